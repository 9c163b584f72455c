//! The shells of a model, once solids are in their place.

use super::joints::Joints;
use signorini_geometry::expansion::{self, Expansion, Place, ShellSide};
use signorini_geometry::mesh::{CellId, Face, Mesh, NodeId};
use signorini_mechanics::system::Director;
use std::collections::HashMap;

/// The shells of a model.
#[derive(Default)]
pub(in crate::setup) struct Shells {
    /// What became of them; the mesh is empty.
    expansion: Option<Expansion>,
    /// The number of the shell behind each element of the input.
    by_label: HashMap<u64, usize>,
    /// Nodes before this one are those of the input.
    first: usize,
    /// The node of the surface behind each node from there on.
    behind: Vec<NodeId>,
    /// The nodes of the input that each of the first of these lies between.
    parents: Vec<Vec<NodeId>>,
    joints: Joints,
}

impl Shells {
    /// Those of an expansion of some cells of a mesh, with the mesh that has solids in their place.
    pub fn new(mut expansion: Expansion, cells: &[CellId], given: &Mesh) -> (Mesh, Self) {
        let labels = cells.iter().zip(0..);
        let labels = labels.filter_map(|(&cell, number)| Some((given.cell_label(cell)?, number)));
        let by_label = labels.collect();
        let mut mesh = std::mem::take(&mut expansion.mesh);
        let joints = Joints::new(&mut expansion, &mut mesh);
        let first = given.nnode();
        let parents = expansion.places.iter().map(|place| match place {
            Place::Edge(ends) => ends.to_vec(),
            Place::Cell(shell) => {
                let cell = cells.get(*shell).map_or(&[][..], |&cell| given.cell(cell));
                cell.to_vec()
            }
        });
        let parents = parents.collect();
        let mut behind: Vec<NodeId> = (first..mesh.nnode()).map(|node| node as NodeId).collect();
        for director in &expansion.directors {
            for node in [
                director.middle,
                director.half,
                director.negative,
                director.positive,
            ] {
                let place = (node as usize).checked_sub(first);
                if let Some(behind) = place.and_then(|place| behind.get_mut(place)) {
                    *behind = director.node;
                }
            }
        }
        let shells = Self {
            expansion: Some(expansion),
            by_label,
            first,
            behind,
            parents,
            joints,
        };
        (mesh, shells)
    }

    /// Where shells meet that have directors of their own.
    pub const fn joints(&self) -> &Joints {
        &self.joints
    }

    /// Whether there are none.
    pub const fn is_empty(&self) -> bool {
        self.expansion.is_none()
    }

    /// All directors, in the order of the nodes that they stand on.
    pub fn directors(&self) -> &[expansion::Director] {
        self.expansion.as_ref().map_or(&[], |of| &of.directors)
    }

    /// The directors on a node of the surface.
    pub fn directors_at(&self, node: NodeId) -> &[expansion::Director] {
        self.expansion
            .as_ref()
            .map_or(&[], |of| of.directors_at(node))
    }

    /// All directors by their nodes.
    pub fn parts(&self) -> Vec<Director> {
        let of_nodes = |one: &expansion::Director| Director {
            middle: one.middle,
            half: one.half,
            ends: [one.negative, one.positive],
        };
        self.directors().iter().map(of_nodes).collect()
    }

    /// Puts the nodes of the surface in the place of those of solids, each once. Sorted.
    pub fn to_surface(&self, nodes: &mut Vec<NodeId>) {
        if self.is_empty() {
            return;
        }
        for node in nodes.iter_mut() {
            let place = (*node as usize).checked_sub(self.first);
            if let Some(&behind) = place.and_then(|place| self.behind.get(place)) {
                *node = behind;
            }
        }
        nodes.sort_unstable();
        nodes.dedup();
    }

    /// New nodes of the surface, each with the nodes of the input that it lies between: on an edge, or in an element.
    pub(super) fn between(&self) -> impl Iterator<Item = (NodeId, &[NodeId])> {
        let nodes = self.first..;
        let nodes = nodes.map(|node| node as NodeId);
        nodes.zip(self.parents.iter().map(Vec::as_slice))
    }

    /// Adds the nodes that lie between these, on edges and in elements all of whose nodes are among them. Sorted.
    pub fn add_between(&self, nodes: &mut Vec<NodeId>) {
        let has = |node: &NodeId| nodes.binary_search(node).is_ok();
        let more = self
            .between()
            .filter(|(_, parents)| parents.iter().all(has));
        let more: Vec<NodeId> = more.map(|(node, _)| node).collect();
        nodes.extend(more);
        nodes.sort_unstable();
        nodes.dedup();
    }

    /// The solids of an element of the input, where it is a shell.
    pub fn solids(&self, label: u64) -> Option<&[CellId]> {
        let number = *self.by_label.get(&label)?;
        self.expansion
            .as_ref()?
            .solids
            .get(number)
            .map(Vec::as_slice)
    }

    /// The faces of a side of an element of the input, where it is a shell: 1 negative, 2 positive, 3 and more its edges.
    pub fn side(&self, label: u64, side: u8) -> Option<Vec<Face>> {
        let number = *self.by_label.get(&label)?;
        let side = ShellSide::numbered(side.checked_sub(1)?);
        Some(self.expansion.as_ref()?.faces(number, side).collect())
    }
}
