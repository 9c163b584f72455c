//! Temperatures of steps: those that are given, and those that are held where temperatures are unknown.

use super::heat::PROCEDURES;
use super::step::{Course, Line, Standing, motion};
use super::translation::Translation;
use crate::case::{Directions, Free, Motion, Name, Step, Temperature, TemperatureAt, Thermal};
use crate::diagnostic::{Place, Spanned, codes};
use crate::readers::inp::{Kind, Statement, compared};

impl Translation<'_> {
    /// What a procedure does with temperatures; none where it does not solve for them.
    pub fn thermal(&mut self, card: &Statement, head: Option<&Statement>) -> Option<Thermal> {
        if !PROCEDURES.contains(&card.keyword.as_str()) {
            return None;
        }
        let thermal = Thermal {
            coupled: card.keyword != "HEATTRANSFER",
            transient: !card.has("STEADYSTATE"),
        };
        if card.has("DELTMX") {
            let text = format!("DELTMX of *{} limits no increment here", card.title);
            let remark = "limit them by the fourth number of its line";
            self.warn(text, &card.place, remark);
        }
        let by = head.and_then(|head| head.get("AMPLITUDE")).map(compared);
        if thermal.transient && by.as_deref() == Some("RAMP") {
            let text = "*STEP, AMPLITUDE=RAMP does not go with a step in which bodies store heat";
            let remark = "give its loads an *AMPLITUDE";
            self.error(&codes::NOT_BUILT, text, &card.place, remark);
        }
        Some(thermal)
    }

    /// Starts with the temperatures that a first step holds where bodies store heat: CalculiX leaves out the heat that goes into the
    /// elements at these nodes when they jump there. Where bodies expand, the start also says where they are without strain.
    pub fn start_with(&mut self, lines: &[Line], step: &Step) {
        let expands = self.case.materials.iter().any(|m| m.expansion.is_some());
        let differs = !self.case.initial_temperatures.is_empty();
        if !step.thermal.is_some_and(|thermal| thermal.transient) || expands && differs {
            return;
        }
        for line in lines {
            if let Course::To(temperature, None) = line.course {
                let on = self.named(&line.targets, &line.place);
                self.case.initial_temperatures.push(TemperatureAt {
                    on,
                    temperature,
                    gradient: None,
                    place: line.place.clone(),
                });
                let everywhere = || Spanned::new(0.0, line.place.clone());
                self.case.initial_temperature.get_or_insert_with(everywhere);
            }
        }
    }

    /// Temperatures that lines of *BOUNDARY hold.
    pub fn hold_temperatures(
        &mut self,
        lines: Vec<Line>,
        sudden: bool,
        standing: &mut Standing,
        step: &mut Step,
    ) {
        for line in lines {
            let Course::To(value, amplitude) = &line.course else {
                let text = "*BOUNDARY, FIXED of temperatures is not supported";
                self.error(
                    &codes::NOT_BUILT,
                    text,
                    &line.place,
                    "write the temperature",
                );
                continue;
            };
            let on = self.named(&line.targets, &line.place);
            standing.warm.push(on.clone());
            step.temperatures.push(Temperature {
                on,
                value: motion(*value, amplitude.as_ref(), sudden, step.duration),
                gradient: None,
                place: line.place.clone(),
            });
        }
    }

    /// Sets free what earlier steps have given temperatures to.
    pub fn free_temperatures(&mut self, named: Vec<Name>, step: &mut Step, place: &Place) {
        step.frees.extend(named.into_iter().map(|on| Free {
            on,
            u: Directions::default(),
            rot: Directions::default(),
            temperature: true,
            place: place.clone(),
        }));
    }

    /// Temperatures that *TEMPERATURE gives.
    pub fn temperatures(&mut self, card: &Statement, standing: &mut Standing, step: &mut Step) {
        if step.thermal.is_some() {
            let text = "*TEMPERATURE in a step that solves for temperatures";
            let remark = "*BOUNDARY of degree of freedom 11 holds them";
            self.error(&codes::CONTRADICTION, text, &card.place, remark);
            return;
        }
        if card.has("AMPLITUDE") || card.has("FILE") {
            let text = "*TEMPERATURE with AMPLITUDE or FILE is not supported";
            self.error(&codes::NOT_BUILT, text, &card.place, "");
            return;
        }
        for row in card.rows() {
            let targets = self.targets(card, row.first(), Kind::Nodes);
            let value = self.real(row.get(1));
            let gradient = self.gradient(&row, &targets);
            if targets.is_empty() {
                continue;
            }
            let on = self.named(&targets, &card.place);
            standing.given.push(on.clone());
            step.temperatures.push(Temperature {
                on,
                value: Motion::Ramp(value),
                gradient: gradient.map(|gradient| Spanned::new(gradient, card.place.clone())),
                place: card.place.clone(),
            });
        }
    }
}
