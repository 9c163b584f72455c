//! The idealisation of each body.

use super::BodyPart;
use crate::system::Idealisation;
use signorini_geometry::mesh::{CellId, NodeId};
use signorini_geometry::surface::{ContactSurface, Facets};
use std::collections::HashMap;

/// What the cells of a plane model stand for, body by body.
pub(super) struct Spaces<'a> {
    owner: &'a HashMap<CellId, usize>,
    /// That of the model.
    common: Idealisation,
    /// That of each body.
    own: Vec<Idealisation>,
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
        Self {
            owner,
            common,
            own: own.collect(),
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

    /// Of the body that a node is in; that of the model where none is.
    pub fn of_node(&self, node: NodeId) -> Idealisation {
        let body = self.body_of_node.get(node as usize);
        body.map_or(self.common, |&body| self.of_body(body as usize))
    }

    /// Of all cells behind facets, where it is the same.
    pub fn alike(&self, facets: &Facets) -> Option<Idealisation> {
        let all = self.behind(facets);
        let first = *all.first()?;
        all.iter().all(|one| *one == first).then_some(first)
    }

    /// Of the cells behind facets.
    pub fn behind(&self, facets: &Facets) -> Vec<Idealisation> {
        let of = |facet| facets.face(facet).map(|face| self.of_cell(face.cell));
        let facets = 0..facets.nfacet() as u32;
        facets.map(|f| of(f).unwrap_or(self.common)).collect()
    }
}
