//! Which outer faces of bodies face one another, where nobody names pairs of surfaces.
//!
//! | symbol | name in code | shape |
//! |---|---|---|
//! | h_f | [`Skin::size`]: root of the area of a facet, of twice that of a triangle; its length in the plane | a length |
//! | t_f | [`Skin::thickness`] of the body behind the middle of a facet, at the start | a length |
//! | n_f, n_q | `normal` of two facets, at their middles | unit vectors |
//! | v | `motion`: how the facets are expected to move relative to one another in an increment | a length |
//! | s | [`Facing::gap`]: along n_f, negative where the bodies overlap | a length |
//!
//! From points x of a facet f (two in the plane, three on triangles and four on quadrilaterals) lines go along its
//! normal, `x + s n_f`. A facet q that such a line crosses faces f where
//!
//! ```text
//! n_f·n_q < −cos 80°                                                                          (E1)
//! −min(t_f, t_q)/2 ≤ s                                                                        (E2)
//! s ≤ r = h_f + 2 v,   −s ≤ r                                                                 (E3)
//! q shares no node with f                                                                     (E4)
//! nothing is entered before it: s ≤ the first s > 0 at which n·n_f < 0                        (E5)
//! ```
//!
//! and of the facets that a line crosses the one with the smallest |s| counts, then that with the lower number. (E1)
//! leaves out neighbours on smooth and convex parts: mortar weights end at that angle, too. (E2) leaves out the far side
//! of the own body: from one side of a slab it is seen at −t, and what has entered by less than t/2 is nearer to where it
//! came in. In (E3) a point at most h_f away is in sight before it has arrived, and twice the motion expected covers an
//! iterate that goes too far. (E5) leaves out what lies behind a body in between.
//!
//! The thickness is measured once, along a line from the middle of a facet against its normal to the first facet of the
//! same body with `n·n_f < 0` that shares no node with it; beyond four times the size of the facet it is infinite. Facets of
//! quadratic elements are polygons through their nodes.
//!
//! Limits: corners and edges that pass between the lines are not seen. At sharp tips t tends to zero, and overlaps there
//! at the start are none. Cost: n log n when the tree is built, n for each search.

mod find;
mod meetings;
mod skin;

pub use find::{Facing, Finder};
pub use meetings::{Meeting, Regions, Standing, secondary};
pub use skin::Skin;

/// cos 80°, of the angle between normals up to which facets face one another (E1).
const FACES: f64 = 0.173_648_177_666_930_33;

/// The part of the thickness up to which bodies may overlap (E2).
const ENTERED: f64 = 0.5;

/// What is expected to move may move that many times as far (E3).
const AHEAD: f64 = 2.0;

/// The thickness over the size of a facet beyond which it is infinite.
const THICK: f64 = 4.0;
