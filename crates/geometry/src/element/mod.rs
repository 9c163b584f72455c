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
//! | ξ | `xi` | [`Vec3`](crate::tensor::Vec3), trailing components unused below three dimensions |
//! | N_i(ξ) | `shape` | `nnode` |
//! | N_i,a | `dshape` | `nnode` vectors of `dim` entries |
//! | N_i,ab | `ddshape` | `nnode` symmetric tensors of `dim × dim` entries |
//!
//! Triangles, tetrahedra and the triangular side of the wedge use area coordinates `ξ = L2, η = L3, ζ = L4` on
//! `[0, 1]`; lines, quadrilaterals, hexahedra and the axis of the wedge use `[-1, 1]`. The nodes of every side are
//! listed so that the normal of the side's own parametrisation, `t1 × t2` (in the plane `(t_y, -t_x)`), points out
//! of the element.
//!
//! Elements of higher order have the corners of the linear ones, then the nodes inside of the edges, in the order of
//! [`ReferenceElement::edges`], each edge from its start to its end: one halfway in quadratic elements, `order − 1` at equal
//! distances in general. Then quad9 has its centre, hex27 the centres of the sides S1 to S6 and its own.
//!
//! What a method needs to know of an element, the element answers: its family, its order, how it locks, which dual basis
//! its shape functions have. Nothing outside an element's own file asks for its name but the tables of foreign formats.
//!
//! To add an element: one file here and one line in [`TABLE`]; its orders in foreign files go into the tables of the
//! readers and writers. The property tests below run over the whole table.

mod family;
mod hex20;
mod hex27;
mod hex8;
mod lagrange;
mod line2;
mod line3;
mod properties;
mod quad4;
mod quad8;
mod quad9;
pub mod quadrature;
mod reference;
mod serendipity;
#[cfg(test)]
pub(crate) mod testing;
#[cfg(test)]
mod tests;
mod tet10;
mod tet4;
mod tri3;
mod tri6;
mod wedge15;
mod wedge6;

pub use family::Family;
pub use properties::{DualBasis, LockingClass};
pub(crate) use quad4::Quad4;
pub use reference::{EdgeNode, Element, MAX_FACET_NODES, MAX_NODES, ReferenceElement, Side};

/// Every element there is.
///
/// # Example
/// ```
/// use signorini_geometry::element::TABLE;
///
/// // shape functions sum to one in every element
/// for element in TABLE {
///     let mut shape = vec![0.0; element.nnode()];
///     element.shape(&element.centre(), &mut shape);
///     assert!((shape.iter().sum::<f64>() - 1.0).abs() < 1e-14, "{}", element.name());
/// }
/// ```
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
///
/// # Example
/// ```
/// use signorini_geometry::element::by_name;
///
/// let brick = by_name("hex20").ok_or("not in the table")?;
/// assert_eq!((brick.nnode(), brick.ncorner(), brick.sides().len()), (20, 8, 6));
/// assert!(by_name("hex21").is_none());
/// # Ok::<(), &str>(())
/// ```
#[must_use]
pub fn by_name(name: &str) -> Option<Element> {
    TABLE.iter().copied().find(|e| e.name() == name)
}

impl Family {
    /// The linear element, whose nodes are the corners.
    #[must_use]
    pub fn linear(self) -> Element {
        match self {
            Self::Line => &line2::Line2,
            Self::Triangle => &tri3::Tri3,
            Self::Quadrilateral => &quad4::Quad4,
            Self::Tetrahedron => &tet4::Tet4,
            Self::Hexahedron => &hex8::Hex8,
            Self::Wedge => &wedge6::Wedge6,
        }
    }
}
