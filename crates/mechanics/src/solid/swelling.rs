//! What stresses are against temperatures that are unknown:
//!
//! ```text
//! K_uθ = Σ w F_ir (∂S_ra/∂θ) N_I,a N_J                                                          (E35)
//! ```
//!
//! with the same projections and condensations as (E2).

use super::cells::Cells;
use super::scratch::{Scratch, Wanted};
use super::term::Solid;
use crate::system::{Dof, PatternSink, Sink};
use signorini_geometry::mesh::NodeId;

impl Solid {
    /// Whether stresses depend on temperatures that are unknown in the present step.
    pub(super) fn swells(&self) -> bool {
        let physics = self.step.physics;
        physics.moves && physics.has_heat() && self.temperature.is_some()
    }

    /// Hands over what the forces of a cell are against temperatures.
    pub(super) fn hand_thermal(&self, nodes: &[NodeId], of: &mut Scratch, out: &mut dyn Sink) {
        if of.thermal.is_empty() {
            return;
        }
        of.heat.clear();
        let dofs = nodes.iter().map(|&node| self.layout.temperature(node));
        of.heat.extend(dofs);
        out.couple(&of.dofs, &of.heat, &of.thermal);
    }

    /// Makes room for what the forces of a cell are against temperatures, where that is wanted; says whether it is.
    pub(super) fn make_room_for_heat(
        &self,
        block: &Cells,
        wanted: Wanted,
        scratch: &mut Scratch,
    ) -> bool {
        let swells = wanted == Wanted::Stiffness && self.swells();
        let nheat = if swells { block.nnode } else { 0 };
        let size = block.nnode * self.layout.ndim() * nheat;
        scratch.thermal.resize(size, 0.0);
        swells
    }

    /// Adds what the displacements that a cell has as unknowns and the temperatures of its nodes couple.
    pub(super) fn couple_heat(&self, nodes: &[NodeId], ends: &[NodeId], out: &mut dyn PatternSink) {
        if !self.swells() {
            return;
        }
        let axes = 0..self.layout.ndim();
        let of_node = |&node| axes.clone().map(move |axis| self.layout.node(node, axis));
        let motions: Vec<Dof> = nodes.iter().flat_map(of_node).collect();
        let heat = ends.iter().map(|&node| self.layout.temperature(node));
        out.coupling(&motions, &heat.collect::<Vec<Dof>>());
    }
}
