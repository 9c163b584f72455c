//! The set is sound, and fails loudly where something is wrong.
#![allow(clippy::unwrap_used)]

use signorini_verification::report::{self, Signs};
use signorini_verification::{
    Frames, Judged, Problem, Setup, Tolerance, exit_code, problems, solve, solve_all, solve_as,
};
use std::collections::BTreeSet;

fn named(name: &str) -> Problem {
    *problems().iter().find(|one| one.name == name).unwrap()
}

/// The problems that are broken on purpose: a patch test, a closed form at large strain, another program's numbers.
const BROKEN: [&str; 3] = ["patch-quad4-mortar", "uniaxial-ogden", "paper-wedge"];

/// What must be true of a set in which one value does not agree.
fn assert_it_fails(judged: &Judged) {
    assert!(!judged.passed(), "{}", judged.problem.name);
    assert_eq!(exit_code(std::slice::from_ref(judged)), 1);
    assert!(report::problem(judged, Signs::Unicode).contains('✗'));
    assert!(report::problem(judged, Signs::Ascii).contains(" no\n"));
    let json = report::json(std::slice::from_ref(judged), 1.0);
    assert!(json.contains("\"ok\":false") && json.contains("\"exit_code\":1"));
    assert!(report::html(std::slice::from_ref(judged), 1.0).contains("class=\"no\">✗"));
}

#[test]
fn there_are_thirty_problems_and_fifteen_quick_ones_with_names_of_their_own() {
    let names: BTreeSet<&str> = problems().iter().map(|one| one.name).collect();
    assert_eq!(names.len(), problems().len());
    assert!(problems().len() >= 30);
    assert!(problems().iter().filter(|one| one.quick).count() >= 15);
    for name in names {
        let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        assert!(name.chars().all(plain) && name.len() <= 32, "{name}");
    }
}

#[test]
fn every_problem_says_what_it_is_about() {
    for one in problems() {
        let said = [
            one.title,
            one.source,
            one.goal,
            one.mesh,
            one.conditions,
            one.formula,
        ];
        assert!(said.iter().all(|text| text.len() >= 4), "{}", one.name);
        // in tables a bar would end a column
        assert!(
            said[..5].iter().all(|text| !text.contains('|')),
            "{}",
            one.name
        );
        assert!(one.source.len() >= 15, "{}: {}", one.name, one.source);
        assert_eq!(one.formula.matches('$').count() % 2, 0, "{}", one.name);
        assert!(one.title.chars().count() <= 72, "{}", one.title);
    }
}

#[test]
fn no_tolerance_lets_everything_pass() {
    for one in problems() {
        let setup = one.setup();
        assert!(!setup.checks.is_empty(), "{}", one.name);
        for check in &setup.checks {
            let place = format!("{}: {}", one.name, check.quantity);
            assert!(check.is_strict(), "{place}");
            assert!(check.quantity.chars().count() <= 34, "{place}");
            assert!(check.why.len() >= 10, "{place}");
            assert!(check.accepts(check.reference), "{place}");
            let allowed = check.tolerance.absolute(check.reference);
            let size = match check.tolerance {
                Tolerance::Relative(_) => check.reference.abs(),
                Tolerance::OfScale { scale, .. } => scale,
            };
            assert!(allowed < size, "{place}");
            for wrong in [
                check.reference + 1.01 * allowed,
                -size - check.reference,
                f64::NAN,
                f64::INFINITY,
            ] {
                assert!(!check.accepts(wrong), "{place}: {wrong}");
            }
        }
    }
}

#[test]
fn the_quick_problems_pass() {
    let quick: Vec<Problem> = problems().iter().filter(|one| one.quick).copied().collect();
    let judged = solve_all(&quick, 2, Frames::None, &|_| ()).unwrap();
    let failed = judged.iter().filter(|one| !one.passed());
    let failed: Vec<String> = failed
        .map(|one| report::problem(one, Signs::Unicode))
        .collect();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
    assert_eq!(exit_code(&judged), 0);
}

#[test]
#[ignore = "takes minutes: .ci/run runs it as a command"]
fn all_problems_pass() {
    let judged = solve_all(problems(), 2, Frames::None, &|_| ()).unwrap();
    let failed = judged.iter().filter(|one| !one.passed());
    let failed: Vec<String> = failed
        .map(|one| report::problem(one, Signs::Unicode))
        .collect();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

#[test]
fn a_wrong_reference_is_found() {
    for name in BROKEN {
        let problem = named(name);
        let mut setup = problem.setup();
        let check = &mut setup.checks[0];
        check.reference += 2.0 * check.tolerance.absolute(check.reference);
        assert_it_fails(&solve_as(&problem, setup, Frames::None));
    }
}

#[test]
fn a_wrong_result_is_found() {
    for name in BROKEN {
        let mut judged = solve(&named(name));
        assert!(judged.passed(), "{name}");
        let check = &judged.setup.checks[0];
        judged.solved.values[0] += 2.0 * check.tolerance.absolute(check.reference);
        assert_it_fails(&judged);
    }
}

#[test]
fn a_value_that_is_missing_or_no_number_is_found() {
    for wrong in [f64::NAN, f64::INFINITY] {
        let mut judged = solve(&named(BROKEN[0]));
        judged.solved.values[1] = wrong;
        assert_it_fails(&judged);
    }
    let mut judged = solve(&named(BROKEN[0]));
    judged.solved.values.pop();
    assert_it_fails(&judged);
    assert_eq!(exit_code(&[]), 1, "nothing is no success");
}

#[test]
fn a_wrong_model_is_found() {
    let wrongs = [
        (BROKEN[0], "nu = 0.3", "nu = 0.31"),
        (BROKEN[1], "alpha = [1.3, -2.0]", "alpha = [1.31, -2.0]"),
        (BROKEN[2], "penalty = 1.0e5", "penalty = 1.01e5"),
    ];
    for (name, from, to) in wrongs {
        let problem = named(name);
        let setup = changed(&problem, from, to);
        let judged = solve_as(&problem, setup, Frames::None);
        assert!(judged.solved.failure.is_none(), "{name}");
        assert_it_fails(&judged);
    }
}

fn changed(problem: &Problem, from: &str, to: &str) -> Setup {
    let mut setup = problem.setup();
    assert!(setup.case.contains(from), "{from}");
    setup.case = setup.case.replace(from, to);
    setup
}

#[test]
fn a_run_that_does_not_converge_fails_with_all_its_values() {
    let problem = named("paper-brick");
    // an increment that inverts the brick, and may not be cut
    let setup = changed(
        &problem,
        "increments = { fixed = 60 }",
        "increments = { fixed = 1 }",
    );
    let mut setup = Setup {
        case: setup.case.replace("uz = -0.3", "uz = -3.0"),
        ..setup
    };
    for check in &mut setup.checks {
        check.asks[0].time = None;
    }
    let judged = solve_as(&problem, setup, Frames::None);
    assert!(
        judged
            .solved
            .failure
            .as_ref()
            .unwrap()
            .contains("not converged")
    );
    assert!(judged.rows().iter().all(|row| !row.passed));
    assert_it_fails(&judged);
}

#[test]
fn a_case_that_is_refused_fails() {
    let problem = named(BROKEN[1]);
    let judged = solve_as(&problem, changed(&problem, "ogden", "ogdem"), Frames::None);
    assert!(
        judged
            .solved
            .failure
            .as_ref()
            .unwrap()
            .starts_with("refused")
    );
    assert_it_fails(&judged);
}

#[test]
fn results_do_not_depend_on_the_number_of_workers() {
    let some: Vec<Problem> = BROKEN.map(named).to_vec();
    let values = |nworker: usize| {
        let judged = solve_all(&some, nworker, Frames::None, &|_| ()).unwrap();
        let bits = judged
            .iter()
            .flat_map(|one| one.solved.values.clone())
            .map(f64::to_bits);
        bits.collect::<Vec<_>>()
    };
    assert_eq!(values(1), values(3));
}

#[test]
fn tables_fit_eighty_columns() {
    for name in BROKEN {
        let judged = solve(&named(name));
        for signs in [Signs::Unicode, Signs::Ascii] {
            let text = report::head() + &report::problem(&judged, signs);
            let longest = text.lines().map(|line| line.chars().count()).max();
            assert!(longest <= Some(80), "{text}");
            assert!(signs == Signs::Unicode || text.is_ascii(), "{text}");
        }
    }
}

#[test]
fn a_manual_has_a_page_for_each_problem_and_a_case_that_can_be_run() {
    use signorini_io::fs::{Fs, MemoryFs};
    let judged = [solve(&named(BROKEN[0])), solve(&named(BROKEN[1]))];
    let fs = MemoryFs::default();
    let draw = |one: &Judged| (one.problem.name == BROKEN[0]).then(|| b"png".to_vec());
    report::manual(&fs, "manual".as_ref(), &judged, &draw).unwrap();
    let read = |name: &str| {
        String::from_utf8(fs.read(format!("manual/{name}").as_ref()).unwrap()).unwrap()
    };
    let index = read("index.md");
    for name in &BROKEN[..2] {
        assert!(index.contains(&format!("[{name}]({name}.md)")));
        let page = read(&format!("{name}.md"));
        assert!(
            page.contains("ANALYTICAL")
                && page.contains('$')
                && page.contains(&format!("{name}.toml"))
        );
        assert_eq!(page.contains(&format!("{name}.png")), *name == BROKEN[0]);
        // every expectation of the case is judged, and met
        let case = read(&format!("{name}.toml"));
        let opened = signorini::open_text(
            "case.toml".as_ref(),
            case.into(),
            &signorini::Reading::default(),
        );
        let loaded = opened.unwrap().with_mesh().unwrap();
        let mut options = signorini::RunOptions::new(loaded.source);
        options.fs = std::sync::Arc::new(MemoryFs::default());
        let model = signorini::build(loaded.case, loaded.mesh).unwrap();
        assert_eq!(signorini::solve(model, &options, &mut ()).exit_code, 0);
    }
}

#[test]
fn the_page_of_the_docs_lists_the_set() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let page = std::fs::read_to_string(root.join("docs/verify.md")).unwrap();
    let wanted = report::list(problems());
    assert!(
        page.contains(&wanted),
        "write into docs/verify.md:\n{wanted}"
    );
}
