//! Displacements that are those of another model at the places of nodes.
//!
//! The displacement of a node is interpolated with the functions of the element of the global model in which its undeformed
//! place lies, else of the closest face, no further away than 1 % of its size.

use super::names::Names;
use super::quoted;
use super::shells::Shells;
use signorini_geometry::location::{Located, Locator};
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::tensor::Vec3;
use signorini_io::case::{Case, GlobalModel, GlobalTime, Name};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Place, codes};
use signorini_io::fs::{Fs, RealFs};
use signorini_io::readers::{frd, vtu};
use signorini_io::vtk;
use signorini_io::writers::pvd::Pvd;
use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};

/// How far from the global model a node may lie, over the size of the face that is closest to it.
const REACH: f64 = 0.01;

/// Displacements of nodes.
type Values = Vec<(NodeId, [f64; 3])>;

/// Results of a global model at one time.
struct Global {
    mesh: Mesh,
    /// The displacement of each node, where it is known.
    u: Vec<Option<Vec3>>,
}

/// Reads the displacements of global models that steps prescribe. `folder` is where the case lies: paths are relative to it.
/// Returns the files that were read.
///
/// # Errors
/// Files that cannot be read, or have no such step; nodes that lie outside of the global model.
pub fn read_motions_of(
    case: &mut Case,
    mesh: &Mesh,
    folder: &Path,
) -> Result<Vec<PathBuf>, Diagnostics> {
    let mut moves = case.steps.iter().flat_map(|step| &step.moves);
    if !moves.any(|one| one.from.is_some()) {
        return Ok(Vec::new());
    }
    let mut found = Diagnostics::new();
    let mut files = BTreeSet::new();
    let mut wanted: Vec<(usize, usize, Values)> = Vec::new();
    {
        let shells = Shells::default();
        let names = Names::of_surfaces(case, mesh, &shells, &mut found);
        let mut known: HashMap<(PathBuf, GlobalTime), Option<Global>> = HashMap::new();
        for (s, step) in case.steps.iter().enumerate() {
            for (m, one) in step.moves.iter().enumerate() {
                let Some(from) = &one.from else { continue };
                let file = folder.join(&from.file.value);
                let key = (file.clone(), from.at);
                let global = known.entry(key).or_insert_with(|| {
                    let read = global(&RealFs, &file, from, &mut files);
                    read.map_err(|fault| found.push(*fault)).ok()
                });
                let (Some(global), Some(nodes)) = (global, names.nodes(&one.on, &mut found)) else {
                    continue;
                };
                match global.at((mesh, &names), &nodes, (&one.on, from)) {
                    Ok(values) => wanted.push((s, m, values)),
                    Err(fault) => found.push(*fault),
                }
            }
        }
    }
    if found.has_errors() {
        return Err(found);
    }
    for (step, number, values) in wanted {
        let step = case.steps.get_mut(step);
        let one = step.and_then(|step| step.moves.get_mut(number));
        if let Some(from) = one.and_then(|one| one.from.as_mut()) {
            from.values = Some(values);
        }
    }
    Ok(files.into_iter().collect())
}

impl Global {
    /// Displacements at the undeformed places of nodes.
    fn at(
        &self,
        (mesh, names): (&Mesh, &Names<'_>),
        nodes: &[NodeId],
        (on, from): (&Name, &GlobalModel),
    ) -> Result<Values, Box<Diagnostic>> {
        let all = self.mesh.cells(self.mesh.dim());
        let meant: BTreeSet<u64> = from.elements.iter().copied().collect();
        let is_meant = |cell: &CellId| {
            let label = self.mesh.cell_label(*cell);
            meant.is_empty() || label.is_some_and(|label| meant.contains(&label))
        };
        let cells: Vec<CellId> = all.filter(is_meant).collect();
        let place = &from.file.place;
        let Some(locator) = Locator::new(&self.mesh, &cells) else {
            let text = format!("{} has none of these elements", from.file.value.display());
            return Err(fault(
                &codes::NOT_IN_MESH,
                text,
                place,
                "the global model of these nodes",
            ));
        };
        let mut values = Vec::with_capacity(nodes.len());
        let mut outside: Vec<(NodeId, f64)> = Vec::new();
        for &node in nodes {
            let point = mesh.points.get(node as usize).copied().unwrap_or_default();
            let Some(located) = locator.locate(point) else {
                continue;
            };
            if located.distance > REACH * located.size {
                outside.push((node, located.distance));
            } else if let Some(u) = self.displacement(&located) {
                values.push((node, u.to_array()));
            } else {
                let label = names.label(node);
                let text = format!(
                    "{} has no displacement where node {label} lies",
                    from.file.value.display()
                );
                return Err(fault(&codes::NOT_IN_MESH, text, place, ""));
            }
        }
        let Some(&(node, distance)) = outside.iter().max_by(|a, b| a.1.total_cmp(&b.1)) else {
            return Ok(values);
        };
        let label = names.label(node);
        let text = format!(
            "{} of the {} nodes of {} lie outside of the global model: node {label} by {distance:.3e}",
            outside.len(),
            nodes.len(),
            quoted(on)
        );
        let one = Diagnostic::error(&codes::NOT_IN_MESH, text).at(place, "");
        let one = one.note("a node may lie off by 1 % of the size of the closest face");
        Err(Box::new(one.help(
            "move the boundary of the submodel into the global model",
        )))
    }

    fn displacement(&self, at: &Located) -> Option<Vec3> {
        let mut sum = Vec3::ZERO;
        for &(node, weight) in &at.weights {
            sum += self.u.get(node as usize).copied().flatten()? * weight;
        }
        Some(sum)
    }
}

fn fault(
    code: &'static signorini_io::diagnostic::Code,
    text: impl Into<String>,
    place: &Place,
    remark: &str,
) -> Box<Diagnostic> {
    Box::new(Diagnostic::error(code, text.into()).at(place, remark))
}

/// The results of a file; `files` receives all that were read.
fn global(
    fs: &dyn Fs,
    file: &Path,
    from: &GlobalModel,
    files: &mut BTreeSet<PathBuf>,
) -> Result<Global, Box<Diagnostic>> {
    let place = &from.file.place;
    let list = file.join("results.pvd");
    let file = match file
        .extension()
        .is_none_or(|e| e.eq_ignore_ascii_case("out"))
        && fs.exists(&list).unwrap_or(false)
    {
        true => list.as_path(),
        false => file,
    };
    let kind = file.extension().map(|e| e.to_string_lossy().to_lowercase());
    match kind.as_deref() {
        Some("frd") => of_frd(&read(fs, file, place, files)?, file, from),
        Some("vtu") => {
            let frame = frame(&read(fs, file, place, files)?, file, place)?;
            let step = step_of(&frame);
            match from.at {
                GlobalTime::Step(wanted) if step != Some(wanted) => {
                    Err(no_step(wanted, step.into_iter(), file, place))
                }
                _ => of_frame(&frame, file, place),
            }
        }
        Some("pvd") => of_list(fs, file, from, files),
        _ => {
            let text = format!("{} holds no results of a global model", file.display());
            let one = Diagnostic::error(&codes::WRONG_KIND, text).at(place, "");
            Err(Box::new(one.help(
                "name a .frd, .vtu or .pvd file, or a folder of results",
            )))
        }
    }
}

fn read(
    fs: &dyn Fs,
    file: &Path,
    place: &Place,
    files: &mut BTreeSet<PathBuf>,
) -> Result<Vec<u8>, Box<Diagnostic>> {
    let bytes = fs.read(file).map_err(|error| {
        let text = format!("{} cannot be read: {error}", file.display());
        let one = Diagnostic::error(&codes::UNREADABLE, text).at(place, "the global model");
        Box::new(one.help("paths are relative to the case; solve the global model first"))
    })?;
    files.insert(file.to_path_buf());
    Ok(bytes)
}

/// A step that results do not have.
fn no_step(
    wanted: u64,
    known: impl Iterator<Item = u64>,
    file: &Path,
    place: &Place,
) -> Box<Diagnostic> {
    let known: BTreeSet<u64> = known.collect();
    let text = format!("{} has no displacements of step {wanted}", file.display());
    let one = Diagnostic::error(&codes::NOT_IN_MESH, text).at(place, "");
    let listed: Vec<String> = known.iter().map(u64::to_string).collect();
    Box::new(match listed.is_empty() {
        true => one.note("it has no displacements at all"),
        false => one.note(format!("it has those of steps {}", listed.join(", "))),
    })
}

/// The global model in a `.frd` file.
fn of_frd(bytes: &[u8], file: &Path, from: &GlobalModel) -> Result<Global, Box<Diagnostic>> {
    let (name, place) = (file.display().to_string(), &from.file.place);
    let (mesh, all) = frd::read_all(&name, bytes).map_err(|error| {
        let text = error.to_string();
        fault(&codes::BAD_MESH, text, place, "the global model")
    })?;
    let mut fields = all.datasets.iter().filter(|one| one.name == "DISP");
    let steps = || {
        all.datasets
            .iter()
            .filter(|one| one.name == "DISP")
            .map(|one| one.step)
    };
    let field = match from.at {
        GlobalTime::Step(step) => fields
            .rfind(|one| one.step == step)
            .ok_or_else(|| no_step(step, steps(), file, place))?,
        GlobalTime::Set(set) => {
            let count = steps().count();
            let field = usize::try_from(set)
                .ok()
                .and_then(|set| fields.nth(set.checked_sub(1)?));
            field.ok_or_else(|| no_set(set, count, file, place))?
        }
    };
    let known: HashMap<u64, usize> = field.nodes.iter().copied().zip(0..).collect();
    let value = |label: &u64| {
        let row = field.row(*known.get(label)?);
        let at = |k: usize| row.get(k).copied().unwrap_or_default();
        (!row.is_empty()).then(|| Vec3::new(at(0), at(1), at(2)))
    };
    let u = mesh.node_labels.iter().map(value).collect();
    Ok(Global { mesh, u })
}

fn no_set(set: u64, count: usize, file: &Path, place: &Place) -> Box<Diagnostic> {
    let text = format!(
        "{} has {count} displacement fields, not {set}",
        file.display()
    );
    fault(&codes::NOT_IN_MESH, text, place, "")
}

fn frame(bytes: &[u8], file: &Path, place: &Place) -> Result<vtk::Vtu, Box<Diagnostic>> {
    vtk::read(bytes).map_err(|error| {
        let text = format!("{}: {error}", file.display());
        fault(&codes::BAD_MESH, text, place, "the global model")
    })
}

/// The step of a frame.
fn step_of(frame: &vtk::Vtu) -> Option<u64> {
    let step = frame.fact("step")?.numbers.to_i64()?;
    step.first().and_then(|&step| u64::try_from(step).ok())
}

/// The global model in a frame.
fn of_frame(frame: &vtk::Vtu, file: &Path, place: &Place) -> Result<Global, Box<Diagnostic>> {
    let name = file.display().to_string();
    let (mesh, _) = vtu::from_grid(&name, frame).map_err(|error| {
        fault(
            &codes::BAD_MESH,
            error.to_string(),
            place,
            "the global model",
        )
    })?;
    let field = frame
        .point_field("displacement")
        .filter(|field| field.ncomponent == 3);
    let Some(field) = field else {
        let text = format!("{name} has no displacements");
        return Err(fault(&codes::WRONG_KIND, text, place, "the global model"));
    };
    let values = field.numbers.to_f64();
    let u = values
        .as_chunks::<3>()
        .0
        .iter()
        .map(|&u| Some(Vec3::from(u)))
        .collect();
    Ok(Global { mesh, u })
}

/// The global model in a list of frames.
fn of_list(
    fs: &dyn Fs,
    file: &Path,
    from: &GlobalModel,
    files: &mut BTreeSet<PathBuf>,
) -> Result<Global, Box<Diagnostic>> {
    let place = &from.file.place;
    read(fs, file, place, files)?;
    let list = Pvd::read(fs, file).map_err(|error| {
        fault(
            &codes::BAD_MESH,
            error.to_string(),
            place,
            "the global model",
        )
    })?;
    let folder = file.parent().map(Path::to_path_buf).unwrap_or_default();
    // the first part of each time is the solids; the undeformed state is no step
    let frames = list.entries().iter().filter(|entry| entry.part == 0);
    let frames: Vec<PathBuf> = frames.map(|entry| folder.join(&entry.file)).collect();
    match from.at {
        GlobalTime::Set(set) => {
            let at = usize::try_from(set)
                .ok()
                .and_then(|set| frames.get(set.checked_sub(1)?));
            let at = at.ok_or_else(|| no_set(set, frames.len(), file, place))?;
            of_frame(&frame(&read(fs, at, place, files)?, at, place)?, at, place)
        }
        GlobalTime::Step(wanted) => {
            let mut known: BTreeSet<u64> = BTreeSet::new();
            for at in frames.iter().rev() {
                let bytes = read(fs, at, place, &mut BTreeSet::new())?;
                let one = frame(&bytes, at, place)?;
                let step = step_of(&one);
                if step == Some(wanted) {
                    files.insert(at.clone());
                    return of_frame(&one, at, place);
                }
                known.extend(step);
            }
            Err(no_step(wanted, known.into_iter(), file, place))
        }
    }
}
