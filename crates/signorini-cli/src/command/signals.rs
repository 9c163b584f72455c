//! Requests to stop: Ctrl-C, SIGTERM and the time limit.
//!
//! ```text
//!  reading, building │ solving
//!  ──────────────────┼───────────────────────────────────────────────────────
//!  a signal ends the │ the first signal, or the limit: "stopping", and the run stops after the current linear solve
//!  process at once   │ the second signal: ends the process at once
//! ```

use super::console::{Console, fitted};
use signal_hook::consts::{SIGINT, SIGTERM};
use signorini::Limits;
use signorini::run::Stop;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// How often requests are looked for during a linear solve.
const LOOK: Duration = Duration::from_millis(50);

/// The signals that ask a run to stop.
#[derive(Clone, Debug)]
pub struct Signals {
    /// The number of the first signal after [`Signals::are_requests`]; 0 before.
    pub seen: Arc<AtomicUsize>,
    /// Whether the next signal ends the process.
    ends: Arc<AtomicBool>,
}

impl Signals {
    /// Takes the signals: until [`Signals::are_requests`] they end the process with their exit code.
    ///
    /// To be called while there is one thread only. Signals that cannot be taken end the process, as they do by default.
    pub fn taken() -> Self {
        let signals = Self {
            seen: Arc::default(),
            ends: Arc::new(AtomicBool::new(true)),
        };
        signals.take();
        signals
    }

    /// From now on the first signal is a request, and only the second one ends the process.
    pub fn are_requests(&self) {
        self.ends.store(false, Ordering::SeqCst);
    }

    /// Has a thread wait for the signals.
    #[cfg(target_os = "linux")]
    fn take(&self) {
        let own = self.clone();
        waiting::wait_for(&[SIGINT, SIGTERM], move |signal| own.came(signal));
    }

    /// What is done when a signal has come.
    #[cfg(target_os = "linux")]
    fn came(&self, signal: i32) {
        if self.ends.swap(true, Ordering::SeqCst) {
            waiting::end_process(128 + signal);
        }
        self.seen.store(signal as usize, Ordering::SeqCst);
    }

    /// Has handlers wait for the signals.
    #[cfg(not(target_os = "linux"))]
    fn take(&self) {
        for signal in [SIGINT, SIGTERM] {
            // in this order: the second signal finds what the first one set
            let ends = &self.ends;
            let _ = flag::register_conditional_shutdown(signal, 128 + signal, Arc::clone(ends));
            let _ = flag::register(signal, Arc::clone(ends));
            let _ = flag::register_usize(signal, Arc::clone(&self.seen), signal as usize);
        }
    }
}

/// A thread that waits for signals, which are blocked everywhere: handlers would not do, for METIS has its own for SIGTERM while
/// it orders, which jumps out of the ordering and forgets the signal, or ends the process where another thread gets it.
///
/// Sources: `sigwait(3)`, `pthread_sigmask(3)`; METIS 5.1, GKlib/error.c, `gk_sigtrap`.
#[cfg(target_os = "linux")]
mod waiting {
    #![allow(unsafe_code)]

    /// Blocks signals in this thread and those that it will start, and calls `came` on a thread of its own for each that comes.
    /// Where there is no such thread, they end the process.
    pub fn wait_for(signals: &[i32], came: impl Fn(i32) + Send + 'static) {
        let set = set_of(signals);
        change(libc::SIG_BLOCK, &set);
        let wait = move || {
            loop {
                let mut signal = 0;
                // SAFETY: both places are of the types asked for, and outlive the call.
                let failed = unsafe { libc::sigwait(&raw const set, &raw mut signal) };
                if failed == 0 {
                    came(signal);
                }
            }
        };
        if std::thread::Builder::new().spawn(wait).is_err() {
            change(libc::SIG_UNBLOCK, &set);
        }
    }

    fn set_of(signals: &[i32]) -> libc::sigset_t {
        // SAFETY: an array of numbers, for which zeros are values; the calls below make it a set.
        let mut set = unsafe { std::mem::zeroed() };
        // SAFETY: the set is a place of that type, and outlives the calls.
        unsafe {
            libc::sigemptyset(&raw mut set);
            for &signal in signals {
                libc::sigaddset(&raw mut set, signal);
            }
        }
        set
    }

    /// Blocks or unblocks signals in this thread.
    fn change(how: i32, set: &libc::sigset_t) {
        // SAFETY: the set is initialized; the old one is not asked for.
        unsafe {
            libc::pthread_sigmask(how, set, std::ptr::null_mut());
        }
    }

    /// Ends the process at once: nothing that other threads do is waited for.
    pub fn end_process(code: i32) -> ! {
        // SAFETY: does not return.
        unsafe { libc::_exit(code) }
    }
}

/// Reports once that a run is stopping: to be asked whenever there is news, and on a thread of its own meanwhile, for a
/// linear solve may take minutes.
#[derive(Clone, Debug)]
pub struct Notice {
    limits: Limits,
    reported: Arc<AtomicBool>,
}

impl Notice {
    /// A notice of these limits.
    pub fn new(limits: Limits) -> Self {
        Self {
            limits,
            reported: Arc::default(),
        }
    }

    /// The line to show, the first time that a limit is reached.
    pub fn line(&self) -> Option<String> {
        let stop = self.limits.reached()?;
        (!self.reported.swap(true, Ordering::SeqCst)).then(|| text(stop))
    }

    /// Shows the line on standard error when it is due, until the returned guard is dropped.
    pub fn watch(self) -> Watch {
        let (end, ended) = channel::<()>();
        let look = move || {
            while ended.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
                if let Some(line) = self.line() {
                    show(&Console::stderr(), &line);
                    return;
                }
            }
        };
        // without the thread, the line appears with the next news
        let thread = std::thread::Builder::new().spawn(look).ok();
        Watch {
            end: Some(end),
            thread,
        }
    }
}

/// Shows a line in place of a progress bar, where there may be one.
pub fn show(console: &Console, line: &str) {
    let wipe = if console.draws { "\r\x1b[2K" } else { "" };
    let line = match console.width() {
        Some(width) => fitted(line, width),
        None => line.to_owned(),
    };
    console.text(&format!("{wipe}{line}\n"));
}

fn text(stop: Stop) -> String {
    let why = match stop {
        Stop::Signal(number) if number == SIGINT as usize => "Ctrl-C".to_owned(),
        Stop::Signal(number) if number == SIGTERM as usize => "SIGTERM".to_owned(),
        Stop::Signal(number) => format!("signal {number}"),
        Stop::Time => "time limit".to_owned(),
        Stop::Listener => "request".to_owned(),
        Stop::Steps => "the steps asked for are done".to_owned(),
    };
    let again = match stop {
        Stop::Signal(_) => "; a second signal ends the process at once",
        _ => "",
    };
    format!("stopping after the current linear solve ({why}){again}")
}

/// Watches for requests as long as it lives.
#[derive(Debug)]
pub struct Watch {
    end: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Drop for Watch {
    fn drop(&mut self) {
        drop(self.end.take());
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Instant;

    #[test]
    fn stopping_is_reported_once_and_names_its_cause() {
        let notice = Notice::new(Limits::default());
        assert_eq!(notice.line(), None);
        notice
            .limits
            .signal
            .store(SIGTERM as usize, Ordering::SeqCst);
        let line = notice.clone().line().unwrap();
        assert!(
            line.contains("stopping") && line.contains("SIGTERM"),
            "{line}"
        );
        assert_eq!(notice.line(), None);
        let late = Notice::new(Limits {
            deadline: Some(Instant::now()),
            ..Limits::default()
        });
        let line = late.line().unwrap();
        assert!(
            line.contains("time limit") && !line.contains("second"),
            "{line}"
        );
    }

    #[test]
    fn a_request_is_reported_while_there_is_no_news() {
        let notice = Notice::new(Limits::default());
        let watch = notice.clone().watch();
        notice
            .limits
            .signal
            .store(SIGINT as usize, Ordering::SeqCst);
        // waits for ever where the watch does not report
        while !notice.reported.load(Ordering::SeqCst) {
            std::thread::yield_now();
        }
        drop(watch);
    }
}
