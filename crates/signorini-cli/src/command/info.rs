//! `signorini info FILE|DIR`

use super::console::Console;
use clap::Args;
use signorini::run::{Owner, Stop, process_in};
use signorini::text::{count, plural, short};
use signorini::{Diagnostics, Reading, load};
use signorini_geometry::mesh::Mesh;
use signorini_io::diagnostic::{Diagnostic, codes};
use signorini_io::fs::{Fs, RealFs};
use signorini_io::readers::{self, Severity};
use signorini_io::writers::json::Summary;
use signorini_io::writers::pvd::Pvd;
use signorini_io::writers::vtu::{self, Vtu};
use std::path::{Path, PathBuf};

/// List the content of a mesh, a case, or a folder of results.
#[derive(Debug, Args)]
pub struct Info {
    /// A mesh, a case (.toml), a .vtu or .frd file, or a folder of results
    path: PathBuf,
}

impl Info {
    pub fn execute(self) -> u8 {
        let told = if self.path.is_dir() {
            results(&self.path)
        } else {
            let extension = self.path.extension().map(|e| e.to_ascii_lowercase());
            match extension.as_deref().and_then(|e| e.to_str()) {
                Some("toml") => {
                    load(&self.path, &Reading::default()).map(|loaded| mesh(&loaded.mesh))
                }
                Some("vtu") => grid_file(&self.path).map_err(Diagnostics::from),
                Some("frd") => frd_file(&self.path).map_err(Diagnostics::from),
                _ => mesh_file(&self.path).map_err(Diagnostics::from),
            }
        };
        match told {
            Ok(lines) => {
                let out = Console::stdout();
                lines.iter().for_each(|line| out.line(line));
                0
            }
            Err(found) => {
                Console::stderr().findings(&found);
                found.exit_code().unwrap_or(3)
            }
        }
    }
}

fn read(path: &Path) -> Result<Vec<u8>, Diagnostic> {
    RealFs.read(path).map_err(|error| {
        Diagnostic::error(&codes::UNREADABLE, error.to_string()).help(error.help())
    })
}

fn mesh_file(path: &Path) -> Result<Vec<String>, Diagnostic> {
    let bytes = read(path)?;
    let (found, notes) = readers::read_mesh(&path.display().to_string(), &bytes)
        .map_err(|error| Diagnostic::error(&codes::BAD_MESH, error.to_string()))?;
    let mut lines = mesh(&found);
    lines.extend(notes.iter().map(|note| format!("note: {note}")));
    Ok(lines)
}

/// The mesh of a file of all frames, and the data sets at its last time with their ranges.
fn frd_file(path: &Path) -> Result<Vec<String>, Diagnostic> {
    let mut lines = mesh_file(path)?;
    let frd = readers::frd::parse(&read(path)?).map_err(|error| {
        Diagnostic::error(&codes::UNREADABLE, format!("{}, {error}", path.display()))
    })?;
    let Some(last) = frd.datasets.last() else {
        return Ok(lines);
    };
    lines.push(format!(
        "results at time {}, step {}, increment {}:",
        last.time, last.step, last.increment
    ));
    for one in frd.datasets.iter().filter(|one| one.time == last.time) {
        let (low, high) = range(&one.values);
        lines.push(format!(
            "  {} ({}, {}): {} to {}",
            one.name,
            plural(one.nodes.len(), "node"),
            one.components.join(" "),
            short(low),
            short(high)
        ));
    }
    Ok(lines)
}

/// Nodes, cells, groups and their faults.
fn mesh(mesh: &Mesh) -> Vec<String> {
    let mut lines = vec![plural(mesh.nnode(), "node")];
    for block in &mesh.blocks {
        lines.push(format!("{} {}", count(block.ncell()), block.element.name()));
    }
    for axis in 0..3 {
        let values = mesh.points.iter().map(|x| x.to_array()[axis]);
        let low = values.clone().fold(f64::INFINITY, f64::min);
        let high = values.fold(f64::NEG_INFINITY, f64::max);
        if low < high {
            let name = ["x", "y", "z"][axis];
            lines.push(format!("{name} from {} to {}", short(low), short(high)));
        }
    }
    for (name, set) in &mesh.sets {
        let mut parts = Vec::new();
        for dim in (0..=3).rev() {
            let n = set
                .cells
                .iter()
                .filter(|cell| mesh.element(**cell).is_some_and(|e| e.dim() == dim));
            let noun = ["point", "line", "surface cell", "volume cell"][dim];
            match n.count() {
                0 => {}
                n => parts.push(plural(n, noun)),
            }
        }
        if !set.faces.is_empty() {
            parts.push(plural(set.faces.len(), "face"));
        }
        if !set.nodes.is_empty() {
            parts.push(plural(set.nodes.len(), "node"));
        }
        lines.push(format!("group {name}: {}", parts.join(", ")));
    }
    for issue in readers::validate(mesh) {
        let kind = match issue.severity() {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        let remedy = issue.remedy();
        let remedy = remedy.map_or_else(String::new, |remedy| format!("; {remedy}"));
        lines.push(format!("{kind}: {issue}{remedy}"));
    }
    lines
}

/// How a run ended, its times, and the fields of its last frame.
fn results(folder: &Path) -> Result<Vec<String>, Diagnostics> {
    let no_results = |why: String| {
        Diagnostic::error(
            &codes::UNREADABLE,
            format!("{} holds no results: {why}", folder.display()),
        )
    };
    let list = Pvd::read(&RealFs, &folder.join("results.pvd"));
    let mut lines = Vec::new();
    let process = process_in(&RealFs, folder).map_err(|error| no_results(error.to_string()))?;
    let summary = Summary::read(&RealFs, &folder.join("summary.json"));
    let resume = format!("signorini resume {}", folder.display());
    match (process, summary) {
        (Some(process), _) => lines.push(format!("running: process {process}")),
        (None, Ok(summary)) => {
            lines.extend(ending(&summary));
            if Stop::STATUSES.contains(&summary.status.as_str()) {
                lines.push(format!("stopped on request; to go on:  {resume}"));
            }
        }
        (None, Err(_)) if list.is_ok() || Owner::read(&RealFs, folder).is_some() => {
            lines.push(format!(
                "killed: no process writes here, and the run has no summary; to go on:  {resume}"
            ))
        }
        (None, Err(error)) => return Err(no_results(error.to_string()).into()),
    }
    // a run that writes no frames for ParaView has no list of them
    let Ok(list) = list else { return Ok(lines) };
    let entries = list.entries();
    if let (Some(first), Some(last)) = (entries.first(), entries.last()) {
        lines.push(format!(
            "{}, time {} to {}",
            plural(entries.len(), "frame"),
            first.time,
            last.time
        ));
        lines.push(format!("fields of the last frame, {}:", last.file));
        lines.extend(fields(&folder.join(&last.file))?);
    }
    Ok(lines)
}

fn ending(summary: &Summary) -> Vec<String> {
    let mut lines = vec![format!(
        "{} (exit code {})",
        summary.status, summary.exit_code
    )];
    for step in &summary.steps {
        lines.push(format!(
            "step {}: {}, {}, {}",
            step.name,
            plural(step.increments as usize, "increment"),
            plural(step.iterations as usize, "iteration"),
            plural(step.cutbacks as usize, "cut-back")
        ));
    }
    for (name, contact) in &summary.contacts {
        let [x, y, z] = contact.force.map(short);
        lines.push(format!(
            "contact {name}: force ({x}, {y}, {z}), largest pressure {}, smallest gap {}",
            short(contact.pressure_max),
            short(contact.gap_min)
        ));
    }
    for one in &summary.expectations {
        let sign = if one.ok { "✓" } else { "✗" };
        lines.push(format!(
            "expect {}: {} for {}  {sign}",
            one.what, one.got, one.value
        ));
    }
    lines
}

/// The mesh of a grid, and its arrays.
fn grid_file(path: &Path) -> Result<Vec<String>, Diagnostic> {
    let grid = grid(path)?;
    // frames of contact alone hold no cells of a mesh: they have fields nevertheless
    let mut lines = match readers::vtu::from_grid(&path.display().to_string(), &grid) {
        Ok((found, notes)) => {
            let notes = notes.iter().map(|note| format!("note: {note}"));
            mesh(&found).into_iter().chain(notes).collect()
        }
        Err(error) => vec![format!("no mesh: {error}")],
    };
    lines.extend(arrays(&grid));
    Ok(lines)
}

fn grid(path: &Path) -> Result<Vtu, Diagnostic> {
    let bytes = read(path)?;
    vtu::read(&bytes).map_err(|error| {
        Diagnostic::error(&codes::UNREADABLE, format!("{}: {error}", path.display()))
    })
}

/// The arrays of a frame with their ranges.
fn fields(path: &Path) -> Result<Vec<String>, Diagnostic> {
    Ok(arrays(&grid(path)?))
}

fn arrays(grid: &Vtu) -> Vec<String> {
    let mut lines = Vec::new();
    for (place, arrays) in [("node", &grid.point_data), ("cell", &grid.cell_data)] {
        for array in arrays {
            let (low, high) = range(&array.numbers.to_f64());
            let what = match array.ncomponent {
                1 => String::new(),
                n => format!(", {n} components"),
            };
            lines.push(format!(
                "  {} ({place}{what}): {} to {}",
                array.name,
                short(low),
                short(high)
            ));
        }
    }
    lines
}

/// Smallest and largest number; numbers that are none are left out.
fn range(values: &[f64]) -> (f64, f64) {
    let start = (f64::INFINITY, f64::NEG_INFINITY);
    let wider = |(low, high): (f64, f64), value: &f64| (low.min(*value), high.max(*value));
    values.iter().fold(start, wider)
}
