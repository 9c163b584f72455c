//! The operator over equations: bulk and interface added up in one compressed matrix, equilibrated.
//!
//! Column e holds *row* e of the operator A. That is the matrix itself where it is symmetric (then only entries at or
//! below the diagonal are kept), and its transpose where it is not. Gathering therefore reads the operator row by row:
//! every place is written by one task, in a fixed order.
//!
//! ```text
//!   raw row d = (node, i)   ──equation[d]──▶   column e of the matrix
//!        bulk value k       ──bulk_place[k]──▶      its place, or NONE (prescribed, or above the diagonal)
//!   interface value k       ──interface_place[k]──▶ its place
//! ```
//!
//! Equilibration makes every row's largest entry about 1, by powers of two, which cost no accuracy (D. Ruiz, A scaling
//! algorithm to equilibrate both rows and columns norms in matrices, RAL-TR-2001-034). Pivots can then be judged by
//! their size.

use crate::error::LinearError;
use crate::problem::{Kept, Problem, Symmetry, Values};
use crate::sparsity::{BlockPattern, NONE, Pattern};
use rayon::prelude::*;
use std::ops::Range;

/// Entries that are worth a task; results do not depend on it.
const ENTRIES_PER_TASK: usize = 50_000;
/// Rows that are worth a task.
const ROWS_PER_TASK: usize = 1000;
/// How often scales are improved.
const SWEEPS: usize = 3;

pub(crate) struct Matrix {
    /// Where each column begins.
    pub start: Vec<u32>,
    /// The row of each entry, sorted; the diagonal is always there, first where the matrix is symmetric.
    pub row: Vec<u32>,
    /// The equilibrated values.
    pub value: Vec<f64>,
    /// The scale of each equation: value = row_scale * A * column_scale.
    pub row_scale: Vec<f64>,
    /// The scale of each unknown.
    pub column_scale: Vec<f64>,
    /// Whether only one half is kept.
    pub symmetric: bool,
    dof_start: Vec<u32>,
    dof: Vec<u32>,
    bulk_place: Vec<u32>,
    interface_place: Vec<u32>,
    row_max: Vec<f64>,
    column_max: Vec<f64>,
}

impl Matrix {
    pub fn new(problem: &Problem) -> Result<Self, LinearError> {
        let Problem {
            bulk,
            interface,
            equation,
            nequation,
            ..
        } = *problem;
        let symmetric = problem.symmetry != Symmetry::Unsymmetric;
        let block = bulk.block;

        // the raw dofs of each equation, by counting
        let mut dof_start = vec![0u32; nequation + 1];
        for &e in equation.iter().filter(|&&e| e != NONE) {
            dof_start[e as usize + 1] += 1;
        }
        for e in 0..nequation {
            dof_start[e + 1] += dof_start[e];
        }
        let mut next = dof_start.clone();
        let mut dof = vec![0u32; dof_start[nequation] as usize];
        for (d, &e) in equation.iter().enumerate().filter(|&(_, &e)| e != NONE) {
            dof[next[e as usize] as usize] = d as u32;
            next[e as usize] += 1;
        }

        let places = Places {
            values: ByRow { bulk, interface },
            equation,
            nequation,
            symmetric,
        };
        let count = parts(bulk.nvalue() + interface.nentry());
        let part = |k: usize| k * nequation / count..(k + 1) * nequation / count;
        let found = (0..count).into_par_iter().map(|k| {
            let of_equation = |e: usize| &dof[dof_start[e] as usize..dof_start[e + 1] as usize];
            places.rows(part(k), of_equation)
        });
        let found: Vec<(Vec<u32>, Vec<usize>)> = found.collect();
        let nentry = found.iter().map(|(row, _)| row.len()).sum();
        if nentry >= NONE as usize / 2 {
            return Err(LinearError::TooLarge { nequation, nentry });
        }
        let mut start = Vec::with_capacity(nequation + 1);
        let mut row: Vec<u32> = Vec::with_capacity(nentry);
        start.push(0);
        for (rows, ends) in found {
            let first = row.len();
            start.extend(ends.into_iter().map(|end| (first + end) as u32));
            row.extend(rows);
        }
        let mut bulk_place = vec![NONE; bulk.nvalue()];
        let mut interface_place = vec![NONE; interface.nentry()];
        let (mut of_bulk, mut of_interface) = (&mut bulk_place[..], &mut interface_place[..]);
        let mut ends = [0; 2];
        let mut tasks = Vec::with_capacity(count);
        for k in 0..count {
            let nodes = k * bulk.nrow() / count..(k + 1) * bulk.nrow() / count;
            let last = if k + 1 < count {
                nodes.end * block
            } else {
                equation.len()
            };
            let dofs = nodes.start * block..last;
            let to = [
                bulk.row_start[nodes.end] * block * block,
                interface.row_start[last.min(interface.nrow)],
            ];
            let own = (
                of_bulk.split_off_mut(..to[0] - ends[0]).unwrap_or_default(),
                of_interface
                    .split_off_mut(..to[1] - ends[1])
                    .unwrap_or_default(),
            );
            tasks.push((dofs, ends, own));
            ends = to;
        }
        tasks
            .into_par_iter()
            .for_each(|(dofs, first, (of_bulk, of_interface))| {
                places.find(dofs, [&start, &row], first, of_bulk, of_interface);
            });
        Ok(Self {
            value: vec![0.0; row.len()],
            row_scale: vec![1.0; nequation],
            column_scale: vec![1.0; nequation],
            start,
            row,
            symmetric,
            dof_start,
            dof,
            bulk_place,
            interface_place,
            row_max: vec![0.0; nequation],
            column_max: vec![0.0; nequation],
        })
    }

    pub fn nequation(&self) -> usize {
        self.row_scale.len()
    }

    /// The rows of the entries of one column.
    pub fn column(&self, column: usize) -> &[u32] {
        &self.row[self.range(column)]
    }

    /// The values of the entries of one column.
    pub fn values(&self, column: usize) -> &[f64] {
        &self.value[self.range(column)]
    }

    pub fn range(&self, column: usize) -> Range<usize> {
        self.start[column] as usize..self.start[column + 1] as usize
    }

    /// The place of the diagonal entry.
    pub fn diagonal(&self, column: usize) -> usize {
        let range = self.range(column);
        let first = range.start;
        if self.symmetric {
            first
        } else {
            first + self.row[range].partition_point(|&row| (row as usize) < column)
        }
    }

    /// Adds `shift` to the diagonal.
    pub fn shift(&mut self, shift: f64) {
        if shift != 0.0 {
            for e in 0..self.nequation() {
                let at = self.diagonal(e);
                self.value[at] += shift;
            }
        }
    }

    /// Adds up bulk and interface and equilibrates, from the scales of the values before on.
    ///
    /// # Errors
    /// `NotFinite`, and `Singular` with the equation where a row is zero.
    pub fn gather(&mut self, problem: &Kept, values: &Values) -> Result<(), LinearError> {
        let (bulk, interface) = (&problem.bulk, &problem.interface);
        let (by_row, block) = (ByRow { bulk, interface }, bulk.block);
        let (dof_start, dof) = (&self.dof_start, &self.dof);
        let (bulk_place, interface_place) = (&self.bulk_place, &self.interface_place);
        let add_up = |e: usize, first: usize, out: &mut [f64]| {
            out.fill(0.0);
            let mut add = |place: u32, a: f64| {
                if place != NONE {
                    out[place as usize - first] += a;
                }
            };
            for &d in &dof[dof_start[e] as usize..dof_start[e + 1] as usize] {
                for (_, at) in by_row.blocks(d as usize) {
                    for (&place, &a) in bulk_place[at..at + block]
                        .iter()
                        .zip(&values.bulk[at..at + block])
                    {
                        add(place, a);
                    }
                }
                let entries = by_row.entries(d as usize);
                let places = &interface_place[entries.clone()];
                for (&place, &a) in places.iter().zip(&values.interface[entries]) {
                    add(place, a);
                }
            }
            out.iter().all(|a| a.is_finite())
        };
        let shares = shares(&self.start, &mut self.value, &mut self.row_max);
        let (start, row) = (&self.start, &self.row);
        let (row_scale, column_scale) = (&self.row_scale, &self.column_scale);
        let measured = shares.into_par_iter().map(|share| {
            let mut column_max = vec![0.0; column_scale.len()];
            let mut is_finite = true;
            for (e, range, own, row_max) in share.each(start) {
                is_finite &= add_up(e, range.start, own);
                let entries = row[range].iter().zip(&*own);
                *row_max = largest(entries, row_scale[e], column_scale, &mut column_max);
            }
            is_finite.then_some(column_max)
        });
        let measured: Option<Vec<Vec<f64>>> = measured.collect();
        let measured = measured.ok_or(LinearError::NotFinite)?;
        self.take_measures(&measured);
        self.equilibrate()
    }

    /// Scales until every row and column, measured with the present scales, has its largest entry near 1, then applies
    /// the scales.
    fn equilibrate(&mut self) -> Result<(), LinearError> {
        let mut pairs = self.row_max.iter().zip(&self.column_max);
        let zero = pairs.position(|(&row, &column)| row == 0.0 || column == 0.0);
        if zero.is_some() {
            return Err(LinearError::Singular { equation: zero });
        }
        for sweep in 0..SWEEPS {
            let within = |max: &[f64]| max.iter().all(|&m| (0.25..4.0).contains(&m));
            if within(&self.row_max) && within(&self.column_max) {
                break;
            }
            for (scale, &max) in self.row_scale.iter_mut().zip(&self.row_max) {
                *scale *= power_of_two(max);
            }
            for (scale, &max) in self.column_scale.iter_mut().zip(&self.column_max) {
                *scale *= power_of_two(max);
            }
            if sweep + 1 < SWEEPS {
                self.measure();
            }
        }
        let shares = shares(&self.start, &mut self.value, &mut self.row_max);
        let (start, row) = (&self.start, &self.row);
        let (row_scale, column_scale) = (&self.row_scale, &self.column_scale);
        let is_finite = shares.into_par_iter().map(|share| {
            let mut is_finite = true;
            for (e, range, own, _) in share.each(start) {
                for (&f, a) in row[range].iter().zip(own) {
                    *a *= row_scale[e] * column_scale[f as usize];
                    is_finite &= a.is_finite();
                }
            }
            is_finite
        });
        if !is_finite.reduce(|| true, |a, b| a && b) {
            // such scales are no start for other values
            self.forget_scales();
            return Err(LinearError::NotFinite);
        }
        Ok(())
    }

    /// Lets the next values be equilibrated as if they were the first.
    pub fn forget_scales(&mut self) {
        self.row_scale.fill(1.0);
        self.column_scale.fill(1.0);
    }

    /// Finds the largest scaled entry of each row and column. An entry of column e at row f is A[e, f] of the operator.
    fn measure(&mut self) {
        let shares = shares(&self.start, &mut self.value, &mut self.row_max);
        let (start, row) = (&self.start, &self.row);
        let (row_scale, column_scale) = (&self.row_scale, &self.column_scale);
        let measured = shares.into_par_iter().map(|share| {
            let mut column_max = vec![0.0; column_scale.len()];
            for (e, range, own, row_max) in share.each(start) {
                let entries = row[range].iter().zip(&*own);
                *row_max = largest(entries, row_scale[e], column_scale, &mut column_max);
            }
            column_max
        });
        let measured: Vec<Vec<f64>> = measured.collect();
        self.take_measures(&measured);
    }

    /// Takes what each share has measured of all columns.
    fn take_measures(&mut self, measured: &[Vec<f64>]) {
        self.column_max.fill(0.0);
        for share in measured {
            let pairs = self.column_max.iter_mut().zip(share);
            pairs.for_each(|(most, size)| *most = most.max(*size));
        }
        if self.symmetric {
            for (row, column) in self.row_max.iter_mut().zip(&mut self.column_max) {
                *row = row.max(*column);
                *column = *row;
            }
        }
    }

    /// The equilibrated operator times a vector; with `of` the absolute value, the sum of absolute values.
    pub fn multiply(&self, x: &[f64], y: &mut [f64], of: impl Fn(f64) -> f64 + Sync) {
        let entries = |e: usize| {
            let range = self.range(e);
            self.row[range.clone()].iter().zip(&self.value[range])
        };
        if !self.symmetric {
            // column e holds row e
            let dot = |e: usize| entries(e).map(|(&f, &a)| of(a * x[f as usize])).sum();
            let each = y.par_iter_mut().enumerate().with_min_len(ROWS_PER_TASK);
            return each.for_each(|(e, y)| *y = dot(e));
        }
        y.fill(0.0);
        for e in 0..x.len() {
            for (&f, &a) in entries(e) {
                let f = f as usize;
                y[e] += of(a * x[f]);
                if f != e {
                    y[f] += of(a * x[e]);
                }
            }
        }
    }
}

/// Into how many parts as many values are divided: one for each thread, unless there are few.
fn parts(nvalue: usize) -> usize {
    (nvalue / ENTRIES_PER_TASK).clamp(1, rayon::current_num_threads())
}

/// The values of a problem, row by row.
#[derive(Clone, Copy)]
struct ByRow<'a> {
    bulk: &'a BlockPattern,
    interface: &'a Pattern,
}

impl<'a> ByRow<'a> {
    /// The columns of the blocks in the row of a raw dof, and where the values of that row begin in each.
    fn blocks(self, dof: usize) -> impl Iterator<Item = (usize, usize)> + use<'a> {
        let Self { bulk, .. } = self;
        let (node, i) = (dof / bulk.block, dof % bulk.block);
        let blocks = match node < bulk.nrow() {
            true => bulk.row_start[node]..bulk.row_start[node + 1],
            false => 0..0,
        };
        blocks.map(move |k| (bulk.column[k] as usize, (k * bulk.block + i) * bulk.block))
    }

    /// Where the values of the interface are in the row of a raw dof.
    fn entries(self, dof: usize) -> Range<usize> {
        match dof < self.interface.nrow {
            true => self.interface.row_start[dof]..self.interface.row_start[dof + 1],
            false => 0..0,
        }
    }
}

/// Where the values of a problem go.
struct Places<'a> {
    values: ByRow<'a>,
    equation: &'a [u32],
    nequation: usize,
    symmetric: bool,
}

impl Places<'_> {
    /// Whether the entry of column `e` at this row is kept.
    fn keeps(&self, e: u32, other: u32) -> bool {
        other != NONE && !(self.symmetric && other < e)
    }

    /// The equations of the columns of a block.
    fn of_block(&self, column: usize) -> &[u32] {
        let block = self.values.bulk.block;
        &self.equation[column * block..][..block]
    }

    /// The equation of the column of an entry of the interface.
    fn of_entry(&self, at: usize) -> u32 {
        self.equation[self.values.interface.column[at] as usize]
    }

    /// The rows of columns, sorted, and where each column ends; `dofs` are the raw dofs of an equation.
    fn rows<'d>(
        &self,
        columns: Range<usize>,
        dofs: impl Fn(usize) -> &'d [u32],
    ) -> (Vec<u32>, Vec<usize>) {
        let (mut row, mut ends) = (Vec::new(), Vec::with_capacity(columns.len()));
        // the last column that met a row
        let mut seen = vec![NONE; self.nequation];
        for e in columns {
            let begin = row.len();
            let mut meet = |other: u32| {
                if self.keeps(e as u32, other) && seen[other as usize] != e as u32 {
                    seen[other as usize] = e as u32;
                    row.push(other);
                }
            };
            meet(e as u32);
            for &d in dofs(e) {
                for (column, _) in self.values.blocks(d as usize) {
                    self.of_block(column).iter().for_each(|&other| meet(other));
                }
                let entries = self.values.entries(d as usize);
                entries.for_each(|at| meet(self.of_entry(at)));
            }
            row[begin..].sort_unstable();
            ends.push(row.len());
        }
        (row, ends)
    }

    /// The places of the values of raw dofs, which begin at `first` in those of the bulk and of the interface.
    fn find(
        &self,
        dofs: Range<usize>,
        [start, row]: [&[u32]; 2],
        first: [usize; 2],
        of_bulk: &mut [u32],
        of_interface: &mut [u32],
    ) {
        // the place of each row of the column at hand
        let mut place = vec![0u32; self.nequation];
        for d in dofs {
            let e = self.equation[d];
            if e == NONE {
                continue;
            }
            for at in start[e as usize]..start[e as usize + 1] {
                place[row[at as usize] as usize] = at;
            }
            let find = |other: u32, to: &mut u32| {
                if self.keeps(e, other) {
                    *to = place[other as usize];
                }
            };
            for (column, at) in self.values.blocks(d) {
                let others = self.of_block(column).iter();
                let to = &mut of_bulk[at - first[0]..][..others.len()];
                others.zip(to).for_each(|(&other, to)| find(other, to));
            }
            for at in self.values.entries(d) {
                find(self.of_entry(at), &mut of_interface[at - first[1]]);
            }
        }
    }
}

/// Columns of one task, with their values and the norms of their rows of the operator.
struct Share<'m> {
    columns: Range<usize>,
    value: &'m mut [f64],
    row_max: &'m mut [f64],
}

impl<'m> Share<'m> {
    /// Each column with the places of its entries, their values, and its norms.
    fn each(
        self,
        start: &[u32],
    ) -> impl Iterator<Item = (usize, Range<usize>, &'m mut [f64], &'m mut f64)> {
        let mut value = self.value;
        self.columns.zip(self.row_max).map(move |(e, row_max)| {
            let range = start[e] as usize..start[e + 1] as usize;
            let own = value.split_off_mut(..range.len()).unwrap_or_default();
            (e, range, own, row_max)
        })
    }
}

/// All columns, shared among the threads with about as many entries each.
fn shares<'m>(start: &[u32], value: &'m mut [f64], row_max: &'m mut [f64]) -> Vec<Share<'m>> {
    let (n, nentry) = (row_max.len(), value.len());
    let count = parts(nentry);
    let (mut first, mut values, mut rows) = (0, value, row_max);
    let share = |k: usize| {
        let last = match k == count {
            true => n,
            false => start.partition_point(|&at| (at as usize) < k * nentry / count),
        };
        let columns = std::mem::replace(&mut first, last)..last;
        let entries = (start[columns.end] - start[columns.start]) as usize;
        Share {
            value: values.split_off_mut(..entries).unwrap_or_default(),
            row_max: rows.split_off_mut(..columns.len()).unwrap_or_default(),
            columns,
        }
    };
    (1..=count).map(share).collect()
}

/// The largest scaled entry of a row of the operator; those of the columns are updated.
fn largest<'a>(
    entries: impl Iterator<Item = (&'a u32, &'a f64)>,
    row_scale: f64,
    column_scale: &[f64],
    column_max: &mut [f64],
) -> f64 {
    let mut of_row = 0.0f64;
    for (&f, a) in entries {
        let size = a.abs() * row_scale * column_scale[f as usize];
        of_row = of_row.max(size);
        let of_column = &mut column_max[f as usize];
        *of_column = of_column.max(size);
    }
    of_row
}

/// The power of two next to 1/√size.
fn power_of_two(size: f64) -> f64 {
    (-0.5 * size.log2()).round().exp2()
}
