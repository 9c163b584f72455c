use super::hold::{Constraints, Hold, Scratch};
use super::{ConnectorError, ROUNDING, place, value};
use crate::system::{Dof, Layout, Order, PatternSink, Sink, State};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::{Mat3, Vec3};

/// What a mean twist is made from.
#[derive(Clone, Debug)]
pub struct TwistParts<'a> {
    /// What it is called in messages.
    pub name: &'a str,
    /// The nodes, each once.
    pub nodes: &'a [NodeId],
    /// The direction of the axis, through the mean of the nodes; in the plane along z.
    pub axis: Vec3,
    /// The unknown that is the angle (radian).
    pub angle: Dof,
    /// Positions of all nodes at the start.
    pub reference: &'a [Vec3],
    /// Which unknown is which.
    pub layout: Layout,
    /// Its multiplier.
    pub first: usize,
}

/// An angle that is the mean of those by which nodes turn about an axis through their mean (E7).
pub struct Twist {
    name: String,
    /// Of the nodes, then the angle and the multiplier.
    dofs: Vec<Dof>,
    nodes: Vec<NodeId>,
    /// p_i of every node; those on the axis turn by no angle.
    arms: Vec<Option<Vec3>>,
    start: Vec<Vec3>,
    axis: Vec3,
    /// r
    radius: f64,
    nonlinear: bool,
}

/// Part of the largest distance from the axis below which a node counts as lying on it.
const ON_AXIS: f64 = 1e-9;

/// What one evaluation needs.
#[derive(Default)]
pub(super) struct Twisted {
    gradient: Vec<f64>,
    hessian: Vec<Mat3>,
    hold: Scratch,
}

impl Twist {
    /// A mean twist.
    ///
    /// # Errors
    /// An axis without direction; nodes that all lie on it.
    pub fn new(parts: &TwistParts<'_>) -> Result<Self, ConnectorError> {
        let Some(axis) = parts.axis.normalized() else {
            return Err(ConnectorError::Number {
                what: "the length of an axis",
                positive: true,
            });
        };
        let start = parts.nodes.iter().map(|&n| place(parts.reference, n));
        let start: Vec<Vec3> = start.collect();
        let middle = start.iter().copied().sum::<Vec3>() / start.len().max(1) as f64;
        let across = |x: &Vec3| {
            let arm = *x - middle;
            arm - axis * arm.dot(axis)
        };
        let arms: Vec<Vec3> = start.iter().map(across).collect();
        let extent = start
            .iter()
            .fold(0.0f64, |m, x| m.max((*x - middle).norm()));
        let off_axis = |arm: &Vec3| arm.norm() > ON_AXIS * extent;
        let arms: Vec<Option<Vec3>> = arms.into_iter().map(|a| Some(a).filter(off_axis)).collect();
        let turning = arms.iter().flatten().count();
        if turning == 0 {
            return Err(ConnectorError::Narrow {
                point: start.len() < 2,
                what: "they turn about no axis through them",
            });
        }
        let squares: f64 = arms.iter().flatten().map(|a| a.norm_squared()).sum();
        let layout = &parts.layout;
        let of_nodes = parts.nodes.iter();
        let mut dofs: Vec<Dof> = of_nodes
            .flat_map(|&node| (0..3).map(move |axis| layout.node(node, axis)))
            .collect();
        dofs.extend([parts.angle, layout.multiplier(parts.first)]);
        Ok(Self {
            name: parts.name.to_string(),
            dofs,
            nodes: parts.nodes.to_vec(),
            arms,
            start,
            axis,
            radius: (squares / turning as f64).sqrt(),
            nonlinear: true,
        })
    }

    /// Present arms across the axis; at small strain those at the start.
    fn arm(&self, k: usize, trial: &State, middle: Vec3) -> Option<Vec3> {
        let start = (*self.arms.get(k)?)?;
        let moved = self.moved(k, trial) - middle;
        let moved = moved - self.axis * moved.dot(self.axis);
        Some(if self.nonlinear { start + moved } else { start })
    }

    /// u_i
    fn moved(&self, k: usize, trial: &State) -> Vec3 {
        match (self.nodes.get(k), self.start.get(k)) {
            (Some(&node), Some(&start)) => place(&trial.x, node) - start,
            _ => Vec3::ZERO,
        }
    }
}

impl Constraints for Twist {
    type Work = Twisted;

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

    fn add(&self, _: usize, trial: &State, order: Order, work: &mut Twisted, out: &mut dyn Sink) {
        let count = self.nodes.len();
        let middle = (0..count).map(|k| self.moved(k, trial)).sum::<Vec3>() / count as f64;
        let turning = self.arms.iter().flatten().count() as f64;
        let given = self.dofs.get(3 * count).copied();
        let given = given.map_or(0.0, |dof| value(trial, dof));
        // ∂θ = a × q / |q|², and its derivative, in the plane across the axis
        work.gradient.clear();
        work.hessian.clear();
        let mut sum = 0.0;
        let (mut mean, mut mean_hessian) = (Vec3::ZERO, Mat3::ZERO);
        let turn = Mat3::skew(self.axis);
        let share = self.radius / turning;
        for k in 0..count {
            let (mut slope, mut bend) = (Vec3::ZERO, Mat3::ZERO);
            if let (Some(Some(p)), Some(q)) = (self.arms.get(k), self.arm(k, trial, middle)) {
                let square = q.norm_squared().max(f64::MIN_POSITIVE);
                slope = self.axis.cross(q) * (share / square);
                if self.nonlinear {
                    bend = (turn * (share / square)) - Mat3::outer(slope, q) * (2.0 / square);
                    let angle = self.axis.dot(p.cross(q)).atan2(p.dot(q));
                    // of all angles that look alike, the one closest to the wanted angle
                    let turns = ((given - angle) / std::f64::consts::TAU).round();
                    sum += share * (angle + std::f64::consts::TAU * turns);
                } else {
                    sum += slope.dot(self.moved(k, trial) - middle);
                }
            }
            mean += slope / count as f64;
            mean_hessian = mean_hessian + bend * (1.0 / count as f64);
            work.gradient.extend(slope.to_array());
            work.hessian.push(bend);
        }
        for (k, slope) in work.gradient.iter_mut().enumerate() {
            *slope -= mean[k % 3];
        }
        work.gradient.push(-self.radius);
        let size = self.start.iter().fold(0.0f64, |m, x| m.max(x.max_abs()));
        let hold = Hold {
            dofs: &self.dofs,
            gap: sum - self.radius * given,
            gradient: &work.gradient,
            rounding: ROUNDING * f64::EPSILON * size,
        };
        let bends = &work.hessian;
        let hessian = |i: usize, j: usize| {
            let (Some(a), Some(b)) = (bends.get(i / 3), bends.get(j / 3)) else {
                return 0.0;
            };
            let at = |m: &Mat3| m.rows[i % 3][j % 3];
            let own = if i / 3 == j / 3 { at(a) } else { 0.0 };
            own - (at(a) + at(b) - at(&mean_hessian)) / count as f64
        };
        hold.add(hessian, trial, order, &mut work.hold, out);
    }
}
