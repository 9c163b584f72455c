//! Places inside facets.

use signorini_geometry::tensor::Vec3;

/// A point inside a facet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnFacet {
    /// The facet.
    pub facet: u32,
    /// Where on it, in its parameters.
    pub xi: Vec3,
    /// Its weight: of the facet's measure in its parameters.
    pub weight: f64,
    /// Whether no facet of the other side is opposite, for the increment that it is made for.
    pub apart: bool,
}

impl OnFacet {
    pub(super) const fn new(facet: u32, (xi, weight): (Vec3, f64), apart: bool) -> Self {
        Self {
            facet,
            xi,
            weight,
            apart,
        }
    }
}
