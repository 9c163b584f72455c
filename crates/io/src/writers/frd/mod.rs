//! `NAME.frd`: mesh and results of a run in one text file of fixed columns, as CalculiX GraphiX, PrePoMax and FreeCAD
//! read it.
//!
//! ```text
//!     1C …                                        head: the title, the program
//!     2C     40                                   nodes: number, x, y, z
//!  -1         1 1.00000E+00 1.00000E+00 0.00000E+00
//!  -3
//!     3C      2                                   elements: number, type, group, material, and nodes, ten in a line
//!  -1         1    4    0    1
//!  -2         1         2         3 …
//!  -3
//!     1PSTEP           1       1       1          a data set: its number, increment, step
//!   100CL  101 1.000000000      40  …             time, number of nodes
//!  -4  DISP        4    1                         name, components
//!  -5  D1          1    2    1    0
//!  -1         1 0.00000E+00 …                     values at a node
//!  -3
//!  9999                                           the end
//! ```
//!
//! | data set | of | components |
//! |---|---|---|
//! | `DISP` | displacement | D1 D2 D3 |
//! | `NDTEMP` | temperature | T |
//! | `STRESS`, `TOSTRAIN` | Cauchy stress, strain; shears are tensor components | XX YY ZZ XY YZ ZX |
//! | `FORC` | forces of supports | F1 F2 F3 |
//! | `PE` | equivalent plastic strain | PE |
//! | `CONTACT` | at the secondary side | COPEN CSLIP1 CSLIP2 CPRESS CSHEAR1 CSHEAR2 |
//!
//! The mesh is written once, then the frames, data set by data set, and the end of the file. The next frame takes that
//! end away first: at any instant the file is the mesh with whole frames and at most one that is torn, and a resumed
//! run cuts it back to the checkpoint's frames. Numbers of elements and nodes are those of the mesh, unless a reader
//! with numbers of 32 bits could not hold them: then nodes or elements count from 1.
//!
//! Limits: six digits; exponents of two digits. Orders of nodes and what has no type are listed in
//! [`cells`](crate::frd::cells).
//!
//! One more data set: a variant of [`Dataset`].

mod columns;

use crate::frd::cells::CellType;
use crate::fs::{Fs, FsError, Log};
use columns::{push_real, push_time, push_whole};
use rayon::prelude::*;
use signorini_geometry::mesh::{CellId, Mesh};
use signorini_geometry::tensor::{Sym3, Vec3};
use std::path::{Path, PathBuf};

/// The last line.
const END: &[u8] = b" 9999\n";

/// The last line of a block.
const TAIL: &[u8] = b" -3\n";

/// Nodes of an element in one line.
const NODES_IN_LINE: usize = 10;

/// Why a file could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FrdError {
    /// The disk failed.
    #[error(transparent)]
    Fs(#[from] FsError),
    /// Elements that the format has no type for; nothing was written.
    #[error("{} cannot be written: the format has no elements of kind {element}; write vtu", path.display())]
    NoElement {
        /// The file.
        path: PathBuf,
        /// The name of the element.
        element: &'static str,
    },
    /// Values for another number of nodes than there are; nothing was written.
    #[error("data set {name} of {} has {got} values where there are {expected} nodes", path.display())]
    WrongLength {
        /// The file.
        path: PathBuf,
        /// The data set.
        name: &'static str,
        /// Nodes.
        expected: usize,
        /// Values given.
        got: usize,
    },
    /// Values at a node that is not there; nothing was written.
    #[error("data set {name} of {} has values at node {node} (counted from 0), which is not there", path.display())]
    NoSuchNode {
        /// The file.
        path: PathBuf,
        /// The data set.
        name: &'static str,
        /// The node, from 0.
        node: u32,
    },
}

/// When a frame is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moment {
    /// Total time.
    pub time: f64,
    /// Number of the step, from 1.
    pub step: u64,
    /// Number of the increment within the step.
    pub increment: u64,
}

/// The values of a frame at its nodes, one per node of the mesh where nothing else is said.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Dataset<'a> {
    /// Displacements.
    Displacement(&'a [Vec3]),
    /// Temperatures.
    Temperature(&'a [f64]),
    /// Cauchy stresses.
    Stress(&'a [Sym3]),
    /// Strains.
    Strain(&'a [Sym3]),
    /// Forces of supports.
    Force(&'a [Vec3]),
    /// Equivalent plastic strains.
    PlasticStrain(&'a [f64]),
    /// Gap, two components of slip, pressure, two components of the tangential traction, at some nodes.
    Contact {
        /// The nodes, from 0.
        nodes: &'a [u32],
        /// The values at each.
        values: &'a [[f64; 6]],
    },
}

impl Dataset<'_> {
    /// The name in the file.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Displacement(_) => "DISP",
            Self::Temperature(_) => "NDTEMP",
            Self::Stress(_) => "STRESS",
            Self::Strain(_) => "TOSTRAIN",
            Self::Force(_) => "FORC",
            Self::PlasticStrain(_) => "PE",
            Self::Contact { .. } => "CONTACT",
        }
    }

    const fn components(&self) -> &'static [Component] {
        match self {
            Self::Displacement(_) => &DISPLACEMENT,
            Self::Temperature(_) => &TEMPERATURE,
            Self::Stress(_) => &STRESS,
            Self::Strain(_) => &STRAIN,
            Self::Force(_) => &FORCE,
            Self::PlasticStrain(_) => &PLASTIC_STRAIN,
            Self::Contact { .. } => &CONTACT,
        }
    }

    /// Nodes with values.
    fn len(&self) -> usize {
        match self {
            Self::Displacement(values) | Self::Force(values) => values.len(),
            Self::Temperature(values) | Self::PlasticStrain(values) => values.len(),
            Self::Stress(values) | Self::Strain(values) => values.len(),
            Self::Contact { values, .. } => values.len(),
        }
    }
}

/// A component as a data set declares it: name, kind (1 scalar, 2 vector, 4 tensor), indices, whether viewers compute it.
struct Component {
    name: &'static str,
    kind: u64,
    index: [u64; 2],
    is_computed: bool,
}

const fn component(name: &'static str, kind: u64, index: [u64; 2]) -> Component {
    Component {
        name,
        kind,
        index,
        is_computed: false,
    }
}

const fn scalar(name: &'static str) -> Component {
    component(name, 1, [0, 0])
}

/// The size of a vector, which viewers compute.
const ALL: Component = Component {
    is_computed: true,
    ..component("ALL", 2, [0, 0])
};

const DISPLACEMENT: [Component; 4] = [
    component("D1", 2, [1, 0]),
    component("D2", 2, [2, 0]),
    component("D3", 2, [3, 0]),
    ALL,
];

const FORCE: [Component; 4] = [
    component("F1", 2, [1, 0]),
    component("F2", 2, [2, 0]),
    component("F3", 2, [3, 0]),
    ALL,
];

const TEMPERATURE: [Component; 1] = [scalar("T")];

const PLASTIC_STRAIN: [Component; 1] = [scalar("PE")];

const STRESS: [Component; 6] = tensor(["SXX", "SYY", "SZZ", "SXY", "SYZ", "SZX"]);

const STRAIN: [Component; 6] = tensor(["EXX", "EYY", "EZZ", "EXY", "EYZ", "EZX"]);

const CONTACT: [Component; 6] = [
    scalar("COPEN"),
    scalar("CSLIP1"),
    scalar("CSLIP2"),
    scalar("CPRESS"),
    scalar("CSHEAR1"),
    scalar("CSHEAR2"),
];

const fn tensor([xx, yy, zz, xy, yz, zx]: [&'static str; 6]) -> [Component; 6] {
    [
        component(xx, 4, [1, 1]),
        component(yy, 4, [2, 2]),
        component(zz, 4, [3, 3]),
        component(xy, 4, [1, 2]),
        component(yz, 4, [2, 3]),
        component(zx, 4, [3, 1]),
    ]
}

/// How far a file has got: what a resumed run cuts it back to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mark {
    /// Bytes of mesh and frames, the end not counted.
    pub length: u64,
    /// Frames.
    pub nframe: u64,
    /// Data sets.
    pub ndataset: u64,
}

/// A file that grows by frames.
pub struct FrdFile {
    log: Box<dyn Log>,
    path: PathBuf,
    /// The number of each node.
    labels: Labels,
    at: Mark,
}

impl FrdFile {
    /// Starts the file again with the cells of the highest dimension of a mesh, and ends it.
    ///
    /// # Errors
    /// [`FrdError::Fs`].
    pub fn create(fs: &dyn Fs, path: &Path, title: &str, mesh: &Mesh) -> Result<Self, FrdError> {
        let blocks = mesh.blocks.iter().filter(|b| b.element.dim() == mesh.dim());
        let mut elements = blocks.map(|b| b.element);
        if let Some(element) = elements.find(|e| CellType::of_element(*e).is_none()) {
            return Err(FrdError::NoElement {
                path: path.to_path_buf(),
                element: element.name(),
            });
        }
        let mut file = Self {
            log: fs.open_log(path, 0)?,
            path: path.to_path_buf(),
            labels: Labels::new(mesh),
            at: Mark::default(),
        };
        let mut mesh_part = Vec::new();
        push_head(&mut mesh_part, title);
        push_nodes(&mut mesh_part, &file.labels, &mesh.points);
        push_elements(&mut mesh_part, &file.labels, mesh);
        file.append(vec![mesh_part], 0)?;
        Ok(file)
    }

    /// Goes on with a file after what [`Self::mark`] returned; later frames, whole or torn, are cut off.
    ///
    /// # Errors
    /// [`FrdError::Fs`], also where the file is shorter.
    pub fn resume(fs: &dyn Fs, path: &Path, mesh: &Mesh, mark: Mark) -> Result<Self, FrdError> {
        let mut file = Self {
            log: fs.open_log(path, mark.length)?,
            path: path.to_path_buf(),
            labels: Labels::new(mesh),
            at: mark,
        };
        file.append(Vec::new(), 0)?;
        Ok(file)
    }

    /// Appends a frame. After an error it is not there, and the next one may be tried.
    ///
    /// # Errors
    /// Values of another mesh; the disk.
    pub fn frame(&mut self, moment: &Moment, datasets: &[Dataset<'_>]) -> Result<(), FrdError> {
        for dataset in datasets {
            self.check(dataset)?;
        }
        let nframe = self.at.nframe + 1;
        let first = self.at.ndataset + 1;
        let labels = &self.labels;
        let of_dataset = |(k, dataset): (usize, &Dataset<'_>)| {
            let mut out = Vec::new();
            let numbers = [first + k as u64, nframe];
            push_moment(&mut out, moment, numbers, labels.nrow(dataset));
            push_declaration(&mut out, dataset);
            push_values(&mut out, labels, dataset);
            out
        };
        let parts = datasets.par_iter().enumerate().map(of_dataset);
        let parts: Vec<Vec<u8>> = parts.collect();
        self.append(parts, datasets.len() as u64)?;
        self.at.nframe = nframe;
        Ok(())
    }

    /// How far the file has got.
    #[must_use]
    pub const fn mark(&self) -> Mark {
        self.at
    }

    /// Makes all frames durable; to be called before a checkpoint marks them.
    ///
    /// # Errors
    /// [`FrdError::Fs`].
    pub fn sync(&mut self) -> Result<(), FrdError> {
        Ok(self.log.sync()?)
    }

    fn check(&self, dataset: &Dataset<'_>) -> Result<(), FrdError> {
        let nodes = match dataset {
            Dataset::Contact { nodes, .. } => Some(*nodes),
            _ => None,
        };
        let expected = nodes.map_or(self.labels.all.len(), <[u32]>::len);
        let (path, name, got) = (&self.path, dataset.name(), dataset.len());
        if got != expected {
            return Err(FrdError::WrongLength {
                path: path.clone(),
                name,
                expected,
                got,
            });
        }
        let mut nodes = nodes.unwrap_or_default().iter();
        match nodes.find(|&&node| node as usize >= self.labels.all.len()) {
            Some(&node) => Err(FrdError::NoSuchNode {
                path: path.clone(),
                name,
                node,
            }),
            None => Ok(()),
        }
    }

    /// Writes these parts, which hold so many data sets, in the place of the end, and the end after them.
    fn append(&mut self, parts: Vec<Vec<u8>>, ndataset: u64) -> Result<(), FrdError> {
        let length: usize = parts.iter().map(Vec::len).sum();
        self.log.cut(self.at.length)?;
        for part in parts {
            self.log.append_owned(part)?;
        }
        self.log.append(END)?;
        self.at.length += length as u64;
        self.at.ndataset += ndataset;
        Ok(())
    }
}

impl std::fmt::Debug for FrdFile {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FrdFile")
            .field("path", &self.path)
            .field("at", &self.at)
            .finish_non_exhaustive()
    }
}

/// The numbers of the nodes in the file, and which of them have elements: the others are left out, as CalculiX does.
#[derive(Debug)]
struct Labels {
    all: Vec<u64>,
    has_elements: Vec<bool>,
}

impl Labels {
    fn new(mesh: &Mesh) -> Self {
        let mut has_elements = vec![false; mesh.node_labels.len()];
        let cells = (1..=mesh.dim()).flat_map(|dim| mesh.cells(dim));
        for &node in cells.flat_map(|cell| mesh.cell(cell)) {
            if let Some(known) = has_elements.get_mut(node as usize) {
                *known = true;
            }
        }
        Self {
            all: numbers(&mesh.node_labels),
            has_elements,
        }
    }

    fn of(&self, node: u32) -> u64 {
        self.all.get(node as usize).copied().unwrap_or(0)
    }

    fn has(&self, node: u32) -> bool {
        self.has_elements.get(node as usize) == Some(&true)
    }

    /// The rows that a data set has in the file.
    fn nrow(&self, dataset: &Dataset<'_>) -> usize {
        match dataset {
            Dataset::Contact { nodes, .. } => nodes.iter().filter(|&&n| self.has(n)).count(),
            _ => self.count(),
        }
    }

    fn count(&self) -> usize {
        self.has_elements.iter().filter(|has| **has).count()
    }

    /// Of values of all nodes those with elements, with the numbers of the nodes.
    fn of_elements<T>(&self, values: impl Iterator<Item = T>) -> impl Iterator<Item = (u64, T)> {
        let all = self.all.iter().zip(&self.has_elements).zip(values);
        all.filter(|((_, has), _)| **has)
            .map(|((&label, _), value)| (label, value))
    }
}

/// The numbers that nodes or elements have in the file.
fn numbers(labels: &[u64]) -> Vec<u64> {
    if labels.iter().all(|&label| i32::try_from(label).is_ok()) {
        labels.to_vec()
    } else {
        (1..=labels.len() as u64).collect()
    }
}

fn push_head(out: &mut Vec<u8>, title: &str) {
    let is_plain = |c: &char| c.is_ascii() && !c.is_ascii_control();
    let title: String = title.chars().filter(is_plain).take(60).collect();
    let version = env!("CARGO_PKG_VERSION");
    for line in [
        format!("    1C{title}"),
        format!("    1U{:<18}{:<40}", "PGM", "Signorini"),
        format!(
            "    1U{:<18}{:<40}",
            "VERSION",
            format!("Version {version}")
        ),
    ] {
        out.extend_from_slice(line.as_bytes());
        out.push(b'\n');
    }
}

/// The line that starts a block of nodes or elements.
fn push_count(out: &mut Vec<u8>, key: &[u8], count: usize) {
    out.extend_from_slice(key);
    push_whole(out, count as u64, 12);
    out.extend_from_slice(b"                  ");
    out.extend_from_slice(b"                   1\n");
}

fn push_nodes(out: &mut Vec<u8>, labels: &Labels, points: &[Vec3]) {
    push_count(out, b"    2C                  ", labels.count());
    for (label, x) in labels.of_elements(points.iter()) {
        push_row(out, label, &x.to_array());
    }
    out.extend_from_slice(TAIL);
}

fn push_elements(out: &mut Vec<u8>, labels: &Labels, mesh: &Mesh) {
    let cells: Vec<CellId> = mesh.cells(mesh.dim()).collect();
    let own: Vec<u64> = cells
        .iter()
        .map(|&cell| mesh.cell_label(cell).unwrap_or(u64::MAX))
        .collect();
    push_count(out, b"    3C                  ", cells.len());
    for (&cell, number) in cells.iter().zip(numbers(&own)) {
        let Some(kind) = mesh.element(cell).and_then(CellType::of_element) else {
            continue;
        };
        out.extend_from_slice(b" -1");
        push_whole(out, number, 10);
        push_whole(out, u64::from(kind.number), 5);
        out.extend_from_slice(b"    0    1");
        let nodes = mesh.cell(cell);
        let picked = kind.places().filter_map(|place| nodes.get(place));
        for (k, &node) in picked.enumerate() {
            if k % NODES_IN_LINE == 0 {
                out.extend_from_slice(b"\n -2");
            }
            push_whole(out, labels.of(node), 10);
        }
        out.push(b'\n');
    }
    out.extend_from_slice(TAIL);
}

/// The two lines that name the data set; `numbers` counts data sets and frames.
fn push_moment(out: &mut Vec<u8>, moment: &Moment, [dataset, frame]: [u64; 2], nnode: usize) {
    out.extend_from_slice(b"    1PSTEP");
    push_whole(out, dataset, 26);
    push_whole(out, moment.increment, 12);
    push_whole(out, moment.step, 12);
    out.extend_from_slice(b"          \n  100CL");
    // five columns each
    let frame = frame.min(99_999);
    push_whole(out, (frame + 100).min(99_999), 5);
    push_time(out, moment.time);
    push_whole(out, nnode as u64, 12);
    out.extend_from_slice(b"                     0");
    push_whole(out, frame, 5);
    out.extend_from_slice(b"           1\n");
}

fn push_declaration(out: &mut Vec<u8>, dataset: &Dataset<'_>) {
    let components = dataset.components();
    out.extend_from_slice(format!(" -4  {:<8}", dataset.name()).as_bytes());
    push_whole(out, components.len() as u64, 5);
    out.extend_from_slice(b"    1\n");
    for one in components {
        out.extend_from_slice(format!(" -5  {:<8}    1", one.name).as_bytes());
        for number in [one.kind, one.index[0], one.index[1]] {
            push_whole(out, number, 5);
        }
        if one.is_computed {
            out.extend_from_slice(format!("    1{}", one.name).as_bytes());
        }
        out.push(b'\n');
    }
}

fn push_values(out: &mut Vec<u8>, labels: &Labels, dataset: &Dataset<'_>) {
    match dataset {
        Dataset::Displacement(values) | Dataset::Force(values) => {
            push_rows(out, labels, values.iter().map(|v| v.to_array()));
        }
        Dataset::Temperature(values) | Dataset::PlasticStrain(values) => {
            push_rows(out, labels, values.iter().map(|&v| [v]));
        }
        Dataset::Stress(values) | Dataset::Strain(values) => {
            let in_order = |s: &Sym3| [s.xx(), s.yy(), s.zz(), s.xy(), s.yz(), s.xz()];
            push_rows(out, labels, values.iter().map(in_order));
        }
        Dataset::Contact { nodes, values } => {
            let known = nodes
                .iter()
                .zip(*values)
                .filter(|(node, _)| labels.has(**node));
            for (&node, row) in known {
                push_row(out, labels.of(node), row);
            }
        }
    }
    out.extend_from_slice(TAIL);
}

fn push_rows<const N: usize>(
    out: &mut Vec<u8>,
    labels: &Labels,
    rows: impl Iterator<Item = [f64; N]>,
) {
    out.reserve(labels.count() * (14 + 12 * N) + TAIL.len());
    for (label, row) in labels.of_elements(rows) {
        push_row(out, label, &row);
    }
}

fn push_row(out: &mut Vec<u8>, label: u64, values: &[f64]) {
    out.extend_from_slice(b" -1");
    push_whole(out, label, 10);
    for &value in values {
        push_real(out, value);
    }
    out.push(b'\n');
}

#[cfg(test)]
mod tests;
