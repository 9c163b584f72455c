//! Incomplete factorization by blocks, without fill.

use super::blocks::{Blocks, inverse};
use super::packed::Packed;
use super::vectors::{Sums, Task, Vectors, dispatch};
use rayon::prelude::*;
use std::ops::Range;

/// `A ≈ (1 + W) D (1 + W)ᵀ`, with `W` below the diagonal where `A` has blocks.
///
/// Rows come in parts that do not couple, and last those between the parts: parts are worked on in parallel, and the
/// same way for any number of threads.
///
/// Source: Meijerink, van der Vorst, *Math. Comp.* 31 (1977) 148–162; by blocks: Axelsson, *Iterative Solution Methods*
/// 1994, chapter 7.
pub(super) struct Incomplete<const N: usize> {
    parts: Vec<Range<usize>>,
    lower: Packed<N, N, i16>,
    /// Wᵀ, its last row first: memory is read in the order in which it is held.
    upper: Packed<N, N, i16>,
    /// D⁻¹
    inverse: Vec<[[f32; N]; N]>,
}

/// What a factor is worked out with: `L = W D` and `D⁻¹` in full precision.
struct Factor<'a, const N: usize> {
    first: usize,
    lower: &'a mut [[[f64; N]; N]],
    inverse: &'a mut [[[f64; N]; N]],
    /// W_ik = L_ik D_k⁻¹ of the row at hand.
    scaled: Vec<[[f64; N]; N]>,
}

impl<const N: usize> Incomplete<N> {
    /// The factor of a matrix whose diagonal is made larger by this share; `None` where it is not positive.
    ///
    /// `parts` are ranges of rows from the first one on; rows after the last part are worked on one after the other.
    pub fn new(matrix: &Blocks<N, N>, parts: &[Range<usize>], shift: f64) -> Option<Self> {
        let nrow = matrix.nrow();
        let mut lower = matrix.below_diagonal();
        let mut inverse = vec![[[0.0; N]; N]; nrow];
        let held = lower.value.as_mut_slice();
        let mut factors = Vec::with_capacity(parts.len());
        let (mut values, mut inverses, mut row) = (held, inverse.as_mut_slice(), 0);
        for part in parts {
            let (own, rest) = values.split_at_mut(lower.start[part.end] - lower.start[row]);
            let (own_inverses, rest_inverses) = inverses.split_at_mut(part.end - row);
            (values, inverses, row) = (rest, rest_inverses, part.end);
            factors.push((
                part.clone(),
                Factor {
                    first: part.start,
                    lower: own,
                    inverse: own_inverses,
                    scaled: Vec::new(),
                },
            ));
        }
        let (start, column) = (&lower.start, &lower.column);
        let complete = factors.into_par_iter().map(|(rows, mut factor)| {
            rows.clone()
                .try_for_each(|row| factor.eliminate(row, matrix, start, column, shift))
        });
        complete.collect::<Option<Vec<()>>>()?;
        let mut whole = Factor {
            first: 0,
            lower: &mut lower.value,
            inverse: &mut inverse,
            scaled: Vec::new(),
        };
        (row..nrow).try_for_each(|row| whole.eliminate(row, matrix, start, column, shift))?;
        let columns = lower.column.par_iter();
        columns.zip(&mut lower.value).for_each(|(&column, block)| {
            *block = product(block, &inverse[column as usize]);
        });
        let single = |block: &[[f64; N]; N]| block.map(|row| row.map(|v| v as f32));
        Some(Self {
            parts: parts.to_vec(),
            inverse: inverse.iter().map(single).collect(),
            upper: Packed::transposed_upside_down(&lower),
            lower: Packed::new(&lower),
        })
    }

    /// Solves with the factor, in place.
    pub fn solve(&self, x: &mut [[f32; N]]) {
        let last = self.parts.last().map_or(0, |part| part.end);
        let (interior, between) = x.split_at_mut(last);
        let pieces = self.pieces(interior);
        pieces
            .into_par_iter()
            .for_each(|(rows, x)| dispatch(Forward { of: self, rows, x }));
        dispatch(Between {
            of: self,
            last,
            interior,
            between,
        });
        let (pieces, between) = (self.pieces(interior), &*between);
        pieces.into_par_iter().for_each(|(rows, x)| {
            dispatch(Backward {
                of: self,
                rows,
                x,
                last,
                between,
            });
        });
    }

    /// The part of a vector that belongs to each part.
    fn pieces<'v>(&self, mut x: &'v mut [[f32; N]]) -> Vec<(Range<usize>, &'v mut [[f32; N]])> {
        let mut pieces = Vec::with_capacity(self.parts.len());
        for part in &self.parts {
            let (own, rest) = x.split_at_mut(part.len());
            x = rest;
            pieces.push((part.clone(), own));
        }
        pieces
    }

    /// `x −= sum`
    #[inline(always)]
    fn reduce(x: &mut [f32; N], sums: &Sums) {
        for (x, sum) in x.iter_mut().zip(sums) {
            *x -= sum;
        }
    }

    /// `Wᵀ x` of one row.
    #[inline(always)]
    fn above<'x>(
        &self,
        vectors: impl Vectors,
        row: usize,
        x: impl Fn(usize) -> &'x [f32; N],
    ) -> Sums {
        self.upper.row(vectors, self.inverse.len() - 1 - row, x)
    }

    /// `x = D⁻¹ x − sum`
    #[inline(always)]
    fn settle(&self, row: usize, x: &mut [f32; N], sums: &Sums) {
        *x = self.scaled(row, *x);
        Self::reduce(x, sums);
    }

    /// `D⁻¹ x` of a row; the block is symmetric.
    #[inline(always)]
    fn scaled(&self, row: usize, x: [f32; N]) -> [f32; N] {
        let mut scaled = [0.0; N];
        for (column, x) in self.inverse[row].iter().zip(x) {
            for (sum, a) in scaled.iter_mut().zip(column) {
                *sum += a * x;
            }
        }
        scaled
    }
}

/// Forward substitution in one part.
struct Forward<'a, const N: usize> {
    of: &'a Incomplete<N>,
    rows: Range<usize>,
    x: &'a mut [[f32; N]],
}

impl<const N: usize> Task for Forward<'_, N> {
    #[inline(always)]
    fn run<V: Vectors>(self, vectors: V) {
        let Self { of, rows, x } = self;
        let first = rows.start;
        for row in rows {
            let sums = of.lower.row(vectors, row, |column| &x[column - first]);
            Incomplete::reduce(&mut x[row - first], &sums);
        }
    }
}

/// Both substitutions in the rows between the parts.
struct Between<'a, const N: usize> {
    of: &'a Incomplete<N>,
    last: usize,
    interior: &'a [[f32; N]],
    between: &'a mut [[f32; N]],
}

impl<const N: usize> Task for Between<'_, N> {
    #[inline(always)]
    fn run<V: Vectors>(self, vectors: V) {
        let Self {
            of,
            last,
            interior,
            between,
        } = self;
        for row in last..last + between.len() {
            let sums = of
                .lower
                .row(vectors, row, |column| match column.checked_sub(last) {
                    Some(at) => &between[at],
                    None => &interior[column],
                });
            Incomplete::reduce(&mut between[row - last], &sums);
        }
        for row in (last..last + between.len()).rev() {
            let sums = of.above(vectors, row, |column| &between[column - last]);
            of.settle(row, &mut between[row - last], &sums);
        }
    }
}

/// Backward substitution in one part.
struct Backward<'a, const N: usize> {
    of: &'a Incomplete<N>,
    rows: Range<usize>,
    x: &'a mut [[f32; N]],
    last: usize,
    between: &'a [[f32; N]],
}

impl<const N: usize> Task for Backward<'_, N> {
    #[inline(always)]
    fn run<V: Vectors>(self, vectors: V) {
        let Self {
            of,
            rows,
            x,
            last,
            between,
        } = self;
        let first = rows.start;
        for row in rows.rev() {
            let sums = of.above(vectors, row, |column| match column.checked_sub(last) {
                Some(at) => &between[at],
                None => &x[column - first],
            });
            of.settle(row, &mut x[row - first], &sums);
        }
    }
}

impl<const N: usize> Factor<'_, N> {
    /// One row of L and D.
    fn eliminate(
        &mut self,
        row: usize,
        matrix: &Blocks<N, N>,
        start: &[usize],
        column: &[u32],
        shift: f64,
    ) -> Option<()> {
        let offset = start[self.first];
        let (before, own) = self.lower.split_at_mut(start[row] - offset);
        let columns = &column[start[row]..start[row + 1]];
        let mut diagonal = *matrix.diagonal(row);
        for (k, line) in diagonal.iter_mut().enumerate() {
            line[k] *= 1.0 + shift;
        }
        self.scaled.clear();
        for (at, &j) in columns.iter().enumerate() {
            // L_ij −= Σ W_ik L_jkᵀ over what both rows have
            let j = j as usize;
            let of_j = start[j]..start[j + 1];
            let (mut p, mut q) = (0, of_j.start);
            while p < at && q < of_j.end {
                let order = columns[p].cmp(&column[q]);
                if order.is_eq() {
                    subtract_transposed(&self.scaled[p], &before[q - offset], &mut own[at]);
                }
                p += usize::from(order.is_le());
                q += usize::from(order.is_ge());
            }
            let scaled = product(&own[at], &self.inverse[j - self.first]);
            subtract_transposed(&scaled, &own[at], &mut diagonal);
            self.scaled.push(scaled);
        }
        self.inverse[row - self.first] = inverse(&diagonal)?;
        Some(())
    }
}

fn product<const N: usize>(a: &[[f64; N]; N], b: &[[f64; N]; N]) -> [[f64; N]; N] {
    let mut product = [[0.0; N]; N];
    for (row, a) in product.iter_mut().zip(a) {
        for (a, b) in a.iter().zip(b) {
            for (sum, b) in row.iter_mut().zip(b) {
                *sum += a * b;
            }
        }
    }
    product
}

/// `to −= a bᵀ`
fn subtract_transposed<const N: usize>(
    a: &[[f64; N]; N],
    b: &[[f64; N]; N],
    to: &mut [[f64; N]; N],
) {
    for (to, a) in to.iter_mut().zip(a) {
        for (to, b) in to.iter_mut().zip(b) {
            *to -= a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        }
    }
}
