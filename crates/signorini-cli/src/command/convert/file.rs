//! Files that are converted: their forms, and how they are written.

use crate::command::findings::not_written;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Severity, codes};
use signorini_io::fs::{Fs, RealFs};
use std::path::Path;

/// The end of a file name, in small letters.
pub(super) fn extension(path: &Path) -> String {
    let end = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    end.unwrap_or_default()
}

/// Writes a file whole, or leaves what was there.
pub(super) fn write(path: &Path, bytes: &[u8]) -> Result<(), Diagnostic> {
    RealFs
        .write_atomic(path, bytes)
        .map_err(|error| not_written(&error))
}

/// Notes of a reader as findings.
pub(super) fn noted(notes: Vec<String>) -> Diagnostics {
    let mut found = Diagnostics::new();
    for note in notes {
        found.push(Diagnostic::new(Severity::Note, &codes::MESH_NOTE, note));
    }
    found
}

/// What cannot be written in another form.
pub(super) fn no_such_form(what: impl std::fmt::Display) -> Diagnostic {
    Diagnostic::error(&codes::NOT_BUILT, what.to_string())
}
