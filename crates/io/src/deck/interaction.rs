//! What happens between two surfaces: *SURFACE INTERACTION and what stands in it.

use super::cohesion::Bond;
use super::heat::GapHeat;
use super::translation::Translation;
use crate::case::Damping;
use crate::diagnostic::codes;
use crate::readers::inp::{Statement, compared};
use std::collections::BTreeMap;

/// What happens between two surfaces.
#[derive(Clone, Debug, Default)]
pub(super) struct Interaction {
    pub law: Law,
    /// The coefficient of friction, and the slope of sticking or zero.
    pub friction: Option<[f64; 2]>,
    /// Pressure and shear over velocity.
    pub damping: [f64; 2],
    /// How the surfaces are joined until the joint breaks.
    pub bond: Bond,
    /// How heat crosses it, and arises in it.
    pub heat: GapHeat,
}

impl Interaction {
    /// What damps it; of CalculiX, wherever the spring acts.
    pub fn damping(&self, exact: bool) -> Damping {
        let [normal, tangential] = self.damping;
        Damping {
            normal,
            tangential,
            pulls: exact && self.damping != [0.0; 2],
        }
    }
}

/// What pressures and overclosures are.
#[derive(Clone, Debug, Default)]
pub(super) enum Law {
    #[default]
    Hard,
    /// K, the tension at a distance, and the gap beyond which nothing acts; zero where they are not given.
    Linear([f64; 3]),
    Exponential {
        c0: f64,
        p0: f64,
    },
    /// Pressures and overclosures.
    Table(Vec<[f64; 2]>),
    /// K; zero where it is not given.
    Tied(f64),
}

impl Translation<'_> {
    pub(super) fn interactions(&mut self) -> BTreeMap<String, Interaction> {
        let mut all: BTreeMap<String, Interaction> = BTreeMap::new();
        let mut open: Option<String> = None;
        let deck = self.deck;
        for card in &deck.statements {
            match card.keyword.as_str() {
                "SURFACEINTERACTION" => {
                    open = self.need(card, "NAME").map(compared);
                    if let Some(name) = &open {
                        all.entry(name.clone()).or_default();
                    }
                }
                "MATERIAL" => open = None,
                "SURFACEBEHAVIOR"
                | "FRICTION"
                | "CONTACTDAMPING"
                | "GAPCONDUCTANCE"
                | "GAPHEATGENERATION"
                | "COHESIVEBEHAVIOR"
                | "DAMAGEINITIATION"
                | "DAMAGEEVOLUTION"
                | "DAMAGESTABILIZATION" => {
                    let Some(one) = open.as_ref().and_then(|name| all.get_mut(name)) else {
                        let text = format!("*{} stands in no *SURFACE INTERACTION", card.title);
                        self.error(&codes::CONTRADICTION, text, &card.place, "");
                        continue;
                    };
                    match card.keyword.as_str() {
                        "FRICTION" => one.friction = Some(self.friction(card)),
                        "CONTACTDAMPING" => one.damping = self.contact_damping(card),
                        "SURFACEBEHAVIOR" => one.law = self.law(card),
                        "GAPCONDUCTANCE" | "GAPHEATGENERATION" => {
                            self.gap_heat(card, &mut one.heat);
                        }
                        _ => self.bond(card, &mut one.bond),
                    }
                }
                "STEP" => break,
                _ => {}
            }
        }
        for one in all.values() {
            self.whole_bond(&one.bond);
        }
        all
    }

    /// Pressure and shear over velocity.
    fn contact_damping(&mut self, card: &Statement) -> [f64; 2] {
        let row = card.rows().next().unwrap_or_default();
        self.not_negative(card, &row);
        let [normal] = self.reals(&row);
        let fraction = card.get("TANGENTFRACTION").map(|text| text.trim().parse());
        match fraction {
            None => [normal, 0.0],
            Some(Ok(fraction)) if fraction >= 0.0 && f64::is_finite(fraction) => {
                [normal, fraction * normal]
            }
            Some(_) => {
                let text = "TANGENT FRACTION of *CONTACT DAMPING is no number from 0 on";
                self.error(&codes::WRONG_TYPE, text, &card.place, "");
                [normal, 0.0]
            }
        }
    }

    /// The coefficient, and the slope of sticking or zero.
    pub(super) fn friction(&mut self, card: &Statement) -> [f64; 2] {
        let row = card.rows().next().unwrap_or_default();
        self.not_negative(card, &row);
        self.reals(&row)
    }

    pub(super) fn law(&mut self, card: &Statement) -> Law {
        let given: Vec<_> = card.rows().collect();
        let rows: Vec<[f64; 2]> = given.iter().map(|row| self.reals(row)).collect();
        let [a, b] = rows.first().copied().unwrap_or_default();
        let kind = card
            .get("PRESSURE-OVERCLOSURE")
            .map(compared)
            .unwrap_or_default();
        match kind.as_str() {
            "" | "HARD" => Law::Hard,
            "LINEAR" => {
                if a <= 0.0 {
                    let text = "the stiffness of LINEAR has to be positive";
                    self.error(&codes::OUT_OF_RANGE, text, &card.place, "");
                }
                let first = given.first().map(|row| self.reals(row));
                Law::Linear(first.unwrap_or_default())
            }
            "EXPONENTIAL" => {
                if a <= 0.0 || b <= 0.0 {
                    let text = "c0 and p0 of EXPONENTIAL have to be positive";
                    self.error(&codes::OUT_OF_RANGE, text, &card.place, "");
                }
                Law::Exponential { c0: a, p0: b }
            }
            "TABULAR" => {
                let rises =
                    |pair: &[[f64; 2]]| matches!(pair, [a, b] if b[0] > a[0] && b[1] > a[1]);
                if rows.len() < 2 || !rows.windows(2).all(rises) {
                    let text =
                        "TABULAR needs two rows or more of pressures and overclosures that rise";
                    self.error(&codes::NOT_INCREASING, text, &card.place, "");
                }
                Law::Table(rows)
            }
            "TIED" => Law::Tied(a),
            _ => {
                let text = format!("PRESSURE-OVERCLOSURE={kind} is not supported");
                self.error(&codes::NOT_BUILT, text, &card.place, "");
                Law::Hard
            }
        }
    }
}
