//! Where an increment starts.

use super::goal::{Goal, Start};
use super::{Failure, Newton};
use crate::system::{Dof, Order, State, System, TermError};

impl Newton {
    /// Sets up the trial state, extrapolated where that is of use.
    ///
    /// An extrapolation that cannot be evaluated is of no use. One that changes a few choices of terms is. One that changes
    /// more is of use where nodes have to be moved and all it does is to close contact without friction; one that opens
    /// contact, takes it to other facets, or leaves traces of friction may lead to another equilibrium. Where no nodes have
    /// to be moved, it is of use only where the plain start leaves a larger residual.
    pub(super) fn start(&mut self, system: &mut System, base: &State, goal: &Goal<'_>) -> Start {
        let Some(guess) = goal.guess else {
            let motion = self.begin(system, base, goal);
            return Start {
                motion,
                changes: 0,
                extrapolated: false,
            };
        };
        self.extrapolate(system, base, goal, guess);
        // few choices change, as a rule
        let is_seen = self.prepare(system, Order::Tangent).is_ok();
        let verdicts = self.verdicts(system);
        // a tangent where the iteration goes on from here
        let order = if verdicts.few {
            Order::Tangent
        } else {
            Order::Residual
        };
        let extrapolated = if is_seen {
            self.largest_residual(system, order)
        } else {
            None
        };
        if extrapolated.is_some() && verdicts.few {
            return Start {
                motion: false,
                changes: verdicts.flips,
                extrapolated: true,
            };
        }
        self.forget(system);
        let motion = self.begin(system, base, goal);
        let better = if motion {
            extrapolated.is_some() && verdicts.closing
        } else {
            let plain = self.prepare(system, Order::Residual).ok();
            let plain = plain.and_then(|()| self.largest_residual(system, Order::Residual));
            self.forget(system);
            extrapolated.zip(plain).is_some_and(|(e, p)| e < p)
        };
        if better {
            self.extrapolate(system, base, goal, guess);
        }
        Start {
            motion: motion && !better,
            changes: 0,
            extrapolated: better,
        }
    }

    /// Lets all terms look at an accepted state, and makes room for what they couple there.
    pub fn look_at(&mut self, system: &mut System, state: &State) -> Result<(), Failure> {
        self.between = None;
        self.trial.clone_from(state);
        self.assembler.begin_increment(&system.terms);
        self.moved();
        self.look(system, Order::Tangent)?;
        let (layout, elimination) = (&system.layout, &system.elimination);
        self.assembler
            .update_interface(layout, elimination, &system.terms);
        Ok(())
    }

    /// Lets all terms look at the trial state as it is, and assembles their forces there.
    pub fn evaluate(&mut self, system: &mut System) -> Result<(), TermError> {
        self.between = None;
        self.moved();
        self.look(system, Order::Residual)?;
        self.assemble(system, Order::Residual)
    }

    /// Forgets what is known of the trial state and of its equations.
    pub fn let_go(&mut self) {
        self.moved();
        (self.has_tangent, self.analyzed, self.coupled_more) = (false, false, true);
    }

    /// The largest residual over the mean force at the trial state; `None` where it cannot be evaluated.
    fn largest_residual(&mut self, system: &System, order: Order) -> Option<f64> {
        self.assemble(system, order).ok()?;
        let residual = self.judge(system).residual;
        residual.is_finite().then_some(residual)
    }

    /// Puts the prescribed dofs at their targets and advances the others by `guess`.
    fn extrapolate(&mut self, system: &System, base: &State, goal: &Goal<'_>, guess: &[f64]) {
        self.du.clear();
        self.du.extend_from_slice(guess);
        for &(dof, to) in goal.targets {
            self.du[dof as usize] = to - base.u.get(dof as usize).copied().unwrap_or(to);
        }
        system.advance(&mut self.trial, base, &self.du, 1.0);
        self.trial.time = goal.time;
        self.moved();
    }

    /// Sets up the trial state and the motion of prescribed dofs; says whether nodes have to be moved in the first
    /// solve.
    fn begin(&mut self, system: &System, base: &State, goal: &Goal<'_>) -> bool {
        self.du.clear();
        self.du.resize(system.layout.ndof(), 0.0);
        let is_felt = |dof| system.elimination.is_felt(dof, &system.layout);
        let step = |dof: Dof, to: f64| to - base.u.get(dof as usize).copied().unwrap_or(to);
        for &(dof, to) in goal.targets.iter().filter(|(d, _)| !is_felt(*d)) {
            self.du[dof as usize] = step(dof, to);
        }
        system.advance(&mut self.trial, base, &self.du, 1.0);
        self.trial.time = goal.time;
        self.moved();
        self.du.fill(0.0);
        let mut motion = false;
        for &(dof, to) in goal.targets.iter().filter(|(d, _)| is_felt(*d)) {
            self.du[dof as usize] = step(dof, to);
            motion |= self.du[dof as usize] != 0.0;
        }
        motion
    }
}
