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
    pub(crate) rows: Vec<OfRow>,
    pub(crate) facets: Vec<OfFacet>,
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
    /// Nodes: those of the facets around the node first, then those of the facets that these meet.
    pub nodes: Vec<NodeId>,
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
    /// ν_e.
    pub normal: Vec3,
    /// D_j.
    pub d: [f64; MAX_FACET_NODES],
    /// D⁰_j.
    pub full: [f64; MAX_FACET_NODES],
    /// M_jl, row by row.
    pub m: Vec<f64>,
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
        self.stamp = other.stamp;
        self.rows.clone_from(&other.rows);
        self.facets.clone_from(&other.facets);
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
