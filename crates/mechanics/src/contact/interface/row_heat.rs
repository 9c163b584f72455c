//! The heat of one row: (E1) to (E3) of `thermal`.

use super::conducting::FrictionHeat;
use crate::contact::kernel::Slopes;
use crate::contact::law::Conducted;
use crate::contact::row::Row;
use crate::system::{Dof, SizedFlows};

/// Heat per time in the last accepted increment.
#[derive(Debug, Default)]
pub(super) struct Warmth {
    pub flows: SizedFlows,
    /// What friction set free, η 𝒟 of each row; empty where nothing became heat.
    pub rubbed: Vec<f64>,
}

impl Warmth {
    /// η 𝒟 of a row.
    pub fn rubbed(&self, row: usize) -> f64 {
        self.rubbed.get(row).copied().unwrap_or_default()
    }
}

/// A participant of a row.
#[derive(Clone, Copy, Debug)]
pub(super) struct OfParticipant {
    /// θ.
    pub temperature: f64,
    /// β.
    pub beta: f64,
    /// s.
    pub side: f64,
}

/// What is known of a row and its temperatures.
#[derive(Default)]
pub(super) struct ThermalScratch {
    pub participants: Vec<OfParticipant>,
    /// Whether the other side neither gives nor takes heat: all that friction sets free is the secondary side's.
    pub insulated: bool,
    /// c.
    pub coverage: f64,
    /// dc over the columns of displacements.
    pub dcoverage: Vec<f64>,
    pub dofs: Vec<Dof>,
    /// ∂β/∂d: a line for each participant.
    pub dbeta: Vec<f64>,
    /// dq and d(𝒟) over the columns of displacements and multipliers.
    pub dflow: Vec<f64>,
    pub dpower: Vec<f64>,
    pub force: Vec<f64>,
    pub stiffness: Vec<f64>,
    pub coupling: Vec<f64>,
    pub slopes: Slopes,
}

/// What goes across a row, over its measure.
pub(super) struct Crossing {
    /// Of it, the part that counts.
    pub conducted: Conducted,
    /// [θ] and θ_m.
    pub jump_and_mean: [f64; 2],
    pub measure: f64,
    /// 𝒟 and what becomes of it.
    pub power: f64,
    pub friction: FrictionHeat,
}

impl Crossing {
    /// q, h and η 𝒟.
    pub fn per_area(&self) -> [f64; 3] {
        let [jump, _] = self.jump_and_mean;
        let h = self.conducted.h;
        [h * jump, h, self.friction.fraction * self.power]
    }
}

impl ThermalScratch {
    /// The temperature of a surface without nodes; any where it has none, for it insulates.
    pub fn of_surface(&mut self, given: Option<f64>) -> f64 {
        self.insulated = given.is_none();
        given.unwrap_or_default()
    }

    /// [θ] and θ_m.
    pub fn jump_and_mean(&self) -> [f64; 2] {
        let all = self.participants.iter();
        let sums = all.fold([0.0; 2], |[jump, mean], of| {
            let part = of.beta * of.temperature;
            [jump + part, mean + 0.5 * of.side * part]
        });
        sums.map(|sum| sum / self.coverage)
    }

    /// (E1).
    pub fn add_residual(
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
    pub fn add_stiffness(&mut self, conducted: &Conducted, jump: f64, weight: f64) {
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
    pub fn couple(
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
