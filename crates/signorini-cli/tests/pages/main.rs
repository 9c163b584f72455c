//! Every command of a block in README.md, CONTRIBUTING.md and docs/ runs here, or is a part of `.ci/run`.
//!
//! Tutorials and how-to pages are done from the first line to the last, see [`script`]; SIGNORINI_PAGE names a part of the path
//! of the only ones to do, SIGNORINI_PROGRAM another program than that of this build.
#![allow(clippy::unwrap_used)]

mod examples;
#[cfg(unix)]
mod reader;
#[cfg(unix)]
mod script;

use std::path::{Path, PathBuf};
use std::process::Command;

/// Commands that are not run by any test: how they begin, and why.
const NOT_RUN: [(&str, &str); 4] = [
    (
        "cargo xtask keys",
        "writes the page that `cargo xtask docs` compares",
    ),
    (
        "cargo xtask rooms --graph",
        "prints the table that `cargo xtask rooms` checks",
    ),
    (
        "cargo build --release -p signorini-cli",
        "builds what this test runs",
    ),
    (
        "python scripts/compare_speed.py",
        "takes hours, and CalculiX",
    ),
];

fn repository() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.canonicalize().unwrap()
}

/// The pages with commands.
fn pages(root: &Path) -> Vec<PathBuf> {
    let docs = std::fs::read_dir(root.join("docs")).unwrap();
    let docs = docs.map(|entry| entry.unwrap().path());
    let mut pages: Vec<PathBuf> = docs
        .filter(|path| path.extension().is_some_and(|ending| ending == "md"))
        .chain(["README.md", "CONTRIBUTING.md"].map(|name| root.join(name)))
        .collect();
    pages.sort();
    pages
}

/// The lines of blocks in `sh`, without remarks and settings of the environment.
fn commands(page: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(page).unwrap();
    let blocks = text.split("```sh\n").skip(1);
    let blocks = blocks.filter_map(|block| block.split("```").next());
    let command = |line: &str| {
        let line = line.split(" #").next().unwrap();
        let words = line.split_whitespace();
        let is_setting = |word: &&str| word.contains('=') && !word.starts_with('-');
        words.skip_while(is_setting).collect::<Vec<_>>().join(" ")
    };
    let lines = blocks.flat_map(str::lines).map(command);
    lines.filter(|line| !line.is_empty()).collect()
}

/// The arguments of a line that runs the program.
fn of_program(line: &str) -> Option<Vec<&str>> {
    let heads = ["cargo run --release -- ", "signorini "];
    let rest = heads.iter().find_map(|head| line.strip_prefix(head))?;
    Some(rest.split_whitespace().collect())
}

/// A folder in which the commands of a page run one after the other: what they name of the repository is there, and what
/// they write stays there.
fn folder_of_page(root: &Path) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink(root.join("examples"), folder.path().join("examples")).unwrap();
    folder
}

#[test]
fn commands_of_the_program_end_well() {
    let root = repository();
    let mut count = 0;
    for page in pages(&root) {
        let folder = folder_of_page(&root);
        for line in commands(&page) {
            let Some(mut arguments) = of_program(&line) else {
                continue;
            };
            let is_run = arguments[0] == "run";
            let output = arguments.iter().position(|word| *word == "-o");
            let results = output.map_or("results.out", |at| arguments[at + 1]);
            if is_run && output.is_none() {
                arguments.extend(["-o", results, "--fresh"]);
            }
            let mut program = Command::new(env!("CARGO_BIN_EXE_signorini"));
            let ended = program.args(&arguments).current_dir(folder.path()).output();
            let ended = ended.unwrap();
            let said = String::from_utf8_lossy(&ended.stderr);
            assert_eq!(
                ended.status.code(),
                Some(0),
                "{}: {line}: {said}",
                page.display()
            );
            if is_run {
                assert!(
                    folder.path().join(results).join("results.pvd").exists(),
                    "{line}"
                );
            }
            count += 1;
        }
    }
    assert!(count >= 1, "README shows how to run a case");
}

/// The command that runs the tests cannot be run by a test; that it is the one of `.ci/run` is checked by its words.
#[test]
fn other_commands_are_those_of_the_automatic_run() {
    let root = repository();
    let automatic = std::fs::read_to_string(root.join(".ci/run")).unwrap();
    for page in pages(&root) {
        for line in commands(&page) {
            let named = |text: &str| root.join(text).exists();
            let is_known = of_program(&line).is_some()
                || automatic.contains(&line)
                || NOT_RUN.iter().any(|(head, _)| line.starts_with(head))
                || line
                    .split(' ')
                    .next()
                    .is_some_and(|word| word == ".ci/run" && named(word))
                || is_test(&line, &root)
                || line.strip_prefix("python ").is_some_and(|script| {
                    named(script.split(' ').next().unwrap()) && automatic.contains(script)
                });
            assert!(is_known, "{}: nothing runs `{line}`", page.display());
        }
    }
}

/// Whether a line runs one file of tests, which the tests of the workspace, or the long ones, run too.
fn is_test(line: &str, root: &Path) -> bool {
    let words: Vec<&str> = line.split(' ').collect();
    let after = |option: &str| {
        let at = words.iter().position(|word| *word == option)?;
        words.get(at + 1).copied()
    };
    let (Some(package), Some(test)) = (after("-p"), after("--test")) else {
        return false;
    };
    let crates = root.join("crates").read_dir().unwrap();
    let folder = crates.map(|entry| entry.unwrap().path()).find(|folder| {
        let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).unwrap();
        manifest.contains(&format!("name = \"{package}\""))
    });
    let tests = folder.map(|folder| folder.join("tests"));
    let is_there = |tests: PathBuf| {
        tests.join(format!("{test}.rs")).exists() || tests.join(test).join("main.rs").exists()
    };
    line.starts_with("cargo test ") && tests.is_some_and(is_there)
}
