//! Results in `.frd` files, of Signorini, CalculiX and others: the mesh, and data sets by step and increment.
//!
//! Columns are fixed, as [`frd`](crate::writers::frd) writes them: node numbers in ten columns (in the short format in
//! five), values in twelve. Counts in the file are not needed and not believed; a block ends with ` -3`. Components that
//! viewers compute from others have no values and are left out.
//!
//! Limits: text only. Lines of the head are passed over but for the title.

use super::fortran::{LineError, lines, real, whole};
use super::{MeshError, Place};
use crate::frd::cells::CellType;
use signorini_geometry::element::MAX_NODES;
use signorini_geometry::mesh::{Mesh, NodeId};
use signorini_geometry::tensor::Vec3;
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// Columns of a value.
const VALUE: usize = 12;

/// The values of one quantity at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Dataset {
    /// `DISP`
    pub name: String,
    /// Number of the step.
    pub step: u64,
    /// Number of the increment within the step.
    pub increment: u64,
    /// Total time.
    pub time: f64,
    /// Names of the components that have values.
    pub components: Vec<String>,
    /// Numbers of the nodes that have values.
    pub nodes: Vec<u64>,
    /// The values, node by node.
    pub values: Vec<f64>,
}

impl Dataset {
    /// The values at a node, by its place among those that have any.
    #[must_use]
    pub fn row(&self, place: usize) -> &[f64] {
        let n = self.components.len();
        self.values
            .get(place * n..(place + 1) * n)
            .unwrap_or_default()
    }
}

/// A file as it was read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frd {
    /// What stands behind `1C`.
    pub title: String,
    /// Numbers of the nodes.
    pub node_labels: Vec<u64>,
    /// Their coordinates.
    pub points: Vec<[f64; 3]>,
    /// Numbers of the elements.
    pub element_labels: Vec<u64>,
    /// The type of each as the file numbers it.
    pub types: Vec<u64>,
    /// Where the nodes of each start, and where the last ones end.
    pub offsets: Vec<usize>,
    /// Numbers of the nodes of all elements, in the order of the file.
    pub connectivity: Vec<u64>,
    /// Results, in the order of the file.
    pub datasets: Vec<Dataset>,
    /// Whether the file says that it is at its end.
    pub is_complete: bool,
}

impl Frd {
    /// The nodes of an element, by its place.
    #[must_use]
    pub fn nodes_of(&self, element: usize) -> &[u64] {
        match self.offsets.get(element..element + 2) {
            Some(&[start, end]) => self.connectivity.get(start..end).unwrap_or_default(),
            _ => &[],
        }
    }

    /// The data set of this name at the last time that has one.
    #[must_use]
    pub fn last(&self, name: &str) -> Option<&Dataset> {
        self.datasets.iter().rev().find(|one| one.name == name)
    }
}

/// Reads all that is in a file.
///
/// # Errors
/// The first line that is none of such a file, or not complete; a file that ends within a block.
///
/// # Limits
/// Memory is a small multiple of the size of the file.
pub fn parse(bytes: &[u8]) -> Result<Frd, LineError> {
    let mut parser = Parser::default();
    parser.frd.offsets.push(0);
    let mut last = 0;
    for (line, text) in lines(bytes) {
        let wrong = |what| LineError { line, what };
        last = line;
        if text.trim_ascii().is_empty() {
            continue;
        }
        parser.line(text).map_err(wrong)?;
        if parser.frd.is_complete {
            break;
        }
    }
    match parser.block {
        Block::None => Ok(parser.frd),
        _ => Err(LineError {
            line: last,
            what: "the file ends within a block",
        }),
    }
}

/// What the lines that start with ` -1` belong to.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
enum Block {
    #[default]
    None,
    Nodes,
    Elements,
    Values,
}

#[derive(Default)]
struct Parser {
    frd: Frd,
    block: Block,
    /// Columns of a node's number.
    label: usize,
    /// Step and increment of the next data set.
    place: [u64; 2],
    /// Entries that the present element or row still lacks.
    missing: usize,
}

impl Parser {
    fn line(&mut self, text: &[u8]) -> Result<(), &'static str> {
        let key = text.get(..6).unwrap_or(text);
        match key {
            [b' ', b'-', b'1', ..] => self.entry(text),
            [b' ', b'-', b'2', ..] => self.more(text),
            [b' ', b'-', b'3', ..] => self.end_of_block(),
            [b' ', b'-', b'4', ..] => self.name(text),
            [b' ', b'-', b'5', ..] => self.component(text),
            _ if self.block != Block::None => Err("a block has no end"),
            [b' ', b'9', b'9', b'9', b'9', ..] => {
                self.frd.is_complete = true;
                Ok(())
            }
            b"    1P" => self.parameter(text),
            b"    1C" => {
                let title = text.get(6..).unwrap_or_default();
                self.frd.title = String::from_utf8_lossy(title.trim_ascii()).into_owned();
                Ok(())
            }
            [b' ', b' ', b' ', b' ', b'1', _] => Ok(()),
            b"    2C" => self.begin(Block::Nodes, text),
            b"    3C" => self.begin(Block::Elements, text),
            b"  100C" => self.dataset(text),
            _ => Err("this is no line of a .frd file"),
        }
    }

    /// Starts a block; the last columns of its first line say how its numbers are written.
    fn begin(&mut self, block: Block, text: &[u8]) -> Result<(), &'static str> {
        self.label = match field(text, 73..75) {
            b"" | b"1" => 10,
            b"0" => 5,
            _ => return Err("numbers in binary are not read; write them as text"),
        };
        self.block = block;
        self.missing = 0;
        Ok(())
    }

    fn parameter(&mut self, text: &[u8]) -> Result<(), &'static str> {
        if text.get(6..10) == Some(b"STEP") {
            let numbers = [field(text, 36..48), field(text, 48..60)].map(whole);
            let [Some(increment), Some(step)] = numbers else {
                return Err("1PSTEP has no numbers of increment and step");
            };
            self.place = [step, increment];
        }
        Ok(())
    }

    fn dataset(&mut self, text: &[u8]) -> Result<(), &'static str> {
        let time = real(field(text, 12..24)).ok_or("a data set has no time")?;
        self.begin(Block::Values, text)?;
        let [step, increment] = self.place;
        self.frd.datasets.push(Dataset {
            step,
            increment,
            time,
            ..Dataset::default()
        });
        Ok(())
    }

    fn name(&mut self, text: &[u8]) -> Result<(), &'static str> {
        let one = self.values()?;
        if !one.name.is_empty() {
            return Err("a second name for a data set");
        }
        one.name = word(text)?;
        Ok(())
    }

    fn component(&mut self, text: &[u8]) -> Result<(), &'static str> {
        let one = self.values()?;
        if !one.nodes.is_empty() {
            return Err("a component after values");
        }
        if field(text, 33..38) != b"1" {
            one.components.push(word(text)?);
        }
        Ok(())
    }

    fn values(&mut self) -> Result<&mut Dataset, &'static str> {
        match (self.block, self.frd.datasets.last_mut()) {
            (Block::Values, Some(one)) => Ok(one),
            _ => Err("outside of a data set"),
        }
    }

    fn entry(&mut self, text: &[u8]) -> Result<(), &'static str> {
        if self.missing > 0 {
            return Err("the entry before is not complete");
        }
        let number = || whole(field(text, 3..3 + self.label)).ok_or("a number is missing");
        match self.block {
            Block::None => Err("outside of a block"),
            Block::Nodes => {
                let label = number()?;
                let mut texts = columns(text, 3 + self.label, VALUE);
                let mut next = || {
                    texts
                        .next()
                        .and_then(real)
                        .ok_or("a coordinate is no number")
                };
                let x = [next()?, next()?, next()?];
                self.frd.node_labels.push(label);
                self.frd.points.push(x);
                Ok(())
            }
            Block::Elements => {
                let label = number()?;
                let kind = whole(field(text, 3 + self.label..8 + self.label));
                let kind = kind.ok_or("an element has no type")?;
                let cell =
                    CellType::of_number(kind).ok_or("a type of elements that is not known")?;
                self.frd.element_labels.push(label);
                self.frd.types.push(kind);
                self.missing = cell.nnode();
                self.frd
                    .offsets
                    .push(self.frd.connectivity.len() + self.missing);
                Ok(())
            }
            Block::Values => {
                let label = number()?;
                let one = self.values()?;
                one.nodes.push(label);
                self.missing = one.components.len();
                self.push_values(text)
            }
        }
    }

    /// A line that goes on with an element or a row.
    fn more(&mut self, text: &[u8]) -> Result<(), &'static str> {
        match self.block {
            Block::Elements => {
                for text in columns(text, 3, self.label).take(self.missing) {
                    let node = whole(text).ok_or("a node of an element is no number")?;
                    self.frd.connectivity.push(node);
                    self.missing -= 1;
                }
                Ok(())
            }
            Block::Values if self.missing > 0 => self.push_values(text),
            _ => Err("this line goes on with nothing"),
        }
    }

    fn push_values(&mut self, text: &[u8]) -> Result<(), &'static str> {
        let (start, missing) = (3 + self.label, self.missing);
        let one = self.values()?;
        let before = one.values.len();
        for text in columns(text, start, VALUE).take(missing) {
            one.values.push(real(text).ok_or("a value is no number")?);
        }
        self.missing -= one.values.len() - before;
        Ok(())
    }

    fn end_of_block(&mut self) -> Result<(), &'static str> {
        if self.missing > 0 {
            return Err("the entry before is not complete");
        }
        if self.block == Block::None {
            return Err("the end of no block");
        }
        self.block = Block::None;
        Ok(())
    }
}

/// Some columns of a line, without blanks around them.
fn field(text: &[u8], columns: Range<usize>) -> &[u8] {
    let end = columns.end.min(text.len());
    text.get(columns.start..end)
        .unwrap_or_default()
        .trim_ascii()
}

/// What is in the columns from `start` on, `width` each, as long as there is something.
fn columns(text: &[u8], start: usize, width: usize) -> impl Iterator<Item = &[u8]> {
    let rest = text.get(start..).unwrap_or_default().trim_ascii_end();
    rest.chunks(width)
}

/// The name of a data set or component.
fn word(text: &[u8]) -> Result<String, &'static str> {
    let name = std::str::from_utf8(field(text, 5..13)).map_err(|_| "a name is no text")?;
    match name {
        "" => Err("a name is missing"),
        name => Ok(name.to_owned()),
    }
}

/// Reads the mesh of a file. `name` appears in messages.
///
/// # Errors
/// Any fault in the file, with the line; elements of nodes that are not there; coordinates that are not finite.
pub fn read(name: &str, bytes: &[u8]) -> Result<(Mesh, Vec<String>), MeshError> {
    let (mesh, frd) = read_all(name, bytes)?;
    let mut notes = Vec::new();
    if !frd.datasets.is_empty() {
        let n = frd.datasets.len();
        notes.push(format!("{n} data sets of results are left out of the mesh"));
    }
    Ok((mesh, notes))
}

/// Reads the mesh and everything else of a file. `name` appears in messages.
///
/// # Errors
/// As [`read`].
pub fn read_all(name: &str, bytes: &[u8]) -> Result<(Mesh, Frd), MeshError> {
    let place = || Place::File(name.into());
    if bytes.trim_ascii().is_empty() {
        return Err(MeshError::Empty { place: place() });
    }
    let frd = parse(bytes).map_err(|LineError { line, what }| MeshError::Frd {
        place: Place::Line {
            file: name.into(),
            line,
        },
        what,
    })?;
    Ok((mesh_of(place(), &frd)?, frd))
}

/// The mesh of what was read.
fn mesh_of(place: Place, frd: &Frd) -> Result<Mesh, MeshError> {
    let mut mesh = Mesh {
        points: frd.points.iter().map(|&x| Vec3::from(x)).collect(),
        node_labels: frd.node_labels.clone(),
        ..Mesh::default()
    };
    let mut ids = HashMap::with_capacity(frd.node_labels.len());
    for (id, (&node, x)) in (0..).zip(frd.node_labels.iter().zip(&frd.points)) {
        if ids.insert(node, id as NodeId).is_some() {
            return Err(MeshError::DuplicateNode { place, node });
        }
        for (x, axis) in x.iter().zip(['x', 'y', 'z']) {
            if !x.is_finite() {
                let found = x.to_string();
                return Err(MeshError::NotFinite {
                    place,
                    node,
                    axis,
                    found,
                });
            }
        }
    }
    let mut seen = HashSet::with_capacity(frd.types.len());
    for (number, (&kind, &element)) in frd.types.iter().zip(&frd.element_labels).enumerate() {
        let Some(cell) = CellType::of_number(kind) else {
            continue;
        };
        if !seen.insert(element) {
            return Err(MeshError::DuplicateElement { place, element });
        }
        let mut nodes = [0; MAX_NODES];
        let ours = nodes.get_mut(..cell.nnode()).unwrap_or_default();
        for (&node, at) in frd.nodes_of(number).iter().zip(cell.places()) {
            let Some(&id) = ids.get(&node) else {
                return Err(MeshError::MissingNode {
                    place,
                    element,
                    node,
                });
            };
            if let Some(entry) = ours.get_mut(at) {
                *entry = id;
            }
        }
        for (i, id) in ours.iter().enumerate() {
            if ours.iter().take(i).any(|before| before == id) {
                let node = mesh.node_labels.get(*id as usize).copied().unwrap_or(0);
                return Err(MeshError::RepeatedNode {
                    place,
                    element,
                    node,
                });
            }
        }
        mesh.push_cell(cell.element, ours, element);
    }
    match mesh.ncell() {
        0 => Err(MeshError::NoElements {
            place,
            nnode: mesh.nnode(),
        }),
        _ => Ok(mesh),
    }
}

#[cfg(test)]
mod tests;
