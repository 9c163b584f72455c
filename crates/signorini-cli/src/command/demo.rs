//! `signorini demo [NAME]`

use super::console::Console;
use super::exit::WRONG_COMMAND;
use super::findings::not_written;
use super::init;
use super::job::{Job, refused};
use super::options::SolveOptions;
use super::report;
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
        let results = loaded.source.output_folder();
        let code = Job::new(loaded, signals, clock, &self.solve).solve(&self.solve);
        if code != 0 {
            return code;
        }
        let made = report::main_picture(&results, &results.join("picture.png"))
            .and_then(|picture| Ok([picture, report::page_of(&results)?]));
        let [picture, page] = match made {
            Ok(paths) => paths,
            Err(one) => {
                console.findings(&one.into());
                return FsError::EXIT_CODE;
            }
        };
        console.line(&format!("  case     {}", path.display()));
        console.line(&format!("  page     {}", page.display()));
        console.line(&format!("  picture  {}", picture.display()));
        code
    }
}
