//! The files of a run: begun again, or gone on with from a checkpoint.

use super::growing::Files;
use super::{Counts, Recorder, Setting, frame_file};
use crate::run::audit::Audit;
use crate::run::closure::Closure;
use crate::run::error::OutputError;
use crate::run::expectations::Expectations;
use crate::run::frequencies::Frequencies;
use crate::run::idle::Idle;
use crate::run::leaks::Leaks;
use crate::run::narration::Narrator;
use crate::run::news::{Effort, Listener};
use signorini_io::checkpoint::{Archive, Checkpoints};
use signorini_io::writers::csv::{CONVERGENCE_COLUMNS, Table};
use signorini_io::writers::dat;
use signorini_io::writers::frd::{FrdFile, Mark};
use signorini_io::writers::json::{EventLog, StepSummary};
use signorini_io::writers::pvd::{Entry, Pvd};
use signorini_io::writers::sta::StatusTable;
use std::collections::BTreeMap;
use std::time::Instant;

/// The open files of a run, and where they stand.
pub struct Opened {
    setting: Setting,
    files: Files,
    results: Pvd,
    contact: Pvd,
    modes: Pvd,
    checkpoints: Checkpoints,
    counts: Counts,
    frequencies: Frequencies,
    expectations: Expectations,
    closure: Closure,
    idle: Idle,
    audit: Audit,
    step: Option<usize>,
    time: f64,
    step_time: f64,
}

impl Opened {
    /// Starts all files again.
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
            tables: match setting.tables.is_empty() {
                true => None,
                false => Some(dat::Tables::create(fs, &path(&tables(&setting.name)))?),
            },
            frd: match &setting.frd {
                None => None,
                Some((name, title)) => {
                    Some(FrdFile::create(fs, &path(name), title, &setting.mesh)?)
                }
            },
        };
        let lists = [
            Pvd::new(&path("results.pvd")),
            Pvd::new(&path("contact.pvd")),
            Pvd::new(&path("modes.pvd")),
        ];
        let steps = setting.steps.iter().map(|s| StepSummary {
            name: s.name.clone(),
            ..StepSummary::default()
        });
        let counts = Counts {
            steps: steps.collect(),
            ..Counts::default()
        };
        setting.fs.settle()?;
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
        let counts = counts(&setting, from)?;
        expectations.load(from.get_f64("run/expectations")?);
        let closure = Closure::restore(from.get_f64("run/closure").unwrap_or_default());
        let idle = Idle::restore(from.get_f64("run/idle").unwrap_or_default());
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
            tables: match setting.tables.is_empty() {
                true => None,
                false => {
                    let mut lines = [0];
                    from.copy_u64("run/tables", &mut lines)?;
                    let path = path(&tables(&setting.name));
                    Some(dat::Tables::resume(fs, &path, lines[0])?)
                }
            },
            frd: match &setting.frd {
                None => None,
                Some((name, _)) => Some(FrdFile::resume(
                    fs,
                    &path(name),
                    &setting.mesh,
                    mark(from)?,
                )?),
            },
        };
        let modes = from.get_f64("run/modes").unwrap_or_default();
        let frequencies = Frequencies::restore(modes, &setting.steps);
        let list = |name: &str, kind: &str, is_written: bool| -> Result<Pvd, OutputError> {
            if !is_written {
                return Ok(Pvd::new(&path(name)));
            }
            let entry = |(number, &time): (usize, &f64)| Entry {
                time,
                part: 0,
                file: frame_file(kind, number),
            };
            let entries = counts.frames.iter().enumerate().map(entry).collect();
            Ok(Pvd::with_entries(fs, &path(name), entries)?)
        };
        let results = list("results.pvd", "volume", setting.has_vtu)?;
        let has_contact = setting.has_vtu && setting.has_contact;
        let contact = list("contact.pvd", "contact", has_contact)?;
        let modes = modes_pvd(&setting, &frequencies)?;
        let [step, time, step_time] = clock;
        // how the run ended before says nothing about it now
        let summary = path("summary.json");
        if fs.exists(&summary)? {
            fs.remove(&summary)?;
        }
        setting.fs.settle()?;
        Ok(Self {
            audit: Audit::restored(from),
            frequencies,
            step: (step >= 0.0).then_some(step as usize),
            time,
            step_time,
            closure,
            idle,
            ..Self::new(
                setting,
                files,
                [results, contact, modes],
                counts,
                expectations,
                checkpoints,
            )
        })
    }

    fn new(
        setting: Setting,
        files: Files,
        [results, contact, modes]: [Pvd; 3],
        counts: Counts,
        expectations: Expectations,
        checkpoints: Checkpoints,
    ) -> Self {
        Self {
            setting,
            files,
            results,
            contact,
            modes,
            counts,
            frequencies: Frequencies::default(),
            expectations,
            checkpoints,
            audit: Audit::default(),
            step: None,
            time: 0.0,
            step_time: 0.0,
            closure: Closure::default(),
            idle: Idle::default(),
        }
    }

    /// Lets someone listen.
    pub fn heard_by(self, listener: &mut dyn Listener) -> Recorder<'_> {
        Recorder {
            began_at: self.counts.increments,
            saved_at: (self.counts.increments, Instant::now()),
            narrator: Narrator::default(),
            listener,
            contacts: BTreeMap::new(),
            drifts: Vec::new(),
            leaks: Leaks::default(),
            torn: Vec::new(),
            worn: Vec::new(),
            closure: self.closure,
            idle: self.idle,
            work_stabilization: 0.0,
            work_external: 0.0,
            heat: None,
            audit: self.audit,
            error: None,
            stop: None,
            write_seconds: 0.0,
            flips: 0,
            iterations: 0,
            judged: 0,
            last_flips: 0,
            worst: None,
            linear: Effort::default(),
            multigrid: false,
            setting: self.setting,
            files: self.files,
            results: self.results,
            contact: self.contact,
            modes: self.modes,
            frequencies: self.frequencies,
            checkpoints: self.checkpoints,
            counts: self.counts,
            expectations: self.expectations,
            step: self.step,
            time: self.time,
            step_time: self.step_time,
        }
    }
}

fn tables(name: &str) -> String {
    format!("{name}.dat")
}

/// The list and the table of modes as they stood.
fn modes_pvd(setting: &Setting, frequencies: &Frequencies) -> Result<Pvd, OutputError> {
    let (fs, path) = (setting.fs.as_ref(), setting.tree.path("modes.pvd"));
    if frequencies.nmode() > 0 {
        let table = frequencies.table();
        fs.write_atomic(&setting.tree.path("frequencies.csv"), table.as_bytes())?;
    }
    if frequencies.nmode() == 0 || !setting.has_vtu {
        return Ok(Pvd::new(&path));
    }
    let entries = (1..=frequencies.nmode()).map(|number| Entry {
        time: number as f64,
        part: 0,
        file: frame_file("mode", number),
    });
    Ok(Pvd::with_entries(fs, &path, entries.collect())?)
}

/// Where the records of the run stood.
fn counts(setting: &Setting, from: &Archive) -> Result<Counts, OutputError> {
    let frames = from.get_f64("run/frames")?.to_vec();
    let mut numbers = vec![0; 1 + 5 * setting.steps.len()];
    from.copy_u64("run/counts", &mut numbers)?;
    let (increments, of_steps) = numbers.split_first().unwrap_or((&0, &[]));
    let steps = setting.steps.iter().zip(of_steps.chunks_exact(5));
    Ok(Counts {
        increments: *increments,
        steps: steps
            .map(|(step, n)| StepSummary {
                name: step.name.clone(),
                increments: n.first().copied().unwrap_or(0),
                iterations: n.get(1).copied().unwrap_or(0),
                cutbacks: n.get(2).copied().unwrap_or(0),
                linear_iterations: n.get(3).copied().unwrap_or(0),
                fallbacks: n.get(4).copied().unwrap_or(0),
            })
            .collect(),
        frames,
    })
}

/// How far the file of all frames had got.
fn mark(from: &Archive) -> Result<Mark, OutputError> {
    let mut numbers = [0; 3];
    from.copy_u64("run/frd", &mut numbers)?;
    let [length, nframe, ndataset] = numbers;
    Ok(Mark {
        length,
        nframe,
        ndataset,
    })
}

fn sta(name: &str) -> String {
    format!("{name}.sta")
}
