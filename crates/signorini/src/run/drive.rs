//! From a model to an ending: claims the folder, solves, saves, judges.

use super::births::{self, Watch};
use super::error::{OutputError, bad_checkpoint, cannot_resume};
use super::expectations::Expectations;
use super::fields::{Fields, Formats};
use super::history::History;
use super::limits::Stop;
use super::news::{Detail, Listener, News, Totals, tell};
use super::recorder::{Opened, Recorder, Setting};
use super::start::{Start, begin, facts};
use super::tables::Tables;
use super::tree::{Claim, Tree};
use super::volume::Volume;
use super::{
    Finished, NOT_STARTED, RunOptions, drift, event_of, failure, heat, solution, torn, worn,
};
use crate::ranks::disk_of_first;
use crate::setup::Model;
use crate::vocabulary::vocabulary;
use signorini_io::case;
use signorini_io::checkpoint::{Checkpoint, Checkpoints};
use signorini_io::deck;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_io::fs::{BehindFs, FsError};
use signorini_io::writers::frd::FrdError;
use signorini_io::writers::json::{
    DiagnosticSummary, Event, Expectation, RanksSummary, StepSummary, Summary,
};
use signorini_io::writers::pvd::Pvd;
use signorini_mechanics::solve::{LinearSeconds, Outcome, RunError, Stepper};
use signorini_mechanics::system::ArchiveError;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The script that shows results in ParaView.
const VIEW: &str = include_str!("view.py");

/// Solves a model; everything that happens goes to files and to the listener.
///
/// Never fails in another way than by the exit code and the messages of what it returns.
pub fn run(model: &mut Model, options: &RunOptions, listener: &mut dyn Listener) -> Finished {
    let clock = Instant::now();
    let prepared = Setting::check(model).and_then(|checked| Ok((checked, begin(model)?)));
    let (checked, mut start) = match prepared {
        Ok(prepared) => prepared,
        Err(found) => return refuse(found, listener),
    };
    let ranks = &options.ranks;
    if let Err(parted) = ranks.same_input(&options.source.hash()) {
        return refuse(parted.diagnostic().into(), listener);
    }
    let fs = disk_of_first(ranks, || Arc::clone(&options.fs));
    let claim = match (options.resume, options.fresh) {
        (true, _) => Claim::Resume,
        (false, true) => Claim::Fresh,
        (false, false) => Claim::Start,
    };
    let tree = match Tree::claim(&fs, &options.folder, &options.source, claim) {
        Ok(tree) => tree,
        Err(found) => return refuse(found, listener),
    };
    let checkpoints = Checkpoints::new(&tree.path("checkpoint"), options.source.hash())
        .keeping(model.case.checkpoint.keep);
    let from = match options.resume.then(|| checkpoints.latest_good(fs.as_ref())) {
        None => None,
        Some(Ok(checkpoint)) => Some(checkpoint),
        Some(Err(error)) => return refuse(bad_checkpoint(&error).into(), listener),
    };
    if let Some(from) = &from {
        match births::take(model, &from.archive) {
            Ok(again) => start = again.unwrap_or(start),
            Err(found) => return refuse(found, listener),
        }
    }
    let (setting, expectations) = setting(model, options, tree, checked);
    let opened = match &from {
        None => Opened::create(setting, expectations, checkpoints),
        Some(from) => Opened::resume(setting, expectations, checkpoints, &from.archive),
    };
    match opened {
        Ok(opened) => Run {
            recorder: opened.heard_by(listener),
            model,
            options,
            clock,
            linear: LinearSeconds::default(),
            in_trouble: false,
        }
        .finish(start, from.as_ref()),
        Err(error) => refuse(not_opened(&error, from.is_some()).into(), listener),
    }
}

/// The ending of a run that never began; the listener learns why.
pub fn refuse(found: Diagnostics, listener: &mut dyn Listener) -> Finished {
    tell(&found, listener);
    let finished = refused(found);
    let event = Event::End {
        status: finished.summary.status.clone(),
        exit_code: finished.exit_code,
        seconds: 0.0,
    };
    let _ = listener.hear(&News {
        event: &event,
        detail: Detail::None,
    });
    finished
}

fn refused(found: Diagnostics) -> Finished {
    let exit_code = found.exit_code().unwrap_or(3);
    Finished {
        exit_code,
        summary: Summary {
            status: NOT_STARTED.into(),
            exit_code,
            version: crate::VERSION.into(),
            diagnostics: summaries(&found),
            ..Summary::default()
        },
        diagnostics: found,
        in_trouble: false,
    }
}

/// The message for growing files that could not be opened.
fn not_opened(error: &OutputError, resumed: bool) -> Diagnostic {
    match error {
        OutputError::Frd(FrdError::Fs(short @ FsError::TooShort { .. })) if resumed => {
            cannot_resume(short).help(short.help())
        }
        OutputError::Frd(_) => error.diagnostic(),
        _ if error.fs().is_some() => error.diagnostic(),
        other if resumed => cannot_resume(other),
        other => other.diagnostic(),
    }
}

fn setting(
    model: &Model,
    options: &RunOptions,
    tree: Tree,
    (history, expectations, fields): (History, Expectations, Fields),
) -> (Setting, Expectations) {
    let checkpoint = &model.case.checkpoint;
    let formats = Formats::new(&model.case.output);
    let frd = || (format!("{}.frd", model.name), model.case.title.clone());
    let setting = Setting {
        fs: disk_of_first(&options.ranks, || {
            Arc::new(BehindFs::new(Arc::clone(&options.fs)))
        }),
        ranks: Arc::clone(&options.ranks),
        tree,
        name: model.name.clone(),
        mesh: Arc::clone(&model.mesh),
        layout: model.system.layout,
        steps: model.steps.clone(),
        volume: Volume::new(&model.mesh, fields),
        fields,
        has_vtu: formats.vtu,
        frd: formats.frd.then(frd),
        history,
        tables: Tables::new(model),
        every: model.case.output.every,
        checkpoint_increments: checkpoint.increments,
        checkpoint_wall: checkpoint.wall.map(Duration::from_secs_f64),
        limits: options.limits.clone(),
        first_steps: options.steps.filter(|n| *n < model.steps.len()),
        has_contact: !model.contacts.is_empty() || model.general.is_some(),
    };
    (setting, expectations)
}

/// A run that has its folder.
struct Run<'a, 'l> {
    model: &'a mut Model,
    options: &'a RunOptions,
    recorder: Recorder<'l>,
    clock: Instant,
    linear: LinearSeconds,
    in_trouble: bool,
}

/// How the solution ended.
enum Ending {
    Solved,
    Stopped(Stop),
    Failed(Diagnostic),
    /// The model could not be built again with contact that began.
    NotBuilt(Diagnostics),
}

/// The exit code of a run and the status in its summary.
#[derive(Clone, Copy)]
struct Verdict {
    exit_code: u8,
    status: &'static str,
}

impl Verdict {
    fn new(exit_code: u8, status: &'static str) -> Self {
        Self { exit_code, status }
    }
}

impl Run<'_, '_> {
    fn finish(mut self, start: Start, from: Option<&Checkpoint>) -> Finished {
        let mut found = self.options.warnings.clone();
        found.append(self.model.warnings.clone());
        if let Some(why) = from.and_then(|from| from.passed_over.as_ref()) {
            let message = "one of the two checkpoints is of no use; the run goes on from the other";
            found.push(Diagnostic::warning(&codes::CANNOT_RESUME, message).note(why));
        }
        let facts = facts(self.model, &start, self.options);
        self.recorder.start(&facts, &self.model.case.title, &found);
        if let Some(from) = from {
            self.recorder.goes_on_from(from);
        }
        self.write_resolved();
        let before = self.recorder.write_seconds;
        let solving = Instant::now();
        let ending = match self.solve(start, from) {
            Ok(ending) => ending,
            Err(error) => Ending::Failed(cannot_resume(error)),
        };
        let writing = self.recorder.write_seconds - before;
        let solving = (solving.elapsed().as_secs_f64() - writing).max(0.0);
        self.close(ending, found, facts.nunknown, solving)
    }

    /// Writes what was really run, and a script that shows the results.
    fn write_resolved(&mut self) {
        let text = case::resolved(&self.model.case, vocabulary());
        let setting = &self.recorder.setting;
        let write = |name: &str, text: &str| {
            let path = setting.tree.path(name);
            setting.fs.write_atomic(&path, text.as_bytes())
        };
        let mut written = write("case.resolved.toml", &text);
        if setting.has_vtu && written.is_ok() {
            written = write("view.py", VIEW);
        }
        if let Err(error) = written {
            self.recorder.error.get_or_insert(error.into());
        }
    }

    /// Solves until the end, a limit or a failure; saves where it is due.
    fn solve(&mut self, start: Start, from: Option<&Checkpoint>) -> Result<Ending, ArchiveError> {
        let mut stepper = match from {
            Some(from) => {
                let archive = solution::of(&from.archive);
                Stepper::resumed(&mut self.model.system, self.model.settings, &archive)?
                    .with_cycles(self.model.cycles.clone())
            }
            None => {
                self.recorder.undeformed(&start.frame);
                Stepper::new(&self.model.system, self.model.settings)
                    .with_cycles(self.model.cycles.clone())
            }
        };
        // its memory serves the run
        drop(start);
        let mut due = from.is_none();
        let mut watch = Watch::new(self.model, &stepper);
        loop {
            if due && self.recorder.error.is_none() {
                let saved = self.recorder.save(&stepper, self.model);
                if let Some(solution) = saved {
                    // in the way a new process does, so that both give the same bits
                    let settings = self.model.settings;
                    stepper = stepper.restarted(&mut self.model.system, settings, &solution)?;
                }
            }
            self.recorder.agree_to_stop(self.recorder.stop);
            if self.recorder.error.is_some() {
                // who asks sees the failure of the disk first
                return Ok(Ending::Solved);
            }
            if let Some(stop) = self.recorder.stop {
                return Ok(Ending::Stopped(stop));
            }
            let outcome = match &mut watch {
                None => {
                    let Model { system, steps, .. } = &mut *self.model;
                    stepper.run(system, steps, &mut self.recorder)
                }
                Some(watch) => match self.run_watched(watch, &mut stepper) {
                    Ok(outcome) => outcome,
                    Err(found) => {
                        self.fails(found.exit_code());
                        return Ok(Ending::NotBuilt(found));
                    }
                },
            };
            self.linear += stepper.take_linear_seconds();
            match outcome {
                Ok(Outcome::Finished) => return Ok(Ending::Solved),
                Ok(Outcome::Stopped) => {
                    // the rest goes on from the end of the steps that were asked for
                    due = self.recorder.is_due()
                        || self.recorder.stop == Some(Stop::Steps)
                        || self.recorder.would_stand_still();
                }
                Err(error) => return Ok(self.failed(&error, &stepper)),
            }
        }
    }

    /// One increment, after which contact may begin that nobody names.
    fn run_watched(
        &mut self,
        watch: &mut Watch,
        stepper: &mut Stepper,
    ) -> Result<Result<Outcome, RunError>, Diagnostics> {
        let done = watch.increment(self.model, stepper, None, &mut self.recorder)?;
        if let Some(begun) = &done.begun {
            self.recorder.setting.layout = self.model.system.layout;
            self.recorder.tell(&event_of(begun), Detail::Finding(begun));
        }
        Ok(done.outcome)
    }

    fn failed(&mut self, error: &RunError, stepper: &Stepper) -> Ending {
        let all_converged = matches!(error, RunError::TooManyIncrements { .. })
            && self
                .recorder
                .counts
                .steps
                .iter()
                .all(|step| step.cutbacks == 0);
        // another method of contact finds no more modes
        self.in_trouble = !(all_converged || matches!(error, RunError::Modes { .. }));
        let saved = failure::Saved {
            increments: self.recorder.counts.increments,
            folder: self.options.folder.display().to_string(),
        };
        let message = failure::message(error, self.model, &saved);
        self.fails(Some(message.code.class.exit_code()));
        self.recorder.gave_up(error);
        self.recorder.failed(&self.model.system, stepper);
        Ending::Failed(message)
    }

    /// Reports a fault to other ranks; where they do not have it, this one comes to its end without them.
    fn fails(&self, exit_code: Option<u8>) {
        let _ = self.options.ranks.fails(exit_code.unwrap_or(5));
    }

    /// Judges, reports and writes how it ended.
    fn close(
        mut self,
        ending: Ending,
        mut found: Diagnostics,
        nunknown: usize,
        solving: f64,
    ) -> Finished {
        self.recorder.settle();
        let solved = matches!(ending, Ending::Solved) && self.recorder.error.is_none();
        self.recorder.finish(solved);
        self.recorder.settle();
        let audited = self.recorder.audit.warnings(self.model);
        let wrong = self.report_unless_allowed(audited, &mut found);
        let (mut verdict, expectations) = self.judge(ending, &mut found);
        let names: Vec<(String, bool)> = (self.model.contacts.iter())
            .map(|contact| (contact.name.clone(), !contact.is_found))
            .collect();
        let idle = self.recorder.idle.notes(&names, &self.model.mesh);
        self.report_unless_allowed(idle, &mut found);
        let frequencies = self.recorder.frequencies.warnings();
        self.report_unless_allowed(frequencies, &mut found);
        let far = drift::warnings(&self.recorder.drifts, self.model);
        self.report_unless_allowed(far, &mut found);
        let leaks = self.recorder.leaks.warnings(self.model);
        self.report_unless_allowed(leaks, &mut found);
        let viscous = torn::warnings(&self.recorder.torn);
        self.report_unless_allowed(viscous, &mut found);
        let deep = worn::warnings(&self.recorder.worn, self.model);
        self.report_unless_allowed(deep, &mut found);
        if verdict.exit_code == 0 && wrong && self.options.strict {
            verdict = Verdict::new(1, "audit failed");
        }
        let mut summary = self.summary(expectations, nunknown, solving);
        self.write_ending(verdict, &mut summary, &mut found);
        Finished {
            exit_code: summary.exit_code,
            diagnostics: found,
            summary,
            in_trouble: self.in_trouble,
        }
    }

    /// What an ending means, and what became of the expectations where the case is solved.
    fn judge(&mut self, ending: Ending, found: &mut Diagnostics) -> (Verdict, Vec<Expectation>) {
        match ending {
            Ending::Solved => {
                let expectations = self.expectations();
                let open = self.never_closed();
                self.report_unless_allowed(open, found);
                let verdict = match expectations.iter().all(|one| one.ok) {
                    true => Verdict::new(0, "solved"),
                    false => Verdict::new(1, "expectation failed"),
                };
                (verdict, expectations)
            }
            Ending::Stopped(stop) => {
                if stop == Stop::Time {
                    let limit = self.stopped_by_time();
                    self.report(limit, found);
                }
                (Verdict::new(stop.exit_code(), stop.status()), Vec::new())
            }
            Ending::NotBuilt(more) => {
                let code = more.exit_code().unwrap_or(5);
                for one in more {
                    self.report(one, found);
                }
                (Verdict::new(code, "model ill-posed"), Vec::new())
            }
            Ending::Failed(one) => {
                let code = one.code.class.exit_code();
                self.report(one, found);
                let status = match code {
                    4 => "model ill-posed",
                    7 => "cannot resume",
                    8 => "out of memory",
                    _ => "not converged",
                };
                (Verdict::new(code, status), Vec::new())
            }
        }
    }

    /// The summary but for how the run ended.
    fn summary(
        &mut self,
        expectations: Vec<Expectation>,
        nunknown: usize,
        solving: f64,
    ) -> Summary {
        let [read, build] = self.options.seconds;
        let total = self.clock.elapsed().as_secs_f64() + self.options.seconds.iter().sum::<f64>();
        Summary {
            audit: self.recorder.audit.summary(&self.model.mesh),
            steps: self.recorder.counts.steps.clone(),
            frequencies: self.recorder.frequencies.summary(),
            contacts: std::mem::take(&mut self.recorder.contacts),
            expectations,
            work_stabilization: self.recorder.work_stabilization,
            work_external: self.recorder.work_external,
            heat: self.recorder.heat.as_ref().map(heat::summary),
            time: [
                ("read", read),
                ("build", build),
                ("solve", solving),
                ("analyze", self.linear.analyze),
                ("factorize", self.linear.factorize),
                ("substitute", self.linear.solve),
                ("write", self.recorder.write_seconds),
                ("total", total),
            ]
            .map(|(phase, seconds)| (phase.to_owned(), seconds))
            .into(),
            memory_peak_bytes: memory_peak(),
            ranks: self.ranks(),
            unknowns: nunknown as u64,
            version: crate::VERSION.into(),
            inputs: self.options.source.inputs.clone(),
            ..Summary::default()
        }
    }

    /// The processes of the run, where there are several, with the largest memory that any of them has had.
    fn ranks(&self) -> Option<RanksSummary> {
        let ranks = &self.options.ranks;
        let largest = ranks.most(memory_peak());
        (!ranks.is_alone()).then(|| RanksSummary {
            count: ranks.size() as u64,
            memory_peak_bytes: largest.unwrap_or_default(),
        })
    }

    /// Writes the ending into summary, events and log, and reports it.
    fn write_ending(
        &mut self,
        mut verdict: Verdict,
        summary: &mut Summary,
        found: &mut Diagnostics,
    ) {
        let path = self.recorder.setting.tree.path("summary.json");
        let seconds = summary.time.get("total").copied().unwrap_or(0.0);
        let totals = self.totals(summary);
        // twice at most: the writing of the ending may fail, which makes another ending
        let event = loop {
            let failed = self.recorder.error.take();
            if let Some(error) = &failed {
                verdict = match self.options.ranks.parted() {
                    Some(parted) => Verdict::new(parted.exit_code(), "a rank failed"),
                    None => Verdict::new(6, "not written"),
                };
                let one = self.not_written(error);
                self.recorder
                    .tell_listener(&event_of(&one), Detail::Finding(&one));
                found.push(one);
            }
            summary.exit_code = verdict.exit_code;
            summary.status = verdict.status.to_owned();
            summary.diagnostics = summaries(found);
            let event = Event::End {
                status: summary.status.clone(),
                exit_code: summary.exit_code,
                seconds,
            };
            let written = summary.write(self.recorder.setting.fs.as_ref(), &path);
            if failed.is_none() {
                self.recorder.record(&event, Detail::End(&totals));
                if let Err(error) = written {
                    self.recorder.error.get_or_insert(error.into());
                }
            }
            self.recorder.settle();
            if failed.is_some() || self.recorder.error.is_none() {
                break event;
            }
        };
        self.recorder.tell_listener(&event, Detail::End(&totals));
    }

    /// Passes a finding to the files and the listener, and adds it to the summary.
    fn report(&mut self, one: Diagnostic, found: &mut Diagnostics) {
        let one = match deck::is_of_deck(&self.model.case) {
            true => deck::one_in_words(one),
            false => one,
        };
        self.recorder.tell(&event_of(&one), Detail::Finding(&one));
        found.push(one);
    }

    /// Reports the findings whose codes the case does not silence by `allow`; returns whether there are any.
    fn report_unless_allowed(
        &mut self,
        mut findings: Diagnostics,
        found: &mut Diagnostics,
    ) -> bool {
        let allowed: Vec<&str> = self.model.case.allow.iter().map(String::as_str).collect();
        findings.silence(&allowed);
        let any = !findings.is_empty();
        for one in findings {
            self.report(one, found);
        }
        any
    }

    fn totals(&self, summary: &Summary) -> Totals {
        let count = |of: fn(&StepSummary) -> u64| summary.steps.iter().map(of).sum();
        Totals {
            increments: count(|s| s.increments),
            iterations: count(|s| s.iterations),
            cutbacks: count(|s| s.cutbacks),
            folder: self.options.folder.display().to_string(),
            phases: summary.time.clone().into_iter().collect(),
        }
    }

    fn expectations(&mut self) -> Vec<Expectation> {
        let verdicts = self.recorder.expectations.judge();
        let tolerances = self.recorder.expectations.tolerances();
        for (verdict, tolerance) in verdicts.iter().zip(&tolerances) {
            let event = Event::Expect {
                what: verdict.what.clone(),
                value: verdict.value,
                got: verdict.got,
                ok: verdict.ok,
            };
            self.recorder.tell(&event, Detail::Expectation(tolerance));
        }
        verdicts
    }

    /// Notes on contacts that never closed.
    fn never_closed(&self) -> Diagnostics {
        let case = &self.model.case;
        let acts = |name: &str| {
            let contact = case.contacts.iter().find(|c| c.name.value == name);
            let free = contact.filter(|contact| contact.tied.is_none());
            free.is_some_and(|contact| contact.acting(case.steps.iter()).any(|acts| acts))
        };
        let names = self.model.contacts.iter();
        let names: Vec<(String, bool)> = names
            .map(|one| (one.name.clone(), !one.is_found && acts(&one.name)))
            .collect();
        let mesh = &self.model.mesh;
        let position = |node: u32| mesh.points.get(node as usize).copied().unwrap_or_default();
        self.recorder.closure.notes(&names, mesh, position)
    }

    fn stopped_by_time(&self) -> Diagnostic {
        let n = self.recorder.counts.increments;
        let folder = self.options.folder.display();
        Diagnostic::error(&codes::LIMIT_REACHED, "the time limit is reached")
            .note(format!("{n} increments have converged and are on disk"))
            .help(format!("signorini resume {folder}"))
    }

    fn not_written(&self, error: &OutputError) -> Diagnostic {
        let mut one = match self.options.ranks.parted() {
            Some(parted) => parted.diagnostic(),
            None => error.diagnostic(),
        };
        let setting = &self.recorder.setting;
        let listed = Pvd::read(setting.fs.as_ref(), &setting.tree.path("results.pvd"));
        let listed = listed.map_or(0, |list| list.entries().len());
        if listed > 0 {
            let last = listed - 1;
            one = one.note(format!(
                "frames 0 to {last} are complete; results.pvd lists only complete ones"
            ));
        }
        if !self.recorder.counts.frames.is_empty() {
            let folder = self.options.folder.display();
            one = one.help(format!("then  signorini resume {folder}"));
        }
        one
    }
}

fn summaries(found: &Diagnostics) -> Vec<DiagnosticSummary> {
    let summary = |one: &Diagnostic| DiagnosticSummary {
        code: one.code.id.into(),
        message: one.message.clone(),
    };
    found.iter().map(summary).collect()
}

/// The largest memory this process has had, in bytes; 0 where the system does not say.
fn memory_peak() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|line| line.split_whitespace().next()?.parse::<u64>().ok());
    kilobytes.map_or(0, |kb| kb * 1024)
}
