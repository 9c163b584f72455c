//! Where nodes and rigid bodies are, and what of them moves a facet.

use crate::mesh::NodeId;
use crate::tensor::{Mat3, Vec3};

/// The number of a rigid body, from 0.
pub type RigidId = u32;

/// Where a rigid body is: its reference point and its rotation from the initial configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Present position of the reference point.
    pub origin: Vec3,
    /// Rotation since the start; a body vector `a` has become `rotation · a`.
    pub rotation: Mat3,
}

/// The configuration, as far as geometry may see it.
#[derive(Clone, Copy, Debug)]
pub struct Placement<'a> {
    /// Positions of all nodes.
    pub x: &'a [Vec3],
    /// Poses of all rigid bodies.
    pub poses: &'a [Pose],
}

/// What moves a facet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Carrier<'a> {
    /// Nodes, weighted by the shape functions of the jet.
    Nodes(&'a [NodeId]),
    /// A rigid body: 6 unknowns, 3 in the plane.
    Rigid(RigidId),
    /// Nothing: the facet is fixed in space.
    Fixed,
}
