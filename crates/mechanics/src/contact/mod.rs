//! Contact: one condition for every kind of segment, discretization, law and dimension.
//!
//! ```text
//!  points of the secondary side           Search ──▶ Candidates      what is near
//!        │                                    │
//!        ▼                                    ▼
//!  Discretization.pair_up ─────────────▶ Pairing                    all discrete choices, once per iterate
//!  Discretization.rows ────────────────▶ Rows                       gap, gradient, weights: first-order data
//!        ContactLaw.pressure ──────────▶ p(g)                       a scalar function
//!  kernel ─────────────────────────────▶ f, K                       never asks what the segment is
//! ```
//!
//! | symbol | name in code | shape |
//! |---|---|---|
//! | g | `gap` | negative is penetration |
//! | G = ∂g/∂d | `gradient` | one number for each column |
//! | b | `weights`: with which a pressure acts on the columns | one number for each column |
//! | ∂b/∂d | `dweights` | columns × columns |
//! | ν | `normal` | unit vector, out of the primary side |
//! | w | `measure`: tributary area, 1 per node | number |
//! | p | pressure, ≥ 0 | number |
//!
//! A *column* is one component of one participant: three for a node, six for a rigid body. With these,
//!
//! ```text
//! f = −w p b                          (E1)
//! K = −w (b dpᵀ + p ∂b/∂d),  dp = p'(g) G        (E2)
//! ```
//!
//! For a projected point `b = G` and `∂b/∂d` is the Hessian of the gap, so that the tangent is symmetric; for mortar it
//! is not. Friction adds a tangential traction with weights of its own to (E1) and (E2).
//!
//! To add a discretization, a law or a friction law: one file in its room that implements the trait, and one line
//! where cases are built. Sources: Wriggers 2006, chapters 6 and 9; Konyukhov and Schweizerhof 2013; Faltus and Horák,
//! *A modular extension of a finite element contact implementation* (the signs of its curvature terms corrected:
//! see [`discretization::node_to_segment`]).

pub mod discretization;
pub mod friction;
mod interface;
mod kernel;
pub mod law;
mod row;
#[cfg(test)]
pub(crate) mod tests;

pub use interface::{
    Areas, Interface, InterfaceParts, Measure, Phase, Shift, closest_points, nmultiplier,
};
pub use row::{Participant, Row, RowOrder, Rows, Wanted};
