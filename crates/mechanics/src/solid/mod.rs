//! Deformable bodies: solids in space, in the plane and of revolution, and bars; small strain or total Lagrangian.
//!
//! | symbol | name in code | shape |
//! |---|---|---|
//! | N_I,X | `gradient` | `nnode` × `NG`: rows of the gradient, in axisymmetry with N_I/R as the third |
//! | H = ∂u/∂X, F = I + H | `h`, `f` | 3 × 3; F_33 = 1 in the plane, 1 + u_r/R in axisymmetry |
//! | w | `weight` | quadrature weight × det J × thickness, or × 2πR |
//! | A | `moduli` | derivative of F S with respect to H |
//!
//! With the strain `E = ½(H + Hᵀ + HᵀH)` (the last term only at finite strain), the stress `S` and the tangent `C` of the
//! material,
//!
//! ```text
//! f_Ii    = Σ w F_ir S_ra N_I,a                                                                 (E1)
//! K_Ii,Jk = Σ w N_I,a A_iakb N_J,b,   A_iakb = F_ir C_rasb F_ks + δ_ik S_ab                      (E2)
//! δE_ab   = ½ (F_ia N_I,b + F_ib N_I,a) for the displacement i of node I                        (E3)
//! σ       = F S Fᵀ / det F                                                                      (E4)
//! ```
//!
//! with `F = I` and without `δ_ik S_ab` at small strain. `E` comes from `H`, not from `FᵀF − I`, so that small strains
//! keep their digits. An element whose reference map or whose `F` has no positive determinant is an error that names it.
//! In plane stress the law is wrapped so that `S_zz` vanishes; the strain across follows, and with it the present
//! thickness in (E4). In axisymmetry x is the radius, never negative; nodes may lie on the axis. Strains that are
//! reported are those the material sees: linearized, or `½ ln(F Fᵀ)`.
//!
//! # Locking
//!
//! | remedy | `locking` | what it is | where |
//! |---|---|---|---|
//! | B-bar, F-bar | `b-bar`, `f-bar` | the dilatation projected, `kernel::dilatation` (E5) to (E10) | not in plane stress |
//! | incompatible modes | `incompatible` | condensed, `kernel::modes` (E11), (E12) | quad4, hex8; small strain |
//! | solid-shell | `solid-shell` | assumed strains across, enhanced modes, `kernel::shell` (E37) to (E39) | shells |
//! | shear of the centre | `selective-shear` | selective reduced integration, `kernel::shear` (E13); never by `auto` | quad4; small strain |
//! | reduced integration | | fewer points | quad8, hex20 |
//!
//! B-bar is for small strain and F-bar, its counterpart, for finite strain; both keep an energy and with it a symmetric
//! tangent. The dilatation is projected onto constants (quad4, hex8, tri6, tet10, wedge15) or linear polynomials (quad8,
//! quad9, hex20, hex27): the most that stays free of oscillating pressures. tri6, tet10 and wedge15 pay for it with
//! one order of convergence of displacements. `auto` chooses, for each size of strains:
//!
//! | element | ordinary material, small | ordinary, finite | keeps its volume, small | keeps its volume, finite |
//! |---|---|---|---|---|
//! | tri3, tet4, wedge6 | none | none | none | none |
//! | quad4, hex8 | incompatible | none | b-bar | f-bar |
//! | quad4 in plane stress | incompatible | none | incompatible | none |
//! | tri6, quad8, quad9, tet10, wedge15, hex20, hex27 | none | none | b-bar | f-bar |
//! | the same in plane stress | none | none | none | none |
//! | quad8, hex20 with reduced integration | none | none | none | none |
//!
//! A material *keeps its volume* where it is plastic or its bulk and shear moduli are those of `ν ≥ 0.45`. tri3, tet4
//! and wedge6 have no remedy: their dilatation is constant already, or nearly so, and they stay stiff in bending and lock
//! where volume is kept; quadratic elements are the way out. What was chosen can be read back, [`Solid::locking`].
//!
//! # Thin bodies
//!
//! In static steps at finite strain the geometric stiffness `δ_ik S_ab` of (E2) takes the stress that the last Newton correction
//! predicted, (E36) of `kernel::predicted`: by itself in shells, and where nothing rubs in bodies most of whose elements have extents that differ by more than a factor of five.
//! Laws with a history and elements with another remedy than the solid-shell take the stress of the iterate.
//!
//! # Shells
//!
//! A body of solid-shells has hex8 whose nodes are the ends of directors, and the unknowns of these, [`crate::system::Directors`]:
//! (E37) to (E40) in `kernel::shell`. It needs no other remedy, at any size of strains.
//!
//! # In motions that conserve energy
//!
//! the stress of elastic laws is the secant of the energy over an increment, `kernel::secant` (E21) to (E23), where strains are finite or
//! the law is not linear; elements with a remedy against locking have no such form there, nor have bars. Laws with a history are
//! evaluated at the mean place.
//!
//! # Damping
//!
//! In motions in time the stiffness of a body may damp, [`Solid::set_retardation`]: (E29) to (E31) in `damping`, and at finite strain (E24)
//! to (E28) in `kernel::viscous`.
//!
//! # Heat
//!
//! Where temperatures are unknowns, [`HeatInBody`] conducts and stores: (E32) to (E34) in `heat`. What stresses are against them is
//! (E35) in `swelling`.
//!
//! # At the start
//!
//! A point may have a stress `S_0` and a strain `E_0` that leaves no stress, [`AtStart`]: `S = S(E − E_0) + S_0`, with
//! the energy `W(E − E_0) + S_0 : E`. Both stay what they are; they are not in equilibrium by themselves.
//!
//! # Cells that take no part
//!
//! A step may remove cells and add them again, [`Solid::set_activity`]: (E18) to (E20) in `activation`.
//!
//! # Axes of the material
//!
//! A law with directions may have axes that vary, [`MaterialAxes`]: those of every quadrature point are found once, from
//! undeformed positions, and come with the strain, [`crate::material::Strain::axes`], to [`crate::material::Oriented`]. Bodies
//! without them keep and pass nothing.
//!
//! # Several at once
//!
//! Cells without a remedy are evaluated as many at a time as the vector registers of the processor have lanes,
//! `kernel::batch`: the material by its constants where it is isotropic and linear, (E17), else cell by cell. What has
//! no answer there is evaluated once more, one cell after the other, to say which cell it is and why. The last digits of a
//! result differ between processors with and without fused multiply-add, not with the number of threads.
//!
//! # History
//!
//! The accepted history of every quadrature point lies here, and next to it the incompatible modes. Evaluation is pure:
//! it starts from the accepted history, and what comes out is kept only by `accept`, which evaluates once more.
//!
//! Sources: Bonet and Wood 2008, chapters 4, 8, 9; Hughes, IJNME 15, 1980 (B-bar); de Souza Neto, Perić, Dutko, Owen,
//! IJSS 33, 1996, made variational after Broccardo, Micheloni, Krysl, IJNME 79, 2009 (F-bar); Taylor, Beresford, Wilson,
//! IJNME 10, 1976 (incompatible modes); Simo, Taylor, Pister, CMAME 51, 1985 (mean dilatation).
//!
//! To add an element: its file in `geometry`, and one line in each of the `kernel`'s tables that has its dimension.
//! Limits: quad4 and hex8 have no remedy in bending at finite strain; a material's history goes on unchanged where a step of small strain is followed by one of finite strain.

mod activation;
mod at;
mod axes;
mod capabilities;
mod cells;
mod choice;
mod conserving;
mod damping;
mod directors;
mod error;
mod heat;
mod kernel;
mod laws;
mod plan;
mod predicting;
mod report;
mod scratch;
mod swelling;
mod term;
#[cfg(test)]
mod tests;
mod truss;
mod viscous;

pub use axes::{Cylindrical, MaterialAxes};
pub use cells::AtStart;
pub use choice::{Integration, Locking};
pub use error::SolidError;
pub use heat::{HeatInBody, HeatParts, Storage};
pub use report::AtNodes;
pub use term::{Solid, SolidParts};
pub use truss::{Truss, TrussParts};
