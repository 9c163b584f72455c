//! A run: solved on a thread of its own, while the calling thread answers callbacks and looks for signals.
//!
//! ```text
//! calling thread                              worker
//!   every 50 ms: Ctrl-C? ──signal──────────▶  stops after the present linear solve
//!   callbacks ◀──Message── Hearing (Listener) ◀── News of the run
//!         └─────Flow──────▶ goes on, or stops
//! ```
//!
//! Python code therefore runs where the user called, and the interpreter is free for other threads meanwhile.

use crate::diagnostics::{exception, list};
use crate::frame::{Frame, Kept};
use crate::job::{Built, Job};
use crate::own::Failures;
use crate::pool;
use crate::worker::{internal, wait, watch_for_panics};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use signorini::run::{Detail, Finished, NOT_STARTED};
use signorini::{Diagnostics, Limits, Listener, News, RunOptions, solve};
use signorini_geometry::mesh::Mesh;
use signorini_io::fs::{Fs, MemoryFs, RealFs};
use signorini_mechanics::solve::{Flow, IncrementRecord, IterationRecord};
use signorini_mechanics::system::{DofName, Layout};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};

/// The number of the signal that Ctrl-C sends.
const SIGINT: usize = 2;
/// How many of the nodes that kept an increment from converging are named.
const WORST: usize = 10;

/// How a run ended, with what it left.
#[pyclass(frozen, get_all, module = "signorini._native")]
pub struct Outcome {
    /// The exit code of the command: 0 solved, 1 an expectation failed, 5 not converged, …
    exit_code: u8,
    /// The same in words.
    status: String,
    /// Errors and warnings.
    diagnostics: Py<PyList>,
    /// `summary.json`.
    summary: String,
    /// `history.csv`.
    history: String,
    /// `convergence.csv`.
    convergence: String,
    /// The frames, the undeformed state first.
    frames: Py<PyList>,
    /// Numbers of the nodes with the largest force error in the last increment that failed.
    worst_nodes: Vec<u64>,
    /// The exception that a callback raised, or that Ctrl-C was.
    error: Option<Py<PyAny>>,
}

/// What the calling thread is asked to do.
enum Message {
    /// An event, as a line of `events.jsonl`.
    Event(String),
    Iteration(IterationRecord),
    Increment(IncrementRecord, Arc<Kept>),
    /// It is over.
    Done(Box<Ended>),
}

/// How it was over: refused, or with what was heard and written.
type Ended = Result<(Finished, Heard), Diagnostics>;

/// What was heard of a run, and its tables.
#[derive(Default)]
struct Heard {
    frames: Vec<Arc<Kept>>,
    worst: Vec<u64>,
    history: String,
    convergence: String,
}

/// Which news the calling thread wants, and whether frames are kept.
#[derive(Clone, Copy)]
struct Wanted {
    events: bool,
    iterations: bool,
    increments: bool,
    frames: bool,
}

/// Hears the news on the worker.
struct Hearing {
    wanted: Wanted,
    failures: Failures,
    mesh: Arc<Mesh>,
    layout: Layout,
    heard: Heard,
    /// The increment at hand, shared with the frame that may follow.
    present: Option<Arc<Kept>>,
    ask: Sender<Message>,
    answer: Receiver<Flow>,
}

impl Hearing {
    fn ask(&self, message: Message) -> Flow {
        let sent = self.ask.send(message);
        match sent.map(|()| self.answer.recv()) {
            Ok(Ok(flow)) => flow,
            // nobody waits for the run any more
            _ => Flow::Stop,
        }
    }

    fn keep(&self, frame: &signorini_mechanics::system::Frame) -> Arc<Kept> {
        Arc::new(Kept {
            values: frame.clone(),
            mesh: Arc::clone(&self.mesh),
        })
    }

    /// The node with the largest force error comes first.
    fn note_worst(&mut self, record: &IterationRecord) {
        let name = record.worst.and_then(|dof| self.layout.name(dof));
        let node = name
            .and_then(DofName::displacement)
            .map(|(node, _)| node as usize);
        if let Some(&label) = node.and_then(|node| self.mesh.node_labels.get(node)) {
            self.heard.worst.retain(|&known| known != label);
            self.heard.worst.insert(0, label);
            self.heard.worst.truncate(WORST);
        }
    }

    fn detail(&mut self, detail: Detail<'_>) -> Flow {
        match detail {
            Detail::Iteration(record) => {
                self.note_worst(record);
                if self.wanted.iterations {
                    return self.ask(Message::Iteration(record.clone()));
                }
            }
            Detail::Increment(record, frame, _) => {
                self.heard.worst.clear();
                self.present = None;
                if self.wanted.increments {
                    let kept = self.keep(frame);
                    self.present = Some(Arc::clone(&kept));
                    return self.ask(Message::Increment(record.clone(), kept));
                }
            }
            Detail::Frame(frame) if self.wanted.frames => {
                let kept = self.present.take().unwrap_or_else(|| self.keep(frame));
                self.heard.frames.push(kept);
            }
            _ => {}
        }
        Flow::Continue
    }
}

impl Listener for Hearing {
    fn hear(&mut self, news: &News<'_>) -> Flow {
        let mut flow = Flow::Continue;
        if self.wanted.events
            && let Ok(line) = serde_json::to_string(news.event)
        {
            flow = self.ask(Message::Event(line));
        }
        match self.detail(news.detail) {
            Flow::Continue if !self.failures.any() => flow,
            _ => Flow::Stop,
        }
    }

    fn opens_files(&self) -> bool {
        self.wanted.events
    }
}

/// The functions of the user that hear of a run.
struct Callbacks<'py> {
    on_event: Option<Bound<'py, PyAny>>,
    on_iteration: Option<Bound<'py, PyAny>>,
    on_increment: Option<Bound<'py, PyAny>>,
    /// The first exception.
    error: Option<PyErr>,
}

impl<'py> Callbacks<'py> {
    fn wanted(&self, frames: bool) -> Wanted {
        Wanted {
            events: self.on_event.is_some(),
            iterations: self.on_iteration.is_some(),
            increments: self.on_increment.is_some(),
            frames,
        }
    }

    /// Calls the function that a message is for; what raises an exception, or returns true, stops the run.
    fn answer(&mut self, py: Python<'py>, message: Message) -> Flow {
        if self.error.is_some() {
            return Flow::Stop;
        }
        match self.call(py, message) {
            Ok(false) => Flow::Continue,
            Ok(true) => Flow::Stop,
            Err(error) => {
                self.error = Some(error);
                Flow::Stop
            }
        }
    }

    fn call(&self, py: Python<'py>, message: Message) -> PyResult<bool> {
        let said = match message {
            Message::Event(line) => {
                let event = py.import("json")?.call_method1("loads", (line,))?;
                self.on_event.as_ref().map(|call| call.call1((event,)))
            }
            Message::Iteration(record) => {
                let record = iteration(py, &record)?;
                self.on_iteration.as_ref().map(|call| call.call1((record,)))
            }
            Message::Increment(record, kept) => {
                let arguments = (Bound::new(py, Frame::new(kept))?, increment(py, &record)?);
                self.on_increment.as_ref().map(|call| call.call1(arguments))
            }
            Message::Done(_) => None,
        };
        said.map_or(Ok(false), |said| said?.is_truthy())
    }
}

fn iteration<'py>(py: Python<'py>, record: &IterationRecord) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("step", record.step)?;
    dict.set_item("increment", record.increment)?;
    dict.set_item("attempt", record.attempt)?;
    dict.set_item("iteration", record.iteration)?;
    dict.set_item("residual", record.residual)?;
    dict.set_item("correction", record.correction)?;
    dict.set_item("line_search", record.line_search)?;
    dict.set_item("closed", record.closed)?;
    dict.set_item("flips", record.flips)?;
    Ok(dict)
}

fn increment<'py>(py: Python<'py>, record: &IncrementRecord) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("increment", record.increment)?;
    dict.set_item("attempts", record.attempts)?;
    dict.set_item("iterations", record.iterations)?;
    dict.set_item("time", record.time)?;
    dict.set_item("dt", record.dt)?;
    dict.set_item("residual", record.residual)?;
    Ok(dict)
}

/// Where results go, and how the run is started.
struct Place {
    output: Option<PathBuf>,
    fresh: bool,
    resume: bool,
    threads: Option<u64>,
    signal: Arc<AtomicUsize>,
}

/// Solves a job. Results go to the folder `output`, or nowhere; with `keep` frames stay in memory. The functions hear of
/// events, of iterations, and of accepted increments with their frames; where one returns true the run stops, and can be
/// resumed where it has a folder.
///
/// Errors: `InputError`, `ModelError`, `OutputError`, `RestartError` where nothing was solved. What a callback raises, and
/// `KeyboardInterrupt`, are in the outcome.
#[pyfunction]
#[pyo3(signature = (job, output = None, *, fresh = false, resume = false, threads = None, keep = true, on_event = None, on_iteration = None, on_increment = None))]
#[allow(clippy::too_many_arguments)]
pub fn run<'py>(
    py: Python<'py>,
    job: &Job,
    output: Option<PathBuf>,
    fresh: bool,
    resume: bool,
    threads: Option<u64>,
    keep: bool,
    on_event: Option<Bound<'py, PyAny>>,
    on_iteration: Option<Bound<'py, PyAny>>,
    on_increment: Option<Bound<'py, PyAny>>,
) -> PyResult<Outcome> {
    let mut callbacks = Callbacks {
        on_event,
        on_iteration,
        on_increment,
        error: None,
    };
    let wanted = callbacks.wanted(keep);
    let place = Place {
        output,
        fresh,
        resume,
        threads,
        signal: Arc::default(),
    };
    let signal = Arc::clone(&place.signal);
    watch_for_panics();
    let ended = std::thread::scope(|scope| {
        let (ask, mut asked) = channel();
        let (reply, answer) = channel();
        let worker = std::thread::Builder::new()
            .name("signorini".into())
            .spawn_scoped(scope, move || work(job, &place, wanted, ask, answer));
        let worker = worker?;
        let ended = listen(py, &mut asked, &reply, &signal, &mut callbacks);
        drop(reply);
        let joined = py.detach(|| worker.join());
        match (ended, joined) {
            (Some(ended), Ok(())) => Ok(ended),
            (_, Err(panic)) => Err(internal(&*panic)),
            (None, Ok(())) => Err(PyRuntimeError::new_err("the run ended without a word")),
        }
    })?;
    let error = job.failures.take().or(callbacks.error);
    match (ended, error) {
        (Ok((finished, heard)), error) => outcome(py, &finished, heard, error),
        (Err(_), Some(error)) => Err(error),
        (Err(found), None) => Err(exception(py, &found)),
    }
}

/// Answers what the worker asks until it is over, and looks for signals.
fn listen<'py>(
    py: Python<'py>,
    asked: &mut Receiver<Message>,
    reply: &Sender<Flow>,
    signal: &AtomicUsize,
    callbacks: &mut Callbacks<'py>,
) -> Option<Ended> {
    loop {
        match py.detach(|| wait(asked)) {
            Ok(Message::Done(ended)) => return Some(*ended),
            Ok(message) => {
                let flow = callbacks.answer(py, message);
                // who asked waits for it
                let _ = reply.send(flow);
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return None,
        }
        if let Err(interrupt) = py.check_signals() {
            callbacks.error.get_or_insert(interrupt);
            signal.store(SIGINT, Ordering::Relaxed);
        }
    }
}

/// Builds and solves, on the worker.
fn work(job: &Job, place: &Place, wanted: Wanted, ask: Sender<Message>, answer: Receiver<Flow>) {
    let done = ask.clone();
    let ended = pool::with(place.threads, || solve_job(job, place, wanted, ask, answer));
    // who does not listen any more needs no ending
    let _ = done.send(Message::Done(Box::new(ended)));
}

fn solve_job(
    job: &Job,
    place: &Place,
    wanted: Wanted,
    ask: Sender<Message>,
    answer: Receiver<Flow>,
) -> Ended {
    let Built {
        mut model,
        source,
        warnings,
        seconds,
    } = job.build()?;
    let mut options = RunOptions::new(source);
    let fs: Arc<dyn Fs> = match &place.output {
        Some(folder) => {
            options.folder.clone_from(folder);
            Arc::new(RealFs)
        }
        None => {
            model.case.output.format.clear();
            Arc::new(MemoryFs::default())
        }
    };
    options.own = job.own();
    options.fs = Arc::clone(&fs);
    options.fresh = place.fresh;
    options.resume = place.resume;
    options.warnings = warnings;
    options.seconds = seconds;
    options.limits = Limits {
        signal: Arc::clone(&place.signal),
        deadline: None,
    };
    let mut hearing = Hearing {
        wanted,
        failures: job.failures.clone(),
        mesh: Arc::clone(&model.mesh),
        layout: model.system.layout,
        heard: Heard::default(),
        present: None,
        ask,
        answer,
    };
    let folder = options.folder.clone();
    let finished = solve(model, &options, &mut hearing);
    if finished.summary.status == NOT_STARTED {
        return Err(finished.diagnostics);
    }
    let mut heard = hearing.heard;
    heard.history = text_of(fs.as_ref(), &folder.join("history.csv"));
    heard.convergence = text_of(fs.as_ref(), &folder.join("convergence.csv"));
    Ok((finished, heard))
}

/// The text of a table; empty where there is none.
fn text_of(fs: &dyn Fs, path: &Path) -> String {
    let bytes = fs.read(path).unwrap_or_default();
    String::from_utf8_lossy(&bytes).into_owned()
}

fn outcome(
    py: Python<'_>,
    finished: &Finished,
    heard: Heard,
    error: Option<PyErr>,
) -> PyResult<Outcome> {
    let frames = heard.frames.into_iter();
    let frames = frames.map(|kept| Bound::new(py, Frame::new(kept)));
    let frames = PyList::new(py, frames.collect::<PyResult<Vec<_>>>()?)?;
    let summary = serde_json::to_string(&finished.summary);
    Ok(Outcome {
        exit_code: finished.exit_code,
        status: finished.summary.status.clone(),
        diagnostics: list(py, &finished.diagnostics)?.unbind(),
        summary: summary.map_err(|error| PyRuntimeError::new_err(error.to_string()))?,
        history: heard.history,
        convergence: heard.convergence,
        frames: frames.unbind(),
        worst_nodes: heard.worst,
        error: error.map(|error| error.into_value(py).into_any()),
    })
}
