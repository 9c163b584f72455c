//! Contact forces that count with those before, as CalculiX has it.
//!
//! ```text
//! f = (1 − αf) f₁ + αf f₀ + f_damper                                                              (E12)
//! ```
//!
//! with the force f₁ of what the row has at the end of the increment, (E7) of `carried`, and that of the increment before, both without
//! dampers. Stiff contact flickers by it, and may gain energy: the force of a row that has just closed is weighted with none.
//!
//! Source: Hilber, Hughes and Taylor, EESD 5, 1977, equation (3), of all internal forces.

use super::memory::Ends;
use super::{Interface, Multiplier, Order, Scratch, Sink, State, TermError};
use crate::system::{Dof, NO_DOF};

/// Takes forces, one after the other.
struct Forces(Vec<(Dof, f64)>);

impl Sink for Forces {
    fn add(&mut self, dofs: &[Dof], force: &[f64], _: &[f64]) {
        let own = dofs.iter().zip(force);
        let own = own.filter(|(dof, force)| **dof != NO_DOF && **force != 0.0);
        self.0.extend(own.map(|(dof, force)| (*dof, *force)));
    }

    fn couple(&mut self, _: &[Dof], _: &[Dof], _: &[f64]) {}

    fn uncertain(&mut self, _: &[Dof], _: f64) {}
}

impl Forces {
    /// One force for each unknown.
    fn sums(mut self) -> Vec<(Dof, f64)> {
        self.0.sort_by_key(|(dof, _)| *dof);
        self.0.dedup_by(|next, kept| {
            let is_same = next.0 == kept.0;
            if is_same {
                kept.1 += next.1;
            }
            is_same
        });
        self.0
    }
}

impl Interface {
    /// αf, where forces count with those before.
    fn share_of_before(&self) -> Option<f64> {
        let scheme = self.step.scheme.filter(|scheme| scheme.weighted)?;
        let has_pressure = self.parts.law.multiplier() == Multiplier::None;
        has_pressure.then_some(scheme.alpha_f)
    }

    /// By what all forces of rows are multiplied, where some count with those before.
    pub(super) fn share_of_elastic(&self) -> f64 {
        1.0 - self.share_of_before().unwrap_or_default()
    }

    /// The share of f₁ in the forces of an iterate, where it is not all of them.
    pub(super) fn share_of_end(&self, trial: &State) -> Option<f64> {
        let before = self.share_of_before()?;
        trial.between.is_some().then_some(1.0 - before)
    }

    /// f₀ where increments begin that count with it.
    pub(super) fn begin_ends(&mut self, from: &State) -> Result<(), TermError> {
        if self.share_of_before().is_none() {
            self.ends = Ends::default();
        } else if self.ends.before.is_none() {
            self.ends.before = Some(self.forces(from)?);
        }
        Ok(())
    }

    /// f₁ of an iterate that was found.
    pub(super) fn reach_ends(&mut self, trial: &State) -> Result<(), TermError> {
        if let Some(share) = self.share_of_end(trial) {
            let duration = std::mem::take(&mut self.duration);
            let forces = self.forces(trial);
            self.duration = duration;
            let mut forces = forces?;
            forces.iter_mut().for_each(|(_, force)| *force /= share);
            self.ends.reached = Some(forces);
        }
        Ok(())
    }

    /// The forces of all rows.
    fn forces(&self, trial: &State) -> Result<Vec<(Dof, f64)>, TermError> {
        let mut scratch = Scratch::default();
        let mut forces = Forces(Vec::new());
        let mut asked = std::mem::take(&mut scratch.asked);
        let rows = 0..self.parts.discretization.nrow();
        self.ask(rows.clone(), trial, &mut scratch.rows, &mut asked)?;
        for (row, answer) in rows.zip(asked.answers()) {
            let row = (row, answer);
            self.act(row, trial, Order::Residual, &mut scratch, &mut forces)?;
        }
        Ok(forces.sums())
    }

    /// What f₀ adds to the forces of an iterate.
    pub(super) fn add_before(&self, trial: &State, order: Order, out: &mut dyn Sink) {
        let share = self.share_of_before().filter(|_| trial.between.is_some());
        let (Some(share), Some(before)) = (share, &self.ends.before) else {
            return;
        };
        let none: &[f64] = match order {
            Order::Residual => &[],
            Order::Tangent => &[0.0],
        };
        for (dof, force) in before {
            out.add(&[*dof], &[share * force], none);
        }
    }
}
