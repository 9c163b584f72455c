//! From the reference element to gradients, and from gradients to strains.

use super::element::{Element, Failure};
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};

/// A quadrature point of an element at the start.
pub(super) struct Place<const NN: usize, const NG: usize> {
    /// N_I,X of each node; in axisymmetry N_I/R is the third.
    pub gradient: [[f64; NG]; NN],
    /// Volume that belongs to the point.
    pub weight: f64,
}

/// The rows `∂x/∂ξ_a` of the map from the reference element.
pub(super) fn jacobian<const ND: usize>(x: &[Vec3], dshape: &[Vec3]) -> Mat3 {
    let mut jacobian = Mat3::ZERO;
    for (x, dn) in x.iter().zip(dshape) {
        for a in 0..ND {
            jacobian.rows[a] += *x * dn[a];
        }
    }
    if ND == 2 {
        jacobian.rows[2] = Vec3::unit(2);
    }
    jacobian
}

/// The inverse of a map with its determinant, which must be positive.
#[inline]
pub(super) fn inverse(map: Mat3) -> Result<(Mat3, f64), Failure> {
    map.inverse()
        .filter(|(_, det)| *det > 0.0)
        .ok_or_else(|| Failure::Inverted {
            ratio: map.determinant(),
        })
}

/// Where a point is.
pub(super) fn position(x: &[Vec3], shape: &[f64]) -> Vec3 {
    x.iter().zip(shape).map(|(x, n)| *x * *n).sum()
}

/// The gradients at a quadrature point.
#[inline]
pub(super) fn place<const NN: usize, const ND: usize, const NG: usize>(
    element: &Element<'_>,
    point: usize,
) -> Result<Place<NN, NG>, Failure> {
    let points = element.reference;
    let dshape = points.dshape(point);
    let (inverse, det) = inverse(jacobian::<ND>(&element.x[..NN], dshape))?;
    let mut gradient = [[0.0; NG]; NN];
    for (to, dn) in gradient.iter_mut().zip(dshape) {
        let g = inverse * *dn;
        for a in 0..ND {
            to[a] = g[a];
        }
    }
    let mut at = Vec3::ZERO;
    if NG > ND {
        let shape = points.shape(point);
        at = position(element.x, shape);
        for (to, n) in gradient.iter_mut().zip(shape) {
            to[ND] = n / at.x;
        }
    }
    let weight = points.rule.weights[point] * det * element.extent(points.shape(point), at);
    Ok(Place { gradient, weight })
}

/// The row of the deformation gradient in which displacement `i` meets row `a` of the gradient: its own, but the hoop
/// of the radius in axisymmetry, which the axial displacement does not have.
#[inline]
pub(super) const fn row<const ND: usize, const NG: usize>(i: usize, a: usize) -> Option<usize> {
    if NG > ND && a == ND {
        return if i == 0 { Some(ND) } else { None };
    }
    Some(i)
}

/// H = ∂u/∂X.
#[inline]
pub(super) fn displacement_gradient<const NN: usize, const ND: usize, const NG: usize>(
    gradient: &[[f64; NG]; NN],
    u: &[f64],
) -> Mat3 {
    let mut h = Mat3::ZERO;
    for (g, u) in gradient.iter().zip(u.chunks_exact(ND)) {
        for i in 0..ND {
            for a in 0..NG {
                if let Some(row) = row::<ND, NG>(i, a) {
                    h.rows[row][a] += u[i] * g[a];
                }
            }
        }
    }
    h
}

/// `½ (H + Hᵀ)`, and `½ HᵀH` more at finite strain.
#[inline]
pub(super) fn strain(h: Mat3, finite: bool) -> Sym3 {
    let linear = Sym3::symmetric_part(h);
    if finite {
        linear + Sym3::gram(h) * 0.5
    } else {
        linear
    }
}

/// `F = I + H` and its determinant, which must be positive, and so must the hoop's part of it; the identity at small
/// strain.
#[inline]
pub(super) fn deformation<const ND: usize, const NG: usize>(
    h: Mat3,
    finite: bool,
) -> Result<(Mat3, f64), Failure> {
    if !finite {
        return Ok((Mat3::IDENTITY, 1.0));
    }
    let f = Mat3::IDENTITY + h;
    let mut ratio = f.determinant();
    if NG > ND {
        ratio = ratio.min(f.rows[2].z);
    }
    // not `ratio <= 0`: a ratio that is not a number must not pass
    if ratio > 0.0 {
        Ok((f, f.determinant()))
    } else {
        Err(Failure::Inverted { ratio })
    }
}
