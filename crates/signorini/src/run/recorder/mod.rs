//! Turns the events of a run into files and news.
//!
//! `files` opens them, `progress` records what the solution reports, `vibrations` natural frequencies, `checkpoint` saves; here are
//! frames and news.

mod checkpoint;
mod files;
mod growing;
mod progress;
mod vibrations;

pub use files::Opened;

use growing::Files;

use crate::ranks::LockStep;
use crate::run::audit::Audit;
use crate::run::closure::Closure;
use crate::run::contact_surface;
use crate::run::error::OutputError;
use crate::run::expectations::Expectations;
use crate::run::fields::Fields;
use crate::run::frd;
use crate::run::frequencies::Frequencies;
use crate::run::history::History;
use crate::run::idle::Idle;
use crate::run::leaks::Leaks;
use crate::run::limits::{Limits, Stop};
use crate::run::narration::{Level, Narrator};
use crate::run::news::{Detail, Effort, Facts, Listener, News};
use crate::run::tables::Tables;
use crate::run::tree::Tree;
use crate::run::volume::Volume;
use crate::setup::Model;
use signorini_geometry::mesh::Mesh;
use signorini_io::case::Every;
use signorini_io::checkpoint::Checkpoints;
use signorini_io::diagnostic::Diagnostics;
use signorini_io::fs::Fs;
use signorini_io::writers::json::{ContactSummary, Event, StepSummary};
use signorini_io::writers::pvd::Pvd;
use signorini_mechanics::solve::{
    Event as Happening, Flow, IncrementRecord, Observer, Step, Stepper,
};
use signorini_mechanics::system::{Dof, Frame, HeatBalance, Layout, System};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What stays the same during a run.
pub struct Setting {
    pub fs: Arc<dyn Fs>,
    pub ranks: Arc<LockStep>,
    pub tree: Tree,
    pub name: String,
    pub mesh: Arc<Mesh>,
    pub layout: Layout,
    pub steps: Vec<Step>,
    pub history: History,
    pub volume: Volume,
    pub tables: Tables,
    pub fields: Fields,
    /// Whether frames go to files of their own.
    pub has_vtu: bool,
    /// The name of the file of all frames and its title, where there is one.
    pub frd: Option<(String, String)>,
    pub every: Every,
    pub checkpoint_increments: Option<u64>,
    pub checkpoint_wall: Option<Duration>,
    pub limits: Limits,
    /// The steps behind which to stop, where there are more.
    pub first_steps: Option<usize>,
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

/// Receives the events of the solution.
pub struct Recorder<'l> {
    pub setting: Setting,
    files: Files,
    results: Pvd,
    contact: Pvd,
    modes: Pvd,
    checkpoints: Checkpoints,
    narrator: Narrator,
    listener: &'l mut dyn Listener,
    pub counts: Counts,
    /// Natural frequencies of all steps so far.
    pub frequencies: Frequencies,
    pub expectations: Expectations,
    /// What every contact carried at the last accepted increment.
    pub contacts: BTreeMap<String, ContactSummary>,
    /// How far contacts that keep the geometry of the start slid at most, over the size of their facets, and where.
    pub drifts: Vec<(String, f64, u32)>,
    /// Where fluids have come through contacts.
    pub leaks: Leaks,
    /// The contacts whose joints break with viscosity: the energies that damage and viscosity have taken.
    pub torn: Vec<(String, [f64; 2])>,
    /// How deep contacts are worn, over the size of their facets, and a node there.
    pub worn: Vec<(String, f64, u32)>,
    /// Which contacts have closed.
    pub closure: Closure,
    /// Which contacts act on nothing that moves somewhere.
    pub idle: Idle,
    /// Work spent so far in holding what only contact stops.
    pub work_stabilization: f64,
    /// Work of supports and loads so far.
    pub work_external: f64,
    /// Where heat came from and went to, where steps find temperatures.
    pub heat: Option<HeatBalance>,
    /// What the audits found so far.
    pub audit: Audit,
    /// The first failure of the disk; nothing is written after it.
    pub error: Option<OutputError>,
    /// Why to stop.
    pub stop: Option<Stop>,
    /// Seconds spent on files, and in waiting for the disk.
    pub write_seconds: f64,
    /// Increments that were done when this process began.
    began_at: u64,
    saved_at: (u64, Instant),
    step: Option<usize>,
    flips: u64,
    iterations: u64,
    /// The iteration that was judged last.
    judged: usize,
    last_flips: usize,
    worst: Option<Dof>,
    /// What the linear solver did since the last increment.
    linear: Effort,
    /// Whether multigrid has made a hierarchy.
    multigrid: bool,
    time: f64,
    step_time: f64,
}

impl Recorder<'_> {
    /// Tells and records that the run starts.
    pub fn start(&mut self, facts: &Facts, title: &str, findings: &Diagnostics) {
        let event = Event::Start {
            case: self.setting.name.clone(),
            title: title.to_owned(),
            version: crate::VERSION.into(),
            ranks: (facts.ranks > 1).then_some(facts.ranks as u64),
            threads: facts.threads as u64,
            nodes: facts.nnode as u64,
            elements: facts.cells.iter().map(|(_, n)| *n as u64).sum(),
            unknowns: facts.nunknown as u64,
            duration: facts.duration,
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

    /// Tells what happened to the listener only; of a file that it may open, when that is on the disk.
    pub fn tell_listener(&mut self, event: &Event, detail: Detail<'_>) {
        let is_file = matches!(event, Event::Frame { .. } | Event::Checkpoint { .. });
        if is_file && self.listener.opens_files() {
            self.settle();
            if self.error.is_some() {
                return;
            }
        }
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

    /// Waits until all that was written is on the disk.
    pub fn settle(&mut self) {
        let clock = Instant::now();
        if let Err(error) = self.setting.fs.settle() {
            self.error.get_or_insert(error.into());
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
                self.tell(&event, Detail::Frame(frame));
            }
            Err(error) => self.error = Some(error),
        }
    }

    fn write_frame(&mut self, frame: &Frame) -> Result<Vec<String>, OutputError> {
        let mut files = Vec::new();
        if self.setting.has_vtu {
            self.write_grids(frame, &mut files)?;
        }
        if let (Some(frd), Some((name, _))) = (&mut self.files.frd, &self.setting.frd)
            && frame.increment > 0
        {
            frd::append(frd, frame, self.setting.fields)?;
            files.push(name.clone());
        }
        Ok(files)
    }

    /// Writes the grids of a frame, and lists them.
    fn write_grids(&mut self, frame: &Frame, files: &mut Vec<String>) -> Result<(), OutputError> {
        let fs = self.setting.fs.as_ref();
        let number = self.counts.frames.len();
        let volume = frame_file("volume", number);
        fs.write_atomic(
            &self.setting.tree.path(&volume),
            &self.setting.volume.encode(frame)?,
        )?;
        files.push(volume.clone());
        if self.setting.has_contact {
            let surface = frame_file("contact", number);
            let bytes = contact_surface::encode(&self.setting.mesh, frame)?;
            fs.write_atomic(&self.setting.tree.path(&surface), &bytes)?;
            self.contact.add(fs, frame.time, &[&surface])?;
            files.push(surface);
        }
        self.results.add(fs, frame.time, &[&volume])?;
        Ok(())
    }

    /// Writes the last try of an increment that failed, where it can be drawn.
    pub fn failed(&mut self, system: &System, stepper: &Stepper) {
        if self.error.is_some() {
            return;
        }
        let trial = stepper.trial();
        let nodes = 0..system.layout.nnode() as u32;
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

    /// Stops where this rank, or another one, has a reason to.
    pub fn agree_to_stop(&mut self, own: Option<Stop>) {
        match self.setting.ranks.stop(own) {
            Ok(stop) => self.stop = stop,
            Err(parted) => {
                self.error.get_or_insert(parted.into());
            }
        }
    }

    /// Whether an increment is the last one of the steps that were asked for.
    fn is_behind_steps(&self, record: &IncrementRecord) -> bool {
        let (time, duration) = record.step_time;
        self.setting.first_steps == Some(record.step + 1) && time >= duration
    }

    fn step_name(&self, step: usize) -> String {
        let step = self.setting.steps.get(step);
        step.map_or_else(String::new, |s| s.name.clone())
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
            Happening::Followed {
                step,
                increment,
                attempt,
                parts,
            } => self.followed([*step, *increment, *attempt], *parts),
            Happening::Stabilized {
                step,
                increment,
                attempt,
                stages,
                work,
                external,
            } => self.stabilized([*step, *increment, *attempt], *stages, [*work, *external]),
            Happening::Explicit {
                step,
                longest,
                added,
            } => self.explicit(*step, [*longest, *added]),
            Happening::Held { step, dofs } => self.held(*step, dofs),
            Happening::Solver {
                step,
                increment,
                note,
            } => self.solver(*step, *increment, note),
            Happening::Vibrations { step, time, found } => self.vibrations(*step, *time, found),
            Happening::Increment { record, frame } => {
                if let Err(parted) = self.setting.ranks.same_state(record, frame) {
                    self.error.get_or_insert(parted.into());
                    return Flow::Stop;
                }
                self.increment(record, frame);
                if self.is_behind_steps(record) {
                    self.stop.get_or_insert(Stop::Steps);
                }
                if self.is_due() {
                    self.agree_to_stop(self.stop.or_else(|| self.setting.limits.reached()));
                    return Flow::Stop;
                }
            }
            _ => {}
        }
        self.agree_to_stop(self.stop.or_else(|| self.setting.limits.reached()));
        if self.stop.is_some() || self.error.is_some() {
            Flow::Stop
        } else {
            Flow::Continue
        }
    }
}

/// The file of a frame, relative to the output folder.
pub fn frame_file(kind: &str, number: usize) -> String {
    format!("frames/{kind}_{number:04}.vtu")
}
