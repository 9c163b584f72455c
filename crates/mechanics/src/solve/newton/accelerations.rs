//! Accelerations where a step with inertia begins, and velocities after impacts of what does not yield.
//!
//! ```text
//! M a = −r + w b λ        0 ≤ λ ⟂ b·a ≥ 0   of rows that touch and do not part            (E1)
//! M Δv = w b Λ            0 ≤ Λ ⟂ b·(v + Δv) ≥ 0   of rows that touch and meet            (E2)
//! ```
//!
//! What meets is stopped first, (E2): by forces it would take a first increment, and all that it sets off.
//!
//! Rigid sides close their gaps within an increment, and would leave each other with a velocity that depends on where in it they met. So
//! their velocities follow from impulses at its end, of all rows whose multipliers press,
//!
//! ```text
//! b·v = −e min(0, b·v₀)        with the coefficient of restitution e, and v₀ at the start of the increment      (E3)
//! ```
//!
//! Which rows are pressed together, and which of these slip, follows from one solution after the other with the mass in the place of the
//! stiffness. Laws without multipliers have the pressure of their gap.

use super::{Failure, Newton};
use crate::solve::equations::{Accuracy, Factor};
use crate::system::{Act, Order, Phase, State, System, Touching, choose_again, touching};
use signorini_linear::{EXACT, LinearError};

/// Rows that are no farther apart than this part of the size of the model may touch.
const TOUCH: f64 = 1e-9;

/// Solutions after which rows stay as they are.
const ROUNDS: usize = 30;

/// Impulses one after the other, and what may be left of a velocity that rows lack.
const STRIKES: usize = 6;
const STRUCK: f64 = 1e-12;

/// The part of the largest velocity, and of one that crosses the model within an increment, that a row which rests may be off by.
const RESTS: f64 = 1e-9;

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
        let mut rows = touching(system, state, TOUCH * self.extent, |of| of.is_hard())?;
        let yields = |row: &Touching| row.rubs_on_what_yields(system);
        if rows.iter().any(|row| row.lacks > 0.0) && !rows.iter().any(yields) {
            self.strike(system, state, &mut rows)?;
            rows = touching(system, state, TOUCH * self.extent, |of| of.is_hard())?;
        }
        self.settle_with_mass(system, &mut rows, Act::Forces)?;
        system.accelerate(state, &self.du);
        system.reject();
        Ok(())
    }

    /// Sets the velocities of what does not yield and has met within the increment that has led to an accepted state, (E3), given the
    /// rates of unknowns where it began, and the accelerations there.
    pub fn bounce(
        &mut self,
        system: &mut System,
        state: &mut State,
        (before, h): (&[f64], f64),
    ) -> Result<(), Failure> {
        let mut rows = touching(system, state, f64::INFINITY, |of| of.bounces())?;
        rows.iter_mut()
            .for_each(|row| row.rebound(&state.u, before, h));
        rows.retain(Touching::is_pressed);
        let slow = RESTS * system.fastest(before).max(self.extent / h);
        let is_at_rest = |row: &Touching| row.lacks.abs() <= slow;
        if rows.iter().all(is_at_rest) {
            return Ok(());
        }
        (self.between, self.assembled, self.has_tangent) = (None, None, false);
        self.trial.clone_from(state);
        for term in &mut system.terms {
            term.begin(&Phase::of_step(self.step), state)?;
        }
        self.assembler.begin_increment(&system.terms);
        self.strike(system, state, &mut rows)?;
        self.trial.clone_from(state);
        let mut rows = touching(system, state, TOUCH * self.extent, |of| of.is_hard())?;
        self.settle_with_mass(system, &mut rows, Act::Forces)?;
        system.accelerate(state, &self.du);
        self.moved();
        Ok(())
    }

    /// Gives rows the velocities that they lack, by impulses; again where multipliers that are redundant yield a little.
    fn strike(
        &mut self,
        system: &System,
        state: &mut State,
        rows: &mut [Touching],
    ) -> Result<(), Failure> {
        let mut rates = system.rates_of_unknowns(state);
        let lacked = rows
            .iter()
            .fold(0.0, |most: f64, row| most.max(row.lacks.abs()));
        for _ in 0..STRIKES {
            self.settle_with_mass(system, rows, Act::Impact)?;
            let changes = rates.iter_mut().zip(&self.du);
            changes.for_each(|(rate, change)| *rate += change);
            let mut lacks = 0.0_f64;
            for row in rows.iter_mut().filter(|row| row.is_pressed()) {
                row.lacks -= row.opens(&self.du, Act::Forces);
                row.pressed += row.traction.0;
                lacks = lacks.max(row.lacks.abs());
            }
            if lacks <= STRUCK * lacked {
                break;
            }
        }
        system.set_velocities(state, &rates);
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
            let found = [&self.trial.u[..], &self.du];
            if last || !choose_again(system, rows, found, act) {
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
        self.equations.forget();
        let mut solved = self.solve_once();
        let redundant = matches!(solved, Err(LinearError::Singular { .. }));
        if redundant && self.assembler.relax(layout, &mut self.assembly) > 0 {
            solved = self.solve_once();
        }
        solved.map_err(|source| self.linear_failure(source))
    }

    fn solve_once(&mut self) -> Result<(), LinearError> {
        let accuracy = Accuracy::Residual(EXACT);
        let (assembler, assembly, new) = (&self.assembler, &self.assembly, Factor::New);
        self.equations
            .solve(assembler, assembly, false, new, accuracy, &mut self.du)
            .map(drop)
    }
}
