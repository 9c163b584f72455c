//! Inner products, and small symmetric eigenproblems.

use crate::error::LinearError;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::{Mat, Par};

/// Where one is shorter, the rest of the other counts for nothing.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
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
pub(crate) fn eigen(matrix: &[Vec<f64>], n: usize) -> Result<Vec<(f64, Vec<f64>)>, LinearError> {
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
