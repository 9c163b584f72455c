//! Rows that touch where velocities or accelerations are to be found, and how they act.
//!
//! Those that part are known by their velocity, `b·v > 0`. Of the others, pressures that pull are let go, and what closes is taken up;
//! what is beyond the limit of friction slips. What slides already rubs along its velocity.

use super::{Acts, Dof, Impulsive, NearRow, State, System, TermError};
use signorini_geometry::tensor::Vec3;

/// What is as small as this against the largest of its kind is nothing.
const NOTHING: f64 = 1e-9;

/// A multiplier that no law takes for contact.
const PULLS: f64 = -1e100;

/// The trial of what slips over its pressure: beyond the limit of friction, and no larger, for it turns with the normals of sides.
const BEYOND: f64 = 10.0;

/// What masses answer to.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Act {
    /// Forces, by accelerations.
    Forces,
    /// Impulses, by changes of velocities.
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
pub(crate) struct Touching {
    /// The unknowns it acts on, and its force on them.
    columns: Vec<(Dof, f64)>,
    normal: Vec3,
    measure: f64,
    /// The velocity of its gap.
    opening: f64,
    /// The velocity of its gap that it lacks.
    pub lacks: f64,
    /// What acted before, and counts with impulses.
    pub pressed: f64,
    restitution: f64,
    multiplier: Dof,
    count: usize,
    /// Its contact among the terms, and its number, where it rubs.
    rubs: Option<(usize, usize)>,
    /// The direction in which its sides slide already.
    slides: Option<Vec3>,
    acts: How,
    /// Its pressure and shear.
    pub traction: (f64, Vec3),
}

/// The rows that touch at a state and have multipliers.
pub(crate) fn touching(
    system: &System,
    state: &State,
    reach: f64,
    takes: fn(&dyn Impulsive) -> bool,
) -> Result<Vec<Touching>, TermError> {
    let mut rows = Vec::new();
    let mut contacts = system.impulsive().filter(|(_, of)| takes(*of)).peekable();
    if contacts.peek().is_none() {
        return Ok(rows);
    }
    let rates = system.rates_of_unknowns(state);
    let nothing = NOTHING * system.fastest(&rates);
    for (term, contact) in contacts {
        contact.near_rows(state, reach, &mut |row| {
            rows.extend(Touching::of(row, term, (system, state), (&rates, nothing)));
        })?;
    }
    Ok(rows)
}

/// Judges rows by a solution, of unknowns and their changes; whether one of them acts otherwise now.
pub(crate) fn choose_again(
    system: &System,
    rows: &mut [Touching],
    [before, changes]: [&[f64]; 2],
    act: Act,
) -> bool {
    let mut pressed = 0.0_f64;
    for row in &mut *rows {
        // an impulse is all of its own
        let before = match act {
            Act::Forces => before,
            Act::Impact => &[],
        };
        row.traction = row.normal_and_shear(before, changes);
        pressed = pressed.max(row.traction.0.abs());
    }
    let fastest = system.fastest(changes);
    let mut changed = false;
    for row in rows {
        let acts = match row.acts {
            How::Parts => How::Parts,
            How::Open if row.opens(changes, act) < -NOTHING * fastest => How::Closed,
            How::Open => How::Open,
            _ if row.traction.0 + row.pressed < -NOTHING * pressed => How::Open,
            How::Closed => row.sticks(system),
            How::Slips(along) => How::Slips(along),
        };
        changed |= acts != row.acts;
        row.acts = acts;
    }
    changed
}

impl Touching {
    fn of(
        row: &NearRow<'_>,
        term: usize,
        (system, state): (&System, &State),
        (rates, nothing): (&[f64], f64),
    ) -> Option<Self> {
        let Acts::Hard {
            multiplier,
            count,
            restitution,
            friction,
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
        let opening: f64 = row
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
        let speed = slip.norm();
        let mut touching = Self {
            columns,
            normal: row.normal,
            measure: row.measure,
            opening,
            lacks: match opening < -nothing {
                true => -(1.0 + restitution) * opening,
                false => 0.0,
            },
            pressed: 0.0,
            restitution,
            multiplier,
            count,
            rubs: friction.map(|_| (term, row.number)),
            slides: (speed > nothing).then(|| slip / speed),
            acts: match opening > nothing {
                true => How::Parts,
                false => How::Closed,
            },
            traction: (0.0, Vec3::ZERO),
        };
        touching.traction = touching.normal_and_shear(&state.u, &[]);
        Some(touching)
    }

    /// Whether its sides are pressed together.
    pub fn is_pressed(&self) -> bool {
        !matches!(self.acts, How::Parts | How::Open)
    }

    /// Whether it has friction on sides that yield: their normals turn with unknowns, which impulses do not go with.
    pub fn rubs_on_what_yields(&self, system: &System) -> bool {
        let contact = |place: usize| system.terms.get(place)?.capabilities().impulsive;
        let of = self.rubs.and_then(|(place, _)| contact(place));
        of.is_some_and(|contact| !contact.bounces())
    }

    /// The places of its multipliers.
    fn places(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let first = self.multiplier as usize;
        (0..self.count).map(move |c| (c, first + c))
    }

    /// Writes multipliers at which laws choose as this row does: what is pressed sticks before a pressure is known.
    pub fn choose(&self, unknowns: &mut [f64]) {
        let pressure = match self.traction.0 > 0.0 {
            true => self.traction.0,
            false => 1.0,
        };
        let (pressure, shear) = match self.acts {
            How::Parts | How::Open => (PULLS, Vec3::ZERO),
            How::Closed => (pressure, Vec3::ZERO),
            How::Slips(along) => (pressure, along * (BEYOND * pressure)),
        };
        let traction = shear - self.normal * pressure;
        for (c, at) in self.places() {
            if let Some(to) = unknowns.get_mut(at) {
                *to = if self.count == 1 {
                    pressure
                } else {
                    traction[c]
                };
            }
        }
    }

    /// Takes what the gap, and all that is open, have of a residual.
    pub fn hold(&self, residual: &mut [f64]) {
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

    /// Has the velocity that (E3) says after an increment of length `h`, where its multiplier presses.
    pub fn rebound(&mut self, unknowns: &[f64], before: &[f64], h: f64) {
        self.acts = How::Closed;
        let (pressure, _) = self.normal_and_shear(unknowns, &[]);
        if pressure <= 0.0 {
            self.acts = How::Open;
            return;
        }
        let came = self.opens(before, Act::Forces);
        self.pressed = pressure * h;
        self.lacks = -self.restitution * came.min(0.0) - self.opening;
    }

    /// Has the gap change as it should: what its equation lacks is a velocity.
    pub fn stop(&self, residual: &mut [f64]) {
        if !self.is_pressed() {
            return;
        }
        let lacks = self.measure * self.lacks;
        for (c, at) in self.places() {
            if let Some(to) = residual.get_mut(at) {
                *to = match self.count {
                    1 => lacks,
                    // a traction, which has the other sign
                    _ => -lacks * self.normal[c],
                };
            }
        }
    }

    /// Pressure and shear of a solution.
    fn normal_and_shear(&self, unknowns: &[f64], changes: &[f64]) -> (f64, Vec3) {
        if !self.is_pressed() {
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
    pub fn opens(&self, changes: &[f64], act: Act) -> f64 {
        let of = |dof: Dof| changes.get(dof as usize).copied().unwrap_or_default();
        let change: f64 = self.columns.iter().map(|(dof, b)| b * of(*dof)).sum();
        match act {
            Act::Forces => change,
            Act::Impact => change - self.lacks,
        }
    }

    /// Whether what is pressed together sticks, or slips where its shear is beyond the limit.
    fn sticks(&self, system: &System) -> How {
        let Some(rubs) = self.rubs else {
            return How::Closed;
        };
        if let Some(along) = self.slides {
            return How::Slips(along);
        }
        let (pressure, shear) = self.traction;
        let limit = system.friction_limit(rubs, (pressure + self.pressed).max(0.0));
        let size = shear.norm();
        match size > limit * (1.0 + NOTHING) && size > 0.0 {
            true => How::Slips(shear / size),
            false => How::Closed,
        }
    }
}
