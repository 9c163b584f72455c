//! Why constraints contradict each other.

use crate::connector::ConnectorError;
use thiserror::Error;

/// Why a constraint, spring or reference makes no sense.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ConstraintError {
    /// A spring that cannot be made.
    #[error("spring \"{spring}\": {source}")]
    Spring {
        /// Its name.
        spring: String,
        /// Why.
        source: ConnectorError,
    },
    /// A constraint by multipliers that cannot be made.
    #[error("constraint \"{constraint}\": {source}")]
    Connector {
        /// Name of the constraint.
        constraint: String,
        /// Why.
        source: ConnectorError,
    },
    /// A node that is not in the plane, or on the line, of the others at the start.
    #[error(
        "constraint \"{constraint}\": its nodes are not {what} at the start: node {node} is {distance:.3e} away from it"
    )]
    Uneven {
        /// Name of the constraint.
        constraint: String,
        /// The node, as numbered in the input.
        node: u64,
        /// Where it should be.
        what: &'static str,
        /// Its distance.
        distance: f64,
    },
    /// A node that follows two carriers.
    #[error(
        "constraint \"{constraint}\": node {node} follows \"{carrier}\" already; it cannot follow two"
    )]
    TwoLeaders {
        /// Name of the constraint.
        constraint: String,
        /// The node, as numbered in the input.
        node: u64,
        /// What it follows.
        carrier: String,
    },
    /// A support or motion of a displacement that follows a carrier.
    #[error("node {node} follows \"{carrier}\": support or move that instead")]
    OnFollower {
        /// The node, as numbered in the input.
        node: u64,
        /// What it follows.
        carrier: String,
    },
    /// Equations that say different things of the same unknowns.
    #[error("constraint \"{constraint}\" contradicts the constraints before it")]
    Contradictory {
        /// Name of the constraint.
        constraint: String,
    },
    /// An equation in which everything is prescribed, differently.
    #[error(
        "constraint \"{constraint}\" leaves nothing free: what it ties together is prescribed or depends on \
        other constraints already, {what} among it"
    )]
    OverConstrained {
        /// Name of the constraint.
        constraint: String,
        /// Something it speaks of.
        what: String,
    },
    /// A rotation that would depend on the place of a node that turns with a carrier.
    #[error(
        "constraint \"{constraint}\" would make a rotation of \"{carrier}\" depend on the place of a node that \
        turns with a carrier"
    )]
    Turning {
        /// Name of the constraint.
        constraint: String,
        /// Whose rotation.
        carrier: String,
    },
    /// A motion of nodes that no body has and no constraint names.
    #[error("step \"{step}\" moves nodes of no body, such as node {node}")]
    Loose {
        /// Name of the step.
        step: String,
        /// One of the nodes, as numbered in the input.
        node: u64,
    },
    /// A reference that is moved or loaded, and that nothing follows.
    #[error("step \"{step}\" moves or loads the reference \"{reference}\", which nothing follows")]
    Idle {
        /// Name of the step.
        step: String,
        /// Name of the reference.
        reference: String,
    },
    /// A reference of an axisymmetric model that would leave its axis.
    #[error(
        "step \"{step}\" moves, turns or loads the reference \"{reference}\" of an axisymmetric model across \
        the axis; it can only move along it"
    )]
    OffAxis {
        /// Name of the step.
        step: String,
        /// Name of the reference.
        reference: String,
    },
}
