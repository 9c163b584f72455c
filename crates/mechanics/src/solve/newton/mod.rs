//! One increment by Newton's method.
//!
//! ```text
//!   start ──▶ judge ──▶ in contact, or found: is aid removed? ──▶ judge
//!               ▲   ──▶ found: do terms release what is frozen?  ──▶ judge, or accept
//!               │   ──▶ stopped, not finite, exhausted           ──▶ fail
//!               │   ──▶ else: tangent, linear solve, line search ─┐
//!               └─────────────────────────────────────────────────┘
//! ```
//!
//! What follows an iterate is decided by pure functions of it (`iterate`), and by what the attempt remembers (`course`).

mod accelerations;
mod course;
mod failure;
mod goal;
mod iterate;
mod middle;
mod scale;
mod start;
mod step;

pub use failure::Failure;
pub(super) use goal::{Converged, Goal, Place};
pub(super) use scale::ForceScale;

use super::equations::Equations;
use super::event::{Flow, IterationRecord};
use crate::system::{
    Aid, Assembler, Assembly, Choices, Dof, GeometricStress, Increment, Layout, NodeId, Order,
    Phase, State, StepContext, System, TermError, Verdict,
};
use course::{Course, Released};
use iterate::{Iterate, Next, Why, is_small};
use middle::{Middle, seen};
use scale::{Judgement, ROUND_OFF, Sizes, Tolerance};

/// Whether and how steps are shortened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineSearch {
    /// Where the full step does not lower the energy; without an energy, where it does not lower the slope.
    Auto,
    /// Never.
    Off,
}

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
    /// Which stress the geometric stiffness of bodies takes.
    pub geometric: GeometricStress,
    /// Whether motions without stiffness and without load are held; else they are a failure.
    pub hold_free: bool,
}

impl Default for NewtonSettings {
    fn default() -> Self {
        Self {
            max_iterations: 20,
            force_tol: 1e-6,
            line_search: LineSearch::Auto,
            geometric: GeometricStress::Auto,
            hold_free: false,
        }
    }
}

/// An extrapolated start changes few choices of a term where the term has this many times as many closed contacts.
/// Iterations of an ironing by mortar and one by Gauss points where none and where few may change: 690, 579 and 748, 744.
const FEW: usize = 8;

/// From the attempt after this one on, tangents take current stresses, and steps are shortened as usual.
const PREDICTS_UP_TO: usize = 3;

/// Newton's method with its memory: kept for a whole run.
pub(super) struct Newton {
    pub settings: NewtonSettings,
    pub scale: ForceScale,
    /// The largest distance of a node from the first one along an axis: the size of the model, to a factor of two.
    extent: f64,
    pub assembler: Assembler,
    pub equations: Equations,
    pub assembly: Assembly,
    /// The present step, as terms see it.
    pub step: StepContext,
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
    /// Where inertia counts, what terms see of it.
    between: Option<Middle>,
    before: State,
    du: Vec<f64>,
    /// Dofs at which motions without stiffness are held by the present tangent, each with the stiffness that does.
    held: Vec<(Dof, f64)>,
    /// The largest stiffness of the bodies at the first tangent of the increment.
    stiffest: f64,
    /// Whether multipliers are redundant in this increment, so that tangents let them yield.
    relaxes: bool,
    /// Whether terms ask for the correction that led to the trial state.
    predicts: bool,
    /// Whether the last increment started from an extrapolation.
    pub extrapolated: bool,
    /// Whether an observer has asked to stop.
    pub stopping: bool,
}

impl Newton {
    pub fn new(settings: NewtonSettings, system: &System, equations: Equations) -> Self {
        let System {
            layout,
            elimination,
            terms,
            ..
        } = system;
        // rows of bodies in space are divided where the solver takes them so
        let is_plain = layout.ndim() == 3 && layout.other_nodal().next().is_none();
        let assembler = match equations.ranks().filter(|_| is_plain) {
            Some(ranks) => Assembler::divided(layout, elimination, terms, ranks),
            None => Assembler::new(layout, elimination, terms),
        };
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
            step: StepContext::default(),
            prescribed: Vec::new(),
            analyzed: false,
            coupled_more: false,
            looked: false,
            assembled: None,
            has_tangent: false,
            trial: state.clone(),
            between: None,
            before: state,
            du: Vec::new(),
            held: Vec::new(),
            stiffest: 0.0,
            relaxes: false,
            predicts: false,
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
        let increment = Increment {
            number: place.increment,
            from: base.time,
            to: goal.time,
        };
        let phase = Phase::of_increment(self.step, increment);
        for term in &mut system.terms {
            term.begin(&phase, base)?;
        }
        let mut terms = system.terms.iter();
        let may_predict = place.attempt <= PREDICTS_UP_TO;
        self.predicts = may_predict && terms.any(|term| term.properties().predicts);
        self.between = Middle::new(self.step.scheme.as_ref(), &system.layout, base);
        self.set_negligible(system, self.scale.mean_force());
        self.assembler.begin_increment(&system.terms);
        self.equations.forget();
        (self.has_tangent, self.relaxes, self.stiffest) = (false, false, 0.0);
        let start = self.start(system, base, goal);
        self.extrapolated = start.extrapolated;
        let each = self.settings.max_iterations;
        let mut course = Course::new(each, &start, goal.guess.is_some(), goal.curvature);
        loop {
            let mut iterate = self.judge_iterate(system, base, &mut course)?;
            self.stopping |= report(&record(&course, &iterate, place)) == Flow::Stop;
            if course.watch.sees(&iterate.judgement) && self.aid(system, Aid::Restore) {
                continue;
            }
            course.note(&mut iterate);
            if (iterate.is_found() || iterate.is_in_contact()) && self.aid(system, Aid::Remove) {
                course.aid_removed();
                continue;
            }
            match iterate.next(self.stopping, course.is_exhausted()) {
                Next::Release => match self.release(system)? {
                    None => return Ok(course.converged(&iterate)),
                    Some(changed) => {
                        if !course.released(changed) {
                            return Err(course.failure(Why::Exhausted, &iterate));
                        }
                    }
                },
                Next::Tangent => self.step(system, &mut course, &iterate)?,
                Next::Fail(why) => return Err(course.failure(why, &iterate)),
            }
        }
    }

    /// Lets the terms look at the trial state, assembles and judges it.
    fn judge_iterate(
        &mut self,
        system: &mut System,
        base: &State,
        course: &mut Course,
    ) -> Result<Iterate, Failure> {
        let (layout, now) = (&system.layout, &self.trial.u);
        let rounding = self.rounding(layout);
        let moved = Sizes::new(layout, |dof| at(now, dof) - at(&base.u, dof));
        let moved = moved.at_least_of_own(rounding);
        // after a small correction there is probably no need for a tangent
        let little = course.step.is_measure && is_small(course.step.correction, moved);
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
        self.set_negligible(system, judgement.q[Layout::FORCES]);
        course.reached(&judgement);
        let verdicts = self.verdicts(system);
        Ok(Iterate {
            iterations: course.iterations,
            step: course.step,
            moves_nodes: course.moves_nodes,
            moved,
            rounding,
            judgement,
            closed: system.choices().map(Choices::nactive).sum(),
            flips: verdicts.flips + course.changes_of_start(),
            is_unsettled: verdicts.repeat.is_some(),
            is_continuous: verdicts.continuous,
            unsettled: verdicts.repeat,
        })
    }

    /// Changes how terms help on; where one does, what was assembled holds no more.
    fn aid(&mut self, system: &mut System, aid: Aid) -> bool {
        let changes = system.aid(aid);
        if changes {
            (self.assembled, self.has_tangent) = (None, false);
        }
        changes
    }

    /// Says to all terms which forces are negligible, where this is the mean one.
    fn set_negligible(&self, system: &mut System, mean: f64) {
        for term in system.adaptive() {
            term.set_negligible(self.settings.force_tol * mean);
        }
    }

    /// Lets terms change what they kept frozen; what the first one says that did, so that the iteration goes on.
    fn release(&mut self, system: &mut System) -> Result<Option<Released>, TermError> {
        (self.assembled, self.has_tangent) = (None, false);
        let mut first: Option<Released> = None;
        for term in system.adaptive() {
            let (why, nodes, solve) = match term.converged(self.seen())? {
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

    /// What was found out about the trial state holds no more.
    fn moved(&mut self) {
        (self.looked, self.assembled) = (false, None);
        if let Some(between) = &mut self.between {
            between.follow(&self.trial);
        }
    }

    /// The state between the last accepted one and the trial where terms were evaluated, where inertia counts.
    pub fn between(&self) -> Option<&State> {
        self.between.as_ref().map(|of| &of.state)
    }

    /// The state where terms are evaluated.
    fn seen(&self) -> &State {
        seen(&self.between, &self.trial)
    }

    /// What all terms say of the iterate.
    fn verdicts(&self, system: &mut System) -> Verdicts {
        verdicts(system, self.seen())
    }

    /// Takes all terms back to their accepted history.
    fn forget(&mut self, system: &mut System) {
        system.reject();
        self.moved();
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
        for term in system.adaptive() {
            let state = seen(&self.between, &self.trial);
            self.coupled_more |= term.prepare(state, next)?;
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
            seen(&self.between, &self.trial),
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

    /// The size of the model.
    pub const fn extent(&self) -> f64 {
        self.extent
    }

    fn judge(&self, system: &System) -> Judgement {
        let dofs = self.equations.dofs();
        let tolerance = Tolerance {
            force_tol: self.settings.force_tol,
            extent: self.extent,
            rounding: self.rounding_of_forces(system),
        };
        self.scale.judge(system, dofs, &self.assembly, tolerance)
    }

    /// The rounding error of the forces of bodies that move as they do: that of displacements times the stiffness.
    fn rounding_of_forces(&self, system: &System) -> f64 {
        let motions = self.trial.u.iter().take(system.layout.nmotion());
        f64::EPSILON * self.stiffest * motions.fold(0.0, |most: f64, u| most.max(u.abs()))
    }

    /// The rounding errors of positions, and of the values of other fields.
    fn rounding(&self, layout: &Layout) -> Sizes {
        let places = self.trial.x.iter();
        let far = places.fold(0.0, |most: f64, x| most.max(x.max_abs()));
        let values = Sizes::new(layout, |dof| at(&self.trial.u, dof));
        values.with_motions(far).times(ROUND_OFF)
    }
}

/// What observers see of an iterate.
const fn record(course: &Course, iterate: &Iterate, place: Place) -> IterationRecord {
    IterationRecord {
        step: place.step,
        increment: place.increment,
        attempt: place.attempt,
        iteration: course.iterations + 1,
        residual: iterate.judgement.residual,
        worst: iterate.judgement.worst,
        correction: iterate.step.correction.motions(),
        decrement: iterate.step.decrement,
        linear_iterations: iterate.step.linear_iterations,
        line_search: iterate.step.alpha,
        closed: iterate.closed,
        flips: iterate.flips,
    }
}

/// What all terms say of an iterate.
struct Verdicts {
    /// How many discrete choices changed.
    flips: usize,
    /// Whether these are few in comparison with the closed contacts of every term.
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
    for term in system.choices_mut() {
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

fn at(values: &[f64], dof: usize) -> f64 {
    values.get(dof).copied().unwrap_or_default()
}
