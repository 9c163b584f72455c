//! Motions that cost no force are found and named; what only looks like one is solved.

use super::*;

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
