//! Bytes of a file as text.
//!
//! Text is UTF-8, with or without byte order mark; lines may end in LF, CR LF or CR.

use crate::diagnostic::{Diagnostic, codes};

/// The text of a file, ready for reading.
///
/// # Errors
/// What is not text in UTF-8 is refused, and UTF-16 named where it is likely.
pub(super) fn decode(name: &str, bytes: &[u8]) -> Result<String, Diagnostic> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    if bytes.starts_with(b"\xFF\xFE") || bytes.starts_with(b"\xFE\xFF") || every_other_is_nul(bytes)
    {
        return Err(
            Diagnostic::error(&codes::NOT_TEXT, format!("{name} is text in UTF-16"))
                .help("save it as UTF-8 (Windows Notepad: Save as, Encoding: UTF-8)"),
        );
    }
    if let Some(at) = bytes.iter().position(|byte| *byte == 0) {
        return Err(not_text(name, bytes, at, "a NUL byte"));
    }
    match std::str::from_utf8(bytes) {
        Err(error) => {
            let one = not_text(
                name,
                bytes,
                error.valid_up_to(),
                "a byte that UTF-8 does not have",
            );
            Err(one.help("if letters with accents are in it, save it as UTF-8 instead of Latin-1"))
        }
        Ok(text) if text.contains('\r') && !text.contains('\n') => Ok(text.replace('\r', "\n")),
        Ok(text) => Ok(text.to_owned()),
    }
}

/// UTF-16 without a mark: text in most languages of Europe has a NUL in every other byte.
fn every_other_is_nul(bytes: &[u8]) -> bool {
    let start = bytes.get(..bytes.len().min(64)).unwrap_or_default();
    let nul = |odd: usize| {
        start
            .iter()
            .skip(odd)
            .step_by(2)
            .filter(|byte| **byte == 0)
            .count()
    };
    start.len() >= 4 && nul(0).abs_diff(nul(1)) * 2 >= start.len() - 1
}

fn not_text(name: &str, bytes: &[u8], at: usize, found: &str) -> Diagnostic {
    let before = bytes.get(..at).unwrap_or_default();
    let line = before.iter().filter(|byte| **byte == b'\n').count() + 1;
    Diagnostic::error(&codes::NOT_TEXT, format!("{name} is not text"))
        .note(format!("{found} stands at byte {at}, in line {line}"))
        .help("name the case, a text file in TOML; a mesh is named inside of it: [mesh] file = \"part.msh\"")
}
