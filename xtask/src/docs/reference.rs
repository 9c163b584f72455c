//! The page of all keys of cases, written from the schema.

use super::keys::{alternatives, elements, others};
use serde_json::Value as Json;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use toml_edit::{Item, TableLike, Value};

/// The page, from the root of the repository.
pub(super) const PATH: &str = "docs/keys.md";

/// A case that gives every key, from the root of the repository.
pub(super) const CASE: &str = "crates/io/src/case/cases/everything.toml";

const HEAD: &str = "# Keys of cases

Every key of a case, with its values, its default, an example and its meaning. Keys of tables inside tables have dots; `NAME`
stands for a name of your own. A key without a default may be left away unless it says *required*, and its meaning says what
holds then. [guide.md](guide.md) explains a case from the first line on, [contact.md](contact.md) the keys of contacts.

Written by `cargo xtask keys` from `signorini schema`, with examples from a case that the tests read; `cargo xtask docs` fails
where the page differs.
";

/// The page of a schema, with examples from the text of a case that has all keys.
pub(super) fn page(schema: &Json, examples: &Examples) -> String {
    let mut out = HEAD.to_string();
    for (name, below) in properties(schema) {
        // writing to a string cannot fail
        let _ = write!(out, "\n## `{name}`\n\n{}.\n", sentence(below));
        let mut rows = Rows {
            examples,
            section: name,
            text: Vec::new(),
        };
        let (inner, mark) = inside(below);
        if properties(inner).next().is_none() {
            rows.push("", below, is_required(schema, name));
        }
        rows.collect(inner, mark);
        let rows = rows.text;
        out.push_str("\n| key | value | default | example | meaning |\n|---|---|---|---|---|\n");
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

/// The rows of a section, in the order of the keys.
struct Rows<'a> {
    examples: &'a Examples,
    section: &'a str,
    text: Vec<String>,
}

impl Rows<'_> {
    /// A row for each key, those of tables inside it after it.
    fn collect(&mut self, schema: &Json, before: &str) {
        for (name, below) in properties(schema) {
            let path = format!("{before}{name}");
            self.push(&path, below, is_required(schema, name));
            let (inner, mark) = inside(below);
            self.collect(inner, &format!("{path}.{mark}"));
        }
        for schema in alternatives(schema) {
            self.collect(schema, before);
        }
    }

    /// The row of a key by its path within the section; of the section itself where there is none.
    fn push(&mut self, path: &str, schema: &Json, is_required: bool) {
        let default = match schema.get("default") {
            Some(value) => format!("`{value}`"),
            None if is_required => "*required*".to_string(),
            None => String::new(),
        };
        let meaning = schema
            .get("description")
            .and_then(Json::as_str)
            .unwrap_or_default();
        let (name, whole) = if path.is_empty() {
            (self.section, self.section.to_string())
        } else {
            (path, format!("{}.{path}", self.section))
        };
        let example = self.examples.of(&whole);
        let cells = [
            format!("`{name}`"),
            values(schema),
            default,
            example.map_or(String::new(), |text| format!("`{text}`")),
            meaning.to_string(),
        ];
        let cells = cells.map(|cell| cell.replace('|', "\\|"));
        let row = format!("| {} |\n", cells.join(" | "));
        // forms of one key that differ in nothing that the row says
        if !self.text.contains(&row) {
            self.text.push(row);
        }
    }
}

fn is_required(schema: &Json, name: &str) -> bool {
    let required = schema.get("required").and_then(Json::as_array);
    required.is_some_and(|names| names.iter().any(|other| other == name))
}

/// Values that a case gives its keys, by the path of the key, `NAME` for names of the user's.
#[derive(Debug, Default)]
pub(super) struct Examples {
    values: BTreeMap<String, String>,
}

/// The longest value that is an example in a table.
const LONGEST: usize = 96;

impl Examples {
    /// Those of a case, and of another for the keys that the first leaves out; of each key the shortest value.
    pub fn new(schema: &Json, cases: [&str; 2]) -> Result<Self, toml_edit::TomlError> {
        let mut examples = Self::default();
        for case in cases {
            let document: toml_edit::DocumentMut = case.parse()?;
            let mut more = Self::default();
            more.table(schema, "", document.as_table());
            for (path, value) in more.values {
                examples.values.entry(path).or_insert(value);
            }
        }
        Ok(examples)
    }

    fn of(&self, path: &str) -> Option<&str> {
        self.values.get(path).map(String::as_str)
    }

    /// The values of a table that schemas describe.
    fn table(&mut self, schema: &Json, before: &str, table: &dyn TableLike) {
        for (name, item) in table.iter() {
            let below = all_under(schema, name);
            let (path, mark) = if below.is_empty() && others(schema).is_some() {
                (format!("{before}NAME"), true)
            } else {
                (format!("{before}{name}"), false)
            };
            let below = if mark {
                others(schema).into_iter().collect()
            } else {
                below
            };
            self.item(&below, &path, item);
        }
    }

    fn item(&mut self, schemas: &[&Json], path: &str, item: &Item) {
        if let Some(value) = item.as_value() {
            self.keep(path, value);
        }
        let tables: Vec<&dyn TableLike> = match item {
            Item::ArrayOfTables(list) => list.iter().map(|table| table as &dyn TableLike).collect(),
            Item::Value(Value::Array(list)) => list
                .iter()
                .filter_map(|value| value.as_inline_table().map(|table| table as &dyn TableLike))
                .collect(),
            _ => item.as_table_like().into_iter().collect(),
        };
        for table in tables {
            for schema in schemas {
                for form in forms(schema) {
                    self.table(form, &format!("{path}."), table);
                }
            }
        }
    }

    fn keep(&mut self, path: &str, value: &Value) {
        let text = value.clone().decorated("", "").to_string();
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        if text.chars().count() > LONGEST || text.contains('`') {
            return;
        }
        let is_better = |old: &String| text.chars().count() < old.chars().count();
        if self.values.get(path).is_none_or(is_better) {
            self.values.insert(path.to_string(), text);
        }
    }
}

/// The schemas that a key may have, those of all forms of the table.
fn all_under<'a>(schema: &'a Json, name: &str) -> Vec<&'a Json> {
    let of = |form: &'a Json| form.get("properties")?.get(name);
    forms(schema).into_iter().filter_map(of).collect()
}

/// A schema, what its lists hold, and its alternatives.
fn forms(schema: &Json) -> Vec<&Json> {
    let mut out = vec![schema];
    let below = alternatives(schema).chain(schema.get("items").filter(|items| items.is_object()));
    out.extend(below.flat_map(forms));
    out
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
                "items": { "type": "object", "required": ["law"], "properties": {
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
        let case =
            "title = \"x\"\ncontact = [{ law = { penalty = 2 } }]\n[material.soft]\nnu = 0.2\n";
        let page = page(
            &schema(),
            &Examples::new(&schema(), [case, "title = \"other\""]).unwrap(),
        );
        for row in [
            "\n## `contact`\n\nPairs of surfaces.\n",
            "\n| `law` | `\"auto\"` or a table | *required* | `{ penalty = 2 }` | how it acts |\n",
            "\n| `law.penalty` | number > 0.0 |  | `2` | per area |\n",
            "\n| `NAME.nu` | number ≥ 0, ≤ 0.5 | `0.3` | `0.2` | ratio |\n",
            "\n| `title` | text | `\"\"` | `\"x\"` | a\\|b |\n",
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
        let examples = Examples::default();
        assert_ne!(page(&other, &examples), page(&schema(), &examples));
    }
}
