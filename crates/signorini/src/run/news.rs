//! What is reported while a run goes on: the terminal, `--json` and `events.jsonl` are fed from one stream.

use signorini_io::diagnostic::{Diagnostic, Diagnostics, Severity};
use signorini_io::writers::json::Event;
use signorini_mechanics::solve::{Cause, Flow, IncrementRecord, IterationRecord, Vibrations};
use signorini_mechanics::system::Frame;

/// Iterations from which on an increment is called slow.
pub const SLOW: usize = 8;

/// One piece of news.
#[derive(Clone, Copy, Debug)]
pub struct News<'a> {
    /// What happened, for machines.
    pub event: &'a Event,
    /// What else is known of it.
    pub detail: Detail<'a>,
}

/// What people read beyond the event.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum Detail<'a> {
    /// Nothing more.
    None,
    /// A run starts.
    Start(&'a Facts),
    /// A linear solve, and the node with the largest force error.
    Iteration(&'a IterationRecord),
    /// Natural frequencies.
    Vibrations(&'a Vibrations),
    /// An accepted increment.
    Increment(&'a IncrementRecord, &'a Frame, &'a Effort),
    /// A frame: what was written, or would be where no format of frames is asked for.
    Frame(&'a Frame),
    /// An increment is tried again in smaller pieces.
    Cutback(&'a Cause),
    /// A finding.
    Finding(&'a Diagnostic),
    /// An expectation with its tolerance in words.
    Expectation(&'a str),
    /// How it ended.
    End(&'a Totals),
}

/// What a run starts from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Facts {
    /// Its name.
    pub name: String,
    /// Number of nodes.
    pub nnode: usize,
    /// Cells of the solids by type: name and number.
    pub cells: Vec<(&'static str, usize)>,
    /// Number of contacts.
    pub ncontact: usize,
    /// Points of all secondary sides.
    pub npoint: usize,
    /// Smallest gap at the start, where anything is within reach.
    pub gap_min: Option<f64>,
    /// Number of unknowns.
    pub nunknown: usize,
    /// Bodies with their remedies against locking.
    pub remedies: Vec<String>,
    /// Number of processes.
    pub ranks: usize,
    /// Number of threads, of each process.
    pub threads: usize,
    /// Seconds for reading, and for building.
    pub seconds: [f64; 2],
    /// The unit of length; empty where the case does not say.
    pub length: String,
    /// Names of the steps.
    pub steps: Vec<String>,
    /// Duration of all steps.
    pub duration: f64,
}

/// What an increment took.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Effort {
    /// Discrete choices that changed in its last iterations, and the node with the largest force error then.
    pub worst: Option<String>,
    /// Closed contact points at its end.
    pub closed: usize,
    /// Linear solves, those of failed attempts too.
    pub solves: u64,
    /// Whether multigrid takes part in them.
    pub multigrid: bool,
    /// Iterations of the linear solver in them; those of a direct solution improve it.
    pub linear_iterations: u64,
    /// Whether iterations gave way to a direct solution.
    pub gave_way: bool,
}

/// How a run ended.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Totals {
    /// Accepted increments.
    pub increments: u64,
    /// Linear solves.
    pub iterations: u64,
    /// Attempts given up.
    pub cutbacks: u64,
    /// The output folder, as the user named it.
    pub folder: String,
    /// Seconds for everything by phase.
    pub phases: Vec<(String, f64)>,
}

/// Receives the news; asked each time whether to go on.
pub trait Listener {
    /// Something happened.
    fn hear(&mut self, news: &News<'_>) -> Flow;

    /// Whether it may open the files that it hears of: then it hears of them when they are on the disk.
    fn opens_files(&self) -> bool {
        true
    }
}

/// Hears nothing.
impl Listener for () {
    fn hear(&mut self, _: &News<'_>) -> Flow {
        Flow::Continue
    }

    fn opens_files(&self) -> bool {
        false
    }
}

impl<F: FnMut(&News<'_>) -> Flow> Listener for F {
    fn hear(&mut self, news: &News<'_>) -> Flow {
        self(news)
    }
}

/// Tells several, one after the other.
impl<A: Listener, B: Listener> Listener for (A, B) {
    fn hear(&mut self, news: &News<'_>) -> Flow {
        let flows = [self.0.hear(news), self.1.hear(news)];
        if flows.contains(&Flow::Stop) {
            Flow::Stop
        } else {
            Flow::Continue
        }
    }

    fn opens_files(&self) -> bool {
        self.0.opens_files() || self.1.opens_files()
    }
}

/// A finding as an event.
#[must_use]
pub fn event_of(finding: &Diagnostic) -> Event {
    let label = finding.labels.first();
    let place = label.map(|label| {
        let line = label.file.line_index(label.span.start);
        let start = label.file.line_range(line).start;
        let before = label.file.text().get(start..label.span.start);
        let column = before.map_or(0, |text| text.chars().count());
        (
            label.file.name().to_owned(),
            line as u64 + 1,
            column as u64 + 1,
        )
    });
    Event::Diagnostic {
        severity: match finding.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        }
        .into(),
        code: finding.code.id.into(),
        message: finding.message.clone(),
        file: place.as_ref().map(|(file, ..)| file.clone()),
        line: place.as_ref().map(|(_, line, _)| *line),
        column: place.map(|(.., column)| column),
        label: label
            .map(|label| label.text.clone())
            .filter(|text| !text.is_empty()),
        notes: finding.notes.clone(),
        help: finding.help.clone(),
    }
}

/// Tells all findings.
pub fn tell(findings: &Diagnostics, listener: &mut dyn Listener) {
    for finding in findings {
        let news = News {
            event: &event_of(finding),
            detail: Detail::Finding(finding),
        };
        // nothing goes on yet, or any more, that could be stopped
        let _ = listener.hear(&news);
    }
}
