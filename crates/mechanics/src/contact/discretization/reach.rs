//! How far apart two facets may be that are compared with one another.
//!
//! | symbol | name in code | shape |
//! |---|---|---|
//! | h_e, h_f | `secondary`, `primary` of [`FacetSizes`]: root of the area, length in the plane | a length each |
//! | v | `motion`: how far both have moved relative to one another since the increment began | a length |
//! | R | [`SurfacePair::reach`]: beyond it nothing counts | a length |
//! | r | [`local_reach`] | a length |
//!
//! ```text
//! r = min(R, max(2 max(h_e, h_f), v))                                                         (E1)
//! ```
//!
//! Where one reach served for all facets, the largest facet of a side would decide for all: a point between two fine
//! teeth would see flanks that it cannot touch, because a shoulder elsewhere is coarse. The motion keeps facets in sight
//! that came from further away within one increment: a point that has passed by less than v is still found behind its
//! facet. Sizes are those at the start of the run.

use super::{Discretization, SurfacePair};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Carrier, Placement};
use signorini_geometry::tensor::Vec3;

/// The reach over the size of the larger of two facets (E1).
pub const REACH: f64 = 2.0;

/// The reach between two facets of these sizes that have moved relative to one another by `motion` (E1).
///
/// # Example
/// ```
/// use signorini_mechanics::contact::discretization::local_reach;
/// assert_eq!(local_reach(10.0, [0.1, 0.3], 0.0), 0.6);
/// assert_eq!(local_reach(10.0, [0.1, 0.3], 0.7), 0.7);
/// assert_eq!(local_reach(0.5, [0.1, 0.3], 0.7), 0.5);
/// ```
#[must_use]
pub fn local_reach(most: f64, sizes: [f64; 2], motion: f64) -> f64 {
    let [secondary, primary] = sizes;
    most.min((REACH * secondary.max(primary)).max(motion))
}

impl SurfacePair {
    /// The reach between a facet of the secondary side and one of the primary side in this configuration (E1).
    #[must_use]
    pub fn reach_between(&self, secondary: u32, primary: u32, at: &Placement) -> f64 {
        let size = self.sizes.secondary.get(secondary as usize);
        let motion = || match &self.secondary {
            Some(facets) => self.mean_motion(facets.nodes(secondary), at),
            None => Vec3::ZERO,
        };
        self.reach_from(size.copied().unwrap_or(0.0), motion, primary, at)
    }

    /// The reach between a place of the secondary side and a facet of the primary side: `size` is that of the facet that
    /// the place is on, `motion` how the place has moved since the increment began.
    #[must_use]
    pub fn reach_from(
        &self,
        size: f64,
        motion: impl FnOnce() -> Vec3,
        primary: u32,
        at: &Placement,
    ) -> f64 {
        let Some(&other) = self.sizes.primary.get(primary as usize) else {
            return self.reach;
        };
        if self.start.is_empty() {
            return local_reach(self.reach, [size, other], 0.0);
        }
        let relative = match self.primary.carrier(primary) {
            Carrier::Nodes(nodes) => motion() - self.mean_motion(nodes, at),
            Carrier::Rigid(_) | Carrier::Fixed => motion(),
        };
        local_reach(self.reach, [size, other], relative.norm())
    }

    /// The reach between the point of a row and a facet of the primary side (E1).
    #[must_use]
    pub fn reach_of_row(
        &self,
        of: &dyn Discretization,
        row: usize,
        primary: u32,
        at: &Placement,
    ) -> f64 {
        if self.sizes.primary.is_empty() {
            return self.reach;
        }
        let motion = || self.motion_of_row(of, row, at);
        self.reach_from(self.size_of_row(of, row), motion, primary, at)
    }

    /// The size of the facet that the point of a row is on, or of the largest around it; 0 for bare nodes.
    #[must_use]
    pub fn size_of_row(&self, of: &dyn Discretization, row: usize) -> f64 {
        let size = match of.capabilities().inside.and_then(|points| points.get(row)) {
            Some(point) => self.sizes.secondary.get(point.facet as usize),
            None => {
                let node = of.point(row).nodes.first();
                let place = node.and_then(|n| self.points.binary_search(n).ok());
                place.and_then(|k| self.sizes.around.get(k))
            }
        };
        size.copied().unwrap_or(0.0)
    }

    /// How the point of a row has moved since the increment began.
    #[must_use]
    pub fn motion_of_row(&self, of: &dyn Discretization, row: usize, at: &Placement) -> Vec3 {
        let point = of.point(row);
        let of_nodes = point.nodes.iter().zip(point.weights);
        of_nodes.map(|(&n, &w)| self.motion(n, at) * w).sum()
    }

    /// How a node has moved since the increment began.
    #[must_use]
    pub fn motion(&self, node: NodeId, at: &Placement) -> Vec3 {
        let node = node as usize;
        match (at.x.get(node), self.start.get(node)) {
            (Some(&now), Some(&before)) => now - before,
            _ => Vec3::ZERO,
        }
    }

    /// How nodes have moved since the increment began, in the mean.
    #[must_use]
    pub fn mean_motion(&self, nodes: &[NodeId], at: &Placement) -> Vec3 {
        let sum: Vec3 = nodes.iter().map(|&n| self.motion(n, at)).sum();
        sum / nodes.len().max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::discretization::FacetSizes;
    use crate::contact::discretization::PointToSegment;
    use crate::contact::tests::facets;
    use std::sync::Arc;

    /// A fine and a coarse facet in a line, and a secondary side of one facet of length 0.2 above them.
    fn pair(x: &mut Vec<Vec3>) -> SurfacePair {
        *x = [0.0, 0.1, 1.1].map(|x| Vec3::new(x, 0.0, 0.0)).to_vec();
        x.extend([0.2, 0.0].map(|x| Vec3::new(x, 0.5, 0.0)));
        let primary = facets(x, &[vec![0, 1], vec![1, 2]]);
        let secondary = facets(x, &[vec![3, 4]]);
        let at = Placement { x, poses: &[] };
        let sizes = FacetSizes::new(&[3, 4], Some(&secondary), &primary, &at);
        SurfacePair {
            secondary: Some(secondary),
            sizes,
            ..SurfacePair::new(vec![3, 4], Arc::new(primary), 1.5)
        }
    }

    #[test]
    fn the_reach_follows_the_larger_of_two_facets_and_never_leaves_that_of_the_pair() {
        let mut x = Vec::new();
        let pair = pair(&mut x);
        let at = Placement { x: &x, poses: &[] };
        let rows = PointToSegment::at_nodes(&[3, 4]);
        for (primary, right) in [(0, 0.4), (1, 1.5)] {
            let found = pair.reach_between(0, primary, &at);
            assert!((found - right).abs() < 1e-14, "{found}");
            assert!((pair.reach_of_row(&rows, 1, primary, &at) - right).abs() < 1e-14);
        }
    }

    #[test]
    fn the_reach_grows_with_relative_motion_and_not_with_a_common_one() {
        let mut x = Vec::new();
        let mut pair = pair(&mut x);
        pair.start.clone_from(&x);
        let rows = PointToSegment::at_nodes(&[3, 4]);
        let carried: Vec<Vec3> = x.iter().map(|&x| x + Vec3::new(7.0, 3.0, 0.0)).collect();
        let mut lowered = carried.clone();
        (lowered[3].y, lowered[4].y) = (lowered[3].y - 0.9, lowered[4].y - 0.9);
        for (x, right) in [(&carried, 0.4), (&lowered, 0.9)] {
            let at = Placement { x, poses: &[] };
            assert!((pair.reach_between(0, 0, &at) - right).abs() < 1e-14);
            assert!((pair.reach_of_row(&rows, 0, 0, &at) - right).abs() < 1e-14);
        }
    }
}
