//! `signorini keywords`

use super::console::Console;
use signorini_io::deck::{KEYWORDS, Support};

/// Prints what becomes of every keyword of a deck.
pub fn execute() -> u8 {
    let out = Console::stdout();
    for (support, heading) in [
        (Support::Read, "read"),
        (
            Support::Ignored,
            "left out, with a note: they change no result here",
        ),
        (Support::Refused, "refused, with their line"),
    ] {
        out.line(&format!("{heading}:"));
        for one in KEYWORDS.iter().filter(|one| one.support == support) {
            let line = format!("  *{:<24}{}", one.name, one.remark);
            out.line(line.trim_end());
        }
    }
    0
}
