//! Amplitudes and steps.

use super::super::parts::*;
use super::super::vocabulary::OWN;
use super::contact::contact_change;
use super::write::{Entries, Value, chosen, list, names, tables};

pub(super) fn amplitude(one: &Amplitude) -> Entries {
    let time = match one.time {
        TimeBase::Step => "step",
        TimeBase::Total => "total",
    };
    let factor = match &one.factor {
        Factor::Table(table) => ("table", list(table)),
        Factor::Own(name) => (OWN, (&name.value).into()),
    };
    vec![factor, ("time", time.into())]
}

pub(super) fn step(step: &Step) -> Entries {
    let geometry = match step.geometry {
        Geometry::Auto => "auto",
        Geometry::Linear => "linear",
        Geometry::Nonlinear => "nonlinear",
    };
    let kind = match (&step.dynamics, &step.frequency, step.thermal) {
        (Some(_), ..) => "dynamic",
        (None, Some(_), _) => "frequency",
        (None, None, Some(thermal)) if thermal.coupled => "coupled",
        (None, None, Some(_)) => "heat",
        (None, None, None) => "static",
    };
    let name = ("name", (&step.name.value).into());
    let supports = [
        (
            "fix",
            tables(&step.fixes, |one| held(&one.on, one.u, one.rot)),
        ),
        ("free", tables(&step.frees, freed)),
    ];
    if let Some(one) = &step.frequency {
        let [lower, upper] = [("lower", one.lower), ("upper", one.upper)];
        let limits = [lower, upper].into_iter();
        let limits = limits.filter_map(|(key, value)| Some((key, value?.into())));
        let modes = ("modes", one.modes.into());
        let frequency = Value::Table([modes].into_iter().chain(limits).collect());
        let head = [name, ("kind", kind.into()), ("geometry", geometry.into())];
        let own = [("frequency", frequency)];
        return head.into_iter().chain(own).chain(supports).collect();
    }
    let [fix, free] = supports;
    let mut entries = vec![
        name,
        ("kind", kind.into()),
        ("geometry", geometry.into()),
        ("duration", step.duration.into()),
        ("increments", increments(&step.increments)),
        fix,
        ("move", tables(&step.moves, motions)),
        free,
        ("load", tables(&step.loads, load)),
        ("contact", tables(&step.contacts, contact_change)),
        ("material", tables(&step.materials, material)),
        ("activate", tables(&step.activations, activation)),
        ("deactivate", tables(&step.deactivations, deactivation)),
        ("temperature", tables(&step.temperatures, temperature)),
    ];
    entries.extend(step.thermal.map(thermal));
    entries.extend(step.dynamics.as_ref().map(|dynamics| {
        let (method, number) = match dynamics.method {
            DynamicMethod::GeneralizedAlpha(rho_inf) => {
                ("generalized-alpha", Some(("rho_inf", rho_inf.into())))
            }
            DynamicMethod::HilberHughesTaylor(alpha) => {
                ("generalized-alpha", Some(("alpha", alpha.into())))
            }
            DynamicMethod::EnergyMomentum => ("energy-momentum", None),
            DynamicMethod::Explicit { safety, scaling } => {
                return ("dynamics", explicit(safety, scaling));
            }
        };
        let contact_mass = match *dynamics.redistributed {
            true => "redistributed",
            false => "as-is",
        };
        let mut entries = vec![("method", method.into())];
        entries.extend(number);
        entries.push(("contact_mass", contact_mass.into()));
        entries.extend(
            dynamics
                .weighted
                .then(|| ("contact_force", "weighted".into())),
        );
        entries.extend([
            ("error_tol", dynamics.error_tol.into()),
            ("impact_step", dynamics.impact_step.into()),
        ]);
        ("dynamics", Value::Table(entries))
    }));
    entries.extend(step.prints.as_ref().map(|prints| {
        // an empty list says that earlier ones end
        let none = || list(Vec::<Value>::new());
        let written = if prints.is_empty() {
            none()
        } else {
            tables(prints, print)
        };
        ("print", written)
    }));
    entries
}

fn freed(one: &Free) -> Entries {
    let mut entries = held(&one.on, one.u, one.rot);
    entries.extend(one.temperature.then(|| ("temperature", true.into())));
    entries
}

fn thermal(thermal: Thermal) -> (&'static str, Value) {
    let word = match thermal.transient {
        true => "transient",
        false => "steady",
    };
    ("thermal", word.into())
}

/// The method of an explicit step, which has nothing else to say.
fn explicit(safety: f64, scaling: Option<MassScaling>) -> Value {
    let scaling = scaling.map(|of| {
        let entries = vec![("step", of.step.into()), ("limit", of.limit.into())];
        ("mass_scaling", Value::Table(entries))
    });
    let own = [("method", "explicit".into()), ("safety", safety.into())];
    Value::Table(own.into_iter().chain(scaling).collect())
}

fn increments(increments: &Increments) -> Value {
    match increments {
        Increments::Count(count) => (*count).into(),
        Increments::Fixed(count) => Value::Table(vec![("fixed", (*count).into())]),
        Increments::Adaptive {
            initial,
            min,
            max,
            count_max,
        } => Value::Table(vec![
            ("initial", (*initial).into()),
            ("min", (*min).into()),
            ("max", (*max).into()),
            ("count_max", (*count_max).into()),
        ]),
    }
}

fn held(on: &Name, u: Directions, rot: Directions) -> Entries {
    let mut entries = vec![("on", (&on.value).into())];
    for (key, directions) in [("u", u), ("rot", rot)] {
        if !directions.is_empty() {
            entries.push((key, axes(directions)));
        }
    }
    entries
}

pub(super) fn axes(directions: Directions) -> Value {
    if directions == Directions::ALL {
        return "all".into();
    }
    let axes = ["x", "y", "z"].into_iter().zip(directions.xyz);
    list(axes.filter(|(_, held)| *held).map(|(axis, _)| axis))
}

fn motions(one: &Move) -> Entries {
    let mut entries = vec![("on", (&one.on.value).into())];
    let keys = ["ux", "uy", "uz", "rx", "ry", "rz"];
    for (key, motion) in keys.into_iter().zip(one.u.iter().chain(&one.rot)) {
        entries.extend(motion.as_ref().map(|motion| (key, course(motion))));
    }
    entries.extend(
        one.from
            .as_ref()
            .map(|from| ("from", Value::Table(global_model(from)))),
    );
    entries
}

fn global_model(from: &GlobalModel) -> Entries {
    let at = match from.at {
        GlobalTime::Step(step) => ("step", step.into()),
        GlobalTime::Set(set) => ("data_set", set.into()),
    };
    let mut entries: Entries = vec![
        ("file", from.file.value.to_string_lossy().as_ref().into()),
        at,
    ];
    if !from.elements.is_empty() {
        entries.push(("elements", list(from.elements.iter().copied())));
    }
    entries.push(("u", axes(from.u)));
    entries.push(("ramp", from.ramp.into()));
    entries
}

fn course(motion: &Motion) -> Value {
    match motion {
        Motion::Ramp(value) => (*value).into(),
        Motion::Table(table) => Value::Table(vec![("table", list(table))]),
        Motion::Amplitude { name, value } => Value::Table(vec![
            ("amplitude", (&name.value).into()),
            ("value", (*value).into()),
        ]),
    }
}

fn load(load: &Load) -> Entries {
    let mut entries: Entries = Vec::new();
    entries.extend(
        load.name
            .as_ref()
            .map(|name| ("name", (&name.value).into())),
    );
    entries.push(("on", (&load.on.value).into()));
    entries.push(chosen(&load.kind));
    entries.extend(
        load.follows
            .as_ref()
            .map(|follows| ("follows", follows.value.into())),
    );
    let coupling = match load.coupling.as_deref() {
        None => "none",
        Some(Axis::X) => "rigid-x",
        Some(Axis::Y) => "rigid-y",
        Some(Axis::Z) => "rigid-z",
    };
    entries.push(("coupling", coupling.into()));
    match &load.course {
        Course::Ramp => {}
        Course::Table(table) => entries.push(("table", list(table))),
        Course::Amplitude(name) => entries.push(("amplitude", (&name.value).into())),
    }
    entries
}

fn material(one: &MaterialChange) -> Entries {
    vec![
        ("group", (&one.group.value).into()),
        ("material", (&one.material.value).into()),
    ]
}

fn activation(one: &Activation) -> Entries {
    let strain = match one.strain {
        StrainAt::Free => "free",
        StrainAt::Keep => "keep",
    };
    vec![
        ("group", (&one.group.value).into()),
        ("strain", strain.into()),
    ]
}

fn deactivation(one: &Deactivation) -> Entries {
    vec![
        ("group", (&one.group.value).into()),
        ("ramp", one.ramp.into()),
    ]
}

fn temperature(one: &Temperature) -> Entries {
    let mut entries = vec![
        ("on", (&one.on.value).into()),
        ("value", course(&one.value)),
    ];
    let gradient = one.gradient.as_ref();
    entries.extend(gradient.map(|gradient| ("gradient", gradient.value.into())));
    entries
}

fn print(one: &Print) -> Entries {
    let totals = match one.totals {
        Totals::No => "no",
        Totals::Yes => "yes",
        Totals::Only => "only",
    };
    let mut entries: Entries = Vec::new();
    entries.extend(one.on.as_ref().map(|on| ("on", (&on.value).into())));
    entries.extend([
        (one.of.key(), names(&one.quantities)),
        ("totals", totals.into()),
        ("local", one.local.into()),
        ("every", one.every.into()),
    ]);
    entries
}
