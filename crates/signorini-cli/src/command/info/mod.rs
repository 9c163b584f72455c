//! `signorini info FILE|DIR`

mod fields;
mod mesh;

use super::console::Console;
use super::object::{self, Members};
use clap::Args;
use fields::Field;
use mesh::Content;
use serde::Serialize;
use serde_json::json;
use signorini::status::{Status, status};
use signorini::text::plural;
use signorini::{Diagnostics, Reading, load};
use signorini_io::diagnostic::{Diagnostic, codes};
use signorini_io::fs::{Fs, RealFs};
use signorini_io::readers;
use signorini_io::writers::pvd::Pvd;
use signorini_io::writers::vtu::{self, Vtu};
use std::path::{Path, PathBuf};

/// List the content of a mesh, a case, or a folder of results.
#[derive(Debug, Args)]
pub struct Info {
    /// A mesh, a case (.toml), a .vtu or .frd file, or a folder of results
    path: PathBuf,
    /// The answer as one object of JSON on standard output
    #[arg(long)]
    json: bool,
}

/// What was found: lines for people, members for machines.
#[derive(Debug, Default)]
struct Told {
    lines: Vec<String>,
    members: Members,
}

impl Told {
    fn of_mesh(content: &Content) -> Self {
        let mut told = Self {
            lines: content.lines(),
            members: Members::new(),
        };
        told.put("mesh", content);
        told
    }

    fn put(&mut self, name: &str, value: &impl Serialize) {
        self.members.insert(name.into(), json!(value));
    }

    fn fields(&mut self, fields: &[Field]) {
        self.lines.extend(fields.iter().flat_map(Field::lines));
        self.put("fields", &fields);
    }
}

impl Info {
    pub fn execute(self) -> u8 {
        let told = if self.path.is_dir() {
            results(&self.path)
        } else {
            let extension = self.path.extension().map(|e| e.to_ascii_lowercase());
            match extension.as_deref().and_then(|e| e.to_str()) {
                Some("toml") => load(&self.path, &Reading::default())
                    .map(|loaded| Told::of_mesh(&Content::new(&loaded.mesh, Vec::new()))),
                Some("vtu") => grid_file(&self.path).map_err(Diagnostics::from),
                Some("frd") => frd_file(&self.path).map_err(Diagnostics::from),
                _ => mesh_file(&self.path).map_err(Diagnostics::from),
            }
        };
        match told {
            Ok(told) if self.json => object::answer("info", 0, &Diagnostics::new(), told.members),
            Ok(told) => {
                let out = Console::stdout();
                told.lines.iter().for_each(|line| out.line(line));
                0
            }
            Err(found) if self.json => object::refused("info", &found),
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

fn mesh_file(path: &Path) -> Result<Told, Diagnostic> {
    let bytes = read(path)?;
    let (found, notes) = readers::read_mesh(&path.display().to_string(), &bytes)
        .map_err(|error| Diagnostic::error(&codes::BAD_MESH, error.to_string()))?;
    let notes = notes.iter().map(ToString::to_string).collect();
    Ok(Told::of_mesh(&Content::new(&found, notes)))
}

/// The mesh of a file of all frames, and the data sets at its last time with their ranges.
fn frd_file(path: &Path) -> Result<Told, Diagnostic> {
    let mut told = mesh_file(path)?;
    let frd = readers::frd::parse(&read(path)?).map_err(|error| {
        Diagnostic::error(&codes::UNREADABLE, format!("{}, {error}", path.display()))
    })?;
    let Some(last) = frd.datasets.last() else {
        return Ok(told);
    };
    told.lines.push(format!(
        "results at time {}, step {}, increment {}:",
        last.time, last.step, last.increment
    ));
    told.put("time", &last.time);
    let datasets = frd.datasets.iter().filter(|one| one.time == last.time);
    let fields: Vec<Field> = datasets.map(fields::of_dataset).collect();
    told.fields(&fields);
    Ok(told)
}

/// How a run ended, its times, and the fields of its last frame.
fn results(folder: &Path) -> Result<Told, Diagnostics> {
    let status: Status = status(&RealFs, folder)?;
    let mut told = Told {
        lines: status.lines(),
        members: object::members(&status),
    };
    // a run that writes no frames for ParaView has no list of them
    let Ok(list) = Pvd::read(&RealFs, &folder.join("results.pvd")) else {
        return Ok(told);
    };
    let entries = list.entries();
    let times: Vec<f64> = entries.iter().map(|entry| entry.time).collect();
    told.put("times", &times);
    if let (Some(first), Some(last)) = (entries.first(), entries.last()) {
        told.lines.push(format!(
            "{}, time {} to {}",
            plural(entries.len(), "frame"),
            first.time,
            last.time
        ));
        told.lines
            .push(format!("fields of the last frame, {}:", last.file));
        told.fields(&fields::of_grid(&grid(&folder.join(&last.file))?));
    }
    let contact = Pvd::read(&RealFs, &folder.join("contact.pvd"));
    if let Ok(list) = contact
        && let Some(last) = list.entries().last()
    {
        let fields = fields::of_grid(&grid(&folder.join(&last.file))?);
        told.lines
            .push(format!("fields of contact, {}:", last.file));
        told.lines.extend(fields.iter().flat_map(Field::lines));
        told.put("contact_fields", &fields);
    }
    Ok(told)
}

/// The mesh of a grid, and its arrays.
fn grid_file(path: &Path) -> Result<Told, Diagnostic> {
    let grid = grid(path)?;
    // frames of contact alone hold no cells of a mesh: they have fields nevertheless
    let mut told = match readers::vtu::from_grid(&path.display().to_string(), &grid) {
        Ok((found, notes)) => {
            let notes = notes.iter().map(ToString::to_string).collect();
            Told::of_mesh(&Content::new(&found, notes))
        }
        Err(error) => Told {
            lines: vec![format!("no mesh: {error}")],
            ..Told::default()
        },
    };
    told.fields(&fields::of_grid(&grid));
    Ok(told)
}

fn grid(path: &Path) -> Result<Vtu, Diagnostic> {
    let bytes = read(path)?;
    vtu::read(&bytes).map_err(|error| {
        Diagnostic::error(&codes::UNREADABLE, format!("{}: {error}", path.display()))
    })
}
