use super::lagrange::{self, Product};
use super::line2::Line2;
use super::quadrature::{self, Rule};
use super::{ReferenceElement, Side};
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

    fn dim(&self) -> usize {
        1
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

    fn edges(&self) -> &'static [[usize; 2]] {
        Line2.edges()
    }

    fn full_rule(&self) -> &'static Rule {
        &quadrature::LINE_2
    }

    fn surface_rule(&self) -> &'static Rule {
        &quadrature::LINE_3
    }

    fn contains(&self, xi: &Vec3, tolerance: f64) -> bool {
        Line2.contains(xi, tolerance)
    }
}
