//! The gap as a function of positions, written down afresh for any kind of number, and differentiated by hyper-dual
//! numbers: an oracle that shares no formula with the rows.

use super::super::discretization::{NodeToSegment, Pair, SurfacePair};
use super::super::row::{Participant, Row};
use super::{Random, facets, first_rows, largest, pair_up};
use num_dual::{DualNum, HyperDual64};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Feature, Placement};
use signorini_geometry::tensor::{Mat3, Vec3};

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

/// Parameters of the corners of a line, a triangle, a quadrilateral.
fn corners(nnode: usize) -> &'static [[f64; 2]] {
    match nnode {
        2 => &[[-1.0, 0.0], [1.0, 0.0]],
        3 => &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
        _ => &[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]],
    }
}

/// Position, tangents and mixed second derivative; the second tangent of a line is the third axis.
fn place<D: Number>(x: &[Point<D>], [u, v]: [D; 2]) -> [Point<D>; 4] {
    let (zero, one) = (D::from(0.0), D::from(1.0));
    let mut weights = [Vec::new(), Vec::new(), Vec::new(), Vec::new()];
    for (i, &[a, b]) in corners(x.len()).iter().enumerate() {
        let values = match (x.len(), i) {
            (2, _) => [(u * a + 1.0) * 0.5, D::from(0.5 * a), zero, zero],
            (3, 0) => [one - u - v, -one, -one, zero],
            (3, 1) => [u, one, zero, zero],
            (3, _) => [v, zero, one, zero],
            _ => [
                (u * a + 1.0) * (v * b + 1.0) * 0.25,
                (v * b + 1.0) * (0.25 * a),
                (u * a + 1.0) * (0.25 * b),
                D::from(0.25 * a * b),
            ],
        };
        for (list, value) in weights.iter_mut().zip(values) {
            list.push(value);
        }
    }
    let mut found = weights.map(|w| combine(&w, x));
    if x.len() == 2 {
        found[2] = [zero, zero, one];
    }
    found
}

fn normal<D: Number>(x: &[Point<D>], xi: [D; 2]) -> Point<D> {
    let [_, t1, t2, _] = place(x, xi);
    unit(cross(t1, t2))
}

/// Newton in numbers with derivatives, from parameters that solve the projection in their real parts.
fn gap_on_face<D: Number>(x: &[Point<D>], r: Point<D>, start: [f64; 2]) -> D {
    let mut xi = start.map(D::from);
    for _ in 0..5 {
        let [rho, t1, t2, bend] = place(x, xi);
        let w = minus(r, rho);
        let (a, b, c) = (dot(t1, t1), dot(t2, t2), dot(t1, t2) - dot(w, bend));
        let (p, q) = (dot(t1, w), dot(t2, w));
        let det = a * b - c * c;
        xi[0] += (b * p - c * q) / det;
        if x.len() > 2 {
            xi[1] += (a * q - c * p) / det;
        }
    }
    let moved = (0..2).map(|a| (xi[a].re() - start[a]).abs());
    assert!(moved.fold(0.0, f64::max) < 1e-11, "not the closest point");
    dot(minus(r, place(x, xi)[0]), normal(x, xi))
}

fn gap_on_edge<D: Number>(a: Point<D>, b: Point<D>, r: Point<D>, sign: f64) -> D {
    let e = minus(b, a);
    let s = dot(minus(r, a), e) / dot(e, e);
    let w = minus(minus(r, a), e.map(|c| c * s));
    dot(w, w).sqrt() * sign
}

fn gap_on_vertex<D: Number>(a: Point<D>, r: Point<D>, sign: f64) -> D {
    let w = minus(r, a);
    dot(w, w).sqrt() * sign
}

/// A surface, its configuration with the node that may touch it, and that node.
struct Scene {
    surface: Vec<Vec<NodeId>>,
    pair: SurfacePair,
    x: Vec<Vec3>,
}

impl Scene {
    fn new(mut x: Vec<Vec3>, surface: Vec<Vec<NodeId>>) -> Self {
        let primary = Box::new(facets(&mut x, &surface));
        let pair = SurfacePair {
            points: vec![x.len() as NodeId],
            secondary: None,
            primary,
            reach: 2.0,
        };
        x.push(Vec3::ZERO);
        Self { surface, pair, x }
    }

    fn node(&self) -> usize {
        self.x.len() - 1
    }

    /// What the closest point lies on, as the corners of its facet: all of them, two, or one.
    fn corners_of(&self, found: &Pair) -> Vec<usize> {
        let nodes = &self.surface[found.anchor.facet as usize];
        let at = corners(nodes.len());
        let (u, v) = (found.anchor.local.x, found.anchor.local.y);
        match found.feature {
            Feature::Face => (0..nodes.len()).collect(),
            Feature::Vertex => {
                let hit = |&k: &usize| (at[k][0] - u).hypot(at[k][1] - v) < 1e-12;
                (0..nodes.len()).filter(hit).collect()
            }
            Feature::Edge { .. } => {
                let n = nodes.len();
                let hit = |&k: &usize| {
                    let ([a, b], [c, d]) = (at[k], at[(k + 1) % n]);
                    ((c - a) * (v - b) - (d - b) * (u - a)).abs() < 1e-12
                };
                let k = (0..n).find(hit).unwrap();
                vec![k, (k + 1) % n]
            }
        }
    }

    /// The sum of unit normals of the facets around an edge, or of those around a vertex weighted by their angles.
    fn pseudonormal(&self, ends: &[NodeId]) -> Point<f64> {
        let r = self.x[self.node()].to_array();
        let mut sum = [0.0; 3];
        for nodes in &self.surface {
            if !ends.iter().all(|n| nodes.contains(n)) {
                continue;
            }
            let x: Vec<Point<f64>> = nodes
                .iter()
                .map(|&n| self.x[n as usize].to_array())
                .collect();
            let at = corners(nodes.len());
            let corner = |n: NodeId| nodes.iter().position(|&m| m == n).unwrap();
            let (xi, weight) = if let [a, b] = *ends {
                let (a, b) = (corner(a), corner(b));
                let e = minus(x[b], x[a]);
                let s = dot(minus(r, x[a]), e) / dot(e, e);
                let along = |c: usize| at[a][c] + s * (at[b][c] - at[a][c]);
                ([along(0), along(1)], 1.0)
            } else {
                let k = corner(ends[0]);
                let n = nodes.len();
                let p = minus(x[(k + 1) % n], x[k]);
                let q = minus(x[(k + n - 1) % n], x[k]);
                let angle = (dot(p, q) / (dot(p, p) * dot(q, q)).sqrt()).acos();
                (at[k], if n == 2 { 1.0 } else { angle })
            };
            let nu = normal(&x, xi);
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
        let ends = self.corners_of(found);
        if let Feature::Face = found.feature {
            return gap_on_face(&x, r, [found.anchor.local.x, found.anchor.local.y]);
        }
        let ids: Vec<NodeId> = ends.iter().map(|&k| nodes[k]).collect();
        let away = match *ends {
            [a] => minus(r, x[a]),
            [a, b] => {
                let e = minus(x[b], x[a]);
                let s = dot(minus(r, x[a]), e) / dot(e, e);
                minus(minus(r, x[a]), e.map(|c| c * s))
            }
            _ => unreachable!("an edge has two ends"),
        };
        let sign = dot(away.map(|c| c.re), self.pseudonormal(&ids)).signum();
        match *ends {
            [a] => gap_on_vertex(x[a], r, sign),
            [a, b] => gap_on_edge(x[a], x[b], r, sign),
            _ => unreachable!("an edge has two ends"),
        }
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
        let method = NodeToSegment::new(1);
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
        let method = NodeToSegment::new(1);
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
fn scene(kind: &str, bend: f64, random: &mut Random) -> (Scene, Vec3) {
    let flat = |u: f64, v: f64| Vec3::new(u, v, bend * (u.abs() + if v > 0.0 { v } else { -v }));
    let (mut x, surface): (Vec<Vec3>, Vec<Vec<NodeId>>) = match kind {
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
    for x in &mut x {
        let mut moved = random.vector() * 0.25;
        if kind.contains("line") {
            moved.z = 0.0;
        }
        *x += moved;
    }
    // the middle of what is in question: the facet, the edge, the vertex
    let middle = match kind {
        "two triangles" => (x[0] + x[2]) * 0.5,
        "two quadrilaterals" => (x[1] + x[4]) * 0.5,
        "two lines" => x[1],
        "four triangles" => x[0],
        "four quadrilaterals" => x[4],
        _ => x.iter().copied().sum::<Vec3>() / x.len() as f64,
    };
    (Scene::new(x, surface), middle)
}

#[test]
fn gap_gradient_and_hessian_match_dual_numbers() {
    let edge = Feature::Edge {
        direction: [0.0; 2],
    };
    let cases = [
        ("line", Feature::Face, 200),
        ("two lines", Feature::Vertex, 200),
        ("triangle", Feature::Face, 200),
        ("two triangles", edge, 200),
        ("four triangles", Feature::Vertex, 200),
        ("quadrilateral", Feature::Face, 400),
        ("two quadrilaterals", edge, 200),
        ("four quadrilaterals", Feature::Vertex, 200),
    ];
    for (seed, (kind, feature, wanted)) in (1..).zip(cases) {
        let mut random = Random::new(seed);
        let mut sides = [0, 0];
        for _ in 0..400 * wanted {
            let bend = 0.7 * random.signed();
            let (mut scene, middle) = scene(kind, bend, &mut random);
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
        assert!(sides.iter().all(|&n| n >= wanted / 2), "{kind}: {sides:?}");
    }
}
