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

use super::{Fs, FsError, Lock, Log};
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

/// Bytes that may wait for the disk; one call may go beyond.
const MOST: usize = 64 << 20;

/// A file system that writes behind its caller's back.
pub struct BehindFs {
    inner: Arc<dyn Fs>,
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
}

impl Queue {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Puts a job at the end, where there is room.
    fn push(&self, job: Job) -> Result<(), FsError> {
        let is_full = |state: &mut State| !state.jobs.is_empty() && state.bytes + job.bytes > MOST;
        let state = self.done.wait_while(self.lock(), is_full);
        let mut state = state.unwrap_or_else(PoisonError::into_inner);
        if let Some(error) = state.error.take() {
            return Err(error);
        }
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
        state.error.take().map_or(Ok(()), Err)
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
            let outcome = (job.act)(fs);
            let mut state = self.lock();
            state.is_busy = false;
            state.bytes -= job.bytes;
            if job.makes.is_some() {
                state.making.pop_front();
            }
            if let Err(error) = outcome {
                (state.jobs, state.making, state.bytes) = Default::default();
                state.error = Some(error);
            }
            self.done.notify_all();
        }
    }

    /// Whether a file is about to be there; the fault that may be why it is not.
    fn makes(&self, path: &Path) -> Result<bool, FsError> {
        let mut state = self.lock();
        match state.error.take() {
            Some(error) => Err(error),
            None => Ok(state.making.iter().any(|made| made == path)),
        }
    }

    fn close(&self) {
        self.lock().is_closed = true;
        self.work.notify_one();
    }
}

impl BehindFs {
    /// The same files as those of `inner`. Where there can be no more threads, every call waits for the disk.
    #[must_use]
    pub fn new(inner: Arc<dyn Fs>) -> Self {
        let queue = Arc::new(Queue::default());
        let (of_thread, fs) = (Arc::clone(&queue), Arc::clone(&inner));
        let thread = std::thread::Builder::new().name("files".into());
        let thread = thread.spawn(move || of_thread.serve(fs.as_ref())).ok();
        Self {
            inner,
            queue,
            thread,
        }
    }

    /// The inner files, when all that was asked for is done.
    fn settled(&self) -> Result<&dyn Fs, FsError> {
        self.queue.settle()?;
        Ok(self.inner.as_ref())
    }
}

impl Drop for BehindFs {
    fn drop(&mut self) {
        self.queue.close();
        if let Some(thread) = self.thread.take() {
            // a panic there has been told already
            let _ = thread.join();
        }
    }
}

impl Fs for BehindFs {
    fn read(&self, path: &Path) -> Result<Vec<u8>, FsError> {
        self.settled()?.read(path)
    }

    fn exists(&self, path: &Path) -> Result<bool, FsError> {
        Ok(self.queue.makes(path)? || self.inner.exists(path)? || {
            // a fault since the first look
            self.queue.makes(path)?
        })
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
        if self.thread.is_none() {
            return Ok(log);
        }
        Ok(Box::new(BehindLog {
            queue: Arc::clone(&self.queue),
            log: Arc::new(Mutex::new(log)),
        }))
    }

    fn lock(&self, path: &Path) -> Result<Lock, FsError> {
        self.settled()?.lock(path)
    }

    fn write_atomic(&self, path: &Path, bytes: &[u8]) -> Result<(), FsError> {
        if self.thread.is_none() {
            return self.inner.write_atomic(path, bytes);
        }
        let (file, bytes) = (path.to_path_buf(), bytes.to_vec());
        self.queue.push(Job {
            makes: Some(path.to_path_buf()),
            bytes: bytes.len(),
            act: Box::new(move |fs| fs.write_atomic(&file, &bytes)),
        })
    }

    fn settle(&self) -> Result<(), FsError> {
        self.settled()?.settle()
    }
}

/// A file that grows behind its writer's back.
struct BehindLog {
    queue: Arc<Queue>,
    log: Arc<Mutex<Box<dyn Log>>>,
}

impl BehindLog {
    fn push(
        &self,
        bytes: usize,
        act: impl FnOnce(&mut dyn Log) -> Result<(), FsError> + Send + 'static,
    ) -> Result<(), FsError> {
        let log = Arc::clone(&self.log);
        self.queue.push(Job {
            makes: None,
            bytes,
            act: Box::new(move |_| {
                let mut log = log.lock().unwrap_or_else(PoisonError::into_inner);
                act(log.as_mut())
            }),
        })
    }
}

impl Log for BehindLog {
    fn append(&mut self, bytes: &[u8]) -> Result<(), FsError> {
        let bytes = bytes.to_vec();
        self.push(bytes.len(), move |log| log.append(&bytes))
    }

    fn cut(&mut self, keep: u64) -> Result<(), FsError> {
        self.queue.settle()?;
        let mut log = self.log.lock().unwrap_or_else(PoisonError::into_inner);
        log.cut(keep)
    }

    fn sync(&mut self) -> Result<(), FsError> {
        self.push(0, |log| log.sync())
    }
}
