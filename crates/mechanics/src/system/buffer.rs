//! What a chunk of a term contributes before it is added.

use super::{Dof, Layout, Sink, TermError, Work};

#[derive(Default)]
pub(super) struct Slot {
    pub work: Work,
    pub buffer: Buffer,
    pub failure: Option<TermError>,
    pub energy: Option<f64>,
}

/// What a chunk added, one contribution after the other.
#[derive(Default)]
pub(super) struct Buffer {
    pub contributions: Vec<Contribution>,
    pub dofs: Vec<Dof>,
    pub force: Vec<f64>,
    pub stiffness: Vec<f64>,
    /// What couples fields: the numbers of rows and columns of each, their dofs one after the other, and the stiffnesses.
    pub couplings: Vec<[usize; 2]>,
    pub coupled: Vec<Dof>,
    pub coupling: Vec<f64>,
    /// Errors at other dofs than those of a contribution.
    pub errors: Vec<(Dof, f64)>,
    /// Whether unknowns in it follow others.
    pub has_dependent: bool,
}

/// One contribution: how much of the lists is its own.
pub(super) struct Contribution {
    pub ndof: usize,
    pub nstiffness: usize,
    /// Whether the stiffness is in blocks as [`Sink::add_symmetric`] has them.
    pub is_symmetric: bool,
    /// The uncertainty of its forces.
    pub error: f64,
}

impl Contribution {
    /// Takes the places of its blocks in the bulk off a list.
    pub fn positions<'p>(&self, ndim: usize, all: &mut &'p [u32]) -> &'p [u32] {
        let nblock = if self.nstiffness > 0 {
            self.ndof / ndim.max(1)
        } else {
            0
        };
        all.split_off(..nblock * nblock).unwrap_or_default()
    }
}

impl Buffer {
    pub fn push(&mut self, dofs: &[Dof], force: &[f64], stiffness: &[f64], is_symmetric: bool) {
        debug_assert_eq!(dofs.len(), force.len());
        self.contributions.push(Contribution {
            ndof: dofs.len(),
            nstiffness: stiffness.len(),
            is_symmetric,
            error: 0.0,
        });
        self.dofs.extend_from_slice(dofs);
        self.force.extend_from_slice(force);
        self.stiffness.extend_from_slice(stiffness);
    }

    /// Multiplies the stiffness against motions, the columns of all unknowns but multipliers.
    pub fn scale_motions(&mut self, factor: f64, layout: &Layout) {
        let first = layout.multiplier(0);
        if self.dofs.iter().all(|&dof| dof < first) {
            self.stiffness.iter_mut().for_each(|k| *k *= factor);
            return;
        }
        self.each_entry(|[_, column], k| {
            if column < first {
                *k *= factor;
            }
        });
    }

    /// Leaves of the stiffness what couples multipliers with others.
    pub fn keep_constraints(&mut self, layout: &Layout) {
        let first = layout.multiplier(0);
        self.each_entry(|[row, column], k| {
            if row < first && column < first {
                *k = 0.0;
            }
        });
    }

    /// Hands row, column and value of every entry of the stiffness to `change`; blocks of [`Sink::add_symmetric`], which have
    /// no multipliers, as if both were the first unknown.
    fn each_entry(&mut self, mut change: impl FnMut([Dof; 2], &mut f64)) {
        let (mut dofs, mut stiffness) = (&self.dofs[..], &mut self.stiffness[..]);
        for own in &self.contributions {
            let (of_own, rest) = dofs.split_at(own.ndof);
            let (entries, others) = std::mem::take(&mut stiffness).split_at_mut(own.nstiffness);
            (dofs, stiffness) = (rest, others);
            if own.is_symmetric {
                entries.iter_mut().for_each(|k| change([0, 0], k));
                continue;
            }
            let rows = entries.chunks_exact_mut(own.ndof.max(1)).zip(of_own);
            for (values, &row) in rows {
                let columns = values.iter_mut().zip(of_own);
                columns.for_each(|(k, &column)| change([row, column], k));
            }
        }
    }

    pub fn clear(&mut self) {
        self.contributions.clear();
        self.dofs.clear();
        self.force.clear();
        self.stiffness.clear();
        self.couplings.clear();
        self.coupled.clear();
        self.coupling.clear();
        self.errors.clear();
    }

    /// What couples fields: rows, columns and stiffness of each.
    pub fn couplings(&self) -> impl Iterator<Item = (&[Dof], &[Dof], &[f64])> {
        let (mut dofs, mut stiffness) = (&self.coupled[..], &self.coupling[..]);
        self.couplings.iter().map(move |&[nrow, ncolumn]| {
            let mut take = |n| dofs.split_off(..n).unwrap_or_default();
            let (rows, columns) = (take(nrow), take(ncolumn));
            let own = stiffness.split_off(..nrow * ncolumn).unwrap_or_default();
            (rows, columns, own)
        })
    }

    /// Each contribution with its dofs, forces and stiffness.
    pub fn iter(&self) -> impl Iterator<Item = (&Contribution, &[Dof], &[f64], &[f64])> {
        let (mut at, mut at_stiffness) = (0, 0);
        self.contributions.iter().map(move |own| {
            let (of_dofs, of_stiffness) = (
                at..at + own.ndof,
                at_stiffness..at_stiffness + own.nstiffness,
            );
            (at, at_stiffness) = (of_dofs.end, of_stiffness.end);
            (
                own,
                &self.dofs[of_dofs.clone()],
                &self.force[of_dofs],
                &self.stiffness[of_stiffness],
            )
        })
    }
}

impl Sink for Buffer {
    fn add(&mut self, dofs: &[Dof], force: &[f64], stiffness: &[f64]) {
        debug_assert!(stiffness.is_empty() || stiffness.len() == dofs.len() * dofs.len());
        self.push(dofs, force, stiffness, false);
    }

    fn add_symmetric(&mut self, dofs: &[Dof], force: &[f64], blocks: &[f64], _: usize) {
        self.push(dofs, force, blocks, true);
    }

    fn couple(&mut self, rows: &[Dof], columns: &[Dof], stiffness: &[f64]) {
        debug_assert_eq!(stiffness.len(), rows.len() * columns.len());
        self.couplings.push([rows.len(), columns.len()]);
        self.coupled.extend_from_slice(rows);
        self.coupled.extend_from_slice(columns);
        self.coupling.extend_from_slice(stiffness);
    }

    fn uncertain(&mut self, dofs: &[Dof], error: f64) {
        match self.contributions.last_mut() {
            Some(last) if self.dofs.ends_with(dofs) && last.ndof == dofs.len() => {
                last.error += error;
            }
            _ => self.errors.extend(dofs.iter().map(|&d| (d, error))),
        }
    }
}
