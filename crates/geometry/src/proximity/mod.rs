//! Which boxes are near which: the broad phase of contact.

mod aabb;

pub use aabb::Aabb;
