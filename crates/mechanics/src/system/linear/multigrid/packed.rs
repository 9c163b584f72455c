//! Sparse matrices of small blocks in single precision, laid out for products with vectors.

use super::blocks::Blocks;
use rayon::prelude::*;
use std::ops::Range;
use wide::{f32x4, f32x8};

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

    /// The transpose of a matrix.
    pub fn transposed(of: &Blocks<C, R>) -> Self {
        Self::transposed_to(of, |row| row)
    }

    /// The transpose of a matrix, its last row first.
    pub fn transposed_upside_down(of: &Blocks<C, R>) -> Self {
        Self::transposed_to(of, |row| of.ncolumn - 1 - row)
    }

    /// The transpose of a matrix with its rows where `place` tells.
    fn transposed_to(of: &Blocks<C, R>, place: impl Fn(usize) -> usize + Sync) -> Self {
        let nrow = of.ncolumn;
        let mut start = vec![0usize; nrow + 1];
        for &column in &of.column {
            start[place(column as usize) + 1] += 1;
        }
        for row in 0..nrow {
            start[row + 1] += start[row];
        }
        let mut column = vec![0; of.column.len()];
        let mut value = vec![0.0; of.value.len() * R * C + LANES];
        // each task looks at all blocks and takes those of its rows
        let ntask = rayon::current_num_threads();
        let ends = (0..=ntask).map(|task| task * nrow / ntask);
        let ends: Vec<usize> = ends.collect();
        let mut tasks = Vec::with_capacity(ntask);
        let (mut columns, mut values) = (column.as_mut_slice(), value.as_mut_slice());
        for ends in ends.windows(2) {
            let nblock = start[ends[1]] - start[ends[0]];
            let (own_columns, other_columns) = columns.split_at_mut(nblock);
            let (own_values, other_values) = values.split_at_mut(nblock * R * C);
            (columns, values) = (other_columns, other_values);
            tasks.push((ends[0]..ends[1], own_columns, own_values));
        }
        tasks.into_par_iter().for_each(|(rows, columns, values)| {
            let first = start[rows.start];
            let mut next: Vec<usize> = start[rows.clone()].iter().map(|at| at - first).collect();
            for from in 0..of.nrow() {
                for (to, block) in of.row(from) {
                    let row = place(to);
                    if !rows.contains(&row) {
                        continue;
                    }
                    let at = next[row - rows.start];
                    next[row - rows.start] += 1;
                    columns[at] = from as u32;
                    let to = &mut values[at * R * C..(at + 1) * R * C];
                    for (to, from) in to.iter_mut().zip(block.as_flattened()) {
                        *to = *from as f32;
                    }
                }
            }
        });
        Self {
            start,
            column,
            value,
        }
    }

    fn range(&self, row: usize) -> Range<usize> {
        self.start[row]..self.start[row + 1]
    }

    /// `A x` of one row of blocks, where `x(column)` is the part of the vector that meets the block. Columns have sums of
    /// their own, which do not wait for one another.
    #[inline(always)]
    pub fn row<'x>(&self, row: usize, x: impl Fn(usize) -> &'x [f32; C]) -> Sums {
        let range = self.range(row);
        let values = &self.value[range.start * R * C..range.end * R * C + LANES];
        let columns = self.column[range].iter().map(|&c| c as usize);
        let blocks = columns.enumerate().map(|(k, column)| {
            // as long as what is read of it
            let block = &values[k * R * C..k * R * C + (C - 1) * R + Self::WIDTH];
            (block, x(column))
        });
        let mut sums = Sums::default();
        if R <= FEW {
            let mut by_column = [f32x4::ZERO; C];
            for (block, x) in blocks {
                for (c, (sum, &x)) in by_column.iter_mut().zip(x).enumerate() {
                    if let Some(&column) = block[c * R..].first_chunk::<FEW>() {
                        *sum += f32x4::new(column) * f32x4::splat(x);
                    }
                }
            }
            let sum = by_column.into_iter().fold(f32x4::ZERO, |sum, c| sum + c);
            sums[..FEW].copy_from_slice(&sum.to_array());
        } else {
            let mut by_column = [f32x8::ZERO; C];
            for (block, x) in blocks {
                for (c, (sum, &x)) in by_column.iter_mut().zip(x).enumerate() {
                    if let Some(&column) = block[c * R..].first_chunk::<LANES>() {
                        *sum += f32x8::new(column) * f32x8::splat(x);
                    }
                }
            }
            let sum = by_column.into_iter().fold(f32x8::ZERO, |sum, c| sum + c);
            sums = sum.to_array();
        }
        sums
    }

    /// Numbers that are read where a column of a block begins.
    const WIDTH: usize = if R <= FEW { FEW } else { LANES };

    /// `to += A x`, or `to -= A x`.
    pub fn multiply<const SUBTRACT: bool>(&self, x: &[[f32; C]], to: &mut [[f32; R]]) {
        let tasks = to.par_chunks_mut(ROWS_PER_TASK).enumerate();
        tasks.for_each(|(task, to)| {
            for (row, to) in (task * ROWS_PER_TASK..).zip(to) {
                let sums = self.row(row, |column| &x[column]);
                for (to, sum) in to.iter_mut().zip(sums) {
                    *to += if SUBTRACT { -sum } else { sum };
                }
            }
        });
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

    /// Aᵀ x, with its rows in their order and upside down.
    fn transposes_agree<const R: usize, const C: usize>() {
        let matrix = matrix::<R, C>();
        let x: Vec<[f32; R]> = (0..3)
            .map(|k| std::array::from_fn(|j| (1 + 3 * k + j) as f32))
            .collect();
        let mut expected = vec![[0.0; C]; 3];
        Packed::new(&matrix.transpose()).multiply::<false>(&x, &mut expected);
        let mut to = vec![[0.0; C]; 3];
        Packed::transposed(&matrix).multiply::<false>(&x, &mut to);
        assert_eq!(to, expected);
        to.fill([0.0; C]);
        Packed::transposed_upside_down(&matrix).multiply::<false>(&x, &mut to);
        to.reverse();
        assert_eq!(to, expected);
    }

    #[test]
    fn transposes_are_those_of_the_blocks() {
        transposes_agree::<3, 3>();
        transposes_agree::<3, 6>();
        transposes_agree::<6, 6>();
    }

    #[test]
    fn products_are_those_of_the_blocks() {
        agrees::<3, 3>();
        agrees::<3, 6>();
        agrees::<6, 3>();
        agrees::<6, 6>();
    }
}
