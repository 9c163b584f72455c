use super::hold::{Constraints, Hold, Scratch, take_out};
use super::{ConnectorError, ROUNDING, place, value};
use crate::system::{Dof, Layout, NO_DOF, Order, PatternSink, Sink, State};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::{Mat3, Vec3};
use std::sync::Arc;

/// Nodes that stay in a plane, or on a line in the plane (E2).
pub struct Plane {
    name: String,
    layout: Layout,
    reference: Arc<[Vec3]>,
    /// What spans the plane; the third is not used in the plane.
    base: [NodeId; 3],
    /// The others, each with a multiplier.
    nodes: Vec<NodeId>,
    first: usize,
    /// 2 A_0; in the plane the length of the base.
    scale: f64,
    nonlinear: bool,
}

/// How far nodes may be from their plane at the start, relative to the size of the base.
const UNEVEN: f64 = 1e-4;
/// Height of the base triangle over its longest edge below which nodes count as lying on a line.
const NARROW: f64 = 1e-6;

/// Unknowns of one constraint: four nodes and the multiplier.
const N: usize = 13;

/// Derivatives of `d·(a × b)` by the edges a, b, d.
struct Volume {
    value: f64,
    gradient: [Vec3; 3],
    hessian: [[Mat3; 3]; 3],
}

impl Volume {
    fn of([a, b, d]: [Vec3; 3]) -> Self {
        let s = Mat3::skew;
        let o = Mat3::ZERO;
        Self {
            value: d.dot(a.cross(b)),
            gradient: [b.cross(d), d.cross(a), a.cross(b)],
            hessian: [
                [o, s(d) * -1.0, s(b)],
                [s(d), o, s(a) * -1.0],
                [s(b) * -1.0, s(a), o],
            ],
        }
    }
}

/// The edge that each node moves, with its sign: the first node moves all.
const MOVES: [[f64; 3]; 4] = [
    [-1.0, -1.0, -1.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
];

impl Plane {
    /// The number of multipliers that so many nodes take.
    #[must_use]
    pub const fn nmultiplier(layout: &Layout, nnode: usize) -> usize {
        nnode.saturating_sub(layout.ndim())
    }

    /// Nodes that stay in a plane. Their multipliers are those from `first` on.
    ///
    /// # Errors
    /// Nodes on one line (in the plane: in one point), or not in a plane at the start.
    pub fn new(
        name: &str,
        nodes: &[NodeId],
        reference: Arc<[Vec3]>,
        layout: Layout,
        first: usize,
    ) -> Result<Self, ConnectorError> {
        let mut plane = Self {
            name: name.to_string(),
            layout,
            base: [0; 3],
            nodes: nodes.to_vec(),
            first,
            scale: 1.0,
            nonlinear: true,
            reference,
        };
        if Self::nmultiplier(&layout, nodes.len()) == 0 {
            plane.nodes.clear();
            return Ok(plane);
        }
        plane.span()?;
        for &node in &plane.nodes {
            let distance = plane.volume(node, |n| plane.start(n)).value / plane.scale;
            if distance.abs() > UNEVEN * plane.scale.powf(1.0 / (layout.ndim() - 1) as f64) {
                return Err(ConnectorError::Uneven {
                    node,
                    what: "in one plane",
                    distance,
                });
            }
        }
        Ok(plane)
    }

    fn start(&self, node: NodeId) -> Vec3 {
        place(&self.reference, node)
    }

    /// Chooses the nodes that span the plane: far from the middle, far from the first, far from the line between them.
    fn span(&mut self) -> Result<(), ConnectorError> {
        let n = self.nodes.len() as f64;
        let middle = self.nodes.iter().map(|&n| self.start(n)).sum::<Vec3>() * n.recip();
        let a = self.take(|x| (x - middle).norm());
        let from = self.start(a);
        let b = self.take(|x| (x - from).norm());
        let edge = self.start(b) - from;
        let length = edge.norm();
        if length == 0.0 {
            return Err(ConnectorError::Narrow {
                point: true,
                what: "they span nothing that could stay plane",
            });
        }
        self.base = [a, b, b];
        self.scale = length;
        if self.layout.ndim() == 3 {
            let c = self.take(|x| (x - from).cross(edge).norm());
            self.scale = (self.start(c) - from).cross(edge).norm();
            self.base[2] = c;
            if self.scale <= NARROW * length * length {
                return Err(ConnectorError::Narrow {
                    point: false,
                    what: "they span no plane",
                });
            }
        }
        Ok(())
    }

    /// Takes out the node at which a measure is largest.
    fn take(&mut self, measure: impl Fn(Vec3) -> f64) -> NodeId {
        let reference = &self.reference;
        take_out(&mut self.nodes, |n| measure(place(reference, n)))
    }

    fn volume(&self, node: NodeId, x: impl Fn(NodeId) -> Vec3) -> Volume {
        let [a, b, c] = self.base;
        let from = x(a);
        let second = match self.layout.ndim() {
            3 => x(c) - from,
            _ => Vec3::unit(2),
        };
        Volume::of([x(b) - from, second, x(node) - from])
    }

    fn dofs(&self, k: usize) -> [Dof; N] {
        let [a, b, c] = self.base;
        let nodes = [a, b, c, self.nodes[k]];
        std::array::from_fn(|i| {
            if i == N - 1 {
                self.layout.multiplier(self.first + k)
            } else if i / 3 == 2 && self.layout.ndim() == 2 {
                NO_DOF
            } else {
                self.layout.node(nodes[i / 3], i % 3)
            }
        })
    }

    /// What the nodes move: in the plane the second edge stays.
    fn moves(&self, node: usize, edge: usize) -> f64 {
        if edge == 1 && self.layout.ndim() == 2 {
            0.0
        } else {
            MOVES[node][edge]
        }
    }
}

impl Constraints for Plane {
    type Work = Scratch;

    fn name(&self) -> &str {
        &self.name
    }

    fn count(&self) -> usize {
        self.nodes.len()
    }

    fn couple(&self, k: usize, out: &mut dyn PatternSink) {
        out.interface(&self.dofs(k));
    }

    fn set_nonlinear(&mut self, nonlinear: bool) {
        self.nonlinear = nonlinear;
    }

    fn add(&self, k: usize, trial: &State, order: Order, work: &mut Scratch, out: &mut dyn Sink) {
        let node = self.nodes[k];
        let dofs = self.dofs(k);
        let start = self.volume(node, |n| self.start(n));
        let x = |n: NodeId| place(&trial.x, n);
        let now = if self.nonlinear {
            self.volume(node, x)
        } else {
            Volume {
                hessian: [[Mat3::ZERO; 3]; 3],
                ..self.volume(node, |n| self.start(n))
            }
        };
        let scale = self.scale.recip();
        let gradient: [f64; N - 1] = std::array::from_fn(|i| {
            let edges = (0..3).map(|e| self.moves(i / 3, e) * now.gradient[e][i % 3]);
            scale * edges.sum::<f64>()
        });
        let gap = if self.nonlinear {
            scale * (now.value - start.value)
        } else {
            let u = dofs.iter().map(|&d| value(trial, d));
            gradient.iter().zip(u).map(|(g, u)| g * u).sum()
        };
        let size = (x(node).max_abs() + x(self.base[0]).max_abs()) * f64::EPSILON;
        let hold = Hold {
            dofs: &dofs,
            gap,
            gradient: &gradient,
            rounding: ROUNDING * size,
        };
        let hessian = |i: usize, j: usize| {
            let mut sum = 0.0;
            for e in 0..3 {
                for f in 0..3 {
                    let weight = self.moves(i / 3, e) * self.moves(j / 3, f);
                    sum += weight * now.hessian[e][f].rows[i % 3][j % 3];
                }
            }
            scale * sum
        };
        hold.add(hessian, trial, order, work, out);
    }
}
