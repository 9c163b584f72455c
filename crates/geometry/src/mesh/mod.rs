//! Meshes: points, cells, named sets, the faces of solids. Topology only; no field lives here.
//!
//! ```text
//! Mesh ── points, labels
//!      ├─ blocks: cells of one element each      CellId = (block, index)
//!      └─ sets by name: nodes, cells, faces      Face   = (cell, side)
//! ```
//!
//! Inside, everything is numbered from 0 without gaps; the numbers a user wrote are kept as *labels* and are all
//! that a message ever shows. A cell of lower dimension than the solids (a triangle on a tetrahedron's side) stands
//! for the face it coincides with: see [`Mesh::faces`]. What lies where is found in [`select`], how good cells are in
//! [`quality`].

pub mod quality;
pub mod select;
#[cfg(test)]
mod testing;
mod topology;

pub use topology::{FaceIndex, SetError, boundary};

use crate::element::Element;
use crate::tensor::Vec3;
use std::collections::BTreeMap;

/// The number of a node, from 0.
pub type NodeId = u32;

/// A cell: the block it is in and its place there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct CellId {
    /// Number of the block.
    pub block: u32,
    /// Place within the block.
    pub index: u32,
}

/// A face of a solid: a cell and one of its sides (an edge, in the plane).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Face {
    /// The cell.
    pub cell: CellId,
    /// Number of the side, from 0, in the order of [`crate::element::ReferenceElement::sides`].
    pub side: u8,
}

/// Cells of one element.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// The reference element of every cell here.
    pub element: Element,
    /// Node numbers, `nnode` of the element for each cell.
    pub nodes: Vec<NodeId>,
    /// The number each cell has in the input.
    pub labels: Vec<u64>,
}

impl Block {
    /// An empty block.
    #[must_use]
    pub const fn new(element: Element) -> Self {
        Self {
            element,
            nodes: Vec::new(),
            labels: Vec::new(),
        }
    }

    /// The number of cells.
    #[must_use]
    pub fn ncell(&self) -> usize {
        self.labels.len()
    }

    /// The nodes of a cell; empty where there is no such cell.
    #[must_use]
    pub fn cell(&self, index: usize) -> &[NodeId] {
        let n = self.element.nnode();
        self.nodes.get(index * n..(index + 1) * n).unwrap_or(&[])
    }
}

/// What a name stands for: any mixture of nodes, cells and faces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Set {
    /// Nodes named directly.
    pub nodes: Vec<NodeId>,
    /// Cells, of any dimension.
    pub cells: Vec<CellId>,
    /// Faces of solids.
    pub faces: Vec<Face>,
}

impl Set {
    /// Whether nothing is in it.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty() && self.cells.is_empty() && self.faces.is_empty()
    }

    /// Whether nodes are in it, and nothing else.
    #[must_use]
    pub fn is_bare(&self) -> bool {
        !self.nodes.is_empty() && self.cells.is_empty() && self.faces.is_empty()
    }
}

/// A mesh.
///
/// # Example
/// ```
/// use signorini_geometry::element::by_name;
/// use signorini_geometry::mesh::{Mesh, boundary};
/// use signorini_geometry::tensor::Vec3;
///
/// let brick = by_name("hex8").ok_or("not in the table")?;
/// let mut mesh = Mesh::default();
/// for z in 0..3 {
///     for [x, y] in [[0, 0], [1, 0], [1, 1], [0, 1]] {
///         mesh.points.push(Vec3::from([x, y, z].map(f64::from)));
///         mesh.node_labels.push(mesh.points.len() as u64);
///     }
/// }
/// mesh.push_cell(brick, &[0, 1, 2, 3, 4, 5, 6, 7], 1);
/// mesh.push_cell(brick, &[4, 5, 6, 7, 8, 9, 10, 11], 2);
/// assert_eq!((mesh.nnode(), mesh.ncell(), mesh.dim()), (12, 2, 3));
/// // two bricks have twelve sides, of which they share one
/// assert_eq!(boundary(&mesh, mesh.cells(3)).len(), 10);
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Positions of the nodes.
    pub points: Vec<Vec3>,
    /// The number each node has in the input.
    pub node_labels: Vec<u64>,
    /// The cells, block by block.
    pub blocks: Vec<Block>,
    /// Named sets.
    pub sets: BTreeMap<String, Set>,
}

impl Mesh {
    /// The number of nodes.
    #[must_use]
    pub fn nnode(&self) -> usize {
        self.points.len()
    }

    /// The number of cells of all dimensions.
    #[must_use]
    pub fn ncell(&self) -> usize {
        self.blocks.iter().map(Block::ncell).sum()
    }

    /// The highest dimension among the cells: 3 for solids in space, 2 in the plane; 0 without cells.
    #[must_use]
    pub fn dim(&self) -> usize {
        self.blocks
            .iter()
            .filter(|b| b.ncell() > 0)
            .map(|b| b.element.dim())
            .max()
            .unwrap_or(0)
    }

    /// The block of this element, made when it does not exist yet.
    pub fn block_mut(&mut self, element: Element) -> (u32, &mut Block) {
        let found = self.blocks.iter().position(|b| *b.element == *element);
        let at = found.unwrap_or_else(|| {
            self.blocks.push(Block::new(element));
            self.blocks.len() - 1
        });
        (at as u32, &mut self.blocks[at])
    }

    /// Appends a cell and says where it went. `nodes` must have as many entries as the element has nodes.
    pub fn push_cell(&mut self, element: Element, nodes: &[NodeId], label: u64) -> CellId {
        debug_assert_eq!(nodes.len(), element.nnode());
        let (block, cells) = self.block_mut(element);
        cells.nodes.extend_from_slice(nodes);
        cells.labels.push(label);
        CellId {
            block,
            index: (cells.labels.len() - 1) as u32,
        }
    }

    /// The element of a cell.
    #[must_use]
    pub fn element(&self, cell: CellId) -> Option<Element> {
        self.blocks.get(cell.block as usize).map(|b| b.element)
    }

    /// The nodes of a cell; empty where there is no such cell.
    #[must_use]
    pub fn cell(&self, cell: CellId) -> &[NodeId] {
        self.blocks
            .get(cell.block as usize)
            .map_or(&[], |b| b.cell(cell.index as usize))
    }

    /// The number a cell has in the input.
    #[must_use]
    pub fn cell_label(&self, cell: CellId) -> Option<u64> {
        let block = self.blocks.get(cell.block as usize)?;
        block.labels.get(cell.index as usize).copied()
    }

    /// Every cell of dimension `dim`.
    pub fn cells(&self, dim: usize) -> impl Iterator<Item = CellId> + '_ {
        self.blocks
            .iter()
            .enumerate()
            .filter(move |(_, b)| b.element.dim() == dim)
            .flat_map(|(block, b)| {
                (0..b.ncell()).map(move |index| CellId {
                    block: block as u32,
                    index: index as u32,
                })
            })
    }

    /// The element and the nodes of a face, in the order that makes its normal point out of the cell.
    #[must_use]
    pub fn face(&self, face: Face) -> Option<(Element, Vec<NodeId>)> {
        let cell = self.cell(face.cell);
        let side = self.element(face.cell)?.sides().get(face.side as usize)?;
        let nodes = side.nodes.iter().map(|&i| cell.get(i).copied());
        Some((side.element, nodes.collect::<Option<_>>()?))
    }
}
