//! What a solver can do, and what it reports.

use crate::error::LinearError;
use crate::problem::{Problem, Values};
use signorini_ranks::Ranks;
use std::any::Any;

/// What a solution is worth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolveReport {
    /// The true relative residual |b − A x| / |b| in the largest entry; 0 for b = 0.
    pub residual: f64,
    /// Applications of the factor or preconditioner.
    pub iterations: usize,
    /// How many of them were refinements.
    pub refinements: usize,
    /// Negative pivots of the factor, one per multiplier in a stable state; 0 where pivots have no sign (LU).
    pub negative_pivots: usize,
}

impl SolveReport {
    /// The same after iterations that led nowhere.
    pub(crate) const fn after(mut self, lost: usize) -> Self {
        self.iterations += lost;
        self
    }
}

/// The stiffness of the bodies at the start of a run.
#[derive(Clone, Debug)]
pub enum StartStiffness {
    /// It is that of all states.
    Always,
    /// It is that of the next values.
    Next,
    /// These values of the bulk.
    Values(Vec<f64>),
}

/// A way to solve linear systems; see the room's page for the order of calls.
pub trait LinearSolver: Send {
    /// Takes note of the pattern. Cheap where the problem is the same as in the last call.
    ///
    /// # Errors
    /// `Shape` and `Range` for parts that do not fit together, `TooLarge`.
    fn analyze(&mut self, problem: &Problem) -> Result<(), LinearError>;

    /// Takes the values of a tangent.
    ///
    /// # Errors
    /// `Singular`, `NotFinite`, `TooLarge`, `Shape`, and `Order` before `analyze`.
    fn factorize(&mut self, values: &Values) -> Result<(), LinearError>;

    /// Solves `A x = rhs` until the true relative residual is at most `rtol`, or at the round-off of the operator.
    ///
    /// The values may be newer than those of the factor, which then serves as a preconditioner for a few refinements.
    ///
    /// # Shapes
    /// `rhs` and `x` have one entry per equation.
    ///
    /// # Errors
    /// `Inaccurate` where the residual stays above, `NotFinite`, `Shape`, and `Order` before `factorize`. `x` then
    /// holds nothing of use.
    fn solve(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        rtol: f64,
    ) -> Result<SolveReport, LinearError>;

    /// Forgets what it has learned from other patterns and values, except its factor and its
    /// [experience](Iterative::experience): from now on it does what it would do had it just been given the pattern. A run
    /// that is resumed here repeats every bit.
    fn forget(&mut self) {}

    /// The solver as an iterative one, if it is.
    fn iterative(&self) -> Option<&dyn Iterative>;

    /// The same, to be used.
    fn iterative_mut(&mut self) -> Option<&mut dyn Iterative>;
}

/// A solver that does less work where less accuracy is asked for, and keeps a preconditioner from one tangent to the next.
pub trait Iterative {
    /// Whether it iterates on the present problem. False while a direct solver takes its place.
    fn iterates(&self) -> bool;

    /// Solves until about this part of the error is left, in a norm of the solver's own: enough for a step of Newton's
    /// method that will not be the last. It need not go on where no entry of the residual is larger than `enough`, but for
    /// equations of multipliers. Where a direct solver takes its place, the solution is as exact as that makes it.
    ///
    /// # Errors
    /// Those of [`LinearSolver::solve`].
    fn solve_to(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        part: f64,
        enough: f64,
    ) -> Result<SolveReport, LinearError>;

    /// The ranks among which it takes the rows of the bulk divided; none: it takes all of them.
    fn ranks(&self) -> Option<&'static dyn Ranks>;

    /// Whether it asks for the initial stiffness of the bodies with this id before the next values.
    fn wants_start(&self, id: u64) -> bool;

    /// Receives that stiffness: of the bodies undeformed and without history.
    fn start_from(&mut self, id: u64, bulk: StartStiffness);

    /// What it has learned that stays when it forgets; a number for [`Iterative::recall`].
    fn experience(&self) -> u8;

    /// Takes over what a solver had learned in the run that is resumed.
    fn recall(&mut self, experience: u8);

    /// Gives away what depends on the problem and its values alone, not on what was solved before: for a solver that goes
    /// on in its place as if it were new.
    fn bequeath(&mut self) -> Option<Box<dyn Any + Send>>;

    /// Takes over what a solver of the same type has given away. What comes from another type is dropped.
    fn inherit(&mut self, heritage: Box<dyn Any + Send>);

    /// What the solver has decided since the last call.
    fn notes(&mut self) -> Vec<Note>;
}

/// What a solver has decided for itself.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Note {
    /// Multigrid has made a hierarchy.
    #[error("multigrid: {levels} levels over {unknowns} unknowns{}",
        .worn.map(|[now, before]| format!(
            ", made anew: {now:.1} iterations to a power of ten were {before:.1} when the last one was new"
        )).unwrap_or_default())]
    Hierarchy {
        /// Unknowns of the finest level.
        unknowns: usize,
        /// Levels, the last of which is solved directly.
        levels: usize,
        /// Iterations to a power of ten with the one before, at last and at first, where it was worn.
        worn: Option<[f64; 2]>,
    },
    /// A factor of the stiffness of the bodies takes the place of their hierarchy until the run ends.
    #[error(
        "the stiffness of the bodies is factorized in place of multigrid, {numbers} numbers: {why}"
    )]
    Factor {
        /// Numbers in the factor.
        numbers: usize,
        /// Why.
        why: Why,
    },
    /// Multigrid over several ranks ends for the increment: each solves by itself.
    #[error("multigrid over ranks gives way to the solver of one process, on every rank: {why}")]
    Alone {
        /// Why.
        why: Why,
    },
    /// The direct solver takes over until the increment ends.
    #[error("multigrid gives way to the direct solver: {why}")]
    Direct {
        /// Why.
        why: Why,
    },
}

/// Why multigrid does not serve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Why {
    /// The stiffness of the bodies has no incomplete factor, even with more on its diagonal: it is not positive definite, or that
    /// of nearly incompressible bodies.
    #[error(
        "the stiffness of the bodies has no incomplete factor, as of nearly incompressible ones"
    )]
    NotPositive,
    /// The equations of the interface have no solution of their own.
    #[error("the equations around the interface are singular by themselves")]
    Interface,
    /// Too many iterations.
    #[error("{iterations} iterations did not suffice")]
    Slow {
        /// How many were made.
        iterations: usize,
    },
    /// Conjugate gradients met a direction without stiffness.
    #[error("the tangent is not positive definite")]
    Indefinite,
}

/// A relative residual far below what Newton's tail needs.
pub const EXACT: f64 = 1e-10;
