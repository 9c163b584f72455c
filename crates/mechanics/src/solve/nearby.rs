//! Equilibria nearby: an increment that failed, gone through in parts before anything else is made of it.
//!
//! Newton's method may fail where nothing jumps: it is the iteration then that does not find the equilibrium, not the
//! equilibrium that is missing. Viscous forces would lead to some equilibrium all the same, but with friction to another
//! one, for what slips on their way has slipped. So before they act, the increment is gone through in smaller and smaller
//! parts, each of them an equilibrium at its own loads. Where that leads to the end of the increment, no jump is needed,
//! and none is taken; where it does not, or where a part moves nodes [`FAR`] times as far as they were going, everything is as
//! before.

use super::Step;
use super::event::{Event, IterationRecord, Observer};
use super::stepping::{Accepted, Stepper, TIME};
use crate::solve::newton::Goal;
use crate::system::{Aid, Archive, Dof, System, TermError};

/// The first part of an increment, and by how much smaller parts are after one that failed.
const PART: f64 = 0.25;
/// The smallest part of an increment that is tried.
const LEAST: f64 = 1.0 / 64.0;

/// Motions of a part over those at the rate before the increment, from which on an equilibrium is not nearby.
const FAR: f64 = 10.0;

/// The change from one state to another over the time that it took.
fn rate(from: &[f64], to: &[f64], dt: f64) -> Vec<f64> {
    let change = to.iter().zip(from);
    change.map(|(now, before)| (now - before) / dt).collect()
}

impl Stepper {
    /// Goes to the step time `end` in parts; `None`, and everything as it is in `before`, where the smallest part fails.
    ///
    /// # Errors
    /// A term that cannot go back.
    pub(super) fn follow(
        &mut self,
        system: &mut System,
        step: &Step,
        end: f64,
        attempt: usize,
        observer: &mut dyn Observer,
    ) -> Result<Option<Accepted>, TermError> {
        let mut before = Archive::default();
        self.save(system, &mut before);
        let from = self.state.u.clone();
        let Some((accepted, parts)) = self.parts(system, step, end, attempt, observer) else {
            self.back(system, &before)?;
            return Ok(None);
        };
        let dt = end - self.progress.time;
        self.progress.rate = rate(&from, &self.state.u, dt);
        (self.progress.jumped, self.progress.curvature) = (false, None);
        // where sizes adapt, the next increment is as long as these parts were
        (self.progress.dt, self.progress.easy) = (Some(dt / parts as f64), 0);
        observer.notice(&Event::Followed {
            step: self.progress.step,
            increment: self.progress.increment + 1,
            attempt,
            parts,
        });
        Ok(Some(accepted))
    }

    /// Whether nodes of the trial state are much farther from the accepted one than they were going at this rate for so long.
    fn is_far(&self, nmotion: usize, dt: f64, rate: &[f64]) -> bool {
        let largest = |most: f64, value: f64| most.max(value.abs());
        let expected = rate.iter().take(nmotion).copied().fold(0.0, largest) * dt;
        let pairs = self.newton.trial.u.iter().zip(&self.state.u).take(nmotion);
        let moved = pairs.map(|(now, before)| now - before).fold(0.0, largest);
        expected > 0.0 && moved > FAR * expected
    }

    /// Back to a stored state, and to the safer ways that terms went there.
    ///
    /// # Errors
    /// A term that cannot go back.
    pub(super) fn back(&mut self, system: &mut System, to: &Archive) -> Result<(), TermError> {
        system.reject();
        let refused = |message: String| TermError::Refused { message };
        self.load(system, to).map_err(|e| refused(e.to_string()))?;
        if self.safer {
            system.aid(Aid::Safer);
        }
        Ok(())
    }

    /// The parts, and how many there were; `None` where the smallest fails.
    fn parts(
        &mut self,
        system: &mut System,
        step: &Step,
        end: f64,
        attempt: usize,
        observer: &mut dyn Observer,
    ) -> Option<(Accepted, usize)> {
        let whole = end - self.progress.time;
        let mut reached = self.progress.time;
        let mut size = PART * whole;
        let mut targets: Vec<(Dof, f64)> = Vec::new();
        let mut pace: Option<Vec<f64>> = None;
        let before = self.progress.rate.clone();
        let nmotion = system.layout.nmotion();
        let mut parts = 0;
        let mut safer = false;
        let mut accepted = Accepted::default();
        while end - reached > TIME * whole {
            let to = if end - reached < 1.5 * size {
                end
            } else {
                reached + size
            };
            self.targets(step, to, &mut targets);
            let dt = to - reached;
            let guess: Option<Vec<f64>> = pace.take().map(|p| p.iter().map(|v| v * dt).collect());
            let goal = Goal {
                time: self.progress.step_start + to,
                targets: &targets,
                guess: guess.as_deref(),
                curvature: None,
            };
            let place = self.place(attempt);
            let from = self.state.u.clone();
            let mut iteration =
                |record: &IterationRecord| observer.notice(&Event::Iteration(record));
            let solved = self
                .newton
                .solve(system, &self.state, &goal, place, &mut iteration);
            // an equilibrium that is far away is a jump, which viscous forces take more gently
            let jumps = solved.is_ok() && self.is_far(nmotion, dt, &before);
            if jumps {
                system.reject();
                return None;
            }
            if let Ok(solved) = solved {
                self.newton.scale.accept(solved.q);
                self.accept(system).ok()?;
                accepted.iterations += solved.iterations;
                accepted.residual = solved.residual;
                pace = Some(rate(&from, &self.state.u, dt));
                (reached, parts, safer) = (to, parts + 1, false);
                continue;
            }
            system.reject();
            // a failure from an extrapolated start says nothing about one from the last state
            if !self.newton.extrapolated {
                safer = !safer && system.aid(Aid::Safer);
                if !safer {
                    system.aid(Aid::Usual);
                    size *= PART;
                }
            }
            if size < LEAST * whole || self.newton.stopping {
                return None;
            }
        }
        Some((accepted, parts))
    }
}
