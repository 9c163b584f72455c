//! Which body is behind a facet.

use super::{ContactSurface, Facets};
use crate::mesh::quality::parts;
use crate::mesh::{CellId, Mesh, NodeId};

/// Bodies made of cells: those that are connected by nodes. Found once, whatever the number of surfaces.
#[derive(Clone, Debug)]
pub struct Bodies {
    of_node: Vec<Option<u32>>,
}

impl Bodies {
    /// Those of these cells.
    #[must_use]
    pub fn new(mesh: &Mesh, cells: &[CellId]) -> Self {
        let mut of_node = vec![None; mesh.nnode()];
        for (number, part) in (0..).zip(&parts(mesh, cells)) {
            for &node in part.iter().flat_map(|&cell| mesh.cell(cell)) {
                if let Some(body) = of_node.get_mut(node as usize) {
                    *body = Some(number);
                }
            }
        }
        Self { of_node }
    }

    /// The number of the body of a node; none where it is of no cell.
    #[must_use]
    pub fn of(&self, node: NodeId) -> Option<u32> {
        self.of_node.get(node as usize).copied().flatten()
    }

    /// The number of the body behind each facet of a surface. A node of no cell is a body of its own.
    #[must_use]
    pub fn behind(&self, facets: &Facets) -> Vec<u32> {
        let of = |facet: u32| {
            let node = facets.nodes(facet).first().copied().unwrap_or_default();
            // numbers of nodes begin at the other end
            self.of(node).unwrap_or(u32::MAX - node)
        };
        (0..facets.nfacet() as u32).map(of).collect()
    }
}

/// A number for each facet that it shares with all facets of the same body and with no other. Bodies are made of these
/// cells: those that are connected by nodes. A node of no cell is a body of its own.
#[must_use]
pub fn bodies(mesh: &Mesh, cells: &[CellId], facets: &Facets) -> Vec<u32> {
    Bodies::new(mesh, cells).behind(facets)
}
