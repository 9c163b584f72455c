//! How far to go along a Newton step.
//!
//! With an energy `Π`, Armijo's rule: `Π(α) ≤ Π(0) + 10⁻⁴ α s(0)`, `s(α) = du·r(α)`, by quadratic interpolation (E1).
//! Without one, or where the step is no descent, the root of `s`: `|s(α)| ≤ 0.8 |s(0)|`, at most five evaluations (E2).
//! Source: Nocedal and Wright, *Numerical Optimization*, 2nd ed. 2006, section 3.1; Crisfield, *Non-linear Finite
//! Element Analysis*, vol. 1, 1991, section 9.2.

/// Fraction of the predicted decrease that must be reached.
const DECREASE: f64 = 1e-4;
/// Relative rounding error of an energy: a smaller change means nothing.
const NOISE: f64 = 1e-11;
/// The smallest step.
const MIN_STEP: f64 = 1e-4;

/// Armijo's rule (E1): the step, or `None` where even the smallest is too long. `energy(α)` is `None` where the state
/// is not admissible (an element turned inside out).
pub(super) fn by_energy(
    start: f64,
    slope: f64,
    first: f64,
    mut energy: impl FnMut(f64) -> Option<f64>,
) -> Option<f64> {
    let mut alpha = first;
    while alpha >= MIN_STEP {
        let Some(reached) = energy(alpha) else {
            alpha *= 0.5;
            continue;
        };
        let noise = NOISE * (start.abs() + reached.abs());
        if reached <= start + DECREASE * alpha * slope + noise {
            return Some(alpha);
        }
        let curvature = reached - start - slope * alpha;
        let minimum = -0.5 * slope * alpha * alpha / curvature;
        let (low, high) = (0.1 * alpha, 0.5 * alpha);
        alpha = if minimum.is_finite() {
            minimum.clamp(low, high)
        } else {
            high
        };
    }
    None
}

/// The root of `s` (E2), by the secant rule kept inside `[0.1, 1]`: the step, or `None` where no state was admissible.
pub(super) fn by_slope(
    start: f64,
    first: f64,
    mut slope: impl FnMut(f64) -> Option<f64>,
) -> Option<f64> {
    let mut alpha = first;
    let mut best: Option<(f64, f64)> = None;
    for _ in 0..5 {
        let Some(s) = slope(alpha) else {
            alpha *= 0.5;
            continue;
        };
        if best.is_none_or(|(_, b)| s.abs() < b) {
            best = Some((alpha, s.abs()));
        }
        if s.abs() <= 0.8 * start.abs() {
            break;
        }
        let root = alpha * start / (start - s);
        alpha = if root.is_finite() && root > 0.0 {
            root.clamp(0.1, first)
        } else {
            0.5 * alpha
        };
    }
    best.map(|b| b.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_step_that_lowers_the_energy_is_taken() {
        let energy = |a: f64| Some(0.5 * (1.0 - a) * (1.0 - a));
        assert_eq!(by_energy(0.5, -1.0, 1.0, energy), Some(1.0));
    }

    #[test]
    fn an_overshoot_is_taken_back_to_the_minimum_of_a_parabola() {
        // Π(α) = −α + 5 α², minimum at 0.1
        let energy = |a: f64| Some(-a + 5.0 * a * a);
        let alpha = by_energy(0.0, -1.0, 1.0, energy).unwrap();
        assert!((alpha - 0.1).abs() < 1e-12);
    }

    #[test]
    fn an_inadmissible_step_is_halved_and_an_endless_one_given_up() {
        let energy = |a: f64| (a < 0.3).then_some(-a);
        assert_eq!(by_energy(0.0, -1.0, 1.0, energy), Some(0.25));
        assert_eq!(by_energy(0.0, -1.0, 1.0, |_| Some(1.0)), None);
    }

    #[test]
    fn the_root_of_the_slope_is_found() {
        let mut calls = 0;
        let slope = |a: f64| {
            calls += 1;
            Some(-1.0 + 5.0 * a)
        };
        let alpha = by_slope(-1.0, 1.0, slope).unwrap();
        assert!((alpha - 0.2).abs() < 0.17, "{alpha}");
        assert!(calls <= 5);
        assert_eq!(by_slope(-1.0, 1.0, |_| None), None);
    }
}
