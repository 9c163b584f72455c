//! Contact surfaces: facets of elements and analytical surfaces behind one trait.
//!
//! ```text
//!            ν ▲      r ·                 ρ(ξ)   point of the surface
//!              │   t2 ╱ ┊ g ν             t_a    tangents, ρ_ab curvature vectors
//!              │  ╱     ┊                 ν      unit normal out of the body
//!     ╭────────ρ───────────╮              g      gap, (r − ρ)·ν
//!    ╱          ╲ t1        ╲
//! ```
//!
//! | symbol | name in code | shape |
//! |---|---|---|
//! | r | `point` | [`Vec3`] |
//! | ξ^a | `local` of an [`Anchor`] | `ntan` of 3 entries |
//! | ρ, t_a, ρ_,ab | `position`, `tangent`, `curvature` | 1, 2, 3 ([`pair`]) vectors |
//! | ν, m_ab = t_a·t_b | `normal`, `metric` | vector, 3 ([`pair`]) numbers |
//! | N_i, N_i,a | `shape`, `dshape` | `nnode`, `nnode` × 2 |
//!
//! A contact in the plane is the contact of an extruded curve: `ntan = 1`, the second tangent is `e_z`, and
//! `ν = t × e_z = (t_y, −t_x, 0)/|t|`, so that a boundary run counter-clockwise round its body has its normal outside.
//!
//! A surface answers in one call, [`ContactSurface::jet`], with everything of second order at a point; nobody asks it
//! for a normal, then a tangent, then a gap. [`ContactSurface::project`] is provided for every surface whose
//! parameters run over the domain of a reference element.
//!
//! | surface | closest point | closed shapes by [`Side`] |
//! |---|---|---|
//! | [`Facets`]: faces of solids, edges in the plane | Newton on faces, edges, vertices | |
//! | [`Triangulated`]: rigid triangles, as of an STL file | as [`Facets`] | |
//! | [`Plane`]; a line | closed form | |
//! | [`Sphere`]; a circle | closed form | • |
//! | [`Cylinder`]; a circle or a strip | closed form | • |
//! | [`Cone`], with its apex; a wedge | closed form | • |
//! | [`Torus`]; two circles | closed form | • |
//! | [`Polynomial`] `y = f(x)`; extruded in space | the best of all roots | [`Facing`] |
//! | [`SignedDistance`], φ of the user | Newton on the surface | |
//!
//! The rigid ones stand on a [`Mount`], fixed or carried by a rigid body, and are given in the initial configuration.
//! From [`Plane`] on they are a [`Shape`] each, of which [`Analytical`] makes a surface.
//!
//! To add a shape: a file that implements [`Shape`] and describes its keys in an `ENTRY`, a line above and in [`TABLE`],
//! and a line in the tests. Cases can name it then. To add another surface: a file that implements [`ContactSurface`]. Its
//! `jet` is checked by the conformance tests of this room against differences, its `project` against brute force.
//!
//! Sources: Wriggers, *Computational Contact Mechanics*, 2nd ed. 2006, chapters 2 and 4; Konyukhov and Schweizerhof,
//! *Computational Contact Mechanics*, 2013, chapters 2 to 4; Bærentzen and Aanæs, IEEE TVCG 11, 2005 (pseudonormals).

mod analytical;
mod bent;
mod cone;
mod cylinder;
mod facets;
mod keys;
mod mount;
mod plane;
mod polynomial;
mod projection;
mod ray;
mod signed_distance;
mod sphere;
#[cfg(test)]
mod tests;
mod thickness;
mod torus;
mod triangulated;

pub use analytical::{Analytical, AnalyticalError, Patch, Shape, Side};
pub use bent::Bent;
pub use cone::Cone;
pub use cylinder::Cylinder;
pub use facets::{Facets, FacetsError};
pub use mount::Mount;
pub use plane::Plane;
pub use polynomial::{Facing, MAX_DEGREE, Polynomial};
pub use projection::{extended_edge, extended_face};
pub use signed_distance::{SignedDistance, UserFunction};
pub use sphere::Sphere;
pub use thickness::Outline;
pub use torus::Torus;
pub use triangulated::Triangulated;

use crate::element::{Element, MAX_FACET_NODES};
use crate::mesh::NodeId;
use crate::proximity::Aabb;
use crate::tensor::{Mat3, Vec3};
use signorini_vocabulary::{Description, Entry};
use thiserror::Error;

/// The shapes that a case may choose by name.
pub static TABLE: [Entry<Box<dyn Shape>, AnalyticalError>; 7] = [
    plane::ENTRY,
    sphere::CIRCLE,
    sphere::ENTRY,
    cylinder::ENTRY,
    cone::ENTRY,
    torus::ENTRY,
    polynomial::ENTRY,
];

/// The names and keys of all shapes of [`TABLE`].
#[must_use]
pub fn descriptions() -> Vec<Description> {
    TABLE.iter().map(|entry| entry.description).collect()
}

/// The number of a rigid body, from 0.
pub type RigidId = u32;

/// Where a rigid body is: its reference point and its rotation from the initial configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Present position of the reference point.
    pub origin: Vec3,
    /// Rotation since the start; a body vector `a` has become `rotation · a`.
    pub rotation: Mat3,
}

/// The configuration, as far as geometry may see it.
#[derive(Clone, Copy, Debug)]
pub struct Placement<'a> {
    /// Positions of all nodes.
    pub x: &'a [Vec3],
    /// Poses of all rigid bodies.
    pub poses: &'a [Pose],
}

/// What moves a facet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Carrier<'a> {
    /// Nodes, weighted by the shape functions of the jet.
    Nodes(&'a [NodeId]),
    /// A rigid body: 6 unknowns, 3 in the plane.
    Rigid(RigidId),
    /// Nothing: the facet is fixed in space.
    Fixed,
}

/// A material point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// Number of the facet.
    pub facet: u32,
    /// `(ξ1, ξ2, 0)`, or a point in the body frame where a surface has poles.
    pub local: Vec3,
}

/// On which kind of place a closest point lies, and with that, along which directions it is free to move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Feature {
    /// Inside a facet: free along all tangents.
    Face,
    /// On an edge: free along the edge, whose tangent is `Σ t_a direction[a]`.
    Edge {
        /// Change of (ξ1, ξ2) along the edge.
        direction: [f64; 2],
    },
    /// On a vertex: not free.
    Vertex,
}

/// A closest point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// Where on the surface.
    pub anchor: Anchor,
    /// On what.
    pub feature: Feature,
    /// Distance from the point that was projected, ≥ 0.
    pub distance: f64,
}

/// What lies outside at a point of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outward {
    /// A direction out of the body; on an edge or vertex the angle-weighted sum of the facets' normals.
    pub direction: Vec3,
    /// Whether the surface ends here.
    pub rim: bool,
}

/// Where the pair of tangents `(a, b)` is stored in a triple: `11, 22, 12`.
#[inline]
#[must_use]
pub const fn pair(a: usize, b: usize) -> usize {
    if a == b { a } else { 2 }
}

/// Position, tangents, curvature, normal and metric of a surface at one point, and the weights of its nodes there.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceJet {
    /// ρ.
    pub position: Vec3,
    /// t_1, t_2; in the plane t_2 is zero.
    pub tangent: [Vec3; 2],
    /// ρ_,11, ρ_,22, ρ_,12.
    pub curvature: [Vec3; 3],
    /// ν, of length 1, out of the body.
    pub normal: Vec3,
    /// m_11, m_22, m_12.
    pub metric: [f64; 3],
    /// The number of nodes that carry the facet, 0 where it is not carried by nodes.
    pub nnode: usize,
    /// N_i.
    pub shape: [f64; MAX_FACET_NODES],
    /// N_i,1 and N_i,2.
    pub dshape: [[f64; 2]; MAX_FACET_NODES],
}

impl Default for SurfaceJet {
    fn default() -> Self {
        Self {
            position: Vec3::ZERO,
            tangent: [Vec3::ZERO; 2],
            curvature: [Vec3::ZERO; 3],
            normal: Vec3::ZERO,
            metric: [0.0; 3],
            nnode: 0,
            shape: [0.0; MAX_FACET_NODES],
            dshape: [[0.0; 2]; MAX_FACET_NODES],
        }
    }
}

/// What a surface cannot answer.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SurfaceError {
    /// The tangents of a facet are parallel, zero or not finite: it has no normal.
    #[error("facet {facet} has no normal: it is folded to a line or a point")]
    Degenerate {
        /// Number of the facet.
        facet: u32,
    },
    /// A facet that does not exist.
    #[error("facet {facet} does not exist")]
    NoSuchFacet {
        /// Number of the facet.
        facet: u32,
    },
    /// A surface of a model of the plane whose normal is not in it.
    #[error("the normal of facet {facet} leaves the plane of the model")]
    OutOfPlane {
        /// Number of the facet.
        facet: u32,
    },
    /// A facet of an element whose shape functions have no dual basis.
    #[error("facet {facet} is a {element}, for which mortar contact has no dual basis")]
    NoDualBasis {
        /// Number of the facet.
        facet: u32,
        /// The name of its element.
        element: &'static str,
    },
    /// A surface given by the user's own code failed.
    #[error("the user's surface failed: {message}")]
    User {
        /// What it said.
        message: String,
    },
}

/// A point of a shape at which it has no normal.
const NO_NORMAL: SurfaceError = SurfaceError::Degenerate { facet: 0 };

/// A surface that points can touch. Facets of elements and analytical surfaces alike.
pub trait ContactSurface: Send + Sync {
    /// The number of tangents: 2 in space, 1 in the plane.
    fn ntan(&self) -> usize;

    /// The number of facets; an analytical surface has one.
    fn nfacet(&self) -> usize;

    /// What moves a facet.
    fn carrier(&self, facet: u32) -> Carrier<'_>;

    /// A box around the facet; unbounded for an infinite surface.
    fn aabb(&self, at: &Placement, facet: u32) -> Aabb;

    /// A length that stands for the size of the facet: the root of its area, its length in the plane.
    fn size(&self, at: &Placement, facet: u32) -> f64;

    /// Everything of second order at a point of the surface.
    ///
    /// # Errors
    /// The facet does not exist or has no normal there.
    fn jet(&self, at: &Placement, point: &Anchor, out: &mut SurfaceJet)
    -> Result<(), SurfaceError>;

    /// The reference element over whose domain the parameters of a facet run; `None` for an analytical surface, which
    /// then brings its own [`ContactSurface::project`].
    fn domain(&self, facet: u32) -> Option<Element>;

    /// Every facet that shares at least one node with this one, without itself, sorted.
    fn neighbours(&self, facet: u32) -> &[u32];

    /// The outward direction at a closest point, with the facets around an edge or vertex taken into account.
    ///
    /// # Errors
    /// As [`ContactSurface::jet`].
    fn outward(&self, at: &Placement, found: &Projection) -> Result<Outward, SurfaceError>;

    /// The closest point of one facet, with its jet in `out`. `None` where there is none, such as at the centre of a
    /// sphere. `hint` is a point that was closest a moment ago.
    ///
    /// # Errors
    /// As [`ContactSurface::jet`].
    fn project(
        &self,
        at: &Placement,
        facet: u32,
        point: Vec3,
        hint: Option<Anchor>,
        out: &mut SurfaceJet,
    ) -> Result<Option<Projection>, SurfaceError> {
        projection::closest(self, at, facet, point, hint, out)
    }

    /// The smallest `s ≥ 0` at which the line `origin + s direction` crosses a facet; `None` where it does not, and on
    /// surfaces that are not made of facets of elements.
    fn crossing(&self, at: &Placement, facet: u32, origin: Vec3, direction: Vec3) -> Option<f64>;
}
