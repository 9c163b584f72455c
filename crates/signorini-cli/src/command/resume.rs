//! `signorini resume DIR`

use super::console::Console;
use super::job::{Job, refused};
use super::options::SolveOptions;
use super::ranks;
use super::signals::Signals;
use clap::Args;
use signorini::resume::{Stopped, stopped_and_held};
use signorini_io::fs::Lock;
use std::path::PathBuf;
use std::time::Instant;

/// Go on with a run that was stopped.
#[derive(Debug, Args)]
pub struct Resume {
    /// The folder with its results
    folder: PathBuf,
    #[command(flatten)]
    solve: SolveOptions,
}

impl Resume {
    pub fn execute(self) -> u8 {
        let clock = Instant::now();
        let signals = Signals::taken();
        ranks::enter();
        let stopped = stopped_and_held(&*ranks::disk(), &self.folder);
        match ranks::all().agreed(stopped) {
            Err(found) => refused(&found, &self.solve),
            Ok(found) => go_on(found, self.folder, signals, clock, &self.solve),
        }
    }
}

/// Goes on with what was found in a folder, and returns the exit code.
pub fn go_on(
    (found, hold): (Stopped, Option<Lock>),
    folder: PathBuf,
    signals: Signals,
    clock: Instant,
    options: &SolveOptions,
) -> u8 {
    match found {
        Stopped::Done(summary) => {
            Console::stderr().line(&format!(
                "nothing is left to do: the run in {} ended as \"{}\"",
                folder.display(),
                summary.status
            ));
            summary.exit_code
        }
        Stopped::Open(loaded) => Job {
            folder: Some(folder),
            resume: true,
            hold,
            ..Job::new(*loaded, signals, clock, options)
        }
        .solve(options),
    }
}
