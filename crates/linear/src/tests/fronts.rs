//! LU by fronts: that it is what solves, that its bits do not depend on threads, and what it leaves to others.

use super::*;

/// Solves; whether fronts did it, and the solution.
fn solve(system: &System, tolerance: f64) -> (bool, Vec<f64>) {
    let assembled = system.assemble();
    let rhs = Random(3).vector(assembled.nequation);
    let mut x = vec![f64::NAN; rhs.len()];
    let mut solver = Direct::reproducible();
    solver.analyze(&assembled.problem()).unwrap();
    solver.factorize(&assembled.values()).unwrap();
    let report = solver.solve(&assembled.values(), &rhs, &mut x, 1e-12);
    let report = report.unwrap();
    assert!(report.residual <= tolerance, "{report:?}");
    (!solver.uses_lu(), x)
}

#[test]
fn friction_and_multipliers_are_solved_by_fronts() {
    let mut tied = tied_blocks([7, 6, 5], [1.0, 50.0]);
    tied.symmetry = Symmetry::Unsymmetric;
    let slipping = slipping_blocks([7, 6, 5], 100.0, 0.9);
    for system in [&tied, &slipping] {
        assert!(solve(system, 1e-12).0);
    }
    // multipliers whose pattern names nodes that they do not act on, some of them first
    let n = nnode([7, 6, 5]) as u32;
    for (dofs, row) in &mut tied.interface {
        let k = dofs.len();
        let wide: Vec<u32> = [0, 3, 6].map(|d| d + dofs[1] % 3).into();
        let value = |at: usize| {
            let (i, j) = (at / (k + 3), at % (k + 3));
            if i < 3 || j < 3 {
                0.0
            } else {
                row[(i - 3) * k + j - 3]
            }
        };
        let values: Vec<f64> = (0..(k + 3) * (k + 3)).map(value).collect();
        assert!(wide.iter().all(|d| d / 3 < n));
        *dofs = [wide, std::mem::take(dofs)].concat();
        *row = values;
    }
    assert!(solve(&tied, 1e-12).0);
}

#[test]
fn bits_of_fronts_do_not_depend_on_threads() {
    // enough for subtrees of their own and for strips of a front
    let system = slipping_blocks([15, 14, 9], 100.0, 0.5);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| solve(&system, 1e-12))
    };
    let one = run(1);
    assert!(one.0);
    for threads in [2, 5] {
        assert!(run(threads) == one, "{threads} threads");
    }
}

#[test]
fn another_order_is_found_where_values_change() {
    // one multiplier, tied to one of two springs at a time
    let system = |first: f64| {
        let mut system = System::new(2, 3, 1, Symmetry::Unsymmetric);
        system.multiplier_from = 6;
        system.held = vec![1, 2, 4, 5];
        system
            .bulk
            .push((vec![0], vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]));
        system
            .bulk
            .push((vec![1], vec![2.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]));
        let [a, b] = [first, 1.0 - first];
        let row = vec![0.0, 0.0, a, 0.0, 0.0, b, a, b, 0.0];
        system.interface.push((vec![0, 3, 6], row));
        system
    };
    let mut solver = Direct::reproducible();
    for first in [1.0, 0.0, 1.0] {
        let assembled = system(first).assemble();
        let mut x = vec![0.0; assembled.nequation];
        let rhs = [1.0, 3.0, 0.5];
        solver.analyze(&assembled.problem()).unwrap();
        solver.factorize(&assembled.values()).unwrap();
        solver
            .solve(&assembled.values(), &rhs, &mut x, 1e-14)
            .unwrap();
        // the tied one moves by ½ and carries the rest, the other one has its spring
        let expected = if first > 0.5 {
            [0.5, 1.5, 0.5]
        } else {
            [1.0, 0.5, 2.0]
        };
        assert!(!solver.uses_lu());
        for (x, expected) in x.iter().zip(expected) {
            assert!((x - expected).abs() < 1e-14, "{first}: {x} {expected}");
        }
    }
}

#[test]
fn blocks_without_pivots_are_solved_by_free_choice_or_by_refinement() {
    // pairs of unknowns, each in the equation of the other one's
    let n = 40;
    let mut system = System::new(n, 1, 0, Symmetry::Unsymmetric);
    for i in 0..n as u32 {
        let other = (i + n as u32 / 2) % n as u32;
        system
            .interface
            .push((vec![i, other], vec![0.0, 1.0 + f64::from(i), 0.0, 0.0]));
    }
    let (_, x) = solve(&system, 1e-12);
    assert!(x.iter().all(|x| x.is_finite()));
}

/// A grid of blocks of three unknowns each, of which every `period`-th has the rank 1 and is regular by its neighbours alone.
fn grid_with_singular_blocks(n: usize, period: usize) -> System {
    let mut system = System::new(n * n, 3, 0, Symmetry::Unsymmetric);
    system.bulk = (0..n * n).map(|k| (vec![k as u32], vec![0.0; 9])).collect();
    let mut random = Random(5);
    for j in 0..n {
        for i in 0..n {
            let node = j * n + i;
            let dofs = |node: usize| (0..3).map(move |c| (3 * node + c) as u32);
            let mut block = random.vector(9);
            let is_singular = node.is_multiple_of(period);
            for (k, entry) in block.iter_mut().enumerate() {
                let (row, column) = (k / 3, k % 3);
                *entry = match is_singular {
                    true => (row as f64 + 1.0) * (column as f64 - 0.5),
                    false => *entry + if row == column { 4.0 } else { 0.0 },
                };
            }
            system.interface.push((dofs(node).collect(), block));
            for (a, b) in [(i + 1, j), (i, j + 1)] {
                if a < n && b < n {
                    let both: Vec<u32> = dofs(node).chain(dofs(b * n + a)).collect();
                    let mut values = random.vector(36);
                    for (k, entry) in values.iter_mut().enumerate() {
                        if (k / 6 < 3) == (k % 6 < 3) {
                            *entry = 0.0;
                        }
                    }
                    system.interface.push((both, values));
                }
            }
        }
    }
    system
}

#[test]
fn a_singular_block_of_a_regular_matrix_needs_no_free_choice_of_pivots() {
    for (n, period) in [(6, 36), (9, 40), (12, 37), (15, 50)] {
        let system = grid_with_singular_blocks(n, period);
        let (by_fronts, _) = solve(&system, 1e-12);
        assert!(by_fronts, "{n} x {n} blocks, every {period}-th singular");
        let assembled = system.assemble();
        let mut solver = Direct::rough();
        solver.analyze(&assembled.problem()).unwrap();
        solver.factorize(&assembled.values()).unwrap();
        assert!(solver.is_rough());
        let left = solver.leaves(&signs(assembled.nequation));
        assert!(left < 0.05, "{n}: {left}");
    }
}

/// A right-hand side of ones and minus ones.
fn signs(n: usize) -> Vec<f64> {
    let signs = [1.0, -1.0, 1.0, 1.0, -1.0].into_iter().cycle();
    signs.take(n).collect()
}

#[test]
fn factors_in_single_precision_serve_where_they_suffice() {
    let system = slipping_blocks([7, 6, 5], 100.0, 0.9);
    let assembled = system.assemble();
    let rhs = Random(3).vector(assembled.nequation);
    let solve = |solver: &mut Direct| {
        let mut x = vec![0.0; rhs.len()];
        solver.factorize(&assembled.values()).unwrap();
        let report = solver.solve(&assembled.values(), &rhs, &mut x, 1e-12);
        assert!(report.unwrap().residual <= 1e-12);
        x
    };
    let mut solver = Direct::rough();
    solver.analyze(&assembled.problem()).unwrap();
    let rough = solve(&mut solver);
    assert!(solver.is_rough());
    let right = signs(assembled.nequation);
    let left = solver.leaves(&right);
    assert!((1e-9..1e-3).contains(&left), "{left}");
    // in double precision until it is asked to forget
    solver.widen();
    let wide = solve(&mut solver);
    assert!(!solver.is_rough() && solver.leaves(&right) < 1e-10);
    let mut plain = Direct::reproducible();
    plain.analyze(&assembled.problem()).unwrap();
    assert_eq!(solve(&mut plain), wide);
    solver.forget();
    assert_eq!(solve(&mut solver), rough);
    assert!(solver.is_rough());
}

#[test]
fn what_a_factor_in_single_precision_leaves_shows_pivots_that_cancel() {
    // pairs of unknowns, of which little is left of the second one
    let n = 40;
    let mut system = System::new(n, 1, 0, Symmetry::Unsymmetric);
    for i in 0..n as u32 / 2 {
        let rows = vec![1.0, 1.0, 1.0, 1.0 + 1e-6];
        system.interface.push((vec![2 * i, 2 * i + 1], rows));
    }
    let assembled = system.assemble();
    let mut solver = Direct::rough();
    solver.analyze(&assembled.problem()).unwrap();
    solver.factorize(&assembled.values()).unwrap();
    assert!(solver.is_rough() && solver.leaves(&signs(assembled.nequation)) > 0.1);
    solver.widen();
    solver.factorize(&assembled.values()).unwrap();
    assert!(!solver.is_rough() && !solver.uses_lu());
    assert!(solver.leaves(&signs(assembled.nequation)) < 1e-8);
}

#[test]
fn couplings_that_fade_leave_normal_numbers() {
    // a square of unknowns that hardly know those next to them: what fills in are powers of the coupling
    let n = 24;
    let mut system = System::new(n * n, 1, 0, Symmetry::Unsymmetric);
    let at = |i: usize, j: usize| (j * n + i) as u32;
    for j in 0..n {
        for i in 0..n {
            system.interface.push((vec![at(i, j)], vec![1.0]));
            for other in [(i + 1, j), (i, j + 1)] {
                if other.0 < n && other.1 < n {
                    let both = vec![at(i, j), at(other.0, other.1)];
                    system.interface.push((both, vec![0.0, 3e-9, 2e-9, 0.0]));
                }
            }
        }
    }
    let assembled = system.assemble();
    let mut solver = Direct::rough();
    solver.analyze(&assembled.problem()).unwrap();
    solver.factorize(&assembled.values()).unwrap();
    assert!(solver.is_rough());
    assert_eq!(solver.nsubnormal(), 0);
    assert!(solver.leaves(&signs(assembled.nequation)) < 1e-7);
}
