//! Sparse matrices of small blocks in single precision, laid out for products with vectors.

use super::blocks::Blocks;
use rayon::prelude::*;
use std::ops::Range;

/// Rows handled by one task; results do not depend on it.
const ROWS_PER_TASK: usize = 1024;
/// Numbers that are worked on together: as many as the rows of a block, or a few more, whose results are dropped.
pub(super) const LANES: usize = 8;
/// As many where blocks have few rows.
const FEW: usize = 4;

/// A matrix of blocks with `R` rows and `C` columns each, compressed by rows of blocks, a block column by column: what a
/// column adds is added to all rows at once.
///
/// # Limits
/// Blocks have at most eight rows.
pub(super) struct Packed<const R: usize, const C: usize> {
    start: Vec<usize>,
    column: Vec<u32>,
    /// The blocks, and what is read beyond the last one.
    value: Vec<f32>,
}

/// The sums of the rows of a block, in their lanes.
pub(super) type Sums = [f32; LANES];

impl<const R: usize, const C: usize> Packed<R, C> {
    /// The same matrix in single precision.
    pub fn new(of: &Blocks<R, C>) -> Self {
        let mut value = vec![0.0; of.value.len() * R * C + LANES];
        let blocks = value.par_chunks_exact_mut((R * C).max(1)).zip(&of.value);
        blocks.for_each(|(to, block)| {
            for (c, to) in to.chunks_exact_mut(R.max(1)).enumerate() {
                for (to, row) in to.iter_mut().zip(block) {
                    *to = row[c] as f32;
                }
            }
        });
        Self {
            start: of.start.clone(),
            column: of.column.clone(),
            value,
        }
    }

    fn range(&self, row: usize) -> Range<usize> {
        self.start[row]..self.start[row + 1]
    }

    /// `sums += A x` of one row of blocks, where `x(column)` is the part of the vector that meets the block.
    #[inline(always)]
    pub fn add_row<'x>(&self, row: usize, sums: &mut Sums, x: impl Fn(usize) -> &'x [f32; C]) {
        let range = self.range(row);
        let values = &self.value[range.start * R * C..range.end * R * C + LANES];
        for (k, &column) in self.column[range].iter().enumerate() {
            let x = x(column as usize);
            if R <= FEW {
                let block = &values[k * R * C..k * R * C + (R * C + FEW - R)];
                add_columns::<R, C, FEW>(block, x, sums);
            } else {
                let block = &values[k * R * C..k * R * C + (R * C + LANES - R)];
                add_columns::<R, C, LANES>(block, x, sums);
            }
        }
    }

    /// `to += A x`, or `to -= A x`.
    pub fn multiply<const SUBTRACT: bool>(&self, x: &[[f32; C]], to: &mut [[f32; R]]) {
        let tasks = to.par_chunks_mut(ROWS_PER_TASK).enumerate();
        tasks.for_each(|(task, to)| {
            for (row, to) in (task * ROWS_PER_TASK..).zip(to) {
                let mut sums = Sums::default();
                self.add_row(row, &mut sums, |column| &x[column]);
                for (to, sum) in to.iter_mut().zip(sums) {
                    *to += if SUBTRACT { -sum } else { sum };
                }
            }
        });
    }
}

/// Adds what the columns of a block make of `x`, `L` rows at once.
#[inline(always)]
fn add_columns<const R: usize, const C: usize, const L: usize>(
    block: &[f32],
    x: &[f32; C],
    sums: &mut Sums,
) {
    for (c, x) in x.iter().enumerate() {
        let column = &block[c * R..c * R + L];
        for (sum, a) in sums[..L].iter_mut().zip(column) {
            *sum += a * x;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Blocks whose entries are all different, in a pattern with an empty row.
    fn matrix<const R: usize, const C: usize>() -> Blocks<R, C> {
        let block = |k: usize| {
            std::array::from_fn(|i| std::array::from_fn(|j| (1 + 100 * k + 10 * i + j) as f64))
        };
        Blocks {
            ncolumn: 3,
            start: vec![0, 2, 2, 3],
            column: vec![0, 2, 1],
            value: (0..3).map(block).collect(),
        }
    }

    fn agrees<const R: usize, const C: usize>() {
        let matrix = matrix::<R, C>();
        let packed = Packed::new(&matrix);
        let x: Vec<[f32; C]> = (0..3)
            .map(|k| std::array::from_fn(|j| (1 + 3 * k + j) as f32))
            .collect();
        let mut to = vec![[0.5; R]; 3];
        packed.multiply::<true>(&x, &mut to);
        for (row, to) in to.iter().enumerate() {
            for (i, to) in to.iter().enumerate() {
                let mut expected = 0.5;
                for (column, block) in matrix.row(row) {
                    let product = block[i].iter().zip(x[column]);
                    expected -= product.map(|(a, x)| a * f64::from(x)).sum::<f64>();
                }
                // whole numbers: nothing is rounded
                assert_eq!(f64::from(*to), expected);
            }
        }
    }

    #[test]
    fn products_are_those_of_the_blocks() {
        agrees::<3, 3>();
        agrees::<3, 6>();
        agrees::<6, 3>();
        agrees::<6, 6>();
    }
}
