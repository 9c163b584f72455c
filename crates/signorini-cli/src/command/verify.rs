//! `signorini verify [--quick]`

use super::console::Console;
use super::exit::WRONG_COMMAND;
use super::findings::not_written;
use clap::Args;
use signorini::crash;
use signorini::threads::count;
use signorini_io::fs::{Fs, FsError, RealFs};
use signorini_report::{PictureOptions, picture};
use signorini_verification::report::{self, Signs};
use signorini_verification::{Frames, Judged, Problem, exit_code, problems, solve_all};
use std::path::PathBuf;
use std::time::Instant;

/// Run problems with known answers on this machine and compare.
#[derive(Debug, Args)]
#[command(after_help = "\
Every value is labelled by its reference: ANALYTICAL, a closed form; PUBLISHED, a number in print; CROSS-CODE, another program;\n\
REGRESSION, a converged result of this program. A value counts only where its run converged and its audit doubts nothing.\n\n\
Exit codes: 0 everything agrees, 1 something does not, 2 command line, 6 not written")]
pub struct Verify {
    /// Only the quick problems
    #[arg(long)]
    quick: bool,
    /// Only problems whose name has this in it; may be given several times
    #[arg(long, value_name = "NAME")]
    only: Vec<String>,
    /// One JSON object on standard output instead of the table
    #[arg(long)]
    json: bool,
    /// Also write the table as an HTML page
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Also write the verification manual: pages in Markdown with pictures, and the cases
    #[arg(long, value_name = "DIR")]
    manual: Option<PathBuf>,
    /// Print the problems as a table in Markdown, and run none
    #[arg(long, conflicts_with_all = ["json", "html", "manual"])]
    list: bool,
    /// Number of problems at a time; results do not depend on it
    #[arg(short = 'j', long, value_name = "N", env = "SIGNORINI_THREADS", value_parser = clap::value_parser!(u64).range(1..=4096))]
    threads: Option<u64>,
}

impl Verify {
    pub fn execute(self) -> u8 {
        let (out, notes) = (Console::stdout(), Console::stderr());
        let wanted = match self.wanted() {
            Ok(wanted) => wanted,
            Err(why) => {
                notes.line(&format!("error: {why}"));
                return WRONG_COMMAND;
            }
        };
        if self.list {
            out.text(&report::list(&wanted));
            return 0;
        }
        let signs = signs();
        let clock = Instant::now();
        if !self.json {
            out.text(&report::head());
        }
        let tell = |judged: &Judged| {
            if !self.json {
                out.text(&report::problem(judged, signs));
            }
        };
        let frames = match self.manual {
            Some(_) => Frames::Written,
            None => Frames::None,
        };
        let judged = match solve_all(&wanted, count(self.threads), frames, &tell) {
            Ok(judged) => judged,
            Err(error) => {
                notes.line(&format!("error: no threads: {error}"));
                return crash::EXIT_CODE;
            }
        };
        let seconds = clock.elapsed().as_secs_f64();
        if self.json {
            out.raw(&format!("{}\n", report::json(&judged, seconds)));
        } else {
            out.text(&report::ending(&judged, seconds, signs));
        }
        match self.write(&judged, seconds) {
            Ok(()) => exit_code(&judged),
            Err(error) => {
                notes.findings(&not_written(&error).into());
                FsError::EXIT_CODE
            }
        }
    }

    /// The problems that are asked for.
    fn wanted(&self) -> Result<Vec<Problem>, String> {
        let all = problems().iter();
        for name in &self.only {
            if !all.clone().any(|problem| problem.name.contains(name)) {
                let names = problems().iter().map(|problem| problem.name);
                let near = signorini_io::diagnostic::closest(name, names);
                let hint = near.map_or_else(String::new, |near| format!("; did you mean {near}?"));
                return Err(format!("there is no problem \"{name}\"{hint}"));
            }
        }
        // a whole name means that problem alone, a part of one all problems that have it
        let is_whole = |name: &str| problems().iter().any(|problem| problem.name == name);
        let means = |problem: &Problem, name: &str| match is_whole(name) {
            true => problem.name == name,
            false => problem.name.contains(name),
        };
        let named = |problem: &&Problem| {
            self.only.is_empty() || self.only.iter().any(|name| means(problem, name))
        };
        let wanted = all
            .filter(named)
            .filter(|problem| problem.quick || !self.quick);
        let wanted: Vec<Problem> = wanted.copied().collect();
        if wanted.is_empty() {
            return Err("none of these problems is a quick one".to_owned());
        }
        Ok(wanted)
    }

    /// The files that are asked for.
    fn write(&self, judged: &[Judged], seconds: f64) -> Result<(), FsError> {
        if let Some(path) = &self.html {
            RealFs.write_atomic(path, report::html(judged, seconds).as_bytes())?;
        }
        if let Some(folder) = &self.manual {
            report::manual(&RealFs, folder, judged, &draw)?;
        }
        Ok(())
    }
}

/// A picture of the last frame; none of a run that left none.
fn draw(judged: &Judged) -> Option<Vec<u8>> {
    let options = PictureOptions {
        width: 900,
        height: 600,
        ..PictureOptions::default()
    };
    let solved = &judged.solved;
    picture(solved.files.as_ref(), &solved.folder, &options).ok()
}

/// What the locale of the terminal can show; files and pipes take all signs.
fn signs() -> Signs {
    let named = ["LC_ALL", "LC_CTYPE", "LANG"];
    let mut set = named
        .iter()
        .filter_map(std::env::var_os)
        .filter(|value| !value.is_empty());
    let locale = set
        .next()
        .map(|value| value.to_string_lossy().to_lowercase());
    let is_unicode =
        locale.is_none_or(|locale| locale.contains("utf-8") || locale.contains("utf8"));
    match is_unicode || !Console::stdout().terminal {
        true => Signs::Unicode,
        false => Signs::Ascii,
    }
}
