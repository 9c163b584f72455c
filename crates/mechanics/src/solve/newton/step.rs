//! One step: the linear solve, and how far it goes.

use super::course::Course;
use super::iterate::{Iterate, LastStep, is_small};
use super::middle::seen;
use super::scale::Sizes;
use super::{Failure, LineSearch, Newton, at};
use crate::solve::equations::{Accuracy, Factor};
use crate::solve::line_search;
use crate::system::{Aid, Dof, Layout, Order, System, TermError};
use signorini_linear::{EXACT, LinearError, StartStiffness};

/// Free motions that are held at once: a body that is all mechanism is not worth solving.
const HELD_AT_MOST: usize = 200;

/// What holds a free motion bears nothing where its force is below this part of the largest force ...
const BORNE: f64 = 1e-6;

/// ... or its motion, by rounding, below this part of the largest one.
const STILL: f64 = 1e-9;

/// How often a step to a saddle point is halved.
const SHORTENINGS: usize = 10;

impl Newton {
    /// Takes the next step: a tangent, the linear solve, and a part of the way. Where something moves freely without the aid of
    /// terms, that is restored instead, and the state is judged once more.
    pub(super) fn step(
        &mut self,
        system: &mut System,
        course: &mut Course,
        iterate: &Iterate,
    ) -> Result<(), Failure> {
        let serves = self.tangent_serves(course, iterate);
        if self.assembled < Some(Order::Tangent) && !serves {
            self.assemble(system, Order::Tangent)?;
        }
        let accuracy = self.accuracy(course, iterate);
        let which = self.assembler.start(&system.terms);
        if self.equations.wants_start(which) {
            let bulk = self.bulk_at_start(system)?;
            self.equations.start_from(which, bulk);
        }
        // where only the size of the next correction is left to show, the last factor shows it
        let keeps = serves || only_the_correction_is_left(iterate);
        let motion = iterate.moves_nodes;
        let left = match self.solve_linear(&system.layout, motion, keeps, accuracy) {
            Err(failure) if failure.is_singular() && self.aid(system, Aid::Restore) => {
                return Ok(());
            }
            solved => solved?,
        };
        let size = Sizes::new(&system.layout, |dof| at(&self.du, dof));
        let moved = iterate.moved.motions();
        let flees = course.watch.sees_correction(size.motions(), moved);
        if flees && self.aid(system, Aid::Restore) {
            return Ok(());
        }
        if !serves {
            course.economy.solved(iterate.judgement.excess, left);
        }
        let decrement = self.slope().abs().sqrt();
        let next = if is_small(size, iterate.moved) {
            Order::Residual
        } else {
            Order::Tangent
        };
        let alpha = self.advance(system, motion, next, course.iterations + 1)?;
        course.stepped(LastStep {
            correction: size.times(alpha),
            is_measure: true,
            alpha,
            decrement,
            linear_iterations: self.equations.iterations,
        });
        Ok(())
    }

    /// Whether the last tangent serves once more: solutions that are not exact need no exact one.
    fn tangent_serves(&self, course: &Course, iterate: &Iterate) -> bool {
        let has_one = self.assembled < Some(Order::Tangent) && self.has_tangent;
        let excess = iterate.judgement.excess;
        has_one
            && iterate.is_quiet()
            && self.equations.is_iterative()
            && course.economy.is_nearly_straight(excess)
    }

    /// How exactly the next step is solved for.
    fn accuracy(&self, course: &Course, iterate: &Iterate) -> Accuracy {
        if !self.equations.is_iterative() {
            return Accuracy::Residual(EXACT);
        }
        let judgement = &iterate.judgement;
        let is_unknown = iterate.iterations == 0 && course.economy.curvature().is_none();
        let nearly = only_the_correction_is_left(iterate);
        // forces that are small already say nothing of the correction unless they are solved for
        let allowed = if nearly { 0.0 } else { judgement.allowed };
        let is_rough = is_unknown || !iterate.is_quiet() || nearly;
        let residual = judgement.excess.forces;
        course.economy.accuracy(residual, allowed, is_rough)
    }

    /// The stiffness of the bodies at the start of the run; a tangent is assembled.
    fn bulk_at_start(&mut self, system: &System) -> Result<StartStiffness, TermError> {
        if self.assembler.is_constant() {
            return Ok(StartStiffness::Always);
        }
        if self.assembler.is_at_start(&system.terms, self.seen()) {
            return Ok(StartStiffness::Next);
        }
        let bulk = self.assembler.bulk_at_start(
            &system.layout,
            &system.elimination,
            &system.terms,
            seen(&self.between, &self.trial),
        );
        bulk.map(StartStiffness::Values)
    }

    /// Solves for the step; returns the relative residual that is left.
    fn solve_linear(
        &mut self,
        layout: &Layout,
        motion: bool,
        keep_factor: bool,
        accuracy: Accuracy,
    ) -> Result<f64, Failure> {
        if !motion {
            self.du.fill(0.0);
        }
        let (assembler, assembly) = (&self.assembler, &self.assembly);
        let mut outcome = Err(LinearError::Order {
            before: "factorize",
        });
        if keep_factor {
            let kept = Factor::Kept;
            outcome =
                self.equations
                    .solve(assembler, assembly, motion, kept, accuracy, &mut self.du);
        }
        if outcome.is_err() {
            let new = Factor::New;
            outcome =
                self.equations
                    .solve(assembler, assembly, motion, new, accuracy, &mut self.du);
        }
        if !self.relaxes && matches!(outcome, Err(LinearError::Singular { .. })) {
            self.relaxes = self.assembler.relax(layout, &mut self.assembly) > 0;
            let (assembler, assembly) = (&self.assembler, &self.assembly);
            let new = Factor::New;
            outcome =
                self.equations
                    .solve(assembler, assembly, motion, new, accuracy, &mut self.du);
        }
        while self.settings.hold_free
            && let Err(LinearError::Singular { equation }) = &outcome
            && let Some(dof) = self.equations.dof(*equation)
            && self.held.len() < HELD_AT_MOST
            && let Some(stiffness) = self.assembler.stiffen(dof, &mut self.assembly)
        {
            self.held.push((dof, stiffness));
            let (assembler, assembly) = (&self.assembler, &self.assembly);
            let new = Factor::New;
            outcome =
                self.equations
                    .solve(assembler, assembly, motion, new, accuracy, &mut self.du);
        }
        let report = outcome.map_err(|source| self.linear_failure(source))?;
        self.judge_held()?;
        Ok(report.residual)
    }

    /// Where a free motion is held at one dof for each, the equations have a solution exactly where no load acts on it:
    /// then what holds it bears nothing.
    fn judge_held(&self) -> Result<(), Failure> {
        let largest = |sizes: &[f64]| sizes.iter().fold(0.0, |most: f64, m| most.max(m.abs()));
        let scale = largest(&self.assembly.magnitude).max(largest(&self.assembly.residual));
        // where motions are prescribed and nothing is strained yet, there is no force to compare with
        let moved = STILL * largest(&self.du);
        let bears = |&&(dof, stiffness): &&(Dof, f64)| {
            let du = self.du.get(dof as usize).copied().unwrap_or_default();
            (stiffness * du).abs() > BORNE * scale && du.abs() > moved
        };
        match self.held.iter().find(bears) {
            Some(&(dof, _)) => Err(Failure::Linear {
                dof: Some(dof),
                source: LinearError::Singular { equation: None },
            }),
            None => Ok(()),
        }
    }

    /// The dofs at which motions without stiffness were held in the last solve.
    pub fn held(&self) -> impl Iterator<Item = Dof> {
        self.held.iter().map(|(dof, _)| *dof)
    }

    pub(in crate::solve) fn linear_failure(&self, source: LinearError) -> Failure {
        let stiffest = || self.assembler.largest_entry(&self.assembly);
        let dof = match &source {
            LinearError::Singular { .. } if self.assembler.hides_bodies(&self.assembly) => {
                return Failure::TooStiff { dof: stiffest() };
            }
            LinearError::Singular { equation } => self.equations.dof(*equation),
            LinearError::NotFinite | LinearError::Inaccurate { .. } => stiffest(),
            _ => None,
        };
        Failure::Linear { source, dof }
    }

    /// Moves the trial state along `du`, as far as the line search says, and returns how far. `next` is what will be
    /// wanted there.
    fn advance(
        &mut self,
        system: &mut System,
        motion: bool,
        next: Order,
        iterations: usize,
    ) -> Result<f64, Failure> {
        self.before.clone_from(&self.trial);
        let (du, state) = (&self.du, self.seen());
        let limits = system.choices().map(|t| t.max_step(state, du));
        let first = limits.fold(1.0, f64::min);
        // a prescribed motion is taken whole: the energy before it is another problem's
        if motion || self.settings.line_search == LineSearch::Off {
            let alpha = if motion { 1.0 } else { first };
            self.place(system, alpha);
            return Ok(alpha);
        }
        // nor have forces and heat a potential in common
        let physics = self.step.physics;
        let is_coupled = physics.moves && physics.has_heat();
        // a step that follows predicted stresses strains what is thin before the next one relieves it
        if is_coupled || self.predicts || system.terms.iter().any(|t| t.properties().has_saddle) {
            return self.shorten(system, first, next);
        }
        let slope = self.slope();
        let state = seen(&self.between, &self.trial);
        let start = self.assembler.energy(&system.terms, state)?;
        if let Some(start) = start.filter(|_| slope < 0.0)
            && self
                .energy_at(system, first, next)
                .is_some_and(|reached| line_search::lowers(start, slope, first, reached))
        {
            return Ok(first);
        }
        let mut obstacle = None;
        let alpha = line_search::root(slope, first, |alpha| {
            let tried = self
                .try_step(system, alpha, Order::Residual)
                .and_then(|()| self.assemble(system, Order::Residual));
            match tried {
                Ok(()) => Some(self.slope()).filter(|s| s.is_finite()),
                Err(error) => {
                    obstacle = Some(error);
                    None
                }
            }
        });
        let Some(alpha) = alpha else {
            let in_the_way = obstacle.map(Failure::Term);
            let residual = &self.assembly.residual;
            let dof = residual.iter().position(|r| !r.is_finite());
            return Err(in_the_way.unwrap_or(Failure::NotFinite {
                iterations,
                dof: dof.map(|dof| dof as Dof),
            }));
        };
        self.place(system, alpha);
        Ok(alpha)
    }

    /// Places the trial state at the first of `first`, `first`/2, … that can be evaluated: at a saddle point neither
    /// energy nor slope say how far to go.
    fn shorten(&mut self, system: &mut System, first: f64, next: Order) -> Result<f64, Failure> {
        let mut alpha = first;
        for _ in 0..SHORTENINGS {
            let tried = self.try_step(system, alpha, next).and_then(|()| {
                let has_place = !self.coupled_more;
                self.assemble(system, if has_place { next } else { Order::Residual })
            });
            if tried.is_ok() {
                return Ok(alpha);
            }
            alpha *= 0.5;
        }
        self.try_step(system, alpha, next)?;
        Ok(alpha)
    }

    /// The energy after a step of `alpha`; `None` where there is none, or no admissible state.
    fn energy_at(&mut self, system: &mut System, alpha: f64, next: Order) -> Option<f64> {
        self.try_step(system, alpha, next).ok()?;
        let state = seen(&self.between, &self.trial);
        let energy = self.assembler.energy(&system.terms, state);
        energy.ok().flatten().filter(|e| e.is_finite())
    }

    /// Puts the trial state at `alpha` and lets the terms look at it.
    fn try_step(&mut self, system: &mut System, alpha: f64, next: Order) -> Result<(), TermError> {
        self.place(system, alpha);
        self.look(system, next)
    }

    /// Puts the trial state at `alpha` along the step.
    fn place(&mut self, system: &System, alpha: f64) {
        system.advance(&mut self.trial, &self.before, &self.du, alpha);
        self.trial.time = self.before.time;
        if self.predicts {
            self.trial.correct_from(&self.before);
        }
        self.moved();
    }

    /// s = du·r over the unknowns.
    fn slope(&self) -> f64 {
        let product = |&dof: &Dof| self.du[dof as usize] * self.assembly.residual[dof as usize];
        self.equations.dofs().iter().map(product).sum()
    }
}

/// Whether only the size of the next correction is left to show.
fn only_the_correction_is_left(iterate: &Iterate) -> bool {
    iterate.iterations > 0 && iterate.is_nearly_found()
}
