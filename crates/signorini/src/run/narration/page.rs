//! The page that lines are written for.

/// What the lines are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Page {
    /// Characters in a line: the table has columns that fit. Sentences are not broken.
    pub width: usize,
}

impl Default for Page {
    fn default() -> Self {
        Self { width: 120 }
    }
}
