//! Sparse matrices of small dense blocks.

use crate::lists::Lists;
use rayon::prelude::*;
use std::ops::Range;

/// Blocks of a factor whose rows are handled by one task; results do not depend on it.
const BLOCKS_PER_TASK: usize = 8192;
/// Rows of a matrix that are projected at once, at least; sums are in this order.
const ROWS_PER_STRIP: usize = 4096;
/// Strips of rows, at most: what comes of each is added to all that came before.
const STRIPS: usize = 12;
/// Stands for no place in a row.
const NOWHERE: u32 = u32::MAX;

/// A matrix of blocks with `R` rows and `C` columns each, compressed by rows, columns sorted.
#[derive(Clone, Debug, Default)]
pub(super) struct Blocks<const R: usize, const C: usize> {
    /// Columns of blocks.
    pub ncolumn: usize,
    /// Where each row of blocks begins.
    pub start: Vec<usize>,
    pub column: Vec<u32>,
    pub value: Vec<[[f64; C]; R]>,
}

/// The columns and the blocks of a row.
type RowMut<'a, const R: usize, const C: usize> = (&'a mut [u32], &'a mut [[[f64; C]; R]]);

impl<const R: usize, const C: usize> Blocks<R, C> {
    /// Rows of blocks.
    pub fn nrow(&self) -> usize {
        self.start.len().saturating_sub(1)
    }

    /// Where the blocks of a row are.
    pub fn range(&self, row: usize) -> Range<usize> {
        self.start[row]..self.start[row + 1]
    }

    /// The blocks of a row with their columns.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, &[[f64; C]; R])> {
        let range = self.range(row);
        let columns = self.column[range.clone()].iter().map(|&c| c as usize);
        columns.zip(&self.value[range])
    }

    /// The blocks of each row where they can be changed, and their columns.
    pub fn rows_mut(&mut self) -> Vec<RowMut<'_, R, C>> {
        let mut rows = Vec::with_capacity(self.nrow());
        let (mut columns, mut values) = (self.column.as_mut_slice(), self.value.as_mut_slice());
        for ends in self.start.windows(2) {
            let (own_columns, other_columns) = columns.split_at_mut(ends[1] - ends[0]);
            let (own_values, other_values) = values.split_at_mut(ends[1] - ends[0]);
            (columns, values) = (other_columns, other_values);
            rows.push((own_columns, own_values));
        }
        rows
    }

    /// The part of a square matrix below its diagonal.
    pub fn below_diagonal(&self) -> Self {
        let below = |row: usize| {
            let range = self.range(row);
            let columns = &self.column[range.clone()];
            range.start..range.start + columns.partition_point(|&c| (c as usize) < row)
        };
        let mut start = vec![0; self.nrow() + 1];
        for row in 0..self.nrow() {
            start[row + 1] = start[row] + below(row).len();
        }
        let nblock = start[self.nrow()];
        let mut part = Self {
            ncolumn: self.ncolumn,
            start,
            column: vec![0; nblock],
            value: vec![[[0.0; C]; R]; nblock],
        };
        let rows = part.rows_mut().into_par_iter().enumerate();
        rows.for_each(|(row, (columns, values))| {
            columns.copy_from_slice(&self.column[below(row)]);
            values.copy_from_slice(&self.value[below(row)]);
        });
        part
    }

    /// The blocks of some rows, column by column: the row, from the first of them on, and the place.
    fn by_column(&self, rows: Range<usize>) -> Lists<(u32, usize)> {
        Lists::new(self.ncolumn, || {
            (0..).zip(rows.clone()).flat_map(|(from, row)| {
                let range = self.range(row);
                let columns = self.column[range.clone()].iter();
                columns
                    .zip(range)
                    .map(move |(&column, at)| (column as usize, (from, at)))
            })
        })
    }

    /// The transpose.
    #[cfg(test)]
    pub fn transpose(&self) -> Blocks<C, R> {
        let blocks = self.by_column(0..self.nrow());
        let all = || (0..self.ncolumn).flat_map(|column| blocks.of(column));
        Blocks {
            ncolumn: self.nrow(),
            start: blocks.start().to_vec(),
            column: all().map(|&(row, _)| row).collect(),
            value: all().map(|&(_, at)| transposed(&self.value[at])).collect(),
        }
    }

    /// The sum with another matrix of the same size.
    pub fn plus(&self, other: &Self) -> Self {
        let nrow = self.nrow();
        let mut sum = Self {
            ncolumn: self.ncolumn,
            start: Vec::with_capacity(nrow + 1),
            // the surplus is never touched, and a sum that grew would be copied
            column: Vec::with_capacity(self.column.len() + other.column.len()),
            value: Vec::with_capacity(self.column.len() + other.column.len()),
        };
        sum.start.push(0);
        for row in 0..nrow {
            let (mut one, mut two) = (self.row(row).peekable(), other.row(row).peekable());
            while let Some(column) = match (one.peek(), two.peek()) {
                (Some(a), Some(b)) => Some(a.0.min(b.0)),
                (a, b) => a.or(b).map(|entry| entry.0),
            } {
                let mut block = [[0.0; C]; R];
                let of_one = one.next_if(|entry| entry.0 == column);
                let of_two = two.next_if(|entry| entry.0 == column);
                for (_, part) in of_one.into_iter().chain(of_two) {
                    let entries = block.as_flattened_mut().iter_mut();
                    entries
                        .zip(part.as_flattened())
                        .for_each(|(to, from)| *to += from);
                }
                sum.column.push(column as u32);
                sum.value.push(block);
            }
            sum.start.push(sum.column.len());
        }
        sum
    }

    /// The product with another matrix. `finish` has the last word on a row, given its number and its columns.
    pub fn times<const D: usize>(
        &self,
        other: &Blocks<C, D>,
        finish: impl Fn(usize, &[u32], &mut [[[f64; D]; R]]) + Sync,
    ) -> Blocks<R, D> {
        self.rows_times(0..self.nrow(), other, finish)
    }

    /// The product of some of its rows with another matrix.
    fn rows_times<const D: usize>(
        &self,
        rows: Range<usize>,
        other: &Blocks<C, D>,
        finish: impl Fn(usize, &[u32], &mut [[[f64; D]; R]]) + Sync,
    ) -> Blocks<R, D> {
        let row_of = |row| self.row(row).map(|(k, block)| (k, *block));
        product(&tasks(&self.start, rows), row_of, other, finish)
    }
}

/// Ranges of rows with about as many blocks each.
fn tasks(start: &[usize], rows: Range<usize>) -> Vec<Range<usize>> {
    let mut tasks = Vec::new();
    let mut begin = rows.start;
    while begin < rows.end {
        let most = start[begin] + BLOCKS_PER_TASK;
        let more = start[begin + 1..=rows.end].partition_point(|&end| end <= most);
        let end = begin + more.max(1);
        tasks.push(begin..end);
        begin = end;
    }
    tasks
}

/// The product of some rows, given by their blocks, with a matrix.
fn product<const R: usize, const C: usize, const D: usize, Row>(
    tasks: &[Range<usize>],
    row_of: impl Fn(usize) -> Row + Sync,
    other: &Blocks<C, D>,
    finish: impl Fn(usize, &[u32], &mut [[[f64; D]; R]]) + Sync,
) -> Blocks<R, D>
where
    Row: Iterator<Item = (usize, [[f64; C]; R])>,
{
    type Part<const R: usize, const D: usize> = (Vec<usize>, Vec<u32>, Vec<[[f64; D]; R]>);
    let work = || (vec![NOWHERE; other.ncolumn], Vec::new(), Vec::new());
    let parts = tasks
        .par_iter()
        .map_init(work, |(place, columns, sums), rows| {
            let (mut length, mut column, mut value) = (Vec::new(), Vec::new(), Vec::new());
            let mut sorted: Vec<(u32, u32)> = Vec::new();
            for row in rows.clone() {
                product_row(row_of(row), other, place, columns, sums);
                // sorted, and the places free again
                sorted.clear();
                for (at, &c) in columns.iter().enumerate() {
                    sorted.push((c, at as u32));
                    place[c as usize] = NOWHERE;
                }
                sorted.sort_unstable();
                let first = column.len();
                for &(c, at) in &sorted {
                    column.push(c);
                    value.push(sums[at as usize]);
                }
                finish(row, &column[first..], &mut value[first..]);
                length.push(sorted.len());
            }
            (length, column, value)
        });
    let parts: Vec<Part<R, D>> = parts.collect();
    let total = parts.iter().map(|part| part.1.len()).sum();
    let mut product = Blocks {
        ncolumn: other.ncolumn,
        start: Vec::with_capacity(tasks.iter().map(Range::len).sum::<usize>() + 1),
        column: vec![0; total],
        value: vec![[[0.0; D]; R]; total],
    };
    let mut end = 0;
    product.start.push(end);
    let (mut columns, mut values) = (&mut product.column[..], &mut product.value[..]);
    let mut places = Vec::with_capacity(parts.len());
    for part in &parts {
        for n in &part.0 {
            end += n;
            product.start.push(end);
        }
        let (own_columns, other_columns) = columns.split_at_mut(part.1.len());
        let (own_values, other_values) = values.split_at_mut(part.1.len());
        (columns, values) = (other_columns, other_values);
        places.push((own_columns, own_values));
    }
    let places = places.into_par_iter().zip(parts);
    places.for_each(|((columns, values), part)| {
        columns.copy_from_slice(&part.1);
        values.copy_from_slice(&part.2);
    });
    product
}

/// One row of a product: its columns in the order they are met, with their sums.
fn product_row<const R: usize, const C: usize, const D: usize>(
    row: impl Iterator<Item = (usize, [[f64; C]; R])>,
    other: &Blocks<C, D>,
    place: &mut [u32],
    columns: &mut Vec<u32>,
    sums: &mut Vec<[[f64; D]; R]>,
) {
    columns.clear();
    sums.clear();
    for (k, a) in row {
        for (column, b) in other.row(k) {
            if place[column] == NOWHERE {
                place[column] = columns.len() as u32;
                columns.push(column as u32);
                sums.push([[0.0; D]; R]);
            }
            let sum = &mut sums[place[column] as usize];
            for (sum, a) in sum.iter_mut().zip(&a) {
                for (a, b) in a.iter().zip(b) {
                    for (sum, b) in sum.iter_mut().zip(b) {
                        *sum += a * b;
                    }
                }
            }
        }
    }
}

impl<const N: usize> Blocks<N, N> {
    /// `Pᵀ A P`, strip by strip of the rows: the product A P is never stored as a whole, for it is larger than A.
    pub fn projected<const D: usize>(&self, onto: &Blocks<N, D>) -> Blocks<D, D> {
        let mut sum: Option<Blocks<D, D>> = None;
        let size = self.nrow().div_ceil(STRIPS).max(ROWS_PER_STRIP);
        for begin in (0..self.nrow()).step_by(size) {
            let strip = begin..self.nrow().min(begin + size);
            let times = self.rows_times(strip.clone(), onto, |_, _, _| {});
            let blocks = onto.by_column(strip);
            let row_of = |column: usize| {
                let blocks = blocks.of(column).iter();
                blocks.map(|&(row, at)| (row as usize, transposed(&onto.value[at])))
            };
            let rows = tasks(blocks.start(), 0..onto.ncolumn);
            let part = product(&rows, row_of, &times, |_, _, _| {});
            sum = Some(match sum {
                Some(sum) => sum.plus(&part),
                None => part,
            });
        }
        sum.unwrap_or_else(|| Blocks {
            ncolumn: onto.ncolumn,
            start: vec![0; onto.ncolumn + 1],
            column: Vec::new(),
            value: Vec::new(),
        })
    }

    /// The block on the diagonal of a row, which every row has.
    pub fn diagonal(&self, row: usize) -> &[[f64; N]; N] {
        let range = self.range(row);
        let columns = &self.column[range.clone()];
        let at = columns.binary_search(&(row as u32)).unwrap_or(0);
        &self.value[range.start + at]
    }
}

fn transposed<const R: usize, const C: usize>(block: &[[f64; C]; R]) -> [[f64; R]; C] {
    std::array::from_fn(|c| std::array::from_fn(|r| block[r][c]))
}

/// `sum += block x`
#[inline]
pub(super) fn add_product<const R: usize, const C: usize>(
    block: &[[f64; C]; R],
    x: &[f64; C],
    sum: &mut [f64; R],
) {
    for (sum, row) in sum.iter_mut().zip(block) {
        for (a, x) in row.iter().zip(x) {
            *sum += *a * *x;
        }
    }
}

/// The inverse of a positive definite block; `None` where it is none to round-off.
pub(super) fn inverse<const N: usize>(block: &[[f64; N]; N]) -> Option<[[f64; N]; N]> {
    // L Lᵀ, then the inverse of L, then L⁻ᵀ L⁻¹
    let mut l = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..=i {
            let known: f64 = (0..j).map(|k| l[i][k] * l[j][k]).sum();
            let left = block[i][j] - known;
            if i != j {
                l[i][j] = left / l[j][j];
            } else if left > f64::EPSILON * block[i][i].abs() && left.is_finite() {
                l[i][i] = left.sqrt();
            } else {
                return None;
            }
        }
    }
    let mut inverse = [[0.0; N]; N];
    for i in 0..N {
        inverse[i][i] = l[i][i].recip();
        let (above, own) = inverse.split_at_mut(i);
        for (j, to) in own[0][..i].iter_mut().enumerate() {
            let sum: f64 = (j..i).map(|k| l[i][k] * above[k][j]).sum();
            *to = -sum / l[i][i];
        }
    }
    Some(std::array::from_fn(|i| {
        std::array::from_fn(|j| (i.max(j)..N).map(|k| inverse[k][i] * inverse[k][j]).sum())
    }))
}
