use crate::system::{Dof, Layout, NodeId, Order};
use signorini_geometry::tensor::{Mat3, Vec3};

/// Force and stiffness of one piece: scratch of one thread.
#[derive(Default)]
pub(super) struct Local {
    pub x: Vec<Vec3>,
    pub dofs: Vec<Dof>,
    pub force: Vec<f64>,
    /// Row-major; empty where it is not wanted.
    pub stiffness: Vec<f64>,
    ndim: usize,
}

impl Local {
    /// Begins a piece with these nodes, which are where `places` says.
    pub fn begin(&mut self, layout: &Layout, nodes: &[NodeId], places: &[Vec3], order: Order) {
        self.ndim = layout.ndim();
        gather(places, nodes, &mut self.x);
        self.dofs.clear();
        let of_node = |&n: &NodeId| (0..layout.ndim()).map(move |axis| layout.node(n, axis));
        self.dofs.extend(nodes.iter().flat_map(of_node));
        let n = self.dofs.len();
        let nstiffness = match order {
            Order::Residual => 0,
            Order::Tangent => n * n,
        };
        self.force.clear();
        self.force.resize(n, 0.0);
        self.stiffness.clear();
        self.stiffness.resize(nstiffness, 0.0);
    }

    /// Adds `N_I f` at every node.
    pub fn push(&mut self, shape: &[f64], force: Vec3) {
        let at_nodes = self.force.chunks_exact_mut(self.ndim);
        for (shape, to) in shape.iter().zip(at_nodes) {
            for (axis, f) in to.iter_mut().enumerate() {
                *f += shape * force[axis];
            }
        }
    }

    /// Adds `N_I K_J` to the columns of node `j`.
    pub fn stiffen(&mut self, shape: &[f64], j: usize, column: Mat3) {
        let (ndim, n) = (self.ndim, self.dofs.len());
        for (i, shape) in shape.iter().enumerate() {
            for (axis, row) in column.rows[..ndim].iter().enumerate() {
                let at = (i * ndim + axis) * n + j * ndim;
                for (k, to) in self.stiffness[at..at + ndim].iter_mut().enumerate() {
                    *to += shape * row[k];
                }
            }
        }
    }

    /// `f·u`: minus the work of a dead force.
    pub fn work(&self, u: &[f64]) -> f64 {
        let value = |dof: Dof| u.get(dof as usize).copied().unwrap_or(0.0);
        let at_dofs = self.dofs.iter().zip(&self.force);
        at_dofs.map(|(&dof, f)| f * value(dof)).sum()
    }
}

/// The places of some nodes.
pub(super) fn gather(places: &[Vec3], nodes: &[NodeId], out: &mut Vec<Vec3>) {
    out.clear();
    let of_nodes = nodes.iter().map(|&n| places.get(n as usize));
    out.extend(of_nodes.map(|x| x.copied().unwrap_or_default()));
}
