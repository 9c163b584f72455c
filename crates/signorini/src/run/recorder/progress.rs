//! Iterations, cut-backs and increments: what becomes of each in tables and news.

use super::Recorder;
use crate::run::heat;
use crate::run::news::SLOW;
use crate::run::news::{Detail, Effort};
use signorini_io::case::Every;
use signorini_io::writers::csv::Cell;
use signorini_io::writers::json::{ContactState, ContactSummary, Event, GivenUp};
use signorini_io::writers::sta::Attempt;
use signorini_linear::Note;
use signorini_mechanics::solve::{Cause, IncrementRecord, IterationRecord, RunError};
use signorini_mechanics::system::{ContactFrame, Dof, DofName, Frame, Site};

impl Recorder<'_> {
    pub(super) fn iteration(&mut self, record: &IterationRecord) {
        if record.iteration == 1 {
            self.flips = 0;
            self.iterations = 0;
        } else if record.iteration != self.judged {
            self.iterations += 1;
            self.flips += u64::from(record.flips > 0);
            self.linear.solves += 1;
            self.linear.linear_iterations += record.linear_iterations as u64;
            if let Some(step) = self.counts.steps.get_mut(record.step) {
                step.iterations += 1;
                step.linear_iterations += record.linear_iterations as u64;
            }
        }
        // a state is judged again where terms let go of something
        self.judged = record.iteration;
        if record.iteration > 1 && record.flips > 0 {
            self.last_flips = record.flips;
        }
        if record.worst.is_some() && record.iteration > 1 {
            self.worst = record.worst;
        }
        let name = self.step_name(record.step);
        let label = self.worst_node(record.worst);
        self.write(|files| {
            files.convergence.row(&[
                Cell::Text(&name),
                Cell::Count(record.increment as u64),
                Cell::Count(record.attempt as u64),
                Cell::Count(record.iteration as u64),
                Cell::Real(record.residual),
                Cell::Real(record.correction),
                Cell::Real(record.line_search),
                Cell::Count(record.closed as u64),
                Cell::Count(record.flips as u64),
                label.map_or(Cell::Empty, Cell::Count),
            ])?;
            Ok(())
        });
        let event = Event::Iteration {
            step: name,
            inc: record.increment as u64,
            att: record.attempt as u64,
            iter: record.iteration as u64,
            residual: record.residual,
            correction: record.correction,
            closed: record.closed as u64,
            flips: record.flips as u64,
            linear: record.linear_iterations as u64,
        };
        self.tell(&event, Detail::Iteration(record));
    }

    pub(super) fn cutback(&mut self, place: [usize; 3], cause: &Cause, next: f64) {
        let [step, increment, attempt] = place;
        let is_smaller = next < cause.dt;
        if is_smaller && let Some(step) = self.counts.steps.get_mut(step) {
            step.cutbacks += 1;
        }
        let row = Attempt {
            step: step as u64 + 1,
            increment: increment as u64,
            attempt: attempt as u64,
            converged: false,
            discontinuity_iterations: self.flips,
            equilibrium_iterations: self.iterations.saturating_sub(self.flips),
            total_time: self.time,
            step_time: self.step_time,
            increment_time: cause.dt,
        };
        self.write(|files| Ok(files.sta.row(&row)?));
        let given_up = GivenUp {
            step: self.step_name(step),
            inc: increment as u64,
            att: attempt as u64,
            time: self.time,
            size: next,
            why: cause.failure.to_string(),
        };
        let event = match is_smaller {
            true => Event::Cutback(given_up),
            false => Event::Retry(given_up),
        };
        self.tell(&event, Detail::Cutback(cause));
    }

    pub(super) fn followed(&mut self, [step, increment, attempt]: [usize; 3], parts: usize) {
        let event = Event::Followed {
            step: self.step_name(step),
            inc: increment as u64,
            att: attempt as u64,
            time: self.time,
            parts: parts as u64,
        };
        self.tell(&event, Detail::None);
    }

    pub(super) fn stabilized(
        &mut self,
        [step, increment, attempt]: [usize; 3],
        stages: usize,
        [work, work_external]: [f64; 2],
    ) {
        let event = Event::Stabilized {
            step: self.step_name(step),
            inc: increment as u64,
            att: attempt as u64,
            time: self.time,
            stages: stages as u64,
            work,
            work_external,
        };
        self.tell(&event, Detail::None);
    }

    pub(super) fn solver(&mut self, step: usize, increment: usize, note: &Note) {
        if let (Note::Alone { .. } | Note::Direct { .. }, Some(counts)) =
            (note, self.counts.steps.get_mut(step))
        {
            counts.fallbacks += 1;
            self.linear.gave_way = true;
        }
        if matches!(note, Note::Hierarchy { .. } | Note::Factor { .. }) {
            self.multigrid = true;
        }
        let event = Event::Solver {
            step: self.step_name(step),
            inc: increment as u64,
            note: note.to_string(),
        };
        self.tell(&event, Detail::None);
    }

    pub(super) fn explicit(&mut self, step: usize, [size, mass_added]: [f64; 2]) {
        let step = self.step_name(step);
        let event = Event::Explicit {
            step,
            size,
            mass_added,
        };
        self.tell(&event, Detail::None);
    }

    pub(super) fn held(&mut self, step: usize, dofs: &[Dof]) {
        let setting = &self.setting;
        let name = |dof: Dof| setting.layout.name(dof);
        let in_words = |&dof: &Dof| match name(dof).and_then(DofName::displacement) {
            Some((node, axis)) => {
                let label = setting.mesh.node_labels.get(node as usize);
                let axis = ["x", "y", "z"].get(axis).copied().unwrap_or_default();
                format!("{axis} of node {}", label.copied().unwrap_or_default())
            }
            None => self.other_in_words(name(dof)),
        };
        let event = Event::Held {
            step: self.step_name(step),
            at: dofs.iter().map(in_words).collect(),
        };
        self.tell(&event, Detail::None);
    }

    pub(super) fn increment(&mut self, record: &IncrementRecord, frame: &Frame) {
        self.counts.increments += 1;
        if let Some(step) = self.counts.steps.get_mut(record.step) {
            step.increments += 1;
        }
        let name = self.step_name(record.step);
        let row = self.setting.history.row(frame, record.iterations);
        let page = self.setting.tables.page(record, frame);
        let attempt = Attempt {
            step: record.step as u64 + 1,
            increment: record.increment as u64,
            attempt: record.attempts as u64,
            converged: true,
            discontinuity_iterations: self.flips,
            equilibrium_iterations: self.iterations.saturating_sub(self.flips),
            total_time: record.time,
            step_time: record.step_time.0,
            increment_time: record.dt,
        };
        self.write(|files| {
            let head = [
                Cell::Real(record.time),
                Cell::Text(&name),
                Cell::Count(record.increment as u64),
                Cell::Count(record.iterations as u64),
            ];
            let numbers = row.iter().skip(head.len()).map(|&value| Cell::Real(value));
            let cells: Vec<Cell<'_>> = head.into_iter().chain(numbers).collect();
            files.history.row(&cells)?;
            files.sta.row(&attempt)?;
            if let (Some(tables), Some(page)) = (&mut files.tables, &page) {
                tables.append(page)?;
            }
            Ok(())
        });
        self.expectations
            .look(self.files.history.nrow(), frame, &row);
        self.closure.look(frame);
        self.idle.look(frame);
        let before = std::mem::take(&mut self.contacts);
        for contact in &frame.contacts {
            // two bodies that meet at several places have one name
            let name = contact.reported_name();
            let now = summary(contact, before.get(name));
            match self.contacts.get_mut(name) {
                Some(sum) => add(sum, &now),
                None => drop(self.contacts.insert(name.to_owned(), now)),
            }
        }
        let drifts = frame.contacts.iter();
        let drifts =
            drifts.filter_map(|c| c.drift.map(|(ratio, node)| (c.name.clone(), ratio, node)));
        self.drifts = drifts.collect();
        self.leaks.look(frame);
        let torn = frame.contacts.iter().filter(|c| c.work_viscous != 0.0);
        let torn = torn.map(|c| (c.name.clone(), [c.work_damage, c.work_viscous]));
        self.torn = torn.collect();
        let wears = frame.contacts.iter();
        let deep = |c: &ContactFrame| {
            let wear = c.wear.as_ref()?;
            Some((c.name.clone(), wear.deepest / c.facet_size, wear.node?))
        };
        self.worn = wears.filter_map(deep).collect();
        self.work_stabilization = frame.work_stabilization;
        self.work_external = frame.work_external;
        self.heat = frame.heat.map(|_| heat::reported(frame));
        self.audit.look(frame);
        let event = Event::Increment {
            step: name,
            inc: record.increment as u64,
            time: record.time,
            iters: record.iterations as u64,
            contact: frame.contacts.iter().map(state).collect(),
        };
        let effort = Effort {
            worst: self.worst_in_words(record),
            closed: frame.contacts.iter().map(|c| c.nclosed()).sum(),
            multigrid: self.multigrid,
            ..std::mem::take(&mut self.linear)
        };
        self.tell(&event, Detail::Increment(record, frame, &effort));
        let from = self.time;
        (self.time, self.step_time) = (record.time, record.step_time.0);
        (self.last_flips, self.worst) = (0, None);
        if self.wants_frame(record, from) {
            self.frame(frame);
        }
    }

    /// What an increment that was slow struggled with.
    fn worst_in_words(&self, record: &IncrementRecord) -> Option<String> {
        if record.iterations < SLOW {
            return None;
        }
        let node = self.worst_node(self.worst).map(|n| format!("n{n}"));
        let flips = match self.last_flips {
            0 => None,
            1 => Some("1 flip".to_owned()),
            n => Some(format!("{n} flips")),
        };
        let words: Vec<String> = flips.into_iter().chain(node).collect();
        (!words.is_empty()).then(|| words.join(" "))
    }

    /// Whether this increment is to be seen: by number or by time, and always at the end of a step.
    fn wants_frame(&self, record: &IncrementRecord, from: f64) -> bool {
        let (time, duration) = record.step_time;
        if time >= duration {
            return true;
        }
        match self.setting.every {
            Every::Increments(n) => (record.increment as u64).is_multiple_of(n.max(1)),
            Every::Time(every) => (record.time / every).floor() > (from / every).floor(),
        }
    }

    /// Records the attempt at which a run failed for good.
    pub fn gave_up(&mut self, error: &RunError) {
        if let RunError::NotConverged {
            increment, tried, ..
        } = error
        {
            let attempt = Attempt {
                step: self.step.unwrap_or(0) as u64 + 1,
                increment: *increment as u64,
                attempt: tried.len() as u64,
                converged: false,
                discontinuity_iterations: self.flips,
                equilibrium_iterations: self.iterations.saturating_sub(self.flips),
                total_time: self.time,
                step_time: self.step_time,
                increment_time: tried.last().copied().unwrap_or(0.0),
            };
            self.write(|files| Ok(files.sta.row(&attempt)?));
        }
    }

    /// Ends the status table.
    pub fn finish(&mut self, completed: bool) {
        self.write(|files| Ok(files.sta.finish(completed)?));
    }

    fn worst_node(&self, dof: Option<Dof>) -> Option<u64> {
        let (node, _) = self.setting.layout.name(dof?)?.displacement()?;
        self.setting.mesh.node_labels.get(node as usize).copied()
    }

    /// What is no displacement of a node.
    fn other_in_words(&self, name: Option<DofName>) -> String {
        let of_node = name.and_then(|name| {
            let field = self.setting.layout.field(name.field)?;
            let label = self.setting.mesh.node_labels.get(name.entity as usize)?;
            (field.on == Site::Nodes).then(|| format!("{} of node {label}", field.name))
        });
        of_node.unwrap_or_else(|| "a reference".to_owned())
    }
}

fn state(contact: &ContactFrame) -> (String, ContactState) {
    let state = ContactState {
        force: contact.reported().force.to_array(),
        area: contact.area_stick + contact.area_slip,
        pressure_max: contact.pressure_max,
        closed: contact.nclosed() as u64,
    };
    (contact.name.clone(), state)
}

/// Adds a contact to another one of the same two bodies.
fn add(sum: &mut ContactSummary, one: &ContactSummary) {
    for (sum, one) in [(&mut sum.force, one.force), (&mut sum.moment, one.moment)] {
        sum.iter_mut().zip(one).for_each(|(sum, one)| *sum += one);
    }
    sum.pressure_max = sum.pressure_max.max(one.pressure_max);
    sum.gap_min = sum.gap_min.min(one.gap_min);
    sum.area_open += one.area_open;
    sum.area_stick += one.area_stick;
    sum.area_slip += one.area_slip;
    for (sum, one) in [
        (&mut sum.area_wet, one.area_wet),
        (&mut sum.heat, one.heat),
        (&mut sum.heat_friction, one.heat_friction),
    ] {
        *sum = match (*sum, one) {
            (Some(a), Some(b)) => Some(a + b),
            (a, b) => a.or(b),
        };
    }
    sum.closure_max = sum
        .closure_max
        .into_iter()
        .chain(one.closure_max)
        .reduce(f64::max);
    sum.imbalance_force = sum.imbalance_force.max(one.imbalance_force);
    sum.imbalance_moment = sum.imbalance_moment.max(one.imbalance_moment);
}

/// A contact with the worst balance so far.
fn summary(contact: &ContactFrame, before: Option<&ContactSummary>) -> ContactSummary {
    let (one, other) = (&contact.secondary, &contact.primary);
    // those of both halves of a ring cancel
    let force: f64 = contact.force.iter().map(|f| f.norm()).sum();
    let over = |value: f64, size: f64| if force > 0.0 { value / size } else { 0.0 };
    let forces = over((one.force + other.force).norm(), force);
    let arm = force * contact.facet_size;
    let moments = over((one.moment + other.moment).norm(), arm);
    let reported = contact.reported();
    ContactSummary {
        force: reported.force.to_array(),
        moment: reported.moment.to_array(),
        pressure_max: contact.pressure_max,
        gap_min: contact.gap_min,
        area_open: contact.area_open,
        area_stick: contact.area_stick,
        area_slip: contact.area_slip,
        area_wet: contact.fluid.map(|fluid| fluid.area),
        closure_max: contact.closure_max.iter().copied().reduce(f64::max),
        heat: contact.warmth.as_ref().map(|warmth| warmth.through),
        heat_friction: contact.warmth.as_ref().map(|warmth| warmth.rubbed),
        imbalance_force: before.map_or(forces, |b| forces.max(b.imbalance_force)),
        imbalance_moment: before.map_or(moments, |b| moments.max(b.imbalance_moment)),
    }
}
