//! A case as text with every default filled in: what was really run.
//!
//! The vocabulary gives the order of the keys and the remark behind each of them; reading the text gives the same case.

use std::fmt::Write as _;

use super::parts::*;
use super::vocabulary::{CASE, Shape, Table};

/// A case as a complete TOML text, which reads back to the same case.
pub fn resolved(case: &Case) -> String {
    let mut text = String::new();
    write_table(&mut text, &CASE, "", &tree(case));
    text
}

/// A value as it is to be written.
enum Value {
    Text(String),
    Number(f64),
    Count(u64),
    Flag(bool),
    List(Vec<Value>),
    /// A table that the vocabulary knows.
    Table(Entries),
    /// Tables by names of the user's choice, or a list of tables.
    Tables(Vec<(Option<String>, Entries)>),
}

type Entries = Vec<(&'static str, Value)>;

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Value::Text(text.to_owned())
    }
}

impl From<&String> for Value {
    fn from(text: &String) -> Self {
        Value::Text(text.clone())
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Value::Number(number)
    }
}

impl From<u64> for Value {
    fn from(number: u64) -> Self {
        Value::Count(number)
    }
}

impl From<bool> for Value {
    fn from(flag: bool) -> Self {
        Value::Flag(flag)
    }
}

impl<const N: usize> From<&[f64; N]> for Value {
    fn from(row: &[f64; N]) -> Self {
        list(row.iter().copied())
    }
}

fn list<T: Into<Value>>(items: impl IntoIterator<Item = T>) -> Value {
    Value::List(items.into_iter().map(Into::into).collect())
}

fn tree(case: &Case) -> Entries {
    let mut entries = vec![
        ("format", u64::from(case.format).into()),
        ("title", (&case.title).into()),
        ("units", (&case.units.value).into()),
        ("allow", list(&case.allow)),
        ("mesh", Value::Table(mesh(&case.mesh))),
        ("model", Value::Table(model(&case.model))),
    ];
    entries.extend([
        (
            "sets",
            named(&case.sets, |set| (&set.name, set_content(&set.content))),
        ),
        (
            "amplitude",
            named(&case.amplitudes, |one| (&one.name, amplitude(one))),
        ),
        (
            "material",
            named(&case.materials, |one| (&one.name, material(one))),
        ),
        ("body", tables(&case.bodies, body)),
        ("contact", tables(&case.contacts, contact)),
        ("step", tables(&case.steps, step)),
        ("solver", Value::Table(solver(&case.solver))),
        ("output", Value::Table(output(&case.output))),
        ("checkpoint", Value::Table(checkpoint(&case.checkpoint))),
        ("expect", tables(&case.expectations, expectation)),
    ]);
    entries
}

fn named<'a, T>(items: &'a [T], entry: impl Fn(&'a T) -> (&'a Name, Entries)) -> Value {
    let entries = items.iter().map(|one| {
        let (name, entries) = entry(one);
        (Some(name.value.clone()), entries)
    });
    Value::Tables(entries.collect())
}

fn tables<T>(items: &[T], entries: impl Fn(&T) -> Entries) -> Value {
    Value::Tables(items.iter().map(|one| (None, entries(one))).collect())
}

fn names<'a>(items: impl IntoIterator<Item = &'a Name>) -> Value {
    list(items.into_iter().map(|name| &name.value))
}

fn mesh(mesh: &MeshSource) -> Entries {
    match mesh {
        MeshSource::File { path } => vec![("file", (&path.value).into())],
        MeshSource::Inline {
            nodes, elements, ..
        } => {
            let row = |(id, [x, y, z]): &(u64, [f64; 3])| {
                Value::List(vec![(*id).into(), (*x).into(), (*y).into(), (*z).into()])
            };
            let element = |one: &InlineElement| {
                let mut entries: Entries = vec![
                    ("id", one.id.into()),
                    ("type", (&one.element_type.value).into()),
                ];
                entries.extend(
                    one.group
                        .as_ref()
                        .map(|group| ("group", (&group.value).into())),
                );
                entries.push(("nodes", list(one.nodes.iter().copied())));
                Value::Table(entries)
            };
            vec![
                ("nodes", Value::List(nodes.iter().map(row).collect())),
                (
                    "elements",
                    Value::List(elements.iter().map(element).collect()),
                ),
            ]
        }
    }
}

fn model(model: &Model) -> Entries {
    match *model.space {
        Space::ThreeD => vec![("space", "3d".into())],
        Space::PlaneStrain => vec![
            ("space", "plane-strain".into()),
            ("thickness", model.thickness.into()),
        ],
    }
}

fn set_content(content: &SetContent) -> Entries {
    vec![match content {
        SetContent::Nodes(nodes) => ("nodes", list(nodes.iter().copied())),
        SetContent::Faces(faces) => {
            let row = |(element, side): &(u64, Side)| {
                Value::List(vec![(*element).into(), Value::Text(side.to_string())])
            };
            ("faces", Value::List(faces.iter().map(row).collect()))
        }
        SetContent::Union(members) => ("union", names(members)),
    }]
}

impl std::fmt::Display for Side {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Side::Numbered(side) => write!(out, "S{side}"),
            Side::Axis(axis, sense) => {
                let sign = if *sense == Sense::Plus { '+' } else { '-' };
                let axis = match axis {
                    Axis::X => 'x',
                    Axis::Y => 'y',
                    Axis::Z => 'z',
                };
                write!(out, "{sign}{axis}")
            }
        }
    }
}

fn amplitude(one: &Amplitude) -> Entries {
    let time = match one.time {
        TimeBase::Step => "step",
        TimeBase::Total => "total",
    };
    vec![("table", list(&one.table)), ("time", time.into())]
}

fn material(one: &Material) -> Entries {
    let mut entries = vec![
        ("model", (&one.model.value).into()),
        ("E", one.young.value.into()),
        ("nu", one.poisson.value.into()),
    ];
    entries.extend(
        one.density
            .as_ref()
            .map(|density| ("density", density.value.into())),
    );
    entries
}

fn body(body: &Body) -> Entries {
    let mut entries = vec![("group", names(&body.groups))];
    entries.extend(
        body.material
            .as_ref()
            .map(|name| ("material", (&name.value).into())),
    );
    entries.push(("rigid", body.rigid.into()));
    entries
}

fn contact(contact: &Contact) -> Entries {
    let method = match *contact.method {
        Method::Auto => "auto",
        Method::NodeToSegment => "node-to-segment",
    };
    vec![
        ("name", (&contact.name.value).into()),
        ("secondary", (&contact.secondary.value).into()),
        ("primary", (&contact.primary.value).into()),
        ("method", method.into()),
        ("enforcement", enforcement(&contact.enforcement)),
        ("friction", contact.friction.value.into()),
        ("sliding", "finite".into()),
        ("passes", 1_u64.into()),
        ("tied", false.into()),
        ("reach", contact.reach.map_or("auto".into(), Value::Number)),
        ("active", contact.active.into()),
    ]
}

fn enforcement(enforcement: &Enforcement) -> Value {
    match enforcement {
        Enforcement::Auto => "auto".into(),
        Enforcement::Penalty { penalty, per } => {
            let penalty = penalty
                .as_ref()
                .map_or("auto".into(), |penalty| Value::Number(penalty.value));
            let mut entries = vec![("penalty", penalty)];
            entries.extend(
                per.map(|per| ("per", if per == Per::Node { "node" } else { "area" }.into())),
            );
            Value::Table(entries)
        }
    }
}

fn step(step: &Step) -> Entries {
    let geometry = match step.geometry {
        Geometry::Auto => "auto",
        Geometry::Linear => "linear",
        Geometry::Nonlinear => "nonlinear",
    };
    vec![
        ("name", (&step.name.value).into()),
        ("kind", "static".into()),
        ("geometry", geometry.into()),
        ("duration", step.duration.into()),
        ("increments", increments(&step.increments)),
        (
            "fix",
            tables(&step.fixes, |one| held(&one.on, one.u, one.rot)),
        ),
        ("move", tables(&step.moves, motions)),
        (
            "free",
            tables(&step.frees, |one| held(&one.on, one.u, one.rot)),
        ),
        ("load", tables(&step.loads, load)),
    ]
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
        if directions == Directions::ALL {
            entries.push((key, "all".into()));
        } else if !directions.is_empty() {
            let axes = ["x", "y", "z"].into_iter().zip(directions.xyz);
            entries.push((
                key,
                list(axes.filter(|(_, held)| *held).map(|(axis, _)| axis)),
            ));
        }
    }
    entries
}

fn motions(one: &Move) -> Entries {
    let mut entries = vec![("on", (&one.on.value).into())];
    let keys = ["ux", "uy", "uz", "rx", "ry", "rz"];
    for (key, motion) in keys.into_iter().zip(one.u.iter().chain(&one.rot)) {
        entries.extend(motion.as_ref().map(|motion| (key, course(motion))));
    }
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
    entries.push(match &load.kind {
        LoadKind::Force(force) => ("force", force.into()),
        LoadKind::PerNode(force) => ("per_node", force.into()),
    });
    entries
}

fn solver(solver: &Solver) -> Entries {
    let newton = &solver.newton;
    let line_search = match newton.line_search {
        LineSearch::Auto => "auto".into(),
        LineSearch::On => true.into(),
        LineSearch::Off => false.into(),
    };
    let remedies = solver.on_trouble.iter().map(|remedy| match remedy {
        Remedy::Cut => "cut",
        Remedy::Stabilize => "stabilize",
    });
    vec![
        (
            "newton",
            Value::Table(vec![
                ("max_iterations", newton.max_iterations.into()),
                ("force_tol", newton.force_tol.into()),
                ("gap_tol", newton.gap_tol.into()),
                ("line_search", line_search),
            ]),
        ),
        (
            "linear",
            if solver.linear == LinearChoice::Direct {
                "direct"
            } else {
                "auto"
            }
            .into(),
        ),
        (
            "stabilize",
            match solver.stabilize {
                Stabilize::Auto => "auto".into(),
                Stabilize::Off => false.into(),
            },
        ),
        ("on_trouble", list(remedies)),
        (
            "threads",
            solver.threads.map_or("auto".into(), Value::Count),
        ),
    ]
}

fn output(output: &Output) -> Entries {
    vec![
        ("format", names(&output.format)),
        ("fields", names(&output.fields)),
        (
            "every",
            match output.every {
                Every::Increments(count) => count.into(),
                Every::Time(time) => Value::Table(vec![("time", time.into())]),
            },
        ),
        ("names", "signorini".into()),
        ("history", tables(&output.history, history)),
    ]
}

fn history(one: &History) -> Entries {
    vec![
        ("name", (&one.name.value).into()),
        ("quantity", names(&one.quantities)),
        match &one.source {
            HistorySource::Contact(name) => ("contact", (&name.value).into()),
            HistorySource::Reference(name) => ("reference", (&name.value).into()),
            HistorySource::Node(node) => ("node", node.value.into()),
            HistorySource::Set(name) => ("set", (&name.value).into()),
        },
    ]
}

fn checkpoint(checkpoint: &Checkpoint) -> Entries {
    let mut every: Entries = Vec::new();
    every.extend(
        checkpoint
            .increments
            .map(|count| ("increments", count.into())),
    );
    every.extend(
        checkpoint
            .wall
            .map(|wall| ("wall", Value::Text(format!("{wall} s")))),
    );
    let mut entries: Entries = Vec::new();
    if !every.is_empty() {
        entries.push(("every", Value::Table(every)));
    }
    entries.push(("keep", checkpoint.keep.into()));
    entries
}

fn expectation(one: &Expectation) -> Entries {
    let mut entries = vec![("what", (&one.what.value).into())];
    match one.at {
        Moment::End => {}
        Moment::Row(row) => entries.push(("at", row.into())),
        Moment::Time(time) => entries.push(("time", time.into())),
    }
    entries.push(("value", one.value.into()));
    entries.push((
        "tol",
        Value::Table(vec![match one.tolerance {
            Tolerance::Relative(rel) => ("rel", rel.into()),
            Tolerance::Absolute(abs) => ("abs", abs.into()),
        }]),
    ));
    entries
}

/// Writes the keys of a table in the order of the vocabulary: values first, then tables below headings.
fn write_table(text: &mut String, words: &Table, path: &str, entries: &Entries) {
    let ordered = || {
        words.keys.iter().filter_map(|key| {
            let (_, value) = entries.iter().find(|(name, _)| *name == key.name)?;
            Some((key, value))
        })
    };
    for (key, value) in ordered().filter(|(key, value)| !has_heading(&key.shape, value, path)) {
        let written = inline(value, true);
        if written.contains('\n') {
            let _ = writeln!(text, "# {}\n{} = {written}", key.doc, key.name);
        } else {
            let _ = writeln!(
                text,
                "{:<40} # {}",
                format!("{} = {written}", key.name),
                key.doc
            );
        }
    }
    for (key, value) in ordered().filter(|(key, value)| has_heading(&key.shape, value, path)) {
        let full = if path.is_empty() {
            key.name.to_owned()
        } else {
            format!("{path}.{}", key.name)
        };
        match (&key.shape, value) {
            (Shape::Table(inner), Value::Table(entries)) => {
                let _ = writeln!(text, "\n[{full}]");
                write_table(text, inner, &full, entries);
            }
            (Shape::Tables(inner) | Shape::Named(inner), Value::Tables(tables)) => {
                for (name, entries) in tables {
                    match name {
                        Some(name) => {
                            let full = format!("{full}.{}", bare_or_quoted(name));
                            let _ = writeln!(text, "\n[{full}]");
                            write_table(text, inner, &full, entries);
                        }
                        None => {
                            let _ = writeln!(text, "\n[[{full}]]");
                            write_table(text, inner, &full, entries);
                        }
                    }
                }
            }
            _ => {}
        }
    }
}

/// Tables of the first level and lists of tables stand below headings of their own.
fn has_heading(shape: &Shape, value: &Value, path: &str) -> bool {
    match (shape, value) {
        (Shape::Table(_), Value::Table(_)) => path.is_empty(),
        (_, Value::Tables(_)) => true,
        _ => false,
    }
}

/// A value in one line; long lists of the outermost level get one line for each entry.
fn inline(value: &Value, outermost: bool) -> String {
    match value {
        Value::Text(text) => quoted(text),
        Value::Number(number) => format!("{number:?}"),
        Value::Count(number) => number.to_string(),
        Value::Flag(flag) => flag.to_string(),
        Value::List(items) => {
            let items: Vec<String> = items.iter().map(|one| inline(one, false)).collect();
            let nested = items
                .first()
                .is_some_and(|first| first.starts_with(['[', '{']));
            if outermost && nested && items.len() > 1 {
                format!("[\n  {},\n]", items.join(",\n  "))
            } else {
                format!("[{}]", items.join(", "))
            }
        }
        Value::Table(entries) => {
            let entries: Vec<String> = entries
                .iter()
                .map(|(key, value)| format!("{key} = {}", inline(value, false)))
                .collect();
            format!("{{ {} }}", entries.join(", "))
        }
        Value::Tables(_) => String::new(),
    }
}

fn bare_or_quoted(name: &str) -> String {
    let bare = !name.is_empty()
        && name
            .bytes()
            .all(|byte| byte.is_ascii_alphanumeric() || b"_-".contains(&byte));
    if bare { name.to_owned() } else { quoted(name) }
}

/// A basic string of TOML.
fn quoted(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            c if c.is_control() => {
                let _ = write!(out, "\\u{:04X}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}
