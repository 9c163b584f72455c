//! The vocabulary, the resolved case, the schema and the manual agree.

use super::*;
use crate::case::vocabulary::{Shape, Table};

#[test]
fn a_resolved_case_reads_back_to_the_same_case() {
    for text in [PAPER_BRICK, EVERYTHING, PLANE] {
        let (case, _) = read(text).unwrap_or_else(|all| panic!("{all}"));
        let written = resolved(&case, vocabulary());
        let (again, _) = read(&written).unwrap_or_else(|all| panic!("{all}"));
        assert_eq!(again, case);
        assert_eq!(resolved(&again, vocabulary()), written);
    }
}

/// The page of the manual about contacts.
const PAGE: &str = include_str!("../../../../../docs/contact.md");

#[test]
fn examples_of_the_page_about_contact_read_without_a_warning() {
    let blocks = PAGE.split("```toml\n").skip(1);
    let shown: String = blocks.filter_map(|text| text.split("```").next()).collect();
    let around = "mesh = { file = 'a.msh' }\nreference = { pilot = { at = [0, 0, 0] } }\n\
        body = [{ group = 'a', rigid = true }]\n";
    let (contacts, change) = shown.split_once("[[step.contact]]").unwrap();
    let case = |contacts: &str| {
        let text = format!("{around}{contacts}\n[[step]]\nname = 's'\n[[step.contact]]{change}");
        let (case, warnings) = read(&text).unwrap_or_else(|all| panic!("{all}"));
        assert!(warnings.is_empty(), "{warnings}");
        case
    };
    assert_eq!(case(contacts).contacts.len(), 8);
    let cells = PAGE.lines().filter_map(|line| line.strip_prefix("| "));
    let laws = cells.flat_map(|line| line.split('`').skip(1).step_by(2));
    let laws: Vec<&str> = laws.filter(|law| law.starts_with('{')).collect();
    assert!(laws.len() >= 10);
    let frictions = vocabulary().frictions().iter();
    let frictions: Vec<&str> = frictions
        .filter_map(|law| Some(law.keys.first()?.name))
        .collect();
    for law in laws {
        let of_friction = frictions.iter().any(|key| law.contains(key));
        let key = if of_friction {
            "friction"
        } else {
            "enforcement"
        };
        let other =
            format!("[[contact]]\nname = 'other'\nsecondary = 'x'\nprimary = 'y'\n{key} = {law}\n");
        assert_eq!(case(&format!("{contacts}{other}")).contacts.len(), 9);
    }
}

fn inner(shape: &'static Shape) -> Option<&'static Table> {
    match shape {
        Shape::Table(table) | Shape::Tables(table) | Shape::Named(table) => Some(table),
        Shape::Either(shapes) => shapes.iter().find_map(inner),
        _ => None,
    }
}

/// Calls `visit` with every table of the vocabulary and its path.
fn each_table(words: &'static Table, path: &str, visit: &mut impl FnMut(&'static Table, &str)) {
    visit(words, path);
    for key in words.keys.iter().filter(|key| key.later.is_none()) {
        if let Some(table) = inner(&key.shape) {
            each_table(table, &format!("{path}.{}", key.name), visit);
        }
    }
}

#[test]
fn a_resolved_case_can_say_every_key() {
    let written = [EVERYTHING, PAPER_BRICK, PLANE]
        .map(|text| {
            resolved(
                &read(text).unwrap_or_else(|all| panic!("{all}")).0,
                vocabulary(),
            )
        })
        .concat();
    each_table(vocabulary().case, "", &mut |table, path| {
        for name in table.names() {
            let said = [format!("\n{name} = "), format!(" {name} = ")]
                .iter()
                .any(|text| written.contains(text))
                || ["[", "."].iter().any(|lead| {
                    written.contains(&format!("{lead}{name}]"))
                        || written.contains(&format!("{lead}{name}."))
                });
            assert!(said || name == "format", "{path}.{name}");
        }
    });
}

#[test]
fn what_rooms_describe_has_its_words_and_keys_in_a_case() {
    let keys_of = |path: &[&str]| {
        let mut table = vocabulary().case;
        for part in path {
            table = inner(&table.key(part).unwrap().shape).unwrap();
        }
        table
    };
    let material = keys_of(&["material"]);
    let Shape::Choice(models) = material.key("model").unwrap().shape else {
        panic!("a model is a word");
    };
    for described in vocabulary().materials() {
        assert!(models.iter().any(|one| one.word == described.name));
        for key in described.keys {
            assert!(material.key(key.name).is_some(), "{}", key.name);
        }
    }
    for described in vocabulary().laws() {
        if let Some(key) = described.bare_key() {
            assert!(keys_of(&["contact", "enforcement"]).key(key.name).is_some());
            continue;
        }
        let law = keys_of(&["contact", "enforcement", described.name]);
        assert_eq!(law.keys.len(), described.keys.len());
    }
    for described in vocabulary().frictions() {
        for path in [
            &["contact", "friction"][..],
            &["step", "contact", "friction"],
        ] {
            let friction = keys_of(path);
            assert!(
                described
                    .keys
                    .iter()
                    .all(|key| friction.key(key.name).is_some())
            );
        }
    }
    assert!(vocabulary().materials().len() > 5 && vocabulary().laws().len() > 1);
}

#[test]
fn the_schema_has_every_key_with_its_meaning() {
    let text = serde_json::to_string(&schema(vocabulary())).unwrap();
    let schema: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(
        schema["$schema"],
        "https://json-schema.org/draft/2020-12/schema"
    );
    fn find(schema: &serde_json::Value) -> Option<&serde_json::Value> {
        if schema.get("properties").is_some() {
            return Some(schema);
        }
        let inner = schema
            .get("items")
            .or_else(|| schema.get("additionalProperties"));
        inner
            .and_then(find)
            .or_else(|| schema.get("anyOf")?.as_array()?.iter().find_map(find))
    }
    let mut nkey = 0;
    each_table(vocabulary().case, "", &mut |table, path| {
        let place = path
            .split('.')
            .filter(|part| !part.is_empty())
            .try_fold(&schema, |at, part| find(at)?.get("properties")?.get(part));
        let properties = &find(place.unwrap_or_else(|| panic!("{path}"))).unwrap()["properties"];
        for key in table.keys {
            let property = &properties[key.name];
            assert!(
                property["description"]
                    .as_str()
                    .is_some_and(|doc| doc.starts_with(key.doc)),
                "{path}.{}",
                key.name
            );
            assert_eq!(property.get("not").is_some(), key.later.is_some());
            nkey += 1;
        }
        assert_eq!(properties.as_object().unwrap().len(), table.keys.len());
    });
    assert!(nkey > 130, "{nkey}");
}
