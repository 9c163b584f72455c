//! Loads: their kinds and places, and the couplings that carry them.

use super::carriers::Carriers;
use super::constraints::axes;
use super::names::{ALL, Names};
use super::quoted;
use super::steps::idle;
use signorini_geometry::mesh::{CellId, NodeId};
use signorini_geometry::surface::RigidId;
use signorini_geometry::tensor::Vec3;
use signorini_io::case::{self, Axis, Case, Directions, LoadKind, Step};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Place, codes};
use signorini_mechanics::model::{BodyKind, BodyPart, ConstraintKind, ConstraintPart, Load};
use signorini_mechanics::system::Idealisation;
use std::collections::HashMap;

/// What a load is called: by its own name, or by its step and its number there.
pub(super) fn name(step: &Step, number: usize, load: &case::Load) -> String {
    let given = load.name.as_ref().map(|name| name.value.clone());
    given.unwrap_or_else(|| format!("{}#{number}", step.name.value))
}

/// What loads refer to.
pub(super) struct Context<'a> {
    pub case: &'a Case,
    pub names: &'a Names<'a>,
    pub carriers: &'a Carriers,
    pub bodies: &'a [BodyPart],
}

impl Context<'_> {
    /// The load; nothing where it cannot act on the named set.
    pub fn load(&self, load: &case::Load, found: &mut Diagnostics) -> Option<Load> {
        self.check_follower(load, found);
        if let Some(carrier) = self.carriers.get(&load.on) {
            return self.on_carrier(load, carrier, found);
        }
        let (on, names) = (&load.on, self.names);
        match &load.kind {
            LoadKind::Force(force) => {
                let total = Vec3::from(*force);
                let nodes = names.nodes(on, found)?;
                Some(match names.covering(on, &nodes) {
                    Some(faces) => Load::Force { faces, total },
                    None => Load::Nodes(even(&nodes, total / nodes.len() as f64)),
                })
            }
            LoadKind::PerNode(force) => {
                let nodes = names.nodes(on, found)?;
                Some(Load::Nodes(even(&nodes, Vec3::from(*force))))
            }
            LoadKind::Moment(moment) => Some(Load::Moment {
                nodes: names.nodes(on, found)?,
                moment: Vec3::from(*moment),
            }),
            LoadKind::Traction(traction) => Some(Load::Traction {
                faces: names.faces(on, "a traction", found)?,
                traction: Vec3::from(*traction),
            }),
            LoadKind::Pressure(pressure) => Some(Load::Pressure {
                faces: names.faces(on, "a pressure", found)?,
                pressure: *pressure,
                follows: load.follows.as_ref().is_none_or(|follows| follows.value),
            }),
            LoadKind::BodyForce(force) => Some(Load::Body {
                cells: self.cells(load, found)?,
                force: Vec3::from(*force),
            }),
            LoadKind::Gravity(acceleration) => {
                self.check_axial(load, *acceleration, found);
                Some(Load::Gravity {
                    cells: self.heavy(load, found)?,
                    acceleration: Vec3::from(*acceleration),
                })
            }
            LoadKind::Centrifugal { speed, point, axis } => Some(Load::Centrifugal {
                cells: self.heavy(load, found)?,
                speed: *speed,
                point: Vec3::from(*point),
                axis: Vec3::from(*axis).normalized()?,
            }),
        }
    }

    fn on_carrier(
        &self,
        load: &case::Load,
        carrier: RigidId,
        found: &mut Diagnostics,
    ) -> Option<Load> {
        let (force, moment) = match &load.kind {
            LoadKind::Force(force) | LoadKind::PerNode(force) => (Vec3::from(*force), Vec3::ZERO),
            LoadKind::Moment(moment) => (Vec3::ZERO, Vec3::from(*moment)),
            kind => {
                let message = format!(
                    "`{}` does not act on {}, which moves as a whole",
                    kind.key(),
                    quoted(&load.on)
                );
                found.push(
                    Diagnostic::error(&codes::WRONG_KIND, message)
                        .at(&load.what, "it takes `force` and `moment`")
                        .help("write its resultant as  force = [x, y, z]  or  moment = [x, y, z]"),
                );
                return None;
            }
        };
        if !self.carriers.moves_something(carrier) {
            found.push(idle(&load.on));
        }
        Some(Load::Carrier {
            carrier,
            force,
            moment,
        })
    }

    /// Only a pressure has a direction that a surface can turn.
    fn check_follower(&self, load: &case::Load, found: &mut Diagnostics) {
        let Some(follows) = load.follows.as_ref().filter(|follows| follows.value) else {
            return;
        };
        if !matches!(load.kind, LoadKind::Pressure(_)) {
            found.push(
                Diagnostic::error(
                    &codes::CONTRADICTION,
                    format!("`{}` keeps its direction", load.kind.key()),
                )
                .at(&follows.place, "only a pressure follows")
                .help("delete `follows`; or load with a `pressure`"),
            );
        }
    }

    /// Gravity across the axis of a body of revolution is no load of revolution.
    fn check_axial(&self, load: &case::Load, acceleration: [f64; 3], found: &mut Diagnostics) {
        let of_model = super::idealisation(&self.case.model);
        let is_ring = |body: &BodyPart| body.kind.space(of_model) == Idealisation::Axisymmetric;
        let falls = acceleration[0] != 0.0;
        // names that are not there are reported where the cells are looked for
        let bodies = falls.then(|| self.deformable(load, &mut Diagnostics::new()));
        let bodies = bodies.flatten().unwrap_or_default();
        if bodies.iter().any(|(body, _)| is_ring(body)) {
            found.push(
                Diagnostic::error(
                    &codes::CONTRADICTION,
                    "gravity across the axis is not axisymmetric",
                )
                .at(&load.what, "only its part along y can act"),
            );
        }
    }

    /// The cells of deformable bodies that a load by volume acts on.
    fn cells(&self, load: &case::Load, found: &mut Diagnostics) -> Option<Vec<CellId>> {
        let bodies = self.deformable(load, found)?;
        Some(bodies.into_iter().flat_map(|(_, cells)| cells).collect())
    }

    /// The same, all of them with a density.
    fn heavy(&self, load: &case::Load, found: &mut Diagnostics) -> Option<Vec<CellId>> {
        let mut all = Vec::new();
        for (body, cells) in self.deformable(load, found)? {
            let (BodyKind::Solid { density, .. } | BodyKind::Truss { density, .. }) = body.kind
            else {
                continue;
            };
            if density.is_none() {
                found.push(
                    Diagnostic::error(
                        &codes::MISSING,
                        format!(
                            "`{}` needs the mass of body \"{}\"",
                            load.kind.key(),
                            body.name
                        ),
                    )
                    .at(&load.what, "its material has no `density`")
                    .help("write  density =  in its [material]"),
                );
            }
            all.extend(cells);
        }
        Some(all)
    }

    /// The bodies that deform, with the cells of each that a load names.
    fn deformable(
        &self,
        load: &case::Load,
        found: &mut Diagnostics,
    ) -> Option<Vec<(&BodyPart, Vec<CellId>)>> {
        let deformable = || self.bodies.iter().filter(|b| b.kind.material().is_some());
        if load.on.as_str() == ALL {
            return Some(deformable().map(|b| (b, b.cells.clone())).collect());
        }
        let named = self.names.cells(&load.on, found).all();
        let owners = deformable().enumerate();
        let owners: HashMap<CellId, usize> = owners
            .flat_map(|(number, body)| body.cells.iter().map(move |cell| (*cell, number)))
            .collect();
        let mut of_bodies: Vec<(&BodyPart, Vec<CellId>)> =
            deformable().map(|body| (body, Vec::new())).collect();
        let mut outside = 0;
        for cell in &named {
            match owners.get(cell).and_then(|&body| of_bodies.get_mut(body)) {
                Some((_, cells)) => cells.push(*cell),
                None => outside += 1,
            }
        }
        if outside > 0 {
            let message = format!(
                "{outside} of the {} elements of {} are in no body that deforms",
                named.len(),
                quoted(&load.on)
            );
            found.push(Diagnostic::error(&codes::WRONG_KIND, message).at(
                &load.on.place,
                format!("`{}` acts on bodies", load.kind.key()),
            ));
        }
        of_bodies.retain(|(_, cells)| !cells.is_empty());
        (outside == 0).then_some(of_bodies)
    }

    /// What a load keeps together.
    pub fn coupling(&self, load: &case::Load, found: &mut Diagnostics) -> Option<Coupling> {
        let axis = load.coupling.as_ref()?;
        if self.carriers.get(&load.on).is_some() {
            found.push(
                Diagnostic::error(
                    &codes::CONTRADICTION,
                    format!("{} moves as a whole anyway", quoted(&load.on)),
                )
                .at(&axis.place, "delete this"),
            );
            return None;
        }
        let one = match axis.value {
            Axis::X => 0,
            Axis::Y => 1,
            Axis::Z => 2,
        };
        let mut directions = Directions::default();
        directions.xyz[one] = true;
        Some(Coupling {
            name: format!("coupling of \"{}\"", load.on.value),
            nodes: self.names.nodes(&load.on, found)?,
            axes: axes(directions, self.case.model.space.ndim()),
            place: axis.place.clone(),
        })
    }
}

fn even(nodes: &[NodeId], force: Vec3) -> Vec<(NodeId, Vec3)> {
    nodes.iter().map(|&node| (node, force)).collect()
}

/// Nodes with one common displacement.
pub(super) struct Coupling {
    name: String,
    nodes: Vec<NodeId>,
    axes: [bool; 3],
    place: Place,
}

impl Coupling {
    /// Adds it to those there are. Couplings hold from the beginning to the end of a run.
    pub fn join(self, in_first_step: bool, all: &mut Vec<Self>, found: &mut Diagnostics) {
        let same = |other: &Self| other.nodes == self.nodes && other.axes == self.axes;
        if all.iter().any(same) {
            return;
        }
        if in_first_step {
            all.push(self);
            return;
        }
        found.push(
            Diagnostic::error(
                &codes::CONTRADICTION,
                "a coupling that begins in a later step",
            )
            .at(&self.place, "it would hold from the first step on")
            .help("write it in the first step, with a force of zero; or delete it"),
        );
    }

    /// It as a constraint.
    pub fn part(self) -> ConstraintPart {
        ConstraintPart {
            name: self.name,
            kind: ConstraintKind::Equal {
                nodes: self.nodes,
                axes: self.axes,
            },
        }
    }
}
