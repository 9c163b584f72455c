//! `signorini mcp`: a server of the Model Context Protocol on standard input and output.

use super::console::Console;
use super::exit::WRONG_COMMAND;
use clap::Args;
use signorini_mcp::{Limits, Options, ServeError, serve};
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Serve agents: check and run cases and read results by the Model Context Protocol.
#[derive(Debug, Args)]
pub struct Mcp {
    /// The folder to work in; nothing outside of it is read or written
    #[arg(long, value_name = "DIR", default_value = ".")]
    root: PathBuf,
    /// Runs at once
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u16).range(1..=64))]
    runs: u16,
    /// The longest time that a run may be given: 90s, 10min, 2h
    #[arg(long, value_name = "TIME", default_value = "24h", value_parser = super::options::duration)]
    max_wall: f64,
}

impl Mcp {
    /// Serves until the client leaves. `program` is the first word of the command line.
    pub fn execute(self, program: &OsStr) -> u8 {
        let mut limits = Limits::default();
        limits.runs = usize::from(self.runs);
        limits.wall = Duration::from_secs_f64(self.max_wall.clamp(1.0, 1e9));
        let served = own(program).and_then(|command| {
            serve(Options {
                root: self.root,
                command: vec![command],
                limits,
            })
        });
        match served {
            Ok(()) => 0,
            Err(error) => {
                Console::stderr().line(&format!("error: {error}"));
                match error {
                    ServeError::Root { .. } => WRONG_COMMAND,
                    _ => 70,
                }
            }
        }
    }
}

/// The file that starts this command once more. A script that carries it, as the Python package has one, is the first word of
/// the command line with its folder; otherwise it is the running program.
fn own(program: &OsStr) -> Result<OsString, ServeError> {
    let named = Path::new(program);
    let has_folder = named.parent().is_some_and(|f| !f.as_os_str().is_empty());
    let found = if has_folder && named.is_file() {
        std::path::absolute(named)
    } else {
        std::env::current_exe()
    };
    found
        .map(PathBuf::into_os_string)
        .map_err(ServeError::Runtime)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_script_is_started_again_by_its_path_and_a_program_by_itself() {
        let folder = tempfile::tempdir().unwrap();
        let script = folder.path().join("signorini");
        std::fs::write(&script, "#!").unwrap();
        assert_eq!(own(script.as_os_str()).unwrap(), script.as_os_str());
        let running = std::env::current_exe().unwrap();
        for program in ["signorini", "", "no/such/signorini"] {
            assert_eq!(own(program.as_ref()).unwrap(), running.as_os_str());
        }
    }
}
