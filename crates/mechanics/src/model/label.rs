//! Numbers of nodes as the mesh labels them.

use signorini_geometry::mesh::{CellId, Mesh, NodeId};

/// The label of a node; 0 of one that is not there.
pub(super) fn label(mesh: &Mesh, node: NodeId) -> u64 {
    mesh.node_labels.get(node as usize).copied().unwrap_or(0)
}

/// The number of a cell in the input.
pub(super) fn cell_label(mesh: &Mesh, cell: CellId) -> u64 {
    mesh.cell_label(cell).unwrap_or(0)
}
