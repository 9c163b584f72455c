//! Reads `.vtu` files with appended raw data, as this program writes them.
//!
//! Nothing is believed: every size is checked against the bytes that are there, and against the counts of the grid,
//! before memory is asked for.
//!
//! Limits: appended raw data only, little-endian, one piece, no compressor but zlib.

use flate2::{Decompress, FlushDecompress, Status};

use super::super::xml::{Piece, Scanner, Tag, XmlError};
use crate::fs::bytes::decode_le;

/// No zlib stream is shorter than its content by more than this factor.
const DEFLATE_LIMIT: u64 = 1032;

/// The numbers of an array, in the type of the file.
#[derive(Clone, Debug, PartialEq)]
pub enum Numbers {
    /// `Float64`
    F64(Vec<f64>),
    /// `Float32`
    F32(Vec<f32>),
    /// `Int8`
    I8(Vec<i8>),
    /// `UInt8`
    U8(Vec<u8>),
    /// `Int32`
    I32(Vec<i32>),
    /// `Int64`
    I64(Vec<i64>),
    /// `String`
    Text(String),
}

impl Numbers {
    /// The numbers as reals; whole numbers beyond 2⁵³ are rounded, text has none.
    pub fn to_f64(&self) -> Vec<f64> {
        match self {
            Numbers::F64(v) => v.clone(),
            Numbers::F32(v) => v.iter().map(|x| f64::from(*x)).collect(),
            Numbers::I8(v) => v.iter().map(|x| f64::from(*x)).collect(),
            Numbers::U8(v) => v.iter().map(|x| f64::from(*x)).collect(),
            Numbers::I32(v) => v.iter().map(|x| f64::from(*x)).collect(),
            Numbers::I64(v) => v.iter().map(|x| *x as f64).collect(),
            Numbers::Text(_) => Vec::new(),
        }
    }
}

/// A named array.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// Its name.
    pub name: String,
    /// Values per node, cell or entry.
    pub ncomponent: usize,
    /// Names of the components, where there are any.
    pub component_names: Vec<String>,
    /// All values, entry by entry.
    pub numbers: Numbers,
}

/// A grid with its fields, as read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Vtu {
    /// Coordinates.
    pub points: Vec<[f64; 3]>,
    /// VTK's type of every cell.
    pub types: Vec<u8>,
    /// Where the nodes of every cell start, and where the last ones end.
    pub offsets: Vec<usize>,
    /// Nodes of all cells, counted from 0; all of them exist.
    pub connectivity: Vec<usize>,
    /// Fields over the nodes.
    pub point_data: Vec<Array>,
    /// Fields over the cells.
    pub cell_data: Vec<Array>,
    /// What is known about the whole frame.
    pub facts: Vec<Array>,
}

impl Vtu {
    /// A field over the nodes.
    pub fn point_field(&self, name: &str) -> Option<&Array> {
        self.point_data.iter().find(|array| array.name == name)
    }

    /// A field over the cells.
    pub fn cell_field(&self, name: &str) -> Option<&Array> {
        self.cell_data.iter().find(|array| array.name == name)
    }

    /// Something known about the whole frame.
    pub fn fact(&self, name: &str) -> Option<&Array> {
        self.facts.iter().find(|array| array.name == name)
    }

    /// The time of the frame.
    pub fn time(&self) -> Option<f64> {
        self.fact("TimeValue")
            .and_then(|array| array.numbers.to_f64().first().copied())
    }
}

/// Why a file could not be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum VtuReadError {
    /// The part before the numbers is not XML.
    #[error("the file is not a .vtu file: {0}")]
    Xml(#[from] XmlError),
    /// The file is of a kind that is not read; convert it.
    #[error("the file is of a kind that is not read here: {what}")]
    Unsupported {
        /// What it has.
        what: String,
    },
    /// Something that must be there is not.
    #[error("the file has no {what}; it is torn or not a .vtu file")]
    Missing {
        /// What is missing.
        what: &'static str,
    },
    /// The bytes of an array are not what the file says about them.
    #[error("array \"{name}\" is damaged: {what}")]
    Damaged {
        /// The array.
        name: String,
        /// What does not fit.
        what: &'static str,
    },
    /// The file asks for more memory than is allowed.
    #[error("array \"{name}\" would take more than the {limit} bytes allowed for this file")]
    TooLarge {
        /// The array.
        name: String,
        /// The limit.
        limit: u64,
    },
}

/// Reads a `.vtu` file; its content may be as large as 256 MiB and 64 times the file.
///
/// # Errors
/// [`VtuReadError`].
pub fn read(bytes: &[u8]) -> Result<Vtu, VtuReadError> {
    read_limited(bytes, (256 << 20) + 64 * bytes.len() as u64)
}

/// Reads a `.vtu` file whose content may be as large as `limit` bytes.
///
/// # Errors
/// [`VtuReadError`].
pub fn read_limited(bytes: &[u8], limit: u64) -> Result<Vtu, VtuReadError> {
    let missing = |what| VtuReadError::Missing { what };
    let tag = find(bytes, b"<AppendedData").ok_or(missing("appended data"))?;
    let (head, rest) = bytes.split_at(tag);
    let start = rest
        .iter()
        .position(|b| *b == b'_')
        .ok_or(missing("appended data"))?
        + 1;
    let (appended, data) = rest.split_at(start);
    let tail = data
        .trim_ascii_end()
        .strip_suffix(b"</VTKFile>")
        .map(<[u8]>::trim_ascii_end);
    let data = tail
        .and_then(|tail| tail.strip_suffix(b"</AppendedData>"))
        .ok_or(missing("end"))?;
    let text = |bytes| {
        std::str::from_utf8(bytes).map_err(|e| XmlError {
            what: "bytes that are not UTF-8",
            at: e.valid_up_to(),
        })
    };
    // The head and the tag of the data, closed again, are a document of their own.
    let document = text(head)?.to_string()
        + text(appended)?.trim_end_matches('_')
        + "</AppendedData></VTKFile>";
    let mut reader = Reader {
        data,
        limit,
        left: limit,
        is_compressed: false,
        vtu: Vtu::default(),
    };
    reader.document(&document)?;
    Ok(reader.vtu)
}

/// The arrays that belong to a grid, found before they can be checked.
#[derive(Default)]
struct Layout {
    npoint: u64,
    ncell: u64,
    points: Option<Slot>,
    connectivity: Option<Slot>,
    offsets: Option<Slot>,
    types: Option<Slot>,
    fields: Vec<(Place, Slot)>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Points,
    Cells,
    Facts,
}

/// The types of numbers that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    F64,
    F32,
    I8,
    U8,
    I32,
    I64,
}

impl Kind {
    fn width(self) -> u64 {
        match self {
            Kind::F64 | Kind::I64 => 8,
            Kind::F32 | Kind::I32 => 4,
            Kind::I8 | Kind::U8 => 1,
        }
    }
}

/// One array as its tag describes it.
struct Slot {
    name: String,
    kind: Kind,
    ncomponent: u64,
    component_names: Vec<String>,
    /// Tuples, for arrays of the whole frame.
    ntuple: u64,
    offset: u64,
}

impl Slot {
    fn damaged(&self, what: &'static str) -> VtuReadError {
        VtuReadError::Damaged {
            name: self.name.clone(),
            what,
        }
    }
}

struct Reader<'a> {
    data: &'a [u8],
    limit: u64,
    /// Bytes of content that may still be read.
    left: u64,
    is_compressed: bool,
    vtu: Vtu,
}

impl Reader<'_> {
    fn document(&mut self, text: &str) -> Result<(), VtuReadError> {
        let mut scanner = Scanner::new(text);
        let mut path: Vec<&str> = Vec::new();
        let mut layout = Layout::default();
        let mut npiece = 0;
        let mut fact = None;
        while let Some(piece) = scanner.piece()? {
            match piece {
                Piece::Open(tag) => {
                    let parent = path.last().copied().unwrap_or_default();
                    match (parent, tag.name) {
                        ("", "VTKFile") => self.file(&tag)?,
                        ("UnstructuredGrid", "Piece") => {
                            npiece += 1;
                            layout.npoint = count(&tag, "NumberOfPoints")?;
                            layout.ncell = count(&tag, "NumberOfCells")?;
                        }
                        ("FieldData", "Array") => {
                            fact = Some(tag.get("Name").unwrap_or_default().to_string())
                        }
                        ("FieldData", "DataArray") => {
                            layout.fields.push((Place::Facts, slot(&tag)?))
                        }
                        ("PointData", "DataArray") => {
                            layout.fields.push((Place::Points, slot(&tag)?))
                        }
                        ("CellData", "DataArray") => {
                            layout.fields.push((Place::Cells, slot(&tag)?))
                        }
                        ("Points", "DataArray") => layout.points = Some(slot(&tag)?),
                        ("Cells", "DataArray") => match tag.get("Name") {
                            Some("connectivity") => layout.connectivity = Some(slot(&tag)?),
                            Some("offsets") => layout.offsets = Some(slot(&tag)?),
                            Some("types") => layout.types = Some(slot(&tag)?),
                            _ => return unsupported("an array of cells with another name"),
                        },
                        ("VTKFile", "AppendedData") if tag.get("encoding") != Some("raw") => {
                            return unsupported("data that is not raw");
                        }
                        _ => {}
                    }
                    path.push(tag.name);
                }
                Piece::Close(_) => {
                    path.pop();
                }
                Piece::Text(codes) => {
                    if let Some(name) = fact.take() {
                        self.text_fact(name, &codes)?;
                    }
                }
            }
        }
        match npiece {
            1 => self.grid(layout),
            0 => Err(VtuReadError::Missing { what: "piece" }),
            _ => unsupported("more than one piece"),
        }
    }

    fn file(&mut self, tag: &Tag<'_>) -> Result<(), VtuReadError> {
        for (key, value) in [
            ("type", "UnstructuredGrid"),
            ("byte_order", "LittleEndian"),
            ("header_type", "UInt64"),
        ] {
            if tag.get(key) != Some(value) {
                return unsupported(&format!(
                    "{key} is {:?}, not {value:?}",
                    tag.get(key).unwrap_or("not given")
                ));
            }
        }
        self.is_compressed = match tag.get("compressor") {
            None => false,
            Some("vtkZLibDataCompressor") => true,
            Some(other) => return unsupported(&format!("compressor {other:?}")),
        };
        Ok(())
    }

    fn text_fact(&mut self, name: String, codes: &str) -> Result<(), VtuReadError> {
        let damaged = |what| VtuReadError::Damaged {
            name: name.clone(),
            what,
        };
        let bytes: Vec<u8> = codes
            .split_ascii_whitespace()
            .map(str::parse)
            .collect::<Result<_, _>>()
            .map_err(|_| damaged("its text is not made of bytes"))?;
        let bytes = bytes.strip_suffix(&[0]).unwrap_or(&bytes);
        let text =
            String::from_utf8(bytes.to_vec()).map_err(|_| damaged("its text is not UTF-8"))?;
        self.vtu.facts.push(Array {
            name,
            ncomponent: 1,
            component_names: vec![],
            numbers: Numbers::Text(text),
        });
        Ok(())
    }

    fn grid(&mut self, layout: Layout) -> Result<(), VtuReadError> {
        let missing = |what| VtuReadError::Missing { what };
        let Layout {
            npoint,
            ncell,
            points,
            connectivity,
            offsets,
            types,
            fields,
        } = layout;

        let slot = points.ok_or(missing("points"))?;
        if slot.ncomponent != 3 {
            return Err(slot.damaged("points have three components"));
        }
        let flat = self.numbers(&slot, Some(npoint))?.to_f64();
        self.vtu.points = flat.as_chunks::<3>().0.to_vec();

        let slot = types.ok_or(missing("cell types"))?;
        self.vtu.types = match self.numbers(&slot, Some(ncell))? {
            Numbers::U8(types) => types,
            _ => return Err(slot.damaged("cell types are UInt8")),
        };

        let slot = offsets.ok_or(missing("cell offsets"))?;
        let ends = self.indices(&slot, Some(ncell))?;
        self.vtu.offsets = std::iter::once(0).chain(ends).collect();
        if !self.vtu.offsets.is_sorted() {
            return Err(slot.damaged("offsets decrease"));
        }

        let slot = connectivity.ok_or(missing("connectivity"))?;
        let last = self.vtu.offsets.last().map_or(0, |last| *last as u64);
        self.vtu.connectivity = self.indices(&slot, Some(last))?;
        if self
            .vtu
            .connectivity
            .iter()
            .any(|node| *node as u64 >= npoint)
        {
            return Err(slot.damaged("a node is not there"));
        }

        for (place, slot) in fields {
            let ntuple = match place {
                Place::Points => npoint,
                Place::Cells => ncell,
                Place::Facts => slot.ntuple,
            };
            let numbers = self.numbers(&slot, Some(ntuple))?;
            let Slot {
                name,
                ncomponent,
                component_names,
                ..
            } = slot;
            let array = Array {
                name,
                ncomponent: ncomponent as usize,
                component_names,
                numbers,
            };
            match place {
                Place::Points => self.vtu.point_data.push(array),
                Place::Cells => self.vtu.cell_data.push(array),
                Place::Facts => self.vtu.facts.push(array),
            }
        }
        Ok(())
    }

    /// Whole numbers that count something.
    fn indices(&mut self, slot: &Slot, ntuple: Option<u64>) -> Result<Vec<usize>, VtuReadError> {
        let wide: Vec<i64> = match self.numbers(slot, ntuple)? {
            Numbers::I32(v) => v.into_iter().map(i64::from).collect(),
            Numbers::I64(v) => v,
            _ => return Err(slot.damaged("node numbers are Int32 or Int64")),
        };
        let indices: Result<Vec<usize>, _> = wide.into_iter().map(usize::try_from).collect();
        indices.map_err(|_| slot.damaged("a node number is negative"))
    }

    fn numbers(&mut self, slot: &Slot, ntuple: Option<u64>) -> Result<Numbers, VtuReadError> {
        let bytes = self.bytes(slot, ntuple)?;
        Ok(match slot.kind {
            Kind::F64 => Numbers::F64(decode_le(&bytes, f64::from_le_bytes)),
            Kind::F32 => Numbers::F32(decode_le(&bytes, f32::from_le_bytes)),
            Kind::I8 => Numbers::I8(decode_le(&bytes, i8::from_le_bytes)),
            Kind::U8 => Numbers::U8(bytes),
            Kind::I32 => Numbers::I32(decode_le(&bytes, i32::from_le_bytes)),
            Kind::I64 => Numbers::I64(decode_le(&bytes, i64::from_le_bytes)),
        })
    }

    /// The bytes of an array, as many as its tag and the grid ask for.
    fn bytes(&mut self, slot: &Slot, ntuple: Option<u64>) -> Result<Vec<u8>, VtuReadError> {
        let block = usize::try_from(slot.offset)
            .ok()
            .and_then(|at| self.data.get(at..));
        let mut block = block.ok_or(slot.damaged("it starts behind the end of the file"))?;
        let expected = ntuple
            .and_then(|n| {
                n.checked_mul(slot.ncomponent)?
                    .checked_mul(slot.kind.width())
            })
            .ok_or(slot.damaged("its size is out of range"))?;
        self.left = self
            .left
            .checked_sub(expected)
            .ok_or(VtuReadError::TooLarge {
                name: slot.name.clone(),
                limit: self.limit,
            })?;
        if self.is_compressed {
            return inflate(block, expected).map_err(|what| slot.damaged(what));
        }
        if take_u64(&mut block) != Some(expected) {
            return Err(slot.damaged("its size is not the one of the grid"));
        }
        let bytes = usize::try_from(expected).ok().and_then(|n| block.get(..n));
        Ok(bytes
            .ok_or(slot.damaged("it ends behind the end of the file"))?
            .to_vec())
    }
}

/// The content of a compressed block, `expected` bytes.
fn inflate(mut block: &[u8], expected: u64) -> Result<Vec<u8>, &'static str> {
    const TORN: &str = "it ends behind the end of the file";
    const SIZE: &str = "its size is not the one of the grid";
    let mut header = || take_u64(&mut block).ok_or(TORN);
    let (npiece, full, last) = (header()?, header()?, header()?);
    let content = match (npiece, last) {
        (0, _) => Some(0),
        (_, 0) => npiece.checked_mul(full),
        (_, last) if last < full => (npiece - 1)
            .checked_mul(full)
            .and_then(|n| n.checked_add(last)),
        _ => None,
    };
    if content != Some(expected) {
        return Err(SIZE);
    }
    let sizes_length = usize::try_from(npiece)
        .ok()
        .and_then(|n| n.checked_mul(8))
        .ok_or(TORN)?;
    let (sizes, mut streams) = block.split_at_checked(sizes_length).ok_or(TORN)?;
    if expected > DEFLATE_LIMIT.saturating_mul(streams.len() as u64) {
        return Err("it claims more content than its bytes can hold");
    }
    let mut out = Vec::new();
    let room = usize::try_from(expected).map_err(|_| SIZE)?;
    out.try_reserve_exact(room)
        .map_err(|_| "there is not enough memory for it")?;
    let mut state = Decompress::new(true);
    let mut piece = Vec::new();
    for (i, size) in decode_le(sizes, u64::from_le_bytes).into_iter().enumerate() {
        let stream;
        (stream, streams) = usize::try_from(size)
            .ok()
            .and_then(|n| streams.split_at_checked(n))
            .ok_or(TORN)?;
        let content = if i as u64 + 1 == npiece && last > 0 {
            last
        } else {
            full
        };
        if content > DEFLATE_LIMIT.saturating_mul(size) {
            return Err("it claims more content than its bytes can hold");
        }
        state.reset(true);
        piece.clear();
        // A little more than the content, so that a stream that is too long shows.
        piece.reserve_exact(content as usize + 16);
        let status = state.decompress_vec(stream, &mut piece, FlushDecompress::Finish);
        let status = status.map_err(|_| "its compressed bytes are wrong")?;
        if status != Status::StreamEnd || piece.len() as u64 != content {
            return Err("its compressed bytes hold another amount of content");
        }
        out.extend_from_slice(&piece);
    }
    Ok(out)
}

fn take_u64(bytes: &mut &[u8]) -> Option<u64> {
    let (first, rest) = bytes.split_first_chunk::<8>()?;
    *bytes = rest;
    Some(u64::from_le_bytes(*first))
}

fn slot(tag: &Tag<'_>) -> Result<Slot, VtuReadError> {
    let name = tag.get("Name").unwrap_or_default().to_string();
    if tag.get("format") != Some("appended") {
        return unsupported(&format!("array {name:?} is not appended"));
    }
    let kind = match tag.get("type").unwrap_or_default() {
        "Float64" => Kind::F64,
        "Float32" => Kind::F32,
        "Int8" => Kind::I8,
        "UInt8" => Kind::U8,
        "Int32" => Kind::I32,
        "Int64" => Kind::I64,
        other => return unsupported(&format!("array {name:?} has type {other:?}")),
    };
    let or_one = |key| {
        if tag.get(key).is_some() {
            count(tag, key)
        } else {
            Ok(1)
        }
    };
    let ncomponent = or_one("NumberOfComponents")?;
    if !(1..=64).contains(&ncomponent) {
        return unsupported(&format!("array {name:?} has {ncomponent} components"));
    }
    let component_names = (0..ncomponent)
        .map_while(|i| tag.get(&format!("ComponentName{i}")).map(str::to_string))
        .collect();
    let (ntuple, offset) = (or_one("NumberOfTuples")?, count(tag, "offset")?);
    Ok(Slot {
        name,
        kind,
        ncomponent,
        component_names,
        ntuple,
        offset,
    })
}

fn count(tag: &Tag<'_>, key: &'static str) -> Result<u64, VtuReadError> {
    tag.get(key)
        .and_then(|value| value.parse().ok())
        .ok_or(VtuReadError::Missing { what: key })
}

fn unsupported<T>(what: &str) -> Result<T, VtuReadError> {
    Err(VtuReadError::Unsupported {
        what: what.to_string(),
    })
}

fn find(bytes: &[u8], what: &[u8]) -> Option<usize> {
    bytes.windows(what.len()).position(|window| window == what)
}
