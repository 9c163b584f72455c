use super::{Domain, Effect, Load, LoadError, LoadProperties, Site, spread};
use signorini_geometry::tensor::Vec3;
use signorini_vocabulary::{Description, Entry, VECTOR, key};
use std::sync::Arc;

/// The entry of [`Moment`].
pub(super) const ENTRY: Entry<Arc<dyn Load>> = Entry {
    description: Description::bare(&[key(
        "moment",
        VECTOR,
        "the moment [x, y, z] about the centre of what it acts on; of shell nodes: at each",
    )
    .hints(&["torque"])
    .across_plane()]),
    make: |values| Ok(Arc::new(Moment(values.vector("moment")?.into()))),
};

/// A moment on nodes: forces that are statically equivalent to it at the start, and keep their direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment(
    /// The moment about their centre.
    pub Vec3,
);

impl Load for Moment {
    fn properties(&self) -> LoadProperties {
        LoadProperties::new(Domain::Nodes, "moment")
    }

    fn following(&self, _: bool) -> Option<Arc<dyn Load>> {
        None
    }

    fn resultant(&self, _: f64) -> Option<[Vec3; 2]> {
        Some([Vec3::ZERO, self.0])
    }

    fn effect(&self, site: Site<'_>) -> Result<Effect, LoadError> {
        let moment = match site.layout.ndim() {
            2 => Vec3::unit(2) * self.0.z,
            _ => self.0,
        };
        let forces = spread::moment(site.nodes, site.reference, moment);
        Ok(Effect::forces(forces.ok_or(LoadError::NoArm)?))
    }
}
