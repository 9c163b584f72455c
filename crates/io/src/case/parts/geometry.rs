//! The mesh, the model, sets.

use super::Name;
use crate::diagnostic::{Place, Spanned};
use signorini_geometry::tensor::Vec3;

/// Where nodes and elements come from.
#[derive(Clone, Debug, PartialEq)]
pub enum MeshSource {
    /// A file, relative to the case.
    File {
        /// Its path.
        path: Spanned<String>,
    },
    /// The case itself.
    Inline {
        /// Number and position of each node; in the plane the third coordinate is zero.
        nodes: Vec<(u64, [f64; 3])>,
        /// The elements.
        elements: Vec<InlineElement>,
        /// Where the nodes were written.
        place: Place,
    },
}

/// An element written in the case.
#[derive(Clone, Debug, PartialEq)]
pub struct InlineElement {
    /// Its number.
    pub id: u64,
    /// The name of its type, as in `hex8`.
    pub element_type: Spanned<String>,
    /// The group it belongs to.
    pub group: Option<Spanned<String>>,
    /// The numbers of its nodes.
    pub nodes: Vec<u64>,
    /// Where it was written.
    pub place: Place,
}

/// Dimension of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Space or plane.
    pub space: Spanned<Space>,
    /// Thickness of a plane model (length); 1 in space and of a body of revolution.
    pub thickness: f64,
}

/// Space or plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Space {
    /// Three dimensions.
    #[default]
    ThreeD,
    /// Two dimensions without strain along the third.
    PlaneStrain,
    /// Two dimensions without stress along the third.
    PlaneStress,
    /// A body of revolution: x is the radius, y the axis.
    Axisymmetric,
}

impl Space {
    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::ThreeD,
        Self::PlaneStrain,
        Self::PlaneStress,
        Self::Axisymmetric,
    ];

    /// Its name in a case.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::ThreeD => "3d",
            Self::PlaneStrain => "plane-strain",
            Self::PlaneStress => "plane-stress",
            Self::Axisymmetric => "axisymmetric",
        }
    }

    /// Whether bodies of both can be in one model: a ring stretches along its circumference, where plane strain allows no
    /// strain.
    #[must_use]
    pub fn goes_with(self, other: Self) -> bool {
        let pair = [self, other];
        let mixed = pair.contains(&Self::Axisymmetric) && pair.contains(&Self::PlaneStrain);
        self.ndim() == other.ndim() && !mixed
    }

    /// Whether a thickness means something.
    pub fn has_thickness(self) -> bool {
        matches!(self, Self::PlaneStrain | Self::PlaneStress)
    }

    /// Displacements of a node.
    pub fn ndim(self) -> usize {
        match self {
            Self::ThreeD => 3,
            Self::PlaneStrain | Self::PlaneStress | Self::Axisymmetric => 2,
        }
    }
}

/// A named set.
#[derive(Clone, Debug, PartialEq)]
pub struct Set {
    /// Its name.
    pub name: Name,
    /// What is in it.
    pub content: SetContent,
    /// Where the content was written.
    pub place: Place,
}

/// What is in a set.
#[derive(Clone, Debug, PartialEq)]
pub enum SetContent {
    /// Nodes, by their numbers.
    Nodes(Vec<u64>),
    /// Elements, by their numbers.
    Elements(Vec<u64>),
    /// Faces, by the number of their element and a side of it.
    Faces(Vec<(u64, Side)>),
    /// Everything in other sets or groups.
    Union(Vec<Name>),
    /// The nodes of a part of space, and with them the whole outer faces between them.
    Region {
        /// Where.
        region: Region,
        /// Among the nodes of this body or group only.
        of: Option<Name>,
    },
}

/// A part of space; all lengths in the unit of the case.
#[derive(Clone, Debug, PartialEq)]
pub enum Region {
    /// What lies in a plane: `|n·x − at| ≤ tol` with the unit vector `n` along `normal`.
    Plane {
        /// Along the normal; not a zero vector, of any length.
        normal: [f64; 3],
        /// Distance of the plane from the origin, along the normal.
        at: f64,
        /// How far from the plane; none: 1e-6 of the size of the mesh.
        tol: Option<f64>,
    },
    /// What lies in a box between two corners, boundary included.
    Box {
        /// The smallest coordinates.
        low: [f64; 3],
        /// The largest coordinates.
        high: [f64; 3],
    },
    /// What lies in a sphere, boundary included.
    Sphere {
        /// Its centre.
        center: [f64; 3],
        /// Its radius.
        radius: f64,
    },
    /// The node nearest to a point.
    Near {
        /// The point.
        point: [f64; 3],
    },
}

/// Local axes of some nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct LocalAxes {
    /// The nodes.
    pub set: Name,
    /// How the axes lie.
    pub system: AxesSystem,
    /// Where it was written.
    pub place: Place,
}

/// How local axes lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AxesSystem {
    /// The same everywhere.
    Rectangular {
        /// A vector along the first.
        x: [f64; 3],
        /// A vector in the plane of the first and the second.
        xy: [f64; 3],
    },
    /// Radial, circumferential and along an axis through two points.
    Cylindrical {
        /// The one.
        from: [f64; 3],
        /// The other.
        to: [f64; 3],
    },
}

/// The distance of a point on an axis, over lengths around it.
const ON_AXIS: f64 = 1e-10;

impl AxesSystem {
    /// Three unit vectors at right angles at a place; none where vectors are parallel or points coincide. On the axis of a
    /// cylindrical system any direction is radial. Taken is the one that CalculiX takes, as nodes there show: of global
    /// axes in their order, let the first that the axis is not square to be k; the direction is square to the axis and
    /// lies in the plane of k and the axis after k, along which it goes forward.
    #[must_use]
    pub fn at(&self, place: Vec3) -> Option<[Vec3; 3]> {
        let (first, third) = match *self {
            Self::Rectangular { x, xy } => {
                let first = Vec3::from(x).normalized()?;
                (first, first.cross(Vec3::from(xy)).normalized()?)
            }
            Self::Cylindrical { from, to } => {
                let (from, to) = (Vec3::from(from), Vec3::from(to));
                let along = (to - from).normalized()?;
                let out = place - from;
                let across = |v: Vec3| v - along * v.dot(along);
                let radial = across(out);
                let near = ON_AXIS * (to - from).norm().max(out.norm());
                let radial = if radial.norm() > near {
                    radial
                } else {
                    let k = (0..3).find(|&k| along[k].abs() > ON_AXIS)?;
                    let next = (k + 1) % 3;
                    Vec3::unit(next) - Vec3::unit(k) * (along[next] / along[k])
                };
                (radial.normalized()?, along)
            }
        };
        Some([first, third.cross(first), third])
    }
}

/// A named point with translations and rotations of its own: six in space, three in the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Its name.
    pub name: Name,
    /// Where it is at the start.
    pub position: Position,
    /// A node that stands for its rotations in printed tables.
    pub rotations: Option<u64>,
    /// Where it was written.
    pub place: Place,
}

/// Where a reference is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Position {
    /// At these coordinates.
    At([f64; 3]),
    /// Where the node of this number is.
    Node(u64),
    /// In the mean of the nodes that move with it, or that it follows.
    Mean,
}

/// A side of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Side `S1`, `S2`, … in the numbering of Abaqus.
    Numbered(u8),
    /// The side whose outward normal lies along an axis.
    Axis(Axis, Sense),
}

/// An axis of the global frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

/// Along an axis or against it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// Along it.
    Plus,
    /// Against it.
    Minus,
}

/// A tensor at an integration point.
#[derive(Clone, Debug, PartialEq)]
pub struct AtPoint {
    /// The number of its element.
    pub element: u64,
    /// Its number in the element, from 1.
    pub point: u64,
    /// xx, yy, zz, xy, xz, yz.
    pub value: [f64; 6],
    /// Where it was written.
    pub place: Place,
}
