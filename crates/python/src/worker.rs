//! Work on a thread of its own, while the calling thread looks for signals.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use signorini::crash::Crash;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Mutex, Once, PoisonError};
use std::time::Duration;

/// How often signals are looked for.
const LOOK: Duration = Duration::from_millis(50);

/// Does something on a thread of its own, which is asked to stop by a signal; the exception of that signal comes first.
pub fn supervised<R: Send>(
    py: Python<'_>,
    work: impl FnOnce(&AtomicBool) -> R + Send,
) -> PyResult<R> {
    watch_for_panics();
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

/// The first panic since the last one that became an exception.
static CRASH: Mutex<Option<Crash>> = Mutex::new(None);

/// Records panics from now on, in addition to what the process does with them already.
pub fn watch_for_panics() {
    static WATCH: Once = Once::new();
    WATCH.call_once(|| {
        let earlier = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            let mut first = CRASH.lock().unwrap_or_else(PoisonError::into_inner);
            first.get_or_insert_with(|| Crash::record(info));
            drop(first);
            earlier(info);
        }));
    });
}

/// The exception for a panic of the program: a bug, of which a file is written next to the user's work.
pub fn internal(panic: &(dyn std::any::Any + Send)) -> PyErr {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
    let crash = CRASH.lock().unwrap_or_else(PoisonError::into_inner).take();
    let folders = [PathBuf::from("."), std::env::temp_dir()];
    let bundle = crash.and_then(|crash| crash.save(&folders, &["python".to_owned()], &[]).ok());
    let mut message = format!(
        "this is a bug of signorini, not of your case: {}",
        text.unwrap_or("a panic")
    );
    if let Some(path) = &bundle {
        message.push_str(&format!("; please send {} with the case", path.display()));
    }
    Python::attach(|py| {
        let class = py
            .import("signorini.errors")
            .and_then(|errors| errors.getattr("InternalError"));
        let made = class
            .and_then(|class| class.call1((&message,)))
            .and_then(|exception| {
                exception.setattr("bundle", bundle)?;
                Ok(exception)
            });
        match made {
            Ok(exception) => PyErr::from_value(exception),
            Err(_) => PyRuntimeError::new_err(message),
        }
    })
}
