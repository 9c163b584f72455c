//! Rigid surfaces that are given by a formula or by triangles.

use super::carriers::Carriers;
use super::{own, quoted};
use crate::own::Own;
use signorini_geometry::mesh::Mesh;
use signorini_geometry::surface::{
    self, Analytical, AnalyticalError, ContactSurface, Mount, Triangulated,
};
use signorini_io::case::{Case, Name, Shape, Surface};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_vocabulary::Entry;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The surfaces of a case, by name; nothing for those that cannot be made, which has been reported.
pub(super) struct Surfaces(BTreeMap<String, Option<Arc<dyn ContactSurface>>>);

impl Surfaces {
    pub fn new(
        case: &Case,
        mesh: &Mesh,
        carriers: &Carriers,
        own: &Own,
        found: &mut Diagnostics,
    ) -> Self {
        let mut surfaces = BTreeMap::new();
        for one in &case.surfaces {
            if mesh.sets.contains_key(&one.name.value) {
                found.push(of_mesh(&one.name));
            }
            let moved = one.reference.as_ref().and_then(|name| carriers.get(name));
            let at = moved.and_then(|c| carriers.place(c));
            if let (Some(reference), Some(_), None) = (&one.reference, moved, at) {
                found.push(nowhere(reference, &one.name));
            }
            let ntan = case.model.space.value.ndim() - 1;
            let mount = moved.map_or(Mount::fixed(ntan), |body| {
                Mount::on(ntan, body, at.unwrap_or_default())
            });
            let made = match made(one, mount, own) {
                Ok(made) => made,
                Err(error) => {
                    let message = format!("surface {}: {error}", quoted(&one.name));
                    let message = Diagnostic::error(&codes::BAD_SURFACE, message);
                    found.push(message.at(&one.place, "this one").help(remedy(&error)));
                    None
                }
            };
            surfaces.insert(one.name.value.clone(), made);
        }
        Self(surfaces)
    }

    /// What a name stands for; outside nothing where it is no surface.
    pub fn get(&self, name: &Name) -> Option<Option<Arc<dyn ContactSurface>>> {
        self.0.get(&name.value).cloned()
    }
}

/// A reference of a surface that is in the mean of nodes: nobody could say how far from it the surface is.
fn nowhere(reference: &Name, surface: &Name) -> Diagnostic {
    let message = format!(
        "surface {} moves with {}, which has no place of its own",
        quoted(surface),
        quoted(reference)
    );
    let message = Diagnostic::error(&codes::MISSING, message).at(&reference.place, "named here");
    message.help("write  at = [x, y, z]  in the reference")
}

/// What to change about a surface that cannot be made.
const fn remedy(error: &AnalyticalError) -> &'static str {
    match error {
        AnalyticalError::Degree { .. } => "write fewer `coefficients`",
        AnalyticalError::NoTriangles
        | AnalyticalError::NoSuchPoint { .. }
        | AnalyticalError::Flat { .. } => {
            "take the triangle out of the file, or correct its corners"
        }
        AnalyticalError::SameWay { .. } => {
            "reverse the order of the corners of one of them, or take it out of the file"
        }
        AnalyticalError::NotFinite { .. }
        | AnalyticalError::NotPositive { .. }
        | AnalyticalError::NoDirection { .. }
        | AnalyticalError::HalfAngle { .. }
        | AnalyticalError::Tube { .. }
        | AnalyticalError::NoCoefficients
        | AnalyticalError::OutOfPlane { .. }
        | AnalyticalError::Values(_)
        | AnalyticalError::Tangents { .. } => "correct the numbers of its `shape`",
    }
}

/// The surface of a shape on its mount; nothing where it is one of the program that the program does not have.
fn made(
    one: &Surface,
    mount: Mount,
    own: &Own,
) -> Result<Option<Arc<dyn ContactSurface>>, AnalyticalError> {
    let surface: Arc<dyn ContactSurface> = match &one.shape {
        Shape::Analytical(chosen) => {
            let shape = match own::name(chosen) {
                None => Entry::make(&surface::TABLE, chosen)?,
                Some(name) => match own.surfaces.get(name) {
                    Some(shape) => Box::new(Arc::clone(shape)),
                    None => return Ok(None),
                },
            };
            Arc::new(Analytical::new(mount, shape)?)
        }
        Shape::Stl { .. } => {
            let (points, triangles) = one.triangles.clone().unwrap_or_default();
            Arc::new(Triangulated::new(mount, points, &triangles)?)
        }
    };
    Ok(Some(surface))
}

fn of_mesh(name: &Name) -> Diagnostic {
    Diagnostic::error(
        &codes::NAME_TWICE,
        format!("{} is both a group of the mesh and a surface", quoted(name)),
    )
    .at(&name.place, "rename this one")
}
