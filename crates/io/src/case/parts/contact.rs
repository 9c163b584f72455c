//! Contacts.

use super::Name;
use crate::diagnostic::{Place, Spanned};

/// A pair of surfaces that may touch.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Its name.
    pub name: Name,
    /// The side that carries the points.
    pub secondary: Name,
    /// The side that is projected onto.
    pub primary: Name,
    /// How the two sides are discretized.
    pub method: Spanned<Method>,
    /// How penetration is prevented.
    pub enforcement: Enforcement,
    /// Coulomb's coefficient of friction.
    pub friction: Spanned<f64>,
    /// How far from each other the sides are searched (length); none: found by the program.
    pub reach: Option<f64>,
    /// Whether it acts from the first step on.
    pub active: bool,
    /// Where it was written.
    pub place: Place,
}

/// How the two sides of a contact are discretized.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The program chooses.
    #[default]
    Auto,
    /// Nodes of the secondary side against segments of the primary side.
    NodeToSegment,
}

/// How penetration is prevented.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Enforcement {
    /// The program chooses.
    #[default]
    Auto,
    /// A pressure or force proportional to the penetration.
    Penalty {
        /// The factor; none: from the stiffness behind the surface.
        penalty: Option<Spanned<f64>>,
        /// Per node (force per length) or per area (stress per length); none: by what the secondary side is.
        per: Option<Per>,
    },
}

/// What a penalty refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Per {
    /// A node of the secondary side.
    Node,
    /// Its area.
    Area,
}
