//! Changes of a case from the command line: `--set material.polymer.E=2000`.
//!
//! A path leads from table to table. Entries of lists are found by their `name`, by the `group` of a body, by what a
//! support acts `on`, or by number, the first one being 0. The value is TOML; what is not TOML is a bare text.

use std::borrow::Cow;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::check::keys_of;
use super::origin::Origins;
use super::scalar::shortened;
use super::vocabulary::{Shape, Table};
use crate::diagnostic::{Diagnostic, Diagnostics, SourceFile, closest, codes, listed};

/// Applies overrides to a document, in order; what names nothing is reported and left out.
pub(super) fn apply<'a>(
    document: &mut DeTable<'a>,
    overrides: &'a [(String, String)],
    case: &'static Table,
    origins: &mut Origins,
) -> Diagnostics {
    let mut found = Diagnostics::new();
    for (path, value) in overrides {
        let start = origins.add(SourceFile::new("--set", format!("{path}={value}")));
        let result = segments(path, start).and_then(|path_segments| {
            let value = parsed(value, start + path.len() + 1);
            set(document, case, &path_segments, value)
        });
        if let Err(Problem { span, remark, note }) = result {
            let message = format!("--set {} names nothing in the case", shortened(path));
            let mut one =
                Diagnostic::error(&codes::BAD_OVERRIDE, message).at(&origins.place(span), remark);
            one.notes.extend(note);
            found.push(one);
        }
    }
    found
}

/// A part of a path and where it stands.
struct Segment {
    name: String,
    span: Range<usize>,
}

/// Why a path leads nowhere.
struct Problem {
    span: Range<usize>,
    remark: String,
    note: Option<String>,
}

impl Problem {
    fn new(span: Range<usize>, remark: impl Into<String>) -> Self {
        Self {
            span,
            remark: remark.into(),
            note: None,
        }
    }

    fn unknown<'a>(segment: &Segment, known: impl Iterator<Item = &'a str> + Clone) -> Self {
        let remark = match closest(&segment.name, known.clone()) {
            Some(meant) => format!("did you mean `{meant}`?"),
            None => format!("there is no `{}` here", shortened(&segment.name)),
        };
        Self {
            note: Some(format!("there are: {}", listed(known))),
            ..Self::new(segment.span.clone(), remark)
        }
    }
}

/// The parts of a dotted path; TOML reads it, so that names may be quoted.
fn segments(path: &str, start: usize) -> Result<Vec<Segment>, Problem> {
    let whole = start..start + path.len();
    let odd = || {
        Problem::new(
            whole.clone(),
            "not a path; quote names with points or spaces: material.\"St 37.2\".E",
        )
    };
    let text = format!("{path} = 0");
    let document = DeTable::parse(&text).map_err(|_| odd())?.into_inner();
    let mut segments = Vec::new();
    let mut table = &document;
    loop {
        let mut entries = table.iter();
        let (Some((key, value)), None) = (entries.next(), entries.next()) else {
            return Err(odd());
        };
        let span = key.span();
        segments.push(Segment {
            name: key.get_ref().to_string(),
            span: start + span.start..start + span.end,
        });
        match value.get_ref() {
            DeValue::Table(inner) => table = inner,
            _ => return Ok(segments),
        }
    }
}

/// A value from the command line, with its place on the line of offsets.
fn parsed(text: &str, start: usize) -> Spanned<DeValue<'_>> {
    match DeValue::parse(text.trim()) {
        Ok(value) => shifted(value, start + text.len() - text.trim_start().len()),
        Err(_) => Spanned::new(
            start..start + text.len(),
            DeValue::String(Cow::Borrowed(text)),
        ),
    }
}

/// A value with its places moved.
fn shifted(value: Spanned<DeValue<'_>>, by: usize) -> Spanned<DeValue<'_>> {
    let moved = |span: Range<usize>| span.start + by..span.end + by;
    let span = moved(value.span());
    let content = match value.into_inner() {
        DeValue::Array(items) => {
            DeValue::Array(items.into_iter().map(|one| shifted(one, by)).collect())
        }
        DeValue::Table(table) => {
            let mut copy = DeTable::new();
            for (key, one) in table {
                let span = moved(key.span());
                copy.insert(Spanned::new(span, key.into_inner()), shifted(one, by));
            }
            DeValue::Table(copy)
        }
        scalar => scalar,
    };
    Spanned::new(span, content)
}

fn set<'a>(
    table: &mut DeTable<'a>,
    words: &'static Table,
    path: &[Segment],
    value: Spanned<DeValue<'a>>,
) -> Result<(), Problem> {
    let Some((segment, rest)) = path.split_first() else {
        return Ok(());
    };
    let Some(key) = words.key(&segment.name) else {
        let mut problem = Problem::unknown(segment, words.names());
        problem.note = Some(keys_of(words));
        return Err(problem);
    };
    let name = Spanned::new(segment.span.clone(), Cow::Owned(segment.name.clone()));
    if rest.is_empty() {
        table.insert(name, value);
        return Ok(());
    }
    let entry = table
        .entry(name)
        .or_insert_with(|| Spanned::new(segment.span.clone(), empty(&key.shape)));
    into(entry, &key.shape, segment, rest, value)
}

/// What a path creates on its way where nothing is.
fn empty(shape: &Shape) -> DeValue<'static> {
    match shape {
        Shape::Tables(_) | Shape::List(..) | Shape::Row(..) | Shape::Nodes => {
            DeValue::Array(DeArray::new())
        }
        _ => DeValue::Table(DeTable::new()),
    }
}

/// Goes on along a path inside of a value.
fn into<'a>(
    entry: &mut Spanned<DeValue<'a>>,
    shape: &'static Shape,
    at: &Segment,
    rest: &[Segment],
    value: Spanned<DeValue<'a>>,
) -> Result<(), Problem> {
    let Some((segment, behind)) = rest.split_first() else {
        *entry = value;
        return Ok(());
    };
    match shape {
        Shape::Either(shapes) => match shapes
            .iter()
            .find(|shape| matches!(shape, Shape::Table(_) | Shape::List(..)))
        {
            Some(shape) => into(entry, shape, at, rest, value),
            None => Err(Problem::new(
                segment.span.clone(),
                format!("`{}` has no parts", at.name),
            )),
        },
        Shape::Table(words) => {
            if !entry.get_ref().is_table() {
                *entry = Spanned::new(entry.span(), DeValue::Table(DeTable::new()));
            }
            match entry.get_mut() {
                DeValue::Table(table) => set(table, words, rest, value),
                _ => Ok(()),
            }
        }
        Shape::Named(words) => {
            let DeValue::Table(table) = entry.get_mut() else {
                return Ok(());
            };
            if !table.contains_key(segment.name.as_str()) && !behind.is_empty() {
                return Err(Problem::unknown(
                    segment,
                    table
                        .keys()
                        .map(|key| key.get_ref().as_ref())
                        .collect::<Vec<_>>()
                        .into_iter(),
                ));
            }
            if behind.is_empty() {
                let name = Spanned::new(segment.span.clone(), Cow::Owned(segment.name.clone()));
                table.insert(name, value);
                return Ok(());
            }
            match table.get_mut(segment.name.as_str()).map(Spanned::get_mut) {
                Some(DeValue::Table(inner)) => set(inner, words, behind, value),
                _ => Err(Problem::new(segment.span.clone(), "not a table")),
            }
        }
        Shape::Tables(words) => {
            let DeValue::Array(items) = entry.get_mut() else {
                return Ok(());
            };
            let at = position(items, segment)?;
            match items.get_mut(at) {
                Some(item) if behind.is_empty() => *item = value,
                Some(item) => match item.get_mut() {
                    DeValue::Table(inner) => return set(inner, words, behind, value),
                    _ => return Err(Problem::new(segment.span.clone(), "not a table")),
                },
                None => {}
            }
            Ok(())
        }
        Shape::List(item, ..) => {
            let DeValue::Array(items) = entry.get_mut() else {
                return Err(Problem::new(
                    segment.span.clone(),
                    format!("`{}` is not a list", at.name),
                ));
            };
            let at = number(items.len(), segment)?;
            match items.get_mut(at) {
                Some(one) => into(one, item, segment, behind, value),
                None => Ok(()),
            }
        }
        _ => Err(Problem::new(
            segment.span.clone(),
            format!("`{}` has no parts", at.name),
        )),
    }
}

/// The entry of a list that a segment names.
fn position(items: &DeArray<'_>, segment: &Segment) -> Result<usize, Problem> {
    let called = |value: &DeValue<'_>| -> bool {
        let Some(table) = value.as_table() else {
            return false;
        };
        ["name", "group", "on"]
            .iter()
            .filter_map(|key| table.get(*key))
            .any(|value| match value.get_ref() {
                DeValue::Array(names) => names
                    .iter()
                    .any(|name| name.get_ref().as_str() == Some(&segment.name)),
                one => one.as_str() == Some(&segment.name),
            })
    };
    let matching: Vec<usize> = items
        .iter()
        .enumerate()
        .filter(|(_, one)| called(one.get_ref()))
        .map(|(at, _)| at)
        .collect();
    match matching.as_slice() {
        [one] => Ok(*one),
        [] if segment.name.bytes().all(|byte| byte.is_ascii_digit()) => {
            number(items.len(), segment)
        }
        [] => {
            let names = items.iter().filter_map(|one| {
                let table = one.get_ref().as_table()?;
                ["name", "group", "on"]
                    .iter()
                    .find_map(|key| table.get(*key)?.get_ref().as_str())
            });
            Err(Problem::unknown(segment, names))
        }
        several => Err(Problem::new(
            segment.span.clone(),
            format!(
                "{} entries are called so; name one by its number: {}",
                several.len(),
                listed(
                    several
                        .iter()
                        .map(|n| n.to_string())
                        .collect::<Vec<_>>()
                        .iter()
                        .map(String::as_str)
                )
            ),
        )),
    }
}

/// The number, counted from 0, of an entry of a list.
fn number(length: usize, segment: &Segment) -> Result<usize, Problem> {
    let last = length.checked_sub(1);
    match (segment.name.parse::<usize>(), last) {
        (Ok(at), Some(last)) if at <= last => Ok(at),
        (_, None) => Err(Problem::new(segment.span.clone(), "the list is empty")),
        (_, Some(last)) => Err(Problem::new(
            segment.span.clone(),
            format!("the list has the entries 0 to {last}"),
        )),
    }
}
