//! An assembled system.

use super::Part;
use super::shares::Share;
use rayon::prelude::*;
use signorini_linear::Values;

/// Entries that are set to zero by one task.
pub(super) const ENTRIES: usize = 1 << 16;

/// The values that one assembly gives.
#[derive(Clone, Debug, Default)]
pub struct Assembly {
    /// r = f_int − f_ext at every raw dof; zero at dependent ones.
    pub residual: Vec<f64>,
    /// Sum of the absolute values of everything that was added to the residual.
    pub magnitude: Vec<f64>,
    /// Sum of the rounding errors that terms know of, beyond that of the magnitude.
    pub uncertainty: Vec<f64>,
    pub(super) bulk: Vec<f64>,
    pub(super) interface: Vec<f64>,
    /// The period of which the bulk is, where it holds for all states in it.
    pub(super) bulk_of: Option<u64>,
}

impl Assembly {
    /// Sets forces, and their uncertainty, to zero.
    pub(super) fn reset_forces(&mut self, ndof: usize) {
        for values in [
            &mut self.residual,
            &mut self.magnitude,
            &mut self.uncertainty,
        ] {
            reset(values, ndof);
        }
    }

    /// The values of the operator.
    #[must_use]
    pub fn values(&self) -> Values<'_> {
        Values {
            bulk: &self.bulk,
            interface: &self.interface,
        }
    }
}

/// What is known of the first tasks.
pub(super) struct Shared {
    /// How many they are.
    pub ntask: usize,
    /// The number of threads that they are shared out for.
    pub nthread: usize,
    pub shares: Vec<Share>,
}

pub(super) struct Task {
    pub term: usize,
    pub chunk: usize,
    pub part: Part,
    /// Whether its elements are known, and none has unknowns that follow others.
    pub is_known: bool,
    // where the blocks of each element of the chunk go, in order; found once
    pub positions: Vec<u32>,
}

pub(super) fn reset(values: &mut Vec<f64>, n: usize) {
    if values.capacity() < n {
        // not touched: threads find the pages of what they add to
        *values = vec![0.0; n];
        return;
    }
    values.resize(n, 0.0);
    values
        .par_chunks_mut(ENTRIES)
        .for_each(|some| some.fill(0.0));
}
