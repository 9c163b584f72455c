//! Motions in time: *DYNAMIC, *DAMPING, and velocities at the start.
//!
//! ALPHA is that of Hilber, Hughes and Taylor, −0.05 unless the card says otherwise, between −1/3 and 0. With contact it becomes the
//! generalized-α method of the same damping of the highest frequencies, `ρ = (1 + α)/(1 − α)`: by ALPHA itself, contact flickers
//! and may gain energy. Where the laws of CalculiX hold and no contact damps, it stays, and contact forces are weighted as others are.

use super::compat::Compat;
use super::translation::Translation;
use crate::case::{
    DynamicMethod, Dynamics, ERROR_TOL, IMPACT_STEP, MaterialDamping, SAFETY, Step, VelocityAt,
};
use crate::diagnostic::{Place, Spanned, codes};
use crate::readers::inp::{Field, Kind, Statement, compared};
use std::collections::BTreeMap;

/// ALPHA where *DYNAMIC does not have it.
const ALPHA: f64 = -0.05;

impl Translation<'_> {
    /// Makes a step dynamic.
    pub fn dynamic(&mut self, card: &Statement, step: &mut Step) {
        self.damping(card.has("EXPLICIT"));
        if card.has("EXPLICIT") {
            step.dynamics = Some(Dynamics {
                method: DynamicMethod::Explicit {
                    safety: SAFETY,
                    scaling: None,
                },
                redistributed: Spanned::new(false, card.place.clone()),
                weighted: false,
                error_tol: ERROR_TOL,
                impact_step: IMPACT_STEP,
            });
            return;
        }
        let given = card.get("ALPHA").map(|text| text.trim().parse::<f64>());
        let alpha = match given {
            None => ALPHA,
            Some(Ok(alpha)) if alpha.is_finite() => alpha.clamp(-1.0 / 3.0, 0.0),
            Some(_) => {
                let text = "ALPHA of *DYNAMIC is no number";
                self.error(&codes::WRONG_TYPE, text, &card.place, "from -1/3 to 0");
                ALPHA
            }
        };
        let has_contact = !self.case.contacts.is_empty() || self.case.general.is_some();
        // dampers of contacts act by the mean velocity of an increment, which ALPHA does not go with
        let damps = self.cards("CONTACTDAMPING").next().is_some();
        let weighted = has_contact && self.compat == Compat::Ccx && !damps;
        let method = if has_contact && !weighted {
            let radius = (1.0 + alpha) / (1.0 - alpha);
            let text = format!(
                "ALPHA = {alpha} becomes rho_inf = {radius:.4} of the generalized-alpha method: by ALPHA, contact flickers"
            );
            self.note(text, &card.place);
            DynamicMethod::GeneralizedAlpha(radius)
        } else {
            DynamicMethod::HilberHughesTaylor(alpha)
        };
        step.dynamics = Some(Dynamics {
            method,
            redistributed: Spanned::new(false, card.place.clone()),
            weighted,
            error_tol: ERROR_TOL,
            impact_step: IMPACT_STEP,
        });
    }

    /// *DAMPING: of the material that it stands in, or of all; of CalculiX always of all. BETA is left out where all motions are
    /// explicit.
    fn damping(&mut self, is_explicit: bool) {
        if let Some(place) = self
            .cards("MODALDAMPING")
            .next()
            .map(|card| card.place.clone())
        {
            let text = "*MODAL DAMPING is not supported in dynamic steps";
            self.error(&codes::NOT_BUILT, text, &place, "write *DAMPING, ALPHA=");
        }
        let mut material: Option<String> = None;
        let deck = self.deck;
        let mut motions = deck
            .statements
            .iter()
            .filter(|card| card.keyword == "DYNAMIC");
        let implicit = motions.any(|card| !card.has("EXPLICIT"));
        for card in &deck.statements {
            match card.keyword.as_str() {
                "MATERIAL" => material = card.peek("NAME").map(compared),
                "DAMPING" => {
                    let [mass, stiffness] = ["ALPHA", "BETA"].map(|key| self.damped(card, key));
                    let text = match implicit {
                        true => {
                            "BETA of *DAMPING damps in explicit steps, too, as others need it: CalculiX leaves it out there"
                        }
                        false => "BETA of *DAMPING is left out in explicit steps, as CalculiX does",
                    };
                    if stiffness > 0.0 && is_explicit {
                        self.note(text.to_owned(), &card.place);
                    }
                    let stiffness = if implicit { stiffness } else { 0.0 };
                    let own = material.as_ref().filter(|_| self.compat != Compat::Ccx);
                    if mass > 0.0 && own.is_none() && !self.point_masses.is_empty() {
                        let text = "ALPHA of *DAMPING does not damp MASS elements here";
                        let remark = "only bodies with a material are damped";
                        self.warn(text, &card.place, remark);
                    }
                    let damped = self.case.materials.iter_mut();
                    let damped =
                        damped.filter(|one| own.is_none_or(|own| compared(&one.name) == *own));
                    damped.for_each(|one| one.damping = MaterialDamping { mass, stiffness });
                }
                _ => {}
            }
        }
    }

    /// A number of *DAMPING, from 0 on.
    fn damped(&mut self, card: &Statement, key: &str) -> f64 {
        match card.get(key).map(|text| text.trim().parse::<f64>()) {
            None => 0.0,
            Some(Ok(value)) if value.is_finite() && value >= 0.0 => value,
            Some(_) => {
                let text = format!("{key} of *DAMPING is no number from 0 on");
                self.error(&codes::WRONG_TYPE, text, &card.place, "");
                0.0
            }
        }
    }

    /// *INITIAL CONDITIONS, TYPE=VELOCITY: component by component, the last line that names a node and a component.
    pub fn velocities(&mut self) {
        let mut velocities: BTreeMap<u64, [f64; 3]> = BTreeMap::new();
        let mut last: Option<Place> = None;
        for card in self.cards("INITIALCONDITIONS") {
            if card.get("TYPE").map(compared).as_deref() != Some("VELOCITY") {
                continue;
            }
            for row in card.rows().filter(|row| !row.is_empty()) {
                let place = row.first().map_or(card.place.clone(), Field::place);
                let targets = self.targets(card, row.first(), Kind::Nodes);
                let (component, value) = (self.count(row.get(1), 0), self.real(row.get(2)));
                let axis = (component as usize).checked_sub(1);
                let Some(axis) = axis.filter(|axis| *axis < self.ndim()) else {
                    let text = format!("a velocity has no component {component}");
                    let remark = format!("1 to {}", self.ndim());
                    self.error(&codes::OUT_OF_RANGE, text, &place, remark);
                    continue;
                };
                for node in targets.iter().flat_map(|target| self.labels(target)) {
                    if let Some(to) = velocities.entry(node).or_default().get_mut(axis) {
                        *to = value;
                    }
                }
                last.get_or_insert(place);
            }
        }
        // nodes that move alike together, in the order of their first
        let mut alike: BTreeMap<[u64; 3], Vec<u64>> = BTreeMap::new();
        for (node, velocity) in velocities {
            let nodes = alike.entry(velocity.map(f64::to_bits)).or_default();
            nodes.push(node);
        }
        let mut groups: Vec<([u64; 3], Vec<u64>)> = alike.into_iter().collect();
        groups.sort_by(|a, b| a.1.cmp(&b.1));
        let place = last.unwrap_or_else(Place::nowhere);
        for (velocity, nodes) in groups {
            let on = self.nodes_named(nodes, &place);
            self.case.initial_velocities.push(VelocityAt {
                on,
                velocity: velocity.map(f64::from_bits),
                spin: [0.0; 3],
                about: [0.0; 3],
                place: place.clone(),
            });
        }
    }
}
