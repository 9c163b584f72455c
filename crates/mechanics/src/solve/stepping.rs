//! Steps and increments: how time passes.

use super::equations::{Equations, LinearSeconds};
use super::event::{Cause, Event, Flow, IncrementRecord, Observer};
use super::heat;
use super::local_error::{Record, look, next};
use super::newton::{Failure, Goal, Newton, NewtonSettings, Place};
use super::stabilization;
use super::step::{Cycle, Increments, Motion, Sizes, Step, Turns};
use super::work::ExternalWork;
use crate::explicit::{Explicit, Kept};
use crate::system::{
    Aid, Archive, ArchiveError, Dof, Frame, HeatBalance, Order, State, System, TermError,
    interpolate,
};
use signorini_linear::{LinearKind, choose};
use thiserror::Error;

/// The numbers of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepperSettings {
    /// Those of Newton's method.
    pub newton: NewtonSettings,
    /// Which linear solver.
    pub linear: LinearKind,
    /// After how many sizes that failed viscous forces help an increment; none: never.
    pub stabilize_after: Option<usize>,
}

impl Default for StepperSettings {
    fn default() -> Self {
        Self {
            newton: NewtonSettings::default(),
            linear: LinearKind::default(),
            stabilize_after: Some(2),
        }
    }
}

/// How a run ended well.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// All steps are done.
    Finished,
    /// An observer asked to stop.
    Stopped,
}

/// How a run ended badly.
#[derive(Clone, Debug, Error)]
pub enum RunError {
    /// An increment did not converge, however small.
    #[error(
        "increment {increment} of step \"{step}\" did not converge (time {time:.6} of {duration:.6}): {cause}"
    )]
    NotConverged {
        /// Name of the step.
        step: String,
        /// The increment, from 1.
        increment: usize,
        /// Step time that was reached.
        time: f64,
        /// Duration of the step.
        duration: f64,
        /// Sizes that were tried, first to last.
        tried: Vec<f64>,
        /// The smallest size allowed; none where increments are fixed.
        min: Option<f64>,
        /// Why the last attempt failed.
        cause: Box<Failure>,
    },
    /// More increments than allowed.
    #[error(
        "step \"{step}\" is not done after {count} increments (time {time:.6} of {duration:.6})"
    )]
    TooManyIncrements {
        /// Name of the step.
        step: String,
        /// The limit.
        count: usize,
        /// Step time that was reached.
        time: f64,
        /// Duration of the step.
        duration: f64,
    },
    /// Natural modes that did not converge.
    #[error("step \"{step}\": {found} of {wanted} natural modes have converged")]
    Modes {
        /// Name of the step.
        step: String,
        /// How many have.
        found: usize,
        /// How many were wanted.
        wanted: usize,
    },
    /// A term refused an accepted state.
    #[error(transparent)]
    Term(#[from] TermError),
}

/// Runs steps, one increment after the other.
pub struct Stepper {
    pub(super) newton: Newton,
    pub(super) state: State,
    pub(super) progress: Progress,
    guess: Vec<f64>,
    stabilize_after: Option<usize>,
    /// Whether terms go a safer way in the present increment.
    pub(super) safer: bool,
    /// The total time at which to pause, where there is one.
    pause: Option<f64>,
    /// The present step, where it is explicit; and what a stored run knows of it.
    pub(super) explicit: Option<Box<Explicit>>,
    pub(super) kept: Option<Kept>,
    /// Steps that come again.
    pub(super) cycles: Vec<Cycle>,
}

/// An increment that was accepted.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Accepted {
    pub iterations: usize,
    pub residual: f64,
}

/// Where a run is: with the state and the histories of the terms, all that it needs to go on.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Progress {
    pub step: usize,
    /// Accepted increments of this step.
    pub increment: usize,
    /// Total time at the start of the step.
    pub step_start: f64,
    /// Time since then.
    pub time: f64,
    /// Size of the next increment; none at the start of a step.
    pub dt: Option<f64>,
    /// Accepted increments in a row that were easy.
    pub easy: usize,
    /// Values of the prescribed dofs at the start of the step.
    pub origin: Vec<f64>,
    /// Change of the state per time in the last increment of this step that did not jump; empty where there was none.
    pub rate: Vec<f64>,
    /// What the first step of the last increment has shown, where that started from an extrapolation.
    pub curvature: Option<f64>,
    /// Whether the last increment jumped: then the rate before it says nothing of the next start.
    pub jumped: bool,
    /// What supports and loads have done.
    pub work: ExternalWork,
    /// Where heat came from and went to; none where no step has found temperatures.
    pub heat: Option<HeatBalance>,
    /// What the control of time knows of increments so far.
    pub record: Record,
    /// Where it is in its cycles.
    pub turns: Turns,
}

/// Iterations up to which an increment counts as easy.
const EASY: usize = 6;
/// Easy increments in a row after which the next one grows.
const EASY_ROW: usize = 2;
/// By how much it grows; and one that follows easy ones takes the rest of a step where that is no longer than this:
/// a short rest would cost as many iterations as any increment.
const GROWTH: f64 = 1.5;
/// What is left of an increment that failed.
const CUT: f64 = 0.5;
/// The same where it failed badly: a force was not a finite number or an element turned inside out.
const CUT_HARD: f64 = 0.25;

/// An increment that has been made.
struct Made {
    end: f64,
    dt: f64,
    attempt: usize,
    accepted: Accepted,
}

impl Stepper {
    /// Prepares a run of a system from its undeformed state.
    #[must_use]
    pub fn new(system: &System, settings: StepperSettings) -> Self {
        let equations = Equations::new(choose(settings.linear));
        let newton = Newton::new(settings.newton, system, equations);
        Self::with(system, settings, newton)
    }

    fn with(system: &System, settings: StepperSettings, newton: Newton) -> Self {
        Self {
            newton,
            state: system.initial_state(),
            progress: Progress::default(),
            guess: Vec::new(),
            stabilize_after: settings.stabilize_after,
            safer: false,
            pause: None,
            explicit: None,
            kept: None,
            cycles: Vec::new(),
        }
    }

    /// A stepper that goes on with a stored run. Histories come first, for they determine the coupling.
    ///
    /// # Errors
    /// The archive belongs to another model.
    pub fn resumed(
        system: &mut System,
        settings: StepperSettings,
        from: &Archive,
    ) -> Result<Self, ArchiveError> {
        Self::going_on(system, from, |system| Self::new(system, settings))
    }

    fn going_on(
        system: &mut System,
        from: &Archive,
        make: impl FnOnce(&System) -> Self,
    ) -> Result<Self, ArchiveError> {
        system.load(from)?;
        let mut stepper = make(system);
        stepper.load(system, from)?;
        Ok(stepper)
    }

    /// Goes on in the place of this one as [`Stepper::resumed`] does, to the same bits: what would be made again, of the
    /// linear solver and of patterns, is not made again.
    ///
    /// # Errors
    /// The archive belongs to another model.
    pub fn restarted(
        self,
        system: &mut System,
        settings: StepperSettings,
        from: &Archive,
    ) -> Result<Self, ArchiveError> {
        let cycles = self.cycles;
        Self::going_on(system, from, |system| {
            let equations = Equations::new(choose(settings.linear));
            let newton = self.newton.renewed(settings.newton, system, equations);
            Self::with(system, settings, newton).with_cycles(cycles)
        })
    }

    /// The last accepted state.
    #[must_use]
    pub const fn state(&self) -> &State {
        &self.state
    }

    /// The state of the last iterate, converged or not.
    #[must_use]
    pub const fn trial(&self) -> &State {
        &self.newton.trial
    }

    /// Wall time spent in the linear solver since this was last asked.
    pub fn take_linear_seconds(&mut self) -> LinearSeconds {
        std::mem::take(&mut self.newton.equations.seconds)
    }

    /// The number of unknowns solved for in the present step.
    #[must_use]
    pub fn nunknown(&self) -> usize {
        self.newton.equations.dofs().len()
    }

    /// Runs the remaining steps.
    ///
    /// # Errors
    /// An increment that does not converge; everything accepted before has been reported.
    pub fn run(
        &mut self,
        system: &mut System,
        steps: &[Step],
        observer: &mut dyn Observer,
    ) -> Result<Outcome, RunError> {
        self.newton.stopping = false;
        while let Some(step) = steps.get(self.progress.step) {
            let outcome = match self.due_cycle() {
                Some(cycle) => self.turn(system, steps, &cycle, observer)?,
                None => {
                    let number = self.progress.step;
                    let outcome = self.one_step(system, steps, step, observer)?;
                    if outcome == Outcome::Finished {
                        self.turn_round(number);
                    }
                    outcome
                }
            };
            if outcome == Outcome::Stopped {
                return Ok(outcome);
            }
        }
        Ok(Outcome::Finished)
    }

    /// Runs the rest of the present step and goes on to the next.
    pub(super) fn one_step(
        &mut self,
        system: &mut System,
        steps: &[Step],
        step: &Step,
        observer: &mut dyn Observer,
    ) -> Result<Outcome, RunError> {
        let number = self.progress.step;
        let event = Event::Step {
            step: number,
            name: &step.name,
        };
        if observer.notice(&event) == Flow::Stop {
            return Ok(Outcome::Stopped);
        }
        self.begin_step(system, step)
            .map_err(|cause| self.not_begun(step, cause))?;
        self.notice_explicit(observer);
        if let Some(wanted) = &step.vibration {
            let outcome = self.vibrate(system, step, wanted, observer)?;
            self.go_to(number + 1, step, steps);
            return Ok(outcome);
        }
        if self.run_step(system, step, observer)? == Outcome::Stopped {
            return Ok(Outcome::Stopped);
        }
        self.go_to(number + 1, step, steps);
        Ok(Outcome::Finished)
    }

    /// Goes on to another step after one that is done.
    fn go_to(&mut self, number: usize, done: &Step, steps: &[Step]) {
        self.progress = Progress {
            step: number,
            step_start: self.progress.step_start + done.duration,
            work: std::mem::take(&mut self.progress.work),
            turns: std::mem::take(&mut self.progress.turns),
            record: Record {
                calm: 0,
                ..self.progress.record
            },
            ..Progress::default()
        };
        // a static step leads from rest to rest
        if steps.get(number).is_some_and(Step::is_static) {
            self.state.rates = None;
        }
    }

    /// Runs as [`Stepper::run`] does, up to a total time, at which an increment ends; [`Outcome::Stopped`] there. Where
    /// increments are fixed, the one before a pause and the one after it are parts of one.
    ///
    /// # Errors
    /// As [`Stepper::run`].
    pub fn run_until(
        &mut self,
        system: &mut System,
        steps: &[Step],
        time: f64,
        observer: &mut dyn Observer,
    ) -> Result<Outcome, RunError> {
        self.pause = Some(time);
        let outcome = self.run(system, steps, observer);
        self.pause = None;
        outcome
    }

    /// The time of the present step at which to pause; never before where it is.
    fn pause_in(&self, step: &Step) -> Option<f64> {
        let time = self.pause? - self.progress.step_start;
        (time < step.duration - TIME * step.duration).then_some(time)
    }

    fn run_step(
        &mut self,
        system: &mut System,
        step: &Step,
        observer: &mut dyn Observer,
    ) -> Result<Outcome, RunError> {
        let sizes = Sizes::of(step);
        while step.duration - self.progress.time > TIME * step.duration {
            let pause = self.pause_in(step);
            if pause.is_some_and(|at| at - self.progress.time <= TIME * step.duration) {
                return Ok(Outcome::Stopped);
            }
            let is_explicit = self.explicit.is_some();
            if self.pause.is_none() && !is_explicit && self.progress.increment >= sizes.count {
                return Err(RunError::TooManyIncrements {
                    step: step.name.clone(),
                    count: sizes.count,
                    time: self.progress.time,
                    duration: step.duration,
                });
            }
            let works = [stabilization::work_of(system), self.progress.work.total];
            let made = match is_explicit {
                true => Some(self.leaps(system, step, &sizes, observer)?),
                false => self.increment(system, step, &sizes, observer)?,
            };
            let Some(made) = made else {
                return Ok(Outcome::Stopped);
            };
            let after = self.notice_increment(system, step, &made, works, observer)?;
            if self.newton.stopping || after == Flow::Stop {
                return Ok(Outcome::Stopped);
            }
        }
        Ok(Outcome::Finished)
    }

    /// Goes to the end of the next increment of an explicit step.
    fn leaps(
        &mut self,
        system: &mut System,
        step: &Step,
        sizes: &Sizes,
        observer: &mut dyn Observer,
    ) -> Result<Made, RunError> {
        let end = self.end_of_increment(step, sizes.first);
        let made = self.leap(system, step, end, observer);
        let (accepted, end) = made.map_err(|cause| self.not_begun(step, cause))?;
        Ok(Made {
            end,
            dt: end - self.progress.time,
            attempt: 1,
            accepted,
        })
    }

    /// Goes to the end of the next increment, by smaller ones where sizes fail; none where it is to stop.
    fn increment(
        &mut self,
        system: &mut System,
        step: &Step,
        sizes: &Sizes,
        observer: &mut dyn Observer,
    ) -> Result<Option<Made>, RunError> {
        let mut targets: Vec<(Dof, f64)> = Vec::new();
        let mut dt = self.progress.dt.unwrap_or(sizes.first).min(sizes.max);
        let mut tried = Vec::new();
        let mut attempt = 1;
        let mut failed = 0;
        let mut owed = false;
        let easy = self.progress.easy;
        self.safer = false;
        loop {
            let end = self.end_of_increment(step, dt);
            dt = end - self.progress.time;
            tried.push(dt);
            self.targets(step, end, &mut targets);
            let made = |attempt, accepted| Made {
                end,
                dt,
                attempt,
                accepted,
            };
            let failure = match self.attempt(system, step, end, &targets, attempt, observer) {
                Ok(accepted) => {
                    self.adapt(step, accepted.iterations, attempt, dt, sizes.max);
                    return Ok(Some(made(attempt, accepted)));
                }
                Err(failure) => failure,
            };
            system.reject();
            if self.newton.stopping {
                self.progress.easy = easy;
                return Ok(None);
            }
            // a failure from an extrapolated start says nothing about one from the last state
            let inaccurate = matches!(failure, Failure::Inaccurate { .. } | Failure::Impact { .. });
            let extrapolated = self.newton.extrapolated && !inaccurate;
            let smaller = dt * severity(&failure);
            let smallest = sizes.min.is_none_or(|m| smaller < m);
            failed += usize::from(!extrapolated);
            let again = !inaccurate && self.tries_again(system, extrapolated);
            let due = |n| failed == n + 1 || (smallest && failed <= n);
            let may_creep = step.scheme.is_none() && self.stabilize_after.is_some_and(due);
            owed |= !extrapolated && may_creep;
            if owed && !again {
                owed = false;
                attempt += 1;
                let helped = self.help(system, step, end, attempt, observer)?;
                if let Some(accepted) = helped {
                    return Ok(Some(made(attempt, accepted)));
                }
                if self.newton.stopping {
                    self.progress.easy = easy;
                    return Ok(None);
                }
            }
            if !again && smallest {
                return Err(RunError::NotConverged {
                    step: step.name.clone(),
                    increment: self.progress.increment + 1,
                    time: self.progress.time,
                    duration: step.duration,
                    tried,
                    min: sizes.min,
                    cause: Box::new(failure),
                });
            }
            let next = if again { dt } else { smaller };
            let event = Event::Cutback {
                step: self.progress.step,
                increment: self.progress.increment + 1,
                attempt,
                cause: &Cause { failure, dt },
                next,
            };
            if observer.notice(&event) == Flow::Stop {
                return Ok(None);
            }
            self.progress.easy = 0;
            self.progress.record.calm = 0;
            dt = next;
            attempt += 1;
        }
    }

    /// Whether the same size is tried again: from the last state after an extrapolated start, or in a safer way that terms
    /// know. A smaller increment is tried the usual way first.
    fn tries_again(&mut self, system: &mut System, extrapolated: bool) -> bool {
        let safer = !extrapolated && !self.safer && system.aid(Aid::Safer);
        let again = extrapolated || safer;
        if !again {
            system.aid(Aid::Usual);
        }
        self.safer = safer || (self.safer && again);
        again
    }

    /// Goes on from an increment, and hands its record and frame to the observer.
    fn notice_increment(
        &mut self,
        system: &mut System,
        step: &Step,
        made: &Made,
        works: [f64; 2],
        observer: &mut dyn Observer,
    ) -> Result<Flow, RunError> {
        let record = IncrementRecord {
            step: self.progress.step,
            increment: self.progress.increment + 1,
            attempts: made.attempt,
            iterations: made.accepted.iterations,
            time: self.state.time,
            step_time: (made.end, step.duration),
            dt: made.dt,
            residual: made.accepted.residual,
            work_stabilization: stabilization::work_of(system) - works[0],
            work_external: self.progress.work.total - works[1],
        };
        let held: Vec<Dof> = self.newton.held().collect();
        if self.progress.increment == 0 && !held.is_empty() {
            let step = self.progress.step;
            observer.notice(&Event::Held { step, dofs: &held });
        }
        self.progress.increment += 1;
        self.progress.time = made.end;
        let frame = self.frame(system, step)?;
        let event = Event::Increment {
            record: &record,
            frame: &frame,
        };
        Ok(observer.notice(&event))
    }

    /// Tries one increment up to the step time `end`.
    fn attempt(
        &mut self,
        system: &mut System,
        step: &Step,
        end: f64,
        targets: &[(Dof, f64)],
        attempt: usize,
        observer: &mut dyn Observer,
    ) -> Result<Accepted, Failure> {
        let place = self.place(attempt);
        let time = self.progress.step_start + end;
        let dt = end - self.progress.time;
        self.guess.clear();
        self.guess.extend(self.progress.rate.iter().map(|r| r * dt));
        let extrapolated = attempt == 1 && self.extrapolates();
        let goal = Goal {
            time,
            targets,
            guess: extrapolated.then_some(&self.guess[..]),
            curvature: self.progress.curvature,
        };
        let outcome = self
            .newton
            .solve(system, &self.state, &goal, place, &mut |record| {
                observer.notice(&Event::Iteration(record))
            });
        for note in self.newton.equations.notes() {
            observer.notice(&Event::Solver {
                step: place.step,
                increment: place.increment,
                note: &note,
            });
        }
        let converged = outcome?;
        if let Some((control, scheme)) = step.control.as_ref().zip(step.scheme.as_ref()) {
            let states = [&self.state, &self.newton.trial];
            let record = &self.progress.record;
            let extent = self.newton.extent();
            self.progress.record = look(control, scheme, system, states, extent, record)?;
        }
        self.newton.scale.accept(converged.q);
        let change = self.newton.trial.u.iter().zip(&self.state.u);
        let rate = change.map(|(now, before)| (now - before) / dt);
        self.progress.rate.clear();
        self.progress.rate.extend(rate);
        self.progress.jumped = false;
        self.progress.curvature = converged.curvature;
        let bounces = system.impulsive().any(|(_, contact)| contact.bounces());
        let has_inertia = self.newton.step.scheme.is_some();
        let before = (bounces && has_inertia).then(|| system.rates_of_unknowns(&self.state));
        self.accept(system)?;
        if let Some(before) = before {
            self.newton.bounce(system, &mut self.state, (&before, dt))?;
        }
        Ok(Accepted {
            iterations: converged.iterations,
            residual: converged.residual,
        })
    }

    /// Whether the increment before says something about the next.
    const fn extrapolates(&self) -> bool {
        !self.progress.rate.is_empty() && !self.progress.jumped
    }

    /// Where the present increment stands.
    pub(super) const fn place(&self, attempt: usize) -> Place {
        Place {
            step: self.progress.step,
            increment: self.progress.increment + 1,
            attempt,
        }
    }

    /// The trial state becomes the accepted one.
    pub(super) fn accept(&mut self, system: &mut System) -> Result<(), TermError> {
        if self.newton.between().is_some() {
            // what terms remember is where the increment ends, not where they were evaluated
            for term in system.adaptive() {
                term.prepare(&self.newton.trial, Order::Residual)?;
            }
        }
        let (newton, states) = (&self.newton, [&self.state, &self.newton.trial]);
        let residual = &newton.assembly.residual;
        let work = &mut self.progress.work;
        let between = newton.between();
        work.advance(system, &newton.prescribed, residual, states, between)?;
        let mut rates = self.state.rates.clone();
        if let (Some(scheme), Some(rates)) = (newton.step.scheme, &mut rates) {
            system.advance_rates(rates, &scheme, states);
        }
        let from = self.state.time;
        self.state.clone_from(&self.newton.trial);
        self.state.correction.clear();
        self.state.rates = rates;
        system.accept(&self.state)?;
        let times = [from, self.state.time];
        heat::advance(&mut self.progress, &self.newton, system, times);
        Ok(())
    }

    /// The step time at which an increment of about `dt` ends, no later than a pause.
    pub(super) fn end_of_increment(&self, step: &Step, dt: f64) -> f64 {
        match self.pause_in(step) {
            Some(pause) => pause.min(self.usual_end(step, dt)),
            None => self.usual_end(step, dt),
        }
    }

    /// The same without pauses: on the grid where increments are fixed, and at the end of the step rather than shortly
    /// before it.
    fn usual_end(&self, step: &Step, dt: f64) -> f64 {
        let max = match step.increments {
            Increments::Fixed(n) => {
                let n = n as f64;
                // from the grid, where no pause has led off it, that is the number of increments so far
                let passed = (self.progress.time / step.duration * n * (1.0 + TIME)).floor();
                return step.duration * ((passed + 1.0) / n);
            }
            Increments::Adaptive { max, .. } => max,
        };
        let longest = if self.progress.easy >= EASY_ROW {
            (GROWTH * dt).min(max)
        } else {
            dt
        };
        let (left, end) = (step.duration - self.progress.time, self.progress.time + dt);
        if left <= longest || left - dt <= (TIME * step.duration).max(1e-3 * dt) {
            step.duration
        } else {
            end
        }
    }

    /// Values of the prescribed dofs at a step time.
    pub(super) fn targets(&self, step: &Step, time: f64, out: &mut Vec<(Dof, f64)>) {
        out.clear();
        let fraction = time / step.duration;
        let total = self.progress.step_start + time;
        for (p, &from) in step.prescriptions.iter().zip(&self.progress.origin) {
            let value = match &p.motion {
                Motion::Hold => from,
                Motion::Ramp(to) => from + (to - from) * fraction,
                Motion::Table(table) => interpolate(table, time),
                Motion::TotalTable(table) => interpolate(table, total),
                Motion::Function(function) => function.at(time),
                Motion::TotalFunction(function) => function.at(total),
            };
            out.push((p.dof, value));
        }
    }

    /// Chooses the size of the next increment after one that converged.
    fn adapt(&mut self, step: &Step, iterations: usize, attempt: usize, dt: f64, max: f64) {
        let progress = &mut self.progress;
        progress.easy = if iterations <= EASY && attempt == 1 {
            progress.easy + 1
        } else {
            0
        };
        // an increment shortened by the end of the step says nothing about the next
        let size = progress
            .dt
            .map_or(dt, |planned| if attempt == 1 { planned } else { dt });
        let grown = match &step.control {
            _ if progress.easy < EASY_ROW => size,
            Some(control) => next(control, &progress.record, size),
            None => size * GROWTH,
        };
        progress.dt = Some(grown.min(max));
    }

    /// The results at the accepted state.
    fn frame(&self, system: &System, step: &Step) -> Result<Frame, TermError> {
        let mut frame = self.report(system)?;
        frame.step.clone_from(&step.name);
        Ok(frame)
    }

    /// The results at the last accepted state; the undeformed one, with nothing prescribed yet, before the first
    /// increment.
    ///
    /// # Errors
    /// A term that cannot evaluate it.
    pub fn report(&self, system: &System) -> Result<Frame, TermError> {
        let (prescribed, assembly) = (&self.newton.prescribed, &self.newton.assembly);
        let mut frame = system.report(&self.state, prescribed, assembly)?;
        frame.step_number = self.progress.step;
        frame.cycles = self.progress.turns.done + self.progress.turns.stands_for;
        frame.work_external = self.progress.work.total;
        frame.heat = self.progress.heat;
        if let Some(energies) = &mut frame.energies {
            energies.external = self.progress.work.total;
            if let Some(explicit) = &self.explicit {
                let [now, brought] = explicit.of_added(&self.state);
                energies.kinetic += now;
                energies.kinetic_at_start += brought;
            }
        }
        frame.increment = self.progress.increment;
        frame.work_turnover = self.progress.work.turnover;
        Ok(frame)
    }
}

/// Relative difference below which two times are equal.
pub(super) const TIME: f64 = 1e-12;

/// What is left of an increment after a failure.
fn severity(failure: &Failure) -> f64 {
    match failure {
        Failure::NotFinite { .. } | Failure::Term(_) => CUT_HARD,
        _ => CUT,
    }
}
