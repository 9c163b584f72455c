//! Scalars of the TOML document as numbers and words.

use toml::de::{DeInteger, DeValue};

use super::vocabulary::{Bounds, Shape};

/// The number a value stands for; infinite or NaN where it says so or is too large.
pub(super) fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(float) => float.as_str().parse().ok(),
        DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str().parse().ok(),
        DeValue::Integer(integer) => whole(integer).map(|n| n as f64),
        _ => None,
    }
}

/// The whole number a value stands for, where it fits.
pub(super) fn whole(integer: &DeInteger<'_>) -> Option<i64> {
    i64::from_str_radix(integer.as_str(), integer.radix()).ok()
}

/// The whole, not negative number a value stands for.
pub(super) fn count(value: &DeValue<'_>) -> Option<u64> {
    whole(value.as_integer()?)?.try_into().ok()
}

/// A number is fit for computing when it is finite and not so small that digits are lost.
pub(super) fn is_usable(value: f64) -> bool {
    value == 0.0 || value.is_normal()
}

/// Whether a value has the TOML type of a shape.
pub(super) fn has_type(value: &DeValue<'_>, shape: &Shape) -> bool {
    match shape {
        Shape::Text | Shape::Choice(_) => value.is_str(),
        Shape::Number(_) => value.is_float() || value.is_integer(),
        Shape::Integer(..) => value.is_integer(),
        Shape::Flag => value.is_bool(),
        Shape::List(..) | Shape::Row(..) | Shape::Nodes | Shape::Tables(_) => value.is_array(),
        Shape::Table(_) | Shape::Named(_) => value.is_table(),
        Shape::Either(shapes) => shapes.iter().any(|shape| has_type(value, shape)),
        Shape::Later(shape, _) => has_type(value, shape),
    }
}

/// What a shape takes, in words.
pub(super) fn wanted(shape: &Shape) -> String {
    match shape {
        Shape::Text => "a text in quotes".to_owned(),
        Shape::Choice(choices) => choices
            .iter()
            .filter(|choice| choice.later.is_none())
            .map(|choice| format!("\"{}\"", choice.word))
            .collect::<Vec<_>>()
            .join(" or "),
        Shape::Number(bounds) => joined("a number", bounds),
        Shape::Integer(..) => "a whole number".to_owned(),
        Shape::Flag => "true or false".to_owned(),
        Shape::List(Shape::Number(_), 2, 3) => "a list of three numbers".to_owned(),
        Shape::List(Shape::Number(_), 2, 2) => "a pair of numbers".to_owned(),
        Shape::List(Shape::List(_, 2, 3), 2, 2) => "two corners [x, y, z]".to_owned(),
        Shape::List(Shape::List(..), ..) => "a list of rows [time, value]".to_owned(),
        Shape::List(Shape::Number(_) | Shape::Integer(..), ..) => "a list of numbers".to_owned(),
        Shape::List(Shape::Row(form, _), ..) => format!("a list of rows {form}"),
        Shape::List(..) => "a list of texts in quotes".to_owned(),
        Shape::Row(form, _) => format!("a row {form}"),
        Shape::Nodes => "a list of rows [id, x, y, z]".to_owned(),
        Shape::Table(table) if table.keys.is_empty() => "a table {}".to_owned(),
        Shape::Table(table) => {
            let names: Vec<_> = table.names().collect();
            format!("a table {{ {} }}", names.join(", "))
        }
        Shape::Named(table) => format!("tables {}", table.heading),
        Shape::Tables(table) => format!("a list of tables {}", table.heading),
        Shape::Either(shapes) => shapes
            .iter()
            .filter(|shape| !matches!(shape, Shape::Later(..)))
            .map(wanted)
            .collect::<Vec<_>>()
            .join(" or "),
        Shape::Later(..) => String::new(),
    }
}

fn joined(noun: &str, bounds: &Bounds) -> String {
    let words = bounds.words();
    if words.is_empty() {
        noun.to_owned()
    } else {
        format!("{noun} {words}")
    }
}

/// What was found instead, in words.
pub(super) fn found(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("the text \"{}\"", shortened(text)),
        DeValue::Integer(integer) => format!("the number {integer}"),
        DeValue::Float(float) => format!("the number {float}"),
        DeValue::Boolean(flag) => flag.to_string(),
        DeValue::Datetime(_) => "a date".to_owned(),
        DeValue::Array(_) => "a list".to_owned(),
        DeValue::Table(_) => "a table".to_owned(),
    }
}

/// The beginning of a text, for messages.
pub(super) fn shortened(text: &str) -> String {
    const LENGTH: usize = 60;
    match text.char_indices().nth(LENGTH) {
        Some((at, _)) => format!("{}…", text.get(..at).unwrap_or_default()),
        None => text.to_owned(),
    }
}
