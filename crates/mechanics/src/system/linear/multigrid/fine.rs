//! The finest level: the stiffness of the bodies over the nodes that can move.

use super::super::{Kept, Values};
use super::aggregation::MODES;
use super::blocks::Blocks;
use crate::system::sparsity::{BlockPattern, NONE};
use rayon::prelude::*;
use std::ops::Range;

/// Parts of the nodes that are worked on in parallel, at most, and nodes of a part, at least.
const PARTS: usize = 64;
const NODES_PER_PART: usize = 4096;

/// Which nodes are rows, in which order, in which parts.
pub(super) struct Fine {
    /// The node of each row.
    pub node: Vec<u32>,
    /// The row of each node, or `NONE`.
    row: Vec<u32>,
    /// Ranges of rows that do not couple with one another; what is between them comes last.
    pub parts: Vec<Range<usize>>,
    /// Motions of a rigid body at each row; nothing where a node is held.
    pub modes: Vec<[[f64; MODES]; 3]>,
    /// What it was made of: bodies, and which of their dofs can move.
    bulk: BlockPattern,
    is_free: Vec<bool>,
}

impl Fine {
    /// Nodes with an equation and a stiffness of their own, bisected by their places.
    pub fn new(kept: &Kept) -> Self {
        let coordinates = kept.coordinates.as_slice();
        let is_free = |dof: usize| kept.equation.get(dof).is_some_and(|&e| e != NONE);
        let nnode = kept.bulk.nrow().min(coordinates.len());
        let has_bulk = |node: u32| kept.bulk.position(node, node).is_some();
        let moves =
            |node: usize| (0..3).any(|axis| is_free(3 * node + axis)) && has_bulk(node as u32);
        let free: Vec<u32> = (0..nnode as u32).filter(|&n| moves(n as usize)).collect();
        let part = bisect(&free, coordinates, nnode);
        // a node with a neighbour in an earlier part is between parts
        let between = |node: u32| {
            let own = part[node as usize];
            let range = kept.bulk.row_start[node as usize]..kept.bulk.row_start[node as usize + 1];
            let near = kept.bulk.column[range].iter();
            near.filter_map(|&other| part.get(other as usize))
                .any(|&other| other < own)
        };
        let nparts = part
            .iter()
            .filter(|&&p| p != NONE)
            .max()
            .map_or(0, |&p| p + 1);
        let mut rows: Vec<Vec<u32>> = vec![Vec::new(); nparts as usize + 1];
        for &node in &free {
            let to = if between(node) {
                nparts
            } else {
                part[node as usize]
            };
            rows[to as usize].push(node);
        }
        let mut parts = Vec::with_capacity(nparts as usize);
        let mut end = 0;
        for part in &rows[..nparts as usize] {
            parts.push(end..end + part.len());
            end += part.len();
        }
        let node = rows.concat();
        let mut row = vec![NONE; kept.bulk.nrow()];
        for (r, &n) in node.iter().enumerate() {
            row[n as usize] = r as u32;
        }
        let modes = modes(&node, coordinates, is_free);
        Self {
            node,
            row,
            parts,
            modes,
            bulk: kept.bulk.clone(),
            is_free: freedom(kept).collect(),
        }
    }

    /// Whether it is that of a problem, whatever its interface.
    pub fn is_of(&self, kept: &Kept) -> bool {
        self.bulk == kept.bulk && freedom(kept).eq(self.is_free.iter().copied())
    }

    /// The stiffness over the rows: what is held has its own diagonal and no more.
    pub fn matrix(&self, kept: &Kept, values: &Values) -> Blocks<3, 3> {
        let is_free = |dof: usize| kept.equation.get(dof).is_some_and(|&e| e != NONE);
        let bulk = &kept.bulk;
        let range = |node: u32| bulk.row_start[node as usize]..bulk.row_start[node as usize + 1];
        let row_of = |column: u32| self.row[column as usize];
        let count = |&node: &u32| {
            let columns = bulk.column[range(node)].iter();
            columns.filter(|&&c| row_of(c) != NONE).count()
        };
        let counts: Vec<usize> = self.node.par_iter().map(count).collect();
        let mut start = Vec::with_capacity(self.node.len() + 1);
        let mut end = 0;
        start.push(end);
        for n in counts {
            end += n;
            start.push(end);
        }
        let mut column = vec![0; end];
        let mut value = vec![[[0.0; 3]; 3]; end];
        // one task for each row: rows get slices of their own
        let mut slices = Vec::with_capacity(self.node.len());
        let (mut columns, mut blocks) = (column.as_mut_slice(), value.as_mut_slice());
        for ends in start.windows(2) {
            let (own_columns, rest_columns) = columns.split_at_mut(ends[1] - ends[0]);
            let (own_blocks, rest_blocks) = blocks.split_at_mut(ends[1] - ends[0]);
            (columns, blocks) = (rest_columns, rest_blocks);
            slices.push((own_columns, own_blocks));
        }
        let tasks = self.node.par_iter().zip(slices);
        tasks.for_each_init(
            Vec::new,
            |order: &mut Vec<(u32, usize)>, (&node, (columns, blocks))| {
                order.clear();
                let of_row = range(node).map(|at| (row_of(bulk.column[at]), at));
                order.extend(of_row.filter(|(row, _)| *row != NONE));
                order.sort_unstable();
                for ((&(row, at), column), block) in order.iter().zip(columns).zip(blocks) {
                    *column = row;
                    let other = bulk.column[at] as usize;
                    let from = values.bulk.get(9 * at..9 * at + 9).unwrap_or(&[0.0; 9]);
                    for i in 0..3 {
                        let free = is_free(3 * node as usize + i);
                        for j in 0..3 {
                            let both = free && is_free(3 * other + j);
                            block[i][j] = if both { from[3 * i + j] } else { 0.0 };
                        }
                        if other == node as usize && !free {
                            let own = from[4 * i];
                            block[i][i] = if own > 0.0 { own } else { 1.0 };
                        }
                    }
                }
            },
        );
        Blocks {
            ncolumn: self.node.len(),
            start,
            column,
            value,
        }
    }
}

/// Whether the dofs of the bulk can move.
fn freedom(kept: &Kept) -> impl Iterator<Item = bool> + '_ {
    let dofs = kept.equation.iter().take(3 * kept.bulk.nrow());
    dofs.map(|&e| e != NONE)
}

/// The part of each node, or `NONE`: halves of halves by the longest extent, as many for any number of threads.
fn bisect(free: &[u32], coordinates: &[[f64; 3]], nnode: usize) -> Vec<u32> {
    let mut part = vec![NONE; nnode];
    let mut nparts = 1;
    while nparts < PARTS && free.len() >= 2 * nparts * NODES_PER_PART {
        nparts *= 2;
    }
    let mut order = free.to_vec();
    let mut pieces = vec![order.as_mut_slice()];
    while pieces.len() < nparts {
        pieces = pieces
            .into_par_iter()
            .flat_map_iter(|piece| {
                let extent = |axis: usize| {
                    let along = piece.iter().map(|&n| coordinates[n as usize][axis]);
                    let ends = along.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
                    ends.1 - ends.0
                };
                let longest = (0..3).max_by(|&a, &b| extent(a).total_cmp(&extent(b)));
                let axis = longest.unwrap_or(0);
                let key = |&n: &u32| (coordinates[n as usize][axis], n);
                let middle = piece.len() / 2;
                piece.select_nth_unstable_by(middle, |a, b| {
                    let (a, b) = (key(a), key(b));
                    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
                });
                let (one, two) = piece.split_at_mut(middle);
                [one, two]
            })
            .collect();
    }
    for (number, piece) in pieces.iter().enumerate() {
        for &node in piece.iter() {
            part[node as usize] = number as u32;
        }
    }
    part
}

/// Three translations, and three rotations about the middle as large.
fn modes(
    node: &[u32],
    coordinates: &[[f64; 3]],
    is_free: impl Fn(usize) -> bool,
) -> Vec<[[f64; MODES]; 3]> {
    let places = || node.iter().map(|&n| coordinates[n as usize]);
    let count = node.len().max(1) as f64;
    let middle: [f64; 3] = std::array::from_fn(|i| places().map(|x| x[i]).sum::<f64>() / count);
    let far = |x: [f64; 3]| (0..3).fold(0.0f64, |m, i| m.max((x[i] - middle[i]).abs()));
    let size = places().map(far).fold(0.0f64, f64::max);
    let scale = if size > 0.0 { size.recip() } else { 1.0 };
    let of = |&node: &u32| {
        let x = coordinates[node as usize];
        let r: [f64; 3] = std::array::from_fn(|i| (x[i] - middle[i]) * scale);
        let mut rows = [
            [1.0, 0.0, 0.0, 0.0, r[2], -r[1]],
            [0.0, 1.0, 0.0, -r[2], 0.0, r[0]],
            [0.0, 0.0, 1.0, r[1], -r[0], 0.0],
        ];
        for (axis, row) in rows.iter_mut().enumerate() {
            if !is_free(3 * node as usize + axis) {
                *row = [0.0; MODES];
            }
        }
        rows
    };
    node.iter().map(of).collect()
}
