//! The tables on the way to a key.

/// A table on the way to a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// `[mesh]`, or a table inside a value.
    Table(&'static str),
    /// `[[contact]]`.
    List(&'static str),
    /// `[material.NAME]`.
    Named(&'static str),
}

impl Part {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Table(name) | Self::List(name) | Self::Named(name) => name,
        }
    }
}
