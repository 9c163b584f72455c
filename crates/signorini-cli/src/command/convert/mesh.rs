//! Meshes in other formats.

use super::file::{extension, no_such_form, noted, write};
use super::grid::Cells;
use crate::command::findings::read;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_io::readers::read_mesh;
use signorini_io::writers::inp;
use std::path::Path;

/// Writes a mesh as .inp or .vtu. In a .vtu, a set of cells is an array of its name that is 1 inside and -1 outside; sets of
/// nodes and faces are left out.
///
/// # Errors
/// A mesh that cannot be read, or that the format does not have; the disk.
pub fn convert(from: &Path, to: &Path) -> Result<Diagnostics, Diagnostics> {
    let (mesh, mut notes) = read_mesh(&from.display().to_string(), &read(from)?)
        .map_err(|error| Diagnostic::error(&codes::BAD_MESH, error.to_string()))?;
    if extension(to) == "inp" {
        let text = inp::encode(&mesh).map_err(no_such_form)?;
        write(to, text.as_bytes())?;
    } else {
        let bytes = Cells::new(&mesh, |_| true).encode(&[], None);
        write(to, &bytes.map_err(no_such_form)?)?;
        let left = mesh.sets.values();
        let left = left.filter(|set| !set.nodes.is_empty() || !set.faces.is_empty());
        match left.count() {
            0 => {}
            n => notes.push(format!(
                "{n} sets of nodes or faces are left out: .vtu has cells only"
            )),
        }
    }
    Ok(noted(notes))
}
