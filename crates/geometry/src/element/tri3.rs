use super::quadrature::{self, Rules};
use super::{DualBasis, Family, LockingClass, ReferenceElement, Side, line2};
use crate::tensor::{Sym3, Vec3};

/// The flat triangle of three nodes, area coordinates `ξ = L2`, `η = L3`.
pub(super) struct Tri3;

impl ReferenceElement for Tri3 {
    fn name(&self) -> &'static str {
        "tri3"
    }

    fn family(&self) -> Family {
        Family::Triangle
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
        const NODES: [Vec3; 3] = [Vec3::ZERO, Vec3::unit(0), Vec3::unit(1)];
        &NODES
    }

    fn shape(&self, xi: &Vec3, n: &mut [f64]) {
        n.copy_from_slice(&[1.0 - xi.x - xi.y, xi.x, xi.y]);
    }

    fn dshape(&self, _: &Vec3, dn: &mut [Vec3]) {
        dn.copy_from_slice(&[Vec3::new(-1.0, -1.0, 0.0), Vec3::unit(0), Vec3::unit(1)]);
    }

    fn ddshape(&self, _: &Vec3, ddn: &mut [Sym3]) {
        ddn.fill(Sym3::ZERO);
    }

    fn sides(&self) -> &'static [Side] {
        static SIDES: [Side; 3] = [
            Side::new(&line2::Line2, &[0, 1]),
            Side::new(&line2::Line2, &[1, 2]),
            Side::new(&line2::Line2, &[2, 0]),
        ];
        &SIDES
    }

    fn rules(&self) -> Rules {
        const RULES: Rules = Rules {
            surface: &quadrature::TRI_3,
            mass: &quadrature::TRI_3,
            revolved: &quadrature::TRI_3,
            ..Rules::all(&quadrature::TRI_1)
        };
        RULES
    }
}
