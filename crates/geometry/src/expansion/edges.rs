//! Edges of shells, and which of them get a middle.
//!
//! A triangle is divided into three quadrilaterals, which needs a middle on each of its edges; elements with mid nodes have
//! them. A quadrilateral with a middle on one edge gets one on the opposite edge, and so on through its neighbours: the
//! divisions match everywhere, and a single triangle among quadrilaterals divides no more than three strips of them.

use super::shell::Shell;
use crate::element::Family;
use crate::mesh::NodeId;

/// No middle.
pub(super) const NONE: NodeId = NodeId::MAX;
/// A middle that has no number yet.
const NEW: NodeId = NodeId::MAX - 1;

/// Numbers edges by their end nodes, in either order: the number of the edge of each pair, and how many there are.
pub(super) fn number(nnode: usize, pairs: &[[NodeId; 2]]) -> (Vec<u32>, usize) {
    let low = |pair: &[NodeId; 2]| pair[0].min(pair[1]) as usize;
    let by_low = Table::new(nnode, pairs.iter().map(low));
    let mut edges = vec![0; pairs.len()];
    let mut n = 0;
    let mut here = Vec::new();
    for node in 0..nnode {
        here.clear();
        let high = |&p: &u32| (pairs[p as usize][0].max(pairs[p as usize][1]), p);
        here.extend(by_low.row(node).iter().map(high));
        here.sort_unstable();
        for same in here.chunk_by(|a, b| a.0 == b.0) {
            for &(_, pair) in same {
                edges[pair as usize] = n as u32;
            }
            n += 1;
        }
    }
    (edges, n)
}

/// Rows of numbers.
pub(super) struct Table {
    start: Vec<u32>,
    entries: Vec<u32>,
}

impl Table {
    /// Puts item `i` into the row that `rows` names for it; items of a row stay in order.
    pub(super) fn new(nrow: usize, rows: impl Iterator<Item = usize> + Clone) -> Self {
        let mut start = vec![0u32; nrow + 1];
        rows.clone().for_each(|row| start[row + 1] += 1);
        for row in 0..nrow {
            start[row + 1] += start[row];
        }
        let mut next = start.clone();
        let mut entries = vec![0; start[nrow] as usize];
        for (item, row) in rows.enumerate() {
            entries[next[row] as usize] = item as u32;
            next[row] += 1;
        }
        Self { start, entries }
    }

    /// The items of a row.
    pub(super) fn row(&self, row: usize) -> &[u32] {
        &self.entries[self.start[row] as usize..self.start[row + 1] as usize]
    }
}

/// The middles of all edges.
pub(super) struct Middles {
    /// Where the edges of each shell start in `edges`.
    first: Vec<u32>,
    /// The edge behind each edge of each shell.
    edges: Vec<u32>,
    /// The node in the middle of each edge, [`NONE`] where it is not divided.
    nodes: Vec<NodeId>,
    /// The ends of the edges with new nodes, in the order of these, the lower number first.
    pub ends: Vec<[NodeId; 2]>,
}

impl Middles {
    /// Which edges have a middle; new ones are numbered from `nnode` on.
    pub(super) fn new(nnode: usize, shells: &[Shell<'_>]) -> Self {
        let (mut first, mut pairs, mut owners) = (vec![0], Vec::new(), Vec::new());
        for (number, shell) in shells.iter().enumerate() {
            let ends = shell.element.edges().iter();
            pairs.extend(ends.map(|&ends| ends.map(|i| shell.nodes[i])));
            owners.resize(pairs.len(), number as u32);
            first.push(pairs.len() as u32);
        }
        let (edges, nedge) = number(nnode, &pairs);
        let mut this = Self {
            first,
            edges,
            nodes: vec![NONE; nedge],
            ends: Vec::new(),
        };
        this.spread(shells, &owners);
        for (pair, &edge) in pairs.iter_mut().zip(&this.edges) {
            let node = &mut this.nodes[edge as usize];
            if *node == NEW {
                *node = (nnode + this.ends.len()) as NodeId;
                pair.sort_unstable();
                this.ends.push(*pair);
            }
        }
        this
    }

    fn spread(&mut self, shells: &[Shell<'_>], owners: &[u32]) {
        for (number, shell) in shells.iter().enumerate() {
            for (mid, _) in shell.element.mid_nodes() {
                let edge = self.edge(number, mid - shell.element.ncorner());
                if self.nodes[edge] == NONE {
                    self.nodes[edge] = shell.nodes[mid];
                }
            }
        }
        let triangles = |s: &&(usize, &Shell<'_>)| s.1.element.family() == Family::Triangle;
        for (number, shell) in shells.iter().enumerate().filter(|s| triangles(&s)) {
            for k in 0..shell.element.ncorner() {
                let edge = self.edge(number, k);
                if self.nodes[edge] == NONE {
                    self.nodes[edge] = NEW;
                }
            }
        }
        let mut divided: Vec<usize> = (0..self.nodes.len())
            .filter(|&edge| self.nodes[edge] != NONE)
            .collect();
        if divided.is_empty() {
            return;
        }
        let users = Table::new(self.nodes.len(), self.edges.iter().map(|&e| e as usize));
        while let Some(edge) = divided.pop() {
            for &place in users.row(edge) {
                let number = owners[place as usize] as usize;
                if shells[number].element.family() != Family::Quadrilateral {
                    continue;
                }
                let k = (place - self.first[number]) as usize;
                let opposite = self.edge(number, (k + 2) % 4);
                if self.nodes[opposite] == NONE {
                    self.nodes[opposite] = NEW;
                    divided.push(opposite);
                }
            }
        }
    }

    fn edge(&self, shell: usize, k: usize) -> usize {
        self.edges[self.first[shell] as usize + k] as usize
    }

    /// The node in the middle of edge `k` of a shell, [`NONE`] where it is not divided.
    pub(super) fn of(&self, shell: usize, k: usize) -> NodeId {
        self.nodes[self.edge(shell, k)]
    }
}
