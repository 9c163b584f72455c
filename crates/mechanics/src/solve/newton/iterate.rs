//! An iterate, and what comes next.

use super::scale::{CORRECTION, Judgement, Sizes};
use crate::system::NodeId;

/// Condition (d'): the same where rows change between states across which forces are continuous, and do not cease to.
const STILL_MOVED: f64 = 1e-6;

/// Whether a correction is small in comparison with what the increment changes, field by field, condition (d).
pub(super) fn is_small(correction: Sizes, moved: Sizes) -> bool {
    correction.is_within(moved.times(CORRECTION))
}

/// The step that has led to an iterate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct LastStep {
    /// The largest changes.
    pub correction: Sizes,
    /// Whether the correction is a measure of the error of the state: nothing else has changed since.
    pub is_measure: bool,
    /// The part of the Newton step that was taken.
    pub alpha: f64,
    /// √|du·r|, of the whole Newton step.
    pub decrement: f64,
    /// Iterations of the linear solver.
    pub linear_iterations: usize,
}

/// An iterate, judged.
#[derive(Clone, Debug)]
pub(super) struct Iterate {
    /// Linear solves so far.
    pub iterations: usize,
    /// The step that has led here.
    pub step: LastStep,
    /// Whether prescribed nodes have yet to be moved, by the next solve.
    pub moves_nodes: bool,
    /// The largest changes in the increment so far.
    pub moved: Sizes,
    /// The rounding errors of positions, and of the values of other fields.
    pub rounding: Sizes,
    /// Its residuals.
    pub judgement: Judgement,
    /// Closed contacts.
    pub closed: usize,
    /// Discrete choices that changed.
    pub flips: usize,
    /// Whether a term is not settled.
    pub is_unsettled: bool,
    /// Whether forces are continuous across all that changed.
    pub is_continuous: bool,
    /// What the first term that is not settled says, and its nodes.
    pub unsettled: Option<(String, Vec<NodeId>)>,
}

/// What follows an iterate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// It is a solution: terms may change what they kept frozen, and where none does, it is accepted.
    Release,
    /// The next step, by a tangent.
    Tangent,
    /// It leads nowhere.
    Fail(Why),
}

/// Why an iteration is given up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Why {
    /// An observer asked to stop.
    Interrupted,
    /// A force is not a finite number.
    NotFinite,
    /// It has had its iterations, and nothing falls any more.
    Exhausted,
}

impl Iterate {
    /// What follows, where the run was asked to stop or not, and the iterations are at an end or not.
    pub fn next(&self, is_stopping: bool, is_exhausted: bool) -> Next {
        let residual = self.judgement.residual;
        if self.is_found() {
            Next::Release
        } else if is_stopping {
            Next::Fail(Why::Interrupted)
        } else if residual.is_nan() {
            Next::Fail(Why::NotFinite)
        } else if is_exhausted {
            Next::Fail(Why::Exhausted)
        } else {
            Next::Tangent
        }
    }

    /// Conditions (a), (b) and (d), or (d').
    pub fn is_found(&self) -> bool {
        let is_exact = self.judgement.round_off || self.is_corrected_little();
        self.is_nearly_found() && (is_exact || self.is_indifferent())
    }

    /// Conditions (a) and (b): only the size of a correction is left to show.
    pub fn is_nearly_found(&self) -> bool {
        !self.moves_nodes && self.judgement.small && self.is_settled()
    }

    /// Whether nothing changed: no choice of a term, nor what is prescribed.
    pub fn is_quiet(&self) -> bool {
        !self.moves_nodes && self.is_settled() && self.flips == 0
    }

    /// Whether contact has settled with something closed, after a whole step: one that was shortened has not shown yet
    /// what else closes.
    pub fn is_in_contact(&self) -> bool {
        let is_whole = self.iterations > 0 && self.step.alpha >= 1.0;
        !self.moves_nodes && self.is_settled() && is_whole && self.closed > 0
    }

    /// Condition (b) or (d'). The first iterate has nothing to compare with.
    pub fn is_settled(&self) -> bool {
        !self.is_unsettled || self.iterations == 0 || self.is_indifferent()
    }

    /// Condition (d).
    fn is_corrected_little(&self) -> bool {
        self.step.is_measure && is_small(self.step.correction, self.moved)
    }

    /// Condition (d'): where forces are continuous, the residual alone is the error of the state, whatever its status.
    fn is_indifferent(&self) -> bool {
        let least = self.moved.times(STILL_MOVED).max(self.rounding);
        let is_still = self.step.correction.is_within(least.times(self.step.alpha));
        let changes = self.is_unsettled && self.is_continuous;
        changes && self.judgement.small && self.step.is_measure && is_still
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A settled solution after three whole steps, whose last correction was small.
    fn solution() -> Iterate {
        Iterate {
            iterations: 3,
            step: LastStep {
                correction: Sizes::of_motions(1e-4),
                is_measure: true,
                alpha: 1.0,
                decrement: 0.0,
                linear_iterations: 0,
            },
            moves_nodes: false,
            moved: Sizes::of_motions(1.0),
            rounding: Sizes::of_motions(1e-14),
            judgement: Judgement {
                residual: 1e-8,
                ..Judgement::EMPTY
            },
            closed: 5,
            flips: 0,
            is_unsettled: false,
            is_continuous: true,
            unsettled: None,
        }
    }

    fn with(change: impl Fn(&mut Iterate)) -> Iterate {
        let mut iterate = solution();
        iterate.judgement.round_off = false;
        change(&mut iterate);
        iterate
    }

    fn next(change: impl Fn(&mut Iterate)) -> Next {
        with(change).next(false, false)
    }

    #[test]
    fn a_solution_fulfils_all_conditions() {
        assert_eq!(next(|_| ()), Next::Release);
        let lacking: [&dyn Fn(&mut Iterate); 5] = [
            &|i| i.judgement.small = false,
            &|i| i.moves_nodes = true,
            &|i| i.step.is_measure = false,
            &|i| i.step.correction = Sizes::of_motions(0.011),
            &|i| i.is_unsettled = true,
        ];
        for lack in lacking {
            assert_eq!(next(lack), Next::Tangent, "{:?}", with(lack));
        }
    }

    #[test]
    fn residuals_of_rounding_need_no_small_correction() {
        let coarse = |i: &mut Iterate| {
            i.judgement.round_off = true;
            i.step.correction = Sizes::of_motions(0.5);
        };
        assert_eq!(next(coarse), Next::Release);
        let unsettled = |i: &mut Iterate| {
            coarse(i);
            i.is_unsettled = true;
        };
        assert_eq!(next(unsettled), Next::Tangent);
    }

    #[test]
    fn rows_that_waver_pass_where_forces_are_continuous_and_nothing_moves() {
        let wavers = |correction: f64, is_continuous: bool| {
            next(|i| {
                i.is_unsettled = true;
                i.is_continuous = is_continuous;
                i.step.correction = Sizes::of_motions(correction);
            })
        };
        assert_eq!(wavers(1e-6, true), Next::Release);
        assert_eq!(wavers(1e-6, false), Next::Tangent);
        assert_eq!(wavers(2e-6, true), Next::Tangent);
        // a hundredth of a step has to be a hundred times as small
        let shortened = |correction: f64| {
            next(|i| {
                i.is_unsettled = true;
                i.step.alpha = 0.01;
                i.step.correction = Sizes::of_motions(correction);
            })
        };
        assert_eq!(shortened(0.9e-8), Next::Release);
        assert_eq!(shortened(1.1e-8), Next::Tangent);
    }

    #[test]
    fn the_first_iterate_has_nothing_to_compare_with() {
        let first = |i: &mut Iterate| {
            i.iterations = 0;
            i.is_unsettled = true;
            i.judgement.round_off = true;
        };
        assert_eq!(next(first), Next::Release);
    }

    #[test]
    fn a_solution_outdoes_every_reason_to_give_up() {
        assert_eq!(solution().next(true, true), Next::Release);
        let far = with(|i| i.judgement.small = false);
        let interrupted = Next::Fail(Why::Interrupted);
        assert_eq!(far.next(true, true), interrupted);
        assert_eq!(far.next(false, true), Next::Fail(Why::Exhausted));
        let lost = with(|i| {
            i.judgement.small = false;
            i.judgement.residual = f64::NAN;
        });
        assert_eq!(lost.next(false, true), Next::Fail(Why::NotFinite));
    }

    #[test]
    fn contact_stands_after_a_whole_step_with_something_closed() {
        assert!(with(|i| i.judgement.small = false).is_in_contact());
        let lacking: [&dyn Fn(&mut Iterate); 5] = [
            &|i| i.closed = 0,
            &|i| i.step.alpha = 0.5,
            &|i| i.iterations = 0,
            &|i| i.moves_nodes = true,
            &|i| {
                i.is_unsettled = true;
                i.is_continuous = false;
            },
        ];
        for lack in lacking {
            assert!(!with(lack).is_in_contact(), "{:?}", with(lack));
        }
    }
}
