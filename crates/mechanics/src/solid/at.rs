//! Where bodies are evaluated.

use crate::system::{Dof, NodalField, State, StepContext};
use signorini_geometry::mesh::NodeId;

/// Where cells are evaluated.
#[derive(Clone, Copy)]
pub(super) enum At<'a> {
    /// At a trial state, from the accepted history.
    Trial(&'a State),
    /// Undeformed, without history.
    Start,
}

impl At<'_> {
    pub fn displacement(self, dof: Dof) -> f64 {
        match self {
            Self::Trial(state) => state.u[dof as usize],
            Self::Start => 0.0,
        }
    }

    /// The temperature of a node.
    pub fn temperature(self, field: &NodalField, step: &StepContext, node: NodeId) -> f64 {
        match self {
            Self::Trial(state) => field.at(step, state.time, node),
            Self::Start => field.at_start(node),
        }
    }
}
