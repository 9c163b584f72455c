//! General contact: `*CONTACT` and the cards that belong to it.
//!
//! | card | here |
//! |---|---|
//! | \*CONTACT INCLUSIONS, ALL EXTERIOR; lines | everything; surfaces that touch themselves (`a` or `a, a`) or each other (`a, b`) |
//! | \*CONTACT EXCLUSIONS | pairs that do not touch; they win over inclusions |
//! | \*CONTACT PROPERTY ASSIGNMENT | interactions, of all (`, , I`) or of pairs; the last wins |
//! | \*CONTACT INITIALIZATION DATA | what is done at the start: SEARCH ABOVE, INTERFERENCE FIT, INITIAL CLEARANCE |
//! | \*CONTACT INITIALIZATION ASSIGNMENT | data, of all (`, , D`) or of pairs; the last wins |
//! | \*CONTACT FORMULATION | which side of a pair is secondary |
//! | \*CONTACT CONTROLS ASSIGNMENT | nothing |
//!
//! Overlaps at the start are without strain unless data say otherwise, as by default in Abaqus.

use super::interaction::{Interaction, Law};
use super::translation::Translation;
use crate::case::{
    ANY, Contact, Excluded, General, GeneralPair, Interference, Method, Name, Start,
};
use crate::diagnostic::{Place, Spanned, codes};
use crate::readers::inp::{Field, Kind, Statement, compared};
use std::collections::{BTreeMap, BTreeSet};

/// Cards that mean nothing without *CONTACT.
const MORE: [&str; 6] = [
    "CONTACTEXCLUSIONS",
    "CONTACTPROPERTYASSIGNMENT",
    "CONTACTFORMULATION",
    "CONTACTINCLUSIONS",
    "CONTACTINITIALIZATIONASSIGNMENT",
    "CONTACTINITIALIZATIONDATA",
];

/// What is done at the start unless data say otherwise.
fn without_strain() -> Start {
    Start {
        interference: Interference::StrainFree,
        ..Start::default()
    }
}

impl Translation<'_> {
    pub(super) fn general(&mut self, interactions: &BTreeMap<String, Interaction>) {
        let Some(begin) = self.cards("CONTACT").next() else {
            for keyword in MORE {
                for card in self.cards(keyword) {
                    let text = format!("*{} stands without *CONTACT", card.title);
                    self.error(&codes::CONTRADICTION, text, &card.place, "");
                }
            }
            return;
        };
        for again in self.cards("CONTACT").skip(1) {
            let text = "a deck has one *CONTACT";
            self.error(&codes::CONTRADICTION, text, &again.place, "the second");
        }
        let nobody = || Spanned::new(String::new(), begin.place.clone());
        let mut common = Contact::new(nobody(), nobody(), nobody(), begin.place.clone());
        common.start = without_strain();
        let (of, mut exclude) = self.included(begin);
        for card in self.cards("CONTACTEXCLUSIONS") {
            for row in card.rows() {
                let [one, other] = self.two(card, &row);
                exclude.push((one, Some(other)));
            }
        }
        let mut pairs = Vec::new();
        for card in self.cards("CONTACTPROPERTYASSIGNMENT") {
            for row in card.rows() {
                self.assigned(card, &row, interactions, (&mut common, &mut pairs));
            }
        }
        let data = self.initializations();
        for card in self.cards("CONTACTINITIALIZATIONASSIGNMENT") {
            for row in card.rows() {
                self.initialized(card, &row, &data, (&mut common, &mut pairs));
            }
        }
        for card in self.cards("CONTACTFORMULATION") {
            self.roles(card, &mut pairs);
        }
        self.case.general = Some(General {
            of,
            with_itself: true,
            exclude,
            common,
            pairs,
        });
    }

    /// What may touch, and what of it may not touch each other.
    fn included(&mut self, begin: &Statement) -> (Vec<Name>, Vec<Excluded>) {
        let mut pairs: Vec<[Name; 2]> = Vec::new();
        let mut is_all = false;
        for card in self.cards("CONTACTINCLUSIONS") {
            is_all |= card.has("ALLEXTERIOR");
            for row in card.rows() {
                let both = self.two(card, &row);
                is_all |= both.iter().all(|name| name.value == ANY);
                pairs.push(both);
            }
        }
        if is_all {
            return (Vec::new(), Vec::new());
        }
        if pairs.is_empty() {
            let text = "*CONTACT has no *CONTACT INCLUSIONS: nothing would touch";
            self.error(&codes::MISSING, text, &begin.place, "");
        }
        let meets_all = pairs.iter().flatten().any(|name| name.value == ANY);
        if meets_all {
            let text = "*CONTACT INCLUSIONS of one surface with everything is not supported";
            self.error(&codes::NOT_BUILT, text, &begin.place, "name both surfaces");
        }
        let key = |[one, other]: [&Name; 2]| {
            let mut both = [one.value.clone(), other.value.clone()];
            both.sort_unstable();
            both
        };
        let meant: BTreeSet<[String; 2]> = pairs.iter().map(|[a, b]| key([a, b])).collect();
        let mut of: Vec<Name> = Vec::new();
        for name in pairs.iter().flatten() {
            if of.iter().all(|known| known.value != name.value) {
                of.push(name.clone());
            }
        }
        let mut exclude = Vec::new();
        for (at, one) in of.iter().enumerate() {
            let others = of.get(at..).unwrap_or_default();
            let apart = others
                .iter()
                .filter(|other| !meant.contains(&key([one, other])));
            exclude.extend(apart.map(|other| (one.clone(), Some(other.clone()))));
        }
        (of, exclude)
    }

    /// Two surfaces of a line: a blank first one is everything, a blank second one the first again.
    fn two(&mut self, card: &Statement, row: &[Field<'_>]) -> [Name; 2] {
        let text = |at: usize| row.get(at).map_or("", |field| field.text);
        let place = |at: usize| row.get(at).map_or_else(|| card.place.clone(), Field::place);
        let one = self.surface_or_any(card, text(0), place(0));
        let other = match (text(0).is_empty(), text(1).is_empty()) {
            (_, false) => self.surface_or_any(card, text(1), place(1)),
            (_, true) => one.clone(),
        };
        [one, other]
    }

    fn surface_or_any(&mut self, card: &Statement, text: &str, place: Place) -> Name {
        let any = || Spanned::new(ANY.to_owned(), place.clone());
        match text.is_empty() {
            true => any(),
            false => self
                .set(card, text, &place, Kind::Surface)
                .unwrap_or_else(any),
        }
    }

    /// What a line names after its two surfaces; `missing` says that there is none.
    fn third_of<'a, T>(
        &mut self,
        card: &Statement,
        row: &[Field<'_>],
        all: &'a BTreeMap<String, T>,
        missing: &str,
    ) -> Option<&'a T> {
        let name = third(row);
        let found = all.get(&name);
        if found.is_none() {
            let text = format!("there {missing} `{name}`");
            self.error(&codes::UNDEFINED, text, &card.place, "");
        }
        found
    }

    /// A line of *CONTACT PROPERTY ASSIGNMENT.
    fn assigned(
        &mut self,
        card: &Statement,
        row: &[Field<'_>],
        interactions: &BTreeMap<String, Interaction>,
        (common, pairs): (&mut Contact, &mut Vec<GeneralPair>),
    ) {
        let Some(interaction) = self.third_of(card, row, interactions, "is no surface interaction")
        else {
            return;
        };
        let joins = match interaction.law {
            Law::Tied(_) => Some("TIED"),
            _ => interaction.bond.cohesive().map(|_| "COHESIVE BEHAVIOR"),
        };
        if let Some(joins) = joins {
            let text = format!("{joins} in *CONTACT PROPERTY ASSIGNMENT is not supported");
            self.error(
                &codes::NOT_BUILT,
                text,
                &card.place,
                "join the surfaces by *TIE",
            );
            return;
        }
        let between = self.two(card, row);
        let mut own = common.clone();
        self.obey(&mut own, interaction, Method::GaussPoint);
        own.method = Method::Auto.into();
        if is_of_all(&between, pairs) {
            (common.enforcement, common.per) = (own.enforcement, own.per);
            common.friction = own.friction;
            return;
        }
        pairs.push(GeneralPair {
            friction: Some(own.friction),
            enforcement: Some((own.enforcement, own.per)),
            ..GeneralPair::new(between, card.place.clone())
        });
    }

    /// What *CONTACT INITIALIZATION DATA say, by name.
    fn initializations(&mut self) -> BTreeMap<String, Start> {
        let mut all = BTreeMap::new();
        for card in self.cards("CONTACTINITIALIZATIONDATA") {
            let mut start = without_strain();
            if let Some(gap) = self.length(card, "SEARCHABOVE", "SEARCH ABOVE") {
                start.close_gaps_below = gap;
            }
            if card.has("SEARCHBELOW") {
                let text = "*CONTACT INITIALIZATION DATA, SEARCH BELOW changes nothing: overlaps of any \
                            size count";
                self.note(text, &card.place);
            }
            let clearance = self.length(card, "INITIALCLEARANCE", "INITIAL CLEARANCE");
            start.clearance = clearance;
            if let Some(text) = card.get("INTERFERENCEFIT") {
                start.interference = Interference::Step;
                if !text.is_empty() {
                    let fit = self.length(card, "INTERFERENCEFIT", "INTERFERENCE FIT");
                    start.clearance = fit.map(|fit| -fit);
                }
                if clearance.is_some() {
                    let text = "INITIAL CLEARANCE and INTERFERENCE FIT exclude each other";
                    self.error(&codes::CONTRADICTION, text, &card.place, "delete one");
                }
            }
            let stays = card.get("ADJUST").map(compared).as_deref() == Some("NO");
            if stays && start.close_gaps_below > 0.0 {
                let text =
                    "*CONTACT INITIALIZATION DATA, ADJUST=NO with SEARCH ABOVE is not supported";
                self.error(
                    &codes::NOT_BUILT,
                    text,
                    &card.place,
                    "gaps are closed by moving nodes",
                );
            }
            if let Some(name) = self.need(card, "NAME") {
                all.insert(compared(name), start);
            }
        }
        all
    }

    /// A parameter that is a length.
    fn length(&mut self, card: &Statement, parameter: &str, shown: &str) -> Option<f64> {
        let value = self.parameter(card, parameter, shown)?;
        if value < 0.0 {
            let text = format!("{shown} is negative");
            self.error(&codes::OUT_OF_RANGE, text, &card.place, "write a length");
        }
        Some(value)
    }

    /// A line of *CONTACT INITIALIZATION ASSIGNMENT.
    fn initialized(
        &mut self,
        card: &Statement,
        row: &[Field<'_>],
        data: &BTreeMap<String, Start>,
        (common, pairs): (&mut Contact, &mut Vec<GeneralPair>),
    ) {
        let missing = "are no *CONTACT INITIALIZATION DATA";
        let Some(start) = self.third_of(card, row, data, missing) else {
            return;
        };
        let between = self.two(card, row);
        if is_of_all(&between, pairs) {
            common.start = start.clone();
            return;
        }
        pairs.push(GeneralPair {
            start: Some(start.clone()),
            ..GeneralPair::new(between, card.place.clone())
        });
    }

    /// The roles of *CONTACT FORMULATION.
    fn roles(&mut self, card: &Statement, pairs: &mut Vec<GeneralPair>) {
        let kind = card.get("TYPE").map(compared).unwrap_or_default();
        if !matches!(kind.as_str(), "MASTERSLAVEROLES" | "MAINSECONDARYROLES") {
            let text = format!("*CONTACT FORMULATION, TYPE={kind} changes nothing here");
            self.note(text, &card.place);
            return;
        }
        for row in card.rows() {
            let role = third(&row);
            let between = self.two(card, &row);
            let [one, other] = &between;
            let secondary = match role.as_str() {
                "SLAVE" | "SECONDARY" => one.clone(),
                "MASTER" | "MAIN" => other.clone(),
                "BALANCED" => {
                    let text = "*CONTACT FORMULATION with BALANCED roles: one side is secondary";
                    self.note(text, &card.place);
                    continue;
                }
                _ => {
                    let text = format!("a role is SLAVE, MASTER or BALANCED, not `{role}`");
                    self.error(&codes::NOT_A_CHOICE, text, &card.place, "");
                    continue;
                }
            };
            pairs.push(GeneralPair {
                secondary: Some(secondary),
                ..GeneralPair::new(between, card.place.clone())
            });
        }
    }
}

/// What a line says of its two surfaces.
fn third(row: &[Field<'_>]) -> String {
    let said = row.get(2).map(|field| compared(field.text));
    said.unwrap_or_default()
}

/// Whether a line is about everything, with nothing of pairs before it that it would have to win over.
fn is_of_all(between: &[Name; 2], pairs: &[GeneralPair]) -> bool {
    pairs.is_empty() && between.iter().all(|name| name.value == ANY)
}
