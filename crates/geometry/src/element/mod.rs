//! Reference elements: shape functions with first and second derivatives, sides, edges, quadrature.
//!
//! ```text
//! quad4   3───2      tri3  2        hex8   7────6     wedge6   5        tet4   3
//!         │   │            │ \            4────5 │           3───4            │\`.
//!         0───1            0──1           │ 3──│─2           │ 2 │            │ \ 2
//!      ξ,η in [-1,1]    ξ,η ≥ 0, ξ+η ≤ 1   0────1            0───1            0──1
//! ```
//!
//! | symbol | name in code | shape |
//! |---|---|---|
//! | ξ | `xi` | [`Vec3`], trailing components unused below three dimensions |
//! | N_i(ξ) | `shape` | `nnode` |
//! | N_i,a | `dshape` | `nnode` vectors of `dim` entries |
//! | N_i,ab | `ddshape` | `nnode` symmetric tensors of `dim × dim` entries |
//!
//! Triangles, tetrahedra and the triangular side of the wedge use area coordinates `ξ = L2, η = L3, ζ = L4` on
//! `[0, 1]`; lines, quadrilaterals, hexahedra and the axis of the wedge use `[-1, 1]`. The nodes of every side are
//! listed so that the normal of the side's own parametrisation, `t1 × t2` (in the plane `(t_y, -t_x)`), points out
//! of the element.
//!
//! The quadratic elements have the corners of the linear ones, then a mid node on every edge in the order of
//! [`ReferenceElement::edges`]; quad9 adds its centre, hex27 the centres of the sides S1 to S6 and then its own.
//!
//! To add an element: one file here and one line in [`TABLE`]; its orders in foreign files go into the tables of the
//! readers and writers. The property tests below run over the whole table.

mod hex20;
mod hex27;
mod hex8;
mod lagrange;
mod line2;
mod line3;
mod quad4;
mod quad8;
mod quad9;
pub mod quadrature;
mod serendipity;
#[cfg(test)]
mod tests;
mod tet10;
mod tet4;
mod tri3;
mod tri6;
mod wedge15;
mod wedge6;

use crate::tensor::{Sym3, Vec3};
pub(crate) use quad4::Quad4;
use quadrature::Rule;
use std::fmt;

/// The largest number of nodes an element may have.
pub const MAX_NODES: usize = 27;

/// The largest number of nodes a contact facet may have.
pub const MAX_FACET_NODES: usize = 9;

/// A reference element: the one description of it that meshes, solids and contact surfaces share.
pub trait ReferenceElement: Send + Sync {
    /// The name in cases and messages, such as `"quad4"`.
    fn name(&self) -> &'static str;

    /// The dimension of the reference domain: 1, 2 or 3.
    fn dim(&self) -> usize;

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

    /// The edges as pairs of end nodes, in the order in which they bound the element (faces: round the boundary). In the
    /// reference domain they are straight; a mid node lies halfway, and mid nodes follow the corners in this order.
    fn edges(&self) -> &'static [[usize; 2]];

    /// The rule that integrates the stiffness of the undistorted element exactly; that of wedge15 has the customary nine
    /// points, exact for products of linear strains.
    fn full_rule(&self) -> &'static Rule;

    /// The rule of reduced integration: one order less in the serendipity elements, the full rule in all others.
    fn reduced_rule(&self) -> &'static Rule {
        self.full_rule()
    }

    /// The rule that integrates loads and areas over the element as a facet, curved or not, and masses over a solid. It
    /// integrates products of two shape functions exactly on an undistorted facet.
    fn surface_rule(&self) -> &'static Rule {
        self.full_rule()
    }

    /// Whether `xi` lies in the reference domain, exceeded by at most `tolerance`.
    fn contains(&self, xi: &Vec3, tolerance: f64) -> bool;

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
        match self.dim() {
            1 => 2,
            2 => self.edges().len(),
            _ => self.edges().len() + 2 - self.sides().len(), // Euler
        }
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
    const fn new(element: Element, nodes: &'static [usize]) -> Self {
        Self { element, nodes }
    }
}

/// A reference element, as everything refers to it.
pub type Element = &'static dyn ReferenceElement;

/// Every element there is.
pub static TABLE: [Element; 14] = [
    &line2::Line2,
    &line3::Line3,
    &tri3::Tri3,
    &tri6::Tri6,
    &quad4::Quad4,
    &quad8::Quad8,
    &quad9::Quad9,
    &tet4::Tet4,
    &tet10::Tet10,
    &hex8::Hex8,
    &hex20::Hex20,
    &hex27::Hex27,
    &wedge6::Wedge6,
    &wedge15::Wedge15,
];

/// The element of this name.
#[must_use]
pub fn by_name(name: &str) -> Option<Element> {
    TABLE.iter().copied().find(|e| e.name() == name)
}

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
