//! Contacts, and their changes in a step.

use super::super::fields::{Fields, numbers};
use super::super::parts::*;
use super::builder::Builder;
use crate::diagnostic::{Diagnostic, Place, Spanned, codes};
use signorini_vocabulary::{Chosen, Description};

/// Rubber on dry concrete has about half of it.
const ROUGH: f64 = 2.0;

/// What becomes of the work of friction.
fn friction_heat(fields: Fields<'_>) -> Option<FrictionHeat> {
    if fields.flag_if("friction_heat") == Some(false) {
        return None;
    }
    let of = fields.table("friction_heat");
    Some(FrictionHeat {
        fraction: of.number("fraction"),
        to_secondary: of.number("to_secondary"),
    })
}

fn damping(fields: Fields<'_>) -> Damping {
    Damping {
        normal: fields.number("normal"),
        tangential: fields.number("tangential"),
        pulls: fields.flag("pulls"),
    }
}

fn gasket(fields: Fields<'_>) -> Option<Gasket> {
    let rows = |fields: Fields<'_>, key: &str| -> Vec<[f64; 2]> {
        fields
            .rows(key)
            .filter_map(|row| numbers(row.get_ref()))
            .collect()
    };
    let table = fields.table("gasket");
    fields.has("gasket").then(|| Gasket {
        loading: rows(table, "loading"),
        unloading: table
            .tables("unloading")
            .into_iter()
            .map(|(one, _)| Unloading {
                from: one.number("from"),
                curve: rows(one, "curve"),
            })
            .collect(),
        onset: table.number_if("onset").map(|onset| onset.value),
        tension: table.number("tension"),
    })
}

fn fluid(fields: Fields<'_>) -> Option<Fluid> {
    let table = fields.table("fluid");
    let is_its_own = table.text_if("critical").is_some();
    fields.has("fluid").then(|| Fluid {
        pressure: table.number("pressure"),
        from: table.text("from"),
        critical: (!is_its_own).then(|| table.number("critical")),
        ramp: table.number("ramp"),
        recedes: table.flag("recede"),
    })
}

impl Builder<'_> {
    /// The ways that heat takes across a contact.
    fn conductance(&mut self, fields: Fields<'_>) -> Vec<Conductance> {
        if let Some(constant) = fields.number_if("conductance") {
            return vec![Conductance::Constant(constant.value)];
        }
        let of = fields.table("conductance");
        let mut paths = Vec::new();
        paths.extend(
            of.number_if("constant")
                .map(|h| Conductance::Constant(h.value)),
        );
        for (key, make) in [
            ("over_pressure", Conductance::OverPressure as fn(_) -> _),
            ("over_gap", Conductance::OverGap),
        ] {
            if of.has(key) {
                paths.push(make(self.increasing(of, key)));
            }
        }
        if of.has("power") {
            let power = of.table("power");
            paths.push(Conductance::Power {
                h0: power.number("h0"),
                hardness: power.number("hardness"),
                exponent: power.number("n"),
            });
        }
        if of.has("gas") {
            let gas = of.table("gas");
            paths.push(Conductance::Gas {
                conductivity: gas.number("k"),
                jump: gas.number("jump"),
            });
        }
        let emissivities = of.numbers_if("radiation");
        if let Some([one, other]) = emissivities.as_deref().map(Vec::as_slice) {
            paths.push(Conductance::Radiation([*one, *other]));
        }
        paths
    }

    pub(super) fn contact(&mut self, fields: Fields<'_>, place: Place) -> Contact {
        let contact = Contact {
            name: fields.text("name"),
            secondary: fields.text("secondary"),
            primary: fields.text("primary"),
            method: method(fields),
            two_pass: fields.count("passes") == 2,
            rule: self.rule(fields),
            area: match fields.text("area").value.as_str() {
                "current" => Area::Current,
                "adjacent" => Area::Adjacent,
                "opposite" => Area::Opposite,
                _ => Area::Reference,
            },
            adhesion: fields.has("adhesion"),
            enforcement: adhesion(fields).unwrap_or_else(|| self.enforcement(fields)),
            per: per(fields),
            friction: self.friction(fields),
            remembers_traction: fields.text("friction_history").value == "traction",
            gasket: gasket(fields),
            fluid: fluid(fields),
            damping: damping(fields.table("damping")),
            conductance: self.conductance(fields),
            friction_heat: friction_heat(fields),
            temperature: fields.number_if("temperature").map(|number| number.value),
            restitution: Spanned::new(fields.number("restitution"), fields.place("restitution")),
            wear: self.wear(fields),
            sliding: match fields.text("sliding").value.as_str() {
                "increment" => Sliding::Increment,
                "small" => Sliding::Small,
                "finite" => Sliding::Finite,
                _ => Sliding::Auto,
            },
            features: match fields.text("features").value.as_str() {
                "faces" => Features::Faces,
                "edges" => Features::Edges,
                _ => Features::Auto,
            },
            tied: tied(fields),
            cohesive: cohesive(fields),
            start: start(fields.table("start")),
            normals: self.normals(fields),
            basis: match fields.text("basis").value.as_str() {
                "whole" => Basis::Whole,
                _ => Basis::Part,
            },
            pairs: if fields.text("pairs").value == "order" {
                Pairs::Order
            } else {
                Pairs::Nearest
            },
            reach: fields.number_if("reach").map(|reach| reach.value),
            active: fields.flag("active"),
            found: None,
            place,
        };
        if fields.has("adhesion")
            && fields
                .get("enforcement")
                .is_some_and(|e| e.get_ref().is_table())
        {
            self.error(
                &codes::CONTRADICTION,
                "`adhesion` stands in place of `enforcement`",
                &fields.place("enforcement"),
                "delete it, or write the law of adhesion there",
            );
        }
        self.sides(&contact);
        self.what_goes_with_the_method(&contact, fields);
        self.what_goes_with_multipliers(&contact, fields);
        self.what_goes_with_seals(&contact, fields);
        if contact.tied.is_some() {
            self.what_goes_with_a_tie(&contact, fields);
        } else if contact.cohesive.is_some() {
            self.error(
                &codes::CONTRADICTION,
                "`cohesive` goes with sides that are joined",
                &fields.place("cohesive"),
                "write  tied = true",
            );
        }
        contact
    }

    fn sides(&mut self, contact: &Contact) {
        let (primary, secondary) = (&contact.primary, &contact.secondary);
        if !primary.is_empty() && primary == secondary {
            self.error(
                &codes::CONTRADICTION,
                format!(
                    "both sides of contact \"{}\" are \"{}\"",
                    contact.name.value, primary.value
                ),
                &primary.place,
                "name the other side, or write \"self\" for contact of a surface with itself",
            );
        }
    }

    fn what_goes_with_the_method(&mut self, contact: &Contact, fields: Fields<'_>) {
        let mut only = |key: &str, wrong: bool, remark: &str| {
            if wrong {
                let message = format!("`{key}` does not go with this `method`");
                self.found.push(
                    Diagnostic::error(&codes::CONTRADICTION, message)
                        .at(&fields.place(key), remark)
                        .at(&contact.method.place, ""),
                );
            }
        };
        let method = *contact.method;
        let of_mortar = contact.normals == Normals::Nodal;
        only(
            "normals",
            fields.has("normals")
                && match method {
                    Method::NodeToNode => of_mortar,
                    Method::Mortar => !of_mortar && contact.normals != Normals::Secondary,
                    _ => true,
                },
            "\"nodal\" belongs to  method = \"mortar\", which also takes \"secondary\"; all others to \"node-to-node\"",
        );
        only(
            "basis",
            fields.has("basis") && method != Method::Mortar,
            "it belongs to  method = \"mortar\"",
        );
        only(
            "pairs",
            fields.has("pairs") && method != Method::NodeToNode,
            "it belongs to  method = \"node-to-node\"",
        );
        only(
            "rule",
            fields.has("rule") && method != Method::GaussPoint,
            "it belongs to  method = \"gauss-point\"",
        );
        only(
            "passes",
            contact.two_pass && matches!(method, Method::NodeToNode | Method::Mortar),
            "two passes belong to \"node-to-segment\" and \"gauss-point\"",
        );
        only(
            "sliding",
            matches!(contact.sliding, Sliding::Increment | Sliding::Small)
                && method == Method::NodeToNode,
            "pairs of nodes stay what they are: delete `sliding`",
        );
        only(
            "sliding",
            contact.sliding == Sliding::Increment && method == Method::Mortar,
            "its cells are those of the first look, or of the present: write \"small\" or delete `sliding`",
        );
        only(
            "features",
            contact.features != Features::Auto
                && !matches!(method, Method::NodeToSegment | Method::GaussPoint),
            "it belongs to \"node-to-segment\" and \"gauss-point\"",
        );
        only(
            "enforcement",
            contact.per == Some(Per::Node) && matches!(method, Method::GaussPoint | Method::Mortar),
            "facets carry pressures, not forces of nodes: write  per = \"area\"",
        );
        only(
            "area",
            matches!(contact.area, Area::Adjacent | Area::Opposite)
                && matches!(method, Method::GaussPoint | Method::Mortar),
            "only nodes have adjacent and opposite faces: delete `area`",
        );
        only(
            "area",
            contact.area == Area::Current && method == Method::Mortar,
            "its areas are those of what is covered: delete `area`",
        );
        if contact.is_with_itself() {
            let mut alone = |key: &str, wrong: bool, remark: &str| {
                if wrong {
                    let message = format!("this `{key}` means nothing with  primary = \"self\"");
                    self.error(&codes::CONTRADICTION, message, &fields.place(key), remark);
                }
            };
            alone("passes", contact.two_pass, "both sides are the same");
            alone(
                "method",
                matches!(method, Method::NodeToNode | Method::Mortar),
                "write \"node-to-segment\" or \"gauss-point\"",
            );
            alone(
                "tied",
                contact.tied.is_some(),
                "it would be joined to itself",
            );
        }
    }

    fn what_goes_with_seals(&mut self, contact: &Contact, fields: Fields<'_>) {
        for (key, given) in [
            ("gasket", contact.gasket.is_some()),
            ("fluid", contact.fluid.is_some()),
        ] {
            if given && contact.is_with_itself() {
                let message = format!("this `{key}` means nothing with  primary = \"self\"");
                let place = fields.place(key);
                self.error(
                    &codes::CONTRADICTION,
                    message,
                    &place,
                    "it is between two sides",
                );
            }
            if contact.two_pass && given {
                self.error(
                    &codes::CONTRADICTION,
                    format!("`{key}` does not go with two `passes`, in which it would press twice"),
                    &fields.place(key),
                    "write  passes = 1",
                );
            }
        }
    }

    /// Multipliers leave no penetration, and nodes can follow only as many as there are of them: those at the nodes of
    /// one side.
    fn what_goes_with_multipliers(&mut self, contact: &Contact, fields: Fields<'_>) {
        let exact = matches!(
            contact.enforcement,
            Enforcement::Lagrange | Enforcement::Augmented { .. }
        );
        if *contact.restitution > 0.0 && !exact {
            self.error(
                &codes::CONTRADICTION,
                "`restitution` goes with multipliers, whose impulses it is of",
                &fields.place("restitution"),
                "delete it, or write  enforcement = { lagrange = {} }",
            );
        }
        let damps = contact.damping.normal > 0.0 || contact.damping.tangential > 0.0;
        if damps && (exact || contact.tied.is_some() || contact.gasket.is_some()) {
            self.error(
                &codes::CONTRADICTION,
                "`damping` goes with contact by a `penalty` or a law of the pressure",
                &fields.place("damping"),
                "delete it, or give a `penalty` alone",
            );
        }
        for (key, wrong, why, instead) in [
            (
                "method",
                *contact.method == Method::GaussPoint,
                "points inside of facets are more than their nodes",
                "write  method = \"node-to-segment\", or give a `penalty` alone",
            ),
            (
                "passes",
                contact.two_pass,
                "the points of both sides",
                "write  passes = 1, or give a `penalty` alone",
            ),
            (
                "primary",
                contact.is_with_itself(),
                "the points of both sides",
                "give a `penalty` alone",
            ),
        ] {
            if exact && wrong {
                let message = format!("`{key}` makes too many points for multipliers");
                self.found.push(
                    Diagnostic::error(&codes::CONTRADICTION, message)
                        .at(&fields.place(key), why)
                        .at(
                            &fields.place("enforcement"),
                            "no motion of the nodes meets all their conditions",
                        )
                        .help(instead),
                );
            }
        }
    }

    fn what_goes_with_a_tie(&mut self, contact: &Contact, fields: Fields<'_>) {
        let one_sided = contact.enforcement.is_curve();
        let by_points = matches!(contact.enforcement, Enforcement::Penalty(_))
            && matches!(*contact.method, Method::NodeToSegment | Method::GaussPoint);
        let pulls = |tied: &Tied| tied.offset == Offset::Pull || tied.penalty_tangential.is_some();
        if contact.tied.as_ref().is_some_and(pulls) && !by_points {
            self.error(
                &codes::CONTRADICTION,
                "`penalty_tangential` and `offset = \"pull\"` go with a penalty at points".to_owned(),
                &fields.place("tied"),
                "write a `penalty` as `enforcement`, and the `method` \"node-to-segment\" or \"gauss-point\"",
            );
        }
        let exact = matches!(
            contact.enforcement,
            Enforcement::Lagrange | Enforcement::Augmented { .. }
        );
        let breaks = contact.cohesive.is_some();
        let cohesive = fields.table("cohesive");
        let own = ["mixity", "initiation", "stiffness"];
        let of_bilinear = own.into_iter().find(|key| cohesive.has(key));
        if let Some(key) = of_bilinear.filter(|_| contact.cohesive.is_some_and(|c| c.exponential)) {
            self.error(
                &codes::CONTRADICTION,
                format!("`{key}` does not go with exponential softening"),
                &cohesive.place(key),
                "its strength and toughness say everything: delete it",
            );
        }
        for (key, wrong, remark) in [
            (
                "enforcement",
                breaks && (exact || contact.per == Some(Per::Node)),
                "a joint that breaks is a stiffness per area: give a `penalty`",
            ),
            (
                "passes",
                breaks && contact.two_pass,
                "a joint that breaks would be twice as strong: write  passes = 1",
            ),
            (
                "tied",
                breaks && contact.tied.as_ref().is_some_and(pulls),
                "the stiffness of a joint that breaks is  cohesive = { stiffness = [opening, shear] }, and it holds where the \
                 sides are at the start",
            ),
            (
                "friction",
                contact.friction.is_some() && !breaks,
                "what is joined does not slide",
            ),
            (
                "start",
                ["clearance", "interference"]
                    .iter()
                    .any(|key| fields.table("start").has(key)),
                "gaps may be closed; all else is said by  tied = { offset, within }",
            ),
            (
                "enforcement",
                one_sided,
                "a joint also pulls: give a number as `penalty`",
            ),
            (
                "gasket",
                contact.gasket.is_some(),
                "a joint has one stiffness: give it as `penalty`",
            ),
            (
                "fluid",
                contact.fluid.is_some(),
                "it comes between sides that may part",
            ),
        ] {
            if wrong {
                self.error(
                    &codes::CONTRADICTION,
                    format!("`{key}` does not go with sides that are joined"),
                    &fields.place(key),
                    remark,
                );
            }
        }
    }

    fn rule(&mut self, fields: Fields<'_>) -> PointRule {
        let rule = fields.table("rule");
        let points = rule.count_if("points");
        let kind = if rule.text("kind").value == "lobatto" {
            PointKind::Lobatto
        } else {
            PointKind::Gauss
        };
        if let Some(points) = points.as_ref().filter(|points| ***points == 1)
            && kind == PointKind::Lobatto
        {
            self.error(
                &codes::OUT_OF_RANGE,
                "a rule with both ends has at least two points",
                &points.place,
                "must be at least 2",
            );
        }
        PointRule {
            kind,
            points: points.map(|points| points.value),
            cut: rule.flag("cut"),
        }
    }

    pub(super) fn enforcement(&mut self, fields: Fields<'_>) -> Enforcement {
        let given = fields.get("enforcement");
        if !given.is_some_and(|value| value.get_ref().is_table()) {
            return Enforcement::Auto;
        }
        let table = fields.table("enforcement");
        let penalty = table.number_if("penalty");
        let rows = table.get("penalty");
        let rows = rows.filter(|value| value.get_ref().is_array());
        if let Some(word) = table.text_if("augmented") {
            if let Some(rows) = rows {
                self.error(
                    &codes::CONTRADICTION,
                    "`augmented` needs one number as `penalty`",
                    &table.at(rows.span()),
                    "a table",
                );
            }
            let by = if word.value == "newton" {
                Augmentation::Newton
            } else {
                Augmentation::Uzawa
            };
            return Enforcement::Augmented { by, penalty };
        }
        let vocabulary = self.vocabulary;
        let mut laws = vocabulary.laws().iter();
        if let Some(law) = laws.find(|law| table.has(law.name)) {
            return Enforcement::Law(self.chosen(table, law));
        }
        if table.has("lagrange") {
            return Enforcement::Lagrange;
        }
        match rows {
            Some(_) => Enforcement::Table(self.pressures(table)),
            None => Enforcement::Penalty(penalty),
        }
    }

    /// Rows of gap and pressure: gaps increase, pressures fall to zero.
    fn pressures(&mut self, fields: Fields<'_>) -> Vec<[f64; 2]> {
        let mut table: Vec<[f64; 2]> = Vec::new();
        for row in fields.rows("penalty") {
            let Some([gap, pressure]) = numbers(row.get_ref()) else {
                // it has been reported, and what is missing would draw other messages after it
                return table;
            };
            if let Some([before, harder]) = table.last().copied() {
                let fault = if gap <= before {
                    let message = "the gaps of `penalty` do not increase";
                    Some((
                        &codes::NOT_INCREASING,
                        message,
                        format!("{gap} comes after {before}"),
                    ))
                } else if pressure > harder {
                    let message = "the pressures of `penalty` grow with the gap";
                    Some((
                        &codes::OUT_OF_RANGE,
                        message,
                        format!("{pressure} comes after {harder}"),
                    ))
                } else {
                    None
                };
                if let Some((code, message, remark)) = fault {
                    self.error(code, message, &fields.at(row.span()), remark);
                    return table;
                }
            }
            table.push([gap, pressure]);
        }
        let ends = table.first().zip(table.last());
        if let Some(([_, first], [_, last])) = ends {
            let remark = if *last > 0.0 {
                "the last pressure must be 0, or the sides push at any distance"
            } else if *first == 0.0 {
                "no row has a pressure: nothing would push"
            } else {
                return table;
            };
            let message = "the pressures of `penalty` do not fall to 0";
            let place = fields.place("penalty");
            self.error(&codes::OUT_OF_RANGE, message, &place, remark);
        }
        table
    }

    /// Friction; none where its limit is zero.
    pub(super) fn friction(&mut self, fields: Fields<'_>) -> Option<Friction> {
        let number = fields.number_if("friction");
        let table = fields.table("friction");
        let coefficient = table.number_if("static").or_else(|| table.number_if(MU));
        if let Some(mu) = number.as_ref().or(coefficient.as_ref()) {
            self.plausible(mu);
        }
        if let Some(mu) = number {
            let limit = Chosen::new(COULOMB, [(MU, mu.value)]);
            return (*mu > 0.0).then_some(Friction { limit, stick: None });
        }
        let value = |key: &str| table.number_if(key).map(|number| number.value);
        if value(MU) == Some(0.0) {
            return None;
        }
        let is_meant = |law: &&Description| law.keys.first().is_some_and(|key| table.has(key.name));
        let vocabulary = self.vocabulary;
        let law = vocabulary.frictions().iter().find(is_meant)?;
        let limit = Chosen {
            name: law.name,
            values: self.values(table, law.keys),
        };
        let stick = value("stiffness").map(Stick::Stiffness);
        Some(Friction {
            limit,
            stick: stick.or(value("elastic_slip").map(Stick::Slip)),
        })
    }

    fn plausible(&mut self, mu: &Spanned<f64>) {
        if **mu > ROUGH {
            self.found.push(
                Diagnostic::warning(
                    &codes::UNUSUAL,
                    format!("a coefficient of friction of {}", mu.value),
                )
                .at(&mu.place, "rubber on dry concrete has about 1")
                .note("silence with  allow = [\"S0406\"]"),
            );
        }
    }

    fn normals(&mut self, fields: Fields<'_>) -> Normals {
        match fields.text("normals").value.as_str() {
            "secondary" => return Normals::Secondary,
            "nodal" => return Normals::Nodal,
            _ => {}
        }
        match self.vector_within(fields, "normals") {
            Some(vector) => {
                self.has_direction(vector, "normals", &fields.place("normals"));
                Normals::Given(vector)
            }
            None => Normals::Primary,
        }
    }

    fn wear(&mut self, fields: Fields<'_>) -> Option<Wear> {
        let table = fields.has("wear").then(|| fields.table("wear"))?;
        let number = |key: &str| table.number_if(key).map(|number| number.value);
        let of_hardness = number("k").zip(number("hardness")).map(|(k, h)| k / h);
        let coefficient = number("coefficient").or(of_hardness).unwrap_or_default();
        let mut coefficients = match table.text("of").value.as_str() {
            "primary" => [0.0, coefficient],
            _ => [coefficient, 0.0],
        };
        if let Some(primary) = number("primary") {
            if coefficients[1] > 0.0 {
                self.error(
                    &codes::CONTRADICTION,
                    "`primary` and  of = \"primary\"  give two coefficients of one side",
                    &table.place("primary"),
                    "delete one of them",
                );
            }
            coefficients[1] = primary;
        }
        Some(Wear {
            coefficients,
            limit: table.number("limit"),
        })
    }

    pub(super) fn contact_change(&mut self, fields: Fields<'_>, place: Place) -> ContactChange {
        ContactChange {
            name: fields.text("name"),
            active: fields.flag_if("active"),
            friction: fields.has("friction").then(|| self.friction(fields)),
            fluid: fields.number_if("fluid").map(|pressure| pressure.value),
            slip: fields.number_if("slip").map(|slip| slip.value),
            place,
        }
    }
}

pub(super) fn method(fields: Fields<'_>) -> Spanned<Method> {
    let word = fields.text("method");
    let method = match word.value.as_str() {
        "node-to-node" => Method::NodeToNode,
        "node-to-segment" => Method::NodeToSegment,
        "gauss-point" => Method::GaussPoint,
        "mortar" => Method::Mortar,
        _ => Method::Auto,
    };
    Spanned::new(method, word.place)
}

pub(super) fn per(fields: Fields<'_>) -> Option<Per> {
    let word = fields.table("enforcement").text_if("per")?;
    Some(match word.value.as_str() {
        "node" => Per::Node,
        _ => Per::Area,
    })
}

fn tied(fields: Fields<'_>) -> Option<Tied> {
    let table = fields.table("tied");
    let is_table = fields
        .get("tied")
        .is_some_and(|value| value.get_ref().is_table());
    (is_table || fields.flag("tied")).then(|| Tied {
        offset: match table.text("offset").value.as_str() {
            "close" => Offset::Close,
            "pull" => Offset::Pull,
            _ => Offset::Keep,
        },
        within: table.number_if("within").map(|within| within.value),
        penalty_tangential: table.number_if("penalty_tangential").map(|one| one.value),
    })
}

/// The law of adhesion; none where nothing pulls.
fn adhesion(fields: Fields<'_>) -> Option<Enforcement> {
    let table = fields.table("adhesion");
    let law = match table.text("shape").value.as_str() {
        "lennard-jones" => "lennard_jones",
        _ => "dugdale",
    };
    let work = table.number_if("work")?.value;
    let range = table.number_if("range")?.value;
    Some(Enforcement::Law(Chosen::new(
        law,
        [("work", work), ("range", range)],
    )))
}

fn cohesive(fields: Fields<'_>) -> Option<Cohesive> {
    let table = fields.table("cohesive");
    let pair = |key: &str| table.get(key).and_then(|value| numbers(value.get_ref()));
    let mixity = table.table("mixity");
    let exponent = |key: &str| mixity.number_if(key).map(|one| one.value);
    let one = table.number_if("stiffness").map(|one| [one.value; 2]);
    Some(Cohesive {
        strength: pair("strength")?,
        toughness: pair("toughness")?,
        mixity: match (exponent("bk"), exponent("power")) {
            (Some(eta), _) => Mixity::Bk(eta),
            (None, Some(alpha)) => Mixity::Power(alpha),
            (None, None) => Mixity::default(),
        },
        quadratic: table.text("initiation").value == "quadratic",
        exponential: table.text("softening").value == "exponential",
        stiffness: one.or_else(|| pair("stiffness")),
        viscosity: table.number("viscosity"),
    })
}

pub(super) fn start(fields: Fields<'_>) -> Start {
    Start {
        close_gaps_below: fields.number("close_gaps_below"),
        close_gaps_of: fields.text_if("close_gaps_of"),
        clearance: fields.number_if("clearance").map(|gap| gap.value),
        interference: match fields.text("interference").value.as_str() {
            "increment" => Interference::Increment,
            "increments" => Interference::Increments,
            "now" => Interference::Now,
            "strain-free" => Interference::StrainFree,
            _ => Interference::Step,
        },
        straight_facets: fields.text("facets").value == "straight",
    }
}
