//! What sides are made from.

use crate::model::spaces::Spaces;
use crate::model::steps::Prescribed;
use crate::system::{Elimination, Idealisation};
use signorini_geometry::mesh::Mesh;
use signorini_geometry::surface::Bodies;
use signorini_geometry::tensor::Vec3;

/// What sides are made from.
#[derive(Clone, Copy)]
pub(in crate::model) struct Source<'a> {
    pub mesh: &'a Mesh,
    /// What its solid cells are connected to.
    pub bodies: &'a Bodies,
    /// Positions at the start.
    pub reference: &'a [Vec3],
    pub space: Idealisation,
    /// What the planes of bodies stand for.
    pub spaces: &'a Spaces<'a>,
    /// What follows rigid bodies.
    pub elimination: &'a Elimination,
    /// Of each node, whether the steps prescribe its motion along all axes.
    pub prescribed: &'a [bool],
    /// Of each node and axis, what the steps prescribe of its motion.
    pub motions: &'a [[Prescribed; 3]],
    /// Of each contact, whether it has friction in any step.
    pub rubs: &'a [bool],
}

impl<'a> Source<'a> {
    /// The same with other positions at the start.
    pub fn with_reference(self, reference: &'a [Vec3]) -> Self {
        Self { reference, ..self }
    }
}
