//! Printed tables.

use super::translation::Translation;
use crate::case::{Increments, Print, PrintOf, Step, Totals};
use crate::diagnostic::{Spanned, codes};
use crate::readers::inp::{Kind, Statement, compared};

/// What decks call the quantities of a card.
fn quantities(of: PrintOf) -> &'static [(&'static str, &'static str)] {
    match of {
        PrintOf::Nodes => &[
            ("U", "displacement"),
            ("RF", "reaction"),
            ("NT", "temperature"),
            ("RFL", "heat-reaction"),
        ],
        PrintOf::Elements => &[
            ("S", "stress"),
            ("E", "strain"),
            ("ME", "mechanical-strain"),
            ("PEEQ", "plastic-strain"),
            ("ENER", "energy-density"),
            ("ELSE", "energy"),
            ("EVOL", "volume"),
            ("CENT", "spin-squared"),
            ("HFL", "heat-flux"),
        ],
        PrintOf::Contact => &[
            ("CDIS", "gap"),
            ("CSTR", "traction"),
            ("CELS", "energy"),
            ("CNUM", "count"),
            ("CF", "force"),
            ("CFN", "normal-force"),
            ("CFS", "shear-force"),
        ],
        // one table has all of them
        PrintOf::Faces => &[("SOF", "force"), ("SOM", "force"), ("SOAR", "force")],
    }
}

impl Translation<'_> {
    /// Tables that a step prints. The first card in a step takes the place of all those of the step before.
    pub fn print(&mut self, card: &Statement, step: &mut Step) {
        let (of, parameter, kind) = match card.keyword.as_str() {
            "NODEPRINT" => (PrintOf::Nodes, "NSET", Kind::Nodes),
            "ELPRINT" => (PrintOf::Elements, "ELSET", Kind::Elements),
            "SECTIONPRINT" => (PrintOf::Faces, "SURFACE", Kind::Surface),
            _ => (PrintOf::Contact, "SLAVE", Kind::Surface),
        };
        let every = self.frequency(card);
        let wanted = self.wanted(card, of);
        let prints = step.prints.get_or_insert_default();
        let last = prints.last().map_or(1, |print| print.every);
        let on = if of == PrintOf::Contact {
            let sides = card.get("SLAVE").zip(card.get("MASTER"));
            sides.and_then(|(slave, master)| {
                let both = [slave, master].map(|name| (name, card.place.clone()));
                let sides = self.sides_of(card, both, false)?;
                self.contact_of(&sides)
            })
        } else {
            let Some(name) = card.get(parameter).filter(|name| !name.is_empty()) else {
                self.prints_nothing(card, every, step);
                return;
            };
            let Some(set) = self.set(card, name, &card.place, kind) else {
                return;
            };
            Some(set)
        };
        let every = every.unwrap_or(last);
        if wanted.is_empty() || every == 0 {
            return;
        }
        let totals = match card.get("TOTALS").map(compared).as_deref() {
            Some("YES") => Totals::Yes,
            Some("ONLY") => Totals::Only,
            _ => Totals::No,
        };
        // vectors at nodes with axes of their own are along these, unless the card says otherwise
        let global = card.get("GLOBAL").map(compared).as_deref() == Some("YES");
        let has_axes = match of {
            PrintOf::Nodes => !self.axes.is_empty(),
            // tensors of materials with axes of their own are along these
            PrintOf::Elements => self.case.bodies.iter().any(|b| b.orientation.is_some()),
            PrintOf::Contact | PrintOf::Faces => false,
        };
        let local = !global && has_axes;
        let prints = step.prints.get_or_insert_default();
        prints.push(Print {
            on,
            of,
            quantities: wanted,
            totals,
            local,
            every,
            place: card.place.clone(),
        });
        // the frequency that was given last holds for all
        for print in prints {
            print.every = every;
        }
    }

    /// After how many increments a card prints; zero for never, nothing where it does not say so.
    fn frequency(&mut self, card: &Statement) -> Option<u64> {
        let text = card.get("FREQUENCY")?;
        let every = compared(text).parse().ok();
        if every.is_none() {
            let text = "FREQUENCY is no whole number";
            self.error(&codes::NOT_A_NUMBER, text, &card.place, "");
        }
        Some(every.unwrap_or(1))
    }

    /// What a card asks for, in our words.
    fn wanted(&mut self, card: &Statement, of: PrintOf) -> Vec<Spanned<String>> {
        let known = quantities(of);
        let mut wanted: Vec<Spanned<String>> = Vec::new();
        for row in card.rows() {
            for field in row.iter().filter(|field| !field.text.is_empty()) {
                // four letters count: CDISP is CDIS
                let letters: String = field.key().chars().take(4).collect();
                match known.iter().find(|(name, _)| *name == letters) {
                    Some(_) if of == PrintOf::Faces && !wanted.is_empty() => {}
                    Some((_, word)) => wanted.push(Spanned::new((*word).to_owned(), field.place())),
                    None => self.note(
                        format!("`{}` of *{} is not printed", field.text, card.title),
                        &field.place(),
                    ),
                }
            }
        }
        wanted
    }

    /// What *REFINE MESH asks for comes after the results of its step.
    pub fn unrefined(&mut self, card: &Statement) {
        // its line says by which result
        let _ = (card.rows(), card.get("LIMIT"));
        let text = "*REFINE MESH is left out: the mesh is not refined";
        self.warn(text, &card.place, "results are those of the mesh given");
    }

    /// Notes that a card without a set prints nothing, unless its frequency says the same.
    fn prints_nothing(&mut self, card: &Statement, every: Option<u64>, step: &Step) {
        let most = match step.increments {
            Increments::Count(count) | Increments::Fixed(count) => count,
            Increments::Adaptive { count_max, .. } => count_max,
        };
        let never = every.is_some_and(|every| every == 0 || every > most);
        // Abaqus' name for it, of which CalculiX knows nothing
        let short = card
            .get("FREQ")
            .and_then(|text| compared(text).parse().ok());
        if never || short.is_some_and(|every: u64| every == 0 || every > most) {
            return;
        }
        let text = format!(
            "*{} names no set: it prints nothing, as in CalculiX",
            card.title
        );
        self.note(text, &card.place);
    }
}
