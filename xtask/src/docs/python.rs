//! The module of all keys of cases for Python, written from the schema.
//!
//! Every table becomes a class, every key an attribute with its type, its meaning and its default. Tables with the same
//! keys share a class, which is called after the one with the shortest path. Inner tables stand before the tables that
//! contain them.

use super::keys::{alternatives, others};
use super::reference::{properties, sentence, values};
use serde_json::Value as Json;
use std::fmt::Write as _;

/// The module, from the root of the repository.
pub(super) const PATH: &str = "crates/python/python/signorini/keys.py";

const HEAD: &str = r#""""Every key of a case as an attribute: one class for each table.

Written by `cargo xtask keys` from `signorini schema`; `cargo xtask docs` fails where the two differ.
"""

# ruff: noqa: E501
# pyright: reportIncompatibleVariableOverride=false

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, TypedDict

from ._table import Items, Key, MaterialTable, Mixed, Named, One, Shape, Table

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .physics import ContactLaw, Course, FrictionLimit, Projection, SignedDistance
"#;

/// Classes whose names do not follow from their path.
const NAMES: [(&str, &str); 4] = [
    ("sets", "Set"),
    ("step.contact", "ContactChange"),
    ("step.material", "MaterialChange"),
    ("step.move.rx", "Motion"),
];

/// Lists of tables whose singular is the method that adds to them: key, and attribute of the list.
const LISTS: [(&str, &str); 22] = [
    ("amplitude", "amplitudes"),
    ("axes", "axes"),
    ("body", "bodies"),
    ("constraint", "constraints"),
    ("contact", "contacts"),
    ("expect", "expects"),
    ("material", "materials"),
    ("orientation", "orientations"),
    ("reference", "references"),
    ("spring", "springs"),
    ("step", "steps"),
    ("step.activate", "activations"),
    ("step.contact", "contacts"),
    ("step.deactivate", "deactivations"),
    ("step.fix", "fixes"),
    ("step.free", "frees"),
    ("step.load", "loads"),
    ("step.material", "materials"),
    ("step.move", "moves"),
    ("step.print", "prints"),
    ("step.temperature", "temperatures"),
    ("surface", "surfaces"),
];

/// What else of Python's a key takes.
const OBJECTS: [(&str, &str); 7] = [
    ("amplitude.own", "Course"),
    ("contact.enforcement", "ContactLaw"),
    ("contact.friction", "FrictionLimit"),
    ("contact.primary", "Shape | SignedDistance | Projection"),
    ("step.contact.friction", "FrictionLimit"),
    ("step.load.amplitude", "Course"),
    ("surface.shape", "Shape | SignedDistance | Projection"),
];

/// Tables whose keys methods take by name, and keys that these methods take otherwise.
const DICTS: [(&str, &[&str]); 7] = [
    ("body", &["group", "material"]),
    ("constraint", &["kind", "on"]),
    ("contact", &["name", "primary", "secondary"]),
    ("orientation", &[]),
    ("sets", &[]),
    ("spring", &["name"]),
    ("step.print", &["on"]),
];

/// Keys that shapes have at the origin unless said otherwise.
const PLACES: [&str; 3] = ["point", "center", "apex"];

/// Longer attributes take several lines.
const WIDTH: usize = 120;

/// Words that Python keeps for itself.
const RESERVED: [&str; 3] = ["from", "self", "with"];

/// A class of the module.
struct Class<'a> {
    name: String,
    schema: &'a Json,
}

/// The classes made so far, and their text.
#[derive(Default)]
struct Module<'a> {
    classes: Vec<Class<'a>>,
    /// The keys of tables, each with the shortest path to a table that has them.
    homes: Vec<(&'a Json, String)>,
    text: String,
    dicts: String,
}

/// The module of a schema.
pub(super) fn module(schema: &Json) -> String {
    let mut module = Module::default();
    module.find_homes(schema, "");
    module.class(schema, "");
    let Module { text, dicts, .. } = module;
    format!("{HEAD}{text}\n\nif TYPE_CHECKING:\n{dicts}")
}

impl<'a> Module<'a> {
    /// Looks at all tables below one.
    fn find_homes(&mut self, schema: &'a Json, path: &str) {
        for (key, below) in properties(schema) {
            let Some(
                Inside::One(inner)
                | Inside::List(inner)
                | Inside::Named(inner)
                | Inside::Either(inner),
            ) = table(below)
            else {
                continue;
            };
            let path = join(path, key);
            if let Some(keys) = inner.get("properties") {
                let depth = |path: &str| path.matches('.').count();
                match self.homes.iter_mut().find(|(known, _)| *known == keys) {
                    Some((_, home)) if depth(&path) < depth(home) => home.clone_from(&path),
                    Some(_) => {}
                    None => self.homes.push((keys, path.clone())),
                }
            }
            self.find_homes(inner, &path);
        }
    }

    /// The name of the class of a table, which is written where it is not there yet.
    fn class(&mut self, schema: &'a Json, path: &str) -> String {
        let same = |class: &&Class<'_>| {
            class.schema.get("properties") == schema.get("properties") && !is_shape(path)
        };
        if let Some(class) = self.classes.iter().find(same) {
            return class.name.clone();
        }
        let keys = schema.get("properties");
        let home = self.homes.iter().find(|(known, _)| keys == Some(*known));
        let home = home.map(|(_, path)| path.clone());
        let path = match &home {
            Some(home) if !is_shape(path) => home,
            _ => path,
        };
        let name = class_name(path);
        let base = match path {
            _ if is_shape(path) => "Shape",
            "material" => "MaterialTable",
            _ => "Table",
        };
        let mut rows = String::new();
        let mut fields = String::new();
        let left_out = DICTS.iter().find(|(known, _)| *known == path);
        let left_out = left_out.map(|(_, keys)| *keys);
        for (key, below) in properties(schema).filter(|(_, below)| below.get("not").is_none()) {
            let path = join(path, key);
            rows.push_str(&self.attribute(below, key, &path));
            if left_out.is_some_and(|keys| !keys.contains(&key)) {
                let given = self.given(below, &path);
                let field = format!("        \"{}\": {given},\n", attribute_name(key, &path));
                fields.push_str(&field);
            }
        }
        let class = header(&name, base, &sentence(schema), path);
        let init = if is_shape(path) {
            self.constructor(schema, path, &[])
        } else {
            String::new()
        };
        self.text += &format!("{class}{rows}{init}");
        if left_out.is_some() {
            // writing to a string cannot fail
            let _ = writeln!(
                self.dicts,
                "    {name}Keys = TypedDict(\"{name}Keys\", {{\n{fields}    }}, total=False)"
            );
        }
        if path == "material" {
            self.materials(schema);
        }
        self.classes.push(Class {
            name: name.clone(),
            schema,
        });
        name
    }

    /// A class for each model of materials: the constants that it needs are arguments without defaults.
    fn materials(&mut self, schema: &'a Json) {
        for (model, doc, constants) in models(schema) {
            let mut class = header(&camel(model), "Material", &capital(doc), "material.NAME");
            let _ = writeln!(class, "    _model = \"{model}\"");
            class.push_str(&self.constructor(schema, "material", &constants));
            self.text.push_str(&class);
        }
    }

    /// An `__init__` with the keys by name, those that are required first.
    fn constructor(&mut self, schema: &'a Json, path: &str, constants: &[&str]) -> String {
        let required = schema.get("required").and_then(Json::as_array);
        let required: Vec<&str> = match constants {
            [] => required
                .into_iter()
                .flatten()
                .filter_map(Json::as_str)
                .collect(),
            all => all.to_vec(),
        };
        let is_place = |key: &str| constants.is_empty() && PLACES.contains(&key);
        let is_constant = |key: &str| {
            constants.is_empty() || ["density", "expansion", "plasticity"].contains(&key)
        };
        let mut first = Vec::new();
        let mut last = Vec::new();
        let mut names = Vec::new();
        for (key, below) in properties(schema) {
            let given = self.given(below, &join(path, key));
            if is_place(key) {
                last.push(format!("{key}: {given} = (0.0, 0.0, 0.0)"));
            } else if required.contains(&key) {
                first.push(format!("{key}: {given}"));
            } else if key != "model" && is_constant(key) {
                last.push(format!("{key}: {given} | None = None"));
            } else {
                continue;
            }
            names.push(key);
        }
        first.append(&mut last);
        let given: Vec<String> = first
            .iter()
            .map(|one| format!("        {one},\n"))
            .collect();
        let passed: Vec<String> = names.iter().map(|key| format!("{key}={key}")).collect();
        format!(
            "\n    def __init__(\n        self,\n        *,\n{}    ) -> None:\n        super().__init__({})\n",
            given.concat(),
            passed.join(", ")
        )
    }

    /// The lines of one attribute.
    fn attribute(&mut self, schema: &'a Json, key: &str, path: &str) -> String {
        let (kind, before) = match table(schema) {
            Some(Inside::One(inner)) => {
                let class = self.class(inner, path);
                (format!("One[{class}]"), format!("{class}, "))
            }
            Some(Inside::List(inner)) => {
                let class = self.class(inner, path);
                (format!("Items[{class}]"), format!("{class}, "))
            }
            Some(Inside::Named(inner)) => {
                let class = self.class(inner, path);
                (format!("Named[{class}]"), format!("{class}, "))
            }
            Some(Inside::Either(inner)) => {
                let class = self.class(inner, path);
                (format!("Mixed[{class}]"), format!("{class}, "))
            }
            None => {
                let got = got(schema);
                let or_none = if schema.get("default").is_some() {
                    ""
                } else {
                    " | None"
                };
                let kind = format!("Key[{got}{or_none}, {}]", self.given(schema, path));
                (kind, String::new())
            }
        };
        let made = kind.split('[').next().unwrap_or_default().to_string();
        let mut details = vec![literal(&sentence(schema)), literal(&values(schema))];
        if let Some(default) = schema.get("default") {
            details.push(format!("default={}", python(default)));
        }
        let name = attribute_name(key, path);
        if name != key {
            details.push(format!("key=\"{key}\""));
        }
        let line = format!(
            "    {name}: {kind} = {made}({before}{})\n",
            details.join(", ")
        );
        if line.chars().count() <= WIDTH {
            return line;
        }
        let details: Vec<String> = details
            .iter()
            .map(|one| format!("        {one},\n"))
            .collect();
        let before = before.trim_end();
        let before = if before.is_empty() {
            String::new()
        } else {
            format!("        {before}\n")
        };
        format!(
            "    {name}: {kind} = {made}(\n{before}{}    )\n",
            details.concat()
        )
    }

    /// The type of what may be assigned.
    fn given(&mut self, schema: &'a Json, path: &str) -> String {
        let mut options = vec![self.given_as_data(schema, path)];
        let object = OBJECTS.iter().find(|(known, _)| *known == path);
        options.extend(object.map(|(_, name)| (*name).to_string()));
        if path.starts_with("step.move.") && schema.get("anyOf").is_some() {
            options.extend(["Sequence[Sequence[float]]", "Course"].map(str::to_string));
        }
        union(options)
    }

    /// The type of what may be assigned and has a form in TOML.
    fn given_as_data(&mut self, schema: &'a Json, path: &str) -> String {
        if let Some(options) = schema.get("anyOf").and_then(Json::as_array) {
            let options = options.iter().map(|one| self.given_as_data(one, path));
            return union(options.collect());
        }
        match table(schema) {
            Some(Inside::One(inner)) => {
                let class = self.class(inner, path);
                format!("{class} | Mapping[str, Any]")
            }
            Some(Inside::List(inner)) => {
                let class = self.class(inner, path);
                format!("Sequence[{class} | Mapping[str, Any]]")
            }
            Some(Inside::Named(_)) => "Mapping[str, Any]".to_string(),
            _ => given_plain(schema),
        }
    }
}

/// A table in a value.
enum Inside<'a> {
    /// A table.
    One(&'a Json),
    /// A list of tables.
    List(&'a Json),
    /// Tables by names of the user's.
    Named(&'a Json),
    /// A table or something else.
    Either(&'a Json),
}

fn table(schema: &Json) -> Option<Inside<'_>> {
    let is_table = |schema: &&Json| schema.get("properties").is_some();
    if let Some(other) = others(schema) {
        return Some(Inside::Named(other));
    }
    if is_table(&schema) {
        return Some(Inside::One(schema));
    }
    if let Some(items) = schema.get("items").filter(is_table) {
        return Some(Inside::List(items));
    }
    alternatives(schema).find(is_table).map(Inside::Either)
}

/// The models of materials: name, what it is, and the constants it needs.
fn models(schema: &Json) -> Vec<(&str, &str, Vec<&str>)> {
    let rules = schema.get("allOf").and_then(Json::as_array);
    let all = rules.into_iter().flatten().filter_map(model);
    all.filter(|(name, ..)| *name != "own").collect()
}

fn model(rule: &Json) -> Option<(&str, &str, Vec<&str>)> {
    let name = rule.pointer("/if/properties/model/const")?.as_str()?;
    let then = rule.get("then")?;
    let doc = then.get("description").and_then(Json::as_str);
    let needed = then.get("required").and_then(Json::as_array)?;
    let needed = needed.iter().filter_map(Json::as_str).collect();
    Some((name, doc.unwrap_or_default(), needed))
}

fn header(name: &str, base: &str, doc: &str, path: &str) -> String {
    let place = if path.is_empty() {
        String::new()
    } else {
        format!("\n\n    TOML: `{path}`.\n    ")
    };
    let doc = doc.replace('\\', "\\\\");
    format!("\n\nclass {name}({base}):\n    \"\"\"{doc}.{place}\"\"\"\n\n    _toml = \"{path}\"\n")
}

fn is_shape(path: &str) -> bool {
    path.strip_prefix("surface.shape.")
        .is_some_and(|rest| !rest.contains('.'))
}

fn join(path: &str, key: &str) -> String {
    if path.is_empty() {
        key.to_string()
    } else {
        format!("{path}.{key}")
    }
}

fn class_name(path: &str) -> String {
    if path.is_empty() {
        return "CaseTable".to_string();
    }
    if let Some((_, name)) = NAMES.iter().find(|(known, _)| *known == path) {
        return (*name).to_string();
    }
    let path = path.strip_prefix("surface.shape.").unwrap_or(path);
    let path = path.strip_prefix("step.").unwrap_or(path);
    path.split('.').map(camel).collect()
}

/// `neo-hookean` as `NeoHookean`.
fn camel(word: &str) -> String {
    word.split(['-', '_']).map(capital).collect()
}

fn capital(word: &str) -> String {
    let mut letters = word.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

fn attribute_name(key: &str, path: &str) -> String {
    let list = LISTS.iter().find(|(known, _)| *known == path);
    match list {
        Some((_, name)) => (*name).to_string(),
        None if RESERVED.contains(&key) => format!("{key}_"),
        None => key.to_string(),
    }
}

/// The type that a value has when it is read.
fn got(schema: &Json) -> String {
    let options: Vec<String> = alternatives(schema).map(got).collect();
    if !options.is_empty() {
        return union(options);
    }
    if let Some(words) = schema.get("enum").and_then(Json::as_array) {
        return words_of(words);
    }
    match schema.get("type").and_then(Json::as_str) {
        Some("array") => format!("list[{}]", element(schema, got)),
        _ => plain(schema).to_string(),
    }
}

/// The type that a value may have when it is assigned, without tables.
fn given_plain(schema: &Json) -> String {
    if let Some(words) = schema.get("enum").and_then(Json::as_array) {
        return words_of(words);
    }
    match schema.get("type").and_then(Json::as_str) {
        Some("array") => {
            let of = element(schema, given_plain);
            let array = if of.contains("str") || of.contains("Literal") {
                ""
            } else {
                " | NDArray[Any]"
            };
            format!("Sequence[{of}]{array}")
        }
        _ => plain(schema).to_string(),
    }
}

/// The type of the elements of a list; rows of several kinds have any.
fn element(schema: &Json, each: fn(&Json) -> String) -> String {
    schema.get("items").map_or_else(|| "Any".to_string(), each)
}

fn plain(schema: &Json) -> &'static str {
    match schema.get("type").and_then(Json::as_str) {
        Some("number") => "float",
        Some("integer") => "int",
        Some("boolean") => "bool",
        Some("string") => "str",
        _ => "Any",
    }
}

fn words_of(words: &[Json]) -> String {
    let words: Vec<String> = words.iter().map(python).collect();
    format!("Literal[{}]", words.join(", "))
}

fn union(options: Vec<String>) -> String {
    let mut out: Vec<String> = Vec::new();
    for option in options {
        if !out.contains(&option) {
            out.push(option);
        }
    }
    out.join(" | ")
}

/// A value as Python writes it.
fn python(value: &Json) -> String {
    match value {
        Json::Bool(true) => "True".to_string(),
        Json::Bool(false) => "False".to_string(),
        Json::Null => "None".to_string(),
        Json::Array(list) => {
            let list: Vec<String> = list.iter().map(python).collect();
            format!("[{}]", list.join(", "))
        }
        other => other.to_string(),
    }
}

fn literal(text: &str) -> String {
    python(&Json::from(text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn schema() -> Json {
        json!({ "description": "a case", "properties": {
            "contact": { "description": "pairs", "type": "array", "items": {
                "description": "pairs", "type": "object", "properties": {
                    "friction": { "description": "how rough", "default": 0.0, "anyOf": [
                        { "type": "number" },
                        { "type": "object", "description": "limits", "properties": { "mu": { "type": "number" } } },
                    ] },
                    "method": { "description": "how", "enum": ["auto", "mortar"], "default": "auto" },
                    "later": { "description": "not yet", "not": {} },
                } } },
            "material": { "description": "materials", "type": "object", "additionalProperties": {
                "description": "materials", "type": "object",
                "properties": { "E": { "type": "number" }, "model": { "enum": ["linear-elastic", "own"] } },
                "allOf": [
                    { "if": { "properties": { "model": { "const": "linear-elastic" } } },
                        "then": { "description": "linear", "required": ["E"] } },
                    { "if": { "properties": { "model": { "const": "own" } } },
                        "then": { "description": "own", "required": [] } },
                ] } },
            "surface": { "description": "surfaces", "type": "array", "items": { "properties": {
                "shape": { "description": "a shape", "properties": {
                    "plane": { "description": "flat", "required": ["normal", "point"], "properties": {
                        "normal": { "type": "array", "items": { "type": "number" } },
                        "point": { "type": "array", "items": { "type": "number" } },
                    } },
                } },
            } } },
            "title": { "description": "a title", "type": "string" },
        } })
    }

    #[test]
    fn every_key_is_an_attribute_with_its_type() {
        let module = module(&schema());
        for line in [
            "class ContactFriction(Table):",
            "    friction: Mixed[ContactFriction] = Mixed(ContactFriction, \"How rough\", \"number or a table\", default=0.0)",
            "    title: Key[str | None, str] = Key(\"A title\", \"text\")",
            "    contacts: Items[Contact] = Items(Contact, \"Pairs\", \"list of a table\", key=\"contact\")",
            "    materials: Named[Material] = Named(Material, \"Materials\", \"tables by name\", key=\"material\")",
            "        \"friction\": float | ContactFriction | Mapping[str, Any] | FrictionLimit,",
        ] {
            assert!(module.lines().any(|one| one == line), "{line}\n{module}");
        }
        assert!(!module.contains("later"));
    }

    #[test]
    fn a_model_takes_its_constants() {
        let module = module(&schema());
        let class = module
            .split("class LinearElastic(Material):")
            .nth(1)
            .unwrap();
        let class = class.split("\n\n\nclass").next().unwrap();
        assert!(class.contains("_model = \"linear-elastic\""), "{class}");
        assert!(class.contains("        E: float,\n"), "{class}");
        assert!(!module.contains("class Own("));
    }

    #[test]
    fn places_of_shapes_are_at_the_origin() {
        let module = module(&schema());
        let class = module.split("class Plane(Shape):").nth(1).unwrap();
        assert!(
            class.contains("        normal: Sequence[float] | NDArray[Any],\n"),
            "{class}"
        );
        let point = "        point: Sequence[float] | NDArray[Any] = (0.0, 0.0, 0.0),\n";
        assert!(class.contains(point), "{class}");
    }

    /// The keys of pairs come before those of the start in the alphabet.
    #[test]
    fn a_shared_table_is_called_after_the_shortest_path() {
        let start = json!({ "properties": { "gap": { "type": "number" } } });
        let pair = json!({ "type": "array", "items": { "properties": { "start": start } } });
        let contact = json!({ "properties": { "pair": pair, "start": start } });
        let module = module(&json!({ "properties": { "contact": contact } }));
        assert!(module.contains("class ContactStart(Table):"), "{module}");
        assert!(module.contains("_toml = \"contact.start\""), "{module}");
        assert!(!module.contains("ContactPairStart"), "{module}");
    }

    #[test]
    fn inner_tables_come_first() {
        let module = module(&schema());
        let place = |class: &str| module.find(&format!("class {class}(")).unwrap();
        assert!(place("ContactFriction") < place("Contact"));
        assert!(place("Contact") < place("CaseTable"));
    }
}
