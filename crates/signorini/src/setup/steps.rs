//! Steps: supports, motions, loads, contacts, temperatures, as changes of what earlier steps leave behind.

pub(super) use super::carriers::idle;

use super::carriers::Carriers;
use super::contact::Changes;
use super::heat;
use super::loads::{self, Coupling};
use super::names::Names;
use super::nonlinear::nonlinear;
use super::quoted;
use super::shells::Rotations;
use crate::own::Own;
use signorini_geometry::mesh::{CellId, NodeId};
use signorini_io::case::{
    self, Amplitude, Case, Directions, DynamicMethod, Factor, GlobalModel, Name, Remedy, Step,
    StrainAt, TimeBase,
};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Place, Severity, codes};
use signorini_mechanics::load::Course;
use signorini_mechanics::model::{
    ActivityPart, BodyPart, Change, ConstraintPart, ControlPart, LoadPart, StepPart, Target,
};
use signorini_mechanics::solve::{Increments, Motion, Vibration};
use signorini_mechanics::system::{CellChange, Leapfrog, MassScaling, Scheme, TimeFunction};
use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;

/// Steps, with what earlier ones leave behind.
pub(super) struct Builder<'a> {
    pub case: &'a Case,
    pub names: &'a Names<'a>,
    pub carriers: &'a Carriers,
    pub own: &'a Own,
    pub bodies: &'a [BodyPart],
    /// Amplitudes by their names.
    pub amplitudes: BTreeMap<&'a str, &'a Amplitude>,
}

impl Builder<'_> {
    /// The steps, and the constraints by which loads keep what they act on together.
    pub fn steps(&self, found: &mut Diagnostics) -> (Vec<StepPart>, Vec<ConstraintPart>) {
        let mut goes_on = false;
        let mut couplings = Vec::new();
        let mut rotations = Rotations::default();
        let mut contacts = Changes::new(self.case, self.own);
        let mut steps = Vec::new();
        let owned = self.owned();
        let cases = &self.case.steps;
        for (number, (step, nonlinear)) in cases.iter().zip(nonlinear(cases)).enumerate() {
            let part = StepPart {
                name: step.name.value.clone(),
                duration: step.duration,
                increments: increments(&step.increments, step.duration, self.may_cut()),
                nonlinear,
                scheme: self.scheme(step, found),
                control: step.dynamics.as_ref().and_then(|of| control(step, of)),
                vibration: self.vibration(step, found),
                physics: heat::physics(step),
                changes: self.changes((number, step), &mut rotations, found),
                loads: self.loads((number, nonlinear), step, &mut couplings, found),
                contacts: contacts.of(step, found),
                temperatures: self.temperatures(step, found),
                freed_temperatures: self.freed_temperatures(step, found),
                activity: self.activity(step, &owned, found),
            };
            let motions = part.changes.len() + part.temperatures.len() + part.activity.len();
            let changes = motions + part.loads.len() + step.contacts.len();
            // overlaps at the start are resolved in the first step
            let has_contact = !self.case.contacts.is_empty() || self.case.general.is_some();
            let moves =
                part.scheme.is_some() || part.vibration.is_some() || part.physics.has_heat();
            let begins = number == 0 && has_contact || moves;
            if changes == 0 && !begins && !goes_on && !found.has_errors() {
                found.push(changes_nothing(step));
            }
            goes_on |= part.changes.iter().any(runs_on)
                || part.temperatures.iter().any(|(_, course)| course.goes_on())
                || part.loads.iter().any(|load| load.course.goes_on());
            steps.push(part);
        }
        let couplings = couplings.into_iter().map(Coupling::part);
        (
            steps,
            couplings
                .chain(rotations.parts(self.names.shells()))
                .collect(),
        )
    }

    /// The method of a dynamic step.
    fn scheme(&self, step: &Step, found: &mut Diagnostics) -> Option<Scheme> {
        let dynamics = step.dynamics.as_ref()?;
        if *dynamics.redistributed && self.case.general.is_some() {
            let message = "masses are redistributed at contacts that are named";
            found.push(
                Diagnostic::error(&codes::NOT_BUILT, message)
                    .at(
                        &dynamics.redistributed.place,
                        "not where `all` finds contacts",
                    )
                    .help("name the pairs; or  contact_mass = \"as-is\""),
            );
        }
        self.keeps_elements("dynamic", found);
        let scheme = match dynamics.method {
            DynamicMethod::GeneralizedAlpha(radius) => Scheme::generalized_alpha(radius),
            DynamicMethod::HilberHughesTaylor(alpha) => Scheme::hilber_hughes_taylor(alpha),
            DynamicMethod::EnergyMomentum => Scheme::energy_momentum(),
            DynamicMethod::Explicit { safety, scaling } => Scheme::explicit(Leapfrog {
                safety,
                scaling: scaling.map(|of| MassScaling {
                    step: of.step,
                    limit: of.limit,
                }),
            }),
        };
        Some(Scheme {
            redistributed: *dynamics.redistributed,
            weighted: dynamics.weighted,
            ..scheme
        })
    }

    /// The modes of a frequency step.
    fn vibration(&self, step: &Step, found: &mut Diagnostics) -> Option<Vibration> {
        let wanted = step.frequency.as_ref()?;
        self.keeps_elements("a frequency step", found);
        Some(Vibration {
            count: usize::try_from(wanted.modes).unwrap_or(usize::MAX),
            from: wanted.lower.filter(|lower| *lower > 0.0),
            to: wanted.upper,
        })
    }

    /// Masses are those of all elements.
    fn keeps_elements(&self, kind: &str, found: &mut Diagnostics) {
        let mut steps = self.case.steps.iter();
        let changed = steps.find_map(|step| {
            let added = step.activations.first().map(|one| &one.place);
            added.or_else(|| step.deactivations.first().map(|one| &one.place))
        });
        if let Some(place) = changed {
            let message = format!("elements are neither removed nor added where a step is {kind}");
            found.push(
                Diagnostic::error(&codes::NOT_BUILT, message)
                    .at(place, "their mass would stay")
                    .help("delete it, or make all steps static"),
            );
        }
    }

    fn changes(
        &self,
        (number, step): (usize, &Step),
        rotations: &mut Rotations,
        found: &mut Diagnostics,
    ) -> Vec<Change> {
        let mut changes = Vec::new();
        for free in &step.frees {
            let turns = !free.rot.is_empty();
            if free.u.is_empty() && !turns {
                continue;
            }
            let components = picked(&free.u, &free.rot);
            for target in self.targets(&free.on, turns, &free.place, found) {
                let components = of_target(&target, &components, |c| *c);
                changes.push(Change::Release(target, components));
            }
        }
        for fix in &step.fixes {
            let turns = !fix.rot.is_empty() && !self.holds_rotations(number, fix, rotations, found);
            let components = picked(&fix.u, &fix.rot);
            for target in self.targets(&fix.on, turns, &fix.place, found) {
                let motions = of_target(&target, &components, |c| *c).into_iter();
                let motions = motions.map(|c| (c, Motion::Hold)).collect();
                changes.push(Change::Prescribe(target, motions));
            }
        }
        for part in &step.moves {
            let turns = part.rot.iter().any(Option::is_some);
            if let Some(from) = &part.from {
                changes.extend(from_global(from, step.duration, &part.place, found));
                continue;
            }
            let courses = part.u.iter().chain(&part.rot).enumerate();
            let motions = courses.filter_map(|(c, m)| Some((c, self.motion(step, m.as_ref()?))));
            let motions: Vec<(usize, Motion)> = motions.collect();
            for target in self.targets(&part.on, turns, &part.place, found) {
                let motions = of_target(&target, &motions, |motion| motion.0);
                changes.push(Change::Prescribe(target, motions));
            }
        }
        changes
    }

    /// Holds rotations of nodes of shells, from the first step on; false where a support is of something else.
    fn holds_rotations(
        &self,
        step: usize,
        fix: &case::Fix,
        rotations: &mut Rotations,
        found: &mut Diagnostics,
    ) -> bool {
        let shells = self.names.shells();
        if fix.rot.is_empty() || shells.is_empty() || self.carriers.get(&fix.on).is_some() {
            return false;
        }
        // names that are not there are reported where displacements are held
        let nodes = self.names.nodes(&fix.on, &mut Diagnostics::new());
        let mut nodes = nodes.unwrap_or_default();
        shells.add_between(&mut nodes);
        nodes.retain(|node| shells.joints().frame_of(*node, 0).is_none());
        if nodes
            .iter()
            .any(|&node| shells.directors_at(node).is_empty())
        {
            return false;
        }
        let about = fix.rot.xyz;
        if step > 0 && !nodes.iter().all(|&node| rotations.holds(node, about)) {
            let text = "rotations of shells that are held from a later step on";
            let one = Diagnostic::error(&codes::NOT_BUILT, text);
            found.push(one.at(&fix.place, "hold them from the first step on"));
        }
        rotations.hold(&nodes, about, &fix.on);
        true
    }

    fn loads(
        &self,
        (number, nonlinear): (usize, bool),
        step: &Step,
        couplings: &mut Vec<Coupling>,
        found: &mut Diagnostics,
    ) -> Vec<LoadPart> {
        let mut parts = Vec::new();
        for (place, load) in step.loads.iter().enumerate() {
            let context = loads::Context {
                case: self.case,
                names: self.names,
                carriers: self.carriers,
                bodies: self.bodies,
                nonlinear,
            };
            for (number, acting) in context.load(load, found).into_iter().enumerate() {
                let name = loads::name(step, place, load);
                parts.push(LoadPart {
                    name: match number {
                        0 => name,
                        _ => format!("{name} of masses"),
                    },
                    load: acting,
                    course: self.course(step, &load.course),
                });
            }
            if let Some(coupling) = context.coupling(load, found) {
                coupling.join(number == 0, couplings, found);
            }
        }
        parts
    }

    fn temperatures(&self, step: &Step, found: &mut Diagnostics) -> Vec<(NodeId, Motion)> {
        let mut temperatures = Vec::new();
        for part in &step.temperatures {
            let course = match (&part.value, step.thermal) {
                (course, Some(_)) => self.motion(step, course),
                (case::Motion::Ramp(to), None) => Motion::Ramp(*to),
                (_, None) => {
                    let text = "a temperature has a course in a step that does not solve for heat";
                    let one = Diagnostic::error(&codes::NOT_BUILT, text).at(&part.place, "");
                    let help = "write a number, which is reached linearly; or  kind = \"coupled\"";
                    found.push(one.help(help));
                    continue;
                }
            };
            let nodes = self.names.nodes(&part.on, found).unwrap_or_default();
            let gradient = part
                .gradient
                .as_ref()
                .map_or(0.0, |gradient| gradient.value);
            temperatures.extend(
                nodes
                    .into_iter()
                    .map(|node| (node, course.clone(), gradient)),
            );
        }
        if let Some(all) = self.names.shells().spread_courses(temperatures) {
            return all;
        }
        let text = "a temperature of shells with a course that is no number changes from node to node, or along the normal";
        let place = step.temperatures.first().map(|one| &one.place);
        let one = Diagnostic::error(&codes::NOT_BUILT, text);
        found.push(match place {
            Some(place) => one.at(place, "write numbers, which are reached linearly"),
            None => one,
        });
        Vec::new()
    }

    /// Nodes whose temperatures are set free.
    fn freed_temperatures(&self, step: &Step, found: &mut Diagnostics) -> Vec<NodeId> {
        let freed = step.frees.iter().filter(|free| free.temperature);
        let nodes = freed.filter_map(|free| self.names.nodes(&free.on, found));
        let nodes = nodes.flatten().map(|node| (node, Motion::Hold, 0.0));
        let all = self.names.shells().spread_courses(nodes.collect());
        let nodes = all.into_iter().flatten();
        nodes.map(|(node, _)| node).collect()
    }

    /// The cells of bodies, where steps ask for them.
    fn owned(&self) -> HashSet<CellId> {
        let mut steps = self.case.steps.iter();
        if steps.all(|step| step.activations.is_empty() && step.deactivations.is_empty()) {
            return HashSet::new();
        }
        let cells = self.bodies.iter().flat_map(|body| &body.cells);
        cells.copied().collect()
    }

    /// Elements that are removed and added.
    fn activity(
        &self,
        step: &Step,
        owned: &HashSet<CellId>,
        found: &mut Diagnostics,
    ) -> Vec<ActivityPart> {
        let added = step.activations.iter().map(|one| {
            let strain_free = one.strain == StrainAt::Free;
            (&one.group, CellChange::Added { strain_free })
        });
        let removed = step.deactivations.iter().map(|one| {
            let ramp = one.ramp;
            (&one.group, CellChange::Removed { ramp })
        });
        let mut parts = Vec::new();
        for (group, change) in removed.chain(added) {
            let Some(mut cells) = self.names.cells_of(group, found) else {
                continue;
            };
            cells.retain(|cell| owned.contains(cell));
            if cells.is_empty() {
                let text = format!("{} has no elements of a body", quoted(group));
                let one = Diagnostic::error(&codes::WRONG_KIND, text);
                found.push(one.at(&group.place, "elements of bodies are removed and added"));
                continue;
            }
            parts.push(ActivityPart { cells, change });
        }
        parts
    }

    /// Whether an increment that fails may be tried again in smaller pieces.
    fn may_cut(&self) -> bool {
        self.case.solver.on_trouble.contains(&Remedy::Cut)
    }

    /// What a support or motion is applied to: nodes, which cannot turn where `turns` asks for it, and the frames of joints of shells.
    fn targets(
        &self,
        on: &Name,
        turns: bool,
        place: &Place,
        found: &mut Diagnostics,
    ) -> Vec<Target> {
        if let Some(carrier) = self.carriers.get(on) {
            if !self.carriers.moves_something(carrier) {
                found.push(idle(on));
            }
            return vec![Target::Rigid(carrier)];
        }
        let mut nodes = self.names.nodes(on, found).unwrap_or_default();
        self.names.shells().add_between(&mut nodes);
        let frame = |node: &NodeId| {
            let joints = self.names.shells().joints();
            joints.frame_of(*node, self.carriers.first_of_joints())
        };
        let mut targets: Vec<Target> = nodes.iter().filter_map(frame).map(Target::Rigid).collect();
        nodes.retain(|node| frame(node).is_none());
        if turns && !nodes.is_empty() {
            found.push(no_rotations(on, place));
        }
        if !nodes.is_empty() {
            targets.insert(0, Target::Nodes(nodes));
        }
        targets
    }

    fn amplitude(&self, name: &Name) -> Option<&Amplitude> {
        self.amplitudes.get(name.value.as_str()).copied()
    }

    fn motion(&self, step: &Step, course: &case::Motion) -> Motion {
        match course {
            // at once, as in other programs
            case::Motion::Ramp(to) if acts_at_once(step) => Motion::Table(vec![[0.0, *to]]),
            case::Motion::Ramp(to) => Motion::Ramp(*to),
            case::Motion::Table(table) => Motion::Table(table.clone()),
            case::Motion::Amplitude { name, value } => {
                let amplitude = self.amplitude(name);
                amplitude.map_or(Motion::Hold, |a| self.scaled(a, *value))
            }
        }
    }

    fn course(&self, step: &Step, course: &case::Course) -> Course {
        match course {
            case::Course::Ramp if acts_at_once(step) => Course::Table(vec![[0.0, 1.0]]),
            case::Course::Ramp => Course::Ramp,
            case::Course::Table(table) => Course::Table(table.clone()),
            case::Course::Amplitude(name) => {
                let amplitude = self.amplitude(name);
                amplitude.map_or(Course::Ramp, |a| self.factor(a))
            }
        }
    }

    /// What an amplitude makes of a load.
    fn factor(&self, amplitude: &Amplitude) -> Course {
        match (&amplitude.factor, amplitude.time) {
            (Factor::Table(table), TimeBase::Step) => Course::Table(table.clone()),
            (Factor::Table(table), TimeBase::Total) => Course::TotalTable(table.clone()),
            (Factor::Own(name), time) => match (self.function(name), time) {
                (None, _) => Course::Ramp,
                (Some(function), TimeBase::Step) => Course::Function(function),
                (Some(function), TimeBase::Total) => Course::TotalFunction(function),
            },
        }
    }

    /// The motion that is an amplitude times a factor.
    fn scaled(&self, amplitude: &Amplitude, factor: f64) -> Motion {
        match &amplitude.factor {
            Factor::Table(table) => {
                let rows = table.iter().map(|[t, v]| [*t, v * factor]).collect();
                match amplitude.time {
                    TimeBase::Step => Motion::Table(rows),
                    TimeBase::Total => Motion::TotalTable(rows),
                }
            }
            Factor::Own(name) => {
                let function = self.function(name).map(|one| one.times(factor));
                match (function, amplitude.time) {
                    (None, _) => Motion::Hold,
                    (Some(function), TimeBase::Step) => Motion::Function(function),
                    (Some(function), TimeBase::Total) => Motion::TotalFunction(function),
                }
            }
        }
    }

    /// The function of time that the program has under this name; where it has none, that was reported.
    fn function(&self, name: &Name) -> Option<TimeFunction> {
        let function = self.own.courses.get(&name.value);
        function.map(|one| TimeFunction::from(Arc::clone(one)))
    }
}

/// Whether loads and motions of a step act at once, as in other programs: where time is more than an order.
fn acts_at_once(step: &Step) -> bool {
    step.dynamics.is_some() || step.thermal.is_some_and(|thermal| thermal.transient)
}

/// What another model prescribes: to each node its own displacement.
fn from_global(
    from: &GlobalModel,
    duration: f64,
    place: &Place,
    found: &mut Diagnostics,
) -> Vec<Change> {
    let Some(values) = &from.values else {
        let text = format!("{} has not been read", from.file.value.display());
        let one = Diagnostic::error(&codes::UNREADABLE, text).at(place, "");
        found.push(one.help("read the case from its file: signorini::load"));
        return Vec::new();
    };
    let of_node = |&(node, u): &(NodeId, [f64; 3])| {
        let axes = from.u.xyz.iter().zip(u).enumerate();
        let given = axes.filter(|(_, (is_given, _))| **is_given);
        let motions = given.map(|(axis, (_, value))| match from.ramp {
            true => (axis, Motion::Ramp(value)),
            false => (axis, Motion::Table(vec![[0.0, value], [duration, value]])),
        });
        Change::Prescribe(Target::Nodes(vec![node]), motions.collect())
    };
    values.iter().map(of_node).collect()
}

fn changes_nothing(step: &Step) -> Diagnostic {
    Diagnostic::new(
        Severity::Note,
        &codes::NO_EFFECT,
        format!("step {} changes nothing", quoted(&step.name)),
    )
    .at(
        &step.place,
        "all supports, loads and contacts stay as they are",
    )
}

/// Whether a motion goes on through later steps.
fn runs_on(change: &Change) -> bool {
    match change {
        Change::Prescribe(_, motions) => motions.iter().any(|(_, motion)| motion.goes_on()),
        Change::Release(..) => false,
    }
}

/// The message on rotations of nodes that have none.
fn no_rotations(on: &Name, place: &Place) -> Diagnostic {
    let text = format!("the nodes of {} have no rotations", quoted(on));
    let one = Diagnostic::error(&codes::WRONG_KIND, text).at(place, "nodes of solids only move");
    one.help(
        "leave the rotations away; or tie the nodes to a [reference] by a kinematic [[constraint]], and name the reference here",
    )
}

/// Those components that a target has: nodes do not turn.
fn of_target<T: Clone>(target: &Target, all: &[T], component: impl Fn(&T) -> usize) -> Vec<T> {
    let has = |one: &&T| matches!(target, Target::Rigid(_)) || component(one) < 3;
    all.iter().filter(has).cloned().collect()
}

fn picked(u: &Directions, rot: &Directions) -> Vec<usize> {
    let all = u.xyz.iter().chain(&rot.xyz).enumerate();
    all.filter_map(|(c, &on)| on.then_some(c)).collect()
}

fn increments(part: &case::Increments, duration: f64, may_cut: bool) -> Increments {
    let (initial, min, max, count_max) = match *part {
        case::Increments::Fixed(n) => return Increments::Fixed(n as usize),
        case::Increments::Count(n) => {
            let size = duration / n as f64;
            (size, 1e-5 * size, size, n.saturating_mul(100).max(1000))
        }
        case::Increments::Adaptive {
            initial,
            min,
            max,
            count_max,
        } => (initial, min, max, count_max),
    };
    Increments::Adaptive {
        initial,
        min: if may_cut { min } else { f64::INFINITY },
        max,
        count_max: count_max as usize,
    }
}

/// What limits the increments of a dynamic step; none where they are fixed.
fn control(step: &Step, dynamics: &case::Dynamics) -> Option<ControlPart> {
    let is_fixed = matches!(step.increments, case::Increments::Fixed(_));
    (!is_fixed).then_some(ControlPart {
        error_tol: dynamics.error_tol,
        impact_step: dynamics.impact_step,
    })
}
