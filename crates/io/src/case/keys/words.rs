//! Forms, ranges, units and defaults in words.

use super::super::vocabulary::{Bounds, Choice, Default, Key, Shape};

/// Units that meanings name in brackets.
const IN_BRACKETS: [&str; 5] = ["stress", "length", "radian", "degrees", "area"];

/// Units of keys whose meaning names none, by the name of the key.
const BY_NAME: [(&str, &str); 26] = [
    ("density", "mass per volume"),
    ("omega", "radian per time"),
    ("force", "force"),
    ("per_node", "force"),
    ("moment", "force times length"),
    ("traction", "stress"),
    ("pressure", "stress"),
    ("body_force", "force per volume"),
    ("gravity", "length per time squared"),
    ("speed", "radian per time"),
    ("ux", "length"),
    ("uy", "length"),
    ("uz", "length"),
    ("rx", "radian"),
    ("ry", "radian"),
    ("rz", "radian"),
    ("duration", "time"),
    ("initial", "time of the step"),
    ("min", "time of the step"),
    ("max", "time of the step"),
    ("close_gaps_below", "length"),
    ("clearance", "length"),
    ("radius", "length"),
    ("tube", "length"),
    ("tresca", "stress"),
    ("cap", "stress"),
];

/// The unit of a number.
pub fn unit(key: &Key) -> Option<&'static str> {
    if !is_number(&key.shape) {
        return None;
    }
    let named = IN_BRACKETS
        .iter()
        .find(|unit| key.doc.contains(&format!("({unit})")));
    let known = || BY_NAME.iter().find(|(name, _)| *name == key.name);
    named.copied().or_else(|| known().map(|(_, unit)| *unit))
}

fn is_number(shape: &Shape) -> bool {
    match shape {
        Shape::Number(_) => true,
        Shape::List(item, ..) => is_number(item),
        Shape::Either(shapes) => shapes.iter().any(is_number),
        _ => false,
    }
}

/// What a value may be.
pub fn form(shape: &Shape) -> String {
    match shape {
        Shape::Text => "text".to_owned(),
        Shape::Choice(choices) => built(choices).join(", "),
        Shape::Number(_) => "number".to_owned(),
        Shape::Integer(..) => "whole number".to_owned(),
        Shape::Flag => "true or false".to_owned(),
        Shape::List(item, least, most) => {
            let item = match item {
                Shape::Number(_) => "numbers".to_owned(),
                Shape::Text => "texts".to_owned(),
                other => format!("({})", form(other)),
            };
            match (*least, *most) {
                (least, most) if least == most => format!("list of {least} {item}"),
                (2, 3) => format!("list of 3 {item}, 2 in the plane"),
                _ => format!("list of {item}"),
            }
        }
        Shape::Row(written, _) => format!("row {written}"),
        Shape::Either(shapes) => {
            let forms = shapes.iter().filter(|one| !matches!(one, Shape::Later(..)));
            forms.map(form).collect::<Vec<_>>().join(", or ")
        }
        Shape::Table(_) => "table".to_owned(),
        Shape::Tables(_) => "list of tables".to_owned(),
        Shape::Named(_) => "tables by names of your own".to_owned(),
        Shape::Nodes => "rows [id, x, y, z]".to_owned(),
        Shape::Later(..) => "nothing yet".to_owned(),
    }
}

fn built(choices: &[Choice]) -> Vec<String> {
    let choices = choices.iter().filter(|choice| choice.later.is_none());
    choices.map(|one| format!("\"{}\"", one.word)).collect()
}

/// The range of numbers; none where any will do.
pub fn range(shape: &Shape) -> Option<String> {
    match shape {
        Shape::Number(bounds) => of_bounds(bounds),
        Shape::Integer(from, to) if *to == i64::MAX => Some(format!("at least {from}")),
        Shape::Integer(from, to) => Some(format!("{from} to {to}")),
        Shape::List(item, ..) => range(item),
        Shape::Either(shapes) => shapes.iter().find_map(range),
        _ => None,
    }
}

fn of_bounds(bounds: &Bounds) -> Option<String> {
    Some(bounds.words()).filter(|words| !words.is_empty())
}

/// What holds where a key is absent, as a case would say it.
pub fn default(default: &Default) -> Option<String> {
    let quoted = |text: &&str| format!("\"{text}\"");
    Some(match default {
        Default::Required | Default::Absent => return None,
        Default::Text(text) => quoted(text),
        Default::Texts(texts) => {
            let texts: Vec<String> = texts.iter().map(quoted).collect();
            format!("[{}]", texts.join(", "))
        }
        Default::Number(number) => format!("{number:?}"),
        Default::Numbers(numbers) => format!("{numbers:?}"),
        Default::Integer(number) => number.to_string(),
        Default::Flag(flag) => flag.to_string(),
    })
}
