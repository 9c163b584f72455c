//! `signorini status` of real processes, alive, killed, resumed and finished.

use crate::support::{brick_in, change, command, folder_with, result, run};
use serde_json::Value;
use std::process::{Child, Stdio};
use std::time::Duration;
use tempfile::TempDir;

/// How often a run is started again that was over before anyone saw that it could be stopped.
const TRIES: usize = 100;

/// Starts the command and waits for a frame; none where the run is over before.
fn started(folder: &TempDir, arguments: &[&str], frame: usize) -> Option<Child> {
    let mut child = command(folder.path())
        .args(arguments)
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let frame = result(folder, &format!("frames/volume_{frame:04}.vtu"));
    while !frame.exists() {
        if child.try_wait().unwrap().is_some() {
            return None;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    // it does not go on while it is looked at
    let id = child.id().to_string();
    let halted = std::process::Command::new("kill")
        .args(["-STOP", &id])
        .status();
    assert!(halted.unwrap().success());
    Some(child)
}

fn kill(mut child: Child) {
    child.kill().unwrap();
    child.wait().unwrap();
}

/// The answer of `status`, for machines.
fn status(folder: &TempDir) -> Value {
    let ended = run(folder.path(), &["status", "case.out", "--json"]);
    ended.says(0, &[]);
    let answer: Value = serde_json::from_str(&ended.out).unwrap();
    assert_eq!(answer["v"], 1);
    assert_eq!(answer["command"], "status");
    assert_eq!(answer["ok"], true);
    answer
}

#[test]
fn a_run_and_its_resumed_part_are_running_then_killed_then_finished() {
    let folder = folder_with(&brick_in(200));
    let mut tries = (0..TRIES).filter_map(|_| started(&folder, &["run", "case.toml"], 3));
    let live = tries.next().expect("every run was over too early");
    let seen = status(&folder);
    assert_eq!(seen["state"], "running", "{seen}");
    assert_eq!(seen["process"], live.id().to_string());
    assert_eq!(seen["progress"]["step"], "press");
    assert_eq!(seen["progress"]["duration"], 1.0);
    assert!(
        seen["progress"]["increment"].as_u64().unwrap() >= 2,
        "{seen}"
    );
    assert!(
        seen["progress"]["iterations"].as_u64().unwrap() >= 2,
        "{seen}"
    );
    assert!(seen["progress"]["seconds_since_event"].as_f64().unwrap() >= 0.0);
    assert!(seen["progress"]["contacts"]["tip"]["force"][2].is_number());
    assert_eq!(seen["resume"], Value::Null);
    kill(live);
    let seen = status(&folder);
    assert_eq!(seen["state"], "killed", "{seen}");
    assert_eq!(seen["resume"], "signorini resume case.out");
    // the resumed part is stopped on request: that says nothing about the one after it
    let late = ["resume", "case.out", "--max-wall", "0.000001s"];
    run(folder.path(), &late).says(8, &[]);
    assert_eq!(status(&folder)["state"], "interrupted");
    let again = started(&folder, &["resume", "case.out"], 150).unwrap();
    let seen = status(&folder);
    assert_eq!(seen["state"], "running", "{seen}");
    assert_eq!(seen["progress"]["resumed"], true);
    kill(again);
    let seen = status(&folder);
    assert_eq!(seen["state"], "killed", "{seen}");
    assert_eq!(seen["summary"], Value::Null);
    let said = run(folder.path(), &["status", "case.out"]);
    said.says(0, &["killed, resumed", "signorini resume case.out"]);
    run(folder.path(), &["resume", "case.out"]).says(0, &[]);
    let seen = status(&folder);
    assert_eq!(seen["state"], "finished", "{seen}");
    assert_eq!(seen["summary"]["exit_code"], 0);
}

#[test]
fn an_interrupted_run_says_how_to_go_on_and_a_failed_one_why() {
    let folder = folder_with(&brick_in(4));
    let late = ["run", "case.toml", "--max-wall", "0.000001s"];
    run(folder.path(), &late).says(8, &[]);
    let said = run(folder.path(), &["status", "case.out"]);
    said.says(0, &["time limit reached", "signorini resume case.out"]);
    let text = change(&brick_in(4), "uz = -0.02", "uz = -5.0");
    let folder = folder_with(&text);
    run(folder.path(), &["run", "case.toml"]).says(5, &[]);
    let seen = status(&folder);
    assert_eq!(seen["state"], "failed", "{seen}");
    let reason = seen["reason"].as_str().unwrap();
    assert!(reason.starts_with("S05"), "{reason}");
    run(folder.path(), &["status", "case.out"]).says(0, &["not converged (exit code 5)", reason]);
}

#[test]
fn a_folder_without_results_is_refused() {
    let folder = folder_with(&brick_in(4));
    run(folder.path(), &["status", "."]).says(3, &["holds no results"]);
    let ended = run(folder.path(), &["status", "nowhere", "--json"]);
    let answer: Value = serde_json::from_str(&ended.out).unwrap();
    assert_eq!((ended.code, &answer["exit_code"]), (Some(3), &3.into()));
    assert_eq!(answer["ok"], false);
    assert_eq!(answer["diagnostics"][0]["code"], "S0121");
}
