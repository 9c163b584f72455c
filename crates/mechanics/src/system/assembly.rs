//! An assembled system.

use super::shares::Share;
use super::{Order, Part, TermError};
use rayon::prelude::*;
use signorini_linear::Values;
use signorini_linear::sparsity::BlockPattern;

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
    /// What is known of the bulk where its rows are divided.
    pub(super) of_ranks: Option<OfRanks>,
}

/// What every rank needs of a bulk whose rows are divided among them.
#[derive(Clone, Debug, Default)]
pub(super) struct OfRanks {
    /// The entry of each unknown on the diagonal.
    pub diagonal: Vec<f64>,
    /// The size of the largest entry.
    pub largest: f64,
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

    /// Fetches from other ranks the forces at their nodes with their uncertainty, and of a tangent what every rank needs.
    pub(super) fn complete(&mut self, bulk: &BlockPattern, order: Order) -> Result<(), TermError> {
        self.of_ranks = self.of_ranks.take().filter(|_| bulk.partition.is_some());
        let Some(partition) = &bulk.partition else {
            return Ok(());
        };
        let Self {
            residual,
            magnitude,
            uncertainty,
            ..
        } = self;
        let forces = [residual, magnitude, uncertainty];
        let fetched = partition.complete(bulk.block, forces.map(Vec::as_mut_slice));
        fetched.map_err(TermError::Ranks)?;
        if order == Order::Residual {
            return Ok(());
        }
        let ndim = bulk.block;
        let of_ranks = self.of_ranks.get_or_insert_default();
        reset(&mut of_ranks.diagonal, bulk.nrow() * ndim);
        for &node in partition.own() {
            let block = bulk.position(node, node).unwrap_or_default() * ndim * ndim;
            let entries = self.bulk.get(block..).unwrap_or_default();
            let entries = entries.iter().step_by(ndim + 1).take(ndim);
            let places = of_ranks.diagonal.iter_mut().skip(node as usize * ndim);
            places.zip(entries).for_each(|(to, entry)| *to = *entry);
        }
        let fetched = partition.complete(ndim, [&mut of_ranks.diagonal]);
        fetched.map_err(TermError::Ranks)?;
        let own = self.bulk.iter().fold(0.0, |most: f64, k| most.max(k.abs()));
        of_ranks.largest = partition.largest(own).map_err(TermError::Ranks)?;
        Ok(())
    }

    /// The largest entry of the bulk, on whatever rank it is.
    pub(super) fn largest_of_bulk(&self) -> f64 {
        match &self.of_ranks {
            Some(of_ranks) => of_ranks.largest,
            None => self.bulk.iter().fold(0.0, |most: f64, k| most.max(k.abs())),
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
    /// Where rows are divided among ranks: the first rank whose rows a known one touches.
    pub first_rank: usize,
    // where the blocks of each element of the chunk go, in order; found once; of a known one none where it touches no row
    // of this rank
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
