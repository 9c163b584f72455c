//! Files in memory, for runs that leave nothing on the disk.

use super::{Action, Fs, FsError, Lock, Log};
use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

/// Files that live as long as this value and its clones, which share them.
///
/// # Example
/// ```
/// use signorini_io::fs::{Fs, MemoryFs};
/// use std::path::Path;
///
/// let fs = MemoryFs::default();
/// fs.write(Path::new("a/history.csv"), b"time\n")?;
/// assert_eq!(fs.read(Path::new("a/history.csv"))?, b"time\n");
/// assert!(fs.read(Path::new("a/other.csv")).is_err());
/// # Ok::<(), signorini_io::fs::FsError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct MemoryFs {
    content: Arc<Mutex<Content>>,
}

#[derive(Debug, Default)]
struct Content {
    files: BTreeMap<PathBuf, Vec<u8>>,
    locked: BTreeSet<PathBuf>,
}

impl MemoryFs {
    fn content(&self) -> MutexGuard<'_, Content> {
        // every change is whole: nothing is torn by a thread that panics
        self.content.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn missing(action: Action, path: &Path) -> FsError {
    FsError::new(action, path, io::ErrorKind::NotFound.into())
}

impl Fs for MemoryFs {
    fn read(&self, path: &Path) -> Result<Vec<u8>, FsError> {
        let content = self.content();
        let bytes = content.files.get(path).cloned();
        bytes.ok_or_else(|| missing(Action::Read, path))
    }

    fn exists(&self, path: &Path) -> Result<bool, FsError> {
        Ok(self.content().files.contains_key(path))
    }

    fn list(&self, folder: &Path) -> Result<Vec<PathBuf>, FsError> {
        let content = self.content();
        let below = content.files.keys().filter_map(|path| {
            let first = path.strip_prefix(folder).ok()?.components().next()?;
            Some(folder.join(first))
        });
        let distinct: BTreeSet<PathBuf> = below.collect();
        Ok(distinct.into_iter().collect())
    }

    fn create_dir_all(&self, _: &Path) -> Result<(), FsError> {
        Ok(())
    }

    fn write(&self, path: &Path, bytes: &[u8]) -> Result<(), FsError> {
        let bytes = bytes.to_vec();
        self.content().files.insert(path.to_path_buf(), bytes);
        Ok(())
    }

    fn rename(&self, from: &Path, to: &Path) -> Result<(), FsError> {
        let mut content = self.content();
        let bytes = content.files.remove(from);
        let bytes = bytes.ok_or_else(|| missing(Action::Rename, from))?;
        content.files.insert(to.to_path_buf(), bytes);
        Ok(())
    }

    fn sync_dir(&self, _: &Path) -> Result<(), FsError> {
        Ok(())
    }

    fn remove(&self, path: &Path) -> Result<(), FsError> {
        let removed = self.content().files.remove(path);
        removed.map_or_else(|| Err(missing(Action::Remove, path)), |_| Ok(()))
    }

    fn open_log(&self, path: &Path, keep: u64) -> Result<Box<dyn Log>, FsError> {
        self.content().files.entry(path.to_path_buf()).or_default();
        let mut log = MemoryLog {
            fs: self.clone(),
            path: path.to_path_buf(),
        };
        log.cut(keep)?;
        Ok(Box::new(log))
    }

    fn lock(&self, path: &Path) -> Result<Lock, FsError> {
        let path = path.to_path_buf();
        if !self.content().locked.insert(path.clone()) {
            return Err(FsError::Locked { path });
        }
        let fs = self.clone();
        Ok(Lock::until_dropped(move || {
            fs.content().locked.remove(&path);
        }))
    }

    fn is_locked(&self, path: &Path) -> Result<bool, FsError> {
        Ok(self.content().locked.contains(path))
    }

    fn modified(&self, path: &Path) -> Result<Option<SystemTime>, FsError> {
        let content = self.content();
        let file = content.files.get(path).map(|_| None);
        file.ok_or_else(|| missing(Action::Read, path))
    }

    fn write_atomic(&self, path: &Path, bytes: &[u8]) -> Result<(), FsError> {
        self.write(path, bytes)
    }

    fn settle(&self) -> Result<(), FsError> {
        Ok(())
    }
}

/// A growing file in memory.
struct MemoryLog {
    fs: MemoryFs,
    path: PathBuf,
}

impl Log for MemoryLog {
    fn append(&mut self, bytes: &[u8]) -> Result<(), FsError> {
        let mut content = self.fs.content();
        let file = content.files.get_mut(&self.path);
        let file = file.ok_or_else(|| missing(Action::Write, &self.path))?;
        file.extend_from_slice(bytes);
        Ok(())
    }

    fn append_owned(&mut self, bytes: Vec<u8>) -> Result<(), FsError> {
        self.append(&bytes)
    }

    fn cut(&mut self, keep: u64) -> Result<(), FsError> {
        let mut content = self.fs.content();
        let file = content.files.get_mut(&self.path);
        let file = file.ok_or_else(|| missing(Action::Write, &self.path))?;
        let have = file.len() as u64;
        if have < keep {
            return Err(FsError::TooShort {
                path: self.path.clone(),
                have,
                keep,
            });
        }
        file.truncate(usize::try_from(keep).unwrap_or(usize::MAX));
        Ok(())
    }

    fn sync(&mut self) -> Result<(), FsError> {
        Ok(())
    }
}
