//! Laws that decks choose by the name of the material: `*USER MATERIAL`.

use super::compat::Compat;
use super::material::Constants;
use super::translation::Translation;
use crate::diagnostic::{Diagnostic, codes};
use crate::readers::inp::{Field, Statement, compared};

/// A law of `*USER MATERIAL` that is built.
struct Law {
    /// How the name of the material starts, in capitals.
    start: &'static str,
    /// The law in a case.
    model: &'static str,
    /// Its constants in a case, in the order of the deck.
    constants: [&'static str; 2],
}

const fn law(start: &'static str, model: &'static str, constants: [&'static str; 2]) -> Law {
    Law {
        start,
        model,
        constants,
    }
}

const HOOKE: [&str; 2] = ["E", "nu"];
const UNILATERAL: [&str; 2] = ["E", "residual"];

static LAWS: [Law; 6] = [
    law("LIN_ISO_EL", "saint-venant-kirchhoff", HOOKE),
    law("UNDO_NLGEOM_LIN_ISO_EL", "rotated-linear", HOOKE),
    law("UNDO_NLGEOM_LIN_EL", "rotated-linear", HOOKE),
    law("CIARLET_EL", "ciarlet", HOOKE),
    law("COMPRESSION_ONLY", "no-tension", UNILATERAL),
    law("TENSION_ONLY", "no-compression", UNILATERAL),
];

/// Other laws that CalculiX has.
static NOT_BUILT: [&str; 9] = [
    "ANISO_CREEP",
    "ANISO_PLAS",
    "CRACK",
    "ELASTIC_FIBER",
    "IDEAL_GAS",
    "JOHNSON_COOK",
    "MOHR_COULOMB",
    "SINGLE_CRYSTAL",
    "UNDO_NLGEOM",
];

impl Translation<'_> {
    /// What *USER MATERIAL says: the law whose name the material's own starts with, and its constants.
    pub(super) fn user_law(
        &mut self,
        card: &Statement,
        material: &str,
        rows: &[Vec<Field<'_>>],
    ) -> Option<(&'static str, Constants)> {
        let name = compared(material);
        let given = card
            .get("CONSTANTS")
            .map(|text| compared(text).parse::<usize>());
        let Some(law) = LAWS.iter().find(|law| name.starts_with(law.start)) else {
            let known = NOT_BUILT.iter().find(|known| name.starts_with(**known));
            let text = match known {
                Some(law) => format!("the law {law} of *USER MATERIAL is not built"),
                None => format!(
                    "the law {material} of *USER MATERIAL is a subroutine that this deck does not contain"
                ),
            };
            let built: Vec<&str> = LAWS.iter().map(|law| law.start).collect();
            let one = Diagnostic::error(&codes::NOT_BUILT, text)
                .at(&card.place, "the name of the material chooses the law")
                .note(format!("built are {}", built.join(", ")));
            self.found.push(one);
            return None;
        };
        let count = law.constants.len();
        let words = law.constants.join(" and ");
        let fault = match given {
            None => Some("CONSTANTS is missing".to_owned()),
            Some(Ok(given)) if given == count => None,
            Some(Ok(given)) => Some(format!("CONSTANTS={given} is given")),
            Some(Err(_)) => Some("CONSTANTS is no whole number".to_owned()),
        };
        if let Some(fault) = fault {
            let text = format!("{} has {count} constants, {words}; {fault}", law.start);
            self.error(&codes::WRONG_LENGTH, text, &card.place, "");
            return None;
        }
        for row in rows {
            let of_law = format!("{words}, temperature");
            self.values_of(card, row, (count, count + 1), (&of_law, " on a line"));
        }
        let table: Vec<[f64; 3]> = rows.iter().map(|row| self.reals(row)).collect();
        let [first, second, _] = *table.first()?;
        let varies = table.iter().any(|row| row[..2] != [first, second]);
        if varies && law.model == "saint-venant-kirchhoff" {
            return self.elastic(card, "", rows);
        }
        if varies {
            let text = format!(
                "constants of {} that depend on temperature are not supported",
                law.start
            );
            let remark = "take the constants at the temperature that matters";
            self.error(&codes::NOT_BUILT, text, &card.place, remark);
        }
        let values = [first, second].map(|value| vec![value]);
        let constants = law.constants.into_iter().zip(values);
        Some((law.model, constants.collect()))
    }

    /// CalculiX takes large strains where a material has *DEFORMATION PLASTICITY, with NLGEOM or without.
    pub(super) fn strains_of_deformation_plasticity(&mut self) {
        let mut all = self.deck.statements.iter();
        let Some(card) = all.find(|card| card.keyword == "DEFORMATIONPLASTICITY") else {
            return;
        };
        let is_linear = |card: &&Statement| card.keyword == "STEP" && card.peek("NLGEOM").is_none();
        if !self.deck.statements.iter().any(|card| is_linear(&card)) {
            return;
        }
        let text = if self.compat == Compat::Ccx {
            self.bends = true;
            "*DEFORMATION PLASTICITY makes strains large in all steps, as in CalculiX"
        } else {
            "*DEFORMATION PLASTICITY: strains are small in steps without NLGEOM; CalculiX has them large"
        };
        self.note(text, &card.place);
    }

    /// What *DEFORMATION PLASTICITY says: E, nu, s0, n and alpha at one temperature.
    pub(super) fn deformation_plasticity(
        &mut self,
        card: &Statement,
        rows: &[Vec<Field<'_>>],
    ) -> Option<(&'static str, Constants)> {
        let table: Vec<[f64; 5]> = rows.iter().map(|row| self.reals(row)).collect();
        let first = *table.first()?;
        if table.iter().any(|row| *row != first) {
            let text =
                "constants of *DEFORMATION PLASTICITY that depend on temperature are not supported";
            let remark = "take the constants at the temperature that matters";
            self.error(&codes::NOT_BUILT, text, &card.place, remark);
        }
        let names = ["E", "nu", "reference_stress", "exponent", "offset"];
        let constants = names.into_iter().zip(first.map(|value| vec![value]));
        Some(("ramberg-osgood-eulerian", constants.collect()))
    }
}
