//! A fluid between the surfaces of a contact pair, from the nodes where it is at first.

use super::translation::Translation;
use crate::case::{Fluid, Step};
use crate::diagnostic::codes;
use crate::readers::inp::{Kind, Statement, compared};

/// The part of a step in which the pressure grows on what the fluid has just reached, unless a card says otherwise.
const PENETRATION_TIME: f64 = 0.001;

impl Translation<'_> {
    /// *PRESSURE PENETRATION within a step: lines of a node of each surface, the pressure, and the critical one.
    pub fn penetration(&mut self, card: &Statement, step: &mut Step) {
        let second = ["SECONDARY", "SLAVE"].into_iter().find(|k| card.has(k));
        let first = ["MAIN", "PRIMARY", "MASTER"]
            .into_iter()
            .find(|k| card.has(k));
        let (secondary, primary) = (second.unwrap_or("SECONDARY"), first.unwrap_or("MAIN"));
        let both = self.need(card, secondary).zip(self.need(card, primary));
        let Some((secondary, primary)) = both else {
            return;
        };
        if card.get("OP").map(compared).is_some_and(|op| op != "MOD") {
            let text = "*PRESSURE PENETRATION, OP=NEW is not supported";
            self.error(
                &codes::NOT_BUILT,
                text,
                &card.place,
                "give pressure 0 in its lines",
            );
            return;
        }
        let sides = [secondary, primary].map(|side| (side, card.place.clone()));
        let Some(sides) = self.sides_of(card, sides, false) else {
            return;
        };
        let Some(at) = self.pair_of(card, &sides.secondary, &sides.primary) else {
            return;
        };
        let (mut nodes, mut given) = (Vec::new(), Vec::new());
        for row in card.rows() {
            for field in row.iter().take(2).filter(|field| !field.text.is_empty()) {
                nodes.extend(self.targets(card, Some(field), Kind::Nodes));
            }
            given.push([self.real(row.get(2)), self.real(row.get(3))]);
        }
        given.dedup();
        let &[[pressure, critical]] = given.as_slice() else {
            let text = "the lines of *PRESSURE PENETRATION have several pressures";
            self.error(
                &codes::NOT_BUILT,
                text,
                &card.place,
                "of one fluid there is one",
            );
            return;
        };
        let time = self.parameter(card, "PENETRATIONTIME", "PENETRATION TIME");
        let fluid = Fluid {
            pressure: 0.0,
            from: self.named(&nodes, &card.place),
            critical: Some(critical),
            ramp: time.unwrap_or(PENETRATION_TIME),
            recedes: true,
        };
        let Some(contact) = self.case.contacts.get_mut(at) else {
            return;
        };
        let before = contact.fluid.get_or_insert_with(|| fluid.clone());
        let is_other = before.from.value != fluid.from.value
            || (before.critical, before.ramp) != (fluid.critical, fluid.ramp);
        if is_other {
            let text = "a second *PRESSURE PENETRATION of a pair changes more than the pressure";
            self.error(&codes::NOT_BUILT, text, &card.place, "a pair has one fluid");
            return;
        }
        if let Some(change) = self.change(step, at, &card.place) {
            change.fluid = Some(pressure);
        }
    }
}
