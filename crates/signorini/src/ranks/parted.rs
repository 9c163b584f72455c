//! Why ranks meet no more.

use signorini_io::diagnostic::{Diagnostic, codes};
use signorini_ranks::RanksError;
use std::time::Duration;

/// How long a rank without files waits for rank 0 to write its ending.
pub const PATIENCE: Duration = Duration::from_secs(5);

/// Why ranks meet no more.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Parted {
    /// One has come to an end that the others do not see.
    #[error("rank {rank} has failed with exit code {exit_code}, the others go with it")]
    Fault {
        /// The rank.
        rank: usize,
        /// Its exit code.
        exit_code: u8,
    },
    /// They are not in the same state, or not at the same place.
    #[error("{what} of {} is not that of rank 0", in_words(ranks))]
    Differ {
        /// What differs.
        what: &'static str,
        /// The ranks that do not have it as rank 0 has.
        ranks: Vec<usize>,
    },
    /// They do not hear one another.
    #[error(transparent)]
    Unheard(#[from] RanksError),
}

impl Parted {
    /// The exit code of all ranks.
    #[must_use]
    pub const fn exit_code(&self) -> u8 {
        match self {
            Self::Fault { exit_code, .. } => *exit_code,
            Self::Differ { .. } | Self::Unheard(_) => crate::crash::EXIT_CODE,
        }
    }

    /// The message to the user.
    #[must_use]
    pub fn diagnostic(&self) -> Diagnostic {
        let one = Diagnostic::error(&codes::RANKS_PARTED, self.to_string());
        match self {
            Self::Fault { rank, .. } => one.help(format!("see what rank {rank} says")),
            Self::Differ { .. } => one.help(
                "run the same program on the same files everywhere; go on with  signorini resume DIR  and send a report \
                 if it happens again",
            ),
            Self::Unheard(_) => one.help("look at what mpirun says; go on with  signorini resume DIR"),
        }
    }
}

fn in_words(ranks: &[usize]) -> String {
    let names: Vec<String> = ranks.iter().map(usize::to_string).collect();
    match names.len() {
        1 => format!("rank {}", names.join("")),
        _ => format!("ranks {}", names.join(", ")),
    }
}
