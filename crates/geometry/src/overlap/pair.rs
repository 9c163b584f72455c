//! Pairs of facets, places on them, and what counts as touching.

use crate::element::MAX_FACET_NODES;

/// A pair of numbers on the auxiliary plane, or of parameters; the second is zero on a line.
pub type Pair<T> = [T; 2];

/// How far a corner may be from a side and still lie on it, relative to the size of the smaller facet.
pub(super) const TOUCH: f64 = 1e-12;

/// What rounding leaves of a coordinate, relative to the largest.
pub(super) const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// What rules on facets with maps that are not affine may miss of an integral of a shape function, relative to the area.
pub(super) const EXACT: f64 = 1e-12;

/// The same where edges are bent: a hundredth of the sagitta, relative to the size of the facet, and no more than this.
pub(super) const BENT: f64 = 1e-9;

/// Which side of a facet is seen along the normal of the plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facing {
    /// Its normal points to the viewer: that of a secondary facet.
    Same,
    /// Its normal points away: that of a primary facet.
    Opposite,
}

/// Parameters of a place on a facet.
#[derive(Clone, Copy, Debug, Default)]
pub struct Parameters {
    /// ξ.
    pub xi: Pair<f64>,
    /// N_j.
    pub shape: [f64; MAX_FACET_NODES],
    /// ∂N_j/∂p: by the place on the plane.
    pub gradient: [Pair<f64>; MAX_FACET_NODES],
}
