//! A point whose gap is measured.

use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::Placement;
use signorini_geometry::tensor::Vec3;

/// A point of the secondary side: its nodes, with their weights.
#[derive(Clone, Copy)]
pub struct Point<'a> {
    /// The nodes.
    pub nodes: &'a [NodeId],
    /// Their shape functions.
    pub weights: &'a [f64],
    /// Of a row between nodes: all nodes that it depends on, its own and the one opposite first. Empty where rows meet facets.
    pub all: &'a [NodeId],
}

impl Point<'_> {
    /// Where it is.
    #[must_use]
    pub fn position(&self, at: &Placement) -> Vec3 {
        let nodes = self.nodes.iter().zip(self.weights);
        nodes
            .map(|(&n, &w)| at.x.get(n as usize).copied().unwrap_or_default() * w)
            .sum()
    }
}
