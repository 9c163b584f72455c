use super::hold::{Constraints, Hold, Scratch};
use super::{ConnectorError, ROUNDING, place, value};
use crate::system::{Dof, Layout, Order, PatternSink, Sink, State};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::{Mat3, Vec3};

/// What keeps two nodes at a distance, or from going farther apart, is made from.
#[derive(Clone, Debug)]
pub struct DistanceParts<'a> {
    /// What it is called in messages.
    pub name: &'a str,
    /// The nodes.
    pub nodes: [NodeId; 2],
    /// The largest distance; `None`: that at the start, neither more nor less.
    pub most: Option<f64>,
    /// A stiffness of the model (force over length), by which forces and gaps are compared.
    pub stiffness: f64,
    /// Positions of all nodes at the start.
    pub reference: &'a [Vec3],
    /// Which unknown is which.
    pub layout: Layout,
    /// Its multiplier.
    pub first: usize,
}

/// Two nodes that keep their distance, as a rod does, or that go no farther apart, as a rope does (E6).
pub struct Distance {
    name: String,
    dofs: [Dof; N + 1],
    nodes: [NodeId; 2],
    /// Where the nodes are at the start.
    start: [Vec3; 2],
    /// d
    length: f64,
    is_rope: bool,
    stiffness: f64,
    nonlinear: bool,
}

/// Unknowns of two nodes.
const N: usize = 6;

impl Distance {
    /// A rod, or a rope.
    ///
    /// # Errors
    /// Nodes in one point; a length or stiffness that is no positive number.
    pub fn new(parts: &DistanceParts<'_>) -> Result<Self, ConnectorError> {
        let start = parts.nodes.map(|node| place(parts.reference, node));
        let distance = (start[1] - start[0]).norm();
        if distance == 0.0 {
            return Err(ConnectorError::Narrow {
                point: true,
                what: "there is no line between them",
            });
        }
        let length = parts.most.unwrap_or(distance);
        for (what, number) in [("a distance", length), ("a stiffness", parts.stiffness)] {
            if !(number > 0.0 && number.is_finite()) {
                return Err(ConnectorError::Number {
                    what,
                    positive: true,
                });
            }
        }
        let dofs = std::array::from_fn(|i| match parts.nodes.get(i / 3) {
            Some(&node) => parts.layout.node(node, i % 3),
            None => parts.layout.multiplier(parts.first),
        });
        Ok(Self {
            name: parts.name.to_string(),
            dofs,
            nodes: parts.nodes,
            start,
            length,
            is_rope: parts.most.is_some(),
            stiffness: parts.stiffness,
            nonlinear: true,
        })
    }
}

impl Constraints for Distance {
    type Work = Scratch;

    fn name(&self) -> &str {
        &self.name
    }

    fn count(&self) -> usize {
        1
    }

    fn couple(&self, _: usize, out: &mut dyn PatternSink) {
        out.interface(&self.dofs);
    }

    fn set_nonlinear(&mut self, nonlinear: bool) {
        self.nonlinear = nonlinear;
    }

    fn add(&self, _: usize, trial: &State, order: Order, work: &mut Scratch, out: &mut dyn Sink) {
        let x = |k: usize| place(&trial.x, self.nodes[k]);
        let between = |nonlinear: bool| match nonlinear {
            true => x(1) - x(0),
            false => self.start[1] - self.start[0],
        };
        let line = between(self.nonlinear);
        let length = line.norm();
        let along = line.normalized().unwrap_or_default();
        let mut gap = length - self.length;
        if !self.nonlinear {
            let moved = (x(1) - self.start[1]) - (x(0) - self.start[0]);
            gap += along.dot(moved);
        }
        let multiplier = self.dofs.last().copied();
        let tension = multiplier.map_or(0.0, |dof| value(trial, dof));
        if self.is_rope && tension + self.stiffness * gap <= 0.0 {
            // slack: λ = 0, as a length
            let flexibility = -self.stiffness.recip();
            let stiffness: &[f64] = match order {
                Order::Tangent => &[flexibility],
                Order::Residual => &[],
            };
            let own = self.dofs.get(N..).unwrap_or_default();
            out.add(own, &[flexibility * tension], stiffness);
            return;
        }
        let gradient: [f64; N] =
            std::array::from_fn(|i| if i < 3 { -along[i] } else { along[i - 3] });
        let size = x(0).max_abs() + x(1).max_abs();
        let hold = Hold {
            dofs: &self.dofs,
            gap,
            gradient: &gradient,
            rounding: ROUNDING * f64::EPSILON * size,
        };
        let turn = match self.nonlinear && length > 0.0 {
            true => (Mat3::IDENTITY - Mat3::outer(along, along)) * length.recip(),
            false => Mat3::ZERO,
        };
        let hessian = |i: usize, j: usize| {
            let sign = if i / 3 == j / 3 { 1.0 } else { -1.0 };
            sign * turn.rows[i % 3][j % 3]
        };
        hold.add(hessian, trial, order, work, out);
    }
}
