//! `signorini check CASE`

use super::findings::joined;
use super::object::{self, Answer, Members};
use super::options::{CaseOptions, FolderOption};
use super::ranks;
use super::report::write_on;
use clap::Args;
use serde_json::{Value, json};
use signorini::preview::{self, Preview};
use signorini::{Diagnostics, Loaded, Model, build, load};
use signorini_geometry::mesh::quality::Quality;
use signorini_io::diagnostic::{Diagnostic, codes};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Read everything, solve nothing.
#[derive(Debug, Args)]
pub struct Check {
    /// The case, a .toml file; or a deck, .inp
    case: PathBuf,
    #[command(flatten)]
    folder: FolderOption,
    /// The answer as one object of JSON on standard output
    #[arg(long)]
    json: bool,
    /// Also write the initial state as one page that works offline
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    #[command(flatten)]
    changes: CaseOptions,
}

impl Check {
    pub fn execute(self) -> u8 {
        ranks::enter();
        let files = Files {
            folder: self.folder.output.as_deref(),
            page: self.report.as_deref(),
        };
        let loaded = ranks::all().agreed(load(&self.case, &self.changes.reading()));
        let looked = loaded.and_then(|case| look(case, &files));
        object::print("check", looked, self.json)
    }
}

/// What a look at a case leaves, where it is asked for.
#[derive(Default)]
struct Files<'a> {
    /// The folder of `check.vtu`.
    folder: Option<&'a Path>,
    /// The page of the initial state.
    page: Option<&'a Path>,
}

/// Builds a case and reports what would be solved.
pub fn preview(loaded: Loaded) -> u8 {
    object::print("check", look(loaded, &Files::default()), false)
}

/// Builds a case and looks at it; draws it where there is a folder, and writes a page where one is named.
fn look(loaded: Loaded, files: &Files<'_>) -> Result<Answer, Diagnostics> {
    let mut model = match build(loaded.case, loaded.mesh) {
        Ok(model) => model,
        Err(found) => return Err(joined(loaded.warnings, found)),
    };
    let mut found = joined(loaded.warnings, std::mem::take(&mut model.warnings));
    let is_held = model.held_by_contact.is_empty();
    let output = signorini::run::check_output(&model);
    let preview = match preview::preview(&mut model) {
        Ok(preview) if output.is_ok() => preview,
        seen => {
            for wrong in [output.err(), seen.err()].into_iter().flatten() {
                found.append(wrong);
            }
            return Err(found);
        }
    };
    let mut members = members(&model, &preview);
    members.insert("held_by_supports".into(), is_held.into());
    let mut lines = preview.lines.clone();
    let ranks = ranks::all().size();
    if ranks > 1 {
        lines.push(format!("{ranks} ranks"));
        members.insert("ranks".into(), json!(ranks));
    }
    if is_held {
        lines.push("supports hold every body".to_owned());
    }
    let failed = |one: Diagnostic| joined(found.clone(), one.into());
    let grid = || {
        preview::picture(&model, &preview)
            .map_err(|error| Diagnostic::error(&codes::NOT_WRITTEN, error.to_string()))
    };
    if let Some(folder) = files.folder {
        let path = folder.join("check.vtu");
        let written = grid().and_then(|bytes| write(&path, &bytes));
        written.map_err(failed)?;
        lines.push(format!("→ {}", path.display()));
        members.insert("picture".into(), json!(path));
    }
    if let Some(path) = files.page {
        let written = grid().and_then(|grid| page(&model, &grid, &lines, &found, path));
        written.map_err(failed)?;
        lines.push(format!("→ {}", path.display()));
        members.insert("report".into(), json!(path));
    }
    lines.push("✓ nothing wrong was found".to_owned());
    Ok(Answer {
        found,
        lines,
        members,
    })
}

/// Writes the initial state as a page.
fn page(
    model: &Model,
    grid: &[u8],
    lines: &[String],
    found: &Diagnostics,
    path: &Path,
) -> Result<(), Diagnostic> {
    let findings = found
        .iter()
        .map(|one| Diagnostics::from(one.clone()).plain());
    let findings: Vec<String> = findings.collect();
    let title = match model.case.title.is_empty() {
        true => &model.name,
        false => &model.case.title,
    };
    let units = &model.case.units.value;
    let bytes = signorini_report::check_page(title, units, grid, lines, &findings);
    write(path, &bytes)
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Diagnostic> {
    write_on(ranks::disk().as_ref(), path, bytes)
}

/// Sizes, bodies, contacts and cost, for machines; with the lines for people.
fn members(model: &Model, preview: &Preview) -> Members {
    let mesh = &model.mesh;
    let mut elements = BTreeMap::new();
    let solids = mesh.blocks.iter().filter(|b| b.element.dim() == mesh.dim());
    for block in solids {
        *elements.entry(block.element.name()).or_insert(0) += block.ncell();
    }
    let quality = preview.quality.as_ref().map(shapes);
    let bodies = model.case.bodies.iter().map(|body| {
        let groups: Vec<&str> = body.groups.iter().map(|g| g.value.as_str()).collect();
        let material = body.material.as_ref().map(|m| m.value.clone());
        json!({ "groups": groups, "material": material, "rigid": body.rigid })
    });
    let bodies: Vec<Value> = bodies.collect();
    let contacts = model.contacts.iter().map(|contact| {
        json!({
            "name": contact.name,
            "method": contact.method,
            "enforcement": contact.enforcement,
            "sliding": contact.sliding,
            "points": contact.npoint,
            "facets": contact.nfacet,
            "facet_size": contact.facet_size,
            "gap_min": contact.start.gap,
            "touching": contact.start.touching,
        })
    });
    let contacts: Vec<Value> = contacts.collect();
    let steps: Vec<&str> = model.steps.iter().map(|s| s.name.as_str()).collect();
    object::members(&json!({
        "title": model.case.title,
        "nodes": mesh.nnode(),
        "elements": elements,
        "unknowns": preview.start.nunknown,
        "quality": quality,
        "bodies": bodies,
        "contacts": contacts,
        "steps": steps,
        "locking": model.remedies(),
        "cost": preview.estimate,
        "lines": preview.lines,
    }))
}

/// The shapes of elements, as members of an object.
pub(super) fn shapes(quality: &Quality) -> Value {
    json!({
        "scaled_jacobian_min": quality.scaled_jacobian.min,
        "scaled_jacobian_mean": quality.scaled_jacobian.mean,
        "edge_ratio_min": quality.edge_ratio.min,
        "inverted": quality.nbad,
    })
}
