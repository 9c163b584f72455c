//! Systems of springs, blocks and contact for the tests of solvers.

use super::*;

/// A generator with a fixed seed, so that a failure can be repeated: uniform in [-1, 1).
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub(super) fn below(&mut self, n: usize) -> usize {
        (((self.next() + 1.0) / 2.0 * n as f64) as usize).min(n - 1)
    }

    pub(super) fn vector(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.next()).collect()
    }
}

/// A system as a list of element matrices; everything else is made from it.
#[derive(Clone)]
pub(super) struct System {
    pub(super) nnode: usize,
    pub(super) block: usize,
    pub(super) ndof: usize,
    pub(super) symmetry: Symmetry,
    /// Members and row-major matrix over their `block` dofs each.
    pub(super) bulk: Vec<(Vec<u32>, Vec<f64>)>,
    /// Raw dofs and row-major matrix.
    pub(super) interface: Vec<(Vec<u32>, Vec<f64>)>,
    pub(super) held: Vec<u32>,
    pub(super) multiplier_from: usize,
}

#[derive(Clone)]
pub(super) struct Assembled {
    pub(super) bulk: BlockPattern,
    pub(super) interface: Pattern,
    pub(super) bulk_values: Vec<f64>,
    pub(super) interface_values: Vec<f64>,
    pub(super) equation: Vec<u32>,
    pub(super) nequation: usize,
    pub(super) sign: Vec<i8>,
    pub(super) ndof: usize,
    pub(super) symmetry: Symmetry,
}

pub(super) fn cliques(elements: &[(Vec<u32>, Vec<f64>)]) -> (Vec<u32>, Vec<usize>) {
    let mut offsets = vec![0];
    let mut members = Vec::new();
    for (clique, _) in elements {
        members.extend_from_slice(clique);
        offsets.push(members.len());
    }
    (members, offsets)
}

impl System {
    pub(super) fn new(nnode: usize, block: usize, nextra: usize, symmetry: Symmetry) -> Self {
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
    pub(super) fn random(
        nnode: usize,
        block: usize,
        nextra: usize,
        symmetry: Symmetry,
        seed: u64,
    ) -> Self {
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

    pub(super) fn assemble(&self) -> Assembled {
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
    pub(super) fn dense_raw(&self) -> Mat<f64> {
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

    pub(super) fn dense(&self) -> Mat<f64> {
        let raw = self.dense_raw();
        let free: Vec<usize> = (0..self.ndof)
            .filter(|&dof| !self.held.contains(&(dof as u32)))
            .collect();
        Mat::from_fn(free.len(), free.len(), |i, j| raw[(free[i], free[j])])
    }
}

impl Assembled {
    pub(super) fn problem(&self) -> Problem<'_> {
        Problem {
            ndof: self.ndof,
            bulk: &self.bulk,
            interface: &self.interface,
            fields: &[],
            equation: &self.equation,
            nequation: self.nequation,
            symmetry: self.symmetry,
            sign: &self.sign,
            coordinates: &[],
            between: &[],
        }
    }

    pub(super) fn values(&self) -> Values<'_> {
        Values {
            bulk: &self.bulk_values,
            interface: &self.interface_values,
        }
    }
}

pub(super) fn random_matrix(n: usize, symmetry: Symmetry, random: &mut Random) -> Vec<f64> {
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
pub(super) fn solvers() -> impl Iterator<Item = Box<dyn LinearSolver>> {
    let kinds = SOLVERS.iter().filter(|s| s.kind != LinearKind::Auto);
    kinds.map(|s| (s.build)())
}

/// Solves and compares with the dense oracle; the report comes back.
pub(super) fn check(
    system: &System,
    solver: &mut dyn LinearSolver,
    seed: u64,
    tolerance: f64,
) -> SolveReport {
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
pub(super) fn brick(h: [f64; 3]) -> Vec<f64> {
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
pub(super) fn add_block(system: &mut System, n: [usize; 3], h: [f64; 3], young: f64, first: usize) {
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

pub(super) fn nnode(n: [usize; 3]) -> usize {
    (n[0] + 1) * (n[1] + 1) * (n[2] + 1)
}

/// A block clamped at its bottom.
pub(super) fn clamped_block(n: [usize; 3], h: [f64; 3]) -> System {
    let mut system = System::new(nnode(n), 3, 0, Symmetry::Definite);
    add_block(&mut system, n, h, 1.0, 0);
    system.held = (0..3 * (n[0] + 1) as u32 * (n[1] + 1) as u32).collect();
    system
}

/// Two blocks on top of each other, the lower clamped, tied node to node by multipliers in all directions.
pub(super) fn tied_blocks(n: [usize; 3], young: [f64; 2]) -> System {
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

/// Two blocks on top of each other that slip: a penalty between them, and friction of `mu` times its force.
pub(super) fn slipping_blocks(n: [usize; 3], penalty: f64, mu: f64) -> System {
    slipping_blocks_of([1.0, 20.0], n, penalty, mu)
}

/// The same with these Young's moduli below and above.
pub(super) fn slipping_blocks_of(young: [f64; 2], n: [usize; 3], penalty: f64, mu: f64) -> System {
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
