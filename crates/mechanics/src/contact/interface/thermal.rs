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

use super::rows::row_order;
use super::{Answer, Interface, Laws, Order, Participant, Rows, Scratch, Sink, State, TermError};
use crate::contact::kernel::Slopes;
use crate::contact::law::{Between, Conductance, Conducted};
use crate::contact::row::Row;
use crate::system::{Dof, NO_DOF, PatternSink};

/// How an interface conducts, and what becomes of the heat of friction.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactHeat {
    /// The ways that heat takes.
    pub paths: Vec<Conductance>,
    /// The heat of friction; none: it is lost.
    pub friction: Option<FrictionHeat>,
    /// The temperature of a primary side that has no nodes; none: it neither gives nor takes heat.
    pub primary: Option<f64>,
    /// The part of the conductance that counts: a half in each of two passes.
    pub share: f64,
}

/// What becomes of the heat of friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionHeat {
    /// η: the part of its work that becomes heat.
    pub fraction: f64,
    /// f: the part of that which the secondary side takes.
    pub to_secondary: f64,
}

/// A participant of a row.
#[derive(Clone, Copy, Debug)]
struct OfParticipant {
    /// θ.
    temperature: f64,
    /// β.
    beta: f64,
    /// s.
    side: f64,
}

/// What is known of a row and its temperatures.
#[derive(Default)]
pub(super) struct ThermalScratch {
    participants: Vec<OfParticipant>,
    /// c.
    coverage: f64,
    /// dc over the columns of displacements.
    dcoverage: Vec<f64>,
    dofs: Vec<Dof>,
    /// ∂β/∂d: a line for each participant.
    dbeta: Vec<f64>,
    /// dq and d(𝒟) over the columns of displacements and multipliers.
    dflow: Vec<f64>,
    dpower: Vec<f64>,
    force: Vec<f64>,
    stiffness: Vec<f64>,
    coupling: Vec<f64>,
    slopes: Slopes,
}

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
        let Some(heat) = self.heat() else {
            return Ok(());
        };
        if self.now.pairs.get(row).is_none_or(Option::is_none) {
            return Ok(());
        }
        self.fill(row, trial, row_order(order), &mut scratch.rows)?;
        let Some(filled) = scratch.rows.rows().first() else {
            return Ok(());
        };
        let s = &mut scratch.thermal;
        if !self.take_temperatures(heat, &scratch.rows, filled, trial, s) {
            return Ok(());
        }
        let lambda = self.lambda(row, trial);
        let laws = Laws {
            answer,
            ..self.laws_of(row)
        };
        let past = self.history.past(row);
        let width = filled.weights.len() + self.ncolumn_of_multiplier();
        let pressure = laws.slopes(filled, &lambda, past, width, &mut s.slopes);
        let [jump, mean] = s.jump_and_mean();
        let at = Between {
            pressure: pressure.max(0.0),
            gap: filled.gap,
            mean,
            jump,
        };
        let mut conducted = Conducted::default();
        for path in &heat.paths {
            conducted += path.at(&at, &self.parts.scale);
        }
        if pressure <= 0.0 {
            conducted.dpressure = 0.0;
        }
        let weight = heat.share * self.measure(row);
        let power = match heat.friction.filter(|_| self.duration > 0.0) {
            Some(_) => s.slopes.dissipated / self.duration,
            None => 0.0,
        };
        if conducted == Conducted::default() && power == 0.0 {
            return Ok(());
        }
        let friction = heat.friction.unwrap_or(FrictionHeat {
            fraction: 0.0,
            to_secondary: 0.5,
        });
        s.add_residual(&conducted, jump, (weight, power), friction);
        s.stiffness.clear();
        s.coupling.clear();
        if order == Order::Tangent {
            s.add_stiffness(&conducted, jump, weight);
        }
        out.add(&s.dofs, &s.force, &s.stiffness);
        if order == Order::Tangent && self.step.physics.moves {
            s.couple(
                filled,
                (&conducted, [jump, mean]),
                (weight, power),
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
        let error = f64::EPSILON * weight * conducted.h.abs() * far + heat.share * pressed.abs();
        out.uncertain(&s.dofs, error);
        Ok(())
    }

    /// Takes β and θ of the participants; false where the other side has no temperature.
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
                Participant::Rigid(_) => (NO_DOF, heat.primary),
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
        let Some(temperature) = heat.primary else {
            return false;
        };
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

impl ThermalScratch {
    /// [θ] and θ_m.
    fn jump_and_mean(&self) -> [f64; 2] {
        let all = self.participants.iter();
        let sums = all.fold([0.0; 2], |[jump, mean], of| {
            let part = of.beta * of.temperature;
            [jump + part, mean + 0.5 * of.side * part]
        });
        sums.map(|sum| sum / self.coverage)
    }

    /// (E1).
    fn add_residual(
        &mut self,
        conducted: &Conducted,
        jump: f64,
        (weight, power): (f64, f64),
        friction: FrictionHeat,
    ) {
        let flow = weight * conducted.h * jump;
        let heat = weight * friction.fraction * power;
        self.force.clear();
        let of = |of: &OfParticipant| of.beta * flow - friction.taken(of.side) * of.beta * heat;
        self.force.extend(self.participants.iter().map(of));
    }

    /// (E2).
    fn add_stiffness(&mut self, conducted: &Conducted, jump: f64, weight: f64) {
        let through = conducted.h + jump * conducted.djump;
        let mean = 0.5 * jump * conducted.dmean;
        for row in &self.participants {
            let of = |column: &OfParticipant| {
                let change = (through + mean * column.side) * column.beta / self.coverage;
                weight * row.beta * change
            };
            self.stiffness.extend(self.participants.iter().map(of));
        }
    }

    /// (E3).
    fn couple(
        &mut self,
        row: &Row,
        (conducted, [jump, mean]): (&Conducted, [f64; 2]),
        (weight, power): (f64, f64),
        (friction, duration): (FrictionHeat, f64),
    ) {
        let (n, width) = (row.weights.len(), self.slopes.pressure.len());
        let through = conducted.h + jump * conducted.djump;
        let of_mean = jump * conducted.dmean;
        self.dflow.clear();
        self.dpower.clear();
        for (j, dpressure) in self.slopes.pressure.iter().enumerate() {
            let mut flow = jump * conducted.dpressure * dpressure;
            if let (Some(gradient), Some(covered)) = (row.gradient.get(j), self.dcoverage.get(j)) {
                let lines = self.dbeta.chunks_exact(n).zip(&self.participants);
                let changes = lines.fold([0.0; 2], |[jump, mean], (line, of)| {
                    let part = line.get(j).copied().unwrap_or_default() * of.temperature;
                    [jump + part, mean + 0.5 * of.side * part]
                });
                let [djump, dmean] = [changes[0] - jump * covered, changes[1] - mean * covered];
                flow += jump * conducted.dgap * gradient;
                flow += (through * djump + of_mean * dmean) / self.coverage;
            }
            self.dflow.push(flow);
            let slope = self.slopes.dissipation.get(j).copied().unwrap_or_default();
            let slope = if power == 0.0 { 0.0 } else { slope / duration };
            self.dpower.push(slope);
        }
        let flow = conducted.h * jump;
        for (k, of) in self.participants.iter().enumerate() {
            let share = friction.fraction * friction.taken(of.side);
            let line = self.dbeta.get(k * n..(k + 1) * n).unwrap_or_default();
            let turned = line.iter().copied().chain(std::iter::repeat(0.0));
            let all = self.dflow.iter().zip(&self.dpower).zip(turned).take(width);
            self.coupling.extend(all.map(|((dflow, dpower), turned)| {
                let conducted = of.beta * dflow + flow * turned;
                weight * (conducted - share * (of.beta * dpower + power * turned))
            }));
        }
    }
}

impl FrictionHeat {
    /// a/β: what a participant of a side takes of the heat.
    fn taken(&self, side: f64) -> f64 {
        match side > 0.0 {
            true => self.to_secondary,
            false => self.to_secondary - 1.0,
        }
    }
}
