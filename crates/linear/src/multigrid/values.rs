//! Values of operators: in chunks on all threads, by their fingerprint, and how stiff nodes are.

use crate::problem::{Kept, Values};
use rayon::prelude::*;

/// How stiff each node is: the mean of the diagonal of its own block in the bulk.
#[derive(Clone, Copy)]
pub(super) enum Means<'a> {
    /// From rows that are all here.
    Here(&'a Kept, &'a Values<'a>),
    /// As a list.
    #[cfg(feature = "mpi")]
    Known(&'a [f64]),
}

impl Means<'_> {
    /// That of a node; 0 where it has no row.
    pub fn of(self, node: usize) -> f64 {
        match self {
            Self::Here(kept, values) => {
                let at = kept.bulk.position(node as u32, node as u32);
                let block = at.and_then(|at| values.bulk.get(9 * at..9 * at + 9));
                block.map_or(0.0, |b| (b[0] + b[4] + b[8]) / 3.0)
            }
            #[cfg(feature = "mpi")]
            Self::Known(means) => means.get(node).copied().unwrap_or(0.0),
        }
    }
}

/// Entries handled by one task.
pub(super) const CHUNK: usize = 8192;

/// Sets all entries of a vector, in parallel.
pub(super) fn fill<T: Send, U: Sync>(to: &mut [T], from: &[U], value: impl Fn(&U) -> T + Sync) {
    let chunks = to.par_chunks_mut(CHUNK).zip(from.par_chunks(CHUNK));
    chunks.for_each(|(to, from)| {
        for (to, from) in to.iter_mut().zip(from) {
            *to = value(from);
        }
    });
}

/// A number that two lists of values share where they are the same, bit by bit, and hardly otherwise.
pub(super) fn fingerprint(values: &[f64]) -> u64 {
    const CHUNK: usize = 1 << 16;
    const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;
    let mix = |sum: u64, bits: u64| (sum.rotate_left(23) ^ bits).wrapping_mul(FACTOR);
    let chunks = values.par_chunks(CHUNK);
    let of_chunk = |chunk: &[f64]| chunk.iter().fold(FACTOR, |sum, v| mix(sum, v.to_bits()));
    let sums: Vec<u64> = chunks.map(of_chunk).collect();
    sums.into_iter().fold(values.len() as u64, mix)
}
