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

mod cut;
mod lean;
pub mod mortar;
pub mod nodes;
mod own;
pub mod points;
pub mod projected;
mod reach;

pub use cut::{Cutter, FacetPoints};
pub use mortar::Mortar;
pub use nodes::{NodeNormals, NodeToNode};
pub use own::{OwnBody, OwnNow, OwnPoint};
pub use points::{OnFacet, PointToSegment, SlidingRange, areas_inside};
pub use reach::{FacetSizes, REACH, local_reach};

use super::mortar::Weights;
use super::row::{RowOrder, Rows, Wanted};
use projected::Point;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::proximity::Search;
use signorini_geometry::surface::{
    Anchor, Bent, ContactSurface, Facets, Feature, Placement, SurfaceError,
};
use signorini_geometry::tensor::Vec3;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// The axes along which nodes are held; those of no node that is not.
pub type HeldAxes = HashMap<NodeId, [bool; 3]>;

/// The two sides of an interface.
pub struct SurfacePair {
    /// Nodes of the secondary side, sorted.
    pub points: Vec<NodeId>,
    /// Its facets; none where it is bare nodes.
    pub secondary: Option<Facets>,
    /// The side that is projected onto.
    pub primary: Arc<dyn ContactSurface>,
    /// The distance beyond which no closest point counts; what counts within it is [local](Self::reach_between).
    pub reach: f64,
    /// Sizes of facets, where the reach is local; empty where it is the same everywhere.
    pub sizes: FacetSizes,
    /// Positions of all nodes when the increment began; empty where they are not known.
    pub start: Vec<Vec3>,
    /// Whether both sides are one.
    pub same: bool,
    /// The body behind a surface that may touch itself.
    pub own: Option<OwnBody>,
}

impl SurfacePair {
    /// Bare nodes against a surface.
    #[must_use]
    pub fn new(points: Vec<NodeId>, primary: Arc<dyn ContactSurface>, reach: f64) -> Self {
        Self {
            points,
            secondary: None,
            primary,
            reach,
            sizes: FacetSizes::default(),
            start: Vec::new(),
            same: false,
            own: None,
        }
    }
}

/// The discrete choices of one row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// The closest point of the primary side; [`NOWHERE`] where the row meets several facets at once.
    pub anchor: Anchor,
    /// On what it lies.
    pub feature: Feature,
    /// Signed distance: negative where the point has passed through the surface.
    pub gap: f64,
    /// The normal that it keeps, where sliding is small.
    pub held: Option<Vec3>,
}

impl Pair {
    /// Whether the place on the surface is the same.
    #[must_use]
    pub fn agrees(&self, other: &Self) -> bool {
        self.anchor.facet == other.anchor.facet
            && std::mem::discriminant(&self.feature) == std::mem::discriminant(&other.feature)
    }
}

/// The point of a row that meets several facets at once: there is no single one.
pub const NOWHERE: Anchor = Anchor {
    facet: u32::MAX,
    local: Vec3::ZERO,
};

/// The discrete choices of all rows: `None` where nothing is within reach.
#[derive(Debug, Default, PartialEq)]
pub struct Pairing {
    /// One entry for each row.
    pub pairs: Vec<Option<Pair>>,
    /// What mortar rows see of both sides; empty for other rows.
    pub weights: Weights,
}

impl Pairing {
    /// Of rows that meet nothing.
    #[must_use]
    pub fn nothing(nrow: usize) -> Self {
        Self {
            pairs: vec![None; nrow],
            weights: Weights::default(),
        }
    }
}

impl Clone for Pairing {
    fn clone(&self) -> Self {
        Self {
            pairs: self.pairs.clone(),
            weights: self.weights.clone(),
        }
    }

    fn clone_from(&mut self, other: &Self) {
        self.pairs.clone_from(&other.pairs);
        self.weights.clone_from(&other.weights);
    }
}

/// The surfaces that the straight facets of both sides were cut from, where gaps are measured between these.
#[derive(Clone, Debug, Default)]
pub struct BentSides {
    /// The secondary side; `None` where it is bare nodes.
    pub secondary: Option<Bent>,
    /// The primary side; `None` where it is no facets of elements.
    pub primary: Option<Bent>,
}

impl BentSides {
    /// By how much the secondary side lies outside a facet at a point of it (length).
    #[must_use]
    pub fn of_secondary(&self, facet: u32, local: Vec3) -> f64 {
        let bent = self.secondary.as_ref();
        bent.map_or(0.0, |bent| bent.rise(facet, local))
    }

    /// By how much the primary side lies outside a facet at a point of it (length).
    #[must_use]
    pub fn of_primary(&self, at: Anchor) -> f64 {
        let bent = self.primary.as_ref();
        bent.map_or(0.0, |bent| bent.rise(at.facet, at.local))
    }
}

/// Where a point sticks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchored {
    /// A material point of the primary side.
    pub anchor: Anchor,
    /// What is between it and the point where it sticks, fixed in space.
    pub offset: Vec3,
}

/// A way to compare two sides.
pub trait Discretization: Send + Sync {
    /// The number of rows, the key of history and multipliers; fixed but for [`Discretization::renew`].
    fn nrow(&self) -> usize;

    /// The point of a row; what the search looks around.
    fn point(&self, row: usize) -> Point<'_>;

    /// Where each row's point is inside a facet of the secondary side; `None` where points are nodes.
    fn inside(&self) -> Option<&[OnFacet]> {
        None
    }

    /// Whether its rows may be others in each increment.
    fn remakes(&self) -> bool {
        false
    }

    /// Makes its rows again for an increment that begins at the positions `x`, where it [remakes](Self::remakes) them;
    /// returns for each the row before that it continues, if there is one. `None` where they stay as they are.
    fn renew(&mut self, _pair: &SurfacePair, _x: &[Vec3]) -> Option<Vec<Option<u32>>> {
        None
    }

    /// What renewed rows are made of, for a checkpoint; empty where rows stay.
    fn store(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Makes the rows that were stored; says whether these numbers are such.
    fn restore(&mut self, _pair: &SurfacePair, stored: &[f64]) -> bool {
        stored.is_empty()
    }

    /// Lets planes that are kept for good lean towards the normals of the secondary side, of which this part counts.
    fn lean(&mut self, _pair: &SurfacePair, _share: f64) {}

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

    /// Fills one row; leaves `out` without rows where nothing is near.
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

    /// The places of the secondary side among the participants of a row.
    fn secondary(&self, rows: &Rows, row: usize) -> Range<usize> {
        let end = rows.participants().len();
        end.saturating_sub(self.point(row).nodes.len())..end
    }

    /// Rows of the nodes that facets around the node of a row share with it, appended; none where rows act at points.
    fn adjacent(&self, _row: usize, _pair: &SurfacePair, _out: &mut Vec<usize>) {}

    /// Nodes of the secondary side without a row of their own that a row speaks for.
    fn guests(&self, _row: usize, _pair: &SurfacePair, _pairing: &Pairing, _out: &mut Vec<NodeId>) {
    }

    /// Whether points may rest on edges and vertices, not on faces alone.
    fn rests_on_edges(&self) -> bool {
        false
    }

    /// Whether tangent planes that are held are those at the start of the increment.
    fn renews(&self) -> bool {
        false
    }

    /// How many times as large the area of a row is as at the start.
    fn stretch(&self, _row: usize, _pairing: &Pairing) -> f64 {
        1.0
    }

    /// Evens out what tractions scatter between the nodes of a facet. `touches` says which rows touch; where both sides are
    /// `joined`, tractions may pull.
    fn even_out(
        &self,
        _pairing: &Pairing,
        _touches: &dyn Fn(usize) -> bool,
        _joined: bool,
        _on_rows: &mut [OnRow],
    ) {
    }

    /// Whether rows meet several facets at once, and there is no closest point.
    fn meets_many(&self) -> bool {
        false
    }

    /// The facets of the primary side that a row meets beyond the one its closest point lies on.
    fn more_facets(&self, _row: usize, _pairing: &Pairing, _out: &mut Vec<u32>) {}

    /// How fast a row closes, positive where its gap shrinks, where nodes move by `by`; `None` where that follows from its
    /// closest point.
    fn approach(
        &self,
        _row: usize,
        _pairing: &Pairing,
        _by: &dyn Fn(NodeId) -> Vec3,
    ) -> Option<f64> {
        None
    }

    /// Nodes that a row depends on beyond its point and the facets around its closest point.
    fn more_nodes<'a>(&'a self, _row: usize, _pairing: &'a Pairing) -> &'a [NodeId] {
        &[]
    }

    /// Takes note of the axes along which nodes of both sides are held from now on. Where that changes weights that stay as
    /// they are: the area of each row over that without supports.
    ///
    /// # Errors
    /// Facets that cannot be compared.
    fn support(
        &mut self,
        _pair: &SurfacePair,
        _held: HeldAxes,
    ) -> Result<Option<Vec<f64>>, SurfaceError> {
        Ok(None)
    }

    /// Makes the choices that hold while an iteration goes on, from those of the present iterate, and in what was before
    /// likewise; says whether rows now see others. What follows the motion smoothly follows it closely `from_rest`, at the
    /// start of an increment, and within it only where it lags far behind. Rows that compare the sides in another way from now on have slipped as
    /// far from their new anchors as from those before.
    ///
    /// # Errors
    /// A facet that has no normal.
    fn settle(
        &self,
        _pair: &SurfacePair,
        _at: &Placement,
        _now: &mut Pairing,
        _before: &mut Pairing,
        _anchors: &mut [Option<Anchored>],
        _from_rest: bool,
    ) -> Result<bool, SurfaceError> {
        Ok(false)
    }

    /// Whether what rows meet first is kept for good.
    fn keeps(&self) -> bool {
        false
    }

    /// The motion of a row relative to what it meets where nodes move by `by`, and its normal; `None` where its
    /// closest point determines that.
    fn way(
        &self,
        _row: usize,
        _pairing: &Pairing,
        _by: &dyn Fn(NodeId) -> Vec3,
    ) -> Option<(Vec3, Vec3)> {
        None
    }

    /// By how much the gaps of rows between straight facets exceed those of the surfaces they were cut from; empty where
    /// that is nothing.
    ///
    /// # Errors
    /// A facet that has no normal.
    fn rises(
        &self,
        _pair: &SurfacePair,
        _at: &Placement,
        _pairing: &Pairing,
        _bent: &BentSides,
    ) -> Result<Vec<f64>, SurfaceError> {
        Ok(Vec::new())
    }

    /// Whether its weights are those of the start for good: moments of both sides balance there.
    fn stays(&self) -> bool {
        false
    }

    /// Whether a pressure acts with the weights with which the gap changes.
    fn is_symmetric(&self) -> bool {
        true
    }
}

/// What acts on the secondary side at a row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OnRow {
    /// The pressure, ≥ 0 in compression.
    pub pressure: f64,
    /// The tangential traction.
    pub shear: Vec3,
}

impl OnRow {
    /// Adds so many times what acts elsewhere.
    pub(super) fn add(&mut self, times: f64, other: Self) {
        self.pressure += times * other.pressure;
        self.shear += other.shear * times;
    }
}

/// To what rows are linked.
#[derive(Clone, Copy)]
pub struct Links<'a> {
    /// The closest points.
    pub pairing: &'a Pairing,
    /// Those at the start of the increment.
    pub before: &'a Pairing,
    /// Where they stick; empty without friction.
    pub anchors: &'a [Option<Anchored>],
    /// Whether they are joined there.
    pub bond: bool,
}
