//! Rules of a wanted degree, for lines and triangles.

use super::super::tri3::Tri3;
use super::{Rule, TRI_3, TRI_6, TRI_12, TRI_16, TRI_33, gauss, on_facet};
use crate::tensor::Vec3;
use std::sync::LazyLock;

/// The highest degree of [`of_degree`].
pub const MAX_DEGREE: usize = 22;

/// Points with their weights.
type Points = Vec<(Vec3, f64)>;

static LINES: LazyLock<Vec<Points>> = LazyLock::new(|| {
    let on_line = |n| gauss(n).into_iter();
    let rule = |n| on_line(n).map(|(x, w)| (Vec3::new(x, 0.0, 0.0), w));
    (0..=MAX_DEGREE)
        .map(|d| rule(d / 2 + 1).collect())
        .collect()
});

static TRIANGLES: LazyLock<Vec<Points>> = LazyLock::new(|| {
    let of = |rule: &Rule| rule.iter().map(|(&x, w)| (x, w)).collect();
    let rule = |degree: usize| match degree {
        0..=2 => of(&TRI_3),
        3..=4 => of(&TRI_6),
        5..=6 => of(&TRI_12),
        7..=8 => of(&TRI_16),
        9..=12 => of(&TRI_33),
        _ => on_facet(&Tri3, &gauss(degree.div_ceil(2) + 1)), // one degree is for the side that shrinks
    };
    (0..=MAX_DEGREE).map(rule).collect()
});

/// A rule on the line `[-1, 1]` (`dim = 1`) or the reference triangle (`dim = 2`) that is exact for polynomials of this
/// degree, at most [`MAX_DEGREE`].
///
/// # Example
/// ```
/// use signorini_geometry::element::quadrature::of_degree;
///
/// // ∫ ξ³ η dA over the reference triangle is 3! 1!/6!
/// let integral: f64 = of_degree(2, 4).iter().map(|(x, weight)| weight * x.x.powi(3) * x.y).sum();
/// assert!((integral - 1.0 / 120.0).abs() < 1e-15);
/// ```
#[must_use]
pub fn of_degree(dim: usize, degree: usize) -> &'static [(Vec3, f64)] {
    let rules = if dim == 1 { &*LINES } else { &*TRIANGLES };
    &rules[degree.min(MAX_DEGREE)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_have_the_degree_that_was_asked_for() {
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        for degree in 0..=MAX_DEGREE as i32 {
            for a in 0..=degree {
                let line = of_degree(1, degree as usize).iter();
                let got: f64 = line.map(|(x, w)| w * x.x.powi(a)).sum();
                let exact = f64::from(1 - a % 2) * 2.0 / f64::from(a + 1);
                assert!((got - exact).abs() < 1e-13, "{degree} {a}");
                for b in 0..=degree - a {
                    let triangle = of_degree(2, degree as usize).iter();
                    let got: f64 = triangle.map(|(x, w)| w * x.x.powi(a) * x.y.powi(b)).sum();
                    let exact = factorial(a) * factorial(b) / factorial(a + b + 2);
                    assert!((got - exact).abs() < 1e-14, "{degree} {a} {b}");
                }
            }
        }
    }
}
