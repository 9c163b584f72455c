//! Why an increment did not converge.

use crate::system::{Dof, NodeId, TermError};
use signorini_linear::LinearError;
use thiserror::Error;

/// Why an increment did not converge.
#[derive(Clone, Debug, Error)]
pub enum Failure {
    /// Too many iterations.
    #[error(
        "{iterations} iterations did not suffice: the largest force error is {residual:.3e} of the mean force"
    )]
    TooManyIterations {
        /// Linear solves done.
        iterations: usize,
        /// Largest residual over the mean force.
        residual: f64,
        /// The dof where it is.
        worst: Option<Dof>,
        /// The residual there, a force.
        force: f64,
        /// What kept changing: the last verdict that was not settled, and its nodes.
        unsettled: Option<(String, Vec<NodeId>)>,
    },
    /// A force is infinite or not a number.
    #[error("a force is not a finite number after {iterations} iterations")]
    NotFinite {
        /// Linear solves done.
        iterations: usize,
        /// The dof where it acts.
        dof: Option<Dof>,
    },
    /// An observer asked to stop before it had converged.
    #[error("the run was asked to stop after {iterations} iterations of an increment")]
    Interrupted {
        /// Linear solves done.
        iterations: usize,
    },
    /// The local error of an increment is too large, of a motion with inertia.
    #[error("the local error of displacements is {error:.2e}, where {allowed:.2e} is allowed")]
    Inaccurate {
        /// The error (length).
        error: f64,
        /// What the case allows.
        allowed: f64,
    },
    /// Rows of contact close or open in an increment that is too long for an impact.
    #[error("contact closes or opens in an increment longer than {longest:.2e}")]
    Impact {
        /// The longest increment (time).
        longest: f64,
    },
    /// A term could not be evaluated.
    #[error(transparent)]
    Term(#[from] TermError),
    /// Rounding errors of a stiffness hide that of the bodies next to it.
    #[error("a stiffness is so large that rounding errors hide the others")]
    TooStiff {
        /// The dof with the largest.
        dof: Option<Dof>,
    },
    /// The linear system could not be solved.
    #[error("{source}")]
    Linear {
        /// Why.
        source: LinearError,
        /// The unknown that the solver names, or else the one with the largest stiffness.
        dof: Option<Dof>,
    },
}

impl Failure {
    /// Whether something moves freely.
    pub(super) const fn is_singular(&self) -> bool {
        matches!(
            self,
            Self::Linear {
                source: LinearError::Singular { .. },
                ..
            }
        )
    }
}
