//! Where multipliers can be eliminated: the multipliers that act together, and for each such group a node that is its
//! host, among those it acts on.
//!
//! Multipliers with the same row of the pattern form a group: the traction of one point. A good host is one that few
//! other groups act on, with a block that inverts well. A group that is open has no values yet; its pattern is all
//! there is to go by. Each host serves one group, and a group without a host stays as it is.

use super::{Kept, Values};
use crate::system::sparsity::NONE;
use std::collections::HashMap;

/// The most multipliers that form a group, and dofs that a host has.
pub(super) const WIDTH: usize = 3;
/// A small square matrix.
pub(super) type Block = [[f64; WIDTH]; WIDTH];
/// A host's smallest pivot over the group's largest coefficient: at least this for a host that is kept,
const KEEP: f64 = 0.05;
/// and this for a new one.
const TAKE: f64 = 0.2;
/// Groups that act on more dofs stay as they are: they would couple all of them.
const WIDE: usize = 400;

/// The columns of the multipliers.
#[derive(Default)]
pub(super) struct Multipliers {
    /// Their raw dofs.
    pub dof: Vec<u32>,
    /// The number of the multiplier at a raw dof, or `NONE`.
    number: Vec<u32>,
    start: Vec<usize>,
    row: Vec<u32>,
    at: Vec<usize>,
}

/// Multipliers that are eliminated together.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Group {
    /// Raw dofs.
    pub multiplier: Vec<u32>,
    /// Raw dofs of the host that have an equation; one of them is the pivot of each multiplier.
    pub host: Vec<u32>,
}

/// The pivots of a group: `S[a][c]` is the coefficient of multiplier c in the equation of dof `row[a]`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pivots {
    /// Raw dofs, one for each multiplier.
    pub row: [u32; WIDTH],
    /// S⁻¹.
    pub inverse: Block,
}

impl Multipliers {
    pub fn new(kept: &Kept) -> Self {
        let nbulk = kept.bulk.nrow() * kept.bulk.block;
        let mut number = vec![NONE; kept.equation.len()];
        let mut dof = Vec::new();
        for (d, &e) in kept.equation.iter().enumerate().skip(nbulk) {
            if e != NONE && kept.sign[e as usize] < 0 {
                number[d] = dof.len() as u32;
                dof.push(d as u32);
            }
        }
        let mut start = vec![0; dof.len() + 1];
        let used = |row: usize| kept.equation[row] != NONE;
        let interface = &kept.interface;
        let entries = |row: usize| interface.row_start[row]..interface.row_start[row + 1];
        for row in (0..interface.nrow).filter(|&row| used(row)) {
            for at in entries(row) {
                let m = number[interface.column[at] as usize];
                if m != NONE {
                    start[m as usize + 1] += 1;
                }
            }
        }
        for m in 0..dof.len() {
            start[m + 1] += start[m];
        }
        let mut next = start.clone();
        let mut rows = vec![0; start[dof.len()]];
        let mut places = vec![0; start[dof.len()]];
        for row in (0..interface.nrow).filter(|&row| used(row)) {
            for at in entries(row) {
                let m = number[interface.column[at] as usize];
                if m != NONE {
                    let to = &mut next[m as usize];
                    (rows[*to], places[*to]) = (row as u32, at);
                    *to += 1;
                }
            }
        }
        Self {
            dof,
            number,
            start,
            row: rows,
            at: places,
        }
    }

    /// The rows of a multiplier's column, and where their values are.
    pub fn column(&self, multiplier: u32) -> impl Iterator<Item = (u32, usize)> + '_ {
        let m = self.number[multiplier as usize] as usize;
        let range = self.start[m]..self.start[m + 1];
        let places = self.at[range.clone()].iter();
        self.row[range].iter().copied().zip(places.copied())
    }

    /// The coefficient of a multiplier in the equation of a dof.
    fn coefficient(&self, row: u32, multiplier: u32, interface: &[f64]) -> f64 {
        let m = self.number[multiplier as usize] as usize;
        let range = self.start[m]..self.start[m + 1];
        match self.row[range.clone()].binary_search(&row) {
            Ok(k) => interface[self.at[range.start + k]],
            Err(_) => 0.0,
        }
    }

    /// Whether nothing but the diagonal is in the rows of a group, so that its multipliers are known beforehand.
    pub fn is_open(&self, kept: &Kept, group: &[u32], interface: &[f64]) -> bool {
        group.iter().all(|&m| {
            let row = m as usize;
            let entries = kept.interface.row_start[row]..kept.interface.row_start[row + 1];
            entries.into_iter().all(|at| {
                let column = kept.interface.column[at];
                let diagonal = column == m;
                (interface[at] != 0.0) == diagonal || kept.equation[column as usize] == NONE
            })
        })
    }

    /// The pivots of a group in a host, and the smallest over the group's largest coefficient.
    fn pivots_of(
        &self,
        kept: &Kept,
        group: &[u32],
        host: &[u32],
        interface: &[f64],
    ) -> Option<(Pivots, f64)> {
        if group.len() > host.len() || host.len() > WIDTH {
            return None;
        }
        let mut block = Block::default();
        for (line, &row) in block.iter_mut().zip(host) {
            for (b, &m) in line.iter_mut().zip(group) {
                *b = self.coefficient(row, m, interface);
            }
        }
        let acts = |&(row, _): &(u32, usize)| kept.is_displacement(row);
        let columns = group.iter().flat_map(|&m| self.column(m).filter(acts));
        let largest = columns.fold(0.0, |max: f64, (_, at)| max.max(interface[at].abs()));
        let (order, smallest) = pivot_order(&block, host.len(), group.len())?;
        let mut square = Block::default();
        let mut row = [NONE; WIDTH];
        for (a, &from) in order[..group.len()].iter().enumerate() {
            square[a] = block[from];
            row[a] = host[from];
        }
        let inverse = inverse(&square, group.len())?;
        Some((Pivots { row, inverse }, smallest / largest))
    }

    /// The pivots of a group, where its host still serves.
    pub fn pivots(&self, kept: &Kept, group: &Group, interface: &[f64]) -> Option<Pivots> {
        let found = self.pivots_of(kept, &group.multiplier, &group.host, interface);
        found
            .filter(|(_, quality)| *quality >= KEEP)
            .map(|(pivots, _)| pivots)
    }

    /// The groups that have a host. Without values, patterns decide.
    ///
    /// `stays` says of a raw dof that its multiplier is not to be eliminated, `before` which node was a multiplier's host.
    pub fn groups(
        &self,
        kept: &Kept,
        values: Option<&Values>,
        stays: &[bool],
        before: &[u32],
    ) -> Vec<Group> {
        let alike = self.alike(kept, stays);
        let interface = values.map(|v| v.interface);
        let nodes: Vec<Vec<u32>> = alike
            .iter()
            .map(|group| self.nodes(kept, group, interface))
            .collect();
        let mut share: HashMap<u32, f64> = HashMap::new();
        for &node in nodes.iter().flatten() {
            *share.entry(node).or_default() += 1.0;
        }
        let mut offers: Vec<(f64, u32, u32)> = Vec::new();
        for (g, group) in alike.iter().enumerate() {
            for &node in &nodes[g] {
                let host = kept.equations_of(node);
                let quality = match interface.filter(|i| !self.is_open(kept, group, i)) {
                    Some(interface) => self
                        .pivots_of(kept, group, &host, interface)
                        .map_or(0.0, |(_, quality)| quality),
                    None if group.len() <= host.len() => 1.0,
                    None => 0.0,
                };
                let was = group.iter().all(|&m| before[m as usize] == node);
                if quality >= TAKE || (was && quality >= KEEP) {
                    let old = if was { 4.0 } else { 1.0 };
                    offers.push((old * quality / share[&node], g as u32, node));
                }
            }
        }
        offers.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let mut host_of = vec![NONE; alike.len()];
        let mut taken: HashMap<u32, ()> = HashMap::new();
        for (_, g, node) in offers {
            if host_of[g as usize] == NONE && !taken.contains_key(&node) {
                host_of[g as usize] = node;
                taken.insert(node, ());
            }
        }
        let hosted = alike.into_iter().zip(host_of).filter(|(_, h)| *h != NONE);
        hosted
            .map(|(multiplier, node)| Group {
                multiplier,
                host: kept.equations_of(node),
            })
            .collect()
    }

    /// Multipliers with the same row of the pattern, in the order in which they first appear.
    fn alike(&self, kept: &Kept, stays: &[bool]) -> Vec<Vec<u32>> {
        let mut number: HashMap<&[u32], usize> = HashMap::new();
        let mut groups: Vec<Vec<u32>> = Vec::new();
        for &m in self.dof.iter().filter(|&&m| !stays[m as usize]) {
            let row = m as usize;
            let range = kept.interface.row_start[row]..kept.interface.row_start[row + 1];
            let g = *number
                .entry(&kept.interface.column[range])
                .or_insert(groups.len());
            if g == groups.len() {
                groups.push(Vec::new());
            }
            groups[g].push(m);
        }
        groups.retain(|group| group.len() <= WIDTH);
        groups
    }

    /// The nodes that a group acts on; none where there are too many.
    fn nodes(&self, kept: &Kept, group: &[u32], interface: Option<&[f64]>) -> Vec<u32> {
        let interface = interface.filter(|i| !self.is_open(kept, group, i));
        let mut nodes = Vec::new();
        let mut ndof = 0;
        for &m in group {
            let acts = |&(row, at): &(u32, usize)| {
                kept.is_displacement(row) && interface.is_none_or(|i| i[at] != 0.0)
            };
            for (row, _) in self.column(m).filter(acts) {
                nodes.push(kept.node_of(row));
                ndof += 1;
            }
        }
        if ndof > WIDE * group.len() {
            return Vec::new();
        }
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}

impl Kept {
    /// Whether a raw dof is an unknown with the sign of a displacement.
    fn is_displacement(&self, dof: u32) -> bool {
        let equation = self.equation[dof as usize];
        equation != NONE && self.sign[equation as usize] >= 0
    }

    /// The node of a raw dof; beyond the bulk, each dof is a node of its own.
    pub(super) fn node_of(&self, dof: u32) -> u32 {
        let (block, nrow) = (self.bulk.block as u32, self.bulk.nrow() as u32);
        if dof < nrow * block {
            dof / block
        } else {
            nrow + (dof - nrow * block)
        }
    }

    /// The dofs of a node that have an equation.
    fn equations_of(&self, node: u32) -> Vec<u32> {
        let (block, nrow) = (self.bulk.block as u32, self.bulk.nrow() as u32);
        let dofs = if node < nrow {
            node * block..(node + 1) * block
        } else {
            let dof = nrow * block + (node - nrow);
            dof..dof + 1
        };
        dofs.filter(|&d| self.is_displacement(d)).collect()
    }
}

/// The row in which each column finds its pivot, by complete pivoting, and the smallest pivot.
fn pivot_order(block: &Block, nrow: usize, ncolumn: usize) -> Option<([usize; WIDTH], f64)> {
    let mut a = *block;
    let (mut row_of, mut used) = ([0; WIDTH], [false; WIDTH]);
    let mut done = [false; WIDTH];
    let mut smallest = f64::INFINITY;
    for _ in 0..ncolumn {
        let mut best = (0.0, 0, 0);
        for r in (0..nrow).filter(|&r| !used[r]) {
            for c in (0..ncolumn).filter(|&c| !done[c]) {
                if a[r][c].abs() > best.0 {
                    best = (a[r][c].abs(), r, c);
                }
            }
        }
        let (size, r, c) = best;
        if size == 0.0 {
            return None;
        }
        smallest = smallest.min(size);
        (used[r], done[c]) = (true, true);
        row_of[c] = r;
        let line = a[r];
        for other in (0..nrow).filter(|&other| !used[other]) {
            let factor = a[other][c] / line[c];
            for (x, y) in a[other].iter_mut().zip(line) {
                *x -= factor * y;
            }
        }
    }
    Some((row_of, smallest))
}

/// The inverse of the leading n × n part, by Gauss and Jordan.
fn inverse(square: &Block, n: usize) -> Option<Block> {
    let mut a = *square;
    let mut out = Block::default();
    for (i, line) in out.iter_mut().enumerate() {
        line[i] = 1.0;
    }
    for c in 0..n {
        let r = (c..n).max_by(|&r, &s| a[r][c].abs().total_cmp(&a[s][c].abs()))?;
        a.swap(r, c);
        out.swap(r, c);
        let pivot = a[c][c];
        if pivot == 0.0 {
            return None;
        }
        for k in 0..n {
            a[c][k] /= pivot;
            out[c][k] /= pivot;
        }
        let (line, result) = (a[c], out[c]);
        for r in (0..n).filter(|&r| r != c) {
            let factor = a[r][c];
            for k in 0..n {
                a[r][k] -= factor * line[k];
                out[r][k] -= factor * result[k];
            }
        }
    }
    Some(out)
}
