//! The rows of this rank: of the operator, and of the stiffness of the bodies.

use super::super::blocks::Blocks;
use super::super::grid::Numbers;
use super::layout::Layout;
use super::library::OwnRows;
use crate::problem::{Kept, Values};
use crate::sparsity::NONE;

/// The rows of the operator, and where their values are in those of the whole.
pub(super) struct Operator {
    pub rows: OwnRows,
    /// The value that each entry begins with, bulk first, then interface; `NONE` for prescribed components, which are 1. A
    /// rank has fewer than 2³² of both, for entries have numbers of 32 bits.
    first: Vec<u32>,
    /// Values that are added, each with its entry.
    more: Vec<(u32, u32)>,
}

impl Operator {
    pub fn new(kept: &Kept, numbers: &Numbers, layout: &Layout) -> Self {
        let nbulk = kept.bulk.nvalue();
        let mut rows = OwnRows {
            start: vec![0],
            ..OwnRows::default()
        };
        let (mut first, mut more) = (Vec::new(), Vec::new());
        let mut of_row: Vec<(u32, usize)> = Vec::new();
        for (k, &e) in layout.own.iter().enumerate() {
            if e == NONE {
                first.push(NONE);
                rows.column.push((layout.first + k) as i32);
            } else {
                let dof = numbers.raw[e as usize];
                let interface = kept.interface_row(dof).map(|(c, at)| (c, nbulk + at));
                let all = kept.bulk_row(dof).chain(interface);
                let equations = all.map(|(c, at)| (kept.equation[c as usize], at));
                of_row.clear();
                of_row.extend(
                    equations
                        .filter(|(e, _)| *e != NONE)
                        .map(|(e, at)| (layout.number[e as usize], at)),
                );
                of_row.sort_unstable();
                let begin = rows.column.len();
                for &(column, at) in &of_row {
                    let is_new =
                        rows.column.len() == begin || rows.column.last() != Some(&(column as i32));
                    if is_new {
                        rows.column.push(column as i32);
                        first.push(at as u32);
                    } else {
                        more.push((at as u32, rows.column.len() as u32 - 1));
                    }
                }
            }
            rows.start.push(rows.column.len() as i32);
        }
        rows.value = vec![0.0; rows.column.len()];
        Self { rows, first, more }
    }

    /// Takes the values of a tangent.
    pub fn update(&mut self, kept: &Kept, values: &Values) {
        let nbulk = kept.bulk.nvalue();
        let value_at = |at: u32| {
            let from = match (at as usize).checked_sub(nbulk) {
                None => values.bulk.get(at as usize),
                Some(at) => values.interface.get(at),
            };
            from.copied().unwrap_or(0.0)
        };
        let value = &mut self.rows.value;
        for (value, &at) in value.iter_mut().zip(&self.first) {
            *value = if at == NONE { 1.0 } else { value_at(at) };
        }
        for &(at, entry) in &self.more {
            value[entry as usize] += value_at(at);
        }
    }
}

/// The rows that this rank has of a matrix over the finest level.
pub(super) fn of_bodies(matrix: &Blocks<3, 3>, layout: &Layout) -> OwnRows {
    let mut rows = OwnRows {
        start: vec![0],
        ..OwnRows::default()
    };
    let mut order: Vec<(u32, usize)> = Vec::new();
    for &row in &layout.rows {
        order.clear();
        let range = matrix.range(row as usize);
        let columns = matrix.column[range.clone()].iter().zip(range);
        order.extend(columns.map(|(&column, at)| (layout.body[column as usize], at)));
        order.sort_unstable();
        for i in 0..3 {
            for &(column, at) in &order {
                for (j, v) in (0..).zip(matrix.value[at][i]) {
                    rows.column.push((column + j) as i32);
                    rows.value.push(v);
                }
            }
            rows.start.push(rows.column.len() as i32);
        }
    }
    rows
}
