//! How two sides are compared: where the gap is measured, and on what the traction acts.
//!
//! To add a discretization: one file that implements [`Discretization`], one line where cases are built. It fills rows
//! and never sees a law, a penalty or an unknown.

pub mod node_to_segment;

pub use node_to_segment::NodeToSegment;

use super::row::Rows;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::proximity::Candidates;
use signorini_geometry::surface::{
    Anchor, ContactSurface, Facets, Feature, Placement, SurfaceError,
};
use signorini_geometry::tensor::Vec3;

/// How far rows are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum RowOrder {
    /// Gap and normal.
    Gap,
    /// And what a force needs: gradient and weights.
    Gradient,
    /// And what a tangent needs: the derivative of the weights.
    Tangent,
}

/// The two sides of an interface.
pub struct SurfacePair {
    /// Nodes of the secondary side, sorted.
    pub points: Vec<NodeId>,
    /// Its facets; none where it is bare nodes.
    pub secondary: Option<Facets>,
    /// The side that is projected onto.
    pub primary: Box<dyn ContactSurface>,
    /// The distance up to which a closest point counts.
    pub reach: f64,
}

/// The discrete choices of one row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// The closest point of the primary side.
    pub anchor: Anchor,
    /// On what it lies.
    pub feature: Feature,
    /// Signed distance: negative where the point has passed through the surface.
    pub gap: f64,
}

impl Pair {
    /// Whether the point has passed through the surface.
    #[must_use]
    pub fn inside(&self) -> bool {
        self.gap < 0.0
    }

    /// Whether the discrete choices are the same.
    #[must_use]
    pub fn agrees(&self, other: &Self) -> bool {
        self.inside() == other.inside()
            && self.anchor.facet == other.anchor.facet
            && std::mem::discriminant(&self.feature) == std::mem::discriminant(&other.feature)
    }
}

/// The discrete choices of all rows: `None` where nothing is within reach.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pairing {
    /// One entry for each row.
    pub pairs: Vec<Option<Pair>>,
}

/// A way to compare two sides.
pub trait Discretization: Send + Sync {
    /// The number of rows, fixed: the key of history and multipliers.
    fn nrow(&self) -> usize;

    /// The point whose distance each row measures first: what the search looks around.
    fn point(&self, row: usize, pair: &SurfacePair, at: &Placement) -> Vec3;

    /// Makes all discrete choices at a configuration. `last` holds the choices of a moment ago, as hints.
    ///
    /// # Errors
    /// A facet that has no normal.
    fn pair_up(
        &self,
        pair: &SurfacePair,
        at: &Placement,
        near: &Candidates,
        last: &Pairing,
        out: &mut Pairing,
    ) -> Result<(), SurfaceError>;

    /// The number of groups of rows.
    fn ngroup(&self, pairing: &Pairing) -> usize;

    /// Fills the rows of one group; leaves `out` without rows where nothing touches.
    ///
    /// # Errors
    /// A facet that has no normal.
    fn rows(
        &self,
        group: usize,
        pair: &SurfacePair,
        at: &Placement,
        pairing: &Pairing,
        order: RowOrder,
        out: &mut Rows,
    ) -> Result<(), SurfaceError>;
}
