//! Running problems and judging their values.

use crate::problem::{Check, Expectations, Problem, Setup};
use signorini::{Diagnostics, Reading, RunOptions, build, open_text};
use signorini_io::fs::{Fs, MemoryFs};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// What a run of a problem left.
#[derive(Clone)]
pub struct Solved {
    /// Why no value of it counts; none where the run converged and its audit doubts nothing.
    pub failure: Option<String>,
    /// The value of each check, in order; not a number where there is none.
    pub values: Vec<f64>,
    /// Seconds on the clock.
    pub seconds: f64,
    /// Accepted increments and linear solves.
    pub effort: [u64; 2],
    /// The files of the run.
    pub files: Arc<dyn Fs>,
    /// The folder of the results in them.
    pub folder: PathBuf,
}

/// A problem with its values and verdicts.
#[derive(Clone)]
pub struct Judged {
    /// The problem.
    pub problem: Problem,
    /// How it was posed.
    pub setup: Setup,
    /// What its run left.
    pub solved: Solved,
}

/// A value next to its reference.
#[derive(Clone, Copy, Debug)]
pub struct Row<'a> {
    /// What is compared.
    pub check: &'a Check,
    /// The value.
    pub value: f64,
    /// Whether it will do.
    pub passed: bool,
}

impl Judged {
    /// The verdict of every check. Where the run failed, none passes, whatever its value.
    #[must_use]
    pub fn rows(&self) -> Vec<Row<'_>> {
        let values = self.solved.values.iter().copied();
        let values = values.chain(std::iter::repeat(f64::NAN));
        let row = |(check, value): (_, f64)| Row {
            check,
            value,
            passed: self.solved.failure.is_none() && Check::accepts(check, value),
        };
        self.setup.checks.iter().zip(values).map(row).collect()
    }

    /// Whether the run converged, there is something to compare, and everything agrees.
    #[must_use]
    pub fn passed(&self) -> bool {
        let rows = self.rows();
        self.solved.failure.is_none() && !rows.is_empty() && rows.iter().all(|row| row.passed)
    }
}

/// The exit code for a set of verdicts: 0 where everything passed and there is something, else 1.
#[must_use]
pub fn exit_code(judged: &[Judged]) -> u8 {
    u8::from(judged.is_empty() || !judged.iter().all(Judged::passed))
}

/// Poses, runs and judges a problem, on the threads of the pool that calls.
#[must_use]
pub fn solve(problem: &Problem) -> Judged {
    solve_as(problem, problem.setup(), Frames::None)
}

/// Whether a run writes frames, for pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frames {
    /// No frames.
    None,
    /// Those of the case.
    Written,
}

/// Runs and judges a problem in a setup that may differ from its own.
#[must_use]
pub fn solve_as(problem: &Problem, setup: Setup, frames: Frames) -> Judged {
    let clock = Instant::now();
    let files: Arc<dyn Fs> = Arc::new(MemoryFs::default());
    let mut solved = Solved {
        failure: None,
        values: Vec::new(),
        seconds: 0.0,
        effort: [0; 2],
        files,
        folder: PathBuf::from(format!("{}.out", problem.name)),
    };
    if let Err(why) = run(problem, &setup, frames, &mut solved) {
        solved.failure = Some(why);
    }
    solved.seconds = clock.elapsed().as_secs_f64();
    Judged {
        problem: *problem,
        setup,
        solved,
    }
}

fn run(
    problem: &Problem,
    setup: &Setup,
    frames: Frames,
    solved: &mut Solved,
) -> Result<(), String> {
    let refused = |found: Diagnostics| format!("refused: {}", first_line(&found));
    let text = setup.text(problem.title, Expectations::Read);
    let path = format!("{}.toml", problem.name);
    let opened = open_text(Path::new(&path), text.into_bytes(), &Reading::default());
    let loaded = opened
        .and_then(signorini::Opened::with_mesh)
        .map_err(refused)?;
    let mut model = build(loaded.case, loaded.mesh).map_err(refused)?;
    problem.name.clone_into(&mut model.name);
    if frames == Frames::None {
        model.case.output.format.clear();
    }
    let mut options = RunOptions::new(loaded.source);
    options.folder.clone_from(&solved.folder);
    options.fs = Arc::clone(&solved.files);
    options.strict = true;
    let finished = signorini::solve(model, &options, &mut ());
    let summary = &finished.summary;
    for step in &summary.steps {
        solved.effort[0] += step.increments;
        solved.effort[1] += step.iterations;
    }
    let mut got = summary.expectations.iter().map(|one| one.got);
    for check in &setup.checks {
        let answers: Vec<f64> = got.by_ref().take(check.asks.len()).collect();
        solved.values.push(check.value(&answers));
    }
    if finished.exit_code != 0 {
        let why = first_line(&finished.diagnostics);
        return Err(format!("{}: {why}", summary.status));
    }
    if !summary.audit.passed {
        return Err("the audit of its states doubts it".to_owned());
    }
    Ok(())
}

/// The first error, else the first finding, in one line.
fn first_line(found: &Diagnostics) -> String {
    let text = found.plain();
    let error = text.lines().find(|line| line.starts_with("error"));
    error
        .or_else(|| text.lines().next())
        .unwrap_or("")
        .to_owned()
}

/// Runs problems, as many at a time as there are workers, each on one thread; results come in the order of the problems and
/// do not depend on the number of workers. `done` hears of every problem as it ends.
///
/// # Errors
/// A pool of threads that the system refuses.
pub fn solve_all(
    problems: &[Problem],
    nworker: usize,
    frames: Frames,
    done: &(dyn Fn(&Judged) + Sync),
) -> Result<Vec<Judged>, rayon::ThreadPoolBuildError> {
    let next = AtomicUsize::new(0);
    let results: Mutex<Vec<(usize, Judged)>> = Mutex::new(Vec::new());
    let work = || -> Result<(), rayon::ThreadPoolBuildError> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(1)
            .stack_size(signorini::threads::STACK)
            .build()?;
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            let Some(problem) = problems.get(at) else {
                break;
            };
            let judged = pool.install(|| solve_as(problem, problem.setup(), frames));
            done(&judged);
            let mut results = results.lock().unwrap_or_else(PoisonError::into_inner);
            results.push((at, judged));
        }
        Ok(())
    };
    let nworker = nworker.clamp(1, problems.len().max(1));
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..nworker).map(|_| scope.spawn(work)).collect();
        for worker in workers {
            match worker.join() {
                Ok(ended) => ended?,
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        Ok(())
    })?;
    let mut results = results.into_inner().unwrap_or_else(PoisonError::into_inner);
    results.sort_by_key(|(at, _)| *at);
    Ok(results.into_iter().map(|(_, judged)| judged).collect())
}
