//! What happens in a run, as one stream: the terminal, the files and Python are all fed from it.

use super::Failure;
use super::natural::Vibrations;
use crate::system::{Dof, Frame};
use signorini_linear::Note;

/// One linear solve.
#[derive(Clone, Debug, PartialEq)]
pub struct IterationRecord {
    /// Number of the step, from 0.
    pub step: usize,
    /// Increment within the step, from 1.
    pub increment: usize,
    /// Attempt at this increment, from 1.
    pub attempt: usize,
    /// Iteration, from 1; one more than the number of solves at the check that ends an increment.
    pub iteration: usize,
    /// Largest residual before this solve, over the mean force q.
    pub residual: f64,
    /// The dof where it is.
    pub worst: Option<Dof>,
    /// Largest change of a displacement by the solve before; 0 before the first.
    pub correction: f64,
    /// Energy norm of the residual that the solve before removed, `√|du·r|`; 0 before the first.
    pub decrement: f64,
    /// Iterations of the linear solver in the solve before; 0 before the first.
    pub linear_iterations: usize,
    /// The multiple of the Newton step taken by the solve before; 1 before the first.
    pub line_search: f64,
    /// Rows that act: closed contacts.
    pub closed: usize,
    /// Discrete choices that changed since the iterate before.
    pub flips: usize,
}

/// One accepted increment.
#[derive(Clone, Debug, PartialEq)]
pub struct IncrementRecord {
    /// Number of the step, from 0.
    pub step: usize,
    /// Increment within the step, from 1.
    pub increment: usize,
    /// Attempts it took.
    pub attempts: usize,
    /// Linear solves of the successful attempt.
    pub iterations: usize,
    /// Total time at its end.
    pub time: f64,
    /// Time since the step began, and the step's duration.
    pub step_time: (f64, f64),
    /// Its size.
    pub dt: f64,
    /// Largest residual at its end, over the mean force q.
    pub residual: f64,
    /// Work of viscous forces in it.
    pub work_stabilization: f64,
    /// Work of supports and loads in it.
    pub work_external: f64,
}

/// Why something was given up: a failure and what it was about.
#[derive(Clone, Debug)]
pub struct Cause {
    /// What failed.
    pub failure: Failure,
    /// Size of the increment that failed.
    pub dt: f64,
}

/// Something that happened.
#[derive(Debug)]
#[non_exhaustive]
pub enum Event<'a> {
    /// A step begins.
    Step {
        /// Its number, from 0.
        step: usize,
        /// Its name.
        name: &'a str,
    },
    /// The state was assembled and judged.
    Iteration(&'a IterationRecord),
    /// An increment failed and is tried again: in smaller pieces, or from another start where `next` is the same size.
    Cutback {
        /// Number of the step, from 0.
        step: usize,
        /// Increment within the step, from 1.
        increment: usize,
        /// Attempt that failed, from 1.
        attempt: usize,
        /// Why.
        cause: &'a Cause,
        /// The size tried next.
        next: f64,
    },
    /// The increment was gone through in parts: there was an equilibrium nearby, without a jump.
    Followed {
        /// Number of the step, from 0.
        step: usize,
        /// Increment within the step, from 1.
        increment: usize,
        /// Attempt that succeeded, from 1.
        attempt: usize,
        /// Parts that it took.
        parts: usize,
    },
    /// There was no equilibrium nearby: the increment was taken in slow motion, with viscous forces.
    Stabilized {
        /// Number of the step, from 0.
        step: usize,
        /// Increment within the step, from 1.
        increment: usize,
        /// Attempt that succeeded, from 1.
        attempt: usize,
        /// Stages that it took.
        stages: usize,
        /// Work of the viscous forces.
        work: f64,
        /// Work that supports and loads have done since the start of the run.
        external: f64,
    },
    /// Motions that nothing resists and no load acts on were held, in the first increment of a step.
    Held {
        /// Number of the step, from 0.
        step: usize,
        /// Where: a dof for each motion.
        dofs: &'a [Dof],
    },
    /// The linear solver has decided something for itself.
    Solver {
        /// Number of the step, from 0.
        step: usize,
        /// Increment within the step, from 1.
        increment: usize,
        /// What.
        note: &'a Note,
    },
    /// An explicit step begins.
    Explicit {
        /// Its number, from 0.
        step: usize,
        /// The longest of its short increments.
        longest: f64,
        /// Mass that was added, over that of all that has some.
        added: f64,
    },
    /// An explicit increment is on its way.
    Leap {
        /// Number of the step, from 0.
        step: usize,
        /// Increment within the step, from 1.
        increment: usize,
        /// Short increments so far.
        count: usize,
        /// The part of the increment that they have gone through.
        part: f64,
    },
    /// Natural modes were found, or tried to be.
    Vibrations {
        /// Number of the step, from 0.
        step: usize,
        /// The total time of the state about which they are.
        time: f64,
        /// They.
        found: &'a Vibrations,
    },
    /// An increment was accepted.
    Increment {
        /// Its record.
        record: &'a IncrementRecord,
        /// Its results.
        frame: &'a Frame,
    },
}

/// Whether to go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// Go on.
    Continue,
    /// Stop: before the next iteration of an increment that has not converged, which is then repeated by who goes on. An
    /// explicit increment ends where it is, and who goes on takes the rest of it.
    Stop,
}

/// Receives the events of a run. Asked after every event whether to go on.
pub trait Observer {
    /// Something happened.
    fn notice(&mut self, event: &Event<'_>) -> Flow;
}

impl<F: FnMut(&Event<'_>) -> Flow> Observer for F {
    fn notice(&mut self, event: &Event<'_>) -> Flow {
        self(event)
    }
}
