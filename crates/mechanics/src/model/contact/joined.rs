//! Which facets are of one body: what shares nodes.

use signorini_geometry::mesh::{CellId, Mesh};
use signorini_geometry::surface::{ContactSurface, Facets};

/// A number for each facet that it shares with all facets of the same body and with no other. A body is what hangs
/// together by the nodes of solid elements, whatever groups it is of.
pub(super) fn bodies(mesh: &Mesh, facets: &Facets) -> Vec<u32> {
    let mut parent: Vec<u32> = (0..mesh.points.len() as u32).collect();
    let solids = mesh.cells(mesh.dim());
    for cell in solids {
        join(mesh, cell, &mut parent);
    }
    let of = |facet: u32| {
        let first = facets.nodes(facet).first();
        first.map_or(0, |&node| root(&mut parent, node))
    };
    (0..facets.nfacet() as u32).map(of).collect()
}

fn join(mesh: &Mesh, cell: CellId, parent: &mut [u32]) {
    let Some((&first, others)) = mesh.cell(cell).split_first() else {
        return;
    };
    for &node in others {
        let (a, b) = (root(parent, first), root(parent, node));
        if let Some(higher) = parent.get_mut(a.max(b) as usize) {
            *higher = a.min(b);
        }
    }
}

/// The lowest node known to hang together with a node.
fn root(parent: &mut [u32], node: u32) -> u32 {
    let mut at = node;
    while let Some(&above) = parent.get(at as usize)
        && above != at
    {
        // every other one on the way is tied to what is above it
        let next = parent.get(above as usize).copied().unwrap_or(above);
        if let Some(own) = parent.get_mut(at as usize) {
            *own = next;
        }
        at = next;
    }
    at
}
