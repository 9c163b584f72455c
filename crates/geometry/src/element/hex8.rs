use super::quadrature::{self, Rules};
use super::{Family, LockingClass, ReferenceElement, Side, quad4};
use crate::tensor::{Sym3, Vec3};

/// The trilinear hexahedron of eight nodes, `ξ, η, ζ ∈ [-1, 1]`.
pub(super) struct Hex8;

const NODES: [Vec3; 8] = [
    Vec3::new(-1.0, -1.0, -1.0),
    Vec3::new(1.0, -1.0, -1.0),
    Vec3::new(1.0, 1.0, -1.0),
    Vec3::new(-1.0, 1.0, -1.0),
    Vec3::new(-1.0, -1.0, 1.0),
    Vec3::new(1.0, -1.0, 1.0),
    Vec3::new(1.0, 1.0, 1.0),
    Vec3::new(-1.0, 1.0, 1.0),
];

impl ReferenceElement for Hex8 {
    fn name(&self) -> &'static str {
        "hex8"
    }

    fn family(&self) -> Family {
        Family::Hexahedron
    }

    fn order(&self) -> usize {
        1
    }

    fn degree(&self) -> usize {
        3
    }

    fn locking_class(&self) -> LockingClass {
        LockingClass::Multilinear
    }

    fn nodes(&self) -> &'static [Vec3] {
        &NODES
    }

    fn shape(&self, xi: &Vec3, n: &mut [f64]) {
        for (n, a) in n.iter_mut().zip(&NODES) {
            *n = 0.125 * (1.0 + a.x * xi.x) * (1.0 + a.y * xi.y) * (1.0 + a.z * xi.z);
        }
    }

    fn dshape(&self, xi: &Vec3, dn: &mut [Vec3]) {
        for (dn, a) in dn.iter_mut().zip(&NODES) {
            let (p, q, r) = (1.0 + a.x * xi.x, 1.0 + a.y * xi.y, 1.0 + a.z * xi.z);
            *dn = Vec3::new(a.x * q * r, a.y * r * p, a.z * p * q) * 0.125;
        }
    }

    fn ddshape(&self, xi: &Vec3, ddn: &mut [Sym3]) {
        for (ddn, a) in ddn.iter_mut().zip(&NODES) {
            let (p, q, r) = (1.0 + a.x * xi.x, 1.0 + a.y * xi.y, 1.0 + a.z * xi.z);
            *ddn = Sym3::new(0.0, 0.0, 0.0, a.x * a.y * r, a.y * a.z * p, a.x * a.z * q) * 0.125;
        }
    }

    fn sides(&self) -> &'static [Side] {
        static SIDES: [Side; 6] = [
            Side::new(&quad4::Quad4, &[0, 3, 2, 1]),
            Side::new(&quad4::Quad4, &[4, 5, 6, 7]),
            Side::new(&quad4::Quad4, &[0, 1, 5, 4]),
            Side::new(&quad4::Quad4, &[1, 2, 6, 5]),
            Side::new(&quad4::Quad4, &[2, 3, 7, 6]),
            Side::new(&quad4::Quad4, &[3, 0, 4, 7]),
        ];
        &SIDES
    }

    fn rules(&self) -> Rules {
        Rules::all(&quadrature::HEX_8)
    }
}
