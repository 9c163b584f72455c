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
pub use lean::Lean;
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
    /// The normals of the secondary side, which planes that are kept for good lean towards.
    pub lean: Option<Lean>,
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
            lean: None,
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

/// What a discretization is, and can do beyond rows.
#[derive(Clone, Copy, Default)]
pub struct Capabilities<'a> {
    /// Whether a pressure acts with the weights with which the gap changes.
    pub is_symmetric: bool,
    /// How long rows keep what they meet.
    pub sliding: SlidingRange,
    /// Whether points may rest on edges and vertices, not on faces alone.
    pub rests_on_edges: bool,
    /// Where each row's point is inside a facet of the secondary side; `None` where points are nodes.
    pub inside: Option<&'a [OnFacet]>,
    /// Of rows that meet several facets at once: there is no closest point.
    pub averaged: Option<&'a dyn Averaged>,
    /// Of rows whose gaps can be measured between curved surfaces.
    pub curved: Option<&'a dyn Curved>,
    /// Of rows that may be others in each increment.
    pub renewable: Option<&'a dyn Renewable>,
}

impl Capabilities<'_> {
    /// Whether what rows meet first is kept for good.
    #[must_use]
    pub fn keeps(&self) -> bool {
        self.sliding == SlidingRange::Small
    }

    /// Whether tangent planes that are held are those at the start of the increment.
    #[must_use]
    pub fn renews(&self) -> bool {
        self.sliding == SlidingRange::Increment
    }

    /// Whether weights are those of the start for good: moments of both sides balance there.
    #[must_use]
    pub fn keeps_weights(&self) -> bool {
        self.averaged.is_some() && self.keeps()
    }
}

/// Rows of nodes that meet several facets at once: gaps and tractions are means over the facets around a node.
pub trait Averaged: Send + Sync {
    /// Takes note of the axes along which nodes of both sides are held from now on. Where that changes weights that stay as
    /// they are: the area of each row over that without supports.
    ///
    /// # Errors
    /// Facets that cannot be compared.
    fn support(
        &mut self,
        pair: &SurfacePair,
        held: HeldAxes,
    ) -> Result<Option<Vec<f64>>, SurfaceError>;

    /// Makes the choices that hold while an iteration goes on, from those of the present iterate, and in what was before
    /// likewise; says whether rows now see others. What follows the motion smoothly follows it closely `from_rest`, at the
    /// start of an increment, and within it only where it lags far behind. Rows that compare the sides in another way from
    /// now on have slipped as far from their new anchors as from those before.
    ///
    /// # Errors
    /// A facet that has no normal.
    fn settle(
        &self,
        pair: &SurfacePair,
        at: &Placement,
        now: &mut Pairing,
        before: &mut Pairing,
        anchors: &mut [Option<Anchored>],
        from_rest: bool,
    ) -> Result<bool, SurfaceError>;

    /// Nodes of the secondary side that a row depends on beyond its point.
    fn more_nodes<'a>(&'a self, row: usize, pairing: &'a Pairing) -> &'a [NodeId];

    /// The facets of the primary side that a row meets beyond the one its closest point lies on.
    fn more_facets(&self, row: usize, pairing: &Pairing, out: &mut Vec<u32>);

    /// Rows of the nodes that facets around the node of a row share with it, appended.
    fn adjacent(&self, row: usize, pair: &SurfacePair, out: &mut Vec<usize>);

    /// Nodes of the secondary side without a row of their own that a row speaks for.
    fn guests(&self, row: usize, pair: &SurfacePair, pairing: &Pairing, out: &mut Vec<NodeId>);

    /// How fast a row closes, positive where its gap shrinks, where nodes move by `by`; `None` where that follows from its
    /// closest point.
    fn approach(&self, row: usize, pairing: &Pairing, by: &dyn Fn(NodeId) -> Vec3) -> Option<f64>;

    /// The motion of a row relative to what it meets where nodes move by `by`, and its normal; `None` where its
    /// closest point determines that.
    fn way(
        &self,
        row: usize,
        pairing: &Pairing,
        by: &dyn Fn(NodeId) -> Vec3,
    ) -> Option<(Vec3, Vec3)>;

    /// The area of a row over that at the start.
    fn stretch(&self, row: usize, pairing: &Pairing) -> f64;

    /// Smooths what tractions scatter between the nodes of a facet. `touches` says which rows touch; where both sides are
    /// `joined`, tractions may pull.
    fn smooth(
        &self,
        pairing: &Pairing,
        touches: &dyn Fn(usize) -> bool,
        joined: bool,
        on_rows: &mut [OnRow],
    );
}

/// Rows whose gaps can be measured between the surfaces that straight facets were cut from.
pub trait Curved: Send + Sync {
    /// By how much the gaps of rows between straight facets exceed those of the surfaces they were cut from; empty where
    /// that is nothing.
    ///
    /// # Errors
    /// A facet that has no normal.
    fn rises(
        &self,
        pair: &SurfacePair,
        at: &Placement,
        pairing: &Pairing,
        bent: &BentSides,
    ) -> Result<Vec<f64>, SurfaceError>;
}

/// Rows whose points are made where both sides are, and may be made again.
pub trait Renewable: Send + Sync {
    /// Whether they are made again in each increment.
    fn renews(&self) -> bool;

    /// Makes the rows again for an increment that begins at the positions `x`, where it does; returns for each the row before
    /// that it continues, if there is one. `None` where they stay as they are.
    fn renew(&mut self, pair: &SurfacePair, x: &[Vec3]) -> Option<Vec<Option<u32>>>;

    /// What the rows are made of, for a checkpoint.
    fn store(&self) -> Vec<f64>;

    /// Makes the rows that were stored; says whether these numbers are such.
    fn restore(&mut self, pair: &SurfacePair, stored: &[f64]) -> bool;
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
    /// Adds a multiple of the force elsewhere.
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
