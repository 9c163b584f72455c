//! The algebra under every term.

pub mod linear;
pub mod sparsity;
