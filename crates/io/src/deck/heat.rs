//! Heat: what materials conduct and store, what crosses contacts, steps that solve for temperatures.
//!
//! | deck | case |
//! |---|---|
//! | \*HEAT TRANSFER | `kind = "heat"`; its temperatures alone are unknown |
//! | \*COUPLED and \*UNCOUPLED TEMPERATURE-DISPLACEMENT | `kind = "coupled"`: one iteration for both, whichever the card asks for |
//! | \*BOUNDARY of degree of freedom 11, or 0 | `step.temperature` |
//! | \*CFLUX, \*DFLUX, \*DSFLUX, \*FILM, \*SFILM, \*RADIATE, \*SRADIATE | loads |
//! | \*GAP CONDUCTANCE | `conductance`: over the gap, over the pressure with PRESSURE; with [`Compat::Ccx`] always over the pressure |
//! | \*GAP HEAT GENERATION | `friction_heat`: all of it, in halves, without the card; none with [`Compat::Ccx`] |
//!
//! Loads and temperatures of transient steps act at once, those of steady ones grow over the step, as in both programs.
//!
//! Source: Abaqus Keywords Reference Guide; CalculiX CrunchiX User's Manual, chapter 7.

use super::compat::Compat;
use super::translation::{Target, Translation};
use crate::case::{Conductance, Conduction, Conductivity, Constants, FrictionHeat};
use crate::diagnostic::{Place, Spanned, codes};
use crate::readers::inp::{Field, Kind, Statement, compared};

/// The component of a line that is a temperature; those of motions are below.
pub(super) const TEMPERATURE: usize = 6;

/// The procedures that solve for temperatures.
pub(super) const PROCEDURES: [&str; 3] = [
    "HEATTRANSFER",
    "COUPLEDTEMPERATURE-DISPLACEMENT",
    "UNCOUPLEDTEMPERATURE-DISPLACEMENT",
];

/// Whether a step of the deck solves for temperatures.
pub(super) fn is_solved_for(statements: &[Statement]) -> bool {
    let mut cards = statements.iter();
    cards.any(|card| PROCEDURES.contains(&card.keyword.as_str()))
}

/// What is known of the heat of a material.
#[derive(Clone, Debug, Default)]
pub(super) struct HeatProperties {
    conductivity: Option<Spanned<Conductivity>>,
    specific_heat: Vec<[f64; 2]>,
    latent_heat: Vec<[f64; 3]>,
}

impl HeatProperties {
    /// Whether heat goes through it.
    pub fn conducts(&self) -> bool {
        self.conductivity.is_some()
    }

    /// Its heat in a case; what it stores counts by mass.
    pub fn case_of(self, has_density: bool) -> Option<Conduction> {
        let conductivity = self.conductivity?;
        let (specific_heat, latent_heat) = match has_density {
            true => (self.specific_heat, self.latent_heat),
            false => Default::default(),
        };
        Some(Conduction {
            conductivity: conductivity.value,
            specific_heat,
            latent_heat,
            place: conductivity.place,
        })
    }
}

/// The heat of an interaction.
#[derive(Clone, Debug, Default)]
pub(super) struct GapHeat {
    conductance: Vec<Conductance>,
    generation: Option<FrictionHeat>,
}

impl Translation<'_> {
    /// Whether all steps of the deck solve for temperatures alone.
    pub fn is_all_heat(&self) -> bool {
        let count = |keyword: &str| {
            let cards = self.deck.statements.iter();
            cards.filter(|card| card.keyword == keyword).count()
        };
        count("STEP") > 0 && count("HEATTRANSFER") == count("STEP")
    }

    /// *PHYSICAL CONSTANTS, of radiation.
    pub fn physical_constants(&mut self) {
        for card in self.cards("PHYSICALCONSTANTS") {
            let zero = self.parameter(card, "ABSOLUTEZERO", "ABSOLUTE ZERO");
            let sigma = self.parameter(card, "STEFANBOLTZMANN", "STEFAN BOLTZMANN");
            if let Some((absolute_zero, stefan_boltzmann)) = zero.zip(sigma) {
                self.case.constants = Some(Constants {
                    stefan_boltzmann,
                    absolute_zero,
                });
            }
        }
    }

    /// *CONDUCTIVITY, *SPECIFIC HEAT or *LATENT HEAT.
    pub fn heat_property(
        &mut self,
        card: &Statement,
        heat: &mut HeatProperties,
        rows: &[Vec<Field<'_>>],
    ) {
        match card.keyword.as_str() {
            "CONDUCTIVITY" => {
                let conductivity = self.conductivity(card, rows);
                heat.conductivity = conductivity.map(|c| Spanned::new(c, card.place.clone()));
            }
            "SPECIFICHEAT" => heat.specific_heat = self.by_temperature(card, rows),
            _ => heat.latent_heat = rows.iter().map(|row| self.reals(row)).collect(),
        }
    }

    fn conductivity(&mut self, card: &Statement, rows: &[Vec<Field<'_>>]) -> Option<Conductivity> {
        let kind = card.get("TYPE").map(compared).unwrap_or_default();
        match kind.as_str() {
            "ORTHO" => match rows {
                [row] => Some(Conductivity::Along(self.reals(row))),
                rows => {
                    let along = rows.iter().map(|row| self.reals(row));
                    let full = along.map(|[a, b, c, t]| [t, a, b, c, 0.0, 0.0, 0.0]);
                    let full = full.collect();
                    Some(Conductivity::Full(self.rising(card, full)))
                }
            },
            "ANISO" => {
                // 11, 12, 22, 13, 23, 33
                let given = rows.iter().map(|row| self.reals(row));
                let full = given.map(|[a, d, b, f, e, c, t]| [t, a, b, c, d, e, f]);
                let full = full.collect();
                Some(Conductivity::Full(self.rising(card, full)))
            }
            _ => Some(Conductivity::Isotropic(self.by_temperature(card, rows))),
        }
    }

    /// Rows of value and temperature, with temperatures first.
    fn by_temperature(&mut self, card: &Statement, rows: &[Vec<Field<'_>>]) -> Vec<[f64; 2]> {
        let given = rows.iter().map(|row| self.reals(row));
        let turned = given.map(|[value, temperature]| [temperature, value]);
        let turned = turned.collect();
        self.rising(card, turned)
    }

    /// Rows in the order of their temperatures, which come first.
    fn rising<const N: usize>(
        &mut self,
        card: &Statement,
        mut rows: Vec<[f64; N]>,
    ) -> Vec<[f64; N]> {
        rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
        if rows
            .windows(2)
            .any(|pair| matches!(pair, [a, b] if a[0] == b[0]))
        {
            let text = format!("*{} has two lines of one temperature", card.title);
            let remark = "each temperature once";
            self.error(&codes::NOT_INCREASING, text, &card.place, remark);
        }
        rows
    }

    /// *GAP CONDUCTANCE or *GAP HEAT GENERATION.
    pub fn gap_heat(&mut self, card: &Statement, gap: &mut GapHeat) {
        let rows: Vec<_> = card.rows().filter(|row| !row.is_empty()).collect();
        for row in &rows {
            self.not_negative(card, row.get(..1).unwrap_or_default());
        }
        if card.keyword == "GAPHEATGENERATION" {
            let row = rows.first().map_or(&[][..], Vec::as_slice);
            let mut given = |at: usize, otherwise: f64| {
                let field = row.get(at).filter(|field| !field.text.is_empty());
                field.map_or(otherwise, |field| self.real(Some(field)))
            };
            let (fraction, to_secondary, speed) = (given(0, 1.0), given(1, 0.5), given(2, 0.0));
            if speed > 0.0 {
                let text = "a speed of its own in *GAP HEAT GENERATION is not supported";
                let remark = "bodies that slide heat each other by their own motion";
                self.error(&codes::NOT_BUILT, text, &card.place, remark);
            }
            gap.generation = Some(FrictionHeat {
                fraction,
                to_secondary,
            });
            return;
        }
        let table: Vec<[f64; 3]> = rows.iter().map(|row| self.reals(row)).collect();
        if let [first, .., last] = table.as_slice()
            && first[2] != last[2]
        {
            let text = "*GAP CONDUCTANCE that depends on temperature is not supported";
            let remark = "lines of one temperature";
            self.error(&codes::NOT_BUILT, text, &card.place, remark);
        }
        let rows = table.iter().map(|&[h, over, _]| [over, h]).collect();
        let rows = self.rising(card, rows);
        gap.conductance = match rows.as_slice() {
            [] => Vec::new(),
            [[_, h]] => vec![Conductance::Constant(*h)],
            _ if card.has("PRESSURE") || self.compat == Compat::Ccx => {
                vec![Conductance::OverPressure(rows)]
            }
            _ => vec![Conductance::OverGap(rows)],
        };
    }

    /// The ways of heat across a contact, and what becomes of its friction. CalculiX heats by friction where a card says so, and
    /// between faces alone.
    pub fn heat_of_gap(
        &self,
        gap: &GapHeat,
        of_faces: bool,
    ) -> (Vec<Conductance>, Option<FrictionHeat>) {
        if !self.solves_for_heat {
            return (Vec::new(), Some(FrictionHeat::default()));
        }
        let generation = match self.compat {
            Compat::Ccx => gap.generation.filter(|_| of_faces),
            Compat::None | Compat::Oofem => Some(gap.generation.unwrap_or_default()),
        };
        (gap.conductance.clone(), generation)
    }

    /// Refuses a heat that has a way of acting which is not built: of networks, cavities, users' routines.
    pub fn no_such_heat(&mut self, card: &Statement, label: &str, place: &Place) {
        let text = format!("*{} has no `{label}` here", card.title);
        let remark = match card.keyword.as_str() {
            "DFLUX" => "S1 to S6 and BF are read",
            "FILM" => "F1 to F6 are read: films of networks and users' routines are not built",
            "RADIATE" => "R1 to R6 are read: cavities and users' routines are not built",
            "DSFLUX" => "S is read",
            "SFILM" => "F is read",
            _ => "R is read",
        };
        self.error(&codes::NOT_BUILT, text, place, remark);
    }

    /// A line of *CFLUX: the nodes it heats.
    pub fn heated(&mut self, card: &Statement, row: &[Field<'_>]) -> Vec<u64> {
        let targets: Vec<Target> = self.targets(card, row.first(), Kind::Nodes);
        let place = row.first().map_or(card.place.clone(), Field::place);
        let dof = self.count(row.get(1), 11);
        if dof != 0 && dof != 11 {
            let text = format!("there is no heat along degree of freedom {dof}");
            self.error(&codes::OUT_OF_RANGE, text, &place, "11, or 0");
            return Vec::new();
        }
        targets
            .iter()
            .flat_map(|target| self.labels(target))
            .collect()
    }
}
