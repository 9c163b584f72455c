//! Decks of Abaqus and CalculiX as cases: what their cards mean in our words.
//!
//! ```text
//! bytes ──readers::inp──▶ Mesh, statements ──▶ Case
//!                                  material    materials
//!                                  forms       how many values and lines cards have
//!                                  sections    elements that have none, or one that is not theirs
//!                                  shell       sections of shells, and what of them is refused
//!                                  model       sections, amplitudes, initial conditions
//!                                  constraint  equations, local axes, rigid bodies, couplings, cuts, sectors
//!                                  mass        masses at nodes and of references, and their weight
//!                                  spring      springs between nodes, and to the ground
//!                                  contact     interactions, pairs, ties, gaps
//!                                  penetration fluids between the surfaces of pairs
//!                                  heat        heat of materials and gaps, and what acts at nodes
//!                                  submodel    nodes that move as those of another model
//!                                  step        supports, loads, changes, printed tables
//!                                  temperature temperatures that steps give, hold and solve for
//! ```
//!
//! The model section is free in its order: every stage looks for its cards in the whole of it. A name means what it
//! means in the mesh; a single node, or the nodes of several lines that say the same, become a set of the case. What
//! a card says and the program does not know is an error with its line, never left out in silence; what does no harm is
//! named once in a note. [`KEYWORDS`] lists which is which.
//!
//! Two programs, one deck: [`Compat`] says whose laws of contact hold. Decks of OOFEM are another language: [`oofem`].
//!
//! Source: CalculiX CrunchiX User's Manual, chapter 7; Abaqus Keywords Reference Guide.
//!
//! To add a card: one line in [`KEYWORDS`], and its translation in the stage where it belongs.

mod activity;
mod axes;
mod cohesion;
mod compat;
mod constraint;
mod contact;
mod forms;
mod frequency;
mod general;
mod heat;
mod interaction;
mod keywords;
mod load;
mod mass;
mod material;
mod model;
mod motion;
mod names;
pub mod oofem;
mod orientation;
mod penetration;
mod print;
mod repeated;
mod sections;
mod shell;
mod spring;
mod step;
mod submodel;
mod temperature;
#[cfg(test)]
mod tests;
mod translation;
mod user;
mod words;

pub use compat::Compat;
pub use keywords::{KEYWORDS, Keyword, Support};
pub use words::{in_words, is_of_deck, one_in_words};

use crate::case::Case;
use crate::diagnostic::{Diagnostic, Diagnostics, Severity, codes};
use crate::fs::Fs;
use crate::readers::inp;
use signorini_geometry::mesh::Mesh;
use translation::Translation;

/// A deck that was read.
#[derive(Clone, Debug)]
pub struct Read {
    /// What it asks for; its mesh is the deck itself.
    pub case: Case,
    /// Its mesh.
    pub mesh: Mesh,
    /// Warnings and notes.
    pub found: Diagnostics,
}

/// Reads a deck. `name` is its path, to which files that it includes are relative.
///
/// # Errors
/// The first fault of its mesh; else all faults of its other cards at once, each with its line.
///
/// # Example
/// ```
/// use signorini_io::deck::{Compat, read};
/// use signorini_io::fs::RealFs;
///
/// let deck = b"*NODE, NSET=ALL\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n\
///     *ELEMENT, TYPE=C3D4, ELSET=PART\n1, 1, 2, 3, 4\n\
///     *MATERIAL, NAME=STEEL\n*ELASTIC\n210000, 0.3\n*SOLID SECTION, ELSET=PART, MATERIAL=STEEL\n\
///     *BOUNDARY\n1, 1, 3\n2, 1, 3\n3, 1, 3\n\
///     *STEP\n*STATIC\n*CLOAD\n4, 3, -1\n*END STEP\n";
/// let found = read(&RealFs, "part.inp", deck, Compat::None)?;
/// assert_eq!(found.case.materials[0].number("E"), Some(210000.0));
/// assert_eq!(found.case.steps.len(), 1);
/// # Ok::<(), signorini_io::diagnostic::Diagnostics>(())
/// ```
pub fn read(fs: &dyn Fs, name: &str, bytes: &[u8], compat: Compat) -> Result<Read, Diagnostics> {
    let deck = inp::read_deck(fs, name, bytes)
        .map_err(|error| Diagnostic::error(&codes::BAD_MESH, error.to_string()))?;
    let mut translation = Translation::new(&deck, name, compat);
    if translation.has_only_structures() {
        return Err(translation.found);
    }
    translation.parameters();
    translation.forms();
    translation.model();
    translation.elements_without_section();
    translation.constraints();
    translation.point_masses();
    translation.springs();
    translation.contacts();
    translation.submodels();
    translation.steps();
    translation.overlaps();
    translation.judge();
    let (case, mut found) = (translation.case, translation.found);
    if found.has_errors() {
        found.sort_by_place();
        return Err(found);
    }
    for note in deck.notes {
        found.push(Diagnostic::new(Severity::Note, &codes::MESH_NOTE, note));
    }
    Ok(Read {
        case,
        mesh: deck.mesh,
        found,
    })
}
