use super::quadrature::{self, Rules};
use super::serendipity::Simplex;
use super::tri3::Tri3;
use super::{DualBasis, Family, LockingClass, ReferenceElement, Side, line3};
use crate::tensor::{Sym3, Vec3};

/// The quadratic triangle of six nodes, area coordinates `ξ = L2`, `η = L3`: corners, then mid nodes edge by edge.
pub(super) struct Tri6;

const NODES: [Vec3; 6] = [
    Vec3::new(0.0, 0.0, 0.0),
    Vec3::new(1.0, 0.0, 0.0),
    Vec3::new(0.0, 1.0, 0.0),
    Vec3::new(0.5, 0.0, 0.0),
    Vec3::new(0.5, 0.5, 0.0),
    Vec3::new(0.0, 0.5, 0.0),
];

const SHAPE: Simplex = Simplex(&Tri3);

impl ReferenceElement for Tri6 {
    fn name(&self) -> &'static str {
        "tri6"
    }

    fn family(&self) -> Family {
        Family::Triangle
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

    fn dual_basis(&self) -> Option<DualBasis> {
        Some(DualBasis::Edges {
            pointwise: 0.25,
            whole: 0.2,
        })
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
        static SIDES: [Side; 3] = [
            Side::new(&line3::Line3, &[0, 1, 3]),
            Side::new(&line3::Line3, &[1, 2, 4]),
            Side::new(&line3::Line3, &[2, 0, 5]),
        ];
        &SIDES
    }

    fn rules(&self) -> Rules {
        const RULES: Rules = Rules {
            surface: &quadrature::TRI_6,
            mass: &quadrature::TRI_6,
            revolved: &quadrature::TRI_6,
            ..Rules::all(&quadrature::TRI_3)
        };
        RULES
    }
}
