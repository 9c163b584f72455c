//! Two sides, and what their points meet.

use super::lean::Lean;
use super::own::OwnBody;
use super::sizes::FacetSizes;
use super::wall::Wall;
use crate::contact::mortar::Weights;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Anchor, Bent, ContactSurface, Facets, Feature};
use signorini_geometry::tensor::Vec3;
use std::sync::Arc;

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
    /// The body between the sides, where they are two faces of one.
    pub wall: Option<Wall>,
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
            wall: None,
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
