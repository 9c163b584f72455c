//! Times of reading and writing large files: `cargo bench -p signorini-io`.
//!
//! Tests assert memory and scanning instead, which do not depend on what else a machine does.
#![allow(missing_docs, clippy::unwrap_used)]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use signorini_geometry::element::by_name;
use signorini_geometry::mesh::Mesh;
use signorini_geometry::tensor::{Sym3, Vec3};
use signorini_io::case::read_case;
use signorini_io::case::vocabulary::{Kinds, Vocabulary};
use signorini_io::fs::{Fs, RealFs};
use signorini_io::readers::{frd, read_mesh, validate};
use signorini_io::writers::frd::{Dataset, FrdFile, Moment};
use std::fmt::Write as _;

/// Measures one thing that reads or writes a file of `size` bytes.
fn timed(c: &mut Criterion, what: &str, size: usize, mut run: impl FnMut()) {
    let mut group = c.benchmark_group("files");
    group
        .sample_size(10)
        .throughput(Throughput::Bytes(size as u64))
        .bench_function(what, |b| b.iter(&mut run));
    group.finish();
}

/// The nodes of a brick of `n³` bricks, and the eight nodes of each of them, from 1.
fn bricks(n: usize) -> (Vec<[f64; 3]>, Vec<[usize; 8]>) {
    let side = n + 1;
    let at = |i: usize| i as f64 / n as f64 + 0.1;
    let nodes = (0..side.pow(3)).map(|k| [at(k % side), at(k / side % side), at(k / side / side)]);
    let cells = (0..n.pow(3)).map(|c| {
        let first = c % n + c / n % n * side + c / n / n * side * side + 1;
        let ring = [0, 1, side + 1, side];
        std::array::from_fn(|k| first + ring[k % 4] + k / 4 * side * side)
    });
    (nodes.collect(), cells.collect())
}

fn gmsh(n: usize) -> String {
    let (nodes, cells) = bricks(n);
    let mut text = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n",
        nodes.len()
    );
    for (number, [x, y, z]) in (1..).zip(&nodes) {
        writeln!(text, "{number} {x} {y} {z}").unwrap();
    }
    write!(text, "$EndNodes\n$Elements\n{}\n", cells.len()).unwrap();
    for (number, nodes) in (1..).zip(&cells) {
        write!(text, "{number} 5 2 1 1").unwrap();
        nodes.iter().for_each(|n| write!(text, " {n}").unwrap());
        text.push('\n');
    }
    text + "$EndElements\n"
}

fn deck(n: usize) -> String {
    let (nodes, cells) = bricks(n);
    let mut text = String::from("*NODE, NSET=all\n");
    for (number, [x, y, z]) in (1..).zip(&nodes) {
        writeln!(text, "{number}, {x:.9}, {y:.9}, {z:.9}").unwrap();
    }
    text += "*ELEMENT, TYPE=C3D8, ELSET=box\n";
    for (number, nodes) in (1..).zip(&cells) {
        write!(text, "{number}").unwrap();
        nodes.iter().for_each(|n| write!(text, ", {n}").unwrap());
        text.push('\n');
    }
    text
}

fn case(nnode: usize) -> String {
    let mut text = String::from("[mesh]\nnodes = [\n");
    for n in 0..nnode {
        let x = n as f64 * 0.001;
        writeln!(text, "  [{n}, {}, {x:.6}, -1.5e-3],", n % 100).unwrap();
    }
    text + "]\nelements = [{ id = 1, type = \"tet4\", group = \"a\", nodes = [0, 1, 2, 3] }]\n\
            [[body]]\ngroup = \"a\"\nrigid = true\n[[step]]\nname = \"s\"\n"
}

fn meshes(c: &mut Criterion) {
    for (name, text) in [("bricks.msh", gmsh(40)), ("bricks.inp", deck(40))] {
        let read = || read_mesh(name, text.as_bytes()).unwrap().0;
        timed(c, &format!("read {name}"), text.len(), || drop(read()));
        let mesh = read();
        let what = format!("validate {name}, {} nodes", mesh.nnode());
        timed(c, &what, text.len(), || assert_eq!(validate(&mesh), []));
    }
}

/// Three fields at a hundred thousand nodes.
fn frames(c: &mut Criterion) {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("frame.frd");
    let point = |k: u32| Vec3::new(f64::from(k).sin(), f64::from(k).sqrt(), 0.1);
    let n = 100_000;
    let mut mesh = Mesh {
        points: (0..n).map(point).collect(),
        node_labels: (1..=u64::from(n)).collect(),
        ..Mesh::default()
    };
    let tet = by_name("tet4").unwrap();
    for first in (0..n).step_by(4) {
        let nodes: [u32; 4] = std::array::from_fn(|k| first + k as u32);
        mesh.push_cell(tet, &nodes, u64::from(first) + 1);
    }
    let stress = |x: &Vec3| Sym3::new(x.x, x.y, x.z, -x.x, -x.y, 1e-9 * x.x);
    let stress: Vec<Sym3> = mesh.points.iter().map(stress).collect();
    let datasets = [
        Dataset::Displacement(&mesh.points),
        Dataset::Stress(&stress),
        Dataset::Force(&mesh.points),
    ];
    let moment = Moment {
        time: 1.0,
        step: 1,
        increment: 1,
    };
    let write = || {
        let mut file = FrdFile::create(&RealFs, &path, "", &mesh).unwrap();
        file.frame(&moment, &datasets).unwrap();
    };
    write();
    let bytes = RealFs.read(&path).unwrap();
    timed(c, "write frame.frd of 100,000 nodes", bytes.len(), write);
    timed(c, "read it", bytes.len(), || {
        let read = frd::parse(&bytes).unwrap();
        assert_eq!(read.datasets[1].values.len(), 6 * n as usize);
    });
}

fn cases(c: &mut Criterion) {
    let text = case(20_000);
    let vocabulary = Vocabulary::new(Kinds {
        materials: signorini_mechanics::material::descriptions(),
        ..Kinds::default()
    });
    timed(c, "read case.toml with 20,000 nodes", text.len(), || {
        read_case("case.toml", text.as_bytes(), &[], &vocabulary).unwrap();
    });
}

criterion_group!(benches, meshes, cases, frames);
criterion_main!(benches);
