use super::{Domain, Effect, Load, LoadError, LoadProperties, Site, spread};
use signorini_geometry::tensor::Vec3;
use signorini_vocabulary::{Description, Entry, VECTOR, key};
use std::sync::Arc;

/// The entry of [`Gravity`].
pub(super) const ENTRY: Entry<Arc<dyn Load>> = Entry {
    description: Description::bare(
        &[key("gravity", VECTOR, "acceleration [x, y, z] of all mass")
            .hints(&["acceleration"])
            .within_plane()],
    ),
    make: |values| Ok(Arc::new(Gravity(values.vector("gravity")?.into()))),
};

/// Mass times an acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gravity(
    /// The acceleration.
    pub Vec3,
);

impl Load for Gravity {
    fn properties(&self) -> LoadProperties {
        LoadProperties {
            off_axis: (self.0.x != 0.0).then_some("only its part along y can act"),
            ..LoadProperties::new(Domain::Mass, "gravity")
        }
    }

    fn resultant(&self, mass: f64) -> Option<[Vec3; 2]> {
        Some([self.0 * mass, Vec3::ZERO])
    }

    fn following(&self, _: bool) -> Option<Arc<dyn Load>> {
        None
    }

    fn effect(&self, site: Site<'_>) -> Result<Effect, LoadError> {
        let forces = spread::over_cells(&site.region, site.reference, self.0);
        Ok(Effect::forces(forces))
    }
}
