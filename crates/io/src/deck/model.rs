//! Materials, sections, amplitudes, temperatures at the start.

use super::translation::{Target, Translation};
use crate::case::{
    Amplitude, AxesSystem, Body, Constant, Expansion, Hardening, Integration, Locking, Material,
    Model, Name, Orientation, Plasticity, Space, TimeBase,
};
use crate::diagnostic::{Place, Spanned, codes};
use crate::readers::inp::{Kind, Statement, compared, number};
use signorini_geometry::tensor::Vec3;
use std::collections::BTreeMap;

/// What is known of a material.
#[derive(Clone, Debug, Default)]
pub(super) struct Properties {
    name: Name,
    law: Option<(&'static str, Vec<(&'static str, f64)>)>,
    density: Option<f64>,
    alpha: Option<(f64, Option<f64>)>,
    plasticity: Option<Plasticity>,
    place: Place,
}

impl Properties {
    /// The first elastic constant.
    pub fn modulus(&self) -> Option<f64> {
        let (_, constants) = self.law.as_ref()?;
        constants.first().map(|(_, value)| *value)
    }
}

impl Translation<'_> {
    pub fn model(&mut self) {
        self.title();
        self.space();
        self.materials();
        self.start_temperature();
        self.amplitudes();
        self.sections();
    }

    fn title(&mut self) {
        let Some(card) = self.cards("HEADING").next() else {
            return;
        };
        let title = card.lines().next().unwrap_or_default();
        self.case.title = title
            .chars()
            .filter(|c| !c.is_control())
            .take(200)
            .collect();
    }

    /// Dimension of the model, by the types of its elements.
    fn space(&mut self) {
        let (names, types) = self.deck.directory.types();
        let mut used = vec![false; names.len()];
        for &number in types.iter().flatten() {
            if let Some(used) = used.get_mut(number as usize) {
                *used = true;
            }
        }
        let dim = self.deck.mesh.dim();
        let names = || {
            names
                .iter()
                .zip(&used)
                .filter(|(_, used)| **used)
                .map(|(name, _)| name)
        };
        let of = |letters: &str| names().any(|name| name.starts_with(letters));
        let space = match dim {
            3 => Space::ThreeD,
            _ if of("CAX") => Space::Axisymmetric,
            _ if of("CPS") => Space::PlaneStress,
            _ => Space::PlaneStrain,
        };
        let mixed = ["CAX", "CPS", "CPE"]
            .iter()
            .filter(|letters| of(letters))
            .count()
            > 1;
        if mixed && dim == 2 {
            self.error(
                &codes::NOT_BUILT,
                "elements of plane stress, plane strain and axisymmetry in one deck",
                &Place::nowhere(),
                "a model has one of them",
            );
        }
        self.case.model = Model {
            space: space.into(),
            thickness: 1.0,
        };
    }

    fn materials(&mut self) {
        let mut open: Option<Properties> = None;
        let mut order = Vec::new();
        let deck = self.deck;
        for card in &deck.statements {
            match card.keyword.as_str() {
                "MATERIAL" => {
                    order.extend(open.take());
                    let name = self
                        .need(card, "NAME")
                        .unwrap_or_default()
                        .trim()
                        .to_owned();
                    open = Some(Properties {
                        name: Spanned::new(name, card.place.clone()),
                        place: card.place.clone(),
                        ..Properties::default()
                    });
                }
                "ELASTIC" | "DENSITY" | "EXPANSION" | "PLASTIC" | "HYPERELASTIC" => {
                    let Some(mut material) = open.take() else {
                        let text = format!("*{} stands in no *MATERIAL", card.keyword);
                        self.error(&codes::CONTRADICTION, text, &card.place, "");
                        continue;
                    };
                    self.property(card, &mut material);
                    open = Some(material);
                }
                "STEP" => break,
                _ => {}
            }
        }
        order.extend(open);
        for material in order {
            self.materials
                .insert(compared(&material.name), material.clone());
            self.case.materials.extend(case_of(material));
        }
    }

    fn property(&mut self, card: &Statement, material: &mut Properties) {
        let rows: Vec<_> = card.rows().filter(|row| !row.is_empty()).collect();
        let Some(first) = rows.first() else {
            let text = format!("*{} has no data", card.keyword);
            self.error(&codes::MISSING, text, &card.place, "");
            return;
        };
        let kind = card.get("TYPE").map(compared).unwrap_or_default();
        match card.keyword.as_str() {
            "DENSITY" => material.density = Some(self.real(first.first())),
            "ELASTIC" => {
                // a second row of the same length is a second temperature
                let per_row = match kind.as_str() {
                    "" => 1,
                    name if "ISOTROPIC".starts_with(name) => 1,
                    _ => 2,
                };
                if rows.len() > per_row {
                    let remark = "take the constants at the temperature that matters";
                    let text = "constants that depend on temperature are not supported";
                    self.error(&codes::NOT_BUILT, text, &card.place, remark);
                }
                let all: Vec<_> = rows.iter().flatten().cloned().collect();
                if per_row == 1 {
                    let [e, nu] = self.reals(&all);
                    material.law = Some(("linear-elastic", vec![("E", e), ("nu", nu)]));
                    return;
                }
                let c: [f64; 9] = self.reals(&all);
                let law = if kind.starts_with("ENGINEERING") {
                    Some(c)
                } else if "ORTHOTROPIC".starts_with(&kind) {
                    engineering(c)
                } else {
                    let text = format!("*ELASTIC, TYPE={kind} is not supported");
                    let remark = "isotropic, ORTHO and ENGINEERING CONSTANTS are";
                    self.error(&codes::NOT_BUILT, text, &card.place, remark);
                    return;
                };
                let names = [
                    "E1", "E2", "E3", "nu12", "nu13", "nu23", "G12", "G13", "G23",
                ];
                match law {
                    Some(c) => {
                        material.law = Some(("orthotropic", names.into_iter().zip(c).collect()));
                    }
                    None => {
                        let text = "these elastic constants have no compliance";
                        self.error(&codes::OUT_OF_RANGE, text, &card.place, "");
                    }
                }
            }
            "EXPANSION" => {
                if !kind.is_empty() && !"ISOTROPIC".starts_with(&kind) || rows.len() > 1 {
                    let text =
                        "expansion that depends on direction or temperature is not supported";
                    self.error(&codes::NOT_BUILT, text, &card.place, "");
                }
                let zero = card.get("ZERO").map(|text| {
                    number(text).unwrap_or_else(|| {
                        let text = "ZERO is no number";
                        self.error(&codes::NOT_A_NUMBER, text, &card.place, "");
                        0.0
                    })
                });
                material.alpha = Some((self.real(first.first()), zero));
            }
            "PLASTIC" => {
                let hardening = match card.get("HARDENING").map(compared).as_deref() {
                    None | Some("ISOTROPIC") => Hardening::Isotropic,
                    Some("KINEMATIC") => Hardening::Kinematic,
                    Some(other) => {
                        let text = format!("*PLASTIC, HARDENING={other} is not supported");
                        self.error(&codes::NOT_BUILT, text, &card.place, "");
                        return;
                    }
                };
                let mut table: Vec<[f64; 2]> = rows.iter().map(|row| self.reals(row)).collect();
                let is_at_another_temperature =
                    |pair: &[[f64; 2]]| matches!(pair, [a, b] if b[1] <= a[1]);
                if table.windows(2).any(is_at_another_temperature) {
                    let text = "plastic strains do not increase";
                    let remark = "hardening that depends on temperature is not supported";
                    self.error(&codes::NOT_INCREASING, text, &card.place, remark);
                }
                if let Some(first) = table.first_mut() {
                    first[1] = 0.0;
                }
                material.plasticity = Some(Plasticity {
                    hardening: hardening.into(),
                    table: table.into(),
                    modulus: None,
                });
            }
            _ => {
                if !card.has("NEOHOOKE") {
                    let text = "only *HYPERELASTIC, NEO HOOKE is supported";
                    self.error(&codes::NOT_BUILT, text, &card.place, "");
                    return;
                }
                // W = C10 (I1 − 3) + (J − 1)²/D1: shear modulus 2 C10, bulk modulus 2/D1
                let [c10, d1]: [f64; 2] = self.reals(first);
                if d1 <= 0.0 || c10 <= 0.0 {
                    let text = "C10 and D1 have to be positive";
                    let remark = "incompressible laws are not supported: give D1";
                    self.error(&codes::OUT_OF_RANGE, text, &card.place, remark);
                    return;
                }
                let constants = vec![("c10", c10), ("c01", 0.0), ("bulk", 2.0 / d1)];
                material.law = Some(("mooney-rivlin", constants));
            }
        }
    }

    fn start_temperature(&mut self) {
        let mut found: Option<(f64, Place)> = None;
        for card in self.cards("INITIALCONDITIONS") {
            let kind = card.get("TYPE").map(compared).unwrap_or_default();
            if kind != "TEMPERATURE" {
                let text = format!("*INITIAL CONDITIONS, TYPE={kind} is not supported");
                self.error(&codes::NOT_BUILT, text, &card.place, "");
                continue;
            }
            for row in card.rows() {
                self.targets(card, row.first(), Kind::Nodes);
                let value = self.real(row.get(1));
                match &found {
                    Some((first, _)) if *first != value => {
                        let text = "temperatures at the start that differ are not supported";
                        let remark = format!("the first one is {first}");
                        self.error(&codes::NOT_BUILT, text, &card.place, remark);
                    }
                    Some(_) => {}
                    None => found = Some((value, card.place.clone())),
                }
            }
        }
        let start = found.as_ref().map(|(value, _)| *value);
        self.case.initial_temperature = found.map(|(value, place)| Spanned::new(value, place));
        // thermal strain counts from the start, at which there is none
        for material in &mut self.case.materials {
            if let (Some(expansion), Some(start)) = (&mut material.expansion, start) {
                expansion.reference.value = start;
            }
        }
    }

    fn amplitudes(&mut self) {
        for card in self.cards("AMPLITUDE") {
            let Some(name) = self.need(card, "NAME") else {
                continue;
            };
            for unknown in ["USER", "SHIFTX", "SHIFTY", "DEFINITION", "VALUE"] {
                if card
                    .get(unknown)
                    .is_some_and(|v| !["TABULAR", "RELATIVE"].contains(&v))
                {
                    let text = format!("*AMPLITUDE, {unknown} is not supported");
                    self.error(&codes::NOT_BUILT, text, &card.place, "");
                }
            }
            let fields: Vec<_> = card.rows().flatten().collect();
            let mut table: Vec<[f64; 2]> = Vec::new();
            for pair in fields.chunks(2) {
                table.push(self.reals(pair));
            }
            if table
                .windows(2)
                .any(|pair| matches!(pair, [a, b] if b[0] <= a[0]))
            {
                let text = "times of *AMPLITUDE do not increase";
                self.error(&codes::NOT_INCREASING, text, &card.place, "");
            }
            let total = card
                .get("TIME")
                .map(compared)
                .is_some_and(|t| t.starts_with("TOTAL"));
            self.case.amplitudes.push(Amplitude {
                name: Spanned::new(name.to_owned(), card.place.clone()),
                table,
                time: if total {
                    TimeBase::Total
                } else {
                    TimeBase::Step
                },
            });
        }
    }

    /// The name of an amplitude as the case has it.
    pub fn amplitude(&mut self, card: &Statement) -> Option<Name> {
        let wanted = card.get("AMPLITUDE")?;
        let known = self.case.amplitudes.iter();
        let known = known
            .map(|one| &one.name.value)
            .find(|name| compared(name) == compared(wanted));
        match known.cloned() {
            Some(name) => Some(Spanned::new(name, card.place.clone())),
            None => {
                let text = format!("there is no amplitude `{wanted}`");
                self.error(&codes::UNDEFINED, text, &card.place, "");
                None
            }
        }
    }

    fn sections(&mut self) {
        let orientations = self.orientations();
        let mut thickness: Option<f64> = None;
        for card in self.cards("SOLIDSECTION") {
            let (elset, material) = (self.need(card, "ELSET"), self.need(card, "MATERIAL"));
            let (Some(elset), Some(material)) = (elset, material) else {
                continue;
            };
            let Some(known) = self.materials.get(&compared(material)) else {
                let text = format!("there is no material `{material}`");
                self.error(&codes::UNDEFINED, text, &card.place, "");
                continue;
            };
            let material = known.name.value.clone();
            let orientation = card.get("ORIENTATION").map(compared);
            let orientation = orientation.and_then(|name| match orientations.get(&name) {
                Some(found) => found.clone(),
                None => {
                    let text = format!("there is no orientation `{name}`");
                    self.error(&codes::UNDEFINED, text, &card.place, "");
                    None
                }
            });
            if let Some(row) = card.rows().next().filter(|row| !row.is_empty())
                && self.is_plane()
                && self.case.model.space.value != Space::Axisymmetric
            {
                let given = self.real(row.first());
                match thickness {
                    Some(first) if first != given => {
                        let text = "sections of different thickness are not supported";
                        let remark = format!("the first one is {first}");
                        self.error(&codes::NOT_BUILT, text, &card.place, remark);
                    }
                    _ => thickness = Some(given),
                }
            }
            let directory = &self.deck.directory;
            let sets: Vec<String> = (directory.spaces(card.scope).iter())
                .filter_map(|&space| directory.set(space, Kind::Elements, elset))
                .map(str::to_owned)
                .collect();
            if sets.is_empty() {
                self.set(card, elset, &card.place, Kind::Elements);
            }
            for set in sets {
                self.body(card, &set, &material, orientation.as_ref());
            }
        }
        self.case.model.thickness = thickness.unwrap_or(1.0);
    }

    /// The bodies of a section: one, or one for each way its elements are integrated.
    fn body(&mut self, card: &Statement, set: &str, material: &str, turned: Option<&Orientation>) {
        let mut ways: BTreeMap<(bool, bool, bool), Vec<u64>> = BTreeMap::new();
        for label in self.elements(&Target::Set(set.to_owned())) {
            let Some(cell) = self.cell(label) else {
                continue;
            };
            let kind = self.type_of(cell);
            let digits = kind.trim_start_matches(|c: char| c.is_ascii_uppercase());
            let reduced = kind.ends_with('R') || kind.ends_with("RH") || kind.ends_with("RT");
            let linear = ["C3D8", "CPS4", "CPE4", "CAX4"]
                .iter()
                .any(|l| kind.starts_with(l));
            let modes = linear && digits.contains('I');
            ways.entry((reduced, modes, linear))
                .or_default()
                .push(label);
        }
        let several = ways.len() > 1;
        for ((reduced, modes, linear), elements) in ways {
            let group = if several {
                self.elements_named(elements, &card.place)
            } else {
                Spanned::new(set.to_owned(), card.place.clone())
            };
            self.case.bodies.push(Body {
                groups: vec![group],
                material: Some(Spanned::new(material.to_owned(), card.place.clone())),
                integration: if reduced && !linear {
                    Integration::Reduced
                } else {
                    Integration::Full
                },
                locking: Spanned::new(locking(reduced, modes, linear), card.place.clone()),
                orientation: turned.cloned(),
                area: None,
                rigid: false,
                reference: None,
                place: card.place.clone(),
            });
        }
    }

    /// Axes of materials; nothing for those that are not supported, which have been told of.
    fn orientations(&mut self) -> BTreeMap<String, Option<Orientation>> {
        let mut all = BTreeMap::new();
        for card in self.cards("ORIENTATION") {
            let Some(name) = self.need(card, "NAME") else {
                continue;
            };
            let cylindrical = card
                .get("SYSTEM")
                .map(compared)
                .is_some_and(|s| s.starts_with('C'));
            let numbers: Vec<_> = card.rows().next().unwrap_or_default();
            let [a, b, c, d, e, f] = self.reals(&numbers);
            let system = AxesSystem::Rectangular {
                x: [a, b, c],
                xy: [d, e, f],
            };
            let orientation = if cylindrical {
                let text = "cylindrical *ORIENTATION is not supported";
                self.error(&codes::NOT_BUILT, text, &card.place, "");
                None
            } else if system.at(Vec3::ZERO).is_none() {
                let text = "the two points of *ORIENTATION give no axes";
                self.error(&codes::OUT_OF_RANGE, text, &card.place, "");
                None
            } else {
                Some(Orientation {
                    x: [a, b, c],
                    y: [d, e, f],
                    place: card.place.clone(),
                })
            };
            all.insert(compared(name), orientation);
        }
        all
    }
}

/// What is done against locking, as the type of the element says: `C3D8I` has incompatible modes, `C3D8R` is not built
/// with one point and takes what suits it best.
const fn locking(reduced: bool, modes: bool, linear: bool) -> Locking {
    match (modes, reduced && linear) {
        (true, _) => Locking::Incompatible,
        (_, true) => Locking::Auto,
        _ => Locking::None,
    }
}

fn case_of(of: Properties) -> Option<Material> {
    let (model, constants) = of.law?;
    Some(Material {
        name: of.name,
        model: model.into(),
        constants: (constants.into_iter())
            .map(|(name, value)| Constant {
                name,
                values: vec![value].into(),
            })
            .collect(),
        density: of.density.map(Spanned::from),
        expansion: of.alpha.map(|(alpha, zero)| Expansion {
            alpha,
            reference: zero.unwrap_or(0.0).into(),
        }),
        plasticity: of.plasticity,
        place: of.place,
    })
}

/// Young's moduli, Poisson's ratios and shear moduli of the stiffnesses
/// `D1111, D1122, D2222, D1133, D2233, D3333, D1212, D1313, D2323`; none where they have no inverse.
fn engineering(d: [f64; 9]) -> Option<[f64; 9]> {
    let [a, h, b, g, f, c, g12, g13, g23] = d;
    // the inverse of [a h g; h b f; g f c] by cofactors
    let cofactors = [b * c - f * f, g * f - h * c, h * f - b * g];
    let determinant = a * cofactors[0] + h * cofactors[1] + g * cofactors[2];
    if determinant.abs() <= 1e-14 * (a * b * c).abs() {
        return None;
    }
    let s11 = cofactors[0] / determinant;
    let s12 = cofactors[1] / determinant;
    let s13 = cofactors[2] / determinant;
    let s22 = (a * c - g * g) / determinant;
    let s23 = (g * h - a * f) / determinant;
    let s33 = (a * b - h * h) / determinant;
    let ratios = [-s12 / s11, -s13 / s11, -s23 / s22];
    let all = [
        1.0 / s11,
        1.0 / s22,
        1.0 / s33,
        ratios[0],
        ratios[1],
        ratios[2],
        g12,
        g13,
        g23,
    ];
    all.iter().all(|x| x.is_finite()).then_some(all)
}
