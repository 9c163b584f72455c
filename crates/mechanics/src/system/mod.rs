//! Unknowns, state, and how terms become one system of equations.
//!
//! ```text
//!  Layout: named fields of unknowns        raw dof:  nodes | rigid bodies | other fields | multipliers
//!  State:  their values, and positions       │
//!  Term:   adds forces and stiffness to ──▶ Sink ──▶ Elimination ──▶ Operator: bulk (blocks) + interface (scalar)
//!                                                                     │
//!                                              equation[raw] ◀── prescribed, dependent, unused are left out
//! ```
//!
//! | symbol | name in code | shape |
//! |---|---|---|
//! | u | `u` | `ndof` raw dofs |
//! | r = f_int − f_ext | `residual` | `ndof` |
//! | Σ_e \|f_e\| | `magnitude` | `ndof` |
//! | rounding error of r | `uncertainty` | `ndof` |
//! | K | `Operator`: bulk and interface | `ndof × ndof` |
//!
//! Newton solves `K du = −r`. The bulk (solids, in blocks of a node) and the interface (contact, couplings, springs)
//! stay apart, because the iterative solver wants them apart; the direct one adds them. Prescribed dofs stay in the
//! operator, so that reactions and the response to a prescribed motion come from the same assembly.
//!
//! Nodes of a rigid body are *dependent*: `x = c + R a_0`, hence `dx = dc − [a]× dθ` with the arm `a = x − c` (E1).
//! A force `f` on such a node acts on the body as `f` and `a × f`, whose variation at constant `f` is
//! `[f]× [a]× dθ` (E2): without that term the tangent is off by about one per cent. Rotations compose,
//! `R ← exp(dθ) R`; angles are never added. A node may follow in some directions only (kinematic couplings), or a dof
//! may be a combination `u = Σ c_k u_k + Σ c_i (R a_0 − a_0)_i` of others, the turns of followers among them (E3):
//! its increment and the forces on it go the same way, and (E2) holds for each turn.
//!
//! What combines goes into the interface part: an element with a dependent dof has its entries there, so that the bulk
//! keeps its blocks and plain models pay nothing.
//!
//! Unknowns are named fields ([`Layout`]). The bulk is that of the displacement; the coefficients of other fields, and
//! those that couple fields, are in the interface.
//!
//! In a motion with inertia all terms are evaluated between the ends of an increment, (E4) to (E7) in `motion`, of
//! rigid bodies (E8) and (E9) in `rigid_motion`.
//!
//! One more field: [`Layout::with_field`], and a term that adds to its dofs through [`PatternSink::interface`].
//!
//! Results do not depend on the number of threads: chunks are evaluated in parallel and added in a fixed order.

mod activity;
mod advance;
mod archive;
mod assembler;
mod assembly;
mod audited;
mod buffer;
mod capabilities;
#[cfg(test)]
mod conformance;
mod course;
mod director;
mod elimination;
mod following;
mod frame;
mod heat_flows;
mod idealisation;
mod impulsive;
mod internal_forces;
mod layout;
mod local_heat;
mod loose;
mod motion;
mod moving;
mod phase;
mod rigid_motion;
mod samples;
mod setting;
mod shares;
mod sink;
mod state;
mod strip;
mod tangent;
mod term;
#[cfg(test)]
mod tests;
mod touching;
mod whole;

pub use activity::{Activity, CellChange};
pub use archive::{Archive, ArchiveError};
pub use assembler::Assembler;
pub use assembly::Assembly;
pub use audited::{Check, ContactAudit, Measured};
pub use capabilities::{
    Adaptive, Aid, Audited, Capabilities, Choices, Conducting, ContactNumbering, Elementwise,
    Inertial, InitialStiffness, Sampled, SampledHeat, Stored, Verdict, Viscous, Wearing,
};
pub use course::{NodalField, TimeFunction, interpolate};
pub use director::{Director, Directors};
pub use elimination::{Elimination, Relation, RigidBody, Turn};
pub use frame::{
    ContactFrame, ContactSample, ContactWarmth, Energies, FluidFrame, Footprint, Frame, FreeMotion,
    IdleRows, NodalValues, ReportedAs, Resultant, RigidFrame, SpinFrame, Status, Wear,
};
pub(crate) use heat_flows::of_residuals;
pub use heat_flows::{HeatBalance, HeatFlows, SizedFlows};
pub use idealisation::{Idealisation, profile_at};
pub use impulsive::{Acts, Impulsive, NearRow, Rubbing};
pub use layout::{ByScale, Dof, DofName, Field, FieldId, Layout, MAX_FIELDS, NO_DOF, Scale, Site};
pub use local_heat::LocalHeat;
pub use loose::Course;
pub use motion::{Between, BodyRates, BodyWay, Leapfrog, MassScaling, Rates, Scheme};
pub use phase::{GeometricStress, Heat, Increment, Phase, Physics, StepContext};
pub use rigid_motion::{RigidMass, moved};
pub use samples::{PointSample, Samples, Wanted};
pub use signorini_geometry::mesh::NodeId;
pub use signorini_linear::Symmetry;
pub use sink::{Lifetime, Order, Part, PatternSink, Role, Sink, TermError, Work, couple_as_square};
pub use state::State;
pub use term::{Properties, Term};
pub(crate) use touching::{Act, Touching, choose_again, touching};
pub use whole::System;
