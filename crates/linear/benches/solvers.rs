//! Factorization and multigrid: `cargo bench -p signorini-linear`.
#![allow(missing_docs, clippy::unwrap_used)]

use criterion::{Criterion, criterion_group, criterion_main};
use signorini_linear::sparsity::{BlockPattern, NONE, Pattern};
use signorini_linear::{LinearKind, Problem, Symmetry, Values, choose};
use std::hint::black_box;

/// Nodes along each side of the cube.
const N: u32 = 16;

/// A cube of nodes joined along the axes by springs of stiffness 1 in all directions, held at its lowest layer.
struct Cube {
    bulk: BlockPattern,
    interface: Pattern,
    values: Vec<f64>,
    equation: Vec<u32>,
    sign: Vec<i8>,
    coordinates: Vec<[f64; 3]>,
}

impl Cube {
    fn new() -> Self {
        let nnode = N * N * N;
        let place = |node: u32| [node % N, node / N % N, node / N / N];
        let mut pairs = Vec::new();
        for node in 0..nnode {
            for (axis, stride) in [1, N, N * N].into_iter().enumerate() {
                if place(node)[axis] + 1 < N {
                    pairs.push([node, node + stride]);
                }
            }
        }
        let offsets: Vec<usize> = (0..=pairs.len()).map(|pair| 2 * pair).collect();
        let bulk = BlockPattern::from_cliques(nnode as usize, 3, pairs.as_flattened(), &offsets);
        let mut values = vec![0.0; bulk.nvalue()];
        for [a, b] in pairs {
            for (row, column, k) in [(a, a, 1.0), (a, b, -1.0), (b, a, -1.0), (b, b, 1.0)] {
                let block = bulk.position(row, column).unwrap();
                (0..3).for_each(|axis| values[9 * block + 4 * axis] += k);
            }
        }
        let held = 3 * N * N;
        let equation: Vec<u32> = (0..3 * nnode)
            .map(|dof| dof.checked_sub(held).unwrap_or(NONE))
            .collect();
        Self {
            interface: Pattern::empty(3 * nnode as usize),
            sign: vec![1; (3 * nnode - held) as usize],
            coordinates: (0..nnode).map(|node| place(node).map(f64::from)).collect(),
            bulk,
            values,
            equation,
        }
    }

    fn problem(&self) -> Problem<'_> {
        Problem {
            ndof: self.equation.len(),
            bulk: &self.bulk,
            interface: &self.interface,
            fields: &[],
            equation: &self.equation,
            nequation: self.sign.len(),
            symmetry: Symmetry::Definite,
            sign: &self.sign,
            coordinates: &self.coordinates,
            between: &[],
        }
    }

    /// The values of a stiffness that is this many times as large.
    fn scaled(&self, times: f64) -> Vec<f64> {
        self.values.iter().map(|k| k * times).collect()
    }
}

fn solvers(c: &mut Criterion) {
    let cube = Cube::new();
    let problem = cube.problem();
    // two tangents in turn: a solver may recognize values that it has factorized already
    let tangents = [1.0, 1.5].map(|times| cube.scaled(times));
    let values = |turn: usize| Values {
        bulk: &tangents[turn % 2],
        interface: &[],
    };
    let rhs: Vec<f64> = (0..problem.nequation)
        .map(|e| (0.1 * e as f64).sin())
        .collect();
    let mut x = vec![0.0; rhs.len()];
    let mut group = c.benchmark_group("11520 equations");
    group.sample_size(10);
    for (name, kind) in [
        ("direct", LinearKind::Direct),
        ("multigrid", LinearKind::Multigrid),
    ] {
        let mut solver = choose(kind);
        solver.analyze(&problem).unwrap();
        let mut turn = 0;
        group.bench_function(format!("{name}, factorize"), |b| {
            b.iter(|| {
                turn += 1;
                solver.factorize(black_box(&values(turn))).unwrap();
            });
        });
        let values = values(0);
        solver.factorize(&values).unwrap();
        group.bench_function(format!("{name}, solve to 1e-8"), |b| {
            b.iter(|| {
                solver
                    .solve(&values, black_box(&rhs), &mut x, 1e-8)
                    .unwrap()
            });
        });
    }
    group.finish();
}

criterion_group!(benches, solvers);
criterion_main!(benches);
