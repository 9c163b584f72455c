//! Findings that hold for many cards: reported once, with all lines.

use crate::diagnostic::{Diagnostic, Diagnostics, Place};
use std::collections::BTreeMap;

/// How many further lines a finding names.
const LISTED: usize = 8;

/// Findings in the order of their first places, by what they say.
#[derive(Default)]
pub(super) struct Repeated<'d> {
    numbers: BTreeMap<String, usize>,
    found: Vec<Finding<'d>>,
}

struct Finding<'d> {
    one: Diagnostic,
    first: &'d Place,
    others: Vec<&'d Place>,
}

impl<'d> Repeated<'d> {
    /// What is found at a place; a finding of the same message has one more place.
    pub fn add(&mut self, one: Diagnostic, place: &'d Place) {
        let number = self.numbers.get(&one.message).copied();
        if let Some(known) = number.and_then(|number| self.found.get_mut(number)) {
            known.others.push(place);
            return;
        }
        self.numbers.insert(one.message.clone(), self.found.len());
        self.found.push(Finding {
            one,
            first: place,
            others: Vec::new(),
        });
    }

    /// Reports all of them.
    pub fn report(self, found: &mut Diagnostics) {
        for finding in self.found {
            found.push(match also_in(finding.first, &finding.others) {
                Some(lines) => finding.one.note(lines),
                None => finding.one,
            });
        }
    }
}

/// The lines of further places; nothing where there are none.
fn also_in(first: &Place, others: &[&Place]) -> Option<String> {
    let of = first.get().map(|(file, _)| file.name());
    let line = |place: &&Place| {
        let (file, range) = place.get()?;
        let number = file.line_index(range.start) + 1;
        Some(match of == Some(file.name()) {
            true => number.to_string(),
            false => format!("{number} of {}", file.name()),
        })
    };
    let lines: Vec<String> = others.iter().take(LISTED).filter_map(line).collect();
    if lines.is_empty() {
        return None;
    }
    let more = match others.len().saturating_sub(LISTED) {
        0 => String::new(),
        count => format!(" and {count} more"),
    };
    Some(format!("also in lines {}{more}", lines.join(", ")))
}
