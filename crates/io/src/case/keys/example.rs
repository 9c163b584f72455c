//! Pieces of cases that show a key.

use super::super::vocabulary::{Bounds, Default, Key, Rule, Shape, Table};
use super::part::Part;
use super::words;
use signorini_vocabulary::Description;

/// Numbers that are tried for a range, the first that lies in it is taken.
const NUMBERS: [f64; 5] = [1.0, 0.3, 10.0, -1.0, -0.05];

/// Values that a reader would expect, by the name of the key.
const KNOWN: [(&str, &str); 25] = [
    ("E", "210e3"),
    ("nu", "0.3"),
    ("density", "7.8e-9"),
    ("alpha", "1.2e-5"),
    ("mu", "0.3"),
    ("friction", "0.3"),
    ("file", "\"part.msh\""),
    ("secondary", "\"foot\""),
    ("primary", "\"top\""),
    ("group", "\"block\""),
    ("material", "\"steel\""),
    ("units", "\"mm-N-MPa\""),
    ("title", "\"A block on a table\""),
    ("on", "\"base\""),
    ("model", "\"linear-elastic\""),
    ("what", "\"tip.force_z\""),
    ("wall", "\"10 min\""),
    ("allow", "[\"S0402\"]"),
    ("stl", "\"tool.stl\""),
    (
        "equation",
        "[[\"left\", \"x\", 1.0], [\"right\", \"x\", -1.0]]",
    ),
    ("nodes", "[1, 2, 3]"),
    ("y", "[0.0, 1.0, 0.0]"),
    ("tube", "0.3"),
    ("stabilize", "false"),
    ("faces", "[[1, \"+z\"], [2, \"S3\"]]"),
];

/// A piece of a case with a key; `model` is the material model that it is a constant of.
pub fn of(parts: &[Part], key: &Key, model: Option<&str>) -> String {
    let Some((first, rest)) = parts.split_first() else {
        return top(key);
    };
    let mut text = head(*first);
    if let Some(model) = model {
        text += &format!("model = \"{model}\"\n");
    }
    let mut path = first.name().to_owned();
    let mut inline = Vec::new();
    for part in rest {
        match part {
            Part::List(name) if inline.is_empty() => {
                path += &format!(".{name}");
                text += &format!("[[{path}]]\n");
            }
            part => inline.push(*part),
        }
    }
    let last = value(key);
    let inner =
        inline
            .iter()
            .rev()
            .fold(format!("{} = {last}", key.name), |inner, part| match part {
                Part::List(name) => format!("{name} = [{{ {inner} }}]"),
                part => format!("{} = {{ {inner} }}", part.name()),
            });
    text + &inner + "\n"
}

/// The heading of a table.
fn head(part: Part) -> String {
    match part {
        Part::Table(name) => format!("[{name}]\n"),
        Part::List(name) => format!("[[{name}]]\n"),
        Part::Named(name) => format!("[{name}.{}]\n", own_name(name)),
    }
}

/// A name that a user might choose.
fn own_name(of: &str) -> &'static str {
    match of {
        "material" => "steel",
        "reference" => "pilot",
        "amplitude" => "saw",
        _ => "base",
    }
}

/// A key of the case itself: a value, or a table with what it needs.
fn top(key: &Key) -> String {
    let (part, table) = match key.shape {
        Shape::Table(table) => (Part::Table(key.name), table),
        Shape::Tables(table) => (Part::List(key.name), table),
        Shape::Named(table) => (Part::Named(key.name), table),
        _ => return format!("{} = {}\n", key.name, value(key)),
    };
    let mut text = head(part);
    for key in needed(table) {
        text += &format!("{} = {}\n", key.name, value(key));
    }
    text
}

/// A material with all its constants.
pub fn of_model(model: &Description) -> String {
    let mut text = format!("[material.steel]\nmodel = \"{}\"\n", model.name);
    let keys = model.keys.iter();
    for key in keys.filter(|key| key.default == Default::Required) {
        text += &format!("{} = {}\n", key.name, value(key));
    }
    text
}

/// The keys that a table cannot be without.
fn needed(table: &'static Table) -> Vec<&'static Key> {
    let first = |keys: &'static [&'static str]| keys.first().copied();
    let one_of = table.rules.iter().filter_map(|rule| match rule {
        Rule::ExactlyOne(keys) | Rule::AtLeastOne(keys) => first(keys),
        _ => None,
    });
    let instead = table.rules.iter().filter_map(|rule| match rule {
        Rule::Instead(_, others) => Some(*others),
        _ => None,
    });
    let named: Vec<&str> = one_of.chain(instead.flatten().copied()).collect();
    let is_needed = |key: &&Key| key.default == Default::Required || named.contains(&key.name);
    table.keys.iter().filter(is_needed).collect()
}

/// A value that a key may have; not the default, where there is another.
fn value(key: &Key) -> String {
    let known = KNOWN.iter().find(|(name, _)| *name == key.name);
    if let Some((_, value)) = known
        && fits(&key.shape, value)
    {
        return (*value).to_owned();
    }
    let default = words::default(&key.default);
    let candidates = candidates(&key.shape);
    let other = candidates.iter().find(|one| Some(*one) != default.as_ref());
    let other = other.or_else(|| candidates.first()).cloned();
    other.or(default).unwrap_or_else(|| "{}".to_owned())
}

/// Whether a known value is of the form that a key takes: keys of one name differ.
fn fits(shape: &Shape, value: &str) -> bool {
    match shape {
        Shape::Text => value.starts_with('"'),
        Shape::Choice(choices) => choices.iter().any(|c| value == format!("\"{}\"", c.word)),
        Shape::Number(bounds) => value.parse().is_ok_and(|value| bounds.hold(value)),
        Shape::Flag => value == "true" || value == "false",
        Shape::List(Shape::Row(..), ..) => value.starts_with("[["),
        Shape::List(Shape::Text | Shape::Choice(_), ..) => value.starts_with("[\""),
        Shape::List(Shape::Number(_) | Shape::Integer(..), ..) => {
            value.starts_with('[') && !value.starts_with("[[") && !value.contains('"')
        }
        Shape::Either(shapes) => shapes.iter().any(|one| fits(one, value)),
        _ => false,
    }
}

/// Values of a form.
fn candidates(shape: &Shape) -> Vec<String> {
    match shape {
        Shape::Text => vec!["\"name\"".to_owned()],
        Shape::Choice(choices) => {
            let built = choices.iter().filter(|choice| choice.later.is_none());
            built.map(|choice| format!("\"{}\"", choice.word)).collect()
        }
        Shape::Number(bounds) => numbers(bounds),
        Shape::Integer(from, to) => [10, 2, *from]
            .iter()
            .filter(|n| (from..=to).contains(n))
            .map(ToString::to_string)
            .collect(),
        Shape::Flag => vec!["true".to_owned(), "false".to_owned()],
        Shape::List(item, least, most) => lists(item, *least, *most),
        Shape::Row(_, items) => {
            let items: Vec<String> = items.iter().filter_map(first).collect();
            vec![format!("[{}]", items.join(", "))]
        }
        Shape::Either(shapes) => shapes.iter().flat_map(candidates).collect(),
        Shape::Table(table) | Shape::Tables(table) => {
            let mut keys = needed(table);
            if keys.is_empty() {
                keys.extend(table.keys.iter().find(|key| key.later.is_none()));
            }
            let inner: Vec<String> = keys
                .iter()
                .map(|key| format!("{} = {}", key.name, value(key)))
                .collect();
            let table = match inner.is_empty() {
                true => "{}".to_owned(),
                false => format!("{{ {} }}", inner.join(", ")),
            };
            match shape {
                Shape::Tables(_) => vec![format!("[{table}]")],
                _ => vec![table],
            }
        }
        Shape::Nodes => vec!["[[1, 0.0, 0.0, 0.0], [2, 1.0, 0.0, 0.0]]".to_owned()],
        Shape::Named(_) | Shape::Later(..) => Vec::new(),
    }
}

fn first(shape: &Shape) -> Option<String> {
    candidates(shape).into_iter().next()
}

fn numbers(bounds: &Bounds) -> Vec<String> {
    let numbers = NUMBERS.iter().filter(|number| bounds.hold(**number));
    numbers.map(|number| format!("{number:?}")).collect()
}

/// Lists of one form: vectors have three entries, tables two rows that increase.
fn lists(item: &Shape, least: usize, most: usize) -> Vec<String> {
    let count = match (least, most) {
        (2, 3) => 3,
        (least, _) => least
            .max(1)
            .max(if is_rows(item) { 2.min(most) } else { 1 }),
    };
    let Some(entry) = first(item) else {
        return Vec::new();
    };
    let entries: Vec<String> = match item {
        Shape::Number(bounds) if bounds.hold(0.0) => {
            let at = |k: usize| if k + 1 == count { "1.0" } else { "0.0" };
            (0..count).map(|k| at(k).to_owned()).collect()
        }
        Shape::List(..) | Shape::Row(..) if is_rows(item) && count == 2 => {
            vec![start(item), entry]
        }
        _ => vec![entry; count],
    };
    vec![format!("[{}]", entries.join(", "))]
}

/// The first row of a table: zeros, where they are in range.
fn start(row: &Shape) -> String {
    let number = |shape: &Shape| match shape {
        Shape::Number(bounds) if bounds.hold(0.0) => "0.0".to_owned(),
        other => first(other).unwrap_or_default(),
    };
    let numbers: Vec<String> = match row {
        Shape::Row(_, items) => items.iter().map(number).collect(),
        Shape::List(item, least, _) => vec![number(item); *least],
        other => vec![number(other)],
    };
    format!("[{}]", numbers.join(", "))
}

/// Whether a form is a row of numbers.
fn is_rows(shape: &Shape) -> bool {
    match shape {
        Shape::List(item, least, most) => least == most && matches!(item, Shape::Number(_)),
        Shape::Row(_, items) => items.iter().all(|item| matches!(item, Shape::Number(_))),
        _ => false,
    }
}
