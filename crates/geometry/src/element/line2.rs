use super::quadrature::{self, Rule};
use super::{ReferenceElement, Side};
use crate::tensor::{Sym3, Vec3};

/// The straight line of two nodes, `ξ ∈ [-1, 1]`.
pub(super) struct Line2;

impl ReferenceElement for Line2 {
    fn name(&self) -> &'static str {
        "line2"
    }

    fn dim(&self) -> usize {
        1
    }

    fn nodes(&self) -> &'static [Vec3] {
        const NODES: [Vec3; 2] = [Vec3::new(-1.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0)];
        &NODES
    }

    fn shape(&self, xi: &Vec3, n: &mut [f64]) {
        n.copy_from_slice(&[0.5 * (1.0 - xi.x), 0.5 * (1.0 + xi.x)]);
    }

    fn dshape(&self, _: &Vec3, dn: &mut [Vec3]) {
        dn.copy_from_slice(&[Vec3::new(-0.5, 0.0, 0.0), Vec3::new(0.5, 0.0, 0.0)]);
    }

    fn ddshape(&self, _: &Vec3, ddn: &mut [Sym3]) {
        ddn.fill(Sym3::ZERO);
    }

    fn sides(&self) -> &'static [Side] {
        &[]
    }

    fn edges(&self) -> &'static [[usize; 2]] {
        &[[0, 1]]
    }

    fn full_rule(&self) -> &'static Rule {
        &quadrature::LINE_2
    }

    fn contains(&self, xi: &Vec3, tolerance: f64) -> bool {
        xi.x.abs() <= 1.0 + tolerance
    }
}
