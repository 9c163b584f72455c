//! The finest level: the stiffness of the bodies over the nodes that can move.

use super::aggregation::MODES;
use super::blocks::Blocks;
use crate::partition::bodies;
use crate::problem::{Kept, Values};
use crate::sparsity::{BlockPattern, NONE};
use rayon::prelude::*;
use std::ops::Range;

/// Parts of the nodes that are worked on in parallel, at most, and nodes of a part, at least.
const PARTS: usize = 64;
const NODES_PER_PART: usize = 4096;
/// The stiffness of springs over that of the nodes, where there is one. Measured: from 0.1 to 0.7 iterations hardly differ.
const SPRING: f64 = 0.3;
/// Nodes between corners, over the corners, from which on these are a level of their own.
const MANY_BETWEEN: usize = 2;
/// The part of a motion that is held, on the average of the nodes held, below which it is free.
const HELD: f64 = 1e-8;

/// Which nodes are rows, in which order, in which parts.
pub(super) struct Fine {
    /// The node of each row.
    pub node: Vec<u32>,
    /// The row of each node, or `NONE`.
    row: Vec<u32>,
    /// Ranges of rows that do not couple with one another; rows between them come last.
    pub parts: Vec<Range<usize>>,
    /// Motions of a rigid body at each row; nothing where a node is held.
    pub modes: Vec<[[f64; MODES]; 3]>,
    /// Rows of bodies that nothing holds but contact, in their order.
    pub floating: Vec<u32>,
    /// Where elements are quadratic.
    pub corners: Option<Corners<3>>,
    /// What it was made of: bodies, and which of their dofs can move.
    bulk: BlockPattern,
    is_free: Vec<bool>,
}

/// The corners of quadratic elements: there are the linear ones on the same places, which a hierarchy aggregates better.
///
/// Source: Rønquist, Patera, *J. Sci. Comput.* 2 (1987) 389–406.
pub(super) struct Corners<const N: usize> {
    /// The row of each, in the order of the rows.
    pub row: Vec<u32>,
    /// Ranges of corners in the parts.
    pub parts: Vec<Range<usize>>,
    /// From corners to rows: a node between two corners moves by their mean.
    pub prolong: Blocks<N, N>,
}

impl Fine {
    /// Nodes with an equation and a stiffness of their own, bisected by their places.
    pub fn new(kept: &Kept) -> Self {
        let coordinates = kept.coordinates.as_slice();
        let is_free = |dof: usize| kept.is_free(dof);
        let nnode = kept.bulk.nrow().min(coordinates.len());
        let moves = |node: u32| {
            (0..3).any(|axis| is_free(3 * node as usize + axis)) && kept.bulk.has_row(node)
        };
        let free: Vec<u32> = (0..nnode as u32).filter(|&n| moves(n)).collect();
        let (bodies, (node, parts)) = match &kept.bulk.partition {
            // what couples is not known of rows of other ranks, and parts are for threads
            Some(partition) => (partition.bodies(), (free, Vec::new())),
            None => {
                let bodies = bodies(nnode, |node| kept.bulk.columns(node));
                let parts = in_parts(kept, &bodies, &free, moves);
                (bodies, parts)
            }
        };
        let mut row = vec![NONE; kept.bulk.nrow()];
        for (r, &n) in node.iter().enumerate() {
            row[n as usize] = r as u32;
        }
        let modes = modes(&node, coordinates, is_free);
        let corners = Corners::new(&node, &row, &parts, &kept.between, is_free);
        let floating = floating(&bodies, coordinates, &row, is_free);
        Self {
            node,
            row,
            parts,
            modes,
            floating,
            corners,
            bulk: kept.bulk.clone(),
            is_free: freedom(kept).collect(),
        }
    }

    /// The row of a node, or `NONE`.
    pub fn row(&self, node: usize) -> u32 {
        self.row.get(node).copied().unwrap_or(NONE)
    }

    /// Whether it is that of a problem, whatever its interface.
    pub fn is_of(&self, kept: &Kept) -> bool {
        self.bulk == kept.bulk && freedom(kept).eq(self.is_free.iter().copied())
    }

    /// The stiffness over the rows: a prescribed row has its own diagonal and no more.
    pub fn matrix(&self, kept: &Kept, values: &Values) -> Blocks<3, 3> {
        let is_free = |dof: usize| kept.is_free(dof);
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
        let mut matrix = Blocks {
            ncolumn: self.node.len(),
            start,
            column: vec![0; end],
            value: vec![[[0.0; 3]; 3]; end],
        };
        let tasks = self.node.par_iter().zip(matrix.rows_mut());
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
        matrix
    }
}

impl Corners<3> {
    /// Those among the nodes of rows; none where few nodes are between others.
    fn new(
        node: &[u32],
        row: &[u32],
        parts: &[Range<usize>],
        between: &[[u32; 2]],
        is_free: impl Fn(usize) -> bool,
    ) -> Option<Self> {
        let ends = |node: u32| between.get(node as usize).filter(|ends| ends[0] != NONE);
        let mut column = vec![NONE; node.len()];
        let mut corners = Vec::new();
        for (r, &node) in node.iter().enumerate() {
            if ends(node).is_none() {
                column[r] = corners.len() as u32;
                corners.push(r as u32);
            }
        }
        if node.len() - corners.len() < MANY_BETWEEN * corners.len() {
            return None;
        }
        let before = |end: usize| corners.partition_point(|&r| (r as usize) < end);
        let parts = parts
            .iter()
            .map(|p| before(p.start)..before(p.end))
            .collect();
        let mut prolong = Blocks {
            ncolumn: corners.len(),
            start: Vec::with_capacity(node.len() + 1),
            column: Vec::new(),
            value: Vec::new(),
        };
        prolong.start.push(0);
        for (r, &own) in node.iter().enumerate() {
            let whole = ([own, NONE], 1.0);
            let (mut of, share) = ends(own).map_or(whole, |&ends| (ends, 0.5));
            let at = |node: u32| row.get(node as usize).map_or(NONE, |&r| r);
            of.sort_unstable_by_key(|&node| at(node));
            for corner in of {
                let to = column.get(at(corner) as usize).copied().unwrap_or(NONE);
                if to == NONE {
                    continue;
                }
                // a prescribed unknown does not move others, nor do they move it
                let moves =
                    |i: usize| is_free(3 * own as usize + i) && is_free(3 * corner as usize + i);
                let mut block = [[0.0; 3]; 3];
                for (i, line) in block.iter_mut().enumerate() {
                    line[i] = if corner == own || moves(i) {
                        share
                    } else {
                        0.0
                    };
                }
                prolong.column.push(to);
                prolong.value.push(block);
            }
            debug_assert!(prolong.column[prolong.start[r]..].is_sorted());
            prolong.start.push(prolong.column.len());
        }
        Some(Self {
            row: corners,
            parts,
            prolong,
        })
    }
}

/// Nodes part by part, and the ranges of the parts; nodes between parts come last.
fn in_parts(
    kept: &Kept,
    bodies: &[Vec<u32>],
    free: &[u32],
    moves: impl Fn(u32) -> bool,
) -> (Vec<u32>, Vec<Range<usize>>) {
    let part = bisect(bodies, moves, &kept.coordinates, free.len());
    // a node with a neighbour in an earlier part is between parts
    let between = |node: u32| {
        let own = part[node as usize];
        let near = kept.bulk.columns(node).iter();
        near.filter_map(|&other| part.get(other as usize))
            .any(|&other| other < own)
    };
    let nparts = part
        .iter()
        .filter(|&&p| p != NONE)
        .max()
        .map_or(0, |&p| p + 1);
    let mut rows: Vec<Vec<u32>> = vec![Vec::new(); nparts as usize + 1];
    for &node in free {
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
    (rows.concat(), parts)
}

/// Springs to the ground at these rows: without any, a body that floats has motions without stiffness, which no level of
/// a hierarchy can distinguish from others. Together they are about as stiff as what the body rests on: E times the diameter of
/// the contact, where a node has E times the size of an element.
pub(super) fn hold(matrix: &mut Blocks<3, 3>, rows: &[u32]) {
    stiffen(matrix, rows, SPRING / (rows.len().max(1) as f64).sqrt());
}

/// Springs to the ground at these rows, of this part of the mean stiffness of their nodes.
pub(super) fn stiffen(matrix: &mut Blocks<3, 3>, rows: &[u32], part: f64) {
    for &row in rows {
        let range = matrix.range(row as usize);
        let Ok(at) = matrix.column[range.clone()].binary_search(&row) else {
            continue;
        };
        let block = &mut matrix.value[range.start + at];
        let mean = (0..3).map(|i| block[i][i]).sum::<f64>() / 3.0;
        (0..3).for_each(|i| block[i][i] += part * mean);
    }
}

/// The rows of bodies that may move as a whole.
fn floating(
    bodies: &[Vec<u32>],
    coordinates: &[[f64; 3]],
    row: &[u32],
    is_free: impl Fn(usize) -> bool,
) -> Vec<u32> {
    let floats = bodies
        .iter()
        .filter(|body| !is_held(body, coordinates, &is_free));
    let rows = floats.flatten().map(|&node| row[node as usize]);
    let mut rows: Vec<u32> = rows.filter(|&row| row != NONE).collect();
    rows.sort_unstable();
    rows
}

/// Whether the supports of a body leave it no rigid motion.
fn is_held(body: &[u32], coordinates: &[[f64; 3]], is_free: impl Fn(usize) -> bool) -> bool {
    let held = |&&node: &&u32| (0..3).any(|axis| !is_free(3 * node as usize + axis));
    let held: Vec<u32> = body.iter().filter(held).copied().collect();
    // the remainder of each mode after those before it: Cholesky's factor of the sums of products
    let mut sums = [[0.0; MODES]; MODES];
    let all = modes(&held, coordinates, |_| true);
    for (&node, rows) in held.iter().zip(&all) {
        for (axis, motion) in rows.iter().enumerate() {
            if !is_free(3 * node as usize + axis) {
                for (sums, a) in sums.iter_mut().zip(motion) {
                    for (sum, b) in sums.iter_mut().zip(motion) {
                        *sum += a * b;
                    }
                }
            }
        }
    }
    for k in 0..MODES {
        let own = sums[k];
        if own[k] <= HELD * held.len() as f64 {
            return false;
        }
        for row in &mut sums[k + 1..] {
            let factor = row[k] / own[k];
            for (v, own) in row.iter_mut().zip(own) {
                *v -= factor * own;
            }
        }
    }
    true
}

/// Whether the dofs of the bulk can move.
fn freedom(kept: &Kept) -> impl Iterator<Item = bool> + '_ {
    let dofs = kept.equation.iter().take(3 * kept.bulk.nrow());
    dofs.map(|&e| e != NONE)
}

/// The part of each node that moves, or `NONE`: bodies, and halves of halves of large ones by the longest extent, the same
/// for any number of threads.
///
/// Bodies are parts of their own since a cut is where the incomplete factor is worst: through the middle of two blocks it
/// would run where they touch (measured: 25 iterations in place of 20).
fn bisect(
    bodies: &[Vec<u32>],
    moves: impl Fn(u32) -> bool,
    coordinates: &[[f64; 3]],
    count: usize,
) -> Vec<u32> {
    let of_body = |body: &Vec<u32>| body.iter().copied().filter(|&node| moves(node)).collect();
    let mut orders: Vec<Vec<u32>> = bodies.iter().map(of_body).collect();
    if orders.len() > PARTS {
        orders = vec![orders.concat()];
    }
    let most = (count / PARTS).max(NODES_PER_PART);
    let mut parts: Vec<&mut [u32]> = Vec::new();
    let mut pieces: Vec<&mut [u32]> = orders.iter_mut().map(Vec::as_mut_slice).collect();
    while !pieces.is_empty() {
        let halves: Vec<Result<&mut [u32], [&mut [u32]; 2]>> = pieces
            .into_par_iter()
            .map(|piece| {
                if piece.len() < 2 * most {
                    Ok(piece)
                } else {
                    Err(halve(piece, coordinates))
                }
            })
            .collect();
        pieces = Vec::new();
        for half in halves {
            match half {
                Ok(whole) => parts.push(whole),
                Err(two) => pieces.extend(two),
            }
        }
    }
    let mut part = vec![NONE; coordinates.len()];
    for (number, piece) in parts.iter().enumerate() {
        for &node in piece.iter() {
            part[node as usize] = number as u32;
        }
    }
    part
}

/// Two halves of nodes, cut across the longest extent; where nodes lie in planes, between two of them.
fn halve<'a>(piece: &'a mut [u32], coordinates: &[[f64; 3]]) -> [&'a mut [u32]; 2] {
    let extent = |axis: usize| {
        let along = piece.iter().map(|&n| coordinates[n as usize][axis]);
        let ends = along.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
        ends.1 - ends.0
    };
    let longest = (0..3).max_by(|&a, &b| extent(a).total_cmp(&extent(b)));
    let axis = longest.unwrap_or(0);
    let place = |n: u32| coordinates[n as usize][axis];
    piece.sort_unstable_by(|&a, &b| place(a).total_cmp(&place(b)).then(a.cmp(&b)));
    let middle = piece.len() / 2;
    let at = place(piece[middle]);
    let [first, last] = [
        piece.partition_point(|&n| place(n) < at),
        piece.partition_point(|&n| place(n) <= at),
    ];
    let near = [first, last]
        .into_iter()
        .min_by_key(|cut| cut.abs_diff(middle));
    let quarter = piece.len() / 4;
    let cut = near.filter(|cut| (quarter..piece.len() - quarter).contains(cut));
    piece.split_at_mut(cut.unwrap_or(middle)).into()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_between_corners_move_by_their_mean_but_for_what_is_held() {
        // corners 4, 1 and 7; twice each of the three edges; node 8 has no row
        let node = [4, 0, 1, 2, 3, 5, 6, 7, 9];
        let mut row = [NONE; 10];
        node.iter().zip(0..).for_each(|(&n, r)| row[n as usize] = r);
        let mut between = [[NONE; 2]; 10];
        for (node, ends) in [
            (0, [4, 1]),
            (2, [1, 4]),
            (3, [1, 7]),
            (5, [7, 1]),
            (6, [4, 7]),
            (9, [7, 4]),
        ] {
            between[node] = ends;
        }
        // the x of a corner, and the y of a node between
        let is_free = |dof: usize| dof != 3 * 7 && dof != 3 * 2 + 1;
        let corners = Corners::new(&node, &row, &[0..3, 3..5], &between, is_free).unwrap();
        assert_eq!(corners.row, [0, 2, 7]);
        assert_eq!(corners.parts, [0..2, 2..2]);
        let moved = [[1.0, 2.0, 4.0], [3.0, 8.0, 16.0], [5.0, 32.0, 64.0]];
        let mut found = [[0.0; 3]; 9];
        for (row, found) in found.iter_mut().enumerate() {
            for (column, block) in corners.prolong.row(row) {
                super::super::blocks::add_product(block, &moved[column], found);
            }
        }
        let mean = |a: usize, b: usize| [0, 1, 2].map(|i| 0.5 * (moved[a][i] + moved[b][i]));
        let mut expected = [
            moved[0],
            mean(0, 1),
            moved[1],
            mean(0, 1),
            mean(1, 2),
            mean(1, 2),
            mean(0, 2),
            moved[2],
            mean(0, 2),
        ];
        expected[3][1] = 0.0;
        for (k, other) in [(4, 1), (5, 1), (6, 0), (8, 0)] {
            expected[k][0] = 0.5 * moved[other][0];
        }
        assert_eq!(found, expected);
        // linear elements, and those where few nodes are between
        assert!(Corners::new(&node, &row, &[], &[], is_free).is_none());
        between[0] = [NONE; 2];
        assert!(Corners::new(&node, &row, &[], &between, is_free).is_none());
    }
}
