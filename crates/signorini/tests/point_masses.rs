//! Masses at nodes and of references, of decks and cases.
//!
//! SOURCE      Written for the purpose.
//! GOAL        Every MASS element of a deck counts once: in vibrations, in motions, and by its weight, where the deck says so
//! MESH        Springs, a bar, one element in the plane and in space, rigid bodies of one element, nodes alone
//! CONDITIONS  Free vibration, free fall, a moment on a rigid body, weight on supports
//! EXPECTED    Closed forms: √(k/m), g t²/2, J⁻¹ M t²/2, m g
//! TOLERANCE   1e-9: the trapezoidal rule and central differences are exact for constant forces
#![allow(clippy::unwrap_used, clippy::panic, clippy::indexing_slicing)]

use signorini::setup::Model;
use signorini::{Driver, Reading, RunOptions, Source, build, open_text};
use signorini_geometry::tensor::Vec3;
use signorini_io::fs::MemoryFs;
use signorini_mechanics::solve::Flow;
use signorini_mechanics::system::Frame;
use std::sync::Arc;

#[track_caller]
fn model(name: &str, text: &str) -> (Model, Source) {
    let opened = open_text(name.as_ref(), text.into(), &Reading::default());
    let loaded = opened.and_then(|opened| opened.with_mesh());
    let loaded = loaded.unwrap_or_else(|found| panic!("{}", found.plain()));
    let model = build(loaded.case, loaded.mesh).unwrap_or_else(|found| panic!("{}", found.plain()));
    (model, loaded.source)
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
    let mut driver = Driver::new(model(name, text).0).unwrap();
    let outcome = driver.advance(driver.end(), &mut |_| Flow::Continue);
    outcome
        .unwrap_or_else(|found| panic!("{}", found.plain()))
        .clone()
}

/// The natural frequencies of a deck (radian per time).
#[track_caller]
fn omegas(text: &str) -> Vec<f64> {
    let (mut model, source) = model("job.inp", text);
    let mut options = RunOptions::new(source);
    options.fs = Arc::new(MemoryFs::default());
    let finished = signorini::run(&mut model, &options, &mut ());
    assert_eq!(finished.exit_code, 0, "{}", finished.diagnostics.plain());
    let found = finished.summary.frequencies.last().unwrap();
    found.modes.iter().map(|mode| mode.omega).collect()
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

/// A cube of one element, and a node for its reference.
const CUBE: &str = "*NODE, NSET=ALL\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n9,.5,.5,2.\n\
                    *ELEMENT, TYPE=C3D8, ELSET=CUBE\n1,1,2,3,4,5,6,7,8\n*NSET, NSET=BASE\n1,2,3,4\n*NSET, NSET=BODY, GENERATE\n1,8\n";

fn section(density: f64, more: &str) -> String {
    format!(
        "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.2\n*DENSITY\n{density:?}\n*SOLID SECTION, ELSET=CUBE, MATERIAL=M\n{more}"
    )
}

/// MASS elements, and the card that gives them a value, in this order.
fn masses(nodes: &[u64], mass: f64, is_card_first: bool) -> String {
    let lines = nodes.iter().zip(20..);
    let lines: String = lines
        .map(|(node, label)| format!("{label}, {node}\n"))
        .collect();
    let elements = format!("*ELEMENT, TYPE=MASS, ELSET=P\n{lines}");
    let card = format!("*MASS, ELSET=P\n{mass:?}\n");
    match is_card_first {
        true => card + &elements,
        false => elements + &card,
    }
}

/// `√(k/m)`, of each node of a set, and of two elements at one.
#[test]
fn masses_on_springs_vibrate_as_they_should() {
    let springs = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,1,1,0\n*ELEMENT, TYPE=SPRINGA, ELSET=S\n1,1,2\n2,3,4\n\
                   *SPRING, ELSET=S\n\n100.\n*BOUNDARY\n1,1,3\n3,1,3\n2,2,3\n4,2,3\n";
    let step = "*STEP\n*FREQUENCY\n2\n*END STEP\n";
    for is_card_first in [false, true] {
        let both = masses(&[2, 4], 4.0, is_card_first);
        agree(
            "two nodes",
            &omegas(&format!("{springs}{both}{step}")),
            &[5.0, 5.0],
        );
        let twice = masses(&[2, 4, 4, 4, 4], 4.0, is_card_first);
        agree(
            "four at one",
            &omegas(&format!("{springs}{twice}{step}")),
            &[2.5, 5.0],
        );
    }
}

/// At the end of a bar, with a third of its mass, in the plane and in space.
#[test]
fn a_mass_on_a_bar_vibrates_with_a_third_of_it() {
    for (kind, held) in [("T2D2", "2,2"), ("T3D2", "2,2,3")] {
        let text = format!(
            "*NODE\n1,0,0\n2,2,0\n*ELEMENT, TYPE={kind}, ELSET=B\n1,1,2\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n\
             *DENSITY\n3.\n*SOLID SECTION, ELSET=B, MATERIAL=M\n0.5\n{}*BOUNDARY\n1,1,3\n{held}\n\
             *STEP\n*FREQUENCY\n1\n*END STEP\n",
            masses(&[2], 4.0, false)
        );
        let wanted: f64 = 1000.0 * 0.5 / 2.0 / (4.0 + 3.0 * 0.5 * 2.0 / 3.0);
        agree(kind, &omegas(&text), &[wanted.sqrt()]);
    }
}

/// Nodes alone, a body, and the rigid bodies of elements and of nodes: all fall by `g t²/2`.
#[test]
fn everything_with_a_mass_falls_alike() {
    let alone = format!("{CUBE}{}", section(2.0, ""));
    let nodes = "*RIGID BODY, NSET=BODY, REF NODE=9\n";
    let elements = "*RIGID BODY, ELSET=CUBE, REF NODE=9\n";
    let rigid = format!("{CUBE}{elements}");
    let without = (&*rigid, "P, GRAV, 10., 0., 0., -1.\n");
    let with = "P, GRAV, 10., 0., 0., -1.\nCUBE, GRAV, 10., 0., 0., -1.\n";
    for method in ["DIRECT, ALPHA=0.", "EXPLICIT"] {
        for (what, (text, load), at, seen) in [
            ("node", (&*alone, with), 9, 9),
            ("body", (&*alone, with), 7, 3),
            ("rigid", without, 9, 7),
            ("rigid off its reference", without, 7, 3),
        ] {
            let mass = masses(&[at], 0.5, false);
            let hold = if text.contains("RIGID") {
                "*BOUNDARY\n9,4,6\n"
            } else {
                ""
            };
            let text = format!(
                "{text}{mass}{hold}*STEP, INC=100000\n*DYNAMIC, {method}\n0.05, 1.\n*DLOAD\n{load}*END STEP\n"
            );
            let run = solved("job.inp", &text);
            let last = run.displacement[seen - 1];
            assert!((last.z + 5.0).abs() < 1e-6, "{what}, {method}: {last:?}");
        }
    }
    let heavy = format!(
        "{CUBE}{}{}*BOUNDARY\n9,4,6\n*STEP, INC=1000\n*DYNAMIC, DIRECT, ALPHA=0.\n0.05, 1.\n*CLOAD\n9, 3, 1.\n*END STEP\n",
        section(2.0, elements),
        masses(&[9], 0.5, false)
    );
    for text in [heavy.clone(), heavy.replace(elements, nodes)] {
        let last = solved("job.inp", &text).displacement[6];
        assert!((last.z - 0.2).abs() < 1e-9, "{last:?}");
    }
}

/// `J⁻¹ M t²/2` where rotations are small, about all axes and in the plane.
#[test]
fn a_moment_turns_a_rigid_body_by_its_rotary_inertia() {
    let rotary = "*ELEMENT, TYPE=ROTARYI, ELSET=R\n30, 9\n*ROTARY INERTIA, ELSET=R\n3., 4., 5., 0.5, -1., 2.\n";
    let moments = "*CLOAD\n9, 4, 1e-4\n9, 5, -2e-4\n9, 6, 3e-4\n9, 1, 1e-4\n";
    let step = |loads: &str| {
        format!("*STEP, INC=1000\n*DYNAMIC, DIRECT, ALPHA=0.\n0.05, 1.\n{loads}*END STEP\n")
    };
    let space = format!(
        "{CUBE}*RIGID BODY, ELSET=CUBE, REF NODE=9\n{rotary}{}{}",
        masses(&[9], 2.0, true),
        step(moments)
    );
    let run = solved("job.inp", &space);
    let last = &run.rigid[0];
    let turned = last.rotation * 2e4;
    // J times what it turned by, over t²/2, is the moment
    let (x, y, z) = (turned.x, turned.y, turned.z);
    let moment = [
        3.0 * x + 0.5 * y - z,
        0.5 * x + 4.0 * y + 2.0 * z,
        -x + 2.0 * y + 5.0 * z,
    ];
    agree("moment", &moment, &[1.0, -2.0, 3.0]);
    agree("force", &[last.displacement.x * 1e4], &[0.25]);
    let plane = format!(
        "*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n9,0,2\n*ELEMENT, TYPE=CPE4, ELSET=CUBE\n1,1,2,3,4\n\
         *RIGID BODY, ELSET=CUBE, REF NODE=9\n{rotary}{}{}",
        masses(&[9], 2.0, true),
        step("*CLOAD\n9, 6, 3e-4\n")
    );
    let run = solved("job.inp", &plane);
    let turned = run.rigid[0].rotation.z;
    agree("plane", &[turned * 1e4], &[0.3]);
}

fn total_reaction(frame: &Frame) -> Vec3 {
    frame.reaction_force.iter().copied().sum()
}

/// Supports bear `m g` of the elements that GRAV names, of sets of sets and single ones.
#[test]
fn supports_bear_the_masses_that_a_deck_names() {
    let more = "*ELEMENT, TYPE=MASS, ELSET=Q\n40, 7\n*MASS, ELSET=Q\n1.5\n*ELSET, ELSET=EALL\nCUBE, P, Q\n*BOUNDARY\nBASE,1,3\n";
    let body = format!(
        "{CUBE}{}{}{more}",
        section(3.0, ""),
        masses(&[6, 7, 7], 0.5, false)
    );
    for (on, wanted) in [
        ("P", 15.0),
        ("Q", 15.0),
        ("21", 5.0),
        ("CUBE", 30.0),
        ("EALL", 60.0),
    ] {
        let text =
            format!("{body}*STEP\n*STATIC\n*DLOAD\n{on}, GRAV, 10., 0., 0., -1.\n*END STEP\n");
        let borne = total_reaction(&solved("job.inp", &text));
        agree(on, &borne.to_array(), &[0.0, 0.0, wanted]);
    }
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
    let deck = |procedure: &str| {
        format!(
            "*NODE\n1,0,0,0\n{}*STEP\n*{procedure}\n0.1, 1.\n*DLOAD\nP, GRAV, 10., 0., 0., -1.\n*END STEP\n",
            masses(&[1], 2.0, false)
        )
    };
    let fallen = solved("job.inp", &deck("DYNAMIC, DIRECT, ALPHA=0."));
    agree("alone", &[fallen.displacement[0].z], &[-5.0]);
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
