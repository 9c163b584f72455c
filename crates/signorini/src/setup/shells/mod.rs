//! Shells: solids in their place, and what a case means by their nodes, elements and sides.
//!
//! ```text
//! Mesh with shells ──expand──▶ Mesh with solids, Shells ──▶ Names, Parts
//! ```
//!
//! Sets of a case keep the nodes that its mesh has: supports, loads and printed values are those of the middle. The nodes of solids
//! stand for these wherever a set of elements or faces brings them in.

mod expand;
mod joints;
mod loads;
mod mirrors;
mod rotations;
mod solids;
mod temperatures;

pub(super) use expand::expanded;
pub(super) use loads::{line_load, moments};
pub(super) use rotations::Rotations;
pub(super) use solids::Shells;
