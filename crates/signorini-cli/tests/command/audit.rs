//! Warnings of the audit of a run, and its exit code.

use crate::support::{folder_with, read, result, run};
use serde_json::Value;

/// The tip of a wedge over the middle of a facet: only nodes of that facet are looked at, and the tip goes in.
pub const WEDGE: &str = r#"format = 1
units = "mm-N-MPa"

[mesh]
nodes = [
  [1, 0.0, -1.0], [2, 1.0, -1.0], [3, 2.0, -1.0], [4, 0.0, 0.0], [5, 1.0, 0.0], [6, 2.0, 0.0],
  [7, -0.5, 0.364], [8, 0.5, 0.0], [9, 1.5, 0.364], [10, -0.5, 1.2], [11, 0.5, 1.2], [12, 1.5, 1.2],
]
elements = [
  { id = 1, type = "quad4", group = "block", nodes = [1, 2, 5, 4] },
  { id = 2, type = "quad4", group = "block", nodes = [2, 3, 6, 5] },
  { id = 3, type = "quad4", group = "wedge", nodes = [7, 8, 11, 10] },
  { id = 4, type = "quad4", group = "wedge", nodes = [8, 9, 12, 11] },
]

[sets]
base = { nodes = [1, 2, 3] }
head = { nodes = [10, 11, 12] }
flat = { faces = [[1, "S3"], [2, "S3"]] }
flanks = { faces = [[3, "S1"], [4, "S1"]] }

[model]
space = "plane-strain"

[material.m]
model = "linear-elastic"
E = 1000.0
nu = 0.3

[[body]]
group = ["block", "wedge"]
material = "m"

[[contact]]
name = "c"
secondary = "flat"
primary = "flanks"
method = "node-to-segment"
sliding = "finite"

[[step]]
name = "press"
geometry = "linear"
increments = { fixed = 2 }
  [[step.fix]]
  on = "base"
  u = "all"
  [[step.move]]
  on = "head"
  ux = 0.0
  uy = -0.19
"#;

fn summary(folder: &tempfile::TempDir) -> Value {
    serde_json::from_str(&read(&result(folder, "summary.json"))).unwrap()
}

#[test]
fn what_is_wrong_is_a_warning_and_a_failure_where_that_is_asked_for() {
    for (strict, code, status) in [(false, 0, "solved"), (true, 1, "audit failed")] {
        let folder = folder_with(WEDGE);
        let option: &[&str] = if strict { &["--strict"] } else { &[] };
        let arguments = [&["run", "case.toml"][..], option].concat();
        run(folder.path(), &arguments).says(code, &["S0422", "contact \"c\"", "inside each other"]);
        let summary = summary(&folder);
        assert_eq!(summary["status"], status);
        assert_eq!(summary["audit"]["passed"], Value::Bool(false));
        let through = &summary["audit"]["contacts"]["c"]["through"];
        assert_eq!(through["passed"], Value::Bool(false));
        // the tip is between two nodes of the flat side in both, at first without a force
        assert_eq!(through["increments"], 2);
        assert!(through["part"].as_f64().unwrap() > 0.1);
        assert!(!through["nodes"].as_array().unwrap().is_empty());
        assert_eq!(summary["diagnostics"][0]["code"], "S0422");
    }
}

#[test]
fn an_audit_that_is_silenced_fails_nothing() {
    let text = WEDGE.replace("format = 1", "format = 1\nallow = [\"S0422\"]");
    let folder = folder_with(&text);
    run(folder.path(), &["run", "case.toml", "--strict"]).says(0, &[]);
    assert_eq!(summary(&folder)["audit"]["passed"], Value::Bool(false));
}
