//! Time of the search for facets that face one another: fifty balls, from 4,800 to 58,800 facets.
#![allow(missing_docs, clippy::unwrap_used)]

#[allow(dead_code)]
#[path = "../tests/facing/skins.rs"]
mod skins;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use signorini_geometry::mesh::CellId;
use signorini_mechanics::facing::{Finder, Skin};

fn facing(c: &mut Criterion) {
    let mut group = c.benchmark_group("facing");
    group.sample_size(20);
    for n in [4, 8, 14] {
        let of = skins::balls(50, n);
        let cells: Vec<CellId> = of.mesh.cells(3).collect();
        let skin = || Skin::new(&of.mesh, &cells, |_| false).unwrap();
        let nfacet = skin().size().len() as u64;
        group.throughput(Throughput::Elements(nfacet));
        group.bench_function(BenchmarkId::new("skin", nfacet), |b| b.iter(skin));
        let mut finder = Finder::new(skin());
        group.bench_function(BenchmarkId::new("find", nfacet), |b| {
            b.iter(|| finder.find(&of.mesh.points, &[]).len());
        });
    }
    group.finish();
}

criterion_group!(benches, facing);
criterion_main!(benches);
