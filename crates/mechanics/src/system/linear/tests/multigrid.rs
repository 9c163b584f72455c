//! Multigrid against the direct solver, and against itself: iterations do not grow with stiffness of contact or size.

use super::super::Multigrid;
use super::*;

/// A system of blocks with the places of its nodes.
struct Placed {
    system: System,
    coordinates: Vec<[f64; 3]>,
}

impl Placed {
    fn problem<'a>(&'a self, assembled: &'a Assembled) -> Problem<'a> {
        Problem {
            coordinates: &self.coordinates,
            ..assembled.problem()
        }
    }
}

/// The places of the nodes of blocks of unit bricks on top of each other.
fn places(n: [usize; 3], nblock: usize) -> Vec<[f64; 3]> {
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
fn pressed(n: [usize; 3], penalty: f64, sticks: bool, floats: bool) -> Placed {
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
fn solve(placed: &Placed, solver: &mut Multigrid) -> (bool, SolveReport, Vec<f64>) {
    let (report, x) = compare(placed, solver);
    (solver.is_multigrid(), report, x)
}

/// Solves, and compares with the direct solver.
fn compare(placed: &Placed, solver: &mut dyn LinearSolver) -> (SolveReport, Vec<f64>) {
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

#[test]
fn iterations_do_not_grow_with_the_stiffness_of_contact() {
    for sticks in [false, true] {
        let counts = [1.0, 1e2, 1e4, 1e6].map(|penalty| {
            let placed = pressed([10, 9, 8], penalty, sticks, false);
            let (multigrid, report, _) = solve(&placed, &mut Multigrid::new());
            assert!(multigrid, "{penalty}");
            report.iterations
        });
        println!("sticks {sticks}: {counts:?}");
        let most = counts.into_iter().max().unwrap() as f64;
        assert!(most <= 1.2 * counts[0] as f64 && most <= 25.0, "{counts:?}");
    }
}

#[test]
fn iterations_grow_slowly_with_size() {
    let count = |n: usize, penalty: f64| {
        let placed = pressed([n, n, n], penalty, false, false);
        let (multigrid, report, _) = solve(&placed, &mut Multigrid::new());
        assert!(multigrid);
        report.iterations
    };
    // measured: 10, 10, 13 without contact; 15, 20, 30 with a wide flat one, of which the block knows one layer
    for (penalty, most) in [(0.0, [11, 11, 14]), (10.0, [16, 21, 31])] {
        let counts = [6, 10, 18].map(|n| count(n, penalty));
        println!("{penalty}: {counts:?}");
        let within = counts.iter().zip(most).all(|(count, most)| *count <= most);
        assert!(within, "{penalty}: {counts:?}");
    }
}

#[test]
fn a_body_held_by_contact_alone_is_solved() {
    for penalty in [1.0, 1e3] {
        let placed = pressed([8, 8, 8], penalty, true, true);
        let (_, report, _) = solve(&placed, &mut Multigrid::new());
        println!("{penalty:e}: {report:?}");
    }
}

#[test]
fn friction_is_solved_by_minimal_residuals() {
    for mu in [0.3, 1.0] {
        let n = [9, 8, 7];
        let placed = Placed {
            system: slipping_blocks(n, 100.0, mu),
            coordinates: places(n, 2),
        };
        let (multigrid, report, _) = solve(&placed, &mut Multigrid::new());
        println!("{mu}: {report:?}");
        assert!(multigrid && report.iterations <= 20, "{mu}: {report:?}");
    }
}

#[test]
fn bits_do_not_depend_on_threads() {
    // enough nodes for two parts
    let placed = pressed([21, 20, 11], 10.0, false, false);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| solve(&placed, &mut Multigrid::new()).2)
    };
    let one = run(1);
    for threads in [2, 3] {
        assert!(run(threads) == one, "{threads} threads");
    }
}

#[test]
fn a_hierarchy_serves_changed_values_and_is_made_anew_where_it_is_worn() {
    let placed = pressed([10, 10, 10], 10.0, false, false);
    let mut solver = Multigrid::new();
    let first = solve(&placed, &mut solver).1.iterations;
    // the same body, half of it much stiffer: worse at first, as good as new at last
    let mut changed = pressed([10, 10, 10], 10.0, false, false);
    for (nodes, matrix) in &mut changed.system.bulk {
        if changed.coordinates[nodes[0] as usize][0] >= 5.0 {
            matrix.iter_mut().for_each(|v| *v *= 100.0);
        }
    }
    let counts: Vec<usize> = (0..4)
        .map(|_| solve(&changed, &mut solver).1.iterations)
        .collect();
    println!("{first}, then {counts:?}");
    assert!(
        counts[0] > counts[3] && counts[3] <= first + 4,
        "{first} {counts:?}"
    );
}

#[test]
fn hierarchies_outlive_contact_and_increments_but_not_the_bodies() {
    let mut solver = Multigrid::new();
    let mut made = |placed: &Placed, forget: bool| {
        if forget {
            solver.forget();
        }
        assert!(solve(placed, &mut solver).0);
        let notes = solver.notes();
        let is_hierarchy = |note: &&Note| matches!(note, Note::Hierarchy { worn: None, .. });
        assert_eq!(notes.iter().filter(is_hierarchy).count(), notes.len());
        notes.len()
    };
    let placed = pressed([8, 8, 8], 10.0, false, false);
    assert_eq!(made(&placed, false), 1);
    assert_eq!(made(&placed, false), 0);
    // contact of another pattern, another increment
    let sticks = pressed([8, 8, 8], 10.0, true, false);
    assert_eq!(made(&sticks, false), 0);
    assert_eq!(made(&sticks, true), 0);
    // other bodies: as long as the increment lasts, the hierarchy serves
    let mut stiffer = pressed([8, 8, 8], 10.0, true, false);
    for (_, matrix) in &mut stiffer.system.bulk {
        matrix.iter_mut().for_each(|v| *v *= 1.1);
    }
    assert_eq!(made(&stiffer, false), 0);
    assert_eq!(made(&stiffer, true), 1);
}

#[test]
fn a_rough_solution_is_less_work() {
    for mu in [0.0, 0.5] {
        let n = [9, 8, 7];
        let system = if mu > 0.0 {
            slipping_blocks(n, 100.0, mu)
        } else {
            pressed(n, 100.0, false, false).system
        };
        let placed = Placed {
            system,
            coordinates: places(n, 2),
        };
        let assembled = placed.system.assemble();
        let rhs = Random(3).vector(assembled.nequation);
        let (mut x, mut exact) = (rhs.clone(), rhs.clone());
        let mut solver = Multigrid::new();
        solver.analyze(&placed.problem(&assembled)).unwrap();
        solver.factorize(&assembled.values()).unwrap();
        let rough = solver.solve_roughly(&assembled.values(), &rhs, &mut x, 0.1);
        let full = solver.solve(&assembled.values(), &rhs, &mut exact, 1e-12);
        let (rough, full) = (rough.unwrap(), full.unwrap());
        println!("{mu}: {} and {}", rough.iterations, full.iterations);
        assert!(0 < rough.iterations && 3 * rough.iterations <= full.iterations);
        let off = x.iter().zip(&exact).map(|(x, y)| (x - y).abs());
        let off = off.fold(0.0, f64::max) / largest(&exact);
        assert!(off > 1e-9 && off < 0.3, "{off:e}");
    }
}

#[test]
fn multipliers_are_condensed_or_in_the_block() {
    let n = [8, 8, 8];
    let mut tied = Placed {
        system: tied_blocks(n, [1.0, 5.0]),
        coordinates: places(n, 2),
    };
    // the upper block hangs on them alone, or is held at its top as well
    compare(&tied, &mut Condensed::new(Multigrid::new));
    let end = 6 * nnode(n) as u32;
    tied.system.held.extend(end - 3 * 81..end);
    let mut solver = Condensed::new(Multigrid::new);
    let (report, _) = compare(&tied, &mut solver);
    println!("condensed: {report:?}");
    assert!(
        solver.inner().is_multigrid() && report.iterations <= 40,
        "{report:?}"
    );
    let (multigrid, report, _) = solve(&tied, &mut Multigrid::new());
    println!("in the block: {report:?}");
    assert!(multigrid && report.iterations <= 40, "{report:?}");
}

#[test]
fn what_does_not_suit_is_solved_directly() {
    // in the plane
    let n = [6, 6, 0];
    let mut plane = Placed {
        system: System::new(nnode(n), 2, 0, Symmetry::Definite),
        coordinates: places(n, 1),
    };
    let spring = |row: usize, column: usize| match (row % 2 == column % 2, row == column) {
        (true, true) => 1.0,
        (true, false) => -1.0,
        _ => 0.0,
    };
    let matrix: Vec<f64> = (0..16).map(|k| spring(k / 4, k % 4)).collect();
    let bars = (1..nnode(n) as u32).map(|node| (vec![node - 1, node], matrix.clone()));
    plane.system.bulk.extend(bars);
    plane.system.held = vec![0, 1];
    assert!(!solve(&plane, &mut Multigrid::new()).0);
    // a tangent that is indefinite
    let mut buckled = pressed([6, 6, 6], 10.0, false, false);
    let ndof = buckled.system.ndof as u32;
    let push = (0..ndof).map(|dof| (vec![dof], vec![-0.5]));
    buckled.system.interface.extend(push);
    solve(&buckled, &mut Multigrid::new());
}

#[test]
fn a_free_body_is_singular_at_last() {
    let mut placed = pressed([4, 4, 4], 1.0, false, true);
    placed.system.held.truncate(0);
    let assembled = placed.system.assemble();
    let mut solver = Multigrid::new();
    solver.analyze(&placed.problem(&assembled)).unwrap();
    let rhs = Random(3).vector(assembled.nequation);
    let mut x = vec![0.0; rhs.len()];
    let factor = solver.factorize(&assembled.values());
    let outcome = factor.and_then(|()| solver.solve(&assembled.values(), &rhs, &mut x, 1e-10));
    assert!(
        matches!(outcome, Err(LinearError::Singular { .. })),
        "{outcome:?}"
    );
}
