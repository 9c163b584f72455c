//! Which body is behind a facet.

use super::{ContactSurface, Facets};
use crate::mesh::quality::parts;
use crate::mesh::{CellId, Mesh};

/// A number for each facet that it shares with all facets of the same body and with no other. Bodies are made of these
/// cells: those that are connected by nodes. A node of no cell is a body of its own.
#[must_use]
pub fn bodies(mesh: &Mesh, cells: &[CellId], facets: &Facets) -> Vec<u32> {
    let mut body: Vec<Option<u32>> = vec![None; mesh.nnode()];
    for (number, part) in (0..).zip(&parts(mesh, cells)) {
        for &node in part.iter().flat_map(|&cell| mesh.cell(cell)) {
            if let Some(body) = body.get_mut(node as usize) {
                *body = Some(number);
            }
        }
    }
    let of = |facet: u32| {
        let node = facets.nodes(facet).first().copied().unwrap_or_default();
        let body = body.get(node as usize).copied().flatten();
        // numbers of nodes begin at the other end
        body.unwrap_or(u32::MAX - node)
    };
    (0..facets.nfacet() as u32).map(of).collect()
}
