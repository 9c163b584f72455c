//! `signorini demo [NAME]`

use super::console::Console;
use super::exit::WRONG_COMMAND;
use super::findings::not_written;
use super::init;
use super::job::{Job, refused};
use super::options::SolveOptions;
use super::signals::Signals;
use super::templates::{self, TEMPLATES};
use clap::Args;
use signorini::{Reading, load};
use signorini_io::fs::FsError;
use std::time::Instant;

/// Run an example and compare with its expected values.
#[derive(Debug, Args)]
pub struct Demo {
    /// Which one; see signorini init --list
    #[arg(default_value = TEMPLATES[0].name)]
    name: String,
    #[command(flatten)]
    solve: SolveOptions,
}

impl Demo {
    pub fn execute(self) -> u8 {
        let console = Console::stderr();
        let Some(template) = templates::find(&self.name) else {
            console.line(&format!("error: {}", templates::unknown(&self.name)));
            return WRONG_COMMAND;
        };
        let clock = Instant::now();
        let signals = Signals::taken();
        let folder = std::env::temp_dir().join(format!("signorini-demo-{}", std::process::id()));
        let path = match init::write(&folder, template) {
            Ok(path) => path,
            Err(error) => {
                console.findings(&not_written(&error).into());
                return FsError::EXIT_CODE;
            }
        };
        console.line(&format!("{}: {}", template.name, template.about));
        let loaded = match load(&path, &Reading::default()) {
            Ok(loaded) => loaded,
            Err(found) => return refused(&found, &self.solve),
        };
        let script = loaded.source.output_folder().join("view.py");
        let code = Job::new(loaded, signals, clock, &self.solve).solve(&self.solve);
        if code == 0 {
            console.line(&format!("  case      {}", path.display()));
            console.line(&format!("  pictures  pvpython {}", script.display()));
        }
        code
    }
}
