//! Files on a thread of their own: who writes goes on, and the disk follows in the same order.
//!
//! ```text
//!   write_atomic, append, sync ──▶ queue ──▶ thread ──▶ the disk
//!                                              └── a fault: the rest of the queue is dropped
//!   the next call, whichever ◀──────────────── and reports the fault
//! ```
//!
//! A fault is reported late, but nothing that was asked for after it reaches the disk before it is reported: at any instant the
//! disk is as it would be had each call waited and the program stopped at one of them. Operations that read, and rare ones,
//! wait for the queue; a file that is in it is said to exist.
//!
//! # Limits
//! The call that reports a fault is not the one that met it: what that one said of the state of its file, such as that a
//! row may be tried again, does not hold. Who writes here stops at the first fault.

use super::{Fs, FsError, Lock, Log};
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::SystemTime;

/// Bytes that may be on their way to the disk, unless one call alone has more.
const MOST: usize = 64 << 20;

/// A file system that writes behind its caller's back.
pub struct BehindFs {
    inner: Arc<dyn Fs>,
    /// None where there can be no more threads.
    worker: Option<Arc<Worker>>,
}

/// The thread; it lives as long as somebody may write.
struct Worker {
    queue: Arc<Queue>,
    thread: Option<JoinHandle<()>>,
}

type Act = Box<dyn FnOnce(&dyn Fs) -> Result<(), FsError> + Send>;

/// Something to do.
struct Job {
    /// The file that is there when it is done.
    makes: Option<PathBuf>,
    /// What it holds in memory.
    bytes: usize,
    /// None while it is being done.
    act: Option<Act>,
}

#[derive(Default)]
struct Queue {
    state: Mutex<State>,
    /// There is something to do, or no more.
    work: Condvar,
    /// Something is done.
    done: Condvar,
}

#[derive(Default)]
struct State {
    /// What is not done, the first of it under way.
    jobs: VecDeque<Job>,
    /// What all of them hold.
    bytes: usize,
    is_closed: bool,
    /// A fault, or a panic, that nobody knows of.
    fault: Option<std::thread::Result<FsError>>,
}

impl State {
    /// Tells what has gone wrong, once.
    ///
    /// # Panics
    /// Where a file system has.
    fn told(&mut self) -> Result<(), FsError> {
        match self.fault.take() {
            None => Ok(()),
            Some(Ok(error)) => Err(error),
            Some(Err(panic)) => resume_unwind(panic),
        }
    }
}

impl Queue {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for a signal as long as this holds.
    fn wait(
        &self,
        signal: &Condvar,
        holds: impl FnMut(&mut State) -> bool,
    ) -> MutexGuard<'_, State> {
        let state = signal.wait_while(self.lock(), holds);
        state.unwrap_or_else(PoisonError::into_inner)
    }

    /// Puts a job at the end, when there is room for its bytes.
    fn push(
        &self,
        bytes: usize,
        makes: Option<&Path>,
        act: impl FnOnce() -> Act,
    ) -> Result<(), FsError> {
        let is_full = |state: &mut State| state.bytes > 0 && state.bytes + bytes > MOST;
        let mut state = self.wait(&self.done, is_full);
        state.told()?;
        state.bytes += bytes;
        state.jobs.push_back(Job {
            makes: makes.map(Path::to_path_buf),
            bytes,
            act: Some(act()),
        });
        self.work.notify_one();
        Ok(())
    }

    /// Waits until nothing is left to do.
    fn settle(&self) -> Result<(), FsError> {
        let is_at_work = |state: &mut State| !state.jobs.is_empty();
        self.wait(&self.done, is_at_work).told()
    }

    /// Does what comes, until no more can come.
    fn serve(&self, fs: &dyn Fs) {
        loop {
            let has_none = |state: &mut State| state.jobs.is_empty() && !state.is_closed;
            let mut state = self.wait(&self.work, has_none);
            let Some(act) = state.jobs.front_mut().and_then(|job| job.act.take()) else {
                return;
            };
            drop(state);
            let outcome = catch_unwind(AssertUnwindSafe(|| act(fs)));
            let mut state = self.lock();
            state.fault = match outcome {
                Ok(Ok(())) => None,
                Ok(Err(error)) => Some(Ok(error)),
                Err(panic) => Some(Err(panic)),
            };
            if state.fault.is_some() {
                (state.jobs, state.bytes) = Default::default();
            } else if let Some(job) = state.jobs.pop_front() {
                state.bytes -= job.bytes;
            }
            self.done.notify_all();
        }
    }

    /// Whether a file is about to be there; the fault that may be why it is not.
    fn makes(&self, path: &Path) -> Result<bool, FsError> {
        let mut state = self.lock();
        state.told()?;
        let makes = |job: &Job| job.makes.as_deref() == Some(path);
        Ok(state.jobs.iter().any(makes))
    }

    fn close(&self) {
        self.lock().is_closed = true;
        self.work.notify_one();
    }
}

impl Worker {
    fn new(fs: Arc<dyn Fs>) -> Option<Self> {
        let queue = Arc::new(Queue::default());
        let of_thread = Arc::clone(&queue);
        let thread = std::thread::Builder::new().name("files".into());
        let thread = thread.spawn(move || of_thread.serve(fs.as_ref())).ok()?;
        Some(Self {
            queue,
            thread: Some(thread),
        })
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.queue.close();
        if let Some(thread) = self.thread.take() {
            // it catches what panics
            let _ = thread.join();
        }
    }
}

impl BehindFs {
    /// The same files as those of `inner`. Where there can be no more threads, every call waits for the disk.
    #[must_use]
    pub fn new(inner: Arc<dyn Fs>) -> Self {
        let worker = Worker::new(Arc::clone(&inner)).map(Arc::new);
        Self { inner, worker }
    }

    /// The inner files, when all that was asked for is done.
    fn settled(&self) -> Result<&dyn Fs, FsError> {
        if let Some(worker) = &self.worker {
            worker.queue.settle()?;
        }
        Ok(self.inner.as_ref())
    }
}

impl Fs for BehindFs {
    fn read(&self, path: &Path) -> Result<Vec<u8>, FsError> {
        self.settled()?.read(path)
    }

    fn exists(&self, path: &Path) -> Result<bool, FsError> {
        let Some(Worker { queue, .. }) = self.worker.as_deref() else {
            return self.inner.exists(path);
        };
        // a file may come, or be prevented by a fault, between two looks
        Ok(queue.makes(path)? || self.inner.exists(path)? || queue.makes(path)?)
    }

    fn list(&self, folder: &Path) -> Result<Vec<PathBuf>, FsError> {
        self.settled()?.list(folder)
    }

    fn create_dir_all(&self, folder: &Path) -> Result<(), FsError> {
        self.settled()?.create_dir_all(folder)
    }

    fn write(&self, path: &Path, bytes: &[u8]) -> Result<(), FsError> {
        self.settled()?.write(path, bytes)
    }

    fn rename(&self, from: &Path, to: &Path) -> Result<(), FsError> {
        self.settled()?.rename(from, to)
    }

    fn sync_dir(&self, folder: &Path) -> Result<(), FsError> {
        self.settled()?.sync_dir(folder)
    }

    fn remove(&self, path: &Path) -> Result<(), FsError> {
        self.settled()?.remove(path)
    }

    fn open_log(&self, path: &Path, keep: u64) -> Result<Box<dyn Log>, FsError> {
        let log = self.settled()?.open_log(path, keep)?;
        let Some(worker) = &self.worker else {
            return Ok(log);
        };
        Ok(Box::new(BehindLog {
            worker: Arc::clone(worker),
            log: Arc::new(Mutex::new(log)),
        }))
    }

    fn lock(&self, path: &Path) -> Result<Lock, FsError> {
        self.settled()?.lock(path)
    }

    fn is_locked(&self, path: &Path) -> Result<bool, FsError> {
        self.settled()?.is_locked(path)
    }

    fn modified(&self, path: &Path) -> Result<Option<SystemTime>, FsError> {
        self.settled()?.modified(path)
    }

    fn write_atomic(&self, path: &Path, bytes: &[u8]) -> Result<(), FsError> {
        let Some(Worker { queue, .. }) = self.worker.as_deref() else {
            return self.inner.write_atomic(path, bytes);
        };
        queue.push(bytes.len(), Some(path), || {
            let (path, bytes) = (path.to_path_buf(), bytes.to_vec());
            Box::new(move |fs| fs.write_atomic(&path, &bytes))
        })
    }

    fn settle(&self) -> Result<(), FsError> {
        self.settled()?.settle()
    }
}

/// A file that grows behind its writer's back.
struct BehindLog {
    worker: Arc<Worker>,
    log: Arc<Mutex<Box<dyn Log>>>,
}

impl BehindLog {
    fn push(
        &self,
        nbyte: usize,
        bytes: impl FnOnce() -> Vec<u8>,
        act: impl FnOnce(&mut dyn Log, Vec<u8>) -> Result<(), FsError> + Send + 'static,
    ) -> Result<(), FsError> {
        let log = Arc::clone(&self.log);
        self.worker.queue.push(nbyte, None, || {
            let bytes = bytes();
            Box::new(move |_| {
                let mut log = log.lock().unwrap_or_else(PoisonError::into_inner);
                act(log.as_mut(), bytes)
            })
        })
    }
}

impl Log for BehindLog {
    fn append(&mut self, bytes: &[u8]) -> Result<(), FsError> {
        let copy = || bytes.to_vec();
        self.push(bytes.len(), copy, |log, bytes| log.append_owned(bytes))
    }

    fn append_owned(&mut self, bytes: Vec<u8>) -> Result<(), FsError> {
        self.push(bytes.len(), || bytes, |log, bytes| log.append_owned(bytes))
    }

    fn cut(&mut self, keep: u64) -> Result<(), FsError> {
        self.worker.queue.settle()?;
        let mut log = self.log.lock().unwrap_or_else(PoisonError::into_inner);
        log.cut(keep)
    }

    fn sync(&mut self) -> Result<(), FsError> {
        self.push(0, Vec::new, |log, _| log.sync())
    }
}
