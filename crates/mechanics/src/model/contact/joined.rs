//! Bodies behind contact surfaces: the parts of the mesh whose solid cells are connected by nodes, whatever groups they are of.

use signorini_geometry::mesh::quality::parts;
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::surface::Facets;

/// The solid cells of the bodies that a surface touches.
pub(super) fn cells_behind(mesh: &Mesh, side: &Facets) -> Vec<CellId> {
    let mut touched = vec![false; mesh.nnode()];
    for node in side.all_nodes() {
        if let Some(touched) = touched.get_mut(node as usize) {
            *touched = true;
        }
    }
    let is_touched = |&node: &NodeId| touched.get(node as usize) == Some(&true);
    let mut bodies = solids(mesh);
    bodies.retain(|part| {
        let mut nodes = part.iter().flat_map(|&cell| mesh.cell(cell));
        nodes.any(is_touched)
    });
    bodies.concat()
}

fn solids(mesh: &Mesh) -> Vec<Vec<CellId>> {
    let cells: Vec<CellId> = mesh.cells(mesh.dim()).collect();
    parts(mesh, &cells)
}
