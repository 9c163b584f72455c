//! Conformance of surfaces: the jet against differences, the projection against brute force.

use super::*;
use crate::element::by_name;
use crate::mesh::{Face, Mesh};
use crate::random::Random;

/// One facet on its own: a cell of dimension one higher is not needed to make a surface of it.
fn single(element: Element) -> (Facets, Vec<Vec3>) {
    // a solid whose first suitable side is the facet
    let parent = ["quad4", "tet4", "hex8"]
        .into_iter()
        .filter_map(by_name)
        .find(|p| p.sides().iter().any(|s| *s.element == *element))
        .unwrap();
    let side = parent
        .sides()
        .iter()
        .position(|s| *s.element == *element)
        .unwrap();
    let mut mesh = Mesh::default();
    for (i, x) in parent.nodes().iter().enumerate() {
        mesh.points.push(*x);
        mesh.node_labels.push(i as u64 + 1);
    }
    let nodes: Vec<NodeId> = (0..parent.nnode() as NodeId).collect();
    let cell = mesh.push_cell(parent, &nodes, 1);
    let face = Face {
        cell,
        side: side as u8,
    };
    (Facets::new(&mesh, &[face]).unwrap(), mesh.points)
}

/// A facet of about unit size with its nodes moved by up to `amount`; in the plane where it is a line.
fn shaped(surface: &Facets, n: usize, random: &mut Random, amount: f64) -> Vec<Vec3> {
    let element = surface.element(0).unwrap();
    let mut x = vec![Vec3::ZERO; n];
    for (xi, &node) in element.nodes().iter().zip(surface.nodes(0)) {
        let mut moved = random.vector() * amount;
        if element.dim() == 1 {
            moved.z = 0.0;
        }
        let flat = if element.name() == "quad4" || element.dim() == 1 {
            *xi * 0.5
        } else {
            *xi
        };
        x[node as usize] = flat + moved;
    }
    x
}

#[test]
fn jet_matches_differences_on_warped_facets() {
    let mut random = Random(1);
    for name in ["line2", "tri3", "quad4"] {
        let (surface, points) = single(by_name(name).unwrap());
        for _ in 0..50 {
            let x = shaped(&surface, points.len(), &mut random, 0.25);
            let at = Placement { x: &x, poses: &[] };
            let local = Vec3::new(0.3 * random.signed(), 0.3 * random.signed(), 0.0);
            let jet_at = |d: Vec3| {
                let mut jet = SurfaceJet::default();
                let anchor = Anchor {
                    facet: 0,
                    local: local + d,
                };
                surface.jet(&at, &anchor, &mut jet).unwrap();
                jet
            };
            let jet = jet_at(Vec3::ZERO);
            let h = 1e-5;
            for a in 0..surface.ntan() {
                let (plus, minus) = (jet_at(Vec3::unit(a) * h), jet_at(Vec3::unit(a) * -h));
                let slope = (plus.position - minus.position) / (2.0 * h);
                assert!((slope - jet.tangent[a]).norm() < 1e-9, "{name} tangent");
                for b in 0..surface.ntan() {
                    let bend = (plus.tangent[b] - minus.tangent[b]) / (2.0 * h);
                    assert!(
                        (bend - jet.curvature[pair(a, b)]).norm() < 1e-9,
                        "{name} curvature"
                    );
                    let metric = jet.tangent[a].dot(jet.tangent[b]);
                    assert!((metric - jet.metric[pair(a, b)]).abs() < 1e-15);
                }
                assert!(jet.normal.dot(jet.tangent[a]).abs() < 1e-14);
            }
            assert!((jet.normal.norm() - 1.0).abs() < 1e-14);
            let sum: f64 = jet.shape[..jet.nnode].iter().sum();
            assert!((sum - 1.0).abs() < 1e-14);
        }
    }
}

/// The distance to a facet by a grid that zooms into each of its local minima.
fn brute_force(element: Element, x: &[Vec3], nodes: &[NodeId], point: Vec3) -> f64 {
    const N: usize = 24;
    let mut shape = vec![0.0; element.nnode()];
    let square = element.name() == "quad4";
    let mut distance = |u: f64, v: f64| {
        // (u, v) in the unit square to the domain
        let xi = if square {
            Vec3::new(2.0 * u - 1.0, 2.0 * v - 1.0, 0.0)
        } else if element.dim() == 1 {
            Vec3::new(2.0 * u - 1.0, 0.0, 0.0)
        } else {
            Vec3::new(u * (1.0 - v), v, 0.0)
        };
        element.shape(&xi, &mut shape);
        let y: Vec3 = nodes
            .iter()
            .zip(&shape)
            .map(|(&n, &s)| x[n as usize] * s)
            .sum();
        (point - y).norm()
    };
    let at = |k: usize| k as f64 / (N - 1) as f64;
    let mut grid = vec![0.0; N * N];
    for i in 0..N {
        for j in 0..N {
            grid[i * N + j] = distance(at(i), at(j));
        }
    }
    let mut best = f64::INFINITY;
    for i in 0..N {
        for j in 0..N {
            let around = (i.saturating_sub(1)..=(i + 1).min(N - 1))
                .flat_map(|p| (j.saturating_sub(1)..=(j + 1).min(N - 1)).map(move |q| p * N + q));
            if around.into_iter().any(|k| grid[k] < grid[i * N + j]) {
                continue;
            }
            let (mut u, mut v, mut width) = (at(i), at(j), 1.5 / N as f64);
            let mut value = grid[i * N + j];
            // shrink only when nothing around is better: a narrow valley must not be lost
            while width > 1e-11 {
                let (u0, v0) = (u, v);
                for p in -3..=3 {
                    for q in -3..=3 {
                        let (a, b) = (
                            (u0 + width * f64::from(p) / 3.0).clamp(0.0, 1.0),
                            (v0 + width * f64::from(q) / 3.0).clamp(0.0, 1.0),
                        );
                        let d = distance(a, b);
                        if d < value {
                            (value, u, v) = (d, a, b);
                        }
                    }
                }
                if (u, v) == (u0, v0) {
                    width *= 0.3;
                }
            }
            best = best.min(value);
        }
    }
    best
}

#[test]
fn projection_agrees_with_brute_force_on_random_facets() {
    let mut random = Random(7);
    let mut kinds = [0usize; 3];
    for name in ["line2", "tri3", "quad4"] {
        let (surface, points) = single(by_name(name).unwrap());
        let element = surface.element(0).unwrap();
        let rounds = if name == "quad4" { 6000 } else { 2000 };
        let mut round = 0;
        while round < rounds {
            let x = shaped(&surface, points.len(), &mut random, 0.25);
            let mut point = element
                .nodes()
                .iter()
                .zip(surface.nodes(0))
                .map(|(_, &n)| x[n as usize])
                .sum::<Vec3>()
                / element.nnode() as f64;
            point += random.vector() * (0.5 + 3f64.sqrt().recip());
            if element.dim() == 1 {
                point.z = 0.0;
            }
            let at = Placement { x: &x, poses: &[] };
            let expected = brute_force(element, &x, surface.nodes(0), point);
            if expected > 1.0 {
                continue;
            }
            round += 1;
            let mut jet = SurfaceJet::default();
            let found = surface
                .project(&at, 0, point, None, &mut jet)
                .unwrap()
                .unwrap();
            assert!(
                (found.distance - expected).abs() < 1e-9,
                "{name} {round}: {} {expected} {:?}",
                found.distance,
                found.feature
            );
            assert!(((point - jet.position).norm() - found.distance).abs() < 1e-14);
            kinds[match found.feature {
                Feature::Face => 0,
                Feature::Edge { .. } => 1,
                Feature::Vertex => 2,
            }] += 1;
            // the closest point, given as a hint, is found again
            let again = surface
                .project(&at, 0, point, Some(found.anchor), &mut jet)
                .unwrap()
                .unwrap();
            assert!((again.distance - found.distance).abs() < 1e-12);
        }
    }
    assert!(kinds.iter().all(|&k| k > 500), "{kinds:?}");
}

/// A strip of `n` unit squares in the plane z = 0 bent up by `slope` at each joint.
fn strip(n: usize, slope: f64) -> (Facets, Vec<Vec3>) {
    let mut mesh = Mesh::default();
    let mut x = Vec3::ZERO;
    for k in 0..=n {
        for y in 0..2 {
            for z in [0.0, -1.0] {
                mesh.points.push(x + Vec3::new(0.0, f64::from(y), z));
                mesh.node_labels.push(mesh.points.len() as u64);
            }
        }
        let angle = slope * k as f64;
        x += Vec3::new(angle.cos(), 0.0, angle.sin());
    }
    let hex = by_name("hex8").unwrap();
    let mut faces = Vec::new();
    for k in 0..n as NodeId {
        let b = 4 * k;
        let cell = mesh.push_cell(
            hex,
            &[b + 1, b + 5, b + 7, b + 3, b, b + 4, b + 6, b + 2],
            u64::from(k) + 1,
        );
        faces.push(Face { cell, side: 1 });
    }
    (Facets::new(&mesh, &faces).unwrap(), mesh.points)
}

#[test]
fn outward_on_a_ridge_is_between_the_normals_and_a_rim_is_named() {
    let (surface, x) = strip(2, -0.4);
    let at = Placement { x: &x, poses: &[] };
    let mut jet = SurfaceJet::default();
    let ridge = surface
        .project(&at, 0, Vec3::new(1.1, 0.5, 1.0), None, &mut jet)
        .unwrap()
        .unwrap();
    assert!(matches!(ridge.feature, Feature::Edge { .. }));
    let out = surface.outward(&at, &ridge).unwrap();
    assert!(!out.rim);
    let expected = Vec3::unit(2) + Vec3::new(0.4f64.sin(), 0.0, 0.4f64.cos());
    assert!((out.direction - expected).norm() < 1e-12, "{out:?}");

    let rim = surface
        .project(&at, 0, Vec3::new(-0.5, 0.5, 0.1), None, &mut jet)
        .unwrap()
        .unwrap();
    assert!(surface.outward(&at, &rim).unwrap().rim);
    let corner = surface
        .project(&at, 0, Vec3::new(1.05, -0.5, 0.5), None, &mut jet)
        .unwrap()
        .unwrap();
    assert_eq!(corner.feature, Feature::Vertex);
    assert!(surface.outward(&at, &corner).unwrap().rim);
    assert_eq!(surface.neighbours(0), [1]);
}

#[test]
fn nodal_areas_share_the_area_of_the_facets() {
    let (surface, x) = strip(3, 0.0);
    let areas = surface.nodal_areas(&x, &|_| 1.0).unwrap();
    let total: f64 = areas.iter().map(|a| a.1).sum();
    assert!((total - 3.0).abs() < 1e-14);
    assert!((areas[0].1 - 0.25).abs() < 1e-15);
    let at = Placement { x: &x, poses: &[] };
    assert!((surface.size(&at, 1) - 1.0).abs() < 1e-14);
}

#[test]
fn a_folded_facet_is_an_error_and_a_far_point_is_not() {
    let (surface, mut x) = strip(1, 0.0);
    let at = Placement { x: &x, poses: &[] };
    let mut jet = SurfaceJet::default();
    let far = surface.project(&at, 0, Vec3::new(1e9, 0.0, 1e9), None, &mut jet);
    assert!(far.unwrap().is_some());
    x.fill(Vec3::ZERO);
    let at = Placement { x: &x, poses: &[] };
    let folded = surface.project(&at, 0, Vec3::unit(2), None, &mut jet);
    assert_eq!(folded, Err(SurfaceError::Degenerate { facet: 0 }));
}
