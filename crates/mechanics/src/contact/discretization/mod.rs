//! How two sides are compared: where the gap is measured, and on what the traction acts.
//!
//! | discretization | a row is | file |
//! |---|---|---|
//! | node to segment, point to segment | a node, or a point of a facet, against its closest point | [`points`], [`projected`] |
//! | node to node | two nodes and a normal | [`nodes`] |
//! | mortar | a node of the secondary side, with all facets around it against all that they meet | [`mortar`] |
//!
//! To add a discretization: one file that implements [`Discretization`], one line where models are built. It fills rows
//! and never sees a law, a penalty or an unknown.

mod capabilities;
mod cut;
mod lean;
pub mod mortar;
pub mod nodes;
mod on_facet;
mod own;
mod pair;
mod point;
pub mod points;
pub mod projected;
mod reach;
mod self_contact;
mod sizes;
mod wall;

pub use capabilities::{
    Averaged, Capabilities, Curved, HeldAxes, Links, OnRow, Renewable, SlidingRange,
};
pub use cut::{Cutter, FacetPoints};
pub use lean::Lean;
pub use mortar::Mortar;
pub use nodes::{NodeNormals, NodeToNode};
pub use on_facet::OnFacet;
pub use own::{OwnBody, OwnNow, OwnPoint};
pub use pair::{Anchored, BentSides, NOWHERE, Pair, Pairing, SurfacePair};
pub use points::{PointToSegment, areas_inside};
pub use reach::{REACH, local_reach};
pub use sizes::FacetSizes;
pub use wall::Wall;

use super::row::{RowOrder, Rows, Wanted};
use projected::Point;
use signorini_geometry::proximity::Search;
use signorini_geometry::surface::{Placement, SurfaceError};
use signorini_geometry::tensor::Vec3;

/// A way to compare two sides.
pub trait Discretization: Send + Sync {
    /// The number of rows, the key of history and multipliers; fixed unless rows are [`Renewable`].
    fn nrow(&self) -> usize;

    /// The point of a row; what the search looks around.
    fn point(&self, row: usize) -> Point<'_>;

    /// What the rest of contact needs to know of it, and what it can do beyond rows.
    fn capabilities(&self) -> Capabilities<'_>;

    /// [`Capabilities::averaged`], to be changed.
    fn averaged_mut(&mut self) -> Option<&mut dyn Averaged>;

    /// [`Capabilities::renewable`], to be changed.
    fn renewable_mut(&mut self) -> Option<&mut dyn Renewable>;

    /// Makes all discrete choices at a configuration. `last` holds the previous choices, as hints; `next` is what
    /// will probably be asked of rows.
    ///
    /// # Errors
    /// A facet that has no normal.
    fn pair_up(
        &self,
        pair: &SurfacePair,
        at: &Placement,
        near: &Search,
        last: &Pairing,
        next: RowOrder,
        out: &mut Pairing,
    ) -> Result<(), SurfaceError>;

    /// Fills one row, and sets which of its participants are those of the secondary side; leaves `out` without rows where
    /// nothing is near.
    ///
    /// # Errors
    /// A facet that has no normal.
    fn row(
        &self,
        row: usize,
        pair: &SurfacePair,
        at: &Placement,
        links: &Links<'_>,
        wanted: Wanted,
        out: &mut Rows,
    ) -> Result<(), SurfaceError>;

    /// Where a row sticks whose point has yielded by `slip` from there.
    ///
    /// # Errors
    /// A facet that has no normal.
    fn anchor(
        &self,
        row: usize,
        pair: &SurfacePair,
        at: &Placement,
        found: &Pair,
        slip: Vec3,
    ) -> Result<Anchored, SurfaceError>;
}
