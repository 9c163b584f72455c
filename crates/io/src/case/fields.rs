//! Access to the keys of a checked table, with the defaults of the vocabulary.
//!
//! The check has reported what is wrong before; here a value of the wrong form counts as absent.

use std::ops::Range;

use toml::Spanned as Ranged;
use toml::de::{DeTable, DeValue};

use super::check::in_order;
use super::origin::Origins;
use super::scalar::{count, has_type, is_usable, number};
use super::vocabulary::{Default, Key, Shape, Table};
use crate::diagnostic::{Place, Spanned};
use signorini_vocabulary::Value;

/// A table of the document, or the empty one where the key is absent.
#[derive(Clone, Copy)]
pub(super) struct Fields<'a> {
    table: Option<&'a DeTable<'a>>,
    words: &'static Table,
    origins: &'a Origins,
}

impl<'a> Fields<'a> {
    pub fn new(table: &'a DeTable<'a>, words: &'static Table, origins: &'a Origins) -> Self {
        Self {
            table: Some(table),
            words,
            origins,
        }
    }

    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<&'a Ranged<DeValue<'a>>> {
        self.table?.get(key)
    }

    /// Whether a key is given.
    pub fn has(&self, key: &str) -> bool {
        self.get(key).is_some()
    }

    /// Whether a key stands here that nobody knows.
    pub fn has_unknown_key(&self) -> bool {
        self.table.is_some_and(|table| {
            table
                .keys()
                .any(|key| self.words.key(key.get_ref()).is_none())
        })
    }

    /// Whether the value of a key has the TOML type of its key.
    pub fn is_of_its_form(&self, key: &str) -> bool {
        let shape = self.words.key(key).map(|key| &key.shape);
        self.get(key)
            .zip(shape)
            .is_some_and(|(value, shape)| has_type(value.get_ref(), shape))
    }

    /// Where a value stands; nowhere where it is absent.
    pub fn place(&self, key: &str) -> Place {
        self.get(key)
            .map_or_else(Place::nowhere, |value| self.at(value.span()))
    }

    pub fn at(&self, span: Range<usize>) -> Place {
        self.origins.place(span)
    }

    pub fn text(&self, key: &str) -> Spanned<String> {
        self.text_if(key)
            .unwrap_or_else(|| match self.default(key) {
                Default::Text(text) => text.into(),
                _ => Spanned::default(),
            })
    }

    pub fn text_if(&self, key: &str) -> Option<Spanned<String>> {
        self.get(key).and_then(|value| self.spanned_text(value))
    }

    /// One text or several.
    pub fn texts(&self, key: &str) -> Vec<Spanned<String>> {
        match (self.get(key), self.default(key)) {
            (Some(value), _) => match value.get_ref() {
                DeValue::Array(items) => items
                    .iter()
                    .filter_map(|one| self.spanned_text(one))
                    .collect(),
                _ => self.spanned_text(value).into_iter().collect(),
            },
            (None, Default::Texts(texts)) => texts.iter().map(|text| (*text).into()).collect(),
            _ => Vec::new(),
        }
    }

    pub fn spanned_text(&self, value: &Ranged<DeValue<'_>>) -> Option<Spanned<String>> {
        let text = value.get_ref().as_str()?.to_owned();
        Some(Spanned::new(text, self.at(value.span())))
    }

    pub fn number(&self, key: &str) -> f64 {
        self.number_if(key).map_or_else(
            || match self.default(key) {
                Default::Number(number) => number,
                _ => 0.0,
            },
            |number| number.value,
        )
    }

    pub fn number_if(&self, key: &str) -> Option<Spanned<f64>> {
        let value = self.get(key)?;
        let number = number(value.get_ref()).filter(|number| is_usable(*number))?;
        Some(Spanned::new(number, self.at(value.span())))
    }

    pub fn count(&self, key: &str) -> u64 {
        self.count_if(key).map_or_else(
            || match self.default(key) {
                Default::Integer(number) => number.unsigned_abs(),
                _ => 0,
            },
            |number| number.value,
        )
    }

    pub fn count_if(&self, key: &str) -> Option<Spanned<u64>> {
        let value = self.get(key)?;
        Some(Spanned::new(count(value.get_ref())?, self.at(value.span())))
    }

    pub fn flag(&self, key: &str) -> bool {
        self.flag_if(key)
            .unwrap_or(matches!(self.default(key), Default::Flag(true)))
    }

    pub fn flag_if(&self, key: &str) -> Option<bool> {
        self.get(key)?.get_ref().as_bool()
    }

    /// The entries of a row of exactly `N`.
    pub fn row<const N: usize>(&self, key: &str) -> Option<[&'a Ranged<DeValue<'a>>; N]> {
        let items = self.get(key)?.get_ref().as_array()?;
        items.iter().collect::<Vec<_>>().try_into().ok()
    }

    /// The rows of a list.
    pub fn rows(&self, key: &str) -> impl Iterator<Item = &'a Ranged<DeValue<'a>>> {
        let rows = self.get(key).and_then(|value| value.get_ref().as_array());
        rows.into_iter().flat_map(|rows| rows.iter())
    }

    /// A number or a list of them.
    pub fn numbers_if(&self, key: &str) -> Option<Spanned<Vec<f64>>> {
        if let Some(Spanned { value, place }) = self.number_if(key) {
            return Some(Spanned::new(vec![value], place));
        }
        self.get(key)?.get_ref().as_array()?;
        let values = self.rows(key).map(|one| number(one.get_ref()));
        let values: Option<Vec<f64>> = values.collect();
        Some(Spanned::new(values?, self.place(key)))
    }

    /// The value of a key, or its default.
    pub fn value(&self, key: &Key) -> Option<Value> {
        let given = self.get(key.name).map(|value| value.get_ref());
        match (given, key.default) {
            (Some(DeValue::String(text)), _) => Some(Value::Text(text.clone().into_owned())),
            (Some(DeValue::Array(_)), _) => {
                let numbers = self.numbers_if(key.name);
                numbers.map(|numbers| Value::Numbers(numbers.value))
            }
            (Some(_), _) => self
                .number_if(key.name)
                .map(|number| Value::Number(number.value)),
            (None, Default::Number(number)) => Some(Value::Number(number)),
            (None, Default::Numbers(numbers)) => Some(Value::Numbers(numbers.to_vec())),
            (None, Default::Text(text)) => Some(Value::Text(text.to_owned())),
            (None, _) => None,
        }
    }

    /// A list of whole numbers.
    pub fn counts(&self, key: &str) -> Vec<u64> {
        let items = self.get(key).and_then(|value| value.get_ref().as_array());
        items
            .into_iter()
            .flat_map(|items| items.iter())
            .filter_map(|one| count(one.get_ref()))
            .collect()
    }

    /// The table behind a key; the empty one where it is absent or of another form.
    pub fn table(&self, key: &str) -> Fields<'a> {
        let table = self.get(key).and_then(|value| value.get_ref().as_table());
        Fields {
            table,
            words: self.inner(key),
            origins: self.origins,
        }
    }

    /// The tables of a list, with their places.
    pub fn tables(&self, key: &str) -> Vec<(Fields<'a>, Place)> {
        let words = self.inner(key);
        let items = self.get(key).and_then(|value| value.get_ref().as_array());
        items
            .into_iter()
            .flat_map(|items| items.iter())
            .filter_map(|one| Some((one.get_ref().as_table()?, one.span())))
            .map(|(table, span)| (Fields::new(table, words, self.origins), self.at(span)))
            .collect()
    }

    /// The tables by names of the user's choice, with their names, in the order of the text.
    pub fn named(&self, key: &str) -> Vec<(Spanned<String>, Fields<'a>, Place)> {
        let words = self.inner(key);
        let entries = self.get(key).and_then(|value| value.get_ref().as_table());
        entries
            .into_iter()
            .flat_map(in_order)
            .filter_map(|(name, one)| Some((name, one.get_ref().as_table()?, one.span())))
            .map(|(name, table, span)| {
                let name = Spanned::new(name.get_ref().clone().into_owned(), self.at(name.span()));
                (name, Fields::new(table, words, self.origins), self.at(span))
            })
            .collect()
    }

    fn default(&self, key: &str) -> Default {
        self.words
            .key(key)
            .map_or(Default::Absent, |key| key.default)
    }

    fn inner(&self, key: &str) -> &'static Table {
        fn table_of(shape: &'static Shape) -> Option<&'static Table> {
            match shape {
                Shape::Table(table) | Shape::Tables(table) | Shape::Named(table) => Some(table),
                Shape::Either(shapes) => shapes.iter().find_map(table_of),
                _ => None,
            }
        }
        self.words
            .key(key)
            .and_then(|key| table_of(&key.shape))
            .unwrap_or(self.words)
    }
}

/// A list of exactly `N` numbers.
pub(super) fn numbers<const N: usize>(value: &DeValue<'_>) -> Option<[f64; N]> {
    let items = value.as_array()?;
    if items.len() != N {
        return None;
    }
    let mut row = [0.0; N];
    for (slot, item) in row.iter_mut().zip(items.iter()) {
        *slot = number(item.get_ref()).filter(|number| is_usable(*number))?;
    }
    Some(row)
}
