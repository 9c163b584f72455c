//! Directors of thin bodies: where their unknowns are.

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

/// The directors of a model by their nodes.
#[derive(Clone, Debug, Default)]
pub struct Directors {
    all: Vec<Director>,
    /// The director that ends at each node of the mesh, and that whose half it carries; `u32::MAX` where there is none, empty
    /// without directors.
    of_end: Vec<u32>,
    of_half: Vec<u32>,
}

impl Directors {
    /// Those of a mesh of `nnode` nodes.
    #[must_use]
    pub fn new(all: Vec<Director>, nnode: usize) -> Self {
        let nnode = if all.is_empty() { 0 } else { nnode };
        let (mut of_end, mut of_half) = (vec![u32::MAX; nnode], vec![u32::MAX; nnode]);
        for (number, director) in (0..).zip(&all) {
            for end in director.ends {
                if let Some(of) = of_end.get_mut(end as usize) {
                    *of = number;
                }
            }
            if let Some(of) = of_half.get_mut(director.half as usize) {
                *of = number;
            }
        }
        Self {
            all,
            of_end,
            of_half,
        }
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

    /// The director whose half difference a node carries.
    #[must_use]
    pub fn with_half(&self, node: NodeId) -> Option<&Director> {
        let number = *self.of_half.get(node as usize)?;
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
