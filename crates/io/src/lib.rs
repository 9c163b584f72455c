//! Everything that crosses the door: meshes and cases in, results out.

pub mod readers;
