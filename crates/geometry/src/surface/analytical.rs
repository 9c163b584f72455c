//! Rigid surfaces given by formulas.
//!
//! A [`Shape`] knows its closest points, and at each of its points the normal ν and the symmetric tensor `∇ν`, with
//! `∇ν ν = 0`; all in the initial configuration, without unknowns, motions or dimensions. [`Analytical`] fastens it to
//! its [`Mount`] and makes a contact surface of it, with orthonormal tangents:
//!
//! ```text
//! κ_ab = ν·ρ_,ab = −t_a·∇ν t_b,   m_ab = δ_ab                                                  (E1)
//! ∇∇g = −κ_ac (δ − g κ)⁻¹_cb t_a t_bᵀ      at a point with the gap g                           (E2)
//! ```
//!
//! (E1) follows from `ν·t_a = 0` by differentiation, (E2) from `∇ν (r) = ∇ν(ρ) ∂ρ/∂r`; a test compares it with
//! differences. A sphere of radius R has `∇ν = (I − ννᵀ)/R` and `κ = −δ/R` outside.

use super::error::AnalyticalError;
use super::mount::Mount;
use super::{
    Anchor, Carrier, ContactSurface, Feature, Outward, Placement, Projection, SurfaceError,
    SurfaceJet, pair,
};
use crate::element::Element;
use crate::proximity::Aabb;
use crate::tensor::{Sym3, Vec3};
use std::fmt::Debug;
use std::sync::Arc;

/// The component along z that a normal of a model of the plane may have.
const IN_PLANE: f64 = 1e-9;

/// On which side of a closed shape there is room.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// The body is the ball, rod, cone or ring; other bodies are outside.
    #[default]
    Outside,
    /// The body is around a hole of that shape; other bodies are inside.
    Inside,
}

impl Side {
    /// A patch of the body outside of which there is room, as this side sees it.
    pub(super) fn of(self, patch: Patch) -> Patch {
        match self {
            Self::Outside => patch,
            Self::Inside => patch.reversed(),
        }
    }
}

/// A shape around one of its points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// ν, of length 1, away from the body.
    pub normal: Vec3,
    /// ∇ν, how the normal changes along the surface, 1/length.
    pub gradient: Sym3,
    /// [`Feature::Face`] where the surface is smooth, [`Feature::Vertex`] at a tip.
    pub feature: Feature,
}

impl Patch {
    /// A smooth place.
    #[must_use]
    pub const fn smooth(normal: Vec3, gradient: Sym3) -> Self {
        Self {
            normal,
            gradient,
            feature: Feature::Face,
        }
    }

    /// The same surface of the body on its other side.
    #[must_use]
    pub fn reversed(self) -> Self {
        Self {
            normal: -self.normal,
            gradient: self.gradient * -1.0,
            ..self
        }
    }
}

/// A rigid shape in the initial configuration.
pub trait Shape: Debug + Send + Sync {
    /// The closest point of the shape. `None` where there is none, or all of a circle or sphere.
    ///
    /// # Errors
    /// A shape given by the user's own code failed.
    fn closest(&self, point: Vec3) -> Result<Option<Vec3>, SurfaceError>;

    /// The shape around a point that lies on it.
    ///
    /// # Errors
    /// There is no normal; a shape given by the user's own code failed.
    fn patch(&self, on: Vec3) -> Result<Patch, SurfaceError>;

    /// Centre and radius of a ball that contains the shape; `None` where it has no end.
    fn ball(&self) -> Option<(Vec3, f64)> {
        None
    }

    /// What must be true of the shape for a model of the plane, where it is not: there it must be its own mirror image
    /// in z = 0, and stands for its section.
    fn out_of_plane(&self) -> Option<&'static str> {
        None
    }
}

/// A shape that others share.
impl Shape for Arc<dyn Shape> {
    fn closest(&self, point: Vec3) -> Result<Option<Vec3>, SurfaceError> {
        (**self).closest(point)
    }

    fn patch(&self, on: Vec3) -> Result<Patch, SurfaceError> {
        (**self).patch(on)
    }

    fn ball(&self) -> Option<(Vec3, f64)> {
        (**self).ball()
    }

    fn out_of_plane(&self) -> Option<&'static str> {
        (**self).out_of_plane()
    }
}

/// A shape as a contact surface of one facet. [`Anchor::local`] is a point on it in the initial configuration.
///
/// Its size is 0: a rigid body has no stiffness that would go by a length, and its radius says nothing about how far
/// contact may reach.
///
/// # Example
/// ```
/// use signorini_geometry::surface::{Analytical, ContactSurface, Mount, Placement, Side, Sphere, SurfaceJet};
/// use signorini_geometry::tensor::Vec3;
/// let ball = Sphere::new(Vec3::ZERO, 2.0, Side::Outside)?;
/// let surface = Analytical::new(Mount::fixed(2), Box::new(ball))?;
/// let mut jet = SurfaceJet::default();
/// let at = Placement { x: &[], poses: &[] };
/// let found = surface.project(&at, 0, Vec3::new(0.0, 0.0, 5.0), None, &mut jet)?;
/// assert_eq!(found.map(|f| f.distance), Some(3.0));
/// assert_eq!(jet.normal, Vec3::unit(2));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Analytical {
    mount: Mount,
    shape: Box<dyn Shape>,
}

impl Analytical {
    /// The surface of a shape on its mount.
    ///
    /// # Errors
    /// A mount of neither the plane nor space; in the plane a shape that is no curve there.
    pub fn new(mount: Mount, shape: Box<dyn Shape>) -> Result<Self, AnalyticalError> {
        let mount = mount.validated()?;
        match shape.out_of_plane() {
            Some(wanted) if mount.ntan == 1 => Err(AnalyticalError::OutOfPlane { wanted }),
            _ => Ok(Self { mount, shape }),
        }
    }

    /// The jet at a point of the shape, and on what that lies.
    fn fill(
        &self,
        at: &Placement,
        on: Vec3,
        out: &mut SurfaceJet,
    ) -> Result<Feature, SurfaceError> {
        let patch = self.shape.patch(on)?;
        let normal = patch.normal;
        if !on.is_finite() || !normal.is_finite() {
            return Err(SurfaceError::NotFinite);
        }
        let ntan = self.mount.ntan;
        if ntan == 1 && normal.z.abs() > IN_PLANE {
            return Err(SurfaceError::OutOfPlane { facet: 0 });
        }
        let motion = self.mount.motion(at);
        let tangent = match ntan {
            1 => [Vec3::unit(2).cross(normal), Vec3::ZERO],
            _ => tangents(normal),
        };
        let gradient = patch.gradient.to_mat3();
        out.nnode = 0;
        out.position = motion.point(on);
        out.normal = motion.vector(normal);
        out.tangent = tangent.map(|t| motion.vector(t));
        for (a, b) in [(0, 0), (1, 1), (0, 1)] {
            let kappa = -tangent[a].dot(gradient * tangent[b]); // (E1)
            out.curvature[pair(a, b)] = out.normal * kappa;
            out.metric[pair(a, b)] = if a == b && a < ntan { 1.0 } else { 0.0 };
        }
        Ok(patch.feature)
    }
}

/// Two orthonormal tangents with `t1 × t2 = ν`.
fn tangents(normal: Vec3) -> [Vec3; 2] {
    let size = |&i: &usize| normal[i].abs();
    let smallest = [0, 1, 2]
        .into_iter()
        .min_by(|i, j| size(i).total_cmp(&size(j)));
    let across = Vec3::unit(smallest.unwrap_or(0)).cross(normal);
    let first = across / across.norm();
    [first, normal.cross(first)]
}

impl ContactSurface for Analytical {
    fn ntan(&self) -> usize {
        self.mount.ntan
    }

    fn nfacet(&self) -> usize {
        1
    }

    fn carrier(&self, _: u32) -> Carrier<'_> {
        self.mount.carrier()
    }

    fn aabb(&self, at: &Placement, _: u32) -> Aabb {
        let ball = self.shape.ball();
        ball.map_or(Aabb::ALL, |(centre, radius)| {
            Aabb::around([self.mount.motion(at).point(centre)]).inflated(radius)
        })
    }

    fn size(&self, _: &Placement, _: u32) -> f64 {
        0.0
    }

    fn jet(
        &self,
        at: &Placement,
        point: &Anchor,
        out: &mut SurfaceJet,
    ) -> Result<(), SurfaceError> {
        if point.facet > 0 {
            return Err(SurfaceError::NoSuchFacet { facet: point.facet });
        }
        self.fill(at, point.local, out).map(|_| ())
    }

    fn domain(&self, _: u32) -> Option<Element> {
        None
    }

    fn neighbours(&self, _: u32) -> &[u32] {
        &[]
    }

    fn crossing(&self, _: &Placement, _: u32, _: Vec3, _: Vec3) -> Option<f64> {
        None
    }

    fn outward(&self, at: &Placement, found: &Projection) -> Result<Outward, SurfaceError> {
        let normal = self.shape.patch(found.anchor.local)?.normal;
        Ok(Outward {
            direction: self.mount.motion(at).vector(normal),
            rim: false,
        })
    }

    fn project(
        &self,
        at: &Placement,
        facet: u32,
        point: Vec3,
        _: Option<Anchor>,
        out: &mut SurfaceJet,
    ) -> Result<Option<Projection>, SurfaceError> {
        if facet > 0 {
            return Err(SurfaceError::NoSuchFacet { facet });
        }
        let initial = self.mount.motion(at).undone(point);
        if !initial.is_finite() {
            return Ok(None);
        }
        let Some(local) = self.shape.closest(initial)? else {
            return Ok(None);
        };
        let feature = self.fill(at, local, out)?;
        Ok(Some(Projection {
            anchor: Anchor { facet, local },
            feature,
            distance: (point - out.position).norm(),
        }))
    }
}

/// The dyad `v vᵀ`.
pub(super) fn dyad(v: Vec3) -> Sym3 {
    Sym3::new(
        v.x * v.x,
        v.y * v.y,
        v.z * v.z,
        v.x * v.y,
        v.y * v.z,
        v.x * v.z,
    )
}

/// Splits the way from an axis' origin to a point: along the axis, away from it, and the unit vector there. `None` on
/// the axis itself.
pub(super) fn polar(from: Vec3, axis: Vec3) -> (f64, Option<(f64, Vec3)>) {
    let along = from.dot(axis);
    let away = from - axis * along;
    (along, away.normalized().map(|e| (away.norm(), e)))
}
