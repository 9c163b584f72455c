//! The disk of rank 0 for all ranks.
//!
//! Rank 0 acts; at the meeting that follows, all learn whether that went well and what was read. So a disk that is full, or a file that
//! is torn, is the same fault on every rank, at the same call.

use super::lock_step::{LockStep, NOTHING};
use serde::{Deserialize, Serialize};
use signorini_io::fs::{Action, Fs, FsError, Lock, Log};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// What the disk of rank 0 says, for all ranks: it alone reads and writes there. All ranks make the same calls, in the same order.
/// `make` is the disk, for the ranks that have one.
///
/// # Example
/// ```
/// use signorini::ranks::{LockStep, disk_of_first};
/// use signorini_io::fs::MemoryFs;
/// use std::sync::Arc;
///
/// let alone = Arc::new(LockStep::default());
/// let disk = disk_of_first(&alone, || Arc::new(MemoryFs::default()));
/// disk.write("a.csv".as_ref(), b"time\n")?;
/// assert!(disk.exists("a.csv".as_ref())?);
/// # Ok::<(), signorini_io::fs::FsError>(())
/// ```
#[must_use]
pub fn disk_of_first(ranks: &Arc<LockStep>, make: impl FnOnce() -> Arc<dyn Fs>) -> Arc<dyn Fs> {
    match ranks.is_alone() {
        true => make(),
        false => Arc::new(RanksFs {
            ranks: Arc::clone(ranks),
            disk: (ranks.rank() == 0).then(make),
        }),
    }
}

/// The disk of rank 0.
struct RanksFs {
    ranks: Arc<LockStep>,
    /// On rank 0.
    disk: Option<Arc<dyn Fs>>,
}

impl RanksFs {
    fn ask<T: Message>(
        &self,
        action: Action,
        path: &Path,
        ask: impl FnOnce(&dyn Fs) -> Result<T, FsError>,
    ) -> Result<T, FsError> {
        let own = self.disk.as_deref().map(ask);
        answered(&self.ranks, action, path, own)
    }
}

/// Meets the others about what a file on rank 0 was asked, and its answer.
pub(super) fn answered<T: Message>(
    ranks: &LockStep,
    action: Action,
    path: &Path,
    own: Option<Result<T, FsError>>,
) -> Result<T, FsError> {
    let parted = |why| FsError::new(action, path, io::Error::other(why));
    if let Some(why) = ranks.parted() {
        // rank 0 still writes its ending
        return own.unwrap_or_else(|| Err(parted(why.clone())));
    }
    let said = own.as_ref().map(|own| match own {
        Ok(answer) => (0, answer.to_bytes()),
        Err(error) => (1, Fault::of(error).to_bytes()),
    });
    let numbers = said.as_ref();
    let numbers = numbers.map_or([NOTHING; 2], |(bad, bytes)| [*bad, bytes.len() as u64]);
    let matter = ("file", action.to_string(), path);
    let [bad, length] = ranks.meet(matter, numbers, None).map_err(parted)?;
    let mut bytes = match said {
        Some((_, bytes)) => bytes,
        None => vec![0; usize::try_from(length).unwrap_or(0)],
    };
    ranks.send(&mut bytes).map_err(parted)?;
    match own {
        Some(own) => own,
        None if bad == 0 => Ok(T::from_bytes(bytes)),
        None => Err(Fault::from_bytes(bytes).into_error()),
    }
}

impl Fs for RanksFs {
    fn read(&self, path: &Path) -> Result<Vec<u8>, FsError> {
        self.ask(Action::Read, path, |disk| disk.read(path))
    }

    fn exists(&self, path: &Path) -> Result<bool, FsError> {
        self.ask(Action::Read, path, |disk| disk.exists(path))
    }

    fn list(&self, folder: &Path) -> Result<Vec<PathBuf>, FsError> {
        self.ask(Action::List, folder, |disk| disk.list(folder))
    }

    fn create_dir_all(&self, folder: &Path) -> Result<(), FsError> {
        let create = |disk: &dyn Fs| disk.create_dir_all(folder);
        self.ask(Action::CreateFolder, folder, create)
    }

    fn write(&self, path: &Path, bytes: &[u8]) -> Result<(), FsError> {
        self.ask(Action::Write, path, |disk| disk.write(path, bytes))
    }

    fn rename(&self, from: &Path, to: &Path) -> Result<(), FsError> {
        self.ask(Action::Rename, from, |disk| disk.rename(from, to))
    }

    fn sync_dir(&self, folder: &Path) -> Result<(), FsError> {
        self.ask(Action::Write, folder, |disk| disk.sync_dir(folder))
    }

    fn remove(&self, path: &Path) -> Result<(), FsError> {
        self.ask(Action::Remove, path, |disk| disk.remove(path))
    }

    fn open_log(&self, path: &Path, keep: u64) -> Result<Box<dyn Log>, FsError> {
        let mut inner = None;
        self.ask(Action::Write, path, |disk| {
            inner = Some(disk.open_log(path, keep)?);
            Ok(())
        })?;
        Ok(Box::new(RanksLog {
            ranks: Arc::clone(&self.ranks),
            path: path.to_path_buf(),
            inner,
        }))
    }

    fn lock(&self, path: &Path) -> Result<Lock, FsError> {
        let mut inner = None;
        self.ask(Action::Lock, path, |disk| {
            inner = Some(disk.lock(path)?);
            Ok(())
        })?;
        Ok(inner.unwrap_or_default())
    }

    fn is_locked(&self, path: &Path) -> Result<bool, FsError> {
        self.ask(Action::Lock, path, |disk| disk.is_locked(path))
    }

    fn modified(&self, path: &Path) -> Result<Option<SystemTime>, FsError> {
        self.ask(Action::Read, path, |disk| disk.modified(path))
    }

    fn write_atomic(&self, path: &Path, bytes: &[u8]) -> Result<(), FsError> {
        self.ask(Action::Write, path, |disk| disk.write_atomic(path, bytes))
    }

    fn settle(&self) -> Result<(), FsError> {
        self.ask(Action::Write, Path::new(""), |disk| disk.settle())
    }
}

/// A file of rank 0 that grows.
struct RanksLog {
    ranks: Arc<LockStep>,
    path: PathBuf,
    /// On rank 0.
    inner: Option<Box<dyn Log>>,
}

impl RanksLog {
    fn ask(
        &mut self,
        ask: impl FnOnce(&mut dyn Log) -> Result<(), FsError>,
    ) -> Result<(), FsError> {
        let own = self.inner.as_mut().map(|log| ask(log.as_mut()));
        answered(&self.ranks, Action::Write, &self.path, own)
    }
}

impl Log for RanksLog {
    fn append(&mut self, bytes: &[u8]) -> Result<(), FsError> {
        self.ask(|log| log.append(bytes))
    }

    fn append_owned(&mut self, bytes: Vec<u8>) -> Result<(), FsError> {
        self.ask(|log| log.append_owned(bytes))
    }

    fn cut(&mut self, keep: u64) -> Result<(), FsError> {
        self.ask(|log| log.cut(keep))
    }

    fn sync(&mut self) -> Result<(), FsError> {
        self.ask(|log| log.sync())
    }
}

/// What can be sent.
pub(super) trait Message {
    fn to_bytes(&self) -> Vec<u8>;
    fn from_bytes(bytes: Vec<u8>) -> Self;
}

impl Message for () {
    fn to_bytes(&self) -> Vec<u8> {
        Vec::new()
    }

    fn from_bytes(_: Vec<u8>) -> Self {}
}

impl Message for bool {
    fn to_bytes(&self) -> Vec<u8> {
        vec![u8::from(*self)]
    }

    fn from_bytes(bytes: Vec<u8>) -> Self {
        bytes == [1]
    }
}

impl Message for Vec<u8> {
    fn to_bytes(&self) -> Vec<u8> {
        self.clone()
    }

    fn from_bytes(bytes: Vec<u8>) -> Self {
        bytes
    }
}

impl Message for Vec<PathBuf> {
    fn to_bytes(&self) -> Vec<u8> {
        let names: Vec<_> = self.iter().map(|path| path.to_string_lossy()).collect();
        names.join("\0").into_bytes()
    }

    fn from_bytes(bytes: Vec<u8>) -> Self {
        let names = String::from_utf8_lossy(&bytes);
        let names = names.split('\0').filter(|name| !name.is_empty());
        names.map(PathBuf::from).collect()
    }
}

impl Message for Option<SystemTime> {
    fn to_bytes(&self) -> Vec<u8> {
        let since = self.and_then(|time| time.duration_since(UNIX_EPOCH).ok());
        since.map_or_else(Vec::new, |since| since.as_secs_f64().to_le_bytes().to_vec())
    }

    fn from_bytes(bytes: Vec<u8>) -> Self {
        let seconds = f64::from_le_bytes(bytes.try_into().ok()?);
        Some(UNIX_EPOCH + Duration::try_from_secs_f64(seconds).ok()?)
    }
}

/// A fault of the disk of rank 0, as others learn of it.
#[derive(Debug, Default, Serialize, Deserialize)]
struct Fault {
    kind: Sort,
    action: usize,
    path: PathBuf,
    root: PathBuf,
    sizes: [u64; 2],
    /// The number of the system's error, and its text.
    number: Option<i32>,
    text: String,
}

#[derive(Debug, Default, Serialize, Deserialize)]
enum Sort {
    DiskFull,
    Denied,
    NotFound,
    WrongKind,
    Locked,
    Outside,
    TooShort,
    #[default]
    Other,
}

const ACTIONS: [Action; 7] = [
    Action::Read,
    Action::Write,
    Action::CreateFolder,
    Action::List,
    Action::Rename,
    Action::Remove,
    Action::Lock,
];

impl Fault {
    fn of(error: &FsError) -> Self {
        let of_action = |action: &Action| ACTIONS.iter().position(|one| one == action);
        let plain = Self {
            path: error.path().to_path_buf(),
            text: error.to_string(),
            ..Self::default()
        };
        match error {
            FsError::DiskFull {
                action,
                needed,
                source,
                ..
            } => Self {
                kind: Sort::DiskFull,
                action: of_action(action).unwrap_or(0),
                sizes: [*needed, 0],
                number: source.raw_os_error(),
                text: source.to_string(),
                ..plain
            },
            FsError::Denied { action, source, .. }
            | FsError::NotFound { action, source, .. }
            | FsError::WrongKind { action, source, .. }
            | FsError::Other { action, source, .. } => Self {
                kind: match error {
                    FsError::Denied { .. } => Sort::Denied,
                    FsError::NotFound { .. } => Sort::NotFound,
                    FsError::WrongKind { .. } => Sort::WrongKind,
                    _ => Sort::Other,
                },
                action: of_action(action).unwrap_or(0),
                number: source.raw_os_error(),
                text: source.to_string(),
                ..plain
            },
            FsError::Locked { .. } => Self {
                kind: Sort::Locked,
                ..plain
            },
            FsError::Outside { action, root, .. } => Self {
                kind: Sort::Outside,
                action: of_action(action).unwrap_or(0),
                root: root.clone(),
                ..plain
            },
            FsError::TooShort { have, keep, .. } => Self {
                kind: Sort::TooShort,
                sizes: [*have, *keep],
                ..plain
            },
            _ => plain,
        }
    }

    fn to_bytes(&self) -> Vec<u8> {
        serde_json::to_vec(self).unwrap_or_default()
    }

    fn from_bytes(bytes: Vec<u8>) -> Self {
        serde_json::from_slice(&bytes).unwrap_or_default()
    }

    fn into_error(self) -> FsError {
        let action = ACTIONS.get(self.action).copied().unwrap_or(Action::Read);
        let source = match self.number {
            Some(number) => io::Error::from_raw_os_error(number),
            None => io::Error::other(self.text),
        };
        let (path, [first, second]) = (self.path, self.sizes);
        match self.kind {
            Sort::DiskFull => FsError::DiskFull {
                action,
                path,
                needed: first,
                source,
            },
            Sort::Locked => FsError::Locked { path },
            Sort::Outside => FsError::Outside {
                action,
                path,
                root: self.root,
            },
            Sort::TooShort => FsError::TooShort {
                path,
                have: first,
                keep: second,
            },
            Sort::Denied => FsError::Denied {
                action,
                path,
                source,
            },
            Sort::NotFound => FsError::NotFound {
                action,
                path,
                source,
            },
            Sort::WrongKind => FsError::WrongKind {
                action,
                path,
                source,
            },
            Sort::Other => FsError::Other {
                action,
                path,
                source,
            },
        }
    }
}
