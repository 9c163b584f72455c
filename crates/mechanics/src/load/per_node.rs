use super::{Domain, Effect, Load, LoadError, LoadProperties, Site};
use signorini_geometry::tensor::Vec3;
use signorini_vocabulary::{Description, Entry, VECTOR, key};
use std::sync::Arc;

/// The entry of [`PerNode`].
pub(super) const ENTRY: Entry<Arc<dyn Load>> = Entry {
    description: Description::bare(&[key(
        "per_node",
        VECTOR,
        "the same force [x, y, z] at every node",
    )
    .within_plane()]),
    make: |values| Ok(Arc::new(PerNode(values.vector("per_node")?.into()))),
};

/// The same force at every node, which keeps its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerNode(
    /// The force at each.
    pub Vec3,
);

impl Load for PerNode {
    fn properties(&self) -> LoadProperties {
        LoadProperties::new(Domain::Nodes, "force")
    }

    fn following(&self, _: bool) -> Option<Arc<dyn Load>> {
        None
    }

    fn resultant(&self, _: f64) -> Option<[Vec3; 2]> {
        Some([self.0, Vec3::ZERO])
    }

    fn effect(&self, site: Site<'_>) -> Result<Effect, LoadError> {
        Ok(Effect::forces(
            site.nodes.iter().map(|&node| (node, self.0)),
        ))
    }
}
