//! Contacts, and their changes in a step.

use super::super::parts::*;
use super::write::{Entries, Value, chosen, list, tables, values};
use crate::diagnostic::Spanned;

pub(super) fn contact(contact: &Contact) -> Entries {
    let area = match contact.area {
        Area::Reference => "reference",
        Area::Current => "current",
        Area::Adjacent => "adjacent",
        Area::Opposite => "opposite",
    };
    let sliding = match contact.sliding {
        Sliding::Auto => "auto",
        Sliding::Finite => "finite",
        Sliding::Increment => "increment",
        Sliding::Small => "small",
    };
    let history = if contact.remembers_traction {
        "traction"
    } else {
        "place"
    };
    let features = match contact.features {
        Features::Auto => "auto",
        Features::Faces => "faces",
        Features::Edges => "edges",
    };
    let passes: u64 = if contact.two_pass { 2 } else { 1 };
    let mut entries = vec![
        ("name", (&contact.name.value).into()),
        ("secondary", (&contact.secondary.value).into()),
        ("primary", (&contact.primary.value).into()),
        ("method", method(*contact.method).into()),
        ("passes", passes.into()),
        ("area", area.into()),
        pull(contact).unwrap_or((
            "enforcement",
            enforcement(&contact.enforcement, contact.per),
        )),
        ("friction", friction(contact.friction.as_ref())),
        ("friction_history", history.into()),
        (
            "damping",
            Value::Table(vec![
                ("normal", contact.damping.normal.into()),
                ("tangential", contact.damping.tangential.into()),
                ("pulls", contact.damping.pulls.into()),
            ]),
        ),
        ("restitution", (*contact.restitution).into()),
        ("friction_heat", friction_heat(contact.friction_heat)),
        ("sliding", sliding.into()),
        ("features", features.into()),
        ("tied", contact.tied.as_ref().map_or(false.into(), tied)),
        ("reach", auto(contact.reach)),
        ("active", contact.active.into()),
    ];
    if !contact.conductance.is_empty() {
        entries.push(("conductance", conductance(&contact.conductance)));
    }
    entries.extend(contact.temperature.map(|t| ("temperature", t.into())));
    entries.extend(contact.wear.map(|of| ("wear", wear(of))));
    match *contact.method {
        Method::GaussPoint => entries.push(("rule", rule(contact.rule))),
        Method::NodeToNode => entries.extend([
            ("normals", normals(&contact.normals)),
            ("pairs", pairs(contact.pairs)),
        ]),
        Method::Mortar => {
            match contact.normals {
                Normals::Nodal => entries.push(("normals", "nodal".into())),
                Normals::Secondary => entries.push(("normals", "secondary".into())),
                Normals::Primary | Normals::Given(_) => {}
            }
            let basis = match contact.basis {
                Basis::Part => "part",
                Basis::Whole => "whole",
            };
            entries.push(("basis", basis.into()));
        }
        Method::Auto | Method::NodeToSegment => {}
    }
    entries.extend(contact.gasket.as_ref().map(|one| ("gasket", gasket(one))));
    entries.extend(contact.fluid.as_ref().map(|one| ("fluid", fluid(one))));
    if contact.gasket.is_some() {
        entries.retain(|(key, _)| *key != "enforcement");
    }
    let cohesive = contact.cohesive.as_ref();
    entries.extend(cohesive.map(|one| ("cohesive", self::cohesive(one))));
    match contact.tied {
        None => entries.push(("start", start(&contact.start))),
        Some(_) => entries.extend(closing(&contact.start).map(|start| ("start", start))),
    }
    entries
}

pub(super) fn general(general: &General) -> Entries {
    let names = |names: &[Name]| list(names.iter().map(|name| &name.value));
    let exclude = |(one, other): &Excluded| match other {
        Some(other) => names(&[one.clone(), other.clone()]),
        None => (&one.value).into(),
    };
    let mut entries = contact(&general.common);
    let own = [
        "name",
        "secondary",
        "primary",
        "passes",
        "tied",
        "cohesive",
        "reach",
    ];
    entries.retain(|(key, _)| !own.contains(key));
    let of = match general.of.is_empty() {
        true => true.into(),
        false => names(&general.of),
    };
    entries.extend([("all", of), ("self", general.with_itself.into())]);
    if !general.exclude.is_empty() {
        let all = general.exclude.iter().map(exclude);
        entries.push(("exclude", Value::List(all.collect())));
    }
    if !general.pairs.is_empty() {
        entries.push(("pair", tables(&general.pairs, general_pair)));
    }
    entries
}

fn general_pair(pair: &GeneralPair) -> Entries {
    let between = list(pair.between.iter().map(|name| &name.value));
    let mut entries = vec![("between", between)];
    if let Some(given) = &pair.friction {
        entries.push(("friction", friction(given.as_ref())));
    }
    if let Some((law, per)) = &pair.enforcement {
        entries.push(("enforcement", enforcement(law, *per)));
    }
    if let Some(given) = &pair.method {
        entries.push(("method", method(**given).into()));
    }
    if let Some(given) = &pair.secondary {
        entries.push(("secondary", (&given.value).into()));
    }
    if let Some(given) = &pair.start {
        entries.push(("start", start(given)));
    }
    entries
}

fn method(method: Method) -> &'static str {
    match method {
        Method::Auto => "auto",
        Method::NodeToNode => "node-to-node",
        Method::NodeToSegment => "node-to-segment",
        Method::GaussPoint => "gauss-point",
        Method::Mortar => "mortar",
    }
}

fn auto(number: Option<f64>) -> Value {
    number.map_or("auto".into(), Value::Number)
}

fn rule(rule: PointRule) -> Value {
    let kind = match rule.kind {
        PointKind::Gauss => "gauss",
        PointKind::Lobatto => "lobatto",
    };
    let points = rule.points.map_or("auto".into(), Value::Count);
    let cut = ("cut", rule.cut.into());
    Value::Table(vec![("kind", kind.into()), ("points", points), cut])
}

fn normals(normals: &Normals) -> Value {
    match normals {
        Normals::Primary => "primary".into(),
        Normals::Secondary => "secondary".into(),
        Normals::Nodal => "nodal".into(),
        Normals::Given(vector) => vector.into(),
    }
}

fn pairs(pairs: Pairs) -> Value {
    match pairs {
        Pairs::Nearest => "nearest",
        Pairs::Order => "order",
    }
    .into()
}

fn enforcement(law: &Enforcement, per: Option<Per>) -> Value {
    let number = |penalty: &Option<Spanned<f64>>| auto(penalty.as_ref().map(|one| one.value));
    let mut entries: Entries = match law {
        Enforcement::Auto => return "auto".into(),
        Enforcement::Penalty(penalty) => vec![("penalty", number(penalty))],
        Enforcement::Table(rows) => vec![("penalty", list(rows))],
        Enforcement::Law(law) => vec![chosen(law)],
        Enforcement::Lagrange => vec![("lagrange", Value::Table(Vec::new()))],
        Enforcement::Augmented { by, penalty } => {
            let by = match by {
                Augmentation::Uzawa => "uzawa",
                Augmentation::Newton => "newton",
            };
            vec![
                ("augmented", by.into()),
                ("penalty", number(penalty)),
                ("gap_tol", "auto".into()),
            ]
        }
    };
    let per = per.map(|per| match per {
        Per::Node => "node",
        Per::Area => "area",
    });
    entries.extend(per.map(|per| ("per", per.into())));
    Value::Table(entries)
}

fn friction(friction: Option<&Friction>) -> Value {
    let Some(friction) = friction else {
        return 0.0.into();
    };
    if let Some(mu) = friction.coefficient() {
        return mu.into();
    }
    let mut entries = values(&friction.limit.values);
    entries.extend(friction.stick.map(|stick| match stick {
        Stick::Stiffness(stiffness) => ("stiffness", stiffness.into()),
        Stick::Slip(slip) => ("elastic_slip", slip.into()),
    }));
    Value::Table(entries)
}

fn gasket(gasket: &Gasket) -> Value {
    let mut entries: Entries = vec![("loading", list(&gasket.loading))];
    if !gasket.unloading.is_empty() {
        let curve = |one: &Unloading| {
            Value::Table(vec![("from", one.from.into()), ("curve", list(&one.curve))])
        };
        let curves = gasket.unloading.iter().map(curve);
        entries.push(("unloading", Value::List(curves.collect())));
    }
    entries.extend(gasket.onset.map(|onset| ("onset", onset.into())));
    entries.push(("tension", gasket.tension.into()));
    Value::Table(entries)
}

fn fluid(fluid: &Fluid) -> Value {
    Value::Table(vec![
        ("pressure", fluid.pressure.into()),
        ("from", (&fluid.from.value).into()),
        (
            "critical",
            fluid.critical.map_or("fluid".into(), Value::Number),
        ),
        ("ramp", fluid.ramp.into()),
        ("recede", fluid.recedes.into()),
    ])
}

fn wear(wear: Wear) -> Value {
    let [secondary, primary] = wear.coefficients;
    let (of, coefficient) = match secondary > 0.0 {
        true => ("secondary", secondary),
        false => ("primary", primary),
    };
    let mut entries = vec![("coefficient", coefficient.into()), ("of", of.into())];
    if secondary > 0.0 && primary > 0.0 {
        entries.push(("primary", primary.into()));
    }
    entries.push(("limit", wear.limit.into()));
    Value::Table(entries)
}

fn tied(tied: &Tied) -> Value {
    let offset = match tied.offset {
        Offset::Keep => "keep",
        Offset::Close => "close",
        Offset::Pull => "pull",
    };
    let mut entries = vec![("offset", offset.into())];
    entries.extend(tied.within.map(|within| ("within", within.into())));
    let tangential = tied.penalty_tangential;
    entries.extend(tangential.map(|penalty| ("penalty_tangential", penalty.into())));
    Value::Table(entries)
}

/// The law of adhesion, where it is given as such.
fn pull(contact: &Contact) -> Option<(&'static str, Value)> {
    match &contact.enforcement {
        Enforcement::Law(law) if contact.adhesion => {
            let mut entries = values(&law.values);
            let shape = match law.name {
                "lennard_jones" => "lennard-jones",
                other => other,
            };
            entries.push(("shape", shape.into()));
            Some(("adhesion", Value::Table(entries)))
        }
        _ => None,
    }
}

fn cohesive(one: &Cohesive) -> Value {
    let pair = |[opening, shear]: [f64; 2]| list([opening, shear]);
    let mixity = match one.mixity {
        Mixity::Bk(eta) => ("bk", eta.into()),
        Mixity::Power(alpha) => ("power", alpha.into()),
    };
    let initiation = if one.quadratic { "quadratic" } else { "mixity" };
    let softening = match one.exponential {
        true => "exponential",
        false => "bilinear",
    };
    let mut entries = vec![
        ("strength", pair(one.strength)),
        ("toughness", pair(one.toughness)),
        ("softening", softening.into()),
        ("viscosity", one.viscosity.into()),
    ];
    if !one.exponential {
        entries.extend([
            ("mixity", Value::Table(vec![mixity])),
            ("initiation", initiation.into()),
            ("stiffness", one.stiffness.map_or("auto".into(), pair)),
        ]);
    }
    Value::Table(entries)
}

/// The gaps that joined sides close at the start; nothing where there are none.
fn closing(start: &Start) -> Option<Value> {
    let below = Some(start.close_gaps_below).filter(|below| *below != 0.0);
    let below = below.map(|below| ("close_gaps_below", below.into()));
    let of = start.close_gaps_of.as_ref();
    let of = of.map(|of| ("close_gaps_of", (&of.value).into()));
    let entries: Entries = below.into_iter().chain(of).collect();
    (!entries.is_empty()).then_some(Value::Table(entries))
}

fn start(start: &Start) -> Value {
    let interference = match start.interference {
        Interference::Step => "step",
        Interference::Increment => "increment",
        Interference::Increments => "increments",
        Interference::Now => "now",
        Interference::StrainFree => "strain-free",
    };
    let clearance = start.clearance.map_or("measured".into(), Value::Number);
    let mut entries: Entries = vec![("close_gaps_below", start.close_gaps_below.into())];
    let of = start.close_gaps_of.as_ref();
    entries.extend(of.map(|of| ("close_gaps_of", (&of.value).into())));
    entries.extend([
        ("clearance", clearance),
        ("interference", interference.into()),
        (
            "facets",
            if start.straight_facets {
                "straight"
            } else {
                "bent"
            }
            .into(),
        ),
    ]);
    Value::Table(entries)
}

pub(super) fn contact_change(change: &ContactChange) -> Entries {
    let mut entries = vec![("name", (&change.name.value).into())];
    entries.extend(change.active.map(|active| ("active", active.into())));
    entries.extend(change.slip.map(|slip| ("slip", slip.into())));
    let friction = change.friction.as_ref();
    entries.extend(friction.map(|friction| ("friction", self::friction(friction.as_ref()))));
    entries.extend(change.fluid.map(|pressure| ("fluid", pressure.into())));
    entries
}

fn conductance(paths: &[Conductance]) -> Value {
    let of = |path: &Conductance| -> (&'static str, Value) {
        match path {
            Conductance::Constant(h) => ("constant", (*h).into()),
            Conductance::OverPressure(rows) => ("over_pressure", list(rows)),
            Conductance::OverGap(rows) => ("over_gap", list(rows)),
            Conductance::Power {
                h0,
                hardness,
                exponent,
            } => {
                let entries = vec![
                    ("h0", (*h0).into()),
                    ("hardness", (*hardness).into()),
                    ("n", (*exponent).into()),
                ];
                ("power", Value::Table(entries))
            }
            Conductance::Gas { conductivity, jump } => {
                let entries = vec![("k", (*conductivity).into()), ("jump", (*jump).into())];
                ("gas", Value::Table(entries))
            }
            Conductance::Radiation(emissivities) => {
                ("radiation", list(emissivities.iter().copied()))
            }
        }
    };
    Value::Table(paths.iter().map(of).collect())
}

fn friction_heat(of: Option<FrictionHeat>) -> Value {
    of.map_or(false.into(), |of| {
        Value::Table(vec![
            ("fraction", of.fraction.into()),
            ("to_secondary", of.to_secondary.into()),
        ])
    })
}
