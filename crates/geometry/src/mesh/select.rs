//! Nodes and faces by where they are.
//!
//! A tolerance is a length; where none is given it is [`TOLERANCE`] of the diagonal of the mesh's box, so that a mesh in
//! metres and the same one in millimetres give the same nodes. All answers are sorted.

use super::{Face, Mesh, NodeId};
use crate::tensor::Vec3;

/// The tolerance where none is given, relative to the diagonal of the mesh's box.
pub const TOLERANCE: f64 = 1e-6;

/// A part of space.
///
/// # Example
/// ```
/// use signorini_geometry::mesh::select::Region;
/// use signorini_geometry::tensor::Vec3;
///
/// let top = Region::Plane { normal: Vec3::unit(2), point: Vec3::new(0.0, 0.0, 1.0) };
/// assert!(top.contains(Vec3::new(5.0, -3.0, 1.0), 1e-9));
/// assert!(!top.contains(Vec3::new(5.0, -3.0, 1.1), 1e-9));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Region {
    /// The plane through a point, with a normal of any length but zero.
    Plane {
        /// Its normal.
        normal: Vec3,
        /// A point of it.
        point: Vec3,
    },
    /// A box along the axes, with its inside. A side may be flat, or infinite.
    Box {
        /// The corner of the smallest coordinates.
        min: Vec3,
        /// The corner of the largest.
        max: Vec3,
    },
    /// A ball: a sphere with its inside.
    Ball {
        /// Its centre.
        centre: Vec3,
        /// Its radius.
        radius: f64,
    },
}

impl Region {
    /// Whether a point is in the region or at most `tolerance` away from it; for a box, along each axis.
    ///
    /// A plane without a normal and a box or ball turned inside out contain nothing.
    #[must_use]
    pub fn contains(&self, x: Vec3, tolerance: f64) -> bool {
        match *self {
            Self::Plane { normal, point } => normal
                .normalized()
                .is_some_and(|n| n.dot(x - point).abs() <= tolerance),
            Self::Box { min, max } => (0..3).all(|i| {
                min[i] <= max[i] && x[i] >= min[i] - tolerance && x[i] <= max[i] + tolerance
            }),
            Self::Ball { centre, radius } => {
                radius >= 0.0 && (x - centre).norm() <= radius + tolerance
            }
        }
    }
}

impl Mesh {
    /// The corners of the box around all nodes; nothing for a mesh without nodes.
    #[must_use]
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let first = *self.points.first()?;
        let wider = |(low, high): (Vec3, Vec3), x: &Vec3| (low.min(*x), high.max(*x));
        Some(self.points.iter().fold((first, first), wider))
    }

    /// The length of the diagonal of the box around all nodes, without overflow.
    #[must_use]
    pub fn diagonal(&self) -> f64 {
        self.bounds().map_or(0.0, |(low, high)| {
            let extent = high - low;
            extent.x.hypot(extent.y).hypot(extent.z)
        })
    }

    /// The tolerance of selections where none is given.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        TOLERANCE * self.diagonal()
    }

    /// The nodes in a region, of those in `among` (all, where that is nothing).
    #[must_use]
    pub fn nodes_in(
        &self,
        region: &Region,
        among: Option<&[NodeId]>,
        tolerance: Option<f64>,
    ) -> Vec<NodeId> {
        let tolerance = tolerance.unwrap_or_else(|| self.tolerance());
        let is_in = |node: &NodeId| {
            let x = self.points.get(*node as usize);
            x.is_some_and(|x| region.contains(*x, tolerance))
        };
        let mut nodes: Vec<NodeId> = match among {
            Some(nodes) => nodes.iter().copied().filter(is_in).collect(),
            None => (0..self.nnode() as NodeId).filter(is_in).collect(),
        };
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// The node nearest to a point and its distance, of those in `among` (all, where that is nothing). Of several
    /// equally near ones the lowest.
    ///
    /// # Example
    /// ```
    /// use signorini_geometry::mesh::Mesh;
    /// use signorini_geometry::tensor::Vec3;
    ///
    /// let mesh = Mesh {
    ///     points: vec![Vec3::ZERO, Vec3::new(3.0, 4.0, 0.0)],
    ///     node_labels: vec![1, 2],
    ///     ..Mesh::default()
    /// };
    /// assert_eq!(mesh.nearest_node(Vec3::new(3.0, 4.0, 2.0), None), Some((1, 2.0)));
    /// ```
    #[must_use]
    pub fn nearest_node(&self, point: Vec3, among: Option<&[NodeId]>) -> Option<(NodeId, f64)> {
        let distance = |node: NodeId| {
            let x = self.points.get(node as usize)?;
            Some((node, (*x - point).norm()))
        };
        let nearer = |a: &(NodeId, f64), b: &(NodeId, f64)| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0));
        match among {
            Some(nodes) => nodes.iter().filter_map(|&n| distance(n)).min_by(nearer),
            None => (0..self.nnode() as NodeId)
                .filter_map(distance)
                .min_by(nearer),
        }
    }

    /// Those of these faces all of whose nodes are among `nodes`.
    ///
    /// With the outer faces of a body ([`super::boundary`]) this is its surface on a plane, say.
    #[must_use]
    pub fn faces_among(&self, faces: &[Face], nodes: &[NodeId]) -> Vec<Face> {
        let mut is_meant = vec![false; self.nnode()];
        for &node in nodes {
            if let Some(entry) = is_meant.get_mut(node as usize) {
                *entry = true;
            }
        }
        let is_in = |face: &&Face| {
            let cell = self.cell(face.cell);
            let element = self.element(face.cell);
            let side = element.and_then(|e| e.sides().get(face.side as usize));
            side.is_some_and(|side| {
                side.nodes.iter().all(|&i| {
                    let node = cell.get(i).and_then(|&n| is_meant.get(n as usize));
                    node.copied().unwrap_or(false)
                })
            })
        };
        let mut found: Vec<Face> = faces.iter().filter(is_in).copied().collect();
        found.sort_unstable();
        found.dedup();
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::boundary;
    use crate::mesh::testing::bricks;

    /// The plane on which the coordinate of an axis has this value.
    fn level(axis: usize, at: f64) -> Region {
        let normal = Vec3::unit(axis);
        let point = normal * at;
        Region::Plane { normal, point }
    }

    #[test]
    fn planes_boxes_and_balls_find_their_nodes() {
        let mesh = bricks([4, 3, 2], 1.0);
        let count = |region| mesh.nodes_in(&region, None, None).len();
        assert_eq!(count(level(2, 2.0)), 5 * 4);
        assert_eq!(count(level(2, 2.5)), 0);
        let diagonal = Region::Plane {
            normal: Vec3::new(2.0, -2.0, 0.0),
            point: Vec3::ZERO,
        };
        assert_eq!(count(diagonal), 4 * 3);
        let infinite = f64::INFINITY;
        let column = Region::Box {
            min: Vec3::new(1.0, 1.0, -infinite),
            max: Vec3::new(2.0, 1.0, infinite),
        };
        assert_eq!(count(column), 2 * 3);
        let (centre, radius) = (Vec3::new(1.0, 1.0, 1.0), 1.0);
        assert_eq!(count(Region::Ball { centre, radius }), 7);
        let inside_out = Region::Box {
            min: centre,
            max: Vec3::ZERO,
        };
        assert_eq!(count(inside_out), 0);
        assert_eq!(
            count(Region::Ball {
                centre,
                radius: -1.0
            }),
            0
        );
        let among = [0, 5, 1];
        assert_eq!(mesh.nodes_in(&level(1, 0.0), Some(&among), None), [0, 1]);
    }

    #[test]
    fn the_unit_of_length_does_not_matter() {
        for size in [1e-9, 1e-3, 1.0, 1e6] {
            let mut mesh = bricks([4, 3, 2], size);
            mesh.points[0].z += 1e-7 * size;
            mesh.points[1].z += 1e-4 * size;
            let nodes = mesh.nodes_in(&level(2, 0.0), None, None);
            assert_eq!(nodes.len(), 5 * 4 - 1, "{size}");
            assert!(nodes.contains(&0) && !nodes.contains(&1));
        }
    }

    #[test]
    fn the_nearest_node_is_the_nearest_by_brute_force_and_the_lowest_of_equals() {
        let mesh = bricks([4, 3, 2], 1.0);
        assert_eq!(
            mesh.nearest_node(Vec3::new(0.5, 0.0, 0.0), None),
            Some((0, 0.5))
        );
        let near = mesh.nearest_node(Vec3::new(2.1, 1.2, 0.9), None).unwrap();
        assert_eq!(mesh.points[near.0 as usize].to_array(), [2.0, 1.0, 1.0]);
        assert_eq!(mesh.nearest_node(Vec3::ZERO, Some(&[9, 3])).unwrap().0, 3);
        assert_eq!(mesh.nearest_node(Vec3::ZERO, Some(&[])), None);
    }

    #[test]
    fn faces_among_nodes_are_the_surface_there() {
        let mesh = bricks([4, 3, 2], 1.0);
        let outer = boundary(&mesh, mesh.cells(3));
        let nodes = mesh.nodes_in(&level(0, 4.0), None, None);
        let faces = mesh.faces_among(&outer, &nodes);
        assert_eq!(faces.len(), 3 * 2);
        for face in faces {
            let (_, nodes) = mesh.face(face).unwrap();
            assert!(nodes.iter().all(|&n| mesh.points[n as usize].x == 4.0));
        }
    }
}
