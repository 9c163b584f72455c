//! `signorini ccx-compat -i JOB`

use super::console::Console;
use super::job::{Job, refused};
use super::options::SolveOptions;
use super::signals::Signals;
use clap::Args;
use signorini::{Compat, Reading, load};
use signorini_io::fs::{Fs, RealFs};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Stand in for CalculiX: its command line, file names and exit codes.
///
/// Solves JOB.inp with the laws of contact that the deck states, and writes JOB.dat, JOB.frd and JOB.sta next to it, for
/// programs that call `ccx -i JOB`. All other results are in JOB.out.
#[derive(Debug, Args)]
#[command(mut_arg("verbose", |verbose| verbose.short(None)))]
pub struct CcxCompat {
    /// The name of the deck, without .inp
    #[arg(short = 'i', value_name = "JOB", required_unless_present = "version")]
    job: Option<PathBuf>,
    /// Print the version
    #[arg(short = 'v')]
    version: bool,
    #[command(flatten)]
    solve: SolveOptions,
}

/// How CalculiX ends where it cannot go on.
const FATAL: u8 = 201;
/// The files that it leaves.
const LEFT: [&str; 3] = ["dat", "frd", "sta"];

impl CcxCompat {
    pub fn execute(self) -> u8 {
        let job = match self.job {
            Some(job) if !self.version => job,
            _ => {
                Console::stdout().line(concat!("This is Signorini ", env!("CARGO_PKG_VERSION")));
                return 0;
            }
        };
        let deck = match job.extension() {
            Some(extension) if extension.eq_ignore_ascii_case("inp") => job.clone(),
            _ => PathBuf::from(format!("{}.inp", job.display())),
        };
        // what an earlier run left would be taken for the result of this one
        for kind in LEFT {
            let _ = std::fs::remove_file(deck.with_extension(kind));
        }
        match solve(&deck, &self.solve) {
            0 | 1 => 0,
            _ => FATAL,
        }
    }
}

/// Solves a deck and copies what CalculiX would leave; the exit code of a run.
fn solve(deck: &Path, options: &SolveOptions) -> u8 {
    let clock = Instant::now();
    let signals = Signals::taken();
    let reading = Reading {
        set: vec![("output.format".into(), "[\"frd\"]".into())],
        compat: Some(Compat::Ccx),
    };
    let loaded = match load(deck, &reading) {
        Ok(loaded) => loaded,
        Err(found) => return refused(&found, options),
    };
    let folder = loaded.source.output_folder();
    let name = loaded.source.name.clone();
    let job = Job {
        fresh: true,
        ..Job::new(loaded, signals, clock, options)
    };
    let code = job.solve(options);
    for kind in LEFT {
        let from = folder.join(format!("{name}.{kind}"));
        if let Ok(bytes) = RealFs.read(&from)
            && let Err(error) = RealFs.write_atomic(&deck.with_extension(kind), &bytes)
        {
            Console::stderr().text(&format!("error: {error}\n"));
            return code.max(6);
        }
    }
    code
}
