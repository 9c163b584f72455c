//! The page of a folder of results.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use signorini_io::fs::RealFs;
use signorini_report::{PageOptions, page};
use std::path::PathBuf;

/// The page of a folder of results as bytes of UTF-8, compared with another folder where one is named.
///
/// # Errors
/// `ValueError` for a folder that holds no results.
#[pyfunction]
#[pyo3(signature = (folder, compare = None))]
pub fn report(py: Python<'_>, folder: PathBuf, compare: Option<PathBuf>) -> PyResult<Vec<u8>> {
    let options = PageOptions {
        compare,
        ..PageOptions::default()
    };
    let made = py.detach(|| page(&RealFs, &folder, &options));
    made.map_err(|error| PyValueError::new_err(format!("{error}; {}", error.help())))
}
