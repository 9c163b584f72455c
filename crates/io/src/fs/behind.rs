//! Files on a thread of their own: who writes goes on, and the disk follows in the same order.
//!
//! ```text
//!   write_atomic, append, sync ──▶ queue ──▶ thread ──▶ the disk
//!                                              └── a fault: what is queued behind it is dropped
//!   the next call, whichever ◀──────────────── and is told of the fault
//! ```
//!
//! A fault is told late, but nothing that was asked for after it reaches the disk before it is told: at any instant the
//! disk is as it would be had each call waited and the program stopped at one of them. What reads, and what is rare,
//! waits for the queue; a file that is in it is said to exist.
//!
//! # Limits
//! The call that is told of a fault is not the one that met it: what that one said of the state of its file, such as that a
//! row may be tried again, does not hold. Who writes here stops at the first fault.

use super::{Fs, FsError, Lock, Log};
use std::any::Any;
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

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
    act: Act,
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
    jobs: VecDeque<Job>,
    /// What all of them hold.
    bytes: usize,
    /// Files that are being made, in the order of their jobs.
    making: VecDeque<PathBuf>,
    is_busy: bool,
    is_closed: bool,
    /// A fault that nobody knows of.
    error: Option<FsError>,
    /// A panic that nobody knows of.
    panic: Option<Box<dyn Any + Send>>,
}

impl State {
    /// Tells what has gone wrong, once.
    ///
    /// # Panics
    /// Where a file system has.
    fn told(&mut self) -> Result<(), FsError> {
        if let Some(panic) = self.panic.take() {
            resume_unwind(panic);
        }
        self.error.take().map_or(Ok(()), Err)
    }
}

impl Queue {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Puts a job at the end, when there is room for its bytes.
    fn push(&self, bytes: usize, job: impl FnOnce() -> Job) -> Result<(), FsError> {
        let is_full = |state: &mut State| state.bytes > 0 && state.bytes + bytes > MOST;
        let state = self.done.wait_while(self.lock(), is_full);
        let mut state = state.unwrap_or_else(PoisonError::into_inner);
        state.told()?;
        let job = job();
        state.bytes += job.bytes;
        state.making.extend(job.makes.clone());
        state.jobs.push_back(job);
        self.work.notify_one();
        Ok(())
    }

    /// Waits until nothing is left to do.
    fn settle(&self) -> Result<(), FsError> {
        let is_at_work = |state: &mut State| state.is_busy || !state.jobs.is_empty();
        let state = self.done.wait_while(self.lock(), is_at_work);
        let mut state = state.unwrap_or_else(PoisonError::into_inner);
        state.told()
    }

    /// Does what comes, until no more can come.
    fn serve(&self, fs: &dyn Fs) {
        loop {
            let has_none = |state: &mut State| state.jobs.is_empty() && !state.is_closed;
            let state = self.work.wait_while(self.lock(), has_none);
            let mut state = state.unwrap_or_else(PoisonError::into_inner);
            let Some(job) = state.jobs.pop_front() else {
                return;
            };
            state.is_busy = true;
            drop(state);
            let outcome = catch_unwind(AssertUnwindSafe(|| (job.act)(fs)));
            let mut state = self.lock();
            state.is_busy = false;
            state.bytes -= job.bytes;
            if job.makes.is_some() {
                state.making.pop_front();
            }
            if !matches!(outcome, Ok(Ok(()))) {
                (state.jobs, state.making, state.bytes) = Default::default();
            }
            match outcome {
                Ok(Ok(())) => {}
                Ok(Err(error)) => state.error = Some(error),
                Err(panic) => state.panic = Some(panic),
            }
            self.done.notify_all();
        }
    }

    /// Whether a file is about to be there; the fault that may be why it is not.
    fn makes(&self, path: &Path) -> Result<bool, FsError> {
        let mut state = self.lock();
        state.told()?;
        Ok(state.making.iter().any(|made| made == path))
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

    fn write_atomic(&self, path: &Path, bytes: &[u8]) -> Result<(), FsError> {
        let Some(Worker { queue, .. }) = self.worker.as_deref() else {
            return self.inner.write_atomic(path, bytes);
        };
        queue.push(bytes.len(), || {
            let (file, bytes) = (path.to_path_buf(), bytes.to_vec());
            Job {
                makes: Some(path.to_path_buf()),
                bytes: bytes.len(),
                act: Box::new(move |fs| fs.write_atomic(&file, &bytes)),
            }
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
        bytes: &[u8],
        act: impl FnOnce(&mut dyn Log, &[u8]) -> Result<(), FsError> + Send + 'static,
    ) -> Result<(), FsError> {
        let log = Arc::clone(&self.log);
        self.worker.queue.push(bytes.len(), || {
            let bytes = bytes.to_vec();
            Job {
                makes: None,
                bytes: bytes.len(),
                act: Box::new(move |_| {
                    let mut log = log.lock().unwrap_or_else(PoisonError::into_inner);
                    act(log.as_mut(), &bytes)
                }),
            }
        })
    }
}

impl Log for BehindLog {
    fn append(&mut self, bytes: &[u8]) -> Result<(), FsError> {
        self.push(bytes, |log, bytes| log.append(bytes))
    }

    fn cut(&mut self, keep: u64) -> Result<(), FsError> {
        self.worker.queue.settle()?;
        let mut log = self.log.lock().unwrap_or_else(PoisonError::into_inner);
        log.cut(keep)
    }

    fn sync(&mut self) -> Result<(), FsError> {
        self.push(&[], |log, _| log.sync())
    }
}
