use super::quadrature::{self, Rule};
use super::serendipity::Simplex;
use super::tri3::Tri3;
use super::{ReferenceElement, Side, line3};
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

    fn dim(&self) -> usize {
        2
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

    fn edges(&self) -> &'static [[usize; 2]] {
        Tri3.edges()
    }

    fn full_rule(&self) -> &'static Rule {
        &quadrature::TRI_3
    }

    fn surface_rule(&self) -> &'static Rule {
        &quadrature::TRI_6
    }

    fn contains(&self, xi: &Vec3, tolerance: f64) -> bool {
        Tri3.contains(xi, tolerance)
    }
}
