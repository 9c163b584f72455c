use crate::support::{BRICK, folder_with, read, run};

#[test]
fn a_wrong_command_line_ends_with_2_and_says_what_is_known() {
    let folder = folder_with(BRICK);
    for wrong in [
        &["solve"][..],
        &["run"],
        &["run", "case.toml", "--bogus"],
        &["run", "case.toml", "-j", "0"],
        &["run", "case.toml", "--set", "nothing"],
        &["run", "case.toml", "--max-wall", "soon"],
        &["explain", "S9999"],
        &["help", "S9999"],
        &["init", "nonsense"],
        &["completions", "nonsense"],
    ] {
        let ended = run(folder.path(), wrong);
        assert_eq!(ended.code, Some(2), "{wrong:?}: {ended:?}");
        assert!(ended.err.contains("error"), "{wrong:?}: {ended:?}");
    }
}

#[test]
fn help_and_version_go_to_standard_output() {
    let folder = folder_with(BRICK);
    run(folder.path(), &["--help"]).says(0, &["resume", "Exit codes"]);
    let version = run(folder.path(), &["--version"]);
    version.says(0, &[env!("CARGO_PKG_VERSION")]);
    assert!(version.err.is_empty());
}

#[test]
fn explanations_schema_and_completions_are_printed() {
    let folder = folder_with(BRICK);
    run(folder.path(), &["explain", "s0501"]).says(0, &["What to do"]);
    run(folder.path(), &["explain"]).says(0, &["S0102  unknown key"]);
    run(folder.path(), &["completions", "bash"]).says(0, &["signorini"]);
    let schema = run(folder.path(), &["schema"]);
    let schema: serde_json::Value = serde_json::from_str(&schema.out).unwrap();
    assert!(schema["properties"]["contact"].is_object());
}

#[test]
fn keys_are_explained_with_values_defaults_and_examples() {
    let folder = folder_with(BRICK);
    run(folder.path(), &["explain", "contact.enforcement"]).says(
        0,
        &[
            "how penetration is prevented",
            "\"auto\"",
            "Keys inside",
            "[[contact]]",
        ],
    );
    run(folder.path(), &["explain", "friction"]).says(
        0,
        &[
            "contact.friction: ",
            "range    at least 0",
            "default  0.0",
            "step.contact.friction",
        ],
    );
    run(folder.path(), &["help", "material.neo-hookean.E"]).says(0, &["Young's modulus"]);
    run(folder.path(), &["explain", "contact.frcition"])
        .says(2, &["did you mean contact.friction?"]);
}

#[test]
fn help_explains_commands_and_suggests_them() {
    let folder = folder_with(BRICK);
    run(folder.path(), &["help"]).says(0, &["Exit codes"]);
    run(folder.path(), &["help", "resume"]).says(0, &["checkpoint", "--max-wall"]);
    run(folder.path(), &["help", "resum"]).says(2, &["did you mean resume?"]);
    run(folder.path(), &["statsu", "case.out"]).says(2, &["'status'"]);
    run(folder.path(), &["chek", "case.toml"]).says(2, &["'check'"]);
}

/// Names and files of all templates.
fn templates() -> Vec<(String, String)> {
    let folder = folder_with(BRICK);
    let list = run(folder.path(), &["init", "--list"]);
    let name = |line: &str| line.split_whitespace().next().unwrap().to_owned();
    let file = |name: &str| match name {
        "deck" => "deck.inp".to_owned(),
        name => format!("{}.toml", name.replace('-', "_")),
    };
    let names = list.out.lines().map(name);
    names.map(|name| (name.clone(), file(&name))).collect()
}

#[test]
fn every_template_is_written_checked_and_not_overwritten() {
    let all = templates();
    for name in [
        "hertz",
        "paper-brick",
        "paper-wedge",
        "sliding",
        "press-fit",
        "o-ring",
    ] {
        assert!(all.iter().any(|(known, _)| known == name), "{name}");
    }
    for name in ["slope", "belt", "patch-test", "deck"] {
        assert!(all.iter().any(|(known, _)| known == name), "{name}");
    }
    let folder = folder_with(BRICK);
    for (name, file) in all {
        let place = format!("new {name}");
        run(folder.path(), &["init", &name, &place]).says(0, &["signorini run"]);
        let file = format!("{place}/{file}");
        let checked = run(folder.path(), &["check", &file]);
        checked.says(0, &["nothing wrong was found"]);
        if name != "deck" {
            // the only element of the paper's wedge is one that is too stiff in bending
            let is_clean = !checked.err.contains("warning") || name == "paper-wedge";
            assert!(is_clean, "{name}: {}", checked.err);
            let text = read(&folder.path().join(&file));
            assert!(text.starts_with("#:schema .signorini/schema.json\n"));
            assert!(
                folder
                    .path()
                    .join(&place)
                    .join(".signorini/schema.json")
                    .exists()
            );
        }
        run(folder.path(), &["init", &name, &place]).says(3, &["is there already"]);
    }
}

#[test]
fn every_template_meets_its_expected_values() {
    let folder = folder_with(BRICK);
    for (name, file) in templates() {
        run(folder.path(), &["init", &name, &name]).says(0, &[]);
        let file = format!("{name}/{file}");
        let solved = run(folder.path(), &["run", &file, "-o", "out", "--fresh"]);
        solved.says(0, &["✓ solved"]);
        if name == "deck" {
            // what the head of the deck says
            let tables = read(&folder.path().join("out/deck.dat"));
            assert!(tables.trim_end().ends_with("-3.419955E+00"), "{tables}");
        } else if name != "paper-brick-arbitrary" {
            assert!(solved.err.contains("expect "), "{name} expects nothing");
        }
    }
}

#[test]
fn examples_name_the_schema_that_the_command_prints() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let examples = std::fs::read_dir(root.join("examples")).unwrap();
    let folder = folder_with(BRICK);
    let wanted = run(folder.path(), &["schema"]).out;
    let mut count = 0;
    for example in examples {
        let example = example.unwrap().path();
        let Ok(case) = std::fs::read_to_string(example.join("case.toml")) else {
            continue;
        };
        let first = case.lines().next().unwrap();
        let schema = first.strip_prefix("#:schema ").expect(first);
        assert!(
            read(&example.join(schema)) == wanted,
            "{schema} is out of date: cargo xtask keys"
        );
        count += 1;
    }
    assert!(count > 20);
}

#[test]
fn the_demo_meets_its_expected_values() {
    let folder = folder_with(BRICK);
    let ended = run(folder.path(), &["demo", "paper-brick"]);
    ended.says(0, &["expect tip.force_z", "✓ solved: 60 increments"]);
    assert!(!ended.err.contains('✗'));
    run(folder.path(), &["demo"]).says(
        0,
        &[
            "expect ball.pressure_max",
            "✓ solved",
            "report.html",
            "picture.png",
        ],
    );
}

#[test]
fn a_check_tells_sizes_contacts_and_gaps_and_writes_only_where_asked() {
    let text = BRICK.replace("[11, 0.3, 0.2, 1]", "[11, 0.3, 0.2, 1.25]");
    let folder = folder_with(&text);
    run(folder.path(), &["check", "case.toml"]).says(
        0,
        &[
            "12 nodes",
            "1 hex8, 1 tet4",
            "12 unknowns",
            "body tool: rigid",
            "smallest gap 0.250 at node 11",
            "memory",
        ],
    );
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    run(folder.path(), &["check", "case.toml", "-o", "seen"]).says(0, &["check.vtu"]);
    run(folder.path(), &["info", "seen/check.vtu"]).says(0, &["contact_pressure (node)"]);
}

#[test]
fn a_dry_run_writes_nothing() {
    let folder = folder_with(BRICK);
    run(folder.path(), &["run", "case.toml", "--dry-run"]).says(0, &["12 unknowns"]);
    assert!(!folder.path().join("case.out").exists());
}

#[test]
fn results_are_told_about() {
    let folder = folder_with(BRICK);
    run(folder.path(), &["run", "case.toml", "-q"]).says(0, &["✓ solved"]);
    run(folder.path(), &["info", "case.out"]).says(
        0,
        &[
            "solved (exit code 0)",
            "5 frames, time 0 to 1",
            "contact tip: force",
            "stress (node, 6 components)",
        ],
    );
    run(folder.path(), &["info", "case.toml"]).says(
        0,
        &[
            "group brick: 1 volume cell",
            "quality (1 ideal, 0 flat): worst",
        ],
    );
    run(folder.path(), &["info", "."]).says(3, &["holds no results"]);
    run(folder.path(), &["info", "nothing.msh"]).says(3, &["nothing.msh"]);
}
