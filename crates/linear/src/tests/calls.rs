//! The calls of a solver: their order, their lists, what they keep, and the same bits again.

use super::*;

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
fn measure_fifty_thousand_equations() {
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
