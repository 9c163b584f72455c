use super::Pair;
use crate::scalar::{Real, minus};

/// More corners than two convex polygons of eight sides can share.
const MAX_CORNERS: usize = 20;

/// A polygon, counter-clockwise.
#[derive(Clone, Copy)]
pub(super) struct Polygon<T> {
    corners: [Pair<T>; MAX_CORNERS],
    n: usize,
}

/// `a × b` of two vectors of the plane.
#[inline]
pub(super) fn cross2<T: Real>(a: Pair<T>, b: Pair<T>) -> T {
    a[0] * b[1] - a[1] * b[0]
}

impl<T: Real> Polygon<T> {
    fn new() -> Self {
        Self {
            corners: [[T::from(0.0); 2]; MAX_CORNERS],
            n: 0,
        }
    }

    /// The one with these corners, as far as there is room.
    pub(super) fn of(corners: impl IntoIterator<Item = Pair<T>>) -> Self {
        let mut polygon = Self::new();
        corners.into_iter().for_each(|corner| polygon.push(corner));
        polygon
    }

    /// One more corner, if there is room.
    fn push(&mut self, corner: Pair<T>) {
        if let Some(c) = self.corners.get_mut(self.n) {
            *c = corner;
            self.n += 1;
        }
    }

    pub(super) fn corners(&self) -> &[Pair<T>] {
        &self.corners[..self.n]
    }

    /// Every corner with the next one.
    fn sides(&self) -> impl Iterator<Item = (&Pair<T>, &Pair<T>)> {
        let next = self.corners().iter().cycle().skip(1);
        self.corners().iter().zip(next)
    }

    pub(super) fn area(&self) -> f64 {
        let Some(first) = self.corners().first().map(values) else {
            return 0.0;
        };
        let twice =
            |(a, b): (&Pair<T>, &Pair<T>)| cross2(minus(values(a), first), minus(values(b), first));
        0.5 * self.sides().map(twice).sum::<f64>()
    }

    /// The largest distance of a corner from the first along an axis.
    pub(super) fn size(&self) -> f64 {
        let first = self.corners[0];
        let away = |p: &Pair<T>| values(&minus(*p, first));
        let all = self.corners().iter().flat_map(away);
        all.fold(0.0, |most, c| most.max(c.abs()))
    }

    /// Whether a corner lies inside the line between its neighbours by more than the tolerance.
    pub(super) fn is_dented(&self, k: usize, tolerance: f64) -> bool {
        let corner = |k: usize| values(&self.corners()[k % self.n]);
        let line = Line::through(corner(k + self.n - 1), corner(k + 1));
        line.is_some_and(|line| line.height(corner(k)) > tolerance)
    }

    /// Whether none does.
    pub(super) fn is_convex(&self, tolerance: f64) -> bool {
        (0..self.n).all(|k| !self.is_dented(k, tolerance))
    }

    /// Whether the boxes around two polygons meet.
    pub(super) fn near(&self, other: &Self) -> bool {
        let range = |of: &Self, a: usize| {
            let all = of.corners().iter().map(|p| p[a].value());
            all.fold([f64::MAX, f64::MIN], |[l, m], c| [l.min(c), m.max(c)])
        };
        (0..2).all(|a| {
            let (own, other) = (range(self, a), range(other, a));
            own[0] <= other[1] && other[0] <= own[1]
        })
    }

    /// What it has in common with a convex one.
    pub(super) fn intersection(&self, other: &Self, tolerance: f64) -> Self {
        // polygons of numbers with derivatives are large: they are written only where something is cut off
        let mut both = [*self, Self::new()];
        let mut is_second = false;
        for (a, b) in other.sides() {
            let Some(line) = Line::through(values(a), values(b)) else {
                continue;
            };
            let [first, second] = &mut both;
            let (rest, next) = match is_second {
                false => (first, second),
                true => (second, first),
            };
            match rest.cut(&line, tolerance) {
                Cut::Nothing => {}
                Cut::All => return Self::new(),
                Cut::Some => {
                    rest.left_of([*a, *b], &line, tolerance, next);
                    is_second = !is_second;
                }
            }
        }
        let [first, second] = both;
        if is_second { second } else { first }
    }

    /// What lies to the right of a line; corners within the tolerance are on the line.
    fn cut(&self, line: &Line, tolerance: f64) -> Cut {
        let sides = self.corners().iter().map(|p| line.side(p, tolerance));
        let [least, most] = sides.fold([0.0f64; 2], |[l, m], h| [l.min(h), m.max(h)]);
        match (least < 0.0, most > 0.0) {
            (_, false) => Cut::All,
            (false, true) => Cut::Nothing,
            (true, true) => Cut::Some,
        }
    }

    /// The part to the left of the line from `a` to `b`.
    fn left_of(&self, [a, b]: [Pair<T>; 2], line: &Line, tolerance: f64, kept: &mut Self) {
        kept.n = 0;
        for (p, q) in self.sides() {
            let [h, k] = [p, q].map(|p| line.side(p, tolerance));
            if h >= 0.0 {
                kept.push(*p);
            }
            if h * k < 0.0 {
                let [dp, dq] = [p, q].map(|c| cross2(minus(b, a), minus(*c, a)));
                let s = dp / (dp - dq);
                kept.push([0, 1].map(|c| p[c] + (q[c] - p[c]) * s));
            }
        }
    }
}

/// How much of a polygon a line cuts off.
enum Cut {
    Nothing,
    Some,
    All,
}

/// A line of plain numbers.
struct Line {
    start: Pair<f64>,
    along: Pair<f64>,
}

impl Line {
    fn through(start: Pair<f64>, end: Pair<f64>) -> Option<Self> {
        let along = crate::scalar::unit(minus(end, start))?;
        Some(Self { start, along })
    }

    /// The distance of a corner to the left; none within the tolerance.
    fn side<T: Real>(&self, p: &Pair<T>, tolerance: f64) -> f64 {
        let h = self.height(values(p));
        if h.abs() <= tolerance { 0.0 } else { h }
    }

    /// The distance of a point to the left.
    fn height(&self, p: Pair<f64>) -> f64 {
        cross2(self.along, minus(p, self.start))
    }
}

fn values<T: Real>(p: &Pair<T>) -> Pair<f64> {
    p.map(|c| c.value())
}
