//! Findings and faults of the program as Python objects.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use signorini::run::event_of;
use signorini::{Diagnostic, Diagnostics};
use signorini_io::writers::json::Event;

/// A finding as a dictionary.
fn dictionary<'py>(py: Python<'py>, one: &Diagnostic) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    if let Event::Diagnostic {
        severity,
        code,
        message,
        file,
        line,
        column,
        ..
    } = event_of(one)
    {
        dict.set_item("severity", severity)?;
        dict.set_item("code", code)?;
        dict.set_item("message", message)?;
        dict.set_item("file", file)?;
        dict.set_item("line", line)?;
        dict.set_item("column", column)?;
    }
    dict.set_item("notes", &one.notes)?;
    dict.set_item("help", &one.help)?;
    dict.set_item("text", Diagnostics::from(one.clone()).plain().trim_end())?;
    Ok(dict)
}

/// Findings as a list of dictionaries.
pub fn list<'py>(py: Python<'py>, found: &Diagnostics) -> PyResult<Bound<'py, PyList>> {
    let all = found.iter().map(|one| dictionary(py, one));
    PyList::new(py, all.collect::<PyResult<Vec<_>>>()?)
}

/// The exception for faults that keep a case from being solved, of the class that their exit code asks for.
pub fn exception(py: Python<'_>, found: &Diagnostics) -> PyErr {
    let class = match found.exit_code() {
        Some(4) => "ModelError",
        Some(5) => "NotConverged",
        Some(6) => "OutputError",
        Some(7) => "RestartError",
        _ => "InputError",
    };
    let made = py.import("signorini.errors").and_then(|errors| {
        errors
            .getattr(class)?
            .call_method1("of", (list(py, found)?,))
    });
    match made {
        Ok(exception) => PyErr::from_value(exception),
        Err(error) => error,
    }
}
