//! The command `signorini`, carried by the package.

use pyo3::prelude::*;

/// Runs the command with these arguments, the program's name not among them; returns the exit code.
///
/// It takes the signals of the process: for the entry point of the command, not for programs.
#[pyfunction]
pub fn main(py: Python<'_>, arguments: Vec<String>) -> u8 {
    let line = std::iter::once("signorini".to_owned()).chain(arguments);
    py.detach(|| signorini_cli::main(line))
}
