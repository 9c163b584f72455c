//! Surfaces given by the user's own function.
//!
//! The surface is where `φ = 0`, the body where `φ < 0`. With `φ` a distance the closest point of r is `r − φ ∇φ`, but
//! few functions that are easy to write down are distances. So φ need not be one. Its closest point is the minimum of
//! `F = ½ |r − ρ|²` on the surface, found by Newton's method on it:
//!
//! ```text
//! x ← x − φ ∇φ / |∇φ|²                         onto the surface, until it stays          (E1)
//! ν = ∇φ/|∇φ|,   λ = (r − x)·ν / |∇φ|,   P = I − ννᵀ
//! P (I + λ ∇∇φ) P t = P (r − x)                a step along it, from there (E1) again    (E2)
//! ∇ν = P ∇∇φ P / |∇φ|                                                                    (E3)
//! ```
//!
//! (E2) is the Hessian of F on the surface; where it is not positive definite the step is `P (r − x)`, and steps are
//! halved until F decreases as it should. A true distance is done after the first (E1).
//!
//! Required of φ: finite and twice continuously differentiable, with the gradient and Hessian that are given, between
//! the surface and the points within reach of it; `∇φ ≠ 0` there. A point at which the gradient vanishes, such as the
//! centre of a ball, and one beyond the centre of curvature of what would be its closest point have none. Of several
//! closest points, that to which the gradient leads is found. [`SignedDistance::check`] finds wrong derivatives.
//!
//! Source: Absil, Mahony, Sepulchre, *Optimization Algorithms on Matrix Manifolds*, 2008, chapters 4 to 6.

use super::SurfaceError;
use super::analytical::{Patch, Shape};
use super::error::AnalyticalError;
use super::mount::positive;
use crate::tensor::{Mat3, Sym3, Vec3};
use std::fmt;

/// A function of the user's, with a message where it fails.
pub type UserFunction<T> = dyn Fn(Vec3) -> Result<T, String> + Send + Sync;

/// Steps after which a search is given up.
const MAX_STEPS: usize = 60;
/// Relative length of a step that changes nothing any more.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;
/// Relative length below which a step that shrinks no further is due to rounding in φ.
const NOISE: f64 = 1e-9;

/// A surface where a function vanishes, with the function's derivatives, in the initial configuration.
pub struct SignedDistance {
    size: f64,
    value: Box<UserFunction<f64>>,
    gradient: Box<UserFunction<Vec3>>,
    hessian: Box<UserFunction<Sym3>>,
    ball: Option<(Vec3, f64)>,
}

impl fmt::Debug for SignedDistance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SignedDistance")
            .field("size", &self.size)
            .field("ball", &self.ball)
            .finish_non_exhaustive()
    }
}

impl SignedDistance {
    /// From φ, ∇φ and ∇∇φ as functions of the position. In a model of the plane positions have z = 0, and φ must not
    /// depend on z. `size` is a length like those in φ, such as a radius: a point is on the surface where it is so to the
    /// rounding error of that length.
    ///
    /// # Errors
    /// A size that is not positive.
    ///
    /// # Example
    /// ```
    /// use signorini_geometry::surface::{Shape, SignedDistance};
    /// use signorini_geometry::tensor::{Sym3, Vec3};
    ///
    /// // an ellipsoid, φ = (x² + y² + z²/4 − 1)/2
    /// let scaled = |x: Vec3| Vec3::new(x.x, x.y, x.z / 4.0);
    /// let ellipsoid = SignedDistance::new(
    ///     1.0,
    ///     Box::new(move |x: Vec3| Ok(0.5 * (x.dot(scaled(x)) - 1.0))),
    ///     Box::new(move |x: Vec3| Ok(scaled(x))),
    ///     Box::new(|_: Vec3| Ok(Sym3::diagonal(1.0, 1.0, 0.25))),
    /// )?;
    /// let on = ellipsoid.closest(Vec3::new(0.0, 0.0, 3.0))?.ok_or("no closest point")?;
    /// assert!((on - Vec3::new(0.0, 0.0, 2.0)).norm() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(
        size: f64,
        value: Box<UserFunction<f64>>,
        gradient: Box<UserFunction<Vec3>>,
        hessian: Box<UserFunction<Sym3>>,
    ) -> Result<Self, AnalyticalError> {
        Ok(Self {
            size: positive("the size of the surface", size)?,
            value,
            gradient,
            hessian,
            ball: None,
        })
    }

    /// The same surface, which lies in this ball: points far from it are left alone.
    #[must_use]
    pub fn within(self, centre: Vec3, radius: f64) -> Self {
        let ball = Some((centre, radius));
        Self { ball, ..self }
    }

    /// Compares the gradient and the Hessian at a point with differences over `step`.
    ///
    /// # Errors
    /// They differ by more than the differences can be wrong, a relative 1e-4; a function fails.
    pub fn check(&self, point: Vec3, step: f64) -> Result<(), SurfaceError> {
        let gradient = self.gradient(point)?;
        let hessian = self.hessian(point)?.to_mat3();
        let mut slopes = Vec3::ZERO;
        let mut bends = Mat3::ZERO;
        for i in 0..3 {
            let (plus, minus) = (point + Vec3::unit(i) * step, point - Vec3::unit(i) * step);
            slopes[i] = (self.value(plus)? - self.value(minus)?) / (2.0 * step);
            bends.rows[i] = (self.gradient(plus)? - self.gradient(minus)?) / (2.0 * step);
        }
        let size = |m: Mat3| m.rows.iter().map(|r| r.max_abs()).fold(0.0, f64::max);
        let tolerance = 1e-4 * gradient.max_abs();
        let wrong = |what, off: f64| {
            failed(format!(
                "{what} at {} differs from differences by {off:.3e}",
                written(point)
            ))
        };
        let off = (slopes - gradient).max_abs();
        if off > tolerance {
            return Err(wrong("the gradient", off));
        }
        let off = size(bends - hessian);
        if off > 1e-4 * size(hessian) + tolerance {
            return Err(wrong("the Hessian", off));
        }
        Ok(())
    }

    fn value(&self, x: Vec3) -> Result<f64, SurfaceError> {
        let value = (self.value)(x).map_err(failed)?;
        finite("the value", x, value, value.is_finite())
    }

    fn gradient(&self, x: Vec3) -> Result<Vec3, SurfaceError> {
        let gradient = (self.gradient)(x).map_err(failed)?;
        finite("the gradient", x, gradient, gradient.is_finite())
    }

    fn hessian(&self, x: Vec3) -> Result<Sym3, SurfaceError> {
        let hessian = (self.hessian)(x).map_err(failed)?;
        let components = hessian.to_pairs();
        finite(
            "the Hessian",
            x,
            hessian,
            components.iter().all(|c| c.is_finite()),
        )
    }

    /// (E1). `None` where the gradient vanishes on the way.
    fn onto(&self, from: Vec3) -> Result<Option<Vec3>, SurfaceError> {
        let mut x = from;
        let mut last = f64::INFINITY;
        for _ in 0..MAX_STEPS {
            let gradient = self.gradient(x)?;
            let squared = gradient.norm_squared();
            if squared == 0.0 {
                return Ok(None);
            }
            let step = gradient * (self.value(x)? / squared);
            let length = step.norm();
            let scale = self.size + x.norm() + (x - from).norm();
            x -= step;
            if length <= ROUND_OFF * scale || (length >= 0.5 * last && length <= NOISE * scale) {
                return Ok(Some(x));
            }
            last = length;
        }
        let point = written(from);
        Err(failed(format!(
            "no zero of the function was found from {point} along its gradient"
        )))
    }

    /// The surface at a point on it: ν, |∇φ| and ∇∇φ.
    fn normal(&self, on: Vec3) -> Result<(Vec3, f64, Mat3), SurfaceError> {
        let gradient = self.gradient(on)?;
        let vanishes = || failed(format!("the gradient vanishes at {}", written(on)));
        let normal = gradient.normalized().ok_or_else(vanishes)?;
        Ok((normal, gradient.norm(), self.hessian(on)?.to_mat3()))
    }
}

fn failed(message: String) -> SurfaceError {
    SurfaceError::User { message }
}

fn finite<T>(what: &str, x: Vec3, value: T, is_finite: bool) -> Result<T, SurfaceError> {
    let error = || failed(format!("{what} at {} is not finite", written(x)));
    is_finite.then_some(value).ok_or_else(error)
}

fn written(x: Vec3) -> String {
    format!("({}, {}, {})", x.x, x.y, x.z)
}

/// Solves `P B P t = τ` for the tangential vectors t and τ; `None` where `P B P` is not positive definite there.
fn tangential(b: Mat3, normal: Vec3, tau: Vec3) -> Option<Vec3> {
    // P B P + ννᵀ is invertible and leaves tangential vectors tangential
    let nn = Mat3::outer(normal, normal);
    let p = Mat3::IDENTITY - nn;
    let m = Sym3::symmetric_part(p * b * p + nn);
    // one eigenvalue is 1, with ν; the others have this sum and product
    let (sum, product) = (m.trace() - 1.0, m.determinant());
    if !(sum > 0.0 && product > 1e-9 * sum * sum) {
        return None;
    }
    let (inverse, _) = m.inverse()?;
    Some(inverse.to_mat3() * tau)
}

impl Shape for SignedDistance {
    fn closest(&self, point: Vec3) -> Result<Option<Vec3>, SurfaceError> {
        let Some(mut x) = self.onto(point)? else {
            return Ok(None);
        };
        let mut last = f64::INFINITY;
        for _ in 0..MAX_STEPS {
            let (normal, steepness, hessian) = self.normal(x)?;
            let away = point - x;
            let along = away.dot(normal);
            let tau = away - normal * along;
            let curved = Mat3::IDENTITY + hessian * (along / steepness);
            let newton = tangential(curved, normal, tau); // (E2)
            let scale = self.size + x.norm() + away.norm();
            let residual = tau.norm();
            if residual <= ROUND_OFF * scale
                || (residual >= 0.5 * last && residual <= NOISE * scale)
            {
                return Ok(newton.map(|_| x));
            }
            last = residual;
            let step = newton.unwrap_or(tau);
            let slope = step.dot(tau);
            let mut alpha = 1.0;
            x = loop {
                let trial = self.onto(x + step * alpha)?;
                let Some(trial) = trial else {
                    return Ok(None);
                };
                let reached = 0.5 * (point - trial).norm_squared();
                let enough = 0.5 * away.norm_squared() - 1e-4 * alpha * slope;
                // a difference of squares shows nothing where the step is at round-off
                if reached <= enough || alpha * step.norm() <= 1e-7 * scale {
                    break trial;
                }
                alpha *= 0.5;
            };
        }
        let point = written(point);
        Err(failed(format!(
            "the closest point of {point} was not found; do the gradient and the Hessian belong to the function?"
        )))
    }

    fn patch(&self, on: Vec3) -> Result<Patch, SurfaceError> {
        let (normal, steepness, hessian) = self.normal(on)?;
        let across = Mat3::IDENTITY - Mat3::outer(normal, normal);
        let gradient = Sym3::symmetric_part(hessian).congruence(across) * steepness.recip(); // (E3)
        Ok(Patch::smooth(normal, gradient))
    }

    fn ball(&self) -> Option<(Vec3, f64)> {
        self.ball
    }
}
