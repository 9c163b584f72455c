//! Steps: supports, motions, loads, temperatures, and how they go over time.

use super::super::fields::{Fields, numbers};
use super::super::parts::*;
use super::super::vocabulary::OWN;
use super::builder::Builder;
use crate::diagnostic::{Diagnostic, Place, Spanned, codes};
use signorini_vocabulary::Chosen;

/// The spectral radius of the highest frequencies, where a step gives none.
const RHO_INF: f64 = 0.8;

/// Keys of a step that would change the state about which a frequency step finds vibrations.
const NOT_IN_FREQUENCY: [&str; 10] = [
    "duration",
    "increments",
    "move",
    "load",
    "contact",
    "material",
    "activate",
    "deactivate",
    "temperature",
    "print",
];

/// Keys of dynamics that explicit steps alone have.
const OF_EXPLICIT: [&str; 2] = ["safety", "mass_scaling"];

impl Builder<'_> {
    pub(super) fn amplitude(&mut self, name: Name, fields: Fields<'_>) -> Amplitude {
        Amplitude {
            name,
            factor: match fields.text_if(OWN) {
                Some(own) => Factor::Own(own),
                None => Factor::Table(self.time_table(fields)),
            },
            time: if fields.text("time").value == "total" {
                TimeBase::Total
            } else {
                TimeBase::Step
            },
        }
    }

    /// The rows of `table`; their times must increase.
    fn time_table(&mut self, fields: Fields<'_>) -> Vec<[f64; 2]> {
        let mut table: Vec<[f64; 2]> = Vec::new();
        for row in fields.rows("table") {
            let Some([time, value]) = numbers(row.get_ref()) else {
                continue;
            };
            if let Some([before, _]) = table.last()
                && time <= *before
            {
                self.error(
                    &codes::NOT_INCREASING,
                    "the times of `table` do not increase",
                    &fields.at(row.span()),
                    format!("{time} comes after {before}"),
                );
                break;
            }
            table.push([time, value]);
        }
        table
    }

    /// How a dynamic step goes through time.
    fn dynamics(&mut self, fields: Fields<'_>) -> Option<Dynamics> {
        if fields.text("kind").value != "dynamic" {
            if fields.has("dynamics") {
                self.error(
                    &codes::CONTRADICTION,
                    "`dynamics` belongs to dynamic steps",
                    &fields.place("dynamics"),
                    "delete it, or write  kind = \"dynamic\"",
                );
            }
            return None;
        }
        let table = fields.table("dynamics");
        let contact_mass = table.text("contact_mass");
        Some(Dynamics {
            method: self.dynamic_method(table),
            redistributed: Spanned::new(contact_mass.value == "redistributed", contact_mass.place),
            weighted: table.text("contact_force").value == "weighted",
            error_tol: table.number("error_tol"),
            impact_step: table.number("impact_step"),
        })
    }

    /// What a heat or coupled step does with temperatures.
    fn thermal(&mut self, fields: Fields<'_>) -> Option<Thermal> {
        let kind = fields.text("kind").value;
        if !matches!(kind.as_str(), "heat" | "coupled") {
            if fields.has("thermal") {
                self.error(
                    &codes::CONTRADICTION,
                    "`thermal` belongs to heat and coupled steps",
                    &fields.place("thermal"),
                    "delete it, or write  kind = \"heat\"  or  kind = \"coupled\"",
                );
            }
            return None;
        }
        let word = fields.text_if("thermal");
        Some(Thermal {
            coupled: kind == "coupled",
            transient: word.is_some_and(|word| word.value == "transient"),
        })
    }

    /// The method of a dynamic step, with its number.
    fn dynamic_method(&mut self, table: Fields<'_>) -> DynamicMethod {
        let method = table.text("method").value;
        let is_explicit = method == "explicit";
        let strangers: &[(&[&str], &str)] = match method.as_str() {
            "explicit" => &[
                (&["rho_inf", "alpha"], "delete it: no frequency is damped"),
                (
                    &["contact_mass"],
                    "delete it: nodes without mass have no accelerations",
                ),
                (&["contact_force"], "delete it: forces are those of a state"),
                (
                    &["error_tol", "impact_step"],
                    "delete it: what is stable is short enough",
                ),
            ],
            "energy-momentum" => &[
                (&["rho_inf", "alpha"], "delete it: no frequency is damped"),
                (
                    &["contact_force"],
                    "delete it: forces do the work of an energy",
                ),
                (&OF_EXPLICIT, "delete it, or write  method = \"explicit\""),
            ],
            _ => &[(&OF_EXPLICIT, "delete it, or write  method = \"explicit\"")],
        };
        let named = strangers
            .iter()
            .flat_map(|(keys, remark)| keys.iter().map(move |key| (*key, *remark)));
        for (key, remark) in named.filter(|(key, _)| table.has(key)) {
            self.error(
                &codes::CONTRADICTION,
                format!("`{key}` means nothing with  method = \"{method}\""),
                &table.place(key),
                remark,
            );
        }
        if is_explicit {
            return DynamicMethod::Explicit {
                safety: table
                    .number_if("safety")
                    .map_or(SAFETY, |safety| safety.value),
                scaling: table.has("mass_scaling").then(|| {
                    let scaling = table.table("mass_scaling");
                    MassScaling {
                        step: scaling.number("step"),
                        limit: scaling.number("limit"),
                    }
                }),
            };
        }
        if method == "energy-momentum" {
            return DynamicMethod::EnergyMomentum;
        }
        let [rho_inf, alpha] = ["rho_inf", "alpha"].map(|key| table.number_if(key));
        match (alpha, rho_inf) {
            (Some(alpha), _) => DynamicMethod::HilberHughesTaylor(alpha.value),
            (None, rho) => DynamicMethod::GeneralizedAlpha(rho.map_or(RHO_INF, |rho| rho.value)),
        }
    }

    /// Which natural frequencies a step finds. Nothing but supports changes in it.
    fn frequency(&mut self, fields: Fields<'_>) -> Option<Frequency> {
        if fields.text("kind").value != "frequency" {
            if fields.has("frequency") {
                self.error(
                    &codes::CONTRADICTION,
                    "`frequency` belongs to frequency steps",
                    &fields.place("frequency"),
                    "delete it, or write  kind = \"frequency\"",
                );
            }
            return None;
        }
        for key in NOT_IN_FREQUENCY.into_iter().filter(|key| fields.has(key)) {
            self.error(
                &codes::CONTRADICTION,
                format!("`{key}` means nothing in a frequency step"),
                &fields.place(key),
                "it finds vibrations about the state where it begins: change that in a step before it",
            );
        }
        let table = fields.table("frequency");
        let [lower, upper] = ["lower", "upper"].map(|key| table.number_if(key));
        if let (Some(lower), Some(upper)) = (&lower, &upper)
            && upper.value <= lower.value
        {
            self.error(
                &codes::CONTRADICTION,
                "`upper` of `frequency` is not above `lower`",
                &upper.place,
                "lower < upper",
            );
        }
        Some(Frequency {
            modes: table.count("modes"),
            lower: lower.map(|number| number.value),
            upper: upper.map(|number| number.value),
        })
    }

    pub(super) fn step(&mut self, fields: Fields<'_>, place: Place) -> Step {
        let duration = fields
            .number_if("duration")
            .map_or_else(|| fields.number("duration"), |number| number.value);
        Step {
            name: fields.text("name"),
            geometry: match fields.text("geometry").value.as_str() {
                "linear" => Geometry::Linear,
                "nonlinear" => Geometry::Nonlinear,
                _ => Geometry::Auto,
            },
            thermal: self.thermal(fields),
            dynamics: self.dynamics(fields),
            frequency: self.frequency(fields),
            duration,
            increments: self.increments(fields, duration),
            fixes: fields
                .tables("fix")
                .into_iter()
                .map(|(one, place)| Fix {
                    on: one.text("on"),
                    u: self.directions(one, "u"),
                    rot: self.directions(one, "rot"),
                    place,
                })
                .collect(),
            moves: fields
                .tables("move")
                .into_iter()
                .map(|(one, place)| self.motion(one, place))
                .collect(),
            frees: fields
                .tables("free")
                .into_iter()
                .map(|(one, place)| Free {
                    on: one.text("on"),
                    u: self.directions(one, "u"),
                    rot: self.directions(one, "rot"),
                    temperature: one.flag("temperature"),
                    place,
                })
                .collect(),
            loads: fields
                .tables("load")
                .into_iter()
                .map(|(one, place)| self.load(one, place))
                .collect(),
            contacts: fields
                .tables("contact")
                .into_iter()
                .map(|(one, place)| self.contact_change(one, place))
                .collect(),
            materials: fields
                .tables("material")
                .into_iter()
                .map(|(one, place)| MaterialChange {
                    group: one.text("group"),
                    material: one.text("material"),
                    place,
                })
                .collect(),
            activations: fields
                .tables("activate")
                .into_iter()
                .map(|(one, place)| Activation {
                    group: one.text("group"),
                    strain: match one.text("strain").value.as_str() {
                        "keep" => StrainAt::Keep,
                        _ => StrainAt::Free,
                    },
                    place,
                })
                .collect(),
            deactivations: fields
                .tables("deactivate")
                .into_iter()
                .map(|(one, place)| Deactivation {
                    group: one.text("group"),
                    ramp: one.flag("ramp"),
                    place,
                })
                .collect(),
            temperatures: fields
                .tables("temperature")
                .into_iter()
                .map(|(one, place)| self.temperature(one, place))
                .collect(),
            prints: fields.has("print").then(|| {
                let tables = fields.tables("print").into_iter();
                tables.map(|(one, place)| print(one, place)).collect()
            }),
            place,
        }
    }

    /// Temperatures; a table of them gives no course that a gradient could have, too.
    fn temperature(&mut self, fields: Fields<'_>, place: Place) -> Temperature {
        let value = self.course(fields, "value").unwrap_or(Motion::Ramp(0.0));
        let gradient = fields.number_if("gradient");
        if let (Motion::Table(_), Some(gradient)) = (&value, &gradient) {
            self.error(
                &codes::CONTRADICTION,
                "`gradient` does not go with a table of temperatures",
                &gradient.place,
                "write  value = number,  or  value = { amplitude = , value = }:  the gradient has the same course",
            );
        }
        Temperature {
            on: fields.text("on"),
            value,
            gradient,
            place,
        }
    }

    fn increments(&mut self, fields: Fields<'_>, duration: f64) -> Increments {
        let table = fields.table("increments");
        if let Some(fixed) = table.count_if("fixed") {
            return Increments::Fixed(fixed.value);
        }
        let Some(initial) = table.number_if("initial") else {
            return Increments::Count(fields.count("increments"));
        };
        let min = table
            .number_if("min")
            .unwrap_or_else(|| initial.min(1e-5 * duration).into());
        let max = table.number_if("max").unwrap_or_else(|| duration.into());
        let mut order = |small: (&str, &Spanned<f64>), large: (&str, &Spanned<f64>)| {
            if small.1.value > large.1.value {
                self.found.push(
                    Diagnostic::error(
                        &codes::OUT_OF_RANGE,
                        format!(
                            "`{}` = {} is greater than `{}` = {}",
                            small.0, small.1.value, large.0, large.1.value
                        ),
                    )
                    .at(&small.1.place, "")
                    .at(&large.1.place, "")
                    .note("min ≤ initial ≤ max ≤ duration of the step"),
                );
            }
        };
        if *min > *max {
            order(("min", &min), ("max", &max));
        } else {
            order(("min", &min), ("initial", &initial));
            order(("initial", &initial), ("max", &max));
        }
        let whole = Spanned::new(duration, fields.place("duration"));
        if table.has("max") {
            order(("max", &max), ("duration", &whole));
        }
        Increments::Adaptive {
            initial: initial.value,
            min: min.value,
            max: max.value,
            count_max: table.count("count_max"),
        }
    }

    /// The course of what a key prescribes.
    fn course(&mut self, fields: Fields<'_>, key: &str) -> Option<Motion> {
        let table = fields.table(key);
        if let Some(name) = table.text_if("amplitude") {
            Some(Motion::Amplitude {
                name,
                value: table.number("value"),
            })
        } else if table.has("table") {
            Some(Motion::Table(self.time_table(table)))
        } else {
            let number = fields.number_if(key);
            number.map(|number| Motion::Ramp(number.value))
        }
    }

    fn motion(&mut self, fields: Fields<'_>, place: Place) -> Move {
        let mut component = |key: &str| {
            if self.space.ndim() == 2 && matches!(key, "uz" | "rx" | "ry") && fields.has(key) {
                self.out_of_plane(&format!("`{key}`"), &fields.place(key));
            }
            self.course(fields, key)
        };
        let (u, rot) = (
            ["ux", "uy", "uz"].map(&mut component),
            ["rx", "ry", "rz"].map(&mut component),
        );
        let from = fields
            .has("from")
            .then(|| self.global_model(fields.table("from")));
        if from.is_some() && u.iter().chain(&rot).any(Option::is_some) {
            self.error(
                &codes::CONTRADICTION,
                "`from` and components of a motion exclude each other",
                &fields.place("from"),
                "write a [[step.move]] for each",
            );
        }
        Move {
            u,
            rot,
            from,
            on: fields.text("on"),
            place,
        }
    }

    /// The results of another model.
    fn global_model(&mut self, fields: Fields<'_>) -> GlobalModel {
        let file = fields.text("file");
        let u = match fields.has("u") {
            true => self.directions(fields, "u"),
            false => Directions::ALL,
        };
        let number = |key: &str| fields.count_if(key).map(|count| count.value);
        GlobalModel {
            file: Spanned::new(file.value.into(), file.place),
            at: match (number("step"), number("data_set")) {
                (Some(step), _) => GlobalTime::Step(step),
                (None, set) => GlobalTime::Set(set.unwrap_or(1)),
            },
            elements: fields.counts("elements"),
            u,
            ramp: fields.flag("ramp"),
            values: None,
        }
    }

    /// Directions of displacements or rotations. A plane model has x and y, and turns about z.
    pub(super) fn directions(&mut self, fields: Fields<'_>, key: &str) -> Directions {
        let words = fields.texts(key);
        let absent = match key {
            "rot" => ["x", "y"].as_slice(),
            _ => ["z"].as_slice(),
        };
        for word in &words {
            if self.space.ndim() == 2 && absent.contains(&word.value.as_str()) {
                self.out_of_plane(&format!("`{key}` = [\"{}\"]", word.value), &word.place);
            }
        }
        let has = |axis: &str| {
            words
                .iter()
                .any(|word| word.value == axis || word.value == "all")
        };
        Directions {
            xyz: [has("x"), has("y"), has("z")],
        }
    }

    fn out_of_plane(&mut self, what: &str, place: &Place) {
        self.error(
            &codes::CONTRADICTION,
            format!("{what} leads out of the plane"),
            place,
            "a plane model moves along x and y, and turns about z",
        );
    }

    fn load(&mut self, fields: Fields<'_>, place: Place) -> Load {
        let kind = self.load_kind(fields);
        let coupling = fields.text("coupling");
        Load {
            name: fields.text_if("name"),
            on: fields.text("on"),
            what: fields.place(kind.name),
            kind,
            follows: fields
                .flag_if("follows")
                .map(|flag| Spanned::new(flag, fields.place("follows"))),
            coupling: match coupling.value.as_str() {
                "rigid-x" => Some(Axis::X),
                "rigid-y" => Some(Axis::Y),
                "rigid-z" => Some(Axis::Z),
                _ => None,
            }
            .map(|axis| Spanned::new(axis, coupling.place)),
            course: match fields.text_if("amplitude") {
                Some(name) => Course::Amplitude(name),
                None if fields.has("table") => Course::Table(self.time_table(fields)),
                None => Course::Ramp,
            },
            place,
        }
    }

    /// What acts; nothing where it is missing, which has been reported.
    fn load_kind(&mut self, fields: Fields<'_>) -> Chosen {
        let vocabulary = self.vocabulary;
        let mut loads = vocabulary.loads().iter();
        match loads.find(|load| fields.has(load.name)) {
            Some(load) => self.chosen(fields, load),
            None => Chosen::new("", []),
        }
    }
}

fn print(fields: Fields<'_>, place: Place) -> Print {
    let kinds = [
        PrintOf::Nodes,
        PrintOf::Elements,
        PrintOf::Contact,
        PrintOf::Faces,
    ];
    let given = kinds.into_iter().find(|of| fields.has(of.key()));
    let of = given.unwrap_or(PrintOf::Nodes);
    Print {
        on: fields.text_if("on"),
        of,
        quantities: fields.texts(of.key()),
        totals: match fields.text("totals").value.as_str() {
            "yes" => Totals::Yes,
            "only" => Totals::Only,
            _ => Totals::No,
        },
        local: fields.flag("local"),
        every: fields.count("every"),
        place,
    }
}
