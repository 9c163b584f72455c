//! Errors of the TOML text in plain words.

use std::collections::BTreeSet;
use std::ops::Range;

use toml::de::{DeTable, Error};

use super::origin::Origins;
use crate::diagnostic::{Diagnostic, Diagnostics, codes};

/// What could be read of a text, and what is wrong with the rest.
pub(super) struct Parsed<'a> {
    /// The tables; incomplete where the text is wrong.
    pub table: DeTable<'a>,
    /// What is wrong.
    pub errors: Diagnostics,
    /// Whether the tables are sound enough for their keys to be looked at.
    pub sound: bool,
}

/// More errors of the text are not reported: by then it is no case.
const MOST: usize = 100;

/// Reads the text; errors are reported one for each line, up to the first that spoils what follows.
pub(super) fn parse<'a>(text: &'a str, origins: &Origins) -> Parsed<'a> {
    let (table, errors) = DeTable::parse_recoverable(text);
    let whole = || text.len()..text.len();
    let mut errors: Vec<_> = errors
        .iter()
        .map(|error| (error.span().unwrap_or_else(whole), error))
        .collect();
    errors.sort_by_key(|(span, _)| span.start);
    let mut parsed = Parsed {
        table: table.into_inner(),
        errors: Diagnostics::new(),
        sound: true,
    };
    let mut lines = BTreeSet::new();
    for (span, error) in errors {
        if lines.insert(origins.line(span.start)) {
            let (one, local) = describe(text, error, span, origins);
            parsed.errors.push(one);
            parsed.sound &= local;
        }
        if !parsed.sound || parsed.errors.len() == MOST {
            break;
        }
    }
    parsed
}

/// The finding for an error, and whether it spoils no more than its own line.
fn describe(
    text: &str,
    error: &Error,
    span: Range<usize>,
    origins: &Origins,
) -> (Diagnostic, bool) {
    let place = origins.place(span.clone());
    let found = text.get(span.clone()).unwrap_or_default().trim();
    let message = error.message();
    let head = message.split(", expected").next().unwrap_or(message);

    if let Some((range, number)) = decimal_comma(text, span.start) {
        let place = origins.place(range);
        let one = Diagnostic::error(
            &codes::NOT_A_NUMBER,
            format!("a number was expected, found `{number}`"),
        )
        .at(&place, "a decimal comma")
        .help(format!("use a decimal point: {}", number.replace(',', ".")));
        return (one, true);
    }
    if head.starts_with("cannot recurse") || head.starts_with("recursion limit") {
        let one = Diagnostic::error(
            &codes::TOO_DEEP,
            "lists or tables are nested more than 80 deep",
        )
        .at(&place, "here it gets too deep")
        .help("look for a bracket that is not closed");
        return (one, false);
    }
    if head == "duplicate key" {
        return (given_twice(text, found, span, origins), true);
    }
    if head == "string values must be quoted" && looks_like_number(found) {
        let one = Diagnostic::error(&codes::NOT_A_NUMBER, format!("a number was expected, found `{found}`"))
            .at(&place, "not a number")
            .help("write digits, a decimal point and an exponent only, as in 2.1e5; units are said once, by `units`");
        return (one, true);
    }
    let behind = text.get(span.start..).unwrap_or_default();
    match explain(head, found, behind) {
        Some(Explained { what, help, local }) => {
            let one = Diagnostic::error(&codes::SYNTAX, what).at(&place, "");
            (one.help(help), local)
        }
        None => {
            let one = Diagnostic::error(&codes::SYNTAX, "this is not TOML");
            (one.at(&place, message.to_owned()), false)
        }
    }
}

/// The finding for a key or a heading that was given before.
fn given_twice(text: &str, found: &str, span: Range<usize>, origins: &Origins) -> Diagnostic {
    let one = Diagnostic::error(&codes::TWICE, format!("`{found}` is given twice"))
        .at(&origins.place(span.clone()), "the second time");
    let one = match first_time(text, found, span.start) {
        Some(first) => one.at(&origins.place(first), "the first time"),
        None => one,
    };
    if origins.line_text(span.start).trim_start().starts_with('[') {
        one.help(format!(
            "open each table once; where entries of a list are meant, write [[{found}]]"
        ))
    } else {
        one.help("delete one of the two")
    }
}

/// An error of the text in plain words.
struct Explained {
    what: &'static str,
    help: String,
    /// Whether it spoils no more than its own line.
    local: bool,
}

/// What the reader of TOML means by the head of its message, by what it found and by the text from there on.
fn explain(head: &str, found: &str, behind: &str) -> Option<Explained> {
    if head == "string values must be quoted" && !found.is_empty() {
        return Some(Explained {
            what: "a text needs quotes",
            help: format!("write \"{found}\""),
            local: true,
        });
    }
    let (what, help, local) = match head {
        // nothing but a blank behind the `=`
        "string values must be quoted" => ("a value is missing", "write one behind the `=`", true),
        "key with no value" => ("a key without a value", "write  key = value", false),
        "missing value" => ("a value is missing", "write one behind the `=`", false),
        "unclosed array" => ("a list is not closed", "add the missing `]`", false),
        "unclosed inline table" => ("a table is not closed", "add the missing `}`", false),
        "unclosed table" | "unclosed array table" => (
            "the heading of a table is not closed",
            "add the missing bracket",
            false,
        ),
        "missing comma between array elements"
            if behind.starts_with('}') || heading_or_key(behind) =>
        {
            (
                "a list is not closed before this",
                "add the missing `]`",
                false,
            )
        }
        "missing comma between array elements" | "missing comma between key-value pairs" => {
            ("a comma is missing", "separate entries by commas", false)
        }
        "extra comma in array" | "extra comma in inline table" => {
            ("a comma too much", "delete it", false)
        }
        "unexpected key or value" | "unexpected content" => (
            "something stands behind the value",
            "one key and its value per line; remarks start with #",
            true,
        ),
        "invalid basic string"
        | "invalid literal string"
        | "invalid multi-line basic string"
        | "invalid multi-line literal string" => (
            "a text is not closed or holds a wrong character",
            "close the quote; write \\\\ for a backslash, or use '…'",
            false,
        ),
        "unexpected leading zero" => ("a number starts with 0", "delete the leading zeros", true),
        "invalid float" | "invalid integer number" | "unexpected sign" => {
            ("this is not a number", "write it as 1.0, 25 or 2.1e5", true)
        }
        _ => return None,
    };
    Some(Explained {
        what,
        help: help.to_owned(),
        local,
    })
}

/// Digits, a comma and digits as the whole value of the line: `nu = 0,3`.
fn decimal_comma(text: &str, at: usize) -> Option<(Range<usize>, &str)> {
    let at = at.min(text.len());
    let start = text.get(..at)?.rfind('\n').map_or(0, |n| n + 1);
    let rest = text.get(start..)?;
    let line = rest.get(..rest.find('\n').unwrap_or(rest.len()))?;
    let equals = line.find('=')?;
    let value = line.get(equals + 1..)?.split('#').next()?;
    let number = value.trim();
    let (whole, fraction) = number.split_once(',')?;
    let digits = |part: &str| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit());
    let mantissa = fraction.split(['e', 'E']).next()?;
    if !digits(whole.trim_start_matches(['-', '+'])) || !digits(mantissa) {
        return None;
    }
    let from = start + equals + 1 + (value.len() - value.trim_start().len());
    Some((from..from + number.len(), number))
}

/// A bare word that starts like a number: `210GPa`, `1.E-6`, `2D5`.
fn looks_like_number(word: &str) -> bool {
    let digits = word.trim_start_matches(['-', '+', '.']);
    digits.starts_with(|c: char| c.is_ascii_digit())
}

/// Where a key or heading that is given twice was given first, where the lines before say.
fn first_time(text: &str, key: &str, before: usize) -> Option<Range<usize>> {
    let start = text.get(..before)?.rfind('\n').map_or(0, |n| n + 1);
    let heading = heading_of(text.get(start..)?);
    let mut end = start;
    for line in text.get(..start)?.split_inclusive('\n').rev() {
        let start = end - line.len();
        let from = start + line.len() - line.trim_start().len();
        match (heading, heading_of(line)) {
            (Some(wanted), Some(here)) if wanted == here => return Some(from..from + here.len()),
            (None, Some(_)) => return None,
            (None, None) => {
                let behind = line.trim_start().strip_prefix(key).unwrap_or_default();
                if behind.starts_with([' ', '\t', '=']) {
                    return Some(from..from + key.len());
                }
            }
            _ => {}
        }
        end = start;
    }
    None
}

/// Whether a text goes on with a line of its own, a heading or a key with a value.
fn heading_or_key(rest: &str) -> bool {
    let line = rest.lines().next().unwrap_or_default();
    heading_of(line).is_some() || line.contains('=')
}

/// The heading that a line consists of, brackets included.
fn heading_of(line: &str) -> Option<&str> {
    let line = line.lines().next()?.split('#').next()?.trim();
    (line.starts_with('[') && line.ends_with(']') && !line.contains(',')).then_some(line)
}
