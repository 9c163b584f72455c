//! Commands on the pages of examples: their runs are those of `tests/examples.rs` and `.ci/run`, their meshes are made here where
//! Gmsh is there, their figures are drawn in `.ci/run` or in the tests of the scripts.

use crate::{commands, repository};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The pages of examples with a case.
fn pages(root: &Path) -> Vec<PathBuf> {
    let folders = std::fs::read_dir(root.join("examples")).unwrap();
    let folders = folders.map(|entry| entry.unwrap().path());
    let mut pages: Vec<PathBuf> = folders
        .filter(|folder| folder.join("case.toml").exists())
        .map(|folder| folder.join("README.md"))
        .collect();
    pages.sort();
    pages
}

fn is_drawn(line: &str, root: &Path) -> bool {
    let script = line
        .strip_prefix("python scripts/")
        .and_then(|rest| rest.split(' ').next());
    let runs = [".ci/run", "scripts/test_scripts.py"];
    script.is_some_and(|script| {
        let stem = script.trim_end_matches(".py");
        runs.iter().any(|run| {
            std::fs::read_to_string(root.join(run))
                .unwrap()
                .contains(stem)
        })
    })
}

#[test]
fn pages_of_examples_begin_with_the_run_of_their_case_and_name_nothing_that_is_not_run() {
    let root = repository();
    for page in pages(&root) {
        let folder = page.parent().unwrap().strip_prefix(&root).unwrap();
        let lines = commands(&page);
        let run = format!("signorini run {}/case.toml", folder.display());
        assert_eq!(lines.first(), Some(&run));
        for line in &lines[1..] {
            let is_known = line.starts_with("gmsh ") || is_drawn(line, &root);
            assert!(is_known, "{}: nothing runs `{line}`", page.display());
        }
    }
}

#[test]
fn meshes_of_examples_are_made_by_the_commands_of_their_pages() {
    let tools = std::env::var_os("SIGNORINI_TOOLS").filter(|tools| !tools.is_empty());
    let Some(tools) = tools.map(PathBuf::from) else {
        println!("not run: SIGNORINI_TOOLS names no folder with Gmsh");
        return;
    };
    let path = std::env::var_os("PATH").unwrap_or_default();
    let places = std::iter::once(tools.clone()).chain(std::env::split_paths(&path));
    let path = std::env::join_paths(places).unwrap();
    let (root, copy) = (repository(), tempfile::tempdir().unwrap());
    let mut count = 0;
    for page in pages(&root) {
        let folder = page.parent().unwrap();
        let place = copy.path().join(folder.file_name().unwrap());
        std::fs::create_dir_all(&place).unwrap();
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|ending| ending == "geo") {
                std::fs::copy(&path, place.join(path.file_name().unwrap())).unwrap();
            }
        }
    }
    for page in pages(&root) {
        let place = copy
            .path()
            .join(page.parent().unwrap().file_name().unwrap());
        for line in commands(&page) {
            let Some(arguments) = line.strip_prefix("gmsh ") else {
                continue;
            };
            let words: Vec<&str> = arguments.split(' ').collect();
            let mut gmsh = Command::new(tools.join("gmsh"));
            gmsh.args(&words).current_dir(&place).env("PATH", &path);
            let ended = gmsh.output();
            let mesh = words.iter().position(|word| *word == "-o").unwrap() + 1;
            assert!(ended.unwrap().status.success(), "{line}");
            assert!(place.join(words[mesh]).exists(), "{line}");
            count += 1;
        }
    }
    println!("pages: {count} meshes of examples made");
    assert!(count >= 10);
}
