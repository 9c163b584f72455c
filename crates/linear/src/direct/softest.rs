//! The softest motion of a stiffness, as exactly as rounding lets it be told from a free one.
//!
//! Where a body is thin, its bending is some `(t/L)²` times softer than its strain, and its factor, which is exact for a
//! matrix nearby, mixes bending into what it finds of a free motion: one vector of inverse iteration does not tell a
//! clamped sheet from a free one. A few vectors span both, and the least energy within their span is that of the softest
//! motion to second order (Rayleigh and Ritz):
//!
//! ```text
//!   X ← orthonormal A⁻¹ X, twice        θ = min of xᵀ A x over x in X        θ / |x|ᵀ|A||x|
//! ```
//!
//! Of a free motion, `θ` is the rounding of sums whose terms are as large as `|x|ᵀ|A||x|`; these cancel over many entries.

use super::gathered::scattered;
use crate::dense::{dot, eigen};
use crate::matrix::Matrix;

/// How many vectors span the softest motions: the six rigid ones of a body, and two that bend it.
const NVECTOR: usize = 8;
/// Steps of inverse iteration.
const STEPS: usize = 2;
/// Below this part of its length, what is left of a vector next to the others is nothing of its own.
const DEPENDENT: f64 = 1e-10;

/// The energy of the softest motion of a definite matrix over the sum of the absolute values in it; nothing where the
/// factor gives no numbers.
pub(super) fn softest(matrix: &Matrix, mut back_substitute: impl FnMut(&mut [f64])) -> Option<f64> {
    let n = matrix.nequation();
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let starts = scattered(n + NVECTOR);
    for k in 0..NVECTOR.min(n) {
        // the same numbers, further on and with other signs
        let start = starts.get(k..n + k)?.iter().enumerate();
        let sign = |e: usize| if (e >> k) & 1 == 0 { 1.0 } else { -1.0 };
        basis.push(start.map(|(e, value)| sign(e) * value).collect());
    }
    for _ in 0..STEPS {
        let mut next: Vec<Vec<f64>> = Vec::with_capacity(basis.len());
        for mut vector in basis {
            back_substitute(&mut vector);
            if orthonormalize(&mut vector, &next)? {
                next.push(vector);
            }
        }
        basis = next;
    }
    let mut product = vec![0.0; n];
    let mut energies: Vec<Vec<f64>> = Vec::with_capacity(basis.len());
    for (k, vector) in basis.iter().enumerate() {
        matrix.multiply(vector, &mut product, |a| a);
        energies.push(basis[..=k].iter().map(|v| dot(v, &product)).collect());
    }
    let pairs = eigen(&energies, basis.len()).ok()?;
    let (_, coefficients) = pairs.first()?;
    let mut motion = vec![0.0; n];
    for (vector, c) in basis.iter().zip(coefficients) {
        motion.iter_mut().zip(vector).for_each(|(m, v)| *m += c * v);
    }
    matrix.multiply(&motion, &mut product, |a| a);
    let energy = dot(&motion, &product);
    matrix.multiply(&motion, &mut product, f64::abs);
    motion.iter_mut().for_each(|m| *m = m.abs());
    let sum = dot(&motion, &product);
    (sum > 0.0 && energy.is_finite()).then(|| energy / sum)
}

/// Makes a vector orthogonal to others and of length 1; false where nothing of it is left.
fn orthonormalize(vector: &mut [f64], others: &[Vec<f64>]) -> Option<bool> {
    let largest = vector.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    if !(largest.is_finite() && largest > 0.0) {
        return None;
    }
    vector.iter_mut().for_each(|v| *v /= largest);
    let before = dot(vector, vector).sqrt();
    for _ in 0..2 {
        for other in others {
            let along = dot(vector, other);
            vector
                .iter_mut()
                .zip(other)
                .for_each(|(v, o)| *v -= along * o);
        }
    }
    let left = dot(vector, vector).sqrt();
    if left <= DEPENDENT * before {
        return Some(false);
    }
    vector.iter_mut().for_each(|v| *v /= left);
    Some(true)
}
