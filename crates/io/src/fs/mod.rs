//! The one door to the disk: every file is written, and read back, through [`Fs`].
//!
//! ```text
//!             writers, checkpoint
//!                     │
//!                  dyn Fs ────────────── write_atomic
//!        ┌────────────┼────────────┐       1 write  FILE.tmp, fsync
//!     RealFs      FailingFs      TornFs    2 rename FILE.tmp -> FILE
//!     the disk    n-th fails     power     3 fsync  the folder
//!                                cut
//! ```
//!
//! [`MemoryFs`] keeps files in memory, for runs that leave none behind.
//! [`BehindFs`] lets any of them work on a thread of its own. [`confine`] restricts [`RealFs`] to one folder.
//!
//! At any instant a file written by [`Fs::write_atomic`] is either the old one or the new one, whole. Files that grow
//! (tables, logs, frames) are a [`Log`]: one write per row, so that at most the last row can be torn.
//!
//! Limits: on systems whose folders cannot be synchronized (Windows) step 3 does nothing.
//!
//! One more: implement [`Fs`] in a file of its own; its methods are the single steps in which a disk can fail, and
//! [`Fs::write_atomic`], which `replace` makes of them.

mod behind;
pub(crate) mod bytes;
mod error;
mod faulty;
mod memory;
mod real;
mod within;

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

pub use behind::BehindFs;
pub use error::{Action, FsError};
pub use faulty::{Failing, FailingFs, Faulty, Torn, TornFs};
pub use memory::MemoryFs;
pub use real::RealFs;
pub use within::{confine, permit, read};

/// A file system, as the program needs one.
///
/// # Errors
/// Every method reports what it tried, on which path, and why that failed, as [`FsError`].
pub trait Fs: Send + Sync {
    /// Reads a whole file.
    fn read(&self, path: &Path) -> Result<Vec<u8>, FsError>;

    /// Says whether something exists at `path`; an error where that cannot be known.
    fn exists(&self, path: &Path) -> Result<bool, FsError>;

    /// Lists what a folder holds, sorted by name; the paths start with `folder`.
    fn list(&self, folder: &Path) -> Result<Vec<PathBuf>, FsError>;

    /// Creates a folder and those above it; an existing one is left as it is.
    fn create_dir_all(&self, folder: &Path) -> Result<(), FsError>;

    /// Creates or replaces a file and synchronizes it; a fault leaves a torn file. Use [`Fs::write_atomic`] instead.
    fn write(&self, path: &Path, bytes: &[u8]) -> Result<(), FsError>;

    /// Renames a file, replacing `to` at once.
    fn rename(&self, from: &Path, to: &Path) -> Result<(), FsError>;

    /// Makes the names in a folder durable.
    fn sync_dir(&self, folder: &Path) -> Result<(), FsError>;

    /// Removes a file.
    fn remove(&self, path: &Path) -> Result<(), FsError>;

    /// Opens a file that grows, creates it where it is missing, and cuts it back to its first `keep` bytes.
    fn open_log(&self, path: &Path, keep: u64) -> Result<Box<dyn Log>, FsError>;

    /// Takes the lock file at `path` for as long as the returned [`Lock`] lives, or until the process ends in any way. On a
    /// disk, the file holds the number of the process; it is empty after the lock was released, and not after a kill.
    ///
    /// # Errors
    /// [`FsError::Locked`] while another process holds it.
    fn lock(&self, path: &Path) -> Result<Lock, FsError>;

    /// Whether a process holds the lock file at `path`; no where there is no such file, or where the disk has no locks.
    fn is_locked(&self, path: &Path) -> Result<bool, FsError>;

    /// When a file was written to last; none where the disk does not say.
    ///
    /// # Errors
    /// A file that is missing or cannot be asked.
    fn modified(&self, path: &Path) -> Result<Option<SystemTime>, FsError>;

    /// Replaces a file as a whole: readers see the old content or the new one, also after a power cut.
    ///
    /// After an error the old content is still there, or the new one if only the last step failed.
    fn write_atomic(&self, path: &Path, bytes: &[u8]) -> Result<(), FsError>;

    /// Waits until all that was asked for is done, where it is not done at once.
    ///
    /// # Errors
    /// The first failure that has not been reported.
    fn settle(&self) -> Result<(), FsError>;
}

/// A file that grows by whole rows.
pub trait Log: Send {
    /// Appends `bytes` with a single write and hands them to the system at once.
    ///
    /// # Errors
    /// After an error the end of the file is unknown: [`Log::cut`] it before the next row.
    fn append(&mut self, bytes: &[u8]) -> Result<(), FsError>;

    /// [`Log::append`] of bytes that the caller does not need any longer.
    ///
    /// # Errors
    /// As there.
    fn append_owned(&mut self, bytes: Vec<u8>) -> Result<(), FsError>;

    /// Cuts the file back to its first `keep` bytes.
    fn cut(&mut self, keep: u64) -> Result<(), FsError>;

    /// Makes everything appended so far durable.
    fn sync(&mut self) -> Result<(), FsError>;
}

/// A held lock file; dropping it releases the lock. By default it holds none.
#[derive(Default)]
pub struct Lock {
    release: Option<Box<dyn FnOnce() + Send>>,
}

impl Lock {
    /// A lock that `release` releases.
    fn until_dropped(release: impl FnOnce() + Send + 'static) -> Self {
        let release: Box<dyn FnOnce() + Send> = Box::new(release);
        Self {
            release: Some(release),
        }
    }
}

impl std::fmt::Debug for Lock {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Lock").finish_non_exhaustive()
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        if let Some(release) = self.release.take() {
            release();
        }
    }
}

/// [`Fs::write_atomic`] by the single steps of a file system.
fn replace(fs: &dyn Fs, path: &Path, bytes: &[u8]) -> Result<(), FsError> {
    let draft = draft_of(path);
    let written = fs
        .write(&draft, bytes)
        .and_then(|()| fs.rename(&draft, path));
    if let Err(error) = written {
        // The draft is of no use; where it cannot be removed either, the next write replaces it.
        let _ = fs.remove(&draft);
        return Err(error.while_writing(path, bytes.len()));
    }
    fs.sync_dir(folder_of(path))
        .map_err(|error| error.while_writing(path, bytes.len()))
}

/// The name under which a file is written before it gets its own: `FILE.tmp`, in the same folder.
fn draft_of(path: &Path) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(".tmp");
    PathBuf::from(name)
}

/// The folder that holds `path`.
fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests;
