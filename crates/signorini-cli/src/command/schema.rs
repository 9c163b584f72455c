//! `signorini schema`

use super::console::Console;

/// Prints the JSON schema of cases.
pub fn execute() -> u8 {
    let text = serde_json::to_string_pretty(&signorini_io::case::schema(signorini::vocabulary()))
        .unwrap_or_default();
    Console::stdout().raw(&format!("{text}\n"));
    0
}
