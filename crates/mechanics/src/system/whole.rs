use super::{Elimination, Frame, Layout, State, Term};
use signorini_geometry::tensor::Vec3;
use std::sync::Arc;

/// Everything that is solved together.
pub struct System {
    /// Which unknown is which.
    pub layout: Layout,
    /// Positions of the nodes at the start.
    pub reference: Arc<[Vec3]>,
    /// Which unknowns follow others.
    pub elimination: Arc<Elimination>,
    /// What exerts forces.
    pub terms: Vec<Box<dyn Term>>,
    /// The same positions, as solvers take them.
    pub coordinates: Vec<[f64; 3]>,
    /// The body each node belongs to.
    pub body: Vec<u32>,
    /// Cells of each block of the mesh, for frames.
    pub ncell: Vec<usize>,
}

impl System {
    /// The undeformed state.
    #[must_use]
    pub fn initial_state(&self) -> State {
        State::initial(&self.layout, &self.reference, &self.elimination)
    }

    /// Makes `trial` the state `base` advanced by `alpha · du`.
    pub fn advance(&self, trial: &mut State, base: &State, du: &[f64], alpha: f64) {
        let (layout, reference) = (&self.layout, &self.reference);
        trial.advance_from(base, du, alpha, layout, reference, &self.elimination);
    }

    /// An empty frame for this system.
    #[must_use]
    pub fn new_frame(&self) -> Frame {
        let mut frame = Frame::new(self.layout.nnode, &self.ncell);
        frame
            .rigid
            .resize_with(self.layout.nrigid, Default::default);
        frame
    }

    /// The displacement of a node, a vector of space in every dimension.
    #[must_use]
    pub fn displacement(&self, state: &State, node: u32) -> Vec3 {
        let mut u = Vec3::ZERO;
        for axis in 0..self.layout.ndim {
            let dof = self.layout.node(node, axis) as usize;
            u[axis] = state.u.get(dof).copied().unwrap_or_default();
        }
        u
    }
}
