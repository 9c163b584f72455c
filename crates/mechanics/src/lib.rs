//! Solids, contact and their solution: everything between a mesh and a result.

pub mod system;
