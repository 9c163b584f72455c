//! Solvers against a dense oracle, on systems as terms assemble them.

mod blocks;
mod calls;
mod condensed;
mod fronts;
mod iterative;
mod multigrid;
mod scene;
mod singular;

use super::ordering::Ordering;
use super::*;
use crate::norm::largest;
use crate::sparsity::{BlockPattern, NONE, Pattern};
use blocks::*;
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use scene::*;

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
        // scales that go on from others are as good, and forgotten ones leave no trace
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
