//! `signorini._native`: the Rust side of the Python package.
//!
//! ```text
//! signorini (Python)  ──Job──▶  job ──▶ run, stepper ──▶ frame ──▶ numpy views of Rust memory
//!                                │          ▲
//!                                └── own ───┘   physics in Python, behind the traits of the library
//! ```
//!
//! What users see is in Python, next to this crate; here is what needs Rust: reading, solving, views of arrays. Nothing here
//! panics across the border: PyO3 turns what does into an exception.

mod command;
mod diagnostics;
mod frame;
mod job;
mod mesh;
mod own;
mod pool;
mod report;
mod run;
mod stepper;
mod table;
mod view;
mod vtu;
mod worker;

use pyo3::prelude::*;

#[global_allocator]
static MEMORY: signorini_cli::LargePages = signorini_cli::LargePages;

/// The Rust side of the package.
#[pymodule]
mod _native {
    #[pymodule_export]
    use super::command::main;
    #[pymodule_export]
    use super::frame::{ContactFrame, Frame};
    #[pymodule_export]
    use super::job::{Job, Loaded, check, load, schema};
    #[pymodule_export]
    use super::mesh::Mesh;
    #[pymodule_export]
    use super::report::report;
    #[pymodule_export]
    use super::run::{Outcome, run};
    #[pymodule_export]
    use super::stepper::Stepper;
    #[pymodule_export]
    use super::table::{parse, write};
    #[pymodule_export]
    use super::vtu::read_vtu;

    #[allow(non_upper_case_globals)]
    #[pymodule_export]
    const version: &str = signorini::VERSION;
}
