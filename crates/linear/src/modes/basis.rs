//! Vectors that are orthonormal in the inner product of the mass.

pub(super) use crate::dense::{dot, eigen};
use rayon::prelude::*;

/// Entries that are handled by one task; results do not depend on it.
const ENTRIES: usize = 1 << 12;

/// Vectors of one length.
pub(super) struct Basis {
    pub vectors: Vec<Vec<f64>>,
    /// Vectors for later use.
    spare: Vec<Vec<f64>>,
    length: usize,
    coefficients: Vec<f64>,
}

impl Basis {
    pub fn new(length: usize) -> Self {
        Self {
            vectors: Vec::new(),
            spare: Vec::new(),
            length,
            coefficients: Vec::new(),
        }
    }

    pub fn len(&self) -> usize {
        self.vectors.len()
    }

    /// A vector to write into.
    pub fn blank(&mut self) -> Vec<f64> {
        let spare = self.spare.pop();
        spare.unwrap_or_else(|| vec![0.0; self.length])
    }

    /// Takes a vector back that is not needed.
    pub fn give_back(&mut self, vector: Vec<f64>) {
        self.spare.push(vector);
    }

    /// The products of all vectors with another.
    pub fn products(&mut self, with: &[f64]) -> &[f64] {
        let of_each = self.vectors.par_iter().map(|v| dot(v, with));
        of_each.collect_into_vec(&mut self.coefficients);
        &self.coefficients
    }

    /// Takes the last [`Basis::products`] times the vectors from another.
    pub fn subtract(&self, from: &mut [f64]) {
        let chunks = from.par_chunks_mut(ENTRIES).enumerate();
        chunks.for_each(|(chunk, from)| {
            let range = chunk * ENTRIES..chunk * ENTRIES + from.len();
            for (v, c) in self.vectors.iter().zip(&self.coefficients) {
                let part = v.get(range.clone()).unwrap_or_default();
                from.iter_mut().zip(part).for_each(|(f, v)| *f -= c * v);
            }
        });
    }

    /// The sum of the first vectors times these coefficients.
    pub fn combine(&self, coefficients: &[f64], out: &mut [f64]) {
        let chunks = out.par_chunks_mut(ENTRIES).enumerate();
        chunks.for_each(|(chunk, out)| {
            out.fill(0.0);
            let range = chunk * ENTRIES..chunk * ENTRIES + out.len();
            for (v, c) in self.vectors.iter().zip(coefficients) {
                let part = v.get(range.clone()).unwrap_or_default();
                out.iter_mut().zip(part).for_each(|(o, v)| *o += c * v);
            }
        });
    }
}
