//! What acts, and where.

use super::{Region, Schedule};
use crate::system::{Layout, Term};
use signorini_geometry::mesh::{CellId, Face, NodeId};
use signorini_geometry::surface::RigidId;
use signorini_geometry::tensor::Vec3;
use std::collections::BTreeSet;
use std::fmt::Debug;
use std::sync::Arc;
use thiserror::Error;

/// What acts, at full size. Where it acts is a matter of its [`Place`].
pub trait Load: Debug + Send + Sync {
    /// What it is, and what it acts on.
    fn properties(&self) -> LoadProperties;

    /// Its force and moment on a carrier with this mass, of a load by mass at the centroid; `None` where it does not act on what
    /// moves as a whole.
    fn resultant(&self, _mass: f64) -> Option<[Vec3; 2]> {
        None
    }

    /// The same load, turning with the surface that it acts on or not; `None` where it always keeps its direction.
    fn following(&self, follows: bool) -> Option<Arc<dyn Load>>;

    /// What it does at a site, at full size.
    ///
    /// # Errors
    /// It cannot act there.
    fn effect(&self, site: Site<'_>) -> Result<Effect, LoadError>;

    /// This load in a place.
    fn on(self, place: Place) -> Acting
    where
        Self: Sized + 'static,
    {
        Acting {
            load: Arc::new(self),
            place,
        }
    }
}

/// What a load is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoadProperties {
    /// What it acts on.
    pub domain: Domain,
    /// What it is an amount of. Two loads of one quantity in one place can take each other's place at once.
    pub quantity: &'static str,
    /// The part of it that can act on a body of revolution, in words, where that is not all of it.
    pub off_axis: Option<&'static str>,
    /// Whether it is heat, not force.
    pub is_heat: bool,
}

impl LoadProperties {
    /// Those of a load that acts whole on bodies of revolution, too.
    #[must_use]
    pub const fn new(domain: Domain, quantity: &'static str) -> Self {
        Self {
            domain,
            quantity,
            off_axis: None,
            is_heat: false,
        }
    }

    /// Those of heat.
    #[must_use]
    pub const fn of_heat(domain: Domain, quantity: &'static str) -> Self {
        Self {
            is_heat: true,
            ..Self::new(domain, quantity)
        }
    }
}

/// What a load acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Domain {
    /// Nodes.
    Nodes,
    /// Faces; nodes where there are none.
    FacesOrNodes,
    /// Faces.
    Faces,
    /// Cells, by their volume.
    Volume,
    /// Cells, by their mass.
    Mass,
}

/// Where a load acts.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// On nodes.
    Nodes(Vec<NodeId>),
    /// On faces.
    Faces(Vec<Face>),
    /// On cells.
    Cells(Vec<CellId>),
    /// On a carrier.
    Carrier(RigidId),
    /// On all mass that is not of cells of bodies that deform: on rigid bodies, and on masses at nodes that follow none.
    Points,
}

/// A load in its place.
#[derive(Clone, Debug)]
pub struct Acting {
    /// What acts, at full size.
    pub load: Arc<dyn Load>,
    /// Where.
    pub place: Place,
}

impl Acting {
    /// Forces on nodes, which keep their direction.
    #[must_use]
    pub fn forces(forces: Vec<(NodeId, Vec3)>) -> Self {
        let nodes = forces.iter().map(|(node, _)| *node).collect();
        Forces(forces).on(Place::Nodes(nodes))
    }

    /// Whether it acts on cells, and there are none.
    #[must_use]
    pub fn is_nowhere(&self) -> bool {
        matches!(&self.place, Place::Cells(cells) if cells.is_empty())
    }

    /// Whether another load is of the same quantity in the same place; on a carrier, whether it acts on that.
    #[must_use]
    pub fn is_alike(&self, other: &Self) -> bool {
        let alike = match (&self.place, &other.place) {
            (Place::Carrier(a), Place::Carrier(b)) => return a == b,
            (Place::Points, Place::Points) => true,
            (Place::Nodes(a), Place::Nodes(b)) => set(a) == set(b),
            (Place::Faces(a), Place::Faces(b)) => set(a) == set(b),
            (Place::Cells(a), Place::Cells(b)) => set(a) == set(b),
            _ => false,
        };
        alike && self.load.properties().quantity == other.load.properties().quantity
    }
}

fn set<T: Copy + Ord>(members: &[T]) -> BTreeSet<T> {
    members.iter().copied().collect()
}

/// The place of a load in a model, and what it needs there.
pub struct Site<'a> {
    /// The name of the load.
    pub name: &'a str,
    /// Its nodes, in the order in which they were named; none on faces and cells.
    pub nodes: &'a [NodeId],
    /// Its cells; none on nodes and faces.
    pub cells: &'a [CellId],
    /// Its faces, or its cells with densities as factors where it acts by mass; empty on nodes.
    pub region: Region,
    /// Whether some of its cells are of a body of revolution.
    pub revolved: bool,
    /// Its factor over time.
    pub schedule: Schedule,
    /// The unknowns.
    pub layout: Layout,
    /// The constants of radiation, where they are known.
    pub radiation: Option<RadiationConstants>,
    /// Positions of all nodes at the start.
    pub reference: &'a Arc<[Vec3]>,
}

/// The constants of radiation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadiationConstants {
    /// σ, of Stefan and Boltzmann.
    pub stefan_boltzmann: f64,
    /// `T_0`, absolute zero.
    pub absolute_zero: f64,
}

/// What a load does.
pub enum Effect {
    /// Forces on nodes that keep direction and size, in the order in which they are added up.
    Forces(Vec<(NodeId, Vec3)>),
    /// Heat per time into nodes, whatever the state.
    Heats(Vec<(NodeId, f64)>),
    /// Forces that go by the state.
    Term(Box<dyn Term>),
}

impl Effect {
    /// Forces on nodes that keep direction and size.
    pub(super) fn forces(forces: impl IntoIterator<Item = (NodeId, Vec3)>) -> Self {
        Self::Forces(forces.into_iter().collect())
    }
}

/// Forces of their own at several nodes.
#[derive(Debug)]
struct Forces(Vec<(NodeId, Vec3)>);

impl Load for Forces {
    fn properties(&self) -> LoadProperties {
        LoadProperties::new(Domain::Nodes, "force")
    }

    fn following(&self, _: bool) -> Option<Arc<dyn Load>> {
        None
    }

    fn effect(&self, _: Site<'_>) -> Result<Effect, LoadError> {
        Ok(Effect::forces(self.0.iter().copied()))
    }
}

/// Why a load cannot act.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum LoadError {
    /// A name given twice in one step.
    #[error("step \"{step}\" has two loads of this name")]
    Twice {
        /// Name of the step.
        step: String,
    },
    /// A load in a place that it does not act on, such as a pressure on nodes.
    #[error("it does not act on a place of this kind")]
    Misplaced,
    /// No face, no cell.
    #[error("it acts on nothing")]
    Nowhere,
    /// An element that is in no body.
    #[error("element {element} belongs to no body")]
    Outside {
        /// The element, as numbered in the input.
        element: u64,
    },
    /// A node that no body has and no constraint names: the load would be lost.
    #[error("node {node} belongs to no body")]
    Loose {
        /// The node, as numbered in the input.
        node: u64,
    },
    /// A node of which a mass is all it has, in a model with static steps: nothing holds it there.
    #[error("node {node} has a mass alone, and nothing holds it in static steps")]
    Alone {
        /// The node, as numbered in the input.
        node: u64,
    },
    /// Something that is no face of a solid.
    #[error("side {side} of element {element} is no face of a solid")]
    NoFace {
        /// The element, as numbered in the input.
        element: u64,
        /// The side, from 1.
        side: usize,
    },
    /// A total force on faces without area.
    #[error("its faces have no area")]
    NoArea,
    /// A load by volume on an element without volume.
    #[error("element {element} has no volume")]
    NoVolume {
        /// The element, as numbered in the input.
        element: u64,
    },
    /// A load by mass on a body whose density is not known.
    #[error("body \"{body}\" has no density")]
    NoDensity {
        /// Name of the body.
        body: String,
    },
    /// A load by mass on a rigid body that has none.
    #[error("what it acts on has no mass")]
    Massless,
    /// Radiation where its constants are not known.
    #[error("the constants of radiation are not known")]
    NoConstants,
    /// Heat in a model in which no temperature is unknown.
    #[error("no step solves for temperatures")]
    NoTemperatures,
    /// A moment on nodes that cannot carry it.
    #[error("its nodes lie in a point, or on a line about which the moment turns")]
    NoArm,
    /// A centrifugal load about an axis without direction.
    #[error("its axis has no direction")]
    NoAxis,
    /// A centrifugal load about another axis than that of an axisymmetric model.
    #[error("its axis is not the axis of the model: x = 0, along y")]
    OtherAxis,
}
