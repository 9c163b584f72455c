use super::{Dof, Layout, NodeId, Order, PatternSink, Sink};

/// Heat into the nodes of one cell or face, with its derivatives: scratch of one thread.
#[derive(Debug, Default)]
pub struct LocalHeat {
    /// Unknown temperatures, node by node.
    pub dofs: Vec<Dof>,
    /// Unknown displacements, node by node.
    pub motions: Vec<Dof>,
    /// Heat per time that leaves each node.
    pub flow: Vec<f64>,
    /// Its derivatives with respect to temperatures, row-major; empty where they are not wanted.
    pub stiffness: Vec<f64>,
    /// Its derivatives with respect to displacements, row-major; empty where they are not wanted.
    pub coupling: Vec<f64>,
}

impl LocalHeat {
    /// Takes the unknowns of these nodes.
    pub fn begin(&mut self, layout: &Layout, nodes: &[NodeId]) {
        self.dofs.clear();
        self.dofs
            .extend(nodes.iter().map(|&node| layout.temperature(node)));
        let of_node = |&node: &NodeId| (0..layout.ndim()).map(move |axis| layout.node(node, axis));
        self.motions.clear();
        self.motions.extend(nodes.iter().flat_map(of_node));
    }

    /// Sets all sums to zero, for the derivatives that this order and bodies that deform need.
    pub fn clear(&mut self, order: Order, deforms: bool) {
        let n = self.dofs.len();
        let (square, across) = match order {
            Order::Residual => (0, 0),
            Order::Tangent if deforms => (n * n, n * self.motions.len()),
            Order::Tangent => (n * n, 0),
        };
        for (list, length) in [
            (&mut self.flow, n),
            (&mut self.stiffness, square),
            (&mut self.coupling, across),
        ] {
            list.clear();
            list.resize(length, 0.0);
        }
    }

    /// Announces where the sums go.
    pub fn announce(&self, deforms: bool, out: &mut dyn PatternSink) {
        out.interface(&self.dofs);
        if deforms {
            out.coupling(&self.dofs, &self.motions);
        }
    }

    /// Adds the sums to the system.
    pub fn add_to(&self, out: &mut dyn Sink) {
        out.add(&self.dofs, &self.flow, &self.stiffness);
        if !self.coupling.is_empty() {
            out.couple(&self.dofs, &self.motions, &self.coupling);
        }
    }
}
