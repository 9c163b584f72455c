//! Rules with any number of points, for facets.

use super::super::{Element, Family};
use super::{QUAD_4, Rule};
use crate::tensor::Vec3;
use std::sync::LazyLock;

/// The most points through a thickness.
const MOST_THROUGH: usize = 9;

/// 2 × 2 points in the middle of a brick and 2 to 9 along ζ, the number clamped to these: the rule of thin bodies.
#[must_use]
pub fn through(npoint: usize) -> &'static Rule {
    static RULES: LazyLock<Vec<Rule>> = LazyLock::new(|| (0..=MOST_THROUGH).map(product).collect());
    let npoint = npoint.clamp(2, MOST_THROUGH);
    RULES.get(npoint).unwrap_or(&super::HEX_8)
}

/// [`QUAD_4`] times Gauss–Legendre; the points live as long as the program.
fn product(npoint: usize) -> Rule {
    let along = gauss(npoint);
    let middle = || {
        along
            .iter()
            .flat_map(|line| QUAD_4.iter().map(move |one| (one, line)))
    };
    let points = middle().map(|((xi, _), (z, _))| Vec3::new(xi.x, xi.y, *z));
    let weights = middle().map(|((_, weight), (_, along))| weight * along);
    Rule {
        points: points.collect::<Vec<_>>().leak(),
        weights: weights.collect::<Vec<_>>().leak(),
    }
}

/// Points and weights of Gauss–Legendre on `[-1, 1]`, exact for polynomials of degree `2n − 1`; one point at least.
///
/// # Source
/// Roots of the Legendre polynomial by Newton's method from Chebyshev's points: Abramowitz and Stegun 25.4.29.
///
/// # Example
/// ```
/// use signorini_geometry::element::quadrature::gauss;
///
/// let integral: f64 = gauss(4).iter().map(|(x, weight)| weight * x.powi(6)).sum();
/// assert!((integral - 2.0 / 7.0).abs() < 1e-15);
/// ```
#[must_use]
pub fn gauss(n: usize) -> Vec<(f64, f64)> {
    let n = n.max(1);
    let root = |k: usize| {
        let mut x = -((k as f64 + 0.75) * std::f64::consts::PI / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..50 {
            let (value, last) = legendre(n, x);
            slope = n as f64 * (x * value - last) / (x * x - 1.0);
            let step = value / slope;
            x -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    if n == 1 {
        return vec![(0.0, 2.0)];
    }
    (0..n).map(root).collect()
}

/// Points and weights of Gauss–Lobatto on `[-1, 1]`, ends included, exact for polynomials of degree `2n − 3`; two points
/// at least.
///
/// # Source
/// Abramowitz and Stegun 25.4.32.
#[must_use]
pub fn lobatto(n: usize) -> Vec<(f64, f64)> {
    let n = n.max(2);
    let m = n - 1;
    let weight = |x: f64| 2.0 / ((n * m) as f64 * legendre(m, x).0.powi(2));
    let root = |k: usize| {
        if k == 0 || k == m {
            return (if k == 0 { -1.0 } else { 1.0 }, weight(1.0));
        }
        let mut x = -(k as f64 * std::f64::consts::PI / m as f64).cos();
        for _ in 0..50 {
            // roots of P'_m, whose derivative follows from Legendre's equation
            let (value, last) = legendre(m, x);
            let slope = m as f64 * (x * value - last) / (x * x - 1.0);
            let bend = (2.0 * x * slope - (m * (m + 1)) as f64 * value) / (1.0 - x * x);
            let step = slope / bend;
            x -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        (x, weight(x))
    };
    (0..n).map(root).collect()
}

/// `P_n(x)` and `P_{n−1}(x)`.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut value, mut last) = (1.0, 0.0);
    for k in 0..n {
        let k = k as f64;
        (value, last) = (((2.0 * k + 1.0) * x * value - k * last) / (k + 1.0), value);
    }
    (value, last)
}

/// Points of a facet and their weights, from a rule on `[-1, 1]`: products; on a triangle, those of a square one side of
/// which shrinks to a corner.
#[must_use]
pub fn on_facet(element: Element, line: &[(f64, f64)]) -> Vec<(Vec3, f64)> {
    if element.dim() == 1 {
        let point = |&(x, w): &(f64, f64)| (Vec3::new(x, 0.0, 0.0), w);
        return line.iter().map(point).collect();
    }
    let triangle = element.family() == Family::Triangle;
    let pairs = line.iter().flat_map(|p| line.iter().map(move |q| (p, q)));
    let point = |(&(y, wy), &(x, wx)): (&(f64, f64), &(f64, f64))| {
        if !triangle {
            return (Vec3::new(x, y, 0.0), wx * wy);
        }
        let (s, t) = (0.5 * (1.0 + x), 0.5 * (1.0 + y));
        (Vec3::new(s, t * (1.0 - s), 0.0), 0.25 * wx * wy * (1.0 - s))
    };
    pairs.map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::by_name;

    /// ∫ x^k over [-1, 1].
    fn exact(k: usize) -> f64 {
        if k.is_multiple_of(2) {
            2.0 / (k + 1) as f64
        } else {
            0.0
        }
    }

    #[test]
    fn rules_are_exact_to_their_degree() {
        for n in 1..=32 {
            for (rule, degree) in [(gauss(n), 2 * n - 1), (lobatto(n.max(2)), 2 * n.max(2) - 3)] {
                for k in 0..=degree {
                    let sum: f64 = rule.iter().map(|(x, w)| w * x.powi(k as i32)).sum();
                    assert!((sum - exact(k)).abs() < 1e-13, "{n} {k}: {sum}");
                }
            }
        }
        assert_eq!(lobatto(4)[0].0, -1.0);
    }

    #[test]
    fn weights_sum_to_the_facet() {
        for (name, area) in [("line2", 2.0), ("tri3", 0.5), ("quad9", 4.0), ("tri6", 0.5)] {
            for n in 2..6 {
                let sum = |line: &[(f64, f64)]| -> f64 {
                    on_facet(by_name(name).unwrap(), line)
                        .iter()
                        .map(|p| p.1)
                        .sum()
                };
                assert!((sum(&gauss(n)) - area).abs() < 1e-13);
                assert!((sum(&lobatto(n)) - area).abs() < 1e-13);
            }
        }
    }
}
