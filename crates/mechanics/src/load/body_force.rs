use super::{Domain, Effect, Load, LoadError, LoadProperties, Site, spread};
use signorini_geometry::tensor::Vec3;
use signorini_vocabulary::{Description, Entry, VECTOR, key};
use std::sync::Arc;

/// The entry of [`BodyForce`].
pub(super) const ENTRY: Entry<Arc<dyn Load>> = Entry {
    description: Description::bare(&[
        key("body_force", VECTOR, "force per volume [x, y, z]").within_plane()
    ]),
    make: |values| Ok(Arc::new(BodyForce(values.vector("body_force")?.into()))),
};

/// Force per reference volume, which keeps its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyForce(
    /// Force per volume.
    pub Vec3,
);

impl Load for BodyForce {
    fn properties(&self) -> LoadProperties {
        LoadProperties::new(Domain::Volume, "body force")
    }

    fn following(&self, _: bool) -> Option<Arc<dyn Load>> {
        None
    }

    fn effect(&self, site: Site<'_>) -> Result<Effect, LoadError> {
        let forces = spread::over_cells(&site.region, site.reference, self.0);
        Ok(Effect::forces(forces))
    }
}
