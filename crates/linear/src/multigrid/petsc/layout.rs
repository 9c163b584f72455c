//! Which rank has which equations, and how all ranks number them.
//!
//! ```text
//!   rank 0                          rank 1
//!   u of its nodes, three each │ others │ u of its nodes │ others │ …      others: multipliers, motions of rigid bodies, …
//! ```
//!
//! Nodes are those of the [`Partition`] of the bulk. A prescribed component keeps its place, with a row of its own, so
//! that blocks stay blocks. What is no component of a deformable node goes to the rank of a node that it acts on.

use super::super::fine::Fine;
use super::super::grid::Numbers;
use crate::partition::Partition;
use crate::problem::Kept;
use crate::sparsity::NONE;

/// The numbers of all equations as one rank sees them.
pub(super) struct Layout {
    /// The rows of the finest level that this rank has, in their order.
    pub rows: Vec<u32>,
    /// The number of the first component of each row of the finest level among the bodies' alone.
    pub body: Vec<u32>,
    /// The number of each equation.
    pub number: Vec<u32>,
    /// The equation of each entry of this rank, or `NONE`.
    pub own: Vec<u32>,
    /// How many entries each rank has.
    pub counts: Vec<usize>,
    /// The number of the first entry of this rank.
    pub first: usize,
}

impl Layout {
    /// Shares out the equations of a problem whose rows are divided like this.
    pub fn new(kept: &Kept, fine: &Fine, numbers: &Numbers, partition: &Partition) -> Self {
        let ranks = partition.ranks();
        let (rank, size) = (ranks.rank(), ranks.size());
        let of_node = |&node: &u32| partition.owner(node).unwrap_or_default() as u32;
        let owner: Vec<u32> = fine.node.iter().map(of_node).collect();
        let others = others(kept, fine, numbers, &owner);
        let mut counts = vec![0; size];
        let mut nbody = vec![0; size];
        for &p in &owner {
            nbody[p as usize] += 3;
        }
        counts.copy_from_slice(&nbody);
        for &(_, p) in &others {
            counts[p as usize] += 1;
        }
        // the first number of each rank, of all equations and of the bodies' alone
        let before = |counts: &[usize]| {
            let mut end = 0;
            let mut first = Vec::with_capacity(counts.len());
            for n in counts {
                first.push(end as u32);
                end += n;
            }
            first
        };
        let mut next_body = before(&nbody);
        let mut next = before(&counts);
        let first = next.get(rank).copied().unwrap_or(0);
        let mut number = vec![NONE; kept.sign.len()];
        let mut own = vec![NONE; counts.get(rank).copied().unwrap_or(0)];
        let mut rows = Vec::new();
        let mut body = Vec::with_capacity(owner.len());
        let mut give = |e: u32, p: usize| {
            let n = next[p];
            next[p] += 1;
            if e != NONE {
                number[e as usize] = n;
                if p == rank {
                    own[(n - first) as usize] = e;
                }
            }
        };
        for ((row, &p), of_row) in (0..).zip(&owner).zip(&numbers.of_row) {
            body.push(next_body[p as usize]);
            next_body[p as usize] += 3;
            of_row.iter().for_each(|&e| give(e, p as usize));
            if p as usize == rank {
                rows.push(row);
            }
        }
        others.iter().for_each(|&(e, p)| give(e, p as usize));
        Self {
            rows,
            body,
            number,
            own,
            counts,
            first: first as usize,
        }
    }

    /// The entries of this rank that are components of its rows.
    pub fn nbody(&self) -> usize {
        3 * self.rows.len()
    }

    /// The entries of all ranks.
    pub fn total(&self) -> usize {
        self.counts.iter().sum()
    }

    /// The entries of this rank of a list with one entry per equation; zero where a component is prescribed.
    pub fn take(&self, whole: &[f64], own: &mut [f64]) {
        for (own, &e) in own.iter_mut().zip(&self.own) {
            *own = whole.get(e as usize).copied().unwrap_or(0.0);
        }
    }
}

/// The equations that are no component of a row of the finest level, with their rank: that of the first row that each acts
/// on.
fn others(kept: &Kept, fine: &Fine, numbers: &Numbers, owner: &[u32]) -> Vec<(u32, u32)> {
    let nbulk = 3 * kept.bulk.nrow();
    let partner = |dof: u32| {
        let columns = kept.interface_row(dof).map(|(column, _)| column as usize);
        let mut rows = columns
            .filter(|&c| c < nbulk)
            .map(|c| fine.row(c / 3))
            .filter(|&row| row != NONE);
        let row = rows.next()?;
        owner.get(row as usize).copied()
    };
    let equations = (0..).zip(&numbers.fine).zip(&numbers.raw);
    let beyond = equations.filter(|((_, unknown), _)| **unknown == NONE);
    beyond
        .map(|((e, _), &dof)| (e, partner(dof).unwrap_or(0)))
        .collect()
}
