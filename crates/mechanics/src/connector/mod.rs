//! Springs, and couplings by Lagrange multipliers: terms between nodes and reference points.
//!
//! | symbol | meaning | code |
//! |---|---|---|
//! | x_i, X_i | node: present and initial position | `State::x` |
//! | c, R | carrier: present reference point, rotation since the start | `Pose` |
//! | w_i | weight of a node, Σ w_i = 1 | `Arm::weight` |
//! | ā, b_i | initial arms: X̄ − c_0 of the mean X̄ = Σ w_i X_i, X_i − X̄ of a node | `mean`, `Arm::arm` |
//! | ℓ² = Σ w_i b_i² | size of a distributing coupling | `size` |
//! | λ | multiplier, a force everywhere: every constraint is a length | `Layout::multiplier` |
//!
//! A *spring* has `Π = ½ k e²`, with the elongation `e = n·(u_b − u_a)` along a fixed direction, or `e = l − l_0` along the
//! line between its ends (E1). Then `f = k e n` and `K = k n nᵀ + (k e/l)(1 − n nᵀ)`; at small strain `n` stays.
//!
//! Nodes that *stay in a plane* through three of them, `x_1, x_2, x_3`, have (E2)
//!
//! ```text
//!   g_i = det[x_2 − x_1, x_3 − x_1, x_i − x_1] / (2 A_0) − its value at the start
//! ```
//!
//! with the initial area A_0 of the triangle: g_i is the distance from the plane. In the plane, `e_z` takes the place of
//! the second edge. The three are those that are spread best.
//!
//! A *damper* holds what nothing but contact stops, `f = k s (u − u_n)`, ever more weakly, or slows a jump (E4).
//!
//! A *distributing* carrier follows the mean motion of its nodes, which stay free to deform (E3):
//!
//! ```text
//!   L = λ_t · g_t + λ_r · g_r,     g_t = c + R ā − Σ w_i x_i,     g_r = Σ w_i (R b_i) × (x_i − c − R ā) / ℓ
//! ```
//!
//! A force F and a moment T on the carrier become forces `w_i F` and `w_i λ × R b_i` on the nodes, statically equivalent
//! to them. Rotations are finite; derivatives are by spins, `dR = [dθ]× R`, so that the tangent is symmetric where the
//! moments on the carrier balance. At small strain everything is linearized about the start.
//!
//! The rows of a multiplier are added up in parts, node by node: what is small is judged by what cancels in it.
//! Terms with multipliers have no energy that a step could lower: `energy` says `None`.
//!
//! Limits: what turns with a plane, or with a spring along a line, must keep a length; nodes on a line carry no moment
//! about it. Sources: Crisfield, *Non-linear Finite Element Analysis*, vol. 2, 1997, chapters 16 and 23.

mod damper;
mod distributing;
mod plane;
mod springs;
#[cfg(test)]
mod tests;

pub use damper::Damper;
pub use distributing::{Distributing, DistributingParts};
pub use plane::Plane;
pub use springs::{Springs, SpringsParts};

use crate::system::{Dof, State};
use thiserror::Error;

/// Constraints or springs of one chunk.
const CHUNK: usize = 256;

/// Rounding error of a constraint over that of the positions in it.
const ROUNDING: f64 = 32.0;

/// Why there is no such connector.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum ConnectorError {
    /// A spring along a line that has no direction.
    #[error("spring {number} has no length at the start: give it a direction")]
    NoLength {
        /// Its number among the pairs of ends, from 1.
        number: usize,
    },
    /// A spring to the ground without a direction.
    #[error("spring {number} is tied to the ground: give it a direction")]
    NoDirection {
        /// Its number among the pairs of ends, from 1.
        number: usize,
    },
    /// A number that is of no use.
    #[error("{what} must be a finite number{}", if *.positive { " above zero" } else { "" })]
    Number {
        /// Which.
        what: &'static str,
        /// Whether it must be positive.
        positive: bool,
    },
    /// Nodes that span too little.
    #[error("its nodes lie {}: {what}", if *.point { "in one point" } else { "on a line" })]
    Narrow {
        /// Whether they coincide.
        point: bool,
        /// What they cannot do.
        what: &'static str,
    },
    /// Nodes that are not in a plane at the start.
    #[error(
        "its nodes are not in one plane at the start: node {node} is {distance:.3e} away from it"
    )]
    Uneven {
        /// Index of the node.
        node: u32,
        /// Its distance.
        distance: f64,
    },
}

fn value(state: &State, dof: Dof) -> f64 {
    state.u.get(dof as usize).copied().unwrap_or(0.0)
}
