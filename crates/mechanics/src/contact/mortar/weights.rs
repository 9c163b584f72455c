//! What mortar rows see of both sides, row by row.

use super::MIN_COVERAGE;
use signorini_geometry::element::MAX_FACET_NODES;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;

/// D and M of all rows at one configuration.
#[derive(Debug, Default, PartialEq)]
pub struct Weights {
    /// Tells one configuration from all others.
    pub(crate) stamp: u64,
    /// Of how many facets derivatives are kept.
    pub(crate) room: usize,
    pub(crate) rows: Vec<OfRow>,
    pub(crate) facets: Vec<OfFacet>,
    pub(crate) guests: Guests,
}

/// Nodes that are hardly covered leave their function ψ to others.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Guests {
    /// Rows that have left it.
    pub(crate) left: Vec<bool>,
    /// What each row has taken over: a facet, a place in it, and which part.
    pub(crate) taken: Vec<Vec<(u32, usize, f64)>>,
}

impl Guests {
    /// The functions of a row: those of the facets around its node, and those taken over.
    pub(crate) fn of<'a>(
        &'a self,
        row: usize,
        around: &'a [(u32, usize)],
    ) -> impl Iterator<Item = (u32, usize, f64)> + 'a {
        let left = self.left.get(row).is_some_and(|l| *l);
        let own = around.iter().filter(move |_| !left);
        let own = own.map(|&(facet, place)| (facet, place, 1.0));
        own.chain(self.taken.get(row).into_iter().flatten().copied())
    }
}

/// One row: sums over the facets around its node.
#[derive(Debug, Default, PartialEq)]
pub struct OfRow {
    /// D_j, as an area, or a length in the plane; zero where nothing is covered.
    pub d: f64,
    /// D⁰_j.
    pub full: f64,
    /// The sum of which ν_j is the direction.
    pub normal: Vec3,
    /// Nodes: so many of the facets around the node first, then those of the facets that these meet.
    pub nodes: Vec<NodeId>,
    /// How many are of the secondary side.
    pub nsecondary: usize,
    /// `D_jk` of the former, `−M_jl` of the latter.
    pub scalar: Vec<f64>,
    /// The same with normals: what a pressure acts with.
    pub vector: Vec<Vec3>,
}

/// One secondary facet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OfFacet {
    /// The primary facets it meets.
    pub met: Vec<u32>,
    /// Their nodes, each once.
    pub nodes: Vec<NodeId>,
    /// ν_e.
    pub normal: Vec3,
    /// The cosine of the angle by which these fail to face it, in the mean over what they cover.
    pub facing: f64,
    /// D_j.
    pub d: [f64; MAX_FACET_NODES],
    /// D⁰_j.
    pub full: [f64; MAX_FACET_NODES],
    /// M_jl, row by row.
    pub m: Vec<f64>,
    /// S of quadratic triangles, row by row; empty of other facets, and where Ñ is negative beyond a bent edge.
    pub mass: Vec<f64>,
    /// `∫ψ_j ν N_k` of its own nodes, then `−∫ψ_j ν N^m_l`, row by row, of facets that are [bent](super::bend); empty of
    /// those with one normal.
    pub vectors: Vec<Vec3>,
}

impl OfFacet {
    /// How many derivatives of M there are.
    pub(crate) fn nslope(&self) -> usize {
        let nprimary = self.nodes.len();
        let nnode = self.m.len() / nprimary.max(1);
        3 * self.m.len() * (nnode + nprimary)
    }
}

impl Weights {
    /// A row, where enough of it is covered for a multiplier.
    #[must_use]
    pub fn row(&self, row: usize) -> Option<&OfRow> {
        let covered = |r: &&OfRow| r.d > MIN_COVERAGE * r.full;
        self.rows.get(row).filter(covered)
    }

    /// Whether there are any.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }
}

impl Clone for Weights {
    fn clone(&self) -> Self {
        let mut copy = Self::default();
        copy.clone_from(self);
        copy
    }

    /// Keeps the memory.
    fn clone_from(&mut self, other: &Self) {
        (self.stamp, self.room) = (other.stamp, other.room);
        self.rows.clone_from(&other.rows);
        self.facets.clone_from(&other.facets);
        self.guests.clone_from(&other.guests);
    }
}

impl Clone for OfRow {
    fn clone(&self) -> Self {
        let mut copy = Self::default();
        copy.clone_from(self);
        copy
    }

    fn clone_from(&mut self, other: &Self) {
        (self.d, self.full, self.normal) = (other.d, other.full, other.normal);
        self.nsecondary = other.nsecondary;
        self.nodes.clone_from(&other.nodes);
        self.scalar.clone_from(&other.scalar);
        self.vector.clone_from(&other.vector);
    }
}

impl OfRow {
    /// `Σ c (x − o)`: D_j times the way from the primary to the secondary side. `o` keeps rounding small.
    #[must_use]
    pub fn way(&self, o: Vec3, x: &dyn Fn(NodeId) -> Vec3) -> Vec3 {
        let terms = self.nodes.iter().zip(&self.scalar);
        terms.map(|(&n, &c)| (x(n) - o) * c).sum()
    }

    /// `Σ n·(x − o)`: D_j times the gap.
    #[must_use]
    pub fn gap(&self, o: Vec3, x: &dyn Fn(NodeId) -> Vec3) -> f64 {
        let terms = self.nodes.iter().zip(&self.vector);
        terms.map(|(&n, v)| v.dot(x(n) - o)).sum()
    }
}
