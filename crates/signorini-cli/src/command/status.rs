//! `signorini status DIR`

use super::console::Console;
use super::object;
use clap::Args;
use signorini::Diagnostics;
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
        match status(&RealFs, &self.folder) {
            Ok(status) if self.json => {
                let members = object::members(&status);
                object::answer("status", 0, &Diagnostics::new(), members)
            }
            Ok(status) => {
                let out = Console::stdout();
                status.lines().iter().for_each(|line| out.line(line));
                0
            }
            Err(found) if self.json => object::refused("status", &found),
            Err(found) => {
                Console::stderr().findings(&found);
                found.exit_code().unwrap_or(3)
            }
        }
    }
}
