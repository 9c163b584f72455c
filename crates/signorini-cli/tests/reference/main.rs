//! The pages of reference have everything there is: every key of a case, every command with its options, every message.
#![allow(clippy::unwrap_used, clippy::panic)]

mod commands;
mod keys;
mod messages;

use std::path::{Path, PathBuf};
use std::process::Command;

/// A page of `docs/`.
fn page(name: &str) -> String {
    std::fs::read_to_string(docs().join(name)).unwrap()
}

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs")
}

/// What the command prints; SIGNORINI_PROGRAM names another one than that of this build.
fn signorini(arguments: &[&str]) -> String {
    let program = std::env::var_os("SIGNORINI_PROGRAM");
    let program = program.unwrap_or_else(|| env!("CARGO_BIN_EXE_signorini").into());
    let mut command = Command::new(program);
    command.args(arguments).env_remove("SIGNORINI_THREADS");
    let ended = command.output().unwrap();
    assert!(ended.status.success(), "{arguments:?}");
    String::from_utf8(ended.stdout).unwrap()
}

/// Compares a page with what it should be; with SIGNORINI_BLESS it is written.
fn compare(name: &str, wanted: &str) {
    if std::env::var_os("SIGNORINI_BLESS").is_some() {
        std::fs::write(docs().join(name), wanted).unwrap();
        return;
    }
    let written = std::fs::read_to_string(docs().join(name)).unwrap_or_default();
    let differ = wanted
        .lines()
        .zip(written.lines())
        .position(|(a, b)| a != b);
    assert_eq!(
        wanted.lines().nth(differ.unwrap_or(0)),
        written.lines().nth(differ.unwrap_or(0)),
        "docs/{name} is out of date: SIGNORINI_BLESS=1 cargo test --release -p signorini-cli --test reference"
    );
    assert!(wanted == written, "docs/{name} is too long or too short");
}
