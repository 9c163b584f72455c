//! Section 2: what was run, in sentences made of the resolved case.

use crate::results::Results;
use crate::text::grouped;
use maud::{Markup, html};
use toml::{Table, Value};

/// The section.
pub fn section(results: &Results) -> Markup {
    let case = &results.case;
    html! {
        section #model {
            h2 { "What was run" }
            @if case.is_empty() {
                p { "The folder has no case.resolved.toml: what was run is not known." }
            } @else {
                ul.sentences {
                    @for sentence in general(results) { li { (sentence) } }
                }
                div.columns {
                    (list("Materials", materials(case)))
                    (list("Bodies", each(case, "body", body)))
                    (list("Contacts", each(case, "contact", contact)))
                    (list("Constraints", each(case, "constraint", |one| assignments(one, &[]))))
                    @for step in tables(case, "step") { (self::step(step)) }
                }
            }
        }
    }
}

fn list(title: &str, items: Vec<String>) -> Markup {
    html! {
        @if !items.is_empty() {
            div { h3 { (title) } ul { @for item in items { li { (item) } } } }
        }
    }
}

fn text<'a>(table: &'a Table, key: &str) -> &'a str {
    table.get(key).and_then(Value::as_str).unwrap_or_default()
}

fn tables<'a>(table: &'a Table, key: &str) -> Vec<&'a Table> {
    let all = table.get(key).and_then(Value::as_array);
    all.map_or_else(Vec::new, |all| {
        all.iter().filter_map(Value::as_table).collect()
    })
}

fn each(case: &Table, key: &str, of: impl Fn(&Table) -> String) -> Vec<String> {
    tables(case, key).into_iter().map(of).collect()
}

/// A value as readers write it: lists with commas, no quotes.
fn plain(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Array(all) => {
            let short: Vec<String> = all.iter().take(8).map(plain).collect();
            let more = if all.len() > 8 { ", …" } else { "" };
            match all.iter().all(Value::is_str) {
                true => short.join(", ") + more,
                false => format!("({}{more})", short.join(", ")),
            }
        }
        Value::Table(table) => {
            let all: Vec<String> = table
                .iter()
                .map(|(k, v)| format!("{k} {}", plain(v)))
                .collect();
            all.join(", ")
        }
        other => other.to_string(),
    }
}

/// `key = value`, for all keys but those that a sentence has named.
fn assignments(table: &Table, without: &[&str]) -> String {
    let all = table
        .iter()
        .filter(|(key, _)| !without.contains(&key.as_str()));
    let all: Vec<String> = all
        .filter(|(_, value)| plain(value).len() < 200)
        .map(|(key, value)| format!("{key} = {}", plain(value)))
        .collect();
    all.join("; ")
}

fn general(results: &Results) -> Vec<String> {
    let case = &results.case;
    let mut all = Vec::new();
    let empty = Table::new();
    let model = case
        .get("model")
        .and_then(Value::as_table)
        .unwrap_or(&empty);
    let space = match text(model, "space") {
        "3d" => "in space".to_owned(),
        "plane-strain" => "in plane strain".to_owned(),
        "plane-stress" => "in plane stress".to_owned(),
        "axisymmetric" => "of a body of revolution".to_owned(),
        other => other.to_owned(),
    };
    let thickness = model
        .get("thickness")
        .map(|t| format!(", thickness {}", plain(t)));
    all.push(format!(
        "A model {space}{}, in the units {}.",
        thickness.unwrap_or_default(),
        results.units()
    ));
    let start = results.events_of("start").next();
    let count = |key: &str| {
        start
            .and_then(|e| e[key].as_u64())
            .map(|n| grouped(n as usize))
    };
    if let (Some(nodes), Some(elements), Some(unknowns)) =
        (count("nodes"), count("elements"), count("unknowns"))
    {
        all.push(format!(
            "{nodes} nodes, {elements} elements, {unknowns} unknowns."
        ));
    }
    let mesh = case.get("mesh").and_then(Value::as_table);
    if let Some(file) = mesh.and_then(|mesh| mesh.get("file")) {
        all.push(format!("The mesh is that of {}.", plain(file)));
    }
    all
}

fn materials(case: &Table) -> Vec<String> {
    let Some(materials) = case.get("material").and_then(Value::as_table) else {
        return Vec::new();
    };
    let sentence = |(name, value): (&String, &Value)| {
        let empty = Table::new();
        let table = value.as_table().unwrap_or(&empty);
        format!(
            "{name}: {}, {}",
            text(table, "model"),
            assignments(table, &["model"])
        )
    };
    materials.iter().map(sentence).collect()
}

fn body(body: &Table) -> String {
    let group = body.get("group").map(plain).unwrap_or_default();
    if body.get("rigid").and_then(Value::as_bool) == Some(true) {
        return format!("{group} is rigid");
    }
    let locking = match text(body, "locking") {
        "" | "none" => String::new(),
        remedy => format!(", against locking: {remedy}"),
    };
    format!(
        "{group} is of {}, {} integration{locking}",
        text(body, "material"),
        text(body, "integration")
    )
}

fn contact(contact: &Table) -> String {
    let enforcement = contact.get("enforcement");
    let kind = match enforcement {
        Some(Value::Table(table)) => {
            let one = |(key, value): (&String, &Value)| {
                let key = if key == "lagrange" {
                    "Lagrange multipliers"
                } else {
                    key
                };
                format!("{key} {}", plain(value)).trim_end().to_owned()
            };
            table.iter().map(one).collect::<Vec<String>>().join(", ")
        }
        Some(other) => plain(other),
        None => String::new(),
    };
    let friction = match contact.get("friction").map(plain).as_deref() {
        None | Some("0.0" | "0") => "without friction".to_owned(),
        Some(friction) => format!("friction {}", friction.trim_start_matches("mu ")),
    };
    let verb = match contact.get("tied") {
        Some(Value::Boolean(true) | Value::Table(_)) => "is tied to",
        _ => "may not pass through",
    };
    format!(
        "{}: {} (secondary) {verb} {} (primary); method {}, enforced by {kind}, {friction}, {} sliding",
        text(contact, "name"),
        text(contact, "secondary"),
        contact.get("primary").map(plain).unwrap_or_default(),
        text(contact, "method"),
        text(contact, "sliding")
    )
}

fn step(step: &Table) -> Markup {
    let mut items = Vec::new();
    for fix in tables(step, "fix") {
        let on = fix.get("on").map(plain).unwrap_or_default();
        let held = match fix.get("u").map(plain).as_deref() {
            Some("all") => "is held in all directions".to_owned(),
            Some(axes) => format!("is held in {axes}"),
            None => String::new(),
        };
        items.push(trimmed(
            &format!("{on} {held}"),
            &assignments(fix, &["on", "u"]),
        ));
    }
    for moved in tables(step, "move") {
        let on = moved.get("on").map(plain).unwrap_or_default();
        items.push(format!("{on} moves: {}", assignments(moved, &["on"])));
    }
    for load in tables(step, "load") {
        let on = load.get("on").map(plain).unwrap_or_default();
        items.push(format!("{on} is loaded: {}", assignments(load, &["on"])));
    }
    for free in tables(step, "free") {
        items.push(format!("freed: {}", assignments(free, &[])));
    }
    let increments = step.get("increments").map(plain).unwrap_or_default();
    html! {
        div {
            h3 { "Step " (text(step, "name")) }
            p { (text(step, "kind")) ", " (text(step, "geometry")) " geometry, duration "
                (step.get("duration").map(plain).unwrap_or_default()) ", increments: " (increments) }
            ul { @for item in items { li { (item) } } }
        }
    }
}

fn trimmed(sentence: &str, rest: &str) -> String {
    match rest.is_empty() {
        true => sentence.to_owned(),
        false => format!("{sentence}; {rest}"),
    }
}
