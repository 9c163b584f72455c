//! Rigid surfaces that are given by a formula or by triangles.

use super::carriers::Carriers;
use super::quoted;
use signorini_geometry::mesh::Mesh;
use signorini_geometry::surface::{ContactSurface, RigidId};
use signorini_io::case::{Case, Name, Shape};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The surfaces of a case, by name; nothing for those that cannot be made, which has been told.
pub(super) struct Surfaces(BTreeMap<String, Option<Arc<dyn ContactSurface>>>);

impl Surfaces {
    pub fn new(case: &Case, mesh: &Mesh, carriers: &Carriers, found: &mut Diagnostics) -> Self {
        let mut surfaces = BTreeMap::new();
        for one in &case.surfaces {
            if mesh.sets.contains_key(&one.name.value) {
                found.push(of_mesh(&one.name));
            }
            let carrier = one.reference.as_ref().and_then(|name| carriers.get(name));
            let made = match surface(&one.shape, carrier) {
                Ok(made) => Some(made),
                Err(Unbuilt) => {
                    let message = format!("surface {} is not supported yet", quoted(&one.name));
                    found.push(
                        Diagnostic::error(&codes::NOT_BUILT, message)
                            .at(&one.place, "known, but this version cannot do it")
                            .help("until then: mesh the tool and make it a rigid body"),
                    );
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

/// A shape that this version cannot make.
struct Unbuilt;

/// The surface of a shape, moved by a carrier or fixed in space.
fn surface(_: &Shape, _: Option<RigidId>) -> Result<Arc<dyn ContactSurface>, Unbuilt> {
    Err(Unbuilt)
}

fn of_mesh(name: &Name) -> Diagnostic {
    Diagnostic::error(
        &codes::NAME_TWICE,
        format!("{} is both a group of the mesh and a surface", quoted(name)),
    )
    .at(&name.place, "rename this one")
}
