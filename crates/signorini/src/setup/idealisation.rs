//! What the planes of a model and of its bodies stand for.

use signorini_io::case::{self, Space};
use signorini_mechanics::system::Idealisation;

/// What the plane of the model stands for.
pub(super) fn idealisation(model: &case::Model) -> Idealisation {
    standing_for(model.space.value, model.thickness)
}

/// What the plane of a body stands for, where it says something of its own.
pub(super) fn own_idealisation(model: &case::Model, body: &case::Body) -> Option<Idealisation> {
    let space = body.space.as_ref().map(|space| space.value);
    let thickness = body.thickness.as_ref().map(|thickness| thickness.value);
    (space.is_some() || thickness.is_some()).then(|| {
        let space = space.unwrap_or(model.space.value);
        standing_for(space, thickness.unwrap_or(model.thickness))
    })
}

fn standing_for(space: Space, thickness: f64) -> Idealisation {
    match space {
        Space::ThreeD => Idealisation::Space,
        Space::PlaneStrain => Idealisation::PlaneStrain { thickness },
        Space::PlaneStress => Idealisation::PlaneStress { thickness },
        Space::Axisymmetric => Idealisation::Axisymmetric,
    }
}
