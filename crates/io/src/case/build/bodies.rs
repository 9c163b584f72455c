//! Materials, bodies, springs, constraints.

use std::collections::BTreeSet;

use signorini_vocabulary::Description;
use toml::Spanned as Ranged;
use toml::de::DeValue;

use super::super::check::id;
use super::super::fields::{Fields, numbers};
use super::super::parts::*;
use super::super::scalar::number;
use super::super::vocabulary::OWN;
use super::builder::Builder;
use crate::diagnostic::{Diagnostic, Place, Spanned, codes, listed};

impl Builder<'_> {
    pub(super) fn material(&mut self, name: Name, fields: Fields<'_>, place: Place) -> Material {
        let model = fields.text("model");
        let law = self.vocabulary.material(&model.value).copied();
        if !fields.has("model") && !fields.has("conductivity") && !fields.has_unknown_key() {
            self.found.push(
                Diagnostic::error(
                    &codes::MISSING,
                    format!(
                        "[material.{}] has neither `model` nor `conductivity`",
                        name.value
                    ),
                )
                .at(&place, "`model` is missing here"),
            );
        }
        let constants = law
            .as_ref()
            .map(|law| self.constants(law, &name, fields, &place));
        let expansion = fields.table("expansion");
        let plasticity = fields.has("plasticity").then(|| {
            let table = fields.table("plasticity");
            if law.is_some_and(|law| law.name != "linear-elastic") {
                self.error(
                    &codes::CONTRADICTION,
                    format!("`plasticity` does not go with {}", model.value),
                    &fields.place("plasticity"),
                    "it needs  model = \"linear-elastic\"",
                );
            }
            self.plasticity(table)
        });
        Material {
            name,
            constants: constants.unwrap_or_default(),
            own: fields.text_if(OWN),
            density: fields.number_if("density"),
            damping: MaterialDamping {
                mass: fields.table("damping").number("mass"),
                stiffness: fields.table("damping").number("stiffness"),
            },
            expansion: fields.has("expansion").then(|| self.expansion(expansion)),
            heat: self.conduction(fields),
            plasticity,
            model,
            place,
        }
    }

    /// The constants of a law: all of them, and no others.
    fn constants(
        &mut self,
        law: &Description,
        name: &Name,
        fields: Fields<'_>,
        place: &Place,
    ) -> Vec<Constant> {
        let takes = || listed(law.keys.iter().map(|key| key.name));
        let missing = law.keys.iter().filter(|key| !fields.has(key.name));
        let missing: Vec<String> = missing.map(|key| format!("`{}`", key.name)).collect();
        if !missing.is_empty() && !fields.has_unknown_key() {
            let what = missing.join(", ");
            let are = if missing.len() == 1 { "is" } else { "are" };
            self.found.push(
                Diagnostic::error(
                    &codes::MISSING,
                    format!("[material.{}] has no {what}", name.value),
                )
                .at(place, format!("{what} {are} missing here"))
                .note(format!("{} takes: {}", law.name, takes())),
            );
        }
        let constants = self.vocabulary.materials().iter().flat_map(|law| law.keys);
        let constants: BTreeSet<&str> = constants.map(|key| key.name).collect();
        for key in constants {
            if fields.has(key) && law.keys.iter().all(|own| own.name != key) {
                self.error(
                    &codes::CONTRADICTION,
                    format!("`{key}` is no constant of {}", law.name),
                    &fields.place(key),
                    format!("{} takes: {}", law.name, takes()),
                );
            }
        }
        let given = law.keys.iter().filter_map(|key| {
            let values = fields.numbers_if(key.name)?;
            let name = key.name;
            Some(Constant { name, values })
        });
        given.collect()
    }

    fn expansion(&mut self, fields: Fields<'_>) -> Expansion {
        let reference = fields.number_if("reference");
        let reference = reference.unwrap_or_else(|| fields.number("reference").into());
        let mut alpha: Vec<[f64; 2]> = match fields.number_if("alpha") {
            Some(alpha) => vec![[reference.value, alpha.value]],
            None => Vec::new(),
        };
        for row in fields.rows("alpha") {
            let Some(pair) = numbers::<2>(row.get_ref()) else {
                continue;
            };
            if alpha.last().is_some_and(|before| pair[0] <= before[0]) {
                self.error(
                    &codes::NOT_INCREASING,
                    "the temperatures of `alpha` do not increase",
                    &fields.at(row.span()),
                    "rows [temperature, alpha]",
                );
                break;
            }
            alpha.push(pair);
        }
        Expansion {
            alpha,
            free: unstrained(fields, &reference),
            reference: reference.value,
        }
    }

    /// How a material conducts and stores heat.
    fn conduction(&mut self, fields: Fields<'_>) -> Option<Conduction> {
        for key in ["specific_heat", "latent_heat"] {
            for needed in ["conductivity", "density"] {
                if fields.has(key) && !fields.has(needed) {
                    self.error(
                        &codes::MISSING,
                        format!("`{key}` without `{needed}`"),
                        &fields.place(key),
                        format!("write  {needed} = "),
                    );
                }
            }
        }
        if !fields.has("conductivity") {
            return None;
        }
        let of = fields.table("conductivity");
        let along = of.row::<3>("along").and_then(|row| {
            let [a, b, c] = row.map(|value| number(value.get_ref()));
            Some([a?, b?, c?])
        });
        let conductivity = match along {
            Some(along) => Conductivity::Along(along),
            None if of.has("rows") => Conductivity::Full(self.increasing(of, "rows")),
            None => Conductivity::Isotropic(self.constant_or_rows(fields, "conductivity")),
        };
        Some(Conduction {
            conductivity,
            specific_heat: self.constant_or_rows(fields, "specific_heat"),
            latent_heat: (fields.rows("latent_heat"))
                .filter_map(|row| numbers(row.get_ref()))
                .collect(),
            place: fields.place("conductivity"),
        })
    }

    /// A number, or rows of temperature and number.
    fn constant_or_rows(&mut self, fields: Fields<'_>, key: &'static str) -> Vec<[f64; 2]> {
        match fields.number_if(key) {
            Some(number) => vec![[0.0, number.value]],
            None => self.increasing(fields, key),
        }
    }

    /// Rows whose first numbers increase.
    pub(super) fn increasing<const N: usize>(
        &mut self,
        fields: Fields<'_>,
        key: &'static str,
    ) -> Vec<[f64; N]> {
        let mut rows: Vec<[f64; N]> = Vec::new();
        for row in fields.rows(key) {
            let Some(values) = numbers::<N>(row.get_ref()) else {
                continue;
            };
            if let Some(before) = rows.last().filter(|before| values[0] <= before[0]) {
                let remark = format!("{} comes after {}", values[0], before[0]);
                self.error(
                    &codes::NOT_INCREASING,
                    format!("the first numbers of the rows of `{key}` do not increase"),
                    &fields.at(row.span()),
                    remark,
                );
                break;
            }
            rows.push(values);
        }
        rows
    }

    fn plasticity(&mut self, fields: Fields<'_>) -> Plasticity {
        let word = fields.text("hardening");
        let hardening = match word.value.as_str() {
            "kinematic" => Hardening::Kinematic,
            "combined" => Hardening::Combined,
            _ => Hardening::Isotropic,
        };
        let modulus = fields.number_if("modulus");
        match (&modulus, hardening) {
            (None, Hardening::Combined) => self.error(
                &codes::MISSING,
                "combined hardening has no `modulus`",
                &word.place,
                "add the kinematic hardening modulus:  modulus = ",
            ),
            (Some(modulus), Hardening::Isotropic | Hardening::Kinematic) => self.error(
                &codes::CONTRADICTION,
                "`modulus` belongs to combined hardening",
                &modulus.place,
                "delete it, or write  hardening = \"combined\"",
            ),
            _ => {}
        }
        let table = self.yield_stresses(fields);
        Plasticity {
            hardening: Spanned::new(hardening, word.place),
            table: Spanned::new(table, fields.place("table")),
            modulus,
        }
    }

    /// Rows of stress and plastic strain; strains begin with zero and increase.
    fn yield_stresses(&mut self, fields: Fields<'_>) -> Vec<[f64; 2]> {
        let mut table: Vec<[f64; 2]> = Vec::new();
        for row in fields.rows("table") {
            let Some([stress, strain]) = numbers(row.get_ref()) else {
                continue;
            };
            let fault = match table.last() {
                None if strain != 0.0 => Some("the first row is that of plastic strain 0".into()),
                Some([_, before]) if strain <= *before => {
                    Some(format!("{strain} comes after {before}"))
                }
                _ => None,
            };
            if let Some(fault) = fault {
                self.error(
                    &codes::NOT_INCREASING,
                    "the plastic strains of `table` do not increase from 0 on",
                    &fields.at(row.span()),
                    fault,
                );
                break;
            }
            table.push([stress, strain]);
        }
        table
    }

    pub(super) fn body(&mut self, fields: Fields<'_>, place: Place) -> Body {
        let rigid = fields.flag("rigid");
        let groups = fields.texts("group");
        let name = groups.first().map_or("", |group| group.value.as_str());
        if !rigid && !fields.has("material") && !fields.has_unknown_key() {
            self.found.push(
                Diagnostic::error(
                    &codes::MISSING,
                    format!("body \"{name}\" has no `material`"),
                )
                .at(&place, "`material` is missing here")
                .help("write  material = \"NAME\"  of a [material.NAME], or  rigid = true"),
            );
        }
        let of_solids = [
            "integration",
            "locking",
            "orientation",
            "space",
            "thickness",
            "shell",
            "temperatures",
            "at_nodes",
            "area",
            "strain",
            "mass_matrix",
            "capacity",
        ];
        let wrong = if rigid {
            &of_solids[..]
        } else {
            &["reference"]
        };
        for key in wrong.iter().filter(|key| fields.has(key)) {
            let (what, remark) = if rigid {
                ("a rigid body", "delete it, or  rigid = true")
            } else {
                ("a body that deforms", "delete it, or write  rigid = true")
            };
            self.error(
                &codes::CONTRADICTION,
                format!("`{key}` means nothing for {what}"),
                &fields.place(key),
                remark,
            );
        }
        let space = fields.text_if("space").map(|word| {
            let space = super::geometry::space(&word.value);
            Spanned::new(space, word.place)
        });
        self.plane(&fields, space.as_ref(), name);
        let shell = self.shell(&fields, name);
        let locking = fields.text("locking");
        Body {
            material: fields.text_if("material"),
            integration: match fields.text("integration").value.as_str() {
                "reduced" => Integration::Reduced,
                "raised" => Integration::Raised,
                _ => Integration::Full,
            },
            locking: Spanned::new(
                match locking.value.as_str() {
                    "none" => Locking::None,
                    "b-bar" => Locking::BBar,
                    "f-bar" => Locking::FBar,
                    "incompatible" => Locking::Incompatible,
                    "selective-shear" => Locking::Shear,
                    _ => Locking::Auto,
                },
                locking.place,
            ),
            orientation: self.body_axes(&fields),
            space,
            thickness: thickness(&fields),
            shell,
            temperatures: match fields.text("temperatures").value.as_str() {
                "linear" => Temperatures::Linear,
                _ => Temperatures::Full,
            },
            at_nodes: match fields.text("at_nodes").value.as_str() {
                "element" => AtNodes::Element,
                _ => AtNodes::Linear,
            },
            area: fields.number_if("area"),
            small_strain: fields.text("strain").value == "small",
            mass_matrix: match fields.text("mass_matrix").value.as_str() {
                "consistent" => MassMatrix::Consistent,
                "lumped" => MassMatrix::Lumped,
                _ => MassMatrix::Auto,
            },
            lumped_capacity: fields.text("capacity").value == "lumped",
            rigid,
            reference: fields.text_if("reference"),
            groups,
            place,
        }
    }

    /// What the plane of a body stands for goes with the model, and with its thickness.
    fn plane(&mut self, fields: &Fields<'_>, space: Option<&Spanned<Space>>, name: &str) {
        let of_body = space.map_or(self.space, |space| space.value);
        if let Some(space) = space
            && !self.space.goes_with(space.value)
        {
            let remark = match self.space {
                Space::ThreeD => "delete it: the model is in space",
                _ => {
                    "a slice that cannot stretch across its plane is no part of a ring: take plane-stress, or two cases"
                }
            };
            let message = format!(
                "body \"{name}\" is {} in a model that is {}",
                space.word(),
                self.space.word()
            );
            self.error(&codes::CONTRADICTION, message, &space.place, remark);
        }
        if fields.has("thickness") && !of_body.has_thickness() {
            self.error(
                &codes::CONTRADICTION,
                "`thickness` means something in plane strain and plane stress only",
                &fields.place("thickness"),
                "delete it",
            );
        }
        if let Some(space) = space
            && of_body.has_thickness()
            && self.space == Space::Axisymmetric
            && !fields.has("thickness")
        {
            self.error(
                &codes::MISSING,
                format!(
                    "body \"{name}\" has no `thickness`, and neither has a model of revolution"
                ),
                &space.place,
                "write the thickness of all such parts around the circumference together",
            );
        }
    }

    /// The axes of the material of a body, by name or in place.
    fn body_axes(&mut self, fields: &Fields<'_>) -> Option<BodyAxes> {
        if let Some(name) = fields.text_if("orientation") {
            return Some(BodyAxes::Named(name));
        }
        if !fields.has("orientation") {
            return None;
        }
        let of = fields.table("orientation");
        let place = fields.place("orientation");
        let [x, y] = self.plane_of(of, &place);
        Some(BodyAxes::Here(Orientation { x, y, place }))
    }

    /// Axes of materials with a name.
    pub(super) fn named_orientation(
        &mut self,
        name: Name,
        fields: Fields<'_>,
        place: Place,
    ) -> NamedOrientation {
        let kind = fields.text("kind").value;
        let (needed, others): (&[&str], &[&str]) = match kind.as_str() {
            "cylindrical" => (&["axis"], &["x", "y", "rows"]),
            "elements" => (&["rows"], &["origin", "axis"]),
            _ => (&["x", "y"], &["origin", "axis", "rows"]),
        };
        for key in needed.iter().filter(|key| !fields.has(key)) {
            let message = format!("orientation \"{}\" has no `{key}`", name.value);
            let remark = format!("kind = \"{kind}\" needs it");
            self.error(&codes::MISSING, message, &place, remark);
        }
        for key in others.iter().filter(|key| fields.has(key)) {
            let message = format!("`{key}` means nothing for a {kind} orientation");
            let remark = "delete it, or choose another kind";
            self.error(&codes::CONTRADICTION, message, &fields.place(key), remark);
        }
        let system = match kind.as_str() {
            "cylindrical" => {
                let axis = self.line(fields, "axis").unwrap_or_default();
                MaterialSystem::Cylindrical {
                    origin: self.vector(fields, "origin").unwrap_or_default(),
                    axis,
                }
            }
            "elements" => {
                let [x, y] = match fields.has("x") {
                    true => self.plane_of(fields, &place),
                    false => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
                };
                let rows = self.axes_of_elements(fields);
                MaterialSystem::Elements { x, y, rows }
            }
            _ => {
                let [x, y] = self.plane_of(fields, &place);
                MaterialSystem::Rectangular { x, y }
            }
        };
        let turn = fields.row::<2>("turn").and_then(|[axis, angle]| {
            let axis = usize::try_from(id(axis)?).ok()?.checked_sub(1)?;
            Some((axis, number(angle.get_ref())?))
        });
        NamedOrientation {
            name,
            system,
            turn,
            place,
        }
    }

    fn axes_of_elements(&mut self, fields: Fields<'_>) -> Vec<ElementAxes> {
        let mut all = Vec::new();
        for row in fields.rows("rows") {
            let Some([element, x, y]) = row.get_ref().as_array().map(|items| &**items) else {
                continue;
            };
            let place = fields.at(row.span());
            let mut vector = |item: &Ranged<DeValue<'_>>| {
                self.vector_at(item.get_ref(), fields.at(item.span()), "rows")
            };
            let (Some(element), Some(x), Some(y)) = (id(element), vector(x), vector(y)) else {
                continue;
            };
            self.spans_plane([x, y], &place);
            all.push(ElementAxes {
                element,
                x,
                y,
                place,
            });
        }
        all
    }

    /// The vectors `x` and `y` of axes, which may not be parallel.
    fn plane_of(&mut self, fields: Fields<'_>, place: &Place) -> [[f64; 3]; 2] {
        let x = self.vector(fields, "x").unwrap_or_default();
        let y = self.vector(fields, "y").unwrap_or_default();
        if fields.has("x") && fields.has("y") {
            self.spans_plane([x, y], place);
        }
        [x, y]
    }

    fn spans_plane(&mut self, [x, y]: [[f64; 3]; 2], place: &Place) {
        let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(&b).map(|(a, b)| a * b).sum::<f64>();
        let (xx, yy, xy) = (dot(x, x), dot(y, y), dot(x, y));
        // sin² of the angle between them
        if xx * yy - xy * xy <= 1e-12 * xx * yy {
            self.error(
                &codes::OUT_OF_RANGE,
                "the vectors of `orientation` span no plane",
                place,
                "`x` and `y` are parallel, or zero",
            );
        }
    }

    pub(super) fn spring(&mut self, fields: Fields<'_>, place: Place) -> Spring {
        let direction = self.line(fields, "direction");
        self.within(
            direction.unwrap_or_default(),
            "direction",
            &fields.place("direction"),
        );
        let ends = match <[Name; 2]>::try_from(fields.texts("between")) {
            Ok([one, other]) => SpringEnds::Between(one, other),
            Err(_) => SpringEnds::Ground(fields.text("on")),
        };
        let name = fields.text("name");
        if matches!(ends, SpringEnds::Ground(_)) && direction.is_none() && !fields.has("direction")
        {
            self.error(
                &codes::MISSING,
                format!("spring \"{}\" to the ground has no `direction`", name.value),
                &place,
                "there is no line between two ends: write  direction = \"x\"  or a vector",
            );
        }
        let law = match fields.number_if("stiffness") {
            Some(stiffness) => SpringLaw::Linear(stiffness.value),
            None => SpringLaw::Table(self.forces(fields)),
        };
        Spring {
            name,
            ends,
            law,
            direction,
            place,
        }
    }

    /// Rows of force and elongation: elongations increase, forces do not decrease.
    fn forces(&mut self, fields: Fields<'_>) -> Vec<[f64; 2]> {
        let mut table: Vec<[f64; 2]> = Vec::new();
        for row in fields.rows("table") {
            let Some([force, elongation]) = numbers(row.get_ref()) else {
                continue;
            };
            if let Some([before, at]) = table.last()
                && (elongation <= *at || force < *before)
            {
                self.error(
                    &codes::NOT_INCREASING,
                    "elongations do not increase, or forces decrease",
                    &fields.at(row.span()),
                    format!("[{force}, {elongation}] comes after [{before}, {at}]"),
                );
            }
            table.push([force, elongation]);
        }
        table
    }

    pub(super) fn constraint(&mut self, fields: Fields<'_>, place: Place) -> Constraint {
        let kind = fields.text("kind");
        if fields.has("equation") {
            return Constraint {
                kind: ConstraintKind::Equation {
                    terms: self.summands(fields),
                    rhs: fields.number("rhs"),
                },
                place,
            };
        }
        self.keys_of_constraint(fields, &kind, &place);
        let on = fields.text("on");
        let axes = if fields.has("dofs") {
            self.axes(fields)
        } else {
            Directions::ALL
        };
        let reference = fields.text("reference");
        let kind = match kind.value.as_str() {
            "kinematic" => ConstraintKind::Kinematic {
                on,
                reference,
                axes,
                local: fields
                    .has("local")
                    .then(|| self.axes_system(fields.table("local"))),
            },
            "distributing" => ConstraintKind::Distributing { on, reference },
            "plane" => ConstraintKind::Plane { on },
            "line" => ConstraintKind::Line { on },
            "distance" => ConstraintKind::Distance {
                on,
                most: fields.number_if("most").map(|most| most.value),
            },
            "twist" => ConstraintKind::Twist {
                on,
                reference,
                axis: self.axis(fields),
            },
            "pretension" => {
                let normal = self.line(fields, "normal");
                let given = normal.unwrap_or_default();
                self.within(given, "normal", &fields.place("normal"));
                ConstraintKind::Pretension {
                    on,
                    reference,
                    normal,
                }
            }
            "cyclic" => ConstraintKind::Cyclic {
                on,
                with: fields.text("with"),
                sectors: fields.count("sectors"),
                point: self.vector(fields, "point").unwrap_or_default(),
                axis: self.axis(fields),
            },
            _ => ConstraintKind::Equal { on, axes },
        };
        Constraint { kind, place }
    }

    /// Refuses keys that a kind of constraint lacks, and those that mean nothing in it.
    fn keys_of_constraint(&mut self, fields: Fields<'_>, kind: &Name, place: &Place) {
        let mut needs = |key: &str, wanted: bool| {
            if fields.has(key) == wanted || kind.is_empty() {
                return;
            }
            let (code, message, remark) = if wanted {
                let message = format!("a {} constraint has no `{key}`", kind.value);
                (&codes::MISSING, message, "missing here")
            } else {
                let message = format!("`{key}` means nothing in a {} constraint", kind.value);
                (&codes::CONTRADICTION, message, "delete it")
            };
            let at = if wanted {
                place.clone()
            } else {
                fields.place(key)
            };
            self.error(code, message, &at, remark);
        };
        // what a kind must have, and what it may
        let (must, may): (&[&str], &[&str]) = match kind.value.as_str() {
            "kinematic" => (&["reference"], &["dofs", "local"]),
            "distributing" => (&["reference"], &[]),
            "twist" => (&["reference"], &["axis"]),
            "pretension" => (&["reference"], &["normal"]),
            "cyclic" => (&["with", "sectors"], &["axis", "point"]),
            "equal" => (&["dofs"], &[]),
            "distance" => (&[], &["most"]),
            _ => (&[], &[]),
        };
        const KEYS: [&str; 9] = [
            "reference",
            "dofs",
            "local",
            "most",
            "normal",
            "with",
            "sectors",
            "point",
            "axis",
        ];
        for key in KEYS.iter().filter(|key| !may.contains(key)) {
            needs(key, must.contains(key));
        }
    }

    /// The axis that something turns about: z, unless another is given in space.
    fn axis(&mut self, fields: Fields<'_>) -> [f64; 3] {
        const Z: [f64; 3] = [0.0, 0.0, 1.0];
        let axis = self.line(fields, "axis").unwrap_or(Z);
        if self.space.ndim() == 2 && axis[..2] != [0.0; 2] {
            self.error(
                &codes::CONTRADICTION,
                "`axis` lies in the plane",
                &fields.place("axis"),
                "what stays in the plane turns about z only",
            );
        }
        axis
    }

    /// The directions of `dofs`. Nodes have no rotations.
    fn axes(&mut self, fields: Fields<'_>) -> Directions {
        for word in fields.texts("dofs") {
            if word.value.starts_with('r') {
                self.error(
                    &codes::CONTRADICTION,
                    format!("nodes have no rotation \"{}\"", word.value),
                    &word.place,
                    "nodes of solids only move; with a reference that turns, they follow through x, y and z",
                );
            }
        }
        self.directions(fields, "dofs")
    }

    fn summands(&mut self, fields: Fields<'_>) -> Vec<Summand> {
        let mut terms = Vec::new();
        for row in fields.rows("equation") {
            let Some([on, component, coefficient]) = row.get_ref().as_array().map(|row| &**row)
            else {
                continue;
            };
            let Some(at) = component.get_ref().as_str().and_then(component_of) else {
                continue;
            };
            terms.push(Summand {
                on: fields.spanned_text(on).unwrap_or_default(),
                component: Spanned::new(at, fields.at(component.span())),
                coefficient: number(coefficient.get_ref()).unwrap_or_default(),
            });
        }
        terms
    }
}

/// The number of a component from its name, as in `rx`.
fn component_of(word: &str) -> Option<usize> {
    COMPONENTS.iter().position(|name| *name == word)
}

/// The names of displacements and rotations, in their order.
pub(in super::super) const COMPONENTS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// The thickness of a body in the plane, or of a shell.
pub(super) fn thickness(fields: &Fields<'_>) -> Option<Spanned<Thickness>> {
    if let Some(word) = fields.text_if("thickness") {
        return Some(Spanned::new(Thickness::Field, word.place));
    }
    let uniform = fields.number_if("thickness")?;
    Some(Spanned::new(
        Thickness::Uniform(uniform.value),
        uniform.place,
    ))
}

/// The temperature without thermal strain; that from which expansion counts where nothing is said.
fn unstrained(fields: Fields<'_>, reference: &Spanned<f64>) -> Spanned<Unstrained> {
    if let Some(word) = fields.text_if("free") {
        return Spanned::new(Unstrained::AtStart, word.place);
    }
    let free = fields.number_if("free");
    let free = free.unwrap_or_else(|| reference.clone());
    Spanned::new(Unstrained::At(free.value), free.place)
}
