//! Recorded states that are wrong cause alarm, each with its cause; states that are right cause none.
//!
//! The states in `data/audit` were computed by the program of commit bce21ec, before it was mended: displacements of all
//! nodes, reactions, and the contact's report on its nodes. `data/audit/make.py` writes the cases. No equation is solved
//! here: the state is set, and the audit is run on it.
#![allow(clippy::unwrap_used, clippy::panic)]

mod common;

use common::{model, repository, run};
use serde_json::Value;
use signorini_geometry::tensor::Vec3;
use signorini_mechanics::audit::viscous;
use signorini_mechanics::system::{
    Check, ContactAudit, Frame, Measured, Phase, Status, StepContext,
};

/// A recorded state, audited.
struct Judged {
    contacts: Vec<ContactAudit>,
    viscous: Measured,
}

impl Judged {
    /// The checks that fail.
    fn failures(&self) -> Vec<Check> {
        let contacts = self.contacts.iter();
        contacts
            .flat_map(|c| c.failures().map(|(check, _)| check))
            .collect()
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().unwrap();
    list.iter()
        .map(|v| v.as_f64().unwrap_or(f64::NAN))
        .collect()
}

fn vectors(value: &Value) -> Vec<Vec3> {
    let vector = |v: &Value| {
        let c = numbers(v);
        Vec3::new(c[0], c[1], c.get(2).copied().unwrap_or(0.0))
    };
    value.as_array().unwrap().iter().map(vector).collect()
}

fn status(number: f64) -> Status {
    let all = [Status::Open, Status::Stick, Status::Slip, Status::Tied];
    let found = all.into_iter().find(|s| f64::from(s.number()) == number);
    found.unwrap_or(Status::Absent)
}

/// The state in `data/audit/NAME.json` of the case next to it; `change` spoils or mends it.
fn judged(name: &str, change: impl FnOnce(&mut Frame)) -> Judged {
    let folder = repository().join("crates/signorini/tests/data/audit");
    let text = std::fs::read_to_string(folder.join(format!("{name}.toml"))).unwrap();
    let stored = std::fs::read_to_string(folder.join(format!("{name}.json"))).unwrap();
    let stored: Value = serde_json::from_str(&stored).unwrap();
    let mut built = model(&format!("{name}.toml"), &text, &[]);
    let system = &mut built.system;
    let mut state = system.initial_state();
    let displacement = vectors(&stored["displacement"]);
    for (node, u) in displacement.iter().enumerate() {
        for axis in 0..system.layout.ndim() {
            state.u[system.layout.node(node as u32, axis) as usize] = u[axis];
        }
        state.x[node] = system.reference[node] + *u;
    }
    state.time = stored["time"].as_f64().unwrap();
    let step = StepContext {
        number: stored["step"].as_u64().unwrap() as usize,
        nonlinear: stored["nonlinear"].as_bool().unwrap(),
        ..StepContext::default()
    };
    let mut frame = Frame::new(system.layout.nnode(), &system.ncell);
    frame.displacement = displacement;
    frame.reaction_force = vectors(&stored["reaction"]);
    for term in &mut system.terms {
        term.begin(&Phase::of_step(step), &state).unwrap();
        term.report(&state, &mut frame).unwrap();
    }
    let contact = &mut frame.contacts[0];
    assert_eq!(
        contact
            .nodes
            .iter()
            .map(|n| f64::from(*n))
            .collect::<Vec<_>>(),
        numbers(&stored["nodes"])
    );
    contact.pressure = numbers(&stored["pressure"]);
    contact.pressure_max = contact.pressure.iter().copied().fold(0.0, f64::max);
    contact.area = numbers(&stored["area"]);
    contact.traction = vectors(&stored["traction"]);
    contact.slip = vectors(&stored["slip"]);
    contact.status = numbers(&stored["status"]).into_iter().map(status).collect();
    let works = numbers(&stored["works"]);
    (frame.work_external, frame.work_turnover, frame.work_jumps) = (works[0], works[1], works[2]);
    change(&mut frame);
    Judged {
        contacts: built.system.audit(&state, &frame),
        viscous: viscous(&frame),
    }
}

#[test]
fn pressure_where_surfaces_are_apart_causes_alarm() {
    for name in ["tooth", "kink", "kink_quadratic", "gear", "convex"] {
        let judged = judged(name, |_| {});
        let apart = judged.contacts[0].of(Check::Apart);
        assert!(
            !apart.passes() && !apart.nodes.is_empty(),
            "{name}: {apart:?}"
        );
    }
}

#[test]
fn a_set_that_presses_on_itself_causes_alarm() {
    let judged = judged("two_blocks", |_| {});
    let failures = judged.failures();
    assert!(failures.contains(&Check::Apart), "{:?}", judged.contacts);
}

#[test]
fn pressure_along_the_normal_of_a_facet_that_has_tilted_causes_alarm() {
    let judged = judged("dragged", |_| {});
    assert_eq!(
        judged.failures(),
        [Check::Direction],
        "{:?}",
        judged.contacts
    );
}

#[test]
fn a_joint_that_pulls_at_a_support_causes_alarm() {
    let judged = judged("tie", |_| {});
    assert_eq!(judged.failures(), [Check::Stress], "{:?}", judged.contacts);
}

#[test]
fn a_jump_to_another_state_causes_alarm() {
    let judged = judged("rotation", |_| {});
    assert!(!judged.viscous.passes(), "{:?}", judged.viscous);
    assert_eq!(judged.failures(), []);
}

/// A block that is dragged until a part of it slips: points inside of facets that stick next to others that slip, and the shear of
/// the nodes between them, are as friction says.
#[test]
fn a_block_that_slips_in_part_is_right() {
    let (across, up) = (4, 2);
    let row = across + 1;
    let nodes: Vec<String> = (0..row * (up + 1))
        .map(|k| {
            let (x, y) = (k % row, k / row);
            format!("[{}, {:?}, {:?}]", k + 1, 0.5 * x as f64, 0.5 * y as f64)
        })
        .collect();
    let elements: Vec<String> = (0..across * up)
        .map(|k| {
            let a = k / across * row + k % across + 1;
            let around = [a, a + 1, a + row + 1, a + row];
            format!(
                "{{ id = {}, type = \"quad4\", group = \"b\", nodes = {around:?} }}",
                k + 1
            )
        })
        .collect();
    let faces: Vec<String> = (1..=across).map(|k| format!("[{k}, \"-y\"]")).collect();
    for method in ["gauss-point", "node-to-segment"] {
        for friction in [0.15, 0.3, 0.6] {
            let text = format!(
                "allow = [\"S0414\"]\n[mesh]\nnodes = [{}]\nelements = [{}]\n[model]\nspace = \"plane-strain\"\n\
                 [material.m]\nmodel = \"linear-elastic\"\nE = 100.0\nnu = 0.3\n[[body]]\ngroup = \"b\"\nmaterial = \"m\"\n\
                 [sets]\nfoot = {{ faces = [{}] }}\nhead = {{ plane = \"y\", at = 1.0 }}\n\
                 [[surface]]\nname = \"floor\"\nshape = {{ plane = {{ point = [0, 0], normal = \"y\" }} }}\n\
                 [[contact]]\nname = \"c\"\nsecondary = \"foot\"\nprimary = \"floor\"\nmethod = \"{method}\"\n\
                 enforcement = {{ penalty = 1e4, per = \"area\" }}\nfriction = {friction:?}\n\
                 [[step]]\nname = \"press\"\nincrements = 1\ngeometry = \"linear\"\nmove = [{{ on = \"head\", uy = -0.05, ux = 0.0 }}]\n\
                 [[step]]\nname = \"drag\"\nincrements = 4\ngeometry = \"linear\"\nmove = [{{ on = \"head\", uy = -0.05, ux = 0.03 }}]\n",
                nodes.join(", "),
                elements.join(", "),
                faces.join(", "),
            );
            let done = run(&mut model("part", &text, &[]));
            assert!(
                done.error.is_none(),
                "{method} {friction}: {:?}",
                done.error
            );
            for frame in &done.frames {
                let found: Vec<Check> = frame
                    .audits
                    .iter()
                    .flat_map(|audit| audit.failures().map(|(check, _)| check))
                    .collect();
                assert!(found.is_empty(), "{method} {friction}: {found:?}");
            }
        }
    }
}
