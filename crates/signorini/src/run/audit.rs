//! What the audits of accepted states found in the course of a run, and how it is reported.

use super::heat::HeatAudit;
use super::remedies::MOTION_INSTEAD;
use super::worst::{Worst, number};
use crate::setup::{LISTED, Model, and_so_on, first_step, hold_it};
use signorini_geometry::mesh::{Mesh, NodeId};
use signorini_io::case::{Case, Enforcement};
use signorini_io::checkpoint::{Archive, ArchiveError};
use signorini_io::diagnostic::{Code, Diagnostic, Diagnostics, codes};
use signorini_io::writers::json::{AuditEntry, AuditSummary, UnheldEntry};
use signorini_mechanics::audit::{stopped, viscous};
use signorini_mechanics::model::Unheld;
use signorini_mechanics::system::{Check, Frame, Measured};
use std::collections::BTreeMap;

/// What the audits found so far.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Audit {
    contacts: BTreeMap<String, [Worst; 4]>,
    /// The largest force of each contact so far.
    forces: BTreeMap<String, f64>,
    increments: u64,
    work_external: f64,
    viscous: Measured,
    /// When viscous forces first led to another equilibrium.
    jumped: Option<f64>,
    /// Bodies that moved freely, by their names, until something stops them.
    unheld: BTreeMap<String, Free>,
    gain: Gain,
    heat: HeatAudit,
}

/// Energy that the method of going through time has added to a motion with inertia.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Gain {
    /// The most so far, and when.
    energy: f64,
    time: f64,
    /// The largest energy that there could have been without it.
    largest: f64,
}

/// The part of the energy that a method of going through time may add.
const GAINED: f64 = 1e-3;

impl Gain {
    fn look(&mut self, frame: &Frame) {
        let Some(energies) = &frame.energies else {
            return;
        };
        let given = energies.kinetic_at_start + energies.external;
        let gained = -energies.algorithmic();
        let there = energies.kinetic + energies.internal + energies.contact;
        self.largest = self.largest.max(given).max(there - gained.max(0.0));
        if gained > self.energy {
            (self.energy, self.time) = (gained, frame.time);
        }
    }

    fn part(&self) -> f64 {
        if self.largest > 0.0 {
            self.energy / self.largest
        } else {
            0.0
        }
    }

    fn warning(&self, is_explicit: bool) -> Diagnostic {
        let message = format!(
            "the method of going through time has added {:.2} % to the energy",
            100.0 * self.part()
        );
        let warning = Diagnostic::warning(&codes::ENERGY_ADDED, message).note(format!(
            "{:.3e} by time {}; up to {:.1} % is let pass",
            self.energy,
            number(self.time),
            100.0 * GAINED
        ));
        if is_explicit {
            return warning
                .help("take a smaller part of what is stable:  safety = 0.5  in `dynamics`, or a softer `penalty`")
                .help("or multipliers, which act by impulses:  enforcement = { lagrange = {} }");
        }
        warning
            .help("let high frequencies go:  dynamics = { rho_inf = 0.8 }  of the step, in place of `alpha`")
            .help("or nodes without mass at contacts:  contact_mass = \"redistributed\"")
    }
}

/// The motion of bodies that nothing stops.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Free {
    /// When it began.
    time: f64,
    /// How far they went.
    distance: f64,
}

/// A force below this part of the largest one of its contact is rounding: nothing is judged by it.
const OF_ROUNDING: f64 = 1e-9;

/// Numbers of a check in a checkpoint, nodes left out.
const STORED: usize = 8;
/// Nodes of a check in a checkpoint.
const NODES: usize = 4;

impl Audit {
    /// Looks at an accepted increment.
    pub fn look(&mut self, frame: &Frame) {
        self.increments += 1;
        self.work_external = frame.work_external;
        self.viscous = viscous(frame);
        if frame.work_jumps > 0.0 {
            self.jumped.get_or_insert(frame.time);
        }
        self.gain.look(frame);
        self.heat.look(frame);
        for motion in &frame.free_motions {
            if stopped(motion) {
                self.unheld.remove(&*motion.bodies);
                continue;
            }
            let (time, distance) = (frame.time, 0.0);
            let free = self.unheld.entry(motion.bodies.to_string());
            free.or_insert(Free { time, distance }).distance += motion.distance;
        }
        for audit in &frame.audits {
            let largest = self.forces.entry(audit.name.clone()).or_default();
            *largest = largest.max(audit.force);
            let presses = audit.force >= OF_ROUNDING * *largest;
            let kept = self.contacts.entry(audit.name.clone()).or_default();
            let checks = Check::ALL.iter().zip(&audit.checks);
            for (kept, (check, measured)) in kept.iter_mut().zip(checks) {
                // sides that are inside each other without a force are no less so
                if presses || *check == Check::Through {
                    kept.take(measured, frame.time);
                }
            }
        }
    }

    /// The entry of `summary.json`.
    pub fn summary(&self, mesh: &Mesh) -> AuditSummary {
        let of = |checks: &[Worst; 4]| {
            let named = Check::ALL.iter().zip(checks);
            named
                .map(|(c, w)| (c.name().to_owned(), w.entry(mesh)))
                .collect()
        };
        let unheld = self.unheld.iter().map(|(bodies, free)| UnheldEntry {
            bodies: bodies.clone(),
            distance: free.distance,
            time: free.time,
        });
        let contacts = self.contacts.iter();
        let all = self.contacts.values().flatten();
        AuditSummary {
            passed: all.fold(self.viscous.passes(), |ok, w| ok && w.failed == 0)
                && self.unheld.is_empty()
                && self.heat.passes()
                && self.gain.part() <= GAINED,
            work_external: self.work_external,
            part_viscous: self.viscous.part,
            part_gained: self.gain.part(),
            unheld: unheld.collect(),
            contacts: contacts.map(|(n, c)| (n.clone(), of(c))).collect(),
            heat: self.heat.seen().map(|worst| worst.entry(mesh)),
        }
    }

    /// A warning for each check of each contact that did not pass.
    pub fn warnings(&self, model: &Model) -> Diagnostics {
        let mut found = Diagnostics::new();
        for (name, checks) in &self.contacts {
            for (&check, worst) in Check::ALL.iter().zip(checks) {
                if worst.failed > 0 {
                    found.push(self.warning(name, check, worst, model));
                }
            }
        }
        let viscous = &self.viscous;
        if !viscous.passes() {
            let message = format!(
                "viscous forces that led to another equilibrium did {:.0} % of the work of loads and supports",
                100.0 * viscous.part
            );
            found.push(self.led_by_viscosity(message, &model.case));
        }
        if !self.unheld.is_empty() {
            found.push(not_stopped(&self.unheld, model));
        }
        if self.gain.part() > GAINED {
            let mut methods = model.steps.iter().filter_map(|step| step.scheme);
            let is_explicit = methods.any(|scheme| scheme.explicit.is_some());
            found.push(self.gain.warning(is_explicit));
        }
        if !self.heat.passes() {
            found.push(self.heat.warning(self.increments));
        }
        found
    }

    fn led_by_viscosity(&self, message: String, case: &Case) -> Diagnostic {
        let viscous = &self.viscous;
        let mut one = Diagnostic::warning(&codes::LED_BY_VISCOSITY, message).note(format!(
            "their work is {:.3e}; up to {:.0} % is let pass",
            viscous.worst,
            100.0 * viscous.limit
        ));
        if let Some(time) = self.jumped {
            one = one.note(format!("first at time {}", number(time)));
        }
        if case.steps.iter().any(|step| !step.loads.is_empty()) {
            one = one.help(MOTION_INSTEAD);
        }
        one.help("where something is free there: hold it by [[step.fix]]")
            .help("to refuse such jumps:  on_trouble = [\"cut\"]  in [solver]")
            .help("where the structure snaps, it is meant so:  allow = [\"S0425\"]")
    }

    fn warning(&self, name: &str, check: Check, worst: &Worst, model: &Model) -> Diagnostic {
        let m = &worst.measured;
        let nodes: Vec<String> = labels(&model.mesh, &m.nodes)
            .map(|n| n.to_string())
            .collect();
        let at = match nodes.as_slice() {
            [] => String::new(),
            [one] => format!(" at node {one}"),
            many => format!(" at nodes {}", many.join(", ")),
        };
        let percent = 100.0 * m.part;
        let worst_at = if at.is_empty() {
            String::new()
        } else {
            format!(", worst{at}")
        };
        let (code, message): (&'static Code, String) = match check {
            Check::Apart if m.worst.is_finite() => (
                &codes::PRESSED_APART,
                format!(
                    "contact \"{name}\" presses{at} where the surfaces are {} apart",
                    number(m.worst)
                ),
            ),
            Check::Apart => (
                &codes::PRESSED_APART,
                format!(
                    "contact \"{name}\" presses{at} where nothing of the other side is in front"
                ),
            ),
            Check::Through => (
                &codes::INSIDE,
                format!(
                    "the sides of contact \"{name}\" are {} inside each other{at}",
                    number(m.worst)
                ),
            ),
            Check::Direction => (
                &codes::WRONG_DIRECTION,
                format!(
                    "{percent:.0} % of the force of contact \"{name}\" is in a direction that friction does not allow{worst_at}"
                ),
            ),
            Check::Stress => (
                &codes::NOT_CARRIED,
                format!(
                    "the stress next to contact \"{name}\" does not carry {percent:.0} % of its force{worst_at}"
                ),
            ),
        };
        let diagnostic = Diagnostic::warning(code, message)
            .note(fact(check, m))
            .note(worst.times(self.increments));
        let helps = help(name, check, model);
        helps.into_iter().fold(diagnostic, Diagnostic::help)
    }

    /// Stores the findings in a checkpoint.
    ///
    /// # Errors
    /// A name that the archive has.
    pub fn save(&self, archive: &mut Archive) -> Result<(), ArchiveError> {
        let names = bytes(self.contacts.keys());
        let v = &self.viscous;
        let works = [self.work_external, v.part, v.limit, v.worst, v.allowed];
        let mut numbers = works.to_vec();
        let mut counts = vec![self.increments];
        for worst in self.contacts.values().flatten() {
            let m = &worst.measured;
            let values = [m.part, m.limit, m.worst, m.allowed, m.pressure];
            numbers.extend(values);
            numbers.extend([worst.time, worst.first, worst.failed as f64]);
            counts.extend((0..NODES).map(|k| m.nodes.get(k).map_or(u64::MAX, |n| u64::from(*n))));
        }
        let forces: Vec<f64> = self.forces.values().copied().collect();
        archive.put_f64("run/audit.forces", &forces)?;
        let free = self
            .unheld
            .values()
            .flat_map(|free| [free.time, free.distance]);
        archive.put_u64("run/audit.unheld", &bytes(self.unheld.keys()))?;
        archive.put_f64("run/audit.free", &free.collect::<Vec<_>>())?;
        let gain = [self.gain.energy, self.gain.time, self.gain.largest];
        archive.put_f64("run/audit.gain", &gain)?;
        archive.put_f64("run/audit.jumped", self.jumped.as_slice())?;
        self.heat.save(archive)?;
        archive.put_u64("run/audit.names", &names)?;
        archive.put_u64("run/audit.counts", &counts)?;
        archive.put_f64("run/audit.numbers", &numbers)
    }

    /// The state in a checkpoint; empty where an older run wrote it.
    pub fn restored(archive: &Archive) -> Self {
        Self::read(archive).unwrap_or_default()
    }

    fn read(archive: &Archive) -> Option<Self> {
        let names = archive.get_u64("run/audit.names").ok()?;
        let counts = archive.get_u64("run/audit.counts").ok()?;
        let numbers = archive.get_f64("run/audit.numbers").ok()?;
        let (&increments, nodes) = counts.split_first()?;
        let (&[work_external, part, limit, worst, allowed], numbers) =
            numbers.split_first_chunk()?;
        let all = texts(names);
        let mut names = all.iter();
        let jumped = archive.get_f64("run/audit.jumped").unwrap_or_default();
        let gain = archive.get_f64("run/audit.gain").unwrap_or_default();
        let gain = gain.first_chunk().copied().unwrap_or_default();
        let [energy, time, largest] = gain;
        let forces = archive.get_f64("run/audit.forces").unwrap_or_default();
        let forces = all.iter().cloned().zip(forces.iter().copied()).collect();
        let unheld = archive.get_u64("run/audit.unheld").unwrap_or_default();
        let free = archive.get_f64("run/audit.free").unwrap_or_default();
        let free = free.as_chunks().0.iter();
        let free = free.map(|&[time, distance]| Free { time, distance });
        let unheld = texts(unheld).into_iter().zip(free).collect();
        let (numbers, nodes) = (
            numbers.as_chunks::<STORED>().0,
            nodes.as_chunks::<NODES>().0,
        );
        let mut contacts = BTreeMap::new();
        for (numbers, nodes) in numbers.chunks_exact(4).zip(nodes.chunks_exact(4)) {
            let name = names.next()?.clone();
            let mut checks = <[Worst; 4]>::default();
            for ((to, numbers), nodes) in checks.iter_mut().zip(numbers).zip(nodes) {
                *to = Worst::of(numbers, nodes);
            }
            contacts.insert(name, checks);
        }
        Some(Self {
            contacts,
            forces,
            jumped: jumped.first().copied(),
            gain: Gain {
                energy,
                time,
                largest,
            },
            unheld,
            heat: HeatAudit::restored(archive),
            increments,
            work_external,
            viscous: Measured {
                part,
                limit,
                worst,
                allowed,
                ..Measured::default()
            },
        })
    }
}

impl Worst {
    /// The entry of `summary.json`.
    fn entry(&self, mesh: &Mesh) -> AuditEntry {
        AuditEntry {
            passed: self.failed == 0,
            part: self.measured.part,
            limit: self.measured.limit,
            time: self.time,
            increments: self.failed,
            nodes: labels(mesh, &self.measured.nodes).collect(),
        }
    }

    fn of(numbers: &[f64; STORED], nodes: &[u64; NODES]) -> Self {
        let [part, limit, worst, allowed, pressure, time, first, failed] = *numbers;
        let nodes = nodes.iter().filter_map(|n| NodeId::try_from(*n).ok());
        Self {
            measured: Measured {
                part,
                limit,
                worst,
                allowed,
                pressure,
                nodes: nodes.collect(),
            },
            time,
            failed: failed as u64,
            first,
        }
    }
}

/// Texts as numbers of a checkpoint, each with a zero at its end.
fn bytes<'a>(texts: impl Iterator<Item = &'a String>) -> Vec<u64> {
    let bytes = texts.flat_map(|text| text.bytes().chain([0]));
    bytes.map(u64::from).collect()
}

/// The texts of [`bytes`].
fn texts(bytes: &[u64]) -> Vec<String> {
    let bytes: Vec<u8> = bytes.iter().filter_map(|b| u8::try_from(*b).ok()).collect();
    let texts = bytes.split_inclusive(|b| *b == 0);
    let text = |bytes: &[u8]| {
        let text = bytes.strip_suffix(&[0]).unwrap_or(bytes);
        String::from_utf8_lossy(text).into_owned()
    };
    texts.map(text).collect()
}

fn labels<'a>(mesh: &'a Mesh, nodes: &'a [NodeId]) -> impl Iterator<Item = u64> + 'a {
    let label = |&node: &NodeId| mesh.node_labels.get(node as usize).copied();
    nodes.iter().filter_map(label)
}

/// The warning about bodies that moved freely.
fn not_stopped(unheld: &BTreeMap<String, Free>, model: &Model) -> Diagnostic {
    let course = |free: &Free| {
        let (distance, time) = (number(free.distance), number(free.time));
        format!("by {distance}, from time {time} on")
    };
    let mut all = unheld.iter();
    let one = match (all.next(), all.len()) {
        (Some((bodies, free)), 0) => {
            let message = format!(
                "body {bodies} moved freely, and nothing stopped it: its place is no result"
            );
            let own = |body: &&Unheld| {
                let mut names = body.bodies.iter();
                names.all(|name| bodies.contains(&format!("\"{name}\"")))
            };
            let motions = model.held_by_contact.iter().filter(own).take(LISTED);
            let motions =
                motions.map(|body| format!("without contact {body} is free to {}", body.motion));
            let one = Diagnostic::warning(&codes::NOT_STOPPED, message);
            let one = one.note(format!("it moved {}", course(free)));
            motions.fold(one, Diagnostic::note)
        }
        (_, more) => {
            let message = format!(
                "{} bodies moved freely, and nothing stopped them: their places are no result",
                more + 1
            );
            let moved = unheld.iter().take(LISTED);
            let moved = moved.map(|(bodies, free)| format!("{bodies} moved {}", course(free)));
            let one = Diagnostic::warning(&codes::NOT_STOPPED, message);
            and_so_on(moved.fold(one, Diagnostic::note), unheld.len())
        }
    };
    one.note("no contact force opposes the motion at its end")
        .help(hold_it(first_step(&model.case)))
        .help("where a contact should stop it: add that pair; where friction should: give the contact friction")
}

/// The numbers of a failed check.
fn fact(check: Check, m: &Measured) -> String {
    let percent = 100.0 * m.part;
    match check {
        Check::Apart => format!(
            "pressure {} there; these nodes have {percent:.1} % of the contact force",
            number(m.pressure)
        ),
        Check::Through => format!(
            "{percent:.0} % of a facet deeper than {}, which the law and the facets explain",
            number(m.allowed)
        ),
        Check::Direction => format!(
            "shear over normal traction {} there, along the normal of the primary side; friction has {}",
            number(m.worst),
            number(m.allowed)
        ),
        Check::Stress => format!(
            "traction {} there, stress {}",
            number(m.worst),
            number(m.allowed)
        ),
    }
}

/// What to do about a failed check, most promising first.
fn help(name: &str, check: Check, model: &Model) -> Vec<String> {
    let method = model.contacts.iter().find(|c| c.name == name);
    let method = method.map_or("", |contact| contact.method);
    let mut own = model.case.contacts.iter().filter(|c| c.name.value == name);
    let has_multipliers = own.any(|contact| {
        let law = &contact.enforcement;
        matches!(law, Enforcement::Lagrange | Enforcement::Augmented { .. })
    });
    let key = |what: &str, key: &str| format!("{what}:  {key}  of contact \"{name}\"");
    let at_nodes = method == "node-to-segment";
    let points = || key("compare single points", "method = \"node-to-segment\"");
    match check {
        Check::Apart if at_nodes => {
            vec!["give a smaller `reach`, or smaller facets at corners and edges".into()]
        }
        Check::Apart => vec![points(), "give a smaller `reach`".into()],
        Check::Through => {
            let exchange = format!("exchange `secondary` and `primary` of contact \"{name}\"");
            let has_passes = (at_nodes || method == "gauss-point") && !has_multipliers;
            let both = has_passes.then(|| key("look from both sides", "passes = 2"));
            let smaller = "smaller increments".into();
            [exchange]
                .into_iter()
                .chain(both)
                .chain([smaller])
                .collect()
        }
        Check::Direction if at_nodes => {
            vec!["smaller facets there, and the faces next to the edge in both sides".into()]
        }
        Check::Direction => vec![
            points(),
            "take the faces next to the edge into the secondary side".into(),
        ],
        Check::Stress => vec![
            "take the supports off nodes that are joined, or smaller elements at the contact"
                .into(),
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_mechanics::system::{ContactAudit, FreeMotion};

    fn frame(time: f64, part: f64) -> Frame {
        let measured = |part| Measured {
            part,
            limit: 0.01,
            worst: 0.0024,
            nodes: vec![3, 1],
            ..Measured::default()
        };
        Frame {
            time,
            work_external: 2.0,
            work_turnover: 4.0,
            work_jumps: 1.0,
            audits: vec![ContactAudit {
                name: "v".into(),
                checks: [measured(part), measured(0.0), measured(0.0), measured(0.0)],
                ..ContactAudit::default()
            }],
            ..Frame::default()
        }
    }

    #[test]
    fn the_worst_increment_is_kept_and_failures_are_counted() {
        let mut audit = Audit::default();
        for (time, part) in [(1.0, 0.0), (2.0, 0.5), (3.0, 0.2)] {
            audit.look(&frame(time, part));
        }
        let worst = &audit.contacts["v"][0];
        assert_eq!((worst.failed, worst.first, worst.time), (2, 2.0, 2.0));
        assert_eq!(worst.measured.part, 0.5);
        assert_eq!(audit.contacts["v"][1].failed, 0);
        assert_eq!(audit.viscous.part, 0.25);
    }

    #[test]
    fn forces_of_rounding_are_not_judged() {
        let mut audit = Audit::default();
        for (time, part, force) in [(1.0, 0.0, 1.0), (2.0, 0.5, 1e-13), (3.0, 0.5, 1e-3)] {
            let mut frame = frame(time, part);
            frame.audits[0].force = force;
            audit.look(&frame);
        }
        let worst = &audit.contacts["v"][0];
        assert_eq!((worst.failed, worst.first), (1, 3.0));
    }

    #[test]
    fn bodies_that_nothing_stops_are_reported_until_something_does() {
        let mut audit = Audit::default();
        let mut look = |time: f64, opposed: f64| {
            let mut frame = frame(time, 0.0);
            frame.free_motions.push(free("\"pin\"", opposed));
            audit.look(&frame);
            audit.summary(&Mesh::default()).unheld
        };
        assert_eq!(look(1.0, 0.0).len(), 1);
        let [one] = &look(2.0, 1e-6)[..] else {
            panic!("one body is free");
        };
        assert_eq!((one.time, one.distance), (1.0, 0.2));
        assert!(look(3.0, 2.0).is_empty());
        assert_eq!(look(4.0, 0.0)[0].time, 4.0);
        assert!(!audit.summary(&Mesh::default()).passed);
    }

    /// A motion by 0.1 against viscous forces whose work is 2.
    fn free(bodies: &str, opposed: f64) -> FreeMotion {
        FreeMotion {
            bodies: bodies.into(),
            distance: 0.1,
            work: 2.0,
            work_throughout: 2.0,
            opposed,
        }
    }

    #[test]
    fn what_a_checkpoint_stores_comes_back() {
        let mut audit = Audit::default();
        let mut looked = frame(1.0, 0.5);
        looked.free_motions.push(free("\"pin\" and \"ring\"", 0.0));
        looked.free_motions.push(free("\"plate\"", 0.0));
        looked.heat = Some(super::super::heat::tests::balance(1.0));
        audit.look(&looked);
        let mut archive = Archive::new();
        audit.save(&mut archive).unwrap();
        assert_eq!(Audit::restored(&archive), audit);
        assert_eq!(Audit::restored(&Archive::new()), Audit::default());
    }

    #[test]
    fn numbers_have_four_digits() {
        let cases = [
            (0.0024, "0.0024"),
            (7739.04, "7739"),
            (0.386_12, "0.3861"),
            (2e14, "2.000e14"),
        ];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
    }
}
