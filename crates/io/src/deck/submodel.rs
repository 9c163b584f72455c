//! Nodes whose displacements are those of another model at their places.

use super::step::{Standing, components, directions};
use super::translation::{Target, Translation};
use crate::case::{GlobalModel, GlobalTime, Move, Step};
use crate::diagnostic::{Spanned, codes};
use crate::readers::inp::{Field, Kind, Statement, compared, number};
use std::collections::BTreeSet;

/// Nodes on the boundary of a submodel.
pub(super) struct Submodel {
    /// The results of the global model.
    file: String,
    /// Elements of it that count; empty: all.
    elements: Vec<u64>,
    /// Numbers of the nodes.
    nodes: BTreeSet<u64>,
}

impl Translation<'_> {
    /// *SUBMODEL: which nodes, and whose results.
    pub fn submodels(&mut self) {
        for card in self.cards("SUBMODEL") {
            if card.get("TYPE").map(compared).as_deref() != Some("NODE") {
                let text = "*SUBMODEL without TYPE=NODE is not supported";
                let remark = "only displacements of a global model are built";
                self.error(&codes::NOT_BUILT, text, &card.place, remark);
                continue;
            }
            let Some(file) = self.need(card, "INPUT").map(str::to_owned) else {
                continue;
            };
            let mut elements = Vec::new();
            if let Some(set) = card.get("GLOBALELSET").filter(|set| !set.is_empty())
                && let Some(set) = self.set(card, set, &card.place, Kind::Elements)
            {
                elements = self.elements(&Target::Set(set.value));
            }
            let mut nodes = BTreeSet::new();
            for row in card.rows() {
                for field in row.iter().filter(|field| !field.text.is_empty()) {
                    for target in self.targets(card, Some(field), Kind::Nodes) {
                        nodes.extend(self.labels(&target));
                    }
                }
            }
            self.submodels.push(Submodel {
                file,
                elements,
                nodes,
            });
        }
    }

    /// *BOUNDARY, SUBMODEL within a step.
    pub fn follow_global(
        &mut self,
        card: &Statement,
        sudden: bool,
        standing: &mut Standing,
        step: &mut Step,
    ) {
        if card.has("AMPLITUDE") || card.has("USER") || card.has("FIXED") {
            let text = "*BOUNDARY, SUBMODEL with AMPLITUDE, USER or FIXED is not supported";
            let remark = "displacements of a global model are reached over the step";
            self.error(&codes::NOT_BUILT, text, &card.place, remark);
            return;
        }
        let whole = |text: &str| number(text).filter(|n| n.fract() == 0.0 && *n >= 1.0);
        let given = |name| card.get(name).and_then(whole).map(|n| n as u64);
        let at = match (given("STEP"), given("DATASET")) {
            (Some(step), None) => GlobalTime::Step(step),
            (None, Some(set)) => GlobalTime::Set(set),
            (Some(_), Some(_)) => {
                let text = "*BOUNDARY, SUBMODEL has both STEP and DATA SET";
                self.error(&codes::CONTRADICTION, text, &card.place, "one of them");
                return;
            }
            (None, None) => {
                let text = "*BOUNDARY, SUBMODEL has neither STEP nor DATA SET";
                let remark = "STEP=, the number of a step of the global model";
                self.error(&codes::MISSING, text, &card.place, remark);
                return;
            }
        };
        for row in card.rows() {
            let place = row.first().map_or(card.place.clone(), Field::place);
            let (first, second) = (row.get(1), row.get(2));
            let first = self.count(first, 0);
            let last = self.count(second, first);
            let Some(components) = components(first, last).filter(|_| last <= 3) else {
                let text =
                    format!("there are no displacements {first} to {last} of a global model");
                self.error(&codes::OUT_OF_RANGE, text, &place, "1 to 3");
                continue;
            };
            for target in self.targets(card, row.first(), Kind::Nodes) {
                self.take_over(&target, (card, &components), (at, !sudden), standing, step);
            }
        }
    }

    fn take_over(
        &mut self,
        target: &Target,
        (card, components): (&Statement, &[usize]),
        (at, ramp): (GlobalTime, bool),
        standing: &mut Standing,
        step: &mut Step,
    ) {
        let labels = self.labels(target);
        let of_all = |one: &Submodel| labels.iter().all(|label| one.nodes.contains(label));
        let Some(known) = self.submodels.iter().find(|one| of_all(one)) else {
            let named = |label: &&u64| !self.submodels.iter().any(|one| one.nodes.contains(label));
            let first = labels.iter().find(named).or(labels.first());
            let text = format!(
                "node {} of *BOUNDARY, SUBMODEL is named by no *SUBMODEL card with all others of its set",
                first.copied().unwrap_or_default()
            );
            self.error(&codes::UNDEFINED, text, &card.place, "");
            return;
        };
        let (u, _) = directions(components);
        let from = GlobalModel {
            file: Spanned::new(known.file.clone().into(), card.place.clone()),
            at,
            elements: known.elements.clone(),
            u,
            ramp,
            values: None,
        };
        if labels.iter().any(|label| self.axes.contains_key(label)) {
            let text = "*BOUNDARY, SUBMODEL of nodes with local axes is not supported";
            self.error(
                &codes::NOT_BUILT,
                text,
                &card.place,
                "without *TRANSFORM it is",
            );
            return;
        }
        for &component in components {
            standing.held.insert((target.clone(), component), true);
        }
        step.moves.push(Move {
            on: self.named(std::slice::from_ref(target), &card.place),
            u: Default::default(),
            rot: Default::default(),
            from: Some(from),
            place: card.place.clone(),
        });
    }
}
