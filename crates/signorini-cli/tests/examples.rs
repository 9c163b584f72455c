//! Every example is run as a user runs it, what its case expects is met, and its audit finds nothing wrong.
#![allow(clippy::unwrap_used)]

#[path = "../../signorini/tests/common/mod.rs"]
mod common;

use common::repository;
use std::process::Command;

/// Examples that other tests run already, with more to say about them.
const ELSEWHERE: [&str; 5] = [
    "hertz_sphere_3d",
    "paper_wedge_3d",
    "paper_brick_symmetric_3d",
    "paper_brick_arbitrary_3d",
    "two_blocks_2d",
];

#[test]
fn examples_meet_what_they_expect_and_pass_the_audit() {
    let folder = repository().join("examples");
    let mut names: Vec<String> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| folder.join(name).join("case.toml").exists())
        .filter(|name| !ELSEWHERE.contains(&name.as_str()))
        .collect();
    names.sort();
    assert!(names.len() >= 5, "{names:?}");
    let results = tempfile::tempdir().unwrap();
    for name in names {
        assert!(folder.join(&name).join("README.md").exists(), "{name}");
        let output = Command::new(env!("CARGO_BIN_EXE_signorini"))
            .arg("run")
            .arg(folder.join(&name).join("case.toml"))
            .arg("-o")
            .arg(results.path().join(&name))
            .arg("--strict")
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{name}: {said}");
    }
}
