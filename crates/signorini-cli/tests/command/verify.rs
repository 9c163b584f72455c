//! `signorini verify`: what it prints, writes, and how it ends. Whether broken problems are found is tested in the crate of
//! the set.

use crate::support::{BRICK, folder_with, read, run};

#[test]
fn a_problem_is_run_and_compared() {
    let folder = folder_with(BRICK);
    let ended = run(folder.path(), &["verify", "--only", "patch-quad4-mortar"]);
    ended.says(
        0,
        &["✓ patch-quad4-mortar", "ANALYTICAL", "1 passed, 0 failed"],
    );
    let longest = ended.out.lines().map(|line| line.chars().count()).max();
    assert!(longest <= Some(80), "{}", ended.out);
}

#[test]
fn machines_get_one_object() {
    let folder = folder_with(BRICK);
    let two = [
        "verify",
        "--json",
        "--only",
        "lever",
        "--only",
        "paper-wedge",
        "-j",
        "2",
    ];
    let ended = run(folder.path(), &two);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    let object: serde_json::Value = serde_json::from_str(&ended.out).unwrap();
    assert_eq!(
        (&object["v"], &object["command"]),
        (&1.into(), &"verify".into())
    );
    assert_eq!(
        (&object["ok"], &object["exit_code"]),
        (&true.into(), &0.into())
    );
    let names = object["problems"].as_array().unwrap().iter();
    let names: Vec<_> = names.map(|one| one["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["lever", "paper-wedge"]);
    assert!(object["problems"][0]["checks"][0]["value"].is_number());
}

#[test]
fn unknown_problems_are_refused_with_the_nearest() {
    let folder = folder_with(BRICK);
    let ended = run(folder.path(), &["verify", "--only", "paper-wegde"]);
    ended.says(2, &["error", "did you mean paper-wedge?"]);
    let none = run(
        folder.path(),
        &["verify", "--quick", "--only", "hertz-sphere-3d"],
    );
    none.says(2, &["quick"]);
}

#[test]
fn the_page_and_the_manual_are_written() {
    let folder = folder_with(BRICK);
    let at = |name: &str| folder.path().join(name);
    let options = ["--html", "v.html", "--manual", "manual"];
    let ended = run(
        folder.path(),
        &[&["verify", "--only", "lame-tube"], &options[..]].concat(),
    );
    ended.says(0, &["1 passed"]);
    let page = read(&at("v.html"));
    assert!(page.contains("lame-tube") && !page.contains("<script"));
    assert!(read(&at("manual/index.md")).contains("(lame-tube.md)"));
    assert!(read(&at("manual/lame-tube.md")).contains("![Lamé"));
    let picture = std::fs::read(at("manual/lame-tube.png")).unwrap();
    assert!(picture.starts_with(b"\x89PNG"));
    run(folder.path(), &["run", "manual/lame-tube.toml"]).says(0, &["✓"]);
    let refused = run(
        folder.path(),
        &["verify", "--only", "lever", "--html", "case.toml/v.html"],
    );
    assert_eq!(refused.code, Some(6), "{refused:?}");
}

#[test]
fn the_list_is_that_of_the_docs() {
    let folder = folder_with(BRICK);
    let list = run(folder.path(), &["verify", "--list"]);
    let docs = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/verify.md");
    assert!(read(&docs).contains(&list.out));
}
