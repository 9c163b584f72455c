//! What an expansion makes.

use super::pattern::Pattern;
use crate::mesh::{CellId, Face, Mesh, NodeId};
use crate::tensor::Vec3;
use std::ops::Range;

/// A director: the pair of nodes on both faces of shells at a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Director {
    /// The node of the surface that it stands on: one of the mesh as given, or a new one in the middle of an edge or of a
    /// cell.
    pub node: NodeId,
    /// The node that carries `v = (u⁺ + u⁻)/2`: `node` itself, or a node of its own where there are several directors.
    pub middle: NodeId,
    /// The node that carries `d = (u⁺ − u⁻)/2`.
    pub half: NodeId,
    /// The node on the negative face.
    pub negative: NodeId,
    /// The node on the positive face.
    pub positive: NodeId,
    /// The unit normal, from the negative face to the positive one.
    pub normal: Vec3,
    /// The distance between both faces along the normal.
    pub thickness: f64,
}

/// A side of a shell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShellSide {
    /// The face that the normal points away from.
    Negative,
    /// The face that the normal points to.
    Positive,
    /// The side on an edge, from 0: edge `k` runs from corner `k` to the next.
    Edge(usize),
}

impl ShellSide {
    /// The side of this number, from 0: the negative face, the positive one, then the edges.
    #[must_use]
    pub fn numbered(number: u8) -> Self {
        match number {
            0 => Self::Negative,
            1 => Self::Positive,
            edge => Self::Edge(usize::from(edge) - 2),
        }
    }
}

/// A node with several directors.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Knot {
    /// The node.
    pub node: NodeId,
    /// Its directors.
    pub directors: Range<usize>,
}

/// Where a new node of the surface lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// In the middle of an edge with these ends, which are nodes of the mesh as given.
    Edge([NodeId; 2]),
    /// In the centre of a shell, by its number in the list.
    Cell(usize),
}

/// Where cells that are no shells went.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Kept {
    /// The new place of each cell in blocks that had shells.
    pub(super) places: Vec<Option<Vec<u32>>>,
}

impl Kept {
    /// A place that no cell has.
    pub(super) const NONE: u32 = u32::MAX;

    /// The new number of a cell of the mesh as given; `None` for a shell. Only blocks that had shells number their cells
    /// again.
    #[must_use]
    pub fn of(&self, cell: CellId) -> Option<CellId> {
        let Some(Some(places)) = self.places.get(cell.block as usize) else {
            return Some(cell);
        };
        let place = places.get(cell.index as usize).copied();
        let index = place.filter(|&index| index != Self::NONE)?;
        let block = cell.block;
        Some(CellId { block, index })
    }
}

/// A mesh with solids in place of shells.
#[derive(Clone, Debug)]
pub struct Expansion {
    /// The mesh: the nodes of the given one in front, with their numbers.
    pub mesh: Mesh,
    /// All directors, in the order of the nodes that they stand on.
    pub directors: Vec<Director>,
    /// The solids of each shell, in the order in which the shells were given.
    pub solids: Vec<Vec<CellId>>,
    /// The directors at the corners of each solid, as the nodes of its negative face; solids in the order of `solids`.
    pub corners: Vec<[u32; 4]>,
    /// Nodes with more than one director, in order.
    pub knots: Vec<Knot>,
    /// Where the new nodes of the surface lie, which follow those of the mesh as given. What is given at nodes, such as
    /// supports, holds at the middle of an edge where it holds at both ends.
    pub places: Vec<Place>,
    /// Where all other cells went.
    pub kept: Kept,
    pub(super) patterns: Vec<&'static Pattern>,
    /// The sides of edges that one shell has alone, shell by shell.
    pub(super) free: Vec<Face>,
    /// Where those of each shell start.
    pub(super) free_from: Vec<usize>,
}

impl Expansion {
    /// The faces of solids on a side of a shell; none for an edge that it does not have.
    pub fn faces(&self, shell: usize, side: ShellSide) -> impl Iterator<Item = Face> + '_ {
        let (of_all, edge) = match side {
            ShellSide::Negative => (Some(0), None),
            ShellSide::Positive => (Some(1), None),
            ShellSide::Edge(k) => (None, Some(k)),
        };
        let solids = self.solids.get(shell).map_or(&[][..], Vec::as_slice);
        let pattern = self.patterns.get(shell);
        let parts = edge.and_then(|k| pattern?.edges.get(k).copied());
        let face = |cell: &CellId, side| Face { cell: *cell, side };
        let on_faces = solids
            .iter()
            .filter_map(move |cell| Some(face(cell, of_all?)));
        let on_edge = parts.unwrap_or(&[]).iter();
        let on_edge = on_edge.filter_map(move |&(quad, side)| Some(face(solids.get(quad)?, side)));
        on_faces.chain(on_edge)
    }

    /// The faces of solids on those edges of a shell that no other shell has.
    #[must_use]
    pub fn free_edges(&self, shell: usize) -> &[Face] {
        let ends = self.free_from.get(shell).zip(self.free_from.get(shell + 1));
        let faces = ends.and_then(|(&from, &to)| self.free.get(from..to));
        faces.unwrap_or(&[])
    }

    /// The directors on a node of the surface, one but at knots; none for other nodes.
    #[must_use]
    pub fn directors_at(&self, node: NodeId) -> &[Director] {
        let from = self.directors.partition_point(|d| d.node < node);
        let rest = self.directors.get(from..).unwrap_or(&[]);
        let n = rest.partition_point(|d| d.node == node);
        rest.get(..n).unwrap_or(&[])
    }
}
