use super::lagrange::{self, Product};
use super::quadrature::{self, Rules};
use super::{Family, LockingClass, ReferenceElement, Side, quad9};
use crate::tensor::{Sym3, Vec3};

/// The triquadratic hexahedron of 27 nodes, `ξ, η, ζ ∈ [-1, 1]`: those of hex20, then the centres of the sides S1 to S6,
/// then the centre.
pub(super) struct Hex27;

const NODES: [Vec3; 27] = [
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
    Vec3::new(0.0, 0.0, -1.0),
    Vec3::new(0.0, 0.0, 1.0),
    Vec3::new(0.0, -1.0, 0.0),
    Vec3::new(1.0, 0.0, 0.0),
    Vec3::new(0.0, 1.0, 0.0),
    Vec3::new(-1.0, 0.0, 0.0),
    Vec3::new(0.0, 0.0, 0.0),
];

const SHAPE: Product<3> = Product {
    factor: lagrange::quadratic,
    nodes: &NODES,
};

impl ReferenceElement for Hex27 {
    fn name(&self) -> &'static str {
        "hex27"
    }

    fn family(&self) -> Family {
        Family::Hexahedron
    }

    fn order(&self) -> usize {
        2
    }

    fn degree(&self) -> usize {
        6
    }

    fn locking_class(&self) -> LockingClass {
        LockingClass::HigherOrder { ndilatation: 4 }
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
        static SIDES: [Side; 6] = [
            Side::new(&quad9::Quad9, &[0, 3, 2, 1, 11, 10, 9, 8, 20]),
            Side::new(&quad9::Quad9, &[4, 5, 6, 7, 12, 13, 14, 15, 21]),
            Side::new(&quad9::Quad9, &[0, 1, 5, 4, 8, 17, 12, 16, 22]),
            Side::new(&quad9::Quad9, &[1, 2, 6, 5, 9, 18, 13, 17, 23]),
            Side::new(&quad9::Quad9, &[2, 3, 7, 6, 10, 19, 14, 18, 24]),
            Side::new(&quad9::Quad9, &[3, 0, 4, 7, 11, 16, 15, 19, 25]),
        ];
        &SIDES
    }

    fn rules(&self) -> Rules {
        Rules::all(&quadrature::HEX_27)
    }
}
