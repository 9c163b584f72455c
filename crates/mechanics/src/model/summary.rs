//! What was chosen for contacts and bodies.

use super::parts::{Enforcement, Interference, Method};
use crate::contact::Measure;
use crate::contact::discretization::SlidingRange;
use crate::material::Kinematics;
use crate::solid::Locking;
use signorini_geometry::mesh::{Face, NodeId};
use signorini_geometry::tensor::Vec3;

/// What a contact became.
#[derive(Clone, Debug)]
pub struct ContactSummary {
    /// Its name.
    pub name: String,
    /// The method in use.
    pub method: Method,
    /// How penetration is prevented, without what was left open.
    pub enforcement: Enforcement,
    /// The penalty in use; of multipliers, what their conditions are scaled by.
    pub penalty: f64,
    /// What it refers to.
    pub measure: Measure,
    /// How far its points slide.
    pub sliding: SlidingRange,
    /// The reach in use.
    pub reach: f64,
    /// Points of the secondary side.
    pub npoint: usize,
    /// Facets of the primary side.
    pub nfacet: usize,
    /// Size of the facets.
    pub facet_size: f64,
    /// Nodes that both sides have, which are not compared; sorted.
    pub shared: Vec<NodeId>,
    /// What is near at the start.
    pub start: StartSummary,
    /// How the joint breaks; `None`: it does not.
    pub cohesion: Option<CohesionSummary>,
}

/// A joint that breaks, and whether its facets resolve the zone in which it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CohesionSummary {
    /// Tractions per opening and per shear of what is undamaged.
    pub stiffness: [f64; 2],
    /// Size of the facets.
    pub facet: f64,
    /// Thickness of the thinner side; `None` where neither ends opposite its face.
    pub thickness: Option<f64>,
    /// Length of the zone; `None` where no side yields.
    pub zone: Option<f64>,
    /// How many facets the zone should span.
    pub resolved: f64,
    /// The strength with which it does; `None` where it does already.
    pub reduced: Option<[f64; 2]>,
}

/// Gaps and overlaps at the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StartSummary {
    /// How many rows have something within reach.
    pub near: usize,
    /// How many nodes of the secondary side touch or overlap.
    pub touching: usize,
    /// The smallest gap at a node of either side that faces the other, negative where the sides overlap (length); of a
    /// surface with itself and of pairs of nodes, at a row. `None` where nothing is within reach.
    pub gap: Option<f64>,
    /// Where that is; `None` where it is known by rows alone.
    pub place: Option<StartPlace>,
    /// At how many nodes the sides overlap by more than the mesh explains.
    pub overlapping: usize,
    /// What becomes of overlaps.
    pub treatment: Treatment,
    /// What comes from straight facets, where gaps are measured between the surfaces that these were cut from.
    pub bent: Option<BentSummary>,
    /// Edges of the body at which the secondary side ends over the other side, of contacts with friction.
    pub open_edges: Option<OpenEdges>,
}

/// Edges of a body at which the secondary side of a contact ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OpenEdges {
    /// How many there are.
    pub count: usize,
    /// A node of one of them.
    pub node: NodeId,
    /// The face next to it that the contact does not have.
    pub face: Face,
}

/// A place at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartPlace {
    /// The node; `None` inside a facet.
    pub node: Option<NodeId>,
    /// The position.
    pub position: Vec3,
}

/// What becomes of gaps and overlaps at the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Treatment {
    /// Gaps are as measured; overlaps are treated like this.
    Interference(Interference),
    /// Gaps are taken to be something else.
    Given,
    /// The sides are joined.
    Joined,
}

impl Default for Treatment {
    fn default() -> Self {
        Self::Interference(Interference::default())
    }
}

/// What comes from straight facets of surfaces that conform (lengths).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BentSummary {
    /// How far gaps between straight facets are from the distance, at most.
    pub straight: f64,
    /// How far those between bent facets are.
    pub bent: f64,
    /// The distance of the surfaces: the median of the gaps between bent facets.
    pub distance: f64,
}

/// What is done against locking in the elements of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct LockingSummary {
    /// Name of the body.
    pub body: String,
    /// Type of the elements.
    pub element: &'static str,
    /// In steps of which size of strains.
    pub kinematics: Kinematics,
    /// What is done.
    pub locking: Locking,
}
