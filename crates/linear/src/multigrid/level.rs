//! One level of a hierarchy: its matrix, its smoother, and the way to the next coarser one.

use super::aggregation::{Aggregates, MODES};
use super::blocks::{Blocks, add_product, inverse};
use super::incomplete::Incomplete;
use super::packed::Packed;
use super::springs::{self, Rows, Springs};
use rayon::prelude::*;
use std::ops::Range;

/// Shares by which diagonals are made larger until an incomplete factor exists.
const SHIFTS: [f64; 3] = [0.01, 0.04, 0.16];
/// Rows of a vector handled by one task.
const CHUNK: usize = 4096;
/// Steps of the power method.
const STEPS: usize = 10;
/// The power method's value is below the largest one by about this factor.
const SAFETY: f64 = 1.1;
/// The largest eigenvalue of the smoothed operator above which the smoother is damped.
const DAMPED_ABOVE: f64 = 1.7;

/// A level of a hierarchy with blocks of `N`, above one with blocks of `M`.
pub(super) struct Level<const N: usize, const M: usize = MODES> {
    matrix: Packed<N, N>,
    smoother: Incomplete<N>,
    damping: f32,
    /// From the next level, and to it.
    prolong: Packed<N, M, i16>,
    restrict: Packed<M, N, i16>,
    residual: Vec<[f32; N]>,
    change: Vec<[f32; N]>,
    springs: Option<Springs<N>>,
}

/// The next level: its matrix and the modes there.
pub(super) type Coarser = (Blocks<MODES, MODES>, Vec<[[f64; MODES]; MODES]>);

impl<const N: usize> Level<N> {
    /// A level, and the matrix of the next one; `None` where the matrix is not positive definite.
    ///
    /// Prolongation is smoothed once by Jacobi's method with blocks, `P = (1 − 4/(3λ) D⁻¹ A) T`.
    pub fn new(
        matrix: &Blocks<N, N>,
        modes: &[[[f64; MODES]; N]],
        parts: &[Range<usize>],
    ) -> Option<(Self, Coarser)> {
        // each has something that one thread does alone
        let (smoother, way) = rayon::join(|| smoother(matrix, parts), || way_down(matrix, modes));
        let Way {
            single,
            prolong,
            coarser,
        } = way?;
        Some((Self::with(single, smoother?, &prolong), coarser))
    }
}

/// What a level has besides its smoother.
struct Way<const N: usize> {
    single: Packed<N, N>,
    prolong: Blocks<N, MODES>,
    coarser: Coarser,
}

/// The way to the next level; `None` where a block on the diagonal is not positive definite.
fn way_down<const N: usize>(matrix: &Blocks<N, N>, modes: &[[[f64; MODES]; N]]) -> Option<Way<N>> {
    let ((motions, coarse_modes), of_jacobi) = rayon::join(
        || Aggregates::new(matrix).motions(modes),
        || {
            let single: Packed<N, N> = Packed::new(matrix);
            let rows = (0..matrix.nrow()).into_par_iter();
            let inverses = rows.map(|row| inverse(matrix.diagonal(row)));
            let inverses = inverses.collect::<Option<Vec<[[f64; N]; N]>>>()?;
            let largest = largest(&single, matrix.nrow(), |r| {
                r.par_iter_mut().zip(&inverses).for_each(|(r, inverse)| {
                    let right = r.map(f64::from);
                    let mut product = [0.0; N];
                    add_product(inverse, &right, &mut product);
                    *r = product.map(|v| v as f32);
                });
            });
            Some((single, inverses, SAFETY * largest))
        },
    );
    let (single, inverses, largest) = of_jacobi?;
    let weight = 4.0 / (3.0 * largest);
    let prolong = matrix.times(&motions, |row, columns, blocks| {
        let own = (motions.column[row], &motions.value[row]);
        smooth(own, &inverses[row], weight, columns, blocks);
    });
    let mut coarse = matrix.projected(&prolong);
    settle(&mut coarse);
    Some(Way {
        single,
        prolong,
        coarser: (coarse, coarse_modes),
    })
}

impl<const N: usize, const M: usize> Level<N, M> {
    /// A level above one that is reached by `prolong`, and the matrix of that; `None` where the matrix is not positive
    /// definite.
    pub fn above(
        matrix: &Blocks<N, N>,
        prolong: &Blocks<N, M>,
        parts: &[Range<usize>],
    ) -> Option<(Self, Blocks<M, M>)> {
        let (smoother, (single, coarse)) = rayon::join(
            || smoother(matrix, parts),
            || (Packed::new(matrix), matrix.projected(prolong)),
        );
        Some((Self::with(single, smoother?, prolong), coarse))
    }

    fn with(matrix: Packed<N, N>, smoother: Incomplete<N>, prolong: &Blocks<N, M>) -> Self {
        let nrow = prolong.nrow();
        let (to_fine, to_coarse) =
            rayon::join(|| Packed::new(prolong), || Packed::transposed(prolong));
        let mut level = Self {
            matrix,
            smoother,
            damping: 1.0,
            prolong: to_fine,
            restrict: to_coarse,
            residual: vec![[0.0; N]; nrow],
            change: vec![[0.0; N]; nrow],
            springs: None,
        };
        level.damp();
        level
    }

    /// Damps the smoother where it overshoots.
    fn damp(&mut self) {
        let (matrix, smoother) = (&self.matrix, &self.smoother);
        let value = SAFETY * largest(matrix, self.residual.len(), |r| smoother.solve(r));
        self.damping = (DAMPED_ABOVE / value).min(1.0) as f32;
    }

    /// Whether it has springs.
    pub const fn is_held(&self) -> bool {
        self.springs.is_some()
    }

    /// Takes springs with these rows, or none; returns those of the next level.
    pub fn hold(&mut self, rows: Option<Rows<N>>) -> Option<Rows<M>> {
        self.springs = None;
        let mut rows = rows?;
        springs::limit(&mut rows, |row| self.matrix.diagonal(row));
        self.springs = Some(Springs::new(&rows));
        Some(springs::projected(&rows, &self.prolong))
    }

    /// `x = V b`: smooths, lets `coarse` turn the coarse residual into the coarse solution, and smooths again.
    pub fn cycle(
        &mut self,
        b: &[[f32; N]],
        x: &mut [[f32; N]],
        coarse_b: &mut [[f32; M]],
        coarse_x: &mut [[f32; M]],
        coarse: impl FnOnce(&[[f32; M]], &mut [[f32; M]]),
    ) {
        let damping = self.damping;
        let both = x
            .par_chunks_mut(CHUNK)
            .zip(self.residual.par_chunks_mut(CHUNK));
        both.zip(b.par_chunks(CHUNK)).for_each(|((x, r), b)| {
            r.copy_from_slice(b);
            for (x, b) in x.iter_mut().zip(b) {
                *x = b.map(|b| damping * b);
            }
        });
        self.smoother.solve(x);
        self.matrix.multiply::<true>(x, &mut self.residual);
        if let Some(springs) = &mut self.springs {
            springs.subtract(x, &mut self.residual);
        }
        coarse_b.fill([0.0; M]);
        self.restrict.multiply::<false>(&self.residual, coarse_b);
        coarse(coarse_b, coarse_x);
        self.prolong.multiply::<false>(coarse_x, x);
        let chunks = self.change.par_chunks_mut(CHUNK).zip(b.par_chunks(CHUNK));
        chunks.for_each(|(change, b)| change.copy_from_slice(b));
        self.matrix.multiply::<true>(x, &mut self.change);
        if let Some(springs) = &mut self.springs {
            springs.subtract(x, &mut self.change);
        }
        self.smoother.solve(&mut self.change);
        let chunks = x.par_chunks_mut(CHUNK).zip(self.change.par_chunks(CHUNK));
        chunks.for_each(|(x, change)| {
            for (x, change) in x.as_flattened_mut().iter_mut().zip(change.as_flattened()) {
                *x += damping * change;
            }
        });
    }
}

/// The smoother of a matrix; `None` where that is not positive definite.
fn smoother<const N: usize>(
    matrix: &Blocks<N, N>,
    parts: &[Range<usize>],
) -> Option<Incomplete<N>> {
    let mut shifts = SHIFTS.iter();
    shifts.find_map(|&shift| Incomplete::new(matrix, parts, shift))
}

/// A row of `P = T − weight D⁻¹ (A T)` from that of A T; T has one block in it.
fn smooth<const N: usize>(
    (own, motion): (u32, &[[f64; MODES]; N]),
    inverse: &[[f64; N]; N],
    weight: f64,
    columns: &[u32],
    blocks: &mut [[[f64; MODES]; N]],
) {
    for (&column, block) in columns.iter().zip(blocks) {
        let right = *block;
        *block = if column == own {
            *motion
        } else {
            [[0.0; MODES]; N]
        };
        for (to, inverse) in block.iter_mut().zip(inverse) {
            for (a, right) in inverse.iter().zip(&right) {
                for (to, b) in to.iter_mut().zip(right) {
                    *to -= weight * a * b;
                }
            }
        }
    }
}

/// Gives motions that are none a stiffness, so that they stay zero.
fn settle(matrix: &mut Blocks<MODES, MODES>) {
    for row in 0..matrix.nrow() {
        let range = matrix.range(row);
        let Ok(at) = matrix.column[range.clone()].binary_search(&(row as u32)) else {
            continue;
        };
        let block = &mut matrix.value[range.start + at];
        let largest = (0..MODES).fold(0.0f64, |m, k| m.max(block[k][k]));
        for (k, line) in block.iter_mut().enumerate() {
            if line[k] <= NOTHING * largest {
                line[k] = if largest > 0.0 { largest } else { 1.0 };
            }
        }
    }
}

/// A stiffness that is nothing compared with the largest of its aggregate.
const NOTHING: f64 = 1e-14;

/// The largest eigenvalue of `M⁻¹ A`, from below.
fn largest<const N: usize>(
    matrix: &Packed<N, N>,
    nrow: usize,
    mut precondition: impl FnMut(&mut [[f32; N]]),
) -> f64 {
    // the same numbers in every run, of all wave lengths
    let mut state = 1u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1u32 << 24) as f32 - 0.5
    };
    let mut x: Vec<[f32; N]> = (0..nrow).map(|_| std::array::from_fn(|_| next())).collect();
    let mut y = vec![[0.0; N]; nrow];
    let norm = |v: &[[f32; N]]| -> f64 {
        let squares = |v: &[[f32; N]]| -> f64 {
            let squares = v
                .as_flattened()
                .iter()
                .map(|&v| f64::from(v) * f64::from(v));
            squares.sum()
        };
        let parts: Vec<f64> = v.par_chunks(CHUNK).map(squares).collect();
        parts.iter().sum::<f64>().sqrt()
    };
    let mut value = 1.0;
    for _ in 0..STEPS {
        y.fill([0.0; N]);
        matrix.multiply::<false>(&x, &mut y);
        precondition(&mut y);
        value = (norm(&y) / norm(&x).max(f64::MIN_POSITIVE)).max(f64::MIN_POSITIVE);
        let scale = value.recip() as f32;
        let chunks = x.par_chunks_mut(CHUNK).zip(y.par_chunks(CHUNK));
        chunks.for_each(|(x, y)| {
            for (x, y) in x.as_flattened_mut().iter_mut().zip(y.as_flattened()) {
                *x = *y * scale;
            }
        });
    }
    value
}
