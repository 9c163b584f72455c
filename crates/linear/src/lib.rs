//! Linear systems: from the operator in two parts to the change of every unknown, with a residual that was measured.
//!
//! ```text
//!   Problem (patterns, equations, signs) ──analyze──▶ order, symbolic factor        once per pattern
//!   Values  (bulk, interface)            ──factorize──▶ numeric factor              once per tangent
//!   right-hand side                      ──solve──▶ x, SolveReport                  residual = |b − A x| / |b|
//! ```
//!
//! A solver never hands back an answer that it has not checked: each solution is put into the operator as it was
//! assembled, in both its parts, and refined or refused. A matrix that is singular to round-off (a body that nothing
//! holds) is an error that names the equation which moves most in the free motion.
//!
//! Multipliers are condensed where they can be ([`Condensed`]): the factor is then one of displacements alone, and L Lᵀ
//! where the whole system is symmetric. What is left is solved as a saddle-point problem, as all of it is by
//! [`LinearKind::Saddle`].
//!
//! One more solver: a file with a struct that implements [`LinearSolver`], and a line in [`SOLVERS`].

mod condensation;
mod direct;
mod error;
mod forecast;
mod lists;
mod matrix;
mod modes;
mod multigrid;
#[cfg(feature = "mumps")]
mod mumps;
mod norm;
mod operator;
mod ordering;
mod partition;
mod problem;
mod residual;
mod solver;
pub mod sparsity;
mod table;
#[cfg(test)]
mod tests;

pub use condensation::Condensed;
pub use direct::{Direct, Factor};
pub use error::LinearError;
pub use forecast::{Forecast, Path};
pub use modes::{Mode, Modes, Wanted, lowest_modes};
pub use multigrid::Multigrid;
#[cfg(feature = "mpi")]
pub use multigrid::Petsc;
#[cfg(feature = "mumps")]
pub use mumps::Mumps;
pub use operator::{apply, apply_absolute};
pub use partition::Partition;
pub use problem::{FieldBlock, Problem, Symmetry, Values};
pub use solver::{EXACT, Iterative, LinearSolver, Note, SolveReport, StartStiffness, Why};
pub use table::{LinearKind, SOLVERS, SolverEntry, choose};
