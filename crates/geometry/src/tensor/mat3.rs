use super::Vec3;
use std::ops::{Add, Mul, Sub};

/// A 3×3 matrix, stored by rows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Mat3 {
    /// The rows.
    pub rows: [Vec3; 3],
}

impl Mat3 {
    /// The identity.
    pub const IDENTITY: Self = Self {
        rows: [Vec3::unit(0), Vec3::unit(1), Vec3::unit(2)],
    };

    /// The zero matrix.
    pub const ZERO: Self = Self {
        rows: [Vec3::ZERO; 3],
    };

    /// The matrix with these rows.
    #[inline]
    #[must_use]
    pub const fn from_rows(rows: [Vec3; 3]) -> Self {
        Self { rows }
    }

    /// The dyad `a bᵀ`.
    #[inline]
    #[must_use]
    pub fn outer(a: Vec3, b: Vec3) -> Self {
        Self::from_rows([b * a.x, b * a.y, b * a.z])
    }

    /// The matrix `[a]×` with `[a]× b = a × b`.
    #[inline]
    #[must_use]
    pub const fn skew(a: Vec3) -> Self {
        Self::from_rows([
            Vec3::new(0.0, -a.z, a.y),
            Vec3::new(a.z, 0.0, -a.x),
            Vec3::new(-a.y, a.x, 0.0),
        ])
    }

    /// The rotation by the vector `theta` (axis times angle in radians), Rodrigues' formula.
    ///
    /// # Example
    /// ```
    /// use signorini_geometry::tensor::{Mat3, Vec3};
    ///
    /// let quarter = Vec3::unit(2) * std::f64::consts::FRAC_PI_2;
    /// let turned = Mat3::rotation(quarter) * Vec3::unit(0);
    /// assert!((turned - Vec3::unit(1)).norm() < 1e-15);
    /// ```
    #[must_use]
    pub fn rotation(theta: Vec3) -> Self {
        let angle_squared = theta.norm_squared();
        let angle = angle_squared.sqrt();
        // sin(x)/x and (1 - cos(x))/x² with their series where the quotients lose digits
        let (a, b) = if angle < 1e-4 {
            (1.0 - angle_squared / 6.0, 0.5 - angle_squared / 24.0)
        } else {
            let half = (0.5 * angle).sin() / angle;
            (angle.sin() / angle, 2.0 * half * half)
        };
        let k = Self::skew(theta);
        Self::IDENTITY + k * a + k * k * b
    }

    /// The rotation vector of a rotation, of half a turn at most: [`Mat3::rotation`] gives it back.
    #[must_use]
    pub fn rotation_vector(self) -> Vec3 {
        let [a, b, c] = self.rows;
        // the quaternion times four times its largest component, which keeps all digits
        let trace = a.x + b.y + c.z;
        let largest = trace.max(a.x).max(b.y).max(c.z);
        let (scalar, vector) = if largest == trace {
            let vector = Vec3::new(c.y - b.z, a.z - c.x, b.x - a.y);
            (1.0 + trace, vector)
        } else if largest == a.x {
            let own = 1.0 + a.x - b.y - c.z;
            (c.y - b.z, Vec3::new(own, b.x + a.y, a.z + c.x))
        } else if largest == b.y {
            let own = 1.0 + b.y - a.x - c.z;
            (a.z - c.x, Vec3::new(b.x + a.y, own, c.y + b.z))
        } else {
            let own = 1.0 + c.z - a.x - b.y;
            (b.x - a.y, Vec3::new(a.z + c.x, c.y + b.z, own))
        };
        let (scalar, vector) = if scalar < 0.0 {
            (-scalar, vector * -1.0)
        } else {
            (scalar, vector)
        };
        let size = vector.norm();
        if size < 1e-8 * scalar {
            return vector * (2.0 / scalar);
        }
        vector * (2.0 * size.atan2(scalar) / size)
    }

    /// The transpose.
    #[inline]
    #[must_use]
    pub fn transpose(self) -> Self {
        let [a, b, c] = self.rows;
        Self::from_rows([
            Vec3::new(a.x, b.x, c.x),
            Vec3::new(a.y, b.y, c.y),
            Vec3::new(a.z, b.z, c.z),
        ])
    }

    /// The determinant.
    #[inline]
    #[must_use]
    pub fn determinant(self) -> f64 {
        self.rows[0].dot(self.rows[1].cross(self.rows[2]))
    }

    /// The inverse and the determinant, or `None` where the determinant is zero or not finite.
    ///
    /// # Example
    /// ```
    /// use signorini_geometry::tensor::{Mat3, Vec3};
    ///
    /// let stretch = Mat3::from_rows([Vec3::unit(0) * 2.0, Vec3::unit(1) * 4.0, Vec3::unit(2)]);
    /// let (inverse, determinant) = stretch.inverse().ok_or("singular")?;
    /// assert_eq!(determinant, 8.0);
    /// assert_eq!(inverse * Vec3::new(2.0, 4.0, 1.0), Vec3::new(1.0, 1.0, 1.0));
    /// # Ok::<(), &str>(())
    /// ```
    #[inline]
    #[must_use]
    pub fn inverse(self) -> Option<(Self, f64)> {
        let [a, b, c] = self.rows;
        let (p, q, r) = (b.cross(c), c.cross(a), a.cross(b));
        let det = a.dot(p);
        if det == 0.0 || !det.is_finite() {
            return None;
        }
        Some((Self::from_rows([p, q, r]).transpose() * det.recip(), det))
    }
}

impl Add for Mat3 {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        let ([a, b, c], [d, e, f]) = (self.rows, o.rows);
        Self::from_rows([a + d, b + e, c + f])
    }
}

impl Sub for Mat3 {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        let ([a, b, c], [d, e, f]) = (self.rows, o.rows);
        Self::from_rows([a - d, b - e, c - f])
    }
}

impl Mul<f64> for Mat3 {
    type Output = Self;
    #[inline]
    fn mul(self, s: f64) -> Self {
        let [a, b, c] = self.rows;
        Self::from_rows([a * s, b * s, c * s])
    }
}

impl Mul<Vec3> for Mat3 {
    type Output = Vec3;
    #[inline]
    fn mul(self, v: Vec3) -> Vec3 {
        let [a, b, c] = self.rows;
        Vec3::new(a.dot(v), b.dot(v), c.dot(v))
    }
}

impl Mul for Mat3 {
    type Output = Self;
    #[inline]
    fn mul(self, o: Self) -> Self {
        let [d, e, f] = o.rows;
        Self::from_rows(self.rows.map(|r| d * r.x + e * r.y + f * r.z))
    }
}

/// What turns axes about one of themselves, from 0, counter-clockwise as seen from its tip, by degrees: to multiply them
/// with from the left. Quarter turns are exact.
///
/// # Example
/// ```
/// use signorini_geometry::tensor::{Mat3, Vec3, turn_about};
///
/// let axes = turn_about(2, 90.0) * Mat3::IDENTITY;
/// assert_eq!(axes.rows, [Vec3::unit(1), -Vec3::unit(0), Vec3::unit(2)]);
/// ```
#[must_use]
pub fn turn_about(axis: usize, angle: f64) -> Mat3 {
    let (sin, cos) = match (angle / 90.0).rem_euclid(4.0) {
        0.0 => (0.0, 1.0),
        1.0 => (1.0, 0.0),
        2.0 => (0.0, -1.0),
        3.0 => (-1.0, 0.0),
        _ => angle.to_radians().sin_cos(),
    };
    let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut turn = Mat3::IDENTITY;
    turn.rows[first] = Vec3::unit(first) * cos + Vec3::unit(second) * sin;
    turn.rows[second] = Vec3::unit(second) * cos - Vec3::unit(first) * sin;
    turn
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Mat3 {
        Mat3::from_rows([
            Vec3::new(2.0, 1.0, -0.5),
            Vec3::new(0.3, -1.5, 0.7),
            Vec3::new(0.1, 0.4, 1.2),
        ])
    }

    fn distance(a: Mat3, b: Mat3) -> f64 {
        (a - b).rows.iter().map(|r| r.max_abs()).fold(0.0, f64::max)
    }

    #[test]
    fn inverse_times_matrix_is_identity() {
        let (inverse, det) = sample().inverse().unwrap();
        assert!(distance(inverse * sample(), Mat3::IDENTITY) < 1e-15);
        assert!((det - sample().determinant()).abs() < 1e-15);
        assert!(Mat3::ZERO.inverse().is_none());
    }

    #[test]
    fn skew_is_the_vector_product() {
        let (a, b) = (Vec3::new(1.0, -2.0, 3.0), Vec3::new(0.5, 0.25, -4.0));
        assert_eq!(Mat3::skew(a) * b, a.cross(b));
    }

    #[test]
    fn rotation_vectors_are_those_of_their_rotations() {
        let axes = [
            Vec3::new(0.6, 0.0, -0.8),
            Vec3::new(0.0, 0.96, 0.28),
            Vec3::new(-1.0, 0.0, 0.0),
            Vec3::new(0.36, -0.48, 0.8),
        ];
        for angle in [
            0.0,
            1e-12,
            1e-9,
            1e-7,
            1e-3,
            1.0,
            3.0,
            std::f64::consts::PI - 1e-6,
        ] {
            for axis in axes {
                let vector = axis * angle;
                let back = Mat3::rotation(vector).rotation_vector();
                assert!((back - vector).norm() < 1e-14, "{angle}: {back:?}");
            }
        }
    }

    #[test]
    fn rotation_is_orthogonal_and_continuous_through_its_series() {
        for angle in [0.0, 1e-9, 0.9999e-4, 1.0001e-4, 0.3, 3.0, 12.0] {
            let r = Mat3::rotation(Vec3::new(0.6, 0.0, 0.8) * angle);
            assert!(
                distance(r * r.transpose(), Mat3::IDENTITY) < 1e-14,
                "{angle}"
            );
            assert!((r.determinant() - 1.0).abs() < 1e-14);
        }
        let quarter = Mat3::rotation(Vec3::new(0.0, 0.0, std::f64::consts::FRAC_PI_2));
        assert!((quarter * Vec3::unit(0) - Vec3::unit(1)).norm() < 1e-15);
    }
}
