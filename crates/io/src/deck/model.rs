//! Materials, sections, amplitudes, temperatures at the start.

use super::constraint::Axes;
use super::translation::{Target, Translation};
use crate::case::{
    Amplitude, AtPoint, Body, Constant, Expansion, Hardening, Integration, Locking, Material,
    Model, Name, Orientation, Plasticity, Space, Temperatures, TimeBase,
};
use crate::diagnostic::{Place, Spanned, codes};
use crate::readers::inp::{Field, Kind, Statement, compared, number};
use std::collections::BTreeMap;

/// Constants of a law, by their names in a case.
type Constants = Vec<(&'static str, Vec<f64>)>;

/// What is known of a material.
#[derive(Clone, Debug, Default)]
pub(super) struct Properties {
    name: Name,
    law: Option<(&'static str, Constants)>,
    density: Option<f64>,
    expansion: Option<Expansion>,
    plasticity: Option<Plasticity>,
    place: Place,
}

/// Elements whose integration points are numbered as ours are.
const POINTWISE: [&str; 5] = ["C3D4", "C3D8", "C3D8I", "C3D20", "C3D20R"];

impl Properties {
    /// The first elastic constant.
    pub fn modulus(&self) -> Option<f64> {
        let (_, constants) = self.law.as_ref()?;
        let (_, first) = constants.iter().find(|(name, _)| *name != "T")?;
        first.first().copied()
    }
}

impl Translation<'_> {
    pub fn model(&mut self) {
        self.title();
        self.space();
        self.materials();
        self.start_temperature();
        self.at_start();
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
                "ELASTIC" | "DENSITY" | "EXPANSION" | "PLASTIC" | "HYPERELASTIC" | "HYPERFOAM" => {
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
            if let (Some((law, _)), Some(_)) = (&material.law, &material.plasticity)
                && *law != "linear-elastic"
            {
                let text = format!("*PLASTIC does not go with {law} constants");
                self.error(
                    &codes::NOT_BUILT,
                    text,
                    &material.place,
                    "isotropic ones, at one temperature",
                );
            }
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
            "DENSITY" => {
                let density = self.real(first.first());
                if rows.iter().any(|row| self.real(row.first()) != density) {
                    let text = "a density that depends on temperature is not supported";
                    self.error(&codes::NOT_BUILT, text, &card.place, "");
                }
                material.density = Some(density);
            }
            "ELASTIC" => material.law = self.elastic(card, &kind, &rows).or(material.law.take()),
            "EXPANSION" => material.expansion = self.expansion(card, &kind, &rows),
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
            "HYPERFOAM" => material.law = self.foam(card, &rows).or(material.law.take()),
            _ => material.law = self.hyperelastic(card, &rows).or(material.law.take()),
        }
    }

    /// What *HYPERFOAM says: pairs of modulus and exponent, then a Poisson's ratio of each.
    fn foam(
        &mut self,
        card: &Statement,
        rows: &[Vec<Field<'_>>],
    ) -> Option<(&'static str, Constants)> {
        let order = card.get("N").map_or(Some(1), |n| n.parse::<usize>().ok());
        let Some(order) = order.filter(|order| (1..=3).contains(order)) else {
            let text = "*HYPERFOAM has one to three terms, N";
            self.error(&codes::OUT_OF_RANGE, text, &card.place, "");
            return None;
        };
        let all: Vec<_> = rows.iter().flatten().cloned().collect();
        let mut number = |at: usize| self.real(all.get(at));
        let mu = (0..order).map(|k| number(2 * k)).collect();
        let alpha = (0..order).map(|k| number(2 * k + 1)).collect();
        let nu = (0..order).map(|k| number(2 * order + k)).collect();
        Some(("hyperfoam", vec![("mu", mu), ("alpha", alpha), ("nu", nu)]))
    }

    /// What *ELASTIC says.
    fn elastic(
        &mut self,
        card: &Statement,
        kind: &str,
        rows: &[Vec<Field<'_>>],
    ) -> Option<(&'static str, Constants)> {
        if kind.is_empty() || "ISOTROPIC".starts_with(kind) {
            let mut table: Vec<[f64; 3]> = rows.iter().map(|row| self.reals(row)).collect();
            let [e, nu, _] = *table.first()?;
            if table.iter().all(|row| row[..2] == [e, nu]) {
                return Some(("linear-elastic", vec![("E", vec![e]), ("nu", vec![nu])]));
            }
            table.sort_by(|a, b| a[2].total_cmp(&b[2]));
            let column = |i: usize| table.iter().map(|row| row[i]).collect();
            let constants = vec![("T", column(2)), ("E", column(0)), ("nu", column(1))];
            return Some(("linear-elastic-by-temperature", constants));
        }
        let anisotropic = "ANISOTROPIC".starts_with(kind);
        // eight constants fill a row
        let per_temperature = if anisotropic { 3 } else { 2 };
        if rows.len() > per_temperature {
            let remark = "take the constants at the temperature that matters";
            let text =
                "constants in several directions that depend on temperature are not supported";
            self.error(&codes::NOT_BUILT, text, &card.place, remark);
        }
        let all: Vec<_> = rows.iter().flatten().cloned().collect();
        if anisotropic {
            let d: [f64; 21] = self.reals(&all);
            return Some(("anisotropic", vec![("D", d.to_vec())]));
        }
        let c: [f64; 9] = self.reals(&all);
        let law = if kind.starts_with("ENGINEERING") {
            Some(c)
        } else if "ORTHOTROPIC".starts_with(kind) {
            engineering(c)
        } else {
            let text = format!("*ELASTIC, TYPE={kind} is not supported");
            let remark = "isotropic, ORTHO, ENGINEERING CONSTANTS and ANISO are";
            self.error(&codes::NOT_BUILT, text, &card.place, remark);
            return None;
        };
        let names = [
            "E1", "E2", "E3", "nu12", "nu13", "nu23", "G12", "G13", "G23",
        ];
        let Some(c) = law else {
            let text = "these elastic constants have no compliance";
            self.error(&codes::OUT_OF_RANGE, text, &card.place, "");
            return None;
        };
        let constants = names.into_iter().zip(c.map(|value| vec![value]));
        Some(("orthotropic", constants.collect()))
    }

    /// What *EXPANSION says: a secant from ZERO on.
    fn expansion(
        &mut self,
        card: &Statement,
        kind: &str,
        rows: &[Vec<Field<'_>>],
    ) -> Option<Expansion> {
        if !kind.is_empty() && !"ISOTROPIC".starts_with(kind) {
            let text = "expansion that depends on direction is not supported";
            self.error(&codes::NOT_BUILT, text, &card.place, "");
            return None;
        }
        let zero = card.get("ZERO").map(|text| {
            number(text).unwrap_or_else(|| {
                let text = "ZERO is no number";
                self.error(&codes::NOT_A_NUMBER, text, &card.place, "");
                0.0
            })
        });
        let reference = zero.unwrap_or(0.0);
        let mut alpha: Vec<[f64; 2]> = Vec::new();
        for row in rows {
            let [value, temperature]: [f64; 2] = self.reals(row);
            alpha.push([temperature, value]);
        }
        alpha.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let first = alpha.first().map_or(0.0, |row| row[1]);
        if alpha.iter().all(|row| row[1] == first) {
            alpha = vec![[reference, first]];
        }
        Some(Expansion {
            alpha,
            reference,
            free: reference.into(),
        })
    }

    /// What *HYPERELASTIC says, of the kinds that are sums over powers of stretches.
    fn hyperelastic(
        &mut self,
        card: &Statement,
        rows: &[Vec<Field<'_>>],
    ) -> Option<(&'static str, Constants)> {
        let order = card.get("N").map_or(Some(1), |n| n.parse::<usize>().ok());
        let order = order.filter(|order| (1..=4).contains(order));
        let all: Vec<_> = rows.iter().flatten().cloned().collect();
        let mut numbers = all.iter().map(|field| self.real(Some(field)));
        let mut next = || numbers.next().unwrap_or(0.0);
        let (law, mut constants, shear): (_, Constants, f64) = match order {
            Some(1) if card.has("NEOHOOKE") || card.has("REDUCEDPOLYNOMIAL") => {
                let c10 = next();
                (
                    "mooney-rivlin",
                    vec![("c10", vec![c10]), ("c01", vec![0.0])],
                    2.0 * c10,
                )
            }
            Some(order) if card.has("OGDEN") => {
                let terms: Vec<(f64, f64)> = (0..order).map(|_| (next(), next())).collect();
                let (mu, alpha): (Vec<f64>, Vec<f64>) = terms.into_iter().unzip();
                let shear = mu.iter().sum();
                ("ogden", vec![("mu", mu), ("alpha", alpha)], shear)
            }
            // polynomial is the default
            Some(1) if !card.has("ARRUDA-BOYCE") && !card.has("YEOH") => {
                let (c10, c01) = (next(), next());
                let constants = vec![("c10", vec![c10]), ("c01", vec![c01])];
                ("mooney-rivlin", constants, 2.0 * (c10 + c01))
            }
            _ => {
                let text = "this kind of *HYPERELASTIC is not supported";
                let remark = "NEO HOOKE, MOONEY-RIVLIN and OGDEN are";
                self.error(&codes::NOT_BUILT, text, &card.place, remark);
                return None;
            }
        };
        // W = … + (J − 1)²/D1 + (J − 1)⁴/D2 + …: the bulk modulus is 2/D1
        let d1 = next();
        let higher = numbers.any(|d| d != 0.0);
        if higher && law == "ogden" {
            let text = "only the first of the coefficients D of *HYPERELASTIC is supported";
            self.error(&codes::NOT_BUILT, text, &card.place, "");
        }
        if d1 < 0.0 || shear <= 0.0 {
            let text = "the initial shear modulus has to be positive, D1 positive or zero";
            self.error(&codes::OUT_OF_RANGE, text, &card.place, "");
            return None;
        }
        let bulk = if d1 > 0.0 {
            2.0 / d1
        } else {
            let text = "D1 = 0 stands for a Poisson's ratio of 0.475, as in CalculiX";
            self.note(text, &card.place);
            const NU: f64 = 0.475;
            2.0 * shear * (1.0 + NU) / (3.0 * (1.0 - 2.0 * NU))
        };
        constants.push(("bulk", vec![bulk]));
        Some((law, constants))
    }

    /// Stress and strain at integration points.
    fn at_start(&mut self) {
        for card in self.cards("INITIALCONDITIONS") {
            let kind = card.get("TYPE").map(compared).unwrap_or_default();
            if kind == "TEMPERATURE" {
                continue;
            }
            let is_stress = kind == "STRESS";
            if !is_stress && kind != "PLASTICSTRAIN" || card.has("USER") {
                let user = if card.has("USER") { ", USER" } else { "" };
                let text = format!("*INITIAL CONDITIONS, TYPE={kind}{user} is not supported");
                self.error(&codes::NOT_BUILT, text, &card.place, "");
                continue;
            }
            if !is_stress && self.case.materials.iter().any(|m| m.plasticity.is_some()) {
                let text = "an initial plastic strain does not go with *PLASTIC";
                let remark = "its hardening is not known";
                self.error(&codes::NOT_BUILT, text, &card.place, remark);
            }
            for row in card.rows().filter(|row| !row.is_empty()) {
                let targets = self.targets(card, row.first(), Kind::Elements);
                let point = self.count(row.get(1), 1);
                let value: [f64; 6] = self.reals(row.get(2..).unwrap_or_default());
                let place = row.first().map_or(card.place.clone(), Field::place);
                let elements = targets.iter().flat_map(|target| self.elements(target));
                for element in elements.collect::<Vec<_>>() {
                    let kind = self.cell(element).map(|cell| self.type_of(cell));
                    if !kind.is_some_and(|kind| POINTWISE.contains(&kind)) {
                        let text = "values at the points of this element are not supported";
                        let remark = format!("of {} they are", POINTWISE.join(", "));
                        self.error(&codes::NOT_BUILT, text, &place, remark);
                        break;
                    }
                    let points = if is_stress {
                        &mut self.case.initial_stress
                    } else {
                        &mut self.case.initial_strain
                    };
                    points.push(AtPoint {
                        element,
                        point,
                        value,
                        place: place.clone(),
                    });
                }
            }
        }
    }

    fn start_temperature(&mut self) {
        let mut found: Option<(f64, Place)> = None;
        for card in self.cards("INITIALCONDITIONS") {
            let kind = card.get("TYPE").map(compared).unwrap_or_default();
            if kind != "TEMPERATURE" {
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
                expansion.free.value = start;
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
            Some(name) => {
                let name = self.delayed(card, name);
                Some(Spanned::new(name, card.place.clone()))
            }
            None => {
                let text = format!("there is no amplitude `{wanted}`");
                self.error(&codes::UNDEFINED, text, &card.place, "");
                None
            }
        }
    }

    /// The amplitude that is this one later, where a card has a TIME DELAY.
    fn delayed(&mut self, card: &Statement, name: String) -> String {
        let Some(text) = card.get("TIMEDELAY") else {
            return name;
        };
        let Some(delay) = number(text) else {
            let text = "TIME DELAY is no number";
            self.error(&codes::NOT_A_NUMBER, text, &card.place, "");
            return name;
        };
        let mut all = self.case.amplitudes.iter();
        let Some(known) = all.find(|one| *one.name == name).cloned() else {
            return name;
        };
        let table: Vec<[f64; 2]> = known.table.iter().map(|[t, a]| [t + delay, *a]).collect();
        let mut all = self.case.amplitudes.iter();
        let same = |one: &&Amplitude| one.table == table && one.time == known.time;
        if let Some(same) = all.find(same) {
            return same.name.value.clone();
        }
        let name = self.fresh(&format!("{name}-delayed"));
        self.case.amplitudes.push(Amplitude {
            name: Spanned::new(name.clone(), card.place.clone()),
            table,
            ..known
        });
        name
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
            let mut own = None;
            if let Some(row) = card.rows().next().filter(|row| !row.is_empty())
                && self.case.model.space.value.has_thickness()
            {
                let given = self.real(row.first());
                let of_model = *thickness.get_or_insert(given);
                own = (given != of_model).then(|| Spanned::new(given, card.place.clone()));
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
                self.body(card, &set, &material, orientation.as_ref(), own.as_ref());
            }
        }
        self.case.model.thickness = thickness.unwrap_or(1.0);
    }

    /// The bodies of a section: one, or one for each way its elements are integrated.
    fn body(
        &mut self,
        card: &Statement,
        set: &str,
        material: &str,
        turned: Option<&Orientation>,
        thickness: Option<&Spanned<f64>>,
    ) {
        let mut ways: BTreeMap<(bool, bool, bool, bool), Vec<u64>> = BTreeMap::new();
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
            // CalculiX interpolates temperatures of these linearly, those of C3D10 not
            let corners = ["C3D20", "CPS8", "CPE8", "CAX8"]
                .iter()
                .any(|l| kind.starts_with(l));
            ways.entry((reduced, modes, linear, corners))
                .or_default()
                .push(label);
        }
        let several = ways.len() > 1;
        for ((reduced, modes, linear, corners), elements) in ways {
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
                thickness: thickness.cloned(),
                temperatures: if corners {
                    Temperatures::Corners
                } else {
                    Temperatures::Nodes
                },
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
            let orientation = if cylindrical {
                let text = "cylindrical *ORIENTATION is not supported";
                self.error(&codes::NOT_BUILT, text, &card.place, "");
                None
            } else if Axes::new([a, b, c], [d, e, f]).is_none() {
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
            .map(|(name, values)| Constant {
                name,
                values: values.into(),
            })
            .collect(),
        density: of.density.map(Spanned::from),
        expansion: of.expansion,
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
