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

/// Numbers of a facet, a row and a function that a row has taken over, in a checkpoint.
const FACET: usize = 2;
const ROW: usize = 4;
const FUNCTION: usize = 3;

/// Nodes that are hardly covered, or that compare points, leave their function ψ to others.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Guests {
    /// Rows that have left it.
    pub(crate) left: Vec<bool>,
    /// Rows that compare their node with its closest point.
    pub(crate) pointwise: Vec<bool>,
    /// How far the normals of a row have turned from those of its facets to those of the facets they meet; empty where none has.
    pub(crate) turned: Vec<f64>,
    /// Facets that any such row acts on; empty where there is none.
    pub(crate) turning: Vec<bool>,
    /// What each row has taken over: a facet, a place in it, and which part.
    pub(crate) taken: Vec<Vec<(u32, usize, f64)>>,
}

impl Guests {
    /// How far the normals of a row have turned.
    pub(crate) fn turn(&self, row: usize) -> f64 {
        self.turned.get(row).copied().unwrap_or(0.0)
    }

    /// Whether a row whose normals have turned acts on a facet.
    pub(crate) fn turns_on(&self, facet: u32) -> bool {
        self.turning.get(facet as usize).is_some_and(|t| *t)
    }

    /// Whether a row compares its node with its closest point.
    pub(crate) fn is_pointwise(&self, row: usize) -> bool {
        self.pointwise.get(row).is_some_and(|p| *p)
    }

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
    /// The sum of their normals, weighted with the areas that they cover.
    pub opposite: Vec3,
    /// The smooth part of the primary side that they belong to.
    pub part: u32,
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
    /// The normal along which a row acts whose normals have turned by `s`: `q/|q|`, `q = (1 − s) ν_e + s m/|m|`.
    pub(crate) fn turned(&self, s: f64) -> Vec3 {
        if s == 0.0 {
            return self.normal;
        }
        let opposite = self.opposite.normalized().unwrap_or(self.normal);
        let q = self.normal * (1.0 - s) + opposite * s;
        q.normalized().unwrap_or(self.normal)
    }

    /// How many derivatives of M there are.
    pub(crate) fn nslope(&self) -> usize {
        let nprimary = self.nodes.len();
        let nnode = self.m.len() / nprimary.max(1);
        3 * self.m.len() * (nnode + nprimary)
    }
}

impl Weights {
    /// The choices that depend on those before, for a checkpoint: the part of the primary side that each facet sees, then of each
    /// row whether it has left its function, whether it compares points, and how far its normals have turned.
    #[must_use]
    pub fn choices(&self) -> Vec<f64> {
        let number = |flag: bool| f64::from(u8::from(flag));
        let flag = |flags: &[bool], k: usize| number(flags.get(k) == Some(&true));
        let guests = &self.guests;
        let taken = |row: usize| guests.taken.get(row).map_or(&[][..], Vec::as_slice);
        let facet = |facet: usize| {
            let part = self.facets.get(facet).map_or(0, |f| f.part);
            [f64::from(part), flag(&guests.turning, facet)]
        };
        let row = |row: usize| {
            let [left, pointwise] = [&guests.left, &guests.pointwise].map(|of| flag(of, row));
            [left, pointwise, guests.turn(row), taken(row).len() as f64]
        };
        let nrow = guests.left.len();
        if self.facets.is_empty() {
            return Vec::new();
        }
        let mut out = vec![self.facets.len() as f64];
        out.extend((0..self.facets.len()).flat_map(facet));
        out.extend((0..nrow).flat_map(row));
        let functions = (0..nrow).flat_map(taken);
        out.extend(
            functions.flat_map(|&(facet, place, share)| [f64::from(facet), place as f64, share]),
        );
        out
    }

    /// Restores the choices of this many rows; returns whether the numbers are valid.
    pub fn restore_choices(&mut self, stored: &[f64], nrow: usize) -> bool {
        let Some((&nfacet, stored)) = stored.split_first() else {
            return true;
        };
        let Some((facets, stored)) = stored.split_at_checked(FACET * nfacet as usize) else {
            return false;
        };
        let Some((rows, functions)) = stored.split_at_checked(ROW * nrow) else {
            return false;
        };
        let (facets, _) = facets.as_chunks::<FACET>();
        let (rows, _) = rows.as_chunks::<ROW>();
        let (functions, rest) = functions.as_chunks::<FUNCTION>();
        let wanted: f64 = rows.iter().map(|r| r[3]).sum();
        let exists = |&[facet, place, _]: &[f64; FUNCTION]| {
            (0.0..nfacet).contains(&facet) && (0.0..MAX_FACET_NODES as f64).contains(&place)
        };
        if !rest.is_empty() || wanted != functions.len() as f64 || !functions.iter().all(exists) {
            return false;
        }
        let of_part = |&[part, _]: &[f64; FACET]| OfFacet {
            part: part as u32,
            ..OfFacet::default()
        };
        self.facets = facets.iter().map(of_part).collect();
        let mut functions = functions.iter().copied();
        let mut taken = |&[.., n]: &[f64; ROW]| {
            let of_row = functions.by_ref().take(n as usize);
            of_row
                .map(|[f, place, share]| (f as u32, place as usize, share))
                .collect()
        };
        self.guests = Guests {
            left: rows.iter().map(|r| r[0] != 0.0).collect(),
            pointwise: rows.iter().map(|r| r[1] != 0.0).collect(),
            taken: rows.iter().map(&mut taken).collect(),
            ..Guests::default()
        };
        if rows.iter().any(|r| r[2] != 0.0) {
            self.guests.turned = rows.iter().map(|r| r[2]).collect();
            self.guests.turning = facets.iter().map(|f| f[1] != 0.0).collect();
        }
        true
    }

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
