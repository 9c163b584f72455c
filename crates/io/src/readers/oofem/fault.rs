//! What is wrong with a record.

use crate::diagnostic::{Code, Diagnostic, Place, codes};
use thiserror::Error;

/// A fault and where it is.
#[derive(Clone, Debug)]
pub struct Fault {
    /// Where.
    pub place: Place,
    /// What.
    pub error: RecordError,
}

/// Why a record cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum RecordError {
    /// The file ends where another record should follow.
    #[error("the deck ends where {wanted} should follow; is it cut off, or is a count too large?")]
    End {
        /// What should follow.
        wanted: String,
    },
    /// A record of another kind.
    #[error(
        "`{found}` stands where {wanted} should; are the counts of the records before it right?"
    )]
    Unexpected {
        /// What stands there.
        found: String,
        /// What should.
        wanted: String,
    },
    /// A keyword without which the record means nothing.
    #[error("this record has no `{keyword}`")]
    Missing {
        /// The keyword.
        keyword: &'static str,
    },
    /// Something else where a number should be.
    #[error("`{found}` stands where {wanted} of `{keyword}` should")]
    NotANumber {
        /// The keyword.
        keyword: String,
        /// What stands there.
        found: String,
        /// What should.
        wanted: &'static str,
    },
    /// A list that is shorter than its count.
    #[error(
        "the list of `{keyword}` is announced to have {wanted} entries, but the record ends after {found}"
    )]
    Short {
        /// The keyword.
        keyword: String,
        /// Its count.
        wanted: u64,
        /// How many there are.
        found: usize,
    },
    /// A number outside of what it may be.
    #[error("`{keyword}` is {found}; it must be {wanted}")]
    OutOfRange {
        /// The keyword.
        keyword: String,
        /// What it is.
        found: String,
        /// What it may be.
        wanted: &'static str,
    },
    /// Two records with one number.
    #[error("a second {what} has the number {number}; give it a number of its own")]
    Twice {
        /// What.
        what: &'static str,
        /// The number.
        number: u64,
    },
    /// A number that nothing has.
    #[error("there is no {what} {number}")]
    Undefined {
        /// What.
        what: &'static str,
        /// The number.
        number: u64,
    },
    /// Nothing that is known.
    #[error("there is no {what} `{found}`{meant}")]
    Unknown {
        /// What.
        what: &'static str,
        /// What stands there.
        found: String,
        /// What may have been meant.
        meant: String,
    },
    /// An element whose list of nodes is too short or too long.
    #[error("element {element} has {found} nodes; {kind} has {wanted}")]
    NodeCount {
        /// Its number.
        element: u64,
        /// Its type.
        kind: &'static str,
        /// How many there are.
        found: usize,
        /// How many there should be.
        wanted: usize,
    },
    /// A node twice in an element.
    #[error("element {element} has node {node} twice; collapsed elements are not supported")]
    Repeated {
        /// The element.
        element: u64,
        /// The node.
        node: u64,
    },
    /// A side that an element does not have.
    #[error("element {element} ({kind}) has no side {side}; it has {nside}")]
    NoSide {
        /// The element.
        element: u64,
        /// Its type.
        kind: &'static str,
        /// The side.
        side: u64,
        /// How many it has.
        nside: usize,
    },
    /// Something that is known, and not built.
    #[error("{what} is not supported: {why}")]
    NotBuilt {
        /// What.
        what: String,
        /// Why.
        why: String,
    },
    /// More than memory should hold.
    #[error("{what} come to more than a deck of this size can mean")]
    Excess {
        /// What.
        what: &'static str,
    },
}

impl RecordError {
    fn code(&self) -> &'static Code {
        match self {
            Self::End { .. } | Self::Missing { .. } => &codes::MISSING,
            Self::Unexpected { .. } | Self::Unknown { .. } => &codes::UNKNOWN_KEY,
            Self::NotANumber { .. } => &codes::NOT_A_NUMBER,
            Self::Short { .. } | Self::NodeCount { .. } => &codes::WRONG_LENGTH,
            Self::OutOfRange { .. } | Self::Excess { .. } => &codes::OUT_OF_RANGE,
            Self::Twice { .. } => &codes::NAME_TWICE,
            Self::Undefined { .. } => &codes::UNDEFINED,
            Self::Repeated { .. } | Self::NoSide { .. } => &codes::BAD_MESH,
            Self::NotBuilt { .. } => &codes::NOT_BUILT,
        }
    }
}

impl From<Fault> for Diagnostic {
    fn from(fault: Fault) -> Self {
        Self::error(fault.error.code(), fault.error.to_string()).at(&fault.place, "")
    }
}

/// At most 40 characters of what was found.
pub(super) fn shown(text: &str) -> String {
    let mut short: String = text.chars().take(40).flat_map(char::escape_debug).collect();
    if text.chars().count() > 40 {
        short.push('…');
    }
    short
}
