//! `signorini resume DIR`

use super::console::Console;
use super::job::{Job, refused};
use super::options::SolveOptions;
use super::signals::Signals;
use clap::Args;
use signorini::resume::{Stopped, stopped};
use signorini_io::fs::RealFs;
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
        match stopped(&RealFs, &self.folder) {
            Err(found) => refused(&found, &self.solve),
            Ok(Stopped::Done(summary)) => {
                let folder = self.folder.display();
                Console::stderr().line(&format!(
                    "nothing is left to do: the run in {folder} ended as \"{}\"",
                    summary.status
                ));
                summary.exit_code
            }
            Ok(Stopped::Open(loaded)) => Job {
                folder: Some(self.folder),
                resume: true,
                ..Job::new(*loaded, signals, clock, &self.solve)
            }
            .solve(&self.solve),
        }
    }
}
