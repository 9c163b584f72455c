//! How far a run has got, from its event lines.

use serde::{Deserialize, Serialize};
use signorini_io::writers::json::ContactState;
use std::collections::BTreeMap;

/// How far a run has got.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Progress {
    /// The step of the last converged increment; none before the first.
    pub step: Option<String>,
    /// The number of that increment within its step.
    pub increment: u64,
    /// Total time that was reached.
    pub time: f64,
    /// Duration of all steps, where the run says so.
    pub duration: Option<f64>,
    /// The processes, where there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ranks: Option<u64>,
    /// Converged increments of all steps.
    pub increments: u64,
    /// Linear solves, those of failed attempts too.
    pub iterations: u64,
    /// Attempts that were given up.
    pub cutbacks: u64,
    /// The last iteration, where it belongs to an increment that has not converged.
    pub attempt: Option<Attempt>,
    /// What every contact carried at the last converged increment.
    pub contacts: BTreeMap<String, ContactState>,
    /// Complete frames, the undeformed one among them.
    pub frames: u64,
    /// The last complete checkpoint.
    pub checkpoint: Option<Saved>,
    /// Whether the run goes on, or went on, from a checkpoint.
    pub resumed: bool,
    /// Seconds since the last event; none where the disk does not say.
    pub seconds_since_event: Option<f64>,
    /// The last error.
    #[serde(skip)]
    pub error: Option<String>,
}

/// An iteration of an increment that has not converged.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Attempt {
    /// The step.
    pub step: String,
    /// The increment.
    pub increment: u64,
    /// The attempt at it, from 1.
    pub attempt: u64,
    /// The iteration, from 1.
    pub iteration: u64,
    /// Largest force error over the force scale; none where it is no number.
    pub residual: Option<f64>,
}

/// A checkpoint.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Saved {
    /// The step.
    pub step: String,
    /// The last increment in it.
    pub increment: u64,
    /// Total time.
    pub time: f64,
    /// Its file, relative to the folder.
    pub file: String,
}

/// What is looked at in a line.
#[derive(Debug, Deserialize)]
#[serde(tag = "ev", rename_all = "snake_case")]
enum Line {
    Start {
        duration: Option<f64>,
        ranks: Option<u64>,
    },
    Diagnostic {
        severity: String,
        code: String,
        message: String,
    },
    Iteration {
        step: String,
        inc: u64,
        att: u64,
        iter: u64,
        residual: Option<f64>,
    },
    Increment {
        step: String,
        inc: u64,
        time: f64,
        contact: BTreeMap<String, Contact>,
    },
    Cutback {},
    Frame {},
    Checkpoint {
        step: String,
        inc: u64,
        time: f64,
        file: String,
    },
    #[serde(other)]
    Other,
}

#[derive(Debug, Deserialize)]
struct Contact {
    force: [Option<f64>; 3],
    area: Option<f64>,
    pressure_max: Option<f64>,
    closed: u64,
}

impl From<Contact> for ContactState {
    fn from(read: Contact) -> Self {
        Self {
            force: read.force.map(|f| f.unwrap_or(f64::NAN)),
            area: read.area.unwrap_or(f64::NAN),
            pressure_max: read.pressure_max.unwrap_or(f64::NAN),
            closed: read.closed,
        }
    }
}

impl Progress {
    /// What the lines of `events.jsonl` say; a line that is torn or unknown is left out.
    #[must_use]
    pub fn of(events: &[u8]) -> Self {
        let mut progress = Self::default();
        let (mut starts, mut judged) = (0, 0);
        for line in events.split(|byte| *byte == b'\n') {
            let Ok(line) = serde_json::from_slice::<Line>(line) else {
                continue;
            };
            match line {
                Line::Start { .. } => starts += 1,
                Line::Iteration { iter: 1, .. } => judged = 1,
                // a state is judged again where terms let go of something
                Line::Iteration { iter, .. } if iter != judged => {
                    judged = iter;
                    progress.iterations += 1;
                }
                _ => {}
            }
            progress.take(line);
        }
        progress.resumed = starts > 1;
        progress
    }

    fn take(&mut self, line: Line) {
        match line {
            Line::Start { duration, ranks } => {
                self.ranks = ranks;
                // how an earlier part of the run ended says nothing about this one
                (self.duration, self.attempt, self.error) = (duration, None, None);
            }
            Line::Diagnostic {
                severity,
                code,
                message,
            } if severity == "error" => self.error = Some(format!("{code}: {message}")),
            Line::Iteration {
                step,
                inc: increment,
                att: attempt,
                iter: iteration,
                residual,
            } => {
                self.attempt = Some(Attempt {
                    step,
                    increment,
                    attempt,
                    iteration,
                    residual,
                });
            }
            Line::Increment {
                step,
                inc,
                time,
                contact,
            } => {
                (self.step, self.increment, self.time) = (Some(step), inc, time);
                self.increments += 1;
                self.attempt = None;
                let contacts = contact.into_iter();
                self.contacts = contacts.map(|(name, c)| (name, c.into())).collect();
            }
            Line::Cutback {} => self.cutbacks += 1,
            Line::Frame {} => self.frames += 1,
            Line::Checkpoint {
                step,
                inc: increment,
                time,
                file,
            } => {
                self.checkpoint = Some(Saved {
                    step,
                    increment,
                    time,
                    file,
                });
            }
            Line::Diagnostic { .. } | Line::Other => {}
        }
    }
}
