//! *MODEL CHANGE, TYPE=ELEMENT: elements that are removed and added.
//!
//! CalculiX takes elements away at once; here what they exert falls to zero over the step, which ends in the same state
//! unless something on the way is remembered. `--compat ccx` takes them away at once, too.

use super::compat::Compat;
use super::translation::{Target, Translation};
use crate::case::{Activation, Deactivation, Step, StrainAt};
use crate::diagnostic::{Spanned, codes};
use crate::readers::inp::{Kind, Statement, compared};

impl Translation<'_> {
    /// *MODEL CHANGE, TYPE=ELEMENT within a step.
    pub fn change_elements(&mut self, card: &Statement, step: &mut Step) {
        if card.has("MECHSTRAINTORESIDUAL") {
            let text =
                "*MODEL CHANGE, MECHSTRAINTORESIDUAL turns strain into residual strain; not built";
            self.error(&codes::NOT_BUILT, text, &card.place, "REMOVE and ADD are");
            return;
        }
        let adds = card.get("ADD").map(compared);
        let removes = card.has("REMOVE");
        let strain = match (adds.as_deref(), removes) {
            (Some(_), true) => {
                let text = "*MODEL CHANGE both adds and removes elements";
                self.error(&codes::CONTRADICTION, text, &card.place, "ADD or REMOVE");
                return;
            }
            (None, false) => {
                let text = "*MODEL CHANGE neither adds nor removes elements";
                self.error(&codes::MISSING, text, &card.place, "ADD or REMOVE");
                return;
            }
            (Some("WITHSTRAIN"), false) => Some(StrainAt::Keep),
            (Some(_), false) => Some(StrainAt::Free),
            (None, true) => None,
        };
        let mut groups: Vec<String> = Vec::new();
        let mut single: Vec<u64> = Vec::new();
        for row in card.rows() {
            for field in row.iter().filter(|field| !field.text.is_empty()) {
                if !self.weighed(card, field).is_empty() {
                    let text = format!("*MODEL CHANGE of MASS elements in `{}`", field.text);
                    let remark = "masses at nodes are neither removed nor added";
                    self.error(&codes::NOT_BUILT, text, &field.place(), remark);
                    continue;
                }
                for target in self.targets(card, Some(field), Kind::Elements) {
                    match target {
                        Target::Set(name) if !groups.contains(&name) => groups.push(name),
                        Target::Set(_) => {}
                        Target::One(label) => single.push(label),
                    }
                }
            }
        }
        if !single.is_empty() {
            single.sort_unstable();
            single.dedup();
            groups.push(self.elements_named(single, &card.place).value);
        }
        for name in groups {
            let (group, place) = (Spanned::new(name, card.place.clone()), card.place.clone());
            match strain {
                Some(strain) => step.activations.push(Activation {
                    group,
                    strain,
                    place,
                }),
                None => step.deactivations.push(Deactivation {
                    group,
                    ramp: self.compat != Compat::Ccx,
                    place,
                }),
            }
        }
    }
}
