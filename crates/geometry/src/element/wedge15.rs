use super::lagrange::{bubble, linear};
use super::quadrature::{self, Rules};
use super::serendipity::{correct_corners, dyad};
use super::wedge6::Wedge6;
use super::{Family, LockingClass, ReferenceElement, Side, quad8, tri6};
use crate::tensor::{Sym3, Vec3};

/// The serendipity wedge of fifteen nodes, a quadratic triangle (`ξ = L2`, `η = L3`) along a line `ζ ∈ [-1, 1]`: corners,
/// then the mid nodes at the bottom, at the top and between.
pub(super) struct Wedge15;

const NODES: [Vec3; 15] = [
    Vec3::new(0.0, 0.0, -1.0),
    Vec3::new(1.0, 0.0, -1.0),
    Vec3::new(0.0, 1.0, -1.0),
    Vec3::new(0.0, 0.0, 1.0),
    Vec3::new(1.0, 0.0, 1.0),
    Vec3::new(0.0, 1.0, 1.0),
    Vec3::new(0.5, 0.0, -1.0),
    Vec3::new(0.5, 0.5, -1.0),
    Vec3::new(0.0, 0.5, -1.0),
    Vec3::new(0.5, 0.0, 1.0),
    Vec3::new(0.5, 0.5, 1.0),
    Vec3::new(0.0, 0.5, 1.0),
    Vec3::new(0.0, 0.0, 0.0),
    Vec3::new(1.0, 0.0, 0.0),
    Vec3::new(0.0, 1.0, 0.0),
];

impl ReferenceElement for Wedge15 {
    fn name(&self) -> &'static str {
        "wedge15"
    }

    fn family(&self) -> Family {
        Family::Wedge
    }

    fn order(&self) -> usize {
        2
    }

    fn degree(&self) -> usize {
        3
    }

    fn locking_class(&self) -> LockingClass {
        LockingClass::HigherOrder { ndilatation: 1 }
    }

    fn nodes(&self) -> &'static [Vec3] {
        &NODES
    }

    fn shape(&self, xi: &Vec3, n: &mut [f64]) {
        let (corners, mids) = n.split_at_mut(6);
        Wedge6.shape(xi, corners);
        for (m, edge) in mids.iter_mut().zip(self.edges()) {
            let (f, z) = mid(edge, xi);
            *m = f.value * z[0];
        }
        correct_corners(self.edges(), n);
    }

    fn dshape(&self, xi: &Vec3, dn: &mut [Vec3]) {
        let (corners, mids) = dn.split_at_mut(6);
        Wedge6.dshape(xi, corners);
        for (m, edge) in mids.iter_mut().zip(self.edges()) {
            let (f, z) = mid(edge, xi);
            *m = f.slope * z[0] + Vec3::unit(2) * (f.value * z[1]);
        }
        correct_corners(self.edges(), dn);
    }

    fn ddshape(&self, xi: &Vec3, ddn: &mut [Sym3]) {
        let (corners, mids) = ddn.split_at_mut(6);
        Wedge6.ddshape(xi, corners);
        for (m, edge) in mids.iter_mut().zip(self.edges()) {
            let (f, z) = mid(edge, xi);
            let axial = Vec3::unit(2) * (0.5 * f.value * z[2]) + f.slope * z[1];
            *m = f.curvature * z[0] + dyad(axial, Vec3::unit(2));
        }
        correct_corners(self.edges(), ddn);
    }

    fn sides(&self) -> &'static [Side] {
        static SIDES: [Side; 5] = [
            Side::new(&tri6::Tri6, &[0, 2, 1, 8, 7, 6]),
            Side::new(&tri6::Tri6, &[3, 4, 5, 9, 10, 11]),
            Side::new(&quad8::Quad8, &[0, 1, 4, 3, 6, 13, 9, 12]),
            Side::new(&quad8::Quad8, &[1, 2, 5, 4, 7, 14, 10, 13]),
            Side::new(&quad8::Quad8, &[2, 0, 3, 5, 8, 12, 11, 14]),
        ];
        &SIDES
    }

    fn rules(&self) -> Rules {
        const RULES: Rules = Rules {
            mass: &quadrature::WEDGE_18,
            ..Rules::all(&quadrature::WEDGE_9)
        };
        RULES
    }
}

/// A function of the triangle, with its derivatives.
struct InTriangle {
    value: f64,
    slope: Vec3,
    curvature: Sym3,
}

/// The function of the mid node of an edge: `4 L_a L_b` of the triangle times a linear function of the axis where the
/// edge lies in a triangle, `L_a` times `1 − ζ²` where it runs along the axis.
fn mid(&[a, b]: &[usize; 2], xi: &Vec3) -> (InTriangle, [f64; 3]) {
    const SLOPES: [Vec3; 3] = [Vec3::new(-1.0, -1.0, 0.0), Vec3::unit(0), Vec3::unit(1)];
    let area = [1.0 - xi.x - xi.y, xi.x, xi.y];
    let (p, q) = (a % 3, b % 3);
    if p == q {
        let along = InTriangle {
            value: area[p],
            slope: SLOPES[p],
            curvature: Sym3::ZERO,
        };
        return (along, bubble(xi.z));
    }
    let across = InTriangle {
        value: 4.0 * area[p] * area[q],
        slope: (SLOPES[p] * area[q] + SLOPES[q] * area[p]) * 4.0,
        curvature: dyad(SLOPES[p], SLOPES[q]) * 4.0,
    };
    (across, linear(NODES[a].z, xi.z))
}
