//! What can go wrong with the files of a run, as messages.

use crate::ranks::Parted;
use signorini_io::checkpoint::{ArchiveError, CheckpointError};
use signorini_io::diagnostic::{Diagnostic, codes};
use signorini_io::fs::FsError;
use signorini_io::writers::RowsError;
use signorini_io::writers::frd::FrdError;
use signorini_io::writers::pvd::PvdError;
use signorini_io::writers::vtu::VtuError;

/// Why the results of a run could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The disk failed.
    #[error(transparent)]
    Fs(#[from] FsError),
    /// A growing file.
    #[error(transparent)]
    Rows(#[from] RowsError),
    /// A list of frames.
    #[error(transparent)]
    Pvd(#[from] PvdError),
    /// A frame.
    #[error(transparent)]
    Vtu(#[from] VtuError),
    /// A file of all frames.
    #[error(transparent)]
    Frd(#[from] FrdError),
    /// A checkpoint that cannot be put together.
    #[error(transparent)]
    Archive(#[from] ArchiveError),
    /// Other processes of the run.
    #[error(transparent)]
    Parted(#[from] Parted),
}

impl OutputError {
    /// The fault of the disk, where it is one.
    pub(super) fn fs(&self) -> Option<&FsError> {
        match self {
            Self::Fs(error)
            | Self::Rows(RowsError::Fs(error))
            | Self::Pvd(PvdError::Fs(error))
            | Self::Frd(FrdError::Fs(error))
            | Self::Vtu(VtuError::Fs(error)) => Some(error),
            _ => None,
        }
    }

    /// The message to the user; exit code 6.
    #[must_use]
    pub fn diagnostic(&self) -> Diagnostic {
        if let Self::Parted(parted) = self {
            return parted.diagnostic();
        }
        let one = Diagnostic::error(&codes::NOT_WRITTEN, self.to_string());
        match self.fs() {
            Some(error) => one.help(error.help()),
            None => one.help("start again with --fresh"),
        }
    }
}

/// The message for a run that cannot go on from its checkpoints; exit code 7.
#[must_use]
pub fn cannot_resume(why: impl std::fmt::Display) -> Diagnostic {
    let text = why.to_string();
    // what an error says to do goes where help stands
    match text.split_once("; ") {
        Some((what, help)) => Diagnostic::error(&codes::CANNOT_RESUME, what).help(help),
        None => Diagnostic::error(&codes::CANNOT_RESUME, text),
    }
}

/// The message for a checkpoint that is of no use; exit code 7.
#[must_use]
pub fn bad_checkpoint(error: &CheckpointError) -> Diagnostic {
    cannot_resume(error)
}
