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
//! line between its ends (E1). Then `f = k e n` and `K = k n nᵀ + (k e/l)(1 − n nᵀ)`; at small strain `n` stays. One with
//! a table has its force in place of `k e`, and the slope of the table in place of `k` in `n nᵀ`.
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
//! A *damper* holds what nothing but contact stops, `f = k s (u − u_n)`, until contact does, or slows a jump (E4).
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
//! Nodes that *stay on a line* through two of them have, with unit vectors `n_k` across the line at the start and its
//! length `l_0` there (E5)
//!
//! ```text
//!   g_k = n_k · ((x_i − x_a) × (x_b − x_a)) / l_0 − its value at the start
//! ```
//!
//! A *rod* keeps two nodes at the distance `d`, a *rope* from going farther apart; with a stiffness `c` of the model (E6)
//!
//! ```text
//!   g = |x_b − x_a| − d = 0;     of a rope:  g = 0 where λ + c g > 0,  λ = 0 elsewhere
//! ```
//!
//! A *twist* is the mean of the angles by which nodes turn about an axis `a` through their mean. With the arms `p_i` at
//! the start and `q_i` now, both across the axis, and their root mean square `r` at the start (E7)
//!
//! ```text
//!   g = r (Σ θ_i / n − γ),     tan θ_i = a · (p_i × q_i) / (p_i · q_i),     ∂θ_i/∂q_i = a × q_i / |q_i|²
//! ```
//!
//! The rows of a multiplier are added up node by node: a small sum is judged by the size of its summands.
//! Terms with multipliers have no energy that a step could lower: `energy` says `None`.
//!
//! Limits: what turns with a plane, or with a spring along a line, must keep a length; nodes on a line carry no moment
//! about it. A line that nodes stay on turns by less than a right angle. All nodes of a twist see one another: some
//! dozens are many. Sources: Crisfield, *Non-linear Finite Element Analysis*, vol. 2, 1997, chapters 16 and 23; Dhondt,
//! *The Finite Element Method for Three-Dimensional Thermomechanical Applications*, 2004, chapter 3.

mod damper;
mod distance;
mod distributing;
mod hold;
mod line;
mod plane;
mod springs;
#[cfg(test)]
mod tests;
mod twist;

pub use damper::Damper;
pub use distance::{Distance, DistanceParts};
pub use distributing::{Distributing, DistributingParts};
pub use line::Line;
pub use plane::Plane;
pub use springs::{SpringLaw, Springs, SpringsParts};
pub use twist::{Twist, TwistParts};

use crate::system::{Dof, State};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;
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
    /// Nodes that are not in a plane, or on a line, at the start.
    #[error("its nodes are not {what} at the start: node {node} is {distance:.3e} away from it")]
    Uneven {
        /// Index of the node.
        node: u32,
        /// Where they should be.
        what: &'static str,
        /// Its distance.
        distance: f64,
    },
}

/// Where a node is, in a list of the positions of all.
fn place(positions: &[Vec3], node: NodeId) -> Vec3 {
    positions.get(node as usize).copied().unwrap_or_default()
}

fn value(state: &State, dof: Dof) -> f64 {
    state.u.get(dof as usize).copied().unwrap_or(0.0)
}
