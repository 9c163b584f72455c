//! Springs.
//!
//! | element | elongation |
//! |---|---|
//! | SPRINGA | of the line between its nodes, which turns with them |
//! | SPRING1 | the displacement of its node along an axis |
//! | SPRING2 | displacement of the first node minus that of the second, along an axis |

use super::translation::Translation;
use crate::case::{Spring, SpringEnds, SpringLaw};
use crate::diagnostic::{Spanned, codes};
use crate::readers::inp::{Field, Special, Statement};
use signorini_geometry::tensor::Vec3;

impl Translation<'_> {
    pub fn springs(&mut self) {
        for card in self.cards("SPRING") {
            self.springs_of(card);
        }
    }

    fn springs_of(&mut self, card: &Statement) {
        let Some(elset) = self.need(card, "ELSET") else {
            return;
        };
        if card.has("ORIENTATION") {
            let text = "*SPRING, ORIENTATION is not supported";
            self.error(&codes::NOT_BUILT, text, &card.place, "axes of the model");
        }
        let directory = &self.deck.directory;
        let spaces = directory.spaces(card.scope).iter();
        let springs: Vec<&Special> = spaces
            .flat_map(|&space| directory.special(space, elset))
            .filter(|element| element.kind.starts_with("SPRING"))
            .collect();
        let Some(first) = springs.first() else {
            let text = format!("element set `{elset}` has no springs");
            self.error(&codes::WRONG_KIND, text, &card.place, "");
            return;
        };
        if springs.iter().any(|one| one.kind != first.kind) {
            let text = format!("the springs of `{elset}` are of several types");
            self.error(&codes::NOT_BUILT, text, &card.place, "of one type they are");
            return;
        }
        let mut rows: Vec<Vec<Field<'_>>> = card.rows().filter(|row| !row.is_empty()).collect();
        // the first line of one along the line between its nodes is empty
        let axes = match first.kind.as_str() {
            "SPRINGA" => None,
            _ if rows.is_empty() => Some(Vec::new()),
            _ => Some(rows.remove(0)),
        };
        let (least, words) = match card.has("NONLINEAR") {
            true => (2, "force, elongation, temperature"),
            false => (1, "stiffness, nothing, temperature"),
        };
        for row in &rows {
            self.values_of(card, row, (least, 3), (words, " on a line"));
        }
        let law = self.spring_law(card, &rows);
        let direction = axes.map(|axes| self.spring_direction(card, &axes));
        let (Some(law), Some(direction)) = (law, direction.map_or(Some(None), |d| d.map(Some)))
        else {
            return;
        };
        for spring in springs {
            self.spring(card, spring, &law, direction);
        }
    }

    fn spring(
        &mut self,
        card: &Statement,
        spring: &Special,
        law: &SpringLaw,
        direction: Option<Vec3>,
    ) {
        let place = &card.place;
        let mut side = |label: u64| self.nodes_named(vec![label], place);
        let ends = match spring.nodes.as_slice() {
            [node] => SpringEnds::Ground(side(*node)),
            [from, to] => SpringEnds::Between(side(*from), side(*to)),
            _ => return,
        };
        let name = self.fresh(&format!("spring-{}", spring.label));
        self.case.springs.push(Spring {
            name: Spanned::new(name, place.clone()),
            ends,
            law: law.clone(),
            // along an axis, decks count what the first end does, and ours what the second does
            direction: direction.map(|along| (-along).to_array()),
            place: place.clone(),
        });
    }

    /// The axis of a line of one or two degrees of freedom.
    fn spring_direction(&mut self, card: &Statement, row: &[Field<'_>]) -> Option<Vec3> {
        let first = self.count(row.first(), 0);
        let second = self.count(row.get(1), first);
        match (first, second) {
            (1..=3, second) if second == first => Some(Vec3::unit(first as usize - 1)),
            _ => {
                let text = "the degrees of freedom of this spring are not supported";
                let remark = "one of 1, 2 and 3, of two nodes the same";
                self.error(&codes::NOT_BUILT, text, &card.place, remark);
                None
            }
        }
    }

    fn spring_law(&mut self, card: &Statement, rows: &[Vec<Field<'_>>]) -> Option<SpringLaw> {
        let nonlinear = card.has("NONLINEAR");
        let table: Vec<[f64; 2]> = rows.iter().map(|row| self.reals(row)).collect();
        let Some(&[stiffness, _]) = table.first() else {
            let text = "*SPRING has no data";
            let remark = "its stiffness, or with NONLINEAR lines of force and elongation";
            self.error(&codes::MISSING, text, &card.place, remark);
            return None;
        };
        let rises = |pair: &[[f64; 2]]| matches!(pair, [a, b] if b[0] >= a[0] && b[1] > a[1]);
        let fault = match nonlinear {
            true if !table.windows(2).all(rises) => "*SPRING, NONLINEAR has no rising table",
            false if table.len() > 1 => "a stiffness that depends on temperature is not supported",
            false if stiffness <= 0.0 => "the stiffness of *SPRING has to be positive",
            _ => {
                return Some(match nonlinear {
                    true => SpringLaw::Table(table),
                    false => SpringLaw::Linear(stiffness),
                });
            }
        };
        let remark = "lines of force and elongation, at one temperature";
        self.error(&codes::NOT_BUILT, fault, &card.place, remark);
        None
    }
}
