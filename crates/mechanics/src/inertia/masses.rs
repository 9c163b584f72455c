//! Masses of cells, and at nodes.

use signorini_geometry::mesh::NodeId;
use std::ops::Range;

/// Cells evaluated together: enough to be worth a task.
const CHUNK: usize = 64;

/// Masses between the nodes of cells, and at nodes.
#[derive(Default)]
pub struct Masses {
    pub(super) groups: Vec<Group>,
    /// Group, and the cells of it, of each chunk.
    chunks: Vec<(usize, Range<usize>)>,
    /// Nodes whose mass is elsewhere.
    pub(super) massless: Vec<NodeId>,
    /// The mean mass of cells.
    pub(super) mean: f64,
}

/// Cells of as many nodes.
pub(super) struct Group {
    nnode: usize,
    nodes: Vec<NodeId>,
    /// `nnode × nnode` of each cell.
    masses: Vec<f64>,
    /// a_R of each cell.
    pub damping: Vec<f64>,
}

impl Group {
    /// The nodes of each cell, and the mass between them.
    pub fn cells(&self) -> impl Iterator<Item = (&[NodeId], &[f64])> {
        let n = self.nnode.max(1);
        self.nodes
            .chunks_exact(n)
            .zip(self.masses.chunks_exact(n * n))
    }
}

impl Masses {
    /// Adds a cell with the mass between its nodes, row-major, and its damping over mass; of a point mass, of one node.
    pub fn push(&mut self, nodes: &[NodeId], masses: &[f64], damping: f64) {
        let nnode = nodes.len();
        debug_assert_eq!(masses.len(), nnode * nnode);
        let found = self.groups.iter().position(|g| g.nnode == nnode);
        let at = found.unwrap_or_else(|| {
            self.groups.push(Group {
                nnode,
                nodes: Vec::new(),
                masses: Vec::new(),
                damping: Vec::new(),
            });
            self.groups.len() - 1
        });
        let group = &mut self.groups[at];
        group.nodes.extend_from_slice(nodes);
        group.masses.extend_from_slice(masses);
        group.damping.push(damping);
    }

    /// These are all: sums up masses at the same node, whose damping is alike, and makes chunks. `massless` are nodes whose
    /// mass is elsewhere.
    #[must_use]
    pub fn complete(mut self, massless: Vec<NodeId>) -> Self {
        for group in self.groups.iter_mut().filter(|group| group.nnode == 1) {
            group.gather();
        }
        let (mut all, mut count) = (0.0, 0);
        for (number, group) in self.groups.iter().enumerate() {
            let ncell = group.damping.len();
            let starts = (0..ncell).step_by(CHUNK);
            let chunk = |first: usize| (number, first..(first + CHUNK).min(ncell));
            self.chunks.extend(starts.map(chunk));
            all += group.masses.iter().sum::<f64>();
            count += ncell;
        }
        self.mean = all / count.max(1) as f64;
        self.massless = massless;
        self
    }

    pub(super) fn nchunk(&self) -> usize {
        self.chunks.len() + self.massless.len().div_ceil(CHUNK)
    }

    /// The cells of a chunk; none where it is of nodes without mass.
    pub(super) fn chunk(&self, chunk: usize) -> Option<(&Group, Range<usize>)> {
        let (number, cells) = self.chunks.get(chunk)?;
        Some((self.groups.get(*number)?, cells.clone()))
    }

    /// The nodes without mass of a chunk.
    pub(super) fn massless_of(&self, chunk: usize) -> &[NodeId] {
        let number = chunk.saturating_sub(self.chunks.len());
        self.massless.chunks(CHUNK).nth(number).unwrap_or_default()
    }
}

impl Group {
    /// Sums up masses at the same node, whose damping is alike.
    fn gather(&mut self) {
        let masses = self.nodes.iter().zip(&self.damping).zip(&self.masses);
        let mut points: Vec<(NodeId, u64, f64)> = masses
            .map(|((node, damping), mass)| (*node, damping.to_bits(), *mass))
            .collect();
        points.sort_by_key(|(node, damping, _)| (*node, *damping));
        points.dedup_by(|next, kept| {
            let is_same = (next.0, next.1) == (kept.0, kept.1);
            if is_same {
                kept.2 += next.2;
            }
            is_same
        });
        self.nodes = points.iter().map(|point| point.0).collect();
        self.damping = points.iter().map(|point| f64::from_bits(point.1)).collect();
        self.masses = points.iter().map(|point| point.2).collect();
    }
}
