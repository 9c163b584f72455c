//! Decks of OOFEM (`.in`): their records, and their mesh with its sets.
//!
//! ```text
//! name of the output file           as it stands there
//! description                       as it stands there
//! analysis                          and metasteps, modules, as many as it says
//! domain, output manager, sizes
//! nodes, elements                   as many as the sizes say            ▶ nodes, cells
//! [sets], contact surfaces, contact segments
//! cross-sections, materials, conditions, initial conditions, functions
//! [sets]                            in one of the two places            ▶ sets of nodes, cells and faces
//! #%BEGIN_CHECK% … #%END_CHECK%     values to be compared, in comments
//! ```
//!
//! A record is a line of words: its type, mostly a number, then fields, each found by its keyword wherever it stands.
//! Lines that start with `#` are comments; `\` at the end joins the next line; `@include` splices a file. Keywords may
//! have any letters.
//!
//! Set 4 is called `set-4` in the mesh; where it holds several things, `set-4` are its nodes, `set-4-elements` and
//! `set-4-sides` the rest. Elements of one type, section and material are a set as `lspace-1`. Facets of contact
//! surfaces are cells of lower dimension on the sides of solids.
//!
//! Sources: OOFEM Input Data Specification, version 2.6 and later; decks of OOFEM's own and of its authors.
//!
//! To add an element: one line in the table of `kind.rs`.

mod deck;
mod fault;
mod kind;
mod mesh;
mod record;
#[cfg(test)]
mod tests;
mod text;

pub use deck::Parts;
pub use fault::{Fault, RecordError};
pub use kind::{ELEMENTS, Family, Kind};
pub use mesh::{Group, Meshed, SetNames};
pub use record::Record;
pub use text::Checks;

use super::{MeshError, Place};
use crate::fs::{Fs, RealFs};
use signorini_geometry::mesh::Mesh;

/// A deck: its mesh, and its records.
#[derive(Clone, Debug)]
pub struct Deck {
    /// Its mesh, and what its numbers are called there.
    pub meshed: Meshed,
    /// Its records.
    pub parts: Parts,
}

/// Reads the mesh of a deck. `name` is its path: files that it includes are looked for in its folder.
///
/// # Errors
/// Any fault in the order of its records, its nodes, elements and sets, with its file and line.
pub fn read(name: &str, bytes: &[u8]) -> Result<(Mesh, Vec<String>), MeshError> {
    let deck = read_deck(&RealFs, name, bytes)?;
    Ok((deck.meshed.mesh, Vec::new()))
}

/// Reads a deck with all its records.
///
/// # Errors
/// Those of [`read`]; what other records say is not looked at.
pub fn read_deck(fs: &dyn Fs, name: &str, bytes: &[u8]) -> Result<Deck, MeshError> {
    let place = || Place::File(name.to_owned());
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Err(MeshError::Utf16 { place: place() });
    }
    if bytes.contains(&0) {
        return Err(MeshError::NotText { place: place() });
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(MeshError::Empty { place: place() });
    }
    let written = String::from_utf8_lossy(bytes).into_owned();
    let text = text::read(fs, name, written)?;
    let nbyte = text.lines.iter().flat_map(|line| &line.stretches);
    let nbyte = nbyte.map(ExactSizeIterator::len).sum();
    let mut parts = deck::parts(text)?;
    let meshed = mesh::mesh(&mut parts, nbyte)?;
    if meshed.mesh.ncell() == 0 {
        return Err(MeshError::NoElements {
            place: place(),
            nnode: meshed.mesh.nnode(),
        });
    }
    Ok(Deck { meshed, parts })
}
