//! The heat across an interface in the last accepted increment: what audits and results know of it.

use super::row_heat::Warmth;
use super::{Archive, ArchiveError, Interface, Order, Scratch, State, TermError};
use crate::system::{Conducting, HeatFlows, NO_DOF, SizedFlows};

impl Interface {
    /// Takes note of the heat of all rows at a state that is being accepted, before what they remember moves on: sums over rows, of
    /// which no participant is asked but a surface that is no unknown.
    pub(super) fn keep_heat(&mut self, state: &State) -> Result<(), TermError> {
        let mut warmth = Warmth::default();
        if self.heat().is_some() {
            let nrow = self.parts.discretization.nrow();
            let mut scratch = Scratch::default();
            warmth.rubbed.resize(nrow, 0.0);
            for row in 0..nrow {
                let crossing = self.crossing((row, None), state, Order::Residual, &mut scratch)?;
                let Some(crossing) = crossing else { continue };
                let [_, _, rubbed] = crossing.per_area();
                let s = &mut scratch.thermal;
                let [jump, _] = crossing.jump_and_mean;
                let works = (crossing.measure, crossing.power);
                s.add_residual(&crossing.conducted, jump, works, crossing.friction);
                let outside = s.dofs.iter().zip(&s.force);
                let outside = outside.filter(|(dof, _)| **dof == NO_DOF);
                warmth.flows.add(HeatFlows {
                    friction: self.measure(row) * s.coverage * rubbed,
                    surfaces: outside.map(|(_, out)| out).sum(),
                    ..HeatFlows::default()
                });
                if let Some(to) = warmth.rubbed.get_mut(row) {
                    *to = rubbed;
                }
            }
        }
        self.warmth = warmth;
        Ok(())
    }

    /// Heat per area of a row at the accepted state: the flux out of the secondary side, the conductance, and what friction set free.
    pub(super) fn warmth_of(
        &self,
        row: usize,
        state: &State,
        scratch: &mut Scratch,
    ) -> Result<[f64; 3], TermError> {
        let crossing = self.crossing((row, None), state, Order::Residual, scratch)?;
        let [flux, conductance, _] = crossing.map_or([0.0; 3], |of| of.per_area());
        Ok([flux, conductance, self.warmth.rubbed(row)])
    }

    /// Stores what friction set free, where it does.
    pub(super) fn store_heat(&self, out: &mut Archive) {
        if self.warmth.rubbed.iter().any(|rubbed| *rubbed != 0.0) {
            let name = format!("contact.{}.rubbed", self.stored_name());
            out.put(name, &self.warmth.rubbed);
        }
    }

    pub(super) fn restore_heat(&mut self, from: &Archive) -> Result<(), ArchiveError> {
        self.warmth = Warmth::default();
        let name = format!("contact.{}.rubbed", self.stored_name());
        if from.length(&name).is_ok() {
            let nrow = self.parts.discretization.nrow();
            self.warmth.rubbed.resize(nrow, 0.0);
            from.get(&name, &mut self.warmth.rubbed)?;
        }
        Ok(())
    }
}

impl Conducting for Interface {
    fn flows(&self) -> SizedFlows {
        self.warmth.flows
    }
}
