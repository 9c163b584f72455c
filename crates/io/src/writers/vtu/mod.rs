//! One frame as a VTK UnstructuredGrid (`.vtu`): XML in front, the numbers behind it as raw bytes.
//!
//! ```text
//! <VTKFile …>                       offset → where an array's block starts, counted from '_'
//!   … <DataArray … offset="0"/>
//!   … <DataArray … offset="812"/>
//!   <AppendedData encoding="raw">
//!   _[block of array 0][block of array 1]…
//!   </AppendedData>
//! </VTKFile>
//!
//! compressed block    n │ size of a full piece │ size of the last piece, 0 if full │ n compressed sizes │ n zlib streams
//! plain block         number of bytes │ bytes                                          (all counts are u64)
//! ```
//!
//! Bytes are little-endian. Cells have VTK's types and VTK's node order. Symmetric tensors have the order
//! XX YY ZZ XY YZ XZ, which is what ParaView labels them with. Viewers draw quadratic cells with flat faces unless
//! ParaView's "Nonlinear Subdivision Level" is raised: a gap seen there may be the viewer's.
//!
//! [`encode`] never writes a file that cannot be read: lengths, node numbers and cell types are checked first.
//! [`read`] reads these files back and survives any bytes.
//!
//! Limits: one piece; no polyhedra; text only in the field data, and meshio refuses files with text; at most 2³² nodes.
//!
//! One more cell type: a line in [`cells`].

use std::fmt::Write;
use std::path::Path;

use flate2::{Compress, Compression, FlushCompress, Status};
use rayon::prelude::*;

use crate::fs::bytes::extend_le;
use crate::fs::{Fs, FsError};
use crate::vtk::cells::{self, CellType};
use crate::vtk::xml::escape;

pub use crate::vtk::{Array, Numbers, Vtu, VtuReadError, read, read_limited};

/// The names of a symmetric tensor's components, in the order of the file.
pub const TENSOR_COMPONENTS: [&str; 6] = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"];

/// Bytes that are compressed together.
const PIECE: usize = 1 << 17;
/// Bytes of arrays whose pieces are shared among threads together.
const TOGETHER: usize = 1 << 23;
/// Whether compression is worth it is found out from so many samples of a piece, of so many bytes,
const SAMPLES: usize = 8;
const SAMPLE: usize = 1 << 10;
/// and it is not where they stay longer than this part. Stresses take 95 to 102 parts of 100, displacements 91.
const WORTH_IT: f64 = 0.85;

/// A symmetric tensor with its components by name, so that no order has to be remembered.
///
/// Shears are tensor components, not engineering strains.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SymTensor {
    /// On the plane normal to x, along x.
    pub xx: f64,
    /// On the plane normal to y, along y.
    pub yy: f64,
    /// On the plane normal to z, along z.
    pub zz: f64,
    /// On the plane normal to x, along y.
    pub xy: f64,
    /// On the plane normal to y, along z.
    pub yz: f64,
    /// On the plane normal to x, along z.
    pub xz: f64,
}

impl SymTensor {
    /// The components in VTK's order, [`TENSOR_COMPONENTS`].
    pub fn to_vtk(self) -> [f64; 6] {
        [self.xx, self.yy, self.zz, self.xy, self.yz, self.xz]
    }
}

/// The values of a field, one per node or cell.
#[derive(Clone, Copy, Debug)]
pub enum Values<'a> {
    /// A number each.
    Scalar(&'a [f64]),
    /// A vector each.
    Vector(&'a [[f64; 3]]),
    /// A symmetric tensor each.
    Tensor(&'a [SymTensor]),
    /// A small whole number each, a status for instance.
    Int8(&'a [i8]),
    /// A whole number each.
    Int32(&'a [i32]),
    /// A large whole number each.
    Int64(&'a [i64]),
}

/// A named field over the nodes or the cells.
#[derive(Clone, Copy, Debug)]
pub struct Field<'a> {
    /// Its name, unique among the fields of the same place.
    pub name: &'a str,
    /// Its values.
    pub values: Values<'a>,
    /// Names of the components, or nothing for the usual ones.
    pub component_names: &'a [&'a str],
}

impl<'a> Field<'a> {
    /// A field with the usual names for its components.
    pub fn new(name: &'a str, values: Values<'a>) -> Self {
        Self {
            name,
            values,
            component_names: &[],
        }
    }
}

/// Something known about the whole frame.
#[derive(Clone, Copy, Debug)]
pub struct Fact<'a> {
    /// Its name; `TimeValue` is the time that viewers show.
    pub name: &'a str,
    /// Its value.
    pub value: FactValue<'a>,
}

/// The value of a [`Fact`].
#[derive(Clone, Copy, Debug)]
pub enum FactValue<'a> {
    /// Numbers.
    Real(&'a [f64]),
    /// Whole numbers.
    Whole(&'a [i64]),
    /// Text.
    Text(&'a str),
}

/// A grid with its fields, borrowed.
///
/// # Shapes
/// `points`, `point_data`: one per node; `types`, `cell_data`: one per cell; `offsets`: one more than cells, starting with 0;
/// the nodes of cell `c` are `connectivity[offsets[c]..offsets[c + 1]]`.
///
/// # Units
/// Those of the case.
#[derive(Clone, Copy, Debug, Default)]
pub struct Grid<'a> {
    /// Coordinates.
    pub points: &'a [[f64; 3]],
    /// VTK's type of every cell.
    pub types: &'a [u8],
    /// Where the nodes of every cell start.
    pub offsets: &'a [usize],
    /// Nodes of all cells, counted from 0, in VTK's order.
    pub connectivity: &'a [u32],
    /// Fields over the nodes; the first vector is the one that viewers warp by.
    pub point_data: &'a [Field<'a>],
    /// Fields over the cells.
    pub cell_data: &'a [Field<'a>],
    /// What is known about the whole frame.
    pub facts: &'a [Fact<'a>],
}

/// How numbers are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Coordinates and fields with 24 instead of 53 bits.
    pub single: bool,
    /// The effort of compression, 0 to 9; nothing for plain bytes, which can be memory-mapped.
    pub compression: Option<u32>,
    /// Node numbers with 64 bits even where 32 are enough.
    pub long_ids: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            single: false,
            compression: Some(1),
            long_ids: false,
        }
    }
}

/// Why a frame could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VtuError {
    /// The disk failed.
    #[error(transparent)]
    Fs(#[from] FsError),
    /// An array has not the length that the grid asks for.
    #[error("array \"{name}\" has {got} values where the grid has {expected}")]
    WrongLength {
        /// The array.
        name: String,
        /// Values needed.
        expected: usize,
        /// Values given.
        got: usize,
    },
    /// Two arrays of the same place have one name, or one has none.
    #[error("the array name \"{name}\" is empty or given twice")]
    BadName {
        /// The name.
        name: String,
    },
    /// A field has names for another number of components.
    #[error("array \"{name}\" has {expected} components and names for {got}")]
    WrongComponentNames {
        /// The array.
        name: String,
        /// Components.
        expected: usize,
        /// Names given.
        got: usize,
    },
    /// A cell has an unknown type, another number of nodes than its type, or a node that is not there.
    #[error("cell {cell} (counted from 0) of VTK type {cell_type} is not one of this grid: {why}")]
    BadCell {
        /// The cell, from 0.
        cell: usize,
        /// Its type.
        cell_type: u8,
        /// What is wrong.
        why: &'static str,
    },
}

/// Writes a frame, complete or not at all, and returns its size in bytes.
///
/// # Errors
/// [`VtuError`]; an earlier file of that name is then still there.
pub fn write(
    fs: &dyn Fs,
    path: &Path,
    grid: &Grid<'_>,
    options: &Options,
) -> Result<usize, VtuError> {
    let bytes = encode(grid, options)?;
    fs.write_atomic(path, &bytes)?;
    Ok(bytes.len())
}

/// Turns a frame into the bytes of a `.vtu` file.
///
/// # Errors
/// All of [`VtuError`] but [`VtuError::Fs`].
pub fn encode(grid: &Grid<'_>, options: &Options) -> Result<Vec<u8>, VtuError> {
    check(grid)?;
    let mut file = File {
        options,
        xml: String::new(),
        data: Vec::new(),
        offsets: Vec::new(),
        waiting: Vec::new(),
    };
    file.grid(grid);
    file.store();
    Ok(file.into_bytes())
}

/// A file in the making.
struct File<'o> {
    options: &'o Options,
    /// The text in front, without the offsets of arrays.
    xml: String,
    data: Vec<u8>,
    /// Where in the text the offset of each array belongs, and what it is, as far as arrays are stored.
    offsets: Vec<(usize, usize)>,
    /// Arrays that are not stored yet, with their places in the text.
    waiting: Vec<(usize, Vec<u8>)>,
}

impl File<'_> {
    fn grid(&mut self, grid: &Grid<'_>) {
        let compressor = match self.options.compression {
            Some(_) => " compressor=\"vtkZLibDataCompressor\"",
            None => "",
        };
        self.line(&format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
             header_type=\"UInt64\"{compressor}>\n  <UnstructuredGrid>"
        ));
        self.line("    <FieldData>");
        for fact in grid.facts {
            self.fact(fact);
        }
        self.line("    </FieldData>");
        let (npoint, ncell) = (grid.points.len(), grid.types.len());
        self.line(&format!(
            "    <Piece NumberOfPoints=\"{npoint}\" NumberOfCells=\"{ncell}\">"
        ));
        self.fields("PointData", grid.point_data);
        self.fields("CellData", grid.cell_data);
        self.line("      <Points>");
        self.reals("Points", grid.points.as_flattened(), 3, &[]);
        self.line("      </Points>\n      <Cells>");
        self.cells(grid);
        self.line("      </Cells>\n    </Piece>\n  </UnstructuredGrid>");
    }

    fn fact(&mut self, fact: &Fact<'_>) {
        match fact.value {
            FactValue::Real(values) => {
                let tuples = format!(" NumberOfTuples=\"{}\"", values.len());
                self.array("Float64", fact.name, &tuples, le(values, f64::to_le_bytes));
            }
            FactValue::Whole(values) => {
                let tuples = format!(" NumberOfTuples=\"{}\"", values.len());
                self.array("Int64", fact.name, &tuples, le(values, i64::to_le_bytes));
            }
            FactValue::Text(text) => {
                // VTK's text: the bytes as numbers, ended by a zero.
                let name = escape(fact.name);
                let codes: String = text
                    .bytes()
                    .filter(|b| *b != 0)
                    .map(|b| format!("{b} "))
                    .collect();
                self.line(&format!(
                    "      <Array type=\"String\" Name=\"{name}\" NumberOfTuples=\"1\" format=\"ascii\">{codes}0</Array>"
                ));
            }
        }
    }

    fn fields(&mut self, place: &str, fields: &[Field<'_>]) {
        let vector = fields
            .iter()
            .find(|field| matches!(field.values, Values::Vector(_)));
        let active = vector
            .map(|field| format!(" Vectors=\"{}\"", escape(field.name)))
            .unwrap_or_default();
        self.line(&format!("      <{place}{active}>"));
        for Field {
            name,
            values,
            component_names,
        } in fields
        {
            match values {
                Values::Scalar(values) => self.reals(name, values, 1, component_names),
                Values::Vector(values) => {
                    self.reals(name, values.as_flattened(), 3, component_names)
                }
                Values::Tensor(values) => {
                    let flat: Vec<f64> = values.iter().flat_map(|t| t.to_vtk()).collect();
                    let names = if component_names.is_empty() {
                        &TENSOR_COMPONENTS[..]
                    } else {
                        component_names
                    };
                    self.reals(name, &flat, 6, names);
                }
                Values::Int8(values) => self.array("Int8", name, "", le(values, i8::to_le_bytes)),
                Values::Int32(values) => {
                    self.array("Int32", name, "", le(values, i32::to_le_bytes))
                }
                Values::Int64(values) => {
                    self.array("Int64", name, "", le(values, i64::to_le_bytes))
                }
            }
        }
        self.line(&format!("      </{place}>"));
    }

    fn cells(&mut self, grid: &Grid<'_>) {
        let ends = grid.offsets.get(1..).unwrap_or_default();
        let largest = grid.points.len().max(grid.connectivity.len());
        if self.options.long_ids || i32::try_from(largest).is_err() {
            self.array(
                "Int64",
                "connectivity",
                "",
                le(grid.connectivity, |n| i64::from(n).to_le_bytes()),
            );
            self.array(
                "Int64",
                "offsets",
                "",
                le(ends, |end| (end as i64).to_le_bytes()),
            );
        } else {
            self.array(
                "Int32",
                "connectivity",
                "",
                le(grid.connectivity, |n| (n as i32).to_le_bytes()),
            );
            self.array(
                "Int32",
                "offsets",
                "",
                le(ends, |end| (end as i32).to_le_bytes()),
            );
        }
        self.array("UInt8", "types", "", grid.types.to_vec());
    }

    /// Real numbers, `ncomponent` per node or cell.
    fn reals(&mut self, name: &str, values: &[f64], ncomponent: usize, component_names: &[&str]) {
        let mut shape = format!(" NumberOfComponents=\"{ncomponent}\"");
        for (i, component) in component_names.iter().enumerate() {
            // Writing into a string cannot fail.
            let _ = write!(shape, " ComponentName{i}=\"{}\"", escape(component));
        }
        if self.options.single {
            self.array(
                "Float32",
                name,
                &shape,
                le(values, |v| (v as f32).to_le_bytes()),
            );
        } else {
            self.array("Float64", name, &shape, le(values, f64::to_le_bytes));
        }
    }

    /// One array: its tag now, its bytes behind those before it when there are enough.
    fn array(&mut self, kind: &str, name: &str, shape: &str, bytes: Vec<u8>) {
        let name = escape(name);
        // Writing into a string cannot fail.
        let _ = write!(
            self.xml,
            "        <DataArray type=\"{kind}\" Name=\"{name}\"{shape} format=\"appended\" offset=\""
        );
        self.waiting.push((self.xml.len(), bytes));
        self.line("\"/>");
        let waiting: usize = self.waiting.iter().map(|(_, bytes)| bytes.len()).sum();
        if waiting > TOGETHER {
            self.store();
        }
    }

    /// Stores what waits; pieces of all arrays are compressed in parallel and do not depend on the number of threads.
    fn store(&mut self) {
        let Self {
            options,
            data,
            offsets,
            waiting,
            ..
        } = self;
        let Some(level) = options.compression else {
            for (at, bytes) in waiting.drain(..) {
                offsets.push((at, data.len()));
                data.extend_from_slice(&(bytes.len() as u64).to_le_bytes());
                data.extend_from_slice(&bytes);
            }
            return;
        };
        let pieces = waiting.iter().flat_map(|(_, bytes)| bytes.chunks(PIECE));
        let pieces: Vec<&[u8]> = pieces.collect();
        let deflated = pieces.into_par_iter().with_max_len(1);
        let deflated = deflated.map_init(|| Deflate::new(level), Deflate::piece);
        let mut deflated = deflated.collect::<Vec<Vec<u8>>>().into_iter();
        for (at, bytes) in waiting.drain(..) {
            offsets.push((at, data.len()));
            let count = bytes.len().div_ceil(PIECE);
            let own: Vec<Vec<u8>> = deflated.by_ref().take(count).collect();
            let header = [count as u64, PIECE as u64, (bytes.len() % PIECE) as u64];
            let sizes = own.iter().map(|piece| piece.len() as u64);
            let header: Vec<u64> = header.into_iter().chain(sizes).collect();
            extend_le(data, &header, u64::to_le_bytes);
            own.iter().for_each(|piece| data.extend_from_slice(piece));
        }
    }

    /// The whole file.
    fn into_bytes(self) -> Vec<u8> {
        let Self {
            xml, data, offsets, ..
        } = self;
        let mut out = Vec::with_capacity(xml.len() + 8 * offsets.len() + data.len() + 64);
        let mut rest = xml.as_bytes();
        let mut before = 0;
        for (at, offset) in offsets {
            let (text, others) = rest.split_at((at - before).min(rest.len()));
            out.extend_from_slice(text);
            out.extend_from_slice(offset.to_string().as_bytes());
            (rest, before) = (others, at);
        }
        out.extend_from_slice(rest);
        out.extend_from_slice(b"  <AppendedData encoding=\"raw\">\n   _");
        out.extend_from_slice(&data);
        out.extend_from_slice(b"\n  </AppendedData>\n</VTKFile>\n");
        out
    }

    fn line(&mut self, text: &str) {
        self.xml.push_str(text);
        self.xml.push('\n');
    }
}

fn le<T: Copy, const N: usize>(values: &[T], to_le: impl Fn(T) -> [u8; N]) -> Vec<u8> {
    let mut out = Vec::new();
    extend_le(&mut out, values, to_le);
    out
}

/// What makes zlib streams.
struct Deflate {
    wanted: Compress,
    stored: Compress,
    sample: Vec<u8>,
}

impl Deflate {
    fn new(level: u32) -> Self {
        let of_level = |level| Compress::new(Compression::new(level), true);
        Self {
            wanted: of_level(level.min(9)),
            stored: of_level(0),
            sample: Vec::new(),
        }
    }

    /// One stream. Where samples say that nothing is gained, as of most digits of most numbers, bytes are stored as they
    /// are.
    fn piece(&mut self, bytes: &[u8]) -> Vec<u8> {
        if bytes.len() > 2 * SAMPLES * SAMPLE {
            self.sample.clear();
            for k in 0..SAMPLES {
                let at = k * (bytes.len() - SAMPLE) / (SAMPLES - 1);
                let sample = bytes.get(at..at + SAMPLE).unwrap_or_default();
                self.sample.extend_from_slice(sample);
            }
            let deflated = stream(&mut self.wanted, &self.sample);
            if deflated.len() as f64 > WORTH_IT * self.sample.len() as f64 {
                return stream(&mut self.stored, bytes);
            }
        }
        stream(&mut self.wanted, bytes)
    }
}

/// One zlib stream.
fn stream(state: &mut Compress, bytes: &[u8]) -> Vec<u8> {
    state.reset();
    let mut out = Vec::with_capacity(bytes.len() + 64);
    loop {
        let rest = bytes.get(state.total_in() as usize..).unwrap_or_default();
        match state.compress_vec(rest, &mut out, FlushCompress::Finish) {
            Ok(Status::StreamEnd) => return out,
            // Only room can be missing: the state is new and the input whole.
            Ok(_) | Err(_) => out.reserve(out.capacity().max(64)),
        }
    }
}

fn check(grid: &Grid<'_>) -> Result<(), VtuError> {
    let (npoint, ncell) = (grid.points.len(), grid.types.len());
    let same = |name: &str, expected: usize, got: usize| match got == expected {
        true => Ok(()),
        false => Err(VtuError::WrongLength {
            name: name.into(),
            expected,
            got,
        }),
    };
    if !(ncell == 0 && grid.offsets.is_empty()) {
        same("offsets", ncell + 1, grid.offsets.len())?;
    }
    same(
        "connectivity",
        grid.offsets.last().copied().unwrap_or(0),
        grid.connectivity.len(),
    )?;
    let types = CellType::by_number();
    let nnode_of = |number: u8| match number {
        cells::VERTEX => Some(1),
        _ => types.get(number as usize)?.map(|one| one.element.nnode()),
    };
    for (cell, (cell_type, ends)) in grid.types.iter().zip(grid.offsets.windows(2)).enumerate() {
        let bad = |why| VtuError::BadCell {
            cell,
            cell_type: *cell_type,
            why,
        };
        let nnode = nnode_of(*cell_type).ok_or(bad("the type is unknown"))?;
        let nodes = match ends {
            [start, end] => grid
                .connectivity
                .get(*start..*end)
                .ok_or(bad("its offsets are not in order"))?,
            _ => &[],
        };
        if nodes.len() != nnode {
            return Err(bad("it has not as many nodes as its type"));
        }
        if nodes.iter().any(|node| *node as usize >= npoint) {
            return Err(bad("it has a node that is not there"));
        }
    }
    for (fields, expected) in [(grid.point_data, npoint), (grid.cell_data, ncell)] {
        distinct(fields.iter().map(|field| field.name))?;
        for Field {
            name,
            values,
            component_names,
        } in fields
        {
            let (got, ncomponent) = match values {
                Values::Scalar(v) => (v.len(), 1),
                Values::Vector(v) => (v.len(), 3),
                Values::Tensor(v) => (v.len(), 6),
                Values::Int8(v) => (v.len(), 1),
                Values::Int32(v) => (v.len(), 1),
                Values::Int64(v) => (v.len(), 1),
            };
            same(name, expected, got)?;
            if !component_names.is_empty() && component_names.len() != ncomponent {
                let (name, got) = ((*name).to_string(), component_names.len());
                return Err(VtuError::WrongComponentNames {
                    name,
                    expected: ncomponent,
                    got,
                });
            }
        }
    }
    distinct(grid.facts.iter().map(|fact| fact.name))
}

fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Result<(), VtuError> {
    let mut seen = std::collections::BTreeSet::new();
    for name in names {
        if name.is_empty() || !seen.insert(name) {
            return Err(VtuError::BadName { name: name.into() });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
