//! Vectors and tensors of three-dimensional space.
//!
//! A problem in the plane uses the same types with `z = 0`; nothing here knows the dimension of a problem.

mod mat3;
mod sym3;
mod vec3;

pub use mat3::{Mat3, turn_about};
pub use sym3::Sym3;
pub use vec3::Vec3;
