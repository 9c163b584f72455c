use crate::support::{BRICK, folder_with, run};

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

#[test]
fn every_template_is_written_checked_and_not_overwritten() {
    let folder = folder_with(BRICK);
    let list = run(folder.path(), &["init", "--list"]);
    list.says(0, &["paper-brick"]);
    for line in list.out.lines() {
        let name = line.split_whitespace().next().unwrap();
        run(folder.path(), &["init", name, "new folder"]).says(0, &["signorini run"]);
        let file = format!("new folder/{}.toml", name.replace('-', "_"));
        run(folder.path(), &["check", &file]).says(0, &["nothing wrong was found"]);
        run(folder.path(), &["init", name, "new folder"]).says(3, &["is there already"]);
    }
}

#[test]
fn the_demo_meets_its_expected_values() {
    let folder = folder_with(BRICK);
    let ended = run(folder.path(), &["demo", "paper-brick"]);
    ended.says(0, &["expect tip.force_z", "✓ solved: 60 increments"]);
    assert!(!ended.err.contains('✗'));
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
    run(folder.path(), &["info", "case.toml"]).says(0, &["group brick: 1 volume cell"]);
    run(folder.path(), &["info", "."]).says(3, &["holds no results"]);
    run(folder.path(), &["info", "nothing.msh"]).says(3, &["nothing.msh"]);
}
