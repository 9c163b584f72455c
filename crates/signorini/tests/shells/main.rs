//! Shells against closed forms, published values, and themselves.
//!
//! SOURCE      MacNeal, Harder, Finite Elem. Anal. Des. 1, 1985; Belytschko et al., CMAME 51, 1985 (Scordelis-Lo, cylinder, hemisphere,
//!             twisted beam); Timoshenko, *Theory of Plates and Shells*, 1959, section 44 (clamped plate); Sze, Liu, Lo, Finite Elem.
//!             Anal. Des. 40, 2004 (cantilever, hemisphere); the elastica (ring)
//! GOAL        thin shells do not lock, flat or curved, of quadrilaterals or triangles, and lose no digits; joints and sides carry
//!             what they should; contact is at the real face
//! MESH        grids made here
//! CONDITIONS  linear and nonlinear geometry
//! EXPECTED    the numbers at the tests; coarse meshes against those of an independent program with the same element
//! TOLERANCE   1 % of the other program, 2 % of published values on fine meshes
#![allow(clippy::unwrap_used, clippy::panic)]

#[path = "../common/mod.rs"]
mod common;
mod contact;
mod joints;
mod linear;
mod nonlinear;
mod sheet;
