//! From a case to a model: names become nodes, cells and faces; every fault becomes a message with its place.
//!
//! ```text
//! Case ──mesh──▶ Mesh ──names──▶ Parts ──mechanics::model──▶ Model
//! ```

mod bodies;
mod carriers;
mod choices;
mod constraints;
mod contact;
mod cuts;
mod cycles;
mod fourier;
pub(crate) mod gaps;
pub(crate) mod general;
mod heat;
mod held;
mod idealisation;
mod info;
mod loads;
mod mesh;
mod motion;
mod names;
mod nonlinear;
mod orientation;
mod origin;
mod own;
mod prints;
mod process_zones;
mod refused;
mod settings;
mod shells;
mod steps;
mod submodel;
mod surfaces;
mod temperature;
#[cfg(test)]
mod tests;

pub(crate) use held::{LISTED, and_so_on, first_step, hold, hold_it};
use idealisation::{OwnPlane, idealisation};
pub use info::{ContactInfo, ReferenceInfo};
pub use mesh::{judge_mesh_of, read_mesh_of, read_surfaces_of};
pub(crate) use names::quoted;
pub use prints::{
    ContactQuantity, ElementQuantity, NodeQuantity, Printed, PrintedContact, PrintedFace, PrintedOf,
};
pub use submodel::read_motions_of;

use crate::own::Own;
use carriers::Carriers;
use cuts::Cuts;
use general::{General, Pair, Source};
use names::Names;
use origin::Origin;
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_io::case::{Case, FreeMotions, Stabilize};
use signorini_io::deck;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Spanned, codes};
use signorini_mechanics::model::{LockingSummary, Parts, Unheld};
use signorini_mechanics::solid::Locking;
use signorini_mechanics::solve::{Cycle, Step, StepperSettings};
use signorini_mechanics::system::{Idealisation, System};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use surfaces::Surfaces;

/// A case, built: everything a run needs.
pub struct Model {
    /// What the run is called: the stem of its files.
    pub name: String,
    /// The mesh.
    pub mesh: Arc<Mesh>,
    /// What is solved.
    pub system: System,
    /// The steps.
    pub steps: Vec<Step>,
    /// Those that come again.
    pub cycles: Vec<Cycle>,
    /// The numbers of the solution.
    pub settings: StepperSettings,
    /// The contacts, with what was chosen for them.
    pub contacts: Vec<ContactInfo>,
    /// What was chosen against locking, by body, size of strains and element.
    pub locking: Vec<LockingSummary>,
    /// References and rigid bodies with a point of their own, by the names they have in histories.
    pub references: Vec<ReferenceInfo>,
    /// The printed tables of every step.
    pub prints: Vec<Vec<Printed>>,
    /// Motions that nothing but contact can stop.
    pub held_by_contact: Vec<Unheld>,
    /// The case, every automatic choice replaced by what was chosen.
    pub case: Case,
    /// What is unusual.
    pub warnings: Diagnostics,
    /// What meets, where nobody names pairs.
    pub(crate) general: Option<General>,
    sets: BTreeMap<String, Vec<NodeId>>,
    by_label: BTreeMap<u64, NodeId>,
    /// Cells of bodies of revolution.
    pub(crate) revolving: BTreeSet<CellId>,
    /// Those of them around nodes whose forces are printed.
    pub(crate) hoops: Vec<CellId>,
}

impl Model {
    /// The nodes of a set or group.
    #[must_use]
    pub fn nodes_of(&self, set: &str) -> Option<Vec<NodeId>> {
        self.sets.get(set).cloned()
    }

    /// Bodies with their remedies against locking: `block: b-bar`; none where nothing is done.
    #[must_use]
    pub fn remedies(&self) -> Vec<String> {
        let by_body = bodies::by_body(&self.locking);
        let remedy = |body| {
            let name = bodies::name(body);
            let mut words: Vec<String> = Vec::new();
            let of_body = by_body.get(&*name).into_iter().flatten();
            for one in of_body.filter(|one| one.locking != Locking::None) {
                let word = one.locking.to_string();
                if !words.contains(&word) {
                    words.push(word);
                }
            }
            (!words.is_empty()).then(|| format!("{name}: {}", words.join(" and ")))
        };
        self.case.bodies.iter().filter_map(remedy).collect()
    }

    /// The node of this number in the input.
    #[must_use]
    pub fn node(&self, label: u64) -> Option<NodeId> {
        self.by_label.get(&label).copied()
    }
}

/// Builds the model of a case with its mesh.
///
/// # Errors
/// As [`build_with`], and a case that names physics of the program.
pub fn build(case: Case, mesh: Mesh) -> Result<Model, Diagnostics> {
    build_with(case, mesh, &Own::default())
}

/// Builds the model of a case with its mesh, and with what the program brings for it.
///
/// # Errors
/// Names that the program does not have; names that the mesh does not have, sets of the wrong kind, and what makes no well-posed model: all messages at once
/// as far as they do not follow from each other.
pub fn build_with(case: Case, mesh: Mesh, own: &Own) -> Result<Model, Diagnostics> {
    build_in_words(case, mesh, own, None)
}

impl Model {
    /// The same model with contact of these pairs, in place of those that were found at the start.
    ///
    /// # Errors
    /// As [`build_with`]; pairs of another model.
    pub(crate) fn with_pairs(&self, pairs: &[Pair]) -> Result<Self, Diagnostics> {
        let Some(origin) = self.general.as_ref().map(|general| &general.origin) else {
            let message = "pairs that were found belong to a case with  all = true";
            return Err(Diagnostic::error(&codes::CANNOT_RESUME, message).into());
        };
        let Origin { case, mesh, own } = origin.clone();
        let mut model = build_in_words(case, Mesh::clone(&mesh), &own, Some(pairs))?;
        model.name.clone_from(&self.name);
        Ok(model)
    }
}

/// Builds a model, with messages in the words of what the case was read from.
fn build_in_words(
    case: Case,
    mesh: Mesh,
    own: &Own,
    pairs: Option<&[Pair]>,
) -> Result<Model, Diagnostics> {
    if !deck::is_of_deck(&case) {
        return build_of(case, mesh, own, pairs);
    }
    let mut model = build_of(case, mesh, own, pairs).map_err(deck::in_words)?;
    model.warnings = deck::in_words(std::mem::take(&mut model.warnings));
    Ok(model)
}

fn build_of(
    mut case: Case,
    mesh: Mesh,
    own: &Own,
    pairs: Option<&[Pair]>,
) -> Result<Model, Diagnostics> {
    let mut found = Diagnostics::new();
    own::check(&case, own, &mut found);
    // what is lacking draws other messages after it
    if found.has_errors() {
        return Err(found);
    }
    let origin = Origin::new(&case, &mesh, own);
    let (mut mesh, shells, mut found) = shells::expanded(&case, mesh, found)?;
    let cuts = Cuts::new(&case, &mut mesh, &mut found);
    let mut names = Names::new(&case, &mesh, &shells, &mut found);
    let carriers = Carriers::new(&case, &names, &mut found);
    let settings = settings::settings(&case.solver, &mut found);
    let prints = prints::prints(&case, &names, &mut found);
    let cycles = cycles::cycles(&case, &mut found);
    let places = (&names, &carriers, &cuts);
    let (mut parts, start) = match parts(&case, &mesh, own, places, &mut found) {
        Some(parts) if !found.has_errors() => parts,
        _ => return Err(found),
    };
    let places = (&names, &cuts);
    let general = find(&case, places, &parts, (origin, pairs), &mut found);
    if let Some(general) = &general {
        general.hand_over(&mut case, &mut names);
        let surfaces = Surfaces::new(&case, &mesh, &carriers, own, &mut found);
        parts.contacts = contact::contacts(&case, &names, &surfaces, own, &mut found);
    }
    if found.has_errors() {
        return Err(found);
    }
    case.initial_temperature = start.map(Spanned::from);
    let left_out = bodies::left_out(&case, &names, &mesh, &parts.bodies);
    let mut model = match signorini_mechanics::model::Model::assemble(parts) {
        Ok(model) => model,
        Err(error) => {
            let notes = gaps::where_too_deep(&error, &mesh);
            let refused = refused::refused(&case, &error);
            found.push(notes.into_iter().fold(refused, |one, note| one.note(note)));
            return Err(found);
        }
    };
    let (wanted, hoops) = prints::wanted(&prints, &mesh, &case, &names);
    model.system.wanted = wanted;
    let solids = mesh.cells(case.model.space.ndim());
    let revolves = |cell: &CellId| names.plane(*cell) == Idealisation::Axisymmetric;
    let revolving = solids.filter(revolves).collect();
    found.append(bodies::stiff_elements(&case, &names, &mesh));
    left_out.into_iter().for_each(|one| found.push(one));
    let contacts = info::contacts(&case, &model.contacts);
    let stabilized = case.solver.stabilize == Stabilize::Auto;
    let sets = names.node_sets();
    let unheld = &model.held_by_contact;
    let held = held::by_contact(unheld, &contacts, (&case, &mesh), &sets, stabilized);
    held.into_iter().for_each(|one| found.push(one));
    if found.has_errors() {
        return Err(found);
    }
    found.append(contact::sharing(&case, &model.contacts, &names));
    found.append(gaps::findings(&case, &mesh, &contacts));
    found.append(process_zones::findings(&case, &contacts));
    let of_steps = (&model.system.layout, &model.steps[..]);
    found.append(fourier::findings(&case, (&names, &mesh), of_steps));
    let allowed: Vec<&str> = case.allow.iter().map(String::as_str).collect();
    found.silence(&allowed);
    choices::choose(&mut case, &carriers, &model.contacts, &model.locking);
    let labels = mesh.node_labels.iter().enumerate();
    let by_label = labels
        .map(|(node, &label)| (label, node as NodeId))
        .collect();
    let references = carriers.infos();
    drop(names);
    // gaps that are closed at the start move nodes
    mesh.points.clone_from_slice(&model.system.reference);
    Ok(Model {
        name: String::from("case"),
        system: model.system,
        steps: model.steps,
        cycles,
        settings,
        contacts,
        locking: model.locking,
        references,
        prints,
        held_by_contact: model.held_by_contact,
        case,
        warnings: found,
        sets,
        by_label,
        revolving,
        hoops,
        general,
        mesh: Arc::new(mesh),
    })
}

/// What meets where nobody names pairs: these pairs, or what is found at the start.
fn find(
    case: &Case,
    (names, cuts): (&Names<'_>, &Cuts),
    parts: &Parts<'_>,
    (origin, pairs): (Option<Origin>, Option<&[Pair]>),
    found: &mut Diagnostics,
) -> Option<General> {
    let (settings, origin) = case.general.as_ref().zip(origin)?;
    let cut: Vec<(NodeId, NodeId)> = cuts.pairs().collect();
    let source = &Source {
        case,
        mesh: parts.mesh,
        names,
        bodies: &parts.bodies,
        steps: &parts.steps,
        cut: &cut,
    };
    let mut general = General::new(settings, source, origin, found)?;
    match pairs {
        None => general.start(&parts.mesh.points),
        Some(pairs) if general.take(pairs) => {}
        Some(_) => {
            let message = "the contacts that were found are those of another model";
            found.push(Diagnostic::error(&codes::CANNOT_RESUME, message));
        }
    }
    Some(general)
}

/// What a model is made of but for contacts that are found, and the temperature at the start; nothing where faults leave none
/// of it.
fn parts<'a>(
    case: &Case,
    mesh: &'a Mesh,
    own: &Own,
    (names, carriers, cuts): (&Names<'_>, &Carriers, &Cuts),
    found: &mut Diagnostics,
) -> Option<(Parts<'a>, Option<f64>)> {
    if let Some(message) = mesh::unfit(case, mesh) {
        found.push(message);
        return None;
    }
    let mut parts = Parts::new(mesh, idealisation(&case.model));
    parts.bodies = bodies::bodies(case, names, carriers, own, found);
    parts.directors = names.shells().parts();
    parts.carriers = carriers.parts();
    parts.springs = constraints::springs(case, names, found);
    parts.constraints = constraints::constraints(case, names, carriers, cuts, found);
    let joints = names.shells().joints();
    let joints = joints.constraints(carriers.first_of_joints());
    parts.constraints.extend(joints);
    let newton = &case.solver.newton;
    parts.gap_tol = newton.gap_tol;
    parts.traction_tol = parts.traction_tol.max(0.1 * newton.force_tol);
    parts.stabilize = case.solver.stabilize == Stabilize::Auto;
    parts.hold_free = case.solver.free_motions == FreeMotions::Hold;
    let surfaces = Surfaces::new(case, mesh, carriers, own, found);
    parts.contacts = contact::contacts(case, names, &surfaces, own, found);
    let (temperature, start) = temperature::at_start(case, names, mesh, found);
    parts.temperature = temperature;
    parts.radiation = heat::radiation(case);
    heat::refuse_cuts(case, found);
    let steps = steps::Builder {
        case,
        names,
        carriers,
        own,
        bodies: &parts.bodies,
        amplitudes: (case.amplitudes.iter().map(|one| (one.name.as_str(), one))).collect(),
    };
    let (steps, couplings) = steps.steps(found);
    parts.steps = steps;
    motion::velocities(case, (names, carriers), mesh, &mut parts, found);
    cuts.moves(&mut parts.velocity);
    motion::masses(case, (names, carriers), &mut parts, found);
    for step in &mut parts.steps {
        cuts.warm(&mut step.temperatures);
    }
    parts.constraints.extend(couplings);
    Some((parts, start))
}
