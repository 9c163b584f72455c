//! The solvers that a case can choose.

use crate::support::{BRICK, change, command, read, run_text};
use std::path::Path;

/// The brick, its linear equations solved in this way.
fn solved_by(word: &str) -> String {
    let solver = format!("[solver]\nlinear = \"{word}\"\n[checkpoint]");
    change(BRICK, "[checkpoint]", &solver)
}

#[test]
fn a_solver_that_does_not_exist_is_refused() {
    run_text(&solved_by("iterative")).says(3, &["S0111", "linear = \"direct\"", "case.toml:"]);
    run_text(&solved_by("pardiso")).says(3, &["S0110", "mumps", "case.toml:"]);
}

#[test]
fn without_its_library_a_solver_is_refused_and_the_way_to_it_told() {
    let optional = [
        ("mumps", "mumps", cfg!(feature = "mumps")),
        ("petsc", "mpi", cfg!(feature = "mpi")),
    ];
    for (word, feature, is_built) in optional {
        let needs = format!("`linear = \"{word}\"` needs");
        let way = format!("--features {feature}");
        if !is_built {
            run_text(&solved_by(word)).says(3, &["S0111", &needs, "case.toml:", &way]);
        }
    }
}

/// The columns of the history, by name.
fn history(path: &Path) -> Vec<(String, Vec<f64>)> {
    let text = read(path);
    let mut rows = text.lines().map(|row| row.split(','));
    let names = rows.next().unwrap();
    let mut columns: Vec<_> = names.map(|name| (name.to_owned(), Vec::new())).collect();
    for row in rows {
        for ((_, column), value) in columns.iter_mut().zip(row) {
            column.push(value.parse().unwrap_or(f64::NAN));
        }
    }
    columns
}

/// The name of the vector that a column is a component of, else its own.
fn quantity(name: &str) -> &str {
    let vector = ["x", "y", "z"].iter().find_map(|i| name.strip_suffix(i));
    vector.unwrap_or(name)
}

/// Runs examples by direct solution and by another solver, and compares every number of their histories.
fn agree_in_every_history(word: &str, examples: &[&str], tolerance: f64) {
    for example in examples {
        let folder = tempfile::tempdir().unwrap();
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let case = root.join("examples").join(example).join("case.toml");
        let [ours, theirs] = ["direct", word].map(|word| {
            let out = folder.path().join(word);
            let mut run = command(folder.path());
            run.arg("run").arg(&case).arg("-o").arg(&out);
            run.args(["--set", &format!("solver.linear={word}")]);
            let ended = crate::support::Ended::from(run.output().unwrap());
            ended.says(0, &["✓ solved"]);
            history(&out.join("history.csv"))
        });
        assert!(ours.len() > 3 && ours[0].1.len() == theirs[0].1.len());
        let largest = |of: &str| {
            let columns = ours.iter().filter(|(name, _)| quantity(name) == of);
            let values = columns.flat_map(|(_, values)| values);
            values.fold(0.0, |max: f64, v| max.max(v.abs()))
        };
        let mut worst = 0.0;
        for ((name, a), (_, b)) in ours.iter().zip(&theirs) {
            let size = largest(quantity(name));
            // a gap that multipliers close is round-off of lengths of some millimetres
            if name.ends_with(".gap_min") && size < 1e-10 {
                continue;
            }
            let off = a.iter().zip(b).map(|(a, b)| (a - b).abs());
            let off = off.fold(0.0, f64::max);
            assert!(
                off <= tolerance * size,
                "{example}, {name}: {off:e} of {size:e}"
            );
            worst = f64::max(worst, off / size.max(f64::MIN_POSITIVE));
        }
        println!("{example}: {} columns agree to {worst:.1e}", ours.len());
    }
}

#[test]
fn multigrid_and_direct_solution_agree_in_every_history() {
    // definite; unsymmetric; with multipliers, which are left to direct solution
    let examples = [
        "paper_brick_symmetric_3d",
        "friction_loop_3d_node_to_segment",
        "two_blocks_2d",
    ];
    agree_in_every_history("multigrid", &examples, 1e-8);
}

#[cfg(feature = "mumps")]
mod mumps {
    use crate::support::{folder_with, read, result, run};

    #[test]
    fn mumps_and_the_default_solver_agree_in_every_history() {
        // definite, with multipliers, unsymmetric, and both of them
        let examples = [
            "two_blocks_2d",
            "trusses_2d_node_to_node",
            "friction_loop_3d_node_to_segment",
            "cattaneo_mindlin_2d_node_to_segment",
        ];
        super::agree_in_every_history("mumps", &examples, 1e-10);
    }

    #[test]
    fn the_resolved_case_keeps_the_word() {
        let text = super::solved_by("mumps");
        let folder = folder_with(&text);
        let ended = run(folder.path(), &["run", "case.toml"]);
        ended.says(0, &["✓ solved"]);
        let resolved = read(&result(&folder, "case.resolved.toml"));
        assert!(resolved.contains("linear = \"mumps\""), "{resolved}");
    }
}

#[cfg(feature = "mpi")]
#[test]
fn petsc_and_the_direct_solver_agree_in_every_history() {
    // bodies that float, a rigid body, friction, and the plane, which is solved without it
    let examples = [
        "paper_brick_arbitrary_3d",
        "patch_3d_mortar",
        "friction_loop_3d_node_to_segment",
        "two_blocks_2d",
    ];
    agree_in_every_history("petsc", &examples, 1e-8);
}
