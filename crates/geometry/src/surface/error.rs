//! What a surface cannot answer, and why one cannot be made.

use signorini_vocabulary::Fault;
use thiserror::Error;

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
    /// A shape answers with a point or normal that is no number; its gap would look like that of an open contact.
    #[error("the closest point of the surface, or its normal there, is not finite")]
    NotFinite,
    /// A surface given by the user's own code failed.
    #[error("the user's surface failed: {message}")]
    User {
        /// What it said.
        message: String,
    },
}

/// A point of a shape at which it has no normal.
pub(super) const NO_NORMAL: SurfaceError = SurfaceError::Degenerate { facet: 0 };

/// Why a rigid surface cannot be made.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum AnalyticalError {
    /// An infinite component, or not a number.
    #[error("{what} must be finite")]
    NotFinite {
        /// Of what.
        what: &'static str,
    },
    /// A length that is no length.
    #[error("{what} is {value}; it must be positive and finite")]
    NotPositive {
        /// Of what.
        what: &'static str,
        /// What it is.
        value: f64,
    },
    /// A direction without length.
    #[error("{what} is zero; it must be a direction")]
    NoDirection {
        /// Of what.
        what: &'static str,
    },
    /// A cone that is a line or a plane.
    #[error("the half angle is {degrees}°; it must lie between 0° and 90°")]
    HalfAngle {
        /// What it is.
        degrees: f64,
    },
    /// A torus that runs into itself.
    #[error("the tube's radius is {tube}; it must be smaller than that of the ring, {radius}")]
    Tube {
        /// Of the ring.
        radius: f64,
        /// Of the tube.
        tube: f64,
    },
    /// A polynomial of nothing.
    #[error("there are no coefficients; a constant polynomial has one")]
    NoCoefficients,
    /// A polynomial that oscillates beyond what can be computed.
    #[error("the polynomial is of degree {degree}; {most} is the most")]
    Degree {
        /// What it is.
        degree: usize,
        /// The most.
        most: usize,
    },
    /// A shape that is no curve of the plane.
    #[error("in a model of the plane {wanted}")]
    OutOfPlane {
        /// What is needed.
        wanted: &'static str,
    },
    /// A number of tangents that is neither that of the plane nor that of space.
    #[error("a surface has 1 tangent in the plane and 2 in space, not {ntan}")]
    Tangents {
        /// What it is.
        ntan: usize,
    },
    /// Nothing to make it of.
    #[error("the surface has no triangles")]
    NoTriangles,
    /// A triangle of a point that is not there.
    #[error("triangle {triangle} has point {point}, but there are {npoint} points, from 0")]
    NoSuchPoint {
        /// Its number, from 1.
        triangle: usize,
        /// Its point, from 0.
        point: u32,
        /// How many there are.
        npoint: usize,
    },
    /// A triangle without area.
    #[error("triangle {triangle} has no area: its corners lie on a line")]
    Flat {
        /// Its number, from 1.
        triangle: usize,
    },
    /// Values of a case that make no shape.
    #[error(transparent)]
    Values(#[from] Fault),
    /// Two triangles that disagree on where outside is, or more than two on one edge.
    #[error(
        "triangles {first} and {second} run along their common edge in the same direction: either one of them is turned \
         inside out or more than two meet there"
    )]
    SameWay {
        /// Number of one, from 1.
        first: usize,
        /// Number of the other, from 1.
        second: usize,
    },
}
