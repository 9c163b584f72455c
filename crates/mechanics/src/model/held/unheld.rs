//! Motions that nothing stops.

use std::fmt;

/// Components of a motion: translations along x, y, z, rotations about them.
pub(super) const NCOMPONENT: usize = 6;

/// Coefficients of one unit's motion.
pub(super) type Motion = [f64; NCOMPONENT];

/// A motion that supports leave to a body.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unheld {
    /// The body, or several that hang together.
    pub bodies: Vec<String>,
    /// A node of the part that moves, as numbered in the input, where it is not the whole body.
    pub node: Option<u64>,
    /// Equal for all that supports and joints tie together, and contact does not.
    pub together: usize,
    /// The motion in words, as in `slide along x and to turn about z`.
    pub motion: String,
}

impl fmt::Display for Unheld {
    /// Who moves, as in `body "pin"`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<String> = self.bodies.iter().map(|b| format!("\"{b}\"")).collect();
        let word = if names.len() == 1 { "body" } else { "bodies" };
        write!(f, "{word} {}", names.join(" and "))?;
        match self.node {
            Some(node) => write!(f, " (the part with node {node})"),
            None => Ok(()),
        }
    }
}
