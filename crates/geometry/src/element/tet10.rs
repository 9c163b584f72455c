use super::quadrature::{self, Rules};
use super::serendipity::Simplex;
use super::tet4::Tet4;
use super::{Family, LockingClass, ReferenceElement, Side, tri6};
use crate::tensor::{Sym3, Vec3};

/// The quadratic tetrahedron of ten nodes, `ξ = L2`, `η = L3`, `ζ = L4`: corners, then mid nodes edge by edge.
pub(super) struct Tet10;

const NODES: [Vec3; 10] = [
    Vec3::new(0.0, 0.0, 0.0),
    Vec3::new(1.0, 0.0, 0.0),
    Vec3::new(0.0, 1.0, 0.0),
    Vec3::new(0.0, 0.0, 1.0),
    Vec3::new(0.5, 0.0, 0.0),
    Vec3::new(0.5, 0.5, 0.0),
    Vec3::new(0.0, 0.5, 0.0),
    Vec3::new(0.0, 0.0, 0.5),
    Vec3::new(0.5, 0.0, 0.5),
    Vec3::new(0.0, 0.5, 0.5),
];

const SHAPE: Simplex = Simplex(&Tet4);

impl ReferenceElement for Tet10 {
    fn name(&self) -> &'static str {
        "tet10"
    }

    fn family(&self) -> Family {
        Family::Tetrahedron
    }

    fn order(&self) -> usize {
        2
    }

    fn degree(&self) -> usize {
        2
    }

    fn locking_class(&self) -> LockingClass {
        LockingClass::HigherOrder { ndilatation: 1 }
    }

    fn nodes(&self) -> &'static [Vec3] {
        &NODES
    }

    fn shape(&self, xi: &Vec3, n: &mut [f64]) {
        SHAPE.shape(xi, n);
    }

    fn dshape(&self, xi: &Vec3, dn: &mut [Vec3]) {
        SHAPE.dshape(xi, dn);
    }

    fn ddshape(&self, xi: &Vec3, ddn: &mut [Sym3]) {
        SHAPE.ddshape(xi, ddn);
    }

    fn sides(&self) -> &'static [Side] {
        static SIDES: [Side; 4] = [
            Side::new(&tri6::Tri6, &[0, 2, 1, 6, 5, 4]),
            Side::new(&tri6::Tri6, &[0, 1, 3, 4, 8, 7]),
            Side::new(&tri6::Tri6, &[1, 2, 3, 5, 9, 8]),
            Side::new(&tri6::Tri6, &[2, 0, 3, 6, 7, 9]),
        ];
        &SIDES
    }

    fn rules(&self) -> Rules {
        const RULES: Rules = Rules {
            mass: &quadrature::TET_14,
            dilatation: &quadrature::TET_14,
            ..Rules::all(&quadrature::TET_4)
        };
        RULES
    }
}
