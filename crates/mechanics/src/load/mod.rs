//! What acts from outside: forces, pressures, and what bodies feel by their mass.
//!
//! | symbol | name in code | |
//! |---|---|---|
//! | φ(t) | [`Schedule`] | factor of a load over time, from its [`Course`] |
//! | N_I | `shape` | shape functions of a face or cell, at its quadrature points |
//! | t1, t2 | `tangents` | of a face; `n dA = t1 × t2 dξ` points out |
//! | dV | `volume` | of a cell at the start, with the extent of a plane model |
//! | p, ρ, ω | `pressure`, `factors`, `speed` | |
//! | c, a, P | `point`, `axis`, `projector` | axis of rotation; `P = I − a aᵀ` |
//!
//! Loads enter the residual with a minus sign. The factor follows from step and time alone; a load that replaces
//! another of its name comes from zero while that fades (E1). Dead loads keep direction and size, so that one term,
//! [`NodalForces`], serves them all, from nodal forces that [`spread`] finds once. Their potential is `−φ f·u`:
//!
//! ```text
//! f_I  = ∫ N_I t dA,   ∫ N_I b dV                              (E2)   over the reference, t and b fixed in space
//! f_I  = −φ p ∫ N_I t1 × t2 dξ                                 (E3)   over the present faces
//! −∂f_I/∂u_J = φ p ∫ N_I (−[t2]× N_J,ξ + [t1]× ∂t2/∂u_J) dξ    (E4)
//!        t2 = ∂x/∂η in space; e_z · thickness in the plane; 2πr e_z with the present r where it is axisymmetric
//! f_I  = φ ω² ∫ ρ N_I P(x − c) dV,   −∂f_I/∂u_J = −φ ω² ∫ ρ N_I N_J P dV,   Π = −½ φ ω² ∫ ρ |P(x − c)|² dV    (E5)
//! f_i  = (J⁻¹ M) × r_i,   J = Σ (r²I − r rᵀ)                   (E6)   a moment on nodes, r from their centre
//! M_IJ = ∫ ρ N_I N_J dV                                        (E7)   for inertia, [`mass`]
//! m_I  = M_II Σ_JK M_JK / Σ_J M_JJ                             (E8)   the same at nodes: never negative
//! R_I  = φ ∫ N_I q(θ) |t1 × t2| dξ                             (E9)   heat out of the faces, present ones where bodies deform
//! ∂|t1 × t2| = n·(∂t1 × t2 + t1 × ∂t2)                         (E10)  with n the unit normal
//! ```
//!
//! Nodes of rigid bodies are loaded as others are: the system hands the forces on, with their moments.
//!
//! A following pressure has a potential only where its faces are closed or their rims held. Nothing here knows that, so
//! it claims none, and its stiffness is unsymmetric. Nor has a moment fixed in space, on what may turn about more than
//! one axis.
//!
//! Prescribed motion needs no term: it is data of a step ([`crate::solve::Prescription`]).
//!
//! Limits: in plane stress (E3) takes the thickness of the start, and so neglects that a stretched sheet gets thinner.
//! The mass of (E2) and (E5) is consistent, that of the start, and integrated by the rule of its element. A jump within a table happens at the first increment that
//! ends at it or after. Sources: Bonet and Wood 2008, sections 8.5.2 and 9.3 (following pressure); Schweizerhof and
//! Ramm, Comput. Struct. 18, 1984 (its potentials); Hinton, Rock and Zienkiewicz, EESD 4, 1976 (E8).
//!
//! | load | acts on |
//! |---|---|
//! | [`Force`] | faces, nodes, carriers |
//! | [`PerNode`], [`Moment`] | nodes, carriers |
//! | [`Wrench`] | carriers |
//! | [`Traction`], [`Pressure`] | faces |
//! | [`Line`] | faces of edges of shells, by their thickness |
//! | [`BodyForce`] | cells, by volume |
//! | [`Gravity`] | cells, by mass; carriers with a mass, and masses at nodes |
//! | [`Spin`] | cells, by mass |
//! | [`HeatFlux`], [`Film`], [`Radiation`] | faces |
//! | [`HeatPower`] | faces, nodes |
//! | [`HeatSource`] | cells, by volume |
//!
//! To add a load: a file that implements [`Load`] and describes its keys in an `ENTRY`, a line above and in [`TABLE`]. A
//! dead one needs no term but a function of [`spread`]. Cases can name it then.

mod body_force;
mod centrifugal;
mod course;
mod exchange;
mod following_pressure;
mod force;
mod gravity;
mod heat;
mod kind;
mod line;
mod local;
pub mod mass;
mod moment;
mod nodal_forces;
mod per_node;
mod pressure;
mod region;
mod section;
pub mod spread;
#[cfg(test)]
mod tests;
mod traction;
mod weight;

pub use body_force::BodyForce;
pub use centrifugal::{Centrifugal, Spin};
pub use course::{Course, Schedule};
pub use following_pressure::FollowingPressure;
pub use force::{Force, Wrench};
pub use gravity::Gravity;
pub use heat::{Film, HeatFlux, HeatPower, HeatSource, Radiation};
pub use kind::{
    Acting, Domain, Effect, Load, LoadError, LoadProperties, Place, RadiationConstants, Site,
};
pub use line::Line;
pub use moment::Moment;
pub use nodal_forces::NodalForces;
pub use per_node::PerNode;
pub use pressure::Pressure;
pub use region::Region;
pub use section::Section;
pub use traction::Traction;
pub use weight::Weight;

use signorini_vocabulary::{Description, Entry};
use std::sync::Arc;

/// The loads that a case may choose by name.
pub static TABLE: [Entry<Arc<dyn Load>>; 14] = [
    force::ENTRY,
    per_node::ENTRY,
    traction::ENTRY,
    pressure::ENTRY,
    line::ENTRY,
    moment::ENTRY,
    body_force::ENTRY,
    gravity::ENTRY,
    centrifugal::ENTRY,
    heat::FLUX,
    heat::POWER,
    heat::SOURCE,
    heat::FILM,
    heat::RADIATION,
];

/// The names and keys of all loads of [`TABLE`].
#[must_use]
pub fn descriptions() -> Vec<Description> {
    TABLE.iter().map(|entry| entry.description).collect()
}
