//! Sparse matrices of small blocks in single precision, laid out for products with vectors.

use super::blocks::Blocks;
use super::vectors::{FEW, LANES, Sums, Task, Vectors, dispatch};
use rayon::prelude::*;
use std::ops::Range;

/// Rows handled by one task; results do not depend on it.
const ROWS_PER_TASK: usize = 1024;

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
    pub fn row<'x, V: Vectors>(
        &self,
        vectors: V,
        row: usize,
        x: impl Fn(usize) -> &'x [f32; C],
    ) -> Sums {
        let range = self.range(row);
        let values = &self.value[range.start * R * C..range.end * R * C + LANES];
        let columns = &self.column[range];
        if R <= FEW {
            let mut by_column = [vectors.four(&[0.0; FEW]); C];
            for (k, &column) in columns.iter().enumerate() {
                // as long as what is read of it
                let block = &values[k * R * C..k * R * C + (C - 1) * R + FEW];
                let x = x(column as usize);
                for c in 0..C {
                    if let Some(column) = block[c * R..].first_chunk() {
                        by_column[c] = vectors.add_four(column, x[c], by_column[c]);
                    }
                }
            }
            vectors.sum_of_four(&by_column)
        } else {
            let mut by_column = [vectors.eight(&[0.0; LANES]); C];
            for (k, &column) in columns.iter().enumerate() {
                let block = &values[k * R * C..k * R * C + (C - 1) * R + LANES];
                let x = x(column as usize);
                for c in 0..C {
                    if let Some(column) = block[c * R..].first_chunk() {
                        by_column[c] = vectors.add_eight(column, x[c], by_column[c]);
                    }
                }
            }
            vectors.sum_of_eight(&by_column)
        }
    }

    /// `to += A x`, or `to -= A x`.
    pub fn multiply<const SUBTRACT: bool>(&self, x: &[[f32; C]], to: &mut [[f32; R]]) {
        let tasks = to.par_chunks_mut(ROWS_PER_TASK).enumerate();
        tasks.for_each(|(task, to)| {
            dispatch(Product::<R, C, SUBTRACT> {
                of: self,
                first: task * ROWS_PER_TASK,
                x,
                to,
            });
        });
    }
}

/// Some rows of a product.
struct Product<'a, const R: usize, const C: usize, const SUBTRACT: bool> {
    of: &'a Packed<R, C>,
    first: usize,
    x: &'a [[f32; C]],
    to: &'a mut [[f32; R]],
}

impl<const R: usize, const C: usize, const SUBTRACT: bool> Task for Product<'_, R, C, SUBTRACT> {
    #[inline(always)]
    fn run<V: Vectors>(self, vectors: V) {
        for (row, to) in (self.first..).zip(self.to) {
            let sums = self.of.row(vectors, row, |column| &self.x[column]);
            for (to, sum) in to.iter_mut().zip(sums) {
                *to += if SUBTRACT { -sum } else { sum };
            }
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
