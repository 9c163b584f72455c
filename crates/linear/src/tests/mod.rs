//! Solvers against a dense oracle, on systems as terms assemble them.

mod condensed;
mod fronts;
mod iterative;
mod multigrid;

use super::ordering::Ordering;
use super::*;
use crate::norm::largest;
use crate::sparsity::{BlockPattern, NONE, Pattern};
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

/// A generator with a fixed seed, so that a failure can be repeated: uniform in [-1, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn below(&mut self, n: usize) -> usize {
        (((self.next() + 1.0) / 2.0 * n as f64) as usize).min(n - 1)
    }

    fn vector(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.next()).collect()
    }
}

/// A system as a list of element matrices; everything else is made from it.
#[derive(Clone)]
struct System {
    nnode: usize,
    block: usize,
    ndof: usize,
    symmetry: Symmetry,
    /// Members and row-major matrix over their `block` dofs each.
    bulk: Vec<(Vec<u32>, Vec<f64>)>,
    /// Raw dofs and row-major matrix.
    interface: Vec<(Vec<u32>, Vec<f64>)>,
    held: Vec<u32>,
    multiplier_from: usize,
}

struct Assembled {
    bulk: BlockPattern,
    interface: Pattern,
    bulk_values: Vec<f64>,
    interface_values: Vec<f64>,
    equation: Vec<u32>,
    nequation: usize,
    sign: Vec<i8>,
    ndof: usize,
    symmetry: Symmetry,
}

fn cliques(elements: &[(Vec<u32>, Vec<f64>)]) -> (Vec<u32>, Vec<usize>) {
    let mut offsets = vec![0];
    let mut members = Vec::new();
    for (clique, _) in elements {
        members.extend_from_slice(clique);
        offsets.push(members.len());
    }
    (members, offsets)
}

impl System {
    fn new(nnode: usize, block: usize, nextra: usize, symmetry: Symmetry) -> Self {
        let ndof = nnode * block + nextra;
        let (bulk, interface, held) = (Vec::new(), Vec::new(), Vec::new());
        Self {
            nnode,
            block,
            ndof,
            symmetry,
            bulk,
            interface,
            held,
            multiplier_from: ndof,
        }
    }

    /// Random element matrices, symmetric and positive definite unless the system is unsymmetric.
    fn random(nnode: usize, block: usize, nextra: usize, symmetry: Symmetry, seed: u64) -> Self {
        let mut random = Random(seed);
        let mut system = Self::new(nnode, block, nextra, symmetry);
        for first in 0..nnode {
            let mut nodes: Vec<u32> = (0..3).map(|_| random.below(nnode) as u32).collect();
            nodes.push(first as u32);
            nodes.sort_unstable();
            nodes.dedup();
            let matrix = random_matrix(nodes.len() * block, symmetry, &mut random);
            system.bulk.push((nodes, matrix));
        }
        for first in (nnode * block..system.ndof).chain(0..2) {
            let mut dofs: Vec<u32> = (0..5).map(|_| random.below(system.ndof) as u32).collect();
            dofs.push(first as u32);
            dofs.sort_unstable();
            dofs.dedup();
            let matrix = random_matrix(dofs.len(), symmetry, &mut random);
            system.interface.push((dofs, matrix));
        }
        system.held = (0..nnode / 5)
            .map(|_| random.below(system.ndof) as u32)
            .collect();
        system
    }

    fn assemble(&self) -> Assembled {
        let (nodes, offsets) = cliques(&self.bulk);
        let bulk = BlockPattern::from_cliques(self.nnode, self.block, &nodes, &offsets);
        let (dofs, offsets) = cliques(&self.interface);
        let interface = Pattern::from_cliques(self.ndof, &dofs, &offsets);
        let mut bulk_values = vec![0.0; bulk.nvalue()];
        for (nodes, matrix) in &self.bulk {
            let n = nodes.len() * self.block;
            for (a, &row) in nodes.iter().enumerate() {
                for (b, &column) in nodes.iter().enumerate() {
                    let at = bulk.position(row, column).unwrap();
                    for i in 0..self.block {
                        for j in 0..self.block {
                            bulk_values[(at * self.block + i) * self.block + j] +=
                                matrix[(a * self.block + i) * n + b * self.block + j];
                        }
                    }
                }
            }
        }
        let mut interface_values = vec![0.0; interface.nentry()];
        for (dofs, matrix) in &self.interface {
            for (a, &row) in dofs.iter().enumerate() {
                for (b, &column) in dofs.iter().enumerate() {
                    interface_values[interface.position(row, column).unwrap()] +=
                        matrix[a * dofs.len() + b];
                }
            }
        }
        let mut equation = vec![NONE; self.ndof];
        let mut sign = Vec::new();
        for dof in (0..self.ndof as u32).filter(|dof| !self.held.contains(dof)) {
            equation[dof as usize] = sign.len() as u32;
            sign.push(if (dof as usize) < self.multiplier_from {
                1
            } else {
                -1
            });
        }
        Assembled {
            bulk,
            interface,
            bulk_values,
            interface_values,
            nequation: sign.len(),
            equation,
            sign,
            ndof: self.ndof,
            symmetry: self.symmetry,
        }
    }

    /// The matrix over raw dofs, from the element matrices alone.
    fn dense_raw(&self) -> Mat<f64> {
        let mut dense = Mat::zeros(self.ndof, self.ndof);
        let mut add = |dofs: &[usize], matrix: &[f64]| {
            for (a, &row) in dofs.iter().enumerate() {
                for (b, &column) in dofs.iter().enumerate() {
                    dense[(row, column)] += matrix[a * dofs.len() + b];
                }
            }
        };
        for (nodes, matrix) in &self.bulk {
            let dofs = nodes
                .iter()
                .flat_map(|&node| (0..self.block).map(move |i| node as usize * self.block + i));
            add(&dofs.collect::<Vec<_>>(), matrix);
        }
        for (dofs, matrix) in &self.interface {
            add(
                &dofs.iter().map(|&dof| dof as usize).collect::<Vec<_>>(),
                matrix,
            );
        }
        dense
    }

    fn dense(&self) -> Mat<f64> {
        let raw = self.dense_raw();
        let free: Vec<usize> = (0..self.ndof)
            .filter(|&dof| !self.held.contains(&(dof as u32)))
            .collect();
        Mat::from_fn(free.len(), free.len(), |i, j| raw[(free[i], free[j])])
    }
}

impl Assembled {
    fn problem(&self) -> Problem<'_> {
        Problem {
            ndof: self.ndof,
            bulk: &self.bulk,
            interface: &self.interface,
            equation: &self.equation,
            nequation: self.nequation,
            symmetry: self.symmetry,
            sign: &self.sign,
            coordinates: &[],
            between: &[],
        }
    }

    fn values(&self) -> Values<'_> {
        Values {
            bulk: &self.bulk_values,
            interface: &self.interface_values,
        }
    }
}

fn random_matrix(n: usize, symmetry: Symmetry, random: &mut Random) -> Vec<f64> {
    let g: Vec<f64> = random.vector(n * n);
    let mut matrix = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..n {
            matrix[i * n + j] = match symmetry {
                Symmetry::Unsymmetric => g[i * n + j],
                _ => (0..n).map(|k| g[k * n + i] * g[k * n + j]).sum(),
            };
        }
        matrix[i * n + i] += 0.2;
    }
    matrix
}

/// One of every kind that this build has.
fn solvers() -> impl Iterator<Item = Box<dyn LinearSolver>> {
    let kinds = SOLVERS.iter().filter(|s| s.kind != LinearKind::Auto);
    kinds.map(|s| (s.build)())
}

/// Solves and compares with the dense oracle; the report comes back.
fn check(system: &System, solver: &mut dyn LinearSolver, seed: u64, tolerance: f64) -> SolveReport {
    let assembled = system.assemble();
    let mut random = Random(seed);
    let rhs = random.vector(assembled.nequation);
    let mut x = vec![f64::NAN; assembled.nequation];
    solver.analyze(&assembled.problem()).unwrap();
    solver.factorize(&assembled.values()).unwrap();
    let report = solver
        .solve(&assembled.values(), &rhs, &mut x, 1e-12)
        .unwrap();
    let oracle = system
        .dense()
        .full_piv_lu()
        .solve(Mat::from_fn(rhs.len(), 1, |i, _| rhs[i]));
    let size = (0..x.len())
        .map(|i| oracle[(i, 0)].abs())
        .fold(0.0, f64::max);
    for (i, x) in x.iter().enumerate() {
        assert!(
            (x - oracle[(i, 0)]).abs() <= tolerance * size,
            "{i}: {x} for {}",
            oracle[(i, 0)]
        );
    }
    report
}

/// The stiffness of an eight-node brick of edges `h`, Young's modulus 1, Poisson's ratio 0.3.
fn brick(h: [f64; 3]) -> Vec<f64> {
    let (lambda, mu) = (0.3 / (1.3 * 0.4), 1.0 / 2.6);
    let corner = |a: usize| {
        [
            (a & 1) as f64 * 2.0 - 1.0,
            (a >> 1 & 1) as f64 * 2.0 - 1.0,
            (a >> 2) as f64 * 2.0 - 1.0,
        ]
    };
    let mut matrix = vec![0.0; 24 * 24];
    for point in 0..8 {
        let xi = corner(point).map(|c| c / 3f64.sqrt());
        let gradient = |a: usize| {
            let c = corner(a);
            let f = [1.0 + c[0] * xi[0], 1.0 + c[1] * xi[1], 1.0 + c[2] * xi[2]];
            [
                c[0] * f[1] * f[2] / 4.0 / h[0],
                c[1] * f[0] * f[2] / 4.0 / h[1],
                c[2] * f[0] * f[1] / 4.0 / h[2],
            ]
        };
        let weight = h[0] * h[1] * h[2] / 8.0;
        for a in 0..8 {
            for b in 0..8 {
                let (ga, gb) = (gradient(a), gradient(b));
                let dot = ga[0] * gb[0] + ga[1] * gb[1] + ga[2] * gb[2];
                for i in 0..3 {
                    for j in 0..3 {
                        let k = lambda * ga[i] * gb[j]
                            + mu * ga[j] * gb[i]
                            + if i == j { mu * dot } else { 0.0 };
                        matrix[(3 * a + i) * 24 + 3 * b + j] += weight * k;
                    }
                }
            }
        }
    }
    matrix
}

/// A block of `n` bricks of Young's modulus `young`, node numbers from `first`.
fn add_block(system: &mut System, n: [usize; 3], h: [f64; 3], young: f64, first: usize) {
    let matrix: Vec<f64> = brick(h).iter().map(|k| k * young).collect();
    let node =
        |x: usize, y: usize, z: usize| (first + (z * (n[1] + 1) + y) * (n[0] + 1) + x) as u32;
    for z in 0..n[2] {
        for y in 0..n[1] {
            for x in 0..n[0] {
                let nodes = (0..8)
                    .map(|a| node(x + (a & 1), y + (a >> 1 & 1), z + (a >> 2)))
                    .collect();
                system.bulk.push((nodes, matrix.clone()));
            }
        }
    }
}

fn nnode(n: [usize; 3]) -> usize {
    (n[0] + 1) * (n[1] + 1) * (n[2] + 1)
}

/// A block clamped at its bottom.
fn clamped_block(n: [usize; 3], h: [f64; 3]) -> System {
    let mut system = System::new(nnode(n), 3, 0, Symmetry::Definite);
    add_block(&mut system, n, h, 1.0, 0);
    system.held = (0..3 * (n[0] + 1) as u32 * (n[1] + 1) as u32).collect();
    system
}

/// Two blocks on top of each other, the lower clamped, tied node to node by multipliers in all directions.
fn tied_blocks(n: [usize; 3], young: [f64; 2]) -> System {
    let layer = (n[0] + 1) * (n[1] + 1);
    let mut system = System::new(2 * nnode(n), 3, 3 * layer, Symmetry::Symmetric);
    add_block(&mut system, n, [1.0; 3], young[0], 0);
    add_block(&mut system, n, [1.0; 3], young[1], nnode(n));
    system.held = (0..3 * layer as u32).collect();
    system.multiplier_from = 6 * nnode(n);
    for node in 0..layer {
        for i in 0..3 {
            let lower = 3 * (nnode(n) - layer + node) + i;
            let upper = 3 * (nnode(n) + node) + i;
            let multiplier = system.multiplier_from + 3 * node + i;
            let row = vec![0.0, 0.0, -1.0, 0.0, 0.0, 1.0, -1.0, 1.0, 0.0];
            system
                .interface
                .push((vec![lower as u32, upper as u32, multiplier as u32], row));
        }
    }
    system
}

#[test]
fn definite_systems_match_the_dense_oracle() {
    for (nnode, block, nextra, seed) in [
        (1, 2, 0, 1),
        (4, 3, 2, 2),
        (30, 2, 5, 3),
        (60, 3, 9, 4),
        (300, 1, 0, 5),
    ] {
        let system = System::random(nnode, block, nextra, Symmetry::Definite, seed);
        for ordering in [Ordering::MinimumDegree, Ordering::NestedDissection] {
            let report = check(&system, &mut Direct::with_ordering(ordering), seed, 1e-9);
            assert_eq!((report.negative_pivots, report.refinements), (0, 0));
        }
        for mut solver in solvers() {
            let report = check(&system, solver.as_mut(), seed, 1e-9);
            assert_eq!((report.negative_pivots, report.refinements), (0, 0));
        }
    }
}

#[test]
fn unsymmetric_systems_match_the_dense_oracle() {
    for (nnode, block, nextra, seed) in [
        (1, 2, 0, 1),
        (4, 3, 2, 2),
        (30, 2, 5, 3),
        (60, 3, 9, 4),
        (200, 1, 20, 5),
    ] {
        let system = System::random(nnode, block, nextra, Symmetry::Unsymmetric, seed);
        for mut solver in solvers() {
            check(&system, solver.as_mut(), seed, 1e-8);
        }
    }
}

#[test]
fn indefinite_tangents_are_solved_and_their_negative_pivots_counted() {
    for (nnode, block, seed) in [(8, 3, 1), (40, 2, 2), (60, 3, 3)] {
        let mut system = System::random(nnode, block, 4, Symmetry::Definite, seed);
        // a spring of negative stiffness at every dof: a third of the eigenvalues turns negative
        let mut values = system
            .dense()
            .self_adjoint_eigenvalues(Side::Lower)
            .unwrap();
        values.sort_by(f64::total_cmp);
        let push = 0.5 * (values[values.len() / 3] + values[values.len() / 3 + 1]);
        system
            .interface
            .extend((0..system.ndof as u32).map(|dof| (vec![dof], vec![-push])));
        let negative = values.iter().filter(|&&value| value < push).count();
        for mut solver in solvers() {
            for _ in 0..2 {
                assert_eq!(
                    check(&system, solver.as_mut(), seed, 1e-7).negative_pivots,
                    negative
                );
            }
        }
    }
}

#[test]
fn a_tangent_that_recovers_is_factorized_as_definite_again() {
    let stable = System::random(20, 3, 0, Symmetry::Definite, 5);
    let mut pushed = stable.clone();
    pushed.interface.push((vec![59], vec![-1e3]));
    let mut relieved = stable.clone();
    relieved.interface.push((vec![59], vec![0.0]));
    for mut solver in solvers() {
        assert_eq!(
            check(&relieved, solver.as_mut(), 1, 1e-9).negative_pivots,
            0
        );
        assert_eq!(check(&pushed, solver.as_mut(), 1, 1e-9).negative_pivots, 1);
        for _ in 0..2 {
            assert_eq!(
                check(&relieved, solver.as_mut(), 1, 1e-9).negative_pivots,
                0
            );
        }
    }
}

#[test]
fn saddles_with_a_zero_block_are_solved_in_every_order() {
    for young in [
        [1.0, 1.0],
        [2.1e5, 70.0],
        [70.0, 2.1e5],
        [2.1e11, 2.1e11],
        [1e-9, 1e-9],
    ] {
        let system = tied_blocks([3, 2, 2], young);
        let nmultiplier = system.ndof - system.multiplier_from;
        for ordering in [Ordering::MinimumDegree, Ordering::NestedDissection] {
            let report = check(&system, &mut Direct::with_ordering(ordering), 3, 1e-6);
            assert_eq!(report.negative_pivots, nmultiplier);
            // the shift on the zero block is always refined away
            assert!(report.refinements > 0, "{report:?}");
        }
        for mut solver in solvers() {
            let report = check(&system, solver.as_mut(), 3, 1e-6);
            assert_eq!(report.negative_pivots, nmultiplier);
        }
    }
}

/// Two blocks on top of each other that slip: a penalty between them, and friction of `mu` times its force.
fn slipping_blocks(n: [usize; 3], penalty: f64, mu: f64) -> System {
    slipping_blocks_of([1.0, 20.0], n, penalty, mu)
}

/// The same with these Young's moduli below and above.
fn slipping_blocks_of(young: [f64; 2], n: [usize; 3], penalty: f64, mu: f64) -> System {
    let layer = (n[0] + 1) * (n[1] + 1);
    let mut system = System::new(2 * nnode(n), 3, 0, Symmetry::Unsymmetric);
    add_block(&mut system, n, [1.0; 3], young[0], 0);
    add_block(&mut system, n, [1.0; 3], young[1], nnode(n));
    let top = 3 * (2 * nnode(n) - layer) as u32;
    system.held = (0..3 * layer as u32)
        .chain(top..system.ndof as u32)
        .collect();
    for node in 0..layer {
        let lower = 3 * (nnode(n) - layer + node) as u32;
        let upper = 3 * (nnode(n) + node) as u32;
        // the gap is u(upper, z) - u(lower, z); forces act along x and z
        let force = [-mu, -1.0, mu, 1.0].map(|f| f * penalty);
        let matrix = force.iter().flat_map(|f| [0.0, -f, 0.0, *f]).collect();
        let dofs = vec![lower, lower + 2, upper, upper + 2];
        system.interface.push((dofs, matrix));
    }
    system
}

#[test]
fn all_solvers_agree_on_systems_of_contact() {
    let n = [6, 5, 4];
    let systems = [
        clamped_block(n, [1.0; 3]),
        tied_blocks(n, [1.0, 20.0]),
        tied_blocks(n, [2.1e5, 70.0]),
        slipping_blocks(n, 10.0, 0.3),
        slipping_blocks(n, 1e4, 0.9),
    ];
    for (at, system) in systems.iter().enumerate() {
        let assembled = system.assemble();
        // forces on displacements, as gaps are closed in a Newton iteration
        let truth = Random(7).vector(assembled.nequation);
        let (mut raw, mut product) = (vec![0.0; system.ndof], vec![0.0; system.ndof]);
        let mut rhs = vec![0.0; assembled.nequation];
        let numbered = || {
            assembled
                .equation
                .iter()
                .enumerate()
                .filter(|&(_, &e)| e != NONE)
        };
        numbered().for_each(|(d, &e)| raw[d] = truth[e as usize]);
        let (bulk, interface) = (&assembled.bulk, &assembled.interface);
        apply(bulk, interface, &assembled.values(), &raw, &mut product);
        numbered().for_each(|(d, &e)| rhs[e as usize] = product[d]);
        for mut solver in solvers() {
            let mut x = vec![f64::NAN; rhs.len()];
            solver.analyze(&assembled.problem()).unwrap();
            solver.factorize(&assembled.values()).unwrap();
            let report = solver
                .solve(&assembled.values(), &rhs, &mut x, 1e-12)
                .unwrap();
            let off = x.iter().zip(&truth).map(|(x, truth)| (x - truth).abs());
            let off = off.fold(0.0, f64::max);
            println!("system {at}: {report:?}, off by {off:.1e}");
            assert!(report.residual <= 1e-12, "system {at}: {report:?}");
            assert!(off < 1e-8, "system {at}: off by {off:e}");
        }
    }
}

#[test]
fn zero_diagonals_that_are_no_multipliers_are_solved() {
    // pairs of dofs that only couple with each other: no pivot on the diagonal exists
    let mut system = System::new(4, 3, 0, Symmetry::Symmetric);
    for node in 0..4u32 {
        system.bulk.push((
            vec![node],
            vec![0.0, 2.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 3.0],
        ));
    }
    for mut solver in solvers() {
        let report = check(&system, solver.as_mut(), 1, 1e-12);
        assert_eq!(report.negative_pivots, 4);
    }
}

#[test]
fn bodies_that_nothing_holds_are_singular() {
    for symmetry in [
        Symmetry::Definite,
        Symmetry::Symmetric,
        Symmetry::Unsymmetric,
    ] {
        for n in [[1, 1, 1], [2, 3, 2], [5, 5, 5], [12, 12, 12]] {
            // free altogether; free to turn about an axis; free to slide
            let free = [
                vec![],
                vec![0, 1, 2, 3, 4, 5],
                (0..nnode(n) as u32)
                    .flat_map(|a| [3 * a, 3 * a + 1])
                    .collect(),
            ];
            for held in free {
                let mut system = clamped_block(n, [1.0; 3]);
                system.symmetry = symmetry;
                system.held = held;
                let assembled = system.assemble();
                for mut solver in solvers() {
                    solver.analyze(&assembled.problem()).unwrap();
                    let error = solver.factorize(&assembled.values()).unwrap_err();
                    assert!(
                        matches!(error, LinearError::Singular { equation: Some(_) }),
                        "{symmetry:?} {n:?} {error:?}"
                    );
                    let (rhs, mut x) = (
                        vec![1.0; assembled.nequation],
                        vec![0.0; assembled.nequation],
                    );
                    let error = solver
                        .solve(&assembled.values(), &rhs, &mut x, 1e-8)
                        .unwrap_err();
                    assert_eq!(
                        error,
                        LinearError::Order {
                            before: "factorize"
                        }
                    );
                }
            }
        }
    }
}

#[test]
fn the_named_equation_belongs_to_the_free_body() {
    let n = [3, 2, 2];
    for symmetry in [
        Symmetry::Definite,
        Symmetry::Symmetric,
        Symmetry::Unsymmetric,
    ] {
        for free_is_first in [false, true] {
            let mut system = System::new(2 * nnode(n), 3, 0, symmetry);
            add_block(&mut system, n, [1.0; 3], 500.0, 0);
            add_block(&mut system, n, [1.0; 3], 1e7, nnode(n));
            let held = if free_is_first { nnode(n) } else { 0 };
            system.held = (3 * held as u32..3 * held as u32 + 36).collect();
            let assembled = system.assemble();
            for mut solver in solvers() {
                solver.analyze(&assembled.problem()).unwrap();
                let error = solver.factorize(&assembled.values()).unwrap_err();
                let LinearError::Singular {
                    equation: Some(equation),
                } = error
                else {
                    panic!("{error:?}")
                };
                let dof = assembled
                    .equation
                    .iter()
                    .position(|&e| e as usize == equation)
                    .unwrap();
                assert_eq!(dof < 3 * nnode(n), free_is_first, "{symmetry:?}: dof {dof}");
            }
        }
    }
}

#[test]
fn a_body_held_by_multipliers_only_may_still_be_free() {
    // ties in the normal direction alone leave the upper block three motions
    let mut system = tied_blocks([3, 3, 2], [1.0, 1.0]);
    for (_, row) in system
        .interface
        .iter_mut()
        .enumerate()
        .filter(|(k, _)| k % 3 != 2)
        .map(|(_, row)| row)
    {
        *row = vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0];
    }
    for ordering in [Ordering::MinimumDegree, Ordering::NestedDissection] {
        let assembled = system.assemble();
        let mut solver = Direct::with_ordering(ordering);
        solver.analyze(&assembled.problem()).unwrap();
        let error = solver.factorize(&assembled.values()).unwrap_err();
        let LinearError::Singular {
            equation: Some(equation),
        } = error
        else {
            panic!("{error:?}")
        };
        let dof = assembled
            .equation
            .iter()
            .position(|&e| e as usize == equation)
            .unwrap();
        assert!(dof >= 3 * nnode([3, 3, 2]), "dof {dof}");
    }
}

#[test]
fn a_zero_row_is_named() {
    for symmetry in [
        Symmetry::Definite,
        Symmetry::Symmetric,
        Symmetry::Unsymmetric,
    ] {
        let mut system = System::random(10, 3, 1, symmetry, 9);
        system.held.clear();
        system.interface.retain(|(dofs, _)| !dofs.contains(&30));
        let assembled = system.assemble();
        for mut solver in solvers() {
            solver.analyze(&assembled.problem()).unwrap();
            let error = solver.factorize(&assembled.values()).unwrap_err();
            assert_eq!(error, LinearError::Singular { equation: Some(30) });
        }
    }
}

#[test]
fn a_doubled_constraint_is_not_solved_wrongly() {
    let mut system = tied_blocks([2, 2, 2], [1.0, 1.0]);
    let (mut dofs, row) = system.interface[4].clone();
    dofs[2] = system.ndof as u32;
    system.ndof += 1;
    system.interface.push((dofs, row));
    let assembled = system.assemble();
    for mut solver in solvers() {
        solver.analyze(&assembled.problem()).unwrap();
        let error = solver.factorize(&assembled.values()).unwrap_err();
        assert!(
            matches!(error, LinearError::Singular { equation: Some(_) }),
            "{error:?}"
        );
    }
}

#[test]
fn ill_conditioned_systems_reach_the_residual() {
    // a penalty of 1e12 times the stiffness between two blocks, and one spring of 1e-9 of it
    let n = [3, 3, 2];
    let layer = 16;
    for symmetry in [
        Symmetry::Definite,
        Symmetry::Symmetric,
        Symmetry::Unsymmetric,
    ] {
        for penalty in [1e-9, 1e4, 1e9, 1e12] {
            let mut system = System::new(2 * nnode(n), 3, 0, symmetry);
            add_block(&mut system, n, [1.0; 3], 1.0, 0);
            add_block(&mut system, n, [1.0; 3], 1.0, nnode(n));
            system.held = (0..3 * layer).collect();
            for k in 0..3 * layer {
                let (lower, upper) = (3 * (nnode(n) as u32 - layer) + k, 3 * nnode(n) as u32 + k);
                system.interface.push((
                    vec![lower, upper],
                    vec![penalty, -penalty, -penalty, penalty],
                ));
            }
            let assembled = system.assemble();
            for mut solver in solvers() {
                solver.analyze(&assembled.problem()).unwrap();
                solver.factorize(&assembled.values()).unwrap();
                // a right-hand side of the size of the terms that cancel: 1e-12 can be asked
                let truth = Random(1).vector(assembled.nequation);
                let mut raw = vec![0.0; system.ndof];
                for (d, &e) in assembled
                    .equation
                    .iter()
                    .enumerate()
                    .filter(|&(_, &e)| e != NONE)
                {
                    raw[d] = truth[e as usize];
                }
                let mut product = vec![0.0; system.ndof];
                apply(
                    &assembled.bulk,
                    &assembled.interface,
                    &assembled.values(),
                    &raw,
                    &mut product,
                );
                let mut rhs = vec![0.0; assembled.nequation];
                for (d, &e) in assembled
                    .equation
                    .iter()
                    .enumerate()
                    .filter(|&(_, &e)| e != NONE)
                {
                    rhs[e as usize] = product[d];
                }
                let mut x = vec![0.0; assembled.nequation];
                let report = solver
                    .solve(&assembled.values(), &rhs, &mut x, 1e-14)
                    .unwrap();
                assert!(
                    report.residual <= 1e-14,
                    "{symmetry:?} {penalty:e} {report:?}"
                );
                // any other: as far as round-off lets it, and the solver says how far
                let rhs = Random(2).vector(assembled.nequation);
                let report = solver
                    .solve(&assembled.values(), &rhs, &mut x, 1e-15)
                    .unwrap();
                for (d, &e) in assembled
                    .equation
                    .iter()
                    .enumerate()
                    .filter(|&(_, &e)| e != NONE)
                {
                    raw[d] = x[e as usize];
                }
                apply_absolute(
                    &assembled.bulk,
                    &assembled.interface,
                    &assembled.values(),
                    &raw,
                    &mut product,
                );
                let attainable = 4.0 * f64::EPSILON * largest(&product) / largest(&rhs);
                assert!(
                    report.residual <= attainable,
                    "{penalty:e} {report:?} {attainable:e}"
                );
            }
        }
    }
}

#[test]
fn slender_structures_are_not_taken_for_free_bodies() {
    // a strip of 1 × 1 × 200 bricks ten times as long as wide: condition about 1e12
    for symmetry in [Symmetry::Definite, Symmetry::Unsymmetric] {
        let mut system = clamped_block([1, 1, 200], [1.0, 1.0, 10.0]);
        system.symmetry = symmetry;
        let assembled = system.assemble();
        for mut solver in solvers() {
            solver.analyze(&assembled.problem()).unwrap();
            solver.factorize(&assembled.values()).unwrap();
            let mut rhs = vec![0.0; assembled.nequation];
            for corner in 0..4 {
                rhs[assembled.nequation - 3 * corner - 3] = 0.25;
            }
            let mut x = vec![0.0; assembled.nequation];
            solver
                .solve(&assembled.values(), &rhs, &mut x, 1e-10)
                .unwrap();
            // Euler–Bernoulli, F L³ / 3 E I; fully integrated bricks of that length lock in shear, so only the order counts
            let beam = 2000f64.powi(3) / 3.0 * 12.0;
            let tip = x[assembled.nequation - 3] / beam;
            assert!((0.005..1.05).contains(&tip), "{tip}");
        }
    }
}

#[test]
fn repeated_factorizations_give_the_same_bits() {
    for symmetry in [
        Symmetry::Definite,
        Symmetry::Symmetric,
        Symmetry::Unsymmetric,
    ] {
        let mut system = clamped_block([6, 6, 6], [1.0; 3]);
        system.symmetry = symmetry;
        let assembled = system.assemble();
        let rhs = Random(3).vector(assembled.nequation);
        let solve = |solver: &mut dyn LinearSolver| {
            let mut x = vec![0.0; rhs.len()];
            solver.analyze(&assembled.problem()).unwrap();
            solver.factorize(&assembled.values()).unwrap();
            solver
                .solve(&assembled.values(), &rhs, &mut x, 1e-10)
                .unwrap();
            x.iter().map(|x| x.to_bits()).collect::<Vec<_>>()
        };
        for fresh in SOLVERS.iter().map(|s| s.build) {
            let mut solver = fresh();
            let first = solve(solver.as_mut());
            assert!(first == solve(solver.as_mut()) && first == solve(fresh().as_mut()));
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(1)
                .build()
                .unwrap();
            assert!(first == pool.install(|| solve(fresh().as_mut())));
        }
    }
}

#[test]
fn values_of_another_size_are_solved_after_others() {
    for symmetry in [
        Symmetry::Definite,
        Symmetry::Symmetric,
        Symmetry::Unsymmetric,
    ] {
        let soft = System::random(20, 3, 0, symmetry, 6);
        let mut stiff = soft.clone();
        for (number, (_, matrix)) in stiff.bulk.iter_mut().enumerate() {
            let by = [1e12, 1e3, 1.0, 1e-9][number % 4];
            matrix.iter_mut().for_each(|a| *a *= by);
        }
        let mut solver = Direct::new();
        check(&soft, &mut solver, 1, 1e-9);
        let assembled = stiff.assemble();
        let rhs = Random(3).vector(assembled.nequation);
        let solve = |solver: &mut Direct| {
            let mut x = vec![0.0; rhs.len()];
            solver.analyze(&assembled.problem()).unwrap();
            solver.factorize(&assembled.values()).unwrap();
            let report = solver.solve(&assembled.values(), &rhs, &mut x, 1e-12);
            assert!(report.unwrap().residual < 1e-12);
            x
        };
        // scales that go on from others are as good, and what is forgotten leaves no trace
        solve(&mut solver);
        solver.forget();
        assert_eq!(solve(&mut solver), solve(&mut Direct::new()));
        check(&soft, &mut solver, 1, 1e-9);
    }
}

#[test]
fn dissection_fills_in_less_than_minimum_degree_on_bricks() {
    let system = clamped_block([9, 9, 10], [1.0; 3]);
    let assembled = system.assemble();
    assert_eq!(assembled.nequation, 3000);
    let rhs = Random(4).vector(3000);
    let mut fill = Vec::new();
    for ordering in [Ordering::NestedDissection, Ordering::MinimumDegree] {
        let mut solver = Direct::with_ordering(ordering);
        let mut x = vec![0.0; 3000];
        solver.analyze(&assembled.problem()).unwrap();
        solver.factorize(&assembled.values()).unwrap();
        let report = solver
            .solve(&assembled.values(), &rhs, &mut x, 1e-12)
            .unwrap();
        assert!(report.residual <= 1e-12 && report.negative_pivots == 0);
        fill.push(solver.size().0);
    }
    assert!(fill[0] < fill[1], "{fill:?}");
}

#[test]
fn two_dofs_may_share_an_equation() {
    let system = System::random(12, 3, 0, Symmetry::Definite, 8);
    let mut assembled = system.assemble();
    let dense = system.dense();
    // the last equation goes to the first one's place
    let last = assembled.nequation as u32 - 1;
    let shared = assembled.equation.iter().position(|&e| e == last).unwrap();
    assembled.equation[shared] = 0;
    assembled.nequation -= 1;
    assembled.sign.pop();
    let n = assembled.nequation;
    let to = |i: usize| if i == n { 0 } else { i };
    let mut merged = Mat::<f64>::zeros(n, n);
    for i in 0..=n {
        for j in 0..=n {
            merged[(to(i), to(j))] += dense[(i, j)];
        }
    }
    let rhs = Random(1).vector(n);
    let oracle = merged
        .full_piv_lu()
        .solve(Mat::from_fn(n, 1, |i, _| rhs[i]));
    for symmetry in [
        Symmetry::Definite,
        Symmetry::Symmetric,
        Symmetry::Unsymmetric,
    ] {
        assembled.symmetry = symmetry;
        for mut solver in solvers() {
            let mut x = vec![0.0; n];
            solver.analyze(&assembled.problem()).unwrap();
            solver.factorize(&assembled.values()).unwrap();
            solver
                .solve(&assembled.values(), &rhs, &mut x, 1e-12)
                .unwrap();
            for (i, x) in x.iter().enumerate() {
                assert!((x - oracle[(i, 0)]).abs() < 1e-9, "{symmetry:?} {i}");
            }
        }
    }
}

#[test]
fn apply_is_the_sum_of_the_element_matrices() {
    for (nnode, block, nextra) in [(9, 1, 0), (20, 2, 3), (2000, 3, 5)] {
        let mut system = System::random(nnode, block, nextra, Symmetry::Unsymmetric, 6);
        system.held.clear();
        let assembled = system.assemble();
        let x = Random(1).vector(system.ndof);
        let (mut y, mut wanted) = (vec![f64::NAN; system.ndof], vec![0.0; system.ndof]);
        apply(
            &assembled.bulk,
            &assembled.interface,
            &assembled.values(),
            &x,
            &mut y,
        );
        let dofs = |nodes: &[u32]| {
            nodes
                .iter()
                .flat_map(|&n| (0..block as u32).map(move |i| n * block as u32 + i))
                .collect::<Vec<_>>()
        };
        let bulk = system
            .bulk
            .iter()
            .map(|(nodes, matrix)| (dofs(nodes), matrix));
        for (dofs, matrix) in bulk.chain(
            system
                .interface
                .iter()
                .map(|(dofs, matrix)| (dofs.clone(), matrix)),
        ) {
            for (a, &row) in dofs.iter().enumerate() {
                for (b, &column) in dofs.iter().enumerate() {
                    wanted[row as usize] += matrix[a * dofs.len() + b] * x[column as usize];
                }
            }
        }
        for (y, wanted) in y.iter().zip(&wanted) {
            assert!((y - wanted).abs() < 1e-12);
        }
        let absolute = |values: &[f64]| values.iter().map(|v| v.abs()).collect::<Vec<_>>();
        let (bulk, interface) = (
            absolute(&assembled.bulk_values),
            absolute(&assembled.interface_values),
        );
        let values = Values {
            bulk: &bulk,
            interface: &interface,
        };
        let mut sizes = [vec![0.0; system.ndof], vec![0.0; system.ndof]];
        apply_absolute(
            &assembled.bulk,
            &assembled.interface,
            &assembled.values(),
            &x,
            &mut sizes[0],
        );
        apply(
            &assembled.bulk,
            &assembled.interface,
            &values,
            &absolute(&x),
            &mut sizes[1],
        );
        assert_eq!(sizes[0], sizes[1]);
    }
}

#[test]
fn a_factor_that_is_a_little_old_serves_as_preconditioner() {
    for symmetry in [
        Symmetry::Definite,
        Symmetry::Symmetric,
        Symmetry::Unsymmetric,
    ] {
        let mut system = clamped_block([3, 3, 3], [1.0; 3]);
        system.symmetry = symmetry;
        let old = system.assemble();
        system
            .bulk
            .iter_mut()
            .step_by(2)
            .for_each(|(_, matrix)| matrix.iter_mut().for_each(|k| *k *= 1.01));
        let new = system.assemble();
        let rhs = Random(5).vector(new.nequation);
        let mut x = vec![0.0; new.nequation];
        for mut solver in solvers() {
            solver.analyze(&old.problem()).unwrap();
            solver.factorize(&old.values()).unwrap();
            let report = solver.solve(&new.values(), &rhs, &mut x, 1e-5).unwrap();
            assert!(
                report.refinements > 0 && report.residual <= 1e-5,
                "{report:?}"
            );
            let error = solver.solve(&new.values(), &rhs, &mut x, 1e-14);
            // not enough for this: it says so
            assert!(
                matches!(error, Err(LinearError::Inaccurate { residual, .. }) if residual > 1e-14),
                "{symmetry:?}: {error:?}"
            );
        }
    }
}

#[test]
fn the_analysis_of_an_identical_problem_is_kept() {
    let system = System::random(20, 3, 2, Symmetry::Definite, 4);
    let (first, same) = (system.assemble(), system.assemble());
    let mut solver = Direct::new();
    solver.analyze(&first.problem()).unwrap();
    solver.factorize(&first.values()).unwrap();
    let kept = solver.address();
    solver.analyze(&same.problem()).unwrap();
    assert_eq!(solver.address(), kept);
    // and so is the factor
    let (rhs, mut x) = (vec![1.0; same.nequation], vec![0.0; same.nequation]);
    solver.solve(&same.values(), &rhs, &mut x, 1e-12).unwrap();
    // anything else is analyzed again, and its factor is not there yet
    let mut equation = first.equation.clone();
    let (a, b) = (first.sign.len() as u32 - 1, first.sign.len() as u32 - 2);
    for e in &mut equation {
        *e = if *e == a {
            b
        } else if *e == b {
            a
        } else {
            *e
        };
    }
    solver
        .analyze(&Problem {
            equation: &equation,
            ..first.problem()
        })
        .unwrap();
    let error = solver.solve(&same.values(), &rhs, &mut x, 1e-12);
    assert_eq!(
        error,
        Err(LinearError::Order {
            before: "factorize"
        })
    );
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    for symmetry in [
        Symmetry::Definite,
        Symmetry::Symmetric,
        Symmetry::Unsymmetric,
    ] {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let assembled = System::random(10, 3, 2, symmetry, 3).assemble();
            for mut solver in solvers() {
                solver.analyze(&assembled.problem()).unwrap();
                let mut broken = assembled.bulk_values.clone();
                let diagonal = assembled.bulk.position(5, 5).unwrap();
                broken[9 * diagonal..9 * diagonal + 9].fill(bad);
                let values = Values {
                    bulk: &broken,
                    interface: &assembled.interface_values,
                };
                assert_eq!(solver.factorize(&values), Err(LinearError::NotFinite));
                solver.factorize(&assembled.values()).unwrap();
                let mut rhs = vec![1.0; assembled.nequation];
                let mut x = rhs.clone();
                assert_eq!(
                    solver.solve(&values, &rhs, &mut x, 1e-8),
                    Err(LinearError::NotFinite)
                );
                rhs[3] = bad;
                assert_eq!(
                    solver.solve(&assembled.values(), &rhs, &mut x, 1e-8),
                    Err(LinearError::NotFinite)
                );
                rhs[3] = 1.0;
                solver
                    .solve(&assembled.values(), &rhs, &mut x, 1e-8)
                    .unwrap();
            }
        }
    }
}

#[test]
fn nothing_to_solve_succeeds() {
    for symmetry in [
        Symmetry::Definite,
        Symmetry::Symmetric,
        Symmetry::Unsymmetric,
    ] {
        let mut system = System::random(3, 2, 0, symmetry, 1);
        system.held = (0..6).collect();
        for assembled in [system.assemble(), System::new(0, 3, 0, symmetry).assemble()] {
            for mut solver in solvers() {
                solver.analyze(&assembled.problem()).unwrap();
                solver.factorize(&assembled.values()).unwrap();
                let report = solver
                    .solve(&assembled.values(), &[], &mut [], 1e-10)
                    .unwrap();
                assert_eq!(report, SolveReport::default());
            }
        }
    }
    // and no force gives no motion
    let assembled = System::random(10, 3, 2, Symmetry::Definite, 3).assemble();
    for kind in SOLVERS.iter().map(|s| s.kind) {
        let mut solver = choose(kind);
        solver.analyze(&assembled.problem()).unwrap();
        solver.factorize(&assembled.values()).unwrap();
        let mut x = vec![1.0; assembled.nequation];
        let report = solver
            .solve(
                &assembled.values(),
                &vec![0.0; assembled.nequation],
                &mut x,
                1e-10,
            )
            .unwrap();
        assert!(report.residual == 0.0 && x.iter().all(|&x| x == 0.0));
    }
}

#[test]
fn calls_out_of_order_and_lists_that_do_not_fit_are_refused() {
    let assembled = System::random(10, 3, 2, Symmetry::Definite, 3).assemble();
    for mut solver in solvers() {
        let rhs = vec![1.0; assembled.nequation];
        let mut x = rhs.clone();
        assert_eq!(
            solver.factorize(&assembled.values()),
            Err(LinearError::Order { before: "analyze" })
        );
        assert_eq!(
            solver.solve(&assembled.values(), &rhs, &mut x, 1e-8),
            Err(LinearError::Order { before: "analyze" })
        );
        solver.analyze(&assembled.problem()).unwrap();
        assert_eq!(
            solver.solve(&assembled.values(), &rhs, &mut x, 1e-8),
            Err(LinearError::Order {
                before: "factorize"
            })
        );
        let short = Values {
            bulk: &assembled.bulk_values[1..],
            interface: &assembled.interface_values,
        };
        assert!(matches!(
            solver.factorize(&short),
            Err(LinearError::Shape {
                what: "bulk values",
                ..
            })
        ));
        solver.factorize(&assembled.values()).unwrap();
        let error = solver.solve(&assembled.values(), &rhs[1..], &mut x, 1e-8);
        assert!(matches!(
            error,
            Err(LinearError::Shape {
                what: "right-hand sides",
                ..
            })
        ));

        let problem = assembled.problem();
        let mut refused = |problem: &Problem| solver.analyze(problem).unwrap_err();
        let mut equation = assembled.equation.clone();
        equation[0] = assembled.nequation as u32;
        assert!(matches!(
            refused(&Problem {
                equation: &equation,
                ..problem
            }),
            LinearError::Range { .. }
        ));
        assert!(matches!(
            refused(&Problem {
                equation: &equation[1..],
                ..problem
            }),
            LinearError::Shape { .. }
        ));
        assert!(matches!(
            refused(&Problem {
                sign: &[],
                ..problem
            }),
            LinearError::Shape { .. }
        ));
        for outside in [NONE, 10] {
            let mut column = assembled.bulk.column.to_vec();
            column[0] = outside;
            let bulk = BlockPattern {
                column: column.into(),
                ..assembled.bulk.clone()
            };
            assert!(matches!(
                refused(&Problem {
                    bulk: &bulk,
                    ..problem
                }),
                LinearError::Range { .. }
            ));
        }
    }
}

#[test]
fn matrices_that_resist_elimination_without_pivoting_are_solved() {
    // ⎡0 L⎤ with the Laplacian L of a string: pivots exist only off the diagonal, and the static shift, though
    // ⎣L 0⎦ harmless in exact arithmetic, makes entries grow by 1e10 over eigenvalues of 1e-7
    let n = 8000;
    let mut system = System::new(2 * n, 1, 0, Symmetry::Symmetric);
    let first = n as u32;
    for i in 0..n as u32 {
        system
            .bulk
            .push((vec![i, first + i], vec![0.0, 2.0, 2.0, 0.0]));
        if i > 0 {
            system
                .bulk
                .push((vec![i, first + i - 1], vec![0.0, -1.0, -1.0, 0.0]));
            system
                .bulk
                .push((vec![i - 1, first + i], vec![0.0, -1.0, -1.0, 0.0]));
        }
    }
    let assembled = system.assemble();
    let truth = Random(1).vector(2 * n);
    let (mut rhs, mut x) = (vec![0.0; 2 * n], vec![0.0; 2 * n]);
    apply(
        &assembled.bulk,
        &assembled.interface,
        &assembled.values(),
        &truth,
        &mut rhs,
    );
    let mut solver = Direct::new();
    for _ in 0..2 {
        solver.analyze(&assembled.problem()).unwrap();
        solver.factorize(&assembled.values()).unwrap();
        let report = solver
            .solve(&assembled.values(), &rhs, &mut x, 1e-13)
            .unwrap();
        assert!(solver.uses_lu() && report.residual <= 1e-13);
        for (x, truth) in x.iter().zip(&truth) {
            assert!((x - truth).abs() < 1e-7, "{x} {truth}");
        }
    }
    for mut solver in solvers() {
        solver.analyze(&assembled.problem()).unwrap();
        solver.factorize(&assembled.values()).unwrap();
        let report = solver
            .solve(&assembled.values(), &rhs, &mut x, 1e-13)
            .unwrap();
        let off = x.iter().zip(&truth).map(|(x, truth)| (x - truth).abs());
        assert!(report.residual <= 1e-13 && off.fold(0.0, f64::max) < 1e-7);
    }
}

/// Run with `--ignored`: large enough for the kernels to share their work.
#[test]
#[ignore = "takes half a minute"]
fn large_systems_repeat_their_bits_and_show_free_bodies() {
    for symmetry in [Symmetry::Definite, Symmetry::Symmetric] {
        let mut system = clamped_block([21, 21, 21], [1.0; 3]);
        system.symmetry = symmetry;
        let assembled = system.assemble();
        assert!(assembled.nequation > 30_000);
        let rhs = Random(3).vector(assembled.nequation);
        let solve = |nthread: usize, mut solver: Direct| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(nthread)
                .build()
                .unwrap();
            pool.install(|| {
                let mut x = vec![0.0; rhs.len()];
                solver.analyze(&assembled.problem()).unwrap();
                solver.factorize(&assembled.values()).unwrap();
                solver
                    .solve(&assembled.values(), &rhs, &mut x, 1e-10)
                    .unwrap();
                x.iter().map(|x| x.to_bits()).collect::<Vec<_>>()
            })
        };
        let one = solve(1, Direct::reproducible());
        for nthread in [2, 5] {
            let same = one == solve(nthread, Direct::reproducible());
            assert!(same, "{symmetry:?}, {nthread} threads");
        }
        assert!(
            solve(2, Direct::new()) == solve(2, Direct::new()),
            "{symmetry:?}, twice on two threads"
        );
        system.held.truncate(5);
        let assembled = system.assemble();
        let mut solver = Direct::new();
        solver.analyze(&assembled.problem()).unwrap();
        let error = solver.factorize(&assembled.values()).unwrap_err();
        assert!(
            matches!(error, LinearError::Singular { equation: Some(_) }),
            "{error:?}"
        );
    }
}

/// Run with `--ignored --nocapture`: seconds for a block of 50,000 equations.
#[test]
#[ignore = "a measurement, not a check"]
fn timing_of_fifty_thousand_equations() {
    let clock = std::time::Instant::now;
    for (name, n) in [("block", [25, 25, 25]), ("plate", [73, 73, 3])] {
        let system = clamped_block(n, [1.0; 3]);
        let from = clock();
        let assembled = system.assemble();
        println!(
            "{name}: {} equations, pattern and values {:?}",
            assembled.nequation,
            from.elapsed()
        );
        for ordering in [Ordering::NestedDissection, Ordering::MinimumDegree] {
            let mut solver = Direct::with_ordering(ordering);
            let from = clock();
            solver.analyze(&assembled.problem()).unwrap();
            let analyze = from.elapsed();
            let from = clock();
            solver.analyze(&assembled.problem()).unwrap();
            let again = from.elapsed();
            let from = clock();
            solver.factorize(&assembled.values()).unwrap();
            let factorize = from.elapsed();
            let rhs = Random(1).vector(assembled.nequation);
            let mut x = rhs.clone();
            let from = clock();
            let report = solver
                .solve(&assembled.values(), &rhs, &mut x, 1e-10)
                .unwrap();
            println!(
                "  {ordering:?}: analyze {analyze:?} (again {again:?}), factorize {factorize:?}, solve {:?}, \
                 factor {:.1} M, residual {:.1e}",
                from.elapsed(),
                solver.size().0 as f64 / 1e6,
                report.residual
            );
        }
        for symmetry in [
            Symmetry::Definite,
            Symmetry::Symmetric,
            Symmetry::Unsymmetric,
        ] {
            let problem = Problem {
                symmetry,
                ..assembled.problem()
            };
            for entry in SOLVERS.iter().filter(|s| s.kind != LinearKind::Auto) {
                let mut solver = (entry.build)();
                solver.analyze(&problem).unwrap();
                let from = clock();
                solver.factorize(&assembled.values()).unwrap();
                println!(
                    "  {symmetry:?}, {}: factorize {:?}",
                    entry.name,
                    from.elapsed()
                );
            }
        }
    }
}
