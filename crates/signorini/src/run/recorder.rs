//! Turns the events of a run into files and news.

use super::contact_surface;
use super::error::OutputError;
use super::expectations::Expectations;
use super::fields::Fields;
use super::history::History;
use super::limits::{Limits, Stop};
use super::narration::{Level, Narrator};
use super::news::{Detail, Effort, Facts, Listener, News};
use super::tree::Tree;
use super::volume::Volume;
use crate::build::Model;
use signorini_geometry::mesh::Mesh;
use signorini_io::case::Every;
use signorini_io::checkpoint::{Archive, Checkpoints, Stamp};
use signorini_io::diagnostic::Diagnostics;
use signorini_io::fs::{Fs, Log};
use signorini_io::writers::csv::{CONVERGENCE_COLUMNS, Cell, Table};
use signorini_io::writers::json::{ContactState, ContactSummary, Event, EventLog, StepSummary};
use signorini_io::writers::pvd::{Entry, Pvd};
use signorini_io::writers::sta::{Attempt, StatusTable};
use signorini_mechanics::solve::{
    Cause, Event as Happening, Flow, IncrementRecord, IterationRecord, Observer, RunError, Step,
    Stepper,
};
use signorini_mechanics::system::{Dof, DofName, Frame, Layout, System};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Iterations from which on an increment is called slow.
pub const SLOW: usize = 8;

/// What stays the same during a run.
pub struct Setting {
    pub fs: Arc<dyn Fs>,
    pub tree: Tree,
    pub name: String,
    pub mesh: Arc<Mesh>,
    pub layout: Layout,
    pub steps: Vec<Step>,
    pub history: History,
    pub volume: Volume,
    pub every: Every,
    pub checkpoint_increments: Option<u64>,
    pub checkpoint_wall: Option<Duration>,
    pub limits: Limits,
    /// Whether there is a contact to write frames of.
    pub has_contact: bool,
}

impl Setting {
    /// Checks what the case asks to be written, before anything is.
    ///
    /// # Errors
    /// Histories, expectations and fields that name nothing.
    pub fn check(model: &Model) -> Result<(History, Expectations, Fields), Diagnostics> {
        let mut found = Diagnostics::new();
        let fields = Fields::new(&model.case.output).map_err(|e| found.append(e));
        let history = History::new(model).map_err(|e| found.append(e));
        if let (Ok(fields), Ok(history)) = (fields, history) {
            return match Expectations::new(model, history.columns()) {
                Ok(expectations) => Ok((history, expectations, fields)),
                Err(more) => {
                    found.append(more);
                    Err(found)
                }
            };
        }
        Err(found)
    }
}

/// The growing files.
struct Files {
    history: Table,
    convergence: Table,
    sta: StatusTable,
    events: EventLog,
    log: Box<dyn Log>,
}

/// Where the records of a run stand.
#[derive(Clone, Debug, Default)]
pub struct Counts {
    /// Accepted increments of all steps.
    pub increments: u64,
    /// Times of the frames written.
    pub frames: Vec<f64>,
    /// What every step took.
    pub steps: Vec<StepSummary>,
}

/// The open files of a run, and where they stand.
pub struct Opened {
    setting: Setting,
    files: Files,
    results: Pvd,
    contact: Pvd,
    checkpoints: Checkpoints,
    counts: Counts,
    expectations: Expectations,
    step: Option<usize>,
    time: f64,
    step_time: f64,
}

/// Receives the events of the solution.
pub struct Recorder<'l> {
    pub setting: Setting,
    files: Files,
    results: Pvd,
    contact: Pvd,
    checkpoints: Checkpoints,
    narrator: Narrator,
    listener: &'l mut dyn Listener,
    pub counts: Counts,
    pub expectations: Expectations,
    /// What every contact carried at the last accepted increment.
    pub contacts: BTreeMap<String, ContactSummary>,
    /// The first failure of the disk; nothing is written after it.
    pub error: Option<OutputError>,
    /// Why to stop.
    pub stop: Option<Stop>,
    /// Seconds spent on files.
    pub write_seconds: f64,
    saved_at: (u64, Instant),
    step: Option<usize>,
    flips: u64,
    iterations: u64,
    last_flips: usize,
    worst: Option<Dof>,
    time: f64,
    step_time: f64,
}

impl Opened {
    /// Starts all files anew.
    ///
    /// # Errors
    /// The disk.
    pub fn create(
        setting: Setting,
        expectations: Expectations,
        checkpoints: Checkpoints,
    ) -> Result<Self, OutputError> {
        let fs = setting.fs.as_ref();
        let path = |name: &str| setting.tree.path(name);
        let files = Files {
            history: Table::create(fs, &path("history.csv"), setting.history.columns())?,
            convergence: Table::create(fs, &path("convergence.csv"), &CONVERGENCE_COLUMNS)?,
            sta: StatusTable::create(fs, &path(&sta(&setting.name)), &setting.name)?,
            events: EventLog::create(fs, &path("events.jsonl"))?,
            log: fs.open_log(&path("run.log"), 0)?,
        };
        let lists = [
            Pvd::new(&path("results.pvd")),
            Pvd::new(&path("contact.pvd")),
        ];
        let steps = setting.steps.iter().map(|s| StepSummary {
            name: s.name.clone(),
            ..StepSummary::default()
        });
        let counts = Counts {
            steps: steps.collect(),
            ..Counts::default()
        };
        Ok(Self::new(
            setting,
            files,
            lists,
            counts,
            expectations,
            checkpoints,
        ))
    }

    /// Goes on with all files from a checkpoint: what was written after it is cut off.
    ///
    /// # Errors
    /// The disk; files that do not have what the checkpoint counts on.
    pub fn resume(
        setting: Setting,
        mut expectations: Expectations,
        checkpoints: Checkpoints,
        from: &Archive,
    ) -> Result<Self, OutputError> {
        let fs = setting.fs.as_ref();
        let path = |name: &str| setting.tree.path(name);
        let mut rows = [0; 4];
        from.copy_u64("run/rows", &mut rows)?;
        let [history, convergence, attempts, events] = rows;
        let frames = from.get_f64("run/frames")?.to_vec();
        let mut numbers = vec![0; 1 + 3 * setting.steps.len()];
        from.copy_u64("run/counts", &mut numbers)?;
        let (increments, of_steps) = numbers.split_first().unwrap_or((&0, &[]));
        let steps = setting.steps.iter().zip(of_steps.chunks_exact(3));
        let counts = Counts {
            increments: *increments,
            steps: steps
                .map(|(step, n)| StepSummary {
                    name: step.name.clone(),
                    increments: n.first().copied().unwrap_or(0),
                    iterations: n.get(1).copied().unwrap_or(0),
                    cutbacks: n.get(2).copied().unwrap_or(0),
                })
                .collect(),
            frames,
        };
        expectations.load(from.get_f64("run/expectations")?);
        let mut clock = [0.0; 3];
        from.copy_f64("run/clock", &mut clock)?;
        let log = path("run.log");
        let length = fs.read(&log).map_or(0, |bytes| bytes.len() as u64);
        let columns = setting.history.columns();
        let files = Files {
            history: Table::resume(fs, &path("history.csv"), columns, history)?,
            convergence: Table::resume(
                fs,
                &path("convergence.csv"),
                &CONVERGENCE_COLUMNS,
                convergence,
            )?,
            sta: StatusTable::resume(fs, &path(&sta(&setting.name)), &setting.name, attempts)?,
            events: EventLog::resume(fs, &path("events.jsonl"), events)?,
            log: fs.open_log(&log, length)?,
        };
        let list = |name: &str, kind: &str| -> Result<Pvd, OutputError> {
            let entry = |(number, &time): (usize, &f64)| Entry {
                time,
                part: 0,
                file: frame_file(kind, number),
            };
            let entries = counts.frames.iter().enumerate().map(entry).collect();
            Ok(Pvd::with_entries(fs, &path(name), entries)?)
        };
        let results = list("results.pvd", "volume")?;
        let contact = if setting.has_contact {
            list("contact.pvd", "contact")?
        } else {
            Pvd::new(&path("contact.pvd"))
        };
        let [step, time, step_time] = clock;
        Ok(Self {
            step: (step >= 0.0).then_some(step as usize),
            time,
            step_time,
            ..Self::new(
                setting,
                files,
                [results, contact],
                counts,
                expectations,
                checkpoints,
            )
        })
    }

    fn new(
        setting: Setting,
        files: Files,
        [results, contact]: [Pvd; 2],
        counts: Counts,
        expectations: Expectations,
        checkpoints: Checkpoints,
    ) -> Self {
        Self {
            setting,
            files,
            results,
            contact,
            counts,
            expectations,
            checkpoints,
            step: None,
            time: 0.0,
            step_time: 0.0,
        }
    }

    /// Lets someone listen.
    pub fn heard_by(self, listener: &mut dyn Listener) -> Recorder<'_> {
        Recorder {
            saved_at: (self.counts.increments, Instant::now()),
            narrator: Narrator::default(),
            listener,
            contacts: BTreeMap::new(),
            error: None,
            stop: None,
            write_seconds: 0.0,
            flips: 0,
            iterations: 0,
            last_flips: 0,
            worst: None,
            setting: self.setting,
            files: self.files,
            results: self.results,
            contact: self.contact,
            checkpoints: self.checkpoints,
            counts: self.counts,
            expectations: self.expectations,
            step: self.step,
            time: self.time,
            step_time: self.step_time,
        }
    }
}

impl Recorder<'_> {
    /// Tells and records that the run starts.
    pub fn start(&mut self, facts: &Facts, title: &str, findings: &Diagnostics) {
        let event = Event::Start {
            case: self.setting.name.clone(),
            title: title.to_owned(),
            version: crate::VERSION.into(),
            threads: facts.threads as u64,
            nodes: facts.nnode as u64,
            elements: facts.cells.iter().map(|(_, n)| *n as u64).sum(),
            unknowns: facts.nunknown as u64,
        };
        self.tell(&event, Detail::Start(facts));
        for finding in findings {
            self.tell(&super::event_of(finding), Detail::Finding(finding));
        }
    }

    /// Tells what happened: to `events.jsonl`, `run.log` and the listener.
    pub fn tell(&mut self, event: &Event, detail: Detail<'_>) {
        self.record(event, detail);
        self.tell_listener(event, detail);
    }

    /// Writes what happened into `events.jsonl` and `run.log`.
    pub fn record(&mut self, event: &Event, detail: Detail<'_>) {
        let lines = self.narrator.lines(&News { event, detail });
        self.write(|files| {
            files.events.append(event)?;
            for line in lines.iter().filter(|line| line.level != Level::Verbose) {
                files.log.append(format!("{}\n", line.text).as_bytes())?;
            }
            Ok(())
        });
    }

    /// Tells what happened to the listener only.
    pub fn tell_listener(&mut self, event: &Event, detail: Detail<'_>) {
        if self.listener.hear(&News { event, detail }) == Flow::Stop {
            self.stop.get_or_insert(Stop::Listener);
        }
    }

    /// Writes into the growing files, unless the disk has failed before.
    fn write(&mut self, write: impl FnOnce(&mut Files) -> Result<(), OutputError>) {
        if self.error.is_some() {
            return;
        }
        let clock = Instant::now();
        if let Err(error) = write(&mut self.files) {
            self.error = Some(error);
        }
        self.write_seconds += clock.elapsed().as_secs_f64();
    }

    /// Writes the undeformed state.
    pub fn undeformed(&mut self, frame: &Frame) {
        self.expectations
            .begin(frame, &self.setting.history.row(frame, 0));
        self.frame(frame);
    }

    /// Writes a frame and lists it.
    fn frame(&mut self, frame: &Frame) {
        if self.error.is_some() {
            return;
        }
        let clock = Instant::now();
        match self.write_frame(frame) {
            Ok(files) => {
                let event = Event::Frame {
                    frame: self.counts.frames.len() as u64,
                    time: frame.time,
                    files,
                };
                self.counts.frames.push(frame.time);
                self.write_seconds += clock.elapsed().as_secs_f64();
                self.tell(&event, Detail::None);
            }
            Err(error) => self.error = Some(error),
        }
    }

    fn write_frame(&mut self, frame: &Frame) -> Result<Vec<String>, OutputError> {
        let fs = self.setting.fs.as_ref();
        let number = self.counts.frames.len();
        let volume = frame_file("volume", number);
        let mut files = vec![volume.clone()];
        fs.write_atomic(
            &self.setting.tree.path(&volume),
            &self.setting.volume.encode(frame)?,
        )?;
        if self.setting.has_contact {
            let surface = frame_file("contact", number);
            let bytes = contact_surface::encode(&self.setting.mesh, frame)?;
            fs.write_atomic(&self.setting.tree.path(&surface), &bytes)?;
            self.contact.add(fs, frame.time, &[&surface])?;
            files.push(surface);
        }
        self.results.add(fs, frame.time, &[&volume])?;
        Ok(files)
    }

    /// Whether a checkpoint is due.
    pub fn is_due(&self) -> bool {
        let (increments, at) = self.saved_at;
        let since = self.counts.increments - increments;
        let by_count = self
            .setting
            .checkpoint_increments
            .is_some_and(|n| since >= n);
        let by_clock = self
            .setting
            .checkpoint_wall
            .is_some_and(|t| at.elapsed() >= t);
        by_count || by_clock
    }

    /// Writes a checkpoint and returns what the solution needs to go on from it; none where the disk failed.
    pub fn save(
        &mut self,
        stepper: &Stepper,
        system: &System,
    ) -> Option<signorini_mechanics::system::Archive> {
        let mut solution = signorini_mechanics::system::Archive::default();
        stepper.save(system, &mut solution);
        // counted first: a resumed run tells of the checkpoint again
        let clock = Instant::now();
        match self.write_checkpoint(&solution, stepper.state().time) {
            Ok((stamp, file)) => {
                self.saved_at = (self.counts.increments, Instant::now());
                self.write_seconds += clock.elapsed().as_secs_f64();
                let step = usize::try_from(stamp.step).ok();
                let event = Event::Checkpoint {
                    step: self.step_name(step.unwrap_or(0)),
                    inc: stamp.increment,
                    time: stamp.time,
                    file,
                };
                self.tell(&event, Detail::None);
                Some(solution)
            }
            Err(error) => {
                self.error.get_or_insert(error);
                None
            }
        }
    }

    fn write_checkpoint(
        &mut self,
        solution: &signorini_mechanics::system::Archive,
        time: f64,
    ) -> Result<(Stamp, String), OutputError> {
        let files = &mut self.files;
        files.history.sync()?;
        files.convergence.sync()?;
        files.sta.sync()?;
        files.events.sync()?;
        let mut archive = Archive::new();
        for (name, values) in &solution.arrays {
            archive.put_f64(&format!("solve/{name}"), values)?;
        }
        let rows = [
            files.history.nrow(),
            files.convergence.nrow(),
            files.sta.nrow(),
            files.events.nrow(),
        ];
        archive.put_u64("run/rows", &rows)?;
        let of_step = |s: &StepSummary| [s.increments, s.iterations, s.cutbacks];
        let mut counts = vec![self.counts.increments];
        counts.extend(self.counts.steps.iter().flat_map(of_step));
        archive.put_u64("run/counts", &counts)?;
        let step = self.step.map_or(-1.0, |step| step as f64);
        archive.put_f64("run/clock", &[step, self.time, self.step_time])?;
        archive.put_f64("run/frames", &self.counts.frames)?;
        archive.put_f64("run/expectations", &self.expectations.save())?;
        let step = self.step.unwrap_or(0);
        let stamp = Stamp {
            step: step as u64,
            increment: self.counts.steps.get(step).map_or(0, |s| s.increments),
            time,
        };
        let path = self
            .checkpoints
            .write(self.setting.fs.as_ref(), stamp, &archive)?;
        let name = path.file_name().map(|n| n.to_string_lossy().into_owned());
        Ok((stamp, format!("checkpoint/{}", name.unwrap_or_default())))
    }

    /// Writes the last try of an increment that failed, where it can be drawn.
    pub fn failed(&mut self, system: &System, stepper: &Stepper) {
        if self.error.is_some() {
            return;
        }
        let trial = stepper.trial();
        let nodes = 0..system.layout.nnode as u32;
        let frame = Frame {
            time: trial.time,
            displacement: nodes.map(|node| system.displacement(trial, node)).collect(),
            step_number: self.step.unwrap_or(0),
            ..Frame::default()
        };
        if !frame.displacement.iter().all(|u| u.is_finite()) {
            return;
        }
        let path = self.setting.tree.path("frames/failed.vtu");
        let written = self
            .setting
            .volume
            .encode_shape(&frame)
            .map_err(OutputError::from);
        let fs = self.setting.fs.as_ref();
        if let Err(error) = written.and_then(|bytes| Ok(fs.write_atomic(&path, &bytes)?)) {
            self.error = Some(error);
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

    fn step_name(&self, step: usize) -> String {
        let step = self.setting.steps.get(step);
        step.map_or_else(String::new, |s| s.name.clone())
    }

    fn iteration(&mut self, record: &IterationRecord) {
        if record.iteration == 1 {
            self.flips = 0;
            self.iterations = 0;
        } else {
            self.iterations += 1;
            self.flips += u64::from(record.flips > 0);
            if let Some(step) = self.counts.steps.get_mut(record.step) {
                step.iterations += 1;
            }
        }
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
        };
        self.tell(&event, Detail::Iteration(record));
    }

    fn worst_node(&self, dof: Option<Dof>) -> Option<u64> {
        match self.setting.layout.name(dof?)? {
            DofName::Node(node, _) => self.setting.mesh.node_labels.get(node as usize).copied(),
            _ => None,
        }
    }

    fn cutback(&mut self, place: [usize; 3], cause: &Cause, next: f64) {
        let [step, increment, attempt] = place;
        if let Some(step) = self.counts.steps.get_mut(step) {
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
        let event = Event::Cutback {
            step: self.step_name(step),
            inc: increment as u64,
            att: attempt as u64,
            time: self.time,
            size: next,
            why: cause.failure.to_string(),
        };
        self.tell(&event, Detail::Cutback(cause));
    }

    fn increment(&mut self, record: &IncrementRecord, frame: &Frame) {
        self.counts.increments += 1;
        if let Some(step) = self.counts.steps.get_mut(record.step) {
            step.increments += 1;
        }
        let name = self.step_name(record.step);
        let row = self.setting.history.row(frame, record.iterations);
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
            Ok(())
        });
        self.expectations
            .look(self.files.history.nrow(), frame, &row);
        self.contacts = frame.contacts.iter().map(summary).collect();
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
}

impl Observer for Recorder<'_> {
    fn notice(&mut self, event: &Happening<'_>) -> Flow {
        match event {
            Happening::Step { step, .. } => {
                // a restart begins the step once more
                if self.step != Some(*step) {
                    self.step = Some(*step);
                    self.step_time = 0.0;
                }
                return Flow::Continue;
            }
            Happening::Iteration(record) => self.iteration(record),
            Happening::Cutback {
                step,
                increment,
                attempt,
                cause,
                next,
            } => self.cutback([*step, *increment, *attempt], cause, *next),
            Happening::Increment { record, frame } => {
                self.increment(record, frame);
                if self.is_due() {
                    self.stop = self.stop.or_else(|| self.setting.limits.reached());
                    return Flow::Stop;
                }
            }
            _ => {}
        }
        if self.stop.is_none() {
            self.stop = self.setting.limits.reached();
        }
        if self.stop.is_some() || self.error.is_some() {
            Flow::Stop
        } else {
            Flow::Continue
        }
    }
}

fn sta(name: &str) -> String {
    format!("{name}.sta")
}

/// The file of a frame, relative to the output folder.
pub fn frame_file(kind: &str, number: usize) -> String {
    format!("frames/{kind}_{number:04}.vtu")
}

fn state(contact: &signorini_mechanics::system::ContactFrame) -> (String, ContactState) {
    let state = ContactState {
        force: contact.secondary.force.to_array(),
        area: contact.area_stick + contact.area_slip,
        pressure_max: contact.pressure_max,
        closed: contact.nclosed() as u64,
    };
    (contact.name.clone(), state)
}

fn summary(contact: &signorini_mechanics::system::ContactFrame) -> (String, ContactSummary) {
    let summary = ContactSummary {
        force: contact.secondary.force.to_array(),
        moment: contact.secondary.moment.to_array(),
        pressure_max: contact.pressure_max,
        gap_min: contact.gap_min,
        area_open: contact.area_open,
        area_stick: contact.area_stick,
        area_slip: contact.area_slip,
    };
    (contact.name.clone(), summary)
}
