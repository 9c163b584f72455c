//! Heat across an interface, on the rows of its forces.
//!
//! A row has a number β for each participant, which sum to the covered part c of its measure on the secondary side and to −c on
//! the primary: its operator is β times the identity. With s = 1 on the secondary side and −1 on the primary, the jump and the
//! mean of temperature `[θ] = Σ β θ/c`, `θ_m = ½ Σ s β θ/c`, and the share `a = f β` or `−(1 − f) β` of either side in the heat
//! `η 𝒟` that friction sets free,
//!
//! ```text
//! R_θ  = w (β q − a η 𝒟),    q = h(p, g, θ_m, [θ]) [θ]                                           (E1)
//! K_θθ = w β dqᵀ                                                                                 (E2)
//! K_θu = w (β dqᵀ + q ∂β/∂d − η (a d𝒟ᵀ + 𝒟 ∂a/∂d))                                               (E3)
//!   dq = [θ] (h_p dp + h_g dg + h_m dθ_m) + (h + [θ] h_j) d[θ]
//!   d[θ] = (Σ θ dβ + Σ β dθ − [θ] dc)/c,  dc = Σ dβ over the secondary side, and likewise dθ_m
//! 𝒟 Δt = L (|e| − L/k) of what slips by penalties, |t·e| by multipliers                          (E4)
//! ```
//!
//! Heat that leaves one side enters the other: Σ β = 0 for all columns. Source: Wriggers, Computational Contact Mechanics, 2006,
//! section 9.7.

use super::conducting::{ContactHeat, FrictionHeat};
use super::row_heat::{Crossing, OfParticipant, ThermalScratch};
use super::rows::row_order;
use super::{Answer, Interface, Laws, Order, Participant, Rows, Scratch, Sink, State, TermError};
use crate::contact::law::{Between, Conductance, Conducted};
use crate::contact::row::Row;
use crate::system::{Dof, NO_DOF, PatternSink};

impl Interface {
    /// How it conducts in the present step; none where temperatures are given.
    pub(super) fn heat(&self) -> Option<&ContactHeat> {
        let heat = self.parts.heat.as_ref();
        heat.filter(|_| self.step.physics.has_heat() && self.is_active())
    }

    /// Whether its heat makes the tangent unsymmetric: by what it has to do with motions, and by conductances that depend on
    /// temperatures.
    pub(super) fn couples_heat(&self) -> bool {
        let radiates = |path: &Conductance| matches!(path, Conductance::Radiation { .. });
        self.heat()
            .is_some_and(|heat| self.step.physics.moves || heat.paths.iter().any(radiates))
    }

    /// Whether heat goes across a gap.
    pub(super) fn conducts_at(&self, gap: f64) -> bool {
        let within = |path: &Conductance| path.reach().is_none_or(|reach| gap <= reach);
        self.heat()
            .is_some_and(|heat| heat.paths.iter().any(within))
    }

    /// Adds what temperatures and these unknowns, of a row and what it meets, couple.
    pub(super) fn couple_heat(&self, dofs: &[Dof], out: &mut dyn PatternSink) {
        if self.heat().is_none() {
            return;
        }
        let names = dofs.iter().filter_map(|&dof| self.layout.name(dof));
        let nodes = names.filter_map(|name| Some(name.displacement()?.0));
        let mut heat: Vec<Dof> = nodes.map(|node| self.layout.temperature(node)).collect();
        heat.dedup();
        out.interface(&heat);
        if self.step.physics.moves {
            out.coupling(&heat, dofs);
        }
    }

    /// Adds the heat of a row.
    pub(super) fn conduct(
        &self,
        (row, answer): (usize, Option<&Answer>),
        trial: &State,
        order: Order,
        scratch: &mut Scratch,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        let Some(crossing) = self.crossing((row, answer), trial, order, scratch)? else {
            return Ok(());
        };
        let Crossing {
            conducted,
            jump_and_mean,
            measure,
            power,
            friction,
        } = crossing;
        let [jump, _] = jump_and_mean;
        if conducted == Conducted::default() && power == 0.0 {
            return Ok(());
        }
        let s = &mut scratch.thermal;
        s.add_residual(&conducted, jump, (measure, power), friction);
        s.stiffness.clear();
        s.coupling.clear();
        if order == Order::Tangent {
            s.add_stiffness(&conducted, jump, measure);
        }
        out.add(&s.dofs, &s.force, &s.stiffness);
        if order == Order::Tangent
            && self.step.physics.moves
            && let Some(filled) = scratch.rows.rows().first()
        {
            s.couple(
                filled,
                (&conducted, jump_and_mean),
                (measure, power),
                (friction, self.duration),
            );
            scratch.rows.dofs(&self.layout, &mut scratch.dofs);
            self.multiplier_dofs(row, &mut scratch.dofs);
            out.couple(&s.dofs, &scratch.dofs, &s.coupling);
        }
        // the rounding of temperatures, and that of positions through the pressure
        let s = &scratch.thermal;
        let temperatures = s.participants.iter().map(|of| of.temperature.abs());
        let far = temperatures.fold(0.0, f64::max);
        let pressed = self.rounding(&scratch.rows, trial, answer) * conducted.dpressure * jump;
        let error = f64::EPSILON * measure * conducted.h.abs() * far + pressed.abs();
        out.uncertain(&s.dofs, error);
        Ok(())
    }

    /// What goes across a row, with its participants in the scratch; none where nothing can.
    pub(super) fn crossing(
        &self,
        (row, answer): (usize, Option<&Answer>),
        trial: &State,
        order: Order,
        scratch: &mut Scratch,
    ) -> Result<Option<Crossing>, TermError> {
        let Some(heat) = self.heat() else {
            return Ok(None);
        };
        if self.now.pairs.get(row).is_none_or(Option::is_none) {
            return Ok(None);
        }
        self.fill(row, trial, row_order(order), &mut scratch.rows)?;
        let Some(filled) = scratch.rows.rows().first() else {
            return Ok(None);
        };
        let s = &mut scratch.thermal;
        if !self.take_temperatures(heat, &scratch.rows, filled, trial, s) {
            return Ok(None);
        }
        let lambda = self.lambda(row, trial);
        let laws = Laws {
            answer,
            ..self.laws_of(row)
        };
        let past = self.history.past(row);
        let width = filled.weights.len() + self.ncolumn_of_multiplier();
        let pressure = laws.slopes(filled, &lambda, past, width, &mut s.slopes);
        let jump_and_mean = s.jump_and_mean();
        let [jump, mean] = jump_and_mean;
        let at = Between {
            pressure: pressure.max(0.0),
            gap: filled.gap,
            mean,
            jump,
        };
        let mut conducted = Conducted::default();
        for path in heat.paths.iter().filter(|_| !s.insulated) {
            conducted += path.at(&at, &self.parts.scale).times(heat.share);
        }
        if pressure <= 0.0 {
            conducted.dpressure = 0.0;
        }
        let power = match heat.friction.filter(|_| self.duration > 0.0) {
            Some(_) => s.slopes.dissipated / self.duration,
            None => 0.0,
        };
        let mut friction = heat.friction.unwrap_or(FrictionHeat {
            fraction: 0.0,
            to_secondary: 0.5,
        });
        if s.insulated {
            friction.to_secondary = 1.0;
        }
        Ok(Some(Crossing {
            conducted,
            jump_and_mean,
            measure: self.measure(row),
            power,
            friction,
        }))
    }

    /// Takes β and θ of the participants; false where nothing is opposite.
    fn take_temperatures(
        &self,
        heat: &ContactHeat,
        rows: &Rows,
        row: &Row,
        trial: &State,
        s: &mut ThermalScratch,
    ) -> bool {
        s.participants.clear();
        s.dofs.clear();
        s.dbeta.clear();
        s.coverage = row.coverage;
        s.insulated = false;
        let n = row.weights.len();
        let secondary = rows.secondary();
        let mut first = 0;
        let mut sum = 0.0;
        for (place, participant) in rows.participants().iter().enumerate() {
            let beta = row.sliding.operator.get(first).map_or(0.0, |b| b.x);
            let (dof, value) = match *participant {
                Participant::Node(node) => {
                    let dof = self.layout.temperature(node);
                    (dof, trial.u.get(dof as usize).copied())
                }
                Participant::Rigid(_) => (NO_DOF, Some(s.of_surface(heat.primary))),
            };
            let Some(temperature) = value else {
                return false;
            };
            sum += beta;
            s.dofs.push(dof);
            row.sliding.dnumber(first, &mut s.dbeta);
            s.participants.push(OfParticipant {
                temperature,
                beta,
                side: if secondary.contains(&place) {
                    1.0
                } else {
                    -1.0
                },
            });
            first += participant.ncolumn();
        }
        s.dcoverage.clear();
        s.dcoverage.resize(n, 0.0);
        let lines = s.dbeta.chunks_exact(n.max(1)).zip(&s.participants);
        for (line, _) in lines.filter(|(_, of)| of.side > 0.0) {
            let to = s.dcoverage.iter_mut();
            to.zip(line).for_each(|(to, d)| *to += d);
        }
        if s.coverage <= 0.0 {
            return false;
        }
        // a surface fixed in space takes no part in the row
        if sum <= 0.5 * row.coverage {
            return true;
        }
        let temperature = s.of_surface(heat.primary);
        s.dofs.push(NO_DOF);
        s.participants.push(OfParticipant {
            temperature,
            beta: -sum,
            side: -1.0,
        });
        s.dbeta.extend(s.dcoverage.iter().map(|d| -d));
        true
    }
}
