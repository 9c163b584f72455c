use super::lagrange::{self, Product};
use super::quadrature::{self, Rules};
use super::{DualBasis, Family, LockingClass, ReferenceElement, Side};
use crate::tensor::{Sym3, Vec3};

/// The quadratic line of three nodes, ends first, `ξ ∈ [-1, 1]`.
pub(super) struct Line3;

const NODES: [Vec3; 3] = [
    Vec3::new(-1.0, 0.0, 0.0),
    Vec3::new(1.0, 0.0, 0.0),
    Vec3::new(0.0, 0.0, 0.0),
];

const SHAPE: Product<1> = Product {
    factor: lagrange::quadratic,
    nodes: &NODES,
};

impl ReferenceElement for Line3 {
    fn name(&self) -> &'static str {
        "line3"
    }

    fn family(&self) -> Family {
        Family::Line
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
        &[]
    }

    fn rules(&self) -> Rules {
        const RULES: Rules = Rules {
            surface: &quadrature::LINE_3,
            mass: &quadrature::LINE_3,
            ..Rules::all(&quadrature::LINE_2)
        };
        RULES
    }
}
