//! Joints that break: *COHESIVE BEHAVIOR and the damage cards of a *SURFACE INTERACTION.

use super::translation::Translation;
use crate::case::{Cohesive, Mixity};
use crate::diagnostic::{Place, codes};
use crate::readers::inp::{Statement, compared};

/// How the surfaces of an interaction are joined, card by card.
#[derive(Clone, Debug, Default)]
pub(super) struct Bond {
    /// The card that joins.
    place: Option<Place>,
    stiffness: Option<[f64; 2]>,
    /// Of opening and shear.
    strength: Option<[f64; 2]>,
    /// The energies, and what they are between opening and shear.
    toughness: Option<([f64; 2], Mixity)>,
    viscosity: f64,
}

impl Bond {
    /// How the joint breaks; nothing where a card is missing.
    pub fn cohesive(&self) -> Option<Cohesive> {
        let ((toughness, mixity), strength) = self.toughness.zip(self.strength)?;
        Some(Cohesive {
            strength,
            toughness,
            mixity,
            quadratic: true,
            exponential: false,
            stiffness: self.stiffness,
            viscosity: self.viscosity,
        })
    }
}

impl Translation<'_> {
    /// What a card adds to a joint.
    pub(super) fn bond(&mut self, card: &Statement, bond: &mut Bond) {
        match card.keyword.as_str() {
            "COHESIVEBEHAVIOR" => self.cohesive_behavior(card, bond),
            "DAMAGEINITIATION" => self.damage_initiation(card, bond),
            "DAMAGEEVOLUTION" => self.damage_evolution(card, bond),
            _ => bond.viscosity = self.of_one_direction(card)[0],
        }
    }

    /// Refuses a joint that lacks a card.
    pub(super) fn whole_bond(&mut self, bond: &Bond) {
        let Some(place) = bond.place.clone().filter(|_| bond.cohesive().is_none()) else {
            return;
        };
        let text =
            "*COHESIVE BEHAVIOR without *DAMAGE INITIATION and *DAMAGE EVOLUTION is not supported";
        self.error(&codes::NOT_BUILT, text, &place, "join the surfaces by *TIE");
    }

    fn cohesive_behavior(&mut self, card: &Statement, bond: &mut Bond) {
        bond.place = Some(card.place.clone());
        self.only(card, "TYPE", "TYPE", &["UNCOUPLED"]);
        self.only(
            card,
            "ELIGIBILITY",
            "ELIGIBILITY",
            &["ORIGINALCONTACTS", "CURRENTCONTACTS"],
        );
        if card.rows().next().is_some() {
            bond.stiffness = Some(self.of_two_directions(card));
        }
    }

    fn damage_initiation(&mut self, card: &Statement, bond: &mut Bond) {
        // only the quadratic criterion is there: the largest of the ratios has corners
        if self.need(card, "CRITERION").is_some() {
            self.only(card, "CRITERION", "CRITERION", &["QUADS"]);
        }
        bond.strength = Some(self.of_two_directions(card));
    }

    fn damage_evolution(&mut self, card: &Statement, bond: &mut Bond) {
        if self.need(card, "TYPE").is_some() {
            self.only(card, "TYPE", "TYPE", &["ENERGY"]);
        }
        self.only(card, "SOFTENING", "SOFTENING", &["LINEAR"]);
        self.only(card, "MODEMIXRATIO", "MODE MIX RATIO", &["ENERGY"]);
        let words = ["BK", "POWERLAW", "MODEINDEPENDENT"];
        self.only(card, "MIXEDMODEBEHAVIOR", "MIXED MODE BEHAVIOR", &words);
        let kind = card.get("MIXEDMODEBEHAVIOR").map(compared);
        let mixity = match kind.as_deref() {
            Some(kind @ ("BK" | "POWERLAW")) => {
                self.need(card, "POWER");
                let power = self.parameter(card, "POWER", "POWER").unwrap_or(1.0);
                if power <= 0.0 {
                    let text = "POWER of *DAMAGE EVOLUTION has to be positive";
                    self.error(&codes::OUT_OF_RANGE, text, &card.place, "");
                }
                match kind {
                    "BK" => Mixity::Bk(power),
                    _ => Mixity::Power(power),
                }
            }
            _ => {
                let [energy] = self.of_one_direction(card);
                bond.toughness = Some(([energy; 2], Mixity::Bk(1.0)));
                return;
            }
        };
        bond.toughness = Some((self.of_two_directions(card), mixity));
    }

    /// Refuses a word that is none of these.
    fn only(&mut self, card: &Statement, parameter: &str, shown: &str, words: &[&str]) {
        let given = card.get(parameter).map(compared);
        if let Some(word) = given.filter(|word| !word.is_empty() && !words.contains(&word.as_str()))
        {
            let text = format!("{shown}={word} of *{} is not supported", card.title);
            self.error(&codes::NOT_BUILT, text, &card.place, "");
        }
    }

    /// A number above zero.
    fn of_one_direction(&mut self, card: &Statement) -> [f64; 1] {
        let row = card.rows().next().unwrap_or_default();
        let numbers = self.reals::<1>(&row);
        self.positive(card, &numbers);
        numbers
    }

    /// Numbers of the normal and of both tangents, which are the same.
    fn of_two_directions(&mut self, card: &Statement) -> [f64; 2] {
        let row = card.rows().next().unwrap_or_default();
        let [normal, first, second] = self.reals::<3>(&row);
        self.positive(card, &[normal, first]);
        if row.len() > 2 && second != first {
            let text = format!("*{} with two kinds of shear is not supported", card.title);
            let remark = format!("{first} and {second} are not the same");
            self.error(&codes::NOT_BUILT, text, &card.place, &remark);
        }
        [normal, first]
    }

    fn positive(&mut self, card: &Statement, numbers: &[f64]) {
        if numbers.iter().any(|number| *number <= 0.0) {
            let text = format!("the numbers of *{} have to be positive", card.title);
            self.error(&codes::OUT_OF_RANGE, text, &card.place, "");
        }
    }
}
