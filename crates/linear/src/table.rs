//! The table of solvers.

use crate::condensation::Condensed;
use crate::direct::Direct;
use crate::multigrid::{MULTIGRID_FROM, Multigrid};
#[cfg(feature = "mumps")]
use crate::mumps::Mumps;
use crate::solver::LinearSolver;

/// Which solver to use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LinearKind {
    /// The one that suits the problem: multigrid in space, from 8,000 equations on, or 1,500 where the matrix is not
    /// definite; the direct one else.
    #[default]
    Auto,
    /// A sparse factorization, with multipliers condensed where they can be.
    Direct,
    /// A sparse factorization with all multipliers.
    Saddle,
    /// Multigrid over the bodies, with a sparse factorization at the interface.
    Multigrid,
    /// That of the library MUMPS.
    #[cfg(feature = "mumps")]
    Mumps,
}

/// A line of the table of solvers.
#[derive(Clone, Copy, Debug)]
pub struct SolverEntry {
    /// Which kind it answers to.
    pub kind: LinearKind,
    /// Its name in a case.
    pub name: &'static str,
    /// Makes one.
    pub build: fn() -> Box<dyn LinearSolver>,
}

/// The table of solvers.
pub const SOLVERS: &[SolverEntry] = &[
    SolverEntry {
        kind: LinearKind::Auto,
        name: "auto",
        build: || Box::new(Multigrid::from_sizes(MULTIGRID_FROM)),
    },
    SolverEntry {
        kind: LinearKind::Direct,
        name: "direct",
        build: || Box::new(Condensed::new(Direct::reproducible)),
    },
    SolverEntry {
        kind: LinearKind::Saddle,
        name: "saddle",
        build: || Box::new(Direct::reproducible()),
    },
    SolverEntry {
        kind: LinearKind::Multigrid,
        name: "multigrid",
        build: || Box::new(Multigrid::new()),
    },
    #[cfg(feature = "mumps")]
    SolverEntry {
        kind: LinearKind::Mumps,
        name: "mumps",
        build: || Box::new(Mumps::new()),
    },
];

/// Makes a solver of the given kind.
pub fn choose(kind: LinearKind) -> Box<dyn LinearSolver> {
    let entry = SOLVERS.iter().find(|entry| entry.kind == kind);
    entry.map_or_else(
        || Box::new(Condensed::new(Direct::reproducible)) as Box<dyn LinearSolver>,
        |entry| (entry.build)(),
    )
}
