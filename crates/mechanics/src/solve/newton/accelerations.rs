//! Accelerations where a step with inertia begins.
//!
//! ```text
//! M a = −r + w b λ        0 ≤ λ ⟂ b·a ≥ 0   of rows that touch and do not part            (E1)
//! M Δv = w b Λ            0 ≤ Λ ⟂ b·(v + Δv) ≥ 0   of rows that touch and meet            (E2)
//! ```
//!
//! What meets is stopped first, (E2): by forces it would take a first increment, and all that it sets off.
//!
//! Of rows that act by multipliers, those that part are known by their velocity, `b·v > 0`; which of the others are pressed together, and
//! which of these slip, follows from one solution after the other with the mass in the place of the stiffness. What slips already
//! rubs along its velocity. Laws without multipliers have the pressure of their gap.

use super::{Failure, Newton};
use crate::solve::equations::{Accuracy, Factor};
use crate::system::{Acts, Dof, NearRow, Order, State, System, TermError};
use signorini_geometry::tensor::Vec3;
use signorini_linear::EXACT;

/// Rows that are no farther apart than this part of the size of the model may touch.
const TOUCH: f64 = 1e-9;

/// Solutions after which rows stay as they are.
const ROUNDS: usize = 30;

/// What is as small as this against the largest of its kind is nothing.
const NOTHING: f64 = 1e-9;

/// A multiplier that no law takes for contact.
const PULLS: f64 = -1e100;

/// The trial of what slips over the limit of friction: so large that its direction stays.
const BEYOND: f64 = 1e6;

/// A pressure that is none, and still has a direction.
const SLIGHT: f64 = 1e-100;

impl Newton {
    /// Sets the accelerations of all nodes at an accepted state where a step with inertia begins: those that forces there give
    /// to masses, with the multipliers of what is joined and of contacts that are closed, (E1). Sides that touch and meet are stopped
    /// before, (E2).
    pub fn accelerate(&mut self, system: &mut System, state: &mut State) -> Result<(), Failure> {
        self.between = None;
        self.trial.clone_from(state);
        self.assembler.begin_increment(&system.terms);
        self.moved();
        self.prepare(system, Order::Tangent)?;
        (self.assembled, self.has_tangent) = (None, false);
        let mut rows = touching(system, state, TOUCH * self.extent)?;
        if rows.iter().any(|row| row.meets > 0.0) {
            self.settle_with_mass(system, &mut rows, Act::Impact)?;
            let mut rates = system.rates_of_unknowns(state);
            let changes = rates.iter_mut().zip(&self.du);
            changes.for_each(|(rate, change)| *rate += change);
            system.set_velocities(state, &rates);
            rows = touching(system, state, TOUCH * self.extent)?;
        }
        self.settle_with_mass(system, &mut rows, Act::Forces)?;
        system.accelerate(state, &self.du);
        system.reject();
        Ok(())
    }

    /// Solves until rows act as they should.
    fn settle_with_mass(
        &mut self,
        system: &System,
        rows: &mut [Touching],
        act: Act,
    ) -> Result<(), Failure> {
        for round in 0..ROUNDS {
            rows.iter().for_each(|row| row.choose(&mut self.trial.u));
            self.solve_with_mass(system, rows, act)?;
            let last = round + 1 == ROUNDS;
            if last || !self.choose_again(system, rows, act) {
                break;
            }
        }
        Ok(())
    }

    /// Accelerations, or changes of velocities, and of multipliers, into `du`.
    fn solve_with_mass(
        &mut self,
        system: &System,
        rows: &[Touching],
        act: Act,
    ) -> Result<(), Failure> {
        let (layout, elimination) = (&system.layout, &system.elimination);
        self.assembler.assemble_mass(
            layout,
            elimination,
            &system.terms,
            &self.trial,
            &mut self.assembly,
        )?;
        let residual = &mut self.assembly.residual;
        match act {
            Act::Forces => rows.iter().for_each(|row| row.hold(residual)),
            Act::Impact => {
                residual.fill(0.0);
                rows.iter().for_each(|row| row.stop(residual));
            }
        }
        self.du.clear();
        self.du.resize(layout.ndof(), 0.0);
        let accuracy = Accuracy::Residual(EXACT);
        let (assembler, assembly) = (&self.assembler, &self.assembly);
        self.equations.forget();
        let solved = self.equations.solve(
            assembler,
            assembly,
            false,
            Factor::New,
            accuracy,
            &mut self.du,
        );
        solved.map_err(|source| self.linear_failure(source))?;
        Ok(())
    }

    /// Judges rows by a solution; whether one of them acts otherwise now.
    fn choose_again(&self, system: &System, rows: &mut [Touching], act: Act) -> bool {
        let mut pressed = 0.0_f64;
        for row in &mut *rows {
            row.traction = row.normal_and_shear(&self.trial.u, &self.du);
            pressed = pressed.max(row.traction.0.abs());
        }
        let accelerations = self.du.iter().take(system.layout.nmotion());
        let fastest = accelerations.fold(0.0, |most: f64, a| most.max(a.abs()));
        let mut changes = false;
        for row in rows {
            let acts = match row.acts {
                How::Parts => How::Parts,
                How::Open if row.opens(&self.du, act) < -NOTHING * fastest => How::Closed,
                How::Open => How::Open,
                _ if row.traction.0 < -NOTHING * pressed => How::Open,
                How::Closed => row.sticks(system),
                How::Slips(along) => How::Slips(along),
            };
            changes |= acts != row.acts;
            row.acts = acts;
        }
        changes
    }
}

/// What masses answer to.
#[derive(Clone, Copy, PartialEq)]
enum Act {
    Forces,
    Impact,
}

/// How a row acts.
#[derive(Clone, Copy, PartialEq)]
enum How {
    /// The sides part: nothing acts, whatever the accelerations.
    Parts,
    Open,
    Closed,
    /// In a direction.
    Slips(Vec3),
}

/// A row that touches.
struct Touching {
    /// The unknowns it acts on, and its force on them.
    columns: Vec<(Dof, f64)>,
    normal: Vec3,
    measure: f64,
    /// How fast its sides meet.
    meets: f64,
    multiplier: Dof,
    count: usize,
    /// Its contact among the terms, and its number, where it rubs.
    rubs: Option<(usize, usize)>,
    /// The direction in which its sides slide already.
    slides: Option<Vec3>,
    acts: How,
    /// Its pressure and shear.
    traction: (f64, Vec3),
}

/// The rows that touch at a state and have multipliers.
fn touching(system: &System, state: &State, reach: f64) -> Result<Vec<Touching>, TermError> {
    let mut rows = Vec::new();
    let contacts = system.terms.iter().enumerate();
    let mut rates = None;
    for (term, of) in contacts {
        let Some(contact) = of.capabilities().impulsive.filter(|of| of.is_hard()) else {
            continue;
        };
        let rates = rates.get_or_insert_with(|| system.rates_of_unknowns(state));
        contact.near_rows(state, reach, &mut |row| {
            rows.extend(Touching::of(row, term, (system, state), rates));
        })?;
    }
    Ok(rows)
}

impl Touching {
    fn of(
        row: &NearRow<'_>,
        term: usize,
        (system, state): (&System, &State),
        rates: &[f64],
    ) -> Option<Self> {
        let Acts::Hard {
            multiplier,
            count,
            friction,
            ..
        } = row.acts
        else {
            return None;
        };
        let rate = |dof: Dof| rates.get(dof as usize).copied().unwrap_or_default();
        let mut columns = Vec::new();
        for (&dof, &weight) in row.dofs.iter().zip(row.weights) {
            let mut take = |dof: Dof, c: f64| columns.push((dof, c * weight));
            system
                .elimination
                .terms(dof, state, &system.layout, &mut take);
        }
        let closing: f64 = row
            .dofs
            .iter()
            .zip(row.weights)
            .map(|(dof, b)| b * rate(*dof))
            .sum();
        let slip = friction.map(|of| {
            let along = row.dofs.iter().zip(of.operator);
            let slip: Vec3 = along.map(|(dof, b)| *b * rate(*dof)).sum();
            slip - row.normal * row.normal.dot(slip)
        });
        let slip = slip.unwrap_or_default();
        let fastest = rates
            .iter()
            .fold(0.0, |most: f64, rate| most.max(rate.abs()));
        let nothing = NOTHING * fastest;
        let speed = slip.norm();
        Some(Self {
            columns,
            normal: row.normal,
            measure: row.measure,
            meets: match closing < -nothing {
                true => -closing,
                false => 0.0,
            },
            multiplier,
            count,
            rubs: friction.map(|_| (term, row.number)),
            slides: (speed > nothing).then(|| slip / speed),
            acts: match closing > nothing {
                true => How::Parts,
                false => How::Closed,
            },
            // it sticks before anything is known
            traction: (1.0, Vec3::ZERO),
        })
    }

    /// The places of its multipliers.
    fn places(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let first = self.multiplier as usize;
        (0..self.count).map(move |c| (c, first + c))
    }

    /// Writes multipliers at which laws choose as this row does.
    fn choose(&self, unknowns: &mut [f64]) {
        let pressure = self.traction.0.max(SLIGHT);
        let traction = match self.acts {
            How::Parts | How::Open => self.normal * -PULLS,
            _ if self.count == 1 => return,
            How::Closed => self.normal * -pressure,
            How::Slips(along) => along * (BEYOND * pressure) - self.normal * pressure,
        };
        for (c, at) in self.places() {
            if let Some(to) = unknowns.get_mut(at) {
                *to = if self.count == 1 { PULLS } else { traction[c] };
            }
        }
    }

    /// Takes what the gap, and all that is open, have of a residual.
    fn hold(&self, residual: &mut [f64]) {
        let slips = matches!(self.acts, How::Slips(_)) && self.count > 1;
        let mut own = Vec3::ZERO;
        if slips {
            for (c, at) in self.places() {
                own[c] = residual.get(at).copied().unwrap_or_default();
            }
            own -= self.normal * self.normal.dot(own);
        }
        for (c, at) in self.places() {
            if let Some(to) = residual.get_mut(at) {
                *to = own[c];
            }
        }
    }

    /// Has the gap close no more: what its equation lacks is the velocity at which it does.
    fn stop(&self, residual: &mut [f64]) {
        if self.acts != How::Closed {
            return;
        }
        let lacks = self.measure * self.meets;
        for (c, at) in self.places() {
            if let Some(to) = residual.get_mut(at) {
                *to = if self.count == 1 {
                    lacks
                } else {
                    self.normal[c] * lacks
                };
            }
        }
    }

    /// Pressure and shear of a solution.
    fn normal_and_shear(&self, unknowns: &[f64], changes: &[f64]) -> (f64, Vec3) {
        if matches!(self.acts, How::Parts | How::Open) {
            return (0.0, Vec3::ZERO);
        }
        let mut own = Vec3::ZERO;
        for (c, at) in self.places() {
            let value = |of: &[f64]| of.get(at).copied().unwrap_or_default();
            own[c] = value(unknowns) + value(changes);
        }
        if self.count == 1 {
            return (own.x, Vec3::ZERO);
        }
        let pressure = -self.normal.dot(own);
        (pressure, own + self.normal * pressure)
    }

    /// How fast the gap opens.
    fn opens(&self, changes: &[f64], act: Act) -> f64 {
        let of = |dof: Dof| changes.get(dof as usize).copied().unwrap_or_default();
        let change: f64 = self.columns.iter().map(|(dof, b)| b * of(*dof)).sum();
        match act {
            Act::Forces => change,
            Act::Impact => change - self.meets,
        }
    }

    /// Whether what is pressed together sticks, or slips where its shear is beyond the limit.
    fn sticks(&self, system: &System) -> How {
        let Some((term, row)) = self.rubs else {
            return How::Closed;
        };
        if let Some(along) = self.slides {
            return How::Slips(along);
        }
        let (pressure, shear) = self.traction;
        let contact = system.terms.get(term).map(|term| term.capabilities());
        let contact = contact.and_then(|of| of.impulsive);
        let limit = contact.map_or(f64::INFINITY, |of| of.limit(row, pressure.max(0.0)));
        let size = shear.norm();
        match size > limit * (1.0 + NOTHING) && size > 0.0 {
            true => How::Slips(shear / size),
            false => How::Closed,
        }
    }
}
