//! `signorini run CASE`

use super::console::Console;
use super::job::{Job, refused};
use super::options::{CaseOptions, FolderOption, SolveOptions};
use super::ranks;
use super::signals::Signals;
use super::threads;
use clap::Args;
use signorini::load_case;
use signorini::resume::stopped_case;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Solve a case.
#[derive(Debug, Args)]
pub struct Run {
    /// The case, a .toml file; or a deck, .inp or .in
    case: PathBuf,
    #[command(flatten)]
    folder: FolderOption,
    /// Start even in a folder with results of another case
    #[arg(long)]
    fresh: bool,
    /// Go on from the last checkpoint of this case, where there is one; else start
    #[arg(long, conflicts_with_all = ["fresh", "dry_run"])]
    resume: bool,
    /// Build everything and stop before the first increment; nothing is written
    #[arg(long)]
    dry_run: bool,
    /// At the end, also of a run that fails, write report.html: one page that works offline
    #[arg(long)]
    report: bool,
    /// Formats of the frames, in place of those that the case names: vtu, frd, or both
    #[arg(long, value_name = "FORMAT", value_delimiter = ',', value_parser = ["vtu", "frd"])]
    format: Vec<String>,
    #[command(flatten)]
    changes: CaseOptions,
    #[command(flatten)]
    solve: SolveOptions,
}

impl Run {
    pub fn execute(self) -> u8 {
        let clock = Instant::now();
        let signals = Signals::taken();
        ranks::enter();
        let mut reading = self.changes.reading();
        if !self.format.is_empty() {
            reading
                .set
                .push(("output.format".into(), format!("{:?}", self.format)));
        }
        let opened = match ranks::all().agreed(load_case(&self.case, &reading)) {
            Ok(opened) => opened,
            Err(found) => return refused(&found, &self.solve),
        };
        if self.resume {
            let folder = self.folder.output.clone();
            let folder = folder.unwrap_or_else(|| opened.source.output_folder());
            match ranks::all().agreed(stopped_case(&*ranks::disk(), &folder, &opened.source)) {
                Err(found) => return refused(&found, &self.solve),
                Ok(Some(found)) => {
                    let code =
                        super::resume::go_on(found, folder.clone(), signals, clock, &self.solve);
                    return self.with_report(&folder, code);
                }
                Ok(None) => Console::stderr().line(&format!(
                    "there is no checkpoint of this case in {}: it starts",
                    folder.display()
                )),
            }
        }
        let nthread = threads::make(self.solve.threads, opened.case.solver.threads);
        let loaded = match ranks::all().agreed(opened.with_mesh()) {
            Ok(loaded) => loaded,
            Err(found) => return refused(&found, &self.solve),
        };
        if self.dry_run {
            return super::check::preview(loaded);
        }
        let job = Job {
            warnings: loaded.warnings,
            case: loaded.case,
            mesh: loaded.mesh,
            source: loaded.source,
            folder: self.folder.output.clone(),
            fresh: self.fresh,
            resume: false,
            hold: None,
            threads: nthread,
            signals,
            clock,
            read_seconds: clock.elapsed().as_secs_f64(),
        };
        let folder = job.folder.clone();
        let folder = folder.unwrap_or_else(|| job.source.output_folder());
        let code = job.solve(&self.solve);
        self.with_report(&folder, code)
    }

    /// Writes the page of a run that ended with this exit code, where it is asked for, and returns the code.
    fn with_report(&self, folder: &Path, code: u8) -> u8 {
        // the page is made of what is on the disk
        match self.report && ranks::all().rank() == 0 {
            true => super::report::after_run(folder, code, self.solve.quiet || self.solve.json),
            false => code,
        }
    }
}
