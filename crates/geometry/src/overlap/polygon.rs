use super::pair::{Facing, Pair};
use crate::scalar::minus;

/// More corners than two convex polygons of eight sides can share: no cell has as many.
pub const MAX_CORNERS: usize = 20;

/// What the outline of a facet, or of a part of it, goes through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Spot {
    /// A node.
    Node(u8),
    /// The centre.
    Centre,
}

/// The line through two spots of a facet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Through {
    pub facet: Facing,
    pub ends: [Spot; 2],
}

/// What a corner moves with.
#[derive(Clone, Copy, Debug)]
pub(super) enum Origin {
    /// A spot of a facet.
    Spot(Facing, Spot),
    /// The place where two lines cross.
    Crossing([Through; 2]),
}

impl Origin {
    /// Where two lines cross: those of the same facet do so in the spot that they share.
    fn crossing(a: Through, b: Through) -> Self {
        let shared = a.ends.into_iter().find(|end| b.ends.contains(end));
        match shared {
            Some(spot) if a.facet == b.facet => Self::Spot(a.facet, spot),
            _ => Self::Crossing([a, b]),
        }
    }
}

/// A corner of a polygon.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub at: Pair<f64>,
    pub origin: Origin,
    /// The line along which the boundary goes on from here.
    side: Through,
}

impl Corner {
    /// The corner in a spot from where the boundary goes on to the next one.
    pub(super) fn new(facet: Facing, [spot, next]: [Spot; 2], at: Pair<f64>) -> Self {
        Self {
            at,
            origin: Origin::Spot(facet, spot),
            side: Through {
                facet,
                ends: [spot, next],
            },
        }
    }
}

/// A polygon, counter-clockwise.
#[derive(Clone, Copy)]
pub(super) struct Polygon {
    corners: [Corner; MAX_CORNERS],
    n: usize,
}

/// `a × b` of two vectors of the plane.
#[inline]
pub(super) fn cross2(a: Pair<f64>, b: Pair<f64>) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

impl Polygon {
    fn new() -> Self {
        let spots = [Spot::Centre; 2];
        Self {
            corners: [Corner::new(Facing::Same, spots, [0.0; 2]); MAX_CORNERS],
            n: 0,
        }
    }

    /// The one through spots of a facet, as far as there is room.
    pub(super) fn of(facet: Facing, spots: impl Iterator<Item = (Spot, Pair<f64>)>) -> Self {
        let mut polygon = Self::new();
        spots.for_each(|(spot, at)| polygon.push(Corner::new(facet, [spot; 2], at)));
        // sides end where the next begins
        let Some(mut next) = polygon.corners().first().map(|c| c.side.ends[0]) else {
            return polygon;
        };
        for corner in polygon.corners[..polygon.n].iter_mut().rev() {
            corner.side.ends[1] = next;
            next = corner.side.ends[0];
        }
        polygon
    }

    /// One more corner, if there is room.
    fn push(&mut self, corner: Corner) {
        if let Some(c) = self.corners.get_mut(self.n) {
            *c = corner;
            self.n += 1;
        }
    }

    pub(super) fn corners(&self) -> &[Corner] {
        &self.corners[..self.n]
    }

    /// Every corner with the next one.
    fn sides(&self) -> impl Iterator<Item = (&Corner, &Corner)> {
        let next = self.corners().iter().cycle().skip(1);
        self.corners().iter().zip(next)
    }

    pub(super) fn area(&self) -> f64 {
        let first = self.corners[0].at;
        let twice = |(a, b): (&Corner, &Corner)| cross2(minus(a.at, first), minus(b.at, first));
        0.5 * self.sides().map(twice).sum::<f64>()
    }

    /// The largest distance of a corner from the first along an axis.
    pub(super) fn size(&self) -> f64 {
        let first = self.corners[0].at;
        let all = self.corners().iter().flat_map(|c| minus(c.at, first));
        all.fold(0.0, |most, c| most.max(c.abs()))
    }

    /// Whether a corner lies inside the line between its neighbours by more than the tolerance.
    pub(super) fn is_dented(&self, k: usize, tolerance: f64) -> bool {
        let corner = |k: usize| self.corners()[k % self.n].at;
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
            let all = of.corners().iter().map(|c| c.at[a]);
            all.fold([f64::MAX, f64::MIN], |[l, m], c| [l.min(c), m.max(c)])
        };
        (0..2).all(|a| {
            let (own, other) = (range(self, a), range(other, a));
            own[0] <= other[1] && other[0] <= own[1]
        })
    }

    /// What it has in common with a convex one.
    pub(super) fn intersection(&self, other: &Self, tolerance: f64) -> Self {
        // written only where something is cut off
        let mut both = [*self, Self::new()];
        let mut is_second = false;
        for (a, b) in other.sides() {
            let Some(line) = Line::through(a.at, b.at) else {
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
                    rest.left_of(&line, a.side, tolerance, next);
                    is_second = !is_second;
                }
            }
        }
        let [first, second] = both;
        if is_second { second } else { first }
    }

    /// What lies to the right of a line; corners within the tolerance are on the line.
    fn cut(&self, line: &Line, tolerance: f64) -> Cut {
        let sides = self.corners().iter().map(|c| line.side(c.at, tolerance));
        let [least, most] = sides.fold([0.0f64; 2], |[l, m], h| [l.min(h), m.max(h)]);
        match (least < 0.0, most > 0.0) {
            (_, false) => Cut::All,
            (false, true) => Cut::Nothing,
            (true, true) => Cut::Some,
        }
    }

    /// The part to the left of a line, which goes through these spots.
    fn left_of(&self, line: &Line, through: Through, tolerance: f64, kept: &mut Self) {
        kept.n = 0;
        for (p, q) in self.sides() {
            let [h, k] = [p, q].map(|c| line.side(c.at, tolerance));
            // where the boundary leaves, it goes on along the line
            let side = if k < 0.0 { through } else { p.side };
            if h == 0.0 {
                kept.push(Corner { side, ..*p });
            } else if h > 0.0 {
                kept.push(*p);
            }
            if h * k < 0.0 {
                let s = h / (h - k);
                kept.push(Corner {
                    at: [0, 1].map(|c| p.at[c] + (q.at[c] - p.at[c]) * s),
                    origin: Origin::crossing(p.side, through),
                    side,
                });
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
    fn side(&self, p: Pair<f64>, tolerance: f64) -> f64 {
        let h = self.height(p);
        if h.abs() <= tolerance { 0.0 } else { h }
    }

    /// The distance of a point to the left.
    fn height(&self, p: Pair<f64>) -> f64 {
        cross2(self.along, minus(p, self.start))
    }
}
