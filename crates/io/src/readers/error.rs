use super::oofem::{Fault, RecordError};
use crate::vtk::VtuReadError;
use std::fmt;
use thiserror::Error;

/// Where a fault is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// A file as a whole.
    File(String),
    /// A line of a text file, from 1.
    Line {
        /// The file.
        file: String,
        /// The line.
        line: usize,
    },
    /// A byte of a binary file, from 0.
    Byte {
        /// The file.
        file: String,
        /// The byte.
        offset: usize,
    },
    /// An entry of an inline table, from 1.
    Entry {
        /// `"nodes"` or `"elements"`.
        table: &'static str,
        /// The entry.
        entry: usize,
    },
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(file) => f.write_str(file),
            Self::Line { file, line } => write!(f, "{file}, line {line}"),
            Self::Byte { file, offset } => write!(f, "{file}, byte {offset}"),
            Self::Entry { table, entry } => write!(f, "[mesh] {table}, entry {entry}"),
        }
    }
}

/// Why a mesh cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum MeshError {
    /// No reader for this extension.
    #[error("{place}: no reader for this kind of file; meshes can be .{known}")]
    UnknownFormat {
        /// Where.
        place: Place,
        /// What is known.
        known: String,
    },
    /// A file of no bytes, or of white space only.
    #[error("{place}: the file is empty; was it written to the end?")]
    Empty {
        /// Where.
        place: Place,
    },
    /// Something else altogether.
    #[error("{place}: this is not a Gmsh mesh: it starts with `{found}`, not with $MeshFormat")]
    NotAMesh {
        /// Where.
        place: Place,
        /// What was found.
        found: String,
    },
    /// Text of two bytes per character.
    #[error("{place}: the file is in UTF-16; save it as UTF-8")]
    Utf16 {
        /// Where.
        place: Place,
    },
    /// A version that is not read.
    #[error(
        "{place}: Gmsh format {found} is not supported; save as 4.1: Mesh.MshFileVersion = 4.1 (or 2.2)"
    )]
    Version {
        /// Where.
        place: Place,
        /// What was found.
        found: String,
    },
    /// A header that contradicts itself.
    #[error(
        "{place}: {what} in $MeshFormat is {found}, which must be {wanted}; save the mesh again"
    )]
    Format {
        /// Where.
        place: Place,
        /// Which part.
        what: &'static str,
        /// What was found.
        found: String,
        /// What is needed.
        wanted: &'static str,
    },
    /// The file ends too early.
    #[error(
        "{place}: the file ends inside {section}, where {wanted} should follow; it is truncated: save or copy it again"
    )]
    Truncated {
        /// Where.
        place: Place,
        /// The section.
        section: String,
        /// What is needed.
        wanted: &'static str,
    },
    /// Something else where a number should be.
    #[error("{place}: `{found}` stands where {wanted} should be in {section}{hint}")]
    NotANumber {
        /// Where.
        place: Place,
        /// The section.
        section: String,
        /// What is needed.
        wanted: &'static str,
        /// What was found.
        found: String,
        /// What to do.
        hint: &'static str,
    },
    /// An infinite coordinate, or not a number.
    #[error("{place}: coordinate {axis} of node {node} is {found}; coordinates must be finite")]
    NotFinite {
        /// Where.
        place: Place,
        /// The node.
        node: u64,
        /// The coordinate.
        axis: char,
        /// What was found.
        found: String,
    },
    /// A number outside of what can be used.
    #[error(
        "{place}: {wanted} is {found}, which is out of range ({range}); {}",
        damaged(place)
    )]
    OutOfRange {
        /// Where.
        place: Place,
        /// What is needed.
        wanted: &'static str,
        /// What was found.
        found: String,
        /// What can be used.
        range: &'static str,
    },
    /// A count that the rest of the file cannot hold.
    #[error(
        "{place}: {wanted} is {announced}, but only {remaining} bytes follow; {}",
        damaged(place)
    )]
    TooMany {
        /// Where.
        place: Place,
        /// What is needed.
        wanted: &'static str,
        /// What was announced.
        announced: u64,
        /// What is left of the file, bytes.
        remaining: usize,
    },
    /// A count that is not met.
    #[error(
        "{place}: ${section} announces {announced} {what}, but its blocks hold {found}; correct the count or save the mesh again"
    )]
    Count {
        /// Where.
        place: Place,
        /// The section.
        section: String,
        /// Which part.
        what: &'static str,
        /// What was announced.
        announced: u64,
        /// What was found.
        found: u64,
    },
    /// More in a section than was announced.
    #[error(
        "{place}: `{found}` stands where $End{section} should be; the section holds more than its count says, or the mark is missing"
    )]
    SectionEnd {
        /// Where.
        place: Place,
        /// The section.
        section: String,
        /// What was found.
        found: String,
    },
    /// Text between sections.
    #[error(
        "{place}: `{found}` stands between sections, where one such as $Nodes should start; remove it"
    )]
    NotASection {
        /// Where.
        place: Place,
        /// What was found.
        found: String,
    },
    /// A section that must not come again.
    #[error("{place}: a second ${section}; a mesh has one: save it again as one model")]
    SectionTwice {
        /// Where.
        place: Place,
        /// The section.
        section: String,
    },
    /// A section that is needed first.
    #[error("{place}: ${section} comes before ${needed}; put ${needed} first, as Gmsh writes it")]
    SectionOrder {
        /// Where.
        place: Place,
        /// The section.
        section: &'static str,
        /// The section it needs.
        needed: &'static str,
    },
    /// A section that must be there.
    #[error("{place}: there is no ${section} in this file; save the whole mesh")]
    NoSection {
        /// Where.
        place: Place,
        /// The section.
        section: &'static str,
    },
    /// A group line without a name.
    #[error(
        "{place}: the name of physical group {tag} is not in double quotes: `{found}`; write {dim} {tag} \"name\""
    )]
    NoName {
        /// Where.
        place: Place,
        /// The dimension.
        dim: u8,
        /// The tag.
        tag: i64,
        /// What was found.
        found: String,
    },
    /// Groups of groups without bound.
    #[error(
        "{place}: the elements are in more physical groups ({found} memberships) than a file of this size can mean; the tags of $Entities are damaged"
    )]
    TooManyMemberships {
        /// Where.
        place: Place,
        /// What was found.
        found: u64,
    },
    /// A number of an element type that nobody knows.
    #[error("{place}: there is no element type `{found}`; supported are {known}")]
    UnknownElement {
        /// Where.
        place: Place,
        /// What was found.
        found: String,
        /// What is known.
        known: String,
    },
    /// Types that are known but not supported.
    #[error("{place}: the mesh has {found}: not supported yet; {hint}")]
    Unsupported {
        /// Where.
        place: Place,
        /// What was found.
        found: String,
        /// What to do.
        hint: &'static str,
    },
    /// Elements in a block of another dimension.
    #[error(
        "{place}: elements of {element} stand in an entity of dimension {dim}; the block is damaged: save the mesh again"
    )]
    WrongDimension {
        /// Where.
        place: Place,
        /// The element.
        element: String,
        /// The dimension.
        dim: u8,
    },
    /// An element with too few or too many nodes.
    #[error("{place}: element {element} has {found} nodes; a {kind} has {wanted}")]
    NodeCount {
        /// Where.
        place: Place,
        /// The element.
        element: u64,
        /// Its type.
        kind: String,
        /// What was found.
        found: usize,
        /// What is needed.
        wanted: usize,
    },
    /// A node that is not there.
    #[error(
        "{place}: element {element} refers to node {node}, which the mesh does not have; correct the element or add the node"
    )]
    MissingNode {
        /// Where.
        place: Place,
        /// The element.
        element: u64,
        /// The node.
        node: u64,
    },
    /// The same node twice in one element.
    #[error(
        "{place}: element {element} has node {node} twice; collapsed elements are not supported: use a type with fewer nodes"
    )]
    RepeatedNode {
        /// Where.
        place: Place,
        /// The element.
        element: u64,
        /// The node.
        node: u64,
    },
    /// Two nodes of one number.
    #[error("{place}: node {node} is defined a second time; give every node a number of its own")]
    DuplicateNode {
        /// Where.
        place: Place,
        /// The node.
        node: u64,
    },
    /// Two elements of one number.
    #[error(
        "{place}: element {element} is defined a second time; give every element a number of its own"
    )]
    DuplicateElement {
        /// Where.
        place: Place,
        /// The element.
        element: u64,
    },
    /// Bytes that are no text.
    #[error("{place}: the file is not text: it holds zero bytes; export the deck again")]
    NotText {
        /// Where.
        place: Place,
    },
    /// A deck that starts with data.
    #[error(
        "{place}: `{found}` stands where a keyword such as *NODE should be; a deck starts with a keyword"
    )]
    NotACard {
        /// Where.
        place: Place,
        /// What was found.
        found: String,
    },
    /// A keyword without a parameter that it needs.
    #[error("{place}: *{card} has no {parameter}; write *{card}, {parameter}=…")]
    NoParameter {
        /// Where.
        place: Place,
        /// The keyword.
        card: String,
        /// The parameter.
        parameter: &'static str,
    },
    /// A keyword with a parameter that it does not take.
    #[error("{place}: {what}; {remark}")]
    Parameter {
        /// Where.
        place: Place,
        /// What is wrong.
        what: String,
        /// What was probably meant, or what the card takes.
        remark: String,
    },
    /// A data line with more values than its card takes.
    #[error("{place}: a line of *{card} takes {wanted}, found {found} values{hint}")]
    TooManyValues {
        /// Where.
        place: Place,
        /// The keyword.
        card: String,
        /// What it takes.
        wanted: &'static str,
        /// How many there are.
        found: usize,
        /// What to do.
        hint: &'static str,
    },
    /// A keyword that changes the mesh in a way that is not read.
    #[error("{place}: *{card} is refused: {why}")]
    Refused {
        /// Where.
        place: Place,
        /// The keyword.
        card: String,
        /// What it would do, and what to do.
        why: &'static str,
    },
    /// A keyword where it cannot be.
    #[error("{place}: *{card} stands {found}; {wanted}")]
    Nesting {
        /// Where.
        place: Place,
        /// The keyword.
        card: String,
        /// Where it stands.
        found: &'static str,
        /// Where it should.
        wanted: &'static str,
    },
    /// An included file that cannot be read.
    #[error("{place}: the file `{path}` cannot be included: {why}")]
    Include {
        /// Where.
        place: Place,
        /// As the deck names it.
        path: String,
        /// Why.
        why: String,
    },
    /// A file that includes itself.
    #[error(
        "{place}: the file `{path}` includes itself, directly or through others; remove this line"
    )]
    IncludeCycle {
        /// Where.
        place: Place,
        /// As the deck names it.
        path: String,
    },
    /// Files in files in files.
    #[error("{place}: files include each other more than {limit} deep; put them into one")]
    IncludeDepth {
        /// Where.
        place: Place,
        /// The limit.
        limit: usize,
    },
    /// A few lines that mean more than memory can hold.
    #[error("{place}: {what} come to more than a file of this size can mean")]
    Excess {
        /// Where.
        place: Place,
        /// What repeats itself.
        what: &'static str,
    },
    /// A name that nothing has.
    #[error("{place}: there is no {what} `{name}`{known}")]
    Undefined {
        /// Where.
        place: Place,
        /// What should have the name.
        what: &'static str,
        /// The name.
        name: String,
        /// `"; there are …"`, or nothing.
        known: String,
    },
    /// Two things with one name.
    #[error("{place}: a second {what} is called `{name}`; give it a name of its own")]
    DuplicateName {
        /// Where.
        place: Place,
        /// What has the name.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// A side that is none.
    #[error("{place}: surface `{surface}`: element {element} ({kind}) has no side {side}{hint}")]
    NoSuchSide {
        /// Where.
        place: Place,
        /// The surface.
        surface: Box<str>,
        /// The element.
        element: u64,
        /// Its type.
        kind: &'static str,
        /// As the deck names it.
        side: Box<str>,
        /// `"; its sides are …"`, or what to do.
        hint: Box<str>,
    },
    /// A `.vtu` file that cannot be read.
    #[error("{place}: {error}")]
    Vtu {
        /// Where.
        place: Place,
        /// Why.
        error: VtuReadError,
    },
    /// A `.frd` file that cannot be read.
    #[error("{place}: {what}")]
    Frd {
        /// Where.
        place: Place,
        /// What is wrong.
        what: &'static str,
    },
    /// A record of a deck of OOFEM that cannot be read.
    #[error("{place}: {error}")]
    Record {
        /// Where.
        place: Place,
        /// Why.
        error: Box<RecordError>,
    },
    /// Nodes alone.
    #[error(
        "{place}: the mesh has {nnode} nodes but no elements; mesh the model before saving it whole (in Gmsh: put what is to be saved into physical groups, or set Mesh.SaveAll = 1)"
    )]
    NoElements {
        /// Where.
        place: Place,
        /// How many nodes there are.
        nnode: usize,
    },
}

/// What number may be wrong for.
fn damaged(place: &Place) -> &'static str {
    match place {
        Place::Byte { .. } => {
            "the file is truncated, damaged or in another byte order: save it again"
        }
        _ => "the file is truncated or damaged: correct the number or save it again",
    }
}

/// At most 40 characters of what was found, on one line.
pub(super) fn excerpt(bytes: &[u8]) -> String {
    let start = bytes.get(..bytes.len().min(160)).unwrap_or(bytes);
    let text = String::from_utf8_lossy(start);
    let mut short: String = text.chars().take(40).flat_map(char::escape_debug).collect();
    if text.chars().count() > 40 {
        short.push('…');
    }
    short
}

impl From<Fault> for MeshError {
    fn from(fault: Fault) -> Self {
        let place = match fault.place.get() {
            Some((file, range)) => Place::Line {
                file: file.name().to_owned(),
                line: file.line_index(range.start) + 1,
            },
            None => Place::File(String::new()),
        };
        Self::Record {
            place,
            error: Box::new(fault.error),
        }
    }
}
