//! Printed tables.

use super::translation::Translation;
use crate::case::{Print, PrintOf, Step, Totals};
use crate::diagnostic::{Spanned, codes};
use crate::readers::inp::{Kind, Statement, compared};

/// What decks call the quantities of a card.
fn quantities(of: PrintOf) -> &'static [(&'static str, &'static str)] {
    match of {
        PrintOf::Nodes => &[
            ("U", "displacement"),
            ("RF", "reaction"),
            ("NT", "temperature"),
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
        let on = if of == PrintOf::Contact {
            let sides = card.get("SLAVE").zip(card.get("MASTER"));
            sides.and_then(|(slave, master)| {
                let both = [slave, master].map(|name| (name, card.place.clone()));
                let sides = self.sides_of(card, both, false)?;
                self.contact_of(&sides)
            })
        } else {
            let Some(name) = self.need(card, parameter) else {
                return;
            };
            let Some(set) = self.set(card, name, &card.place, kind) else {
                return;
            };
            Some(set)
        };
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
                        format!("`{}` of *{} is not printed", field.text, card.keyword),
                        &field.place(),
                    ),
                }
            }
        }
        if wanted.is_empty() {
            return;
        }
        let totals = match card.get("TOTALS").map(compared).as_deref() {
            Some("YES") => Totals::Yes,
            Some("ONLY") => Totals::Only,
            _ => Totals::No,
        };
        let every = card
            .get("FREQUENCY")
            .map(|text| match compared(text).parse() {
                Ok(every) => every,
                Err(_) => {
                    let text = "FREQUENCY is no whole number";
                    self.error(&codes::NOT_A_NUMBER, text, &card.place, "");
                    1
                }
            });
        // vectors at nodes with axes of their own are along these, unless the card says otherwise
        let global = card.get("GLOBAL").map(compared).as_deref() == Some("YES");
        let local = of == PrintOf::Nodes && !global && !self.axes.is_empty();
        let prints = step.prints.get_or_insert_default();
        let last = prints.last().map_or(1, |print| print.every);
        let every = every.unwrap_or(last).max(1);
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
}
