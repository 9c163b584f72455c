//! What the laws answer for many rows at once: a law that takes slices costs one call for all of them.

use crate::contact::friction::{Limit, Sliding};
use crate::contact::kernel::{Answer, Laws, Past};
use crate::contact::law::Eval;
use crate::contact::row::SeenGap;

/// Answers for rows that follow each other, and buffers for what the laws are asked with.
#[derive(Default)]
pub(super) struct Asked {
    /// One for each row; nothing where there is no pair.
    answers: Vec<Option<Answer>>,
    gaps: Vec<f64>,
    lambdas: Vec<f64>,
    pressures: Vec<Eval>,
    /// The rows that touch, among those of the answers.
    touching: Vec<usize>,
    at: Vec<Sliding>,
    limits: Vec<Limit>,
}

impl Asked {
    /// Forgets all rows.
    pub fn clear(&mut self) {
        self.answers.clear();
        self.gaps.clear();
        self.lambdas.clear();
    }

    /// A further row: its gap and its multiplier along the normal, where it has a pair.
    pub fn push(&mut self, at: Option<(SeenGap, f64)>) {
        self.answers.push(at.map(|at| Answer {
            at,
            ..Answer::default()
        }));
        self.gaps.extend(at.map(|(gap, _)| gap.now));
        self.lambdas.extend(at.map(|(_, lambda)| lambda));
    }

    /// The answer for each row.
    pub fn answers(&self) -> impl Iterator<Item = Option<&Answer>> {
        self.answers.iter().map(Option::as_ref)
    }

    /// Asks the laws about all rows, each with its past.
    pub fn ask(&mut self, laws: &Laws<'_>, past: impl Iterator<Item = Past>) {
        self.pressures.clear();
        self.pressures.resize(self.gaps.len(), Eval::default());
        let (gaps, lambdas) = (&self.gaps, &self.lambdas);
        laws.law
            .pressures(gaps, lambdas, laws.scale, &mut self.pressures);
        let with_pair = self.answers.iter_mut().flatten();
        for (answer, pressure) in with_pair.zip(&self.pressures) {
            let (gap, lambda) = answer.at;
            let at_end = match gap.worn {
                Some(_) => laws.law_at(gap, lambda),
                None => *pressure,
            };
            answer.pressure = laws.in_motion(gap, at_end);
        }
        self.ask_for_limits(laws, past);
    }

    /// Asks the friction law, if there is one, about the rows that touch and whose limit is not held.
    fn ask_for_limits(&mut self, laws: &Laws<'_>, past: impl Iterator<Item = Past>) {
        let Some(friction) = laws.friction else {
            return;
        };
        self.touching.clear();
        self.at.clear();
        for (place, (answer, past)) in self.answers.iter().zip(past).enumerate() {
            let Some(answer) = answer.as_ref().filter(|_| past.limit.is_none()) else {
                continue;
            };
            if answer.pressure == Eval::default() {
                continue;
            }
            let (gap, lambda) = answer.at;
            let answered = Laws {
                answer: Some(answer),
                ..*laws
            };
            self.touching.push(place);
            self.at
                .push(past.sliding(answered.tried(gap, lambda).value));
        }
        self.limits.clear();
        self.limits.resize(self.at.len(), Limit::default());
        friction.limits(&self.at, &mut self.limits);
        let found = self.at.iter().zip(&self.limits);
        for (place, (at, limit)) in self.touching.iter().zip(found) {
            if let Some(Some(answer)) = self.answers.get_mut(*place) {
                answer.limit = Some((*at, *limit));
            }
        }
    }
}
