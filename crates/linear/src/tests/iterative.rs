//! What every iterative solver promises besides its solutions.

use super::*;

/// The system as a solver takes it: with the rows of the bulk divided among its ranks, which are one in a test.
fn as_taken_by(solver: &dyn LinearSolver, assembled: &Assembled) -> Assembled {
    let bulk = match solver.iterative().and_then(|s| s.ranks()) {
        Some(ranks) => assembled.bulk.divided(ranks),
        None => assembled.bulk.clone(),
    };
    Assembled {
        bulk,
        ..assembled.clone()
    }
}

/// The iterative solvers of the table that iterate on a problem of this size, analyzed and factorized.
fn iterative(
    placed: &Placed,
    assembled: &Assembled,
) -> Vec<(&'static SolverEntry, Box<dyn LinearSolver>)> {
    let mut found = Vec::new();
    for entry in SOLVERS {
        let mut solver = (entry.build)();
        let taken = as_taken_by(solver.as_ref(), assembled);
        solver.analyze(&placed.problem(&taken)).unwrap();
        solver.factorize(&assembled.values()).unwrap();
        if solver.iterative().is_some_and(|s| s.iterates()) {
            found.push((entry, solver));
        }
    }
    assert!(!found.is_empty());
    found
}

/// The norm of the energy, by which errors of a definite system are measured.
fn energy(assembled: &Assembled, x: &[f64]) -> f64 {
    let mut raw = vec![0.0; assembled.ndof];
    for (raw, &e) in raw.iter_mut().zip(&assembled.equation) {
        *raw = x.get(e as usize).copied().unwrap_or(0.0);
    }
    let mut force = vec![0.0; assembled.ndof];
    apply(
        &assembled.bulk,
        &assembled.interface,
        &assembled.values(),
        &raw,
        &mut force,
    );
    let work: f64 = raw.iter().zip(&force).map(|(x, f)| x * f).sum();
    work.sqrt()
}

fn solve(solver: &mut dyn LinearSolver, assembled: &Assembled, rhs: &[f64]) -> Vec<f64> {
    let mut x = vec![0.0; rhs.len()];
    let values = assembled.values();
    solver.solve(&values, rhs, &mut x, EXACT).unwrap();
    x
}

#[test]
fn iterative_solvers_leave_the_part_of_the_error_that_is_asked_for() {
    let placed = pressed([9, 8, 7], 100.0, false, false);
    let assembled = placed.system.assemble();
    let rhs = Random(3).vector(assembled.nequation);
    for (_, mut solver) in iterative(&placed, &assembled) {
        let exact = solve(solver.as_mut(), &assembled, &rhs);
        let mut before = 0;
        for part in [0.3, 0.1, 1e-2, 1e-4] {
            let mut x = vec![0.0; rhs.len()];
            let iterative = solver.iterative_mut().unwrap();
            let report = iterative.solve_to(&assembled.values(), &rhs, &mut x, part, 0.0);
            let iterations = report.unwrap().iterations;
            let error: Vec<f64> = x.iter().zip(&exact).map(|(x, y)| x - y).collect();
            let left = energy(&assembled, &error) / energy(&assembled, &exact);
            println!("{part}: {left:.1e} after {iterations}");
            assert!(left <= part, "{part}: {left:e}");
            assert!(iterations > before, "{part}: {iterations}");
            before = iterations;
        }
    }
}

#[test]
fn iterative_solvers_stop_where_every_residual_is_small_enough() {
    let placed = pressed([6, 6, 6], 100.0, false, false);
    let assembled = placed.system.assemble();
    let rhs = Random(3).vector(assembled.nequation);
    for (_, mut solver) in iterative(&placed, &assembled) {
        let solver = solver.iterative_mut().unwrap();
        let mut count = |enough: f64| {
            let mut x = vec![0.0; rhs.len()];
            let report = solver.solve_to(&assembled.values(), &rhs, &mut x, 1e-8, enough);
            report.unwrap().iterations
        };
        let all = count(0.0);
        assert!(count(0.1 * largest(&rhs)) < all);
    }
}

#[test]
fn iterative_solvers_recall_their_experience() {
    for entry in SOLVERS {
        for experience in [0, 1] {
            if let Some(solver) = (entry.build)().iterative_mut() {
                solver.recall(experience);
                assert_eq!(solver.experience(), experience, "{}", entry.name);
            }
        }
    }
}

#[test]
fn heirs_solve_to_the_same_bits_as_new_solvers() {
    let placed = pressed([6, 6, 6], 100.0, false, false);
    let assembled = placed.system.assemble();
    let rhs = Random(3).vector(assembled.nequation);
    for (entry, mut before) in iterative(&placed, &assembled) {
        let expected = solve(before.as_mut(), &assembled, &rhs);
        let before = before.iterative_mut().unwrap();
        let is_noted = !before.notes().is_empty();
        assert!(is_noted && before.notes().is_empty());
        let heritage = before.bequeath().unwrap();
        let mut heir = (entry.build)();
        heir.iterative_mut().unwrap().inherit(heritage);
        let taken = as_taken_by(heir.as_ref(), &assembled);
        heir.analyze(&placed.problem(&taken)).unwrap();
        heir.factorize(&assembled.values()).unwrap();
        assert_eq!(solve(heir.as_mut(), &assembled, &rhs), expected);
        // the work of the first one is not done again
        assert!(heir.iterative_mut().unwrap().notes().is_empty());
    }
}

#[test]
fn heritage_of_another_type_is_dropped() {
    let placed = pressed([6, 6, 6], 100.0, false, false);
    let assembled = placed.system.assemble();
    let rhs = Random(3).vector(assembled.nequation);
    for (_, mut solver) in iterative(&placed, &assembled) {
        let expected = solve(solver.as_mut(), &assembled, &rhs);
        solver.iterative_mut().unwrap().inherit(Box::new(()));
        assert_eq!(solve(solver.as_mut(), &assembled, &rhs), expected);
    }
}
