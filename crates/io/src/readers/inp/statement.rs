//! Cards that say something else than the mesh: kept with their data, and with the places of both.

use super::card::{Card, Fields, Parameter, real, text, whole};
use super::lines::{Lines, Spot};
use super::spelling::compared;
use crate::diagnostic::{Place, SourceFile};
use std::cell::Cell;
use std::ops::Range;
use std::sync::Arc;

/// A card with its data lines.
#[derive(Clone, Debug)]
pub struct Statement {
    /// In capitals, without star and blanks.
    pub keyword: String,
    /// In capitals, without star, its words apart: for messages.
    pub title: String,
    /// Where the card stands.
    pub place: Place,
    /// The spaces whose numbers and names it means: see [`super::Directory`].
    pub scope: usize,
    parameters: Vec<Parameter>,
    rows: Vec<Row>,
    /// Whether anybody has looked at it.
    seen: Cell<bool>,
}

/// A data line.
#[derive(Clone, Debug)]
struct Row {
    file: Arc<SourceFile>,
    line: Range<usize>,
}

/// A field of a data line.
#[derive(Clone, Debug)]
pub struct Field<'a> {
    /// Without white space at its ends.
    pub text: &'a str,
    file: &'a Arc<SourceFile>,
    at: usize,
}

impl Field<'_> {
    /// Where it was written.
    #[must_use]
    pub fn place(&self) -> Place {
        Place::new(self.file, self.at..self.at + self.text.len())
    }

    /// A whole number without sign.
    #[must_use]
    pub fn whole(&self) -> Option<u64> {
        whole(self.text.as_bytes())
    }

    /// A real number as Fortran writes it; finite.
    #[must_use]
    pub fn real(&self) -> Option<f64> {
        real(self.text.as_bytes()).filter(|value| value.is_finite())
    }

    /// Whether another field follows this one without a blank between them.
    #[must_use]
    pub const fn touches(&self, next: &Self) -> bool {
        self.at + self.text.len() + 1 == next.at
    }

    /// What names are compared by.
    #[must_use]
    pub fn key(&self) -> String {
        compared(self.text)
    }
}

impl Statement {
    /// Takes a card and its data from the lines.
    pub(super) fn read(card: &Card, scope: usize, lines: &mut Lines<'_>) -> Self {
        let mut pieces = vec![(card.spot, card.written.clone())];
        while let Some(line) = lines.data() {
            pieces.push((lines.spot, text(line)));
        }
        let mut rows = excerpts(pieces, lines).into_iter();
        let place = rows
            .next()
            .map_or_else(Place::nowhere, |row: Row| Place::new(&row.file, row.line));
        Self {
            keyword: card.keyword.clone(),
            title: card.title.clone(),
            place,
            scope,
            parameters: card.parameters.clone(),
            rows: rows.collect(),
            seen: Cell::new(false),
        }
    }

    /// The value of a parameter as it was written; empty where it has none.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&str> {
        self.seen.set(true);
        Parameter::find(&self.parameters, name)
    }

    /// The value of a parameter as [`Statement::get`] gives it, without a sign that anybody has asked for it.
    #[must_use]
    pub fn peek(&self, name: &str) -> Option<&str> {
        let named = self.parameters().find(|(known, _)| *known == name);
        named.map(|(_, value)| value)
    }

    /// The names of its parameters, in capitals and without blanks, with their values as they were written.
    pub fn parameters(&self) -> impl Iterator<Item = (&str, &str)> {
        (self.parameters.iter()).map(|one| (one.name.as_str(), one.value.as_str()))
    }

    /// Whether a parameter is there.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.get(name).is_some()
    }

    /// The names of its parameters, in capitals and without blanks.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.parameters.iter().map(|one| one.name.as_str())
    }

    /// The names of parameters that nobody has asked for so far.
    pub fn unread(&self) -> impl Iterator<Item = &str> {
        Parameter::unread(&self.parameters)
    }

    /// Whether it says something, and nobody has looked at that so far.
    #[must_use]
    pub fn is_unread(&self) -> bool {
        let says = !self.rows.is_empty() || !self.parameters.is_empty();
        says && !self.seen.get()
    }

    /// The fields of each data line; those at the end that are empty are left out.
    pub fn rows(&self) -> impl Iterator<Item = Vec<Field<'_>>> {
        self.seen.set(true);
        self.peek_rows()
    }

    /// The same, without a sign that anybody has looked at them.
    pub fn peek_rows(&self) -> impl Iterator<Item = Vec<Field<'_>>> {
        self.rows.iter().map(|row| {
            let line = row.text();
            let fields = Fields::of(line.as_bytes()).map(|field| {
                let within = (field.as_ptr() as usize).saturating_sub(line.as_ptr() as usize);
                Field {
                    text: line.get(within..within + field.len()).unwrap_or_default(),
                    file: &row.file,
                    at: row.line.start + within,
                }
            });
            let mut fields: Vec<Field<'_>> = fields.collect();
            while fields.last().is_some_and(|field| field.text.is_empty()) {
                fields.pop();
            }
            fields
        })
    }

    /// Its data lines as they stand there.
    pub fn lines(&self) -> impl Iterator<Item = &str> {
        self.seen.set(true);
        self.rows.iter().map(Row::text)
    }
}

impl Row {
    fn text(&self) -> &str {
        self.file.text().get(self.line.clone()).unwrap_or_default()
    }
}

/// Where a card stands.
pub(super) fn place_of(card: &Card, lines: &Lines<'_>) -> Place {
    let rows = excerpts(vec![(card.spot, card.written.clone())], lines);
    let first = rows.into_iter().next();
    first.map_or_else(Place::nowhere, |row| Place::new(&row.file, row.line))
}

/// Texts of lines that follow each other, one for each stretch without a gap.
fn excerpts(pieces: Vec<(Spot, String)>, lines: &Lines<'_>) -> Vec<Row> {
    let mut rows = Vec::with_capacity(pieces.len());
    let mut pieces = pieces.into_iter().peekable();
    while let Some(&(first, _)) = pieces.peek() {
        let mut whole = String::new();
        let mut ranges: Vec<Range<usize>> = Vec::new();
        let mut last: Option<Spot> = None;
        let follows = |last: Option<Spot>, spot| last.is_none_or(|last| last.precedes(spot));
        while let Some((spot, text)) = pieces.next_if(|(spot, _)| follows(last, *spot)) {
            if last.is_some() {
                whole.push('\n');
            }
            ranges.push(whole.len()..whole.len() + text.len());
            whole.push_str(&text);
            last = Some(spot);
        }
        let (name, line) = lines.source(first);
        let file = SourceFile::excerpt(name, whole, line.saturating_sub(1));
        rows.extend(ranges.into_iter().map(|line| Row {
            file: Arc::clone(&file),
            line,
        }));
    }
    rows
}
