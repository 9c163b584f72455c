//! Meshes from files and from inline data, and their faults.
//!
//! ```text
//! bytes ──reader by extension──▶ (Mesh, notes) ──validate──▶ issues
//! ```
//!
//! A reader is a function from the name and the bytes of a file to a [`Mesh`] and notes worth telling. It trusts
//! nothing: no count is believed before the bytes that remain could hold it, nothing recurses, every fault is a
//! [`MeshError`] with its place. What a mesh that could be read still gets wrong (volumes, coincident nodes) is the
//! matter of [`validate`].
//!
//! Triangles of rigid surfaces are no meshes of bodies: [`stl`] reads them by themselves. Results are read back too: of
//! `.frd` files with their mesh by [`frd::parse`], of `.dat` tables by [`dat::parse`], of comma-separated values by
//! [`csv::records`].
//!
//! To add a format: one file here with a function of type [`Reader`], and one line in [`READERS`].

pub mod csv;
pub mod dat;
mod error;
mod fortran;
pub mod frd;
pub mod gmsh;
mod inline;
pub mod inp;
pub(crate) mod labels;
pub mod oofem;
mod side;
pub mod stl;
mod validate;
pub mod vtu;

pub use error::{MeshError, Place};
pub use fortran::LineError;
pub use inline::{InlineElement, build};
pub use side::{SideError, side_by_normal};
pub use signorini_geometry::mesh::quality::parts;
pub use validate::{MeshIssue, Sample, Severity, validate, validate_as};

use signorini_geometry::mesh::Mesh;

/// Reads the bytes of the file of this name: the mesh, and notes about what was ignored or is unusual.
pub type Reader = fn(&str, &[u8]) -> Result<(Mesh, Vec<String>), MeshError>;

/// Readers by extension, in lower case.
pub const READERS: [(&str, Reader); 5] = [
    ("msh", gmsh::read),
    ("inp", inp::read),
    ("in", oofem::read),
    ("vtu", vtu::read),
    ("frd", frd::read),
];

/// Reads a mesh in the format that the extension of `name` says.
///
/// # Errors
/// An extension that [`READERS`] does not list; any fault in the file.
///
/// # Example
/// ```
/// use signorini_io::readers::read_mesh;
///
/// let deck = b"*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n\
///     *ELEMENT, TYPE=C3D4, ELSET=part\n7, 1, 2, 3, 4\n";
/// let (mesh, notes) = read_mesh("part.inp", deck)?;
/// assert_eq!((mesh.nnode(), mesh.ncell()), (4, 1));
/// assert_eq!(mesh.blocks[0].element.name(), "tet4");
/// assert!(mesh.sets.contains_key("part") && notes.is_empty());
/// # Ok::<(), signorini_io::readers::MeshError>(())
/// ```
pub fn read_mesh(name: &str, bytes: &[u8]) -> Result<(Mesh, Vec<String>), MeshError> {
    let extension = name.rsplit_once('.').map_or("", |(_, e)| e);
    let extension = extension.to_lowercase();
    match READERS.iter().find(|(known, _)| *known == extension) {
        Some((_, reader)) => reader(name, bytes),
        None => Err(MeshError::UnknownFormat {
            place: Place::File(name.into()),
            known: READERS.map(|(known, _)| known).join(", ."),
        }),
    }
}

/// The same for a case with shells: surfaces of a deck name their sides, as [`inp::read_shells`] has them.
///
/// # Errors
/// Those of [`read_mesh`].
pub fn read_mesh_of_shells(name: &str, bytes: &[u8]) -> Result<(Mesh, Vec<String>), MeshError> {
    match name.to_lowercase().ends_with(".inp") {
        true => inp::read_shells(name, bytes),
        false => read_mesh(name, bytes),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_extension_is_refused_with_the_known_ones() {
        let error = read_mesh("part.stl", b"solid").unwrap_err();
        assert_eq!(
            error.to_string(),
            "part.stl: no reader for this kind of file; meshes can be .msh, .inp, .in, .vtu, .frd"
        );
        assert!(read_mesh("part", b"").is_err());
    }

    #[test]
    fn the_extension_may_be_in_capitals() {
        let error = read_mesh("PART.MSH", b"").unwrap_err();
        assert!(matches!(error, MeshError::Empty { .. }), "{error}");
    }
}
