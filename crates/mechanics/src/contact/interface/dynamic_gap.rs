//! Gaps that rows carry from increment to increment where energy is conserved.
//!
//! ```text
//! γ₁ = γ₀ + b(x_α)·Δd                                                                            (E9)
//! ```
//!
//! is what the law sees at the end of an increment, and [`secant`](crate::contact::law::secant) takes the pressure from the energies at
//! γ₀ and γ₁: with that the contact force does exactly the work of the law's potential. A row has a measured gap at the start of the
//! increment in which it closes, and its own from then on, until the law acts at neither gap: its γ differs from the measured gap by what
//! weights change within increments, which is of second order in their length.
//!
//! Laws with a multiplier have no energy to take the secant of: they see the end of the increment, (E7) of `carried`.
//!
//! Source: Armero and Petőcz, CMAME 158, 1998, section 4 (the dynamic gap function).

use super::{Interface, Rows, State, TermError};
use crate::contact::law::{Eval, Multiplier};
use crate::contact::row::RowOrder;

impl Interface {
    /// Whether forces are secants of a potential.
    pub(super) fn conserves(&self) -> bool {
        self.step.conserves() && self.parts.law.multiplier() == Multiplier::None
    }

    /// Whether rows have dynamic gaps.
    fn carries_gaps(&self) -> bool {
        self.conserves() && self.parts.bond.is_none() && self.is_active()
    }

    /// γ₀ of the rows where an increment begins.
    pub(super) fn begin_gaps(&mut self, from: &State) -> Result<(), TermError> {
        let mut gaps = std::mem::take(&mut self.gaps);
        gaps.start.clear();
        gaps.reached.clear();
        gaps.time = from.time;
        if self.carries_gaps() {
            let mut rows = Rows::default();
            for row in 0..self.parts.discretization.nrow() {
                self.relate(row, from, RowOrder::Gap, &mut rows)?;
                let measured = rows.rows().first().map(|filled| filled.gap);
                let start = measured.map(|gap| self.carried_gap(row, gap, from.time));
                gaps.start.push(start);
            }
        }
        self.gaps = gaps;
        Ok(())
    }

    /// The gap of a row with this measured one, both without what is added to them at a time: that which it has kept, as long as the
    /// law acts at either of the two.
    pub(super) fn carried_gap(&self, row: usize, measured: f64, time: f64) -> f64 {
        let Some(kept) = self.gap_kept(row) else {
            return measured;
        };
        let (law, scale) = (&self.parts.law, &self.parts.scale);
        let shift = self.shift(row, time);
        let acts = |gap: f64| law.pressure(gap + shift, 0.0, scale) != Eval::default();
        if acts(kept) || acts(measured) {
            kept
        } else {
            measured
        }
    }

    /// γ₁ of the rows at an iterate that was found.
    pub(super) fn reach_gaps(&mut self, trial: &State) -> Result<(), TermError> {
        let mut reached = std::mem::take(&mut self.gaps.reached);
        reached.clear();
        if self.carries_gaps() && trial.between.is_some() {
            let mut rows = Rows::default();
            for row in 0..self.parts.discretization.nrow() {
                self.fill(row, trial, RowOrder::Gap, &mut rows)?;
                let gap = rows.rows().first().map(|filled| filled.gap);
                reached.push(gap.map(|gap| gap - self.shift(row, trial.time)));
            }
        }
        self.gaps.reached = reached;
        Ok(())
    }

    /// The increment has ended: rows keep γ₁.
    pub(super) fn keep_gaps(&mut self) {
        let reached = self.gaps.reached.iter().copied();
        let all = reached.chain(std::iter::repeat(None));
        for (memory, gap) in self.history.accepted.iter_mut().zip(all) {
            memory.gap = gap;
        }
    }

    /// Fills a row for a report of the increment that has ended: pressures are those that acted in it. Says whether there is one.
    pub(super) fn reported_row(
        &self,
        row: usize,
        state: &State,
        rows: &mut Rows,
    ) -> Result<bool, TermError> {
        let start = self.gap_at_start(row);
        let Some([_, from]) = start.filter(|_| self.gap_kept(row).is_some()) else {
            return self.acting_row(row, state, RowOrder::Gradient, rows);
        };
        self.fill(row, state, RowOrder::Gradient, rows)?;
        let (laws, lambda) = (self.laws(), self.lambda(row, state));
        let filled = rows.rows_mut().first_mut();
        Ok(filled.is_some_and(|filled| {
            filled.from = Some(from);
            laws.acts(filled.seen(), filled.normal, &lambda)
        }))
    }

    /// γ₀ of a row, without what is added to it, and with that.
    pub(super) fn gap_at_start(&self, row: usize) -> Option<[f64; 2]> {
        let start = self.gaps.start.get(row).copied().flatten()?;
        Some([start, start + self.shift(row, self.gaps.time)])
    }

    /// The gap that a row has kept from the increment before.
    pub(super) fn gap_kept(&self, row: usize) -> Option<f64> {
        let memory = self.history.accepted.get(row)?;
        memory.gap.filter(|_| self.carries_gaps())
    }
}
