use super::quadrature::{self, Rules};
use super::{DualBasis, Family, LockingClass, ReferenceElement, Side, line2};
use crate::tensor::{Sym3, Vec3};

/// The bilinear quadrilateral of four nodes, `ξ, η ∈ [-1, 1]`.
pub(crate) struct Quad4;

const NODES: [Vec3; 4] = [
    Vec3::new(-1.0, -1.0, 0.0),
    Vec3::new(1.0, -1.0, 0.0),
    Vec3::new(1.0, 1.0, 0.0),
    Vec3::new(-1.0, 1.0, 0.0),
];

impl ReferenceElement for Quad4 {
    fn name(&self) -> &'static str {
        "quad4"
    }

    fn family(&self) -> Family {
        Family::Quadrilateral
    }

    fn order(&self) -> usize {
        1
    }

    fn degree(&self) -> usize {
        2
    }

    fn locking_class(&self) -> LockingClass {
        LockingClass::Multilinear
    }

    fn dual_basis(&self) -> Option<DualBasis> {
        Some(DualBasis::Shape)
    }

    fn nodes(&self) -> &'static [Vec3] {
        &NODES
    }

    fn shape(&self, xi: &Vec3, n: &mut [f64]) {
        for (n, a) in n.iter_mut().zip(&NODES) {
            *n = 0.25 * (1.0 + a.x * xi.x) * (1.0 + a.y * xi.y);
        }
    }

    fn dshape(&self, xi: &Vec3, dn: &mut [Vec3]) {
        for (dn, a) in dn.iter_mut().zip(&NODES) {
            *dn = Vec3::new(
                0.25 * a.x * (1.0 + a.y * xi.y),
                0.25 * a.y * (1.0 + a.x * xi.x),
                0.0,
            );
        }
    }

    fn ddshape(&self, _: &Vec3, ddn: &mut [Sym3]) {
        for (ddn, a) in ddn.iter_mut().zip(&NODES) {
            *ddn = Sym3::new(0.0, 0.0, 0.0, 0.25 * a.x * a.y, 0.0, 0.0);
        }
    }

    fn sides(&self) -> &'static [Side] {
        static SIDES: [Side; 4] = [
            Side::new(&line2::Line2, &[0, 1]),
            Side::new(&line2::Line2, &[1, 2]),
            Side::new(&line2::Line2, &[2, 3]),
            Side::new(&line2::Line2, &[3, 0]),
        ];
        &SIDES
    }

    fn rules(&self) -> Rules {
        Rules::all(&quadrature::QUAD_4)
    }
}
