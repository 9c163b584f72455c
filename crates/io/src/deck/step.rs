//! Steps: their time, supports and motions.
//!
//! What *BOUNDARY prescribes is the displacement at the end of the step, reached in a straight line from where the node
//! is. Zero is a support where nothing was moved before, a motion to zero elsewhere. Along local axes, three components
//! make a vector; fewer are equations, which hold for the whole run.

use super::axes::along;
use super::compat::Compat;
use super::heat::{PROCEDURES, TEMPERATURE};
use super::load::Loads;
use super::translation::{Target, Translation};
use crate::case::{
    ConstraintKind, Directions, Fix, Free, Geometry, Increments, Motion, Move, Name, Position,
    Reference, Step, Summand,
};
use crate::diagnostic::{Diagnostic, Place, Spanned, codes};
use crate::readers::inp::{Field, Kind, Statement, compared};
use std::collections::{BTreeMap, BTreeSet};

/// How often an explicit step that does not say so writes results.
const INTERVALS: u64 = 20;

/// The course of a component.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Course {
    /// Stays where it is.
    Stay,
    /// Reaches a value.
    To(f64, Option<Name>),
}

/// A line of *BOUNDARY, or several that differ in their nodes alone.
pub(super) struct Line {
    pub targets: Vec<Target>,
    /// Whether these are single nodes.
    single: bool,
    /// Components, from 0; a temperature comes after those of motions, and alone.
    components: Vec<usize>,
    pub course: Course,
    pub place: Place,
}

impl Line {
    fn is_of_heat(&self) -> bool {
        self.components.contains(&TEMPERATURE)
    }
}

/// What earlier steps leave behind.
#[derive(Default)]
pub(super) struct Standing {
    /// Components that are prescribed, and whether they have ever been moved.
    pub(super) held: BTreeMap<(Target, usize), bool>,
    /// Local components of nodes that equations hold.
    local: BTreeSet<(u64, usize)>,
    /// What is prescribed along all local axes of a node.
    along: BTreeMap<u64, [f64; 3]>,
    nonlinear: bool,
    pub loads: Loads,
    /// Temperatures that wait for a step that solves for them.
    cold: Vec<Line>,
    /// What steps have given temperatures to: by *BOUNDARY, and by *TEMPERATURE.
    pub warm: Vec<Name>,
    pub given: Vec<Name>,
}

impl Translation<'_> {
    pub fn steps(&mut self) {
        let deck = self.deck;
        let mut standing = Standing::default();
        let mut inside: Option<Vec<&Statement>> = None;
        let mut steps: Vec<Vec<&Statement>> = Vec::new();
        for card in &deck.statements {
            match card.keyword.as_str() {
                "STEP" => {
                    steps.extend(inside.take());
                    inside = Some(vec![card]);
                }
                "ENDSTEP" => steps.extend(inside.take()),
                _ => {
                    if let Some(cards) = &mut inside {
                        cards.push(card);
                    }
                }
            }
        }
        steps.extend(inside);
        if steps.is_empty() {
            let text = "the deck has no step: there is nothing to solve";
            let help = "write *STEP, *STATIC, *END STEP; or read its mesh in a case of your own";
            self.found
                .push(Diagnostic::error(&codes::MISSING, text).help(help));
        }
        for (number, cards) in steps.into_iter().enumerate() {
            let step = self.step(number, &cards, &mut standing);
            self.case.steps.push(step);
        }
    }

    fn step(&mut self, number: usize, cards: &[&Statement], standing: &mut Standing) -> Step {
        let head = cards.first().copied();
        let place = head.map_or_else(Place::nowhere, |card| card.place.clone());
        let name = self.fresh(&format!("step-{}", number + 1));
        if let Some(nonlinear) = head.and_then(|card| card.get("NLGEOM")) {
            standing.nonlinear = compared(nonlinear) != "NO";
        }
        let is_of_modes = |card: &&Statement| card.keyword == "FREQUENCY";
        if head.is_some_and(|card| card.has("PERTURBATION")) && !cards.iter().any(is_of_modes) {
            let text = "*STEP, PERTURBATION is supported with *FREQUENCY alone";
            self.error(&codes::NOT_BUILT, text, &place, "");
        }
        let name = Spanned::new(name, place.clone());
        let mut step = Step {
            geometry: if standing.nonlinear || self.bends {
                Geometry::Nonlinear
            } else {
                Geometry::Linear
            },
            ..Step::of_nothing(name, place.clone())
        };
        self.time(number, cards, &mut step);
        let mut lines = Vec::new();
        if number == 0 {
            self.free_rigid_bodies(&mut step);
            for card in self.cards("BOUNDARY") {
                self.boundary(card, &mut lines);
            }
        }
        let sudden = head.and_then(|card| card.get("AMPLITUDE")).map(compared);
        let sudden = sudden.as_deref() == Some("STEP");
        let mut fresh = BTreeSet::new();
        let mut change_of = None;
        for card in cards {
            // the first card of a kind may take back what earlier steps have prescribed
            let first = fresh.insert(card.keyword.as_str());
            let renews = first && card.get("OP").map(compared).as_deref() == Some("NEW");
            match card.keyword.as_str() {
                "BOUNDARY" => {
                    if renews {
                        self.release(standing, &mut step, &card.place);
                    }
                    if card.has("SUBMODEL") {
                        self.follow_global(card, sudden, standing, &mut step);
                        continue;
                    }
                    self.boundary(card, &mut lines);
                }
                "CLOAD" | "DLOAD" | "DSLOAD" | "CFLUX" | "DFLUX" | "DSFLUX" | "FILM" | "SFILM"
                | "RADIATE" | "SRADIATE" => {
                    self.load(card, renews, &mut standing.loads);
                }
                "TEMPERATURE" => self.temperatures(card, standing, &mut step),
                "PRESSUREPENETRATION" => self.penetration(card, &mut step),
                "MODELCHANGE" => self.model_change(card, &mut step),
                "CHANGESOLIDSECTION" => self.change_section(card, &mut step),
                "CHANGEFRICTION" | "CHANGESURFACEBEHAVIOR" => change_of = Some(*card),
                "FRICTION" => {
                    if let Some(of) = change_of.take() {
                        self.change_friction(of, card, &mut step);
                    }
                }
                "SURFACEBEHAVIOR" => {
                    if let Some(of) = change_of.take() {
                        self.change_behavior(of, card, &mut step);
                    }
                }
                "NODEPRINT" | "ELPRINT" | "CONTACTPRINT" | "SECTIONPRINT" => {
                    self.print(card, &mut step)
                }
                "REFINEMESH" => self.unrefined(card),
                _ => {}
            }
        }
        self.write_loads(&mut standing.loads, sudden, &mut step);
        let lines = self.without_replaced(lines);
        let (warm, lines): (Vec<_>, Vec<_>) = lines.into_iter().partition(Line::is_of_heat);
        standing.cold.extend(warm);
        if step.thermal.is_some() {
            let given = std::mem::take(&mut standing.given);
            self.free_temperatures(given, &mut step, &place);
            let lines = std::mem::take(&mut standing.cold);
            if number == 0 && self.compat == Compat::Ccx {
                self.start_with(&lines, &step);
            }
            self.hold_temperatures(lines, sudden, standing, &mut step);
        }
        self.prescribe(lines, number, sudden, standing, &mut step);
        self.still(&mut step);
        step
    }

    fn time(&mut self, number: usize, cards: &[&Statement], step: &mut Step) {
        let is_procedure = |keyword: &str| {
            ["STATIC", "DYNAMIC", "FREQUENCY"].contains(&keyword) || PROCEDURES.contains(&keyword)
        };
        let Some(card) = cards.iter().find(|c| is_procedure(&c.keyword)) else {
            let known = ["COMPLEXFREQUENCY", "VISCO"];
            // those are reported by their keyword
            if !cards
                .iter()
                .any(|c| known.iter().any(|k| c.keyword.starts_with(k)))
            {
                let text = "this step has no procedure";
                self.error(&codes::MISSING, text, &step.place, "write *STATIC");
            }
            return;
        };
        if card.keyword == "FREQUENCY" {
            self.natural_frequencies(number, cards, card, step);
            return;
        }
        let Some([initial, period, least, most]) = self.times(card) else {
            return;
        };
        step.duration = period;
        step.thermal = self.thermal(card, cards.first().copied());
        if card.keyword == "DYNAMIC" {
            self.dynamic(card, step);
        }
        let limit = cards.first().and_then(|head| head.get("INC")).map(compared);
        let limit = limit.and_then(|text| text.parse().ok()).unwrap_or(100);
        let is_explicit = card.keyword == "DYNAMIC" && card.has("EXPLICIT");
        step.increments = if is_explicit && self.first_time(card).is_none() {
            Increments::Fixed(INTERVALS)
        } else if is_explicit {
            // what is stable is shorter, as a rule
            Increments::Fixed((step.duration / initial).ceil().clamp(1.0, 1e6) as u64)
        } else if card.has("DIRECT") {
            let count = (step.duration / initial).round().clamp(1.0, 1e6);
            if (count * initial - step.duration).abs() > 1e-6 * step.duration {
                self.warn(
                    format!("{count} equal increments"),
                    &card.place,
                    "the increment is no whole part of the step",
                );
            }
            Increments::Fixed(count as u64)
        } else {
            Increments::Adaptive {
                initial,
                min: least,
                max: most,
                count_max: limit,
            }
        };
    }

    /// The first increment of a procedure, where it is given.
    fn first_time(&mut self, card: &Statement) -> Option<f64> {
        let row = card.rows().next().unwrap_or_default();
        let field = row.first().filter(|field| !field.text.is_empty())?;
        Some(self.real(Some(field))).filter(|time| *time > 0.0)
    }

    /// Rigid bodies of elements are free in decks until something holds them; in cases they are held.
    fn free_rigid_bodies(&mut self, step: &mut Step) {
        let components: &[usize] = match self.ndim() {
            3 => &[0, 1, 2, 3, 4, 5],
            _ => &[0, 1, 5],
        };
        let (u, rot) = directions(components);
        let rigid = self.case.bodies.iter().filter(|body| body.rigid);
        let references: BTreeSet<&str> = (rigid.clone())
            .filter_map(|body| body.reference.as_ref())
            .map(|name| name.value.as_str())
            .collect();
        for name in references {
            let mut of = rigid.clone().filter_map(|body| body.reference.as_ref());
            let Some(on) = of.find(|of| of.value == name).cloned() else {
                continue;
            };
            step.frees.push(Free {
                place: on.place.clone(),
                on,
                u,
                rot,
                temperature: false,
            });
        }
    }

    /// Initial increment, period, smallest and largest increment of a procedure; nothing where they contradict each other,
    /// which is reported.
    fn times(&mut self, card: &Statement) -> Option<[f64; 4]> {
        let row = card.rows().next().unwrap_or_default();
        let given = |at: usize| row.get(at).filter(|field| !field.text.is_empty());
        let names = [
            "initial increment",
            "period",
            "smallest increment",
            "largest increment",
        ];
        let mut is_sound = true;
        let mut values = [None; 4];
        for (at, (value, name)) in values.iter_mut().zip(names).enumerate() {
            let Some(field) = given(at) else { continue };
            // zero stands for the default, as an empty field does
            let number = self.real(Some(field));
            *value = (number > 0.0).then_some(number);
            if number < 0.0 {
                is_sound = false;
                let text = format!("the {name} of *{} is {}", card.title, field.text);
                let remark = "positive; left empty or zero it is chosen by the program";
                self.error(&codes::OUT_OF_RANGE, text, &field.place(), remark);
            }
        }
        if !is_sound {
            return None;
        }
        let [initial, period, least, most] = values;
        let period = period.unwrap_or(1.0);
        let largest = most.unwrap_or(period).min(period);
        let first = initial.unwrap_or(largest);
        let smallest = least.unwrap_or((1e-6 * period).min(first).min(largest));
        // a rounding of decimals is no contradiction
        let exceeds = |a: f64, b: f64| a > b * (1.0 + 1e-9);
        let limits = [
            (0, ("initial increment", first), ("period", period)),
            (2, ("smallest increment", smallest), ("initial one", first)),
            (
                2,
                ("smallest increment", smallest),
                ("largest one", largest),
            ),
        ];
        let wrong = limits
            .into_iter()
            .find(|(_, (_, a), (_, b))| exceeds(*a, *b));
        if let Some((at, (name, value), (other, limit))) = wrong {
            let text = format!(
                "the {name} of *{}, {value}, is larger than its {other}, {limit}",
                card.title
            );
            let place = given(at).map_or(card.place.clone(), Field::place);
            let remark = "initial increment, period, smallest, largest increment";
            self.error(&codes::CONTRADICTION, text, &place, remark);
            return None;
        }
        if exceeds(first, largest) {
            let text = format!(
                "the initial increment of *{} is reduced to its largest one, {largest}",
                card.title
            );
            self.note(text, &card.place);
        }
        let first = first.min(largest);
        Some([first, period, smallest.min(first), largest])
    }

    /// The lines of a card, those together that differ in single nodes alone.
    fn boundary(&mut self, card: &Statement, lines: &mut Vec<Line>) {
        let kind = card.get("TYPE").map(compared).unwrap_or_default();
        if !["", "DISPLACEMENT"].contains(&kind.as_str())
            || card.has("SUBMODEL")
            || card.has("USER")
        {
            let text = "*BOUNDARY of this type is not supported";
            let remark = match card.has("SUBMODEL") {
                true => "displacements of a global model are prescribed within steps",
                false => "displacements are",
            };
            self.error(&codes::NOT_BUILT, text, &card.place, remark);
            return;
        }
        let amplitude = self.amplitude(card);
        for row in card.rows() {
            let targets = self.targets(card, row.first(), Kind::Nodes);
            let place = row.first().map_or(card.place.clone(), Field::place);
            let (components, value) = match row.get(1).and_then(words) {
                Some(components) => (components.to_vec(), 0.0),
                None => {
                    let first = self.count(row.get(1), 0);
                    let last = self.count(row.get(2), first);
                    let of_heat = (first, last) == (11, 11) || (first, last) == (0, 0);
                    let all = match of_heat && self.solves_for_heat {
                        true => Some(vec![TEMPERATURE]),
                        false => components(first, last),
                    };
                    let Some(components) = all else {
                        if !(first == 11 || first == 8) {
                            let text = format!("there are no degrees of freedom {first} to {last}");
                            self.error(&codes::OUT_OF_RANGE, text, &place, "1 to 6");
                        }
                        continue;
                    };
                    (components, self.real(row.get(3)))
                }
            };
            let has_amplitude = value != 0.0 || components == [TEMPERATURE];
            let course = if card.has("FIXED") {
                Course::Stay
            } else {
                Course::To(value, amplitude.clone().filter(|_| has_amplitude))
            };
            let single = targets
                .iter()
                .all(|target| matches!(target, Target::One(_)));
            match lines.last_mut() {
                Some(last)
                    if single
                        && last.single
                        && last.components == components
                        && last.course == course =>
                {
                    last.targets.extend(targets);
                }
                _ => lines.push(Line {
                    targets,
                    single,
                    components,
                    course,
                    place,
                }),
            }
        }
    }

    /// Lines without what later ones prescribe otherwise at the same nodes: the last line counts, of the model or the step.
    fn without_replaced(&self, lines: Vec<Line>) -> Vec<Line> {
        let mut last: BTreeMap<(u64, usize), usize> = BTreeMap::new();
        for (number, line) in lines.iter().enumerate() {
            for label in line.targets.iter().flat_map(|target| self.labels(target)) {
                last.extend(line.components.iter().map(|&c| ((label, c), number)));
            }
        }
        let courses: Vec<Course> = lines.iter().map(|line| line.course.clone()).collect();
        let counts = |line: &Line, label: u64, component: usize| {
            let by = last.get(&(label, component)).and_then(|&k| courses.get(k));
            by.is_none_or(|course| *course == line.course)
        };
        let mut kept = Vec::new();
        for line in lines {
            let mut groups: BTreeMap<Vec<usize>, Vec<Target>> = BTreeMap::new();
            for target in &line.targets {
                let labels = self.labels(target);
                let counting = |&label: &u64| -> Vec<usize> {
                    let components = line.components.iter().copied();
                    components.filter(|&c| counts(&line, label, c)).collect()
                };
                if labels
                    .iter()
                    .all(|label| counting(label) == line.components)
                {
                    let whole = groups.entry(line.components.clone()).or_default();
                    whole.push(target.clone());
                    continue;
                }
                for label in labels {
                    let of_node = groups.entry(counting(&label)).or_default();
                    of_node.push(Target::One(label));
                }
            }
            let groups = groups
                .into_iter()
                .filter(|(components, _)| !components.is_empty());
            kept.extend(groups.map(|(components, targets)| Line {
                targets,
                single: line.single,
                components,
                course: line.course.clone(),
                place: line.place.clone(),
            }));
        }
        kept
    }

    /// Sets everything free that earlier steps have prescribed.
    fn release(&mut self, standing: &mut Standing, step: &mut Step, place: &Place) {
        if !standing.local.is_empty() {
            let text = "*BOUNDARY, OP=NEW where nodes are held along local axes is not supported";
            self.error(&codes::NOT_BUILT, text, place, "");
        }
        let warm = std::mem::take(&mut standing.warm);
        self.free_temperatures(warm, step, place);
        let mut by_target: BTreeMap<Target, Vec<usize>> = BTreeMap::new();
        for (target, component) in std::mem::take(&mut standing.held).into_keys() {
            by_target.entry(target).or_default().push(component);
        }
        for (target, components) in by_target {
            let (on, components) = self.carried(&[target], &components, place);
            let (u, rot) = directions(&components);
            step.frees.push(Free {
                on,
                u,
                rot,
                temperature: false,
                place: place.clone(),
            });
        }
    }

    /// What carries these targets, and the components that are meant of it.
    fn carried(
        &mut self,
        targets: &[Target],
        components: &[usize],
        place: &Place,
    ) -> (Name, Vec<usize>) {
        if let Some(carrier) = self.carrier_of(targets) {
            let shift = if carrier.turns { 3 } else { 0 };
            let name = Spanned::new(carrier.name.clone(), place.clone());
            return (name, components.iter().map(|c| c + shift).collect());
        }
        (self.named(targets, place), components.to_vec())
    }

    fn prescribe(
        &mut self,
        lines: Vec<Line>,
        number: usize,
        sudden: bool,
        standing: &mut Standing,
        step: &mut Step,
    ) {
        let mut local: BTreeMap<u64, [Option<(Course, Place)>; 3]> = BTreeMap::new();
        for line in lines {
            let turned = |this: &Self, target: &Target| {
                this.labels(target)
                    .iter()
                    .any(|label| this.axes.contains_key(label))
            };
            let (turned, plain): (Vec<_>, Vec<_>) = line
                .targets
                .iter()
                .cloned()
                .partition(|target| turned(self, target));
            let labels = turned.iter().flat_map(|target| self.labels(target));
            let (labels, others): (Vec<u64>, Vec<u64>) =
                labels.partition(|label| self.axes.contains_key(label));
            let turns = line.components.iter().any(|component| *component >= 3);
            self.no_local_rotations(&labels, turns, &line.place);
            for label in labels {
                let of_node = local.entry(label).or_default();
                for &component in line.components.iter().filter(|c| **c < 3) {
                    of_node[component] = Some((line.course.clone(), line.place.clone()));
                }
            }
            let mut targets = plain;
            targets.extend(others.into_iter().map(Target::One));
            // references are named one by one
            let is_carrier = |one: &Target| self.carrier_of(std::slice::from_ref(one)).is_some();
            let (carriers, nodes): (Vec<_>, Vec<_>) = targets.into_iter().partition(is_carrier);
            for carrier in carriers {
                self.set_course(&[carrier], &line, number, sudden, standing, step);
            }
            let parts = self.shells_apart(nodes, turns);
            for nodes in parts.iter().filter(|nodes| !nodes.is_empty()) {
                self.set_course(nodes, &line, number, sudden, standing, step);
            }
        }
        for (label, components) in local {
            self.set_local(label, components, sudden, standing, step);
        }
    }

    /// One support or motion of everything that a line names.
    fn set_course(
        &mut self,
        targets: &[Target],
        line: &Line,
        number: usize,
        sudden: bool,
        standing: &mut Standing,
        step: &mut Step,
    ) {
        let ndim = self.ndim();
        let (on, components) = self.carried(targets, &line.components, &line.place);
        // nodes of solids have no rotations; in a plane model nothing leaves the plane
        let is_carried = self.carrier_of(targets).is_some();
        let turns = is_carried || self.has_shell_nodes(targets);
        let is_there = |c: &usize| *c < ndim || turns && *c >= if ndim == 3 { 3 } else { 5 };
        let components: Vec<usize> = components.iter().copied().filter(is_there).collect();
        if components.is_empty() {
            return;
        }
        let keys = || {
            targets
                .iter()
                .flat_map(|t| line.components.iter().map(|c| (t.clone(), *c)))
        };
        let stays = match &line.course {
            Course::Stay => true,
            Course::To(value, _) => {
                let untouched = |key: &(Target, usize)| standing.held.get(key) == Some(&false);
                *value == 0.0 && (number == 0 || keys().all(|key| untouched(&key)))
            }
        };
        for key in keys() {
            let moved = standing.held.entry(key).or_default();
            *moved |= !stays;
        }
        if !stays && !is_carried && components.iter().any(|component| *component >= 3) {
            self.no_turning(&line.place);
            return;
        }
        if stays {
            let (u, rot) = directions(&components);
            step.fixes.push(Fix {
                on,
                u,
                rot,
                place: line.place.clone(),
            });
        } else if let Course::To(value, amplitude) = &line.course {
            let course = motion(*value, amplitude.as_ref(), sudden, step.duration);
            let mut part = Move {
                on,
                u: Default::default(),
                rot: Default::default(),
                from: None,
                place: line.place.clone(),
            };
            for component in components {
                let slots = part.u.iter_mut().chain(&mut part.rot);
                if let Some(slot) = slots.into_iter().nth(component) {
                    *slot = Some(course.clone());
                }
            }
            step.moves.push(part);
        }
    }

    /// What is prescribed along the local axes of a node.
    fn set_local(
        &mut self,
        label: u64,
        components: [Option<(Course, Place)>; 3],
        sudden: bool,
        standing: &mut Standing,
        step: &mut Step,
    ) {
        let Some(axes) = self.axes.get(&label).copied() else {
            return;
        };
        let ndim = self.ndim();
        let given = || components.iter().flatten();
        let Some(place) = given().next().map(|(_, place)| place.clone()) else {
            return;
        };
        // a motion prescribed along all three axes, and not repeated, stays
        let known = standing.along.get(&label).copied();
        let values: Vec<Option<f64>> = (components.iter().zip(0..))
            .map(|(one, axis)| match one {
                Some((Course::To(value, None), _)) => Some(*value),
                None => known.and_then(|values| values.get(axis).copied()),
                Some(_) => None,
            })
            .collect();
        let on = self.nodes_named(vec![label], &place);
        if let [Some(a), Some(b), Some(c)] = values[..] {
            standing.along.insert(label, [a, b, c]);
            let u = (axes[0] * a + axes[1] * b + axes[2] * c).to_array();
            let key = |c| (Target::One(label), c);
            let moved = u != [0.0; 3] || (0..3).any(|c| standing.held.get(&key(c)) == Some(&true));
            for component in 0..3 {
                standing.held.insert(key(component), moved);
            }
            if moved {
                let course = |axis: usize| {
                    (axis < ndim).then(|| motion(u[axis], None, sudden, step.duration))
                };
                step.moves.push(Move {
                    on,
                    u: [course(0), course(1), course(2)],
                    rot: Default::default(),
                    from: None,
                    place,
                });
            } else {
                step.fixes.push(Fix {
                    on,
                    u: Directions {
                        xyz: [true, true, ndim == 3],
                    },
                    rot: Directions::default(),
                    place,
                });
            }
            return;
        }
        for (axis, (component, axes)) in components.into_iter().zip(axes).enumerate() {
            let Some((course, place)) = component else {
                continue;
            };
            let Course::To(value, amplitude) = course else {
                // what an equation holds stays where it is
                if !standing.local.contains(&(label, axis)) {
                    let text =
                        "*BOUNDARY, FIXED along local axes that nothing held is not supported";
                    self.error(&codes::NOT_BUILT, text, &place, "");
                }
                continue;
            };
            let course = motion(value, amplitude.as_ref(), sudden, step.duration);
            let reference = format!("motion-{label}-{}", axis + 1);
            let moves = self
                .case
                .references
                .iter()
                .any(|one| one.name.value == reference);
            if !standing.local.insert((label, axis)) {
                if moves {
                    step.moves.push(along_x(&reference, course, &place));
                } else if value != 0.0 {
                    let text =
                        "a support along a local axis that moves in a later step is not supported";
                    let remark = "the equation that holds it has no motion";
                    self.error(&codes::NOT_BUILT, text, &place, remark);
                }
                continue;
            }
            let mut terms = along(on.clone(), axes, 1.0, ndim);
            if value != 0.0 {
                terms.push(self.moved(reference, label, &place));
                if let Some(term) = terms.last() {
                    step.moves.push(along_x(&term.on.value, course, &place));
                }
            }
            self.constrain(ConstraintKind::Equation { terms, rhs: 0.0 }, &place);
        }
    }

    /// The summand of an equation that moves what it holds: less the displacement of a reference along x.
    fn moved(&mut self, wanted: String, label: u64, place: &Place) -> Summand {
        let on = Spanned::new(self.fresh(&wanted), place.clone());
        self.case.references.push(Reference {
            name: on.clone(),
            position: Position::Node(label),
            rotations: None,
            place: place.clone(),
        });
        Summand {
            on,
            component: Spanned::new(0, place.clone()),
            coefficient: -1.0,
        }
    }
}

fn along_x(reference: &str, course: Motion, place: &Place) -> Move {
    Move {
        on: Spanned::new(reference.to_owned(), place.clone()),
        u: [Some(course), None, None],
        rot: Default::default(),
        from: None,
        place: place.clone(),
    }
}

pub(super) fn motion(value: f64, amplitude: Option<&Name>, sudden: bool, duration: f64) -> Motion {
    match amplitude {
        Some(name) => Motion::Amplitude {
            name: name.clone(),
            value,
        },
        None if sudden => Motion::Table(vec![[0.0, value], [duration, value]]),
        None => Motion::Ramp(value),
    }
}

/// Displacements and rotations among components from 0 to 5.
pub(super) fn directions(components: &[usize]) -> (Directions, Directions) {
    let of = |first: usize| Directions {
        xyz: std::array::from_fn(|axis| components.contains(&(first + axis))),
    };
    (of(0), of(3))
}

/// Components from 0, of degrees of freedom from 1 to 6.
pub(super) fn components(first: u64, last: u64) -> Option<Vec<usize>> {
    let meant = first >= 1 && last >= first && last <= 6;
    meant.then(|| (first as usize - 1..last as usize).collect())
}

/// The words of Abaqus for supports.
fn words(field: &Field<'_>) -> Option<&'static [usize]> {
    Some(match field.key().as_str() {
        "ENCASTRE" => &[0, 1, 2, 3, 4, 5],
        "PINNED" => &[0, 1, 2],
        "XSYMM" => &[0, 4, 5],
        "YSYMM" => &[1, 3, 5],
        "ZSYMM" => &[2, 3, 4],
        "XASYMM" => &[1, 2, 3],
        "YASYMM" => &[0, 2, 4],
        "ZASYMM" => &[0, 1, 5],
        _ => return None,
    })
}
