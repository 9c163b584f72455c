//! Vectors that are orthonormal in the inner product of the mass, and small symmetric eigenproblems.

use crate::error::LinearError;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::{Mat, Par};
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

/// Where one is shorter, the rest of the other counts for nothing.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len().min(b.len());
    let [a, b] = [a, b].map(|values| values.get(..n).unwrap_or_default());
    // several at a time, which do not wait for one another
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    let mut sums = [0.0f64; 8];
    for (a, b) in a.iter().zip(b) {
        for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
            *sum += a * b;
        }
    }
    let rest = a_rest.iter().zip(b_rest).map(|(a, b)| a * b);
    sums.iter().sum::<f64>() + rest.sum::<f64>()
}

/// Eigenvalues of the leading part of a symmetric matrix, ascending, and its eigenvectors one after the other.
///
/// # Errors
/// `NotFinite`.
pub(super) fn eigen(matrix: &[Vec<f64>], n: usize) -> Result<Vec<(f64, Vec<f64>)>, LinearError> {
    let entry = |i: usize, j: usize| {
        let row = matrix.get(i.max(j));
        row.and_then(|row| row.get(i.min(j)))
            .copied()
            .unwrap_or_default()
    };
    let a = Mat::<f64>::from_fn(n, n, entry);
    let mut vectors = Mat::<f64>::zeros(n, n);
    let mut values = faer::diag::Diag::<f64>::zeros(n);
    let scratch =
        self_adjoint_evd_scratch::<f64>(n, ComputeEigenvectors::Yes, Par::Seq, Default::default());
    let mut memory = MemBuffer::new(scratch);
    self_adjoint_evd(
        a.as_ref(),
        values.as_mut(),
        Some(vectors.as_mut()),
        Par::Seq,
        MemStack::new(&mut memory),
        Default::default(),
    )
    .map_err(|_| LinearError::NotFinite)?;
    let pair = |k: usize| {
        let column = (0..n).map(|i| vectors[(i, k)]).collect();
        (values.column_vector()[k], column)
    };
    let mut pairs: Vec<(f64, Vec<f64>)> = (0..n).map(pair).collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(pairs)
}
