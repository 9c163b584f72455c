//! How keywords and names are compared and shown.

/// A keyword in capitals, with one blank between its words.
pub(super) fn title(name: &str) -> String {
    let words: Vec<String> = name.split_whitespace().map(str::to_uppercase).collect();
    words.join(" ")
}

/// What names are compared by: in capitals, without blanks, as CalculiX reads them.
pub(super) fn key(name: &str) -> String {
    let upper = name.chars().filter(|c| !c.is_whitespace());
    upper.flat_map(char::to_uppercase).collect()
}

/// What names are compared by: in capitals, without blanks and quotes.
#[must_use]
pub fn compared(name: &str) -> String {
    key(name.trim_matches('"'))
}
