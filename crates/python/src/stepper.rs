//! A run that Python drives: `advance`, look, change, `advance`.

use crate::diagnostics::exception;
use crate::frame::{Frame, Kept};
use crate::job::{Built, Job};
use crate::own::Failures;
use crate::pool;
use crate::worker::supervised;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use signorini::{Diagnostics, Driver};
use signorini_mechanics::solve::{Event, Flow};
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A case in a state, which goes forward when it is asked to.
#[pyclass(frozen, module = "signorini._native")]
pub struct Stepper {
    inner: Mutex<Inner>,
    threads: Option<u64>,
}

struct Inner {
    driver: Driver,
    failures: Failures,
}

impl Inner {
    fn new(job: &Job) -> Result<Self, Diagnostics> {
        let Built { model, .. } = job.build()?;
        Ok(Self {
            driver: Driver::new(model)?,
            failures: job.failures.clone(),
        })
    }
}

#[pymethods]
impl Stepper {
    /// The undeformed state of a job.
    ///
    /// Errors: `InputError`, `ModelError`.
    #[new]
    #[pyo3(signature = (job, threads = None))]
    fn new(py: Python<'_>, job: &Job, threads: Option<u64>) -> PyResult<Self> {
        let inner = supervised(py, |_| pool::with(threads, || Inner::new(job)))?;
        let inner = raised(py, &job.failures, inner)?;
        Ok(Self {
            inner: Mutex::new(inner),
            threads,
        })
    }

    /// Total time.
    #[getter]
    fn time(&self, py: Python<'_>) -> f64 {
        py.detach(|| self.inner().driver.time())
    }

    /// The end of the last step.
    #[getter]
    fn end(&self, py: Python<'_>) -> f64 {
        py.detach(|| self.inner().driver.end())
    }

    /// Whether all steps are done.
    #[getter]
    fn done(&self, py: Python<'_>) -> bool {
        py.detach(|| self.inner().driver.is_done())
    }

    /// The results at the present state.
    #[getter]
    fn frame(&self, py: Python<'_>) -> Frame {
        Frame::new(py.detach(|| kept(&self.inner().driver)))
    }

    /// Goes forward by a time, in one increment or several, and no further than the last step.
    ///
    /// Errors: `NotConverged`, where the state is the last one that converged; `KeyboardInterrupt`; what a function of the
    /// case raises.
    fn advance(&self, py: Python<'_>, dt: f64) -> PyResult<Frame> {
        let advanced = supervised(py, |stop| {
            let mut inner = self.inner();
            let Inner { driver, failures } = &mut *inner;
            let advanced = pool::with(self.threads, || {
                let mut observe =
                    |_: &Event<'_>| match stop.load(Ordering::Relaxed) || failures.any() {
                        true => Flow::Stop,
                        false => Flow::Continue,
                    };
                driver.advance(dt, &mut observe)?;
                Ok(kept(driver))
            });
            (advanced, failures.clone())
        })?;
        let (advanced, failures) = advanced;
        raised(py, &failures, advanced).map(Frame::new)
    }

    /// The state as bytes, to be restored here or in another process.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let state = py.detach(|| self.inner().driver.save());
        let state = state.map_err(|found| exception(py, &found))?;
        Ok(PyBytes::new(py, &state))
    }

    /// Goes back, or forward, to a state.
    ///
    /// Errors: `RestartError` for bytes that are no state of this case; the state is what it was.
    fn restore(&self, py: Python<'_>, state: &[u8]) -> PyResult<()> {
        let restored = supervised(py, |_| {
            let mut inner = self.inner();
            let driver = &mut inner.driver;
            pool::with(self.threads, || driver.restore(state))
        })?;
        restored.map_err(|found| exception(py, &found))
    }

    /// Goes on with a changed case on the same mesh: other loads, materials, contacts.
    ///
    /// Errors: `InputError`, `ModelError`; `RestartError` where the unknowns are not the same.
    fn update(&self, py: Python<'_>, job: &Job) -> PyResult<()> {
        let replaced = supervised(py, |_| {
            let mut inner = self.inner();
            let Inner { driver, failures } = &mut *inner;
            pool::with(self.threads, || {
                let Built { model, .. } = job.build()?;
                driver.replace(model)?;
                *failures = job.failures.clone();
                Ok(())
            })
        })?;
        raised(py, &job.failures, replaced)
    }
}

impl Stepper {
    fn inner(&self) -> MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn kept(driver: &Driver) -> Arc<Kept> {
    Arc::new(Kept {
        values: driver.frame().clone(),
        mesh: Arc::clone(&driver.model().mesh),
    })
}

/// A result, or the exception that a function of the user raised, or the one that faults make.
fn raised<T>(py: Python<'_>, failures: &Failures, result: Result<T, Diagnostics>) -> PyResult<T> {
    if let Some(error) = failures.take() {
        return Err(error);
    }
    result.map_err(|found| exception(py, &found))
}
