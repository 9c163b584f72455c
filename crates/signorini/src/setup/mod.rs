//! From a case to a model: names become nodes, cells and faces; every fault becomes a message with its place.
//!
//! ```text
//! Case ──mesh──▶ Mesh ──names──▶ Parts ──mechanics::model──▶ Model
//! ```

mod bodies;
mod carriers;
mod constraints;
mod contact;
mod cuts;
pub(crate) mod gaps;
mod held;
mod loads;
mod mesh;
mod names;
mod prints;
mod refused;
mod steps;
mod surfaces;
mod temperature;
#[cfg(test)]
mod tests;

pub(crate) use held::{first_step, hold};
pub use mesh::{judge_mesh_of, read_mesh_of, read_surfaces_of};
pub use prints::{
    ContactQuantity, ElementQuantity, NodeQuantity, Printed, PrintedContact, PrintedOf,
};

use carriers::Carriers;
use cuts::Cuts;
use names::Names;
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::surface::RigidId;
use signorini_io::case::{
    self, Case, Enforcement, FreeMotions, HistorySource, Method, Per, Space, Stabilize,
};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Spanned, codes};
use signorini_linear::{LinearKind, SOLVERS};
use signorini_mechanics::contact::Measure;
use signorini_mechanics::model::{self, ContactSummary, LockingSummary, Parts, StartSummary};
use signorini_mechanics::solid::Locking;
use signorini_mechanics::solve::{LineSearch, NewtonSettings, Step, StepperSettings};
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
    /// The case, every automatic choice replaced by what was chosen.
    pub case: Case,
    /// What is unusual.
    pub warnings: Diagnostics,
    sets: BTreeMap<String, Vec<NodeId>>,
    by_label: BTreeMap<u64, NodeId>,
    /// Cells of bodies of revolution.
    pub(crate) revolving: BTreeSet<CellId>,
    /// Those of them around nodes whose forces are printed.
    pub(crate) hoops: Vec<CellId>,
}

/// What a contact became.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactInfo {
    /// Its name.
    pub name: String,
    /// The method in use.
    pub method: &'static str,
    /// Whether the program chose the method, and how penetration is prevented.
    pub automatic: bool,
    /// How penetration is prevented, in words.
    pub enforcement: String,
    /// How far its points slide, in words.
    pub sliding: &'static str,
    /// The penalty in use.
    pub penalty: f64,
    /// Whether the case gives it as a number.
    pub is_given: bool,
    /// What it refers to: `"node"` or `"area"`.
    pub per: &'static str,
    /// Points of the secondary side.
    pub npoint: usize,
    /// Facets of the primary side.
    pub nfacet: usize,
    /// Size of its facets.
    pub facet_size: f64,
    /// Gaps and overlaps at the start.
    pub start: StartSummary,
}

/// A reference or rigid body, as histories name it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReferenceInfo {
    /// Name of the reference, or of the group of the rigid body.
    pub name: String,
    /// Its number.
    pub rigid: RigidId,
}

impl Model {
    /// The nodes of a set or group.
    #[must_use]
    pub fn nodes_of(&self, set: &str) -> Option<Vec<NodeId>> {
        self.sets.get(set).cloned()
    }

    /// Bodies with what is done against locking in them: `block: b-bar`; none where nothing is done.
    #[must_use]
    pub fn remedies(&self) -> Vec<String> {
        let remedy = |body| {
            let name = bodies::name(body);
            let mut words: Vec<String> = Vec::new();
            for one in of_body(&self.locking, &name).filter(|l| l.locking != Locking::None) {
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
/// Names that the mesh does not have, sets of the wrong kind, and what makes no well-posed model: all messages at once
/// as far as they do not follow from each other.
pub fn build(mut case: Case, mut mesh: Mesh) -> Result<Model, Diagnostics> {
    let mut found = Diagnostics::new();
    let cuts = Cuts::new(&case, &mut mesh, &mut found);
    let names = Names::new(&case, &mesh, &mut found);
    let carriers = Carriers::new(&case, &names, &mut found);
    let settings = settings(&case.solver, &mut found);
    let prints = prints::prints(&case, &names, &mut found);
    let (parts, start) = match parts(&case, &mesh, &names, &carriers, &cuts, &mut found) {
        Some(parts) if !found.has_errors() => parts,
        _ => return Err(found),
    };
    case.initial_temperature = start.map(Spanned::from);
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
    if found.has_errors() {
        return Err(found);
    }
    found.append(bodies::stiff_elements(&case, &names, &mesh));
    let is_tied = |name: &str| {
        let mut tied = case.contacts.iter().filter(|one| one.tied.is_some());
        tied.any(|one| one.name.value == name)
    };
    let is_automatic = |name: &str| {
        let mut automatic = case.contacts.iter().filter(|one| {
            one.tied.is_none()
                && *one.method == Method::Auto
                && one.enforcement == Enforcement::Auto
        });
        automatic.any(|one| one.name.value == name)
    };
    let gives_penalty = |name: &str| {
        let mut contacts = case.contacts.iter();
        let own = contacts.find(|one| one.name.value == name);
        own.is_some_and(|one| matches!(one.enforcement, Enforcement::Penalty(Some(_))))
    };
    let contacts: Vec<ContactInfo> = model
        .contacts
        .iter()
        .map(|c| ContactInfo {
            name: c.name.clone(),
            method: contact::word(&c.method),
            automatic: is_automatic(&c.name),
            enforcement: contact::words(c),
            sliding: contact::range(c, is_tied(&c.name)),
            penalty: c.penalty,
            is_given: gives_penalty(&c.name),
            per: contact::per(c.measure),
            npoint: c.npoint,
            nfacet: c.nfacet,
            facet_size: c.facet_size,
            start: c.start,
        })
        .collect();
    let stabilized = case.solver.stabilize == Stabilize::Auto;
    let sets = names.node_sets();
    let unheld = &model.held_by_contact;
    let held = held::by_contact(unheld, &contacts, (&case, &mesh), &sets, stabilized);
    if let Some(one) = held {
        found.push(one);
    }
    if found.has_errors() {
        return Err(found);
    }
    found.append(gaps::findings(&case, &mesh, &contacts));
    let allowed: Vec<&str> = case.allow.iter().map(String::as_str).collect();
    found.silence(&allowed);
    choose(&mut case, &carriers, &model.contacts, &model.locking);
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
        settings,
        contacts,
        locking: model.locking,
        references,
        prints,
        case,
        warnings: found,
        sets,
        by_label,
        revolving,
        hoops,
        mesh: Arc::new(mesh),
    })
}

/// Everything a model is made of, and the temperature at the start; nothing where faults leave none of it.
fn parts<'a>(
    case: &Case,
    mesh: &'a Mesh,
    names: &Names<'_>,
    carriers: &Carriers,
    cuts: &Cuts,
    found: &mut Diagnostics,
) -> Option<(Parts<'a>, Option<f64>)> {
    if let Some(message) = mesh::unfit(case, mesh) {
        found.push(message);
        return None;
    }
    let mut parts = Parts::new(mesh, idealisation(&case.model));
    parts.bodies = bodies::bodies(case, names, carriers, found);
    parts.carriers = carriers.parts();
    parts.springs = constraints::springs(case, names, found);
    parts.constraints = constraints::constraints(case, names, carriers, cuts, found);
    let newton = &case.solver.newton;
    parts.gap_tol = newton.gap_tol;
    parts.traction_tol = parts.traction_tol.max(0.1 * newton.force_tol);
    parts.stabilize = case.solver.stabilize == Stabilize::Auto;
    parts.hold_free = case.solver.free_motions == FreeMotions::Hold;
    let surfaces = Surfaces::new(case, mesh, carriers, found);
    parts.contacts = contact::acting(case)
        .filter_map(|c| contact::contact(c, &case.steps, names, &surfaces, found))
        .collect();
    for contact in &mut parts.contacts {
        contact.smooths = case.output.smooth_pressures;
    }
    let (temperature, start) = temperature::at_start(case, names, mesh, found);
    parts.temperature = temperature;
    let steps = steps::Builder {
        case,
        names,
        carriers,
        bodies: &parts.bodies,
    };
    let (steps, couplings) = steps.steps(found);
    parts.steps = steps;
    for step in &mut parts.steps {
        cuts.warm(&mut step.temperatures);
    }
    parts.constraints.extend(couplings);
    Some((parts, start))
}

fn idealisation(model: &case::Model) -> Idealisation {
    standing_for(model.space.value, model.thickness)
}

/// What the plane of a body stands for, where it says something of its own.
fn own_idealisation(model: &case::Model, body: &case::Body) -> Option<Idealisation> {
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

/// Writes into the case what was chosen where it leaves a choice.
fn choose(
    case: &mut Case,
    carriers: &Carriers,
    contacts: &[ContactSummary],
    locking: &[LockingSummary],
) {
    for summary in contacts {
        let mut all = case.contacts.iter_mut();
        let Some(part) = all.find(|one| one.name.value == summary.name) else {
            continue;
        };
        if *part.method == Method::Auto {
            contact::choose(part, &summary.method);
        }
        contact::choose_sliding(part, summary);
        let chosen = Some(summary.penalty.into());
        match &mut part.enforcement {
            Enforcement::Augmented { penalty, .. } => *penalty = chosen,
            law @ (Enforcement::Auto | Enforcement::Penalty(_)) => {
                *law = match summary.enforcement {
                    model::Enforcement::Lagrange => Enforcement::Lagrange,
                    _ => Enforcement::Penalty(chosen),
                };
            }
            _ => {}
        }
        if part.enforcement != Enforcement::Lagrange {
            part.per = Some(match summary.measure {
                Measure::Area => Per::Area,
                Measure::Node => Per::Node,
            });
        }
        part.reach = Some(summary.reach);
    }
    for body in &mut case.bodies {
        let name = bodies::name(body);
        let mut chosen = of_body(locking, &name).map(|one| one.locking);
        // elements and sizes of strains that differ leave the choice to the program
        if let Some(first) = chosen.next().filter(|first| chosen.all(|c| c == *first)) {
            body.locking.value = bodies::locking_word(first);
        }
    }
    // a rigid body of several groups, or with a reference, has many names and one set of columns
    for history in &mut case.output.history {
        if let HistorySource::Reference(name) = &mut history.source
            && let Some(own) = carriers.called(name)
        {
            name.value = own.to_owned();
        }
    }
}

/// What was chosen for a body.
fn of_body<'a>(
    locking: &'a [LockingSummary],
    body: &str,
) -> impl Iterator<Item = &'a LockingSummary> {
    locking.iter().filter(move |one| one.body == body)
}

/// How many sizes of an increment fail before viscous forces help: where sizes come first, some.
fn stabilize_after(remedies: &[case::Remedy]) -> Option<usize> {
    let place = remedies.iter().position(|r| *r == case::Remedy::Stabilize);
    place.map(|before| if before == 0 { 0 } else { SIZES })
}

/// Sizes of an increment that fail before viscous forces help, where smaller ones are tried first.
const SIZES: usize = 1;

fn settings(solver: &case::Solver, found: &mut Diagnostics) -> StepperSettings {
    let newton = &solver.newton;
    StepperSettings {
        newton: NewtonSettings {
            max_iterations: newton.max_iterations as usize,
            force_tol: newton.force_tol,
            line_search: match newton.line_search {
                case::LineSearch::Off => LineSearch::Off,
                case::LineSearch::Auto | case::LineSearch::On => LineSearch::Auto,
            },
            hold_free: solver.free_motions == FreeMotions::Hold,
        },
        linear: linear(&solver.linear, found),
        stabilize_after: stabilize_after(&solver.on_trouble),
    }
}

/// The linear solver of that name, which not every build has.
fn linear(choice: &Spanned<case::LinearChoice>, found: &mut Diagnostics) -> LinearKind {
    let word = choice.word();
    match SOLVERS.iter().find(|solver| solver.name == word) {
        Some(solver) => solver.kind,
        None => {
            found.push(
                Diagnostic::error(
                    &codes::NOT_BUILT,
                    format!("`linear = \"{word}\"` needs a library that this program was built without"),
                )
                .at(&choice.place, "known, but not in this build")
                .note("with the library (Debian: libmumps-seq-dev):  cargo build --release --features mumps")
                .help("without it:  linear = \"direct\""),
            );
            LinearKind::default()
        }
    }
}

/// A name as written, for messages.
pub(crate) fn quoted(name: &Spanned<String>) -> String {
    format!("\"{}\"", name.value)
}
