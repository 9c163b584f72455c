//! Conformance of surfaces: the jet against differences, the projection against brute force.

use super::*;
use crate::element::testing::CUBIC;
use crate::element::{Element, Family, TABLE, by_name};
use crate::mesh::{Face, Mesh, NodeId};
use crate::proximity::Aabb;
use crate::random::Random;
use crate::tensor::Vec3;

mod analytical;
mod polynomial;
mod ray;
mod signed_distance;
mod triangulated;

/// Every element that can be a facet, and made-up ones of degree 3.
fn kinds() -> impl Iterator<Item = Element> {
    TABLE.into_iter().chain(CUBIC).filter(|e| e.dim() < 3)
}

/// How far the nodes of a facet of about unit size are moved: the less, the closer they are.
fn warp(element: Element) -> f64 {
    match element.order() {
        1 => 0.25,
        2 => 0.2,
        _ => 0.1,
    }
}

/// One facet on its own.
fn single(element: Element) -> (Facets, Vec<Vec3>) {
    let n = element.nnode() as u32;
    let surface = Facets::connected(vec![element], vec![0, n], (0..n).collect(), Vec::new());
    (surface.unwrap(), element.nodes().to_vec())
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
        let size = if is_triangle(element) { 1.0 } else { 0.5 };
        x[node as usize] = *xi * size + moved;
    }
    x
}

fn is_triangle(element: Element) -> bool {
    element.family() == Family::Triangle
}

/// The point of the domain at `(u, v)` of the unit square.
fn in_domain(element: Element, u: f64, v: f64) -> Vec3 {
    match element.family() {
        Family::Line => Vec3::new(2.0 * u - 1.0, 0.0, 0.0),
        Family::Triangle => Vec3::new(u * (1.0 - v), v, 0.0),
        _ => Vec3::new(2.0 * u - 1.0, 2.0 * v - 1.0, 0.0),
    }
}

#[test]
fn jet_matches_differences_on_warped_facets() {
    let mut random = Random(1);
    for element in kinds() {
        let name = element.name();
        let (surface, points) = single(element);
        for _ in 0..50 {
            let x = shaped(&surface, points.len(), &mut random, warp(element));
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

/// The distance to a facet.
fn brute_force(element: Element, x: &[Vec3], nodes: &[NodeId], point: Vec3) -> f64 {
    let mut shape = vec![0.0; element.nnode()];
    smallest(|u, v| {
        element.shape(&in_domain(element, u, v), &mut shape);
        let y: Vec3 = nodes
            .iter()
            .zip(&shape)
            .map(|(&n, &s)| x[n as usize] * s)
            .sum();
        (point - y).norm()
    })
}

/// The smallest value over the unit square, by a grid that zooms into each of its local minima.
fn smallest(mut distance: impl FnMut(f64, f64) -> f64) -> f64 {
    const N: usize = 24;
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
    let mut features = [0usize; 3];
    for element in kinds() {
        let name = element.name();
        let (surface, points) = single(element);
        let rounds = match (element.order(), element.family()) {
            (1, Family::Quadrilateral) => 6000,
            (1, _) => 2000,
            _ => 1000,
        };
        let mut round = 0;
        while round < rounds {
            let x = shaped(&surface, points.len(), &mut random, warp(element));
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
            if (found.distance - expected).abs() >= 1e-9 {
                eprintln!(
                    "{name} {round}: {} {expected} {:?}",
                    found.distance, found.feature
                );
            }
            assert!(((point - jet.position).norm() - found.distance).abs() < 1e-14);
            features[match found.feature {
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
    assert!(features.iter().all(|&k| k > 500), "{features:?}");
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
    let areas = surface.nodal_areas(&x, &|_, _, _| 1.0).unwrap();
    let total: f64 = areas.iter().map(|a| a.1).sum();
    assert!((total - 3.0).abs() < 1e-14);
    assert!((areas[0].1 - 0.25).abs() < 1e-15);
    let at = Placement { x: &x, poses: &[] };
    assert!((surface.size(&at, 1) - 1.0).abs() < 1e-14);
}

#[test]
fn a_box_contains_its_curved_facet_which_its_nodes_do_not_bound() {
    let mut random = Random(11);
    for element in kinds() {
        let name = element.name();
        let (surface, points) = single(element);
        let mut beyond_nodes = 0;
        for _ in 0..100 {
            let x = shaped(&surface, points.len(), &mut random, 2.0 * warp(element));
            let at = Placement { x: &x, poses: &[] };
            let aabb = surface.aabb(&at, 0).inflated(1e-14);
            let of_nodes = Aabb::around(surface.nodes(0).iter().map(|&n| x[n as usize]));
            let of_nodes = of_nodes.inflated(1e-14);
            let mut shape = vec![0.0; element.nnode()];
            for k in 0..400 {
                let (u, v) = (f64::from(k % 20) / 19.0, f64::from(k / 20) / 19.0);
                element.shape(&in_domain(element, u, v), &mut shape);
                let nodes = surface.nodes(0).iter().zip(&shape);
                let y: Vec3 = nodes.map(|(&n, &s)| x[n as usize] * s).sum();
                assert!(aabb.contains(y), "{name}");
                beyond_nodes += usize::from(!of_nodes.contains(y));
            }
        }
        let straight = element.is_linear();
        assert_eq!(beyond_nodes == 0, straight, "{name}");
    }
}

/// SOURCE: Zienkiewicz, Taylor, *The Finite Element Method*, vol. 1, section on mass lumping: 3/57 and 16/57 of the
/// triangle of six nodes, 3/76 and 16/76 of the quadrilateral of eight.
#[test]
fn lumped_areas_are_positive_and_sum_to_the_area() {
    let mut random = Random(12);
    for element in kinds() {
        let name = element.name();
        let (surface, points) = single(element);
        for amount in [0.0, 0.1, warp(element)] {
            let x = shaped(&surface, points.len(), &mut random, amount);
            let extent = |_, _: &[f64], p: Vec3| 2.0 + p.x;
            let consistent = surface.nodal_areas(&x, &extent).unwrap();
            let lumped = surface.lumped_areas(&x, &extent).unwrap();
            let sum = |areas: &[(NodeId, f64)]| areas.iter().map(|a| a.1).sum::<f64>();
            let total = sum(&consistent);
            assert!((sum(&lumped) - total).abs() < 1e-14 * total, "{name}");
            assert!(lumped.iter().all(|a| a.1 > 0.005 * total), "{name}");
            let straight = element.is_linear();
            assert_eq!(lumped == consistent, straight, "{name}");
        }
        let x = shaped(&surface, points.len(), &mut random, 0.0);
        let areas = surface.lumped_areas(&x, &|_, _, _| 1.0).unwrap();
        let of = |i: usize| {
            let node = surface.nodes(0)[i];
            areas.iter().find(|a| a.0 == node).unwrap().1
        };
        let (corner, mid) = match name {
            "tri6" => (0.5 * 3.0 / 57.0, 0.5 * 16.0 / 57.0),
            "quad8" => (3.0 / 76.0, 16.0 / 76.0),
            "quad9" => (1.0 / 36.0, 1.0 / 9.0),
            "line3" => (1.0 / 6.0, 2.0 / 3.0),
            _ => continue,
        };
        assert!((of(0) - corner).abs() < 1e-15, "{name}: {}", of(0));
        let found = of(element.ncorner());
        assert!((found - mid).abs() < 1e-15, "{name}: {found}");
    }
}

/// A solid of every element, its nodes moved: where the map from its reference domain is one to one, a point is inside
/// if and only if its parameters are.
#[test]
fn inside_and_outside_are_distinguished_across_faces_edges_and_vertices() {
    let mut random = Random(13);
    for element in TABLE.into_iter().filter(|e| e.dim() > 1) {
        let dim = element.dim();
        let mut kinds = [[0; 3]; 2];
        for _ in 0..100 {
            let mut mesh = Mesh::default();
            let slope = random.vector() * 0.1;
            for xi in element.nodes() {
                let mut moved = random.vector() * (0.3 * warp(element));
                // all of it bends, so that corners are no special points of a face
                moved += Vec3::new(xi.y * xi.y, xi.z * xi.z, xi.x * xi.x) * slope.x;
                if dim == 2 {
                    moved.z = 0.0;
                }
                mesh.points.push(*xi + moved);
            }
            mesh.node_labels = (1..=mesh.points.len() as u64).collect();
            let nodes: Vec<NodeId> = (0..element.nnode() as NodeId).collect();
            let cell = mesh.push_cell(element, &nodes, 1);
            let faces: Vec<Face> = (0..element.sides().len() as u8)
                .map(|side| Face { cell, side })
                .collect();
            let surface = Facets::new(&mesh, &faces).unwrap();
            let at = Placement {
                x: &mesh.points,
                poses: &[],
            };
            let mut shape = vec![0.0; element.nnode()];
            for k in 0..40 {
                let hull: Vec<f64> = element.nodes().iter().map(|_| random.unit()).collect();
                let sum: f64 = hull.iter().sum();
                let weighted = element.nodes().iter().zip(&hull);
                let xi: Vec3 = weighted.map(|(&p, &w)| p * (w / sum)).sum();
                let centre = element.centre();
                // from the centre through the point, to either side of the boundary
                let mut far = 1.0;
                while element.contains(&(centre + (xi - centre) * far), 0.0) {
                    far *= 1.02;
                }
                let inside = k % 2 == 0;
                let xi = centre + (xi - centre) * (far * if inside { 0.95 } else { 1.1 });
                element.shape(&xi, &mut shape);
                let point: Vec3 = mesh.points.iter().zip(&shape).map(|(&x, &n)| x * n).sum();
                let mut jet = SurfaceJet::default();
                let found = (0..surface.nfacet() as u32)
                    .filter_map(|f| surface.project(&at, f, point, None, &mut jet).unwrap())
                    .min_by(|a, b| a.distance.total_cmp(&b.distance))
                    .unwrap();
                surface.jet(&at, &found.anchor, &mut jet).unwrap();
                let outward = surface.outward(&at, &found).unwrap();
                assert!(!outward.rim, "{element:?}");
                let side = outward.direction.dot(point - jet.position);
                assert_eq!(side < 0.0, inside, "{element:?} {found:?} {side}");
                let feature = match found.feature {
                    Feature::Face => 0,
                    Feature::Edge { .. } => 1,
                    Feature::Vertex => 2,
                };
                kinds[usize::from(inside)][feature] += 1;
            }
        }
        // a convex solid is closest to its faces from inside
        let [outside, inside] = kinds;
        assert!(
            inside[0] == 2000 && outside[0] > 1000,
            "{element:?} {kinds:?}"
        );
        assert!(outside[1] + outside[2] > 50, "{element:?} {kinds:?}");
    }
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

/// Facets that count how often their places are evaluated.
struct Counted<'a>(&'a Facets, std::sync::atomic::AtomicUsize);

impl ContactSurface for Counted<'_> {
    fn ntan(&self) -> usize {
        self.0.ntan()
    }

    fn nfacet(&self) -> usize {
        ContactSurface::nfacet(self.0)
    }

    fn carrier(&self, facet: u32) -> Carrier<'_> {
        self.0.carrier(facet)
    }

    fn aabb(&self, at: &Placement, facet: u32) -> Aabb {
        self.0.aabb(at, facet)
    }

    fn size(&self, at: &Placement, facet: u32) -> f64 {
        self.0.size(at, facet)
    }

    fn jet(
        &self,
        at: &Placement,
        point: &Anchor,
        out: &mut SurfaceJet,
    ) -> Result<(), SurfaceError> {
        self.1.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        self.0.jet(at, point, out)
    }

    fn domain(&self, facet: u32) -> Option<Element> {
        self.0.domain(facet)
    }

    fn neighbours(&self, facet: u32) -> &[u32] {
        self.0.neighbours(facet)
    }

    fn crossing(&self, at: &Placement, facet: u32, origin: Vec3, direction: Vec3) -> Option<f64> {
        self.0.crossing(at, facet, origin, direction)
    }

    fn outward(&self, at: &Placement, found: &Projection) -> Result<Outward, SurfaceError> {
        self.0.outward(at, found)
    }
}

#[test]
fn facets_that_bend_little_are_evaluated_few_times_for_a_closest_point() {
    let mut random = Random(11);
    // over the face, and beyond its edges
    for (name, over, beyond) in [
        ("tri3", 8, 12),
        ("tri6", 12, 32),
        ("quad4", 10, 14),
        ("quad8", 14, 43),
    ] {
        let (facets, points) = single(by_name(name).unwrap());
        let surface = Counted(&facets, Default::default());
        let (mut counts, rounds) = ([0; 2], 200);
        for _ in 0..rounds {
            let x = shaped(&facets, points.len(), &mut random, 0.005);
            let element = facets.element(0).unwrap();
            let at = Placement { x: &x, poses: &[] };
            let inner = in_domain(
                element,
                0.3 + 0.2 * random.unit(),
                0.3 + 0.2 * random.unit(),
            );
            for (place, count) in [inner, inner + Vec3::new(2.0, 1.0, 0.0)]
                .into_iter()
                .zip(&mut counts)
            {
                let mut jet = SurfaceJet::default();
                let anchor = Anchor {
                    facet: 0,
                    local: place,
                };
                facets.jet(&at, &anchor, &mut jet).unwrap();
                let point = jet.position + jet.normal * (0.4 * random.unit() - 0.2);
                surface.1.store(0, std::sync::atomic::Ordering::Relaxed);
                surface
                    .project(&at, 0, point, None, &mut jet)
                    .unwrap()
                    .unwrap();
                *count += surface.1.load(std::sync::atomic::Ordering::Relaxed);
            }
        }
        let means = counts.map(|count| count / rounds);
        println!("{name}: {means:?}");
        assert!(means[0] <= over && means[1] <= beyond, "{name}: {means:?}");
    }
}
