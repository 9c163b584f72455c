//! What of a deck is read.

/// What of a deck is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    Mesh,
    MeshOfShells,
    Whole,
}

impl Part {
    /// Whether a card that is not of the mesh is kept.
    pub fn keeps(self, keyword: &str) -> bool {
        match self {
            Self::Mesh => false,
            Self::MeshOfShells => keyword == SHELL_SECTION,
            Self::Whole => !["ENDPART", "ENDINSTANCE", "INCLUDE"].contains(&keyword),
        }
    }
}

/// The card that makes shells of elements.
pub(super) const SHELL_SECTION: &str = "SHELLSECTION";
