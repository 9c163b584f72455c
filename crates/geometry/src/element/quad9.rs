use super::lagrange::{self, Product};
use super::quadrature::{self, Rules};
use super::{DualBasis, Family, LockingClass, ReferenceElement, Side, line3};
use crate::tensor::{Sym3, Vec3};

/// The biquadratic quadrilateral of nine nodes, `ξ, η ∈ [-1, 1]`: those of quad8, then the centre.
pub(super) struct Quad9;

const NODES: [Vec3; 9] = [
    Vec3::new(-1.0, -1.0, 0.0),
    Vec3::new(1.0, -1.0, 0.0),
    Vec3::new(1.0, 1.0, 0.0),
    Vec3::new(-1.0, 1.0, 0.0),
    Vec3::new(0.0, -1.0, 0.0),
    Vec3::new(1.0, 0.0, 0.0),
    Vec3::new(0.0, 1.0, 0.0),
    Vec3::new(-1.0, 0.0, 0.0),
    Vec3::new(0.0, 0.0, 0.0),
];

const SHAPE: Product<2> = Product {
    factor: lagrange::quadratic,
    nodes: &NODES,
};

impl ReferenceElement for Quad9 {
    fn name(&self) -> &'static str {
        "quad9"
    }

    fn family(&self) -> Family {
        Family::Quadrilateral
    }

    fn order(&self) -> usize {
        2
    }

    fn degree(&self) -> usize {
        4
    }

    fn locking_class(&self) -> LockingClass {
        LockingClass::HigherOrder { ndilatation: 3 }
    }

    fn dual_basis(&self) -> Option<DualBasis> {
        Some(DualBasis::Axes { alpha: 0.25 })
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
            Side::new(&line3::Line3, &[0, 1, 4]),
            Side::new(&line3::Line3, &[1, 2, 5]),
            Side::new(&line3::Line3, &[2, 3, 6]),
            Side::new(&line3::Line3, &[3, 0, 7]),
        ];
        &SIDES
    }

    fn rules(&self) -> Rules {
        Rules::all(&quadrature::QUAD_9)
    }
}
