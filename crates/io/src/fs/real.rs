//! The disk itself.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use super::within::permit;
use super::{Action, Fs, FsError, Lock, Log, folder_of, replace};

/// The file system of this machine.
#[derive(Clone, Copy, Debug, Default)]
pub struct RealFs;

impl Fs for RealFs {
    fn read(&self, path: &Path) -> Result<Vec<u8>, FsError> {
        permit(Action::Read, path)?;
        fs::read(path).map_err(|e| FsError::new(Action::Read, path, e))
    }

    fn exists(&self, path: &Path) -> Result<bool, FsError> {
        permit(Action::Read, path)?;
        path.try_exists()
            .map_err(|e| FsError::new(Action::Read, path, e))
    }

    fn list(&self, folder: &Path) -> Result<Vec<PathBuf>, FsError> {
        permit(Action::List, folder)?;
        let paths = || -> io::Result<Vec<PathBuf>> {
            let mut paths = fs::read_dir(folder)?
                .map(|entry| Ok(entry?.path()))
                .collect::<io::Result<Vec<_>>>()?;
            paths.sort();
            Ok(paths)
        };
        paths().map_err(|e| FsError::new(Action::List, folder, e))
    }

    fn create_dir_all(&self, folder: &Path) -> Result<(), FsError> {
        permit(Action::CreateFolder, folder)?;
        let created = || -> io::Result<()> {
            let missing: Vec<&Path> = folder
                .ancestors()
                .take_while(|f| !f.as_os_str().is_empty() && !f.exists())
                .collect();
            fs::create_dir_all(folder)?;
            missing.iter().try_for_each(|f| sync_folder(folder_of(f)))
        };
        created().map_err(|e| FsError::new(Action::CreateFolder, folder, e))
    }

    fn write(&self, path: &Path, bytes: &[u8]) -> Result<(), FsError> {
        permit(Action::Write, path)?;
        let written = || -> io::Result<()> {
            let mut file = File::create(path)?;
            file.write_all(bytes)?;
            file.sync_all()
        };
        written().map_err(|e| FsError::new(Action::Write, path, e))
    }

    fn rename(&self, from: &Path, to: &Path) -> Result<(), FsError> {
        permit(Action::Rename, from)?;
        permit(Action::Rename, to)?;
        fs::rename(from, to).map_err(|e| FsError::new(Action::Rename, from, e))
    }

    fn sync_dir(&self, folder: &Path) -> Result<(), FsError> {
        sync_folder(folder).map_err(|e| FsError::new(Action::Write, folder, e))
    }

    fn remove(&self, path: &Path) -> Result<(), FsError> {
        permit(Action::Remove, path)?;
        fs::remove_file(path).map_err(|e| FsError::new(Action::Remove, path, e))
    }

    fn open_log(&self, path: &Path, keep: u64) -> Result<Box<dyn Log>, FsError> {
        permit(Action::Write, path)?;
        let opened = || -> io::Result<(File, bool)> {
            let new = !path.try_exists()?;
            let file = OpenOptions::new()
                .write(true)
                .create(true)
                .truncate(false)
                .open(path)?;
            Ok((file, new))
        };
        let (file, new) = opened().map_err(|e| FsError::new(Action::Write, path, e))?;
        let mut log = RealLog {
            file,
            path: path.to_path_buf(),
        };
        log.cut(keep)?;
        if new {
            self.sync_dir(folder_of(path))?;
        }
        Ok(Box::new(log))
    }

    fn lock(&self, path: &Path) -> Result<Lock, FsError> {
        permit(Action::Lock, path)?;
        let failed = |e| FsError::new(Action::Lock, path, e);
        let mut file = OpenOptions::new()
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)
            .map_err(failed)?;
        match exclusive(&file) {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(FsError::Locked {
                    path: path.to_path_buf(),
                });
            }
            // Some network disks have no locks; a run there goes on without one.
            Err(TryLockError::Error(e)) if e.kind() == io::ErrorKind::Unsupported => {}
            Err(TryLockError::Error(e)) => return Err(failed(e)),
        }
        file.set_len(0)
            .and_then(|()| writeln!(file, "{}", std::process::id()))
            .map_err(failed)?;
        // the system releases the lock with the last handle; who is killed leaves its number behind
        Ok(Lock::until_dropped(move || {
            let _ = file.set_len(0);
            drop(file);
        }))
    }

    fn is_locked(&self, path: &Path) -> Result<bool, FsError> {
        permit(Action::Read, path)?;
        let file = match File::open(path) {
            Ok(file) => file,
            Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(false),
            Err(e) => return Err(FsError::new(Action::Read, path, e)),
        };
        // shared, so that two who ask at once do not see each other; it ends with the file
        match file.try_lock_shared() {
            Ok(()) => Ok(false),
            Err(TryLockError::WouldBlock) => Ok(true),
            Err(TryLockError::Error(e)) if e.kind() == io::ErrorKind::Unsupported => Ok(false),
            Err(TryLockError::Error(e)) => Err(FsError::new(Action::Lock, path, e)),
        }
    }

    fn modified(&self, path: &Path) -> Result<Option<SystemTime>, FsError> {
        permit(Action::Read, path)?;
        let metadata = fs::metadata(path).map_err(|e| FsError::new(Action::Read, path, e))?;
        Ok(metadata.modified().ok())
    }

    fn write_atomic(&self, path: &Path, bytes: &[u8]) -> Result<(), FsError> {
        replace(self, path, bytes)
    }

    fn settle(&self) -> Result<(), FsError> {
        Ok(())
    }
}

/// How often a lock is tried, and the pause between: [`Fs::is_locked`] holds it for microseconds.
const TRIES: usize = 5;
const PAUSE: Duration = Duration::from_millis(10);

/// Locks a file for this process alone.
fn exclusive(file: &File) -> Result<(), TryLockError> {
    for _ in 1..TRIES {
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => std::thread::sleep(PAUSE),
            done => return done,
        }
    }
    file.try_lock()
}

/// A growing file on the disk, positioned at its end.
struct RealLog {
    file: File,
    path: PathBuf,
}

impl Log for RealLog {
    fn append(&mut self, bytes: &[u8]) -> Result<(), FsError> {
        self.file
            .write_all(bytes)
            .map_err(|e| FsError::new(Action::Write, &self.path, e))
    }

    fn cut(&mut self, keep: u64) -> Result<(), FsError> {
        let failed = |e| FsError::new(Action::Write, &self.path, e);
        let have = self.file.metadata().map_err(failed)?.len();
        if have < keep {
            return Err(FsError::TooShort {
                path: self.path.clone(),
                have,
                keep,
            });
        }
        self.file
            .set_len(keep)
            .and_then(|()| self.file.seek(SeekFrom::Start(keep)))
            .map_err(failed)?;
        Ok(())
    }

    fn sync(&mut self) -> Result<(), FsError> {
        self.file
            .sync_data()
            .map_err(|e| FsError::new(Action::Write, &self.path, e))
    }

    fn append_owned(&mut self, bytes: Vec<u8>) -> Result<(), FsError> {
        self.append(&bytes)
    }
}

/// Makes the names in a folder durable where the system can.
#[cfg(unix)]
fn sync_folder(folder: &Path) -> io::Result<()> {
    match File::open(folder)?.sync_all() {
        // Some network disks cannot synchronize folders.
        Err(e)
            if matches!(
                e.kind(),
                io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported
            ) =>
        {
            Ok(())
        }
        synced => synced,
    }
}

/// Makes the names in a folder durable where the system can.
#[cfg(not(unix))]
fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}
