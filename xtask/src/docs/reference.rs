//! The page of all keys of cases, written from the schema.

use super::keys::{alternatives, elements, others};
use serde_json::Value as Json;
use std::fmt::Write as _;

/// The page, from the root of the repository.
pub(super) const PATH: &str = "docs/keys.md";

const HEAD: &str = "# Keys of cases

Every key of a case, with its values, its default and its meaning. Keys of tables inside tables have dots; `NAME` stands for
a name of your own. [guide.md](guide.md) explains a case from the first line on, [contact.md](contact.md) the keys of contacts.

Written by `cargo xtask keys` from `signorini schema`; `cargo xtask docs` fails where the two differ.
";

/// The page of a schema.
pub(super) fn page(schema: &Json) -> String {
    let mut out = HEAD.to_string();
    for (name, below) in properties(schema) {
        // writing to a string cannot fail
        let _ = write!(out, "\n## `{name}`\n\n{}.\n", sentence(below));
        let mut rows = Vec::new();
        let (inner, mark) = inside(below);
        if properties(inner).next().is_none() {
            rows.push(row(name, below));
        }
        collect(inner, mark, &mut rows);
        out.push_str("\n| key | value | default | meaning |\n|---|---|---|---|\n");
        for row in rows {
            out.push_str(&row);
        }
    }
    out
}

pub(super) fn properties(schema: &Json) -> impl Iterator<Item = (&str, &Json)> {
    let all = schema.get("properties").and_then(Json::as_object);
    all.into_iter()
        .flatten()
        .map(|(name, below)| (name.as_str(), below))
}

/// The schema of the tables in a list or under names of the user's, and what stands before their keys.
fn inside(schema: &Json) -> (&Json, &'static str) {
    if let Some(other) = others(schema) {
        return (other, "NAME.");
    }
    let items = schema
        .get("items")
        .filter(|items| items.get("properties").is_some());
    (items.unwrap_or(schema), "")
}

/// A row for each key, those of tables inside it after it.
fn collect(schema: &Json, before: &str, rows: &mut Vec<String>) {
    for (name, below) in properties(schema) {
        let path = format!("{before}{name}");
        rows.push(row(&path, below));
        collect_inside(below, &path, rows);
    }
    for schema in alternatives(schema) {
        collect(schema, before, rows);
    }
}

fn collect_inside(schema: &Json, path: &str, rows: &mut Vec<String>) {
    let (inner, mark) = inside(schema);
    collect(inner, &format!("{path}.{mark}"), rows);
}

fn row(path: &str, schema: &Json) -> String {
    let default = schema
        .get("default")
        .map_or(String::new(), |value| format!("`{value}`"));
    let meaning = schema
        .get("description")
        .and_then(Json::as_str)
        .unwrap_or_default();
    let cells = [
        format!("`{path}`"),
        values(schema),
        default,
        meaning.to_string(),
    ];
    let cells = cells.map(|cell| cell.replace('|', "\\|"));
    format!("| {} |\n", cells.join(" | "))
}

/// A description as a sentence without its full stop.
pub(super) fn sentence(schema: &Json) -> String {
    let text = schema
        .get("description")
        .and_then(Json::as_str)
        .unwrap_or_default();
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

/// The values that a key takes, in words.
pub(super) fn values(schema: &Json) -> String {
    let mut options: Vec<String> = alternatives(schema).map(values).collect();
    if !options.is_empty() {
        options.dedup();
        return options.join(" or ");
    }
    if let Some(words) = schema.get("enum").and_then(Json::as_array) {
        let words: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
        return words.join(", ");
    }
    if let Some(word) = schema.get("const") {
        return format!("`{word}`");
    }
    match schema.get("type").and_then(Json::as_str) {
        Some("number" | "integer") => number(schema),
        Some("boolean") => "`true` or `false`".to_string(),
        Some("string") => "text".to_string(),
        Some("array") => list(schema),
        Some("object") if others(schema).is_some() => "tables by name".to_string(),
        Some("object") => "a table".to_string(),
        _ => "any".to_string(),
    }
}

fn number(schema: &Json) -> String {
    let kind = match schema.get("type").and_then(Json::as_str) {
        Some("integer") => "whole number",
        _ => "number",
    };
    let signs = [
        ("minimum", "≥"),
        ("exclusiveMinimum", ">"),
        ("maximum", "≤"),
        ("exclusiveMaximum", "<"),
    ];
    let bound = |(key, sign): (&str, &str)| Some(format!(" {sign} {}", schema.get(key)?));
    let bounds: Vec<String> = signs.into_iter().filter_map(bound).collect();
    format!("{kind}{}", bounds.join(","))
}

fn list(schema: &Json) -> String {
    let mut kinds: Vec<String> = elements(schema).map(values).collect();
    kinds.dedup();
    let count = ["minItems", "maxItems"].map(|key| schema.get(key).and_then(Json::as_u64));
    let of = if kinds.is_empty() {
        String::new()
    } else {
        format!(" of {}", kinds.join("; "))
    };
    match count {
        [Some(least), Some(most)] if least == most => format!("list{of}, {least} of them"),
        _ => format!("list{of}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn schema() -> Json {
        json!({ "properties": {
            "contact": {
                "description": "pairs of surfaces",
                "type": "array",
                "items": { "type": "object", "properties": {
                    "law": { "description": "how it acts", "anyOf": [
                        { "enum": ["auto"] },
                        { "type": "object", "properties": {
                            "penalty": { "type": "number", "exclusiveMinimum": 0.0, "description": "per area" },
                        } },
                    ] },
                } },
            },
            "material": {
                "description": "materials",
                "type": "object",
                "additionalProperties": { "type": "object", "properties": {
                    "nu": { "type": "number", "minimum": 0, "maximum": 0.5, "default": 0.3, "description": "ratio" },
                } },
            },
            "title": { "type": "string", "default": "", "description": "a|b" },
        } })
    }

    #[test]
    fn every_key_has_a_row_with_its_path() {
        let page = page(&schema());
        for row in [
            "\n## `contact`\n\nPairs of surfaces.\n",
            "\n| `law` | `\"auto\"` or a table |  | how it acts |\n",
            "\n| `law.penalty` | number > 0.0 |  | per area |\n",
            "\n| `NAME.nu` | number ≥ 0, ≤ 0.5 | `0.3` | ratio |\n",
            "\n| `title` | text | `\"\"` | a\\|b |\n",
        ] {
            assert!(page.contains(row), "{row}\n{page}");
        }
    }

    #[test]
    fn a_renamed_key_changes_the_page() {
        let mut other = schema();
        let all = other["properties"].as_object_mut().unwrap();
        let title = all.remove("title").unwrap();
        all.insert("name".to_string(), title);
        assert_ne!(page(&other), page(&schema()));
    }
}
