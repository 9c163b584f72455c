//! What an expansion needs besides the mesh.

use crate::mesh::{CellId, NodeId};
use crate::tensor::Vec3;
use std::collections::BTreeMap;

/// One shell cell with its section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShellCell {
    /// The cell: a triangle or a quadrilateral of three, six, four, eight or nine nodes.
    pub cell: CellId,
    /// The number of its section.
    pub section: usize,
}

/// Thickness and offset of shells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section<'a> {
    /// The thickness where `at_nodes` has none.
    pub thickness: f64,
    /// The thickness at nodes of the mesh. It replaces the number; nodes beyond its end and nodes where it is not a number
    /// (NaN) keep the number.
    pub at_nodes: Option<&'a [f64]>,
    /// By how many thicknesses the nodes lie from the middle surface towards the positive face. At +0.5 they lie on the
    /// positive face.
    pub offset: f64,
}

impl Section<'_> {
    /// The thickness at a node of the mesh.
    #[must_use]
    pub fn thickness_at(&self, node: NodeId) -> f64 {
        let given = self.at_nodes.and_then(|t| t.get(node as usize));
        given
            .copied()
            .filter(|t| !t.is_nan())
            .unwrap_or(self.thickness)
    }
}

/// Which cells have one director at a node that they share.
#[derive(Clone, Copy, Debug)]
pub struct Joining<'a> {
    /// The largest angle between the normal of a cell and that of the reference cell, in radian, less than π/2.
    pub angle: f64,
    /// Prescribed normals, by cell and node. Cells join them within half a degree; their length does not matter.
    /// Those of other cells and of nodes that the cell does not have are ignored.
    pub given: &'a BTreeMap<(CellId, NodeId), Vec3>,
}

impl Joining<'_> {
    /// The usual angle: 20 degrees.
    pub const ANGLE: f64 = std::f64::consts::PI / 9.0;
}
