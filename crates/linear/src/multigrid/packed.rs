//! Sparse matrices of small blocks in single precision or less, laid out for products with vectors.

use super::blocks::Blocks;
use super::vectors::{FEW, LANES, Number, Sums, Task, Vectors, dispatch};
use rayon::prelude::*;
use std::ops::Range;

/// Rows handled by one task; results do not depend on it.
const ROWS_PER_TASK: usize = 1024;

/// A matrix of blocks with `R` rows and `C` columns each, compressed by rows of blocks, a block column by column: what a
/// column adds is added to all rows at once. Its numbers are stored as `T`, with a unit for each row of blocks.
///
/// # Limits
/// Blocks have at most eight rows.
pub(super) struct Packed<const R: usize, const C: usize, T = f32> {
    start: Vec<usize>,
    column: Vec<u32>,
    /// The blocks, with padding behind the last one.
    value: Vec<T>,
    /// The unit of the numbers of each row of blocks.
    unit: Vec<f32>,
    ncolumn: usize,
}

impl<const R: usize, const C: usize, T: Number> Packed<R, C, T> {
    /// The same matrix with such numbers.
    pub fn new(of: &Blocks<R, C>) -> Self {
        let mut value = vec![T::default(); of.value.len() * R * C + LANES];
        let mut unit = vec![1.0; of.nrow()];
        let mut tasks = Vec::with_capacity(of.nrow().div_ceil(ROWS_PER_TASK));
        let mut values = value.as_mut_slice();
        for (task, units) in unit.chunks_mut(ROWS_PER_TASK).enumerate() {
            let first = task * ROWS_PER_TASK;
            let nblock = of.start[first + units.len()] - of.start[first];
            let (own, rest) = values.split_at_mut(nblock * R * C);
            values = rest;
            tasks.push((first, units, own));
        }
        let tasks = tasks.into_par_iter();
        tasks.for_each(|(first, units, mut values)| {
            for (row, unit) in (first..).zip(units) {
                let blocks = &of.value[of.range(row)];
                *unit = T::unit(blocks.iter().map(largest));
                let (own, rest) = values.split_at_mut(blocks.len() * R * C);
                values = rest;
                let columns = blocks
                    .iter()
                    .flat_map(|block| (0..C).map(move |c| (block, c)));
                for ((block, c), to) in columns.zip(own.chunks_exact_mut(R.max(1))) {
                    for (to, line) in to.iter_mut().zip(block) {
                        *to = T::new(line[c] as f32, *unit);
                    }
                }
            }
        });
        Self {
            start: of.start.clone(),
            column: of.column.clone(),
            value,
            unit,
            ncolumn: of.ncolumn,
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

    /// The transpose of a matrix with its rows where `place` says.
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
        let mut value = vec![T::default(); of.value.len() * R * C + LANES];
        let mut unit = vec![0.0f32; nrow];
        // each task looks at all blocks and takes those of its rows
        let ntask = rayon::current_num_threads();
        let ends = (0..=ntask).map(|task| task * nrow / ntask);
        let ends: Vec<usize> = ends.collect();
        let mut tasks = Vec::with_capacity(ntask);
        let (mut columns, mut values) = (column.as_mut_slice(), value.as_mut_slice());
        let mut units = unit.as_mut_slice();
        for ends in ends.windows(2) {
            let nblock = start[ends[1]] - start[ends[0]];
            let (own_columns, other_columns) = columns.split_at_mut(nblock);
            let (own_values, other_values) = values.split_at_mut(nblock * R * C);
            let (own_units, other_units) = units.split_at_mut(ends[1] - ends[0]);
            (columns, values, units) = (other_columns, other_values, other_units);
            tasks.push((ends[0]..ends[1], own_columns, own_values, own_units));
        }
        let tasks = tasks.into_par_iter();
        tasks.for_each(|(rows, columns, values, units)| {
            let blocks = || {
                let all = (0..of.nrow()).flat_map(|from| of.row(from).map(move |at| (from, at)));
                let placed = all.map(|(from, (to, block))| (from, place(to), block));
                let own = placed.filter(|(_, row, _)| rows.contains(row));
                own.map(|(from, row, block)| (from, row - rows.start, block))
            };
            for (_, row, block) in blocks() {
                units[row] = units[row].max(largest(block));
            }
            let of_row = |unit: &mut f32| *unit = T::unit(std::iter::once(*unit));
            units.iter_mut().for_each(of_row);
            let first = start[rows.start];
            let mut next: Vec<usize> = start[rows.clone()].iter().map(|at| at - first).collect();
            for (from, row, block) in blocks() {
                let at = next[row];
                next[row] += 1;
                columns[at] = from as u32;
                let to = &mut values[at * R * C..(at + 1) * R * C];
                for (to, from) in to.iter_mut().zip(block.as_flattened()) {
                    *to = T::new(*from as f32, units[row]);
                }
            }
        });
        Self {
            start,
            column,
            value,
            unit,
            ncolumn: of.nrow(),
        }
    }

    fn range(&self, row: usize) -> Range<usize> {
        self.start[row]..self.start[row + 1]
    }

    /// An entry of the block at this place.
    fn entry(&self, unit: f32, at: usize, i: usize, j: usize) -> f32 {
        self.value[at * R * C + j * R + i].value(unit)
    }

    /// The matrix as it is stored, with nothing in rows that are not wanted.
    pub fn blocks(&self, is_wanted: impl Fn(usize) -> bool) -> Blocks<R, C> {
        let nrow = self.unit.len();
        let mut blocks = Blocks {
            ncolumn: self.ncolumn,
            start: Vec::with_capacity(nrow + 1),
            column: Vec::new(),
            value: Vec::new(),
        };
        blocks.start.push(0);
        for (row, &unit) in self.unit.iter().enumerate() {
            if is_wanted(row) {
                blocks.column.extend(&self.column[self.range(row)]);
                blocks.value.extend(self.range(row).map(|at| {
                    let entry = |i, j| f64::from(self.entry(unit, at, i, j));
                    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
                }));
            }
            blocks.start.push(blocks.column.len());
        }
        blocks
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
        let sums = if R <= FEW {
            let mut by_column = [vectors.four(&[0.0; FEW]); C];
            for (k, &column) in columns.iter().enumerate() {
                // as long as the vector read from it
                let block = &values[k * R * C..k * R * C + (C - 1) * R + FEW];
                let x = x(column as usize);
                for c in 0..C {
                    if let Some(column) = block[c * R..].first_chunk() {
                        let column = T::four(vectors, column);
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
                        let column = T::eight(vectors, column);
                        by_column[c] = vectors.add_eight(column, x[c], by_column[c]);
                    }
                }
            }
            vectors.sum_of_eight(&by_column)
        };
        sums.map(|sum| sum * self.unit[row])
    }

    /// `to += A x`, or `to -= A x`.
    pub fn multiply<const SUBTRACT: bool>(&self, x: &[[f32; C]], to: &mut [[f32; R]]) {
        let tasks = to.par_chunks_mut(ROWS_PER_TASK).enumerate();
        tasks.for_each(|(task, to)| {
            dispatch(Product::<R, C, T, SUBTRACT> {
                of: self,
                first: task * ROWS_PER_TASK,
                x,
                to,
            });
        });
    }
}

impl<const N: usize, T: Number> Packed<N, N, T> {
    /// The diagonal of the block on the diagonal of a row.
    pub fn diagonal(&self, row: usize) -> [f32; N] {
        let range = self.range(row);
        let found = self.column[range.clone()].binary_search(&(row as u32));
        found.map_or([0.0; N], |k| {
            std::array::from_fn(|i| self.entry(self.unit[row], range.start + k, i, i))
        })
    }
}

/// The largest size of the numbers of a block.
fn largest<const R: usize, const C: usize>(block: &[[f64; C]; R]) -> f32 {
    let numbers = block.as_flattened().iter();
    numbers.fold(0.0, |largest: f32, v| largest.max(v.abs() as f32))
}

/// Some rows of a product.
struct Product<'a, const R: usize, const C: usize, T, const SUBTRACT: bool> {
    of: &'a Packed<R, C, T>,
    first: usize,
    x: &'a [[f32; C]],
    to: &'a mut [[f32; R]],
}

impl<const R: usize, const C: usize, T: Number, const SUBTRACT: bool> Task
    for Product<'_, R, C, T, SUBTRACT>
{
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

    fn agrees<const R: usize, const C: usize, T: Number>() {
        let matrix = matrix::<R, C>();
        let packed = Packed::<R, C, T>::new(&matrix);
        let x: Vec<[f32; C]> = (0..3)
            .map(|k| std::array::from_fn(|j| (1 + 3 * k + j) as f32))
            .collect();
        let mut to = vec![[0.5; R]; 3];
        packed.multiply::<true>(&x, &mut to);
        for (row, to) in to.iter().enumerate() {
            for (i, to) in to.iter().enumerate() {
                let (mut expected, mut size) = (0.5, 0.0);
                for (column, block) in matrix.row(row) {
                    let product = block[i].iter().zip(x[column]);
                    expected -= product.map(|(a, x)| a * f64::from(x)).sum::<f64>();
                    size += x[column].iter().map(|x| f64::from(x.abs())).sum::<f64>();
                }
                // half a unit in each entry, and nothing where there are no units: these are whole numbers
                let unit = f64::from(packed.unit[row]);
                let (half, round_off) = if unit == 1.0 { (0.0, 0.0) } else { (0.5, 1e-6) };
                let most = (half * unit * size).mul_add(1.0 + 1e-3, round_off * expected.abs());
                assert!((f64::from(*to) - expected).abs() <= most, "{to} {expected}");
            }
        }
    }

    /// What is stored is what it was made of, to half a unit, and nothing of rows that are not wanted.
    fn is_held<const R: usize, const C: usize, T: Number>() {
        let matrix = matrix::<R, C>();
        let packed = Packed::<R, C, T>::new(&matrix);
        let held = packed.blocks(|row| row == 0);
        assert_eq!((held.nrow(), held.ncolumn), (3, 3));
        assert_eq!(held.column, [0, 2]);
        let pairs = held.value.iter().zip(&matrix.value);
        for (a, b) in pairs.flat_map(|(a, b)| a.as_flattened().iter().zip(b.as_flattened())) {
            assert!((a - b).abs() <= 0.51 * f64::from(packed.unit[0]), "{a} {b}");
        }
    }

    /// Aᵀ x, with its rows in their order and upside down.
    fn transposes_agree<const R: usize, const C: usize, T: Number>() {
        let matrix = matrix::<R, C>();
        let x: Vec<[f32; R]> = (0..3)
            .map(|k| std::array::from_fn(|j| (1 + 3 * k + j) as f32))
            .collect();
        let mut expected = vec![[0.0; C]; 3];
        Packed::<C, R, T>::new(&matrix.transpose()).multiply::<false>(&x, &mut expected);
        let mut to = vec![[0.0; C]; 3];
        Packed::<C, R, T>::transposed(&matrix).multiply::<false>(&x, &mut to);
        assert_eq!(to, expected);
        to.fill([0.0; C]);
        Packed::<C, R, T>::transposed_upside_down(&matrix).multiply::<false>(&x, &mut to);
        to.reverse();
        assert_eq!(to, expected);
    }

    fn all_agree<const R: usize, const C: usize>() {
        agrees::<R, C, f32>();
        agrees::<R, C, i16>();
        is_held::<R, C, f32>();
        is_held::<R, C, i16>();
        transposes_agree::<R, C, f32>();
        transposes_agree::<R, C, i16>();
    }

    #[test]
    fn diagonals_are_found() {
        let packed = Packed::<3, 3>::new(&matrix());
        assert_eq!(packed.diagonal(0), [1.0, 12.0, 23.0]);
        assert_eq!(packed.diagonal(1), [0.0; 3]);
    }

    #[test]
    fn products_and_transposes_are_those_of_the_blocks() {
        all_agree::<3, 3>();
        all_agree::<3, 6>();
        all_agree::<6, 3>();
        all_agree::<6, 6>();
    }
}
