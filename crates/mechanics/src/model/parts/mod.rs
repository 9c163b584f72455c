//! What a model is made of, as plain data: names are resolved, nothing is chosen yet.

mod contact;

pub use contact::*;

use super::ControlPart;
use crate::connector::SpringLaw;
use crate::load::{Acting, Course, RadiationConstants};
use crate::material::{Conductor, Material};
use crate::solid::{AtNodes, AtStart, Integration, Locking, MaterialAxes, Storage};
use crate::solve::{Increments, Motion, Vibration};
use crate::system::{CellChange, Director, Idealisation, Physics, Scheme};
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::surface::RigidId;
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};
use std::sync::Arc;

/// Everything a model is made of.
pub struct Parts<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// Space, plane or axisymmetry; of bodies that say nothing else.
    pub space: Idealisation,
    /// The bodies.
    pub bodies: Vec<BodyPart>,
    /// The directors of solid-shells.
    pub directors: Vec<Director>,
    /// What rigid bodies and couplings move with. Their numbers, [`RigidId`], are their places here.
    pub carriers: Vec<CarrierPart>,
    /// Springs.
    pub springs: Vec<SpringPart>,
    /// Constraints between unknowns.
    pub constraints: Vec<ConstraintPart>,
    /// The contacts.
    pub contacts: Vec<ContactPart>,
    /// Temperature of each node at the start; empty where no step and no material speaks of temperatures.
    pub temperature: Vec<f64>,
    /// The constants of radiation, where they are known.
    pub radiation: Option<RadiationConstants>,
    /// Velocity of each node of the mesh at the start; empty where nothing moves.
    pub velocity: Vec<Vec3>,
    /// Masses at nodes.
    pub masses: Vec<(NodeId, f64)>,
    /// Masses of carriers, besides those of their rigid bodies.
    pub carrier_masses: Vec<CarrierMass>,
    /// How carriers move at the start.
    pub carrier_velocities: Vec<CarrierVelocity>,
    /// The steps.
    pub steps: Vec<StepPart>,
    /// Whether viscous forces hold bodies that nothing but contact stops.
    pub stabilize: bool,
    /// Whether bodies may move freely where no load moves them, see [`crate::solve::NewtonSettings::hold_free`].
    pub hold_free: bool,
    /// Gap over the size of the facets that contact methods with multipliers may leave.
    pub gap_tol: f64,
    /// What multipliers that friction limits may be off by, over themselves.
    pub traction_tol: f64,
}

impl<'a> Parts<'a> {
    /// What counts as open and as unloaded: a gap and a traction.
    pub(super) fn tolerances(&self) -> [f64; 2] {
        [self.gap_tol, self.traction_tol]
    }

    /// A model without anything in it yet.
    #[must_use]
    pub fn new(mesh: &'a Mesh, space: Idealisation) -> Self {
        Self {
            mesh,
            space,
            bodies: Vec::new(),
            directors: Vec::new(),
            carriers: Vec::new(),
            springs: Vec::new(),
            constraints: Vec::new(),
            contacts: Vec::new(),
            temperature: Vec::new(),
            radiation: None,
            velocity: Vec::new(),
            masses: Vec::new(),
            carrier_masses: Vec::new(),
            carrier_velocities: Vec::new(),
            steps: Vec::new(),
            stabilize: true,
            hold_free: false,
            gap_tol: 1e-6,
            traction_tol: 1e-7,
        }
    }
}

/// Where the mass of bodies is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MassMatrix {
    /// Between the nodes, as shape functions have it.
    #[default]
    Consistent,
    /// At the nodes.
    Lumped,
}

/// What a body does in a step with inertia, besides its density.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MassPart {
    /// Where the mass is.
    pub matrix: MassMatrix,
    /// Viscous forces over mass and velocity.
    pub damping: f64,
    /// Viscous stress over the initial stiffness of its material and the rate of strain (time).
    pub retardation: f64,
}

/// How a body conducts and stores heat.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatPart {
    /// What conducts.
    pub conductor: Conductor,
    /// Axes of a conductor with directions, as columns.
    pub axes: Mat3,
    /// Where heat is stored.
    pub storage: Storage,
}

/// A body.
pub struct BodyPart {
    /// Its name.
    pub name: String,
    /// Its cells.
    pub cells: Vec<CellId>,
    /// What it is.
    pub kind: BodyKind,
}

/// What a body is.
pub enum BodyKind {
    /// A deformable solid.
    Solid {
        /// What it is made of.
        material: Box<dyn Material>,
        /// Materials that take its place, each with the step, from 0, from which on it does.
        later: Vec<(usize, Box<dyn Material>)>,
        /// Mass per volume, where it is known.
        density: Option<f64>,
        /// What else it does in motions in time.
        mass: MassPart,
        /// Full or reduced integration.
        integration: Integration,
        /// What is done against locking.
        locking: Locking,
        /// What its plane stands for, where it is not what that of the model does: another thickness, or another
        /// idealisation of two dimensions. Thicknesses in a model with bodies of revolution are those of the full
        /// circumference.
        space: Option<Idealisation>,
        /// What its thickness is multiplied by at every node of the mesh, interpolated as displacements are; none: 1.
        profile: Option<Arc<[f64]>>,
        /// Whether temperatures are linear in quad8 and hex20 with full integration, as strains are.
        linear_temperatures: bool,
        /// How stresses and strains at points are carried to nodes.
        at_nodes: AtNodes,
        /// Stress and strain at the start.
        initial: Vec<AtStart>,
        /// Axes of a material that takes those of points; none: those of the frame.
        axes: Option<Box<MaterialAxes>>,
        /// How it conducts and stores heat, where temperatures are unknowns.
        heat: Option<Box<HeatPart>>,
    },
    /// Bars that carry normal force only: cells of lines.
    Truss {
        /// What it is made of; it answers uniaxial stress.
        material: Box<dyn Material>,
        /// Mass per volume, where it is known.
        density: Option<f64>,
        /// What else it does in motions in time.
        mass: MassPart,
        /// Cross-section (area).
        area: f64,
        /// Whether strains are small in all steps.
        small: bool,
    },
    /// A rigid body.
    Rigid {
        /// What it moves with.
        carrier: RigidId,
        /// Mass per volume, where it has one.
        density: Option<f64>,
    },
}

impl BodyKind {
    /// A solid of this material, everything else as it is by default.
    #[must_use]
    pub fn solid(material: Box<dyn Material>) -> Self {
        Self::Solid {
            material,
            later: Vec::new(),
            density: None,
            mass: MassPart::default(),
            integration: Integration::default(),
            locking: Locking::default(),
            space: None,
            profile: None,
            linear_temperatures: false,
            at_nodes: AtNodes::default(),
            initial: Vec::new(),
            axes: None,
            heat: None,
        }
    }

    /// What its plane stands for, in a model of this space.
    #[must_use]
    pub fn space(&self, of_model: Idealisation) -> Idealisation {
        match self {
            Self::Solid { space, .. } => space.unwrap_or(of_model),
            Self::Truss { .. } | Self::Rigid { .. } => of_model,
        }
    }

    /// What its thickness is multiplied by at every node of the mesh, where it is not 1.
    #[must_use]
    pub fn profile(&self) -> Option<&Arc<[f64]>> {
        match self {
            Self::Solid { profile, .. } => profile.as_ref(),
            Self::Truss { .. } | Self::Rigid { .. } => None,
        }
    }

    /// The material of a deformable body.
    #[must_use]
    pub fn material(&self) -> Option<&dyn Material> {
        match self {
            Self::Solid { material, .. } | Self::Truss { material, .. } => Some(material.as_ref()),
            Self::Rigid { .. } => None,
        }
    }
}

/// A reference point with translations and rotations of its own. Rigid bodies and couplings move with it.
#[derive(Clone, Debug, PartialEq)]
pub struct CarrierPart {
    /// Its name: that of the reference, or of the rigid body whose own it is.
    pub name: String,
    /// Where it is; `None`: in the mean of the nodes of its rigid bodies, or of those of its couplings.
    pub at: Option<Vec3>,
}

/// A mass that moves with a carrier.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarrierMass {
    /// The carrier.
    pub carrier: RigidId,
    /// The mass.
    pub mass: f64,
    /// Its centroid at the start; none: at the carrier.
    pub centroid: Option<Vec3>,
    /// Moments of inertia about the centroid, along the axes of the frame.
    pub inertia: Sym3,
}

/// How a carrier moves at the start, as a rigid body does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarrierVelocity {
    /// The carrier.
    pub carrier: RigidId,
    /// The velocity at `about`.
    pub velocity: Vec3,
    /// Angular velocity (radian per time).
    pub spin: Vec3,
    /// A point of the axis of the angular velocity.
    pub about: Vec3,
}

/// A spring. Its elongation is measured along `direction`, or along the line between its ends, which turns with them.
#[derive(Clone, Debug, PartialEq)]
pub struct SpringPart {
    /// Its name.
    pub name: String,
    /// Pairs of ends; the second is `None` where the spring is tied to the ground.
    pub ends: Vec<(NodeId, Option<NodeId>)>,
    /// The force of each spring, by its elongation.
    pub law: SpringLaw,
    /// Unit vector, fixed in space; `None`: along the line between the ends.
    pub direction: Option<Vec3>,
}

/// What an equation speaks of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unknown {
    /// Displacement of a node along an axis.
    Node(NodeId, usize),
    /// Component of a carrier: 0 to 2 translations, 3 to 5 rotations.
    Carrier(RigidId, usize),
}

/// A constraint between unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstraintPart {
    /// What it is called in messages.
    pub name: String,
    /// What it says.
    pub kind: ConstraintKind,
}

/// What a constraint says.
#[derive(Clone, Debug, PartialEq)]
pub enum ConstraintKind {
    /// `Σ coefficient · unknown = rhs`; the right-hand side is reached linearly over the first step.
    Equation {
        /// Unknowns with their coefficients.
        terms: Vec<(Unknown, f64)>,
        /// The right-hand side.
        rhs: f64,
    },
    /// These displacements of all nodes are equal.
    Equal {
        /// The nodes.
        nodes: Vec<NodeId>,
        /// The directions.
        axes: [bool; 3],
    },
    /// The nodes follow the carrier as a rigid body does, in these directions.
    Kinematic {
        /// The nodes.
        nodes: Vec<NodeId>,
        /// What they follow.
        carrier: RigidId,
        /// The directions.
        axes: [bool; 3],
    },
    /// Each node follows the carrier as a rigid body does along a direction of its own, a unit vector that stays as it is.
    KinematicAlong {
        /// The nodes with their directions; a node may have several.
        nodes: Vec<(NodeId, Vec3)>,
        /// What they follow.
        carrier: RigidId,
    },
    /// Directors turn with a carrier: half the difference of the displacements of their ends is `R (1 + a) D − D`, with half the
    /// thickness vector `D`, by which the node that carries it lies away from the carrier.
    Directors {
        /// The nodes that carry half the differences, each with a carrier without a place whose displacement along x is the
        /// stretch, `a |D|`.
        halves: Vec<(NodeId, RigidId)>,
        /// What they turn with.
        carrier: RigidId,
    },
    /// The carrier follows the weighted mean motion of the nodes, which stay free to deform.
    Distributing {
        /// The nodes with positive weights.
        nodes: Vec<(NodeId, f64)>,
        /// What follows them.
        carrier: RigidId,
    },
    /// The nodes, in a plane at the start (in the plane: on a line), stay in one, which may move and turn.
    Plane {
        /// The nodes.
        nodes: Vec<NodeId>,
    },
    /// The nodes, on a line at the start, stay on one, which may move and turn.
    Line {
        /// The nodes.
        nodes: Vec<NodeId>,
    },
    /// Two nodes keep their distance, or go no farther apart than `most`.
    Distance {
        /// The nodes.
        nodes: [NodeId; 2],
        /// The largest distance; `None`: that at the start, neither more nor less.
        most: Option<f64>,
    },
    /// The translation of the carrier along x is the angle (radian) by which the nodes turn in the mean about an axis
    /// through their mean.
    Twist {
        /// The nodes.
        nodes: Vec<NodeId>,
        /// The direction of the axis.
        axis: Vec3,
        /// Whose translation along x is the angle.
        carrier: RigidId,
    },
}

impl ConstraintKind {
    /// The nodes that it names, some of them maybe several times.
    pub fn nodes(&self) -> Vec<NodeId> {
        match self {
            Self::Equation { terms, .. } => {
                let node = |(unknown, _): &(Unknown, f64)| match unknown {
                    Unknown::Node(node, _) => Some(*node),
                    Unknown::Carrier(..) => None,
                };
                terms.iter().filter_map(node).collect()
            }
            Self::Distributing { nodes, .. } => nodes.iter().map(|(node, _)| *node).collect(),
            Self::KinematicAlong { nodes, .. } => nodes.iter().map(|(node, _)| *node).collect(),
            Self::Directors { halves, .. } => halves.iter().map(|(node, _)| *node).collect(),
            Self::Distance { nodes, .. } => nodes.to_vec(),
            Self::Equal { nodes, .. }
            | Self::Kinematic { nodes, .. }
            | Self::Plane { nodes }
            | Self::Line { nodes }
            | Self::Twist { nodes, .. } => nodes.clone(),
        }
    }
}

/// What a support or a motion is applied to.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// Nodes of deformable bodies.
    Nodes(Vec<NodeId>),
    /// A carrier.
    Rigid(RigidId),
}

/// A change of prescribed motions.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// Components 0 to 2 (displacements) and 3 to 5 (rotations) get a motion.
    Prescribe(Target, Vec<(usize, Motion)>),
    /// Components become free.
    Release(Target, Vec<usize>),
}

/// A load. A later load of the same name replaces it; a load stays as it is until then.
#[derive(Clone, Debug)]
pub struct LoadPart {
    /// Its name.
    pub name: String,
    /// What acts, at full size, and where.
    pub load: Acting,
    /// The factor over time: from what the load of this name was before to full size by default.
    pub course: Course,
}

/// Cells that take part again, or no longer, from the beginning of a step on.
#[derive(Clone, Debug, PartialEq)]
pub struct ActivityPart {
    /// The cells.
    pub cells: Vec<CellId>,
    /// What becomes of them.
    pub change: CellChange,
}

/// A step: what it changes.
///
/// # Example
/// ```
/// use signorini_mechanics::model::StepPart;
/// use signorini_mechanics::solve::Increments;
///
/// let step = StepPart::new("press", Increments::Fixed(4));
/// assert_eq!((step.duration, step.nonlinear), (1.0, true));
/// ```
#[derive(Clone, Debug)]
pub struct StepPart {
    /// Its name.
    pub name: String,
    /// Its duration.
    pub duration: f64,
    /// How it is cut into increments.
    pub increments: Increments,
    /// Whether displacements may be large.
    pub nonlinear: bool,
    /// How it goes through time, where inertia counts.
    pub scheme: Option<Scheme>,
    /// What limits its increments there, where they adapt.
    pub control: Option<ControlPart>,
    /// Which natural modes are found in it; it then takes no time.
    pub vibration: Option<Vibration>,
    /// What is unknown in it.
    pub physics: Physics,
    /// Changes of supports and motions; everything else stays.
    pub changes: Vec<Change>,
    /// Loads that begin or change here.
    pub loads: Vec<LoadPart>,
    /// Contacts that change when it begins.
    pub contacts: Vec<ContactChange>,
    /// Courses of the temperatures of nodes; others keep theirs, or are free where temperatures are unknown. Where no step solves for
    /// temperatures, they are reached linearly.
    pub temperatures: Vec<(NodeId, Motion)>,
    /// Nodes whose temperatures are free again from its beginning on.
    pub freed_temperatures: Vec<NodeId>,
    /// Cells that take part again, or no longer, from its beginning on.
    pub activity: Vec<ActivityPart>,
}

impl StepPart {
    /// A step of duration 1 with large displacements, in which nothing changes yet.
    #[must_use]
    pub fn new(name: impl Into<String>, increments: Increments) -> Self {
        Self {
            name: name.into(),
            duration: 1.0,
            increments,
            nonlinear: true,
            scheme: None,
            control: None,
            vibration: None,
            physics: Physics::default(),
            changes: Vec::new(),
            loads: Vec::new(),
            contacts: Vec::new(),
            temperatures: Vec::new(),
            freed_temperatures: Vec::new(),
            activity: Vec::new(),
        }
    }
}
