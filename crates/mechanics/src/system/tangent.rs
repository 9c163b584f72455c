//! What is read off a tangent, and small changes of it.

use super::assembly::Assembly;
use super::strip::largest;
use super::{Assembler, Dof, Layout};

/// Compliance of redundant multipliers over that of what they act on: far below all that is of interest, far above rounding.
const YIELDING: f64 = 1e-6;

/// How many times the largest stiffness of bodies another may be before rounding errors hide theirs.
const HIDING: f64 = 1e13;

impl Assembler {
    /// The dof in whose row of the operator the largest number is; one that is not finite is the largest.
    pub fn largest_entry(&self, out: &Assembly) -> Option<Dof> {
        let row = |starts: &[usize], at: usize| {
            let begun = starts.partition_point(|&start| start <= at);
            begun.checked_sub(1)
        };
        let (bulk, interface) = (largest(&out.bulk), largest(&out.interface));
        let of_interface = match (bulk, interface) {
            (Some((_, k)), Some((_, i))) => i.total_cmp(&k).is_gt(),
            (_, other) => other.is_some(),
        };
        let ndim = self.bulk.block;
        let dof = if of_interface {
            row(&self.interface.row_start, interface?.0)?
        } else {
            let (node, within) = (bulk?.0 / (ndim * ndim), bulk?.0 % (ndim * ndim));
            row(&self.bulk.row_start, node)? * ndim + within / ndim
        };
        Some(dof as Dof)
    }

    /// Whether the stiffness of bodies is lost in the rounding errors of the stiffness between them.
    pub fn hides_bodies(&self, out: &Assembly) -> bool {
        let has_bodies = self.bulk.partition.is_some() || !out.bulk.is_empty();
        let interface = largest(&out.interface).filter(|_| has_bodies);
        interface.is_some_and(|(_, i)| i > HIDING * out.largest_of_bulk())
    }

    /// Adds the largest stiffness there is to the diagonal at a dof, and returns it; `None` where it has no place.
    pub fn stiffen(&self, dof: Dof, out: &mut Assembly) -> Option<f64> {
        let interface = out.interface.iter();
        let stiffness = interface.fold(out.largest_of_bulk(), |most: f64, k| most.max(k.abs()));
        let (ndim, node) = (self.bulk.block, dof / self.bulk.block.max(1) as u32);
        let of_block = (node as usize) < self.bulk.nrow() && self.bulk.has_row(node);
        if of_block {
            // one rank has the row
            let place = self.bulk.position(node, node).and_then(|block| {
                let axis = dof as usize % ndim;
                out.bulk.get_mut(block * ndim * ndim + axis * (ndim + 1))
            });
            place.into_iter().for_each(|to| *to += stiffness);
        } else {
            let position = self.interface.position(dof, dof)?;
            *out.interface.get_mut(position)? += stiffness;
        }
        out.bulk_of = None;
        Some(stiffness)
    }

    /// Adds a compliance to multipliers that act on unknowns with a stiffness, in the tangent `out` alone: `YIELDING` times
    ///
    /// ```text
    /// Σ_j B_j² / K_jj                                                                          (E4)
    /// ```
    ///
    /// with the coefficients `B_j` of the multiplier and the stiffness `K_jj` of what they act on, which is about the compliance
    /// of its equation once displacements are eliminated. Returns the number of these multipliers.
    ///
    /// Where several are redundant, the tangent is singular though the problem is not: with this each takes the share that a
    /// very stiff joint would give it. Residuals stay as they are, so that the state that is found is not changed.
    pub fn relax(&self, layout: &Layout, out: &mut Assembly) -> usize {
        let pattern = &self.interface;
        let multipliers =
            layout.multiplier(0) as usize..layout.multiplier(layout.nmultiplier()) as usize;
        let mut added: Vec<(usize, f64)> = Vec::new();
        for row in multipliers.clone() {
            let Some(&[begin, end]) = pattern.row_start.get(row..row + 2) else {
                continue;
            };
            let columns = pattern.column.get(begin..end).unwrap_or_default();
            let coefficients = out.interface.get(begin..end).unwrap_or_default();
            let mut compliance = 0.0;
            for (&column, b) in columns.iter().zip(coefficients) {
                if *b != 0.0 && !multipliers.contains(&(column as usize)) {
                    let stiffness = self.stiffness_of(column, out);
                    compliance += if stiffness > 0.0 {
                        b * b / stiffness
                    } else {
                        0.0
                    };
                }
            }
            let diagonal = pattern.position(row as Dof, row as Dof);
            if let Some(at) = diagonal.filter(|_| compliance > 0.0) {
                added.push((at, YIELDING * compliance));
            }
        }
        for &(at, compliance) in &added {
            if let Some(entry) = out.interface.get_mut(at) {
                *entry -= compliance;
            }
        }
        added.len()
    }

    /// The largest entry of the stiffness of the bodies.
    pub fn stiffest(of: &Assembly) -> f64 {
        of.largest_of_bulk()
    }

    /// The entry of an unknown on the diagonal of a tangent.
    fn stiffness_of(&self, dof: Dof, of: &Assembly) -> f64 {
        let (ndim, node) = (self.bulk.block, dof / self.bulk.block.max(1) as u32);
        let in_bulk = (node as usize) < self.bulk.nrow();
        let block = in_bulk.then(|| self.bulk.position(node, node)).flatten();
        let place = block.map(|block| block * ndim * ndim + dof as usize % ndim * (ndim + 1));
        let of_bulk = match &of.of_ranks {
            Some(of_ranks) => of_ranks.diagonal.get(dof as usize),
            None => place.and_then(|at| of.bulk.get(at)),
        };
        let position = self.interface.position(dof, dof);
        let of_interface = position.and_then(|at| of.interface.get(at));
        of_bulk.copied().unwrap_or_default() + of_interface.copied().unwrap_or_default()
    }

    /// Takes the symmetric part of an operator; returns the largest entry of the rest over that of the operator.
    pub fn symmetrize(&self, of: &mut Assembly) -> f64 {
        let largest = of.bulk.iter().chain(&of.interface);
        let largest = largest.fold(0.0, |most: f64, k| most.max(k.abs()));
        let mut apart = 0.0;
        let mut even = |values: &mut [f64], one: usize, other: usize| {
            let pair = values.get(one).copied().zip(values.get(other).copied());
            let Some((a, b)) = pair else { return };
            apart = f64::max(apart, 0.5 * (a - b).abs());
            for at in [one, other] {
                if let Some(value) = values.get_mut(at) {
                    *value = 0.5 * (a + b);
                }
            }
        };
        let ndim = self.bulk.block;
        let rows = self.bulk.row_start.windows(2).enumerate();
        for (row, range) in rows {
            let &[begin, end] = range else { continue };
            let columns = self.bulk.column.get(begin..end).unwrap_or_default();
            for (block, &column) in (begin..end).zip(columns) {
                let across = self.bulk.position(column, row as u32);
                let Some(across) = across.filter(|_| column as usize >= row) else {
                    continue;
                };
                for (i, j) in (0..ndim).flat_map(|i| (0..ndim).map(move |j| (i, j))) {
                    let at = |block: usize, i: usize, j: usize| (block * ndim + i) * ndim + j;
                    even(&mut of.bulk, at(block, i, j), at(across, j, i));
                }
            }
        }
        for (row, range) in self.interface.row_start.windows(2).enumerate() {
            let &[begin, end] = range else { continue };
            let columns = self.interface.column.get(begin..end).unwrap_or_default();
            for (at, &column) in (begin..end).zip(columns) {
                let across = self.interface.position(column, row as u32);
                if let Some(across) = across.filter(|_| column as usize > row) {
                    even(&mut of.interface, at, across);
                }
            }
        }
        if largest > 0.0 { apart / largest } else { 0.0 }
    }
}
