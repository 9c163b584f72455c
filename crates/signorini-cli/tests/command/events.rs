use crate::support::{BRICK, change, command, folder_with, read, result, run};
use serde_json::Value;
use std::process::Stdio;

fn lines(text: &str) -> Vec<Value> {
    text.lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect()
}

fn kinds(events: &[Value]) -> Vec<&str> {
    events.iter().map(|e| e["ev"].as_str().unwrap()).collect()
}

#[test]
fn json_is_one_object_per_event_and_the_same_in_the_folder() {
    let text =
        format!("{BRICK}\n[[expect]]\nwhat = \"time\"\nvalue = 1.0\ntol = {{ abs = 0.0 }}\n");
    let folder = folder_with(&text);
    let ended = run(folder.path(), &["run", "case.toml", "--json"]);
    ended.says(0, &[]);
    let events = lines(&ended.out);
    let kinds = kinds(&events);
    assert_eq!(kinds.first(), Some(&"start"));
    assert_eq!(kinds.last(), Some(&"end"));
    for (kind, count) in [
        ("increment", 4),
        ("frame", 5),
        ("checkpoint", 5),
        ("expect", 1),
    ] {
        assert_eq!(
            kinds.iter().filter(|k| **k == kind).count(),
            count,
            "{kind}"
        );
    }
    assert!(kinds.contains(&"iteration"));
    assert!(events.iter().all(|e| e["v"] == 1));
    let last = events.iter().rfind(|e| e["ev"] == "increment").unwrap();
    assert!(last["contact"]["tip"]["force"][2].as_f64().unwrap() > 0.0);
    assert_eq!(events.last().unwrap()["exit_code"], 0);
    assert_eq!(read(&result(&folder, "events.jsonl")), ended.out);
}

#[test]
fn json_tells_why_nothing_is_solved() {
    let folder = folder_with(&change(BRICK, "E = 500.0", "E = -500.0"));
    let ended = run(folder.path(), &["run", "case.toml", "--json"]);
    ended.says(3, &["S0109"]);
    let events = lines(&ended.out);
    assert_eq!(kinds(&events), ["diagnostic", "end"]);
    assert_eq!(events[0]["code"], "S0109");
    assert!(events[0]["line"].as_u64().unwrap() > 10);
    assert_eq!(events[1]["exit_code"], 3);
}

#[test]
fn plain_lines_without_escapes_go_where_no_terminal_is() {
    let folder = folder_with(BRICK);
    let ended = run(folder.path(), &["run", "case.toml"]);
    ended.says(0, &["case  12 nodes", " step ", "✓ solved: 4 increments"]);
    assert!(ended.out.is_empty());
    assert!(!ended.err.contains(['\x1b', '\r']));
    assert_eq!(read(&result(&folder, "run.log")), ended.err);
    let quiet = run(folder.path(), &["run", "case.toml", "-q"]);
    assert_eq!(quiet.err.lines().count(), 1, "{}", quiet.err);
    let verbose = run(folder.path(), &["run", "case.toml", "-v"]);
    assert!(
        verbose.err.contains("iteration  1  residual"),
        "{}",
        verbose.err
    );
}

#[cfg(unix)]
#[test]
fn closed_outputs_do_not_stop_a_run() {
    let folder = folder_with(BRICK);
    for arguments in [
        &["run", "case.toml", "--json"][..],
        &["run", "case.toml", "-v"],
    ] {
        let mut child = command(folder.path())
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        drop(child.stderr.take());
        assert_eq!(child.wait().unwrap().code(), Some(0), "{arguments:?}");
        assert!(result(&folder, "frames/volume_0004.vtu").exists());
    }
}
