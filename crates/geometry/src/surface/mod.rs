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
//! | r | `point` | [`Vec3`](crate::tensor::Vec3) |
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
mod behind;
mod bent;
mod cone;
mod contact_surface;
mod cylinder;
mod error;
mod extension;
mod facets;
mod keys;
mod mount;
mod placement;
mod plane;
mod point;
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

pub use analytical::{Analytical, Patch, Shape, Side};
pub use behind::{Bodies, bodies};
pub use bent::Bent;
pub use cone::Cone;
pub use contact_surface::ContactSurface;
pub use cylinder::Cylinder;
pub use error::{AnalyticalError, SurfaceError};
pub use extension::{extended_edge, extended_face};
pub use facets::{Extent, Facets, FacetsError};
pub use mount::Mount;
pub use placement::{Carrier, Placement, Pose, RigidId};
pub use plane::Plane;
pub use point::{Anchor, Feature, Outward, Projection, SurfaceJet, pair};
pub use polynomial::{Facing, MAX_DEGREE, Polynomial};
pub use signed_distance::{SignedDistance, UserFunction};
pub use sphere::Sphere;
pub use thickness::Outline;
pub use torus::Torus;
pub use triangulated::Triangulated;

use signorini_vocabulary::{Description, Entry};

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
