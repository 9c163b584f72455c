//! Increments at whose end there is no equilibrium nearby: a jump, taken in slow motion.
//!
//! A point that slips over an edge, or a body that snaps through, leaves one branch of equilibria for another: no
//! increment is small enough for Newton's method to follow. Viscous forces `c k (u − u_n)` turn the jump into a motion
//! in a time of its own, at the loads of the end of the increment (E1), in stages of implicit Euler
//!
//! ```text
//! r(u_{n+1}) + c_n k (u_{n+1} − u_n − d_n) = 0                                                  (E1)
//! ```
//!
//! with a viscosity `c_n` that falls as stages succeed and grows where one fails. The drift `d_n` is what the state would
//! have changed by at the rate before the jump; it belongs to the first stage, which takes the loads to the end of the
//! increment. What slips on the way slips stage by stage. When viscosity has fallen to [`FAINT`], the equilibrium is looked for without it. So the state that is
//! accepted is one of equilibrium like any other; which of several it is, and what friction dissipates on the way, is
//! what a slow jump would give. The work of the viscous forces is reported next to that of supports and loads.
//!
//! A jump is taken only where no equilibrium is found without it: before, the increment is gone through in parts
//! ([`super::nearby`]).
//!
//! Limits: inertia plays no part. A stage takes no time, in which no heat could be stored: transient steps take no jumps. A jump that
//! never comes to rest (a body that falls, a limit load) fails as before.

use super::event::{Event, Observer};
use super::step::Step;
use super::stepping::{Accepted, Stepper};
use crate::solve::newton::Goal;
use crate::system::{Archive, Dof, Heat, System, TermError, Viscous};

/// Viscosity below which the equilibrium is looked for without it.
const FAINT: f64 = 1e-6;
/// Viscosity above which stages no longer get anywhere.
const STIFF: f64 = 1e6;
/// What is left of it after a stage that was easy, and after another that succeeded.
const FALL: [f64; 2] = [0.1, 0.3];
/// Stages after one that failed in which it does not fall: an instability needs them to grow.
const PATIENCE: usize = 2;
/// By how much it grows after a stage that failed.
const GROWTH: f64 = 3.0;
/// Stages, at most.
const MAX_STAGES: usize = 100;
/// Iterations of a stage, at most: with viscosity enough it needs few.
const MAX_ITERATIONS: usize = 8;
/// Iterations up to which a stage counts as easy.
const EASY: usize = 4;

impl Stepper {
    /// Goes to the step time `end` where sizes of the increment have failed: in parts, and if that does not get there, in
    /// slow motion, where bodies store no heat; `None` where neither does.
    pub(super) fn help(
        &mut self,
        system: &mut System,
        step: &Step,
        end: f64,
        attempt: usize,
        observer: &mut dyn Observer,
    ) -> Result<Option<Accepted>, TermError> {
        if !has_brake(system) {
            return Ok(None);
        }
        if let Some(accepted) = self.follow(system, step, end, attempt, observer)? {
            return Ok(Some(accepted));
        }
        // stages take no time, in which nothing stores heat
        if step.physics.heat == Heat::Transient {
            return Ok(None);
        }
        let mut targets = Vec::new();
        self.targets(step, end, &mut targets);
        self.stabilize(system, end, &targets, attempt, observer)
    }

    /// Goes to the step time `end` in slow motion; `None`, and everything as before, where that does not lead to an
    /// equilibrium.
    ///
    /// # Errors
    /// A term that cannot go back.
    fn stabilize(
        &mut self,
        system: &mut System,
        end: f64,
        targets: &[(Dof, f64)],
        attempt: usize,
        observer: &mut dyn Observer,
    ) -> Result<Option<Accepted>, TermError> {
        let spent = work_of(system);
        let mut before = Archive::default();
        self.save(system, &mut before);
        let iterations = self.newton.settings.max_iterations;
        self.newton.settings.max_iterations = iterations.min(MAX_ITERATIONS);
        let found = self.slow_motion(system, end, targets, attempt, observer);
        self.newton.settings.max_iterations = iterations;
        damp(system, 0.0, &[]);
        let Some((accepted, stages)) = found else {
            self.back(system, &before)?;
            return Ok(None);
        };
        self.progress.jumped = true;
        let event = Event::Stabilized {
            step: self.progress.step,
            increment: self.progress.increment + 1,
            attempt,
            stages,
            work: work_of(system) - spent,
            external: self.progress.work.total,
        };
        observer.notice(&event);
        Ok(Some(accepted))
    }

    /// The stages (E1), and the last one without viscosity; how many there were.
    fn slow_motion(
        &mut self,
        system: &mut System,
        end: f64,
        targets: &[(Dof, f64)],
        attempt: usize,
        observer: &mut dyn Observer,
    ) -> Option<(Accepted, usize)> {
        let mut viscosity = 1.0;
        let mut patience = 0;
        let dt = end - self.progress.time;
        let mut drift: Vec<f64> = self.progress.rate.iter().map(|r| r * dt).collect();
        let mut accepted = Accepted::default();
        for stage in 1..=MAX_STAGES {
            let last = viscosity < FAINT;
            damp(system, if last { 0.0 } else { viscosity }, &drift);
            let goal = Goal {
                time: self.progress.step_start + end,
                targets,
                guess: None,
                curvature: None,
            };
            let place = self.place(attempt);
            let solved = self
                .newton
                .solve(system, &self.state, &goal, place, &mut |record| {
                    observer.notice(&Event::Iteration(record))
                });
            let Ok(solved) = solved else {
                system.reject();
                viscosity = viscosity.max(FAINT) * GROWTH;
                patience = PATIENCE;
                if viscosity > STIFF || self.newton.stopping {
                    return None;
                }
                continue;
            };
            self.accept(system).ok()?;
            drift.clear();
            accepted.iterations += solved.iterations;
            accepted.residual = solved.residual;
            if last {
                self.newton.scale.accept(solved.q);
                return Some((accepted, stage));
            }
            if patience == 0 {
                viscosity *= FALL[usize::from(solved.iterations > EASY)];
            }
            patience = patience.saturating_sub(1);
        }
        None
    }
}

/// The work of viscous forces since the start of the run.
pub(super) fn work_of(system: &System) -> f64 {
    let terms = system.terms.iter();
    let viscous = terms.filter_map(|term| term.capabilities().viscous);
    viscous.map(Viscous::work).sum()
}

/// Whether a term has viscous forces.
fn has_brake(system: &mut System) -> bool {
    damp(system, 0.0, &[])
}

/// Asks all terms for viscous forces; says whether there are any.
fn damp(system: &mut System, viscosity: f64, drift: &[f64]) -> bool {
    let terms = system.terms.iter_mut();
    let viscous = terms.filter_map(|term| term.adaptive()?.viscous());
    viscous.fold(false, |any, term| any | term.damp(viscosity, drift))
}
