//! The contacts that were found where nobody names pairs, as a table.

use crate::run::Start;
use crate::setup::{ContactInfo, Model};
use crate::text::short;
use signorini_io::case::SELF;
use signorini_vocabulary::Value;

/// Heads of the columns.
const HEAD: [&str; 7] = [
    "pair",
    "status",
    "gap",
    "area",
    "secondary",
    "method",
    "friction",
];

/// The coefficient of friction of most laws.
const MU: &str = "mu";

/// A row for each contact that was found, below a head; nothing where none was.
pub fn table(model: &Model, start: &Start) -> Vec<String> {
    let found = model.contacts.iter().filter(|one| one.is_found);
    let rows: Vec<[String; 7]> = found.map(|info| row(model, start, info)).collect();
    if rows.is_empty() {
        return Vec::new();
    }
    let all = || std::iter::once(HEAD.map(str::to_owned)).chain(rows.iter().cloned());
    let mut widths = [0; 7];
    for row in all() {
        for (width, cell) in widths.iter_mut().zip(&row) {
            *width = (*width).max(cell.chars().count());
        }
    }
    let line = |row: [String; 7]| {
        let cells = row.iter().zip(widths);
        let cells: Vec<String> = cells
            .map(|(cell, width)| format!("{cell:<width$}"))
            .collect();
        cells.join("  ").trim_end().to_owned()
    };
    let head = format!("contact was found between {} pairs:", rows.len());
    std::iter::once(head)
        .chain(all().map(|row| format!("  {}", line(row))))
        .collect()
}

fn row(model: &Model, start: &Start, info: &ContactInfo) -> [String; 7] {
    let case = model
        .case
        .contacts
        .iter()
        .find(|one| one.name.value == info.name);
    let frame = start
        .frame
        .contacts
        .iter()
        .find(|one| one.name == info.name);
    let gap = info.start.gap;
    let status = match gap {
        None => "apart",
        Some(gap) if gap < 0.0 && info.start.overlapping > 0 => "overlap",
        Some(_) if info.start.touching > 0 => "touching",
        Some(_) => "near",
    };
    let area = frame.map_or(0.0, |frame| {
        let near = frame
            .gap
            .iter()
            .zip(&frame.area)
            .filter(|(gap, _)| gap.is_finite());
        near.map(|(_, area)| area).sum()
    });
    // sides are called by their bodies and the numbers of their regions
    let body = |name: &str| name.split('/').next().unwrap_or_default().to_owned();
    let secondary = case.map_or_else(String::new, |one| match one.primary.value == SELF {
        true => "-".to_owned(),
        false => body(&one.secondary.value),
    });
    let friction = match case.and_then(|one| one.friction.as_ref()) {
        None => "0".to_owned(),
        Some(friction) => {
            let mut values = friction.limit.values.iter();
            let mu = values.find_map(|(key, value)| match value {
                Value::Number(mu) if *key == *MU => Some(short(*mu)),
                _ => None,
            });
            mu.unwrap_or_else(|| friction.limit.name.to_owned())
        }
    };
    [
        info.name.clone(),
        status.to_owned(),
        gap.map_or_else(|| "-".to_owned(), short),
        short(area),
        secondary,
        info.method.to_owned(),
        friction,
    ]
}
