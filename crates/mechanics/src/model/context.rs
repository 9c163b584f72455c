//! What the parts of a model are made from.

use super::constraints::Ties;
use super::parts::CarrierPart;
use super::spaces::Spaces;
use super::substance::Substance;
use crate::system::{Elimination, Idealisation, Layout};
use signorini_geometry::mesh::{CellId, Mesh};
use signorini_geometry::surface::Pose;
use signorini_geometry::tensor::Vec3;
use std::collections::HashMap;
use std::sync::Arc;

/// What the parts of a model are made from.
pub(super) struct Context<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) reference: &'a Arc<[Vec3]>,
    pub(super) owner: &'a HashMap<CellId, usize>,
    pub(super) modulus: &'a [Option<f64>],
    pub(super) shear_modulus: &'a [Option<f64>],
    pub(super) substances: &'a [Substance],
    pub(super) elimination: Arc<Elimination>,
    pub(super) carriers: &'a [CarrierPart],
    /// That of bodies that say nothing else, and of all that is no body.
    pub(super) space: Idealisation,
    pub(super) spaces: &'a Spaces<'a>,
    pub(super) layout: Layout,
    pub(super) ties: &'a Ties,
    /// Poses of the carriers at the start.
    pub(super) poses: Vec<Pose>,
}
