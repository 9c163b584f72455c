//! `signorini run CASE`

use super::job::{Job, refused};
use super::options::{CaseOptions, FolderOption, SolveOptions};
use super::signals::Signals;
use super::threads;
use clap::Args;
use signorini::load_case;
use std::path::PathBuf;
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
        let mut reading = self.changes.reading();
        if !self.format.is_empty() {
            reading
                .set
                .push(("output.format".into(), format!("{:?}", self.format)));
        }
        let opened = match load_case(&self.case, &reading) {
            Ok(opened) => opened,
            Err(found) => return refused(&found, &self.solve),
        };
        let nthread = threads::make(self.solve.threads, opened.case.solver.threads);
        let loaded = match opened.with_mesh() {
            Ok(loaded) => loaded,
            Err(found) => return refused(&found, &self.solve),
        };
        let job = Job {
            warnings: loaded.warnings,
            case: loaded.case,
            mesh: loaded.mesh,
            source: loaded.source,
            folder: self.folder.output,
            fresh: self.fresh,
            resume: false,
            threads: nthread,
            signals,
            clock,
            read_seconds: clock.elapsed().as_secs_f64(),
        };
        if self.dry_run {
            return super::check::preview(job.case, job.mesh, job.warnings, None, None);
        }
        if !self.report {
            return job.solve(&self.solve);
        }
        let folder = job.folder.clone();
        let folder = folder.unwrap_or_else(|| job.source.output_folder());
        let code = job.solve(&self.solve);
        super::report::after_run(&folder, code, self.solve.quiet || self.solve.json)
    }
}
