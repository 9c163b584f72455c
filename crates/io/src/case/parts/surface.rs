//! Rigid surfaces that are given by a formula or by triangles.

use super::Name;
use crate::diagnostic::{Place, Spanned};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;

/// A rigid surface without a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Its name.
    pub name: Name,
    /// What it is.
    pub shape: Shape,
    /// The reference it moves with; none: fixed in space.
    pub reference: Option<Name>,
    /// The triangles of its file, once it is read.
    pub triangles: Option<Triangles>,
    /// Where it was written.
    pub place: Place,
}

/// The shape of a surface, at the start. Directions are of any length but zero; in the plane all z are zero.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A plane; a line in the plane.
    Plane {
        /// A point of it.
        point: [f64; 3],
        /// Towards the bodies.
        normal: [f64; 3],
    },
    /// A sphere; a circle in the plane.
    Sphere {
        /// Its centre.
        center: [f64; 3],
        /// Its radius, positive.
        radius: f64,
        /// Where bodies are.
        facing: Facing,
    },
    /// A cylinder without ends.
    Cylinder {
        /// A point of its axis.
        point: [f64; 3],
        /// Along the axis.
        axis: [f64; 3],
        /// Its radius, positive.
        radius: f64,
        /// Where bodies are.
        facing: Facing,
    },
    /// A cone without end; bodies are outside.
    Cone {
        /// Its tip.
        apex: [f64; 3],
        /// From the tip into the cone.
        axis: [f64; 3],
        /// Between the axis and the surface, in degrees, between 0 and 90.
        half_angle: f64,
    },
    /// A ring with a round section.
    Torus {
        /// Its centre.
        center: [f64; 3],
        /// Along the axis.
        axis: [f64; 3],
        /// From the axis to the middle of the tube.
        radius: f64,
        /// Radius of the tube: positive, less than the other.
        tube: f64,
        /// Where bodies are.
        facing: Facing,
    },
    /// The curve y = c_n x^n + … + c_0, the same for all z.
    Polynomial {
        /// c_n to c_0, at least one.
        coefficients: Vec<f64>,
        /// Whether bodies are above it, that is at larger y.
        above: bool,
    },
    /// Triangles, whose normals point to the bodies.
    Stl {
        /// Path of their file, relative to the case.
        path: Spanned<String>,
    },
}

/// Triangles: points, and the corners of each triangle among them.
pub type Triangles = (Vec<Vec3>, Vec<[NodeId; 3]>);

/// Where bodies are, of a closed surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Facing {
    /// Around it.
    #[default]
    Outside,
    /// In it.
    Inside,
}
