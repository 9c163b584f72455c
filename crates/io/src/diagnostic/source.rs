//! Texts that were read, places in them, and values that remember theirs.

use std::ops::{Deref, Range};
use std::sync::{Arc, OnceLock};

/// A text that was read: the name users know it by, and its content.
#[derive(Debug)]
pub struct SourceFile {
    name: String,
    text: String,
    /// Lines before the text, where it is a part of a file.
    before: usize,
    line_starts: OnceLock<Vec<usize>>,
}

impl SourceFile {
    /// Keeps `text` under `name` for messages that point into it.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Arc<Self> {
        Self::excerpt(name, text, 0)
    }

    /// Keeps a part of the text called `name`, which so many lines come before.
    pub fn excerpt(name: impl Into<String>, text: impl Into<String>, before: usize) -> Arc<Self> {
        Arc::new(Self {
            name: name.into(),
            text: text.into(),
            before,
            line_starts: OnceLock::new(),
        })
    }

    /// The name users know the text by.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The whole text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The line, counted from zero, that holds the byte at `offset`.
    pub fn line_index(&self, offset: usize) -> usize {
        let starts = self.line_starts();
        let number = starts.partition_point(|start| *start <= offset);
        self.before + number.saturating_sub(1)
    }

    /// The bytes of a line counted from zero, without its line end.
    pub fn line_range(&self, line: usize) -> Range<usize> {
        let starts = self.line_starts();
        let line = line.saturating_sub(self.before);
        let length = self.text.len();
        let start = starts.get(line).copied().unwrap_or(length);
        let end = starts.get(line + 1).copied().unwrap_or(length);
        let content = self.text.get(start..end).unwrap_or_default();
        start..start + content.trim_end_matches(['\r', '\n']).len()
    }

    fn line_starts(&self) -> &[usize] {
        self.line_starts.get_or_init(|| {
            let after_breaks = self.text.match_indices('\n').map(|(at, _)| at + 1);
            std::iter::once(0).chain(after_breaks).collect()
        })
    }
}

/// Where something was written; nowhere for what was not read from a text.
///
/// All places are equal: two values that differ only in where they were written are the same.
#[derive(Clone, Debug, Default)]
pub struct Place(Option<(Arc<SourceFile>, Range<usize>)>);

impl Place {
    /// Bytes `range` of `file`.
    pub fn new(file: &Arc<SourceFile>, range: Range<usize>) -> Self {
        Self(Some((Arc::clone(file), range)))
    }

    /// The place of what was not read from a text.
    pub fn nowhere() -> Self {
        Self(None)
    }

    /// The file and the bytes in it.
    pub fn get(&self) -> Option<(&Arc<SourceFile>, Range<usize>)> {
        self.0.as_ref().map(|(file, range)| (file, range.clone()))
    }

    /// The text at this place, where there is one.
    pub fn text(&self) -> Option<&str> {
        let (file, range) = self.0.as_ref()?;
        file.text().get(range.clone())
    }

    /// `line L of NAME`, counted from one.
    pub fn line(&self) -> Option<String> {
        let (file, range) = self.0.as_ref()?;
        Some(format!(
            "line {} of {}",
            file.line_index(range.start) + 1,
            file.name()
        ))
    }
}

impl PartialEq for Place {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// A value and where it was written. Equal when the values are.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Where it was written.
    pub place: Place,
}

impl<T> Spanned<T> {
    /// A value with its place.
    pub fn new(value: T, place: Place) -> Self {
        Self { value, place }
    }
}

impl<T> Deref for Spanned<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.value
    }
}

impl<T> From<T> for Spanned<T> {
    fn from(value: T) -> Self {
        Self::new(value, Place::nowhere())
    }
}

impl From<&str> for Spanned<String> {
    fn from(value: &str) -> Self {
        value.to_owned().into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_of_a_file_has_the_lines_of_the_file() {
        let part = SourceFile::excerpt("a", "four\nfive", 3);
        assert_eq!(part.line_index(6), 4);
        assert_eq!(part.line_range(4), 5..9);
        assert_eq!(
            Place::new(&part, 5..9).line().as_deref(),
            Some("line 5 of a")
        );
    }

    #[test]
    fn lines_are_found_whatever_ends_them() {
        let file = SourceFile::new("a", "one\r\ntwo\n\nfour");
        let lines: Vec<&str> = (0..5).map(|n| &file.text()[file.line_range(n)]).collect();
        assert_eq!(lines, ["one", "two", "", "four", ""]);
        assert_eq!(
            [0, 4, 5, 9, 10, 99].map(|at| file.line_index(at)),
            [0, 0, 1, 2, 3, 3]
        );
    }

    #[test]
    fn places_do_not_make_values_differ() {
        let file = SourceFile::new("a", "steel steel");
        let first = Spanned::new("steel", Place::new(&file, 0..5));
        let second = Spanned::new("steel", Place::new(&file, 6..11));
        assert_eq!(first, second);
        assert_ne!(first, Spanned::from("rubber"));
        assert_eq!(second.place.text(), Some("steel"));
        assert_eq!(second.place.line().as_deref(), Some("line 1 of a"));
    }
}
