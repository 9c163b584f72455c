//! Which boxes are near which: the broad phase of contact.
//!
//! ```text
//!     ╭╌╌╌╌╌ R = r + s ╌╌╌╌╌╮
//!     ┆    ╭──── r ────╮    ┆
//!     ┆    │           │  ┌─┼──────┐        B touches the outer circle: it is a candidate of p,
//!     ┆    │     • p   │  │ ┆  B   │        long before it comes within reach
//!     ┆    │           │  └─┼──────┘
//!     ┆    ╰───────────╯    ┆
//!     ╰╌╌╌╌╌╌╌╌╌╌╌╌╌╌╌╌╌╌╌╌╌╯
//! ```
//!
//! | symbol | name in code | shape | unit |
//! |---|---|---|---|
//! | p | `points` | `npoint` vectors | length |
//! | B | `boxes`: around the facets, as [`Aabb`] | `nfacet` boxes | length |
//! | r | `reach`: contact farther away is of no interest | scalar | length |
//! | s | `skin`: how far things may move before candidates are collected again | scalar | length |
//! | R | `range` | scalar | length |
//! | a, b | `point_motion`, `box_motion`: the largest since candidates were collected | scalars | length |
//! | w | `width` of a box | scalar | length |
//!
//! A [`Bvh`] finds the boxes near a point; [`Search`] keeps with it the [`Candidates`], the boxes near every point.
//! The distance of a point from a box is
//!
//! ```text
//! d(p, B)² = Σ_i max(B.min_i − p_i, p_i − B.max_i, 0)²                                     (E1)
//! ```
//!
//! Candidates are collected within the range R, in the configuration marked 0, and kept while (E3) holds:
//!
//! ```text
//! d(p⁰, B⁰) ≤ R = r + s                                                                   (E2)
//! r + a + b ≤ R,   a = max |p − p⁰|,   b = max |β|,
//!                  β_i = max(B⁰.min_i − B.min_i, B.max_i − B⁰.max_i, 0)                   (E3)
//! ```
//!
//! While (E3) holds no box within reach is missed. Proof: let `d(p, B) ≤ r`; some `x ∈ B` has `|p − x| ≤ r`. By the
//! choice of β the point `y ∈ B⁰` closest to `x` has `|x_i − y_i| ≤ β_i`, thus `|x − y| ≤ b`. Then `d(p⁰, B⁰) ≤
//! |p⁰ − y| ≤ |p⁰ − p| + |p − x| + |x − y| ≤ a + r + b ≤ R`, which is (E2). Where (E3) fails, `a + b > s` (at an
//! unchanged reach), so something has moved by more than half the skin. Only the outward motion of a box counts.
//!
//! The tree is split where the cost of its two parts, `n w` each, is smallest over the bins of its longest axis, and
//! is refitted rather than built again while its cost
//!
//! ```text
//! C = (Σ_inner w + Σ_leaf n w) / w_root                                                   (E4)
//! ```
//!
//! stays below 6/5 of what it was when it was built.
//!
//! What moves far within an increment is found by [`Sweep`], along the way (E5), instead of where it ends.
//!
//! Boxes that are unbounded, such as those of planes, are kept apart from the tree and tested one by one: there should be
//! few of them. Boxes that contain nothing are near nothing; so are points that are not finite. Results are sorted
//! and do not depend on the shape of the tree. Coordinates whose squares leave the range of floating point (beyond
//! 1e±150) are not supported. At most 2³² − 1 boxes are looked at.
//!
//! Sources: Goldsmith, Salmon, *Automatic creation of object hierarchies for ray tracing*, IEEE CG&A 7(5), 1987, for
//! the cost; Wald, *On fast construction of SAH-based bounding volume hierarchies*, RT 2007, for the bins; Verlet,
//! *Computer "experiments" on classical fluids*, Phys. Rev. 159, 1967, for the skin.
//!
//! To add a query: one method of [`Bvh`] on top of its traversal, and its oracle in [`brute`].

mod aabb;
pub mod brute;
mod bvh;
mod search;
mod sweep;
#[cfg(test)]
mod tests;

pub use aabb::Aabb;
pub use bvh::Bvh;
pub use search::{Candidates, Search};
pub use sweep::Sweep;
