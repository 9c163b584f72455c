//! The verification set: problems with known answers, run on the machine of the user and judged.
//!
//! ```text
//! Problem ──pose──▶ Setup: Grid + case + Checks ──solve──▶ Solved: values ──▶ Judged: rows ──▶ table, JSON, HTML, manual
//! ```
//!
//! A problem makes its mesh in memory, and computes its reference from the closed form wherever there is one. It runs through
//! the same door as a case of a user: text in, `[[expect]]` out. A value counts only where the run converged, its audit doubts
//! nothing and the value is a finite number.
//!
//! To add a problem: a function that returns its [`Setup`] and an entry in a list of [`set`], with source, goal, mesh,
//! conditions and formula; a tolerance says why it is what it is.

mod forms;
mod mesh;
mod problem;
pub mod report;
pub mod set;
mod solve;

pub use mesh::Grid;
pub use problem::{Ask, Check, Expectations, Kind, Problem, Setup, Tolerance};
pub use set::problems;
pub use solve::{Frames, Judged, Row, Solved, exit_code, solve, solve_all, solve_as};
