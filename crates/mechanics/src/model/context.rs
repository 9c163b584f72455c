//! What the parts of a model are made from.

use super::constraints::Ties;
use super::parts::CarrierPart;
use super::spaces::Spaces;
use super::substance::Substance;
use crate::system::{Activity, Elimination, Idealisation, Layout, RigidMass};
use signorini_geometry::mesh::{CellId, Mesh};
use signorini_geometry::surface::Pose;
use signorini_geometry::tensor::Vec3;
use std::collections::HashMap;
use std::sync::Arc;

/// What the parts of a model are made from.
pub(super) struct Context<'a> {
    pub mesh: &'a Mesh,
    /// Of each node, whether no body has it, and no constraint and no spring names it.
    pub loose: &'a [bool],
    pub reference: &'a Arc<[Vec3]>,
    pub owner: &'a HashMap<CellId, usize>,
    pub modulus: &'a [Option<f64>],
    pub shear_modulus: &'a [Option<f64>],
    pub substances: &'a [Substance],
    pub elimination: Arc<Elimination>,
    pub carriers: &'a [CarrierPart],
    /// Those that have a mass.
    pub heavy: Arc<[RigidMass]>,
    /// That of bodies that say nothing else, and of all that is no body.
    pub space: Idealisation,
    pub spaces: &'a Spaces<'a>,
    pub layout: Layout,
    pub ties: &'a Ties,
    /// Poses of the carriers at the start.
    pub poses: Vec<Pose>,
    /// Which cells take part in which step.
    pub activity: Arc<Activity>,
}
