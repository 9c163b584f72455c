//! What several commands do with findings.

use signorini::Diagnostics;
use signorini_io::diagnostic::{Diagnostic, codes};
use signorini_io::fs::{Fs, FsError, RealFs};
use std::path::Path;

/// All findings of two phases, in their order.
pub fn joined(mut first: Diagnostics, second: Diagnostics) -> Diagnostics {
    first.append(second);
    first
}

/// The content of a file.
pub fn read(path: &Path) -> Result<Vec<u8>, Diagnostic> {
    RealFs.read(path).map_err(|error| {
        Diagnostic::error(&codes::UNREADABLE, error.to_string()).help(error.help())
    })
}

/// The message for a file that could not be written.
pub fn not_written(error: &FsError) -> Diagnostic {
    Diagnostic::error(&codes::NOT_WRITTEN, error.to_string()).help(error.help())
}
