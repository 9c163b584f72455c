//! What a run in a folder has reached: while it goes on, after it was killed, and after its end.
//!
//! ```text
//!   lock held                                    running
//!   no lock, and no summary of the last process  killed
//!   summary: stopped by a signal or a limit      interrupted
//!            exit code 0 or 1                    finished
//!            else                                failed
//! ```
//!
//! A run that goes on removes the summary of the part before: what it says holds for the last process only.

mod progress;

pub use progress::{Attempt, Progress, Saved};

use crate::run::{Owner, Stop, killed_after, process_in};
use crate::text::{clock, plural, short};
use serde::Serialize;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_io::fs::Fs;
use signorini_io::writers::json::Summary;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Whether a run goes on, and how it ended otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum State {
    /// A process writes there.
    Running,
    /// It ended without an ending: `kill -9`, a power cut, no memory.
    Killed,
    /// It was stopped by a signal or a time limit, or behind the steps that were asked for.
    Interrupted,
    /// It ended with an error.
    Failed,
    /// It is solved; an expectation may have failed.
    Finished,
}

/// What a run has reached.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Status {
    /// The folder, as the user named it.
    pub folder: PathBuf,
    /// The case.
    pub case: Option<PathBuf>,
    /// Whether it goes on, and how it ended otherwise.
    pub state: State,
    /// The process that writes there, as it names itself.
    pub process: Option<String>,
    /// Why it failed.
    pub reason: Option<String>,
    /// The command that goes on with it, where there is something to go on from.
    pub resume: Option<String>,
    /// How far it has got.
    pub progress: Progress,
    /// How it ended.
    pub summary: Option<Summary>,
}

/// Reads what the run in a folder has reached.
///
/// # Errors
/// A folder that holds no results: exit code 3.
///
/// # Example
/// ```
/// use signorini::status::status;
/// use signorini_io::fs::MemoryFs;
///
/// let found = status(&MemoryFs::default(), "case.out".as_ref()).unwrap_err();
/// assert!(found.plain().contains("holds no results"));
/// ```
pub fn status(fs: &dyn Fs, folder: &Path) -> Result<Status, Diagnostics> {
    let none = |why: &dyn std::fmt::Display| {
        let message = format!("{} holds no results: {why}", folder.display());
        Diagnostics::from(Diagnostic::error(&codes::UNREADABLE, message))
    };
    // in this order: a run that ends meanwhile has written its summary before it lets go of the lock
    let process = process_in(fs, folder).map_err(|error| none(&error))?;
    let summary = Summary::read(fs, &folder.join("summary.json"));
    let owner = Owner::read(fs, folder);
    let (state, summary) = match (&process, summary) {
        (Some(_), _) => (State::Running, None),
        // it ended before it could say that the ending is no longer true
        (None, Ok(_)) if killed_after(fs, folder, "summary.json") => (State::Killed, None),
        (None, Ok(summary)) => (state_of(&summary), Some(summary)),
        (None, Err(_)) if owner.is_some() => (State::Killed, None),
        (None, Err(error)) => return Err(none(&error)),
    };
    let events = folder.join("events.jsonl");
    let mut progress = Progress::of(&fs.read(&events).unwrap_or_default());
    let written = fs.modified(&events).ok().flatten();
    let since = written.and_then(|at| SystemTime::now().duration_since(at).ok());
    progress.seconds_since_event = since.map(|since| since.as_secs_f64());
    let reason = match (state, &summary) {
        (State::Failed, Some(summary)) => {
            let known = progress.error.take();
            Some(known.unwrap_or_else(|| summary.status.clone()))
        }
        _ => None,
    };
    let is_over = matches!(state, State::Running | State::Finished);
    let resume = format!("signorini resume {}", quoted(folder));
    Ok(Status {
        folder: folder.to_path_buf(),
        case: owner.map(|owner| owner.case),
        state,
        process,
        reason,
        resume: (!is_over && progress.checkpoint.is_some()).then_some(resume),
        progress,
        summary,
    })
}

fn state_of(summary: &Summary) -> State {
    if Stop::STATUSES.contains(&summary.status.as_str()) {
        State::Interrupted
    } else if summary.exit_code <= 1 {
        State::Finished
    } else {
        State::Failed
    }
}

/// A path as a shell reads it.
fn quoted(path: &Path) -> String {
    let shown = path.display().to_string();
    if shown.contains([' ', '\t', '(', ')', '&', ';']) {
        format!("\"{shown}\"")
    } else {
        shown
    }
}

impl Status {
    /// What there is to say, line by line.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
        let mut lines = vec![self.headline()];
        if let Some(reason) = &self.reason {
            lines.push(format!("  {reason}"));
        }
        match &self.summary {
            Some(summary) => lines.extend(ending(summary)),
            None => lines.extend(self.reached()),
        }
        if let Some(resume) = &self.resume {
            let from = self.progress.checkpoint.as_ref();
            let from = from.map_or_else(String::new, |at| {
                format!("   (from time {})", short(at.time))
            });
            lines.push(format!("to go on:  {resume}{from}"));
        } else if self.state == State::Killed {
            lines.push("there is no checkpoint to go on from: start it again".to_owned());
        }
        lines
    }

    fn headline(&self) -> String {
        let part = match self.progress.resumed {
            true => ", resumed",
            false => "",
        };
        match (self.state, &self.summary) {
            (State::Running, _) => {
                let process = self.process.as_deref().unwrap_or_default();
                let ranks = self.progress.ranks;
                let ranks = ranks.map_or_else(String::new, |n| format!(" of {n} ranks"));
                format!("running: process {process}{ranks}{part}")
            }
            (State::Interrupted, Some(summary)) => format!(
                "{} (exit code {}): stopped on request",
                summary.status, summary.exit_code
            ),
            (_, Some(summary)) => format!("{} (exit code {})", summary.status, summary.exit_code),
            (_, None) => {
                format!("killed{part}: no process writes here, and the run has no ending")
            }
        }
    }

    /// How far a run without an ending has got.
    fn reached(&self) -> Vec<String> {
        let progress = &self.progress;
        let of = progress.duration;
        let of = of.map_or_else(String::new, |duration| format!(" of {}", short(duration)));
        let mut lines = vec![match &progress.step {
            Some(step) => format!(
                "step {step}, increment {}: time {}{of}",
                progress.increment,
                short(progress.time)
            ),
            None => "no increment has converged yet".to_owned(),
        }];
        if let Some(now) = &progress.attempt {
            let residual = now.residual.map_or("—".to_owned(), |r| format!("{r:.1e}"));
            lines.push(format!(
                "in step {}, increment {}, attempt {}: iteration {}, residual {residual}",
                now.step, now.increment, now.attempt, now.iteration
            ));
        }
        lines.push(format!(
            "{}, {}, {}, {}",
            plural(progress.increments as usize, "increment"),
            plural(progress.iterations as usize, "iteration"),
            plural(progress.cutbacks as usize, "cut-back"),
            plural(progress.frames as usize, "frame")
        ));
        for (name, contact) in &progress.contacts {
            let [x, y, z] = contact.force.map(short);
            lines.push(format!(
                "contact {name}: force ({x}, {y}, {z}), largest pressure {}",
                short(contact.pressure_max)
            ));
        }
        if let Some(seconds) = progress.seconds_since_event {
            lines.push(format!("last event {} ago", ago(seconds)));
        }
        lines
    }
}

/// A duration in words.
fn ago(seconds: f64) -> String {
    if seconds < 60.0 {
        format!("{seconds:.1} s")
    } else {
        clock(seconds)
    }
}

/// How a run ended, in lines.
fn ending(summary: &Summary) -> Vec<String> {
    let mut lines = Vec::new();
    for step in &summary.steps {
        lines.push(format!(
            "step {}: {}, {}, {}",
            step.name,
            plural(step.increments as usize, "increment"),
            plural(step.iterations as usize, "iteration"),
            plural(step.cutbacks as usize, "cut-back")
        ));
    }
    if let Some(ranks) = &summary.ranks {
        let [first, most] = [summary.memory_peak_bytes, ranks.memory_peak_bytes];
        let [first, most] = [first, most].map(|bytes| short(bytes as f64 / 1e6));
        lines.push(format!(
            "{} ranks: rank 0 had {first} MB of memory, the largest {most} MB",
            ranks.count
        ));
    }
    for (name, contact) in &summary.contacts {
        let [x, y, z] = contact.force.map(short);
        lines.push(format!(
            "contact {name}: force ({x}, {y}, {z}), largest pressure {}, smallest gap {}",
            short(contact.pressure_max),
            short(contact.gap_min)
        ));
    }
    for one in &summary.expectations {
        let sign = if one.ok { "✓" } else { "✗" };
        lines.push(format!(
            "expect {}: {} for {}  {sign}",
            one.what, one.got, one.value
        ));
    }
    lines
}

#[cfg(test)]
mod tests;
