//! `--json` of commands that answer once.

use crate::support::{BRICK, change, folder_with, run};
use serde_json::Value;
use tempfile::TempDir;

/// The one object that a command prints; its exit code is that of the command.
fn answer(folder: &TempDir, arguments: &[&str]) -> Value {
    let ended = run(folder.path(), arguments);
    assert_eq!(ended.out.lines().count(), 1, "{ended:?}");
    assert!(ended.err.is_empty(), "{ended:?}");
    let answer: Value = serde_json::from_str(&ended.out).unwrap();
    assert_eq!(answer["v"], 1);
    assert_eq!(answer["command"], arguments[0]);
    assert_eq!(answer["exit_code"].as_i64(), ended.code.map(i64::from));
    assert_eq!(answer["ok"], ended.code == Some(0));
    assert!(answer["diagnostics"].is_array());
    answer
}

#[test]
fn a_check_lists_sizes_and_contacts_for_machines() {
    let folder = folder_with(BRICK);
    let seen = answer(&folder, &["check", "case.toml", "--json"]);
    assert_eq!(seen["nodes"], 12);
    assert_eq!(seen["elements"]["hex8"], 1);
    assert_eq!(seen["unknowns"], 12);
    assert_eq!(seen["contacts"][0]["name"], "tip");
    assert_eq!(seen["bodies"][1]["rigid"], true);
    assert_eq!(seen["steps"][0], "press");
    assert_eq!(seen["held_by_supports"], true);
    assert!(seen["cost"]["memory_bytes"].as_f64().unwrap() > 0.0);
}

#[test]
fn a_broken_case_is_answered_by_diagnostics_with_places_and_remedies() {
    let folder = folder_with(&change(BRICK, "primary = \"top\"", "primary = \"tpo\""));
    let seen = answer(&folder, &["check", "case.toml", "--json"]);
    assert_eq!(seen["exit_code"], 3);
    let one = &seen["diagnostics"][0];
    assert_eq!(one["code"], "S0201");
    assert_eq!(one["severity"], "error");
    assert!(one["line"].as_u64().unwrap() > 10);
    assert!(one["help"][0].as_str().unwrap().contains("top"), "{one}");
    assert_eq!(one["ev"], "diagnostic");
}

#[test]
fn the_content_of_meshes_and_results_is_listed_for_machines() {
    let folder = folder_with(BRICK);
    let seen = answer(&folder, &["info", "case.toml", "--json"]);
    assert_eq!(seen["mesh"]["nodes"], 12);
    assert_eq!(seen["mesh"]["cells"]["hex8"], 1);
    assert_eq!(seen["mesh"]["groups"][0]["name"], "brick");
    run(folder.path(), &["run", "case.toml", "-q"]).says(0, &[]);
    let seen = answer(&folder, &["info", "case.out", "--json"]);
    assert_eq!(seen["state"], "finished");
    assert_eq!(seen["times"].as_array().unwrap().len(), 5);
    let fields = seen["fields"].as_array().unwrap();
    let stress = fields.iter().find(|one| one["name"] == "stress").unwrap();
    let names: Vec<&str> = stress["components"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["XX", "YY", "ZZ", "XY", "YZ", "XZ"]);
    let moved = fields.iter().find(|one| one["name"] == "displacement");
    let along_z = &moved.unwrap()["components"][2];
    assert_eq!(along_z["name"], "z");
    assert!((along_z["range"][0].as_f64().unwrap() + 0.02).abs() < 1e-12);
    let contact = seen["contact_fields"].as_array().unwrap();
    assert!(contact.iter().any(|one| one["name"] == "contact_gap"));
}

#[test]
fn codes_and_keys_are_explained_for_machines() {
    let folder = folder_with(BRICK);
    let code = answer(&folder, &["explain", "S0501", "--json"]);
    assert!(!code["remedies"].as_array().unwrap().is_empty());
    assert_eq!(code["class_exit_code"], 5);
    let key = answer(&folder, &["explain", "material.neo-hookean.E", "--json"]);
    assert_eq!(key["unit"], "stress");
    assert_eq!(key["range"], "greater than 0");
    assert_eq!(key["required"], true);
    let wrong = answer(&folder, &["explain", "contact.frcition", "--json"]);
    assert_eq!(wrong["exit_code"], 2);
    assert_eq!(wrong["did_you_mean"], "contact.friction");
    let all = answer(&folder, &["explain", "--json"]);
    assert!(all["codes"].as_array().unwrap().len() > 50);
}

#[test]
fn the_doctor_answers_machines_too() {
    let folder = folder_with(BRICK);
    let seen = answer(&folder, &["doctor", "--json"]);
    assert_eq!(seen["version"], env!("CARGO_PKG_VERSION"));
    assert!(seen["trial_seconds"].as_f64().unwrap() > 0.0);
}
