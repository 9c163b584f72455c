//! `signorini info FILE|DIR`

mod fields;
mod mesh;

use super::findings::read;
use super::object::{self, Answer};
use clap::Args;
use fields::Field;
use mesh::Content;
use signorini::status::{Status, status};
use signorini::text::plural;
use signorini::{Diagnostics, Reading, load};
use signorini_io::diagnostic::{Diagnostic, codes};
use signorini_io::fs::RealFs;
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

/// The content of a mesh.
fn of_mesh(content: &Content) -> Answer {
    let mut answer = Answer {
        lines: content.lines(),
        ..Answer::default()
    };
    answer.put("mesh", content);
    answer
}

/// Adds fields under a name.
fn put_fields(answer: &mut Answer, name: &str, fields: &[Field]) {
    answer.lines.extend(fields.iter().flat_map(Field::lines));
    answer.put(name, &fields);
}

impl Info {
    pub fn execute(self) -> u8 {
        let answer = if self.path.is_dir() {
            results(&self.path)
        } else {
            let extension = self.path.extension().map(|e| e.to_ascii_lowercase());
            match extension.as_deref().and_then(|e| e.to_str()) {
                Some("toml") => load(&self.path, &Reading::default())
                    .map(|loaded| of_mesh(&Content::new(&loaded.mesh, Vec::new()))),
                Some("vtu") => grid_file(&self.path).map_err(Diagnostics::from),
                Some("frd") => frd_file(&self.path).map_err(Diagnostics::from),
                _ => mesh_file(&self.path).map_err(Diagnostics::from),
            }
        };
        object::print("info", answer, self.json)
    }
}

fn mesh_file(path: &Path) -> Result<Answer, Diagnostic> {
    let bytes = read(path)?;
    let (found, notes) = readers::read_mesh(&path.display().to_string(), &bytes)
        .map_err(|error| Diagnostic::error(&codes::BAD_MESH, error.to_string()))?;
    let notes = notes.iter().map(ToString::to_string).collect();
    Ok(of_mesh(&Content::new(&found, notes)))
}

/// The mesh of a file of all frames, and the data sets at its last time with their ranges.
fn frd_file(path: &Path) -> Result<Answer, Diagnostic> {
    let mut answer = mesh_file(path)?;
    let frd = readers::frd::parse(&read(path)?).map_err(|error| {
        Diagnostic::error(&codes::UNREADABLE, format!("{}, {error}", path.display()))
    })?;
    let Some(last) = frd.datasets.last() else {
        return Ok(answer);
    };
    answer.lines.push(format!(
        "results at time {}, step {}, increment {}:",
        last.time, last.step, last.increment
    ));
    answer.put("time", &last.time);
    let datasets = frd.datasets.iter().filter(|one| one.time == last.time);
    let fields: Vec<Field> = datasets.map(fields::of_dataset).collect();
    put_fields(&mut answer, "fields", &fields);
    Ok(answer)
}

/// How a run ended, its times, and the fields of its last frame.
fn results(folder: &Path) -> Result<Answer, Diagnostics> {
    let status: Status = status(&RealFs, folder)?;
    let mut answer = Answer {
        lines: status.lines(),
        members: object::members(&status),
        ..Answer::default()
    };
    // a run that writes no frames for ParaView has no list of them
    let Ok(list) = Pvd::read(&RealFs, &folder.join("results.pvd")) else {
        return Ok(answer);
    };
    let entries = list.entries();
    let times: Vec<f64> = entries.iter().map(|entry| entry.time).collect();
    answer.put("times", &times);
    if let (Some(first), Some(last)) = (entries.first(), entries.last()) {
        answer.lines.push(format!(
            "{}, time {} to {}",
            plural(entries.len(), "frame"),
            first.time,
            last.time
        ));
        answer
            .lines
            .push(format!("fields of the last frame, {}:", last.file));
        let fields = fields::of_grid(&grid(&folder.join(&last.file))?);
        put_fields(&mut answer, "fields", &fields);
    }
    let contact = Pvd::read(&RealFs, &folder.join("contact.pvd"));
    if let Ok(list) = contact
        && let Some(last) = list.entries().last()
    {
        let fields = fields::of_grid(&grid(&folder.join(&last.file))?);
        answer
            .lines
            .push(format!("fields of contact, {}:", last.file));
        put_fields(&mut answer, "contact_fields", &fields);
    }
    Ok(answer)
}

/// The mesh of a grid, and its arrays.
fn grid_file(path: &Path) -> Result<Answer, Diagnostic> {
    let grid = grid(path)?;
    // frames of contact alone hold no cells of a mesh: they have fields nevertheless
    let mut answer = match readers::vtu::from_grid(&path.display().to_string(), &grid) {
        Ok((found, notes)) => {
            let notes = notes.iter().map(ToString::to_string).collect();
            of_mesh(&Content::new(&found, notes))
        }
        Err(error) => Answer {
            lines: vec![format!("no mesh: {error}")],
            ..Answer::default()
        },
    };
    put_fields(&mut answer, "fields", &fields::of_grid(&grid));
    Ok(answer)
}

fn grid(path: &Path) -> Result<Vtu, Diagnostic> {
    let bytes = read(path)?;
    vtu::read(&bytes).map_err(|error| {
        Diagnostic::error(&codes::UNREADABLE, format!("{}: {error}", path.display()))
    })
}
