use super::{Domain, Effect, Load, LoadError, LoadProperties, Site, spread};
use signorini_geometry::tensor::Vec3;
use signorini_vocabulary::{Description, Entry, VECTOR, key};
use std::sync::Arc;

/// The entry of [`Force`].
pub(super) const ENTRY: Entry<Arc<dyn Load>> = Entry {
    description: Description::bare(&[key(
        "force",
        VECTOR,
        "the total force [x, y, z], spread over what it acts on",
    )
    .within_plane()]),
    make: |values| Ok(Arc::new(Force(values.vector("force")?.into()))),
};

/// A total force, spread evenly over the reference area of faces or over nodes; it keeps its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Force(
    /// The sum.
    pub Vec3,
);

impl Load for Force {
    fn properties(&self) -> LoadProperties {
        LoadProperties::new(Domain::FacesOrNodes, "force")
    }

    fn following(&self, _: bool) -> Option<Arc<dyn Load>> {
        None
    }

    fn resultant(&self, _: f64) -> Option<[Vec3; 2]> {
        Some([self.0, Vec3::ZERO])
    }

    fn effect(&self, site: Site<'_>) -> Result<Effect, LoadError> {
        if site.region.is_empty() {
            let each = self.0 / site.nodes.len() as f64;
            return Ok(Effect::forces(site.nodes.iter().map(|&node| (node, each))));
        }
        let area = spread::area(&site.region, site.reference);
        if area <= 0.0 {
            return Err(LoadError::NoArea);
        }
        let traction = self.0 / area;
        let forces = spread::over_faces(&site.region, site.reference, |n| traction * n.norm());
        Ok(Effect::forces(forces))
    }
}

/// A force and a moment on a carrier, which keep their direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench {
    /// The force.
    pub force: Vec3,
    /// The moment.
    pub moment: Vec3,
}

impl Load for Wrench {
    fn properties(&self) -> LoadProperties {
        LoadProperties::new(Domain::Nodes, "wrench")
    }

    fn following(&self, _: bool) -> Option<Arc<dyn Load>> {
        None
    }

    fn resultant(&self, _: f64) -> Option<[Vec3; 2]> {
        Some([self.force, self.moment])
    }

    fn effect(&self, _: Site<'_>) -> Result<Effect, LoadError> {
        Err(LoadError::Misplaced)
    }
}
