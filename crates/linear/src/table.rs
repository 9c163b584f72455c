//! The table of solvers.

use crate::condensation::Condensed;
use crate::direct::Direct;
#[cfg(feature = "mpi")]
use crate::multigrid::Petsc;
use crate::multigrid::{MULTIGRID_FROM, Multigrid};
#[cfg(feature = "mumps")]
use crate::mumps::Mumps;
use crate::solver::LinearSolver;

/// Which solver to use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LinearKind {
    /// The one that suits the problem: multigrid in space, from 8,000 equations on, or 1,500 where the matrix is not
    /// definite; the direct one else. Where several ranks compute together, that of PETSc.
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
    /// Multigrid of the library PETSc, over the ranks of MPI.
    #[cfg(feature = "mpi")]
    Petsc,
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
///
/// # Example
/// ```
/// use signorini_linear::sparsity::{BlockPattern, NONE, Pattern};
/// use signorini_linear::{Problem, SOLVERS, Symmetry, Values};
///
/// // four springs in a row, k = 2, held at node 0
/// let bulk = BlockPattern::from_cliques(5, 1, &[0, 1, 1, 2, 2, 3, 3, 4], &[0, 2, 4, 6, 8]);
/// let interface = Pattern::empty(5);
/// let mut stiffness = vec![0.0; bulk.nvalue()];
/// for spring in 0..4 {
///     for (row, column, k) in [(0, 0, 2.0), (0, 1, -2.0), (1, 0, -2.0), (1, 1, 2.0)] {
///         let at = bulk.position(spring + row, spring + column).ok_or("not in the pattern")?;
///         stiffness[at] += k;
///     }
/// }
/// let values = Values { bulk: &stiffness, interface: &[] };
/// let problem = Problem {
///     ndof: 5,
///     bulk: &bulk,
///     interface: &interface,
///     fields: &[],
///     equation: &[NONE, 0, 1, 2, 3],
///     nequation: 4,
///     symmetry: Symmetry::Definite,
///     sign: &[1; 4],
///     coordinates: &[[0.0; 3]; 5],
///     between: &[],
/// };
///
/// // every solver measures its residual, and finds the same end displacement F n/k
/// for entry in SOLVERS {
///     let mut solver = (entry.build)();
///     solver.analyze(&problem)?;
///     solver.factorize(&values)?;
///     let mut x = [0.0; 4];
///     let report = solver.solve(&values, &[0.0, 0.0, 0.0, 1.0], &mut x, 1e-10)?;
///     assert!(report.residual <= 1e-10, "{}", entry.name);
///     assert!((x[3] - 2.0).abs() < 1e-9, "{}", entry.name);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub const SOLVERS: &[SolverEntry] = &[
    SolverEntry {
        kind: LinearKind::Auto,
        name: "auto",
        build: automatic,
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
    #[cfg(feature = "mpi")]
    SolverEntry {
        kind: LinearKind::Petsc,
        name: "petsc",
        build: || Box::new(Petsc::new()),
    },
];

/// The solver that chooses for itself.
fn automatic() -> Box<dyn LinearSolver> {
    #[cfg(feature = "mpi")]
    if signorini_ranks::together().size() > 1 {
        return Box::new(Petsc::new());
    }
    Box::new(Multigrid::from_sizes(MULTIGRID_FROM))
}

/// Makes a solver of the given kind.
pub fn choose(kind: LinearKind) -> Box<dyn LinearSolver> {
    let entry = SOLVERS.iter().find(|entry| entry.kind == kind);
    entry.map_or_else(
        || Box::new(Condensed::new(Direct::reproducible)) as Box<dyn LinearSolver>,
        |entry| (entry.build)(),
    )
}
