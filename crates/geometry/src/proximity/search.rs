use super::{Aabb, Bvh};
use crate::tensor::Vec3;

/// For every point the facets that may come near it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Candidates {
    /// Where the row of each point begins in `facet`; one entry more than there are points.
    start: Vec<usize>,
    facet: Vec<u32>,
}

impl Candidates {
    /// The number of points.
    #[must_use]
    pub fn npoint(&self) -> usize {
        self.start.len().saturating_sub(1)
    }

    /// The number of pairs of a point and a facet.
    #[must_use]
    pub fn npair(&self) -> usize {
        self.facet.len()
    }

    /// The facets near this point, in increasing order; none for a point that does not exist.
    #[must_use]
    pub fn near(&self, point: usize) -> &[u32] {
        match self.start.get(point..) {
            Some([first, last, ..]) => &self.facet[*first..*last],
            _ => &[],
        }
    }
}

/// Keeps the candidates of moving points among moving facets.
///
/// # Example
/// ```
/// use signorini_geometry::{proximity::{Aabb, Search}, tensor::Vec3};
/// let facet = [Aabb::around([Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0)])];
/// let mut search = Search::default();
/// let (reach, skin) = (0.1, 0.2);
/// let mut update = |z| search.update(&[Vec3::new(0.5, 0.5, z)], &facet, reach, skin, &|_, _| true);
/// assert!(update(0.25));    // collected: the facet is not within reach, but within reach and skin
/// assert!(!update(0.06));   // within reach, and a candidate already
/// assert!(update(-0.15));   // has moved by twice the skin
/// assert_eq!(search.candidates().near(0), [0]);
/// ```
#[derive(Clone, Debug, Default)]
pub struct Search {
    bvh: Bvh,
    candidates: Candidates,
    /// R of (E2).
    range: f64,
    /// The configuration in which the candidates were collected.
    points: Vec<Vec3>,
    boxes: Vec<Aabb>,
    row: Vec<u32>,
}

/// Covers the rounding in (E1) and (E3).
const ROUNDING: f64 = 1.0 + 16.0 * f64::EPSILON;

impl Search {
    /// The candidates, as of the last update: all facets whose boxes are within reach of a point, and some more.
    #[must_use]
    pub fn candidates(&self) -> &Candidates {
        &self.candidates
    }

    /// The tree over the boxes, as of when the candidates were last collected.
    #[must_use]
    pub fn bvh(&self) -> &Bvh {
        &self.bvh
    }

    /// The distance within which candidates were collected: no box of the tree has moved further than this exceeds the
    /// reach asked for.
    #[must_use]
    pub fn range(&self) -> f64 {
        self.range
    }

    /// Makes the candidates hold for these points and facets: collects them again where something has moved by more
    /// than half the skin since that was last done (E3), and says whether it did.
    ///
    /// `filter(point, facet)` answers which pairs may touch at all, for instance all but a node and its own facets
    /// where a surface may touch itself. It is asked when candidates are collected; where it changes its mind,
    /// [`Search::forget`] them. A larger skin means fewer collections and more candidates.
    pub fn update(
        &mut self,
        points: &[Vec3],
        boxes: &[Aabb],
        reach: f64,
        skin: f64,
        filter: &dyn Fn(u32, u32) -> bool,
    ) -> bool {
        if self.covers(points, boxes, reach) {
            return false;
        }
        self.range = reach + skin;
        self.points.clear();
        self.points.extend_from_slice(points);
        self.boxes.clear();
        self.boxes.extend(boxes.iter().map(canonical));
        self.bvh.refit(boxes);
        if self.bvh.degraded() {
            self.bvh.rebuild(boxes);
        }
        self.collect(filter);
        true
    }

    /// Makes the next update collect the candidates again.
    pub fn forget(&mut self) {
        self.range = f64::NAN;
    }

    /// (E3): whether no box within reach of a point can be missing from its candidates.
    fn covers(&self, points: &[Vec3], boxes: &[Aabb], reach: f64) -> bool {
        let same = self.points.len() == points.len() && self.boxes.len() == boxes.len();
        same && reach + self.point_motion(points) + self.box_motion(boxes) <= self.range
    }

    /// a of (E3); NaN where a point is not finite.
    fn point_motion(&self, points: &[Vec3]) -> f64 {
        let motion = self.points.iter().zip(points).map(|(&p0, &p)| p - p0);
        largest(motion)
    }

    /// b of (E3). Bounds at infinity that stay there have not moved: their difference is NaN, which `max` drops.
    fn box_motion(&self, boxes: &[Aabb]) -> f64 {
        let outward =
            |(b0, b): (&Aabb, &Aabb)| (b0.min - b.min).max(b.max - b0.max).max(Vec3::ZERO);
        largest(self.boxes.iter().zip(boxes).map(outward))
    }

    /// (E2).
    fn collect(&mut self, filter: &dyn Fn(u32, u32) -> bool) {
        let Candidates { start, facet } = &mut self.candidates;
        start.clear();
        facet.clear();
        start.push(0);
        for (number, &point) in (0..u32::MAX).zip(&self.points) {
            self.bvh.query(point, self.range * ROUNDING, &mut self.row);
            let near = self.row.iter().filter(|&&f| filter(number, f));
            facet.extend(near);
            start.push(facet.len());
        }
    }

    /// Where the buffers are and how much they hold.
    #[cfg(test)]
    pub(super) fn memory(&self) -> Vec<(usize, usize)> {
        let Candidates { start, facet } = &self.candidates;
        let mut memory = vec![
            (start.as_ptr() as usize, start.capacity()),
            (facet.as_ptr() as usize, facet.capacity()),
            (self.points.as_ptr() as usize, self.points.capacity()),
            (self.boxes.as_ptr() as usize, self.boxes.capacity()),
            (self.row.as_ptr() as usize, self.row.capacity()),
        ];
        memory.extend(self.bvh.memory());
        memory
    }
}

/// The length of the longest vector; NaN where one is not a number.
fn largest(vectors: impl Iterator<Item = Vec3>) -> f64 {
    let larger = |a: f64, b: f64| if b <= a || a.is_nan() { a } else { b };
    vectors.map(Vec3::norm_squared).fold(0.0, larger).sqrt()
}

/// One way to contain nothing instead of many, such that every box that contains something is an infinite motion away.
fn canonical(b: &Aabb) -> Aabb {
    if b.is_empty() { Aabb::EMPTY } else { *b }
}
