//! The geometry of contact, without a single unknown: elements, meshes, contact surfaces, proximity.
//!
//! ```text
//! tensor ◀── element ◀── mesh ◀── surface        proximity ──▶ tensor
//! scalar ◀── overlap ──▶ element                surface ◀── location
//! expansion ──▶ mesh
//! ```
//!
//! Rooms import only leftwards. Everything here can be used alone: a mesh, a surface made of some of its faces,
//! the closest point on it, its curvature.

#[cfg(test)]
extern crate self as signorini_geometry; // for the elements that tests of other crates share

pub mod element;
pub mod expansion;
pub mod location;
pub mod mesh;
pub mod overlap;
pub mod proximity;
#[cfg(test)]
mod random;
pub mod scalar;
pub mod surface;
pub mod tensor;
