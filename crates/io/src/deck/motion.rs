//! Motions in time: *DYNAMIC, and velocities at the start.
//!
//! ALPHA is that of Hilber, Hughes and Taylor, −0.05 unless the card says otherwise, between −1/3 and 0. With contact it becomes the
//! generalized-α method of the same damping of the highest frequencies, `ρ = (1 + α)/(1 − α)`: by ALPHA itself, contact flickers
//! and may gain energy.

use super::translation::Translation;
use crate::case::{DynamicMethod, Dynamics, ERROR_TOL, IMPACT_STEP, Step, VelocityAt};
use crate::diagnostic::{Place, Spanned, codes};
use crate::readers::inp::{Field, Kind, Statement, compared};
use std::collections::BTreeMap;

/// ALPHA where *DYNAMIC does not have it.
const ALPHA: f64 = -0.05;

impl Translation<'_> {
    /// Makes a step dynamic.
    pub fn dynamic(&mut self, card: &Statement, step: &mut Step) {
        for keyword in ["DAMPING", "CONTACTDAMPING", "MODALDAMPING"] {
            let place = self.cards(keyword).next().map(|card| card.place.clone());
            if let Some(place) = place {
                let remark = "write  damping = { mass = }  in the [material] of a case";
                let text = "damping of decks is not supported in dynamic steps";
                self.error(&codes::NOT_BUILT, text, &place, remark);
            }
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
        let method = if has_contact {
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
            error_tol: ERROR_TOL,
            impact_step: IMPACT_STEP,
        });
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
