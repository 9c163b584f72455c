//! Requests to stop: Ctrl-C, SIGTERM and the time limit.
//!
//! ```text
//!  reading, building │ solving
//!  ──────────────────┼───────────────────────────────────────────────────────
//!  a signal ends the │ the first signal, or the limit: "stopping", and the run stops after the current linear solve
//!  process at once   │ the second signal: ends the process at once
//! ```

use super::console::Console;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
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
    /// Catches the signals: until [`Signals::are_requests`] they end the process with their exit code.
    ///
    /// Signals that cannot be caught end the process, as they do by default.
    pub fn caught() -> Self {
        let signals = Self {
            seen: Arc::default(),
            ends: Arc::new(AtomicBool::new(true)),
        };
        for signal in [SIGINT, SIGTERM] {
            // in this order: the second signal finds what the first one set
            let ends = &signals.ends;
            let _ = flag::register_conditional_shutdown(signal, 128 + signal, Arc::clone(ends));
            let _ = flag::register(signal, Arc::clone(ends));
            let _ = flag::register_usize(signal, Arc::clone(&signals.seen), signal as usize);
        }
        signals
    }

    /// From now on the first signal is a request, and only the second one ends the process.
    pub fn are_requests(&self) {
        self.ends.store(false, Ordering::SeqCst);
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
    let wipe = if console.terminal { "\r\x1b[2K" } else { "" };
    console.text(&format!("{wipe}{line}\n"));
}

fn text(stop: Stop) -> String {
    let why = match stop {
        Stop::Signal(number) if number == SIGINT as usize => "Ctrl-C".to_owned(),
        Stop::Signal(number) if number == SIGTERM as usize => "SIGTERM".to_owned(),
        Stop::Signal(number) => format!("signal {number}"),
        Stop::Time => "time limit".to_owned(),
        Stop::Listener => "request".to_owned(),
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
