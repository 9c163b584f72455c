//! Work on a thread of its own, while the calling thread looks for signals.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

/// How often signals are looked for.
const LOOK: Duration = Duration::from_millis(50);

/// Does something on a thread of its own, which is asked to stop by a signal; the exception of that signal comes first.
pub fn supervised<R: Send>(
    py: Python<'_>,
    work: impl FnOnce(&AtomicBool) -> R + Send,
) -> PyResult<R> {
    let stop = AtomicBool::new(false);
    let stop = &stop;
    let (done, mut ended) = channel::<()>();
    std::thread::scope(|scope| {
        let worker = scope.spawn(move || {
            // dropped when the work is done, or panics
            let _done = done;
            work(stop)
        });
        let mut interrupt = Ok(());
        while py.detach(|| wait(&mut ended)) == Err(RecvTimeoutError::Timeout) {
            if let Err(signal) = py.check_signals() {
                interrupt = interrupt.and(Err(signal));
                stop.store(true, Ordering::Relaxed);
            }
        }
        let result = py.detach(|| worker.join());
        interrupt?;
        result.map_err(|panic| internal(&*panic))
    })
}

/// Waits for a message, not longer than until signals are looked for again.
pub fn wait<T>(asked: &mut Receiver<T>) -> Result<T, RecvTimeoutError> {
    asked.recv_timeout(LOOK)
}

/// The exception for a panic of the program: a bug.
pub fn internal(panic: &(dyn std::any::Any + Send)) -> PyErr {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
    let message = format!(
        "this is a bug of signorini, not of your case: {}",
        text.unwrap_or("a panic")
    );
    Python::attach(|py| {
        let class = py
            .import("signorini.errors")
            .and_then(|errors| errors.getattr("InternalError"));
        match class.and_then(|class| class.call1((&message,))) {
            Ok(exception) => PyErr::from_value(exception),
            Err(_) => PyRuntimeError::new_err(message),
        }
    })
}
