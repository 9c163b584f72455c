//! Mortar integrals: what the multipliers of a secondary facet see of both sides, over the part that is covered.
//!
//! ```text
//!  Plane of the facet ─▶ overlap ─▶ Pair: ∫N_j, ∫N_j N_k, ∫N_j N^m_l      one for each primary facet it meets
//!                                     │ added up
//!                                     ▼
//!                          dual basis ψ = A Ñ of the covered part ─▶ D_j, M_jl, ν
//! ```
//!
//! | symbol | name in code | shape |
//! |---|---|---|
//! | j, k | nodes of the secondary facet | `nnode` |
//! | l | nodes of the primary facets it meets, each once | `nprimary` |
//! | v | columns: coordinates x, y, z of the nodes, secondary first | `ncolumn` |
//! | N_j, N^m_l | shape functions | |
//! | T, Ñ = T N | [`Transformation`]: what [`DualBasis`] says of the element | `nnode` × `nnode` |
//! | A, ψ = A Ñ | coefficients of the dual basis | `nnode` × `nnode` |
//! | D_j = ∫ψ_j Ñ_j = ∫ψ_j | `d` | `nnode` numbers |
//! | M_jl = ∫ψ_j N^m_l | `m` | `nnode` × `nprimary` |
//! | D⁰_j | `full`: `∫Ñ_j` over the whole facet | `nnode` numbers |
//! | ν = −n0 | `normal`: out of the primary side | vector |
//!
//! With `cov` the covered part of a facet and the same points for all integrals,
//!
//! ```text
//! S = ∫_cov Ñ Ñᵀ,  D = diag ∫_cov Ñ,  A = D S⁻¹                              (E1)
//! dA = (dD − A dS) S⁻¹                                                       (E2)
//! M = A T m,  dM = dA T m + A T dm,  m = ∫ N N^mᵀ                            (E3)
//! Σ_j ψ_j = 1,  Σ_l M_jl = D_j,  Σ_k ∫ψ_j Ñ_k x̃_k = Σ_l M_jl x_l  for x linear on coincident surfaces
//! ```
//!
//! `S` is inverted in the scale of its diagonal, where its condition does not depend on how little is covered. Where the
//! covered part is an island inside the facet it does: above `MAX_CONDITION`, in the norm of the largest row sum, which
//! is n times that of the eigenvalues at most, the basis is `ψ = Ñ` and `D` lumped, which keeps `Σ_l M_jl = D_j` and
//! uniform pressures but not linear fields. A node that is covered by less than [`MIN_COVERAGE`] of `D⁰`, over all its
//! facets, has no multiplier: that is the caller's to decide.
//!
//! *The switch* between the two bases is a jump, not a kink: `D` is the same on either side, and so is the force of a
//! uniform pressure, but rows of `M` jump by as much as the dual ones exceed `|M_jl| ≤ D_j`, and forces on single primary
//! nodes and gaps with them. Derivatives are those of the basis that was taken. Where an iterate crosses it the next
//! residual is not what the last linearization said, for one iteration; where a solution lies on it, iterates may
//! alternate, until the increment is cut. Only facets of which an island is covered are concerned.
//!
//! *Quadratic facets* have weights `∫N_j` of either sign. Those of `Ñ` are non-negative at every point:
//!
//! ```text
//! Ñ_corner = N_corner + α Σ N_edge,  Ñ_edge = (1 − 2α) N_edge                (E4)
//! ```
//!
//! over the edges that meet in the corner, with the α of the element ([`DualBasis`]): 1/4, and 3/8 for quad8; of quad9 it is
//! the tensor product of that of line3. Facets of elements without a dual basis are refused. Beyond a bent edge, inside the polygon of the facet, they may be negative: where nothing but such a sliver is
//! covered and `D_j < 0`, it is zero with all its row. The displacements that belong to `Ñ` are `x̃ = T⁻ᵀ x`, and `∫ψ_j N_k = D_j T⁻ᵀ_jk`.
//!
//! *Derivatives.* Cells depend on the places of nodes on the plane alone, two numbers each. Points of cells follow their
//! corners and the nodes ((E4) of [`signorini_geometry::overlap`]); corners move with nodes as (E5) there says; places
//! depend on coordinates by the axes of the plane. The three stages are taken for all points, for each cell, and once for
//! each pair (`products`, `pair`). What couples several primary facets is (E2) and (E3), by the product rule.
//!
//! *Axisymmetry.* Lines of the x-y plane stand for surfaces of revolution about the axis y, r = x. All integrals, `D⁰` too,
//! have the factor
//!
//! ```text
//! 2π r,   r(p) = [(p_b − p) r_a + (p − p_a) r_b]/(p_b − p_a)                 (E5)
//! ```
//!
//! between the ends a, b of the secondary facet. Any r that is common to both sides keeps `Σ_l M_jl = D_j`, and with it
//! momentum along the axis; where surfaces coincide all choices are one, and patch tests pass. This one is the radius of
//! the chord, which is parallel to the auxiliary line: a uniform pressure p on a covered facet then has the exact
//! resultant along the axis, `∫2π r p dr = π p (r_b² − r_a²)`, on bent facets too. The auxiliary line itself, through the
//! mean of the nodes, is off by a third of the sagitta there, and would give `1 + 2δr/(r_a + r_b)` times as much. What
//! acts on primary nodes at a gap is the force of the secondary circumference, not the traction of it.
//!
//! *What is compared.* A primary facet counts where its projection onto the plane is one to one and turned towards the
//! secondary facet. All integrals of two facets have the weight
//!
//! ```text
//! w(c) = s² (3 − 2s),  s = (c − cos 80°)/(cos 60° − cos 80°) within [0, 1],  c = −n0·n^m              (E6)
//! ```
//!
//! with the normal `n^m` of the primary facet at its centre. A facet seen edge-on has much gap over a small part of the
//! plane, which says nothing about contact there: it fades out instead. One weight for all integrals of two facets keeps
//! `Σ_l M_jl = D_j`, all bases and the balance of momentum, and is 1 where surfaces touch flush. By the angle between `−n0`
//! and `n^m`:
//!
//! | projection | angle | |
//! |---|---|---|
//! | one to one, facing | ≤ 60° | compared |
//! | one to one, facing | 60° to 80° | compared, with the weight (E6) |
//! | any | ≥ 80° | passed over: a flank, seen edge-on |
//! | turned round | > 90° | passed over |
//! | folded, or without an inverse at a point | > 60° | passed over |
//! | folded, or without an inverse at a point | ≤ 60° | [`MortarError::Folded`]: the increment is cut |
//!
//! All is continuous and has continuous first derivatives where facets are affine; a curved one that is folded while it
//! still has a weight is lost with it. Facets whose projections have no box in common are never compared, whatever they
//! look like.
//!
//! *Normal.* With one normal for each facet, `ν D` and `ν M` are the operators by which a pressure acts, linear and angular
//! momentum are exact without friction, and nodes of the secondary side do not couple.
//!
//! The standard basis `ψ = N` has `∫N_j N_k` and `∫N_j N^m_l`, which are those of [`Pair`].
//!
//! Sources: Hüeber and Wohlmuth, CMAME 194, 2005, 3147–3166 (dual bases); Cichosz and Bischoff, CMAME 200, 2011,
//! 1317–1332, and Popp, Seitz, Gee and Wall, CMAME 264, 2013, 67–80 (covered part); Popp, Wohlmuth, Gee and Wall, SIAM J.
//! Sci. Comput. 34, 2012, B421–B446 (quadratic facets).

#[allow(clippy::needless_range_loop)] // indices as in the equations
mod basis;
#[allow(clippy::needless_range_loop)]
mod bent;
#[allow(clippy::needless_range_loop)]
mod covered;
mod factor;
mod pair;
#[allow(clippy::needless_range_loop)]
mod products;
mod rises;
#[cfg(test)]
#[allow(clippy::needless_range_loop)]
mod tests;
mod transformation;
mod weights;

pub use bent::{Held, Met, SMOOTH, bend, between};
pub use covered::{Covered, Derivatives, MIN_COVERAGE};
pub use pair::{Frame, Pair};
pub use rises::rises;
pub use transformation::{Basis, Transformation};
pub use weights::{Guests, OfFacet, OfRow, Weights};

#[cfg(doc)]
use signorini_geometry::element::DualBasis;
use signorini_geometry::element::{Element, Family};
use signorini_geometry::tensor::Vec3;
use thiserror::Error;

/// What integrals are taken over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Measure {
    /// Areas in space, lengths in the plane.
    #[default]
    Flat,
    /// Surfaces that lines make when they turn about the axis `x = 0`: `2π r ds` over the full circumference, (E5).
    Revolved,
}

/// Whether multipliers of a facet scatter between corners and mid nodes: those of quadratic triangles, whose corners take no
/// part of an even traction.
fn scatters(element: Element) -> bool {
    element.family() == Family::Triangle && element.order() == 2
}

/// A facet where it is now.
#[derive(Clone, Copy, Debug)]
pub struct Facet<'a> {
    /// Its element: a line, triangle or quadrilateral.
    pub element: Element,
    /// Positions of its nodes.
    pub x: &'a [Vec3],
}

/// Why a facet has no integrals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum MortarError {
    /// The tangents of the secondary facet are parallel or zero at its centre, or it is folded on its own plane.
    #[error("a facet of the secondary side is folded or has no normal")]
    Secondary,
    /// A primary facet in front of the secondary one is folded in the projection: its map has no inverse at a point.
    #[error(
        "primary facet {number} and the secondary facet cannot be compared: one of them is folded"
    )]
    Folded {
        /// The place of the primary facet in the list.
        number: usize,
    },
    /// A secondary facet of an element whose shape functions have no dual basis.
    #[error("there is no dual basis for facets of kind {element}")]
    NoDualBasis {
        /// The name of the element.
        element: &'static str,
    },
    /// A facet has not one position for each node, or more nodes than a facet may have.
    #[error("facet of kind {element} with {positions} positions")]
    Positions {
        /// The name of the element.
        element: &'static str,
        /// How many positions there are.
        positions: usize,
    },
}
