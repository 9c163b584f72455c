//! Quadrature rules on the reference elements.
//!
//! | rule | points | exact for polynomials of degree |
//! |---|---|---|
//! | [`LINE_2`] | 2, Gauss–Legendre | 3 |
//! | [`QUAD_4`], [`HEX_8`] | products of it | 3 in each direction |
//! | [`TRI_1`], [`TET_1`] | 1, the centroid | 1 |
//! | [`TRI_3`] | 3, inside | 2 |
//! | [`WEDGE_6`] | [`TRI_3`] × [`LINE_2`] | 2 in the triangle, 3 along the axis |
//!
//! Weights sum to the measure of the reference domain. Sources: Zienkiewicz, Taylor, *The Finite Element Method*,
//! vol. 1, tables 5.1 to 5.3; Hughes, *The Finite Element Method*, section 3.8.

use crate::tensor::Vec3;

/// A quadrature rule.
#[derive(Debug)]
pub struct Rule {
    /// Reference coordinates of the points.
    pub points: &'static [Vec3],
    /// Their weights.
    pub weights: &'static [f64],
}

impl Rule {
    /// The number of points.
    #[must_use]
    pub const fn npoint(&self) -> usize {
        self.points.len()
    }

    /// Points with their weights.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&Vec3, f64)> {
        self.points.iter().zip(self.weights.iter().copied())
    }
}

/// 1/√3.
const G: f64 = 0.577_350_269_189_625_8;

const fn at(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

/// Gauss–Legendre with two points on `[-1, 1]`.
pub static LINE_2: Rule = Rule {
    points: &[at(-G, 0.0, 0.0), at(G, 0.0, 0.0)],
    weights: &[1.0; 2],
};

/// 2 × 2 Gauss points, `ξ` fastest.
pub static QUAD_4: Rule = Rule {
    points: &[
        at(-G, -G, 0.0),
        at(G, -G, 0.0),
        at(-G, G, 0.0),
        at(G, G, 0.0),
    ],
    weights: &[1.0; 4],
};

/// 2 × 2 × 2 Gauss points, `ξ` fastest.
pub static HEX_8: Rule = Rule {
    points: &[
        at(-G, -G, -G),
        at(G, -G, -G),
        at(-G, G, -G),
        at(G, G, -G),
        at(-G, -G, G),
        at(G, -G, G),
        at(-G, G, G),
        at(G, G, G),
    ],
    weights: &[1.0; 8],
};

/// The centroid of the triangle.
pub static TRI_1: Rule = Rule {
    points: &[at(1.0 / 3.0, 1.0 / 3.0, 0.0)],
    weights: &[0.5],
};

/// Three points inside the triangle.
pub static TRI_3: Rule = Rule {
    points: &[at(A, A, 0.0), at(B, A, 0.0), at(A, B, 0.0)],
    weights: &[A; 3],
};

/// The centroid of the tetrahedron.
pub static TET_1: Rule = Rule {
    points: &[at(0.25, 0.25, 0.25)],
    weights: &[1.0 / 6.0],
};

/// Three points of the triangle times two along the axis, the triangle's fastest.
pub static WEDGE_6: Rule = Rule {
    points: &[
        at(A, A, -G),
        at(B, A, -G),
        at(A, B, -G),
        at(A, A, G),
        at(B, A, G),
        at(A, B, G),
    ],
    weights: &[A; 6],
};

const A: f64 = 1.0 / 6.0;
const B: f64 = 2.0 / 3.0;

#[cfg(test)]
mod tests {
    use super::*;

    fn integral(rule: &Rule, f: impl Fn(&Vec3) -> f64) -> f64 {
        rule.iter().map(|(x, w)| w * f(x)).sum()
    }

    #[test]
    fn products_of_gauss_points_integrate_cubics_in_each_direction() {
        for (rule, dim) in [(&LINE_2, 1), (&QUAD_4, 2), (&HEX_8, 3)] {
            for px in 0..=3 {
                for py in 0..=if dim > 1 { 3 } else { 0 } {
                    for pz in 0..=if dim > 2 { 3 } else { 0 } {
                        let powers = [px, py, pz];
                        let exact: f64 = powers[..dim]
                            .iter()
                            .map(|p| {
                                if p % 2 == 0 {
                                    2.0 / f64::from(p + 1)
                                } else {
                                    0.0
                                }
                            })
                            .product();
                        let got = integral(rule, |x| x.x.powi(px) * x.y.powi(py) * x.z.powi(pz));
                        assert!(
                            (got - exact).abs() < 1e-14,
                            "{dim} {powers:?}: {got} {exact}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn simplex_rules_integrate_their_degree() {
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        for (rule, degree) in [(&TRI_1, 1), (&TRI_3, 2)] {
            for a in 0..=degree {
                for b in 0..=degree - a {
                    let exact = factorial(a) * factorial(b) / factorial(a + b + 2);
                    let got = integral(rule, |x| x.x.powi(a) * x.y.powi(b));
                    assert!((got - exact).abs() < 1e-15, "{a} {b}");
                }
            }
        }
        for axis in 0..3 {
            assert!((integral(&TET_1, |x| x[axis]) - 1.0 / 24.0).abs() < 1e-16);
        }
        assert!((integral(&TET_1, |_| 1.0) - 1.0 / 6.0).abs() < 1e-16);
        let wedge = integral(&WEDGE_6, |x| x.x * x.x * x.z * x.z);
        assert!((wedge - 1.0 / 12.0 * 2.0 / 3.0).abs() < 1e-15);
    }
}
