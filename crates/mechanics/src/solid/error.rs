//! Why cells make no body.

use super::Locking;
use thiserror::Error;

/// Why a body cannot be made.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SolidError {
    /// An element that is no solid in this space.
    #[error("element {label} of body \"{body}\" is a {element}: no solid in {ndim} dimensions")]
    NotSolid {
        /// Name of the body.
        body: String,
        /// Number of the element in the input.
        label: u64,
        /// Its type.
        element: &'static str,
        /// Dimension of the problem.
        ndim: usize,
    },
    /// A solid-shell whose nodes are not at the ends of directors.
    #[error("element {label} of shell \"{body}\" has a node at the end of no director")]
    NoDirector {
        /// Name of the body.
        body: String,
        /// Number of the element in the input.
        label: u64,
    },
    /// An element that is no bar.
    #[error("element {label} of truss \"{body}\" is a {element}: bars are line2 or line3")]
    NotBar {
        /// Name of the body.
        body: String,
        /// Number of the element in the input.
        label: u64,
        /// Its type.
        element: &'static str,
    },
    /// A bar without length or a body without cross-section.
    #[error("element {label} of truss \"{body}\" has no {what}")]
    NoSize {
        /// Name of the body.
        body: String,
        /// Number of the element in the input.
        label: u64,
        /// Length, or cross-section.
        what: &'static str,
    },
    /// A bar in an axisymmetric model.
    #[error("truss \"{body}\" is in an axisymmetric model: bars exist in space and in the plane")]
    BarOfRevolution {
        /// Name of the body.
        body: String,
    },
    /// A stress at the start at a point that is not there.
    #[error(
        "element {label} of body \"{body}\", a {element}, has {npoint} points: there is no point {point}"
    )]
    NoPoint {
        /// Name of the body.
        body: String,
        /// Number of the element in the input.
        label: u64,
        /// Its type.
        element: &'static str,
        /// How many there are.
        npoint: usize,
        /// The one that was named, from 1.
        point: usize,
    },
    /// A material that takes the place of one with another history.
    #[error(
        "body \"{body}\" changes to a material that remembers other things than the one before"
    )]
    OtherHistory {
        /// Name of the body.
        body: String,
    },
    /// A remedy that an element does not have.
    #[error(
        "locking = \"{locking}\" is not possible for the {element} of body \"{body}\": {reason}"
    )]
    Locking {
        /// Name of the body.
        body: String,
        /// Type of the elements.
        element: &'static str,
        /// What was asked for.
        locking: Locking,
        /// Why it cannot be had.
        reason: &'static str,
    },
    /// An element that no method conserves the energy of.
    #[error(
        "no form of the {element} of \"{body}\" {what} conserves energy: write  method = \"generalized-alpha\""
    )]
    NotConserving {
        /// Name of the body.
        body: String,
        /// Type of the elements.
        element: &'static str,
        /// What is in the way.
        what: String,
    },
    /// A point on the axis of a cylindrical system.
    #[error(
        "element {label} of body \"{body}\" has an integration point on the axis of its cylindrical orientation: no direction is radial there"
    )]
    OnAxis {
        /// Name of the body.
        body: String,
        /// Number of the element in the input.
        label: u64,
    },
    /// An axisymmetric element that reaches beyond the axis.
    #[error(
        "element {label} of body \"{body}\" reaches to the radius {radius:.6e}: in an axisymmetric model x is the radius, 0 or more"
    )]
    Radius {
        /// Name of the body.
        body: String,
        /// Number of the element in the input.
        label: u64,
        /// The radius.
        radius: f64,
    },
}
