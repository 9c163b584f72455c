use super::quadrature::{self, Rules};
use super::{Family, LockingClass, ReferenceElement, Side, tri3};
use crate::tensor::{Sym3, Vec3};

/// The linear tetrahedron of four nodes, `ξ = L2`, `η = L3`, `ζ = L4`.
pub(super) struct Tet4;

impl ReferenceElement for Tet4 {
    fn name(&self) -> &'static str {
        "tet4"
    }

    fn family(&self) -> Family {
        Family::Tetrahedron
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

    fn nodes(&self) -> &'static [Vec3] {
        const NODES: [Vec3; 4] = [Vec3::ZERO, Vec3::unit(0), Vec3::unit(1), Vec3::unit(2)];
        &NODES
    }

    fn shape(&self, xi: &Vec3, n: &mut [f64]) {
        n.copy_from_slice(&[1.0 - xi.x - xi.y - xi.z, xi.x, xi.y, xi.z]);
    }

    fn dshape(&self, _: &Vec3, dn: &mut [Vec3]) {
        dn.copy_from_slice(&[
            Vec3::new(-1.0, -1.0, -1.0),
            Vec3::unit(0),
            Vec3::unit(1),
            Vec3::unit(2),
        ]);
    }

    fn ddshape(&self, _: &Vec3, ddn: &mut [Sym3]) {
        ddn.fill(Sym3::ZERO);
    }

    fn sides(&self) -> &'static [Side] {
        static SIDES: [Side; 4] = [
            Side::new(&tri3::Tri3, &[0, 2, 1]),
            Side::new(&tri3::Tri3, &[0, 1, 3]),
            Side::new(&tri3::Tri3, &[1, 2, 3]),
            Side::new(&tri3::Tri3, &[2, 0, 3]),
        ];
        &SIDES
    }

    fn rules(&self) -> Rules {
        const RULES: Rules = Rules {
            surface: &quadrature::TET_4,
            mass: &quadrature::TET_4,
            ..Rules::all(&quadrature::TET_1)
        };
        RULES
    }
}
