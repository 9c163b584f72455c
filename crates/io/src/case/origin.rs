//! Where the parts of a case come from: the file, or an override on the command line.
//!
//! ```text
//! offset  0 ……………… n   n+1 ……………………… m   m+1 ……
//!         case.toml      first --set        second --set
//! ```
//!
//! All texts share one line of offsets, so that a value carries no more than a range, wherever it comes from.

use std::ops::Range;
use std::sync::Arc;

use crate::diagnostic::{Place, SourceFile};

/// The texts of a case on one line of offsets.
pub(super) struct Origins {
    files: Vec<(usize, Arc<SourceFile>)>,
}

impl Origins {
    pub fn new(file: Arc<SourceFile>) -> Self {
        Self {
            files: vec![(0, file)],
        }
    }

    /// Adds a text and returns the offset of its first byte.
    pub fn add(&mut self, file: Arc<SourceFile>) -> usize {
        let start = self
            .files
            .last()
            .map_or(0, |(start, last)| start + last.text().len() + 1);
        self.files.push((start, file));
        start
    }

    /// The place of a range of offsets.
    pub fn place(&self, range: Range<usize>) -> Place {
        let Some((start, file)) = self.origin(range.start) else {
            return Place::nowhere();
        };
        Place::new(
            file,
            range.start - start..range.end.max(range.start) - start,
        )
    }

    /// The name of the case file.
    pub fn name(&self) -> &str {
        self.files.first().map_or("", |(_, file)| file.name())
    }

    /// The origin and the line, counted from zero, of an offset.
    pub fn line(&self, at: usize) -> (usize, usize) {
        self.origin(at).map_or((0, 0), |(start, file)| {
            (*start, file.line_index(at - start))
        })
    }

    /// The line of an offset.
    pub fn line_text(&self, at: usize) -> &str {
        let Some((start, file)) = self.origin(at) else {
            return "";
        };
        let range = file.line_range(file.line_index(at - start));
        file.text().get(range).unwrap_or_default()
    }

    /// The text of a range.
    pub fn text(&self, range: Range<usize>) -> &str {
        let Some((start, file)) = self.origin(range.start) else {
            return "";
        };
        let end = range.end.saturating_sub(*start);
        file.text()
            .get(range.start - start..end)
            .unwrap_or_default()
    }

    fn origin(&self, at: usize) -> Option<&(usize, Arc<SourceFile>)> {
        self.files.iter().rev().find(|(start, _)| *start <= at)
    }
}
