//! What the planes of a model and of its bodies stand for.

use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;
use signorini_io::case::{self, Space, Thickness};
use signorini_mechanics::system::{Idealisation, profile_at};
use std::sync::Arc;

/// What the plane of the model stands for.
pub(super) fn idealisation(model: &case::Model) -> Idealisation {
    standing_for(model.space.value, model.thickness)
}

/// What the plane of a body stands for, where it says something of its own.
#[derive(Clone)]
pub(super) struct OwnPlane {
    pub space: Idealisation,
    /// What its thickness is multiplied by at every node of the mesh; none: 1.
    pub profile: Option<Arc<[f64]>>,
}

impl OwnPlane {
    /// Of a body, in a mesh with these thicknesses at nodes: 0 where none is known. Its nodes are asked for where it takes them.
    pub fn new(
        model: &case::Model,
        body: &case::Body,
        nodes: impl FnOnce() -> Vec<NodeId>,
        thicknesses: &[f64],
    ) -> Option<Self> {
        let space = body.space.as_ref().map(|space| space.value);
        if space.is_none() && body.thickness.is_none() {
            return None;
        }
        let space = space.unwrap_or(model.space.value);
        let (thickness, profile) = match body.thickness.as_ref().map(|of| of.value) {
            None => (model.thickness, None),
            Some(Thickness::Uniform(thickness)) => (thickness, None),
            Some(Thickness::Field) => {
                let nodes = nodes();
                let at = |&node: &NodeId| thicknesses.get(node as usize);
                let sum: f64 = nodes.iter().filter_map(at).sum();
                let mean = sum / nodes.len().max(1) as f64;
                let profile = thicknesses.iter().map(|thickness| thickness / mean);
                (mean, Some(profile.collect()))
            }
        };
        let space = standing_for(space, thickness);
        Some(Self { space, profile })
    }

    /// The extent of a facet where its nodes have these shape functions, at a position.
    pub fn extent(&self, nodes: &[NodeId], shape: &[f64], at: Vec3) -> f64 {
        let profile = self.profile.iter().flat_map(|profile| {
            let of_node = |&node: &NodeId| profile.get(node as usize).copied().unwrap_or(1.0);
            nodes.iter().map(of_node)
        });
        let profile: Vec<f64> = profile.collect();
        self.space.extent(at) * profile_at(&profile, shape)
    }

    /// The first of the nodes of its body without a thickness, where it takes that of nodes.
    pub fn gap(&self, nodes: impl FnOnce() -> Vec<NodeId>) -> Option<NodeId> {
        let profile = self.profile.as_ref()?;
        let has_one = |node: &NodeId| profile.get(*node as usize).is_some_and(|p| *p > 0.0);
        nodes().into_iter().find(|node| !has_one(node))
    }
}

fn standing_for(space: Space, thickness: f64) -> Idealisation {
    match space {
        Space::ThreeD => Idealisation::Space,
        Space::PlaneStrain => Idealisation::PlaneStrain { thickness },
        Space::PlaneStress => Idealisation::PlaneStress { thickness },
        Space::Axisymmetric => Idealisation::Axisymmetric,
    }
}
