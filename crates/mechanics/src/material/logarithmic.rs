#![allow(clippy::needless_range_loop)] // indices are those of tensors, and several arrays share them

use super::frame::Frame;
use super::{MaterialError, Order, Response};
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};

/// The logarithmic strain `H = ½ ln C` in the principal axes of `C = I + 2E`.
///
/// A law that answers `H` with its conjugate stress `T` and `M = ∂T/∂H`, both in the principal axes, is a law for `E`:
///
/// ```text
/// S_ij = θ_ij T_ij,      θ_ij = ln[c_i, c_j]
/// C_(ik)(kj) = θ_ik θ_kj M_(ik)(kj) + 4 Σ T_ij ln[c_i, c_k, c_j] G_ik G_kj
/// ```
///
/// with the divided differences of the logarithm, `ln[a, b] = (ln a − ln b)/(a − b)`, `ln[a, a] = 1/a`, and so on, and
/// `G` the strain of a unit normal strain or doubled shear. Equal values are no special case: the first difference goes
/// through `ln(1 + x)/x`, the second through a series where the three values are close.
///
/// Source: Miehe, Apel, Lambrecht, *Comput. Methods Appl. Mech. Engrg.* 191 (2002) 5383–5425, sections 2 and 3; the
/// derivatives of a function of a symmetric matrix: Bhatia, *Matrix Analysis* 1997, theorem V.3.3.
#[derive(Clone, Copy, Debug)]
pub(super) struct Logarithmic {
    /// The principal axes.
    pub frame: Frame,
    /// Principal values of `E`.
    values: [f64; 3],
    /// Principal values of `H`.
    pub strain: [f64; 3],
}

/// Relative distance of the closest three values whose second difference needs no series.
const CLOSE: f64 = 0.1;
/// Terms of the series: `CLOSE` to this power is round-off.
const TERMS: usize = 16;
/// An off-diagonal term counts as nothing below this part of the two diagonal ones.
const NOTHING: f64 = 0.01 * f64::EPSILON;
/// Sweeps of Jacobi's method; convergence is quadratic, six do.
const SWEEPS: usize = 30;

impl Logarithmic {
    /// The logarithmic strain of a strain of Green and Lagrange.
    ///
    /// # Errors
    /// `C` is not positive definite.
    pub fn new(e: &Sym3) -> Result<Self, MaterialError> {
        let Principal { values, frame } = Principal::new(e);
        let c = values.map(|e| 1.0 + 2.0 * e);
        if !c.iter().all(|c| *c > 0.0 && c.is_finite()) {
            let ratio = c[0] * c[1] * c[2];
            return Err(MaterialError::Inverted { ratio });
        }
        Ok(Self {
            frame,
            values,
            strain: values.map(|e| 0.5 * (2.0 * e).ln_1p()),
        })
    }

    /// `H` in the principal axes.
    pub const fn value(&self) -> Sym3 {
        let [a, b, c] = self.strain;
        Sym3::diagonal(a, b, c)
    }

    /// For a law in `E` where this is of `A E Aᵀ` and a constant.
    pub fn through(mut self, a: Mat3) -> Self {
        self.frame.axes = self.frame.axes * a;
        self
    }

    /// Turns `T` and `M`, in the principal axes, into `S` and its tangent in the global ones.
    pub fn pull_back(&self, order: Order, out: &mut Response) {
        let theta = self.firsts();
        let t = out.stress.to_mat3();
        let scale = Sym3::PAIRS.map(|(i, j)| theta[i][j]);
        let mut stress = out.stress.to_pairs();
        for (s, scale) in stress.iter_mut().zip(scale) {
            *s *= scale;
        }
        out.stress = Sym3::from_pairs(stress);
        if order == Order::Tangent {
            for (row, a) in out.tangent.iter_mut().zip(scale) {
                for (value, b) in row.iter_mut().zip(scale) {
                    *value *= a * b;
                }
            }
            let second = self.seconds(&theta);
            for i in 0..3 {
                for j in 0..3 {
                    for k in 0..3 {
                        let halves =
                            if i == k { 1.0 } else { 0.5 } * if k == j { 1.0 } else { 0.5 };
                        out.tangent[PLACE[i][k]][PLACE[k][j]] +=
                            4.0 * halves * t.rows[i][j] * second[i][k][j];
                    }
                }
            }
        }
        self.frame.turn_back(order, out);
    }

    fn c(&self, i: usize) -> f64 {
        1.0 + 2.0 * self.values[i]
    }

    /// `c_i − c_j`.
    fn distance(&self, i: usize, j: usize) -> f64 {
        2.0 * (self.values[i] - self.values[j])
    }

    /// `θ_ij = ln[c_i, c_j]`.
    fn firsts(&self) -> [[f64; 3]; 3] {
        let mut theta = [[0.0; 3]; 3];
        for i in 0..3 {
            for j in 0..=i {
                let x = self.distance(i, j) / self.c(j);
                let share = if x == 0.0 { 1.0 } else { x.ln_1p() / x };
                theta[i][j] = share / self.c(j);
                theta[j][i] = theta[i][j];
            }
        }
        theta
    }

    /// `ln[c_i, c_j, c_k]`, the same in any order.
    fn seconds(&self, theta: &[[f64; 3]; 3]) -> [[[f64; 3]; 3]; 3] {
        let mut all = [[[0.0; 3]; 3]; 3];
        for i in 0..3 {
            for j in i..3 {
                for k in j..3 {
                    let value = self.second(theta, [i, j, k]);
                    for [a, b, c] in [
                        [i, j, k],
                        [j, k, i],
                        [k, i, j],
                        [k, j, i],
                        [j, i, k],
                        [i, k, j],
                    ] {
                        all[a][b][c] = value;
                    }
                }
            }
        }
        all
    }

    /// `ln[c_i, c_j, c_k]`, from the first differences.
    fn second(&self, theta: &[[f64; 3]; 3], [i, j, k]: [usize; 3]) -> f64 {
        // the two farthest apart, and the one between
        let mut farthest = (i, k, j);
        for (a, b, between) in [(i, j, k), (j, k, i)] {
            if self.distance(a, b).abs() > self.distance(farthest.0, farthest.1).abs() {
                farthest = (a, b, between);
            }
        }
        let (a, b, between) = farthest;
        let mean = (self.c(i) + self.c(j) + self.c(k)) / 3.0;
        if self.distance(a, b).abs() > CLOSE * mean {
            return (theta[a][between] - theta[between][b]) / self.distance(a, b);
        }
        // Σ over n ≥ 2 of (−1)ⁿ⁻¹/(n meanⁿ) h_(n−2)(x), h the complete homogeneous polynomials of the distances
        let mid = (self.values[i] + self.values[j] + self.values[k]) / 3.0;
        let x = [i, j, k].map(|i| 2.0 * (self.values[i] - mid) / mean);
        let p = [
            x[0] + x[1] + x[2],
            x[0] * x[1] + x[1] * x[2] + x[2] * x[0],
            x[0] * x[1] * x[2],
        ];
        let mut h = [1.0, 0.0, 0.0];
        let (mut sum, mut sign) = (0.0, -1.0);
        for n in 2..2 + TERMS {
            sum += sign * h[0] / n as f64;
            sign = -sign;
            h = [p[0] * h[0] - p[1] * h[1] + p[2] * h[2], h[0], h[1]];
        }
        sum / (mean * mean)
    }
}

/// The place of the pair `(i, j)` in [`Sym3::PAIRS`].
const PLACE: [[usize; 3]; 3] = [[0, 3, 5], [3, 1, 4], [5, 4, 2]];

/// A symmetric tensor by its principal values and axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Principal {
    /// The principal values.
    pub values: [f64; 3],
    frame: Frame,
}

impl Principal {
    /// Of a tensor.
    pub fn new(tensor: &Sym3) -> Self {
        let (values, axes) = principal(tensor);
        let frame = Frame { axes };
        Self { values, frame }
    }

    /// The isotropic function of the tensor that is this one of its principal values.
    pub fn map(&self, function: impl Fn(f64) -> f64) -> Sym3 {
        let [a, b, c] = self.values.map(function);
        self.frame.leave(Sym3::diagonal(a, b, c))
    }

    /// Turns a response in the principal axes to the global ones.
    pub fn turn_back(&self, order: Order, out: &mut Response) {
        self.frame.turn_back(order, out);
    }
}

/// Principal values and axes (rows), by Jacobi's method: axes are orthonormal however close the values are.
fn principal(tensor: &Sym3) -> ([f64; 3], Mat3) {
    let mut a = tensor.to_mat3().rows.map(|r| [r.x, r.y, r.z]);
    let mut axes = Mat3::IDENTITY.rows;
    for _ in 0..SWEEPS {
        if a[0][1] == 0.0 && a[1][2] == 0.0 && a[0][2] == 0.0 {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let off = a[p][q];
            if off.abs() <= NOTHING * a[p][p].abs().min(a[q][q].abs()) {
                (a[p][q], a[q][p]) = (0.0, 0.0);
                continue;
            }
            let theta = (a[q][q] - a[p][p]) / (2.0 * off);
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let cos = (t * t + 1.0).sqrt().recip();
            let sin = t * cos;
            a[p][p] -= t * off;
            a[q][q] += t * off;
            (a[p][q], a[q][p]) = (0.0, 0.0);
            let r = 3 - p - q;
            let (rp, rq) = (a[r][p], a[r][q]);
            (a[r][p], a[r][q]) = (cos * rp - sin * rq, sin * rp + cos * rq);
            (a[p][r], a[q][r]) = (a[r][p], a[r][q]);
            let (u, v): (Vec3, Vec3) = (axes[p], axes[q]);
            (axes[p], axes[q]) = (u * cos - v * sin, u * sin + v * cos);
        }
    }
    ([a[0][0], a[1][1], a[2][2]], Mat3::from_rows(axes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn second_differences_have_their_closed_forms_on_both_sides_of_the_series() {
        for base in [0.01f64, 1.0, 30.0] {
            for spread in [0.03, 0.0999, 0.1001, 2.0] {
                for middle in [0.0, 0.3, 1.0] {
                    let c = [base, base * (1.0 + middle * spread), base * (1.0 + spread)];
                    let e = c.map(|c| 0.5 * (c - 1.0));
                    let at = Logarithmic::new(&Sym3::diagonal(e[0], e[1], e[2])).unwrap();
                    let seconds = at.seconds(&at.firsts());
                    let d = |a: f64, b: f64| ((a - b) / b).ln_1p() / (a - b);
                    let inverse = |a: f64| a.recip();
                    let lower = if middle == 0.0 {
                        inverse(c[0])
                    } else {
                        d(c[1], c[0])
                    };
                    let upper = if middle == 1.0 {
                        inverse(c[2])
                    } else {
                        d(c[2], c[1])
                    };
                    let expected = (upper - lower) / (c[2] - c[0]);
                    let value = seconds[0][1][2];
                    assert!((value / expected - 1.0).abs() < 1e-11, "{value} {expected}");
                    assert_eq!(value, seconds[2][0][1]);
                }
            }
        }
        // ln[a, a, a] = −1/(2a²)
        let at = Logarithmic::new(&Sym3::IDENTITY).unwrap();
        assert_eq!(at.seconds(&at.firsts())[0][1][2], -1.0 / 18.0);
    }

    #[test]
    fn principal_axes_are_orthonormal_and_diagonalize() {
        for eps in [1.0, 1e-4, 1e-8, 1e-12, 1e-300, 0.0] {
            let e = Sym3::new(0.3, 0.3 + eps, 0.3, 0.4 * eps, -0.2 * eps, 0.7 * eps);
            let (values, axes) = principal(&e);
            let back = Sym3::diagonal(values[0], values[1], values[2]).congruence(axes.transpose());
            let error = (back - e).to_pairs();
            assert!(error.iter().all(|v| v.abs() < 1e-15), "{eps} {error:?}");
            let unit = axes * axes.transpose() - Mat3::IDENTITY;
            assert!(unit.rows.iter().all(|r| r.max_abs() < 1e-15));
        }
    }
}
