use super::{BodyKind, BodyPart, Context, LockingSummary, ModelError};
use crate::material::Kinematics;
use crate::solid::{Solid, SolidParts, Truss, TrussParts};
use crate::system::{NodalField, Term};
use signorini_geometry::mesh::{CellId, Mesh};
use std::collections::HashMap;
use std::sync::Arc;

type Terms = Vec<Box<dyn Term>>;

/// The body of each cell.
pub(super) fn owners(
    mesh: &Mesh,
    bodies: &[BodyPart],
) -> Result<HashMap<CellId, usize>, ModelError> {
    let mut owner: HashMap<CellId, usize> = HashMap::new();
    for (number, body) in bodies.iter().enumerate() {
        if body.cells.is_empty() {
            return Err(ModelError::EmptyBody {
                body: body.name.clone(),
            });
        }
        for &cell in &body.cells {
            if let Some(before) = owner.insert(cell, number) {
                return Err(ModelError::TwoBodies {
                    label: mesh.cell_label(cell).unwrap_or(0),
                    first: bodies[before].name.clone(),
                    second: body.name.clone(),
                });
            }
        }
    }
    Ok(owner)
}

/// The body of each node; `u32::MAX` where there is none.
pub(super) fn nodes_by_body(mesh: &Mesh, bodies: &[BodyPart]) -> Vec<u32> {
    let mut of = vec![u32::MAX; mesh.nnode()];
    for (number, body) in bodies.iter().enumerate() {
        for &cell in &body.cells {
            for &node in mesh.cell(cell) {
                of[node as usize] = number as u32;
            }
        }
    }
    of
}

impl Context<'_> {
    /// The terms of the bodies, and what was chosen against locking for these sizes of strains.
    pub(super) fn bodies(
        &self,
        bodies: Vec<BodyPart>,
        temperature: Option<Arc<NodalField>>,
        sizes: &[Kinematics],
    ) -> Result<(Terms, Vec<LockingSummary>), ModelError> {
        let mut terms = Terms::new();
        let mut summaries = Vec::new();
        for body in bodies {
            let (name, cells) = (&*body.name, &*body.cells);
            let (mesh, layout, space) = (self.mesh, self.layout, self.space);
            let (reference, temperature) = (self.reference.clone(), temperature.clone());
            match body.kind {
                BodyKind::Solid {
                    material,
                    integration,
                    locking,
                    ..
                } => {
                    let solid = Solid::new(SolidParts {
                        name,
                        mesh,
                        reference,
                        cells,
                        layout,
                        space,
                        material,
                        integration,
                        locking,
                        temperature,
                    })?;
                    for &kinematics in sizes {
                        let chosen = solid.locking(kinematics)?.into_iter();
                        summaries.extend(chosen.map(|(element, locking)| LockingSummary {
                            body: name.to_string(),
                            element,
                            kinematics,
                            locking,
                        }));
                    }
                    terms.push(Box::new(solid));
                }
                BodyKind::Truss { material, area, .. } => {
                    terms.push(Box::new(Truss::new(TrussParts {
                        name,
                        mesh,
                        reference,
                        cells,
                        layout,
                        space,
                        material,
                        area,
                        temperature,
                    })?));
                }
                BodyKind::Rigid(_) => {}
            }
        }
        Ok((terms, summaries))
    }
}
