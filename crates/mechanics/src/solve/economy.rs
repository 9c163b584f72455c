//! How exactly Newton's systems are solved, where less accuracy is less work.
//!
//! ```text
//!   contact changes           ──▶ to a tenth of the error, in the norm of the solver, or to 0.3
//!   it does not, residual r   ──▶ to max(0.3, 0.3 c r²), and to a tenth at least
//!                                 with the last tangent, where that leaves no more than 0.3
//! ```
//!
//! Residuals are those of forces, over what they may be: equations of multipliers are solved exactly at each step, and
//! have a curvature of their own; where nothing else is left, closing them may be all there is to do. While contact
//! changes, a step only has to find out what touches. When it does not, one solution goes as far as is of use: to what
//! is allowed, or to what the step leaves because forces are not linear in the displacements, `c r²`, as the steps
//! before did, the first one as that of the increment before. What then stays is often so little that the tangent of
//! the last step, with its factor, removes it, too: from `r₀` to `r` by a tangent, and from there with the same one, `2
//! c r₀ r` is left.
//!
//! Sources: Dembo, Eisenstat, Steihaug, *SIAM J. Numer. Anal.* 19 (1982) 400–408; Eisenstat, Walker, *SIAM J. Sci.
//! Comput.* 17 (1996) 16–32.

use super::equations::Accuracy;
use signorini_linear::EXACT;

/// The part of the error that a rough solution leaves.
const ROUGH: f64 = 0.1;
/// What a solution leaves of what need not be smaller.
const MARGIN: f64 = 0.3;

/// The largest residuals, over the tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Excess {
    /// That of forces and moments.
    pub forces: f64,
    /// That of the equations of multipliers.
    pub multipliers: f64,
}

/// What the steps of an increment have shown so far.
pub(super) struct Economy {
    /// What a step leaves over the square of what was there, c.
    curvature: Option<f64>,
    /// The last step: residuals before it, and of forces what its linear system left.
    last: Option<(Excess, f64)>,
    /// Residuals before the step that has led here.
    before: Option<Excess>,
}

impl Economy {
    /// With the curvature that the first step of a like increment has shown.
    pub fn new(curvature: Option<f64>) -> Self {
        Self {
            curvature,
            last: None,
            before: None,
        }
    }

    /// The curvature that was given or shown last.
    pub const fn curvature(&self) -> Option<f64> {
        self.curvature
    }

    /// Takes note of the residuals that the last step has led to.
    pub fn reached(&mut self, excess: Excess) {
        self.before = None;
        if let Some((before, left)) = self.last.take() {
            let curved = (excess.forces - left).max(0.0);
            self.before = Some(before);
            self.curvature = Some(curved / (before.forces * before.forces));
        }
    }

    /// How exactly to solve at this residual of forces, where a force of this size is allowed; `is_rough` where nothing is
    /// gained by more than a tenth.
    pub fn accuracy(&self, residual: f64, allowed: f64, is_rough: bool) -> Accuracy {
        let rough = Accuracy::Part {
            part: ROUGH,
            enough: MARGIN * allowed,
        };
        if is_rough || residual.is_nan() || residual <= 0.0 {
            return rough;
        }
        let curved = self.curvature.map_or(0.0, |c| c * residual * residual);
        let left = MARGIN * curved.max(1.0);
        if left >= ROUGH * residual {
            return rough;
        }
        Accuracy::Residual((left / residual).max(EXACT))
    }

    /// Whether the tangent of the last step leads from these residuals to the goal, where contact is as it was.
    pub fn is_nearly_straight(&self, excess: Excess) -> bool {
        let is_left = |now: f64, before: f64| now <= MARGIN || 2.0 * now * now <= MARGIN * before;
        self.before.is_some_and(|before| {
            is_left(excess.forces, before.forces) && is_left(excess.multipliers, before.multipliers)
        })
    }

    /// A system was solved at these residuals with their own tangent; `left` is the part of them that stayed.
    pub fn solved(&mut self, excess: Excess, left: f64) {
        self.last = (excess.forces > 0.0).then_some((excess, left * excess.forces));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROUGHLY: Accuracy = Accuracy::Part {
        part: 0.1,
        enough: 0.3,
    };

    fn forces(forces: f64) -> Excess {
        Excess {
            forces,
            multipliers: 0.0,
        }
    }

    #[test]
    fn a_linear_problem_is_solved_to_what_is_allowed_in_one_go() {
        let mut economy = Economy::new(None);
        let rough = Accuracy::Part {
            part: 0.1,
            enough: 0.6,
        };
        assert_eq!(economy.accuracy(1e6, 2.0, true), rough);
        economy.solved(forces(1e6), 0.1);
        economy.reached(forces(1e5));
        let Accuracy::Residual(rtol) = economy.accuracy(1e5, 2.0, false) else {
            panic!("too rough");
        };
        assert!((rtol - 3e-6).abs() < 1e-18);
    }

    #[test]
    fn what_the_curvature_leaves_is_not_solved_for() {
        // r = c r²: 1e11, 1e9, 1e5
        let mut economy = Economy::new(None);
        economy.solved(forces(1e11), 0.0);
        economy.reached(forces(1e9));
        let Accuracy::Residual(rtol) = economy.accuracy(1e9, 1.0, false) else {
            panic!("too rough");
        };
        assert!((rtol / (0.3 * 1e5 / 1e9) - 1.0).abs() < 1e-9);
        // and where it leaves nearly all, nor is the rest
        economy.solved(forces(1e6), 0.0);
        economy.reached(forces(9e5));
        assert_eq!(economy.accuracy(9e5, 1.0, false), ROUGHLY);
    }

    #[test]
    fn the_increment_before_tells_how_far_the_first_step_may_go() {
        let mut economy = Economy::new(Some(1e-9));
        let Accuracy::Residual(rtol) = economy.accuracy(1e3, 1.0, false) else {
            panic!("too rough");
        };
        assert!((rtol / 3e-4 - 1.0).abs() < 1e-9);
        // what it then shows counts
        economy.solved(forces(1e3), 0.3e-3);
        economy.reached(forces(100.3));
        assert!((economy.curvature().unwrap() / 1e-4 - 1.0).abs() < 1e-9);
    }

    #[test]
    fn the_last_tangent_serves_where_little_is_left_by_it() {
        // f = u + u²/1e8 to 1e6, from 0: what Newton's method leaves, and what the same tangent leaves after it
        let residual = |u: f64| u + u * u / 1e8 - 1e4;
        let (r0, r) = (residual(0.0), residual(1e4));
        let after = residual(1e4 - r);
        let mut economy = Economy::new(None);
        assert!(!economy.is_nearly_straight(forces(r0.abs())));
        economy.solved(forces(r0.abs()), 0.0);
        economy.reached(forces(r.abs()));
        assert!(economy.is_nearly_straight(forces(r.abs())));
        assert!(after.abs() <= 2.0 * r * r / r0.abs());
        // ten times as far, and it does not
        economy.solved(forces(1e5), 0.0);
        economy.reached(forces(1e3));
        assert!(!economy.is_nearly_straight(forces(1e3)));
        assert!(!economy.is_nearly_straight(forces(f64::NAN)));
        // nor where that of multipliers would stay
        economy.solved(
            Excess {
                forces: 1e4,
                multipliers: 100.0,
            },
            0.0,
        );
        economy.reached(forces(1.0));
        let of_multipliers = |multipliers| Excess {
            forces: 1.0,
            multipliers,
        };
        assert!(economy.is_nearly_straight(of_multipliers(3.0)));
        assert!(!economy.is_nearly_straight(of_multipliers(5.0)));
    }

    #[test]
    fn nothing_is_asked_that_rounding_forbids() {
        let economy = Economy::new(None);
        let exact = Accuracy::Residual(EXACT);
        assert_eq!(economy.accuracy(1e18, 1.0, false), exact);
        assert_eq!(economy.accuracy(f64::NAN, 1.0, false), ROUGHLY);
    }
}
