//! What an element answers for itself.

use super::family::Family;
use super::properties::{DualBasis, LockingClass};
use super::quadrature::{Rule, Rules};
use crate::tensor::{Sym3, Vec3};
use std::fmt;
use std::ops::Range;

/// The largest number of nodes an element may have.
pub const MAX_NODES: usize = 27;

/// The largest number of nodes a contact facet may have.
pub const MAX_FACET_NODES: usize = 10;

/// A reference element: the one description of it that meshes, solids and contact surfaces share.
///
/// # Example
/// ```
/// use signorini_geometry::element::by_name;
///
/// // the volume of the reference tetrahedron
/// let tetrahedron = by_name("tet10").ok_or("not in the table")?;
/// let volume: f64 = tetrahedron.full_rule().iter().map(|(_, weight)| weight).sum();
/// assert!((volume - 1.0 / 6.0).abs() < 1e-15);
/// # Ok::<(), &str>(())
/// ```
pub trait ReferenceElement: Send + Sync {
    /// The name in cases and messages, such as `"quad4"`.
    fn name(&self) -> &'static str;

    /// The shape of the reference domain, which has the corners and edges.
    fn family(&self) -> Family;

    /// The degree of the shape functions along an edge: 1, 2, 3 for two, three, four nodes on it.
    fn order(&self) -> usize;

    /// The degree of the shape functions as polynomials of all parameters together: 2 for quad4, which has `ξη`.
    fn degree(&self) -> usize;

    /// How it locks as a solid.
    fn locking_class(&self) -> LockingClass;

    /// What makes a dual basis of it as a contact facet; `None` where there is none, so that mortar contact refuses it.
    fn dual_basis(&self) -> Option<DualBasis> {
        None
    }

    /// The reference coordinates of the nodes; as many as the element has nodes.
    fn nodes(&self) -> &'static [Vec3];

    /// Shape functions at `xi`. `n` has `nnode` entries.
    fn shape(&self, xi: &Vec3, n: &mut [f64]);

    /// First derivatives of the shape functions at `xi`. `dn` has `nnode` entries.
    fn dshape(&self, xi: &Vec3, dn: &mut [Vec3]);

    /// Second derivatives of the shape functions at `xi`. `ddn` has `nnode` entries.
    fn ddshape(&self, xi: &Vec3, ddn: &mut [Sym3]);

    /// The sides (faces in space, edges in the plane), normals pointing out. In Abaqus's order S1, S2, ….
    fn sides(&self) -> &'static [Side];

    /// The rules of integration, by purpose.
    fn rules(&self) -> Rules;

    /// [`Rules::full`].
    fn full_rule(&self) -> &'static Rule {
        self.rules().full
    }

    /// [`Rules::reduced`].
    fn reduced_rule(&self) -> &'static Rule {
        self.rules().reduced
    }

    /// [`Rules::surface`].
    fn surface_rule(&self) -> &'static Rule {
        self.rules().surface
    }

    /// The dimension of the reference domain: 1, 2 or 3.
    fn dim(&self) -> usize {
        self.family().dim()
    }

    /// The edges as pairs of end nodes, in the order in which they bound the element (faces: round the boundary). In the
    /// reference domain they are straight; nodes inside of them follow the corners in this order.
    fn edges(&self) -> &'static [[usize; 2]] {
        self.family().edges()
    }

    /// Whether `xi` lies in the reference domain, exceeded by at most `tolerance`.
    fn contains(&self, xi: &Vec3, tolerance: f64) -> bool {
        self.family().contains(xi, tolerance)
    }

    /// The middle of the reference domain.
    fn centre(&self) -> Vec3 {
        let nodes = self.nodes();
        nodes.iter().copied().sum::<Vec3>() / nodes.len() as f64
    }

    /// The number of nodes.
    fn nnode(&self) -> usize {
        self.nodes().len()
    }

    /// The number of corners, the nodes in which edges end. They come first.
    fn ncorner(&self) -> usize {
        self.family().ncorner()
    }
}

/// A node inside of an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeNode {
    /// Its local number.
    pub node: usize,
    /// The corners in which its edge starts and ends.
    pub ends: [usize; 2],
    /// Which part of the way from the start to the end it lies at, in the reference domain.
    pub part: f64,
}

impl EdgeNode {
    /// Where it would be if the edge were straight, with nodes at equal distances.
    #[must_use]
    pub fn straight(&self, [start, end]: [Vec3; 2]) -> Vec3 {
        start * (1.0 - self.part) + end * self.part
    }
}

impl dyn ReferenceElement {
    /// Whether its nodes are the corners.
    #[must_use]
    pub fn is_linear(&self) -> bool {
        self.order() == 1
    }

    /// The nodes inside of an edge, from its start to its end.
    #[must_use]
    pub fn inside_edge(&self, edge: usize) -> Range<usize> {
        let n = self.order() - 1;
        let first = self.ncorner() + edge * n;
        first..first + n
    }

    /// The nodes inside of all edges, edge by edge.
    pub fn edge_nodes(&self) -> impl Iterator<Item = EdgeNode> + '_ {
        let over = 1.0 / self.order() as f64;
        let of_edge = move |(edge, &ends): (usize, &[usize; 2])| {
            let inside = self.inside_edge(edge).enumerate();
            inside.map(move |(k, node)| EdgeNode {
                node,
                ends,
                part: (k + 1) as f64 * over,
            })
        };
        self.edges().iter().enumerate().flat_map(of_edge)
    }

    /// The nodes halfway along edges, each with the two corners that it lies between.
    pub fn mid_nodes(&self) -> impl Iterator<Item = (usize, [usize; 2])> + '_ {
        let halfway = self.edge_nodes().filter(|of| of.part == 0.5);
        halfway.map(|of| (of.node, of.ends))
    }

    /// The nodes round the boundary of a face, from its first corner on: every edge has its start, then the nodes inside of
    /// it.
    pub fn ring(&self) -> impl Iterator<Item = usize> + '_ {
        let of_edge = |(edge, &[start, _]): (usize, &[usize; 2])| {
            std::iter::once(start).chain(self.inside_edge(edge))
        };
        self.edges().iter().enumerate().flat_map(of_edge)
    }

    /// Whether every node takes a part of an even pressure on it as a facet: all `∫N` are positive.
    #[must_use]
    pub fn shares_even_pressure(&self) -> bool {
        let n = self.nnode();
        let mut sums = [0.0; MAX_NODES];
        let mut shape = [0.0; MAX_NODES];
        let mut total = 0.0;
        for (xi, weight) in self.surface_rule().iter() {
            self.shape(xi, &mut shape[..n]);
            total += weight;
            for (sum, n) in sums.iter_mut().zip(shape) {
                *sum += weight * n;
            }
        }
        // that of a corner of tri6 is zero but for rounding
        sums[..n].iter().all(|sum| *sum > 1e-9 * total)
    }
}

/// One side of an element.
#[derive(Clone, Copy)]
pub struct Side {
    /// The element that the side is, seen by itself.
    pub element: Element,
    /// Its nodes as local node numbers of the parent, in the order of `element`.
    pub nodes: &'static [usize],
}

impl Side {
    pub(super) const fn new(element: Element, nodes: &'static [usize]) -> Self {
        Self { element, nodes }
    }
}

/// A reference element, as everything refers to it.
pub type Element = &'static dyn ReferenceElement;

impl fmt::Debug for dyn ReferenceElement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl PartialEq for dyn ReferenceElement {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}
