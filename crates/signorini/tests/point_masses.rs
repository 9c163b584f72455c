//! Masses at nodes.
//!
//! SOURCE      Written for the purpose.
//! GOAL        Every mass has a weight, and has it once
//! MESH        One element in the plane, nodes alone
//! CONDITIONS  Free fall, weight on supports
//! EXPECTED    Closed forms: g t²/2, m g
//! TOLERANCE   1e-9: the trapezoidal rule and central differences are exact for constant forces
#![allow(clippy::unwrap_used, clippy::panic, clippy::indexing_slicing)]

use signorini::setup::Model;
use signorini::{Driver, Reading, build, open_text};
use signorini_geometry::tensor::Vec3;
use signorini_mechanics::solve::Flow;
use signorini_mechanics::system::Frame;

#[track_caller]
fn model(name: &str, text: &str) -> Model {
    let opened = open_text(name.as_ref(), text.into(), &Reading::default());
    let loaded = opened.and_then(|opened| opened.with_mesh());
    let loaded = loaded.unwrap_or_else(|found| panic!("{}", found.plain()));
    build(loaded.case, loaded.mesh).unwrap_or_else(|found| panic!("{}", found.plain()))
}

/// Why a model is refused.
#[track_caller]
fn refusal(name: &str, text: &str) -> String {
    let opened = open_text(name.as_ref(), text.into(), &Reading::default());
    let loaded = opened.and_then(|opened| opened.with_mesh());
    let loaded = loaded.unwrap_or_else(|found| panic!("{}", found.plain()));
    let built = build(loaded.case, loaded.mesh);
    built.err().map_or_else(String::new, |found| found.plain())
}

/// The end of a run.
#[track_caller]
fn solved(name: &str, text: &str) -> Frame {
    let mut driver = Driver::new(model(name, text)).unwrap();
    let outcome = driver.advance(driver.end(), &mut |_| Flow::Continue);
    outcome
        .unwrap_or_else(|found| panic!("{}", found.plain()))
        .clone()
}

#[track_caller]
fn agree(what: &str, got: &[f64], wanted: &[f64]) {
    assert_eq!(got.len(), wanted.len(), "{what}: {got:?}");
    for (got, wanted) in got.iter().zip(wanted) {
        let off = (got - wanted).abs();
        assert!(
            off <= 1e-9 * wanted.abs().max(1.0),
            "{what}: {got} for {wanted}"
        );
    }
}

fn total_reaction(frame: &Frame) -> Vec3 {
    frame.reaction_force.iter().copied().sum()
}

/// A square of density 3 with masses at three of its nodes, on its base.
fn square(more: &str, load: &str) -> String {
    format!(
        "[mesh]\nnodes = [[1, 0, 0], [2, 1, 0], [3, 1, 1], [4, 0, 1], [5, 3, 0]]\n\
         elements = [{{ id = 1, type = \"quad4\", group = \"e\", nodes = [1, 2, 3, 4] }}]\n\
         [model]\nspace = \"plane-stress\"\n\
         [material.m]\nmodel = \"linear-elastic\"\nE = 1000.0\nnu = 0.0\ndensity = 3.0\n\
         [sets]\nbase = {{ nodes = [1, 2] }}\ntop = {{ nodes = [3, 4] }}\nleft = {{ nodes = [1, 4] }}\n\
         [[mass]]\non = \"top\"\nvalue = 0.5\n[[mass]]\non = \"left\"\nvalue = 0.25\n{more}\
         [[step]]\nname = \"s\"\ngeometry = \"linear\"\n{load}\n"
    )
}

/// Gravity acts on masses at nodes by `all`, by the set that they are given to, and by any set of nodes; that of elements leaves
/// them out.
#[test]
fn gravity_acts_on_masses_at_nodes() {
    let body = "[[body]]\ngroup = \"e\"\nmaterial = \"m\"\n";
    for (on, wanted) in [
        ("all", 45.0),
        ("e", 30.0),
        ("top", 12.5),
        ("left", 10.0),
        ("base", 2.5),
    ] {
        let load = format!(
            "fix = [{{ on = \"base\", u = \"all\" }}]\nload = [{{ on = \"{on}\", gravity = [0.0, -10.0] }}]"
        );
        let borne = total_reaction(&solved("case.toml", &square(body, &load)));
        agree(on, &borne.to_array(), &[0.0, wanted, 0.0]);
    }
}

/// In statics nothing holds a node that has a mass alone: its weight would be lost.
#[test]
fn a_mass_alone_has_no_weight_in_statics() {
    let body = "[[body]]\ngroup = \"e\"\nmaterial = \"m\"\n[[mass]]\non = \"far\"\nvalue = 1.0\n";
    for on in ["all", "far"] {
        let load = format!(
            "fix = [{{ on = \"base\", u = \"all\" }}]\nload = [{{ on = \"{on}\", gravity = [0.0, -10.0] }}]"
        );
        let text = square(body, &load).replace("[sets]\n", "[sets]\nfar = { nodes = [5] }\n");
        let said = refusal("case.toml", &text);
        assert!(said.contains("node 5 has a mass alone"), "{said}");
        let dynamic = text.replace(
            "name = \"s\"",
            "name = \"s\"\nkind = \"dynamic\"\nduration = 1.0\nincrements = { fixed = 20 }",
        );
        let fallen = solved("case.toml", &dynamic);
        agree(on, &[fallen.displacement[4].y], &[-5.0]);
    }
}

/// A rigid body has the masses of its nodes: by `all` they weigh once.
#[test]
fn masses_of_a_rigid_body_weigh_once() {
    for material in ["", "material = \"m\"\n"] {
        let body = format!("[[body]]\ngroup = \"e\"\nrigid = true\n{material}");
        let load = "kind = \"dynamic\"\nduration = 1.0\nincrements = { fixed = 20 }\n\
                    load = [{ on = \"all\", gravity = [0.0, -10.0] }]";
        let run = solved("case.toml", &square(&body, load));
        let fallen: Vec<f64> = run.displacement[..4].iter().map(|u| u.y).collect();
        agree("fallen", &fallen, &[-5.0; 4]);
    }
}
