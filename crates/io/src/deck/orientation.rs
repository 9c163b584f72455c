//! Axes of materials: `*ORIENTATION` and `*DISTRIBUTION`.

use super::translation::Translation;
use crate::case::{
    AxesSystem, BodyAxes, ElementAxes, MaterialSystem, NamedOrientation, Orientation,
};
use crate::diagnostic::{Place, Spanned, codes};
use crate::readers::inp::{Field, Kind, Statement, compared};
use signorini_geometry::tensor::{Mat3, Vec3, turn_about};
use std::collections::BTreeMap;

/// Axes of materials by their names; nothing for those that have been reported.
pub(super) type Orientations = BTreeMap<String, Option<BodyAxes>>;

/// Axes by element.
type Distributions = BTreeMap<String, MaterialSystem>;

impl Translation<'_> {
    /// The second line of *ORIENTATION: the number of a local axis, the first if it is not given, and the angle by which
    /// all turn about it.
    fn turn(&mut self, card: &Statement, row: &[Field<'_>]) -> Option<(usize, f64)> {
        let axis = self.count(row.first(), 1);
        let angle = self.real(row.get(1));
        if !(1..=3).contains(&axis) {
            let text = format!("*ORIENTATION turns about local axis {axis}");
            self.error(&codes::OUT_OF_RANGE, text, &card.place, "1, 2 or 3");
            return None;
        }
        Some((axis as usize - 1, angle))
    }

    /// Axes of materials. Those that are not the same everywhere get a name in the case.
    pub(super) fn orientations(&mut self) -> Orientations {
        let mut all = BTreeMap::new();
        self.named_twice("ORIENTATION");
        let distributions = self.distributions();
        for card in self.cards("ORIENTATION") {
            if let Some(name) = self.need(card, "NAME") {
                let orientation = self.orientation(card, name, &distributions);
                all.insert(compared(name), orientation);
            }
        }
        all
    }

    fn orientation(
        &mut self,
        card: &Statement,
        name: &str,
        distributions: &Distributions,
    ) -> Option<BodyAxes> {
        let system = card.get("SYSTEM").map(compared).unwrap_or_default();
        let cylindrical = system.starts_with('C');
        let mut rows = card.rows();
        let numbers: Vec<_> = rows.next().unwrap_or_default();
        let turn = rows.next().filter(|row| !row.is_empty());
        let turn = turn.and_then(|row| self.turn(card, &row));
        let place = card.place.clone();
        let named = |system| NamedOrientation {
            name: Spanned::new(name.to_owned(), place.clone()),
            system,
            turn,
            place: place.clone(),
        };
        let first = numbers.first();
        let is_name = |field: &&Field<'_>| !field.text.is_empty() && field.real().is_none();
        if let Some(field) = first.filter(is_name) {
            let Some(found) = distributions.get(&compared(field.text)) else {
                let text = format!("there is no *DISTRIBUTION `{}`", field.text);
                self.error(&codes::UNDEFINED, text, &field.place(), "");
                return None;
            };
            if cylindrical {
                let text = "*ORIENTATION, SYSTEM=CYLINDRICAL of a *DISTRIBUTION is not supported";
                self.error(
                    &codes::NOT_BUILT,
                    text,
                    &field.place(),
                    "rectangular ones are",
                );
                return None;
            }
            let one = named(found.clone());
            return Some(self.name_axes(one));
        }
        let system = self.system(card, &numbers);
        let Some(axes) = system.at(Vec3::ZERO) else {
            let text = "the two points of *ORIENTATION give no axes";
            self.error(&codes::OUT_OF_RANGE, text, &card.place, "");
            return None;
        };
        match system {
            AxesSystem::Cylindrical { from, to } => {
                let along = Vec3::from(to) - Vec3::from(from);
                let one = named(MaterialSystem::Cylindrical {
                    origin: from,
                    axis: along.to_array(),
                });
                Some(self.name_axes(one))
            }
            AxesSystem::Rectangular { x, xy } => Some(BodyAxes::Here(match turn {
                Some((axis, angle)) => turned(axes, axis, angle, place.clone()),
                None => Orientation {
                    x,
                    y: xy,
                    place: place.clone(),
                },
            })),
        }
    }

    /// The axes of an *ORIENTATION before they turn, by its first line.
    pub(super) fn system(&mut self, card: &Statement, numbers: &[Field<'_>]) -> AxesSystem {
        let system = card.get("SYSTEM").map(compared).unwrap_or_default();
        let [a, b, c, d, e, f] = self.reals(numbers);
        match system.starts_with('C') {
            true => AxesSystem::Cylindrical {
                from: [a, b, c],
                to: [d, e, f],
            },
            false => AxesSystem::Rectangular {
                x: [a, b, c],
                xy: [d, e, f],
            },
        }
    }

    fn name_axes(&mut self, one: NamedOrientation) -> BodyAxes {
        let name = one.name.clone();
        self.case.orientations.push(one);
        BodyAxes::Named(name)
    }

    /// Axes by element: the first line is the default, further ones name an element or a set.
    fn distributions(&mut self) -> Distributions {
        let mut all = BTreeMap::new();
        self.named_twice("DISTRIBUTION");
        for card in self.cards("DISTRIBUTION") {
            let Some(name) = self.need(card, "NAME") else {
                continue;
            };
            let mut default = None;
            let mut of_element: BTreeMap<u64, ElementAxes> = BTreeMap::new();
            for row in card.rows().filter(|row| !row.is_empty()) {
                let place = row.first().map_or(card.place.clone(), Field::place);
                let [a, b, c, d, e, f] = self.reals(row.get(1..).unwrap_or_default());
                let (x, y) = ([a, b, c], [d, e, f]);
                if (AxesSystem::Rectangular { x, xy: y })
                    .at(Vec3::ZERO)
                    .is_none()
                {
                    let text = "the two points of this line of *DISTRIBUTION give no axes";
                    self.error(&codes::OUT_OF_RANGE, text, &place, "");
                    continue;
                }
                let is_default = row.first().is_some_and(|field| field.text.is_empty());
                if default.is_none() {
                    if !is_default {
                        let text = "the first line of *DISTRIBUTION is the default";
                        let remark = "leave its first field empty";
                        self.error(&codes::MISSING, text, &place, remark);
                    }
                    default = Some((x, y));
                    if is_default {
                        continue;
                    }
                }
                for target in self.targets(card, row.first(), Kind::Elements) {
                    for element in self.elements(&target) {
                        let place = place.clone();
                        of_element.insert(
                            element,
                            ElementAxes {
                                element,
                                x,
                                y,
                                place,
                            },
                        );
                    }
                }
            }
            if let Some((x, y)) = default {
                let rows = of_element.into_values().collect();
                all.insert(compared(name), MaterialSystem::Elements { x, y, rows });
            }
        }
        all
    }
}

/// Local axes that turn about one of themselves, counter-clockwise as seen from its tip; degrees.
fn turned(axes: [Vec3; 3], axis: usize, angle: f64, place: Place) -> Orientation {
    let [x, y, _] = (turn_about(axis, angle) * Mat3::from_rows(axes)).rows;
    Orientation {
        x: x.to_array(),
        y: y.to_array(),
        place,
    }
}
