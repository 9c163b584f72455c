//! Rigid surfaces that are given by a formula or by triangles.

use super::Name;
use crate::diagnostic::{Place, Spanned};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;
use signorini_vocabulary::Chosen;

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

/// The shape of a surface, at the start.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A formula, by its name in the vocabulary, with the values of its keys.
    Analytical(Chosen),
    /// Triangles, whose normals point to the bodies.
    Stl {
        /// Path of their file, relative to the case.
        path: Spanned<String>,
    },
}

/// Triangles: points, and the corners of each triangle among them.
pub type Triangles = (Vec<Vec3>, Vec<[NodeId; 3]>);
