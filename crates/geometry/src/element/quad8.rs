use super::lagrange::{self, Product};
use super::quad4::Quad4;
use super::quadrature::{self, Rules};
use super::serendipity::correct_corners;
use super::{DualBasis, Family, LockingClass, ReferenceElement, Side, line3};
use crate::tensor::{Sym3, Vec3};

/// The serendipity quadrilateral of eight nodes, `ξ, η ∈ [-1, 1]`: corners, then mid nodes edge by edge.
pub(super) struct Quad8;

const NODES: [Vec3; 8] = [
    Vec3::new(-1.0, -1.0, 0.0),
    Vec3::new(1.0, -1.0, 0.0),
    Vec3::new(1.0, 1.0, 0.0),
    Vec3::new(-1.0, 1.0, 0.0),
    Vec3::new(0.0, -1.0, 0.0),
    Vec3::new(1.0, 0.0, 0.0),
    Vec3::new(0.0, 1.0, 0.0),
    Vec3::new(-1.0, 0.0, 0.0),
];

const MIDS: Product<2> = Product {
    factor: lagrange::serendipity,
    nodes: NODES.split_at(4).1,
};

impl ReferenceElement for Quad8 {
    fn name(&self) -> &'static str {
        "quad8"
    }

    fn family(&self) -> Family {
        Family::Quadrilateral
    }

    fn order(&self) -> usize {
        2
    }

    fn degree(&self) -> usize {
        3
    }

    fn locking_class(&self) -> LockingClass {
        LockingClass::HigherOrder { ndilatation: 3 }
    }

    fn dual_basis(&self) -> Option<DualBasis> {
        Some(DualBasis::Edges {
            pointwise: 3.0 / 8.0,
            whole: 0.2,
        })
    }

    fn nodes(&self) -> &'static [Vec3] {
        &NODES
    }

    fn shape(&self, xi: &Vec3, n: &mut [f64]) {
        let (corners, mids) = n.split_at_mut(4);
        Quad4.shape(xi, corners);
        MIDS.shape(xi, mids);
        correct_corners(self.edges(), n);
    }

    fn dshape(&self, xi: &Vec3, dn: &mut [Vec3]) {
        let (corners, mids) = dn.split_at_mut(4);
        Quad4.dshape(xi, corners);
        MIDS.dshape(xi, mids);
        correct_corners(self.edges(), dn);
    }

    fn ddshape(&self, xi: &Vec3, ddn: &mut [Sym3]) {
        let (corners, mids) = ddn.split_at_mut(4);
        Quad4.ddshape(xi, corners);
        MIDS.ddshape(xi, mids);
        correct_corners(self.edges(), ddn);
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
        const RULES: Rules = Rules {
            reduced: &quadrature::QUAD_4,
            ..Rules::all(&quadrature::QUAD_9)
        };
        RULES
    }
}
