//! Decks of Abaqus and CalculiX (`.inp`): their mesh and its sets; all else in them is stepped over.
//!
//! ```text
//! *NODE                    number, x, y, z                                           NSET=
//! *ELEMENT, TYPE=C3D8      number, nodes; goes on over lines until they are complete ELSET=
//! *NSET, *ELSET            numbers and names of sets; GENERATE: first, last, step    ▶ sets of nodes, of cells
//! *SURFACE                 element or element set, S1 …; TYPE=NODE: nodes, node sets ▶ sets of faces, of nodes
//! *INCLUDE, INPUT=file     the file stands in place of the line
//! *PART, *INSTANCE         sets of an instance are called `instance.set`
//! ```
//!
//! `**` starts a comment. Keywords, parameters and names may have any letters and blanks; a set keeps the name it has
//! where it comes first. A card that ends with a comma goes on on the next line. Numbers are those of Fortran (`1.D5`).
//! Cards may come in any order, but a set must be there before another one names it. Sets that come twice add up.
//! Node sets, element sets and surfaces have names of their own: where two share one, see the notes.
//!
//! An instance is its part, moved and then turned. The first one keeps its numbers; those of others go on behind the
//! highest, as a note reports. What the assembly has besides comes last.
//!
//! Elements in the plane, shells, membranes, rigid facets, bars and beams are cells of their shape: with solids in the
//! mesh, its faces and edges. What they mean (plane stress, say) is reported in a note; the case decides. Masses, springs
//! and gaps are left out. Cards that make nodes or elements out of others are refused.
//!
//! Source: Abaqus Keywords Reference Guide; CalculiX CrunchiX User's Manual, chapters 6 and 7.
//!
//! To add an element: one line in the table of `kind.rs`.

mod assemble;
mod card;
mod deck;
mod definition;
mod directory;
mod kind;
mod lines;
mod parameters;
mod part;
mod spelling;
mod statement;
#[cfg(test)]
mod tests;

pub use directory::{Directory, ElementCard, Kind, Special};
pub(crate) use kind::without_volume;
pub(crate) use parameters::{judge, not_read, spelled};
pub use spelling::compared;
pub use statement::{Field, Statement};

use super::{MeshError, Place};
use crate::fs::{Fs, RealFs};
use lines::Files;
use part::Part;
use signorini_geometry::mesh::Mesh;

/// Reads a mesh, with notes. `name` is the path of the deck: files that it includes are looked
/// for in its folder, and in the working folder.
///
/// # Errors
/// Any fault in the mesh or its sets, with its file and line.
///
/// # Limits
/// Files include each other ten deep. Memory stays below a fixed multiple of the size of the deck and its files.
pub fn read(name: &str, bytes: &[u8]) -> Result<(Mesh, Vec<String>), MeshError> {
    read_from(&RealFs, name, bytes)
}

/// As [`read`], with included files from another place than the disk.
///
/// # Errors
/// Those of [`read`].
pub fn read_from(fs: &dyn Fs, name: &str, bytes: &[u8]) -> Result<(Mesh, Vec<String>), MeshError> {
    let whole = read_all(fs, name, bytes, Part::Mesh)?;
    Ok((whole.mesh, whole.notes))
}

/// As [`read`], for a case with shells: sides of elements that a *SHELL SECTION names are those of shells, see
/// [`Directory::shells`]; where nothing but shells is in the mesh and no section, those of all.
///
/// # Errors
/// Those of [`read`].
pub fn read_shells(name: &str, bytes: &[u8]) -> Result<(Mesh, Vec<String>), MeshError> {
    let whole = read_all(&RealFs, name, bytes, Part::MeshOfShells)?;
    Ok((whole.mesh, whole.notes))
}

/// A real number as Fortran writes it; finite.
#[must_use]
pub fn number(text: &str) -> Option<f64> {
    card::real(text.trim().as_bytes()).filter(|value| value.is_finite())
}

/// A deck: its mesh, and the cards that say what to do with it.
#[derive(Clone, Debug)]
pub struct Deck {
    /// The mesh.
    pub mesh: Mesh,
    /// What is worth telling about it.
    pub notes: Vec<String>,
    /// Cards that are no part of the mesh, in their order.
    pub statements: Vec<Statement>,
    /// What names and numbers of the deck are called in the mesh.
    pub directory: Directory,
}

/// Reads a deck with all its cards.
///
/// # Errors
/// Those of [`read`]; what other cards say is not looked at.
pub fn read_deck(fs: &dyn Fs, name: &str, bytes: &[u8]) -> Result<Deck, MeshError> {
    read_all(fs, name, bytes, Part::Whole)
}

fn read_all(fs: &dyn Fs, name: &str, bytes: &[u8], part: Part) -> Result<Deck, MeshError> {
    let is_blank = |b: &u8| b.is_ascii_whitespace();
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    if text.iter().all(is_blank) {
        return Err(MeshError::Empty {
            place: Place::File(name.into()),
        });
    }
    let files = Files::open(fs, name, bytes)?;
    let mut cards = deck::read(&files, part)?;
    let statements = std::mem::take(&mut cards.statements);
    let assembled = assemble::assemble(&files, cards, &statements, part)?;
    Ok(Deck {
        mesh: assembled.mesh,
        notes: assembled.notes,
        statements,
        directory: assembled.directory,
    })
}
