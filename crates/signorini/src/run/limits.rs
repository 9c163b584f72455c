//! What stops a run from outside: a signal, the clock.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// More than any signal has.
const BEHIND_SIGNALS: u64 = 1 << 32;

/// The limits of a run.
#[derive(Clone, Debug, Default)]
pub struct Limits {
    /// The number of the signal that came; 0 before that. May be set from anywhere.
    pub signal: Arc<AtomicUsize>,
    /// When to stop.
    pub deadline: Option<Instant>,
}

/// Why a run stopped before its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// A signal came.
    Signal(usize),
    /// The time is up.
    Time,
    /// Who listens wants no more.
    Listener,
    /// The steps that were asked for are done.
    Steps,
}

impl Stop {
    /// All statuses that [`Stop::status`] gives.
    pub const STATUSES: [&str; 3] = ["interrupted", "time limit reached", "first steps solved"];

    /// The exit code of the program.
    #[must_use]
    pub fn exit_code(self) -> u8 {
        match self {
            Self::Signal(number) => u8::try_from(128 + number).unwrap_or(130),
            Self::Time => 8,
            Self::Listener => 130,
            Self::Steps => 0,
        }
    }

    /// A number for it: reasons that come first are smaller.
    pub(crate) fn to_number(self) -> u64 {
        match self {
            Self::Signal(number) => number as u64,
            Self::Time => BEHIND_SIGNALS,
            Self::Listener => BEHIND_SIGNALS + 1,
            Self::Steps => BEHIND_SIGNALS + 2,
        }
    }

    /// The reason that a number stands for.
    pub(crate) fn from_number(number: u64) -> Option<Self> {
        match number.checked_sub(BEHIND_SIGNALS) {
            None => usize::try_from(number).ok().map(Self::Signal),
            Some(0) => Some(Self::Time),
            Some(1) => Some(Self::Listener),
            Some(2) => Some(Self::Steps),
            Some(_) => None,
        }
    }

    /// The status in the summary.
    #[must_use]
    pub const fn status(self) -> &'static str {
        let [interrupted, late, first] = Self::STATUSES;
        match self {
            Self::Signal(_) | Self::Listener => interrupted,
            Self::Time => late,
            Self::Steps => first,
        }
    }
}

impl Limits {
    /// Whether to stop now, and why.
    #[must_use]
    pub fn reached(&self) -> Option<Stop> {
        let signal = self.signal.load(Ordering::Relaxed);
        if signal != 0 {
            return Some(Stop::Signal(signal));
        }
        let late = self.deadline.is_some_and(|at| Instant::now() >= at);
        late.then_some(Stop::Time)
    }
}
