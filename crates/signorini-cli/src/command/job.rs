//! A job: the model, the place of its results, and its report.

use super::console::Console;
use super::exit::WRONG_COMMAND;
use super::findings::joined;
use super::ndjson::Ndjson;
use super::options::SolveOptions;
use super::ranks;
use super::signals::{Notice, Signals};
use super::terminal::Terminal;
use super::threads;
use signorini::run::{Detail, Finished, NOT_STARTED};
use signorini::{Diagnostics, Limits, Listener, Loaded, Model, News, RunOptions, Source, build};
use signorini_geometry::mesh::Mesh;
use signorini_io::case::Case;
use signorini_io::fs::Lock;
use signorini_io::writers::json::Event;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Everything that a solution starts from, whichever command asks for it.
pub struct Job {
    pub case: Case,
    pub mesh: Mesh,
    pub warnings: Diagnostics,
    pub source: Source,
    pub folder: Option<PathBuf>,
    pub fresh: bool,
    pub resume: bool,
    /// Holds the folder until the run takes it.
    pub hold: Option<Lock>,
    pub threads: usize,
    pub signals: Signals,
    /// When the command began.
    pub clock: Instant,
    pub read_seconds: f64,
}

impl Job {
    /// What was loaded since `clock`, to be solved in its own folder.
    pub fn new(loaded: Loaded, signals: Signals, clock: Instant, options: &SolveOptions) -> Self {
        Self {
            signals,
            clock,
            threads: threads::make(options.threads, loaded.case.solver.threads),
            case: loaded.case,
            mesh: loaded.mesh,
            warnings: loaded.warnings,
            source: loaded.source,
            folder: None,
            fresh: false,
            resume: false,
            hold: None,
            read_seconds: clock.elapsed().as_secs_f64(),
        }
    }

    /// Builds, solves, reports; returns the exit code.
    pub fn solve(self, options: &SolveOptions) -> u8 {
        let clock = Instant::now();
        let mut model = match ranks::all().agreed(build(self.case, self.mesh)) {
            Ok(model) => model,
            Err(found) => return refused(&joined(self.warnings, found), options),
        };
        model.name.clone_from(&self.source.name);
        let names: Vec<&str> = model.steps.iter().map(|s| s.name.as_str()).collect();
        if !is_beginning(&options.steps, &names) {
            Console::stderr().line(&format!(
                "error: --steps {} are not the first steps of the case\n  its steps are, in order: {}",
                options.steps.join(","),
                names.join(", ")
            ));
            return WRONG_COMMAND;
        }
        let mut run = RunOptions::new(self.source);
        run.warnings = self.warnings;
        run.folder = self.folder.unwrap_or(run.folder);
        run.fresh = self.fresh;
        run.resume = self.resume;
        run.steps = (!options.steps.is_empty()).then_some(options.steps.len());
        run.strict = options.strict;
        run.ranks = ranks::all();
        run.threads = self.threads;
        run.seconds = [self.read_seconds, clock.elapsed().as_secs_f64()];
        run.limits = Limits {
            signal: Arc::clone(&self.signals.seen),
            deadline: options
                .max_wall
                .map(|s| self.clock + Duration::from_secs_f64(s.min(1e9))),
        };
        self.signals.are_requests();
        drop(self.hold);
        let finished = solve(model, &run, options);
        ranks::say_own(&finished.diagnostics);
        if options.timings {
            timings(&finished);
        }
        finished.exit_code
    }
}

/// Whether all that is wanted is how a list begins.
fn is_beginning(wanted: &[String], all: &[&str]) -> bool {
    wanted.len() <= all.len() && wanted.iter().zip(all).all(|(a, b)| a == b)
}

/// Solves and reports as the options say.
fn solve(model: Model, run: &RunOptions, options: &SolveOptions) -> Finished {
    let level = if options.json {
        signorini::run::narration::Level::Important
    } else {
        Terminal::level(options.quiet, options.verbose)
    };
    let notice = Notice::new(run.limits.clone());
    let _watch = notice.clone().watch();
    let progress = !options.no_progress && !options.json;
    let mut terminal = Terminal::new(level, progress, notice);
    if options.json {
        signorini::solve(model, run, &mut (Ndjson(Console::stdout()), terminal))
    } else {
        signorini::solve(model, run, &mut terminal)
    }
}

/// Reports why nothing is solved, and returns the exit code.
pub fn refused(found: &Diagnostics, options: &SolveOptions) -> u8 {
    ranks::say(found);
    let code = found.exit_code().unwrap_or(3);
    if options.json {
        let mut out = Ndjson(Console::stdout());
        signorini::run::tell(found, &mut out);
        let event = Event::End {
            status: NOT_STARTED.into(),
            exit_code: code,
            seconds: 0.0,
        };
        let _ = out.hear(&News {
            event: &event,
            detail: Detail::None,
        });
    }
    code
}

fn timings(finished: &Finished) {
    let console = Console::stderr();
    for (phase, seconds) in &finished.summary.time {
        console.line(&format!("  {phase:<10}{seconds:>9.3} s"));
    }
    let steps = &finished.summary.steps;
    let iterations: u64 = steps.iter().map(|step| step.linear_iterations).sum();
    let fallbacks: u64 = steps.iter().map(|step| step.fallbacks).sum();
    console.line(&format!(
        "  {iterations} linear iterations, {fallbacks} times given way to a direct solution"
    ));
}
