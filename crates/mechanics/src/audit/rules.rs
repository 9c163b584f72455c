//! What a contact promises, as an audit asks for it.

use crate::system::{ContactFrame, Measured};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::proximity::Aabb;
use signorini_geometry::surface::{ContactSurface, Facets, Placement};
use signorini_geometry::tensor::Vec3;

/// Where the two sides of a contact are.
#[derive(Clone, Copy)]
pub struct Sides<'a> {
    /// The facets of the secondary side; none where it is bare nodes.
    pub secondary: Option<&'a Facets>,
    /// The other side.
    pub primary: &'a dyn ContactSurface,
    /// Where all is now.
    pub now: Placement<'a>,
    /// Positions at the start, if the method keeps the geometry of the start.
    pub start: Option<Placement<'a>>,
    /// Where the nodes were at the start.
    pub reference: &'a [Vec3],
    /// Whether both sides are one.
    pub same: bool,
}

impl<'a> Sides<'a> {
    /// The configuration in which closest points are looked for.
    pub(super) const fn searched(&self) -> Placement<'a> {
        match self.start {
            Some(start) => start,
            None => self.now,
        }
    }
}

impl Sides<'_> {
    /// Whether boxes around both sides have a point in common; where they have none, no side is inside the other.
    pub(super) fn overlap(&self, of: &ContactFrame) -> bool {
        let at = self.searched();
        let nodes = of.nodes.iter();
        let places = nodes.filter_map(|&node| at.x.get(node as usize).copied());
        let secondary = Aabb::around(places);
        let facets = 0..self.primary.nfacet() as u32;
        let primary = facets.map(|facet| self.primary.aabb(&at, facet));
        let primary = primary.fold(Aabb::EMPTY, Aabb::union);
        // nodes that have moved from where the geometry is held may be anywhere
        self.start.is_some() || secondary.overlaps(&primary)
    }
}

/// The conditions that a contact has to satisfy.
pub trait Rules: Sync {
    /// Whether the sides are joined.
    fn joined(&self) -> bool;
    /// The prescribed shift of the gap at a node of the secondary side, by its place among them.
    fn shift(&self, node: usize) -> f64;
    /// How far the gap has gone since the time that the pressure on a node belongs to, at most.
    fn moved(&self, node: usize) -> f64;
    /// The gap that the law has at a pressure on a node.
    fn gap(&self, node: usize, pressure: f64) -> f64;
    /// The largest tangential traction at a pressure on a node; `None` without friction.
    fn limit(&self, node: usize, pressure: f64) -> Option<f64>;
    /// The node opposite a node, where nodes meet nodes and the other side has no facets.
    fn partner(&self, node: usize) -> Option<NodeId>;
    /// How deep a node of the secondary side may be behind a facet of the primary side: deeper, it sees it through its own
    /// body.
    fn deepest(&self, node: NodeId, primary: u32) -> f64;
    /// The same of a node of the primary side behind a facet of the secondary side.
    fn deepest_back(&self, node: NodeId, secondary: u32) -> f64;
    /// Whether a node follows a rigid body, so that no stress carries the forces on it.
    fn is_rigid(&self, node: NodeId) -> bool;
}

/// The part of the work of loads and supports that viscous forces may do in jumps.
pub(super) const VISCOUS: f64 = 0.05;

/// The part of the largest heat per time that equations may lose or make.
pub(super) const HEAT: f64 = 1e-8;

/// The part of it that the iteration may leave in all free nodes together: by the usual tolerance, 1e-6 of the mean heat at a node, it
/// is 1e-6 and less.
pub(super) const HEAT_LEFT: f64 = 1e-4;

/// How many nodes a finding names.
pub(super) const NAMED: usize = 4;

/// The worst of these nodes, the worst first.
pub(super) fn worst(of: &ContactFrame, mut nodes: Vec<(usize, f64)>) -> Vec<NodeId> {
    nodes.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let name = |&(k, _): &(usize, f64)| of.nodes.get(k).copied();
    nodes.iter().take(NAMED).filter_map(name).collect()
}

/// A check that has nothing to look at.
pub(super) fn nothing(limit: f64) -> Measured {
    Measured {
        limit,
        ..Measured::default()
    }
}
