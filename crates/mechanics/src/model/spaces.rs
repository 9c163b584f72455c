//! The idealisation of each body.

use super::BodyPart;
use crate::system::{Idealisation, profile_at};
use signorini_geometry::mesh::{CellId, NodeId};
use signorini_geometry::surface::{ContactSurface, Facets};
use signorini_geometry::tensor::Vec3;
use std::collections::HashMap;
use std::sync::Arc;

/// What the cells of a plane model stand for, body by body.
pub(super) struct Spaces<'a> {
    owner: &'a HashMap<CellId, usize>,
    /// That of the model.
    common: Idealisation,
    /// That of each body.
    own: Vec<Idealisation>,
    /// The profile of each body, where it has one.
    profiles: Vec<Option<Arc<[f64]>>>,
    /// The body of each node.
    body_of_node: &'a [u32],
}

impl<'a> Spaces<'a> {
    pub fn new(
        common: Idealisation,
        owner: &'a HashMap<CellId, usize>,
        body_of_node: &'a [u32],
        bodies: &[BodyPart],
    ) -> Self {
        let own = bodies.iter().map(|body| body.kind.space(common));
        let profiles = bodies.iter().map(|body| body.kind.profile().cloned());
        Self {
            owner,
            common,
            own: own.collect(),
            profiles: profiles.collect(),
            body_of_node,
        }
    }

    /// Of a body.
    pub fn of_body(&self, body: usize) -> Idealisation {
        self.own.get(body).copied().unwrap_or(self.common)
    }

    /// Of a cell; that of the model where no body has it.
    pub fn of_cell(&self, cell: CellId) -> Idealisation {
        let body = self.owner.get(&cell);
        body.map_or(self.common, |&body| self.of_body(body))
    }

    /// The extent at a node of a body; in the plane of the model where none has the node.
    pub fn extent_of_node(&self, node: NodeId, at: Vec3) -> f64 {
        let body = self.body_of_node.get(node as usize);
        let body = body.map_or(usize::MAX, |&body| body as usize);
        self.of_body(body).extent(at) * self.profile_at(body, node)
    }

    /// What the thickness of a body is multiplied by at a node.
    fn profile_at(&self, body: usize, node: NodeId) -> f64 {
        let profile = self.profiles.get(body).and_then(Option::as_deref);
        profile.map_or(1.0, |of| of.get(node as usize).copied().unwrap_or(1.0))
    }

    /// Of all cells behind facets, where it is the same.
    pub fn alike(&self, facets: &Facets) -> Option<Idealisation> {
        let all = self.behind(facets).spaces;
        let first = *all.first()?;
        all.iter().all(|one| *one == first).then_some(first)
    }

    /// Of the cells behind facets.
    pub fn behind(&self, facets: &Facets) -> Extents {
        let mut extents = Extents::default();
        let has_profiles = self.profiles.iter().any(Option::is_some);
        for facet in 0..facets.nfacet() as u32 {
            let body = facets.face(facet);
            let body = body.and_then(|face| self.owner.get(&face.cell));
            let body = body.map_or(usize::MAX, |&body| body);
            extents.spaces.push(self.of_body(body));
            if has_profiles {
                let nodes = facets.nodes(facet).iter();
                let at_nodes = nodes.map(|&node| self.profile_at(body, node));
                extents.profiles.push(at_nodes.collect());
            }
        }
        extents
    }
}

/// What the plane stands for behind facets.
#[derive(Default)]
pub(super) struct Extents {
    /// Of each facet.
    pub spaces: Vec<Idealisation>,
    /// What the thickness is multiplied by at the nodes of each facet; empty where it is 1 everywhere.
    profiles: Vec<Vec<f64>>,
}

impl Extents {
    /// The extent across a facet where its nodes have these shape functions, at a position.
    pub fn at(&self, facet: u32, shape: &[f64], at: Vec3) -> f64 {
        let space = self.spaces.get(facet as usize);
        let extent = space.map_or(1.0, |space| space.extent(at));
        let profile = self.profiles.get(facet as usize);
        extent * profile_at(profile.map_or(&[], Vec::as_slice), shape)
    }
}
