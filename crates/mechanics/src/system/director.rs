//! Directors of thin bodies: where their unknowns are.

use super::{Elimination, Layout, Relation};
use signorini_geometry::mesh::NodeId;

/// A director of a thin body: `u± = v ± d`, with the displacement `v` of the middle and half the difference `d` of the displacements
/// of its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Director {
    /// The node whose displacement is `v`.
    pub middle: NodeId,
    /// The node whose displacement is `d`.
    pub half: NodeId,
    /// Its ends on the negative and the positive face, whose displacements follow.
    pub ends: [NodeId; 2],
}

/// The directors of a model by the nodes at their ends.
#[derive(Clone, Debug, Default)]
pub struct Directors {
    all: Vec<Director>,
    /// The director of each node of the mesh, `u32::MAX` where it is at the end of none; empty without directors.
    of_end: Vec<u32>,
}

impl Directors {
    /// Those of a mesh of `nnode` nodes.
    #[must_use]
    pub fn new(all: Vec<Director>, nnode: usize) -> Self {
        let mut of_end = Vec::new();
        if !all.is_empty() {
            of_end.resize(nnode, u32::MAX);
        }
        for (number, director) in (0..).zip(&all) {
            for end in director.ends {
                if let Some(of) = of_end.get_mut(end as usize) {
                    *of = number;
                }
            }
        }
        Self { all, of_end }
    }

    /// All of them.
    #[must_use]
    pub fn all(&self) -> &[Director] {
        &self.all
    }

    /// The director that ends at a node.
    #[must_use]
    pub fn at_end(&self, node: NodeId) -> Option<&Director> {
        let number = *self.of_end.get(node as usize)?;
        self.all.get(number as usize)
    }

    /// The nodes that carry the unknowns of a solid-shell with these nodes, the negative face first: its middles, then its half
    /// differences. `None` where a node is at the end of no director.
    #[must_use]
    pub fn carriers(&self, nodes: &[NodeId]) -> Option<Vec<NodeId>> {
        let (negative, positive) = nodes.split_at(nodes.len() / 2);
        let middles = negative
            .iter()
            .map(|&node| self.at_end(node).map(|d| d.middle));
        let halves = positive
            .iter()
            .map(|&node| self.at_end(node).map(|d| d.half));
        middles.chain(halves).collect()
    }

    /// The nodes that carry the unknowns behind nodes of a mesh, these themselves where they are at the end of no director.
    pub fn behind<'a>(&'a self, nodes: &'a [NodeId]) -> impl Iterator<Item = NodeId> + 'a {
        nodes.iter().flat_map(|&node| {
            match self.at_end(node) {
                Some(director) => [Some(director.middle), Some(director.half)],
                None => [Some(node), None],
            }
            .into_iter()
            .flatten()
        })
    }
}

impl Elimination {
    /// Lets the ends of directors follow their unknowns, (E3), whatever these follow themselves.
    pub fn follow_directors(&mut self, layout: &Layout, directors: &Directors) {
        let mut relations = Vec::with_capacity(6 * directors.all().len());
        for director in directors.all() {
            for (end, sign) in director.ends.into_iter().zip([-1.0, 1.0]) {
                for axis in 0..layout.ndim() {
                    let mut relation = Relation {
                        dof: layout.node(end, axis),
                        terms: Vec::with_capacity(2),
                        turns: Vec::new(),
                    };
                    self.add_terms(
                        layout.node(director.middle, axis),
                        1.0,
                        layout,
                        &mut relation,
                    );
                    self.add_terms(
                        layout.node(director.half, axis),
                        sign,
                        layout,
                        &mut relation,
                    );
                    relations.push(relation);
                }
            }
        }
        self.relate_more(layout, relations);
    }
}
