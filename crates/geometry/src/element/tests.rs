//! Properties of every element of the table and of made-up cubic ones, asked through the trait alone.

use super::quadrature::Rule;
use super::*;
use crate::random::Random;
use crate::tensor::{Mat3, Sym3, Vec3};
use std::collections::{BTreeMap, BTreeSet};

/// The elements of the table, and those that no table has.
fn all() -> Vec<Element> {
    TABLE.into_iter().chain(testing::CUBIC).collect()
}

impl Random {
    /// In `[-1, 1)` along the first `dim` axes, 0 along the others.
    fn cube(&mut self, dim: usize) -> Vec3 {
        (0..dim).fold(Vec3::ZERO, |v, axis| v + Vec3::unit(axis) * self.signed())
    }

    /// A point of the convex hull of these.
    fn between(&mut self, points: &[Vec3]) -> Vec3 {
        let weights: Vec<f64> = points.iter().map(|_| self.unit()).collect();
        let sum: f64 = weights.iter().sum();
        let weighted = points.iter().zip(&weights).map(|(&p, &w)| p * (w / sum));
        weighted.sum()
    }

    /// A linear map of the first `dim` axes that keeps orientation; the identity on the others.
    fn distortion(&mut self, dim: usize) -> Mat3 {
        loop {
            let mut a = Mat3::IDENTITY;
            for row in a.rows.iter_mut().take(dim) {
                *row += self.cube(dim);
            }
            if a.determinant() > 0.1 {
                return a;
            }
        }
    }
}

fn shape(e: Element, xi: Vec3) -> Vec<f64> {
    let mut n = vec![f64::NAN; e.nnode()];
    e.shape(&xi, &mut n);
    n
}

fn dshape(e: Element, xi: Vec3) -> Vec<Vec3> {
    let mut dn = vec![Vec3::new(f64::NAN, f64::NAN, f64::NAN); e.nnode()];
    e.dshape(&xi, &mut dn);
    dn
}

fn ddshape(e: Element, xi: Vec3) -> Vec<Sym3> {
    let mut ddn = vec![Sym3::IDENTITY * f64::NAN; e.nnode()];
    e.ddshape(&xi, &mut ddn);
    ddn
}

/// `Σ N_i x_i`.
fn position(e: Element, x: &[Vec3], xi: Vec3) -> Vec3 {
    shape(e, xi).iter().zip(x).map(|(&n, &x)| x * n).sum()
}

/// The columns `Σ N_i,a x_i`.
fn tangents(e: Element, x: &[Vec3], xi: Vec3) -> [Vec3; 3] {
    let dn = dshape(e, xi);
    [0, 1, 2].map(|a| dn.iter().zip(x).map(|(dn, &x)| x * dn[a]).sum())
}

/// The determinant of the map from the reference domain, for elements as flat as their reference.
fn jacobian(e: Element, x: &[Vec3], xi: Vec3) -> f64 {
    let mut columns = tangents(e, x, xi);
    for (axis, column) in columns.iter_mut().enumerate().skip(e.dim()) {
        *column = Vec3::unit(axis);
    }
    columns[0].dot(columns[1].cross(columns[2]))
}

/// The normal of a side, as long as the side's measure per measure of its reference domain.
fn normal(side: Element, x: &[Vec3], xi: Vec3) -> Vec3 {
    let [t1, t2, _] = tangents(side, x, xi);
    match side.dim() {
        1 => Vec3::new(t1.y, -t1.x, 0.0),
        _ => t1.cross(t2),
    }
}

fn side_nodes(side: &Side, x: &[Vec3]) -> Vec<Vec3> {
    side.nodes.iter().map(|&i| x[i]).collect()
}

/// Gauss–Legendre with nine points on `[0, 1]`, exact up to degree 17: Newton on the Legendre polynomial.
fn gauss() -> [(f64, f64); 9] {
    const N: usize = 9;
    std::array::from_fn(|k| {
        let mut x = (std::f64::consts::PI * (k as f64 + 0.75) / (N as f64 + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..8 {
            let (mut before, mut p) = (1.0, x);
            for n in 2..=N {
                let n = n as f64;
                (before, p) = (p, ((2.0 * n - 1.0) * x * p - (n - 1.0) * before) / n);
            }
            slope = N as f64 * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        (0.5 + 0.5 * x, 1.0 / ((1.0 - x * x) * slope * slope))
    })
}

/// Points and weights that integrate polynomials over the reference domain, without the element's own rules: the domain
/// is the union of the cones over its sides, each side is integrated in the same way.
fn exact_rule(e: Element) -> Vec<(Vec3, f64)> {
    if e.dim() == 1 {
        let [a, b] = e.edges()[0].map(|i| e.nodes()[i]);
        let at = |(s, w): (f64, f64)| (a + (b - a) * s, w * (b - a).x);
        return gauss().map(at).to_vec();
    }
    let apex = e.centre();
    let mut rule = Vec::new();
    for side in e.sides() {
        let x = side_nodes(side, e.nodes());
        for (eta, weight) in exact_rule(side.element) {
            let ray = position(side.element, &x, eta) - apex;
            let height = ray.dot(normal(side.element, &x, eta));
            let along = |(s, w): (f64, f64)| w * s.powi(e.dim() as i32 - 1) * height * weight;
            rule.extend(gauss().map(|at| (apex + ray * at.0, along(at))));
        }
    }
    rule
}

fn integral(e: Element, f: impl Fn(Vec3) -> f64) -> f64 {
    exact_rule(e).into_iter().map(|(xi, w)| w * f(xi)).sum()
}

/// The nodes of each part of the boundary: sides, or the ends of a line.
fn boundary(e: Element) -> Vec<Vec<Vec3>> {
    if e.dim() == 1 {
        let ends = e.edges()[0].map(|i| vec![e.nodes()[i]]);
        return ends.to_vec();
    }
    let sides = e.sides().iter();
    sides.map(|side| side_nodes(side, e.nodes())).collect()
}

/// Runs a claim at random points of the reference domain of every element.
fn for_points(mut claim: impl FnMut(Element, Vec3, &mut Random)) {
    let mut random = Random(1);
    for e in all() {
        for _ in 0..20 {
            let xi = random.between(e.nodes());
            claim(e, xi, &mut random);
        }
    }
}

fn assert_near(e: Element, what: &str, a: f64, b: f64, tolerance: f64) {
    let error = (a - b).abs();
    assert!(error <= tolerance, "{} {what}: {a} {b}", e.name());
}

fn sorted<const N: usize>(mut a: [usize; N]) -> [usize; N] {
    a.sort_unstable();
    a
}

#[test]
fn names_find_their_elements_and_no_other() {
    for e in TABLE {
        assert_eq!(by_name(e.name()), Some(e));
    }
    for e in all() {
        assert!((2..=MAX_NODES).contains(&e.nnode()) && (1..=3).contains(&e.dim()));
        assert!(e.dim() == 3 || e.nnode() <= MAX_FACET_NODES);
    }
    let names: BTreeSet<_> = all().iter().map(|e| e.name()).collect();
    assert_eq!(names.len(), all().len());
    assert_eq!(by_name("hex"), None);
}

#[test]
fn shape_functions_are_a_partition_of_unity() {
    for_points(|e, xi, _| {
        let sum: f64 = shape(e, xi).iter().sum();
        assert_near(e, "ΣN", sum, 1.0, 1e-14);
        let slope: Vec3 = dshape(e, xi).into_iter().sum();
        assert_near(e, "ΣN,a", slope.max_abs(), 0.0, 1e-14);
        let curvature = ddshape(e, xi).into_iter().fold(Sym3::ZERO, |a, b| a + b);
        for c in curvature.to_pairs() {
            assert_near(e, "ΣN,ab", c, 0.0, 1e-14);
        }
    });
}

#[test]
fn each_shape_function_is_one_at_its_node_and_zero_at_the_others() {
    for e in all() {
        for (i, &node) in e.nodes().iter().enumerate() {
            for (j, n) in shape(e, node).into_iter().enumerate() {
                let delta = f64::from(u8::from(i == j));
                assert_near(e, "N_j(ξ_i)", n, delta, 1e-15);
            }
        }
    }
}

#[test]
fn linear_fields_are_reproduced() {
    for_points(|e, xi, random| {
        let (slope, offset) = (random.cube(e.dim()), random.unit());
        let field = |p: Vec3| offset + slope.dot(p);
        let nodal: Vec<f64> = e.nodes().iter().map(|&p| field(p)).collect();
        let n = shape(e, xi);
        let value: f64 = n.iter().zip(&nodal).map(|(n, f)| n * f).sum();
        assert_near(e, "field", value, field(xi), 1e-14);
        let dn = dshape(e, xi);
        let gradient: Vec3 = dn.iter().zip(&nodal).map(|(&dn, &f)| dn * f).sum();
        let error = (gradient - slope).max_abs();
        assert_near(e, "gradient", error, 0.0, 1e-14);
    });
}

#[test]
fn all_monomials_of_the_order_are_reproduced_and_by_product_elements_those_along_each_axis() {
    for_points(|e, xi, _| {
        let product = e.degree() == e.order() * e.dim();
        let power = |x: Vec3, p: [i32; 3]| x.x.powi(p[0]) * x.y.powi(p[1]) * x.z.powi(p[2]);
        let order = e.order() as i32;
        for k in 0..(order + 1).pow(e.dim() as u32) {
            let digit = |axis: u32| k / (order + 1).pow(axis) % (order + 1);
            let p = [digit(0), digit(1), digit(2)];
            if !product && p.iter().sum::<i32>() > order {
                continue;
            }
            let n = shape(e, xi).into_iter().zip(e.nodes());
            let value: f64 = n.map(|(n, &x)| n * power(x, p)).sum();
            assert_near(e, "monomial", value, power(xi, p), 1e-14);
        }
    });
}

/// Differences of order `n` vanish for polynomials below degree `n`, and for no other.
#[test]
fn degree_is_that_of_the_shape_functions_along_any_line() {
    for_points(|e, xi, random| {
        let step = random.cube(e.dim());
        let largest_difference = |order: usize| {
            let mut rows: Vec<Vec<f64>> = (0..=order)
                .map(|k| shape(e, xi + step * k as f64))
                .collect();
            while rows.len() > 1 {
                let minus = |w: &[Vec<f64>]| w[1].iter().zip(&w[0]).map(|(b, a)| b - a).collect();
                rows = rows.windows(2).map(minus).collect();
            }
            rows[0].iter().fold(0.0, |m: f64, d| m.max(d.abs()))
        };
        let [own, next] = [0, 1].map(|more| largest_difference(e.degree() + more));
        assert!(next < 1e-10, "{e:?} {next:e}");
        let long = (0..e.dim()).all(|axis| step[axis].abs() > 0.1);
        assert!(!long || own > 1e-8, "{e:?} {own:e}");
    });
}

#[test]
fn corners_come_first_and_then_nodes_at_equal_distances_in_the_order_of_the_edges() {
    for e in all() {
        let corners: BTreeSet<_> = e.edges().iter().flatten().copied().collect();
        assert!(corners.into_iter().eq(0..e.ncorner()), "{e:?}");
        let linear = e.family().linear();
        assert_eq!(linear.nodes(), &e.nodes()[..e.ncorner()], "{e:?}");
        let x = e.nodes();
        let mut next = e.ncorner();
        for of in e.edge_nodes() {
            assert_eq!(of.node, next, "{e:?}");
            let error = x[of.node] - of.straight(of.ends.map(|k| x[k]));
            assert!(error.max_abs() < 1e-15, "{e:?} {of:?}");
            next += 1;
        }
        assert_eq!(next, e.ncorner() + e.edges().len() * (e.order() - 1));
        assert!(next <= e.nnode(), "{e:?}");
        let mids = if e.order() == 2 { e.edges().len() } else { 0 };
        assert_eq!(e.mid_nodes().count(), mids, "{e:?}");
        for (mid, [a, b]) in e.mid_nodes() {
            assert_eq!(x[mid], (x[a] + x[b]) * 0.5, "{e:?} {mid}");
        }
    }
}

#[test]
fn nodes_of_the_ring_are_those_of_the_sides_in_their_order() {
    for e in all().into_iter().filter(|e| e.dim() == 2) {
        let of_side = |side: &Side| {
            let start = side.nodes[0];
            let inside = side.element.inside_edge(0).map(|k| side.nodes[k]);
            [start].into_iter().chain(inside).collect::<Vec<_>>()
        };
        let sides = e.sides().iter().flat_map(of_side);
        assert!(e.ring().eq(sides), "{e:?}");
    }
}

#[test]
fn an_even_pressure_is_shared_where_all_integrals_of_shape_functions_are_positive() {
    for e in all().into_iter().filter(|e| e.dim() < 3) {
        let least = (0..e.nnode()).map(|i| integral(e, |xi| shape(e, xi)[i]));
        let least = least.fold(f64::INFINITY, f64::min);
        assert_eq!(e.shares_even_pressure(), least > 1e-12, "{e:?} {least:e}");
    }
    let shares = |name| by_name(name).unwrap().shares_even_pressure();
    assert!(!shares("tri6") && !shares("quad8") && shares("quad9"));
}

/// The derivative along an axis from five points, exact for polynomials of degree 4.
fn difference<const N: usize>(f: impl Fn(Vec3) -> [f64; N], xi: Vec3, axis: usize) -> [f64; N] {
    let h = 1.0 / 128.0;
    let [m2, m1, p1, p2] = [-2.0, -1.0, 1.0, 2.0].map(|k| f(xi + Vec3::unit(axis) * (k * h)));
    std::array::from_fn(|i| (m2[i] - p2[i] + 8.0 * (p1[i] - m1[i])) / (12.0 * h))
}

#[test]
fn first_derivatives_match_differences() {
    for_points(|e, xi, _| {
        for (i, dn) in dshape(e, xi).into_iter().enumerate() {
            for axis in 0..3 {
                let [expected] = difference(|p| [shape(e, p)[i]], xi, axis);
                assert_near(e, "N_i,a", dn[axis], expected, 1e-12);
                assert!(axis < e.dim() || dn[axis] == 0.0);
            }
        }
    });
}

#[test]
fn second_derivatives_match_differences() {
    for_points(|e, xi, _| {
        for (i, ddn) in ddshape(e, xi).into_iter().enumerate() {
            let ddn = ddn.to_mat3();
            for axis in 0..3 {
                let expected = difference(|p| dshape(e, p)[i].to_array(), xi, axis);
                for (b, expected) in expected.into_iter().enumerate() {
                    assert_near(e, "N_i,ab", ddn.rows[axis][b], expected, 1e-12);
                }
            }
        }
    });
}

#[test]
fn trailing_coordinates_are_not_used() {
    for_points(|e, xi, random| {
        let other = xi + (e.dim()..3).map(|a| Vec3::unit(a) * random.unit()).sum();
        assert_eq!(shape(e, xi), shape(e, other));
        assert_eq!(dshape(e, xi), dshape(e, other));
        assert_eq!(ddshape(e, xi), ddshape(e, other));
        assert_eq!(e.contains(&xi, 0.0), e.contains(&other, 0.0));
    });
}

#[test]
fn weights_sum_to_the_measure_of_the_reference_domain() {
    for e in all() {
        let measure = match e.family() {
            Family::Line => 2.0,
            Family::Triangle => 0.5,
            Family::Quadrilateral => 4.0,
            Family::Tetrahedron => 1.0 / 6.0,
            Family::Hexahedron => 8.0,
            Family::Wedge => 1.0,
        };
        assert_near(e, "∫1", integral(e, |_| 1.0), measure, 1e-13 * measure);
        let rules = [
            Some(e.rules().full),
            Some(e.rules().reduced),
            Some(e.rules().surface),
            Some(e.rules().revolved),
            Some(e.rules().dilatation),
            e.rules().raised,
        ];
        for rule in rules.into_iter().flatten() {
            let sum: f64 = rule.weights.iter().sum();
            assert_near(e, "Σw", sum, measure, 1e-14);
            assert_eq!(rule.points.len(), rule.weights.len());
            assert!(rule.points.iter().all(|p| e.contains(p, 0.0)));
            assert!(rule.weights.iter().all(|&w| w > 0.0));
        }
    }
}

/// The largest difference between the rule's and the exact integral of some functions, and of their products.
fn defects(e: Element, rule: &Rule, f: impl Fn(Vec3) -> Vec<f64>) -> [f64; 2] {
    let n = f(e.centre()).len();
    let (mut single, mut double) = (vec![0.0; n], vec![0.0; n * n]);
    let exact = exact_rule(e).into_iter().map(|(xi, w)| (xi, -w));
    for (xi, w) in exact.chain(rule.iter().map(|(&xi, w)| (xi, w))) {
        let values = f(xi);
        for (i, a) in values.iter().enumerate() {
            single[i] += w * a;
            for (sum, b) in double[i * n..].iter_mut().zip(&values[..=i]) {
                *sum += w * a * b;
            }
        }
    }
    [single, double].map(|list| list.iter().fold(0.0, |a: f64, b| a.max(b.abs())))
}

/// Every component of every gradient.
fn gradients(e: Element, xi: Vec3) -> Vec<f64> {
    let dn = dshape(e, xi).into_iter();
    dn.flat_map(|d| d.to_array().into_iter().take(e.dim()))
        .collect()
}

#[test]
fn full_rule_integrates_the_stiffness_of_the_undistorted_element() {
    for e in all() {
        let [single, double] = defects(e, e.full_rule(), |xi| gradients(e, xi));
        assert_near(e, "∫N_i,a", single, 0.0, 1e-13);
        if e.name() != "wedge15" {
            assert_near(e, "∫N_i,a N_j,b", double, 0.0, 1e-13);
        }
    }
}

#[test]
fn surface_rule_integrates_products_of_two_shape_functions() {
    for e in all().into_iter().filter(|e| e.dim() < 3) {
        let [single, double] = defects(e, e.surface_rule(), |xi| shape(e, xi));
        assert_near(e, "∫N_i", single, 0.0, 1e-13);
        assert_near(e, "∫N_i N_j", double, 0.0, 1e-13);
    }
}

#[test]
fn mass_rule_integrates_products_of_two_shape_functions() {
    for e in all() {
        let [single, double] = defects(e, e.rules().mass, |xi| shape(e, xi));
        assert_near(e, "∫N_i", single, 0.0, 1e-13);
        assert_near(e, "∫N_i N_j", double, 0.0, 1e-13);
    }
}

/// The rank of the matrix with these rows, by elimination with the largest pivot.
fn rank(mut rows: Vec<Vec<f64>>) -> usize {
    let n = rows[0].len();
    for rank in 0..n.min(rows.len()) {
        let places = (rank..rows.len()).flat_map(|i| (rank..n).map(move |j| (i, j)));
        let largest =
            places.max_by(|&(i, j), &(k, l)| rows[i][j].abs().total_cmp(&rows[k][l].abs()));
        let (i, j) = largest.unwrap();
        if rows[i][j].abs() < 1e-9 {
            return rank;
        }
        rows.swap(rank, i);
        rows.iter_mut().for_each(|row| row.swap(rank, j));
        let (done, rest) = rows.split_at_mut(rank + 1);
        let pivot = &done[rank];
        for row in rest {
            let factor = row[rank] / pivot[rank];
            row.iter_mut()
                .zip(pivot)
                .for_each(|(a, b)| *a -= factor * b);
        }
    }
    n.min(rows.len())
}

/// The full rule sees every strain; the reduced rule of quad8 misses one and that of hex20 six.
///
/// SOURCE: Hughes, *The Finite Element Method*, section 4.8 and its problems.
#[test]
fn full_rule_has_no_mode_without_energy_but_rigid_motion() {
    for e in all().into_iter().filter(|e| e.dim() > 1) {
        let (dim, n) = (e.dim(), e.nnode());
        let rigid = dim * (dim + 1) / 2;
        let strains = |rule: &Rule| {
            let mut rows = Vec::new();
            for (xi, _) in rule.iter() {
                let dn = dshape(e, *xi);
                for (i, j) in Sym3::PAIRS.into_iter().filter(|&(_, j)| j < dim) {
                    let mut row = vec![0.0; dim * n];
                    for (k, d) in dn.iter().enumerate() {
                        row[dim * k + i] += d[j];
                        row[dim * k + j] += d[i];
                    }
                    rows.push(row);
                }
            }
            rank(rows)
        };
        assert_eq!(strains(e.full_rule()), dim * n - rigid, "{e:?}");
        let missed = match e.name() {
            "quad8" => 1,
            "hex20" => 6,
            _ => 0,
        };
        assert_eq!(strains(e.reduced_rule()) + missed, dim * n - rigid, "{e:?}");
    }
}

#[test]
fn distorted_volume_is_determinant_times_measure() {
    let mut random = Random(2);
    for e in all() {
        let measure: f64 = e.full_rule().weights.iter().sum();
        for _ in 0..10 {
            let (a, shift) = (random.distortion(e.dim()), random.cube(3));
            let x: Vec<Vec3> = e.nodes().iter().map(|&p| a * p + shift).collect();
            let points = e.full_rule().iter();
            let volume: f64 = points.map(|(p, w)| w * jacobian(e, &x, *p)).sum();
            let expected = a.determinant() * measure;
            assert_near(e, "volume", volume, expected, 1e-13 * expected.max(1.0));
        }
    }
}

#[test]
fn domain_is_the_convex_hull_of_the_nodes() {
    for_points(|e, xi, random| {
        assert!(e.contains(&xi, 1e-15), "{e:?}");
        assert!(e.contains(&e.centre(), -0.1), "{e:?}");
        for part in boundary(e) {
            let edge = random.between(&part);
            let at = |s: f64| e.centre() + (edge - e.centre()) * s;
            assert!(
                e.contains(&at(0.999), 0.0) && !e.contains(&at(1.001), 0.0),
                "{e:?}"
            );
            assert!(
                e.contains(&at(1.001), 0.002) && !e.contains(&at(1.001), 0.0001),
                "{e:?}"
            );
            assert!(
                e.contains(&at(2.0), 1.01) && !e.contains(&edge, -0.001),
                "{e:?}"
            );
        }
    });
    for e in all() {
        assert!(!e.contains(&(Vec3::unit(0) * f64::NAN), 1.0), "{e:?}");
    }
}

#[test]
fn sides_are_one_dimension_lower_and_carry_the_trace() {
    for e in all() {
        assert_eq!(e.sides().is_empty(), e.dim() == 1);
        for side in e.sides() {
            assert_eq!(side.element.dim() + 1, e.dim());
            assert_eq!(side.element.nnode(), side.nodes.len());
            let x = side_nodes(side, e.nodes());
            let mut random = Random(3);
            for _ in 0..10 {
                let eta = random.between(side.element.nodes());
                let mut expected = vec![0.0; e.nnode()];
                for (&i, n) in side.nodes.iter().zip(shape(side.element, eta)) {
                    expected[i] = n;
                }
                let found = shape(e, position(side.element, &x, eta));
                for (a, b) in found.into_iter().zip(expected) {
                    assert_near(e, "trace", a, b, 1e-14);
                }
            }
        }
    }
}

#[test]
fn normals_of_sides_point_away_from_the_centre() {
    let mut random = Random(4);
    for e in all() {
        for k in 0..10 {
            let mut x = e.nodes().to_vec();
            if k > 0 {
                let a = random.distortion(e.dim());
                x.iter_mut().for_each(|p| *p = a * *p);
            }
            let centre = position(e, &x, e.centre());
            for side in e.sides() {
                let nodes = side_nodes(side, &x);
                let eta = random.between(side.element.nodes());
                let out = position(side.element, &nodes, eta) - centre;
                assert!(out.dot(normal(side.element, &nodes, eta)) > 0.0, "{e:?}");
            }
        }
    }
}

/// Gauss: `Σ ∫ n = 0` and `Σ ∫ x·n = dim · volume` over the sides, whatever the shape of the element.
#[test]
fn sides_close() {
    let mut random = Random(5);
    for e in all().into_iter().filter(|e| e.dim() > 1) {
        for bend in [0.0, 0.1, 0.2] {
            let a = random.distortion(e.dim());
            let mut bent = |&p: &Vec3| a * (p + random.cube(e.dim()) * bend);
            let x: Vec<Vec3> = e.nodes().iter().map(&mut bent).collect();
            let volume = integral(e, |xi| jacobian(e, &x, xi));
            assert!(volume > 0.0);
            let (mut area, mut flux) = ([0.0; 3], 0.0);
            for side in e.sides() {
                let nodes = side_nodes(side, &x);
                let n = |eta| normal(side.element, &nodes, eta);
                for (axis, area) in area.iter_mut().enumerate() {
                    *area += integral(side.element, |eta| n(eta)[axis]);
                }
                flux += integral(side.element, |eta| {
                    position(side.element, &nodes, eta).dot(n(eta))
                });
            }
            for area in area {
                assert_near(e, "Σ∫n", area, 0.0, 1e-13);
            }
            let expected = e.dim() as f64 * volume;
            assert_near(e, "Σ∫x·n", flux, expected, 1e-13 * expected.max(1.0));
        }
    }
}

#[test]
fn edges_of_faces_run_round_the_boundary_counter_clockwise() {
    for e in all().into_iter().filter(|e| e.dim() == 2) {
        let edges = e.edges();
        let mut area = 0.0;
        for (k, &[a, b]) in edges.iter().enumerate() {
            assert_eq!(b, edges[(k + 1) % edges.len()][0], "{e:?}");
            assert_eq!(e.sides()[k].nodes[..2], [a, b], "{e:?}");
            area += 0.5 * e.nodes()[a].cross(e.nodes()[b]).z;
        }
        assert_eq!(e.sides().len(), edges.len());
        let measure: f64 = e.full_rule().weights.iter().sum();
        assert_near(e, "area", area, measure, 1e-15);
    }
}

#[test]
fn every_edge_of_a_solid_lies_in_two_sides_which_run_through_it_in_opposite_directions() {
    for e in all().into_iter().filter(|e| e.dim() == 3) {
        let mut runs: BTreeMap<[usize; 2], Vec<[usize; 2]>> = BTreeMap::new();
        for side in e.sides() {
            for edge in side.element.edges() {
                let edge = edge.map(|i| side.nodes[i]);
                runs.entry(sorted(edge)).or_default().push(edge);
            }
        }
        for (key, run) in &runs {
            assert_eq!(run.len(), 2, "{e:?} {key:?}");
            assert_eq!(run[0], [run[1][1], run[1][0]], "{e:?} {key:?}");
        }
        let listed: BTreeSet<_> = e.edges().iter().map(|&edge| sorted(edge)).collect();
        assert_eq!(listed.len(), e.edges().len(), "{e:?}");
        assert!(listed.iter().eq(runs.keys()), "{e:?}");
        let corners: BTreeSet<_> = e.edges().iter().flatten().collect();
        assert_eq!(
            corners.len() + e.sides().len(),
            e.edges().len() + 2,
            "Euler"
        );
    }
}

/// SOURCE: Abaqus Analysis User's Guide, element library, faces of solid elements; corners, numbered from 1.
#[test]
fn sides_are_numbered_as_in_abaqus() {
    for e in all().into_iter().filter(|e| e.dim() > 1) {
        let expected: &[&[usize]] = match e.family() {
            Family::Line => &[],
            Family::Triangle => &[&[1, 2], &[2, 3], &[3, 1]],
            Family::Quadrilateral => &[&[1, 2], &[2, 3], &[3, 4], &[4, 1]],
            Family::Tetrahedron => &[&[1, 2, 3], &[1, 4, 2], &[2, 4, 3], &[3, 4, 1]],
            Family::Hexahedron => &[
                &[1, 2, 3, 4],
                &[5, 8, 7, 6],
                &[1, 5, 6, 2],
                &[2, 6, 7, 3],
                &[3, 7, 8, 4],
                &[4, 8, 5, 1],
            ],
            Family::Wedge => &[
                &[1, 2, 3],
                &[4, 5, 6],
                &[1, 2, 5, 4],
                &[2, 3, 6, 5],
                &[3, 1, 4, 6],
            ],
        };
        assert_eq!(e.sides().len(), expected.len());
        for (side, expected) in e.sides().iter().zip(expected) {
            let corners = side.element.edges().iter().flatten();
            let corners: BTreeSet<usize> = corners.map(|&i| side.nodes[i] + 1).collect();
            assert_eq!(corners, expected.iter().copied().collect(), "{e:?}");
        }
    }
}
