//! What the deck says over time: when its steps end, and the values of functions there.

use crate::case::Step;
use crate::diagnostic::{Place, Spanned};
use std::collections::BTreeMap;

/// When steps end.
#[derive(Clone, Debug, Default)]
pub(super) struct Clock {
    /// The time of the deck, and ours, at the end of each step.
    pub ends: Vec<[f64; 2]>,
}

/// The values of functions at the ends of the steps, by their numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct Functions {
    pub values: BTreeMap<u64, Option<Vec<f64>>>,
    /// Those that the case has already.
    pub named: BTreeMap<u64, String>,
}

/// A step in which nothing changes; its name and place are given when it is read.
pub(super) fn empty_step() -> Step {
    Step::of_nothing(Spanned::from("step-1"), Place::nowhere())
}
