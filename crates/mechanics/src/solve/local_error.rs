//! How long increments of a motion with inertia may be: the local error of displacements, and impacts.
//!
//! ```text
//! e = h² |1/6 + ½ (αf − αm) − β| ‖a₁ − a₀‖        root mean square over the nodes                  (E5)
//! ```
//!
//! estimates what an increment of length `h` adds to the error of displacements. It is accepted where `e` is a part of the largest
//! displacement so far; the next one is twice as long where `e`, of third order, would still be that part with a margin, as sizes that
//! are powers of two apart share a stiffness. While rows of contact close or open an increment is no longer than the time that a wave
//! takes through an element or two: the force of an impact acts at once, and the error of displacements sees it late. Nor is it shorter
//! than a part of that for the sake of the error: what nodes that stop at once lose does not become less by shorter increments, but the
//! force in which they lose it grows without bound.

use super::newton::Failure;
use crate::system::{Choices, Scheme, State, System};

/// What limits increments that adapt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeControl {
    /// What the local error may be, over the largest displacement so far; none: it is not looked at.
    pub tolerance: Option<f64>,
    /// The longest increment in which rows of contact close or open; none: there is no limit.
    pub impact: Option<f64>,
}

/// The local error counts as small up to this part of the size of the model, however small displacements are: where a motion begins
/// smoothly, increments of any length are a large part of it.
const FLOOR: f64 = 1e-5;
/// Where an error `e` is below the tolerance over this, twice the length is safe: (2/0.9)³.
const DOUBLE: f64 = 11.0;
/// The part of the longest increment in an impact that an error does not shorten, as long as the impact lasts.
const SHORTEST: f64 = 1.0 / 3.0;
/// Accepted increments after a rejection, or after rows closed or opened, before longer ones: rejections would else alternate with them.
const CALM: usize = 6;
/// The same for lengths beyond those of an impact while rows are closed.
const CALM_IN_CONTACT: usize = 24;

/// What is known of increments so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Record {
    /// The largest displacement.
    pub largest: f64,
    /// Increments since one was rejected, or rows closed or opened.
    pub calm: usize,
    /// For how many more increments an impact lasts.
    pub impact: usize,
    /// Rows closed at the accepted state.
    pub closed: usize,
    /// Whether the last error would allow an increment twice as long.
    pub is_easy: bool,
}

/// Looks at an increment that has converged.
///
/// # Errors
/// It is too long.
pub(super) fn look(
    control: &TimeControl,
    scheme: &Scheme,
    system: &System,
    [from, to]: [&State; 2],
    extent: f64,
    before: &Record,
) -> Result<Record, Failure> {
    let h = to.time - from.time;
    let closed = system.choices().map(Choices::nactive).sum();
    let mut after = Record {
        largest: before.largest.max(system.largest_displacement(to)),
        calm: before.calm + 1,
        impact: before.impact.saturating_sub(1),
        closed,
        is_easy: true,
    };
    if let Some(tolerance) = control.tolerance {
        let factor = 1.0 / 6.0 + 0.5 * (scheme.alpha_f - scheme.alpha_m) - scheme.beta;
        let change = system.change_of_acceleration(scheme, [from, to]);
        let error = h * h * factor.abs() * change;
        let allowed = tolerance * after.largest.max(FLOOR * extent);
        let in_impact = closed.max(before.closed) > 0 || before.impact > 0;
        let shortest = control.impact.filter(|_| in_impact);
        let is_short = shortest.is_some_and(|longest| h <= SHORTEST * longest);
        if error > allowed && !is_short {
            return Err(Failure::Inaccurate { error, allowed });
        }
        after.is_easy = DOUBLE * error <= allowed;
    }
    if closed != before.closed {
        if let Some(longest) = control.impact.filter(|longest| h > *longest) {
            return Err(Failure::Impact { longest });
        }
        (after.calm, after.impact) = (0, CALM);
    }
    Ok(after)
}

/// The length of the increment after one of this length.
pub(super) fn next(control: &TimeControl, record: &Record, h: f64) -> f64 {
    let twice = 2.0 * h;
    let in_impact = record.closed > 0 && control.impact.is_some_and(|longest| twice > longest);
    let calm = if in_impact { CALM_IN_CONTACT } else { CALM };
    if record.is_easy && record.calm >= calm {
        twice
    } else {
        h
    }
}
