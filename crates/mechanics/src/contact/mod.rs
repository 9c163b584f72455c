//! Contact: one condition for every kind of segment, discretization, law and dimension.
//!
//! ```text
//!  points of the secondary side           Search ──▶ Candidates      nearby facets
//!        │                                    │
//!        ▼                                    ▼
//!  Discretization.pair_up ─────────────▶ Pairing                    all discrete choices, once per iterate
//!  Discretization.rows ────────────────▶ Rows                       gap, gradient, weights: first-order data
//!        ContactLaw.pressures ─────────▶ p(g)                       a scalar function, for the rows of a chunk at once
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
//! | B | `operator`: with which a traction acts on the columns, `Bᵀν = b` | a vector for each column |
//! | ∂B/∂d | `turns` | a sum of products |
//! | e | `slip`: from the place where it sticks, in the tangent plane | vector |
//! | w | `measure`: tributary area, 1 per node | number |
//! | p | pressure, ≥ 0 | number |
//! | t | tangential traction, along the slip that it resists | vector |
//! | λ | multiplier: a pressure without friction, else the traction `−p ν + t` | number or vector |
//! | P | `I − ννᵀ` | |
//!
//! A *column* is one component of one participant: three for a node, six for a rigid body. Without friction,
//!
//! ```text
//! f = −w p b,  f_λ = w c(g, λ)                                               (E1)
//! K = −w (b dpᵀ + p ∂b/∂d),  dp = p_,g G + p_,λ dλ,  K_λ = w (c_,g Gᵀ, c_,λ)  (E2)
//! ```
//!
//! For a projected point `b = G` and `∂b/∂d` is the Hessian of the gap, so that the tangent is symmetric, and that of
//! `c` is its transpose; where normals are averaged it is not. With friction, the trial is returned to the limit
//! `L(p, s)` of the law, `s` the slip before the increment:
//!
//! ```text
//! z = Pλ + k e,   t = z where |z| ≤ L (sticks),   t = L z/|z| where not (slips)
//! f = w (Bᵀt − p b)                                                          (E3)
//! K = w (Bᵀdt + (∂B/∂d)ᵀt − b dpᵀ − p ∂b/∂d)                                 (E4)
//! dz = P dλ − ((ν·λ) I + ν λᵀ) dν + k de
//! dt = dz (sticks),   dt = z/|z| L_p dp + L/|z| (I − zzᵀ/|z|²) dz (slips)
//! ```
//!
//! `k` is the stiffness of what sticks. Where a slip length ℓ is given instead, the trial is `e`, and `t = L e/ℓ` up to
//! `|e| = ℓ`; then the pressure is in `dt` of what sticks, too. Multipliers stick exactly, with `k = ε`; frozen ones are
//! the traction of a solution before, and `λ ← −p ν + t`. Those that are solved for add one vector equation for all
//! states,
//!
//! ```text
//! f_λ = −(w/ε) (λ + p̂ ν − t),   p̂ = λ_N + ε c(g, λ_N),   λ_N = −ν·λ          (E5)
//! ```
//!
//! with the limit `L(p̂, s)`; it reads `w (g ν + e) = 0` where it sticks, and `−(w/ε) λ = 0` where it is open. The augmented
//! Lagrangian has `p̂ = p` and acts by (E3); a [`Direct`](law::Multiplier::Direct) multiplier is the traction, `λ` in the
//! place of `t − p ν`. Where both sides are held along an axis, as by a plane of symmetry, `z` and `dz` have no part along
//! it: nothing rubs there. Bonds are linear,
//!
//! ```text
//! f = w Bᵀ(λ + E e),   f_λ = w e,   e the whole way from the anchor           (E6)
//! E = k I + (ε − k) ννᵀ,   ν that at the start of the increment
//! ```
//!
//! without E where the multiplier is the traction, and with `k = ε` unless a stiffness within the tangent plane is given. Tractions of a pair at a distance have a moment, `w (r − ρ) × t`: nothing
//! without friction, `w g ν × t` with friction, which vanishes with the gap. With multipliers, `∂f/∂λ` and
//! `∂f_λ/∂d` of what sticks are each other's transposes where the anchor is the closest point; the rest of the
//! tangent is unsymmetric, `(∂B/∂d)ᵀλ`.
//!
//! What is remembered is a place on the primary side and, of frozen multipliers, the traction. After an increment, a point
//! that slipped has its anchor behind it by `t/k`, a point that stuck keeps its anchor, and a point that opened has none.
//!
//! To add a discretization, a law or a friction law: one file in its room that implements the trait, and one line
//! where cases are built. Sources: Wriggers 2006, chapters 6 and 9; Konyukhov and Schweizerhof 2013; Faltus and Horák,
//! *A modular extension of a finite element contact implementation* (the signs of its curvature terms corrected:
//! see [`discretization::projected`]).

pub mod cohesion;
pub mod discretization;
pub mod friction;
mod interface;
mod kernel;
pub mod law;
pub mod mortar;
mod row;
mod tear;
#[cfg(test)]
pub(crate) mod tests;
mod worn;

pub use interface::{
    Allowance, Areas, Bend, ContactHeat, ContactPhase, Critical, Fluid, FrictionHeat, Interface,
    InterfaceParts, Measure, Shift, WearParts, closest_points, inherit, nmultiplier,
};
pub use row::{Participant, Row, RowOrder, Rows, Wanted};
