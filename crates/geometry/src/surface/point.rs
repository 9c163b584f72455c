//! A point of a surface: where it is, what it lies on, and the surface around it to second order.

use crate::element::MAX_FACET_NODES;
use crate::tensor::Vec3;

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
