//! Newton's method, line search, increments: everything that turns a system into accepted states.
//!
//! ```text
//! Stepper: for each step, for each increment            ──▶ Event ──▶ Observer (terminal, files, Python)
//!   Newton: repeat
//!     prepare, assemble  r, K                      all terms
//!     converged?  r small, nothing changed, du small
//!     K du = −r − K du_p                           du_p: prescribed motion of nodes, in the first solve only
//!     line search  u ← u + α du
//!   accept, or cut the increment, or go through it in parts, or in slow motion
//! ```
//!
//! An increment has converged when
//!
//! ```text
//! (a)  max_i |r_i| ≤ max(force_tol · q, 100 eps max_i Σ_e |f_e|_i)
//! (b)  no term changed its mind in the last update (status, facet, stick or slip), or (d')
//! (d)  |du| ≤ 0.01 of the increment's displacement, or r is round-off already
//! (d') what changed is open, closed, stick or slip alone, and |du| ≤ 1e-6 of the increment's displacement
//! ```
//!
//! with `q` the mean of `Σ_e |f_e|_i` over the loaded components, its maximum over the run so far; rotations,
//! multipliers and each field with a scale of its own have means of their own, and such fields corrections of their own in
//! (d) and (d'). Forces are continuous functions of the state where a row opens, closes, sticks or
//! slips: the residual is all that is wrong with a state, whatever its rows are called, and rows at their limit may go to
//! and fro by rounding for ever (d'). They are not where a row goes to another facet. Condition (c), on penetrations, belongs to laws with multipliers and comes
//! through the verdict of their terms. *Iterations* are linear solves.
//!
//! An increment starts from the state extrapolated from the one before, unless that changes more than a few choices of
//! contact, and not only by closing it without friction. Else, and at the start of a step, prescribed motion of nodes
//! enters through the first linear solve, from the last accepted state: moving the nodes first would crush the elements
//! next to them. Rigid bodies are moved at once: they deform nothing.
//!
//! This room knows nothing of solids or contact: all it sees is [`crate::system::Term`].

mod begin;
mod checkpoint;
mod cycles;
mod economy;
mod equations;
mod event;
mod forecast;
mod heat;
mod leap;
mod line_search;
mod local_error;
mod natural;
mod nearby;
mod newton;
mod stabilization;
mod step;
mod stepping;
#[cfg(test)]
mod tests;
mod vibration;
mod work;

pub use equations::LinearSeconds;
pub use event::{Cause, Event, Flow, IncrementRecord, IterationRecord, Observer};
pub use forecast::{Cost, forecast};
pub use local_error::TimeControl;
pub use natural::{NaturalMode, Vibrations};
pub use newton::{Failure, LineSearch, NewtonSettings};
pub use step::{Cycle, Increments, Jump, Motion, Prescription, Step, Vibration};
pub use stepping::{Outcome, RunError, Stepper, StepperSettings};
