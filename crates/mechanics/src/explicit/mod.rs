//! Steps whose increments need no equations solved, (E11) of `system::motion`.
//!
//! ```text
//! increment: repeat, for short increments of length h
//!   leave: x₁ from v₀ and a₀             nodes, `bodies`
//!   terms look, forces at x₁              contact by penalties and curves among them
//!   foresee v in the middle of the next   `impulses` leave rows closed there
//!   land: a₁ = M⁻¹ f, v₁                  `masses`, `bodies`
//! ```
//!
//! What is written is at ends of increments; how many short ones each takes follows from what is stable, `longest`, which is found
//! out where the step begins and every [`LOOK`] of them, and sooner where elements become short. Masses are at nodes; where
//! unknowns follow others, those take them.

mod bodies;
mod impulses;
mod longest;
mod masses;

use crate::system::{Archive, ArchiveError, Dof, Leapfrog, Rates, State, System, TermError};
use bodies::Bodies;
pub use bodies::Past;
use impulses::Impulses;
use longest::{Bound, Initial};
use masses::Masses;
use signorini_geometry::tensor::Vec3;

/// Short increments after which what is stable is found out again, where motions are large.
const LOOK: usize = 100;

/// Short increments after which the lengths of elements are looked at, and the square of a frequency over that before from which on
/// what is stable is found out again.
const GLANCE: usize = 2;
const GROWN: f64 = 1.1;

/// How far apart rows may be that impulses are looked for, over the way of the fastest node in a short increment.
const REACH: f64 = 4.0;

/// Relative difference below which two times are equal.
pub const ROUNDING: f64 = 1e-9;

/// Rounds in which mass is added, at most, and the part of the mass that counts as none.
const SCALINGS: usize = 20;
const ENOUGH: f64 = 1e-6;

/// An explicit step on its way.
pub struct Explicit {
    leapfrog: Leapfrog,
    masses: Masses,
    bodies: Bodies,
    impulses: Impulses,
    /// The longest short increment, with safety.
    longest: f64,
    /// What elements are at the start, once that was asked for.
    initial: Option<Initial>,
    /// How many there were since that was found out, and the square of the highest frequency of unloaded elements then.
    since: usize,
    unloaded: f64,
    /// Mass that was added to each node, where any was; that of all; and its kinetic energy where the step began.
    extra: Vec<f64>,
    added: f64,
    brought: f64,
    /// Of each unknown at the last end of a short increment; those of bodies are with these.
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
    /// In the middle of the last short increment, and of the next one.
    middle: Vec<f64>,
    foreseen: Vec<f64>,
    ndim: usize,
    du: Vec<f64>,
    /// What prescribed unknowns are at the end of the present short increment, or of the next.
    pub targets: Vec<(Dof, f64)>,
}

/// The name under which the sizes of short increments and added masses are stored.
const STORED: [&str; 2] = ["explicit.size", "explicit.masses"];

impl Explicit {
    /// Where a step begins, or goes on, at an accepted state.
    pub fn new(
        leapfrog: Leapfrog,
        system: &System,
        state: &State,
        prescribed: &[bool],
    ) -> Result<Self, TermError> {
        let nmotion = system.layout.nmotion();
        let mut explicit = Self {
            leapfrog,
            masses: Masses::of(system),
            bodies: Bodies::default(),
            impulses: Impulses::default(),
            longest: 0.0,
            initial: None,
            since: 0,
            unloaded: 0.0,
            extra: Vec::new(),
            added: 0.0,
            brought: 0.0,
            velocity: vec![0.0; nmotion],
            acceleration: vec![0.0; nmotion],
            middle: vec![0.0; nmotion],
            foreseen: vec![0.0; nmotion],
            ndim: system.layout.ndim(),
            du: vec![0.0; system.layout.ndof()],
            targets: Vec::new(),
        };
        explicit.share_out(system, state, prescribed)?;
        Ok(explicit)
    }

    /// Goes on with a step after a pause.
    pub fn go_on(
        &mut self,
        system: &System,
        state: &State,
        prescribed: &[bool],
        kept: Kept,
    ) -> Result<(), TermError> {
        (self.longest, self.since) = (kept.longest, kept.since);
        (self.unloaded, self.brought) = (kept.unloaded, kept.brought);
        if kept.extra.len() == self.masses.of_nodes.len() {
            self.add(kept.extra);
            self.share_out(system, state, prescribed)?;
        }
        Ok(())
    }

    /// Adds mass to nodes.
    fn add(&mut self, extra: Vec<f64>) {
        let masses = self.masses.of_nodes.iter_mut().zip(&extra);
        masses.for_each(|(mass, extra)| *mass += extra);
        self.added = extra.iter().sum();
        self.extra = extra;
    }

    /// The kinetic energy of mass that was added, at a state and where the step began.
    pub fn of_added(&self, state: &State) -> [f64; 2] {
        let velocity = state.rates.iter().flat_map(|rates| &rates.velocity);
        let now = self.extra.iter().zip(velocity);
        let now = now.map(|(mass, v)| 0.5 * mass * v.norm_squared());
        [now.sum(), self.brought]
    }

    /// Gives masses to unknowns and bodies, which move as at an accepted state.
    fn share_out(
        &mut self,
        system: &System,
        state: &State,
        prescribed: &[bool],
    ) -> Result<(), TermError> {
        self.bodies = Bodies::of(system, &self.masses.of_nodes, prescribed);
        let bodies = &self.bodies;
        self.masses.share_out(system, state, prescribed, bodies)?;
        self.take_up(system, state);
        Ok(())
    }

    /// Takes up how everything moves at an accepted state.
    pub fn take_up(&mut self, system: &System, state: &State) {
        let Some(rates) = &state.rates else {
            return;
        };
        let layout = &system.layout;
        let nodes = (0..).zip(rates.velocity.iter().zip(&rates.acceleration));
        for (node, (v, a)) in nodes {
            for axis in 0..layout.ndim() {
                let dof = layout.node(node, axis) as usize;
                let places = self
                    .velocity
                    .get_mut(dof)
                    .zip(self.acceleration.get_mut(dof));
                if let Some((velocity, acceleration)) = places {
                    (*velocity, *acceleration) = (v[axis], a[axis]);
                }
            }
        }
        self.bodies.take_up(state, &system.heavy);
    }

    /// Adds mass to elements whose waves are too fast for the shortest increment that is wanted.
    pub fn scale_masses(
        &mut self,
        system: &System,
        state: &State,
        prescribed: &[bool],
    ) -> Result<(), TermError> {
        let Some(scaling) = self.leapfrog.scaling else {
            return Ok(());
        };
        let (before, own) = (self.masses.total(), self.masses.of_nodes.clone());
        let most = (2.0 * self.leapfrog.safety / scaling.step).powi(2);
        for _ in 0..SCALINGS {
            let lacking = self.bound(system, prescribed).lacking(state, most)?;
            let masses = self.masses.of_nodes.iter_mut().zip(&lacking);
            masses.for_each(|(mass, lacks)| *mass += lacks);
            if lacking.iter().sum::<f64>() <= ENOUGH * before {
                break;
            }
        }
        let all = std::mem::replace(&mut self.masses.of_nodes, own);
        let extra = all
            .iter()
            .zip(&self.masses.of_nodes)
            .map(|(all, own)| all - own);
        self.add(extra.collect());
        if self.added > scaling.limit * before {
            let part = self.added / before;
            return Err(TermError::Refused {
                message: format!(
                    "short increments of {:.3e} take {:.3} of the mass more, where {:.3} is allowed: write a shorter `step` in \
                     `mass_scaling`, or a larger `limit`",
                    scaling.step, part, scaling.limit
                ),
            });
        }
        [self.brought, _] = self.of_added(state);
        self.share_out(system, state, prescribed)
    }

    fn bound<'a>(&'a self, system: &'a System, prescribed: &'a [bool]) -> Bound<'a> {
        Bound {
            system,
            of_nodes: &self.masses.of_nodes,
            bodies: &self.bodies,
            prescribed,
        }
    }

    /// The length of the next short increment, of those that lead from one time of the step to another.
    pub fn length(&self, from: f64, to: f64) -> f64 {
        let left = to - from;
        left / (left / self.longest * (1.0 - ROUNDING)).ceil().max(1.0)
    }

    /// What elements are at the start; who takes it gives it back.
    fn take_initial(&mut self, system: &System, prescribed: &[bool]) -> Result<Initial, TermError> {
        match self.initial.take() {
            Some(initial) => Ok(initial),
            None => self.bound(system, prescribed).initial(),
        }
    }

    /// Finds out how long short increments may be. Nothing limits those of a system that nothing holds together.
    pub fn look(
        &mut self,
        system: &System,
        state: &State,
        prescribed: &[bool],
        whole: f64,
    ) -> Result<(), TermError> {
        let speed = system.fastest(&self.velocity);
        let before = match self.longest > 0.0 {
            true => self.longest,
            false => whole,
        };
        let mut longest = before;
        let initial = self.take_initial(system, prescribed)?;
        let bound = self.bound(system, prescribed);
        let (unloaded, of_elements) = (
            bound.unloaded(state, &initial),
            bound.of_elements(state, &initial)?,
        );
        // what is near is within reach until the next look, at twice the speed
        for _ in 0..2 {
            let reach = 2.0 * speed * longest * LOOK as f64;
            let squared = of_elements + bound.of_rows(state, reach)?;
            if !squared.is_finite() {
                return Err(TermError::NotFinite {
                    what: "a stiffness".to_owned(),
                });
            }
            let stable = 2.0 * self.leapfrog.safety / squared.sqrt();
            longest = if stable.is_finite() { stable } else { whole };
            if self.longest > 0.0 {
                break;
            }
        }
        (self.longest, self.since, self.unloaded) = (longest, 0, unloaded);
        self.initial = Some(initial);
        Ok(())
    }

    /// Stays at a state where the step begins.
    pub fn stay(&mut self, state: &State) {
        for body in &mut self.bodies.of {
            body.stay(state);
        }
        self.middle.clone_from(&self.velocity);
    }

    /// Counts a short increment that leads to a state; whether what is stable is to be found out again, where motions are large:
    /// after some of them, and where elements have become short.
    pub fn counts(
        &mut self,
        system: &System,
        state: &State,
        prescribed: &[bool],
    ) -> Result<bool, TermError> {
        self.since += 1;
        if self.since >= LOOK {
            return Ok(true);
        }
        if !self.since.is_multiple_of(GLANCE) {
            return Ok(false);
        }
        let initial = self.take_initial(system, prescribed)?;
        let now = self.bound(system, prescribed).unloaded(state, &initial);
        self.initial = Some(initial);
        Ok(now > GROWN * self.unloaded)
    }

    /// What every unknown does in the present short increment.
    pub fn moves(&self) -> &[f64] {
        &self.du
    }

    /// Whether everything moves at a speed.
    pub fn is_finite(&self) -> bool {
        self.velocity.iter().all(|v| v.is_finite())
    }

    /// The longest short increment, and the mass that was added over that before.
    pub fn sizes(&self) -> [f64; 2] {
        let before = self.masses.total() - self.added;
        let added = if before > 0.0 {
            self.added / before
        } else {
            0.0
        };
        [self.longest, added]
    }

    /// What cannot be found out again.
    pub fn kept(&self) -> Kept {
        Kept {
            longest: self.longest,
            since: self.since,
            unloaded: self.unloaded,
            brought: self.brought,
            extra: self.extra.clone(),
        }
    }

    /// Begins a short increment: what every unknown does in it.
    pub fn leave(&mut self, state: &State, h: f64) {
        let unknowns = self
            .velocity
            .iter()
            .zip(&self.acceleration)
            .zip(&self.masses.inverse);
        for (du, ((v, a), inverse)) in self.du.iter_mut().zip(unknowns) {
            *du = if *inverse > 0.0 {
                h * (v + 0.5 * h * a)
            } else {
                0.0
            };
        }
        for body in &mut self.bodies.of {
            body.leave(state, h, &mut self.du);
        }
        for &(dof, to) in &self.targets {
            let from = state.u.get(dof as usize).copied().unwrap_or(to);
            if let Some(du) = self.du.get_mut(dof as usize) {
                *du = to - from;
            }
        }
        let over = h.recip();
        let rates = self.middle.iter_mut().zip(&self.du);
        rates.for_each(|(middle, du)| *middle = du * over);
        // multipliers begin with nothing
        let nmotion = self.velocity.len();
        let others = self.du.iter_mut().zip(&state.u).skip(nmotion);
        others.for_each(|(du, u)| *du = -u);
    }

    /// Ends a short increment at a state with this residual of all that acts there, contact by impulses excepted, which comes to
    /// it. The targets are those of the end of the next one.
    pub fn land(
        &mut self,
        system: &System,
        state: &mut State,
        residual: &mut [f64],
        past: Past,
    ) -> Result<(), TermError> {
        self.settle(state, residual, past);
        let reach = REACH * past.next * system.fastest(&self.foreseen);
        let inverse = &self.masses.inverse;
        self.impulses
            .take_up(system, state, inverse, &self.bodies, reach)?;
        if !self.impulses.is_empty() {
            // from the middle of one increment to that of the next
            let (h, time) = (2.0 * past.next, past.half + past.next);
            self.impulses.solve(system, [h, time], &mut self.foreseen);
            self.impulses.act(time, residual, &mut state.u);
            self.settle(state, residual, past);
        }
        for body in &mut self.bodies.of {
            let forces = body.forces(residual);
            body.land(state, forces, past, &self.foreseen);
        }
        Ok(())
    }

    /// Velocities and accelerations of nodes where these forces act, and all rates in the middle of the next short increment.
    fn settle(&mut self, state: &State, residual: &[f64], past: Past) {
        let ndim = self.ndim.max(1);
        let damping = |dof: usize| {
            self.masses
                .damping
                .get(dof / ndim)
                .copied()
                .unwrap_or_default()
        };
        let rates = self
            .middle
            .iter()
            .zip(&mut self.velocity)
            .zip(&mut self.acceleration);
        let forces = residual.iter().zip(&self.masses.inverse);
        let all = rates.zip(forces).zip(&mut self.foreseen).enumerate();
        for (dof, ((((middle, v), a), (r, inverse)), foreseen)) in all {
            if *inverse == 0.0 {
                (*v, *a, *foreseen) = (0.0, 0.0, 0.0);
                continue;
            }
            let (own, damping) = (-r * inverse, damping(dof));
            *v = (middle + past.half * own) / (1.0 + damping * past.half);
            *a = own - damping * *v;
            *foreseen = *v + past.next * *a;
        }
        let h = 2.0 * past.next;
        for &(dof, to) in &self.targets {
            let at = dof as usize;
            let from = state.u.get(at).copied().unwrap_or(to);
            let next = (to - from) / h;
            let rates = self.velocity.get_mut(at).zip(self.acceleration.get_mut(at));
            if let Some((v, a)) = rates {
                let middle = self.middle.get(at).copied().unwrap_or(next);
                *a = (next - middle) / (past.half + past.next);
                *v = middle + past.half * *a;
            }
            if let Some(foreseen) = self.foreseen.get_mut(at) {
                *foreseen = next;
            }
        }
        for body in &self.bodies.of {
            let forces = body.forces(residual);
            body.foresee(state, forces, past, &mut self.foreseen);
        }
    }

    /// Writes how everything moves to an accepted state.
    pub fn report(&self, system: &System, state: &mut State) {
        let [velocity, mut acceleration] =
            [&self.velocity, &self.acceleration].map(|rates| system.nodal_rates(state, rates));
        let massless = |node: usize| self.masses.of_nodes.get(node).is_none_or(|m| *m == 0.0);
        let nodes = acceleration.iter_mut().enumerate();
        nodes
            .filter(|(node, _)| massless(*node))
            .for_each(|(_, a)| *a = Vec3::ZERO);
        let bodies = state
            .rates
            .take()
            .map(|rates| rates.bodies)
            .unwrap_or_default();
        let mut rates = Rates {
            velocity,
            acceleration,
            bodies,
        };
        for body in &self.bodies.of {
            body.report(state, &system.heavy, &mut rates);
        }
        state.rates = Some(rates);
    }
}

/// What of an explicit step cannot be found out again from its state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Kept {
    longest: f64,
    since: usize,
    unloaded: f64,
    brought: f64,
    extra: Vec<f64>,
}

impl Kept {
    pub fn save(&self, out: &mut Archive) {
        let numbers = [self.longest, self.since as f64, self.unloaded, self.brought];
        out.put(STORED[0], &numbers);
        if !self.extra.is_empty() {
            out.put(STORED[1], &self.extra);
        }
    }

    /// That of an archive; none where its step was not explicit.
    pub fn load(from: &Archive) -> Result<Option<Self>, ArchiveError> {
        if from.length(STORED[0]).is_err() {
            return Ok(None);
        }
        let mut numbers = [0.0; 4];
        from.get(STORED[0], &mut numbers)?;
        let mut extra = vec![0.0; from.length(STORED[1]).unwrap_or(0)];
        if !extra.is_empty() {
            from.get(STORED[1], &mut extra)?;
        }
        Ok(Some(Self {
            longest: numbers[0],
            since: numbers[1] as usize,
            unloaded: numbers[2],
            brought: numbers[3],
            extra,
        }))
    }
}
