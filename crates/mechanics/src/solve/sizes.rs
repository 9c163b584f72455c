//! Sizes and number of increments.

use super::stepping::{Increments, Step};

/// Sizes and number of the increments of a step.
pub(super) struct Sizes {
    pub(super) count: usize,
    pub(super) first: f64,
    /// None where an increment that fails is not made smaller.
    pub(super) min: Option<f64>,
    pub(super) max: f64,
}

impl Sizes {
    pub(super) fn of(step: &Step) -> Self {
        match step.increments {
            Increments::Fixed(n) => Self {
                count: n,
                first: step.duration / n as f64,
                min: None,
                max: step.duration / n as f64,
            },
            Increments::Adaptive {
                initial,
                min,
                max,
                count_max,
            } => Self {
                count: count_max,
                first: initial,
                min: Some(min).filter(|m| m.is_finite()),
                max,
            },
        }
    }
}
