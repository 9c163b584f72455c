//! A run: a model is solved, and everything that happens becomes files and news.
//!
//! ```text
//!            ┌── drive ─────────────────────────────────────────────────┐
//!  Model ──▶ │ Stepper ──solve::Event──▶ Recorder ──▶ files, through Fs │ ──▶ Finished
//!            │    ▲                         │                           │
//!            │    └── checkpoint, restart ──┤                           │
//!            └──────────────────────────────┼───────────────────────────┘
//!                                           └──▶ News ──▶ Listener
//! ```
//!
//! At any instant the folder is whole: frames are complete before a list names them, rows are whole, and of two
//! checkpoints one is good. After a checkpoint the run itself goes on from it, in the way a resumed run does: what
//! follows is the same to the last bit. For the same reason an interrupted run adds no checkpoint where none was due.
//!
//! To add a file: a line in `tree`, and its writing in `recorder`.

mod audit;
pub(crate) mod births;
mod by_points;
mod cells;
mod closure;
mod contact_surface;
mod drift;
mod drive;
mod error;
mod expectations;
mod failure;
mod fields;
mod frd;
mod frequencies;
mod heat;
mod history;
mod idle;
mod leaks;
mod limits;
pub mod narration;
mod news;
mod point;
mod probe;
mod recorder;
mod remedies;
pub(crate) mod solution;
mod start;
mod tables;
#[cfg(test)]
mod tests;
mod torn;
mod tree;
mod volume;
mod worn;
mod worst;

pub use by_points::solve;
pub use drive::run;
pub use error::{OutputError, bad_checkpoint, cannot_resume};
pub(crate) use failure::{Saved, message as failure_message};
pub use fields::Fields;
pub use limits::{Limits, Stop};
pub use news::{Detail, Effort, Facts, Listener, News, Totals, event_of, tell};
pub use point::element_named;
pub use start::{Start, begin, facts};
pub use tree::{Owner, Tree, case_copy, hold, killed_after, process_in};
pub use volume::Volume;

use crate::load::Source;
use crate::own::Own;
use crate::ranks::LockStep;
use crate::setup::Model;
use signorini_io::diagnostic::Diagnostics;
use signorini_io::fs::{Fs, RealFs};
use signorini_io::writers::json::Summary;
use std::path::PathBuf;
use std::sync::Arc;

/// What a run is given besides its model.
///
/// # Example
/// ```
/// use signorini::{Reading, RunOptions, build, load, solve};
///
/// let text = r#"
/// [mesh]
/// nodes = [
///   [1, 0.0, 0.0], [2, 1.0, 0.0], [3, 1.0, 1.0], [4, 0.0, 1.0],
/// ]
/// elements = [{ id = 1, type = "quad4", group = "plate", nodes = [1, 2, 3, 4] }]
/// [model]
/// space = "plane-stress"
/// [sets]
/// base = { nodes = [1, 2] }
/// head = { nodes = [3, 4] }
/// [material.soft]
/// model = "linear-elastic"
/// E = 1000.0
/// nu = 0.0
/// [[body]]
/// group = "plate"
/// material = "soft"
/// [[step]]
/// name = "pull"
/// geometry = "linear"
/// fix = [{ on = "base", u = "all" }]
/// move = [{ on = "head", ux = 0.0, uy = 0.01 }]
/// [[expect]]
/// what = "reaction_force.y @ set head"
/// value = 10.0
/// tol = { abs = 1e-6 }
/// "#;
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("plate.toml");
/// std::fs::write(&path, text)?;
/// let loaded = load(&path, &Reading::default())?;
/// let options = RunOptions::new(loaded.source);
/// let finished = solve(build(loaded.case, loaded.mesh)?, &options, &mut ());
/// // solved, and the reaction is E A u/L as expected
/// assert_eq!(finished.exit_code, 0);
/// assert!(folder.path().join("plate.out/results.pvd").exists());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct RunOptions {
    /// Where the model comes from.
    pub source: Source,
    /// What the case names by `own`: where the model is built again, it is with this.
    pub own: Own,
    /// The folder for the results.
    pub folder: PathBuf,
    /// Start even in a folder of another case.
    pub fresh: bool,
    /// Go on from the last checkpoint in the folder.
    pub resume: bool,
    /// Stop behind this many steps, resumable; all of them where there are no more.
    pub steps: Option<usize>,
    /// Whether a run whose audit finds something wrong ends with exit code 1.
    pub strict: bool,
    /// What was unusual when the case was read.
    pub warnings: Diagnostics,
    /// What stops it from outside.
    pub limits: Limits,
    /// The disk; that of rank 0.
    pub fs: Arc<dyn Fs>,
    /// The processes that all run this, with listeners of one kind.
    pub ranks: Arc<LockStep>,
    /// How many threads there are, for the records.
    pub threads: usize,
    /// Seconds that reading and building took, for the records.
    pub seconds: [f64; 2],
}

impl RunOptions {
    /// A run into the usual folder of its case.
    #[must_use]
    pub fn new(source: Source) -> Self {
        Self {
            folder: source.output_folder(),
            source,
            own: Own::default(),
            fresh: false,
            resume: false,
            steps: None,
            strict: false,
            warnings: Diagnostics::default(),
            limits: Limits::default(),
            fs: Arc::new(RealFs),
            ranks: Arc::default(),
            threads: rayon::current_num_threads(),
            seconds: [0.0; 2],
        }
    }
}

/// Checks what a case asks to be written: fields, histories, expectations.
///
/// # Errors
/// What names nothing.
pub fn check_output(model: &Model) -> Result<(), Diagnostics> {
    recorder::Setting::check(model).map(|_| ())
}

/// The status of a run that never began.
pub const NOT_STARTED: &str = "not started";

/// How a run ended.
#[derive(Clone, Debug)]
pub struct Finished {
    /// The exit code of the program: 0 solved, 1 an expectation failed, 5 not converged, 6 not written, …
    pub exit_code: u8,
    /// Errors and warnings.
    pub diagnostics: Diagnostics,
    /// What `summary.json` says.
    pub summary: Summary,
    /// Whether an attempt at an increment failed.
    pub(super) in_trouble: bool,
}
