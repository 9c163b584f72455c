//! Where multipliers can be eliminated: each with an equation of a node that is its partner, among those it acts on.
//!
//! A good partner is one that few other multipliers act on, with a large coefficient. Multipliers with a common partner form a
//! group and are eliminated together, by the block of their coefficients in it: a traction at its own node, or what two
//! contacts exert on a node of both. A multiplier that is open has no coefficients yet; its pattern is all there is to
//! go by. One that finds no partner stays as it is.

use crate::problem::{Kept, Values};
use crate::sparsity::NONE;
use std::collections::{BTreeMap, HashMap};

/// The most dofs that a partner has, and multipliers with it.
pub(crate) const WIDTH: usize = 3;
/// A small square matrix.
pub(crate) type Block = [[f64; WIDTH]; WIDTH];
/// The smallest pivot of a group over its largest coefficient: at least this for a partner that is kept,
const KEEP: f64 = 0.05;
/// and this for a new one.
const TAKE: f64 = 0.2;
/// Multipliers that act on more nodes stay as they are: they would couple all of them.
const WIDE: usize = 100;

/// The columns of the multipliers.
#[derive(Default)]
pub(crate) struct Multipliers {
    /// Their raw dofs.
    pub dof: Vec<u32>,
    /// The number of the multiplier at a raw dof, or `NONE`.
    number: Vec<u32>,
    start: Vec<usize>,
    row: Vec<u32>,
    at: Vec<usize>,
}

/// Multipliers with a common partner.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Group {
    /// Raw dofs.
    pub multiplier: Vec<u32>,
    /// Raw dofs of the partner that have an equation; one of them is the pivot of each multiplier.
    pub partner: Vec<u32>,
}

/// The pivots of the multipliers of a group that are closed: `S[a][c]` is the coefficient of multiplier c in the
/// equation of dof `row[a]`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pivots {
    multiplier: [u32; WIDTH],
    row: [u32; WIDTH],
    n: usize,
    /// S⁻¹.
    pub inverse: Block,
}

impl Pivots {
    const OPEN: Self = Self {
        multiplier: [NONE; WIDTH],
        row: [NONE; WIDTH],
        n: 0,
        inverse: [[0.0; WIDTH]; WIDTH],
    };

    /// Raw dofs of the multipliers.
    pub fn multipliers(&self) -> &[u32] {
        &self.multiplier[..self.n]
    }

    /// Raw dofs of their pivots.
    pub fn rows(&self) -> &[u32] {
        &self.row[..self.n]
    }
}

impl Multipliers {
    pub fn new(kept: &Kept) -> Self {
        let nbulk = kept.bulk.nrow() * kept.bulk.block;
        let mut number = vec![NONE; kept.equation.len()];
        let mut dof = Vec::new();
        if kept.shares_equations() {
            return Self::default();
        }
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

    /// Whether nothing but the diagonal is in the row of a multiplier, so that it is known beforehand.
    pub fn is_open(kept: &Kept, multiplier: u32, interface: &[f64]) -> bool {
        let row = multiplier as usize;
        let mut entries = kept.interface.row_start[row]..kept.interface.row_start[row + 1];
        entries.all(|at| {
            let column = kept.interface.column[at];
            (interface[at] != 0.0) == (column == multiplier)
                || kept.equation[column as usize] == NONE
        })
    }

    /// The largest coefficient of a multiplier in the equations of displacements.
    fn largest(&self, kept: &Kept, multiplier: u32, interface: &[f64]) -> f64 {
        let column = self.column(multiplier);
        let acts = column.filter(|&(row, _)| kept.is_displacement(row));
        acts.fold(0.0, |max: f64, (_, at)| max.max(interface[at].abs()))
    }

    /// The pivots of those of the multipliers that are closed, if every one is at least `least` of the largest
    /// coefficient.
    fn pivots_of(
        &self,
        kept: &Kept,
        multipliers: &[u32],
        partner: &[u32],
        interface: &[f64],
        least: f64,
    ) -> Option<Pivots> {
        let mut pivots = Pivots::OPEN;
        let mut largest = 0.0f64;
        let closed = |&&m: &&u32| !Self::is_open(kept, m, interface);
        for &m in multipliers.iter().filter(closed) {
            *pivots.multiplier.get_mut(pivots.n)? = m;
            pivots.n += 1;
            largest = largest.max(self.largest(kept, m, interface));
        }
        let n = pivots.n;
        if n == 0 {
            return Some(pivots);
        }
        if n > partner.len() || partner.len() > WIDTH {
            return None;
        }
        let mut block = Block::default();
        for (line, &row) in block.iter_mut().zip(partner) {
            for (b, &m) in line.iter_mut().zip(pivots.multipliers()) {
                *b = self.coefficient(row, m, interface);
            }
        }
        let (order, smallest) = pivot_order(&block, partner.len(), n)?;
        if smallest.is_nan() || smallest < least * largest {
            return None;
        }
        let mut square = Block::default();
        for (a, &from) in order[..n].iter().enumerate() {
            square[a] = block[from];
            pivots.row[a] = partner[from];
        }
        pivots.inverse = inverse(&square, n)?;
        Some(pivots)
    }

    /// The pivots of a group, where its partner still serves.
    pub fn pivots(&self, kept: &Kept, group: &Group, interface: &[f64]) -> Option<Pivots> {
        self.pivots_of(kept, &group.multiplier, &group.partner, interface, KEEP)
    }

    /// The multipliers that have a partner. Without values, patterns decide.
    ///
    /// `stays` says of a raw dof that its multiplier is not to be eliminated, `before` which node was a multiplier's partner.
    pub fn groups(
        &self,
        kept: &Kept,
        values: Option<&Values>,
        stays: &[bool],
        before: &[u32],
    ) -> Vec<Group> {
        let candidates = || self.dof.iter().copied().filter(|&m| !stays[m as usize]);
        let interface = |m: u32| {
            let values = values.map(|v| v.interface);
            values.filter(|i| !Self::is_open(kept, m, i))
        };
        // (multiplier, node, coefficient over the largest)
        let mut acts: Vec<(u32, u32, f64)> = Vec::new();
        for m in candidates() {
            let begin = acts.len();
            let largest = interface(m).map(|i| self.largest(kept, m, i));
            for (row, at) in self.column(m).filter(|&(row, _)| kept.is_displacement(row)) {
                let size = match (interface(m), largest) {
                    (Some(interface), Some(largest)) => interface[at].abs() / largest,
                    _ => 1.0,
                };
                let node = kept.node_of(row);
                match acts[begin..].iter_mut().find(|(_, n, _)| *n == node) {
                    Some((.., most)) => *most = most.max(size),
                    None => acts.push((m, node, size)),
                }
            }
            acts.retain(|&(.., size)| size > 0.0);
            if acts.len() - begin > WIDE {
                acts.truncate(begin);
            }
        }
        let mut share: HashMap<u32, f64> = HashMap::new();
        for &(_, node, _) in &acts {
            *share.entry(node).or_default() += 1.0;
        }
        let was = |m: u32, node: u32| before[m as usize] == node;
        let mut offers: Vec<(f64, u32, u32)> = acts
            .iter()
            .map(|&(m, node, size)| {
                let bonus = if was(m, node) { 4.0 } else { 1.0 };
                (bonus * size / share[&node], m, node)
            })
            .collect();
        offers.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));

        let mut paired = vec![false; kept.equation.len()];
        let mut groups: BTreeMap<u32, Group> = BTreeMap::new();
        for (_, m, node) in offers {
            if paired[m as usize] {
                continue;
            }
            let group = groups.entry(node).or_insert_with(|| Group {
                multiplier: Vec::new(),
                partner: kept.equations_of(node),
            });
            if group.multiplier.len() == group.partner.len() {
                continue;
            }
            group.multiplier.push(m);
            let least = if was(m, node) { KEEP } else { TAKE };
            let fits = values.is_none_or(|v| {
                let (multipliers, partner) = (&group.multiplier, &group.partner);
                let found = self.pivots_of(kept, multipliers, partner, v.interface, least);
                found.is_some()
            });
            if fits {
                paired[m as usize] = true;
            } else {
                group.multiplier.pop();
            }
        }
        groups.retain(|_, group| !group.multiplier.is_empty());
        groups.into_values().collect()
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
