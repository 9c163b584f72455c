//! Values as text, in the order of the vocabulary.

use std::fmt::Write as _;

use super::super::parts::Name;
use super::super::vocabulary::{Shape, Table};
use signorini_vocabulary::{Chosen, Value as Given, Values};

/// A value as it is to be written.
pub(super) enum Value {
    Text(String),
    Number(f64),
    Count(u64),
    Flag(bool),
    List(Vec<Value>),
    /// A table that the vocabulary knows.
    Table(Entries),
    /// Tables by names of the user's choice, or a list of tables.
    Tables(Vec<(Option<String>, Entries)>),
}

pub(super) type Entries = Vec<(&'static str, Value)>;

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Value::Text(text.to_owned())
    }
}

impl From<&String> for Value {
    fn from(text: &String) -> Self {
        Value::Text(text.clone())
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Value::Number(number)
    }
}

impl From<u64> for Value {
    fn from(number: u64) -> Self {
        Value::Count(number)
    }
}

impl From<bool> for Value {
    fn from(flag: bool) -> Self {
        Value::Flag(flag)
    }
}

impl<const N: usize> From<[f64; N]> for Value {
    fn from(row: [f64; N]) -> Self {
        list(row)
    }
}

impl<const N: usize> From<&[f64; N]> for Value {
    fn from(row: &[f64; N]) -> Self {
        list(row.iter().copied())
    }
}

pub(super) fn list<T: Into<Value>>(items: impl IntoIterator<Item = T>) -> Value {
    Value::List(items.into_iter().map(Into::into).collect())
}

pub(super) fn named<'a, T>(items: &'a [T], entry: impl Fn(&'a T) -> (&'a Name, Entries)) -> Value {
    let entries = items.iter().map(|one| {
        let (name, entries) = entry(one);
        (Some(name.value.clone()), entries)
    });
    Value::Tables(entries.collect())
}

pub(super) fn tables<T>(items: &[T], entries: impl Fn(&T) -> Entries) -> Value {
    Value::Tables(items.iter().map(|one| (None, entries(one))).collect())
}

pub(super) fn names<'a>(items: impl IntoIterator<Item = &'a Name>) -> Value {
    list(items.into_iter().map(|name| &name.value))
}

/// A thing that another room describes: its name as the key, its only value or the table of its values.
pub(super) fn chosen(chosen: &Chosen) -> (&'static str, Value) {
    let written = match chosen.bare_value() {
        Some(value) => given(value),
        None => Value::Table(values(&chosen.values)),
    };
    (chosen.name, written)
}

/// The values of the keys of a thing.
pub(super) fn values(values: &Values) -> Entries {
    values
        .iter()
        .map(|(key, value)| (key, given(value)))
        .collect()
}

fn given(value: &Given) -> Value {
    match value {
        Given::Number(number) => Value::Number(*number),
        Given::Numbers(numbers) => list(numbers.iter().copied()),
        Given::Text(text) => Value::Text(text.clone()),
    }
}

/// Writes the keys of a table in the order of the vocabulary: values first, then tables below headings.
pub(super) fn write_table(text: &mut String, words: &Table, path: &str, entries: &Entries) {
    let ordered = || {
        words.keys.iter().filter_map(|key| {
            let (_, value) = entries.iter().find(|(name, _)| *name == key.name)?;
            Some((key, value))
        })
    };
    for (key, value) in ordered().filter(|(key, value)| !has_heading(&key.shape, value, path)) {
        let written = inline(value, true);
        if written.contains('\n') {
            let _ = writeln!(text, "# {}\n{} = {written}", key.doc, key.name);
        } else {
            let _ = writeln!(
                text,
                "{:<40} # {}",
                format!("{} = {written}", key.name),
                key.doc
            );
        }
    }
    for (key, value) in ordered().filter(|(key, value)| has_heading(&key.shape, value, path)) {
        let full = if path.is_empty() {
            key.name.to_owned()
        } else {
            format!("{path}.{}", key.name)
        };
        match (&key.shape, value) {
            (Shape::Table(inner), Value::Table(entries)) => {
                let _ = writeln!(text, "\n[{full}]");
                write_table(text, inner, &full, entries);
            }
            (Shape::Tables(inner) | Shape::Named(inner), Value::Tables(tables)) => {
                for (name, entries) in tables {
                    match name {
                        Some(name) => {
                            let full = format!("{full}.{}", bare_or_quoted(name));
                            let _ = writeln!(text, "\n[{full}]");
                            write_table(text, inner, &full, entries);
                        }
                        None => {
                            let _ = writeln!(text, "\n[[{full}]]");
                            write_table(text, inner, &full, entries);
                        }
                    }
                }
            }
            _ => {}
        }
    }
}

/// Tables of the first level and lists of tables stand below headings of their own.
fn has_heading(shape: &Shape, value: &Value, path: &str) -> bool {
    match (shape, value) {
        (Shape::Table(_), Value::Table(_)) => path.is_empty(),
        (_, Value::Tables(_)) => true,
        _ => false,
    }
}

/// A value in one line; long lists of the outermost level get one line for each entry.
fn inline(value: &Value, outermost: bool) -> String {
    match value {
        Value::Text(text) => quoted(text),
        Value::Number(number) => format!("{number:?}"),
        Value::Count(number) => number.to_string(),
        Value::Flag(flag) => flag.to_string(),
        Value::List(items) => {
            let items: Vec<String> = items.iter().map(|one| inline(one, false)).collect();
            let nested = items
                .first()
                .is_some_and(|first| first.starts_with(['[', '{']));
            if outermost && nested && items.len() > 1 {
                format!("[\n  {},\n]", items.join(",\n  "))
            } else {
                format!("[{}]", items.join(", "))
            }
        }
        Value::Table(entries) if entries.is_empty() => "{}".to_owned(),
        Value::Table(entries) => {
            let entries: Vec<String> = entries
                .iter()
                .map(|(key, value)| format!("{key} = {}", inline(value, false)))
                .collect();
            format!("{{ {} }}", entries.join(", "))
        }
        Value::Tables(_) => String::new(),
    }
}

fn bare_or_quoted(name: &str) -> String {
    let bare = !name.is_empty()
        && name
            .bytes()
            .all(|byte| byte.is_ascii_alphanumeric() || b"_-".contains(&byte));
    if bare { name.to_owned() } else { quoted(name) }
}

/// A basic string of TOML.
fn quoted(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            c if c.is_control() => {
                let _ = write!(out, "\\u{:04X}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}
