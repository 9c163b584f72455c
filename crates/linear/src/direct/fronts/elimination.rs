//! Elimination of one front, and of all below it.

use super::forest::{LITTLE, Node};
use super::number::Number;
use crate::direct::registers::clear_upper_halves;
use crate::lists::Lists;
use crate::matrix::Matrix;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::factor::{lu_in_place, lu_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_unit_lower_triangular_in_place,
};
use faer::{Accum, MatMut, Par};
use rayon::prelude::*;
use std::ops::Range;

/// Columns of what goes to the parent that are worked on together.
pub(super) const COLUMNS: usize = 96;

/// What a supernode keeps: `L₁₁∖U₁₁` over `L₂₁`, column by column, then `U₁₂`, column by column.
pub(super) struct Panel<T> {
    pub(super) value: Vec<T>,
    /// Row `pivot[k]` of the block came to place k.
    pub(super) pivot: Vec<u32>,
}

/// A pivot that is no number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NoPivot;

/// The places of the entries of some nodes in their panels.
#[derive(Default)]
pub(super) struct Placed {
    pub(super) from: Vec<u32>,
    pub(super) to: Vec<u32>,
    /// Where the entries of each node end.
    pub(super) ends: Vec<usize>,
}

impl Placed {
    /// Adds one more node; `local` is of nothing before and after.
    pub(super) fn add(
        &mut self,
        node: &Node,
        (matrix, by_row): (&Matrix, &Lists<[u32; 2]>),
        (order, place): (&[u32], &[u32]),
        local: &mut [Option<u32>],
    ) -> Option<()> {
        let (columns, w, m) = (node.columns.clone(), node.width(), node.size());
        let unknowns = || columns.clone().chain(node.rows.iter().map(|&r| r as usize));
        unknowns().zip(0..).for_each(|(k, at)| local[k] = Some(at));
        for (own, &e) in order[columns.clone()].iter().enumerate() {
            let e = e as usize;
            for (at, &f) in (matrix.start[e]..).zip(matrix.column(e)) {
                let other = place[f as usize] as usize;
                if other >= columns.start {
                    let j = local[other]? as usize;
                    let place = if j < w {
                        own + j * m
                    } else {
                        w * m + own + (j - w) * w
                    };
                    self.from.push(at);
                    self.to.push(u32::try_from(place).ok()?);
                }
            }
            for &[f, at] in by_row.of(e) {
                let other = place[f as usize] as usize;
                if other >= columns.end {
                    let place = local[other]? as usize + own * m;
                    self.from.push(at);
                    self.to.push(u32::try_from(place).ok()?);
                }
            }
        }
        unknowns().for_each(|k| local[k] = None);
        self.ends.push(self.from.len());
        Some(())
    }
}

/// Memory for pivots.
#[derive(Default)]
pub(super) struct Memory<T> {
    pub(super) buffer: Option<MemBuffer>,
    pub(super) width: usize,
    pub(super) inverse: Vec<u32>,
    pub(super) column: Vec<T>,
}

/// What all nodes share.
#[derive(Clone, Copy)]
pub(super) struct Tree<'a> {
    pub(super) nodes: &'a [Node],
    pub(super) tasks: &'a [Range<usize>],
    pub(super) from: &'a [u32],
    pub(super) to: &'a [u32],
    pub(super) value: &'a [f64],
}

impl Tree<'_> {
    /// Whether a node is above all tasks.
    pub(super) fn is_above(self, s: u32) -> bool {
        let before = self.tasks.partition_point(|task| task.end <= s as usize);
        let next = self.tasks.get(before);
        next.is_none_or(|task| task.start > s as usize)
    }

    /// Eliminates the nodes above the tasks in the subtrees with these roots, which side by side are the nodes from `begin`
    /// on: at the same time. Returns the smallest pivot.
    pub(super) fn climb_all<T: Number>(
        self,
        mut begin: usize,
        roots: &[u32],
        mut panels: &mut [Panel<T>],
        mut left: &mut [Vec<T>],
    ) -> Result<f64, NoPivot> {
        let mut jobs = Vec::with_capacity(roots.len());
        for &root in roots {
            let end = root as usize + 1;
            let (own, others) = panels.split_at_mut(end - begin);
            let (own_left, others_left) = left.split_at_mut(end - begin);
            if self.is_above(root) {
                jobs.push((begin..end, own, own_left));
            }
            (panels, left, begin) = (others, others_left, end);
        }
        let jobs = jobs.into_par_iter();
        jobs.map(|(subtree, panels, left)| self.climb(subtree, panels, left))
            .try_reduce(|| f64::INFINITY, |a, b| Ok(a.min(b)))
    }

    /// The same of one subtree. A node with two children above the tasks has two subtrees with much work below it, so that
    /// there are never many of them above one another.
    pub(super) fn climb<T: Number>(
        self,
        subtree: Range<usize>,
        panels: &mut [Panel<T>],
        left: &mut [Vec<T>],
    ) -> Result<f64, NoPivot> {
        let (mut begin, mut lowest) = (subtree.start, subtree.end - 1);
        let children = loop {
            let children = self.nodes[lowest].children.as_slice();
            let mut above = (0..children.len()).filter(|&k| self.is_above(children[k]));
            match (above.next(), above.next()) {
                (Some(only), None) => {
                    begin = only
                        .checked_sub(1)
                        .map_or(begin, |k| children[k] as usize + 1);
                    lowest = children[only] as usize;
                }
                _ => break children,
            }
        };
        let below = begin - subtree.start..lowest - subtree.start;
        let parts = (&mut panels[below.clone()], &mut left[below]);
        let mut smallest = self.climb_all(begin, children, parts.0, parts.1)?;
        let mut memory = Memory::default();
        for s in (lowest..subtree.end).filter(|&s| self.is_above(s as u32)) {
            let at = s - subtree.start;
            let (children, own) = left.split_at_mut(at);
            let children = (children, subtree.start);
            let pivot = self.eliminate(s, children, &mut panels[at], &mut own[0], &mut memory)?;
            smallest = smallest.min(pivot);
        }
        Ok(smallest)
    }

    /// Eliminates the columns of a node; `children` holds what the nodes from its number on leave, and `left` gets what
    /// this one does. Returns the smallest pivot.
    pub(super) fn eliminate<T: Number>(
        self,
        s: usize,
        (children, first): (&mut [Vec<T>], usize),
        panel: &mut Panel<T>,
        left: &mut Vec<T>,
        memory: &mut Memory<T>,
    ) -> Result<f64, NoPivot> {
        let node = &self.nodes[s];
        let (w, r) = (node.width(), node.rows.len());
        let m = w + r;
        panel.value.fill(T::default());
        left.clear();
        left.resize(r * r, T::default());
        let entries = self.from[node.entries.clone()].iter();
        for (&from, &to) in entries.zip(&self.to[node.entries.clone()]) {
            panel.value[to as usize] += T::narrow(self.value[from as usize]).flushed();
        }
        let (lower, upper) = panel.value.split_at_mut(w * m);
        for &child in &node.children {
            let part = std::mem::take(&mut children[child as usize - first]);
            let place = &self.nodes[child as usize].place;
            let split = place.partition_point(|&p| (p as usize) < w);
            let (own, below) = place.split_at(split);
            for (&column, part) in place.iter().zip(part.chunks_exact(place.len().max(1))) {
                let column = column as usize;
                if column < w {
                    let to = &mut lower[column * m..(column + 1) * m];
                    for (&row, v) in place.iter().zip(part) {
                        to[row as usize] += v.flushed();
                    }
                } else {
                    let (above, part) = part.split_at(split);
                    let to = &mut upper[(column - w) * w..(column - w + 1) * w];
                    for (&row, v) in own.iter().zip(above) {
                        to[row as usize] += v.flushed();
                    }
                    let to = &mut left[(column - w) * r..(column - w + 1) * r];
                    for (&row, v) in below.iter().zip(part) {
                        to[row as usize - w] += v.flushed();
                    }
                }
            }
        }
        let smallest = pivots(lower, upper, (w, r), &mut panel.pivot, memory)?;
        if r > 0 {
            let is_little = node.effort() < LITTLE;
            let (block, below) =
                MatMut::from_column_major_slice_mut(lower, m, w).split_at_row_mut(w);
            let (block, mut below) = (block.as_ref(), below);
            solve_lower_triangular_in_place(
                block.transpose(),
                below.as_mut().transpose_mut(),
                Par::Seq,
            );
            flush(below.as_mut());
            let below = below.as_ref();
            let strip = |(upper, left): (&mut [T], &mut [T])| {
                let n = left.len() / r;
                let mut upper = MatMut::from_column_major_slice_mut(upper, w, n);
                solve_unit_lower_triangular_in_place(block, upper.as_mut(), Par::Seq);
                flush(upper.as_mut());
                let left = MatMut::from_column_major_slice_mut(left, r, n);
                matmul(
                    left,
                    Accum::Add,
                    below,
                    upper.as_ref(),
                    T::narrow(-1.0),
                    Par::Seq,
                );
                clear_upper_halves();
            };
            if is_little {
                upper
                    .chunks_mut(w * COLUMNS)
                    .zip(left.chunks_mut(r * COLUMNS))
                    .for_each(strip);
            } else {
                upper
                    .par_chunks_mut(w * COLUMNS)
                    .zip(left.par_chunks_mut(r * COLUMNS))
                    .for_each(strip);
            }
        }
        Ok(smallest)
    }
}

/// Drops what counts as nothing.
pub(super) fn flush<T: Number>(block: MatMut<'_, T>) {
    for column in block.col_iter_mut() {
        if let Some(column) = column.try_as_col_major_mut() {
            for value in column.as_slice_mut() {
                *value = value.flushed();
            }
        }
    }
}

/// Factorizes the block of pivots, and exchanges the rows of `upper`. Returns the smallest pivot before it was replaced.
pub(super) fn pivots<T: Number>(
    lower: &mut [T],
    upper: &mut [T],
    (w, r): (usize, usize),
    pivot: &mut [u32],
    memory: &mut Memory<T>,
) -> Result<f64, NoPivot> {
    let m = w + r;
    let mut block = MatMut::from_column_major_slice_mut(lower, m, w)
        .split_at_row_mut(w)
        .0;
    if memory.width < w {
        let scratch = lu_in_place_scratch::<u32, T>(w, w, Par::Seq, Default::default());
        memory.buffer = MemBuffer::try_new(scratch).ok();
        memory.width = w;
    }
    let buffer = memory.buffer.as_mut().ok_or(NoPivot)?;
    memory.inverse.resize(w, 0);
    lu_in_place(
        block.as_mut(),
        pivot,
        &mut memory.inverse,
        Par::Seq,
        MemStack::new(buffer),
        Default::default(),
    );
    clear_upper_halves();
    flush(block.as_mut());
    let mut smallest = f64::INFINITY;
    for k in 0..w {
        let value = block[(k, k)].wide();
        let size = value.abs();
        if !size.is_finite() {
            return Err(NoPivot);
        }
        smallest = smallest.min(size);
        if size < T::VANISHING {
            block[(k, k)] = T::narrow(T::REPLACEMENT.copysign(value));
        }
    }
    if pivot.iter().enumerate().any(|(k, &p)| k != p as usize) {
        for column in upper.chunks_exact_mut(w) {
            memory.column.clear();
            memory.column.extend_from_slice(column);
            for (to, &p) in column.iter_mut().zip(pivot.iter()) {
                *to = memory.column[p as usize];
            }
        }
    }
    Ok(smallest)
}
