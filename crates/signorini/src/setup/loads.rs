//! Loads: their kinds and places, and the couplings that carry them.

use super::carriers::Carriers;
use super::constraints::axes;
use super::names::{ALL, Names};
use super::quoted;
use super::shells::{line_load, moments};
use super::steps::idle;
use signorini_geometry::mesh::{CellId, NodeId};
use signorini_geometry::surface::RigidId;
use signorini_geometry::tensor::Vec3;
use signorini_io::case::{self, Axis, Case, Directions, Step};
use signorini_io::diagnostic::{self, Diagnostic, Diagnostics, codes};
use signorini_mechanics::load::{self, Acting, Domain, Line, Load, Place};
use signorini_mechanics::model::{BodyKind, BodyPart, ConstraintKind, ConstraintPart};
use signorini_mechanics::system::Idealisation;
use signorini_vocabulary::Entry;
use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

/// What a load is called: by its own name, or by its step and its number there.
pub(super) fn name(step: &Step, number: usize, load: &case::Load) -> String {
    let given = load.name.as_ref().map(|name| name.value.clone());
    given.unwrap_or_else(|| format!("{}#{number}", step.name.value))
}

/// What acts, as its entry makes it.
fn acting(load: &case::Load, found: &mut Diagnostics) -> Option<Arc<dyn Load>> {
    let acts = match Entry::make(&load::TABLE, &load.kind) {
        Ok(acts) => acts,
        Err(fault) => {
            let message = format!("`{}` of a load: {fault}", load.kind.name);
            found.push(
                Diagnostic::error(&codes::CONTRADICTION, message)
                    .at(&load.what, "")
                    .help("correct its values"),
            );
            return None;
        }
    };
    let Some(follows) = &load.follows else {
        return Some(acts);
    };
    let following = acts.following(follows.value);
    if follows.value && following.is_none() {
        found.push(
            Diagnostic::error(
                &codes::CONTRADICTION,
                format!("`{}` keeps its direction", load.kind.name),
            )
            .at(&follows.place, "only a pressure follows")
            .help("delete `follows`; or load with a `pressure`"),
        );
    }
    Some(following.unwrap_or(acts))
}

/// Whether a load acts on what moves as a whole by its mass.
fn acts_by_mass(load: &dyn Load) -> bool {
    load.properties().domain == Domain::Mass && load.resultant(1.0).is_some()
}

/// What loads refer to.
pub(super) struct Context<'a> {
    pub case: &'a Case,
    pub names: &'a Names<'a>,
    pub carriers: &'a Carriers,
    pub bodies: &'a [BodyPart],
    /// Whether displacements of the step are of any size.
    pub nonlinear: bool,
}

impl Context<'_> {
    /// The load in its place, and what of it acts on masses that are not of bodies that deform; nothing where it cannot act on
    /// the named set.
    pub fn load(&self, load: &case::Load, found: &mut Diagnostics) -> Vec<Acting> {
        let Some(acts) = acting(load, found) else {
            return Vec::new();
        };
        if let Some(carrier) = self.carriers.get(&load.on) {
            let place = self.check_carrier(load, acts.as_ref(), carrier, found);
            let place = place.map(|()| Place::Carrier(carrier));
            return Vec::from_iter(place.map(|place| Acting { load: acts, place }));
        }
        if let Some(all) = self.on_shells(load, &acts, found) {
            return all;
        }
        let on_masses = self.on_masses(load, &acts);
        let has_cells = on_masses.is_none() || self.names.has_cells(&load.on);
        let place = has_cells.then(|| self.place(load, acts.as_ref(), found));
        let on_place = place.flatten().map(|place| Acting { load: acts, place });
        // where nothing deforms there are no cells
        let is_left = |one: &Acting| on_masses.is_none() || !one.is_nowhere();
        let on_place = on_place.filter(is_left);
        on_place.into_iter().chain(on_masses).collect()
    }

    /// A moment at nodes of shells, or a force along their edges.
    fn on_shells(
        &self,
        load: &case::Load,
        acts: &Arc<dyn Load>,
        found: &mut Diagnostics,
    ) -> Option<Vec<Acting>> {
        let shells = self.names.shells();
        if shells.is_empty() {
            return None;
        }
        if load.kind.name == "line" {
            let follows = load.follows.as_ref().is_none_or(|follows| follows.value);
            let force = load.kind.values.number("line").ok()?;
            let faces = self.names.faces(&load.on, "a line load", found);
            let line = Line { force, follows };
            return Some(line_load(
                &line,
                faces.unwrap_or_default(),
                self.names.mesh(),
            ));
        }
        let [force, moment] = acts.resultant(1.0)?;
        if force != Vec3::ZERO || acts_by_mass(acts.as_ref()) {
            return None;
        }
        // names that are not there are reported where the load has its place
        let nodes = self.names.nodes(&load.on, &mut Diagnostics::new());
        let mut nodes = nodes.unwrap_or_default();
        if nodes
            .iter()
            .all(|&node| shells.directors_at(node).is_empty())
        {
            return None;
        }
        let frame = |node: &NodeId| {
            let first = self.carriers.first_of_joints();
            shells.joints().frame_of(*node, first)
        };
        let frames: Vec<RigidId> = nodes.iter().filter_map(frame).collect();
        let on_frame = |carrier| Acting {
            load: Arc::clone(acts),
            place: Place::Carrier(carrier),
        };
        let on_frames = frames.into_iter().map(on_frame);
        nodes.retain(|node| frame(node).is_none());
        let label = |node| self.names.label(node);
        let is_left = !nodes.is_empty();
        if is_left && self.nonlinear {
            let text = format!(
                "moments on nodes of shells, such as those of {}",
                quoted(&load.on)
            );
            let one = Diagnostic::error(&codes::NOT_BUILT, text);
            let one = one.at(
                &load.what,
                "they do not turn with the shell in nonlinear steps yet",
            );
            found.push(one.help("tie two rows of nodes to a [reference] by a kinematic [[constraint]], and load that"));
        }
        let acting = is_left.then(|| moments(shells, (load, moment), &nodes, label, found));
        Some(acting.flatten().into_iter().chain(on_frames).collect())
    }

    /// A load by mass on masses that are not of bodies that deform: on all, on those given to the named set, or at its nodes
    /// where it has no cells.
    fn on_masses(&self, load: &case::Load, acts: &Arc<dyn Load>) -> Option<Acting> {
        let masses = &self.case.masses;
        if !acts_by_mass(acts.as_ref()) {
            return None;
        }
        if load.on.as_str() == ALL {
            let has_points = !masses.is_empty() || self.carriers.has_heavy();
            return has_points.then(|| Acting {
                load: Arc::clone(acts),
                place: Place::Points,
            });
        }
        // names that are not there are reported where they stand
        let nodes_of = |name| self.names.nodes(name, &mut Diagnostics::new());
        let own: BTreeSet<NodeId> = match self.names.has_cells(&load.on) {
            true => BTreeSet::new(),
            false => nodes_of(&load.on).into_iter().flatten().collect(),
        };
        let mut forces = Vec::new();
        let at_nodes = masses
            .iter()
            .filter(|one| self.carriers.get(&one.on).is_none());
        for one in at_nodes {
            let is_named = one.on == load.on;
            let nodes = nodes_of(&one.on).unwrap_or_default().into_iter();
            let [force, _] = acts.resultant(one.value)?;
            let loaded = nodes.filter(|node| is_named || own.contains(node));
            forces.extend(loaded.map(|node| (node, force)));
        }
        (!forces.is_empty()).then(|| Acting::forces(forces))
    }

    /// Where a load acts that does not act on a carrier.
    fn place(&self, load: &case::Load, acts: &dyn Load, found: &mut Diagnostics) -> Option<Place> {
        let (on, names) = (&load.on, self.names);
        Some(match acts.properties().domain {
            Domain::Nodes => Place::Nodes(names.nodes(on, found)?),
            Domain::FacesOrNodes => {
                let nodes = names.nodes(on, found)?;
                match names.covering(on, &nodes) {
                    Some(faces) => Place::Faces(faces),
                    None => Place::Nodes(nodes),
                }
            }
            Domain::Faces => {
                let what = format!("a {}", load.kind.name);
                Place::Faces(names.faces(on, &what, found)?)
            }
            Domain::Volume => {
                self.check_axial(load, acts, found);
                Place::Cells(self.cells(load, found)?)
            }
            Domain::Mass => {
                self.check_axial(load, acts, found);
                Place::Cells(self.heavy(load, found)?)
            }
        })
    }

    /// Refuses loads that do not act on what moves as a whole.
    fn check_carrier(
        &self,
        load: &case::Load,
        acts: &dyn Load,
        carrier: RigidId,
        found: &mut Diagnostics,
    ) -> Option<()> {
        if acts_by_mass(acts) {
            if self.carriers.has_mass(carrier) {
                return Some(());
            }
            let message = format!("{} has no mass", quoted(&load.on));
            found.push(
                Diagnostic::error(&codes::MISSING, message)
                    .at(&load.what, "acts on mass")
                    .help(
                        "write a [[mass]] on it; or a `material` with a `density` in its [[body]]",
                    ),
            );
            return None;
        }
        if acts.resultant(1.0).is_none() {
            let message = format!(
                "`{}` does not act on {}, which moves as a whole",
                load.kind.name,
                quoted(&load.on)
            );
            found.push(
                Diagnostic::error(&codes::WRONG_KIND, message)
                    .at(&load.what, "it takes `force` and `moment`")
                    .help("write its resultant as  force = [x, y, z]  or  moment = [x, y, z]"),
            );
            return None;
        }
        if !self.carriers.moves_something(carrier) {
            found.push(idle(&load.on));
        }
        Some(())
    }

    /// Refuses loads that are not the same all around the axis of a body of revolution.
    fn check_axial(&self, load: &case::Load, acts: &dyn Load, found: &mut Diagnostics) {
        let Some(what_can) = acts.properties().off_axis else {
            return;
        };
        let of_model = super::idealisation(&self.case.model);
        let is_ring = |body: &BodyPart| body.kind.space(of_model) == Idealisation::Axisymmetric;
        // names that are not there are reported where the cells are looked for
        let bodies = self.deformable(load, &mut Diagnostics::new());
        if bodies
            .unwrap_or_default()
            .iter()
            .any(|(body, _)| is_ring(body))
        {
            found.push(
                Diagnostic::error(
                    &codes::CONTRADICTION,
                    format!(
                        "{} across the axis is not axisymmetric",
                        acts.properties().quantity
                    ),
                )
                .at(&load.what, what_can),
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
                            load.kind.name, body.name
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
                format!("`{}` acts on bodies", load.kind.name),
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

/// Nodes with one common displacement.
pub(super) struct Coupling {
    name: String,
    nodes: Vec<NodeId>,
    axes: [bool; 3],
    place: diagnostic::Place,
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
