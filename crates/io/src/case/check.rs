//! The check of a document against the vocabulary.
//!
//! Everything that can be said by looking at one table at a time is said here: unknown keys, wrong types, numbers out
//! of range, words that are no choice, what is missing, what excludes each other, what is not supported yet. Later
//! passes find values of the right form or none.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::origin::Origins;
use super::scalar::{count, found, has_type, is_usable, number, shortened, wanted, whole};
use super::vocabulary::{Bounds, Choice, Default, Key, Rule, Shape, Table};
use crate::diagnostic::{Diagnostic, Diagnostics, closest, codes, listed};

/// After so many findings the check ends: by then it is no case.
const MOST: usize = 10_000;

/// Checks a whole document.
pub(super) fn check(
    document: &DeTable<'_>,
    case: &'static Table,
    origins: &Origins,
) -> Diagnostics {
    let mut checker = Checker {
        case,
        origins,
        found: Diagnostics::new(),
    };
    checker.table(document, case, None);
    checker.found
}

/// The entries of a table in the order in which they were written.
pub(super) fn in_order<'a, 'i>(
    table: &'a DeTable<'i>,
) -> Vec<(
    &'a Spanned<toml::de::DeString<'i>>,
    &'a Spanned<DeValue<'i>>,
)> {
    let mut entries: Vec<_> = table.iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    entries
}

struct Checker<'a> {
    case: &'static Table,
    origins: &'a Origins,
    found: Diagnostics,
}

impl Checker<'_> {
    fn table(&mut self, table: &DeTable<'_>, words: &'static Table, heading: Option<Range<usize>>) {
        // A key that a mistyped one was meant to be is not reported as missing, too.
        let mut meant = Vec::new();
        for (name, value) in in_order(table) {
            if self.found.len() > MOST {
                return;
            }
            match words.key(name.get_ref()) {
                None => meant.extend(self.unknown(name, value, words)),
                Some(Key {
                    later: Some(instead),
                    ..
                }) => {
                    self.later(name.span(), &format!("`{}`", name.get_ref()), instead);
                }
                Some(key) => self.value(value, &key.shape, key, Some(words)),
            }
        }
        for key in words.keys {
            let given = table.contains_key(key.name) || meant.contains(&key.name);
            if key.default == Default::Required && !given {
                self.missing(key, words, heading.clone());
            }
        }
        for rule in words.rules {
            self.rule(rule, table, (words, &meant), heading.clone());
        }
    }

    fn value(
        &mut self,
        value: &Spanned<DeValue<'_>>,
        shape: &'static Shape,
        key: &Key,
        words: Option<&'static Table>,
    ) {
        let span = value.span();
        if !has_type(value.get_ref(), shape) {
            return self.wrong_type(value, shape, key);
        }
        match (shape, value.get_ref()) {
            (Shape::Either(shapes), content) => {
                if let Some(shape) = shapes.iter().find(|shape| has_type(content, shape)) {
                    self.value(value, shape, key, words);
                }
            }
            (Shape::Later(_, instead), content) => {
                self.later(
                    span,
                    &format!("`{}` with {}", key.name, found(content)),
                    instead,
                );
            }
            (Shape::Text, DeValue::String(text))
                if text.trim().is_empty() && key.default == Default::Required =>
            {
                self.found.push(
                    Diagnostic::error(&codes::MISSING, format!("`{}` is an empty text", key.name))
                        .at(&self.origins.place(span), key.doc),
                );
            }
            (Shape::Choice(choices), DeValue::String(word)) => {
                self.choice(word, choices, span, key, words);
            }
            (Shape::Number(bounds), content) => {
                if let Some(number) = number(content) {
                    self.number(number, bounds, span, key);
                }
            }
            (Shape::Integer(from, to), DeValue::Integer(integer)) => {
                let number = whole(integer);
                let negative = integer.as_str().starts_with('-');
                if number.map_or(negative, |number| number < *from) {
                    self.out_of_range(span, key, &format!("at least {from}"));
                } else if number.is_none_or(|number| number > *to) {
                    self.out_of_range(span, key, &format!("at most {to}"));
                }
            }
            (Shape::List(item, least, most), DeValue::Array(items)) => {
                if items.len() < *least || items.len() > *most {
                    let wanted = match (*least, *most) {
                        (1, usize::MAX) => "at least one entry".to_owned(),
                        (least, most) if least == most => format!("{least} entries"),
                        (least, most) => format!("{least} to {most} entries"),
                    };
                    self.wrong_length(span, key, &wanted, items.len());
                } else {
                    for one in items.iter() {
                        self.value(one, item, key, words);
                    }
                }
            }
            (Shape::Row(_, shapes), DeValue::Array(items)) => {
                if items.len() == shapes.len() {
                    for (one, shape) in items.iter().zip(*shapes) {
                        self.value(one, shape, key, words);
                    }
                } else {
                    self.wrong_length(span, key, &format!("{} entries", shapes.len()), items.len());
                }
            }
            _ => self.tables(value, shape, key),
        }
    }

    /// A number of any kind: finite, not too small to compute with, and within its bounds.
    fn number(&mut self, number: f64, bounds: &Bounds, span: Range<usize>, key: &Key) {
        if is_usable(number) {
            if !bounds.hold(number) {
                self.out_of_range(span, key, &bounds.words());
            }
            return;
        }
        let remark = if number.is_finite() {
            "too small to compute with"
        } else {
            "not finite"
        };
        let text = self.origins.text(span.clone());
        self.found.push(
            Diagnostic::error(
                &codes::NOT_FINITE,
                format!("`{}` needs a finite number, found {text}", key.name),
            )
            .at(&self.origins.place(span), remark),
        );
    }

    /// A table, a list of tables, or tables by their names.
    fn tables(&mut self, value: &Spanned<DeValue<'_>>, shape: &'static Shape, key: &Key) {
        match (shape, value.get_ref()) {
            (Shape::Table(words), DeValue::Table(table)) => {
                self.table(table, words, Some(value.span()));
            }
            (Shape::Tables(words), DeValue::Array(items)) => {
                for one in items.iter() {
                    match one.get_ref() {
                        DeValue::Table(table) => self.table(table, words, Some(one.span())),
                        _ => self.wrong_type(one, shape, key),
                    }
                }
            }
            (Shape::Named(words), DeValue::Table(entries)) => {
                for (name, one) in in_order(entries) {
                    if self.found.len() > MOST {
                        return;
                    }
                    match one.get_ref() {
                        DeValue::Table(table) => self.table(table, words, Some(one.span())),
                        other => self.no_table(name.get_ref(), other, one.span(), words),
                    }
                }
            }
            _ => {}
        }
    }

    /// Reports a name whose value is no table.
    fn no_table(
        &mut self,
        name: &str,
        value: &DeValue<'_>,
        span: Range<usize>,
        words: &'static Table,
    ) {
        let name = shortened(name);
        let message = format!("`{name}` needs a table, found {}", found(value));
        self.found.push(
            Diagnostic::error(&codes::WRONG_TYPE, message)
                .at(&self.origins.place(span), "not a table")
                .note(keys_of(words)),
        );
    }

    /// Reports an unknown key and returns the key of this table that it was probably meant to be.
    fn unknown(
        &mut self,
        name: &Spanned<toml::de::DeString<'_>>,
        value: &Spanned<DeValue<'_>>,
        words: &'static Table,
    ) -> Option<&'static str> {
        let typed: &str = name.get_ref();
        let place = self.origins.place(name.span());
        let mut one = Diagnostic::error(
            &codes::UNKNOWN_KEY,
            format!("unknown key `{}`", shortened(typed)),
        );
        let hinted = words.keys.iter().find(|key| {
            key.hints
                .iter()
                .any(|hint| hint.eq_ignore_ascii_case(typed))
        });
        let near = hinted
            .map(|key| key.name)
            .or_else(|| closest(typed, words.names()));
        if let Some(meant) = near {
            one = one.at(&place, format!("did you mean `{meant}`?"));
        } else if let Some((outer, meant)) = inside(words, typed) {
            let written = shortened(
                self.origins
                    .text(value.span())
                    .lines()
                    .next()
                    .unwrap_or_default(),
            );
            let remark = if meant == typed {
                format!("`{meant}` belongs inside `{outer}`")
            } else {
                format!("did you mean `{meant}`? it belongs inside `{outer}`")
            };
            one = one
                .at(&place, remark)
                .help(format!("write  {outer} = {{ {meant} = {written} }}"));
        } else if let Some(heading) = elsewhere(self.case, typed) {
            one = one.at(&place, format!("`{typed}` is a key of {heading}"));
        } else {
            one = one.at(&place, format!("{} has no such key", words.heading));
        }
        self.found.push(one.note(keys_of(words)));
        near
    }

    fn later(&mut self, span: Range<usize>, what: &str, instead: &str) {
        let one = Diagnostic::error(&codes::NOT_BUILT, format!("{what} is not supported yet")).at(
            &self.origins.place(span),
            "known, but this version cannot do it",
        );
        self.found.push(if instead.is_empty() {
            one
        } else {
            one.help(format!("until then: {instead}"))
        });
    }

    fn choice(
        &mut self,
        word: &str,
        choices: &'static [Choice],
        span: Range<usize>,
        key: &Key,
        words: Option<&'static Table>,
    ) {
        match choices.iter().find(|choice| choice.word == word) {
            Some(Choice { later: None, .. }) => {}
            Some(Choice {
                later: Some(instead),
                ..
            }) => {
                let built = choices
                    .iter()
                    .any(|choice| choice.word == *instead && choice.later.is_none());
                let instead = match (built, key.shape) {
                    (true, Shape::List(..)) => format!("{} = [\"{instead}\"]", key.name),
                    (true, _) => format!("{} = \"{instead}\"", key.name),
                    (false, _) => (*instead).to_owned(),
                };
                self.later(span, &format!("`{} = \"{word}\"`", key.name), &instead);
            }
            None => {
                let known = || {
                    choices
                        .iter()
                        .filter(|choice| choice.later.is_none())
                        .map(|choice| choice.word)
                };
                let remark = match closest(word, choices.iter().map(|choice| choice.word)) {
                    Some(meant) => format!("did you mean \"{meant}\"?"),
                    None => String::new(),
                };
                let of = words.map_or(String::new(), |words| format!(" of {}", words.heading));
                let message = format!("`{}`{of} knows no \"{}\"", key.name, shortened(word));
                let one = Diagnostic::error(&codes::NOT_A_CHOICE, message)
                    .at(&self.origins.place(span), remark);
                self.found.push(match &key.shape {
                    Shape::Either([_, Shape::List(Shape::Choice(axes), ..)])
                        if axes.iter().any(|one| one.word == word) =>
                    {
                        one.help(format!("write {} = [\"{word}\"]", key.name))
                    }
                    shape => match key_inside(shape, word) {
                        Some(value) => {
                            one.help(format!("write {} = {{ {word} = {value} }}", key.name))
                        }
                        None => one.note(format!("it takes: {}", listed(known()))),
                    },
                });
            }
        }
    }

    fn wrong_type(&mut self, value: &Spanned<DeValue<'_>>, shape: &Shape, key: &Key) {
        let mut one = Diagnostic::error(
            &codes::WRONG_TYPE,
            format!(
                "`{}` needs {}, found {}",
                key.name,
                wanted(shape),
                found(value.get_ref())
            ),
        )
        .at(&self.origins.place(value.span()), key.doc);
        match (shape, value.get_ref()) {
            (Shape::Tables(words), DeValue::Table(_)) => {
                one = one.help(format!("write {}", words.heading));
            }
            (shape, DeValue::String(text)) if takes_number(shape) => {
                let number = text.trim().replace(',', ".");
                if number.parse::<f64>().is_ok_and(f64::is_finite) {
                    one = one.help(format!("write {} = {number}", key.name));
                }
            }
            (Shape::Integer(..), DeValue::Float(float)) => {
                if let Some(whole) = float
                    .as_str()
                    .parse::<f64>()
                    .ok()
                    .filter(|n| n.fract() == 0.0 && n.abs() < 1e15)
                {
                    one = one.help(format!("write {} = {whole}", key.name));
                }
            }
            (shape, DeValue::String(text)) if takes_list(shape) => {
                one = one.help(format!("write {} = [\"{}\"]", key.name, shortened(text)));
            }
            _ => {}
        }
        self.found.push(one);
    }

    fn out_of_range(&mut self, span: Range<usize>, key: &Key, range: &str) {
        let text = self.origins.text(span.clone()).to_owned();
        self.found.push(
            Diagnostic::error(
                &codes::OUT_OF_RANGE,
                format!("`{}` = {} is out of range", key.name, shortened(&text)),
            )
            .at(&self.origins.place(span), format!("must be {range}"))
            .note(format!("{}: {}", key.name, key.doc)),
        );
    }

    fn wrong_length(&mut self, span: Range<usize>, key: &Key, wanted: &str, found: usize) {
        self.found.push(
            Diagnostic::error(
                &codes::WRONG_LENGTH,
                format!("`{}` needs {wanted}, found {found}", key.name),
            )
            .at(&self.origins.place(span), key.doc),
        );
    }

    fn missing(&mut self, key: &Key, words: &'static Table, heading: Option<Range<usize>>) {
        let what = match key.shape {
            Shape::Table(table) | Shape::Tables(table) => table.heading,
            _ => key.name,
        };
        let message = match heading {
            Some(ref span) => format!("{} has no `{what}`", self.heading(words, span)),
            None => format!("{} has no {what}", self.origins.name()),
        };
        let mut one =
            Diagnostic::error(&codes::MISSING, message).note(format!("{what}: {}", key.doc));
        if let Some(span) = heading {
            one = one.at(
                &self.origins.place(span),
                format!("`{what}` is missing here"),
            );
        }
        if let Shape::Choice(choices) = key.shape {
            let known = choices
                .iter()
                .filter(|choice| choice.later.is_none())
                .map(|choice| choice.word);
            one = one.note(format!("it takes: {}", listed(known)));
        }
        self.found.push(one);
    }

    /// A table as it was written, where it has a heading of its own.
    fn heading(&self, words: &Table, span: &Range<usize>) -> String {
        let written = self.origins.text(span.clone());
        if written.starts_with('[') && !written.contains('\n') {
            shortened(written)
        } else {
            words.heading.to_owned()
        }
    }

    fn rule(
        &mut self,
        rule: &Rule,
        table: &DeTable<'_>,
        (words, meant): (&'static Table, &[&'static str]),
        heading: Option<Range<usize>>,
    ) {
        let given = |keys: &'static [&'static str]| {
            let mut given: Vec<_> = keys
                .iter()
                .filter_map(|key| table.get_key_value(*key))
                .map(|(key, _)| key)
                .collect();
            given.sort_by_key(|key| key.span().start);
            given
        };
        // A key that is refused as unknown or not supported counts as given: one message is enough.
        let refused = || {
            let mut keys = table.keys().map(|key| words.key(key.get_ref()));
            keys.any(|key| key.is_none_or(|key| key.later.is_some()))
        };
        match rule {
            Rule::ExactlyOne(keys) | Rule::AtLeastOne(keys)
                if given(keys).is_empty() && !refused() =>
            {
                let of = match (rule, keys.len()) {
                    (Rule::AtLeastOne(_), _) => "one or more of",
                    (_, 2) => "either of",
                    _ => "one of",
                };
                let mut one = Diagnostic::error(
                    &codes::CONTRADICTION,
                    format!("{} needs {of} {}", words.heading, quoted(keys)),
                );
                if let Some(span) = heading {
                    one = one.at(&self.origins.place(span), "none of them is given");
                }
                self.found.push(one);
            }
            Rule::ExactlyOne(keys) | Rule::AtMostOne(keys) => {
                if let [first, second, ..] = given(keys).as_slice() {
                    self.found.push(
                        Diagnostic::error(
                            &codes::CONTRADICTION,
                            format!(
                                "`{}` and `{}` exclude each other",
                                first.get_ref(),
                                second.get_ref()
                            ),
                        )
                        .at(&self.origins.place(second.span()), "the second")
                        .at(&self.origins.place(first.span()), "the first")
                        .help("keep the one that is meant"),
                    );
                }
            }
            Rule::Needs(key, other) => {
                if let Some((name, _)) = table.get_key_value(*key)
                    && !table.contains_key(*other)
                {
                    self.found.push(
                        Diagnostic::error(
                            &codes::CONTRADICTION,
                            format!("`{key}` means nothing without `{other}`"),
                        )
                        .at(
                            &self.origins.place(name.span()),
                            format!("add `{other}`, or delete `{key}`"),
                        ),
                    );
                }
            }
            Rule::Instead(key, others) => match table.get_key_value(*key) {
                Some((name, _)) => {
                    for other in given(others) {
                        let message =
                            format!("`{key}` and `{}` exclude each other", other.get_ref());
                        self.found.push(
                            Diagnostic::error(&codes::CONTRADICTION, message)
                                .at(&self.origins.place(other.span()), "delete this one")
                                .at(&self.origins.place(name.span()), "or this one"),
                        );
                    }
                }
                None => {
                    let is_given =
                        |other: &&str| table.contains_key(*other) || meant.contains(other);
                    let missing = others.iter().filter(|other| !is_given(other));
                    for key in missing.filter_map(|other| words.key(other)) {
                        self.missing(key, words, heading.clone());
                    }
                }
            },
            Rule::NotAbove(..) | Rule::Below(..) => self.order(rule, table, words),
            Rule::AtLeastOne(_) => {}
        }
    }

    /// Reports a number that is greater than another, or not less.
    fn order(&mut self, rule: &Rule, table: &DeTable<'_>, words: &'static Table) {
        let (Rule::NotAbove(key, other) | Rule::Below(key, other)) = rule else {
            return;
        };
        // a number out of the range of its own key has been reported
        let entry = |key: &str| {
            let value = table.get(key)?;
            let number = number(value.get_ref())?;
            let shape = words.key(key).map(|key| key.shape);
            let fits = !matches!(shape, Some(Shape::Number(range)) if !range.hold(number));
            fits.then(|| (number, value.span()))
        };
        let wrong = |small: f64, large: f64| match rule {
            Rule::Below(..) if small >= large => Some("not less"),
            Rule::NotAbove(..) if small > large => Some("greater"),
            _ => None,
        };
        if let (Some((small, at)), Some((large, limit))) = (entry(key), entry(other))
            && let Some(wrong) = wrong(small, large)
        {
            self.found.push(
                Diagnostic::error(
                    &codes::OUT_OF_RANGE,
                    format!("`{key}` = {small} is {wrong} than `{other}` = {large}"),
                )
                .at(&self.origins.place(at), "")
                .at(&self.origins.place(limit), ""),
            );
        }
    }
}

/// The keys of a table, for a message.
pub(super) fn keys_of(words: &Table) -> String {
    let names: Vec<&str> = words.names().collect();
    format!("keys of {}: {}", words.heading, names.join(", "))
}

fn quoted(keys: &[&str]) -> String {
    keys.iter()
        .map(|key| format!("`{key}`"))
        .collect::<Vec<_>>()
        .join(", ")
}

/// Whether a number may stand here.
fn takes_number(shape: &Shape) -> bool {
    match shape {
        Shape::Number(_) | Shape::Integer(..) => true,
        Shape::Either(shapes) => shapes.iter().any(takes_number),
        _ => false,
    }
}

fn takes_list(shape: &Shape) -> bool {
    match shape {
        Shape::List(item, ..) => matches!(item, Shape::Text | Shape::Choice(_)),
        Shape::Either(shapes) => shapes.iter().any(takes_list),
        _ => false,
    }
}

/// The key of `words` whose value is a table with a key like `typed`, and that key.
fn inside(words: &'static Table, typed: &str) -> Option<(&'static str, &'static str)> {
    words
        .keys
        .iter()
        .filter(|key| key.later.is_none())
        .find_map(|key| {
            let inner = inline_table(&key.shape)?;
            let names: Vec<_> = inner.names().collect();
            closest(typed, names.iter().copied()).and_then(|meant| {
                names
                    .iter()
                    .find(|name| **name == meant)
                    .map(|meant| (key.name, *meant))
            })
        })
}

fn inline_table(shape: &'static Shape) -> Option<&'static Table> {
    match shape {
        Shape::Table(table) => Some(table),
        Shape::Either(shapes) => shapes.iter().find_map(inline_table),
        _ => None,
    }
}

/// The heading of a table anywhere in the case that has exactly this key.
fn elsewhere(words: &'static Table, typed: &str) -> Option<&'static str> {
    words.keys.iter().find_map(|key| {
        let inner = match &key.shape {
            Shape::Named(table) | Shape::Tables(table) => table,
            shape => inline_table(shape)?,
        };
        if inner.key(typed).is_some_and(|key| key.later.is_none()) {
            return Some(inner.heading);
        }
        elsewhere(inner, typed)
    })
}

/// The number of a node or element, where the value is one.
pub(super) fn id(value: &Spanned<DeValue<'_>>) -> Option<u64> {
    count(value.get_ref())
}

/// What to write for a key of that name in a table that may stand in place of a word.
fn key_inside(shape: &Shape, name: &str) -> Option<&'static str> {
    let Shape::Either(shapes) = shape else {
        return None;
    };
    let tables = shapes.iter().filter_map(|shape| match shape {
        Shape::Table(table) => Some(table),
        _ => None,
    });
    let key = tables
        .flat_map(|table| table.keys)
        .find(|key| key.name == name)?;
    Some(match key.shape {
        Shape::Table(_) => "{}",
        _ => "...",
    })
}
