//! The gap as a function of positions, written down afresh for any kind of number, and differentiated by hyper-dual
//! numbers: an oracle that shares no formula with the rows.

use super::super::discretization::{Pair, PointToSegment, SurfacePair};
use super::super::row::{Participant, Row};
use super::{Random, facets_of, first_rows, largest, pair_up, with_mid_nodes};
use num_dual::{DualNum, HyperDual64};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Feature, Placement};
use signorini_geometry::tensor::{Mat3, Vec3};
use std::sync::Arc;

trait Number: DualNum<Primitive = f64> + Copy {}
impl<D: DualNum<Primitive = f64> + Copy> Number for D {}

type Point<D> = [D; 3];

fn minus<D: Number>(a: Point<D>, b: Point<D>) -> Point<D> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot<D: Number>(a: Point<D>, b: Point<D>) -> D {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross<D: Number>(a: Point<D>, b: Point<D>) -> Point<D> {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit<D: Number>(a: Point<D>) -> Point<D> {
    let length = dot(a, a).sqrt();
    a.map(|c| c / length)
}

fn combine<D: Number>(weights: &[D], x: &[Point<D>]) -> Point<D> {
    std::array::from_fn(|c| {
        let terms = weights.iter().zip(x).map(|(&w, p)| w * p[c]);
        terms.fold(D::from(0.0), |sum, term| sum + term)
    })
}

/// A kind of facet, from nothing but its nodes and its monomials.
struct Kind {
    name: &'static str,
    ncorner: usize,
    /// Parameters of the nodes.
    at: Vec<[f64; 2]>,
    powers: Vec<[i32; 2]>,
    /// The coefficients of the monomials in each shape function.
    coefficients: Vec<Vec<f64>>,
}

/// Position, tangents and second derivatives 11, 22, 12; the second tangent of a line is the third axis.
struct Place<D> {
    rho: Point<D>,
    t: [Point<D>; 2],
    bend: [Point<D>; 3],
}

impl Kind {
    fn new(name: &'static str) -> Self {
        let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let (mut at, along): (Vec<[f64; 2]>, &[[i32; 2]]) = match &name[..name.len() - 1] {
            "line" => (vec![[-1.0, 0.0], [1.0, 0.0]], &[[0, 0], [1, 0], [2, 0]]),
            "tri" => (
                vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
                &[[0, 0], [1, 0], [0, 1], [1, 1], [2, 0], [0, 2]],
            ),
            _ => (
                square.to_vec(),
                &[
                    [0, 0],
                    [1, 0],
                    [0, 1],
                    [1, 1],
                    [2, 0],
                    [0, 2],
                    [2, 1],
                    [1, 2],
                    [2, 2],
                ],
            ),
        };
        let ncorner = at.len();
        if matches!(name, "line3" | "tri6" | "quad8" | "quad9") {
            for k in 0..if ncorner == 2 { 1 } else { ncorner } {
                let (a, b) = (at[k], at[(k + 1) % ncorner]);
                at.push([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
            }
        }
        if name == "quad9" {
            at.push([0.0, 0.0]);
        }
        let powers = along[..at.len()].to_vec();
        // the monomials at the nodes, next to them the unit matrix; Gauss and Jordan
        let n = at.len();
        let mut rows: Vec<Vec<f64>> = (0..n)
            .map(|i| {
                let monomials = powers
                    .iter()
                    .map(|p| at[i][0].powi(p[0]) * at[i][1].powi(p[1]));
                let unit = (0..n).map(|j| f64::from(u8::from(i == j)));
                monomials.chain(unit).collect()
            })
            .collect();
        for k in 0..n {
            let largest = (k..n).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs()));
            rows.swap(k, largest.unwrap());
            let pivot: Vec<f64> = rows[k].iter().map(|v| v / rows[k][k]).collect();
            for (i, row) in rows.iter_mut().enumerate() {
                let factor = row[k];
                for (v, p) in row.iter_mut().zip(&pivot) {
                    *v = if i == k { *p } else { *v - factor * p };
                }
            }
        }
        let of_node = |j: usize| rows.iter().map(|row| row[n + j]).collect();
        let coefficients = (0..n).map(of_node).collect();
        Self {
            name,
            ncorner,
            at,
            powers,
            coefficients,
        }
    }

    fn place<D: Number>(&self, x: &[Point<D>], [u, v]: [D; 2]) -> Place<D> {
        let power = |base: D, p: i32, times: i32| {
            let factor: i32 = (0..times).map(|k| p - k).product();
            if factor == 0 {
                return D::from(0.0);
            }
            (0..p - times).fold(D::from(f64::from(factor)), |product, _| product * base)
        };
        let derivative = |a: i32, b: i32| {
            let monomials = self
                .powers
                .iter()
                .map(|p| power(u, p[0], a) * power(v, p[1], b));
            let monomials: Vec<D> = monomials.collect();
            let weights: Vec<D> = self
                .coefficients
                .iter()
                .map(|c| {
                    let terms = c.iter().zip(&monomials).map(|(&c, &m)| m * c);
                    terms.fold(D::from(0.0), |sum, term| sum + term)
                })
                .collect();
            combine(&weights, x)
        };
        let across = match self.ncorner {
            2 => [0.0, 0.0, 1.0].map(D::from),
            _ => derivative(0, 1),
        };
        Place {
            rho: derivative(0, 0),
            t: [derivative(1, 0), across],
            bend: [derivative(2, 0), derivative(0, 2), derivative(1, 1)],
        }
    }

    fn normal<D: Number>(&self, x: &[Point<D>], xi: [D; 2]) -> Point<D> {
        let [t1, t2] = self.place(x, xi).t;
        unit(cross(t1, t2))
    }

    /// Newton in numbers with derivatives, from parameters that solve the projection in their real parts.
    fn gap_on_face<D: Number>(&self, x: &[Point<D>], r: Point<D>, start: [f64; 2]) -> D {
        let mut xi = start.map(D::from);
        for _ in 0..4 {
            let Place { rho, t, bend } = self.place(x, xi);
            let w = minus(r, rho);
            let a = dot(t[0], t[0]) - dot(w, bend[0]);
            let b = dot(t[1], t[1]) - dot(w, bend[1]);
            let c = dot(t[0], t[1]) - dot(w, bend[2]);
            let (p, q) = (dot(t[0], w), dot(t[1], w));
            if self.ncorner == 2 {
                xi[0] += p / a;
                continue;
            }
            let det = a * b - c * c;
            xi[0] += (b * p - c * q) / det;
            xi[1] += (a * q - c * p) / det;
        }
        let moved = (0..2).map(|a| (xi[a].re() - start[a]).abs());
        assert!(moved.fold(0.0, f64::max) < 1e-11, "not the closest point");
        dot(minus(r, self.place(x, xi).rho), self.normal(x, xi))
    }

    /// The same along a straight line of the parameters.
    fn gap_on_edge<D: Number>(
        &self,
        x: &[Point<D>],
        r: Point<D>,
        start: [f64; 2],
        along: [f64; 2],
    ) -> D {
        let mut s = D::from(0.0);
        let at = |s: D| {
            let xi = [s * along[0] + start[0], s * along[1] + start[1]];
            let Place { rho, t, bend } = self.place(x, xi);
            let [a, b] = along;
            let tangent: Point<D> = std::array::from_fn(|c| t[0][c] * a + t[1][c] * b);
            let second: Point<D> = std::array::from_fn(|c| {
                bend[0][c] * (a * a) + bend[1][c] * (b * b) + bend[2][c] * (2.0 * a * b)
            });
            (minus(r, rho), tangent, second)
        };
        for _ in 0..4 {
            let (w, t, bend) = at(s);
            s += dot(w, t) / (dot(t, t) - dot(w, bend));
        }
        assert!(s.re().abs() < 1e-11, "not the closest point");
        let w = at(s).0;
        dot(w, w).sqrt()
    }
}

/// A surface, its configuration with the node that may touch it, and that node.
struct Scene {
    kind: Kind,
    surface: Vec<Vec<NodeId>>,
    pair: SurfacePair,
    x: Vec<Vec3>,
}

impl Scene {
    fn new(kind: Kind, mut x: Vec<Vec3>, surface: Vec<Vec<NodeId>>) -> Self {
        let named: Vec<_> = surface.iter().map(|n| (kind.name, n.clone())).collect();
        let primary = Arc::new(facets_of(&mut x, &named));
        let pair = SurfacePair::new(vec![x.len() as NodeId], primary, 2.0);
        x.push(Vec3::ZERO);
        Self {
            kind,
            surface,
            pair,
            x,
        }
    }

    fn node(&self) -> usize {
        self.x.len() - 1
    }

    /// The corner on which the closest point lies, or the two at the ends of its edge, and how far along it is.
    fn corners_of(&self, found: &Pair) -> (Vec<usize>, f64) {
        let at = &self.kind.at[..self.kind.ncorner];
        let (u, v) = (found.anchor.local.x, found.anchor.local.y);
        let n = at.len();
        if found.feature == Feature::Vertex {
            let hit = |&k: &usize| (at[k][0] - u).hypot(at[k][1] - v) < 1e-12;
            return ((0..n).filter(hit).collect(), 0.0);
        }
        let hit = |&k: &usize| {
            let ([a, b], [c, d]) = (at[k], at[(k + 1) % n]);
            ((c - a) * (v - b) - (d - b) * (u - a)).abs() < 1e-12
        };
        let k = (0..n).find(hit).unwrap();
        let ([a, b], [c, d]) = (at[k], at[(k + 1) % n]);
        (
            vec![k, (k + 1) % n],
            (u - a).hypot(v - b) / (c - a).hypot(d - b),
        )
    }

    /// The sum of unit normals of the facets around an edge, at the fraction `s` of it, or of those around a vertex
    /// weighted by their angles.
    fn pseudonormal(&self, ends: &[NodeId], s: f64) -> Point<f64> {
        let mut sum = [0.0; 3];
        let at = &self.kind.at[..self.kind.ncorner];
        for nodes in &self.surface {
            if !ends.iter().all(|n| nodes.contains(n)) {
                continue;
            }
            let x: Vec<Point<f64>> = nodes
                .iter()
                .map(|&n| self.x[n as usize].to_array())
                .collect();
            let corner = |n: NodeId| nodes.iter().position(|&m| m == n).unwrap();
            let (xi, weight) = if let [a, b] = *ends {
                let (a, b) = (corner(a), corner(b));
                let along = |c: usize| at[a][c] + s * (at[b][c] - at[a][c]);
                ([along(0), along(1)], 1.0)
            } else {
                let k = corner(ends[0]);
                let n = at.len();
                let [t1, t2] = self.kind.place(&x, at[k]).t;
                let leaving = |other: usize| -> Point<f64> {
                    let d = [0, 1].map(|c| at[other][c] - at[k][c]);
                    std::array::from_fn(|c| t1[c] * d[0] + t2[c] * d[1])
                };
                let (p, q) = (leaving((k + 1) % n), leaving((k + n - 1) % n));
                let angle = (dot(p, q) / (dot(p, p) * dot(q, q)).sqrt()).acos();
                (at[k], if n == 2 { 1.0 } else { angle })
            };
            let nu = self.kind.normal(&x, xi);
            sum = std::array::from_fn(|c| sum[c] + weight * nu[c]);
        }
        sum
    }

    /// The gap for positions of the facet's nodes and of the point, as a function of one and then the other column.
    fn gap(&self, found: &Pair, columns: [usize; 2]) -> HyperDual64 {
        let nodes = &self.surface[found.anchor.facet as usize];
        let mut column = 0;
        let mut seeded = |x: Vec3| {
            x.to_array().map(|value| {
                let hit = columns.map(|c| f64::from(u8::from(c == column)));
                column += 1;
                HyperDual64::new(value, hit[0], hit[1], 0.0)
            })
        };
        let x: Vec<Point<HyperDual64>> =
            nodes.iter().map(|&n| seeded(self.x[n as usize])).collect();
        let r = seeded(self.x[self.node()]);
        let start = [found.anchor.local.x, found.anchor.local.y];
        if found.feature == Feature::Face {
            return self.kind.gap_on_face(&x, r, start);
        }
        let (ends, s) = self.corners_of(found);
        let ids: Vec<NodeId> = ends.iter().map(|&k| nodes[k]).collect();
        let away = minus(r, self.kind.place(&x, start.map(HyperDual64::from)).rho);
        let sign = dot(away.map(|c| c.re), self.pseudonormal(&ids, s)).signum();
        let at = &self.kind.at;
        let distance = match *ends {
            [a] => dot(minus(r, x[a]), minus(r, x[a])).sqrt(),
            [a, b] => {
                let along = [0, 1].map(|c| at[b][c] - at[a][c]);
                self.kind.gap_on_edge(&x, r, start, along)
            }
            _ => unreachable!("an edge has two ends"),
        };
        distance * sign
    }

    /// Compares the row with the oracle; in the plane the third direction is no unknown.
    fn compare(&self, found: &Pair, row: &Row, used: &[usize]) {
        let n = row.gradient.len();
        let (slope, bend) = (largest(&row.gradient), largest(&row.dweights));
        for &i in used {
            for &j in used.iter().filter(|&&j| j >= i) {
                let exact = self.gap(found, [i, j]);
                assert!(
                    (exact.re - row.gap).abs() < 1e-12,
                    "{found:?}: {}",
                    exact.re
                );
                let first = (row.gradient[i] - exact.eps1).abs();
                assert!(first < 1e-10 * slope, "{found:?}, column {i}: {first:e}");
                for (a, b) in [(i, j), (j, i)] {
                    let error = (row.dweights[a * n + b] - exact.eps1eps2).abs();
                    assert!(error < 1e-10 * bend, "{found:?} ({a}, {b}): {error:e}");
                }
            }
        }
        assert_eq!(row.weights, row.gradient);
    }

    /// Force and moment balance; rigid modes in the null space of the gradient; the gap of the scene turned round.
    fn balance(&self, participants: &[Participant], row: &Row, random: &mut Random) {
        let (mut force, mut moment) = (Vec3::ZERO, Vec3::ZERO);
        for (participant, b) in participants.iter().zip(row.weights.chunks_exact(3)) {
            let Participant::Node(node) = *participant else {
                panic!("only nodes take part");
            };
            let b = Vec3::new(b[0], b[1], b[2]);
            force += b;
            moment += self.x[node as usize].cross(b);
        }
        assert!(force.max_abs() < 1e-13, "{force:?}");
        assert!(moment.max_abs() < 1e-13, "{moment:?}");

        let plane = self.pair.primary.ntan() == 1;
        let mut turn = random.vector() * 2.0;
        if plane {
            turn = Vec3::new(0.0, 0.0, turn.z);
        }
        let turn = Mat3::rotation(turn);
        let moved: Vec<Vec3> = self
            .x
            .iter()
            .map(|&x| turn * x + Vec3::new(0.3, -0.7, 0.0))
            .collect();
        let at = Placement {
            x: &moved,
            poses: &[],
        };
        let method = PointToSegment::at_nodes(&self.pair.points);
        let pairing = pair_up(&method, &self.pair, &at, self.pair.reach);
        let rows = first_rows(&method, &self.pair, &at, &pairing);
        assert!((rows.rows()[0].gap - row.gap).abs() < 2e-13);
        let normal = turn * row.normal;
        assert!((rows.rows()[0].normal - normal).max_abs() < 1e-11);
    }

    /// Puts the node there; where the closest point lies on the wanted feature, checks everything and says on which
    /// side the node is.
    fn check(&mut self, point: Vec3, wanted: &Feature, random: &mut Random) -> Option<f64> {
        let node = self.node();
        self.x[node] = point;
        let at = Placement {
            x: &self.x,
            poses: &[],
        };
        let method = PointToSegment::at_nodes(&self.pair.points);
        let pairing = pair_up(&method, &self.pair, &at, self.pair.reach);
        let found = pairing.pairs[0]?;
        let same = std::mem::discriminant(wanted) == std::mem::discriminant(&found.feature);
        if !same || found.gap.abs() > 0.5 {
            return None;
        }
        let rows = first_rows(&method, &self.pair, &at, &pairing);
        let row = &rows.rows()[0];
        let in_plane = |c: &usize| self.pair.primary.ntan() == 2 || c % 3 < 2;
        let used: Vec<usize> = (0..rows.ncolumn()).filter(in_plane).collect();
        self.compare(&found, row, &used);
        self.balance(rows.participants(), row, random);
        Some(found.gap)
    }
}

/// A line, a triangle, a quadrilateral, two of them joined, or as many as meet in a point, warped at random and bent.
fn scene(kind: &str, element: &'static str, bend: f64, random: &mut Random) -> (Scene, Vec3) {
    let flat = |u: f64, v: f64| Vec3::new(u, v, bend * (u.abs() + if v > 0.0 { v } else { -v }));
    let (mut x, mut surface): (Vec<Vec3>, Vec<Vec<NodeId>>) = match kind {
        "line" => (
            vec![Vec3::ZERO, Vec3::new(-1.0, 0.0, 0.0)],
            vec![vec![0, 1]],
        ),
        "two lines" => (
            [(1.0, bend), (0.0, 0.0), (-1.0, bend)]
                .map(|(x, y)| Vec3::new(x, y, 0.0))
                .to_vec(),
            vec![vec![0, 1], vec![1, 2]],
        ),
        "triangle" => (
            vec![Vec3::ZERO, Vec3::unit(0), Vec3::unit(1)],
            vec![vec![0, 1, 2]],
        ),
        "four triangles" => {
            let around = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)];
            let x = [(0.0, 0.0)].iter().chain(&around);
            (
                x.map(|&(u, v)| flat(u, v)).collect(),
                (0..4).map(|k| vec![0, 1 + k, 1 + (k + 1) % 4]).collect(),
            )
        }
        "two triangles" => {
            let at = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.5)];
            let bent = at.map(|(u, v): (f64, f64)| Vec3::new(u, v, bend * u.abs()));
            (bent.to_vec(), vec![vec![0, 1, 2], vec![0, 2, 3]])
        }
        "quadrilateral" => {
            let at = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
            (
                at.map(|(u, v)| Vec3::new(u, v, 0.0)).to_vec(),
                vec![vec![0, 1, 2, 3]],
            )
        }
        "two quadrilaterals" => {
            let node = |k: u32| (f64::from(k % 3) - 1.0, f64::from(k / 3));
            let bent = (0..6).map(node);
            (
                bent.map(|(u, v)| Vec3::new(u, v, bend * u.abs())).collect(),
                vec![vec![0, 1, 4, 3], vec![1, 2, 5, 4]],
            )
        }
        "four quadrilaterals" => {
            let node = |k: u32| flat(f64::from(k % 3) - 1.0, f64::from(k / 3) - 1.0);
            let facet = |k: u32| vec![k, k + 1, k + 4, k + 3];
            ((0..9).map(node).collect(), [0, 1, 3, 4].map(facet).to_vec())
        }
        _ => panic!("no scene is called {kind}"),
    };
    let curved = matches!(element, "line3" | "tri6" | "quad8" | "quad9");
    if curved {
        with_mid_nodes(&mut x, &mut surface, element == "quad9");
    }
    for x in &mut x {
        // mid nodes are half as far apart
        let mut moved = random.vector() * if curved { 0.15 } else { 0.25 };
        if kind.contains("line") {
            moved.z = 0.0;
        }
        *x += moved;
    }
    // the middle of the feature: the facet, the edge, the vertex
    let middle = match kind {
        "two triangles" => (x[0] + x[2]) * 0.5,
        "two quadrilaterals" => (x[1] + x[4]) * 0.5,
        "two lines" => x[1],
        "four triangles" => x[0],
        "four quadrilaterals" => x[4],
        _ => x.iter().copied().sum::<Vec3>() / x.len() as f64,
    };
    (Scene::new(Kind::new(element), x, surface), middle)
}

#[test]
fn gap_gradient_and_hessian_match_dual_numbers() {
    let edge = Feature::Edge {
        direction: [0.0; 2],
    };
    let cases = [
        ("line", "line2", Feature::Face, 200),
        ("line", "line3", Feature::Face, 100),
        ("two lines", "line2", Feature::Vertex, 200),
        ("two lines", "line3", Feature::Vertex, 100),
        ("triangle", "tri3", Feature::Face, 200),
        ("triangle", "tri6", Feature::Face, 100),
        ("two triangles", "tri3", edge, 200),
        ("two triangles", "tri6", edge, 40),
        ("four triangles", "tri3", Feature::Vertex, 200),
        ("four triangles", "tri6", Feature::Vertex, 20),
        ("quadrilateral", "quad4", Feature::Face, 400),
        ("quadrilateral", "quad8", Feature::Face, 60),
        ("quadrilateral", "quad9", Feature::Face, 60),
        ("two quadrilaterals", "quad4", edge, 200),
        ("two quadrilaterals", "quad8", edge, 20),
        ("two quadrilaterals", "quad9", edge, 20),
        ("four quadrilaterals", "quad4", Feature::Vertex, 200),
        ("four quadrilaterals", "quad8", Feature::Vertex, 10),
        ("four quadrilaterals", "quad9", Feature::Vertex, 10),
    ];
    for (seed, (kind, element, feature, wanted)) in (1..).zip(cases) {
        let mut random = Random::new(seed);
        let mut sides = [0, 0];
        for _ in 0..400 * wanted {
            let bend = 0.7 * random.signed();
            let (mut scene, middle) = scene(kind, element, bend, &mut random);
            let mut away = random.vector() * 0.5;
            if kind.contains("line") {
                away.z = 0.0;
            }
            if let Some(gap) = scene.check(middle + away, &feature, &mut random) {
                sides[usize::from(gap < 0.0)] += 1;
            }
            if sides.iter().all(|&n| n >= wanted / 2) {
                break;
            }
        }
        let enough = sides.iter().all(|&n| n >= wanted / 2);
        assert!(enough, "{kind} of {element}: {sides:?}");
    }
}
