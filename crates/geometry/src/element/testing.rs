//! Made-up facets of degree 3 for tests: no table has them, mortar contact has no dual basis for them. Tests of other crates
//! take this file by its path.

use signorini_geometry::element::quadrature::{self, Rule, Rules};
use signorini_geometry::element::{Element, Family, LockingClass, ReferenceElement, Side};
use signorini_geometry::tensor::{Sym3, Vec3};

/// All of them.
pub(crate) const CUBIC: [Element; 2] = [&Line4, &Tri10];

/// The line of four nodes: its ends, then two inside.
pub(crate) struct Line4;

/// The triangle of ten nodes: corners, two on each edge, the centroid.
pub(crate) struct Tri10;

/// A function of one area coordinate: its value, slope and second derivative.
type Factor = [f64; 3];

/// Of what a shape function is the product: how many thirds of each area coordinate its node has.
type Thirds = [u8; 3];

/// `Π (3 L − k)/(k + 1)` for all `k` below `n`.
fn factor(n: u8, l: f64) -> Factor {
    match n {
        0 => [1.0, 0.0, 0.0],
        1 => [3.0 * l, 3.0, 0.0],
        2 => [1.5 * l * (3.0 * l - 1.0), 9.0 * l - 1.5, 9.0],
        _ => [
            0.5 * l * (3.0 * l - 1.0) * (3.0 * l - 2.0),
            13.5 * l * l - 9.0 * l + 1.0,
            27.0 * l - 9.0,
        ],
    }
}

/// The area coordinates with their slopes.
struct Area {
    l: [f64; 3],
    slope: [Vec3; 3],
}

impl Area {
    fn on_line(xi: &Vec3) -> Self {
        let half = Vec3::new(0.5, 0.0, 0.0);
        Self {
            l: [0.5 * (1.0 - xi.x), 0.5 * (1.0 + xi.x), 0.0],
            slope: [-half, half, Vec3::ZERO],
        }
    }

    fn on_triangle(xi: &Vec3) -> Self {
        Self {
            l: [1.0 - xi.x - xi.y, xi.x, xi.y],
            slope: [Vec3::new(-1.0, -1.0, 0.0), Vec3::unit(0), Vec3::unit(1)],
        }
    }

    fn factors(&self, thirds: &Thirds) -> [Factor; 3] {
        std::array::from_fn(|a| factor(thirds[a], self.l[a]))
    }

    fn shape(&self, thirds: &[Thirds], n: &mut [f64]) {
        for (n, thirds) in n.iter_mut().zip(thirds) {
            *n = self.factors(thirds).iter().map(|f| f[0]).product();
        }
    }

    fn dshape(&self, thirds: &[Thirds], dn: &mut [Vec3]) {
        for (dn, thirds) in dn.iter_mut().zip(thirds) {
            let f = self.factors(thirds);
            let by = |a: usize| self.slope[a] * (f[a][1] * f[(a + 1) % 3][0] * f[(a + 2) % 3][0]);
            *dn = by(0) + by(1) + by(2);
        }
    }

    fn ddshape(&self, thirds: &[Thirds], ddn: &mut [Sym3]) {
        for (ddn, thirds) in ddn.iter_mut().zip(thirds) {
            let f = self.factors(thirds);
            let second = |i: usize, j: usize| {
                let mut sum = 0.0;
                for a in 0..3 {
                    for b in 0..3 {
                        let order = |c: usize| usize::from(c == a) + usize::from(c == b);
                        let product: f64 = (0..3).map(|c| f[c][order(c)]).product();
                        sum += product * self.slope[a][i] * self.slope[b][j];
                    }
                }
                sum
            };
            *ddn = Sym3::from_pairs(Sym3::PAIRS.map(|(i, j)| second(i, j)));
        }
    }
}

const ON_LINE: [Thirds; 4] = [[3, 0, 0], [0, 3, 0], [2, 1, 0], [1, 2, 0]];

const ON_TRIANGLE: [Thirds; 10] = [
    [3, 0, 0],
    [0, 3, 0],
    [0, 0, 3],
    [2, 1, 0],
    [1, 2, 0],
    [0, 2, 1],
    [0, 1, 2],
    [1, 0, 2],
    [2, 0, 1],
    [1, 1, 1],
];

/// Gauss–Legendre with four points on `[-1, 1]`.
static LINE_4: Rule = {
    const A: f64 = 0.861_136_311_594_052_6;
    const B: f64 = 0.339_981_043_584_856_26;
    const W: f64 = 0.347_854_845_137_453_85;
    Rule {
        points: &[
            Vec3::new(-A, 0.0, 0.0),
            Vec3::new(-B, 0.0, 0.0),
            Vec3::new(B, 0.0, 0.0),
            Vec3::new(A, 0.0, 0.0),
        ],
        weights: &[W, 1.0 - W, 1.0 - W, W],
    }
};

impl ReferenceElement for Line4 {
    fn name(&self) -> &'static str {
        "cubic line"
    }

    fn family(&self) -> Family {
        Family::Line
    }

    fn order(&self) -> usize {
        3
    }

    fn degree(&self) -> usize {
        3
    }

    fn locking_class(&self) -> LockingClass {
        LockingClass::HigherOrder { ndilatation: 1 }
    }

    fn nodes(&self) -> &'static [Vec3] {
        const NODES: [Vec3; 4] = [
            Vec3::new(-1.0, 0.0, 0.0),
            Vec3::new(1.0, 0.0, 0.0),
            Vec3::new(-1.0 / 3.0, 0.0, 0.0),
            Vec3::new(1.0 / 3.0, 0.0, 0.0),
        ];
        &NODES
    }

    fn shape(&self, xi: &Vec3, n: &mut [f64]) {
        Area::on_line(xi).shape(&ON_LINE, n);
    }

    fn dshape(&self, xi: &Vec3, dn: &mut [Vec3]) {
        Area::on_line(xi).dshape(&ON_LINE, dn);
    }

    fn ddshape(&self, xi: &Vec3, ddn: &mut [Sym3]) {
        Area::on_line(xi).ddshape(&ON_LINE, ddn);
    }

    fn sides(&self) -> &'static [Side] {
        &[]
    }

    fn rules(&self) -> Rules {
        const RULES: Rules = Rules {
            surface: &LINE_4,
            mass: &LINE_4,
            ..Rules::all(&quadrature::LINE_3)
        };
        RULES
    }
}

impl ReferenceElement for Tri10 {
    fn name(&self) -> &'static str {
        "cubic triangle"
    }

    fn family(&self) -> Family {
        Family::Triangle
    }

    fn order(&self) -> usize {
        3
    }

    fn degree(&self) -> usize {
        3
    }

    fn locking_class(&self) -> LockingClass {
        LockingClass::HigherOrder { ndilatation: 3 }
    }

    fn nodes(&self) -> &'static [Vec3] {
        const NODES: [Vec3; 10] = {
            let mut nodes = [Vec3::ZERO; 10];
            let mut k = 0;
            while k < 10 {
                let [_, a, b] = ON_TRIANGLE[k];
                nodes[k] = Vec3::new(a as f64 / 3.0, b as f64 / 3.0, 0.0);
                k += 1;
            }
            nodes
        };
        &NODES
    }

    fn shape(&self, xi: &Vec3, n: &mut [f64]) {
        Area::on_triangle(xi).shape(&ON_TRIANGLE, n);
    }

    fn dshape(&self, xi: &Vec3, dn: &mut [Vec3]) {
        Area::on_triangle(xi).dshape(&ON_TRIANGLE, dn);
    }

    fn ddshape(&self, xi: &Vec3, ddn: &mut [Sym3]) {
        Area::on_triangle(xi).ddshape(&ON_TRIANGLE, ddn);
    }

    fn sides(&self) -> &'static [Side] {
        static SIDES: [Side; 3] = [
            Side {
                element: &Line4,
                nodes: &[0, 1, 3, 4],
            },
            Side {
                element: &Line4,
                nodes: &[1, 2, 5, 6],
            },
            Side {
                element: &Line4,
                nodes: &[2, 0, 7, 8],
            },
        ];
        &SIDES
    }

    fn rules(&self) -> Rules {
        const RULES: Rules = Rules {
            surface: &quadrature::TRI_12,
            mass: &quadrature::TRI_12,
            ..Rules::all(&quadrature::TRI_6)
        };
        RULES
    }
}
