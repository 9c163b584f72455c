//! Properties of every element of the table, asked through the trait alone.

use super::*;
use crate::random::Random;
use crate::tensor::Mat3;
use std::collections::{BTreeMap, BTreeSet};

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

/// Gauss–Legendre with five points on `[0, 1]`, exact up to degree 9: Abramowitz, Stegun, table 25.4.
fn gauss() -> [(f64, f64); 5] {
    let (root, inner) = (70f64.sqrt(), (10.0f64 / 7.0).sqrt());
    let a = (5.0 - 2.0 * inner).sqrt() / 3.0;
    let b = (5.0 + 2.0 * inner).sqrt() / 3.0;
    let (wa, wb) = ((322.0 + 13.0 * root) / 900.0, (322.0 - 13.0 * root) / 900.0);
    let w0 = 128.0 / 225.0;
    [(-b, wb), (-a, wa), (0.0, w0), (a, wa), (b, wb)].map(|(x, w)| (0.5 + 0.5 * x, 0.5 * w))
}

/// The integral of `f` over the reference domain, without the element's own rule: the domain is the union of the
/// cones over its sides, each side is integrated in the same way.
fn integral(e: Element, f: &mut dyn FnMut(Vec3) -> f64) -> f64 {
    if e.dim() == 1 {
        let [a, b] = e.edges()[0].map(|i| e.nodes()[i]);
        let at = |(s, w): (f64, f64)| w * f(a + (b - a) * s) * (b - a).x;
        return gauss().map(at).iter().sum();
    }
    let apex = e.centre();
    let mut sum = 0.0;
    for side in e.sides() {
        let x = side_nodes(side, e.nodes());
        sum += integral(side.element, &mut |eta| {
            let ray = position(side.element, &x, eta) - apex;
            let height = ray.dot(normal(side.element, &x, eta));
            let along = |(s, w): (f64, f64)| w * s.powi(e.dim() as i32 - 1) * f(apex + ray * s);
            height * gauss().map(along).iter().sum::<f64>()
        });
    }
    sum
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
    for e in TABLE {
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
        assert!((2..=MAX_NODES).contains(&e.nnode()) && (1..=3).contains(&e.dim()));
        assert!(e.dim() == 3 || e.nnode() <= MAX_FACET_NODES);
    }
    let names: BTreeSet<_> = TABLE.iter().map(|e| e.name()).collect();
    assert_eq!(names.len(), TABLE.len());
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
    for e in TABLE {
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
    for e in TABLE {
        let family = e.name().trim_end_matches(char::is_numeric);
        let measure = match family {
            "line" => 2.0,
            "tri" => 0.5,
            "quad" => 4.0,
            "tet" => 1.0 / 6.0,
            "hex" => 8.0,
            "wedge" => 1.0,
            _ => panic!("write down the measure of {family}"),
        };
        let sum: f64 = e.full_rule().weights.iter().sum();
        assert_near(e, "Σw", sum, measure, 1e-14);
        assert_near(e, "∫1", integral(e, &mut |_| 1.0), measure, 1e-14);
        assert_eq!(e.full_rule().points.len(), e.full_rule().weights.len());
        assert!(e.full_rule().points.iter().all(|p| e.contains(p, 0.0)));
        assert!(e.full_rule().weights.iter().all(|&w| w > 0.0));
    }
}

#[test]
fn full_rule_integrates_the_stiffness_of_the_undistorted_element() {
    for e in TABLE {
        for i in 0..e.nnode() {
            for j in 0..=i {
                for (a, b) in (0..3).flat_map(|a| (0..3).map(move |b| (a, b))) {
                    let mut product = |xi: Vec3| {
                        let dn = dshape(e, xi);
                        dn[i][a] * dn[j][b]
                    };
                    let exact = integral(e, &mut product);
                    let rule: f64 = e.full_rule().iter().map(|(p, w)| w * product(*p)).sum();
                    assert_near(e, "∫N_i,a N_j,b", rule, exact, 1e-14);
                }
            }
        }
    }
}

#[test]
fn distorted_volume_is_determinant_times_measure() {
    let mut random = Random(2);
    for e in TABLE {
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
    for e in TABLE {
        assert!(!e.contains(&(Vec3::unit(0) * f64::NAN), 1.0), "{e:?}");
    }
}

#[test]
fn sides_are_one_dimension_lower_and_carry_the_trace() {
    for e in TABLE {
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
    for e in TABLE {
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
    for e in TABLE.into_iter().filter(|e| e.dim() > 1) {
        for bend in [0.0, 0.1, 0.2] {
            let a = random.distortion(e.dim());
            let mut bent = |&p: &Vec3| a * (p + random.cube(e.dim()) * bend);
            let x: Vec<Vec3> = e.nodes().iter().map(&mut bent).collect();
            let volume = integral(e, &mut |xi| jacobian(e, &x, xi));
            assert!(volume > 0.0);
            let (mut area, mut flux) = ([0.0; 3], 0.0);
            for side in e.sides() {
                let nodes = side_nodes(side, &x);
                let n = |eta| normal(side.element, &nodes, eta);
                for (axis, area) in area.iter_mut().enumerate() {
                    *area += integral(side.element, &mut |eta| n(eta)[axis]);
                }
                flux += integral(side.element, &mut |eta| {
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
    for e in TABLE.into_iter().filter(|e| e.dim() == 2) {
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
    for e in TABLE.into_iter().filter(|e| e.dim() == 3) {
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
    for e in TABLE.into_iter().filter(|e| e.dim() > 1) {
        let expected: &[&[usize]] = match e.name().trim_end_matches(char::is_numeric) {
            "tri" => &[&[1, 2], &[2, 3], &[3, 1]],
            "quad" => &[&[1, 2], &[2, 3], &[3, 4], &[4, 1]],
            "tet" => &[&[1, 2, 3], &[1, 4, 2], &[2, 4, 3], &[3, 4, 1]],
            "hex" => &[
                &[1, 2, 3, 4],
                &[5, 8, 7, 6],
                &[1, 5, 6, 2],
                &[2, 6, 7, 3],
                &[3, 7, 8, 4],
                &[4, 8, 5, 1],
            ],
            "wedge" => &[
                &[1, 2, 3],
                &[4, 5, 6],
                &[1, 2, 5, 4],
                &[2, 3, 6, 5],
                &[3, 1, 4, 6],
            ],
            family => panic!("write down the sides of {family}"),
        };
        assert_eq!(e.sides().len(), expected.len());
        for (side, expected) in e.sides().iter().zip(expected) {
            let corners = side.element.edges().iter().flatten();
            let corners: BTreeSet<usize> = corners.map(|&i| side.nodes[i] + 1).collect();
            assert_eq!(corners, expected.iter().copied().collect(), "{e:?}");
        }
    }
}
