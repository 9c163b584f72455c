//! How far to go along a Newton step.
//!
//! The full step is taken where it lowers the energy `Π` by Armijo's rule, `Π(1) ≤ Π(0) + 10⁻⁴ s(0)` with the slope
//! `s(α) = du·r(α)` (E1). Elsewhere, and where there is no energy, the step is a root of the slope, to
//! `|s(α)| ≤ ½|s(0)|` (E2), by the rule of false position with Illinois' modification. A root, rather than any decrease: where
//! contact has just opened, the step is that of a body set free, and only a tiny part of it, up to where contact
//! closes again, is of use; a mere decrease would stop short of it time and again.
//!
//! Sources: Nocedal and Wright, *Numerical Optimization*, 2nd ed. 2006, section 3.1; Dowell and Jarratt, BIT 11, 1971
//! (Illinois); Crisfield, *Non-linear Finite Element Analysis*, vol. 1, 1991, section 9.2.

/// Fraction of the predicted decrease that must be reached (E1).
const DECREASE: f64 = 1e-4;
/// Relative rounding error of an energy: a smaller change means nothing.
const NOISE: f64 = 1e-11;
/// What is left of the slope (E2).
const SLOPE: f64 = 0.5;
/// Evaluations of the slope.
const MAX_EVALUATIONS: usize = 30;

/// Whether the step `alpha` lowers the energy enough (E1).
pub(super) fn lowers(start: f64, slope: f64, alpha: f64, reached: f64) -> bool {
    let noise = NOISE * (start.abs() + reached.abs());
    reached <= start + DECREASE * alpha * slope + noise
}

/// A root of the slope in `(0, first]` (E2), `first` itself where the slope keeps its sign; `start` is its value at 0.
/// `None` where no state along the step is admissible; `slope(α)` is `None` where an element is turned inside out.
pub(super) fn root(
    start: f64,
    first: f64,
    mut slope: impl FnMut(f64) -> Option<f64>,
) -> Option<f64> {
    let (mut low, mut at_low) = (0.0, start);
    let mut high: Option<(f64, f64)> = None;
    let mut alpha = first;
    let mut last_side = 0;
    let mut best: Option<(f64, f64)> = None;
    for _ in 0..MAX_EVALUATIONS {
        let Some(s) = slope(alpha) else {
            // not admissible: half way back to the last admissible step
            alpha = 0.5 * (low + alpha);
            continue;
        };
        if best.is_none_or(|(_, b)| s.abs() < b) {
            best = Some((alpha, s.abs()));
        }
        if s.abs() <= SLOPE * start.abs() || (high.is_none() && s * start > 0.0) {
            return Some(alpha);
        }
        if s * start > 0.0 {
            (low, at_low) = (alpha, s);
            if last_side == 1 {
                high = high.map(|(h, sh)| (h, 0.5 * sh));
            }
            last_side = 1;
        } else {
            high = Some((alpha, s));
            if last_side == -1 {
                at_low *= 0.5;
            }
            last_side = -1;
        }
        if let Some((h, at_high)) = high {
            alpha = (low * at_high - h * at_low) / (at_high - at_low);
        }
    }
    best.map(|b| b.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_step_to_the_minimum_of_a_parabola_lowers_the_energy() {
        // Π(α) = ½(1 − α)²
        assert!(lowers(0.5, -1.0, 1.0, 0.0));
        // Π(α) = −α + 5α²
        assert!(!lowers(0.0, -1.0, 1.0, 4.0));
    }

    #[test]
    fn a_slope_that_keeps_its_sign_takes_the_full_step() {
        assert_eq!(root(-1.0, 1.0, |a| Some(-1.0 + 0.3 * a)), Some(1.0));
    }

    #[test]
    fn contact_that_closes_after_a_millionth_of_the_step_is_found() {
        // free until α = 1e-6, then ten million times stiffer
        let mut calls = 0;
        let slope = |a: f64| {
            calls += 1;
            Some(-1.0 + a + 1e7 * (a - 1e-6).max(0.0))
        };
        let alpha = root(-1.0, 1.0, slope).unwrap();
        assert!((alpha - 1.1e-6).abs() <= 0.051e-6, "{alpha:e}");
        assert!(calls < 15, "{calls}");
    }

    #[test]
    fn an_inadmissible_step_is_shortened_and_an_endless_one_given_up() {
        let slope = |a: f64| (a < 0.3).then_some(-1.0 + 8.0 * a);
        let alpha = root(-1.0, 1.0, slope).unwrap();
        assert!((-1.0 + 8.0 * alpha).abs() <= 0.5, "{alpha}");
        assert_eq!(root(-1.0, 1.0, |_| None), None);
    }
}
