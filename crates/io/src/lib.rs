//! Everything that crosses the door: cases, meshes, results, checkpoints.

pub mod case;
pub mod diagnostic;
