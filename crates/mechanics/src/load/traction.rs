use super::{Domain, Effect, Load, LoadError, LoadProperties, Site, spread};
use signorini_geometry::tensor::Vec3;
use signorini_vocabulary::{Description, Entry, VECTOR, key};
use std::sync::Arc;

/// The entry of [`Traction`].
pub(super) const ENTRY: Entry<Arc<dyn Load>> = Entry {
    description: Description::bare(&[
        key("traction", VECTOR, "force per area [x, y, z]").within_plane()
    ]),
    make: |values| Ok(Arc::new(Traction(values.vector("traction")?.into()))),
};

/// Force per reference area, which keeps its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traction(
    /// Force per area.
    pub Vec3,
);

impl Load for Traction {
    fn properties(&self) -> LoadProperties {
        LoadProperties::new(Domain::Faces, "traction")
    }

    fn following(&self, _: bool) -> Option<Arc<dyn Load>> {
        None
    }

    fn effect(&self, site: Site<'_>) -> Result<Effect, LoadError> {
        let forces = spread::over_faces(&site.region, site.reference, |n| self.0 * n.norm());
        Ok(Effect::forces(forces))
    }
}
