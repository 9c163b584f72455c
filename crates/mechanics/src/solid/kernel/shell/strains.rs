//! Strains of the solid-shell by its unknowns, along the convected axes.

use super::super::element::{Element, Failure};
use super::super::gradient::inverse;
use crate::material::Kinematics;
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};

/// Functions of the unknowns: one for each middle, one for each half difference.
pub(super) const NB: usize = 8;

/// Unknowns of an element.
pub(super) const N: usize = 3 * NB;

/// Enhanced modes.
pub(super) const MODES: usize = 5;

/// A strain along the convected axes, in the order of [`Sym3::PAIRS`], shears twice; or the stress conjugate to it.
pub(super) type Voigt = [f64; 6];

/// Variations of a strain with the unknowns.
pub(super) type Variation = [[f64; N]; 6];

/// ξ and η of the corners.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// Where shears across are taken: two points for `E_23`, two for `E_13`, each pair along the axis that it varies along.
const TYING: [[f64; 2]; 4] = [[-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]];

/// The places of the shears across in [`Sym3::PAIRS`], with the axis along the middle and their tying points.
pub(super) const ACROSS: [(usize, usize, [usize; 2]); 2] = [(4, 1, [0, 1]), (5, 0, [2, 3])];

/// The places of the strains of the middle.
pub(super) const ALONG: [usize; 3] = [0, 1, 3];

/// `N_k` of the quadrilateral.
pub(super) fn corner_functions(xi: Vec3) -> [f64; 4] {
    CORNERS.map(|[a, b]| 0.25 * (1.0 + a * xi.x) * (1.0 + b * xi.y))
}

/// Derivatives of all functions with ξ, η, ζ.
fn slopes(xi: Vec3) -> [[f64; 3]; NB] {
    let mut slopes = [[0.0; 3]; NB];
    let (middle, half) = slopes.split_at_mut(4);
    for ((middle, half), [a, b]) in middle.iter_mut().zip(half).zip(CORNERS) {
        let along = [0.25 * a * (1.0 + b * xi.y), 0.25 * b * (1.0 + a * xi.x)];
        *middle = [along[0], along[1], 0.0];
        let function = 0.25 * (1.0 + a * xi.x) * (1.0 + b * xi.y);
        *half = [xi.z * along[0], xi.z * along[1], function];
    }
    slopes
}

/// Derivatives of a field with ξ, η, ζ.
fn derivatives(slopes: &[[f64; 3]; NB], values: &[Vec3; NB]) -> [Vec3; 3] {
    let mut sums = [Vec3::ZERO; 3];
    for (slope, value) in slopes.iter().zip(values) {
        for (sum, slope) in sums.iter_mut().zip(slope) {
            *sum += *value * *slope;
        }
    }
    sums
}

/// The part of (E37) with these places that is linear in `h`, shears twice.
fn linear(pair: (usize, usize), g: &[Vec3; 3], h: &[Vec3; 3]) -> f64 {
    match pair {
        (i, j) if i == j => g[i].dot(h[i]),
        (i, j) => g[i].dot(h[j]) + h[i].dot(g[j]),
    }
}

/// The part that is quadratic in `h`.
fn quadratic((i, j): (usize, usize), h: &[Vec3; 3]) -> f64 {
    let factor = if i == j { 0.5 } else { 1.0 };
    factor * h[i].dot(h[j])
}

/// Writes the variation of a strain.
fn vary(
    (i, j): (usize, usize),
    slopes: &[[f64; 3]; NB],
    now: &[Vec3; 3],
    weight: f64,
    to: &mut [f64; N],
) {
    for (to, slope) in to.as_chunks_mut::<3>().0.iter_mut().zip(slopes) {
        let with = match i == j {
            true => now[i] * (weight * slope[i]),
            false => (now[j] * slope[i] + now[i] * slope[j]) * weight,
        };
        to[0] += with.x;
        to[1] += with.y;
        to[2] += with.z;
    }
}

/// A place of the middle at which shears across are taken.
struct Tying {
    slopes: [[f64; 3]; NB],
    start: [Vec3; 3],
    moved: [Vec3; 3],
    lagging: [Vec3; 3],
}

/// An element in its unknowns.
pub(super) struct Geometry {
    finite: bool,
    start: [Vec3; NB],
    moved: [Vec3; NB],
    /// The last correction of the unknowns.
    lagging: [Vec3; NB],
    tying: [Tying; 4],
    /// `G₀ᵏ`.
    dual: [Vec3; 3],
    /// `A₀`.
    area: f64,
}

/// What a quadrature point has.
pub(super) struct AtPoint {
    /// Volume that belongs to it.
    pub weight: f64,
    /// `Gⁱ`.
    pub dual: [Vec3; 3],
    /// Derivatives of the displacements, compatible ones.
    pub moved: [Vec3; 3],
    pub slopes: [[f64; 3]; NB],
    pub corners: [f64; 4],
    /// `g_i`; `G_i` at small strain.
    now: [Vec3; 3],
    xi: Vec3,
    /// (E37), (E38) without the modes.
    pub strain: Voigt,
    /// (E39), a column for each mode.
    pub modes: [[f64; MODES]; 6],
}

impl Geometry {
    /// The element, whose nodes have `X_k` and `D_k` as positions.
    pub fn new(element: &Element<'_>) -> Result<Self, Failure> {
        let vectors = |from: &[f64]| {
            let mut to = [Vec3::ZERO; NB];
            let from = from.as_chunks::<3>().0.iter();
            to.iter_mut()
                .zip(from)
                .for_each(|(to, &from)| *to = from.into());
            to
        };
        let mut start = [Vec3::ZERO; NB];
        start.iter_mut().zip(element.x).for_each(|(to, x)| *to = *x);
        let (moved, lagging) = (vectors(element.u), vectors(element.correction));
        let tying = TYING.map(|[a, b]| {
            let slopes = slopes(Vec3::new(a, b, 0.0));
            Tying {
                start: derivatives(&slopes, &start),
                moved: derivatives(&slopes, &moved),
                lagging: derivatives(&slopes, &lagging),
                slopes,
            }
        });
        let centre = derivatives(&slopes(Vec3::ZERO), &start);
        let (turn, _) = inverse(Mat3::from_rows(centre))?;
        Ok(Self {
            finite: element.kinematics == Kinematics::Finite,
            start,
            moved,
            lagging,
            tying,
            dual: turn.transpose().rows,
            area: area(&centre),
        })
    }

    /// What a quadrature point has.
    pub fn at(&self, element: &Element<'_>, point: usize) -> Result<AtPoint, Failure> {
        let rule = element.reference.rule;
        let xi = rule.points.get(point).copied().unwrap_or_default();
        let weight = rule.weights.get(point).copied().unwrap_or_default();
        let slopes = slopes(xi);
        let base = derivatives(&slopes, &self.start);
        let moved = derivatives(&slopes, &self.moved);
        let (turn, det) = inverse(Mat3::from_rows(base))?;
        let mut now = base;
        if self.finite {
            now.iter_mut().zip(moved).for_each(|(g, h)| *g += h);
            // not `ratio <= 0`: a ratio that is not a number must not pass
            let ratio = Mat3::from_rows(now).determinant() / det;
            if ratio.is_nan() || ratio <= 0.0 {
                return Err(Failure::Inverted { ratio });
            }
        }
        let corners = corner_functions(xi);
        let of = |at: &Tying, pair| {
            let bend = if self.finite {
                quadratic(pair, &at.moved)
            } else {
                0.0
            };
            linear(pair, &at.start, &at.moved) + bend
        };
        let local = |pair| {
            let bend = if self.finite {
                quadratic(pair, &moved)
            } else {
                0.0
            };
            linear(pair, &base, &moved) + bend
        };
        let of_corner = |k: usize| {
            let (d, h) = (self.start[4 + k], self.moved[4 + k]);
            d.dot(h)
                + if self.finite {
                    0.5 * h.norm_squared()
                } else {
                    0.0
                }
        };
        Ok(AtPoint {
            weight: weight * det,
            dual: turn.transpose().rows,
            strain: self.assume(xi, &corners, local, of, of_corner),
            modes: self.modes(xi, &base),
            moved,
            slopes,
            corners,
            now,
            xi,
        })
    }

    /// (E38): strains of the middle from the point, those across from tying points and corners.
    fn assume(
        &self,
        xi: Vec3,
        corners: &[f64; 4],
        local: impl Fn((usize, usize)) -> f64,
        tied: impl Fn(&Tying, (usize, usize)) -> f64,
        of_corner: impl Fn(usize) -> f64,
    ) -> Voigt {
        let mut strain = [0.0; 6];
        for k in ALONG {
            strain[k] = local(Sym3::PAIRS[k]);
        }
        for (k, _, points) in ACROSS {
            let weights = tying_weights(k, xi);
            let terms = points.iter().zip(weights);
            let terms = terms.map(|(&p, weight)| weight * tied(&self.tying[p], Sym3::PAIRS[k]));
            strain[k] = terms.sum();
        }
        strain[2] = (0..4).map(|k| corners[k] * of_corner(k)).sum();
        strain
    }

    /// The strain quadratic in the last correction: what (E37) has more than its linear prediction.
    pub fn bend_of_correction(&self, at: &AtPoint) -> Voigt {
        let lagging = derivatives(&at.slopes, &self.lagging);
        let local = |pair| quadratic(pair, &lagging);
        let tied = |at: &Tying, pair| quadratic(pair, &at.lagging);
        let of_corner = |k: usize| 0.5 * self.lagging[4 + k].norm_squared();
        self.assume(at.xi, &at.corners, local, tied, of_corner)
    }

    /// (E39).
    fn modes(&self, xi: Vec3, base: &[Vec3; 3]) -> [[f64; MODES]; 6] {
        let middle = derivatives(&slopes(Vec3::new(xi.x, xi.y, 0.0)), &self.start);
        let scale = self.area / area(&middle);
        // modes of the size of strains along the axes of the frame: those of thin elements differ by powers of their thickness
        let [a, b, c] = self.dual.map(|dual| dual.norm().recip());
        // (place of M_kl in pairs of axes, its size), mode by mode
        let tensors = [
            ((0, 0), xi.x * scale * a * a),
            ((1, 1), xi.y * scale * b * b),
            ((0, 1), 0.5 * xi.x * scale * a * b),
            ((0, 1), 0.5 * xi.y * scale * a * b),
            ((2, 2), xi.z * c * c),
        ];
        let mut modes = [[0.0; MODES]; 6];
        let cosines = base.map(|g| self.dual.map(|dual| g.dot(dual)));
        for (row, (i, j)) in modes.iter_mut().zip(Sym3::PAIRS) {
            for (to, ((k, l), size)) in row.iter_mut().zip(tensors) {
                let (a, b) = (cosines[i], cosines[j]);
                let both = if k == l {
                    a[k] * b[l]
                } else {
                    a[k] * b[l] + a[l] * b[k]
                };
                *to = size * both * if i == j { 1.0 } else { 2.0 };
            }
        }
        modes
    }

    /// Variations of the strains without the modes.
    pub fn variation(&self, at: &AtPoint) -> Variation {
        let mut rows = [[0.0; N]; 6];
        for k in ALONG {
            vary(Sym3::PAIRS[k], &at.slopes, &at.now, 1.0, &mut rows[k]);
        }
        for (k, _, points) in ACROSS {
            for (p, weight) in points.into_iter().zip(tying_weights(k, at.xi)) {
                let tying = &self.tying[p];
                let mut now = tying.start;
                if self.finite {
                    now.iter_mut().zip(tying.moved).for_each(|(g, h)| *g += h);
                }
                vary(Sym3::PAIRS[k], &tying.slopes, &now, weight, &mut rows[k]);
            }
        }
        let across = rows[2].as_chunks_mut::<3>().0.iter_mut().skip(4);
        for (k, to) in across.enumerate() {
            let moved = if self.finite {
                self.moved[4 + k]
            } else {
                Vec3::ZERO
            };
            *to = ((self.start[4 + k] + moved) * at.corners[k]).to_array();
        }
        rows
    }

    /// Adds what a stress along the convected axes does by the change of the variations: a number for each two functions.
    pub fn bend(&self, at: &AtPoint, stress: &Voigt, to: &mut [[f64; NB]; NB]) {
        let mut add = |slopes: &[[f64; 3]; NB], k: usize, weight: f64| {
            let (i, j) = Sym3::PAIRS[k];
            for (to, a) in to.iter_mut().zip(slopes) {
                for (to, b) in to.iter_mut().zip(slopes) {
                    let both = if i == j {
                        a[i] * b[i]
                    } else {
                        a[i] * b[j] + a[j] * b[i]
                    };
                    *to += weight * stress[k] * both;
                }
            }
        };
        for k in ALONG {
            add(&at.slopes, k, at.weight);
        }
        for (k, _, points) in ACROSS {
            for (p, weight) in points.into_iter().zip(tying_weights(k, at.xi)) {
                add(&self.tying[p].slopes, k, at.weight * weight);
            }
        }
        for (k, n) in at.corners.iter().enumerate() {
            to[4 + k][4 + k] += at.weight * stress[2] * n;
        }
    }
}

/// `|G_1 × G_2|`.
fn area(base: &[Vec3; 3]) -> f64 {
    base[0].cross(base[1]).norm()
}

/// By how much the two tying points of a shear count.
fn tying_weights(place: usize, xi: Vec3) -> [f64; 2] {
    let along = if place == 4 { xi.x } else { xi.y };
    [0.5 * (1.0 - along), 0.5 * (1.0 + along)]
}

impl AtPoint {
    /// The tensor with these components along the convected axes.
    pub fn tensor(&self, strain: &Voigt) -> Sym3 {
        let of_axes = self.to_axes();
        let mut values = [0.0; 6];
        for ((to, row), (p, q)) in values.iter_mut().zip(&of_axes).zip(Sym3::PAIRS) {
            let sum: f64 = row.iter().zip(strain).map(|(t, e)| t * e).sum();
            *to = sum * if p == q { 1.0 } else { 0.5 };
        }
        Sym3::from_pairs(values)
    }

    /// The matrix from strains along the convected axes to those along the axes of the frame, shears twice in both.
    pub fn to_axes(&self) -> [[f64; 6]; 6] {
        let dual = self.dual.map(Vec3::to_array);
        let mut matrix = [[0.0; 6]; 6];
        for (row, (p, q)) in matrix.iter_mut().zip(Sym3::PAIRS) {
            for (to, (i, j)) in row.iter_mut().zip(Sym3::PAIRS) {
                let (a, b) = (&dual[i], &dual[j]);
                *to = match (p == q, i == j) {
                    (true, true) => a[p] * a[p],
                    (true, false) => a[p] * b[p],
                    (false, true) => 2.0 * a[p] * a[q],
                    (false, false) => a[p] * b[q] + b[p] * a[q],
                };
            }
        }
        matrix
    }

    /// The strain with the modes at these values.
    pub fn enhanced(&self, values: &[f64; MODES]) -> Voigt {
        let mut strain = self.strain;
        for (e, row) in strain.iter_mut().zip(&self.modes) {
            *e += row.iter().zip(values).map(|(m, a)| m * a).sum::<f64>();
        }
        strain
    }
}
