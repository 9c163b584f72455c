//! The numbers and names of one scope of a deck, as entities of the mesh.

use crate::readers::inp::definition::Family;
use crate::readers::labels::Lookup;
use signorini_geometry::mesh::{CellId, NodeId, Set};
use std::collections::BTreeMap;

/// A named set.
#[derive(Default)]
pub(super) struct Named {
    /// As it was written first.
    pub(super) name: String,
    pub(super) set: Set,
}

pub(super) type Names = BTreeMap<String, Named>;

/// A scope whose nodes and cells are in the mesh.
pub(super) struct Space {
    pub(super) nodes: Lookup,
    pub(super) node_ids: Vec<NodeId>,
    pub(super) elements: Lookup,
    /// Nothing for elements that are no cells here.
    pub(super) cells: Vec<Option<CellId>>,
    pub(super) node_sets: Names,
    pub(super) cell_sets: Names,
    pub(super) surfaces: Names,
    pub(super) surfaces_of_nodes: Names,
    /// What numbers of nodes and elements are more than in the deck.
    pub(super) shift: [u64; 2],
    /// Numbers in the mesh of elements that are no cells, by their places.
    pub(super) special: BTreeMap<u32, u64>,
    /// The same, by the element sets that hold them.
    pub(super) special_sets: BTreeMap<String, Vec<u64>>,
}

impl Space {
    pub(super) fn names(&mut self, family: Family) -> &mut Names {
        match family {
            Family::Nodes => &mut self.node_sets,
            Family::Cells => &mut self.cell_sets,
            Family::Faces => &mut self.surfaces,
            Family::Points => &mut self.surfaces_of_nodes,
        }
    }

    pub(super) fn get(&self, family: Family, key: &str) -> Option<&Set> {
        let names = match family {
            Family::Nodes => &self.node_sets,
            Family::Cells => &self.cell_sets,
            Family::Faces => &self.surfaces,
            Family::Points => &self.surfaces_of_nodes,
        };
        names.get(key).map(|named| &named.set)
    }
}
