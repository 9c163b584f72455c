//! Where bodies are evaluated.

use crate::system::{Dof, Layout, NodalField, State, StepContext};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;

/// Where cells are evaluated.
#[derive(Clone, Copy)]
pub(super) enum At<'a> {
    /// At a trial state, from the accepted history.
    Trial(&'a State),
    /// Undeformed, without history.
    Start,
}

impl<'a> At<'a> {
    pub fn displacement(self, dof: Dof) -> f64 {
        match self {
            Self::Trial(state) => state.u[dof as usize],
            Self::Start => 0.0,
        }
    }

    /// The correction that led here, of all dofs; empty where none did.
    pub fn correction(self) -> &'a [f64] {
        match self {
            Self::Trial(state) => &state.correction,
            Self::Start => &[],
        }
    }

    /// The way of each node in the increment, where the state is between the ends of one.
    pub fn way(self) -> Option<&'a [Vec3]> {
        match self {
            Self::Trial(state) => state.between.as_ref().map(|of| &of.way[..]),
            Self::Start => None,
        }
    }

    /// The temperature of a node: the unknown where it is one.
    pub fn temperature(
        self,
        layout: &Layout,
        field: &NodalField,
        step: &StepContext,
        node: NodeId,
    ) -> f64 {
        match self {
            Self::Trial(state) => {
                let unknown = state.u.get(layout.temperature(node) as usize).copied();
                unknown.unwrap_or_else(|| field.at(step, state.time, node))
            }
            Self::Start => field.at_start(node),
        }
    }
}
