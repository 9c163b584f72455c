use super::{Mat3, Vec3};
use std::ops::{Add, Mul, Sub};

/// A symmetric 3×3 tensor (stress, strain: tensor components, no factor 2 on shears).
///
/// The order in which the six components are stored is nobody's business: kernels that run over all of them use
/// [`Sym3::PAIRS`], the foreign orders (Voigt, VTK, Abaqus) exist only where files are read and written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sym3 {
    c: [f64; 6],
}

impl Sym3 {
    /// The zero tensor.
    pub const ZERO: Self = Self { c: [0.0; 6] };

    /// The identity.
    pub const IDENTITY: Self = Self::diagonal(1.0, 1.0, 1.0);

    /// The index pair `(i, j)`, `i ≤ j`, of each stored component, in storage order.
    pub const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)];

    /// The tensor with these components.
    #[inline]
    #[must_use]
    pub const fn new(xx: f64, yy: f64, zz: f64, xy: f64, yz: f64, xz: f64) -> Self {
        Self {
            c: [xx, yy, zz, xy, yz, xz],
        }
    }

    /// The tensor with this diagonal.
    #[inline]
    #[must_use]
    pub const fn diagonal(xx: f64, yy: f64, zz: f64) -> Self {
        Self::new(xx, yy, zz, 0.0, 0.0, 0.0)
    }

    /// The tensor with its components in the order of [`Sym3::PAIRS`].
    #[inline]
    #[must_use]
    pub const fn from_pairs(c: [f64; 6]) -> Self {
        Self { c }
    }

    /// The components in the order of [`Sym3::PAIRS`].
    #[inline]
    #[must_use]
    pub const fn to_pairs(self) -> [f64; 6] {
        self.c
    }

    /// The symmetric part of a matrix.
    #[inline]
    #[must_use]
    pub fn symmetric_part(m: Mat3) -> Self {
        let [a, b, c] = m.rows;
        Self::new(
            a.x,
            b.y,
            c.z,
            0.5 * (a.y + b.x),
            0.5 * (b.z + c.y),
            0.5 * (a.z + c.x),
        )
    }

    /// `mᵀ m`.
    #[inline]
    #[must_use]
    pub fn gram(m: Mat3) -> Self {
        let [a, b, c] = m.transpose().rows;
        Self::new(a.dot(a), b.dot(b), c.dot(c), a.dot(b), b.dot(c), a.dot(c))
    }

    /// Component `xx`.
    #[inline]
    #[must_use]
    pub const fn xx(&self) -> f64 {
        self.c[0]
    }

    /// Component `yy`.
    #[inline]
    #[must_use]
    pub const fn yy(&self) -> f64 {
        self.c[1]
    }

    /// Component `zz`.
    #[inline]
    #[must_use]
    pub const fn zz(&self) -> f64 {
        self.c[2]
    }

    /// Component `xy`.
    #[inline]
    #[must_use]
    pub const fn xy(&self) -> f64 {
        self.c[3]
    }

    /// Component `yz`.
    #[inline]
    #[must_use]
    pub const fn yz(&self) -> f64 {
        self.c[4]
    }

    /// Component `xz`.
    #[inline]
    #[must_use]
    pub const fn xz(&self) -> f64 {
        self.c[5]
    }

    /// The same tensor as a full matrix.
    #[inline]
    #[must_use]
    pub fn to_mat3(self) -> Mat3 {
        let [xx, yy, zz, xy, yz, xz] = self.c;
        Mat3::from_rows([
            Vec3::new(xx, xy, xz),
            Vec3::new(xy, yy, yz),
            Vec3::new(xz, yz, zz),
        ])
    }

    /// The trace.
    #[inline]
    #[must_use]
    pub fn trace(self) -> f64 {
        self.c[0] + self.c[1] + self.c[2]
    }

    /// The determinant.
    #[inline]
    #[must_use]
    pub fn determinant(self) -> f64 {
        self.to_mat3().determinant()
    }

    /// The double contraction `a : b`, every off-diagonal product counted twice.
    #[inline]
    #[must_use]
    pub fn double_dot(self, o: Self) -> f64 {
        let (a, b) = (self.c, o.c);
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2.0 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5])
    }

    /// The inverse and the determinant, or `None` where the determinant is zero or not finite.
    #[inline]
    #[must_use]
    pub fn inverse(self) -> Option<(Self, f64)> {
        let (inverse, det) = self.to_mat3().inverse()?;
        Some((Self::symmetric_part(inverse), det))
    }

    /// `m s mᵀ`.
    #[inline]
    #[must_use]
    pub fn congruence(self, m: Mat3) -> Self {
        Self::symmetric_part(m * self.to_mat3() * m.transpose())
    }

    /// The eigenvalues, largest first, by Jacobi's rotations.
    ///
    /// # Limits
    /// Each is exact to a few roundings of the largest one, however close they lie. Components that are not finite
    /// give values that are not.
    ///
    /// # Source
    /// Golub and Van Loan, Matrix Computations, 4th ed., section 8.5.
    ///
    /// # Example
    /// ```
    /// use signorini_geometry::tensor::Sym3;
    ///
    /// // pure shear has the principal stresses τ, 0, −τ
    /// let shear = Sym3::new(0.0, 0.0, 0.0, 5.0, 0.0, 0.0);
    /// let mut principal = shear.eigenvalues();
    /// principal.sort_by(f64::total_cmp);
    /// for (found, exact) in principal.iter().zip([-5.0, 0.0, 5.0]) {
    ///     assert!((found - exact).abs() < 1e-14);
    /// }
    /// ```
    #[must_use]
    pub fn eigenvalues(self) -> [f64; 3] {
        let mut m = self.to_mat3().rows.map(Vec3::to_array);
        // convergence is quadratic: four sweeps reach round-off from nearly all starts, six from any
        for _ in 0..6 {
            let size = |entries: [f64; 3]| entries.iter().map(|e| e.abs()).sum::<f64>();
            let diagonal = size([m[0][0], m[1][1], m[2][2]]);
            if size([m[0][1], m[0][2], m[1][2]]) <= NOTHING * diagonal {
                break;
            }
            for (p, q) in [(0, 1), (0, 2), (1, 2)] {
                annihilate(&mut m, p, q);
            }
        }
        let mut values = [m[0][0], m[1][1], m[2][2]];
        values.sort_by(|a, b| b.total_cmp(a));
        values
    }

    /// The equivalent stress of von Mises, `√(3/2 s:s)` of the deviator `s`.
    ///
    /// # Example
    /// ```
    /// use signorini_geometry::tensor::Sym3;
    ///
    /// let uniaxial = Sym3::diagonal(250.0, 0.0, 0.0);
    /// let shear = Sym3::new(0.0, 0.0, 0.0, 100.0, 0.0, 0.0);
    /// assert!((uniaxial.von_mises() - 250.0).abs() < 1e-12);
    /// assert!((shear.von_mises() - 100.0 * 3_f64.sqrt()).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn von_mises(self) -> f64 {
        let mean = self.trace() / 3.0;
        let s = self - Self::diagonal(mean, mean, mean);
        (1.5 * s.double_dot(s)).max(0.0).sqrt()
    }
}

/// What may stay off the diagonal, relative to it, when values are found.
const NOTHING: f64 = f64::EPSILON / 64.0;

/// Turns a symmetric matrix in the plane `p, q` such that its entry there vanishes.
fn annihilate(m: &mut [[f64; 3]; 3], p: usize, q: usize) {
    let entry = m[p][q];
    if entry == 0.0 {
        return;
    }
    let theta = 0.5 * (m[q][q] - m[p][p]) / entry;
    // where the square is too large for a number, there is nothing to turn
    let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    m[p][p] -= t * entry;
    m[q][q] += t * entry;
    (m[p][q], m[q][p]) = (0.0, 0.0);
    let r = 3 - p - q;
    let (x, y) = (m[r][p], m[r][q]);
    (m[r][p], m[r][q]) = (c * x - s * y, s * x + c * y);
    (m[p][r], m[q][r]) = (m[r][p], m[r][q]);
}

impl Add for Sym3 {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Self {
            c: std::array::from_fn(|i| self.c[i] + o.c[i]),
        }
    }
}

impl Sub for Sym3 {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        Self {
            c: std::array::from_fn(|i| self.c[i] - o.c[i]),
        }
    }
}

impl Mul<f64> for Sym3 {
    type Output = Self;
    #[inline]
    fn mul(self, s: f64) -> Self {
        Self {
            c: self.c.map(|v| v * s),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const S: Sym3 = Sym3::new(3.0, 2.0, 1.5, 0.4, -0.3, 0.2);

    #[test]
    fn accessors_and_pairs_name_the_same_components() {
        let m = S.to_mat3();
        let named = [S.xx(), S.yy(), S.zz(), S.xy(), S.yz(), S.xz()];
        for (k, (i, j)) in Sym3::PAIRS.into_iter().enumerate() {
            assert_eq!(S.to_pairs()[k], m.rows[i][j]);
            assert_eq!(S.to_pairs()[k], m.rows[j][i]);
            assert_eq!(S.to_pairs()[k], named[k]);
        }
    }

    #[test]
    fn invariants_agree_with_the_full_matrix() {
        let m = S.to_mat3();
        assert!((S.determinant() - m.determinant()).abs() < 1e-15);
        let full: f64 = (0..3).map(|i| m.rows[i].dot(m.rows[i])).sum();
        assert!((S.double_dot(S) - full).abs() < 1e-14);
        let (inverse, _) = S.inverse().unwrap();
        let product = inverse.to_mat3() * m - Mat3::IDENTITY;
        assert!(product.rows.iter().all(|r| r.max_abs() < 1e-15));
    }

    #[test]
    fn von_mises_of_uniaxial_stress_is_its_size_and_ignores_pressure() {
        assert!((Sym3::diagonal(-7.0, 0.0, 0.0).von_mises() - 7.0).abs() < 1e-14);
        assert!(Sym3::diagonal(5.0, 5.0, 5.0).von_mises() < 1e-14);
        assert!(
            (Sym3::new(0.0, 0.0, 0.0, 2.0, 0.0, 0.0).von_mises() - 2.0 * 3f64.sqrt()).abs() < 1e-14
        );
    }

    #[test]
    fn eigenvalues_have_the_invariants_of_the_tensor() {
        let mut random = crate::random::Random(7);
        for _ in 0..1000 {
            let c = std::array::from_fn(|_| random.signed());
            let s = Sym3::from_pairs(c);
            let [a, b, c] = s.eigenvalues();
            assert!(a >= b && b >= c);
            assert!((a + b + c - s.trace()).abs() < 1e-14);
            assert!((a * b * c - s.determinant()).abs() < 1e-14);
            assert!((a * a + b * b + c * c - s.double_dot(s)).abs() < 1e-14);
        }
    }

    #[test]
    fn eigenvalues_of_diagonals_and_pure_shear_are_known() {
        assert_eq!(
            Sym3::diagonal(3.0, -1.0, 2.0).eigenvalues(),
            [3.0, 2.0, -1.0]
        );
        assert_eq!(Sym3::ZERO.eigenvalues(), [0.0; 3]);
        let shear = Sym3::new(0.0, 0.0, 0.0, 0.0, 0.0, 2.0).eigenvalues();
        assert!(
            shear
                .iter()
                .zip([2.0, 0.0, -2.0])
                .all(|(a, b)| (a - b).abs() < 1e-15)
        );
    }

    #[test]
    fn eigenvalues_that_nearly_coincide_keep_their_distance() {
        // a (1, 1, 1)/3-projection raises one of three equal values by d
        for d in [1e-3, 1e-8, 1e-13, 0.0] {
            let third = d / 3.0;
            let diagonal = 1.0 + third;
            let s = Sym3::new(diagonal, diagonal, diagonal, third, third, third);
            let [a, b, c] = s.eigenvalues();
            assert!((a - 1.0 - d).abs() < 1e-15, "{d}: {a}");
            assert!((b - 1.0).abs() < 1e-15 && (c - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn eigenvalues_of_what_is_not_finite_are_not() {
        for value in [f64::NAN, f64::INFINITY] {
            for k in 0..6 {
                let mut c = [1.0, 2.0, 3.0, 0.5, 0.0, 0.0];
                c[k] = value;
                let found = Sym3::from_pairs(c).eigenvalues();
                assert!(found.iter().any(|v| !v.is_finite()), "{c:?}: {found:?}");
            }
        }
    }

    #[test]
    fn eigenvalues_scale_with_huge_and_tiny_tensors() {
        for scale in [1e-150, 1e150] {
            for (a, b) in (S * scale).eigenvalues().iter().zip(S.eigenvalues()) {
                assert!((a / scale - b).abs() < 1e-14);
            }
        }
    }
}
