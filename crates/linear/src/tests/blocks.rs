//! Blocks and a round head that press on each other, with what multigrid knows of them.

use super::*;

/// A system of blocks with the places of its nodes.
#[derive(Clone)]
pub(super) struct Placed {
    pub(super) system: System,
    pub(super) coordinates: Vec<[f64; 3]>,
}

impl Placed {
    pub(super) fn problem<'a>(&'a self, assembled: &'a Assembled) -> Problem<'a> {
        Problem {
            coordinates: &self.coordinates,
            ..assembled.problem()
        }
    }
}

/// The places of the nodes of blocks of unit bricks on top of each other.
pub(super) fn places(n: [usize; 3], nblock: usize) -> Vec<[f64; 3]> {
    let mut all = Vec::new();
    for block in 0..nblock {
        for z in 0..=n[2] {
            for y in 0..=n[1] {
                let z = (z + block * n[2]) as f64;
                all.extend((0..=n[0]).map(|x| [x as f64, y as f64, z]));
            }
        }
    }
    all
}

/// Two blocks, the lower clamped; where they meet, springs along z (and across, where they stick) over a part of the
/// nodes. The upper one is clamped at its top, or held by nothing but springs.
pub(super) fn pressed(n: [usize; 3], penalty: f64, sticks: bool, floats: bool) -> Placed {
    let layer = (n[0] + 1) * (n[1] + 1);
    let mut system = System::new(2 * nnode(n), 3, 0, Symmetry::Definite);
    add_block(&mut system, n, [1.0; 3], 1.0, 0);
    add_block(&mut system, n, [1.0; 3], 3.0, nnode(n));
    let top = 3 * (2 * nnode(n) - layer) as u32;
    let above = if floats {
        0..0
    } else {
        top..system.ndof as u32
    };
    system.held = (0..3 * layer as u32).chain(above).collect();
    for node in 0..layer {
        let [x, y] = [node % (n[0] + 1), node / (n[0] + 1)];
        if 4 * x > 3 * n[0] || 4 * y > 3 * n[1] {
            continue;
        }
        let lower = 3 * (nnode(n) - layer + node) as u32;
        let upper = 3 * (nnode(n) + node) as u32;
        for axis in if sticks { 0..3 } else { 2..3 } {
            let spring = vec![penalty, -penalty, -penalty, penalty];
            system
                .interface
                .push((vec![lower + axis, upper + axis], spring));
        }
    }
    Placed {
        system,
        coordinates: places(n, 2),
    }
}

/// Solves; whether multigrid did it at last, and the report.
pub(super) fn solve(placed: &Placed, solver: &mut Multigrid) -> (bool, SolveReport, Vec<f64>) {
    let (report, x) = compare(placed, solver);
    (solver.is_multigrid(), report, x)
}

/// Solves, and compares with the direct solver.
pub(super) fn compare(placed: &Placed, solver: &mut dyn LinearSolver) -> (SolveReport, Vec<f64>) {
    let assembled = placed.system.assemble();
    let rhs = Random(3).vector(assembled.nequation);
    let mut x = vec![f64::NAN; rhs.len()];
    solver.analyze(&placed.problem(&assembled)).unwrap();
    solver.factorize(&assembled.values()).unwrap();
    let report = solver
        .solve(&assembled.values(), &rhs, &mut x, 1e-10)
        .unwrap();
    let mut direct = Direct::reproducible();
    let mut y = vec![f64::NAN; rhs.len()];
    direct.analyze(&assembled.problem()).unwrap();
    direct.factorize(&assembled.values()).unwrap();
    direct
        .solve(&assembled.values(), &rhs, &mut y, 1e-12)
        .unwrap();
    let off = x.iter().zip(&y).map(|(x, y)| (x - y).abs());
    let off = off.fold(0.0, f64::max) / largest(&y);
    assert!(off < 1e-6, "off by {off:e}");
    // stiffnesses of a million leave more to rounding
    assert!(report.residual <= 1e-8, "{report:?}");
    (report, x)
}

/// Holds every unknown of the upper block by a spring to the ground, as viscous forces do.
pub(super) fn damp(placed: &mut Placed, n: [usize; 3], stiffness: f64) {
    for dof in 3 * nnode(n) as u32..placed.system.ndof as u32 {
        placed.system.interface.push((vec![dof], vec![stiffness]));
    }
}

/// Lines of `even` cells of a size, and of others that grow up to an end.
pub(super) fn graded(size: f64, even: usize, others: usize, end: f64) -> Vec<f64> {
    let reach = |growth: f64| {
        let grown = (1..=others as i32).map(|k| growth.powi(k));
        size * (even as f64 + grown.sum::<f64>())
    };
    let (mut low, mut high) = (1.0, 20.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if reach(middle) < end {
            low = middle;
        } else {
            high = middle;
        }
    }
    let mut lines: Vec<f64> = (0..=even).map(|k| size * k as f64).collect();
    let mut cell = size;
    for _ in 0..others {
        cell *= low;
        lines.push(lines[lines.len() - 1] + cell);
    }
    lines
}

/// A block of bricks between lines, its numbers from `first` on.
pub(super) fn add_graded(placed: &mut Placed, lines: [&[f64]; 3], first: usize) {
    let n = lines.map(|l| l.len() - 1);
    let node =
        |x: usize, y: usize, z: usize| (first + (z * (n[1] + 1) + y) * (n[0] + 1) + x) as u32;
    for &z in lines[2] {
        for &y in lines[1] {
            let places = lines[0].iter().map(|&x| [x, y, z]);
            placed.coordinates.extend(places);
        }
    }
    for z in 0..n[2] {
        for y in 0..n[1] {
            for x in 0..n[0] {
                let at = [x, y, z];
                let h = std::array::from_fn(|i| lines[i][at[i] + 1] - lines[i][at[i]]);
                let corner = |a: usize| node(x + (a & 1), y + (a >> 1 & 1), z + (a >> 2));
                let nodes = (0..8).map(corner).collect();
                placed.system.bulk.push((nodes, brick(h)));
            }
        }
    }
}

/// A quarter of two blocks that touch in a circle of radius 8, finer there, cells of the two not matching: two ends to
/// end, with a spring of `penalty` times E over the size of a cell below each node of the upper one. Its middle planes, base
/// and head are held across, or base and head altogether.
pub(super) fn round_contact(n: usize, penalty: f64, clamped: bool) -> Placed {
    let (even, end) = (n * 11 / 20, 64.0);
    let size = 12.0 / even as f64;
    let across = graded(size, even, n - even, end);
    let below = graded(12.0 / (even - 1) as f64, even - 1, n - even, end);
    let layers = n * 17 / 20;
    let up = graded(1.2 * size, layers * 2 / 5, layers - layers * 2 / 5, end);
    let down: Vec<f64> = up.iter().rev().map(|z| -z).collect();
    let per_layer = [across.len() * across.len(), below.len() * below.len()];
    let [upper, lower] = per_layer.map(|count| count * up.len());
    let mut placed = Placed {
        system: System::new(upper + lower, 3, 0, Symmetry::Definite),
        coordinates: Vec::new(),
    };
    add_graded(&mut placed, [&across, &across, &up], 0);
    add_graded(&mut placed, [&below, &below, &down], upper);
    let at_end = |x: &[f64; 3]| x[2].abs() > end - 1e-6;
    let held = |(node, x): (usize, &[f64; 3])| {
        let plane = |axis: usize| !clamped && axis < 2 && x[axis] == 0.0;
        let is_held = |&axis: &usize| plane(axis) || at_end(x) && (clamped || axis == 2);
        let axes: Vec<u32> = (0..3)
            .filter(is_held)
            .map(|a| (3 * node + a) as u32)
            .collect();
        axes
    };
    let nodes = placed.coordinates.iter().enumerate();
    placed.system.held = nodes.flat_map(held).collect();
    let top = upper + lower - per_layer[1];
    for node in 0..per_layer[0] {
        let [x, y, _] = placed.coordinates[node];
        if x.hypot(y) >= 8.0 {
            continue;
        }
        let cell = |v: f64| below.partition_point(|line| *line <= v) - 1;
        let (i, j) = (cell(x), cell(y));
        let part = |v: f64, k: usize| (v - below[k]) / (below[k + 1] - below[k]);
        let (s, t) = (part(x, i), part(y, j));
        let corner =
            |di: usize, dj: usize| (3 * (top + (j + dj) * below.len() + i + di) + 2) as u32;
        let dofs = vec![
            (3 * node + 2) as u32,
            corner(0, 0),
            corner(1, 0),
            corner(0, 1),
            corner(1, 1),
        ];
        let gap = [
            1.0,
            -(1.0 - s) * (1.0 - t),
            -s * (1.0 - t),
            -(1.0 - s) * t,
            -s * t,
        ];
        let spring = gap.iter().flat_map(|a| gap.map(|b| penalty * size * a * b));
        placed.system.interface.push((dofs, spring.collect()));
    }
    placed
}

/// The right side where the head of the upper block, at this height, is moved along z.
pub(super) fn head_moved_at(height: f64, placed: &Placed, assembled: &Assembled) -> Vec<f64> {
    let head = placed
        .coordinates
        .iter()
        .map(|x| (x[2] - height).abs() < 1e-6);
    let moved = head.flat_map(|is_head| [0.0, 0.0, f64::from(u8::from(is_head))]);
    let moved: Vec<f64> = moved.collect();
    let mut forces = vec![0.0; moved.len()];
    apply(
        &assembled.bulk,
        &assembled.interface,
        &assembled.values(),
        &moved,
        &mut forces,
    );
    let mut rhs = vec![0.0; assembled.nequation];
    let equations = assembled.equation.iter().zip(&forces);
    for (&e, f) in equations.filter(|(e, _)| **e != NONE) {
        rhs[e as usize] = -f;
    }
    rhs
}

/// The same for the blocks of [`round_contact`].
pub(super) fn head_moved(placed: &Placed, assembled: &Assembled) -> Vec<f64> {
    head_moved_at(64.0, placed, assembled)
}

/// Iterations to 1e-8.
pub(super) fn count(placed: &Placed, rhs: impl Fn(&Assembled) -> Vec<f64>) -> usize {
    let assembled = placed.system.assemble();
    let rhs = rhs(&assembled);
    let mut x = vec![0.0; rhs.len()];
    let mut solver = Multigrid::new();
    solver.analyze(&placed.problem(&assembled)).unwrap();
    solver.factorize(&assembled.values()).unwrap();
    let report = solver.solve(&assembled.values(), &rhs, &mut x, 1e-8);
    let report = report.unwrap();
    println!("{} equations: {report:?}", assembled.nequation);
    assert!(solver.is_multigrid());
    report.iterations
}

pub(super) fn turned(by: [[f64; 3]; 3], x: &[f64]) -> [f64; 3] {
    by.map(|row| row.iter().zip(x).map(|(r, x)| r * x).sum())
}

/// Turns the matrix of a cell.
pub(super) fn turn_matrix(matrix: &mut [f64], by: [[f64; 3]; 3]) {
    let n = matrix.len().isqrt();
    // rows, then columns
    for column in 0..n {
        for k in (0..n).step_by(3) {
            let of = [0, 1, 2].map(|i| matrix[(k + i) * n + column]);
            for (i, v) in turned(by, &of).into_iter().enumerate() {
                matrix[(k + i) * n + column] = v;
            }
        }
    }
    for row in matrix.chunks_exact_mut(n) {
        for part in row.chunks_exact_mut(3) {
            let v = turned(by, part);
            part.copy_from_slice(&v);
        }
    }
}

/// Turns a system whose held nodes are held altogether.
pub(super) fn turn(placed: &mut Placed, by: [[f64; 3]; 3]) {
    for x in &mut placed.coordinates {
        *x = turned(by, x);
    }
    for (_, matrix) in &mut placed.system.bulk {
        turn_matrix(matrix, by);
    }
    // springs along what was the axis z
    let axis = [0, 1, 2].map(|i| by[i][2]);
    for (dofs, spring) in &mut placed.system.interface {
        let n = dofs.len();
        let nodes: Vec<u32> = dofs.iter().map(|d| d / 3).collect();
        let place = |k: usize| (k / 3, axis[k % 3]);
        let value = |k: usize| {
            let ((a, x), (b, y)) = (place(k / (3 * n)), place(k % (3 * n)));
            spring[a * n + b] * x * y
        };
        let all: Vec<f64> = (0..9 * n * n).map(value).collect();
        *dofs = nodes
            .iter()
            .flat_map(|node| (0..3).map(move |i| 3 * node + i))
            .collect();
        *spring = all;
    }
}

/// The same, but the upper block is turned about x by an angle.
pub(super) fn turned_above(placed: &Placed, angle: f64) -> Placed {
    let (s, c) = angle.sin_cos();
    let by = [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]];
    let mut turned = placed.clone();
    let upper = placed.coordinates.len() as u32 / 2;
    for (nodes, matrix) in &mut turned.system.bulk {
        if nodes[0] >= upper {
            turn_matrix(matrix, by);
        }
    }
    turned
}

/// Iterations and the solution in an increment of a step, where the solver is given the initial stiffness if it
/// asks.
pub(super) fn solve_from(
    which: u64,
    start: &Placed,
    now: &Placed,
    solver: &mut Multigrid,
) -> (usize, Vec<f64>) {
    let assembled = now.system.assemble();
    let rhs = Random(3).vector(assembled.nequation);
    let mut x = vec![0.0; rhs.len()];
    solver.forget();
    solver.analyze(&now.problem(&assembled)).unwrap();
    if solver.wants_start(which) {
        let at_start = start.system.assemble().values().bulk.to_vec();
        solver.start_from(which, StartStiffness::Values(at_start));
    }
    solver.factorize(&assembled.values()).unwrap();
    let report = solver.solve(&assembled.values(), &rhs, &mut x, 1e-8);
    assert!(solver.is_multigrid());
    (report.unwrap().iterations, x)
}

/// Iterations of a solution to a tenth and of an exact one, and the largest difference over the largest value.
pub(super) fn roughly(placed: &Placed, assembled: &Assembled, rhs: &[f64]) -> ([usize; 2], f64) {
    let [mut x, mut exact] = [0; 2].map(|_| vec![0.0; rhs.len()]);
    let mut solver = Multigrid::new();
    solver.analyze(&placed.problem(assembled)).unwrap();
    solver.factorize(&assembled.values()).unwrap();
    let rough = solver.solve_to(&assembled.values(), rhs, &mut x, 0.1, 0.0);
    let full = solver.solve(&assembled.values(), rhs, &mut exact, 1e-12);
    let off = x.iter().zip(&exact).map(|(x, y)| (x - y).abs());
    let off = off.fold(0.0, f64::max) / largest(&exact);
    ([rough, full].map(|report| report.unwrap().iterations), off)
}

/// Two plates of cells as high as a tenth of their width, clamped along one edge and held together across by multipliers at
/// every `every`th node of the other half.
pub(super) fn plates(n: [usize; 3], every: usize) -> Placed {
    let layer = (n[0] + 1) * (n[1] + 1);
    let at = |node: usize| [node % (n[0] + 1), node / (n[0] + 1)];
    let joined: Vec<usize> = (0..layer)
        .filter(|&node| 2 * at(node)[0] > n[0] && node % every == 0)
        .collect();
    let mut system = System::new(2 * nnode(n), 3, joined.len(), Symmetry::Unsymmetric);
    system.multiplier_from = 6 * nnode(n);
    for (block, young) in [1.0, 3.0].into_iter().enumerate() {
        add_block(&mut system, n, [1.0, 1.0, 0.1], young, block * nnode(n));
    }
    let clamped = (0..2 * nnode(n)).filter(|node| at(node % layer)[0] == 0);
    system.held = clamped
        .flat_map(|node| (0..3).map(move |axis| (3 * node + axis) as u32))
        .collect();
    for (number, node) in joined.into_iter().enumerate() {
        let lower = 3 * (nnode(n) - layer + node) + 2;
        let upper = 3 * (nnode(n) + node) + 2;
        let multiplier = system.multiplier_from + number;
        let row = vec![0.0, 0.0, -1.0, 0.0, 0.0, 1.0, -1.0, 1.0, 0.0];
        let dofs = [lower, upper, multiplier].map(|dof| dof as u32);
        system.interface.push((dofs.to_vec(), row));
    }
    let mut coordinates = places(n, 2);
    coordinates.iter_mut().for_each(|x| x[2] *= 0.1);
    Placed {
        system,
        coordinates,
    }
}
