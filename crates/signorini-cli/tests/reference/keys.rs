//! `docs/keys.md` compared with the schema, key by key.

use crate::{page, signorini};
use serde_json::Value;
use std::collections::BTreeMap;

/// The keys of a schema by their path, `NAME` for names of the user's, each with its schemas.
fn keys(schema: &Value) -> BTreeMap<String, Vec<&Value>> {
    let mut out = BTreeMap::new();
    collect(schema, "", &mut out);
    out
}

fn collect<'a>(schema: &'a Value, before: &str, out: &mut BTreeMap<String, Vec<&'a Value>>) {
    for (name, below) in schema["properties"].as_object().into_iter().flatten() {
        let path = format!("{before}{name}");
        out.entry(path.clone()).or_default().push(below);
        collect(below, &format!("{path}."), out);
    }
    for list in ["anyOf", "oneOf"] {
        for form in schema[list].as_array().into_iter().flatten() {
            collect(form, before, out);
        }
    }
    if schema["items"].is_object() {
        collect(&schema["items"], before, out);
    }
    if schema["additionalProperties"].is_object() {
        collect(
            &schema["additionalProperties"],
            &format!("{before}NAME."),
            out,
        );
    }
}

/// The rows of the page by their path: default and example.
fn rows(page: &str) -> BTreeMap<String, (String, String)> {
    let (mut section, mut out) = (String::new(), BTreeMap::new());
    for line in page.lines() {
        if let Some(name) = line.strip_prefix("## `") {
            section = name.trim_end_matches('`').to_string();
            out.insert(section.clone(), (String::new(), String::new()));
        }
        let line = line.replace("\\|", "¦");
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let [_, key, _, default, example, _, _] = cells[..] else {
            continue;
        };
        let Some(key) = key.strip_prefix('`') else {
            continue;
        };
        let key = key.trim_end_matches('`');
        let path = if key == section {
            section.clone()
        } else {
            format!("{section}.{key}")
        };
        out.insert(path, (default.to_string(), example.to_string()));
    }
    out
}

#[test]
fn every_key_of_the_schema_has_a_row_and_every_row_a_key() {
    let schema: Value = serde_json::from_str(&signorini(&["schema"])).unwrap();
    let (keys, page) = (keys(&schema), page("keys.md"));
    let rows = rows(&page);
    let lost: Vec<&String> = keys.keys().filter(|key| !rows.contains_key(*key)).collect();
    let stale: Vec<&String> = rows.keys().filter(|key| !keys.contains_key(*key)).collect();
    assert!(
        lost.is_empty() && stale.is_empty(),
        "lost {lost:?}, stale {stale:?}"
    );
    println!("{} keys", keys.len());
    assert!(keys.len() >= 330, "{} keys", keys.len());
}

#[test]
fn every_default_of_the_schema_is_on_the_page() {
    let schema: Value = serde_json::from_str(&signorini(&["schema"])).unwrap();
    let page = page("keys.md");
    let rows = rows(&page);
    let mut count = 0;
    for (path, schemas) in keys(&schema) {
        let defaults: Vec<&Value> = schemas
            .iter()
            .filter_map(|key| key.get("default"))
            .collect();
        if let [default] = defaults[..] {
            let default = format!("`{default}`").replace('|', "¦");
            assert_eq!(rows[&path].0, default, "{path}");
            count += 1;
        }
    }
    assert!(count >= 50, "{count} defaults");
}

#[test]
fn every_key_that_can_be_given_has_an_example() {
    let schema: Value = serde_json::from_str(&signorini(&["schema"])).unwrap();
    let page = page("keys.md");
    let rows = rows(&page);
    let mut without = Vec::new();
    for (path, schemas) in keys(&schema) {
        let is_section = !path.contains('.');
        let is_refused = schemas.iter().all(|key| key["not"].is_object());
        let is_list_of_tables = |key: &&Value| key["items"]["properties"].is_object();
        if is_section || is_refused || schemas.iter().any(is_list_of_tables) {
            continue;
        }
        if rows[&path].1.is_empty() {
            without.push(path);
        }
    }
    assert!(without.is_empty(), "no example: {without:?}");
}

#[test]
fn every_example_names_the_schema_for_editors() {
    let examples = crate::docs().join("../examples");
    let mut count = 0;
    for entry in std::fs::read_dir(&examples).unwrap() {
        let Ok(case) = std::fs::read_to_string(entry.unwrap().path().join("case.toml")) else {
            continue;
        };
        assert_eq!(
            case.lines().next(),
            Some("#:schema ../../docs/case.schema.json")
        );
        count += 1;
    }
    assert!(count >= 20 && crate::docs().join("case.schema.json").exists());
}
