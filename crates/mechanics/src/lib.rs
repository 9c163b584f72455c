//! Everything between a mesh and a result: unknowns, materials, solids, loads, contact, solution.
//!
//! ```text
//! system ◀── solid, load, inertia, contact, connector ◀── model          solve ──▶ explicit, system
//! ```
//!
//! `solve` knows nothing of solids or contact: all it sees is [`system::Term`]. `material` and `contact::law` have never
//! heard of a degree of freedom.

pub mod audit;
pub mod connector;
pub mod contact;
#[cfg(test)]
#[path = "../../geometry/src/element/testing.rs"]
mod cubic;
mod explicit;
pub mod facing;
pub mod inertia;
pub mod load;
pub mod material;
pub mod model;
pub mod solid;
pub mod solve;
pub mod system;
