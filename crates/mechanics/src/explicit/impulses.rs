//! Contact without penetration in explicit steps: impulses that leave rows closed at the end of the next short increment.
//!
//! ```text
//! r = b·v_½ − v̄        P ← max(0, P − r/W)        W = b M⁻¹ b        v_½ ← v_½ + M⁻¹ b ΔP            (E1)
//! v̄ = −g/h, or −e b·v_½ as it was before all impulses where that is more, of rows that close         (E2)
//! |P_t| ≤ limit(P)      P_t ← P_t − P Bᵀ v_½/W_t, cut off
//! ```
//!
//! row after row in their order, until no velocity changes, with the weights b along which the force does its work. The force is
//! `P/h`. Each impact takes the energy of the nodes that meet, but for the coefficient of restitution e: it is that of rigid bodies, for
//! nodes of deformable ones are stopped by what is behind them.
//!
//! Sources: Carpenter, Taylor and Katona, Int. J. Numer. Meth. Eng. 32, 1991; Jean, CMAME 177, 1999 (row after row).

use super::bodies::Bodies;
use crate::system::{Acts, Dof, NO_DOF, NearRow, State, System, TermError};
use signorini_geometry::tensor::Vec3;

/// Rounds over all rows, and the change of a velocity over the largest one at which they end.
const ROUNDS: usize = 400;
const SETTLED: f64 = 1e-12;

/// The rows of a state, and what acts on them. Kept from one short increment to the next for its memory.
#[derive(Default)]
pub struct Impulses {
    rows: Vec<Row>,
    /// Of all rows one after the other: unknown, b, M⁻¹ b; and the same of slips.
    columns: Vec<Column>,
    /// Unknowns that bodies answer with.
    scratch: Vec<Column>,
}

/// What a row has of an unknown.
#[derive(Clone, Copy, Default)]
struct Column {
    dof: Dof,
    weight: f64,
    answer: f64,
    operator: Vec3,
    answers: Vec3,
}

struct Row {
    gap: f64,
    measure: f64,
    normal: Vec3,
    multiplier: Dof,
    count: usize,
    first: usize,
    end: usize,
    /// W, and that of slips.
    answer: f64,
    slips: f64,
    /// Its number, and the place of its contact among the terms.
    of: (usize, usize),
    rubs: bool,
    restitution: f64,
    /// The velocity of the gap that impulses lead to.
    target: f64,
    impulse: f64,
    shear: Vec3,
}

impl Impulses {
    /// Takes up the rows of a state that may close within a short increment.
    pub fn take_up(
        &mut self,
        system: &System,
        state: &State,
        inverse: &[f64],
        bodies: &Bodies,
        reach: f64,
    ) -> Result<(), TermError> {
        self.rows.clear();
        self.columns.clear();
        let mut contacts = system.impulsive().filter(|(_, of)| of.is_hard()).peekable();
        if contacts.peek().is_none() {
            return Ok(());
        }
        let compliances: Vec<[[f64; 6]; 6]> = bodies
            .of
            .iter()
            .map(|body| body.compliance(state))
            .collect();
        let answers = Answers {
            inverse,
            bodies,
            compliances: &compliances,
        };
        for (term, contact) in contacts {
            contact.near_rows(state, reach, &mut |row| {
                self.push((term, row), system, state, &answers);
            })?;
        }
        Ok(())
    }

    fn push(
        &mut self,
        (term, row): (usize, &NearRow<'_>),
        system: &System,
        state: &State,
        answers: &Answers<'_>,
    ) {
        let Acts::Hard {
            multiplier,
            count,
            restitution,
            friction,
        } = row.acts
        else {
            return;
        };
        let first = self.columns.len();
        for (k, &dof) in row.dofs.iter().enumerate() {
            let at = |values: &[f64]| values.get(k).copied().unwrap_or_default();
            let weight = at(row.weights);
            let operator = friction.and_then(|of| of.operator.get(k).copied());
            let operator = operator.unwrap_or_default();
            let is_idle = weight == 0.0 && operator == Vec3::ZERO;
            if dof == NO_DOF || is_idle {
                continue;
            }
            system
                .elimination
                .terms(dof, state, &system.layout, &mut |dof, c| {
                    if dof == NO_DOF {
                        return;
                    }
                    let found = self.columns[first..].iter().position(|of| of.dof == dof);
                    let at = found.map_or_else(
                        || {
                            self.columns.push(Column {
                                dof,
                                ..Column::default()
                            });
                            self.columns.len() - 1
                        },
                        |at| first + at,
                    );
                    let column = &mut self.columns[at];
                    column.weight += c * weight;
                    column.operator += operator * c;
                });
        }
        answers.find(&mut self.columns, first, &mut self.scratch);
        let columns = &self.columns[first..];
        let answer: f64 = columns.iter().map(|of| of.weight * of.answer).sum();
        let slips: f64 = columns.iter().map(|of| of.operator.dot(of.answers)).sum();
        if answer <= 0.0 {
            // nothing of it moves freely
            self.columns.truncate(first);
            return;
        }
        self.rows.push(Row {
            gap: row.gap,
            measure: row.measure,
            normal: row.normal,
            multiplier,
            count,
            first,
            end: self.columns.len(),
            answer,
            // the mean over all directions
            slips: slips / system.layout.ndim().max(1) as f64,
            of: (term, row.number),
            rubs: friction.is_some(),
            restitution,
            target: 0.0,
            impulse: 0.0,
            shear: Vec3::ZERO,
        });
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Finds impulses so that rows whose unknowns have these rates in a short increment of length `h` do not close beyond
    /// contact, and changes the rates accordingly. Forces act for a `time`.
    pub fn solve(&mut self, system: &System, [h, time]: [f64; 2], rates: &mut [f64]) {
        let Self { rows, columns, .. } = self;
        for row in &mut *rows {
            let columns = columns.get(row.first..row.end).unwrap_or_default();
            let at = |dof: Dof| rates.get(dof as usize).copied().unwrap_or_default();
            let before: f64 = columns.iter().map(|of| of.weight * at(of.dof)).sum();
            let closes = -row.gap / h;
            row.target = match before < closes && row.restitution > 0.0 {
                true => closes.max(-row.restitution * before),
                false => closes,
            };
        }
        let fastest = system.fastest(rates);
        for _ in 0..ROUNDS {
            let mut changed = 0.0_f64;
            for row in &mut *rows {
                let columns = &columns[row.first..row.end];
                let at = |dof: Dof| rates.get(dof as usize).copied().unwrap_or_default();
                let closing: f64 = columns.iter().map(|of| of.weight * at(of.dof)).sum();
                let next = (row.impulse - (closing - row.target) / row.answer).max(0.0);
                let change = next - row.impulse;
                row.impulse = next;
                let mut along = Vec3::ZERO;
                if row.rubs && row.slips > 0.0 {
                    let slip: Vec3 = columns.iter().map(|of| of.operator * at(of.dof)).sum();
                    let slip = slip - row.normal * row.normal.dot(slip);
                    let trial = row.shear - slip / row.slips;
                    let most = row.most(system, time);
                    let size = trial.norm();
                    let next = if size > most {
                        trial * (most / size)
                    } else {
                        trial
                    };
                    along = next - row.shear;
                    row.shear = next;
                }
                if change == 0.0 && along == Vec3::ZERO {
                    continue;
                }
                for of in columns {
                    let by = of.answer * change + of.answers.dot(along);
                    changed = changed.max(by.abs());
                    if let Some(rate) = rates.get_mut(of.dof as usize) {
                        *rate += by;
                    }
                }
            }
            if changed <= SETTLED * fastest {
                break;
            }
        }
    }

    /// Adds forces to a residual that act for a `time`, and writes multipliers.
    pub fn act(&self, time: f64, residual: &mut [f64], multipliers: &mut [f64]) {
        for row in &self.rows {
            for of in &self.columns[row.first..row.end] {
                let force = (of.weight * row.impulse + of.operator.dot(row.shear)) / time;
                if let Some(to) = residual.get_mut(of.dof as usize) {
                    *to -= force;
                }
            }
            let over = (time * row.measure).recip();
            // tractions have the sign of the force on the secondary side within
            let traction = row.normal * (-row.impulse * over) - row.shear * over;
            for c in 0..row.count {
                let value = match row.count {
                    1 => row.impulse * over,
                    _ => traction[c],
                };
                if let Some(to) = multipliers.get_mut(row.multiplier as usize + c) {
                    *to = value;
                }
            }
        }
    }
}

impl Row {
    /// The largest impulse of friction. Pressures are impulses over time and measure.
    fn most(&self, system: &System, time: f64) -> f64 {
        if self.impulse <= 0.0 {
            return 0.0;
        }
        let over = time * self.measure;
        system.friction_limit(self.of, self.impulse / over) * over
    }
}

/// What answers to forces.
struct Answers<'a> {
    inverse: &'a [f64],
    bodies: &'a Bodies,
    compliances: &'a [[[f64; 6]; 6]],
}

impl Answers<'_> {
    /// M⁻¹ b and M⁻¹ B of the columns of a row, from `first` on; adds those that only answer.
    fn find(&self, columns: &mut Vec<Column>, first: usize, scratch: &mut Vec<Column>) {
        scratch.clear();
        scratch.extend_from_slice(&columns[first..]);
        for column in &mut columns[first..] {
            let inverse = self.inverse.get(column.dof as usize).copied();
            let inverse = inverse.unwrap_or_default();
            column.answer = inverse * column.weight;
            column.answers = column.operator * inverse;
        }
        for (body, compliance) in self.bodies.of.iter().zip(self.compliances) {
            let mut forces = [[0.0; 6]; 4];
            let mut takes = false;
            for (k, dof) in body.dofs.iter().enumerate() {
                for of in scratch.iter().filter(|of| of.dof == *dof) {
                    takes = true;
                    forces[0][k] = of.weight;
                    (0..3).for_each(|axis| forces[axis + 1][k] = of.operator[axis]);
                }
            }
            if !takes {
                continue;
            }
            let answers = forces.map(|forces| body.respond(compliance, &forces));
            for (k, &dof) in body.dofs.iter().enumerate() {
                if dof == NO_DOF {
                    continue;
                }
                let answer = answers[0][k];
                let along = Vec3::new(answers[1][k], answers[2][k], answers[3][k]);
                match columns[first..].iter_mut().find(|of| of.dof == dof) {
                    Some(column) => (column.answer, column.answers) = (answer, along),
                    None => columns.push(Column {
                        dof,
                        answer,
                        answers: along,
                        ..Column::default()
                    }),
                }
            }
        }
    }
}
