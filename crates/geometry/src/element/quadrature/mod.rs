//! Quadrature rules on the reference elements.
//!
//! | rule | points | exact for polynomials of degree |
//! |---|---|---|
//! | [`LINE_2`], [`LINE_3`] | 2, 3, Gauss–Legendre | 3, 5 |
//! | [`QUAD_4`], [`HEX_8`] | products of [`LINE_2`] | 3 in each direction |
//! | [`QUAD_9`], [`HEX_27`] | products of [`LINE_3`] | 5 in each direction |
//! | [`TRI_1`], [`TET_1`] | 1, the centroid | 1 |
//! | [`TRI_3`], [`TET_4`] | 3, 4, inside | 2 |
//! | [`TRI_6`] | 6, inside | 4 |
//! | [`TRI_12`], [`TRI_16`], [`TRI_33`] | 12, 16, 33, inside | 6, 8, 12 |
//! | [`TET_14`] | 14, inside | 5 |
//! | [`WEDGE_6`] | [`TRI_3`] × [`LINE_2`] | 2 in the triangle, 3 along the axis |
//! | [`WEDGE_9`] | [`TRI_3`] × [`LINE_3`] | 2 in the triangle, 5 along the axis |
//! | [`WEDGE_18`] | [`TRI_6`] × [`LINE_3`] | 4 in the triangle, 5 along the axis |
//!
//! For facets there are rules with any number of points, too: [`gauss`], [`lobatto`], [`on_facet`], and those of a wanted
//! degree: [`of_degree`].
//!
//! Weights sum to the measure of the reference domain. Products run through their first factor fastest. Sources:
//! Zienkiewicz, Taylor, *The Finite Element Method*, vol. 1, tables 5.1 to 5.3; Hughes, *The Finite Element Method*,
//! section 3.8; Dunavant, IJNME 21, 1985, table II ([`TRI_6`] and larger ones, refined to round-off);
//! Walkington, *Quadrature on simplices of arbitrary dimension*, 2000 ([`TET_14`]).

mod degree;
mod points;

pub use degree::{MAX_DEGREE, of_degree};
pub use points::{gauss, lobatto, on_facet, through};

use crate::tensor::Vec3;

/// A quadrature rule.
///
/// # Example
/// ```
/// use signorini_geometry::element::quadrature::LINE_3;
///
/// // three points integrate x⁴ over [−1, 1] exactly
/// let integral: f64 = LINE_3.iter().map(|(x, weight)| weight * x.x.powi(4)).sum();
/// assert!((integral - 2.0 / 5.0).abs() < 1e-15);
/// ```
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

/// The rules of an element, by purpose.
#[derive(Clone, Copy, Debug)]
pub struct Rules {
    /// Integrates the stiffness of the undistorted element exactly; that of wedge15 has the customary nine points, exact
    /// for products of linear strains.
    pub full: &'static Rule,
    /// Reduced integration: one order less in the serendipity elements, the full rule in all others.
    pub reduced: &'static Rule,
    /// Integrates loads and areas over the element as a facet, curved or not, and weights over a solid: exact for products
    /// of two shape functions on an undistorted facet.
    pub surface: &'static Rule,
    /// Integrates mass matrices: exact for products of two shape functions on the undistorted element.
    pub mass: &'static Rule,
    /// For bodies of revolution, where the hoop is a strain of its own: with fewer points motions would be free.
    pub revolved: &'static Rule,
    /// Where the dilatation is projected and counts only once: with fewer points motions would be free.
    pub dilatation: &'static Rule,
    /// The rule with more points than the full one that other programs use for the element, if there is one.
    pub raised: Option<&'static Rule>,
}

impl Rules {
    /// One rule for every purpose.
    #[must_use]
    pub const fn all(rule: &'static Rule) -> Self {
        Self {
            full: rule,
            reduced: rule,
            surface: rule,
            mass: rule,
            revolved: rule,
            dilatation: rule,
            raised: None,
        }
    }
}

/// 1/√3.
const G: f64 = 0.577_350_269_189_625_8;
/// √(3/5).
const H: f64 = 0.774_596_669_241_483_4;

const GAUSS_2: ([f64; 2], [f64; 2]) = ([-G, G], [1.0; 2]);
const GAUSS_3: ([f64; 3], [f64; 3]) = ([-H, 0.0, H], [5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0]);

/// Gauss–Legendre with two points on `[-1, 1]`.
pub static LINE_2: Rule = Rule {
    points: &along_line(&GAUSS_2.0),
    weights: &GAUSS_2.1,
};

/// Gauss–Legendre with three points on `[-1, 1]`.
pub static LINE_3: Rule = Rule {
    points: &along_line(&GAUSS_3.0),
    weights: &GAUSS_3.1,
};

/// 2 × 2 Gauss points.
pub static QUAD_4: Rule = Rule {
    points: &product_points::<2, 2, 4>(LINE_2.points, &GAUSS_2.0, 1),
    weights: &product_weights::<2, 2, 4>(LINE_2.weights, &GAUSS_2.1),
};

/// 3 × 3 Gauss points.
pub static QUAD_9: Rule = Rule {
    points: &product_points::<3, 3, 9>(LINE_3.points, &GAUSS_3.0, 1),
    weights: &product_weights::<3, 3, 9>(LINE_3.weights, &GAUSS_3.1),
};

/// 2 × 2 × 2 Gauss points.
pub static HEX_8: Rule = Rule {
    points: &product_points::<4, 2, 8>(QUAD_4.points, &GAUSS_2.0, 2),
    weights: &product_weights::<4, 2, 8>(QUAD_4.weights, &GAUSS_2.1),
};

/// 3 × 3 × 3 Gauss points.
pub static HEX_27: Rule = Rule {
    points: &product_points::<9, 3, 27>(QUAD_9.points, &GAUSS_3.0, 2),
    weights: &product_weights::<9, 3, 27>(QUAD_9.weights, &GAUSS_3.1),
};

/// The centroid of the triangle.
pub static TRI_1: Rule = Rule {
    points: &[Vec3::new(1.0 / 3.0, 1.0 / 3.0, 0.0)],
    weights: &[0.5],
};

/// Three points inside the triangle.
pub static TRI_3: Rule = Rule {
    points: &around_triangle(1.0 / 6.0),
    weights: &[1.0 / 6.0; 3],
};

/// Six points inside the triangle.
pub static TRI_6: Rule = Rule {
    points: &{
        let [a, b, c] = around_triangle(0.445_948_490_915_965);
        let [d, e, f] = around_triangle(0.091_576_213_509_770_74);
        [a, b, c, d, e, f]
    },
    weights: &{
        const NEAR: f64 = 0.111_690_794_839_005_73;
        const FAR: f64 = 0.054_975_871_827_660_93;
        [NEAR, NEAR, NEAR, FAR, FAR, FAR]
    },
};

/// Twelve points inside the triangle.
pub static TRI_12: Rule = {
    const ORBITS: ([Vec3; 12], [f64; 12]) = orbits(
        &[],
        &[
            (0.116_786_275_726_457_43, 0.249_286_745_170_864_13),
            (0.050_844_906_370_220_606, 0.063_089_014_491_512),
        ],
        &[(
            0.082_851_075_618_327_65,
            0.053_145_049_844_784_03,
            0.310_352_451_033_820_14,
        )],
    );
    Rule {
        points: &ORBITS.0,
        weights: &ORBITS.1,
    }
};

/// Sixteen points inside the triangle.
pub static TRI_16: Rule = {
    const ORBITS: ([Vec3; 16], [f64; 16]) = orbits(
        &[0.144_315_607_677_720_3],
        &[
            (0.095_091_634_267_326_21, 0.459_292_588_292_681_5),
            (0.103_217_370_534_737_6, 0.170_569_307_751_712_06),
            (0.032_458_497_623_205_705, 0.050_547_228_317_034_565),
        ],
        &[(
            0.027_230_314_174_411_85,
            0.263_112_829_634_789_6,
            0.008_394_777_409_881_229,
        )],
    );
    Rule {
        points: &ORBITS.0,
        weights: &ORBITS.1,
    }
};

/// Thirty-three points inside the triangle.
pub static TRI_33: Rule = {
    const ORBITS: ([Vec3; 33], [f64; 33]) = orbits(
        &[],
        &[
            (0.025_731_066_425_726_312, 0.488_217_389_786_345_66),
            (0.043_692_544_510_797_98, 0.439_724_392_315_404_33),
            (0.062_858_224_252_622_34, 0.271_210_384_992_223_8),
            (0.034_796_112_984_671_39, 0.127_576_145_639_277_16),
            (0.006_166_261_042_275_458, 0.021_317_350_432_354_38),
        ],
        &[
            (
                0.040_371_557_735_177_8,
                0.275_713_269_821_302_8,
                0.115_343_494_496_680_8,
            ),
            (
                0.022_356_773_205_377_91,
                0.281_325_580_941_482_36,
                0.022_838_332_225_173_02,
            ),
            (
                0.017_316_231_118_064_213,
                0.116_251_915_862_837_04,
                0.025_734_050_563_945_04,
            ),
        ],
    );
    Rule {
        points: &ORBITS.0,
        weights: &ORBITS.1,
    }
};

/// Points and weights of a triangle from their orbits: weights of the centroid, of three points and their area
/// coordinate `a`, of six points and two of their area coordinates. Given weights sum to 1.
const fn orbits<const N: usize>(
    centre: &[f64],
    threes: &[(f64, f64)],
    sixes: &[(f64, f64, f64)],
) -> ([Vec3; N], [f64; N]) {
    let mut out = ([Vec3::ZERO; N], [0.0; N]);
    let mut n = 0;
    if let [w] = *centre {
        out.0[0] = Vec3::new(1.0 / 3.0, 1.0 / 3.0, 0.0);
        out.1[0] = 0.5 * w;
        n = 1;
    }
    let mut k = 0;
    while k < threes.len() {
        let (w, a) = threes[k];
        let around = around_triangle(a);
        let mut i = 0;
        while i < 3 {
            out.0[n] = around[i];
            out.1[n] = 0.5 * w;
            (n, i) = (n + 1, i + 1);
        }
        k += 1;
    }
    k = 0;
    while k < sixes.len() {
        let (w, a, b) = sixes[k];
        let c = 1.0 - a - b;
        let pairs = [(a, b), (b, a), (b, c), (c, b), (c, a), (a, c)];
        let mut i = 0;
        while i < 6 {
            out.0[n] = Vec3::new(pairs[i].0, pairs[i].1, 0.0);
            out.1[n] = 0.5 * w;
            (n, i) = (n + 1, i + 1);
        }
        k += 1;
    }
    out
}

/// The centroid of the tetrahedron.
pub static TET_1: Rule = Rule {
    points: &[Vec3::new(0.25, 0.25, 0.25)],
    weights: &[1.0 / 6.0],
};

/// Four points inside the tetrahedron, at `(5 − √5)/20` from three of its sides.
pub static TET_4: Rule = Rule {
    points: &{
        const A: f64 = 0.138_196_601_125_010_5;
        const B: f64 = 1.0 - 3.0 * A;
        [
            Vec3::new(A, A, A),
            Vec3::new(B, A, A),
            Vec3::new(A, B, A),
            Vec3::new(A, A, B),
        ]
    },
    weights: &[1.0 / 24.0; 4],
};

/// Fourteen points inside the tetrahedron: twice four around a corner, and six around the edges.
pub static TET_14: Rule = Rule {
    points: &{
        let [a, b, c, d] = around_tetrahedron(0.310_885_919_263_300_6);
        let [e, f, g, h] = around_tetrahedron(0.092_735_250_310_891_23);
        const NEAR: f64 = 0.045_503_704_125_649_65;
        const FAR: f64 = 0.5 - NEAR;
        [
            a,
            b,
            c,
            d,
            e,
            f,
            g,
            h,
            Vec3::new(NEAR, NEAR, FAR),
            Vec3::new(NEAR, FAR, NEAR),
            Vec3::new(FAR, NEAR, NEAR),
            Vec3::new(FAR, FAR, NEAR),
            Vec3::new(FAR, NEAR, FAR),
            Vec3::new(NEAR, FAR, FAR),
        ]
    },
    weights: &{
        const A: f64 = 0.018_781_320_953_002_642;
        const B: f64 = 0.012_248_840_519_393_658;
        const C: f64 = 0.007_091_003_462_846_911;
        [A, A, A, A, B, B, B, B, C, C, C, C, C, C]
    },
};

/// The points of volume coordinates `(a, a, a, 1 − 3a)` in any order.
const fn around_tetrahedron(a: f64) -> [Vec3; 4] {
    let b = 1.0 - 3.0 * a;
    [
        Vec3::new(a, a, a),
        Vec3::new(b, a, a),
        Vec3::new(a, b, a),
        Vec3::new(a, a, b),
    ]
}

/// Three points of the triangle times two along the axis.
pub static WEDGE_6: Rule = Rule {
    points: &product_points::<3, 2, 6>(TRI_3.points, &GAUSS_2.0, 2),
    weights: &product_weights::<3, 2, 6>(TRI_3.weights, &GAUSS_2.1),
};

/// Three points of the triangle times three along the axis.
pub static WEDGE_9: Rule = Rule {
    points: &product_points::<3, 3, 9>(TRI_3.points, &GAUSS_3.0, 2),
    weights: &product_weights::<3, 3, 9>(TRI_3.weights, &GAUSS_3.1),
};

/// Six points of the triangle times three along the axis.
pub static WEDGE_18: Rule = Rule {
    points: &product_points::<6, 3, 18>(TRI_6.points, &GAUSS_3.0, 2),
    weights: &product_weights::<6, 3, 18>(TRI_6.weights, &GAUSS_3.1),
};

const fn along_line<const N: usize>(s: &[f64; N]) -> [Vec3; N] {
    product_points::<1, N, N>(&[Vec3::ZERO], s, 0)
}

/// The points of area coordinates `(a, a, 1 − 2a)` in any order.
const fn around_triangle(a: f64) -> [Vec3; 3] {
    let b = 1.0 - 2.0 * a;
    [
        Vec3::new(a, a, 0.0),
        Vec3::new(b, a, 0.0),
        Vec3::new(a, b, 0.0),
    ]
}

/// `M = P·Q` points: those of a rule, repeated at every `s` along one more axis.
const fn product_points<const P: usize, const Q: usize, const M: usize>(
    points: &[Vec3],
    s: &[f64; Q],
    axis: usize,
) -> [Vec3; M] {
    let mut out = [Vec3::ZERO; M];
    let mut k = 0;
    while k < M {
        out[k] = points[k % P];
        match axis {
            0 => out[k].x = s[k / P],
            1 => out[k].y = s[k / P],
            _ => out[k].z = s[k / P],
        }
        k += 1;
    }
    out
}

const fn product_weights<const P: usize, const Q: usize, const M: usize>(
    weights: &[f64],
    w: &[f64; Q],
) -> [f64; M] {
    let mut out = [0.0; M];
    let mut k = 0;
    while k < M {
        out[k] = weights[k % P] * w[k / P];
        k += 1;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn integral(rule: &Rule, f: impl Fn(&Vec3) -> f64) -> f64 {
        rule.iter().map(|(x, w)| w * f(x)).sum()
    }

    /// The integral over `[-1, 1]`.
    fn along_axis(p: i32) -> f64 {
        f64::from(1 - p % 2) * 2.0 / f64::from(p + 1)
    }

    /// The integral of `x^a y^b z^c` over the reference triangle (`c = 0`) or tetrahedron.
    fn over_simplex(dim: i32, [a, b, c]: [i32; 3]) -> f64 {
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        factorial(a) * factorial(b) * factorial(c) / factorial(a + b + c + dim)
    }

    #[test]
    fn products_of_gauss_points_integrate_their_degree_in_each_direction() {
        for (rule, dim, degree) in [
            (&LINE_2, 1, 3),
            (&LINE_3, 1, 5),
            (&QUAD_4, 2, 3),
            (&QUAD_9, 2, 5),
            (&HEX_8, 3, 3),
            (&HEX_27, 3, 5),
        ] {
            let powers = |axis: usize| 0..=if axis < dim { degree } else { 0 };
            for a in powers(0) {
                for (b, c) in powers(1).flat_map(|b| powers(2).map(move |c| (b, c))) {
                    let exact: f64 = [a, b, c][..dim].iter().map(|&p| along_axis(p)).product();
                    let got = integral(rule, |x| x.x.powi(a) * x.y.powi(b) * x.z.powi(c));
                    assert!(
                        (got - exact).abs() < 1e-14,
                        "{dim} {a} {b} {c}: {got} {exact}"
                    );
                }
            }
            let beyond = integral(rule, |x| x.x.powi(degree + 1)) / 2f64.powi(dim as i32 - 1);
            assert!((beyond - along_axis(degree + 1)).abs() > 1e-2);
        }
    }

    #[test]
    fn simplex_rules_integrate_their_total_degree() {
        for (rule, dim, degree) in [
            (&TRI_1, 2, 1),
            (&TRI_3, 2, 2),
            (&TRI_6, 2, 4),
            (&TRI_12, 2, 6),
            (&TRI_16, 2, 8),
            (&TRI_33, 2, 12),
            (&TET_1, 3, 1),
            (&TET_4, 3, 2),
            (&TET_14, 3, 5),
        ] {
            let error = |p: [i32; 3]| {
                let got = integral(rule, |x| x.x.powi(p[0]) * x.y.powi(p[1]) * x.z.powi(p[2]));
                (got - over_simplex(dim, p)).abs()
            };
            for a in 0..=degree {
                for b in 0..=degree - a {
                    for c in 0..=if dim == 3 { degree - a - b } else { 0 } {
                        assert!(error([a, b, c]) < 1e-15, "{a} {b} {c}");
                    }
                }
            }
            assert!(error([degree + 1, 0, 0]) > 1e-9);
        }
    }

    #[test]
    fn wedge_rules_integrate_quadratics_of_the_triangle_times_powers_along_the_axis() {
        for (rule, along) in [(&WEDGE_6, 3), (&WEDGE_9, 5)] {
            for (a, b) in [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)] {
                for c in 0..=along {
                    let exact = over_simplex(2, [a, b, 0]) * along_axis(c);
                    let got = integral(rule, |x| x.x.powi(a) * x.y.powi(b) * x.z.powi(c));
                    assert!((got - exact).abs() < 1e-15, "{a} {b} {c}");
                }
            }
        }
    }
}
