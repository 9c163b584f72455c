//! Results in other formats.

use super::file::{extension, no_such_form, noted, write};
use super::grid::Cells;
use crate::command::findings::read;
use signorini_geometry::mesh::Mesh;
use signorini_geometry::tensor::{Sym3, Vec3};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_io::fs::RealFs;
use signorini_io::readers::frd::{self, Frd};
use signorini_io::readers::vtu::from_grid;
use signorini_io::writers::frd::{Dataset, FrdFile, Moment};
use signorini_io::writers::pvd::Pvd;
use signorini_io::writers::vtu::{self, Field, SymTensor, Values, Vtu};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Data sets of CalculiX and the names that frames for ParaView have for them.
const NAMES: [(&str, &str); 7] = [
    ("DISP", "displacement"),
    ("STRESS", "stress"),
    ("TOSTRAIN", "strain"),
    ("FORC", "reaction_force"),
    ("NDTEMP", "temperature"),
    ("PE", "plastic_strain"),
    ("ERROR", "error"),
];

fn unreadable(path: &Path, why: impl std::fmt::Display) -> Diagnostic {
    Diagnostic::error(&codes::UNREADABLE, format!("{}: {why}", path.display()))
}

/// Writes the frames of a folder, or of a list of frames, into one .frd: displacements, stresses, strains, temperatures and
/// reactions at the nodes.
///
/// # Errors
/// Frames that cannot be read; a mesh that the format does not have; the disk.
pub fn to_frd(from: &Path, to: &Path) -> Result<Diagnostics, Diagnostics> {
    let list = match from.is_dir() {
        true => from.join("results.pvd"),
        false => from.to_path_buf(),
    };
    let frames = Pvd::read(&RealFs, &list).map_err(|error| unreadable(&list, error))?;
    let folder = list.parent().unwrap_or(Path::new("."));
    let mut file: Option<(FrdFile, usize)> = None;
    for (number, entry) in frames.entries().iter().enumerate() {
        let path = folder.join(&entry.file);
        let grid = vtu::read(&read(&path)?).map_err(|error| unreadable(&path, error))?;
        let (file, nnode) = match &mut file {
            Some(file) => file,
            None => {
                let (mesh, _) = from_grid(&path.display().to_string(), &grid)
                    .map_err(|error| unreadable(&path, error))?;
                let made = FrdFile::create(&RealFs, to, "results", &mesh).map_err(no_such_form)?;
                file.insert((made, mesh.nnode()))
            }
        };
        // the undeformed state is the mesh itself
        if number == 0 && entry.time == 0.0 {
            continue;
        }
        let moment = Moment {
            time: entry.time,
            step: 1,
            increment: number as u64,
        };
        append(file, &moment, &grid, *nnode).map_err(no_such_form)?;
    }
    match file {
        Some((mut file, _)) => {
            file.sync().map_err(no_such_form)?;
            Ok(Diagnostics::new())
        }
        None => Err(unreadable(&list, "it lists no frames").into()),
    }
}

/// Appends the fields of a frame that both formats have.
fn append(
    file: &mut FrdFile,
    moment: &Moment,
    grid: &Vtu,
    nnode: usize,
) -> Result<(), signorini_io::writers::frd::FrdError> {
    let numbers = |name: &str, ncomponent: usize| {
        let array = grid.point_data.iter().find(|array| array.name == name)?;
        let numbers = array.numbers.to_f64();
        let fits = array.ncomponent == ncomponent && numbers.len() == ncomponent * nnode;
        fits.then_some(numbers)
    };
    let vectors = |name: &str| {
        let rows = numbers(name, 3)?;
        let (rows, _) = rows.as_chunks::<3>();
        Some(rows.iter().map(|row| Vec3::from(*row)).collect::<Vec<_>>())
    };
    let tensors = |name: &str| {
        let rows = numbers(name, 6)?;
        let (rows, _) = rows.as_chunks::<6>();
        // XX YY ZZ XY YZ XZ
        let tensor = |&[xx, yy, zz, xy, yz, xz]: &[f64; 6]| Sym3::new(xx, yy, zz, xy, yz, xz);
        Some(rows.iter().map(tensor).collect::<Vec<_>>())
    };
    let displacement = vectors("displacement");
    let reaction = vectors("reaction_force");
    let (stress, strain) = (tensors("stress"), tensors("strain"));
    let temperature = numbers("temperature", 1);
    let all = [
        displacement.as_deref().map(Dataset::Displacement),
        temperature.as_deref().map(Dataset::Temperature),
        stress.as_deref().map(Dataset::Stress),
        strain.as_deref().map(Dataset::Strain),
        reaction.as_deref().map(Dataset::Force),
    ];
    let datasets: Vec<Dataset<'_>> = all.into_iter().flatten().collect();
    file.frame(moment, &datasets)
}

/// Writes the data sets of a .frd as frames for ParaView: a list of them next to a folder of frames, or the last one alone.
///
/// # Errors
/// A file that cannot be read; the disk.
pub fn from_frd(from: &Path, to: &Path) -> Result<Diagnostics, Diagnostics> {
    let bytes = read(from)?;
    let (mesh, notes) =
        frd::read(&from.display().to_string(), &bytes).map_err(|error| unreadable(from, error))?;
    let results = frd::parse(&bytes).map_err(|error| unreadable(from, error))?;
    let cells = Cells::new(&mesh, |dim| dim > 0);
    let mut moments: Vec<(u64, u64, f64)> = Vec::new();
    for one in &results.datasets {
        let moment = (one.step, one.increment, one.time);
        if !moments.contains(&moment) {
            moments.push(moment);
        }
    }
    if extension(to) == "vtu" {
        let last = moments.last().copied();
        write(to, &frame(&cells, &mesh, &results, last)?)?;
        return Ok(noted(notes));
    }
    let stem = to
        .file_stem()
        .map(|stem| stem.to_string_lossy().into_owned());
    let stem = stem.unwrap_or_else(|| "results".to_owned());
    let folder = to.parent().unwrap_or(Path::new("."));
    let mut list = Pvd::new(to);
    for (number, moment) in moments.iter().enumerate() {
        let name = format!("{stem}_{number:04}.vtu");
        let path: PathBuf = folder.join(&name);
        write(&path, &frame(&cells, &mesh, &results, Some(*moment))?)?;
        list.add(&RealFs, moment.2, &[&name])
            .map_err(no_such_form)?;
    }
    if moments.is_empty() {
        return Err(unreadable(from, "it holds a mesh but no results; write it as .vtu").into());
    }
    Ok(noted(notes))
}

/// The bytes of a frame with all data sets of a moment; numbers at nodes that a data set leaves out are none.
fn frame(
    cells: &Cells,
    mesh: &Mesh,
    results: &Frd,
    moment: Option<(u64, u64, f64)>,
) -> Result<Vec<u8>, Diagnostic> {
    let places: BTreeMap<u64, usize> = mesh.node_labels.iter().copied().zip(0..).collect();
    let own = results
        .datasets
        .iter()
        .filter(|one| Some((one.step, one.increment, one.time)) == moment);
    let mut made: Vec<(String, Table)> = Vec::new();
    for one in own {
        let known = NAMES.iter().find(|(name, _)| *name == one.name);
        let name = known.map_or_else(|| one.name.to_lowercase(), |(_, name)| (*name).to_owned());
        let ncomponent = one.components.len();
        let rows = one.nodes.iter().enumerate();
        let rows = rows.filter_map(|(k, label)| Some((*places.get(label)?, one.row(k))));
        match ncomponent {
            3 => made.push((name, Table::vectors(mesh.nnode(), rows))),
            6 if known.is_some() => made.push((name, Table::tensors(mesh.nnode(), rows))),
            _ => {
                let rows: Vec<(usize, &[f64])> = rows.collect();
                for (k, component) in one.components.iter().enumerate() {
                    let name = match ncomponent {
                        1 => name.clone(),
                        _ => format!("{name}_{}", component.to_lowercase()),
                    };
                    let rows = rows.iter().map(|(place, row)| (*place, *row));
                    made.push((name, Table::scalars(mesh.nnode(), rows, k)));
                }
            }
        }
    }
    let fields: Vec<Field<'_>> = made.iter().map(|(name, table)| table.field(name)).collect();
    let time = moment.map(|(.., time)| time);
    cells.encode(&fields, time).map_err(no_such_form)
}

/// Numbers at all nodes.
enum Table {
    Scalars(Vec<f64>),
    Vectors(Vec<[f64; 3]>),
    Tensors(Vec<SymTensor>),
}

impl Table {
    fn scalars<'a>(
        nnode: usize,
        rows: impl Iterator<Item = (usize, &'a [f64])>,
        component: usize,
    ) -> Self {
        let mut all = vec![f64::NAN; nnode];
        for (place, row) in rows {
            if let (Some(entry), Some(value)) = (all.get_mut(place), row.get(component)) {
                *entry = *value;
            }
        }
        Self::Scalars(all)
    }

    fn vectors<'a>(nnode: usize, rows: impl Iterator<Item = (usize, &'a [f64])>) -> Self {
        let mut all = vec![[f64::NAN; 3]; nnode];
        for (place, row) in rows {
            if let (Some(entry), [x, y, z]) = (all.get_mut(place), row) {
                *entry = [*x, *y, *z];
            }
        }
        Self::Vectors(all)
    }

    /// In the order of .frd: XX YY ZZ XY YZ ZX.
    fn tensors<'a>(nnode: usize, rows: impl Iterator<Item = (usize, &'a [f64])>) -> Self {
        let none = f64::NAN;
        let tensor = |xx, yy, zz, xy, yz, xz| SymTensor {
            xx,
            yy,
            zz,
            xy,
            yz,
            xz,
        };
        let mut all = vec![tensor(none, none, none, none, none, none); nnode];
        for (place, row) in rows {
            if let (Some(entry), [xx, yy, zz, xy, yz, zx]) = (all.get_mut(place), row) {
                *entry = tensor(*xx, *yy, *zz, *xy, *yz, *zx);
            }
        }
        Self::Tensors(all)
    }

    fn field<'a>(&'a self, name: &'a str) -> Field<'a> {
        let values = match self {
            Self::Scalars(all) => Values::Scalar(all),
            Self::Vectors(all) => Values::Vector(all),
            Self::Tensors(all) => Values::Tensor(all),
        };
        Field::new(name, values)
    }
}
