//! Heat across an interface, on the rows of its forces.
//!
//! A row has a number β for each participant, positive on the secondary side and negative on the primary, which sum to ±1: its
//! operator is β times the identity. With the mean and the jump of temperature `θ_m = ½ Σ |β| θ`, `[θ] = Σ β θ`, and the share
//! `a = f β⁺ − (1 − f) β⁻` of the heat `η 𝒟` that friction sets free,
//!
//! ```text
//! R_θ  = w (β q − a η 𝒟),    q = h(p, g, θ_m, [θ]) [θ]                                           (E1)
//! K_θθ = w β (h β + [θ] (h_m ½|β| + h_j β))ᵀ                                                     (E2)
//! K_θu = w (β dqᵀ + q ∂β/∂d − η (a d𝒟ᵀ + 𝒟 ∂a/∂d))                                               (E3)
//!   dq = [θ] (h_p dp + h_g G) + (h + [θ] h_j) (∂β)ᵀθ + ½ h_m [θ] (sgn(β) ∂β)ᵀθ
//! 𝒟 Δt = L (|e| − L/k) of what slips by penalties, |t·e| by multipliers                          (E4)
//! ```
//!
//! Heat that leaves one side enters the other: Σ β = 0 for all columns. Source: Wriggers, Computational Contact Mechanics, 2006,
//! section 9.7.

use super::rows::row_order;
use super::{Answer, Interface, Laws, Order, Participant, Scratch, Sink, State, TermError};
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

/// What is known of a row and its temperatures.
#[derive(Default)]
pub(super) struct ThermalScratch {
    /// θ, β and its place among the columns, of each participant.
    participants: Vec<(f64, f64, usize)>,
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
        if !self.take_temperatures(heat, scratch.rows.participants(), filled, trial, s) {
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
        let weight = heat.share * self.measure(row) * filled.coverage;
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
                (&conducted, jump),
                (weight, power),
                (friction, self.duration),
            );
            scratch.rows.dofs(&self.layout, &mut scratch.dofs);
            self.multiplier_dofs(row, &mut scratch.dofs);
            out.couple(&s.dofs, &scratch.dofs, &s.coupling);
        }
        // the rounding of temperatures, and that of positions through the pressure
        let s = &scratch.thermal;
        let temperatures = s.participants.iter().map(|p| p.0.abs());
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
        participants: &[Participant],
        row: &Row,
        trial: &State,
        s: &mut ThermalScratch,
    ) -> bool {
        s.participants.clear();
        s.dofs.clear();
        s.dbeta.clear();
        let n = row.weights.len();
        let mut first = 0;
        let mut sum = 0.0;
        for participant in participants {
            let beta = row.sliding.operator.get(first).map_or(0.0, |b| b.x);
            let (dof, value) = match *participant {
                Participant::Node(node) => {
                    let dof = self.layout.temperature(node);
                    (dof, trial.u.get(dof as usize).copied())
                }
                Participant::Rigid(_) => (NO_DOF, heat.primary),
            };
            let Some(value) = value else {
                return false;
            };
            sum += beta;
            s.participants.push((value, beta, first));
            s.dofs.push(dof);
            row.sliding.dnumber(first, &mut s.dbeta);
            first += participant.ncolumn();
        }
        // a surface fixed in space takes no part in the row
        let Some(primary) = heat.primary.filter(|_| sum > 0.5) else {
            return sum <= 0.5;
        };
        s.participants.push((primary, -sum, n));
        s.dofs.push(NO_DOF);
        s.dbeta.resize(s.dbeta.len() + n, 0.0);
        true
    }
}

impl ThermalScratch {
    /// [θ] and θ_m.
    fn jump_and_mean(&self) -> [f64; 2] {
        let all = self.participants.iter();
        all.fold([0.0; 2], |[jump, mean], (value, beta, _)| {
            [jump + beta * value, mean + 0.5 * beta.abs() * value]
        })
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
        let of = |(_, beta, _): &(f64, f64, usize)| beta * flow - friction.taken(*beta) * heat;
        self.force.extend(self.participants.iter().map(of));
    }

    /// (E2).
    fn add_stiffness(&mut self, conducted: &Conducted, jump: f64, weight: f64) {
        let through = conducted.h + jump * conducted.djump;
        for (_, row, _) in &self.participants {
            let of = |(_, beta, _): &(f64, f64, usize)| {
                let mean = 0.5 * jump * conducted.dmean * beta.abs();
                weight * row * (through * beta + mean)
            };
            self.stiffness.extend(self.participants.iter().map(of));
        }
    }

    /// (E3).
    fn couple(
        &mut self,
        row: &Row,
        (conducted, jump): (&Conducted, f64),
        (weight, power): (f64, f64),
        (friction, duration): (FrictionHeat, f64),
    ) {
        let (n, width) = (row.weights.len(), self.slopes.pressure.len());
        let through = conducted.h + jump * conducted.djump;
        self.dflow.clear();
        self.dpower.clear();
        for j in 0..width {
            let mut flow = jump * conducted.dpressure * self.slopes.pressure[j];
            if j < n {
                flow += jump * conducted.dgap * row.gradient[j];
                for (k, (value, beta, _)) in self.participants.iter().enumerate() {
                    let change = self.dbeta[k * n + j] * value;
                    flow +=
                        through * change + 0.5 * jump * conducted.dmean * beta.signum() * change;
                }
            }
            self.dflow.push(flow);
            let slopes = self.slopes.dissipation.get(j).copied().unwrap_or_default();
            self.dpower
                .push(if power == 0.0 { 0.0 } else { slopes / duration });
        }
        let flow = conducted.h * jump;
        for (k, (_, beta, _)) in self.participants.iter().enumerate() {
            let taken = friction.fraction * friction.taken(*beta);
            let share = friction.fraction * friction.taken(beta.signum());
            for j in 0..width {
                let turned = match j < n {
                    true => self.dbeta[k * n + j],
                    false => 0.0,
                };
                let heat = taken * self.dpower[j] + share * beta.signum() * power * turned;
                let of = beta * self.dflow[j] + flow * turned - heat;
                self.coupling.push(weight * of);
            }
        }
    }
}

impl FrictionHeat {
    /// a: what a participant takes of the heat, of what its β is.
    fn taken(&self, beta: f64) -> f64 {
        match beta > 0.0 {
            true => self.to_secondary * beta,
            false => -(1.0 - self.to_secondary) * beta,
        }
    }
}
