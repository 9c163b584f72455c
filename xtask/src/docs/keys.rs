//! The keys of cases, as `signorini schema` lists them, and texts in TOML that use them.

use super::toml::{Data, Kind, parse};
use serde_json::Value as Json;

/// The JSON schema of cases.
#[derive(Debug)]
pub(super) struct Keys {
    schema: Json,
}

/// What is wrong with a text, and where in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Fault {
    pub at: usize,
    pub what: String,
}

impl Keys {
    pub const fn new(schema: Json) -> Self {
        Self { schema }
    }

    /// The schema itself.
    pub const fn schema(&self) -> &Json {
        &self.schema
    }

    /// Faults of a text that is a case or a part of one; with the key `format` it has to be whole.
    pub fn faults(&self, text: &str) -> Vec<Fault> {
        match parse(text) {
            Ok(data) => {
                let is_whole = data.get("format").is_some();
                check(&self.schema, &data, is_whole)
            }
            Err(error) => vec![Fault {
                at: error.at,
                what: format!("this is no TOML: {}", error.reason),
            }],
        }
    }

    /// Whether a value may stand somewhere in a case: under `key`, or, without one, under any.
    pub fn fits(&self, key: Option<&str>, value: &Data) -> bool {
        let fits = |schema: &&Json| check(schema, value, false).is_empty();
        self.under(key).iter().any(fits)
    }

    /// Whether there is such a key.
    pub fn has(&self, key: &str) -> bool {
        !self.under(Some(key)).is_empty()
    }

    /// Whether a case has this key at its top.
    pub fn has_top(&self, key: &str) -> bool {
        self.schema
            .get("properties")
            .is_some_and(|all| all.get(key).is_some())
    }

    /// Whether a dotted path leads to a value: `material.NAME.E`, or `contact.NAME.friction` of a list.
    pub fn leads(&self, path: &str) -> bool {
        let mut level = vec![&self.schema];
        let mut parts = path.split('.').peekable();
        while let Some(part) = parts.next() {
            let is_last = parts.peek().is_none();
            let of = |schema| {
                let named = named_items(schema).filter(|_| !is_last);
                step(schema, part).into_iter().chain(named)
            };
            level = level.into_iter().flat_map(of).collect();
        }
        !level.is_empty()
    }

    /// Whether a word is a value that a key may have.
    pub fn has_word(&self, word: &str) -> bool {
        let mut found = false;
        visit(&self.schema, &mut |schema| {
            let is_word = |value: &Json| value.as_str() == Some(word);
            let list = schema.get("enum").and_then(Json::as_array);
            found |= list.is_some_and(|list| list.iter().any(is_word));
            found |= schema.get("const").is_some_and(is_word);
        });
        found
    }

    /// The schemas that hold under a key, or all there are.
    fn under(&self, key: Option<&str>) -> Vec<&Json> {
        let mut out = Vec::new();
        visit(&self.schema, &mut |schema| match key {
            None => out.push(schema),
            Some(key) => out.extend(schema.get("properties").and_then(|all| all.get(key))),
        });
        out
    }
}

/// Goes through a schema and all in it.
fn visit<'a>(schema: &'a Json, f: &mut impl FnMut(&'a Json)) {
    f(schema);
    let properties = schema.get("properties").and_then(Json::as_object);
    let below = properties.into_iter().flat_map(|all| all.values());
    for schema in below
        .chain(alternatives(schema))
        .chain(elements(schema))
        .chain(others(schema))
    {
        visit(schema, f);
    }
}

pub(super) fn alternatives(schema: &Json) -> impl Iterator<Item = &Json> {
    let lists = ["anyOf", "oneOf"]
        .iter()
        .filter_map(|name| schema.get(name)?.as_array());
    lists.flatten()
}

pub(super) fn elements(schema: &Json) -> impl Iterator<Item = &Json> {
    let each = schema.get("items").filter(|items| items.is_object());
    let first = schema.get("prefixItems").and_then(Json::as_array);
    each.into_iter().chain(first.into_iter().flatten())
}

pub(super) fn others(schema: &Json) -> Option<&Json> {
    schema
        .get("additionalProperties")
        .filter(|other| other.is_object())
}

/// The tables of a list that go by their name in a path: `contact.NAME.friction`.
fn named_items(schema: &Json) -> Option<&Json> {
    let items = schema.get("items")?;
    items.get("properties")?.get("name").map(|_| items)
}

/// Where one part of a dotted path leads; lists are gone into.
fn step<'a>(schema: &'a Json, part: &str) -> Vec<&'a Json> {
    let named = schema.get("properties").and_then(|all| all.get(part));
    let direct = named.or_else(|| others(schema));
    let inside = alternatives(schema).chain(elements(schema));
    direct
        .into_iter()
        .chain(inside.flat_map(|schema| step(schema, part)))
        .collect()
}

/// Faults of a value. Of a part of a case, required keys may be absent, and `[step.x]` may stand for `[[step]]`.
fn check(schema: &Json, data: &Data, is_whole: bool) -> Vec<Fault> {
    let options: Vec<&Json> = alternatives(schema).collect();
    if !options.is_empty() {
        return check_options(&options, data, is_whole);
    }
    if let Some(words) = schema.get("enum").and_then(Json::as_array) {
        return check_word(words, data);
    }
    let name = schema.get("type").and_then(Json::as_str);
    match (name, &data.kind) {
        (Some("object"), Kind::Table(_)) => check_table(schema, data, is_whole),
        (Some("array"), Kind::List(list)) => {
            let fixed = schema.get("prefixItems").and_then(Json::as_array);
            let of = |i: usize| {
                fixed
                    .and_then(|fixed| fixed.get(i))
                    .or_else(|| schema.get("items"))
            };
            let each = list.iter().enumerate();
            each.filter_map(|(i, data)| Some(check(of(i)?, data, is_whole)))
                .flatten()
                .collect()
        }
        (Some("array"), Kind::Table(_)) if !is_whole => elements(schema)
            .flat_map(|schema| check(schema, data, is_whole))
            .collect(),
        (Some("string"), Kind::Text(_))
        | (Some("number"), Kind::Integer | Kind::Number)
        | (Some("integer"), Kind::Integer)
        | (Some("boolean"), Kind::Flag)
        | (None, _) => Vec::new(),
        (Some(name), _) => fault(
            data.at,
            format!("the key takes a value of another type: {name}"),
        ),
    }
}

fn fault(at: usize, what: String) -> Vec<Fault> {
    vec![Fault { at, what }]
}

/// Faults by the alternative that suits best.
fn check_options(options: &[&Json], data: &Data, is_whole: bool) -> Vec<Fault> {
    let found: Vec<Vec<Fault>> = options
        .iter()
        .map(|option| check(option, data, is_whole))
        .collect();
    if found.iter().any(Vec::is_empty) {
        return Vec::new();
    }
    let inside = found
        .into_iter()
        .find(|faults| faults.iter().all(|fault| fault.at != data.at));
    inside.unwrap_or_else(|| fault(data.at, "the key does not take such a value".to_string()))
}

fn check_word(words: &[Json], data: &Data) -> Vec<Fault> {
    let Kind::Text(word) = &data.kind else {
        return fault(data.at, "the key takes a word".to_string());
    };
    if words.iter().any(|known| known.as_str() == Some(word)) {
        return Vec::new();
    }
    let words: Vec<&str> = words.iter().filter_map(Json::as_str).collect();
    fault(
        data.at,
        format!(
            "the key does not take \"{word}\"; it takes {}",
            words.join(", ")
        ),
    )
}

fn check_table(schema: &Json, data: &Data, is_whole: bool) -> Vec<Fault> {
    let Kind::Table(entries) = &data.kind else {
        return Vec::new();
    };
    let mut out = Vec::new();
    for entry in entries {
        let named = schema.get("properties").and_then(|all| all.get(&entry.key));
        match named.or_else(|| others(schema)) {
            Some(schema) => out.extend(check(schema, &entry.value, is_whole)),
            None => out.extend(fault(
                entry.at,
                format!("a case has no key `{}` here", entry.key),
            )),
        }
    }
    let required = schema.get("required").and_then(Json::as_array);
    for key in required.into_iter().flatten().filter_map(Json::as_str) {
        if is_whole && data.get(key).is_none() {
            out.extend(fault(
                data.at,
                format!("the key `{key}` is missing in a whole case"),
            ));
        }
    }
    out
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A small vocabulary.
    pub fn sample() -> Keys {
        let contact = serde_json::json!({ "type": "object", "additionalProperties": false, "properties": {
            "name": { "type": "string" },
            "method": { "enum": ["auto", "mortar"] },
            "enforcement": { "anyOf": [{ "enum": ["auto"] }, { "type": "object", "additionalProperties": false,
                "properties": { "penalty": { "type": "number" } } }] },
        } });
        let material = serde_json::json!({ "type": "object", "additionalProperties": false, "properties": {
            "E": { "type": "number" } } });
        Keys::new(
            serde_json::json!({ "type": "object", "additionalProperties": false, "required": ["title"],
            "properties": {
                "format": { "type": "integer" },
                "title": { "type": "string" },
                "contact": { "type": "array", "items": contact },
                "material": { "type": "object", "additionalProperties": material },
            } }),
        )
    }

    fn faults(text: &str) -> Vec<String> {
        sample()
            .faults(text)
            .into_iter()
            .map(|fault| fault.what)
            .collect()
    }

    #[test]
    fn parts_of_cases_have_known_keys_and_words() {
        for good in [
            "[[contact]]\nmethod = \"mortar\"\nenforcement = { penalty = 1e4 }\n",
            "[material.any]\nE = 1\n",
            "[contact]\nenforcement = \"auto\"",
        ] {
            assert_eq!(faults(good), [""; 0], "{good}");
        }
        assert_eq!(
            faults("[[contact]]\nmetod = \"mortar\""),
            ["a case has no key `metod` here"]
        );
        assert_eq!(
            faults("[[contact]]\nmethod = \"nts\""),
            ["the key does not take \"nts\"; it takes auto, mortar"]
        );
        assert_eq!(
            faults("[[contact]]\nenforcement = { stiffness = 1 }"),
            ["a case has no key `stiffness` here"]
        );
        assert_eq!(
            faults("[[contact]]\nenforcement = 3"),
            ["the key does not take such a value"]
        );
        assert_eq!(
            faults("[material.any]\nE = \"1\""),
            ["the key takes a value of another type: number"]
        );
        assert_eq!(faults("a =").len(), 1);
    }

    #[test]
    fn a_whole_case_has_all_that_is_required() {
        assert_eq!(
            faults("format = 1"),
            ["the key `title` is missing in a whole case"]
        );
        assert_eq!(faults("format = 1\ntitle = \"x\""), [""; 0]);
    }

    #[test]
    fn dotted_keys_lead_somewhere() {
        for good in [
            "material.rubber.E",
            "contact.enforcement.penalty",
            "contact.foot.enforcement.penalty",
        ] {
            assert!(sample().leads(good), "{good}");
        }
        for bad in ["material.rubber.modulus", "contact.law", "contact.foot.law"] {
            assert!(!sample().leads(bad), "{bad}");
        }
    }

    #[test]
    fn values_fit_under_some_key() {
        let value = |text: &str| parse(text).unwrap().get("x").cloned().unwrap();
        let keys = sample();
        assert!(keys.fits(Some("method"), &value("x = \"mortar\"")));
        assert!(!keys.fits(Some("method"), &value("x = \"nts\"")));
        assert!(keys.fits(None, &value("x = { penalty = 1.0 }")));
        assert!(!keys.fits(None, &value("x = { stiffness = 1.0 }")));
        assert!(keys.has_word("mortar") && !keys.has_word("nts"));
    }
}
