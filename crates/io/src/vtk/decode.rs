use std::borrow::Cow;
use std::str::FromStr;

use flate2::{Decompress, FlushDecompress, Status};

use super::stream::Stream;
use super::xml::{Piece, Scanner, Tag, XmlError};

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
    /// `Int16`
    I16(Vec<i16>),
    /// `UInt16`
    U16(Vec<u16>),
    /// `Int32`
    I32(Vec<i32>),
    /// `UInt32`
    U32(Vec<u32>),
    /// `Int64`
    I64(Vec<i64>),
    /// `UInt64`
    U64(Vec<u64>),
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
            Numbers::I16(v) => v.iter().map(|x| f64::from(*x)).collect(),
            Numbers::U16(v) => v.iter().map(|x| f64::from(*x)).collect(),
            Numbers::I32(v) => v.iter().map(|x| f64::from(*x)).collect(),
            Numbers::U32(v) => v.iter().map(|x| f64::from(*x)).collect(),
            Numbers::I64(v) => v.iter().map(|x| *x as f64).collect(),
            Numbers::U64(v) => v.iter().map(|x| *x as f64).collect(),
            Numbers::Text(_) => Vec::new(),
        }
    }

    /// Whole numbers; nothing for reals, text, and numbers beyond 2⁶³.
    pub fn to_i64(&self) -> Option<Vec<i64>> {
        Some(match self {
            Numbers::I8(v) => v.iter().map(|x| i64::from(*x)).collect(),
            Numbers::U8(v) => v.iter().map(|x| i64::from(*x)).collect(),
            Numbers::I16(v) => v.iter().map(|x| i64::from(*x)).collect(),
            Numbers::U16(v) => v.iter().map(|x| i64::from(*x)).collect(),
            Numbers::I32(v) => v.iter().map(|x| i64::from(*x)).collect(),
            Numbers::U32(v) => v.iter().map(|x| i64::from(*x)).collect(),
            Numbers::I64(v) => v.clone(),
            Numbers::U64(v) => v
                .iter()
                .map(|x| i64::try_from(*x))
                .collect::<Result<_, _>>()
                .ok()?,
            Numbers::F64(_) | Numbers::F32(_) | Numbers::Text(_) => return None,
        })
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
    /// Names of arrays of kinds that are not read.
    pub skipped: Vec<String>,
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
    let text = |bytes| {
        std::str::from_utf8(bytes).map_err(|e| XmlError {
            what: "bytes that are not UTF-8",
            at: e.valid_up_to(),
        })
    };
    let mut reader = Reader {
        data: &[],
        limit,
        left: limit,
        storage: Storage::default(),
        vtu: Vtu::default(),
    };
    let Some(tag) = find(bytes, b"<AppendedData") else {
        reader.document(text(bytes)?)?;
        return Ok(reader.vtu);
    };
    let missing = |what| VtuReadError::Missing { what };
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
    reader.data = tail
        .and_then(|tail| tail.strip_suffix(b"</AppendedData>"))
        .ok_or(missing("end"))?;
    // The head and the tag of the data, closed again, are a document of their own.
    let document = text(head)?.to_string()
        + text(appended)?.trim_end_matches('_')
        + "</AppendedData></VTKFile>";
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
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
}

impl Kind {
    fn width(self) -> u64 {
        match self {
            Kind::F64 | Kind::I64 | Kind::U64 => 8,
            Kind::F32 | Kind::I32 | Kind::U32 => 4,
            Kind::I16 | Kind::U16 => 2,
            Kind::I8 | Kind::U8 => 1,
        }
    }
}

/// Where the values of an array are.
enum Source {
    /// Behind the document, from this offset on.
    Appended(u64),
    /// In its tag, as decimal numbers.
    Ascii(String),
    /// In its tag, in base64.
    Base64(String),
}

/// How blocks of bytes are stored in the whole file.
#[derive(Clone, Copy, Default)]
struct Storage {
    is_compressed: bool,
    is_big_endian: bool,
    /// Sizes have eight bytes, not four.
    is_wide: bool,
    /// What is appended is base64, not raw.
    is_base64: bool,
}

/// One array as its tag describes it.
struct Slot {
    name: String,
    kind: Kind,
    ncomponent: u64,
    component_names: Vec<String>,
    /// Tuples, for arrays of the whole frame.
    ntuple: u64,
    source: Source,
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
    storage: Storage,
    vtu: Vtu,
}

/// Where an array belongs, by the element around it and by its name.
enum Target {
    Field(Place),
    Points,
    Connectivity,
    Offsets,
    Types,
}

impl Reader<'_> {
    fn document(&mut self, text: &str) -> Result<(), VtuReadError> {
        let mut scanner = Scanner::new(text);
        let mut path: Vec<&str> = Vec::new();
        let mut layout = Layout::default();
        let mut npiece = 0;
        let mut fact = None;
        let mut open: Option<(Target, Slot)> = None;
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
                        ("FieldData", "Array") if tag.get("format") == Some("ascii") => {
                            fact = Some(tag.get("Name").unwrap_or_default().to_string())
                        }
                        (parent, "DataArray") => open = self.array(parent, &tag)?,
                        ("VTKFile", "AppendedData") => {
                            self.storage.is_base64 = match tag.get("encoding") {
                                Some("raw") => false,
                                Some("base64") => true,
                                _ => return unsupported("data neither raw nor in base64"),
                            };
                        }
                        _ => {}
                    }
                    path.push(tag.name);
                }
                Piece::Close(name) => {
                    path.pop();
                    if name != "DataArray" {
                        continue;
                    }
                    match open.take() {
                        Some((Target::Field(place), slot)) => layout.fields.push((place, slot)),
                        Some((Target::Points, slot)) => layout.points = Some(slot),
                        Some((Target::Connectivity, slot)) => layout.connectivity = Some(slot),
                        Some((Target::Offsets, slot)) => layout.offsets = Some(slot),
                        Some((Target::Types, slot)) => layout.types = Some(slot),
                        None => {}
                    }
                }
                Piece::Text(text) => {
                    if let Some(name) = fact.take() {
                        self.text_fact(name, &text)?;
                    } else if path.last() == Some(&"DataArray")
                        && let Some((_, slot)) = &mut open
                        && let Source::Ascii(all) | Source::Base64(all) = &mut slot.source
                    {
                        all.push_str(&text);
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

    /// An array's tag. Fields of kinds that are not read are left out; the grid itself must be read.
    fn array(
        &mut self,
        parent: &str,
        tag: &Tag<'_>,
    ) -> Result<Option<(Target, Slot)>, VtuReadError> {
        let target = match (parent, tag.get("Name")) {
            ("FieldData", _) => Target::Field(Place::Facts),
            ("PointData", _) => Target::Field(Place::Points),
            ("CellData", _) => Target::Field(Place::Cells),
            ("Points", _) => Target::Points,
            ("Cells", Some("connectivity")) => Target::Connectivity,
            ("Cells", Some("offsets")) => Target::Offsets,
            ("Cells", Some("types")) => Target::Types,
            // faces of polyhedra; cells that are some are refused by their type
            _ => return Ok(None),
        };
        match (slot(tag), target) {
            (Err(VtuReadError::Unsupported { .. }), Target::Field(_)) => {
                let name = tag.get("Name").unwrap_or_default().to_string();
                self.vtu.skipped.push(name);
                Ok(None)
            }
            (slot, target) => Ok(Some((target, slot?))),
        }
    }

    fn file(&mut self, tag: &Tag<'_>) -> Result<(), VtuReadError> {
        let other = |key: &str, found: &str| unsupported(&format!("{key} is {found:?}"));
        let get = |key| tag.get(key).unwrap_or("not given");
        match get("type") {
            "UnstructuredGrid" => {}
            found => return other("type", found),
        }
        self.storage.is_big_endian = match get("byte_order") {
            "LittleEndian" => false,
            "BigEndian" => true,
            found => return other("byte_order", found),
        };
        // the first version of the format had no other
        self.storage.is_wide = match get("header_type") {
            "UInt64" => true,
            "UInt32" | "not given" => false,
            found => return other("header_type", found),
        };
        self.storage.is_compressed = match tag.get("compressor") {
            None | Some("") => false,
            Some("vtkZLibDataCompressor") => true,
            Some(found) => return other("compressor", found),
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
        let types = self.indices(&slot, Some(ncell))?;
        let types = types
            .into_iter()
            .map(u8::try_from)
            .collect::<Result<_, _>>();
        self.vtu.types = types.map_err(|_| slot.damaged("a cell type is beyond 255"))?;

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
        let wide = self.numbers(slot, ntuple)?.to_i64();
        let wide = wide.ok_or(slot.damaged("its numbers are not whole, or too large"))?;
        let indices: Result<Vec<usize>, _> = wide.into_iter().map(usize::try_from).collect();
        indices.map_err(|_| slot.damaged("a number in it is negative"))
    }

    /// The values of an array, as many as its tag and the grid ask for.
    fn numbers(&mut self, slot: &Slot, ntuple: Option<u64>) -> Result<Numbers, VtuReadError> {
        let count = ntuple.and_then(|n| n.checked_mul(slot.ncomponent));
        let nbyte = count.and_then(|n| n.checked_mul(slot.kind.width()));
        let (count, nbyte) = count
            .zip(nbyte)
            .ok_or(slot.damaged("its size is out of range"))?;
        self.left = self.left.checked_sub(nbyte).ok_or(VtuReadError::TooLarge {
            name: slot.name.clone(),
            limit: self.limit,
        })?;
        let stream = match &slot.source {
            Source::Ascii(text) => return ascii(slot, text, count),
            Source::Base64(text) => Stream::base64(text.as_bytes()),
            Source::Appended(offset) => {
                let data = usize::try_from(*offset)
                    .ok()
                    .and_then(|at| self.data.get(at..));
                let data = data.ok_or(slot.damaged("it starts behind the end of the file"))?;
                match self.storage.is_base64 {
                    true => Stream::base64(data),
                    false => Stream::Raw(data),
                }
            }
        };
        let block = block(stream, nbyte, self.storage);
        let bytes = block.map_err(|what| slot.damaged(what))?;
        let big = self.storage.is_big_endian;
        Ok(match slot.kind {
            Kind::F64 => Numbers::F64(decode(&bytes, big, f64::from_le_bytes, f64::from_be_bytes)),
            Kind::F32 => Numbers::F32(decode(&bytes, big, f32::from_le_bytes, f32::from_be_bytes)),
            Kind::I8 => Numbers::I8(decode(&bytes, big, i8::from_le_bytes, i8::from_be_bytes)),
            Kind::U8 => Numbers::U8(bytes.into_owned()),
            Kind::I16 => Numbers::I16(decode(&bytes, big, i16::from_le_bytes, i16::from_be_bytes)),
            Kind::U16 => Numbers::U16(decode(&bytes, big, u16::from_le_bytes, u16::from_be_bytes)),
            Kind::I32 => Numbers::I32(decode(&bytes, big, i32::from_le_bytes, i32::from_be_bytes)),
            Kind::U32 => Numbers::U32(decode(&bytes, big, u32::from_le_bytes, u32::from_be_bytes)),
            Kind::I64 => Numbers::I64(decode(&bytes, big, i64::from_le_bytes, i64::from_be_bytes)),
            Kind::U64 => Numbers::U64(decode(&bytes, big, u64::from_le_bytes, u64::from_be_bytes)),
        })
    }
}

/// Bytes to numbers, in either byte order.
fn decode<T, const N: usize>(
    bytes: &[u8],
    is_big_endian: bool,
    le: fn([u8; N]) -> T,
    be: fn([u8; N]) -> T,
) -> Vec<T> {
    let from = if is_big_endian { be } else { le };
    let chunks = bytes.as_chunks::<N>().0.iter();
    chunks.map(|chunk| from(*chunk)).collect()
}

/// Decimal numbers, exactly as many as are asked for.
fn ascii(slot: &Slot, text: &str, count: u64) -> Result<Numbers, VtuReadError> {
    fn parse<T: FromStr>(text: &str, count: u64) -> Result<Vec<T>, &'static str> {
        if count > text.len() as u64 / 2 + 1 {
            return Err("its text is too short for its size");
        }
        let words = text.split_ascii_whitespace().map(str::parse);
        let numbers = words.collect::<Result<Vec<T>, _>>();
        let numbers = numbers.map_err(|_| "its text has something else than its numbers")?;
        match numbers.len() as u64 == count {
            true => Ok(numbers),
            false => Err("its size is not the one of the grid"),
        }
    }
    let numbers = match slot.kind {
        Kind::F64 => parse(text, count).map(Numbers::F64),
        Kind::F32 => parse(text, count).map(Numbers::F32),
        Kind::I8 => parse(text, count).map(Numbers::I8),
        Kind::U8 => parse(text, count).map(Numbers::U8),
        Kind::I16 => parse(text, count).map(Numbers::I16),
        Kind::U16 => parse(text, count).map(Numbers::U16),
        Kind::I32 => parse(text, count).map(Numbers::I32),
        Kind::U32 => parse(text, count).map(Numbers::U32),
        Kind::I64 => parse(text, count).map(Numbers::I64),
        Kind::U64 => parse(text, count).map(Numbers::U64),
    };
    numbers.map_err(|what| slot.damaged(what))
}

const TORN: &str = "it ends behind the end of the file, or is no base64";
const SIZE: &str = "its size is not the one of the grid";

/// The content of a block, `expected` bytes.
fn block(
    mut stream: Stream<'_>,
    expected: u64,
    storage: Storage,
) -> Result<Cow<'_, [u8]>, &'static str> {
    if storage.is_compressed {
        return inflate(stream, expected, storage).map(Cow::Owned);
    }
    if sizes(&mut stream, 1, storage)?.first() != Some(&expected) {
        return Err(SIZE);
    }
    stream.take(expected).ok_or(TORN)
}

/// Sizes in front of a block.
fn sizes(stream: &mut Stream<'_>, count: u64, storage: Storage) -> Result<Vec<u64>, &'static str> {
    let width = if storage.is_wide { 8 } else { 4 };
    let nbyte = count.checked_mul(width).ok_or(TORN)?;
    let bytes = stream.take(nbyte).ok_or(TORN)?;
    let big = storage.is_big_endian;
    if storage.is_wide {
        return Ok(decode(&bytes, big, u64::from_le_bytes, u64::from_be_bytes));
    }
    let narrow = decode(&bytes, big, u32::from_le_bytes, u32::from_be_bytes);
    Ok(narrow.into_iter().map(u64::from).collect())
}

/// The content of a compressed block, `expected` bytes.
fn inflate(
    mut stream: Stream<'_>,
    expected: u64,
    storage: Storage,
) -> Result<Vec<u8>, &'static str> {
    let head = sizes(&mut stream, 3, storage)?;
    let &[npiece, full, last] = head.as_slice() else {
        return Err(TORN);
    };
    let content = match (npiece, last) {
        (0, _) => Some(0),
        (_, 0) => npiece.checked_mul(full),
        (_, last) if last <= full => (npiece - 1)
            .checked_mul(full)
            .and_then(|n| n.checked_add(last)),
        _ => None,
    };
    if content != Some(expected) {
        return Err(SIZE);
    }
    let sizes = sizes(&mut stream, npiece, storage)?;
    if expected > DEFLATE_LIMIT.saturating_mul(stream.bound()) {
        return Err("it claims more content than its bytes can hold");
    }
    let mut out = Vec::new();
    let room = usize::try_from(expected).map_err(|_| SIZE)?;
    out.try_reserve_exact(room)
        .map_err(|_| "there is not enough memory for it")?;
    let mut state = Decompress::new(true);
    let mut piece = Vec::new();
    for (i, size) in sizes.into_iter().enumerate() {
        let content = if i as u64 + 1 == npiece && last > 0 {
            last
        } else {
            full
        };
        if content > DEFLATE_LIMIT.saturating_mul(size) {
            return Err("it claims more content than its bytes can hold");
        }
        let bytes = stream.take(size).ok_or(TORN)?;
        state.reset(true);
        piece.clear();
        // A little more than the content, so that a stream that is too long shows.
        piece.reserve_exact(content as usize + 16);
        let status = state.decompress_vec(&bytes, &mut piece, FlushDecompress::Finish);
        let status = status.map_err(|_| "its compressed bytes are wrong")?;
        if status != Status::StreamEnd || piece.len() as u64 != content {
            return Err("its compressed bytes hold another amount of content");
        }
        out.extend_from_slice(&piece);
    }
    Ok(out)
}

fn slot(tag: &Tag<'_>) -> Result<Slot, VtuReadError> {
    let name = tag.get("Name").unwrap_or_default().to_string();
    let source = match tag.get("format") {
        Some("appended") => Source::Appended(count(tag, "offset")?),
        Some("binary") => Source::Base64(String::new()),
        // what the format says where nothing is said
        Some("ascii") | None => Source::Ascii(String::new()),
        Some(other) => return unsupported(&format!("array {name:?} has format {other:?}")),
    };
    let kind = match tag.get("type").unwrap_or_default() {
        "Float64" => Kind::F64,
        "Float32" => Kind::F32,
        "Int8" => Kind::I8,
        "UInt8" => Kind::U8,
        "Int16" => Kind::I16,
        "UInt16" => Kind::U16,
        "Int32" => Kind::I32,
        "UInt32" => Kind::U32,
        "Int64" => Kind::I64,
        "UInt64" => Kind::U64,
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
    let ntuple = or_one("NumberOfTuples")?;
    Ok(Slot {
        name,
        kind,
        ncomponent,
        component_names,
        ntuple,
        source,
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
