//! How exactly Newton's systems are solved, where less accuracy is less work.
//!
//! ```text
//!   contact changes           ──▶ to a tenth of the error, in the norm of the solver
//!   it does not, residual r   ──▶ to max(0.3, 0.3 c r²), and to a tenth at least
//! ```
//!
//! Residuals are those of forces, over what they may be: equations of multipliers are solved exactly at each step, and
//! have a curvature of their own. While contact changes, a step only has to find out what touches. When it does not, one
//! solution goes as far as is of use: to what is allowed, or to what the step leaves because forces are not linear in the
//! displacements, `c r²`, as the steps before did, the first one as that of the increment before. Sources: Dembo, Eisenstat, Steihaug, *SIAM J. Numer. Anal.* 19 (1982)
//! 400–408; Eisenstat, Walker, *SIAM J. Sci. Comput.* 17 (1996) 16–32.

use super::equations::Accuracy;
use crate::system::linear::EXACT;

/// The part of the error that a rough solution leaves.
const ROUGH: f64 = 0.1;
/// What a solution leaves of what need not be smaller.
const MARGIN: f64 = 0.3;

/// What the steps of an increment have shown so far.
#[derive(Default)]
pub(super) struct Economy {
    /// What a step leaves over the square of what was there, c.
    curvature: Option<f64>,
    /// Residuals of the last step: before it, and what its linear system left.
    last: Option<[f64; 2]>,
}

impl Economy {
    /// With the curvature that the first step of a like increment has shown.
    pub fn new(curvature: Option<f64>) -> Self {
        Self {
            curvature,
            last: None,
        }
    }

    /// The curvature that was told or shown last.
    pub const fn curvature(&self) -> Option<f64> {
        self.curvature
    }

    /// Takes note of the residual that the last step has led to.
    pub fn reached(&mut self, residual: f64) {
        if let Some([before, left]) = self.last.take() {
            self.curvature = Some((residual - left).max(0.0) / (before * before));
        }
    }

    /// How exactly to solve at this residual; `is_rough` where nothing is gained by more than a tenth.
    pub fn accuracy(&self, residual: f64, is_rough: bool) -> Accuracy {
        if is_rough || residual.is_nan() || residual <= 0.0 {
            return Accuracy::Part(ROUGH);
        }
        let curved = self.curvature.map_or(0.0, |c| c * residual * residual);
        let left = MARGIN * curved.max(1.0);
        if left >= ROUGH * residual {
            return Accuracy::Part(ROUGH);
        }
        Accuracy::Residual((left / residual).max(EXACT))
    }

    /// A system was solved at this residual, of which `left` is the part that stayed.
    pub fn solved(&mut self, residual: f64, left: f64) {
        self.last = (residual > 0.0).then_some([residual, left * residual]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_problem_is_solved_to_what_is_allowed_in_one_go() {
        let mut economy = Economy::default();
        assert_eq!(economy.accuracy(1e6, true), Accuracy::Part(0.1));
        economy.solved(1e6, 0.1);
        economy.reached(1e5);
        let Accuracy::Residual(rtol) = economy.accuracy(1e5, false) else {
            panic!("too rough");
        };
        assert!((rtol - 3e-6).abs() < 1e-18);
    }

    #[test]
    fn what_the_curvature_leaves_is_not_solved_for() {
        // r = c r²: 1e11, 1e9, 1e5
        let mut economy = Economy::default();
        economy.solved(1e11, 0.0);
        economy.reached(1e9);
        let Accuracy::Residual(rtol) = economy.accuracy(1e9, false) else {
            panic!("too rough");
        };
        assert!((rtol / (0.3 * 1e5 / 1e9) - 1.0).abs() < 1e-9);
        // and where it leaves nearly all, nor is the rest
        economy.solved(1e6, 0.0);
        economy.reached(9e5);
        assert_eq!(economy.accuracy(9e5, false), Accuracy::Part(0.1));
    }

    #[test]
    fn the_increment_before_tells_how_far_the_first_step_may_go() {
        let mut economy = Economy::new(Some(1e-9));
        let Accuracy::Residual(rtol) = economy.accuracy(1e3, false) else {
            panic!("too rough");
        };
        assert!((rtol / 3e-4 - 1.0).abs() < 1e-9);
        // what it then shows counts
        economy.solved(1e3, 0.3e-3);
        economy.reached(100.3);
        assert!((economy.curvature().unwrap() / 1e-4 - 1.0).abs() < 1e-9);
    }

    #[test]
    fn nothing_is_asked_that_rounding_forbids() {
        let economy = Economy::default();
        assert_eq!(economy.accuracy(1e18, false), Accuracy::Residual(EXACT));
        assert_eq!(economy.accuracy(f64::NAN, false), Accuracy::Part(0.1));
    }
}
