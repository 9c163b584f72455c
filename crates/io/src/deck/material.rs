//! Materials: their constants, density, expansion, yield stresses.

use super::forms::needs_data;
use super::heat::HeatProperties;
use super::translation::Translation;
use crate::case::{
    Constant, Expansion, Hardening, Material, MaterialDamping, Name, Plasticity, Unstrained,
};
use crate::diagnostic::{Place, Spanned, codes};
use crate::readers::inp::{Field, Statement, compared};

/// Constants of a law, by their names in a case.
pub(super) type Constants = Vec<(&'static str, Vec<f64>)>;

/// What is known of a material.
#[derive(Clone, Debug, Default)]
pub(super) struct Properties {
    pub name: Name,
    law: Option<(&'static str, Constants)>,
    /// Where its law is given.
    of_law: Place,
    /// Whether a card of a law has been refused.
    is_refused: bool,
    density: Option<Spanned<f64>>,
    expansion: Option<Expansion>,
    plasticity: Option<Plasticity>,
    pub heat: HeatProperties,
    place: Place,
}

impl Properties {
    /// Whether its stiffness is known.
    pub fn has_law(&self) -> bool {
        self.law.is_some()
    }

    /// Whether the law that it was to have has been reported.
    pub fn is_refused(&self) -> bool {
        self.is_refused
    }

    /// The first elastic constant.
    pub fn modulus(&self) -> Option<f64> {
        let (_, constants) = self.law.as_ref()?;
        let (_, first) = constants.iter().find(|(name, _)| *name != "T")?;
        first.first().copied()
    }
}

impl Translation<'_> {
    pub fn materials(&mut self) {
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
                "ELASTIC"
                | "DENSITY"
                | "EXPANSION"
                | "PLASTIC"
                | "HYPERELASTIC"
                | "HYPERFOAM"
                | "USERMATERIAL"
                | "CONDUCTIVITY"
                | "SPECIFICHEAT"
                | "LATENTHEAT"
                | "DEFORMATIONPLASTICITY" => {
                    let Some(mut material) = open.take() else {
                        let text = format!("*{} stands in no *MATERIAL", card.title);
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
        self.named_twice("MATERIAL");
        self.strains_of_deformation_plasticity();
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
            if !needs_data(card) {
                let text = format!("*{} has no data", card.title);
                self.error(&codes::MISSING, text, &card.place, "");
            }
            return;
        };
        let kind = card.get("TYPE").map(compared).unwrap_or_default();
        let is_of_heat =
            ["CONDUCTIVITY", "SPECIFICHEAT", "LATENTHEAT"].contains(&card.keyword.as_str());
        if is_of_heat {
            self.heat_property(card, &mut material.heat, &rows);
            return;
        }
        if !["DENSITY", "EXPANSION", "PLASTIC"].contains(&card.keyword.as_str()) {
            material.of_law = first.first().map_or(card.place.clone(), Field::place);
        }
        match card.keyword.as_str() {
            "DENSITY" => {
                let density = self.real(first.first());
                let place = first.first().map_or(card.place.clone(), Field::place);
                if density < 0.0 {
                    let text = format!("the density of `{}` is {density}", material.name.value);
                    self.error(&codes::OUT_OF_RANGE, text, &place, "not negative");
                }
                if rows.iter().any(|row| self.real(row.first()) != density) {
                    let text = "a density that depends on temperature is not supported";
                    self.error(&codes::NOT_BUILT, text, &card.place, "");
                }
                material.density = Some(Spanned::new(density, place));
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
                let start = rows.first().and_then(|row| row.first());
                if let (Some(row), Some(start)) = (table.first(), start)
                    && row[0] <= 0.0
                {
                    let text = "the yield stress of *PLASTIC has to be positive";
                    self.error(&codes::OUT_OF_RANGE, text, &start.place(), "");
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
            "USERMATERIAL" => {
                let law = self.user_law(card, &material.name, &rows);
                material.is_refused |= law.is_none();
                material.law = law.or(material.law.take());
            }
            "DEFORMATIONPLASTICITY" => {
                let law = self.deformation_plasticity(card, &rows);
                material.law = law.or(material.law.take());
            }
            _ => material.law = self.hyperelastic(card, &rows).or(material.law.take()),
        }
    }

    /// What *HYPERFOAM says: pairs of modulus and exponent, then a Poisson's ratio of each.
    fn foam(
        &mut self,
        card: &Statement,
        rows: &[Vec<Field<'_>>],
    ) -> Option<(&'static str, Constants)> {
        let Some(order) = terms(card, 3) else {
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
    pub(super) fn elastic(
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
        let zero = self.parameter(card, "ZERO", "ZERO");
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
            free: Unstrained::At(reference).into(),
        })
    }

    /// What *HYPERELASTIC says, of the kinds that are sums over powers of stretches.
    fn hyperelastic(
        &mut self,
        card: &Statement,
        rows: &[Vec<Field<'_>>],
    ) -> Option<(&'static str, Constants)> {
        let all: Vec<_> = rows.iter().flatten().cloned().collect();
        let mut numbers = all.iter().map(|field| self.real(Some(field)));
        let mut next = || numbers.next().unwrap_or(0.0);
        let (law, mut constants, shear): (_, Constants, f64) = match terms(card, 4) {
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
            Some(1)
                if card.has("MOONEY-RIVLIN")
                    || card.has("POLYNOMIAL")
                    || !card.has("ARRUDA-BOYCE") && !card.has("YEOH") =>
            {
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
}

fn case_of(of: Properties) -> Option<Material> {
    let heat = of.heat.case_of(of.density.is_some());
    // without a law it conducts alone
    if of.law.is_none() && heat.is_none() {
        return None;
    }
    let (model, constants) = of.law.unwrap_or_default();
    Some(Material {
        name: of.name,
        model: model.into(),
        constants: (constants.into_iter())
            .map(|(name, values)| Constant {
                name,
                values: Spanned::new(values, of.of_law.clone()),
            })
            .collect(),
        own: None,
        density: of.density,
        damping: MaterialDamping::default(),
        expansion: of.expansion,
        heat,
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

/// The number of terms of a law, one unless N says otherwise; none where there are more than so many.
fn terms(card: &Statement, most: usize) -> Option<usize> {
    let order = card.get("N").map_or(Some(1), |n| n.parse().ok());
    order.filter(|order| (1..=most).contains(order))
}
