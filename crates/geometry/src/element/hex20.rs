use super::hex8::Hex8;
use super::lagrange::{self, Product};
use super::quadrature::{self, Rules};
use super::serendipity::correct_corners;
use super::{Family, LockingClass, ReferenceElement, Side, quad8};
use crate::tensor::{Sym3, Vec3};

/// The serendipity hexahedron of twenty nodes, `ξ, η, ζ ∈ [-1, 1]`: corners, then the mid nodes at the bottom, at the
/// top and between.
pub(super) struct Hex20;

const NODES: [Vec3; 20] = [
    Vec3::new(-1.0, -1.0, -1.0),
    Vec3::new(1.0, -1.0, -1.0),
    Vec3::new(1.0, 1.0, -1.0),
    Vec3::new(-1.0, 1.0, -1.0),
    Vec3::new(-1.0, -1.0, 1.0),
    Vec3::new(1.0, -1.0, 1.0),
    Vec3::new(1.0, 1.0, 1.0),
    Vec3::new(-1.0, 1.0, 1.0),
    Vec3::new(0.0, -1.0, -1.0),
    Vec3::new(1.0, 0.0, -1.0),
    Vec3::new(0.0, 1.0, -1.0),
    Vec3::new(-1.0, 0.0, -1.0),
    Vec3::new(0.0, -1.0, 1.0),
    Vec3::new(1.0, 0.0, 1.0),
    Vec3::new(0.0, 1.0, 1.0),
    Vec3::new(-1.0, 0.0, 1.0),
    Vec3::new(-1.0, -1.0, 0.0),
    Vec3::new(1.0, -1.0, 0.0),
    Vec3::new(1.0, 1.0, 0.0),
    Vec3::new(-1.0, 1.0, 0.0),
];

const MIDS: Product<3> = Product {
    factor: lagrange::serendipity,
    nodes: NODES.split_at(8).1,
};

impl ReferenceElement for Hex20 {
    fn name(&self) -> &'static str {
        "hex20"
    }

    fn family(&self) -> Family {
        Family::Hexahedron
    }

    fn order(&self) -> usize {
        2
    }

    fn degree(&self) -> usize {
        4
    }

    fn locking_class(&self) -> LockingClass {
        LockingClass::HigherOrder { ndilatation: 4 }
    }

    fn nodes(&self) -> &'static [Vec3] {
        &NODES
    }

    fn shape(&self, xi: &Vec3, n: &mut [f64]) {
        let (corners, mids) = n.split_at_mut(8);
        Hex8.shape(xi, corners);
        MIDS.shape(xi, mids);
        correct_corners(self.edges(), n);
    }

    fn dshape(&self, xi: &Vec3, dn: &mut [Vec3]) {
        let (corners, mids) = dn.split_at_mut(8);
        Hex8.dshape(xi, corners);
        MIDS.dshape(xi, mids);
        correct_corners(self.edges(), dn);
    }

    fn ddshape(&self, xi: &Vec3, ddn: &mut [Sym3]) {
        let (corners, mids) = ddn.split_at_mut(8);
        Hex8.ddshape(xi, corners);
        MIDS.ddshape(xi, mids);
        correct_corners(self.edges(), ddn);
    }

    fn sides(&self) -> &'static [Side] {
        static SIDES: [Side; 6] = [
            Side::new(&quad8::Quad8, &[0, 3, 2, 1, 11, 10, 9, 8]),
            Side::new(&quad8::Quad8, &[4, 5, 6, 7, 12, 13, 14, 15]),
            Side::new(&quad8::Quad8, &[0, 1, 5, 4, 8, 17, 12, 16]),
            Side::new(&quad8::Quad8, &[1, 2, 6, 5, 9, 18, 13, 17]),
            Side::new(&quad8::Quad8, &[2, 3, 7, 6, 10, 19, 14, 18]),
            Side::new(&quad8::Quad8, &[3, 0, 4, 7, 11, 16, 15, 19]),
        ];
        &SIDES
    }

    fn rules(&self) -> Rules {
        const RULES: Rules = Rules {
            reduced: &quadrature::HEX_8,
            ..Rules::all(&quadrature::HEX_27)
        };
        RULES
    }
}
