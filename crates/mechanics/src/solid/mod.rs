//! Deformable solids: elements of a body, small strain or total Lagrangian, in space and in plane strain.
//!
//! | symbol | name in code | shape |
//! |---|---|---|
//! | N_I,X | `gradient` | `nnode` × `ndim` |
//! | H = ∂u/∂X, F = I + H | `h`, `f` | 3 × 3; in plane strain F_33 = 1 |
//! | B_I | `b` | `nstrain` × `ndim` of each node; shears doubled |
//! | w | `weight` | quadrature weight × det J × thickness |
//!
//! With the strain `E = ½(H + Hᵀ + HᵀH)` (the last term only at finite strain) and the stress `S` of the material,
//!
//! ```text
//! f_I  = Σ w B_Iᵀ S                                    (E1)
//! K_IJ = Σ w (B_Iᵀ C B_J + (N_I,X · S N_J,X) I)         (E2)   second part only at finite strain
//! B_I  : δE_ab (doubled for a ≠ b) = F_ia N_I,b + F_ib N_I,a  for the displacement i   (E3), F = I at small strain
//! σ    = F S Fᵀ / det F                                 (E4)
//! ```
//!
//! `E` comes from `H`, not from `FᵀF − I`, so that small strains keep their digits. An element whose reference map or
//! whose `F` has no positive determinant is an error that names it. Source: Bonet and Wood 2008, chapters 4, 8, 9.
//!
//! To add an element: its file in `geometry`, and one line in [`kernel`]'s table. Limits: full integration, no remedy
//! against locking yet.

mod choice;
mod dense;
mod kernel;
mod report;
mod term;
#[cfg(test)]
mod tests;

pub use choice::{Integration, Locking};
pub use term::{Solid, SolidError, SolidParts};
