//! What discretizations can do beyond rows.

use super::on_facet::OnFacet;
use super::pair::{Anchored, BentSides, Pairing, SurfacePair};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Placement, SurfaceError};
use signorini_geometry::tensor::Vec3;
use std::collections::{BTreeSet, HashMap};

/// The axes along which nodes are held; those of no node that is not.
pub type HeldAxes = HashMap<NodeId, [bool; 3]>;

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

    /// Leaves rows of these nodes to other contacts: their functions go to rows next to them, where there are any. Before any
    /// pairing is made.
    fn yield_at(&mut self, nodes: BTreeSet<NodeId>);

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

/// How far points slide, and so how long they keep the tangent plane that they meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SlidingRange {
    /// As far as it goes: the closest point moves with them.
    #[default]
    Finite,
    /// Little within an increment: they keep the tangent plane that they meet at its start.
    Increment,
    /// Little: they keep the tangent plane that they meet first, between the normals of both sides where the secondary side
    /// has faces.
    Small,
}
