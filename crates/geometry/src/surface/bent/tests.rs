use super::*;
use crate::element::by_name;
use crate::mesh::{Mesh, boundary};
use crate::random::Random;
use std::f64::consts::FRAC_PI_2;

/// Lines between points in turn, with the body on the left; at the end of a closed one the first comes again.
fn polyline(points: &[Vec3], inward: f64, closed: bool) -> (Facets, Vec<Vec3>) {
    let mut mesh = Mesh::default();
    let n = points.len() as u32;
    let centre = Vec3::ZERO;
    mesh.points = points.to_vec();
    let inner = points.iter().map(|&p| p + (centre - p) * inward);
    mesh.points.extend(inner);
    mesh.node_labels = (1..=u64::from(2 * n)).collect();
    let quad = by_name("quad4").unwrap();
    let last = if closed { n } else { n - 1 };
    for k in 0..last {
        let (a, b) = (k, (k + 1) % n);
        mesh.push_cell(quad, &[a, b, b + n, a + n], u64::from(k) + 1);
    }
    let mut faces = boundary(&mesh, mesh.cells(2));
    faces.retain(|&f| mesh.face(f).unwrap().1.iter().all(|&node| node < n));
    (Facets::new(&mesh, &faces).unwrap(), mesh.points)
}

/// The outer faces of a layer of bricks below the surface `at(u, v)` over a grid.
fn grid(us: &[f64], vs: &[f64], at: impl Fn(f64, f64) -> (Vec3, Vec3)) -> (Facets, Vec<Vec3>) {
    let mut mesh = Mesh::default();
    let nu = us.len() as u32;
    let n = nu * vs.len() as u32;
    for layer in 0..2 {
        for &v in vs {
            for &u in us {
                let (x, normal) = at(u, v);
                mesh.points.push(x - normal * (0.1 * f64::from(layer)));
            }
        }
    }
    mesh.node_labels = (1..=u64::from(2 * n)).collect();
    let hex = by_name("hex8").unwrap();
    for j in 0..vs.len() as u32 - 1 {
        for i in 0..nu - 1 {
            let a = i + nu * j;
            let face = [a, a + 1, a + 1 + nu, a + nu];
            let cell = [face.map(|k| k + n), face].concat();
            mesh.push_cell(hex, &cell, u64::from(a) + 1);
        }
    }
    let mut faces = boundary(&mesh, mesh.cells(3));
    faces.retain(|&f| mesh.face(f).unwrap().1.iter().all(|&node| node < n));
    (Facets::new(&mesh, &faces).unwrap(), mesh.points)
}

/// The largest error of bent facets, and the largest rise that is due, by the distance of points from the true surface:
/// positive outside of it.
fn errors(facets: &Facets, x: &[Vec3], outside: impl Fn(Vec3) -> f64) -> [f64; 2] {
    let bent = Bent::new(facets, x);
    let at = Placement { x, poses: &[] };
    let mut jet = SurfaceJet::default();
    let (mut error, mut due) = (0.0f64, 0.0f64);
    for facet in 0..facets.nfacet() as u32 {
        let element = facets.element(facet).unwrap();
        for (local, _) in element.surface_rule().iter() {
            let anchor = Anchor {
                facet,
                local: *local,
            };
            facets.jet(&at, &anchor, &mut jet).unwrap();
            let rise = bent.rise(facet, *local);
            error = error.max(outside(jet.position + jet.normal * rise).abs());
            due = due.max(outside(jet.position).abs());
        }
    }
    [error, due]
}

#[test]
fn lines_of_unequal_lengths_along_a_circle_bend_to_it_from_either_side() {
    for n in [12, 24, 48] {
        let step = |k: u32| FRAC_PI_2 / f64::from(n) * (f64::from(k) + 0.3 * f64::from(k % 2));
        let angles: Vec<f64> = (0..=n).map(step).collect();
        let at = |a: &f64| Vec3::new(2.0 * a.cos(), 2.0 * a.sin(), 0.0);
        let outer: Vec<Vec3> = angles.iter().map(at).collect();
        let inner: Vec<Vec3> = angles.iter().rev().map(at).collect();
        for (points, inward, sign) in [(outer, 0.1, 1.0), (inner, -0.1, -1.0)] {
            let (facets, x) = polyline(&points, inward, false);
            let [error, due] = errors(&facets, &x, |p| sign * (p.norm() - 2.0));
            assert!(error < 3e-3 * due, "{n}: {error:e} of {due:e}");
        }
    }
}

#[test]
fn a_disc_of_twelve_sides_is_round_and_a_block_is_not() {
    let ring = |n: u32, turn: f64| -> Vec<Vec3> {
        let angle = |k: u32| f64::from(k) * 4.0 * FRAC_PI_2 / f64::from(n) + turn;
        (0..n)
            .map(|k| Vec3::new(angle(k).cos(), angle(k).sin(), 0.0))
            .collect()
    };
    let (facets, x) = polyline(&ring(12, 0.5), 0.1, true);
    let [error, due] = errors(&facets, &x, |p| p.norm() - 1.0);
    assert!(error < 0.015 * due, "{error:e} of {due:e}");
    let (facets, x) = polyline(&ring(8, 0.5), 0.1, true);
    let bent = Bent::new(&facets, &x);
    assert!((0..8).all(|f| bent.sagitta(f) == 0.0));
}

#[test]
fn faces_of_a_cylinder_bend_across_its_axis_up_to_the_ends_of_the_mesh() {
    for (nv, skew) in [(1, 0.0), (1, 0.01), (3, 0.0), (3, 0.02)] {
        let us: Vec<f64> = (0..=12).map(|k| f64::from(k) * FRAC_PI_2 / 12.0).collect();
        let vs: Vec<f64> = (0..=nv).map(|k| 0.2 * f64::from(k)).collect();
        let at = |u: f64, v: f64| {
            let u = u + skew * (7.0 * (u + v)).sin();
            let normal = Vec3::new(u.cos(), u.sin(), 0.0);
            (normal * 1.5 + Vec3::unit(2) * v, normal)
        };
        let (facets, x) = grid(&us, &vs, at);
        let [error, due] = errors(&facets, &x, |p| p.x.hypot(p.y) - 1.5);
        let allowed = if skew > 0.0 { 0.05 } else { 0.005 };
        assert!(error < allowed * due, "{nv} {skew}: {error:e} of {due:e}");
    }
}

#[test]
fn faces_and_triangles_of_a_sphere_bend_to_it() {
    let mut random = Random(3);
    let us: Vec<f64> = (0..=8).map(|k| f64::from(k) * 0.1).collect();
    let mut at = BTreeMap::new();
    let n = us.len();
    for j in 0..n {
        for i in 0..n {
            let mut off = || 0.02 * (random.unit() - 0.5);
            at.insert((i, j), (us[i] + off(), us[j] + off()));
        }
    }
    let place = |u: f64, v: f64| {
        let k = |c: f64| (10.0 * c).round() as usize;
        let (u, v) = at[&(k(u), k(v))];
        let normal = Vec3::new(v.cos() * u.cos(), v.cos() * u.sin(), v.sin());
        (normal * 3.0, normal)
    };
    let (facets, x) = grid(&us, &us, place);
    let [error, due] = errors(&facets, &x, |p| p.norm() - 3.0);
    assert!(error < 0.02 * due, "faces: {error:e} of {due:e}");
    let n = n as u32;
    // diagonals in turn, and all the same way, with corners of a single triangle
    for turn in [2, n * n] {
        let mut triangles = Vec::new();
        for j in 0..n - 1 {
            for i in 0..n - 1 {
                let a = i + n * j;
                let [b, c, d] = [a + 1, a + 1 + n, a + n];
                triangles.extend(if (i + j) % turn == 0 {
                    [[a, b, c], [a, c, d]]
                } else {
                    [[a, b, d], [b, c, d]]
                });
            }
        }
        let facets = Facets::of_triangles(&triangles).unwrap();
        let [error, due] = errors(&facets, &x, |p| p.norm() - 3.0);
        assert!(error < 0.02 * due, "triangles: {error:e} of {due:e}");
    }
}

#[test]
fn what_bending_misses_is_of_a_higher_order_than_what_it_removes() {
    let error = |n: u32| {
        let step = |k: u32| f64::from(k) * 0.8 / f64::from(n);
        let us: Vec<f64> = (0..=n).map(step).collect();
        // an ellipsoid, whose curvature varies
        let at = |u: f64, v: f64| {
            let s = Vec3::new(v.cos() * u.cos(), v.cos() * u.sin(), v.sin());
            let x = Vec3::new(2.0 * s.x, 3.0 * s.y, 4.0 * s.z);
            let normal = Vec3::new(s.x / 2.0, s.y / 3.0, s.z / 4.0);
            (x, normal.normalized().unwrap())
        };
        let (facets, x) = grid(&us, &us, at);
        let outside = |p: Vec3| {
            let q = Vec3::new(p.x / 2.0, p.y / 3.0, p.z / 4.0);
            let slope = Vec3::new(q.x / 2.0, q.y / 3.0, q.z / 4.0);
            (q.norm_squared() - 1.0) / (2.0 * slope.norm())
        };
        errors(&facets, &x, outside)
    };
    let [coarse, fine] = [error(8), error(16)];
    assert!(coarse[0] < 0.1 * coarse[1], "{coarse:?}");
    assert!((coarse[1] / fine[1]).log2() > 1.8);
    assert!((coarse[0] / fine[0]).log2() > 2.7, "{coarse:?} {fine:?}");
}

#[test]
fn flat_faces_and_sides_of_edges_do_not_rise() {
    let us = [0.0, 0.1, 0.3, 0.6];
    let flat = |u: f64, v: f64| (Vec3::new(u, v, 0.3 * u - 0.2 * v), Vec3::unit(2));
    let roof = |u: f64, v: f64| (Vec3::new(u, v, -(u - 0.3).abs()), Vec3::unit(2));
    for surface in [&flat as &dyn Fn(f64, f64) -> (Vec3, Vec3), &roof] {
        let (facets, x) = grid(&us, &us, surface);
        let bent = Bent::new(&facets, &x);
        let most = (0..facets.nfacet() as u32).map(|f| bent.sagitta(f));
        assert!(most.fold(0.0, f64::max) < 1e-14);
    }
}

#[test]
fn rises_vanish_at_corners_and_agree_along_shared_edges() {
    let us: Vec<f64> = (0..=4).map(|k| 0.2 * f64::from(k)).collect();
    let at = |u: f64, v: f64| {
        let normal = Vec3::new(v.cos() * u.cos(), v.cos() * u.sin(), v.sin());
        (normal, normal)
    };
    let (facets, x) = grid(&us, &us, at);
    let bent = Bent::new(&facets, &x);
    let mut middles: BTreeMap<[NodeId; 2], Vec<f64>> = BTreeMap::new();
    for facet in 0..facets.nfacet() as u32 {
        let element = facets.element(facet).unwrap();
        let (nodes, local) = (facets.nodes(facet), element.nodes());
        for (k, &at) in local.iter().enumerate() {
            assert!(bent.rise(facet, at).abs() < 1e-15, "{k}");
        }
        for &[a, b] in element.edges() {
            let rise = bent.rise(facet, (local[a] + local[b]) * 0.5);
            let key = [nodes[a].min(nodes[b]), nodes[a].max(nodes[b])];
            middles.entry(key).or_default().push(rise);
        }
    }
    let shared = middles.values().filter(|rises| rises.len() == 2);
    assert!(shared.clone().count() > 10);
    for rises in shared {
        // normals of the two facets differ by the turn of the edge
        assert!((rises[0] / rises[1] - 1.0).abs() < 0.02, "{rises:?}");
    }
}
