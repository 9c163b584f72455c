//! Contact mechanics by finite elements.

pub mod build;
