//! What the parts of a model are made from.

use super::constraints::{Followers, Ties};
use super::parts::CarrierPart;
use super::spaces::Spaces;
use super::substance::Substance;
use crate::load::RadiationConstants;
use crate::system::{Activity, Elimination, Idealisation, Layout, RigidMass};
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::surface::Pose;
use signorini_geometry::tensor::Vec3;
use std::collections::HashMap;
use std::sync::Arc;

/// What the parts of a model are made from.
pub(super) struct Context<'a> {
    pub mesh: &'a Mesh,
    pub singles: &'a Singles<'a>,
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
    /// The constants of radiation, where they are known.
    pub radiation: Option<RadiationConstants>,
    pub ties: &'a Ties,
    /// Poses of the carriers at the start.
    pub poses: Vec<Pose>,
    /// Which cells take part in which step.
    pub activity: Arc<Activity>,
}

/// What nodes that no body has are left with.
pub(super) struct Singles<'a> {
    /// Of each node, whether no body has it, no constraint and no spring names it, and it has no mass: nothing follows from a
    /// load on it.
    pub loose: Vec<bool>,
    /// Whether a mass is all that it has.
    pub alone: Vec<bool>,
    /// Masses at nodes.
    pub masses: &'a [(NodeId, f64)],
}

impl<'a> Singles<'a> {
    pub fn new(
        body_of_node: &[u32],
        followers: &Followers<'_>,
        masses: &'a [(NodeId, f64)],
    ) -> Self {
        let mut loose: Vec<bool> = body_of_node.iter().map(|&body| body == u32::MAX).collect();
        let of_constraints = followers
            .constraints
            .iter()
            .flat_map(|one| one.kind.nodes());
        let ends = followers.springs.iter().flat_map(|spring| &spring.ends);
        let of_springs = ends.flat_map(|&(a, b)| [Some(a), b]).flatten();
        for node in of_constraints.chain(of_springs) {
            if let Some(loose) = loose.get_mut(node as usize) {
                *loose = false;
            }
        }
        let mut alone = vec![false; loose.len()];
        for &(node, _) in masses {
            let node = node as usize;
            if let (Some(alone), Some(loose)) = (alone.get_mut(node), loose.get_mut(node)) {
                *alone |= std::mem::take(loose);
            }
        }
        Self {
            loose,
            alone,
            masses,
        }
    }
}
