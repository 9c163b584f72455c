use super::quadrature::{self, Rules};
use super::{DualBasis, Family, LockingClass, ReferenceElement, Side};
use crate::tensor::{Sym3, Vec3};

/// The straight line of two nodes, `ξ ∈ [-1, 1]`.
pub(super) struct Line2;

impl ReferenceElement for Line2 {
    fn name(&self) -> &'static str {
        "line2"
    }

    fn family(&self) -> Family {
        Family::Line
    }

    fn order(&self) -> usize {
        1
    }

    fn degree(&self) -> usize {
        1
    }

    fn locking_class(&self) -> LockingClass {
        LockingClass::ConstantStrain
    }

    fn dual_basis(&self) -> Option<DualBasis> {
        Some(DualBasis::Shape)
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

    fn rules(&self) -> Rules {
        Rules::all(&quadrature::LINE_2)
    }
}
