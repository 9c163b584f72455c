//! Everything that crosses the door: cases, meshes, results, checkpoints, and the messages about them.
//!
//! ```text
//! case.toml ──case──▶ Case       part.msh ──readers──▶ Mesh       job.inp ──deck──▶ Case and Mesh
//! Frame ──writers──▶ frames/*.vtu, history.csv, …      all files through fs
//! results ──compare──▶ Findings
//! ```
//!
//! Foreign orders and names (Gmsh, VTK, Abaqus) exist only here, each function naming its own.

pub mod case;
pub mod checkpoint;
pub mod compare;
#[cfg(test)]
#[path = "../../geometry/src/element/testing.rs"]
mod cubic;
pub mod deck;
pub mod diagnostic;
pub mod frd;
pub mod fs;
pub mod readers;
pub mod vtk;
pub mod writers;
