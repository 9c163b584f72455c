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
    pub(super) fn new() -> Self {
        Self {
            corners: [[T::from(0.0); 2]; MAX_CORNERS],
            n: 0,
        }
    }

    /// One more corner, if there is room.
    pub(super) fn push(&mut self, corner: Pair<T>) {
        if let Some(c) = self.corners.get_mut(self.n) {
            *c = corner;
            self.n += 1;
        }
    }

    pub(super) fn corners(&self) -> &[Pair<T>] {
        &self.corners[..self.n]
    }

    /// Every corner with the next one.
    fn sides(&self) -> impl Iterator<Item = (Pair<T>, Pair<T>)> {
        let next = self.corners().iter().cycle().skip(1);
        self.corners().iter().copied().zip(next.copied())
    }

    pub(super) fn area(&self) -> f64 {
        let Some(first) = self.corners().first().map(values) else {
            return 0.0;
        };
        let twice =
            |(a, b): (Pair<T>, Pair<T>)| cross2(minus(values(&a), first), minus(values(&b), first));
        0.5 * self.sides().map(twice).sum::<f64>()
    }

    /// The largest distance of a corner from the first along an axis.
    pub(super) fn size(&self) -> f64 {
        let first = self.corners[0];
        let away = |p: &Pair<T>| values(&minus(*p, first));
        let all = self.corners().iter().flat_map(away);
        all.fold(0.0, |most, c| most.max(c.abs()))
    }

    /// Whether no corner lies inside the line between its neighbours by more than the tolerance.
    pub(super) fn is_convex(&self, tolerance: f64) -> bool {
        let next = |k: usize| &self.corners()[k % self.n];
        (0..self.n).all(|k| {
            let [a, b, c] = [next(k), next(k + 1), next(k + 2)].map(values);
            Line::through(a, c).is_none_or(|line| line.height(b) <= tolerance)
        })
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
        let mut rest = *self;
        for (a, b) in other.sides() {
            rest = rest.left_of(a, b, tolerance);
        }
        rest
    }

    /// The part to the left of the line from `a` to `b`. Corners within the tolerance are on the line.
    fn left_of(&self, a: Pair<T>, b: Pair<T>, tolerance: f64) -> Self {
        let Some(line) = Line::through(values(&a), values(&b)) else {
            return *self;
        };
        let side = |p: &Pair<T>| {
            let h = line.height(values(p));
            if h.abs() <= tolerance { 0.0 } else { h }
        };
        if self.corners().iter().all(|p| side(p) >= 0.0) {
            let inside = self.corners().iter().any(|p| side(p) > 0.0);
            return if inside { *self } else { Self::new() };
        }
        let mut kept = Self::new();
        let mut inside = false;
        for (p, q) in self.sides() {
            let (h, k) = (side(&p), side(&q));
            inside |= h > 0.0;
            if h >= 0.0 {
                kept.push(p);
            }
            if h * k < 0.0 {
                let [dp, dq] = [p, q].map(|c| cross2(minus(b, a), minus(c, a)));
                let s = dp / (dp - dq);
                kept.push([0, 1].map(|c| p[c] + (q[c] - p[c]) * s));
            }
        }
        if inside { kept } else { Self::new() }
    }
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

    /// The distance of a point to the left.
    fn height(&self, p: Pair<f64>) -> f64 {
        cross2(self.along, minus(p, self.start))
    }
}

fn values<T: Real>(p: &Pair<T>) -> Pair<f64> {
    p.map(|c| c.value())
}
