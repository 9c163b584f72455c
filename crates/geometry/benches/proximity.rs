//! Search and closest points: `cargo bench -p signorini-geometry`.
#![allow(missing_docs, clippy::unwrap_used)]

use criterion::{Criterion, criterion_group, criterion_main};
use signorini_geometry::element::by_name;
use signorini_geometry::mesh::{Mesh, NodeId, boundary};
use signorini_geometry::proximity::{Aabb, Bvh, Search};
use signorini_geometry::surface::{
    ContactSurface, Facets, Placement, Shape, Side, SurfaceJet, Torus,
};
use signorini_geometry::tensor::Vec3;
use std::hint::black_box;

/// Facets along each side of the surface.
const N: u32 = 64;

/// A wavy layer of hexahedra with `N × N` facets on its upper side.
fn layer() -> (Mesh, Facets) {
    let mut mesh = Mesh::default();
    for k in 0..2 {
        for j in 0..=N {
            for i in 0..=N {
                let [x, y] = [i, j].map(|n| f64::from(n) / f64::from(N));
                let wave = 0.02 * (9.0 * x).sin() * (7.0 * y).cos();
                mesh.points.push(Vec3::new(x, y, 0.1 * f64::from(k) + wave));
                mesh.node_labels.push(mesh.points.len() as u64);
            }
        }
    }
    let hex8 = by_name("hex8").unwrap();
    let node = |i, j, k| i + (N + 1) * (j + (N + 1) * k);
    for j in 0..N {
        for i in 0..N {
            let ring = |k| {
                [
                    node(i, j, k),
                    node(i + 1, j, k),
                    node(i + 1, j + 1, k),
                    node(i, j + 1, k),
                ]
            };
            mesh.push_cell(hex8, &[ring(0), ring(1)].concat(), u64::from(i + N * j + 1));
        }
    }
    let top: Vec<NodeId> = (0..=N)
        .flat_map(|j| (0..=N).map(move |i| node(i, j, 1)))
        .collect();
    let faces = mesh.faces_among(&boundary(&mesh, mesh.cells(3)), &top);
    let surface = Facets::new(&mesh, &faces).unwrap();
    (mesh, surface)
}

/// Points above the surface, spread without a pattern.
fn points() -> Vec<Vec3> {
    let at = |n: u32| {
        let n = f64::from(n);
        Vec3::new((0.618_034 * n).fract(), (0.754_878 * n).fract(), 0.14)
    };
    (0..1000).map(at).collect()
}

fn search(c: &mut Criterion) {
    let (mesh, surface) = layer();
    let at = Placement {
        x: &mesh.points,
        poses: &[],
    };
    let boxes: Vec<Aabb> = (0..surface.nfacet() as u32)
        .map(|f| surface.aabb(&at, f))
        .collect();
    let points = points();
    c.bench_function("build a tree over 4096 boxes", |b| {
        b.iter(|| Bvh::build(black_box(&boxes)))
    });
    let tree = Bvh::build(&boxes);
    let mut found = Vec::new();
    c.bench_function("query it at 1000 points", |b| {
        b.iter(|| {
            for point in &points {
                tree.query(black_box(*point), 0.05, &mut found);
            }
        });
    });
    c.bench_function("collect candidates of 1000 points", |b| {
        b.iter(|| {
            let mut search = Search::default();
            search.update(&points, &boxes, 0.05, 0.02, &|_, _| true);
            search.candidates().npair()
        });
    });
}

fn projection(c: &mut Criterion) {
    let (mesh, surface) = layer();
    let at = Placement {
        x: &mesh.points,
        poses: &[],
    };
    let points = points();
    let mut jet = SurfaceJet::default();
    c.bench_function("project 1000 points on a quad4 facet", |b| {
        b.iter(|| {
            for (facet, point) in (0..).zip(&points) {
                let found = surface.project(&at, facet, black_box(*point), None, &mut jet);
                black_box(found.unwrap());
            }
        });
    });
    let torus = Torus::new(Vec3::ZERO, Vec3::unit(2), 1.0, 0.3, Side::Outside).unwrap();
    c.bench_function("project 1000 points on a torus", |b| {
        b.iter(|| {
            for point in &points {
                black_box(torus.closest(black_box(*point)).unwrap());
            }
        });
    });
}

criterion_group!(benches, search, projection);
criterion_main!(benches);
