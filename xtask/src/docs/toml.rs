//! TOML as plain data with places.

use std::ops::Range;
use toml_edit::{Document, InlineTable, Item, Key, Table, Value};

/// A value and where it begins in the text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Data {
    pub at: usize,
    pub kind: Kind,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    Table(Vec<Entry>),
    List(Vec<Data>),
    Text(String),
    Integer,
    Number,
    Flag,
    Date,
}

/// A key of a table with its value.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    pub at: usize,
    pub key: String,
    pub value: Data,
}

impl Data {
    /// The value of a key, where it is a table that has it.
    pub fn get(&self, key: &str) -> Option<&Self> {
        let Kind::Table(entries) = &self.kind else {
            return None;
        };
        entries
            .iter()
            .find(|entry| entry.key == key)
            .map(|entry| &entry.value)
    }
}

/// Why a text is no TOML, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct NoToml {
    pub at: usize,
    pub reason: String,
}

/// Reads a document.
pub(super) fn parse(text: &str) -> Result<Data, NoToml> {
    let document = Document::parse(text).map_err(|error| NoToml {
        at: start(error.span()),
        reason: error.message().to_string(),
    })?;
    Ok(table(document.as_table()))
}

fn start(span: Option<Range<usize>>) -> usize {
    span.map_or(0, |span| span.start)
}

fn entry(key: Option<&Key>, name: &str, value: Data) -> Entry {
    Entry {
        at: key.and_then(Key::span).map_or(value.at, |span| span.start),
        key: name.to_string(),
        value,
    }
}

fn table(table: &Table) -> Data {
    let entries = table
        .iter()
        .map(|(name, value)| entry(table.key(name), name, item(value)));
    Data {
        at: start(table.span()),
        kind: Kind::Table(entries.collect()),
    }
}

fn inline(table: &InlineTable) -> Kind {
    let entries = table
        .iter()
        .map(|(name, inner)| entry(table.key(name), name, value(inner)));
    Kind::Table(entries.collect())
}

fn item(item: &Item) -> Data {
    match item {
        Item::Value(inner) => value(inner),
        Item::Table(inner) => table(inner),
        Item::ArrayOfTables(list) => Data {
            at: start(list.span()),
            kind: Kind::List(list.iter().map(table).collect()),
        },
        Item::None => Data {
            at: 0,
            kind: Kind::List(Vec::new()),
        },
    }
}

fn value(value_: &Value) -> Data {
    let kind = match value_ {
        Value::String(text) => Kind::Text(text.value().clone()),
        Value::Integer(_) => Kind::Integer,
        Value::Float(_) => Kind::Number,
        Value::Boolean(_) => Kind::Flag,
        Value::Datetime(_) => Kind::Date,
        Value::Array(list) => Kind::List(list.iter().map(value).collect()),
        Value::InlineTable(table) => inline(table),
    };
    Data {
        at: start(value_.span()),
        kind,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_and_values_have_places() {
        let data = parse("a = 1\n[[b]]\nc = { d = \"e\" }\n").unwrap();
        let Kind::Table(entries) = data.kind else {
            panic!()
        };
        assert_eq!((entries[0].at, entries[0].value.at), (0, 4));
        let Kind::List(tables) = &entries[1].value.kind else {
            panic!()
        };
        let Kind::Table(inner) = &tables[0].kind else {
            panic!()
        };
        assert_eq!((inner[0].key.as_str(), inner[0].at), ("c", 12));
    }

    #[test]
    fn what_is_no_toml_has_a_place_and_a_reason() {
        assert_eq!(parse("a = 1\nb =").unwrap_err().at, 9);
    }
}
