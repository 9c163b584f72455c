//! What can go wrong with a file, and what to do about it.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// What was tried when a file operation failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Reading a file.
    Read,
    /// Writing a file or a row of it.
    Write,
    /// Creating a folder.
    CreateFolder,
    /// Listing a folder.
    List,
    /// Giving a file its final name.
    Rename,
    /// Removing a file.
    Remove,
    /// Taking a lock.
    Lock,
}

impl fmt::Display for Action {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Action::Read => "reading",
            Action::Write => "writing",
            Action::CreateFolder => "creating the folder",
            Action::List => "listing",
            Action::Rename => "renaming",
            Action::Remove => "removing",
            Action::Lock => "locking",
        })
    }
}

/// A file operation that failed: what, where and why; [`FsError::help`] says what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FsError {
    /// The disk or the quota is full.
    #[error("disk full while {action} {}{}", path.display(), needs(*needed))]
    DiskFull {
        /// What was tried.
        action: Action,
        /// The file.
        path: PathBuf,
        /// Bytes that were to be written, 0 where unknown.
        needed: u64,
        /// The system's error.
        source: io::Error,
    },
    /// The user may not do this, or the disk is mounted read-only.
    #[error("no permission for {action} {}", path.display())]
    Denied {
        /// What was tried.
        action: Action,
        /// The file or folder.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The file, or the folder it belongs to, is not there.
    #[error("{} does not exist ({action} it failed)", path.display())]
    NotFound {
        /// What was tried.
        action: Action,
        /// The file or folder.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// A file stands where a folder is needed, or a folder where a file is needed.
    #[error("{} or a folder above it is not what it has to be, a file or a folder ({action} it failed)", path.display())]
    WrongKind {
        /// What was tried.
        action: Action,
        /// The file or folder.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// Another run writes into the same output folder.
    #[error("{} is held by another run", path.display())]
    Locked {
        /// The lock file.
        path: PathBuf,
    },
    /// The process is confined to a folder, and the path leads out of it.
    #[error("{} is outside of {}, the only folder that may be used ({action} it was refused)", path.display(), root.display())]
    Outside {
        /// What was tried.
        action: Action,
        /// The file or folder, as it was named.
        path: PathBuf,
        /// The folder that may be used.
        root: PathBuf,
    },
    /// A growing file is shorter than the part to be kept.
    #[error("{} has {have} bytes where {keep} were to be kept", path.display())]
    TooShort {
        /// The file.
        path: PathBuf,
        /// Its length in bytes.
        have: u64,
        /// The length asked for, in bytes.
        keep: u64,
    },
    /// Any other error of the system.
    #[error("{action} {} failed: {source}", path.display())]
    Other {
        /// What was tried.
        action: Action,
        /// The file or folder.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
}

impl FsError {
    /// The exit code of a program that ends because of this error.
    pub const EXIT_CODE: u8 = 6;

    /// Sorts an error of the system into the case that the user can act on.
    pub fn new(action: Action, path: &Path, source: io::Error) -> Self {
        use io::ErrorKind as Kind;
        let path = path.to_path_buf();
        match source.kind() {
            Kind::StorageFull | Kind::QuotaExceeded => Self::DiskFull {
                action,
                path,
                needed: 0,
                source,
            },
            Kind::PermissionDenied | Kind::ReadOnlyFilesystem => Self::Denied {
                action,
                path,
                source,
            },
            Kind::NotFound => Self::NotFound {
                action,
                path,
                source,
            },
            Kind::IsADirectory | Kind::NotADirectory | Kind::AlreadyExists => Self::WrongKind {
                action,
                path,
                source,
            },
            _ => Self::Other {
                action,
                path,
                source,
            },
        }
    }

    /// The file or folder concerned.
    pub fn path(&self) -> &Path {
        match self {
            Self::DiskFull { path, .. }
            | Self::Denied { path, .. }
            | Self::NotFound { path, .. }
            | Self::WrongKind { path, .. }
            | Self::Locked { path }
            | Self::Outside { path, .. }
            | Self::TooShort { path, .. }
            | Self::Other { path, .. } => path,
        }
    }

    /// One thing to do about it.
    pub fn help(&self) -> String {
        match self {
            Self::DiskFull { .. } => "free space on that disk, or write elsewhere with -o DIR; then resume the run".into(),
            Self::Denied { .. } => "make the folder writable for this user, or write elsewhere with -o DIR".into(),
            Self::NotFound { action: Action::Read | Action::List, .. } => "check the path".into(),
            Self::NotFound { .. } => {
                "the folder is gone: was it removed or unmounted while the run went on? resume once it is back".into()
            }
            Self::WrongKind { .. } => "move it away, or write elsewhere with -o DIR".into(),
            Self::Locked { .. } => "wait for the other run, stop it, or write elsewhere with -o DIR".into(),
            Self::Outside { .. } => "use a path in that folder, without links that lead out of it".into(),
            Self::TooShort { .. } => "the file was changed since the checkpoint: start again with --fresh".into(),
            Self::Other { .. } => "check the disk, or write elsewhere with -o DIR".into(),
        }
    }

    /// The same fault, reported for the file that the user knows instead of its draft.
    pub(super) fn while_writing(self, file: &Path, size: usize) -> Self {
        let mut error = self;
        match &mut error {
            Self::DiskFull {
                action,
                path,
                needed,
                ..
            } => {
                *action = Action::Write;
                *path = file.to_path_buf();
                *needed = size as u64;
            }
            Self::Denied { action, path, .. }
            | Self::NotFound { action, path, .. }
            | Self::WrongKind { action, path, .. }
            | Self::Other { action, path, .. } => {
                *action = Action::Write;
                *path = file.to_path_buf();
            }
            Self::Locked { .. } | Self::Outside { .. } | Self::TooShort { .. } => {}
        }
        error
    }
}

/// ` (needs 1.2 MB)`, or nothing where the size is unknown.
fn needs(bytes: u64) -> String {
    match bytes {
        0 => String::new(),
        1..1_000 => format!(" (needs {bytes} B)"),
        1_000..1_000_000 => format!(" (needs {:.1} kB)", bytes as f64 / 1e3),
        1_000_000..1_000_000_000 => format!(" (needs {:.1} MB)", bytes as f64 / 1e6),
        _ => format!(" (needs {:.1} GB)", bytes as f64 / 1e9),
    }
}
