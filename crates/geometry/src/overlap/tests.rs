//! Areas against closed forms and brute force, derivatives against differences, over all pairings.

use super::pair::EXACT;
use super::*;
use crate::element::quadrature::{gauss, on_facet};
use crate::element::testing::CUBIC;
use crate::element::{Element, Family, MAX_FACET_NODES, TABLE, by_name};
use crate::random::Random;
use crate::scalar::Dual;
use crate::tensor::{Mat3, Vec3};

/// Every element that can be a facet, and made-up ones of degree 3; lines first.
fn kinds() -> impl Iterator<Item = Element> + Clone {
    let of = |dim| {
        TABLE
            .into_iter()
            .chain(CUBIC)
            .filter(move |e| e.dim() == dim)
    };
    of(1).chain(of(2))
}

/// Coordinates of the nodes of two facets.
const VARIABLES: usize = 2 * 3 * MAX_FACET_NODES;

/// Every pairing of facets of one dimension.
fn pairings() -> Vec<[Element; 2]> {
    let pairs = kinds().flat_map(|a| kinds().map(move |b| [a, b]));
    pairs.filter(|[a, b]| a.dim() == b.dim()).collect()
}

/// Nodes of a facet about the origin, one unit large, distorted and warped by `noise`, cubic ones by less: their nodes are
/// closer.
fn facet(element: Element, noise: f64, random: &mut Random) -> Vec<Vec3> {
    let noise = if element.order() > 2 {
        0.3 * noise
    } else {
        noise
    };
    let flat = element.dim() == 1;
    let place = |xi: &Vec3| {
        let n = random.vector() * noise;
        *xi - element.centre() + if flat { Vec3::new(n.x, n.y, 0.0) } else { n }
    };
    element.nodes().iter().map(place).collect()
}

/// The same, turned over, shifted and stretched: a primary facet in front of it.
fn opposite(element: Element, noise: f64, random: &mut Random) -> Vec<Vec3> {
    let flat = element.dim() == 1;
    let turn = Mat3::rotation(Vec3::new(
        0.0,
        0.0,
        if flat { 0.0 } else { 2.0 * random.signed() },
    ));
    let shift = Vec3::new(random.signed(), random.signed(), 0.0) * 0.6;
    let over = |x: Vec3| {
        if flat {
            Vec3::new(-x.x, x.y, 0.0)
        } else {
            Vec3::new(x.x, -x.y, x.z)
        }
    };
    let shift = if flat {
        Vec3::new(shift.x, 0.1, 0.0)
    } else {
        shift
    };
    let x = facet(element, noise, random).into_iter();
    x.map(|x| turn * over(x) + shift).collect()
}

/// How corners move: for each the nodes, with the facet, and derivatives.
type Moves = [Vec<(Facing, usize, [Pair<f64>; 2])>; 3];

/// A point, and the simplex it belongs to: its size with derivatives, and how its corners move.
struct Placed {
    point: Point,
    size: f64,
    dsize: [Pair<f64>; 3],
    moves: Moves,
}

/// The points of two facets, given in space.
fn points(elements: [Element; 2], x: [&[Vec3]; 2]) -> Vec<Placed> {
    let plane = Plane::of(elements[0], &plain(x[0])).unwrap();
    let flat = |k: usize, facing| {
        let places = plain(x[k]).into_iter().map(|x| plane.project(x));
        Flat::new(elements[k], &places.collect::<Vec<_>>(), facing)
    };
    let mut found = Vec::new();
    if let Some(primary) = flat(1, Facing::Opposite) {
        let secondary = flat(0, Facing::Same).unwrap();
        integrate(&secondary, &primary, |cell| {
            cell.simplices(|simplex| {
                let moves: Moves = simplex.corners.map(|corner| {
                    let mut moves = Vec::new();
                    cell.moves(corner, |facing, node, d| moves.push((facing, node, d)));
                    moves
                });
                simplex.points(0, |point| {
                    found.push(Placed {
                        point: *point,
                        size: simplex.size,
                        dsize: simplex.dsize,
                        moves: moves.clone(),
                    });
                })
            })
        })
        .unwrap();
    }
    found
}

fn plain(x: &[Vec3]) -> Vec<[f64; 3]> {
    x.iter().map(|x| x.to_array()).collect()
}

fn between(elements: [Element; 2], x: [&[Vec3]; 2]) -> Vec<Point> {
    points(elements, x).into_iter().map(|p| p.point).collect()
}

fn measure(points: &[Point]) -> f64 {
    points.iter().map(|p| p.weight).sum()
}

fn at(element: Element, x: &[Vec3], xi: Pair<f64>) -> Vec3 {
    let mut n = vec![0.0; element.nnode()];
    element.shape(&Vec3::new(xi[0], xi[1], 0.0), &mut n);
    n.iter().zip(x).map(|(&n, &x)| x * n).sum()
}

#[test]
fn an_overlap_of_squares_is_a_rectangle() {
    let quad = by_name("quad4").unwrap();
    let square = facet(quad, 0.0, &mut Random(1));
    for (shift, width, height) in [
        ([0.0, 0.0], 2.0, 2.0),
        ([0.7, 0.4], 1.3, 1.6),
        ([1.999, -1.0], 0.001, 1.0),
        ([2.0 - 1e-9, 2.0 - 1e-9], 1e-9, 1e-9),
        ([2.0 - 1e-13, 0.0], 0.0, 2.0),
        ([2.0, 0.0], 0.0, 0.0),
        ([2.0, 2.0], 0.0, 0.0),
        ([2.1, 0.0], 0.0, 0.0),
        ([7.0, 7.0], 0.0, 0.0),
    ] {
        let turned: Vec<Vec3> = square
            .iter()
            .map(|x| Vec3::new(x.x + shift[0], shift[1] - x.y, 0.3))
            .collect();
        let found = between([quad, quad], [&square, &turned]);
        let exact = width * height;
        let error = (measure(&found) - exact).abs();
        assert!(
            error < 1e-15 * (1.0 + exact) && error <= 1e-6 * exact,
            "{shift:?}: {error:e}"
        );
        assert_eq!(found.is_empty(), exact == 0.0, "{shift:?}");
        let inside =
            |p: &Point| quad.contains(&Vec3::new(p.primary.xi[0], p.primary.xi[1], 0.0), 1e-12);
        assert!(found.iter().all(inside));
    }
}

#[test]
fn facets_that_look_the_same_way_or_are_folded_overlap_nowhere() {
    for elements in pairings() {
        let mut random = Random(2);
        let secondary = facet(elements[0], 0.0, &mut random);
        let same = facet(elements[1], 0.0, &mut random);
        assert!(
            between(elements, [&secondary, &same]).is_empty(),
            "{elements:?}"
        );
        let mut folded = opposite(elements[1], 0.0, &mut random);
        folded.swap(0, 1);
        assert!(
            between(elements, [&secondary, &folded]).is_empty(),
            "{elements:?}"
        );
        folded.fill(Vec3::new(f64::NAN, 0.0, 0.0));
        assert!(
            between(elements, [&secondary, &folded]).is_empty(),
            "{elements:?}"
        );
    }
}

/// The area that two polygons share, by looking at the strips between all heights where anything changes: widths are
/// linear there.
fn strips(a: &[Pair<f64>], b: &[Pair<f64>]) -> f64 {
    let sides = |p: &[Pair<f64>]| -> Vec<(Pair<f64>, Pair<f64>)> {
        (0..p.len()).map(|k| (p[k], p[(k + 1) % p.len()])).collect()
    };
    let (sa, sb) = (sides(a), sides(b));
    let all = [sa.clone(), sb.clone()].concat();
    let mut heights: Vec<f64> = [a, b].concat().iter().map(|p| p[1]).collect();
    for (i, (p, q)) in all.iter().enumerate() {
        for (r, s) in &all[..i] {
            let [u, v, w] = [minus(*q, *p), minus(*s, *r), minus(*r, *p)];
            let t = cross2(w, v) / cross2(u, v);
            if (0.0..=1.0).contains(&t) {
                heights.push(p[1] + t * u[1]);
            }
        }
    }
    heights.sort_by(f64::total_cmp);
    let range = |sides: &[(Pair<f64>, Pair<f64>)], y: f64| {
        let hits = sides.iter().filter(|(p, q)| (p[1] - y) * (q[1] - y) < 0.0);
        let x = hits.map(|(p, q)| p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]));
        x.fold([f64::MAX, f64::MIN], |[l, r], x| [l.min(x), r.max(x)])
    };
    let width = |y: f64| {
        let ([a, b], [c, d]) = (range(&sa, y), range(&sb, y));
        (b.min(d) - a.max(c)).max(0.0)
    };
    let strip = |y: &[f64]| (y[1] - y[0]) * width(0.5 * (y[0] + y[1]));
    heights.windows(2).map(strip).sum()
}

#[test]
fn areas_of_random_overlaps_are_those_of_brute_force() {
    let mut random = Random(3);
    let (mut met, mut parted) = (0, 0);
    for elements in pairings().into_iter().filter(|e| e[0].dim() == 2) {
        for _ in 0..100 {
            let flat = |x: Vec<Vec3>| -> Vec<Vec3> {
                x.into_iter().map(|x| Vec3::new(x.x, x.y, 0.0)).collect()
            };
            // straight edges: the corners alone determine the covered area
            let linear = elements.map(|e| e.family().linear());
            let a = flat(facet(linear[0], 0.15, &mut random));
            let mut b = flat(opposite(linear[1], 0.15, &mut random));
            let away = Vec3::new(1.2 * random.signed(), 0.0, 0.0);
            b.iter_mut().for_each(|x| *x += away);
            let mut nodes = [a.clone(), b.clone()];
            for (k, x) in nodes.iter_mut().enumerate() {
                let at_node = |xi: &Vec3| at(linear[k], x, [xi.x, xi.y]);
                *x = elements[k].nodes().iter().map(at_node).collect();
            }
            let found = between(elements, [&nodes[0], &nodes[1]]);
            let pair = |x: &Vec3| [x.x, x.y];
            let outline = |x: &[Vec3]| x.iter().map(pair).collect::<Vec<_>>();
            let exact = strips(&outline(&a), &outline(&b));
            assert!(
                (measure(&found) - exact).abs() < 1e-12,
                "{elements:?} {} {exact} {a:?} {b:?}",
                measure(&found)
            );
            if found.is_empty() {
                parted += 1
            } else {
                met += 1
            }
            for p in &found {
                let [q, r] = [
                    at(elements[0], &nodes[0], p.secondary.xi),
                    at(elements[1], &nodes[1], p.primary.xi),
                ];
                assert!((q - r).max_abs() < 1e-13, "{elements:?}: {q:?} {r:?}");
            }
        }
    }
    assert!(met > 1000 && parted > 100, "{met} {parted}");
}

/// Σ w and Σ w N_j(ξ) of either facet, scaled: what rules must give exactly where facets are covered.
fn moments(elements: [Element; 2], points: &[Point]) -> [Vec<f64>; 2] {
    let of = |k: usize| {
        let mut sum = vec![0.0; elements[k].nnode()];
        let mut n = sum.clone();
        for p in points {
            let xi = [p.secondary.xi, p.primary.xi][k];
            elements[k].shape(&Vec3::new(xi[0], xi[1], 0.0), &mut n);
            sum.iter_mut().zip(&n).for_each(|(s, n)| *s += p.weight * n);
        }
        sum
    };
    [of(0), of(1)]
}

#[test]
fn the_map_of_a_quadrilateral_is_that_of_its_shape_functions() {
    let mut random = Random(7);
    for element in kinds() {
        let (x, flat) = straight(element, 0.4, &mut random);
        for xi in [[0.0, 0.0], [0.3, -0.7], [-1.2, 0.9]] {
            let Some((place, tangents)) = flat.bilinear(xi) else {
                assert_ne!(element.name(), "quad4");
                continue;
            };
            let known = at(element, &x, xi);
            let h = 1e-6;
            for a in 0..2 {
                assert!((place[a] - known[a]).abs() < 1e-14);
                for (along, tangent) in tangents.iter().enumerate() {
                    let [mut before, mut after] = [xi, xi];
                    (before[along], after[along]) = (xi[along] - h, xi[along] + h);
                    let slope = at(element, &x, after)[a] - at(element, &x, before)[a];
                    assert!((slope / (2.0 * h) - tangent[a]).abs() < 1e-9);
                }
            }
        }
    }
}

/// `∫ N_j` over a facet by a rule on its parameters.
fn whole(element: Element, x: &[Vec3]) -> Vec<f64> {
    let mut sum = vec![0.0; element.nnode()];
    let (mut n, mut dn) = (sum.clone(), vec![Vec3::ZERO; sum.len()]);
    for (xi, w) in on_facet(element, &gauss(6)) {
        element.shape(&xi, &mut n);
        element.dshape(&xi, &mut dn);
        let t = |a: usize| dn.iter().zip(x).map(|(d, &x)| x * d[a]).sum::<Vec3>();
        let t2 = if element.dim() == 1 {
            Vec3::unit(2)
        } else {
            t(1)
        };
        let area = t(0).cross(t2).norm();
        sum.iter_mut().zip(&n).for_each(|(s, n)| *s += w * area * n);
    }
    sum
}

/// A facet of the plane with straight edges and a bend below `most`: a distorted one with its other nodes moved along
/// the edges they lie on.
fn straight(element: Element, most: f64, random: &mut Random) -> (Vec<Vec3>, Flat) {
    let linear = element.family().linear();
    let line = element.dim() == 1;
    loop {
        let noise = most * random.unit();
        let flat = |x: Vec3| Vec3::new(x.x, if line { 0.0 } else { x.y }, 0.0);
        let corners: Vec<Vec3> = facet(linear, if line { 0.0 } else { noise }, random)
            .into_iter()
            .map(flat)
            .collect();
        let slide = noise * random.unit();
        let place = |(k, xi): (usize, &Vec3)| {
            let mut xi = *xi;
            if k >= linear.nnode() {
                let s = slide * random.signed();
                if element.family() == Family::Triangle {
                    let on_edge = element.edge_nodes().find(|of| of.node == k);
                    let ends = on_edge.map(|of| of.ends.map(|end| element.nodes()[end]));
                    let along = ends.map_or(Vec3::ZERO, |[a, b]| b - a);
                    xi += along * (0.5 * s);
                } else {
                    for a in 0..element.dim() {
                        xi[a] += if xi[a].abs() < 0.5 { s } else { 0.0 };
                    }
                }
            }
            at(linear, &corners, [xi.x, xi.y])
        };
        let x: Vec<Vec3> = element.nodes().iter().enumerate().map(place).collect();
        let places: Vec<Pair<f64>> = x.iter().map(|x| [x.x, x.y]).collect();
        if let Some(flat) = Flat::new(element, &places, Facing::Same)
            && flat.bend() <= most
        {
            return (x, flat);
        }
    }
}

#[test]
fn errors_of_rules_fall_as_stated() {
    let mut random = Random(9);
    for element in kinds() {
        let name = element.name();
        let n = element.nnode();
        for most in [0.003, 0.01, 0.03, 0.1, 0.2, 0.3, 0.4, 0.5] {
            for _ in 0..100 {
                let (x, flat) = straight(element, most, &mut random);
                let (q, bend) = (flat.degree(), flat.bend());
                let area: f64 = whole(element, &x).iter().sum();
                let exact = over_parameters(element, &x);
                for degree in (q..=MAX_DEGREE).step_by(2) {
                    let mut sums = Products::new(n);
                    let mut add = |p: Pair<f64>, w: f64| {
                        let mut there = Parameters::default();
                        locate::parameters(&flat, p, &mut there).unwrap();
                        let xi = there.xi;
                        sums.add(element, xi, w);
                    };
                    if element.dim() == 1 {
                        let [a, b] = flat.ends().map(|node| flat.x()[usize::from(node)][0]);
                        let half = 0.5 * (b - a);
                        for (s, w) in of_degree(1, degree) {
                            add([a + half * (1.0 + s.x), 0.0], w * half);
                        }
                    } else {
                        let outline = flat.pieces().next().unwrap().polygon;
                        let corners: Vec<_> = outline.corners().iter().map(|c| c.at).collect();
                        let [first, rest @ ..] = &corners[..] else {
                            panic!("a polygon")
                        };
                        for side in rest.windows(2) {
                            let [u, v] = [minus(side[0], *first), minus(side[1], *first)];
                            for (s, w) in of_degree(2, degree) {
                                let p = [0, 1].map(|c| first[c] + u[c] * s.x + v[c] * s.y);
                                add(p, w * cross2(u, v));
                            }
                        }
                    }
                    let [single, product] = sums.errors(&exact).map(|e| e / area);
                    let bound = error_bound(element.dim(), q, bend, degree);
                    assert!(
                        single <= bound + 1e-13,
                        "{name} {bend} {degree}: {single:e} {bound:e}"
                    );
                    if degree >= 2 * q && q > 1 {
                        // as many degrees per power of the bend, from the degree of the product
                        let missed = ((degree - 2 * q) / (q - 1) + 1) as i32;
                        let beyond = (degree - 2 * q) as i32;
                        let c = if element.dim() == 1 { 0.1 } else { 0.02 };
                        let bound = c * bend.powi(missed) * 4f64.powi(missed - 1 - beyond);
                        assert!(
                            product <= bound + 1e-13,
                            "{name} {bend} {degree}: {product:e} {bound:e}"
                        );
                    }
                }
            }
        }
    }
}

/// Σ w N_j and Σ w N_j N_k.
struct Products {
    n: Vec<f64>,
    single: Vec<f64>,
    product: Vec<f64>,
}

impl Products {
    fn new(n: usize) -> Self {
        Self {
            n: vec![0.0; n],
            single: vec![0.0; n],
            product: vec![0.0; n * n],
        }
    }

    fn add(&mut self, element: Element, xi: Pair<f64>, w: f64) {
        element.shape(&Vec3::new(xi[0], xi[1], 0.0), &mut self.n);
        let n = self.n.len();
        for (j, a) in self.n.iter().enumerate() {
            self.single[j] += w * a;
            for (k, b) in self.n.iter().enumerate() {
                self.product[j * n + k] += w * a * b;
            }
        }
    }

    /// The largest differences of either kind.
    fn errors(&self, other: &Self) -> [f64; 2] {
        let of = |a: &[f64], b: &[f64]| {
            let pairs = a.iter().zip(b).map(|(a, b)| (a - b).abs());
            pairs.fold(0.0, f64::max)
        };
        [
            of(&self.single, &other.single),
            of(&self.product, &other.product),
        ]
    }
}

/// The integrals over a facet by a rule on its parameters, exact for polynomials.
fn over_parameters(element: Element, x: &[Vec3]) -> Products {
    let mut sums = Products::new(x.len());
    let mut dn = vec![Vec3::ZERO; x.len()];
    for (xi, w) in on_facet(element, &gauss(10)) {
        element.dshape(&xi, &mut dn);
        let t = |a: usize| dn.iter().zip(x).map(|(d, &x)| x * d[a]).sum::<Vec3>();
        let second = if element.dim() == 1 {
            Vec3::unit(1)
        } else {
            t(1)
        };
        sums.add(element, [xi.x, xi.y], w * t(0).cross(second).z);
    }
    sums
}

#[test]
fn integrals_over_covered_facets_are_exact_however_they_are_distorted_in_their_plane() {
    let mut random = Random(4);
    let (mut worst, mut largest_bend) = (0.0f64, 0.0f64);
    for elements in pairings() {
        for round in 0..20 {
            let [small, large] = elements;
            let (x, flat) = straight(small, [0.003, 0.03, 0.1, 0.3][round % 4], &mut random);
            largest_bend = largest_bend.max(flat.bend());
            // one facet around it, or several that meet inside it
            let size = [9.0, 1.3][round / 4 % 2];
            let centres: &[[f64; 2]] = match (size > 2.0, large.dim()) {
                (true, _) => &[[0.0, 0.0]],
                (_, 1) => &[[-1.2, 0.0], [1.4, 0.0]],
                _ if large.ncorner() == 4 => &[[-1.1, 1.2], [1.5, 1.2], [-1.1, -1.4], [1.5, -1.4]],
                _ => continue,
            };
            let around: Vec<Vec<Vec3>> = centres
                .iter()
                .map(|c| {
                    let over = |x: Vec3| match small.dim() {
                        1 => x * -size + Vec3::new(c[0], 0.0, 0.0),
                        _ => Vec3::new(x.x, -x.y, 0.1) * size + Vec3::new(c[0], c[1], 0.0),
                    };
                    facet(large, 0.0, &mut random)
                        .into_iter()
                        .map(over)
                        .collect()
                })
                .collect();
            let exact = whole(small, &x);
            let area: f64 = exact.iter().sum();
            let mut sums = [vec![0.0; x.len()], vec![0.0; x.len()]];
            for around in &around {
                let first = moments([small, large], &between([small, large], [&x, around]));
                let second = moments([large, small], &between([large, small], [around, &x]));
                let [a, b] = &mut sums;
                a.iter_mut().zip(&first[0]).for_each(|(s, v)| *s += v);
                b.iter_mut().zip(&second[1]).for_each(|(s, v)| *s += v);
            }
            for (s, e) in sums.iter().flat_map(|sums| sums.iter().zip(&exact)) {
                let error = (s - e).abs() / area;
                assert!(
                    error < EXACT,
                    "{elements:?}: {error:e}, bend {}",
                    flat.bend()
                );
                worst = worst.max(error);
            }
        }
    }
    println!(
        "largest error of integrals of shape functions: {worst:.1e}, bend up to {largest_bend:.2}"
    );
}

#[test]
fn bent_edges_cover_what_their_polygons_enclose() {
    let mut random = Random(10);
    let mut dented = 0;
    for element in kinds().filter(|e| e.dim() == 2 && !e.is_linear()) {
        let large = by_name("quad4").unwrap();
        for round in 0..40 {
            let noise = [1e-9, 1e-5, 1e-3, 0.03][round % 4];
            let flat = |x: &Vec3| Vec3::new(x.x, x.y, 0.0);
            let x: Vec<Vec3> = facet(element, noise, &mut random)
                .iter()
                .map(flat)
                .collect();
            let places: Vec<Pair<f64>> = x.iter().map(|x| [x.x, x.y]).collect();
            let found = Flat::new(element, &places, Facing::Same).unwrap();
            dented += usize::from(found.pieces().any(|p| p.sign < 0.0));
            // four facets that meet inside
            let mut sum = 0.0;
            for [a, b] in [[-1.1, 1.2], [1.5, 1.2], [-1.1, -1.4], [1.5, -1.4]] {
                let around: Vec<Vec3> = large
                    .nodes()
                    .iter()
                    .map(|x| Vec3::new(x.x, -x.y, 0.1) * 1.3 + Vec3::new(a, b, 0.0))
                    .collect();
                sum += measure(&between([element, large], [&x, &around]));
            }
            let boundary: Vec<Pair<f64>> = element.ring().map(|k| places[k]).collect();
            let n = boundary.len();
            let twice = |k: usize| cross2(boundary[k], boundary[(k + 1) % n]);
            let area = 0.5 * (0..n).map(twice).sum::<f64>();
            let error = (sum - area).abs() / area;
            assert!(error < 1e-14, "{element:?} {noise:e}: {error:e}");
        }
    }
    assert!(dented > 60, "{dented}");
}

#[test]
fn nearly_affine_facets_need_few_points() {
    println!("points of a triangle, of a whole facet and of half of it");
    for element in kinds() {
        let name = element.name();
        let places: Vec<Pair<f64>> = element.nodes().iter().map(|x| [x.x, x.y]).collect();
        let q = Flat::new(element, &places, Facing::Same).unwrap().degree();
        let points = |bend: f64| {
            let degree = degree_for(element.dim(), q, bend, EXACT).clamp(2 * q, MAX_DEGREE);
            of_degree(element.dim(), degree).len()
        };
        let bends = [0.0, 0.003, 0.03, 0.1, 0.3];
        let row: Vec<String> = bends
            .iter()
            .map(|&b| format!("{} ({})", points(b), points(0.5 * b / (1.0 - 0.5 * b))))
            .collect();
        println!("| {name} | {} |", row.join(" | "));
        assert!(points(1e-6) == points(0.0), "{name}");
    }
}

#[test]
fn points_and_weights_do_not_notice_a_rigid_motion() {
    let mut random = Random(5);
    for elements in pairings() {
        let plane = elements[0].dim() == 1;
        let a = facet(elements[0], 0.1, &mut random);
        let b = opposite(elements[1], 0.1, &mut random);
        let mut turn = random.vector() * 3.0;
        if plane {
            turn = Vec3::new(0.0, 0.0, turn.z);
        }
        let (turn, shift) = (
            Mat3::rotation(turn),
            Vec3::new(2.0, -1.0, if plane { 0.0 } else { 3.0 }),
        );
        let moved = |x: &[Vec3]| -> Vec<Vec3> { x.iter().map(|&x| turn * x + shift).collect() };
        let before = between(elements, [&a, &b]);
        let after = between(elements, [&moved(&a), &moved(&b)]);
        assert_eq!(before.len(), after.len());
        assert!(!before.is_empty());
        for (p, q) in before.iter().zip(&after) {
            let all = |p: &Point| {
                [
                    p.weight,
                    p.secondary.xi[0],
                    p.secondary.xi[1],
                    p.primary.xi[0],
                    p.primary.xi[1],
                ]
            };
            for (p, q) in all(p).iter().zip(all(q)) {
                assert!((p - q).abs() < 1e-13, "{elements:?}");
            }
        }
    }
}

#[test]
fn derivatives_of_points_and_weights_match_differences() {
    let mut random = Random(6);
    let mut worst = 0.0f64;
    for elements in pairings() {
        for noise in [0.02, 0.1] {
            let x = [
                facet(elements[0], noise, &mut random),
                opposite(elements[1], noise, &mut random),
            ];
            let nodes = [elements[0].nnode(), elements[1].nnode()];
            let seeded: [Vec<[Dual<VARIABLES>; 3]>; 2] = [0, 1].map(|k| {
                let first = 3 * k * nodes[0];
                let node = |(i, x): (usize, &Vec3)| {
                    [0, 1, 2].map(|c| Dual::variable(x[c], first + 3 * i + c))
                };
                x[k].iter().enumerate().map(node).collect()
            });
            let exact = points(elements, [&x[0], &x[1]]);
            let plane = Plane::of(elements[0], &seeded[0]).unwrap();
            let places = [0, 1].map(|k: usize| -> Vec<Pair<Dual<VARIABLES>>> {
                seeded[k].iter().map(|&x| plane.project(x)).collect()
            });
            let components = if elements[0].dim() == 1 { 2 } else { 3 };
            for variable in 0..3 * (nodes[0] + nodes[1]) {
                let (node, c) = (variable / 3, variable % 3);
                if c >= components || random.unit() > 0.1 {
                    continue;
                }
                let moved = |h: f64| {
                    let mut x = x.clone();
                    let (k, i) = if node < nodes[0] {
                        (0, node)
                    } else {
                        (1, node - nodes[0])
                    };
                    x[k][i][c] += h;
                    between(elements, [&x[0], &x[1]])
                };
                let h = 1e-4;
                let steps = [-2.0, -1.0, 1.0, 2.0].map(|k| moved(k * h));
                if steps.iter().any(|s| s.len() != exact.len()) {
                    continue; // a corner comes or goes
                }
                for (k, placed) in exact.iter().enumerate() {
                    let p = &placed.point;
                    // w, and N_0 of either facet
                    let parts = |p: &Point| [p.weight, p.secondary.shape[0], p.primary.shape[0]];
                    let [a, b, c, d] = [0, 1, 2, 3].map(|s| parts(&steps[s][k]));
                    let mut weight = 0.0;
                    let mut at = [0.0; 2];
                    for (corner, moves) in placed.moves.iter().enumerate() {
                        for (facing, node, slopes) in moves {
                            let place = places[usize::from(*facing == Facing::Opposite)][*node];
                            for a in 0..2 {
                                let along = |b: usize| slopes[a][b] * place[b].slope[variable];
                                let dc: f64 = (0..elements[0].dim()).map(along).sum();
                                weight += p.weight / placed.size * placed.dsize[corner][a] * dc;
                                at[a] += p.shares[corner] * dc;
                            }
                        }
                    }
                    let of = |there: &Parameters, k: usize| {
                        let mut rest = at;
                        for (n, x) in there.shape.iter().zip(&places[k]) {
                            rest = [0, 1].map(|a| rest[a] - n * x[a].slope[variable]);
                        }
                        there.gradient[0][0] * rest[0] + there.gradient[0][1] * rest[1]
                    };
                    let ours = [weight, of(&p.secondary, 0), of(&p.primary, 1)];
                    for (i, &ours) in ours.iter().enumerate() {
                        let slope = (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * h);
                        let error = (slope - ours).abs() / (1.0 + slope.abs());
                        worst = worst.max(error);
                        assert!(error < 1e-7, "{elements:?} {i}: {slope} {ours}");
                    }
                }
            }
        }
    }
    println!("largest error of derivatives: {worst:.1e}");
}
