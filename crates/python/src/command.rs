//! The command `signorini`, carried by the package.

use pyo3::prelude::*;

/// Runs the command with these words, the program's name the first; returns the exit code.
///
/// It takes the signals of the process: for the entry point of the command, not for programs.
#[pyfunction]
pub fn main(py: Python<'_>, words: Vec<String>) -> u8 {
    py.detach(|| signorini_cli::main(words))
}
