//! `signorini status DIR`

use super::object::{self, Answer};
use clap::Args;
use signorini::status::status;
use signorini_io::fs::RealFs;
use std::path::PathBuf;

/// Say what a run has reached: while it goes on, after it was killed, and after its end.
#[derive(Debug, Args)]
pub struct Status {
    /// The folder with its results
    folder: PathBuf,
    /// The answer as one object of JSON on standard output
    #[arg(long)]
    json: bool,
}

impl Status {
    pub fn execute(self) -> u8 {
        let reached = status(&RealFs, &self.folder).map(|status| Answer {
            lines: status.lines(),
            members: object::members(&status),
            ..Answer::default()
        });
        object::print("status", reached, self.json)
    }
}
