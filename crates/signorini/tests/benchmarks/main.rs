//! Benchmarks of contact with exact answers: bars, beams, patches, stacks of blocks, Hertz, friction, interference fits.
//!
//! Every module states its source, mesh, conditions, expected values and tolerance. Closed forms are ported with their
//! source. Meshes are made by [`scene`].

#![allow(clippy::unwrap_used, clippy::panic)]

#[path = "../common/mod.rs"]
mod common;
mod scene;

mod adhesion;
mod assemblies;
mod bars;
mod beam;
mod clamped;
mod cohesion;
mod complementarity;
mod enforcement;
mod faceted;
mod friction_loop;
mod hertz;
mod ironing;
mod linear_steps;
mod mortar_patch;
mod patch;
mod pin;
mod prescribed;
mod pushed;
mod random;
mod references;
mod rings;
mod rotation;
mod sharp;
mod slip;
mod stack;
mod start_gaps;
mod thin;
mod valley;
mod variants;
