//! One increment by Newton's method.

use super::economy::{Economy, Excess};
use super::equations::{Accuracy, Equations, Factor};
use super::event::{Flow, IterationRecord};
use super::line_search;
use crate::system::linear::{EXACT, LinearError, StartStiffness};
use crate::system::{
    Assembler, Assembly, Dof, DofName, Layout, NodeId, Order, State, System, TermError, Verdict,
};
use thiserror::Error;

/// Whether and how steps are shortened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineSearch {
    /// Where the full step does not lower the energy; without an energy, where it does not lower the slope.
    Auto,
    /// Never.
    Off,
}

/// How many times its iterations an increment may take in all, as long as the residual falls: contact over many nodes that
/// opens from its rim inwards takes an iteration for every row of them.
const PATIENCE: usize = 3;

/// Iterations over which the smallest residual, or the smallest number of discrete choices that change, has to fall to this part
/// of the smallest before them.
const FALLS: (usize, f64) = (5, 0.7);

/// The numbers of Newton's method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonSettings {
    /// Linear solves after which an increment is given up; three times as many while the residual, or the number of discrete
    /// choices that change, falls.
    pub max_iterations: usize,
    /// Largest residual over the mean force, condition (a).
    pub force_tol: f64,
    /// Whether steps are shortened.
    pub line_search: LineSearch,
    /// Whether motions without stiffness and without load are held; else they are a failure.
    pub hold_free: bool,
}

impl Default for NewtonSettings {
    fn default() -> Self {
        Self {
            max_iterations: 20,
            force_tol: 1e-6,
            line_search: LineSearch::Auto,
            hold_free: false,
        }
    }
}

/// Why an increment did not converge.
#[derive(Clone, Debug, Error)]
pub enum Failure {
    /// Too many iterations.
    #[error(
        "{iterations} iterations did not suffice: the largest force error is {residual:.3e} of the mean force"
    )]
    TooManyIterations {
        /// Linear solves done.
        iterations: usize,
        /// Largest residual over the mean force.
        residual: f64,
        /// The dof where it is.
        worst: Option<Dof>,
        /// The residual there, a force.
        force: f64,
        /// What kept changing: the last verdict that was not settled, and its nodes.
        unsettled: Option<(String, Vec<NodeId>)>,
    },
    /// The residual grew beyond all measure.
    #[error("the iteration diverged: the largest force error is {residual:.3e} of the mean force")]
    Diverged {
        /// Linear solves done.
        iterations: usize,
        /// Largest residual over the mean force.
        residual: f64,
        /// The dof where it is.
        worst: Option<Dof>,
    },
    /// No multiple of the step lowers the energy.
    #[error("no multiple of the Newton step lowers the energy: the state may be at a limit load")]
    NoDescent {
        /// Linear solves done.
        iterations: usize,
        /// The dof with the largest residual.
        worst: Option<Dof>,
    },
    /// An observer asked to stop before it had converged.
    #[error("the run was asked to stop after {iterations} iterations of an increment")]
    Interrupted {
        /// Linear solves done.
        iterations: usize,
    },
    /// A term could not be evaluated.
    #[error(transparent)]
    Term(#[from] TermError),
    /// The linear system could not be solved.
    #[error("{source}")]
    Linear {
        /// Why.
        source: LinearError,
        /// The unknown that the solver names.
        dof: Option<Dof>,
    },
}

impl Failure {
    /// Whether something moves freely.
    const fn is_singular(&self) -> bool {
        matches!(
            self,
            Self::Linear {
                source: LinearError::Singular { .. },
                ..
            }
        )
    }
}

/// Free motions that are held at once: a body that is all mechanism is not worth solving.
const HELD_AT_MOST: usize = 200;

/// What holds a free motion bears nothing where its force is below this part of the largest force ...
const BORNE: f64 = 1e-6;

/// ... or its motion, by rounding, below this part of the largest one.
const STILL: f64 = 1e-9;

/// Whether a measure of what is wrong, one for each iteration, still falls.
pub(super) fn falls(measures: &[f64]) -> bool {
    let (window, part) = FALLS;
    let smallest = |some: &[f64]| some.iter().copied().fold(f64::INFINITY, f64::min);
    let Some(at) = measures.len().checked_sub(window).filter(|&at| at > 0) else {
        return false;
    };
    let (before, since) = measures.split_at(at);
    smallest(since) < part * smallest(before)
}

/// What counts as small: residuals are judged against the mean force, separately for forces, moments, multipliers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ForceScale {
    /// q of each kind over the accepted states so far.
    accepted: [f64; KINDS],
}

const KINDS: usize = 3;
const FORCES: usize = 0;
const ROTATIONS: usize = 1;
const MULTIPLIERS: usize = 2;

const fn kind(name: Option<DofName>) -> usize {
    match name {
        Some(DofName::Rotation(..)) => ROTATIONS,
        Some(DofName::Multiplier(_)) => MULTIPLIERS,
        _ => FORCES,
    }
}

/// A state, judged.
#[derive(Clone, Copy, Debug)]
struct Judgement {
    /// max |r| / q over the kinds.
    residual: f64,
    excess: Excess,
    /// The least force or moment that is allowed.
    allowed: f64,
    worst: Option<Dof>,
    force: f64,
    small: bool,
    round_off: bool,
    q: [f64; KINDS],
}

impl ForceScale {
    pub fn accept(&mut self, q: [f64; KINDS]) {
        for (a, q) in self.accepted.iter_mut().zip(q) {
            *a = a.max(q);
        }
    }

    /// The values, for a checkpoint.
    pub const fn to_array(&self) -> [f64; KINDS] {
        self.accepted
    }

    pub const fn from_array(accepted: [f64; KINDS]) -> Self {
        Self { accepted }
    }

    fn judge(
        &self,
        system: &System,
        dofs: &[Dof],
        assembly: &Assembly,
        (force_tol, extent, rounding): (f64, f64, f64),
    ) -> Judgement {
        let layout = &system.layout;
        let mut largest = [0.0f64; KINDS];
        for (dof, m) in assembly.magnitude.iter().enumerate() {
            let k = kind(layout.name(dof as Dof));
            largest[k] = largest[k].max(*m);
        }
        let mut sum = [0.0; KINDS];
        let mut count = [0usize; KINDS];
        for (dof, m) in assembly.magnitude.iter().enumerate() {
            let k = kind(layout.name(dof as Dof));
            if *m > LOADED * largest[k] {
                sum[k] += m;
                count[k] += 1;
            }
        }
        let q: [f64; KINDS] = std::array::from_fn(|k| {
            let mean = if count[k] > 0 {
                sum[k] / count[k] as f64
            } else {
                0.0
            };
            // bodies that move without a force have forces of rounding
            let least = if k == FORCES {
                rounding / force_tol
            } else {
                0.0
            };
            mean.max(self.accepted[k]).max(least)
        });
        let mut judgement = Judgement {
            residual: 0.0,
            excess: Excess::default(),
            allowed: 0.0,
            worst: None,
            force: 0.0,
            small: true,
            round_off: true,
            q,
        };
        // a reaction must be a number, too
        let broken = assembly.residual.iter().position(|r| !r.is_finite());
        if let Some(dof) = broken {
            judgement.residual = f64::NAN;
            judgement.excess.forces = f64::NAN;
            judgement.worst = Some(dof as Dof);
            judgement.force = f64::NAN;
            judgement.small = false;
            judgement.round_off = false;
            return judgement;
        }
        // moments are sums of forces times distances, whose rounding stays where they cancel
        largest[ROTATIONS] += largest[FORCES] * extent;
        let mut least = f64::INFINITY;
        for &dof in dofs {
            let k = kind(layout.name(dof));
            let r = assembly.residual[dof as usize].abs();
            let floor = ROUND_OFF * largest[k] + assembly.uncertainty[dof as usize];
            judgement.round_off &= r <= floor;
            let limit = (force_tol * q[k]).max(floor);
            judgement.small &= r <= limit;
            let excess = if k == MULTIPLIERS {
                &mut judgement.excess.multipliers
            } else {
                least = least.min(limit);
                &mut judgement.excess.forces
            };
            if r > *excess * limit {
                *excess = r / limit;
            }
            // equations of multipliers and moments may hold nothing but their residual: its mean says nothing
            let done = r == 0.0 || (k != FORCES && r <= floor);
            let relative = if done { 0.0 } else { r / q[k] };
            if relative > judgement.residual {
                judgement.residual = relative;
                judgement.worst = Some(dof);
                judgement.force = r;
            }
        }
        judgement.allowed = if least.is_finite() { least } else { 0.0 };
        judgement
    }
}

/// A component carries load where its forces exceed this part of the largest.
const LOADED: f64 = 1e-12;
/// Rounding error of a residual over the sum of the absolute values in it.
const ROUND_OFF: f64 = 100.0 * f64::EPSILON;
/// Condition (d): the last correction over the increment's displacement.
const CORRECTION: f64 = 1e-2;
/// Condition (d'): the same where rows change between states across which forces are continuous, and do not cease to.
const STILL_MOVED: f64 = 1e-6;
/// Residual over the mean force at which an iteration has left the realm of the possible.
const DIVERGED: f64 = 1e12;

/// Choices of a term that an extrapolated start has changed are few where it has so many times as many closed contacts.
/// Iterations of an ironing by mortar and one by Gauss points where none and where few may change: 690, 579 and 748, 744.
const FEW: usize = 8;

/// The correction over the increment's displacement from which on something is not held that has just been let go.
const FLEES: f64 = 1.0;

/// How often a step to a saddle point is halved.
const SHORTENINGS: usize = 10;
/// How often terms may change what they keep frozen, in one increment.
const MAX_AUGMENTATIONS: usize = 60;

/// An increment that converged.
pub(super) struct Converged {
    pub iterations: usize,
    pub residual: f64,
    pub q: [f64; KINDS],
    /// What the first step from an extrapolated start has shown, for the next increment.
    pub curvature: Option<f64>,
}

/// Where an increment stands: for the records.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub step: usize,
    pub increment: usize,
    pub attempt: usize,
}

/// What an increment is to reach.
pub(super) struct Goal<'a> {
    /// Total time at its end.
    pub time: f64,
    /// Values of the prescribed dofs.
    pub targets: &'a [(Dof, f64)],
    /// Expected change of all dofs, from the increments before.
    pub guess: Option<&'a [f64]>,
    /// What the first step from such a start has shown there.
    pub curvature: Option<f64>,
}

/// Newton's method with its memory: kept for a whole run.
pub(super) struct Newton {
    pub settings: NewtonSettings,
    pub scale: ForceScale,
    /// The largest distance of a node from the first one along an axis: the size of the model, to a factor of two.
    extent: f64,
    pub assembler: Assembler,
    pub equations: Equations,
    pub assembly: Assembly,
    /// Raw dofs that are prescribed in this step.
    pub prescribed: Vec<bool>,
    /// Whether the numbering still holds.
    pub analyzed: bool,
    /// Whether a term couples unknowns that the pattern may not hold yet.
    pub coupled_more: bool,
    /// Whether all terms have looked at the trial state as it is.
    looked: bool,
    /// How far the trial state is assembled as it is.
    assembled: Option<Order>,
    /// Whether the last tangent is that of this increment, of terms that have kept the same frozen since.
    has_tangent: bool,
    /// The state of the iterate.
    pub trial: State,
    before: State,
    du: Vec<f64>,
    /// Dofs at which motions without stiffness are held by the present tangent, each with the stiffness that does.
    held: Vec<(Dof, f64)>,
    /// The largest stiffness of the bodies at the first tangent of the increment.
    stiffest: f64,
    /// Whether multipliers are redundant in this increment, so that tangents let them yield.
    relaxes: bool,
    /// Whether the last increment started from an extrapolation.
    pub extrapolated: bool,
    /// Whether an observer has asked to stop.
    pub stopping: bool,
}

impl Newton {
    pub fn new(settings: NewtonSettings, system: &System, equations: Equations) -> Self {
        let assembler = Assembler::new(&system.layout, &system.elimination, &system.terms);
        Self::with(settings, system, equations, assembler)
    }

    /// Goes on in the place of this one as a new one does: what never changes is not made again.
    pub fn renewed(
        self,
        settings: NewtonSettings,
        system: &System,
        mut equations: Equations,
    ) -> Self {
        equations.inherit(self.equations);
        let System {
            layout,
            elimination,
            terms,
            ..
        } = system;
        let assembler = self.assembler.renewed(layout, elimination, terms);
        Self::with(settings, system, equations, assembler)
    }

    fn with(
        settings: NewtonSettings,
        system: &System,
        equations: Equations,
        assembler: Assembler,
    ) -> Self {
        let state = system.initial_state();
        let first = state.x.first().copied().unwrap_or_default();
        let apart = state.x.iter().map(|x| (*x - first).max_abs());
        let extent = apart.fold(0.0, f64::max);
        Self {
            settings,
            extent,
            scale: ForceScale::default(),
            assembler,
            equations,
            assembly: Assembly::default(),
            prescribed: Vec::new(),
            analyzed: false,
            coupled_more: false,
            looked: false,
            assembled: None,
            has_tangent: false,
            trial: state.clone(),
            before: state,
            du: Vec::new(),
            held: Vec::new(),
            stiffest: 0.0,
            relaxes: false,
            extrapolated: false,
            stopping: false,
        }
    }

    /// Solves one increment from the accepted state `base`. Afterwards `trial` is the new state.
    ///
    /// # Errors
    /// Why it did not converge; `Interrupted` where `report` asks to stop before it has.
    pub fn solve(
        &mut self,
        system: &mut System,
        base: &State,
        goal: &Goal<'_>,
        place: Place,
        report: &mut dyn FnMut(&IterationRecord) -> Flow,
    ) -> Result<Converged, Failure> {
        for term in &mut system.terms {
            term.begin_increment(base)?;
        }
        self.let_pass(system, self.scale.accepted[FORCES]);
        self.assembler.begin_increment(&system.terms);
        self.equations.forget();
        (self.has_tangent, self.relaxes, self.stiffest) = (false, false, 0.0);
        let Start {
            mut motion,
            changes: mut of_start,
            extrapolated,
        } = self.start(system, base, goal);
        self.extrapolated = extrapolated;
        let mut correction = 0.0;
        // whether a correction tells how far off the state is
        let mut solved = false;
        // whether what terms keep frozen has changed since the last solution
        let mut released = false;
        // the residual where terms have let go of what they held, until a correction has shown whether contact holds it
        let mut watched: Option<Option<f64>> = None;
        let mut alpha = 1.0;
        let mut decrement = 0.0;
        let mut unsettled = None;
        let is_like = goal.guess.is_some() && !motion;
        let mut economy = Economy::new(goal.curvature.filter(|_| is_like));
        let mut first_curvature = None;
        let mut last = self.settings.max_iterations;
        let mut augmentations = 0;
        let nmotion = system.layout.nmotion();
        let mut iterations = 0;
        let mut residuals = Vec::with_capacity(last + 1);
        let mut changes_so_far = Vec::with_capacity(last + 1);
        loop {
            let moved = largest_difference(&self.trial.u[..nmotion], &base.u[..nmotion]);
            let little = solved && correction <= CORRECTION * moved;
            // after a small correction there is probably no need for a tangent
            let first = if little {
                Order::Residual
            } else {
                Order::Tangent
            };
            self.prepare(system, first)?;
            if self.assembled < Some(first) {
                self.assemble(system, first)?;
            }
            let judgement = self.judge(system);
            self.let_pass(system, judgement.q[FORCES]);
            economy.reached(judgement.excess);
            if iterations == 1 && is_like {
                first_curvature = economy.curvature();
            }
            let Verdicts {
                flips,
                repeat,
                continuous,
                ..
            } = verdicts(system, &self.trial);
            let flips = flips + std::mem::take(&mut of_start);
            let closed = nclosed(system);
            let flow = report(&IterationRecord {
                step: place.step,
                increment: place.increment,
                attempt: place.attempt,
                iteration: iterations + 1,
                residual: judgement.residual,
                worst: judgement.worst,
                correction,
                decrement,
                line_search: alpha,
                closed,
                flips,
            });
            self.stopping |= flow == Flow::Stop;
            match &mut watched {
                Some(none @ None) => *none = Some(judgement.residual),
                Some(Some(left)) => {
                    let flees = !judgement.small && judgement.residual > *left;
                    watched = None;
                    if flees && hold_again(system) {
                        (self.assembled, self.has_tangent) = (None, false);
                        continue;
                    }
                }
                None => {}
            }
            // where forces are continuous, the residual alone is the error of the state, whatever its status
            let still = || correction <= alpha * (STILL_MOVED * moved).max(self.rounding());
            let changes = repeat.is_some() && continuous;
            let indifferent = changes && judgement.small && solved && still();
            let settled = repeat.is_none() || iterations == 0 || indifferent;
            residuals.push(judgement.residual);
            // the first iterate has nothing to compare with
            changes_so_far.push(if iterations == 0 {
                f64::INFINITY
            } else {
                flips as f64
            });
            unsettled = repeat.or(unsettled);
            let known = judgement.round_off || little || indifferent;
            let is_found = !motion && judgement.small && settled && known;
            // a step that was shortened has not shown yet what else closes
            let is_whole = iterations > 0 && alpha >= 1.0;
            let is_held = !motion && settled && is_whole && closed > 0;
            if (is_found || is_held) && let_go(system) {
                watched = Some(None);
                (self.assembled, self.has_tangent) = (None, false);
                last = iterations + self.settings.max_iterations;
                residuals.clear();
                changes_so_far.clear();
                correction = 0.0;
                solved = false;
                continue;
            }
            if is_found {
                match self.release(system)? {
                    None => {
                        return Ok(Converged {
                            iterations,
                            residual: judgement.residual,
                            q: judgement.q,
                            curvature: first_curvature,
                        });
                    }
                    Some(changed) if augmentations < MAX_AUGMENTATIONS => {
                        unsettled = Some(changed.said);
                        augmentations += 1;
                        last = iterations + self.settings.max_iterations;
                        residuals.clear();
                        changes_so_far.clear();
                        // the change may be of no account: then the state is judged again as it is, but only once
                        if std::mem::replace(&mut released, true) || changed.solve {
                            correction = 0.0;
                            solved = false;
                        }
                        continue;
                    }
                    Some(changed) => {
                        return Err(Failure::TooManyIterations {
                            iterations,
                            residual: judgement.residual,
                            worst: judgement.worst,
                            force: judgement.force,
                            unsettled: Some(changed.said),
                        });
                    }
                }
            }
            if self.stopping {
                return Err(Failure::Interrupted { iterations });
            }
            if judgement.residual.is_nan() || judgement.residual > DIVERGED {
                return Err(Failure::Diverged {
                    iterations,
                    residual: judgement.residual,
                    worst: judgement.worst,
                });
            }
            let longest = last + (PATIENCE - 1) * self.settings.max_iterations;
            let progresses = falls(&residuals) || falls(&changes_so_far);
            let goes_on = iterations < longest && progresses;
            if iterations >= last && !goes_on {
                return Err(Failure::TooManyIterations {
                    iterations,
                    residual: judgement.residual,
                    worst: judgement.worst,
                    force: judgement.force,
                    unsettled,
                });
            }
            let is_iterative = self.equations.is_iterative();
            let has_none = self.assembled < Some(Order::Tangent);
            let serves = has_none && self.has_tangent && !motion && settled && flips == 0;
            // solutions that are not exact need no exact tangent
            let serves = serves && is_iterative && economy.is_nearly_straight(judgement.excess);
            if has_none && !serves {
                self.assemble(system, Order::Tangent)?;
            }
            // where only the size of the next correction is left to show, the last factor tells it
            let nearly = iterations > 0 && !motion && judgement.small && settled;
            let accuracy = if is_iterative {
                let is_unknown = iterations == 0 && economy.curvature().is_none();
                let changes = motion || is_unknown || !settled || flips > 0;
                // forces that are small already tell nothing of the correction unless they are solved for
                let allowed = if nearly { 0.0 } else { judgement.allowed };
                economy.accuracy(judgement.excess.forces, allowed, changes || nearly)
            } else {
                Accuracy::Residual(EXACT)
            };
            let which = self.assembler.start(&system.terms);
            if self.equations.wants_start(which) {
                let bulk = self.bulk_at_start(system)?;
                self.equations.start_from(which, bulk);
            }
            let keeps = nearly || serves;
            let left = match self.solve_linear(&system.layout, motion, keeps, accuracy) {
                Err(failure) if failure.is_singular() && hold_again(system) => {
                    (self.assembled, self.has_tangent) = (None, false);
                    continue;
                }
                solved => solved?,
            };
            // what contact holds hardly moves when it is let go
            let flees = watched.is_some() && largest(&self.du[..nmotion]) > FLEES * moved;
            if flees && hold_again(system) {
                watched = None;
                (self.assembled, self.has_tangent) = (None, false);
                continue;
            }
            if !serves {
                economy.solved(judgement.excess, left);
            }
            decrement = self.slope().abs().sqrt();
            let is_last = largest(&self.du[..nmotion]) <= CORRECTION * moved;
            let next = if is_last {
                Order::Residual
            } else {
                Order::Tangent
            };
            alpha = self.advance(system, motion, next, iterations + 1, judgement.worst)?;
            correction = alpha * largest(&self.du[..nmotion]);
            motion = false;
            solved = true;
            released = false;
            iterations += 1;
        }
    }

    /// Says to all terms which forces are of no account, where this is the mean one.
    fn let_pass(&self, system: &mut System, mean: f64) {
        for term in &mut system.terms {
            term.let_pass(self.settings.force_tol * mean);
        }
    }

    /// Lets terms change what they kept frozen; what the first one says that did, so that the iteration goes on.
    fn release(&mut self, system: &mut System) -> Result<Option<Released>, TermError> {
        (self.assembled, self.has_tangent) = (None, false);
        let mut first: Option<Released> = None;
        for term in &mut system.terms {
            let (why, nodes, solve) = match term.converged(&self.trial)? {
                Verdict::Settled => continue,
                Verdict::Repeat { why, nodes, .. } => (why, nodes, false),
                Verdict::Renewed { why } => (why, Vec::new(), true),
            };
            let first = first.get_or_insert(Released {
                said: (why, nodes),
                solve,
            });
            first.solve |= solve;
        }
        Ok(first)
    }

    /// Sets up the trial state, extrapolated where that is of use.
    ///
    /// An extrapolation that cannot be evaluated is of no use. One that changes a few choices of terms is. One that changes
    /// more is of use where nodes have to be moved and all it does is to close contact without friction; one that opens
    /// contact, takes it to other facets, or leaves traces of friction may lead to another equilibrium. Where no nodes have
    /// to be moved, it is of use only where the plain start leaves a larger residual.
    fn start(&mut self, system: &mut System, base: &State, goal: &Goal<'_>) -> Start {
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
        let verdicts = verdicts(system, &self.trial);
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

    /// What was found out about the trial state holds no more.
    const fn moved(&mut self) {
        (self.looked, self.assembled) = (false, None);
    }

    /// Takes all terms back to their accepted history.
    fn forget(&mut self, system: &mut System) {
        for term in &mut system.terms {
            term.reject();
        }
        self.moved();
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

    /// Lets all terms look at the trial state and keeps the pattern up to date. `next` is what will be wanted there.
    fn prepare(&mut self, system: &mut System, next: Order) -> Result<(), Failure> {
        if !self.looked {
            self.look(system, next)?;
        }
        if self.coupled_more {
            let (layout, elimination) = (&system.layout, &system.elimination);
            let changed = self
                .assembler
                .update_interface(layout, elimination, &system.terms);
            self.analyzed &= !changed;
            self.coupled_more = false;
            // what has no place yet was left out
            self.assembled = self.assembled.map(|_| Order::Residual);
        }
        if !self.analyzed {
            self.equations
                .analyze(system, &self.assembler, &self.prescribed)
                .map_err(|source| self.linear_failure(source))?;
            (self.analyzed, self.has_tangent) = (true, false);
        }
        Ok(())
    }

    /// Lets all terms look at the trial state.
    fn look(&mut self, system: &mut System, next: Order) -> Result<(), TermError> {
        for term in &mut system.terms {
            self.coupled_more |= term.prepare(&self.trial, next)?;
        }
        (self.looked, self.assembled) = (true, None);
        Ok(())
    }

    fn assemble(&mut self, system: &System, order: Order) -> Result<(), TermError> {
        self.assembled = None;
        if order == Order::Tangent {
            self.held.clear();
            // one that fails leaves a torn one
            self.has_tangent = false;
        }
        self.assembler.assemble(
            &system.layout,
            &system.elimination,
            &system.terms,
            &self.trial,
            order,
            &mut self.assembly,
        )?;
        if self.stiffest == 0.0 && order == Order::Tangent {
            self.stiffest = Assembler::stiffest(&self.assembly);
        }
        if self.relaxes && order == Order::Tangent {
            self.assembler.relax(&system.layout, &mut self.assembly);
        }
        self.assembled = Some(order);
        self.has_tangent |= order == Order::Tangent;
        Ok(())
    }

    /// The stiffness of the bodies at the start of the run; a tangent is assembled.
    fn bulk_at_start(&mut self, system: &System) -> Result<StartStiffness, TermError> {
        if self.assembler.is_constant() {
            return Ok(StartStiffness::Always);
        }
        if self.assembler.is_at_start(&system.terms, &self.trial) {
            return Ok(StartStiffness::Next);
        }
        let bulk = self.assembler.bulk_at_start(
            &system.layout,
            &system.elimination,
            &system.terms,
            &self.trial,
        );
        bulk.map(StartStiffness::Values)
    }

    fn judge(&self, system: &System) -> Judgement {
        let dofs = self.equations.dofs();
        self.scale.judge(
            system,
            dofs,
            &self.assembly,
            (
                self.settings.force_tol,
                self.extent,
                self.rounding_of_forces(system),
            ),
        )
    }

    /// The rounding error of the forces of bodies that move as they do: that of displacements times the stiffness.
    fn rounding_of_forces(&self, system: &System) -> f64 {
        let motions = self.trial.u.iter().take(system.layout.nmotion());
        f64::EPSILON * self.stiffest * motions.fold(0.0, |most: f64, u| most.max(u.abs()))
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

    fn linear_failure(&self, source: LinearError) -> Failure {
        let equation = match &source {
            LinearError::Singular { equation } => *equation,
            _ => None,
        };
        Failure::Linear {
            dof: self.equations.dof(equation),
            source,
        }
    }

    /// Moves the trial state along `du`, as far as the line search says, and returns how far. `next` is what will be
    /// wanted there.
    fn advance(
        &mut self,
        system: &mut System,
        motion: bool,
        next: Order,
        iterations: usize,
        worst: Option<Dof>,
    ) -> Result<f64, Failure> {
        self.before.clone_from(&self.trial);
        let du = &self.du;
        let limits = system.terms.iter().map(|t| t.max_step(&self.before, du));
        let first = limits.fold(1.0, f64::min);
        // a prescribed motion is taken whole: the energy before it is another problem's
        if motion || self.settings.line_search == LineSearch::Off {
            let alpha = if motion { 1.0 } else { first };
            self.place(system, alpha);
            return Ok(alpha);
        }
        if system.terms.iter().any(|t| t.has_saddle()) {
            return self.shorten(system, first, next);
        }
        let slope = self.slope();
        let start = self.assembler.energy(&system.terms, &self.before)?;
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
            return Err(in_the_way.unwrap_or(Failure::NoDescent { iterations, worst }));
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
        let energy = self.assembler.energy(&system.terms, &self.trial);
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
        self.moved();
    }

    /// The rounding error of positions.
    fn rounding(&self) -> f64 {
        let places = self.trial.x.iter();
        ROUND_OFF * places.fold(0.0, |most: f64, x| most.max(x.max_abs()))
    }

    /// s = du·r over the unknowns.
    fn slope(&self) -> f64 {
        let product = |&dof: &Dof| self.du[dof as usize] * self.assembly.residual[dof as usize];
        self.equations.dofs().iter().map(product).sum()
    }
}

/// How many contacts are closed at the present iterate.
fn nclosed(system: &System) -> usize {
    system.terms.iter().map(|t| t.nactive()).sum()
}

/// Whether some term lets go of what it has held so far.
fn let_go(system: &mut System) -> bool {
    let mut some = false;
    for term in &mut system.terms {
        some |= term.let_go();
    }
    some
}

/// Whether some term holds again what it has let go.
fn hold_again(system: &mut System) -> bool {
    let mut some = false;
    for term in &mut system.terms {
        some |= term.hold_again();
    }
    some
}

/// What terms have changed that they kept frozen.
struct Released {
    /// What the first of them says, and its nodes.
    said: (String, Vec<NodeId>),
    /// Whether the state has to be solved for again.
    solve: bool,
}

/// How an increment starts.
struct Start {
    /// Whether nodes have to be moved in the first solve.
    motion: bool,
    /// How many discrete choices have changed, as terms have told already.
    changes: usize,
    /// Whether it is the extrapolation.
    extrapolated: bool,
}

/// What all terms say of an iterate.
struct Verdicts {
    /// How many discrete choices changed.
    flips: usize,
    /// Whether these are few beside the closed contacts of every term.
    few: bool,
    /// What the first term that is not settled says.
    repeat: Option<(String, Vec<NodeId>)>,
    /// Whether all that changed is contact without friction that closed.
    closing: bool,
    /// Whether forces are continuous across all that changed.
    continuous: bool,
}

fn verdicts(system: &mut System, trial: &State) -> Verdicts {
    let mut all = Verdicts {
        flips: 0,
        few: true,
        repeat: None,
        closing: true,
        continuous: true,
    };
    for term in &mut system.terms {
        if let Verdict::Repeat {
            changes,
            closing,
            continuous,
            why,
            nodes,
        } = term.verdict(trial)
        {
            all.flips += changes;
            all.few &= FEW * changes <= term.nactive();
            all.closing &= closing;
            all.continuous &= continuous;
            all.repeat.get_or_insert((why, nodes));
        }
    }
    all
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| v.abs().max(m))
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max)
}
