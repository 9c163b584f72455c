//! Everything that crosses the door: cases, meshes, results, checkpoints.

pub mod checkpoint;
pub mod fs;
pub mod writers;
