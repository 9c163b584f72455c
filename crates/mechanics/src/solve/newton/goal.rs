//! Where Newton's method goes, and what it has reached.

use crate::system::{ByScale, Dof};

/// An increment that converged.
pub(in crate::solve) struct Converged {
    pub iterations: usize,
    pub residual: f64,
    pub q: ByScale,
    /// What the first step from an extrapolated start has shown, for the next increment.
    pub curvature: Option<f64>,
}

/// Where an increment stands: for the records.
#[derive(Clone, Copy)]
pub(in crate::solve) struct Place {
    pub step: usize,
    pub increment: usize,
    pub attempt: usize,
}

/// What an increment is to reach.
pub(in crate::solve) struct Goal<'a> {
    /// Total time at its end.
    pub time: f64,
    /// Values of the prescribed dofs.
    pub targets: &'a [(Dof, f64)],
    /// Expected change of all dofs, from the increments before.
    pub guess: Option<&'a [f64]>,
    /// What the first step from such a start has shown there.
    pub curvature: Option<f64>,
}

/// How an increment starts.
pub(in crate::solve) struct Start {
    /// Whether nodes have to be moved in the first solve.
    pub motion: bool,
    /// How many discrete choices have changed, as terms have said already.
    pub changes: usize,
    /// Whether it is the extrapolation.
    pub extrapolated: bool,
}
