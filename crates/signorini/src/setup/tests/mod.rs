//! Cases as text, and the parts they become.

mod bodies;
mod constraints;
mod contacts;
mod sets;
mod steps;

use super::carriers::Carriers;
use super::names::Names;
use super::*;
use signorini_io::case::{read_case, resolved};
use signorini_mechanics::model::{Change, StepPart, Target};
use std::path::Path;

/// Two unit cubes, one on the other and apart by nothing but their nodes; a bar next to them.
const CUBES: &str = r#"
[mesh]
nodes = [
  [1, 0, 0, 0], [2, 1, 0, 0], [3, 1, 1, 0], [4, 0, 1, 0],
  [5, 0, 0, 1], [6, 1, 0, 1], [7, 1, 1, 1], [8, 0, 1, 1],
  [11, 0, 0, 1], [12, 1, 0, 1], [13, 1, 1, 1], [14, 0, 1, 1],
  [15, 0, 0, 2], [16, 1, 0, 2], [17, 1, 1, 2], [18, 0, 1, 2],
  [21, 3, 0, 0], [22, 3, 0, 2], [99, 9, 9, 1],
]
elements = [
  { id = 1, type = "hex8", group = "low", nodes = [1, 2, 3, 4, 5, 6, 7, 8] },
  { id = 2, type = "hex8", group = "high", nodes = [11, 12, 13, 14, 15, 16, 17, 18] },
  { id = 3, type = "line2", group = "bar", nodes = [21, 22] },
]
[material.steel]
model = "linear-elastic"
E = 210e3
nu = 0.3
[[body]]
group = "low"
material = "steel"
"#;

const BASE: &str = "[sets]\nbase = { plane = 'z', at = 0, of = 'low' }\n";
const STEP: &str = "[[step]]\nname = 'one'\n[[step.fix]]\non = 'base'\nu = 'all'\n";

/// The comparable content of parts, with the warnings.
struct Built {
    text: String,
    springs: Vec<signorini_mechanics::model::SpringPart>,
    constraints: Vec<signorini_mechanics::model::ConstraintPart>,
    carriers: Vec<signorini_mechanics::model::CarrierPart>,
    steps: Vec<StepPart>,
    bodies: Vec<signorini_mechanics::model::BodyPart>,
    temperature: Vec<f64>,
    contacts: Vec<signorini_mechanics::model::ContactPart>,
    warnings: Diagnostics,
    case: Case,
}

fn try_parts(text: &str) -> Result<Built, Diagnostics> {
    let (mut case, found) = read_case("case.toml", text.as_bytes(), &[], crate::vocabulary())?;
    let (mesh, _) = read_mesh_of(&case, Path::new("."))?;
    let (mut mesh, shells, mut found) = shells::expanded(&case, mesh, found)?;
    let cuts = Cuts::new(&case, &mut mesh, &mut found);
    let names = Names::new(&case, &mesh, &shells, &mut found);
    let carriers = Carriers::new(&case, &names, &mut found);
    let (parts, start) = match parts(
        &case,
        &mesh,
        &Own::default(),
        (&names, &carriers, &cuts),
        &mut found,
    ) {
        Some(parts) if !found.has_errors() => parts,
        _ => return Err(found),
    };
    let text = format!(
        "{:?} {:?} {:?} {:?} {:?} {:?} {:?}",
        parts.space,
        parts.carriers,
        parts.springs,
        parts.constraints,
        parts.contacts,
        parts.temperature,
        parts.steps
    );
    let built = (
        parts.springs,
        parts.constraints,
        parts.carriers,
        parts.steps,
        parts.bodies,
        parts.temperature,
        parts.contacts,
    );
    case.initial_temperature = start.map(Spanned::from);
    let (springs, constraints, carriers, steps, bodies, temperature, contacts) = built;
    Ok(Built {
        text,
        springs,
        constraints,
        carriers,
        steps,
        bodies,
        temperature,
        contacts,
        warnings: found,
        case,
    })
}

#[track_caller]
fn parts_of(text: &str) -> Built {
    try_parts(text).unwrap_or_else(|all| panic!("{all}"))
}

/// The parts of the cubes with more behind them.
#[track_caller]
fn cubes(more: &str) -> Built {
    parts_of(&format!("{CUBES}{BASE}{more}"))
}

/// What is said about the cubes with more behind them: the code of its first error, and all of it.
#[track_caller]
fn refused(more: &str) -> (&'static str, String) {
    let all = try_parts(&format!("{CUBES}{BASE}{more}")).err().unwrap();
    let first = all.iter().next().map_or("", |one| one.code.id);
    (first, all.plain())
}

fn labels(mesh_nodes: &[NodeId]) -> Vec<u64> {
    const LABELS: [u64; 19] = [
        1, 2, 3, 4, 5, 6, 7, 8, 11, 12, 13, 14, 15, 16, 17, 18, 21, 22, 99,
    ];
    mesh_nodes.iter().map(|&n| LABELS[n as usize]).collect()
}

fn fixed(step: &StepPart) -> Vec<u64> {
    match &step.changes[0] {
        Change::Prescribe(Target::Nodes(nodes), _) => labels(nodes),
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_cannot_be_is_refused_with_its_reason() {
    let top = "top = { plane = 'z', at = 1, of = 'low' }\nedge = { nodes = [5, 6] }\n";
    let pilot = "[reference.pilot]\nat = [0, 0, 5]\n";
    let load = |what: &str| format!("{top}{pilot}{STEP}[[step.load]]\n{what}\n");
    for (more, code, word) in [
        (
            load("on = 'edge'\npressure = 1"),
            "S0203",
            "a pressure needs some",
        ),
        (
            load("on = 'top'\nforce = [1, 0, 0]\nfollows = true"),
            "S0112",
            "keeps its direction",
        ),
        (
            load("on = 'pilot'\nforce = [1, 0, 0]"),
            "S0112",
            "moves nothing",
        ),
        (
            load("on = 'low'\ngravity = [1, 0, 0]"),
            "S0106",
            "no `density`",
        ),
        (
            load("on = 'high'\nbody_force = [1, 0, 0]"),
            "S0203",
            "in no body that deforms",
        ),
        (
            load("on = 'nowhere'\nforce = [1, 0, 0]"),
            "S0201",
            "nowhere",
        ),
        (format!("{STEP}rot = 'all'\n"), "S0203", "have no rotations"),
        (
            format!("{STEP}[[step.move]]\non = 'base'\nrx = 1\n"),
            "S0203",
            "have no rotations",
        ),
        (
            format!(
                "a = {{ nodes = [1, 2, 3] }}\n[[constraint]]\nequation = [['a', 'x', 1], ['base', 'x', 1]]\n{STEP}"
            ),
            "S0203",
            "cannot be paired",
        ),
        (
            format!("[[constraint]]\nequation = [['base', 'rx', 1]]\n{STEP}"),
            "S0203",
            "have no rotations",
        ),
        (
            format!(
                "a = {{ nodes = [5] }}\nb = {{ nodes = [11] }}\n[[spring]]\nname = 's'\nbetween = ['a', 'b']\nstiffness = 1\n{STEP}"
            ),
            "S0106",
            "has no length",
        ),
        (
            format!("[reference.pilot]\nnode = 1000\n{STEP}"),
            "S0201",
            "no node 1000",
        ),
    ] {
        let (found, text) = refused(&more);
        assert!(
            found == code && text.contains(word),
            "{code} {word}: {text}"
        );
    }
}

#[test]
fn a_resolved_case_becomes_the_same_parts() {
    let text = "[reference.pilot]\nat = [0, 0, 5]\n[[body]]\ngroup = 'high'\nrigid = true\nreference = 'pilot'\n\
        [[spring]]\nname = 's'\nbetween = ['base', 'top']\nstiffness = 3\n\
        [[constraint]]\nkind = 'equal'\non = 'top'\ndofs = ['x']\n[[contact]]\nname = 'c'\nsecondary = 'high'\nprimary = 'top'\n\
        method = 'gauss-point'\nfriction = { mu = 0.3, cap = 2 }\nstart = { clearance = 0.1 }\n";
    let steps = "[[step.contact]]\nname = 'c'\nactive = false\n[[step.load]]\non = 'top'\npressure = 0.5\ntable = [[0, 0], [1, 2]]\n[[step.temperature]]\non = 'all'\nvalue = 50\n\
        [[step]]\nname = 'two'\n[[step.free]]\non = 'base'\nu = ['x']\n[[step.load]]\non = 'all'\ngravity = [0, 0, -1]\n";
    let text = format!(
        "{CUBES}{BASE}top = {{ plane = [0, 0, 3], at = 1, of = 'low' }}\n{text}{STEP}{steps}"
    );
    let text = text.replace(
        "nu = 0.3",
        "nu = 0.3\ndensity = 2.0\nexpansion = { alpha = 1e-5, reference = 20 }",
    );
    let first = parts_of(&text);
    let second = parts_of(&resolved(&first.case, crate::vocabulary()));
    assert_eq!(first.text, second.text);
    assert_eq!(
        resolved(&first.case, crate::vocabulary()),
        resolved(&second.case, crate::vocabulary())
    );
}
