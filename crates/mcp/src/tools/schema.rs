//! The tool that describes the keys of cases.

use crate::Server;
use crate::reply::{Refusal, Reply, counted};
use rmcp::RoleServer;
use rmcp::service::RequestContext;
use serde_json::{Value, json};

/// What is known of a place in the schema.
struct Found<'a> {
    /// Its schema.
    schema: &'a Value,
    /// The keys in it with their schemas, in alphabetical order.
    keys: Vec<(&'a str, &'a Value)>,
}

impl Server {
    /// The JSON schema of cases, which the command prints once.
    pub(super) async fn case_schema(
        &self,
        context: &RequestContext<RoleServer>,
    ) -> Result<&Value, Refusal> {
        let arguments = ["schema".to_owned()];
        self.known_schema()
            .get_or_try_init(|| self.ask(&arguments, context))
            .await
    }
}

/// The part of a schema at a path of keys such as `contact.friction`; all of it without a path.
pub(super) fn described(schema: &Value, path: &str) -> Result<Reply, Refusal> {
    let mut here = vec![schema];
    for (depth, name) in path.split('.').filter(|name| !name.is_empty()).enumerate() {
        // `contact[0]` and `contact` are the same here
        let name = name.split('[').next().unwrap_or(name);
        let next: Vec<&Value> = here.iter().flat_map(|node| inner(node, name)).collect();
        if next.is_empty() {
            let before: Vec<&str> = path.split('.').take(depth).collect();
            return Err(unknown(name, &before.join("."), &here));
        }
        here = next;
    }
    let Some(schema) = here.first() else {
        return Err(Refusal::value("key", "the schema is empty"));
    };
    let found = Found {
        schema,
        keys: keys_of(&here),
    };
    Ok(found.reply(path))
}

impl Found<'_> {
    fn reply(&self, path: &str) -> Reply {
        let keys: Vec<Value> = self
            .keys
            .iter()
            .map(|(name, schema)| {
                let mut one = json!({ "key": name, "form": form(schema) });
                for member in ["description", "default"] {
                    if let Some(value) = schema.get(member) {
                        one[member] = value.clone();
                    }
                }
                one["required"] = self.requires(name).into();
                one
            })
            .collect();
        let mut text = match path {
            "" => format!("a case has {}", counted(self.keys.len(), "key")),
            path => format!("{path}: {}", remark(self.schema)),
        };
        for (name, schema) in &self.keys {
            let needed = if self.requires(name) {
                ", required"
            } else {
                ""
            };
            text.push_str(&format!("\n{name}{needed}: {}", remark(schema)));
        }
        text.push_str(match path {
            "" => "\nAsk for one of them by `key`, as in contact or contact.friction.",
            _ => "",
        });
        let mut value = json!({ "ok": true, "key": path, "keys": keys });
        if !path.is_empty() {
            value["schema"] = self.schema.clone();
        }
        Reply::new(text, value)
    }

    fn requires(&self, name: &str) -> bool {
        let tables = [Some(self.schema), self.schema.get("items")];
        tables.into_iter().flatten().any(|table| {
            let required = table.get("required").and_then(Value::as_array);
            required.is_some_and(|list| list.iter().any(|one| one == name))
        })
    }
}

/// What a schema says of itself: form, default, description.
fn remark(schema: &Value) -> String {
    let mut text = form(schema);
    if let Some(default) = schema.get("default") {
        text.push_str(&format!(", default {default}"));
    }
    if let Some(description) = schema.get("description").and_then(Value::as_str) {
        text.push_str(&format!("; {description}"));
    }
    text
}

/// The form of a value, in words.
fn form(schema: &Value) -> String {
    if let Some(words) = schema.get("enum").and_then(Value::as_array) {
        let words: Vec<String> = words.iter().map(Value::to_string).collect();
        return words.join(" | ");
    }
    for several in ["anyOf", "oneOf"] {
        if let Some(forms) = schema.get(several).and_then(Value::as_array) {
            let forms: Vec<String> = forms.iter().map(form).collect();
            return forms.join(" | ");
        }
    }
    match schema.get("type").and_then(Value::as_str) {
        Some("object") => "table".into(),
        Some("array") => match schema.get("items") {
            Some(items) => format!("list of {}", form(items)),
            None => "list".into(),
        },
        Some(kind) => kind.into(),
        None => "value".into(),
    }
}

/// Schemas that are alternatives, or parts, of this one, and it.
fn alternatives(schema: &Value) -> Vec<&Value> {
    let mut all = vec![schema];
    for several in ["anyOf", "oneOf", "allOf"] {
        let forms = schema.get(several).and_then(Value::as_array);
        all.extend(forms.into_iter().flatten().flat_map(alternatives));
    }
    if let Some(items) = schema.get("items") {
        all.extend(alternatives(items));
    }
    all
}

/// The schemas of a key in a table, in a list of tables, or in one of several forms.
fn inner<'a>(schema: &'a Value, name: &str) -> Vec<&'a Value> {
    let mut found = Vec::new();
    for one in alternatives(schema) {
        let key = one.get("properties").and_then(|keys| keys.get(name));
        // tables whose keys are names of the user
        let any = one
            .get("additionalProperties")
            .filter(|any| any.is_object());
        found.extend(key.or(any));
    }
    found
}

fn keys_of<'a>(schemas: &[&'a Value]) -> Vec<(&'a str, &'a Value)> {
    let mut keys: Vec<(&str, &Value)> = Vec::new();
    for schema in schemas.iter().flat_map(|schema| alternatives(schema)) {
        for (name, one) in schema
            .get("properties")
            .and_then(Value::as_object)
            .into_iter()
            .flatten()
        {
            if !keys.iter().any(|(known, _)| known == name) {
                keys.push((name, one));
            }
        }
        if let Some(any) = schema
            .get("additionalProperties")
            .filter(|any| any.is_object())
        {
            keys.push(("(a name)", any));
        }
    }
    keys
}

fn unknown(name: &str, before: &str, here: &[&Value]) -> Refusal {
    let known: Vec<&str> = keys_of(here).iter().map(|(name, _)| *name).collect();
    let near = known
        .iter()
        .map(|known| (strsim::damerau_levenshtein(known, name), known))
        .filter(|(distance, _)| *distance <= 2)
        .min();
    let hint = near.map_or_else(String::new, |(_, near)| format!("; did you mean {near}?"));
    let place = if before.is_empty() { "a case" } else { before };
    let name: String = name.chars().take(100).collect();
    let list = if known.is_empty() {
        "it has none".to_owned()
    } else {
        format!("there are: {}", known.join(", "))
    };
    Refusal::value(
        "key",
        format!("{place} has no key \"{name}\"{hint} ({list})"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn schema() -> Value {
        json!({
            "type": "object",
            "required": ["mesh"],
            "properties": {
                "mesh": { "type": "object", "description": "nodes and elements", "required": ["file"],
                    "properties": { "file": { "type": "string", "description": "path" } } },
                "material": { "type": "object", "additionalProperties":
                    { "type": "object", "properties": { "E": { "type": "number" } } } },
                "contact": { "type": "array", "items": { "type": "object", "required": ["name"], "properties": {
                    "name": { "type": "string" },
                    "friction": { "anyOf": [
                        { "enum": ["none"] },
                        { "type": "object", "properties": { "mu": { "type": "number", "default": 0.3 } } } ] } } } }
            }
        })
    }

    #[test]
    fn without_a_key_the_top_is_listed() {
        let reply = described(&schema(), "").unwrap();
        assert!(
            reply.text.starts_with("a case has 3 keys"),
            "{}",
            reply.text
        );
        assert!(
            reply
                .text
                .contains("mesh, required: table; nodes and elements")
        );
        assert!(!reply.value.contains_key("schema"));
        assert_eq!(reply.value["keys"][0]["key"], "contact");
    }

    #[test]
    fn keys_are_found_in_tables_lists_alternatives_and_named_tables() {
        let reply = described(&schema(), "contact.friction.mu").unwrap();
        assert_eq!(reply.value["schema"]["default"], 0.3);
        assert_eq!(reply.text, "contact.friction.mu: number, default 0.3");
        let friction = described(&schema(), "contact[0].friction").unwrap();
        assert!(friction.text.contains("\"none\" | table") && friction.text.contains("\nmu: "));
        assert!(described(&schema(), "material.steel.E").is_ok());
        let contact = described(&schema(), "contact").unwrap();
        assert!(
            contact.text.contains("name, required: string"),
            "{}",
            contact.text
        );
    }

    #[test]
    fn unknown_keys_are_refused_with_those_there_are() {
        let error = described(&schema(), "contact.frictoin")
            .unwrap_err()
            .to_string();
        assert!(error.contains("did you mean friction?"), "{error}");
        let error = described(&schema(), "mesh.file.x").unwrap_err().to_string();
        assert!(
            error.contains("mesh.file has no key \"x\" (it has none)"),
            "{error}"
        );
    }
}
