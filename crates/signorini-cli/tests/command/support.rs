//! A small case, and the command run on it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// A tip pressed into a brick in four increments.
pub const BRICK: &str = r#"
title = "a brick"
units = "m-MN-MPa"
[mesh]
nodes = [
  [1, 0, 0, 0], [2, 1, 0, 0], [3, 1, 1, 0], [4, 0, 1, 0],
  [5, 0, 0, 1], [6, 1, 0, 1], [7, 1, 1, 1], [8, 0, 1, 1],
  [11, 0.3, 0.2, 1], [12, 0, 0, 1.8], [13, 0.6, 0, 1.8], [14, 0.3, 0.6, 1.8],
]
elements = [
  { id = 1, type = "hex8", group = "brick", nodes = [1, 2, 3, 4, 5, 6, 7, 8] },
  { id = 2, type = "tet4", group = "tool", nodes = [11, 12, 13, 14] },
]
[sets]
base = { nodes = [1, 2, 3, 4] }
tip_node = { nodes = [11] }
top = { faces = [[1, "+z"]] }
[material.soft]
model = "saint-venant-kirchhoff"
E = 500.0
nu = 0.0
[[body]]
group = "brick"
material = "soft"
[[body]]
group = "tool"
rigid = true
[[contact]]
name = "tip"
secondary = "tip_node"
primary = "top"
enforcement = { penalty = 1e5, per = "node" }
[[step]]
name = "press"
increments = { fixed = 4 }
[[step.fix]]
on = "base"
u = "all"
[[step.move]]
on = "tool"
uz = -0.02
[checkpoint]
every = { increments = 1 }
"#;

/// The brick with other increments.
pub fn brick_in(increments: usize) -> String {
    change(BRICK, "fixed = 4", &format!("fixed = {increments}"))
}

/// A text with a part of it replaced; the part must be there.
pub fn change(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from}");
    text.replacen(from, to, 1)
}

/// How the command ended.
#[derive(Debug)]
pub struct Ended {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl Ended {
    /// Asserts the exit code and that all these words are in what was said.
    #[track_caller]
    pub fn says(&self, code: i32, words: &[&str]) -> &Self {
        assert_eq!(self.code, Some(code), "{self:#?}");
        for word in words {
            let said = self.err.contains(word) || self.out.contains(word);
            assert!(said, "`{word}` is missing in\n{}\n{}", self.out, self.err);
        }
        assert!(!self.err.contains("internal error"), "{}", self.err);
        assert!(!self.err.contains("panicked"), "{}", self.err);
        self
    }
}

impl From<Output> for Ended {
    fn from(output: Output) -> Self {
        Self {
            code: output.status.code(),
            out: String::from_utf8(output.stdout).unwrap(),
            err: String::from_utf8(output.stderr).unwrap(),
        }
    }
}

/// The command, in a folder, without the environment of who tests.
pub fn command(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_signorini"));
    command.current_dir(folder).stdin(Stdio::null());
    for name in ["SIGNORINI_THREADS", "OMP_NUM_THREADS", "NO_COLOR"] {
        command.env_remove(name);
    }
    command
}

/// Runs the command to its end.
pub fn run(folder: &Path, arguments: &[&str]) -> Ended {
    command(folder).args(arguments).output().unwrap().into()
}

/// A folder with a case of this text in `case.toml`.
pub fn folder_with(text: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("case.toml"), text).unwrap();
    folder
}

/// `signorini run` of a text; nothing may be left behind unless something was solved.
pub fn run_text(text: &str) -> Ended {
    let folder = folder_with(text);
    let ended = run(folder.path(), &["run", "case.toml"]);
    if ended.code == Some(3) {
        assert!(
            !folder.path().join("case.out").exists(),
            "nothing was solved"
        );
    }
    ended
}

/// A file of the results.
pub fn result(folder: &TempDir, name: &str) -> PathBuf {
    folder.path().join("case.out").join(name)
}

pub fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}
