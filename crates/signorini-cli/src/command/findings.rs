//! What several commands do with findings.

use signorini::Diagnostics;
use signorini_io::diagnostic::{Diagnostic, codes};
use signorini_io::fs::FsError;

/// All findings of two phases, in their order.
pub fn joined(mut first: Diagnostics, second: Diagnostics) -> Diagnostics {
    first.append(second);
    first
}

/// The message for a file that could not be written.
pub fn not_written(error: &FsError) -> Diagnostic {
    Diagnostic::error(&codes::NOT_WRITTEN, error.to_string()).help(error.help())
}
