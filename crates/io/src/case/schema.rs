//! The vocabulary as a JSON schema, for editors.

use serde_json::{Map, Value, json};
use signorini_vocabulary::Description;

use super::vocabulary::{Choice, Default, Key, Rule, Shape, Table, Vocabulary};

/// The schema of a case, in JSON Schema 2020-12.
///
/// What the format knows but this version cannot do is listed and refused.
///
/// # Example
/// ```
/// use signorini_io::case::schema;
/// use signorini_io::case::vocabulary::{Kinds, Vocabulary};
///
/// let schema = schema(&Vocabulary::new(Kinds::default()));
/// assert!(schema["properties"]["step"].is_object());
/// assert_eq!(schema["additionalProperties"], false);
/// ```
pub fn schema(vocabulary: &Vocabulary) -> Value {
    let mut schema = table(vocabulary.case);
    if let Some(map) = schema.as_object_mut() {
        map.insert(
            "$schema".to_owned(),
            json!("https://json-schema.org/draft/2020-12/schema"),
        );
        map.insert("title".to_owned(), json!("Signorini case"));
    }
    let material = schema.pointer_mut("/properties/material/additionalProperties");
    if let Some(map) = material.and_then(Value::as_object_mut) {
        let models: Vec<Value> = vocabulary.materials().iter().map(model).collect();
        if !models.is_empty() {
            map.insert("allOf".to_owned(), json!(models));
        }
    }
    schema
}

/// The constants that a model of materials needs.
fn model(model: &Description) -> Value {
    let needed = model.keys.iter();
    let needed = needed.filter(|key| key.default == Default::Required);
    let needed: Vec<&str> = needed.map(|key| key.name).collect();
    json!({
        "if": { "properties": { "model": { "const": model.name } }, "required": ["model"] },
        "then": { "description": model.doc, "required": needed },
    })
}

fn table(words: &Table) -> Value {
    let mut properties = Map::new();
    for one in words.keys {
        properties.insert(one.name.to_owned(), key(one));
    }
    let required: Vec<&str> = words
        .keys
        .iter()
        .filter(|key| key.default == Default::Required)
        .map(|key| key.name)
        .collect();
    let mut schema = json!({
        "type": "object",
        "description": words.doc,
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    });
    let rules: Vec<Value> = words.rules.iter().filter_map(rule).collect();
    if let Some(map) = schema.as_object_mut()
        && !rules.is_empty()
    {
        map.insert("allOf".to_owned(), json!(rules));
    }
    schema
}

fn key(key: &Key) -> Value {
    if let Some(instead) = key.later {
        let hint = if instead.is_empty() {
            String::new()
        } else {
            format!("; use instead: {instead}")
        };
        return json!({ "description": format!("{} (not supported yet{hint})", key.doc), "not": {} });
    }
    let mut schema = shape(&key.shape);
    if let Some(map) = schema.as_object_mut() {
        map.insert("description".to_owned(), json!(key.doc));
        let default = match key.default {
            Default::Required | Default::Absent => None,
            Default::Text(text) => Some(json!(text)),
            Default::Texts(texts) => Some(json!(texts)),
            Default::Number(number) => Some(json!(number)),
            Default::Numbers(numbers) => Some(json!(numbers)),
            Default::Integer(number) => Some(json!(number)),
            Default::Flag(flag) => Some(json!(flag)),
        };
        if let Some(default) = default {
            map.insert("default".to_owned(), default);
        }
    }
    schema
}

fn shape(form: &Shape) -> Value {
    match form {
        Shape::Text => json!({ "type": "string" }),
        Shape::Choice(choices) => json!({ "enum": built(choices) }),
        Shape::Number(bounds) => {
            let mut schema = Map::from_iter([("type".to_owned(), json!("number"))]);
            let ends = [
                ("exclusiveMinimum", bounds.above),
                ("minimum", bounds.from),
                ("exclusiveMaximum", bounds.below),
                ("maximum", bounds.to),
            ];
            for (name, end) in ends {
                if let Some(end) = end {
                    schema.insert(name.to_owned(), json!(end));
                }
            }
            Value::Object(schema)
        }
        Shape::Integer(from, i64::MAX) => json!({ "type": "integer", "minimum": from }),
        Shape::Integer(from, to) => json!({ "type": "integer", "minimum": from, "maximum": to }),
        Shape::Flag => json!({ "type": "boolean" }),
        Shape::List(item, least, usize::MAX) => {
            json!({ "type": "array", "items": shape(item), "minItems": least })
        }
        Shape::List(item, least, most) => {
            json!({ "type": "array", "items": shape(item), "minItems": least, "maxItems": most })
        }
        Shape::Row(_, items) => {
            let items: Vec<Value> = items.iter().map(shape).collect();
            json!({ "type": "array", "prefixItems": items, "minItems": items.len(), "maxItems": items.len() })
        }
        Shape::Either(shapes) => {
            let shapes: Vec<Value> = shapes
                .iter()
                .filter(|one| !matches!(one, Shape::Later(..)))
                .map(shape)
                .collect();
            json!({ "anyOf": shapes })
        }
        Shape::Table(words) => table(words),
        Shape::Tables(words) => json!({ "type": "array", "items": table(words) }),
        Shape::Named(words) => json!({ "type": "object", "additionalProperties": table(words) }),
        Shape::Nodes => json!({
            "type": "array",
            "minItems": 1,
            "items": { "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 4 },
        }),
        Shape::Later(..) => json!({ "not": {} }),
    }
}

fn built(choices: &[Choice]) -> Vec<&'static str> {
    choices
        .iter()
        .filter(|choice| choice.later.is_none())
        .map(|choice| choice.word)
        .collect()
}

/// A rule, where a schema can express it.
fn rule(rule: &Rule) -> Option<Value> {
    let each = |keys: &[&str]| {
        keys.iter()
            .map(|key| json!({ "required": [key] }))
            .collect::<Vec<_>>()
    };
    Some(match rule {
        Rule::ExactlyOne(keys) => json!({ "oneOf": each(keys) }),
        Rule::AtLeastOne(keys) => json!({ "anyOf": each(keys) }),
        Rule::AtMostOne(keys) => {
            let pairs = keys.iter().enumerate().flat_map(|(at, one)| {
                let others = keys.iter().skip(at + 1);
                others.map(move |other| json!({ "required": [one, other] }))
            });
            json!({ "not": { "anyOf": pairs.collect::<Vec<_>>() } })
        }
        Rule::Needs(key, other) => {
            let mut needs = Map::new();
            needs.insert((*key).to_owned(), json!([other]));
            json!({ "dependentRequired": needs })
        }
        Rule::Instead(key, others) => {
            json!({ "oneOf": [{ "required": [key] }, { "required": others }] })
        }
        Rule::NotAbove(..) | Rule::Below(..) => return None,
    })
}
