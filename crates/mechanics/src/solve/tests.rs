//! Solving small systems.
