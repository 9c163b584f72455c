use super::quadrature::{self, Rules};
use super::{Family, LockingClass, ReferenceElement, Side, quad4, tri3};
use crate::tensor::{Sym3, Vec3};

/// The wedge of six nodes: a linear triangle (`ξ = L2`, `η = L3`) along a line `ζ ∈ [-1, 1]`.
pub(super) struct Wedge6;

impl ReferenceElement for Wedge6 {
    fn name(&self) -> &'static str {
        "wedge6"
    }

    fn family(&self) -> Family {
        Family::Wedge
    }

    fn order(&self) -> usize {
        1
    }

    fn degree(&self) -> usize {
        2
    }

    fn locking_class(&self) -> LockingClass {
        LockingClass::ConstantStrain
    }

    fn nodes(&self) -> &'static [Vec3] {
        const NODES: [Vec3; 6] = [
            Vec3::new(0.0, 0.0, -1.0),
            Vec3::new(1.0, 0.0, -1.0),
            Vec3::new(0.0, 1.0, -1.0),
            Vec3::new(0.0, 0.0, 1.0),
            Vec3::new(1.0, 0.0, 1.0),
            Vec3::new(0.0, 1.0, 1.0),
        ];
        &NODES
    }

    fn shape(&self, xi: &Vec3, n: &mut [f64]) {
        let area = [1.0 - xi.x - xi.y, xi.x, xi.y];
        let axis = [0.5 * (1.0 - xi.z), 0.5 * (1.0 + xi.z)];
        for (i, n) in n.iter_mut().enumerate() {
            *n = area[i % 3] * axis[i / 3];
        }
    }

    fn dshape(&self, xi: &Vec3, dn: &mut [Vec3]) {
        let area = [1.0 - xi.x - xi.y, xi.x, xi.y];
        let axis = [0.5 * (1.0 - xi.z), 0.5 * (1.0 + xi.z)];
        for (i, dn) in dn.iter_mut().enumerate() {
            let (da, dz) = (DAREA[i % 3], DAXIS[i / 3]);
            *dn = Vec3::new(da[0] * axis[i / 3], da[1] * axis[i / 3], area[i % 3] * dz);
        }
    }

    fn ddshape(&self, _: &Vec3, ddn: &mut [Sym3]) {
        for (i, ddn) in ddn.iter_mut().enumerate() {
            let (da, dz) = (DAREA[i % 3], DAXIS[i / 3]);
            *ddn = Sym3::new(0.0, 0.0, 0.0, 0.0, da[1] * dz, da[0] * dz);
        }
    }

    fn sides(&self) -> &'static [Side] {
        static SIDES: [Side; 5] = [
            Side::new(&tri3::Tri3, &[0, 2, 1]),
            Side::new(&tri3::Tri3, &[3, 4, 5]),
            Side::new(&quad4::Quad4, &[0, 1, 4, 3]),
            Side::new(&quad4::Quad4, &[1, 2, 5, 4]),
            Side::new(&quad4::Quad4, &[2, 0, 3, 5]),
        ];
        &SIDES
    }

    fn rules(&self) -> Rules {
        const RULES: Rules = Rules {
            raised: Some(&quadrature::WEDGE_9),
            ..Rules::all(&quadrature::WEDGE_6)
        };
        RULES
    }
}

const DAREA: [[f64; 2]; 3] = [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]];
const DAXIS: [f64; 2] = [-0.5, 0.5];
