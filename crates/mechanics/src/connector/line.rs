use super::hold::{Constraints, Hold, Scratch, take_out};
use super::{ConnectorError, ROUNDING, place, value};
use crate::system::{Dof, Layout, Order, PatternSink, Sink, State};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::{Mat3, Vec3};
use std::sync::Arc;

/// Nodes that stay on a straight line (E5).
pub struct Line {
    name: String,
    layout: Layout,
    reference: Arc<[Vec3]>,
    /// What the line goes through.
    base: [NodeId; 2],
    /// The others, each with a multiplier for each of `across`.
    nodes: Vec<NodeId>,
    first: usize,
    /// l_0
    length: f64,
    /// n_k: across the line at the start; in the plane only one that is in it.
    across: Vec<Vec3>,
    nonlinear: bool,
}

/// How far nodes may be from their line at the start, in parts of its length.
const UNEVEN: f64 = 1e-4;
/// Unknowns of one constraint, besides its multiplier: those of three nodes.
const N: usize = 9;

impl Line {
    /// The number of multipliers that so many nodes take.
    #[must_use]
    pub const fn nmultiplier(layout: &Layout, nnode: usize) -> usize {
        nnode.saturating_sub(2) * (layout.ndim() - 1)
    }

    /// Nodes that stay on a line. Their multipliers are those from `first` on.
    ///
    /// # Errors
    /// Nodes in one point, or not on a line at the start.
    pub fn new(
        name: &str,
        nodes: &[NodeId],
        reference: Arc<[Vec3]>,
        layout: Layout,
        first: usize,
    ) -> Result<Self, ConnectorError> {
        let mut line = Self {
            name: name.to_string(),
            layout,
            reference,
            base: [0; 2],
            nodes: nodes.to_vec(),
            first,
            length: 1.0,
            across: Vec::new(),
            nonlinear: true,
        };
        if nodes.len() < 3 {
            line.nodes.clear();
            return Ok(line);
        }
        let middle = nodes.iter().map(|&n| line.start(n)).sum::<Vec3>() / nodes.len() as f64;
        let one = line.take_farthest(middle);
        let other = line.take_farthest(line.start(one));
        line.base = [one, other];
        let along = line.start(other) - line.start(one);
        line.length = along.norm();
        let Some(along) = along.normalized() else {
            return Err(ConnectorError::Narrow {
                point: true,
                what: "they lie on no line of their own",
            });
        };
        line.across = across(along, layout.ndim());
        for &node in &line.nodes {
            let distance = (line.start(node) - line.start(one)).cross(along).norm();
            if distance > UNEVEN * line.length {
                return Err(ConnectorError::Uneven {
                    node,
                    what: "on one line",
                    distance,
                });
            }
        }
        Ok(line)
    }

    fn start(&self, node: NodeId) -> Vec3 {
        place(&self.reference, node)
    }

    /// Takes out the node that is farthest from a point.
    fn take_farthest(&mut self, from: Vec3) -> NodeId {
        let reference = &self.reference;
        take_out(&mut self.nodes, |n| (place(reference, n) - from).norm())
    }

    /// The unknowns of the k-th constraint.
    fn dofs(&self, k: usize) -> [Dof; N + 1] {
        let [a, b] = self.base;
        let node = self.nodes.get(k / self.across.len().max(1));
        let nodes = [a, b, node.copied().unwrap_or(a)];
        std::array::from_fn(|i| match nodes.get(i / 3) {
            Some(&node) => self.layout.node(node, i % 3),
            None => self.layout.multiplier(self.first + k),
        })
    }
}

/// Unit vectors across a direction: two at right angles, or in the plane the normal of the plane, about which the
/// direction turns.
fn across(along: Vec3, ndim: usize) -> Vec<Vec3> {
    if ndim == 2 {
        return vec![Vec3::unit(2)];
    }
    let least = (0..3).min_by(|&i, &j| along[i].abs().total_cmp(&along[j].abs()));
    let first = along.cross(Vec3::unit(least.unwrap_or(0))).normalized();
    let first = first.unwrap_or_default();
    vec![first, along.cross(first)]
}

impl Constraints for Line {
    type Work = Scratch;

    fn name(&self) -> &str {
        &self.name
    }

    fn count(&self) -> usize {
        self.nodes.len() * self.across.len()
    }

    fn couple(&self, k: usize, out: &mut dyn PatternSink) {
        out.interface(&self.dofs(k));
    }

    fn set_nonlinear(&mut self, nonlinear: bool) {
        self.nonlinear = nonlinear;
    }

    fn add(&self, k: usize, trial: &State, order: Order, work: &mut Scratch, out: &mut dyn Sink) {
        let many = self.across.len();
        let (Some(&node), Some(&normal)) = (self.nodes.get(k / many), self.across.get(k % many))
        else {
            return;
        };
        let dofs = self.dofs(k);
        let x = |n: NodeId| match self.nonlinear {
            true => place(&trial.x, n),
            false => self.start(n),
        };
        let [a, b] = self.base;
        let (arm, edge) = (x(node) - x(a), x(b) - x(a));
        // g = n · (arm × edge) / l_0
        let scale = self.length.recip();
        let by_arm = edge.cross(normal) * scale;
        let by_edge = normal.cross(arm) * scale;
        let by_node = [(by_arm + by_edge) * -1.0, by_edge, by_arm];
        let gradient: [f64; N] = std::array::from_fn(|i| by_node[i / 3][i % 3]);
        let gap = if self.nonlinear {
            let start = |n: NodeId| self.start(n);
            let at_start = (start(node) - start(a)).cross(start(b) - start(a));
            normal.dot(arm.cross(edge) - at_start) * scale
        } else {
            let parts = gradient.iter().zip(&dofs);
            parts.map(|(g, &dof)| g * value(trial, dof)).sum()
        };
        let size = x(node).max_abs() + x(a).max_abs();
        let hold = Hold {
            dofs: &dofs,
            gap,
            gradient: &gradient,
            rounding: ROUNDING * f64::EPSILON * size,
        };
        // ∂²g by arm and edge is −[n]×
        let turn = Mat3::skew(normal * scale);
        let nonlinear = self.nonlinear;
        let hessian = |i: usize, j: usize| {
            const MOVES: [[f64; 2]; 3] = [[-1.0, -1.0], [0.0, 1.0], [1.0, 0.0]];
            let (p, q) = (MOVES[i / 3], MOVES[j / 3]);
            let factor = p[1] * q[0] - p[0] * q[1];
            if nonlinear {
                factor * turn.rows[i % 3][j % 3]
            } else {
                0.0
            }
        };
        hold.add(hessian, trial, order, work, out);
    }
}
