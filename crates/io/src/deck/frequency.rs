//! Natural frequencies: *FREQUENCY.
//!
//! With `*STEP, PERTURBATION` they are those about the state that earlier steps lead to, with its stresses and its contact. Without
//! it, CalculiX takes the structure as it is at the start; here the geometry of the step is then linear, so that stresses do not count, and
//! contact is as earlier steps leave it, which a note says.

use super::translation::Translation;
use crate::case::{Frequency, Geometry, Step};
use crate::diagnostic::codes;
use crate::readers::inp::{Field, Statement};

/// Cards that would change the state in a step of natural frequencies.
const CHANGES: [&str; 8] = [
    "CLOAD",
    "DLOAD",
    "DSLOAD",
    "TEMPERATURE",
    "MODELCHANGE",
    "CHANGESOLIDSECTION",
    "CHANGEFRICTION",
    "CHANGESURFACEBEHAVIOR",
];

impl Translation<'_> {
    /// Makes a step one of natural frequencies.
    pub fn natural_frequencies(
        &mut self,
        number: usize,
        cards: &[&Statement],
        card: &Statement,
        step: &mut Step,
    ) {
        let is_perturbation = cards.first().is_some_and(|head| head.has("PERTURBATION"));
        if !is_perturbation && number > 0 {
            let text = "without PERTURBATION stresses of earlier steps do not count; contact is as they leave it, where CalculiX \
                        takes that of the start";
            self.note(text, &card.place);
        }
        step.geometry = if is_perturbation {
            Geometry::Nonlinear
        } else {
            Geometry::Linear
        };
        for change in cards {
            if CHANGES.contains(&change.keyword.as_str()) {
                let text = format!("*{} in a step of *FREQUENCY", change.title);
                let remark = "it does not change the state: put it into a *STATIC step before it";
                self.error(&codes::NOT_BUILT, text, &change.place, remark);
            }
        }
        let row = card.rows().next().unwrap_or_default();
        if row.first().is_none_or(|field| field.text.is_empty()) {
            let text = "*FREQUENCY does not say how many";
            let remark = "number of frequencies, lowest, highest (cycles per time)";
            self.error(&codes::MISSING, text, &card.place, remark);
            return;
        }
        let modes = self.count(row.first(), 1);
        let limit = |of: &mut Self, at: usize| {
            let value = of.real(row.get(at));
            if value < 0.0 {
                let place = row.get(at).map_or(card.place.clone(), Field::place);
                let text = format!("a limit of *FREQUENCY is {value}");
                of.error(
                    &codes::OUT_OF_RANGE,
                    text,
                    &place,
                    "0 or above; empty: none",
                );
            }
            (value > 0.0).then_some(value)
        };
        let (lower, upper) = (limit(self, 1), limit(self, 2));
        if let (Some(from), Some(to)) = (lower, upper)
            && to <= from
        {
            let text = format!(
                "the highest frequency of *FREQUENCY, {to}, is not above the lowest, {from}"
            );
            let remark = "number of frequencies, lowest, highest";
            self.error(&codes::CONTRADICTION, text, &card.place, remark);
        }
        if modes == 0 {
            let text = "*FREQUENCY asks for no frequency";
            self.error(&codes::OUT_OF_RANGE, text, &card.place, "1 or more");
        }
        step.frequency = Some(Frequency {
            modes: modes.max(1),
            lower,
            upper,
        });
    }

    /// A step of natural frequencies moves nothing, and has no tables.
    pub fn still(&mut self, step: &mut Step) {
        if step.frequency.is_none() {
            return;
        }
        if let Some(place) = step.moves.first().map(|one| one.place.clone()) {
            let text = "*BOUNDARY moves something in a step of *FREQUENCY";
            let remark =
                "it does not change the state: hold it there, or move it in a *STATIC step before";
            self.error(&codes::NOT_BUILT, text, &place, remark);
            step.moves.clear();
        }
        if let Some(print) = step.prints.take().and_then(|all| all.into_iter().next()) {
            let text = "tables of natural modes are not printed: see frequencies.csv and modes.pvd";
            self.note(text, &print.place);
        }
    }
}
