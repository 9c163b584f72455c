//! Physics in Python: surfaces, laws, limits of friction, materials and courses, behind the traits of the library.

use pyo3::prelude::*;
use std::sync::{Arc, Mutex, PoisonError};

/// The first exception that a function of the user raised: a run that it spoils stops, and raises it.
#[derive(Clone, Default)]
pub struct Failures {
    first: Arc<Mutex<Option<PyErr>>>,
}

impl Failures {
    /// Keeps an exception, unless there is one.
    pub fn put(&self, error: PyErr) {
        let mut first = self.first.lock().unwrap_or_else(PoisonError::into_inner);
        first.get_or_insert(error);
    }

    /// Whether there is one.
    pub fn any(&self) -> bool {
        let first = self.first.lock().unwrap_or_else(PoisonError::into_inner);
        first.is_some()
    }

    /// Takes the exception.
    pub fn take(&self) -> Option<PyErr> {
        let mut first = self.first.lock().unwrap_or_else(PoisonError::into_inner);
        first.take()
    }
}
