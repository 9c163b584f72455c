//! What an attempt at an increment remembers from one iterate to the next.

use super::failure::Failure;
use super::goal::{Converged, Start};
use super::iterate::{Iterate, LastStep, Why};
use super::scale::{Judgement, Sizes};
use crate::solve::economy::Economy;
use crate::system::NodeId;

/// How many times its iterations an increment may take in all, as long as the residual falls: contact over many nodes that
/// opens from its rim inwards takes an iteration for every row of them.
const PATIENCE: usize = 3;

/// Iterations over which the smallest residual, or the smallest number of discrete choices that change, has to fall to this part
/// of the smallest before them.
const FALLS: (usize, f64) = (5, 0.7);

/// The correction over the increment's displacement from which on contact does not hold what aid held.
const FLEES: f64 = 1.0;

/// How often terms may change what they keep frozen, in one increment.
const MAX_AUGMENTATIONS: usize = 60;

/// Whether a measure of what is wrong, one for each iteration, still falls.
fn falls(measures: &[f64]) -> bool {
    let (window, part) = FALLS;
    let smallest = |some: &[f64]| some.iter().copied().fold(f64::INFINITY, f64::min);
    let Some(at) = measures.len().checked_sub(window).filter(|&at| at > 0) else {
        return false;
    };
    let (before, since) = measures.split_at(at);
    smallest(since) < part * smallest(before)
}

/// Whether contact holds bodies without the aid of terms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Watch {
    /// No aid has been removed.
    #[default]
    Off,
    /// Aid has, and the state has not been judged since.
    Removed,
    /// Aid has, with this residual: the next step shows whether contact holds what it held.
    From(f64),
}

impl Watch {
    /// Takes note of an iterate; whether its residual shows that something moves freely.
    pub fn sees(&mut self, judgement: &Judgement) -> bool {
        let before = std::mem::take(self);
        match before {
            Self::Off => false,
            Self::Removed => {
                *self = Self::From(judgement.residual);
                false
            }
            Self::From(left) => !judgement.small && judgement.residual > left,
        }
    }

    /// Whether a correction shows it: what contact holds hardly moves when aid is removed.
    pub fn sees_correction(&mut self, correction: f64, moved: f64) -> bool {
        let flees = *self != Self::Off && correction > FLEES * moved;
        if flees {
            *self = Self::Off;
        }
        flees
    }
}

/// How many iterations an attempt still has.
#[derive(Clone, Debug)]
struct Allowance {
    /// Linear solves for each problem.
    each: usize,
    /// Linear solves after which the present one is given up, unless it progresses.
    last: usize,
    /// The residuals of the present one.
    residuals: Vec<f64>,
    /// The numbers of discrete choices that changed.
    changes: Vec<f64>,
}

impl Allowance {
    fn new(each: usize) -> Self {
        Self {
            each,
            last: each,
            residuals: Vec::with_capacity(each + 1),
            changes: Vec::with_capacity(each + 1),
        }
    }

    fn note(&mut self, iterate: &Iterate) {
        self.residuals.push(iterate.judgement.residual);
        // the first iterate has nothing to compare with
        let is_first = iterate.iterations == 0;
        let changes = iterate.flips as f64;
        self.changes
            .push(if is_first { f64::INFINITY } else { changes });
    }

    /// The problem is another one from now on.
    fn begin_again(&mut self, iterations: usize) {
        self.last = iterations + self.each;
        self.residuals.clear();
        self.changes.clear();
    }

    fn is_used_up(&self, iterations: usize) -> bool {
        let longest = self.last + (PATIENCE - 1) * self.each;
        let progresses = falls(&self.residuals) || falls(&self.changes);
        iterations >= self.last && !(iterations < longest && progresses)
    }
}

/// What terms have changed that they kept frozen.
pub(super) struct Released {
    /// What the first of them says, and its nodes.
    pub said: (String, Vec<NodeId>),
    /// Whether the state has to be solved for again.
    pub solve: bool,
}

/// An attempt at an increment, on its way.
pub(super) struct Course {
    /// Linear solves so far.
    pub iterations: usize,
    /// Whether prescribed nodes have yet to be moved, by the next solve.
    pub moves_nodes: bool,
    /// The last step.
    pub step: LastStep,
    /// How exactly the next one has to be solved for.
    pub economy: Economy,
    /// Whether contact holds bodies without the aid of terms.
    pub watch: Watch,
    /// Discrete choices that the start has changed, until they are counted.
    of_start: usize,
    /// Whether the increment starts as those do whose curvature is compared.
    is_like: bool,
    first_curvature: Option<f64>,
    allowance: Allowance,
    unsettled: Option<(String, Vec<NodeId>)>,
    /// Whether what terms keep frozen has changed since the last step.
    is_released: bool,
    augmentations: usize,
}

impl Course {
    /// At the start of an increment that may be extrapolated, and then is like the one with this curvature.
    pub fn new(each: usize, start: &Start, is_guessed: bool, curvature: Option<f64>) -> Self {
        let is_like = is_guessed && !start.motion;
        Self {
            iterations: 0,
            moves_nodes: start.motion,
            step: LastStep {
                alpha: 1.0,
                ..LastStep::default()
            },
            economy: Economy::new(curvature.filter(|_| is_like)),
            watch: Watch::Off,
            of_start: start.changes,
            is_like,
            first_curvature: None,
            allowance: Allowance::new(each),
            unsettled: None,
            is_released: false,
            augmentations: 0,
        }
    }

    /// Discrete choices that the start has changed, the first time.
    pub fn changes_of_start(&mut self) -> usize {
        std::mem::take(&mut self.of_start)
    }

    /// Takes note of where the last step has led.
    pub fn reached(&mut self, judgement: &Judgement) {
        self.economy.reached(judgement.excess);
        if self.iterations == 1 && self.is_like {
            self.first_curvature = self.economy.curvature();
        }
    }

    /// Takes note of an iterate from which the attempt goes on.
    pub fn note(&mut self, iterate: &mut Iterate) {
        self.allowance.note(iterate);
        if let Some(unsettled) = iterate.unsettled.take() {
            self.unsettled = Some(unsettled);
        }
    }

    /// Whether its iterations are at an end.
    pub fn is_exhausted(&self) -> bool {
        self.allowance.is_used_up(self.iterations)
    }

    /// Terms have removed their aid: the state without it is looked for.
    pub fn aid_removed(&mut self) {
        self.watch = Watch::Removed;
        self.begin_again();
    }

    /// Terms have changed what they kept frozen. Says whether the attempt goes on.
    pub fn released(&mut self, changed: Released) -> bool {
        self.unsettled = Some(changed.said);
        if self.augmentations >= MAX_AUGMENTATIONS {
            return false;
        }
        self.augmentations += 1;
        // the change may be of no account: then the state is judged again as it is, but only once
        if std::mem::replace(&mut self.is_released, true) || changed.solve {
            self.begin_again();
        } else {
            self.allowance.begin_again(self.iterations);
        }
        true
    }

    fn begin_again(&mut self) {
        self.allowance.begin_again(self.iterations);
        (self.step.correction, self.step.is_measure) = (Sizes::default(), false);
    }

    /// This step was taken.
    pub fn stepped(&mut self, step: LastStep) {
        self.step = step;
        self.moves_nodes = false;
        self.is_released = false;
        self.iterations += 1;
    }

    /// The increment has converged.
    pub const fn converged(&self, at: &Iterate) -> Converged {
        Converged {
            iterations: self.iterations,
            residual: at.judgement.residual,
            q: at.judgement.q,
            curvature: self.first_curvature,
        }
    }

    /// It has not.
    pub fn failure(self, why: Why, at: &Iterate) -> Failure {
        let iterations = self.iterations;
        let Judgement {
            residual,
            worst,
            force,
            ..
        } = at.judgement;
        match why {
            Why::Interrupted => Failure::Interrupted { iterations },
            Why::NotFinite => Failure::NotFinite {
                iterations,
                dof: worst,
            },
            Why::Exhausted => Failure::TooManyIterations {
                iterations,
                residual,
                worst,
                force,
                unsettled: self.unsettled,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wrong_falls_where_its_least_of_late_is_well_below_the_least_before() {
        let never = [f64::INFINITY, 9.0, 8.0, 7.0, 8.0, 9.0, 6.5, 8.0];
        let does = [f64::INFINITY, 9.0, 8.0, 7.0, 8.0, 9.0, 4.0, 8.0];
        let done = [f64::INFINITY, 9.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let short = [9.0, 1.0, 0.0, 0.0, 0.0];
        let all = [&never[..], &does, &done, &short].map(falls);
        assert_eq!(all, [false, true, false, false]);
    }

    fn residual(residual: f64, small: bool) -> Judgement {
        Judgement {
            residual,
            small,
            ..Judgement::EMPTY
        }
    }

    #[test]
    fn a_residual_that_grows_once_aid_is_removed_shows_that_something_flees() {
        for (after, small, flees) in [(0.9, false, false), (1.1, false, true), (1.1, true, false)] {
            let mut watch = Watch::Removed;
            assert!(!watch.sees(&residual(1.0, false)));
            assert_eq!(watch, Watch::From(1.0));
            assert_eq!(watch.sees(&residual(after, small)), flees);
            assert_eq!(watch, Watch::Off);
        }
        assert!(!Watch::Off.sees(&residual(1e9, false)));
    }

    #[test]
    fn a_correction_beyond_the_displacement_shows_it_too() {
        let mut watch = Watch::From(1.0);
        assert!(!watch.sees_correction(0.9, 1.0));
        assert_eq!(watch, Watch::From(1.0));
        assert!(watch.sees_correction(1.1, 1.0));
        assert!(!watch.sees_correction(1.1, 1.0));
    }

    #[test]
    fn iterations_are_allowed_up_to_three_times_while_residuals_fall() {
        let mut allowance = Allowance::new(20);
        allowance.residuals = (0..20).map(|i| 0.8f64.powi(i)).collect();
        assert!(!allowance.is_used_up(19) && !allowance.is_used_up(59));
        assert!(allowance.is_used_up(60));
        allowance.residuals = vec![1.0; 20];
        assert!(!allowance.is_used_up(19) && allowance.is_used_up(20));
        // fewer and fewer choices that change are progress as well
        allowance.changes = (0..20).map(|i| f64::from(100 - 5 * i)).collect();
        assert!(!allowance.is_used_up(20));
        allowance.begin_again(20);
        assert!(!allowance.is_used_up(39) && allowance.is_used_up(40));
    }

    #[test]
    fn frozen_quantities_that_change_without_a_solve_are_judged_once_as_they_are() {
        let start = Start {
            motion: false,
            changes: 0,
            extrapolated: false,
        };
        let mut course = Course::new(20, &start, false, None);
        let step = LastStep {
            correction: Sizes::of_motions(0.1),
            is_measure: true,
            alpha: 1.0,
            ..LastStep::default()
        };
        course.stepped(step);
        let released = |solve| Released {
            said: (String::new(), Vec::new()),
            solve,
        };
        assert!(course.released(released(false)) && course.step.is_measure);
        assert!(course.released(released(false)) && !course.step.is_measure);
        course.stepped(step);
        assert!(course.released(released(true)) && !course.step.is_measure);
        assert!((3..MAX_AUGMENTATIONS).all(|_| course.released(released(true))));
        assert!(!course.released(released(true)));
    }
}
