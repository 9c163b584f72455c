//! `signorini check CASE`

use super::console::Console;
use super::findings::{joined, not_written};
use super::options::{CaseOptions, FolderOption};
use clap::Args;
use signorini::preview::{self, Preview};
use signorini::{Diagnostics, Model, build, load};
use signorini_geometry::mesh::Mesh;
use signorini_io::case::Case;
use signorini_io::diagnostic::{Diagnostic, codes};
use signorini_io::fs::{Fs, FsError, RealFs};
use std::path::{Path, PathBuf};

/// Read everything, solve nothing.
#[derive(Debug, Args)]
pub struct Check {
    /// The case, a .toml file; or a deck, .inp
    case: PathBuf,
    #[command(flatten)]
    folder: FolderOption,
    /// Also write the initial state as one page that works offline
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    #[command(flatten)]
    changes: CaseOptions,
}

impl Check {
    pub fn execute(self) -> u8 {
        match load(&self.case, &self.changes.reading()) {
            Ok(loaded) => preview(
                loaded.case,
                loaded.mesh,
                loaded.warnings,
                self.folder.output.as_deref(),
                self.report.as_deref(),
            ),
            Err(found) => refused(&found),
        }
    }
}

/// Builds a case and reports what would be solved; draws it where there is a folder, and writes a page where one is named.
pub fn preview(
    case: Case,
    mesh: Mesh,
    warnings: Diagnostics,
    folder: Option<&Path>,
    report: Option<&Path>,
) -> u8 {
    let mut model = match build(case, mesh) {
        Ok(model) => model,
        Err(found) => return refused(&joined(warnings, found)),
    };
    let mut found = joined(warnings, std::mem::take(&mut model.warnings));
    let is_by_contact = |one: &Diagnostic| one.code.id == codes::HELD_BY_CONTACT.id;
    let is_held = !found.iter().any(is_by_contact);
    let output = signorini::run::check_output(&model);
    let preview = match preview::preview(&mut model) {
        Ok(preview) if output.is_ok() => preview,
        seen => {
            for wrong in [output.err(), seen.err()].into_iter().flatten() {
                found.append(wrong);
            }
            return refused(&found);
        }
    };
    Console::stderr().findings(&found);
    let out = Console::stdout();
    for line in &preview.lines {
        out.line(line);
    }
    if is_held {
        out.line("supports hold every body");
    }
    if let Some(folder) = folder {
        let path = folder.join("check.vtu");
        let written = preview::picture(&model, &preview)
            .map_err(|error| Diagnostic::error(&codes::NOT_WRITTEN, error.to_string()))
            .and_then(|bytes| write(&path, &bytes).map_err(|e| not_written(&e)));
        match written {
            Ok(()) => out.line(&format!("→ {}", path.display())),
            Err(one) => return refused(&one.into()),
        }
    }
    if let Some(path) = report {
        match page(&model, &preview, &found, is_held, path) {
            Ok(()) => out.line(&format!("→ {}", path.display())),
            Err(one) => return refused(&one.into()),
        }
    }
    out.line("✓ nothing wrong was found");
    0
}

/// Writes the initial state as a page.
fn page(
    model: &Model,
    preview: &Preview,
    found: &Diagnostics,
    is_held: bool,
    path: &Path,
) -> Result<(), Diagnostic> {
    let grid = preview::picture(model, preview)
        .map_err(|error| Diagnostic::error(&codes::NOT_WRITTEN, error.to_string()))?;
    let mut lines = preview.lines.clone();
    if is_held {
        lines.push("supports hold every body".to_owned());
    }
    let findings: Vec<String> = found
        .iter()
        .map(|one| Diagnostics::from(one.clone()).plain())
        .collect();
    let title = match model.case.title.is_empty() {
        true => &model.name,
        false => &model.case.title,
    };
    let bytes =
        signorini_report::check_page(title, &model.case.units.value, &grid, &lines, &findings);
    super::report::write(path, &bytes)
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), FsError> {
    RealFs.create_dir_all(path.parent().unwrap_or(Path::new(".")))?;
    RealFs.write_atomic(path, bytes)
}

fn refused(found: &Diagnostics) -> u8 {
    Console::stderr().findings(found);
    found.exit_code().unwrap_or(3)
}
