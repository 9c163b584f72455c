//! Disks that fail on purpose, for tests of the state after a fault.
//!
//! Both wrap another [`Fs`] and count its write-like operations: `create_dir_all`, `write`, `rename`, `sync_dir`,
//! `remove`, `open_log`, `lock`, and a log's `append`, `cut` and `sync`. Run once with [`FailingFs::counting`] to learn how many there are,
//! then once for every n.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::SystemTime;

use super::{Action, Fs, FsError, Lock, Log, replace};

/// What a wrapped operation is to do.
enum Verdict {
    /// Do it.
    Go,
    /// Do nothing of it, or write only this many of its bytes, and report this error.
    Fail(io::Error, usize),
    /// Write only this many bytes and claim success.
    Pretend(usize),
}

/// Decides what fails.
trait Plan: Send + Sync + 'static {
    /// Asked once per write-like operation; `size` is the number of bytes to be written, 0 where it writes none.
    fn judge(&self, size: usize) -> Verdict;
}

/// A disk whose n-th write-like operation fails, as on a full disk: half of the bytes get there.
pub type FailingFs<F> = Faulty<F, Failing>;

/// A disk that loses power in its n-th write: a prefix gets there, and later operations fail.
pub type TornFs<F> = Faulty<F, Torn>;

/// A file system with a plan for its faults: [`FailingFs`] or [`TornFs`].
#[derive(Debug)]
pub struct Faulty<F, P> {
    inner: F,
    plan: Arc<P>,
}

/// The plan of [`FailingFs`].
#[derive(Debug)]
pub struct Failing {
    /// Operations asked for so far.
    count: AtomicU64,
    /// The first one that fails, counted from 1.
    first: u64,
    /// The last one that fails.
    last: u64,
    kind: io::ErrorKind,
}

impl<F: Fs> FailingFs<F> {
    /// Only the `n`-th operation fails, counted from 1.
    pub fn nth(inner: F, n: u64, kind: io::ErrorKind) -> Self {
        Self::between(inner, n, n, kind)
    }

    /// The `n`-th operation and all later ones fail.
    pub fn from_nth(inner: F, n: u64, kind: io::ErrorKind) -> Self {
        Self::between(inner, n, u64::MAX, kind)
    }

    /// Nothing fails; operations are only counted.
    pub fn counting(inner: F) -> Self {
        Self::between(inner, u64::MAX, u64::MAX, io::ErrorKind::Other)
    }

    fn between(inner: F, first: u64, last: u64, kind: io::ErrorKind) -> Self {
        Self {
            inner,
            plan: Arc::new(Failing {
                count: AtomicU64::new(0),
                first,
                last,
                kind,
            }),
        }
    }

    /// The number of write-like operations asked for so far.
    pub fn count(&self) -> u64 {
        self.plan.count.load(Ordering::SeqCst)
    }
}

impl Plan for Failing {
    fn judge(&self, size: usize) -> Verdict {
        let n = self.count.fetch_add(1, Ordering::SeqCst) + 1;
        if (self.first..=self.last).contains(&n) {
            Verdict::Fail(self.kind.into(), size / 2)
        } else {
            Verdict::Go
        }
    }
}

/// The plan of [`TornFs`].
#[derive(Debug)]
pub struct Torn {
    /// Writes with bytes asked for so far.
    writes: AtomicU64,
    /// The write that is torn, counted from 1.
    nth: u64,
    /// How many bytes of it reach the disk.
    keep: usize,
    /// Operations after the torn write that still reach the disk.
    survivors: u64,
    /// Operations after the torn write so far.
    later: AtomicU64,
}

impl<F: Fs> TornFs<F> {
    /// The `n`-th write (counted from 1; only those that carry bytes count) keeps its first `keep` bytes; it and all
    /// later operations fail.
    pub fn nth(inner: F, n: u64, keep: usize) -> Self {
        Self::lying(inner, n, keep, 0)
    }

    /// As [`TornFs::nth`], but the disk claims that the write succeeded, and `survivors` later operations (a rename,
    /// say) still reach it.
    pub fn lying(inner: F, n: u64, keep: usize, survivors: u64) -> Self {
        let plan = Torn {
            writes: AtomicU64::new(0),
            nth: n,
            keep,
            survivors,
            later: AtomicU64::new(0),
        };
        Self {
            inner,
            plan: Arc::new(plan),
        }
    }

    /// The number of writes that carried bytes so far.
    pub fn count(&self) -> u64 {
        self.plan.writes.load(Ordering::SeqCst)
    }
}

impl Plan for Torn {
    fn judge(&self, size: usize) -> Verdict {
        let cut = || io::Error::other("power cut");
        let before = self.writes.load(Ordering::SeqCst);
        if before >= self.nth {
            let later = self.later.fetch_add(1, Ordering::SeqCst) + 1;
            return if later <= self.survivors {
                Verdict::Go
            } else {
                Verdict::Fail(cut(), 0)
            };
        }
        if size == 0 || self.writes.fetch_add(1, Ordering::SeqCst) + 1 < self.nth {
            return Verdict::Go;
        }
        let keep = self.keep.min(size);
        if self.survivors > 0 {
            Verdict::Pretend(keep)
        } else {
            Verdict::Fail(cut(), keep)
        }
    }
}

/// Runs an operation that carries no bytes, if the plan lets it.
fn judged_act<T>(
    plan: &impl Plan,
    action: Action,
    path: &Path,
    act: impl FnOnce() -> Result<T, FsError>,
) -> Result<T, FsError> {
    match plan.judge(0) {
        Verdict::Fail(error, _) => Err(FsError::new(action, path, error)),
        Verdict::Go | Verdict::Pretend(_) => act(),
    }
}

impl<F: Fs, P: Plan> Fs for Faulty<F, P> {
    fn read(&self, path: &Path) -> Result<Vec<u8>, FsError> {
        self.inner.read(path)
    }

    fn exists(&self, path: &Path) -> Result<bool, FsError> {
        self.inner.exists(path)
    }

    fn list(&self, folder: &Path) -> Result<Vec<PathBuf>, FsError> {
        self.inner.list(folder)
    }

    fn create_dir_all(&self, folder: &Path) -> Result<(), FsError> {
        judged_act(&*self.plan, Action::CreateFolder, folder, || {
            self.inner.create_dir_all(folder)
        })
    }

    fn write(&self, path: &Path, bytes: &[u8]) -> Result<(), FsError> {
        judged(self.plan.judge(bytes.len()), path, bytes, |bytes| {
            self.inner.write(path, bytes)
        })
    }

    fn rename(&self, from: &Path, to: &Path) -> Result<(), FsError> {
        judged_act(&*self.plan, Action::Rename, from, || {
            self.inner.rename(from, to)
        })
    }

    fn sync_dir(&self, folder: &Path) -> Result<(), FsError> {
        judged_act(&*self.plan, Action::Write, folder, || {
            self.inner.sync_dir(folder)
        })
    }

    fn remove(&self, path: &Path) -> Result<(), FsError> {
        judged_act(&*self.plan, Action::Remove, path, || {
            self.inner.remove(path)
        })
    }

    fn open_log(&self, path: &Path, keep: u64) -> Result<Box<dyn Log>, FsError> {
        let inner = judged_act(&*self.plan, Action::Write, path, || {
            self.inner.open_log(path, keep)
        })?;
        Ok(Box::new(FaultyLog {
            inner,
            path: path.to_path_buf(),
            plan: Arc::clone(&self.plan),
        }))
    }

    fn lock(&self, path: &Path) -> Result<Lock, FsError> {
        judged_act(&*self.plan, Action::Lock, path, || self.inner.lock(path))
    }

    fn is_locked(&self, path: &Path) -> Result<bool, FsError> {
        self.inner.is_locked(path)
    }

    fn modified(&self, path: &Path) -> Result<Option<SystemTime>, FsError> {
        self.inner.modified(path)
    }

    fn write_atomic(&self, path: &Path, bytes: &[u8]) -> Result<(), FsError> {
        replace(self, path, bytes)
    }

    fn settle(&self) -> Result<(), FsError> {
        self.inner.settle()
    }
}

/// A log on a faulty disk.
struct FaultyLog<P> {
    inner: Box<dyn Log>,
    path: PathBuf,
    plan: Arc<P>,
}

impl<P: Plan> Log for FaultyLog<P> {
    fn append(&mut self, bytes: &[u8]) -> Result<(), FsError> {
        judged(self.plan.judge(bytes.len()), &self.path, bytes, |bytes| {
            self.inner.append(bytes)
        })
    }

    fn cut(&mut self, keep: u64) -> Result<(), FsError> {
        judged(self.plan.judge(0), &self.path, &[], |_| {
            self.inner.cut(keep)
        })
    }

    fn sync(&mut self) -> Result<(), FsError> {
        judged(self.plan.judge(0), &self.path, &[], |_| self.inner.sync())
    }

    fn append_owned(&mut self, bytes: Vec<u8>) -> Result<(), FsError> {
        self.append(&bytes)
    }
}

/// Writes as much as the verdict lets through.
fn judged(
    verdict: Verdict,
    path: &Path,
    bytes: &[u8],
    write: impl FnOnce(&[u8]) -> Result<(), FsError>,
) -> Result<(), FsError> {
    let prefix = |keep: usize| bytes.get(..keep).unwrap_or(bytes);
    match verdict {
        Verdict::Go => write(bytes),
        Verdict::Pretend(keep) => write(prefix(keep)),
        Verdict::Fail(error, keep) => {
            if keep > 0 {
                write(prefix(keep))?;
            }
            Err(FsError::new(Action::Write, path, error))
        }
    }
}
