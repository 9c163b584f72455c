//! A cantilever whose tip meets a stop.
//!
//! SOURCE      Theory of beams: w = q L⁴/(8 EI) without the stop, R = 3 EI/L³ (w − g) with it
//! GOAL        the force of the stop, of a solid instead of a beam
//! MESH        40 × 2 quad4 with incompatible modes, 1 × 0.05
//! CONDITIONS  plane stress, nu = 0, EI = L = q = 1, stop at the gap 0.05 under the lower corner of the tip
//! EXPECTED    R = 0.225, tip at −0.05
//! TOLERANCE   1 %: shear bends the solid by 0.2 % more; the tip to round-off for multipliers
use crate::scene::{Scene, Side, equal};

#[test]
fn a_cantilever_is_held_by_the_stop_under_its_tip() {
    let height = 0.05f64;
    let young = 12.0 / height.powi(3);
    for (primary, by, exact) in [
        (
            "stop",
            "method = \"node-to-segment\"\nenforcement = { lagrange = {} }",
            true,
        ),
        (
            "anvil_top",
            "method = \"node-to-segment\"\nenforcement = { lagrange = {} }",
            true,
        ),
        (
            "anvil_top",
            "method = \"node-to-segment\"\nenforcement = { augmented = \"uzawa\" }",
            true,
        ),
        (
            "pin",
            "method = \"node-to-node\"\nnormals = [0.0, 1.0]\nenforcement = { lagrange = {} }",
            true,
        ),
        ("stop", "method = \"node-to-segment\"", false),
    ] {
        let mut scene = Scene::default();
        let beam = scene.grid(
            "beam",
            [&equal(0.0, 1.0, 40), &equal(0.0, height, 2)],
            |x, y| [x, y],
        );
        let anvil = scene.grid("anvil", [&[0.9, 1.1], &[-0.25, -0.05]], |x, y| [x, y]);
        let pin = scene.node(&[1.0, -0.05]);
        let under = scene.node(&[1.0, -0.1]);
        scene.cell("line2", "post", vec![pin, under]);
        scene.set("pin", &[pin]);
        scene.set("root", &beam.along(Side::Left));
        scene.set("tip", &[beam.nodes[0][40]]);
        scene.faces("anvil_top", &anvil.faces(Side::Top));
        scene.set("held", &[anvil.nodes.concat(), vec![pin, under]].concat());
        let run = scene
            .elastic("plane-stress", young, 0.0)
            .body(&["beam", "anvil"], "")
            .body(&["post"], "area = 1.0")
            .plane("stop", [0.0, -0.05], [0.0, 1.0])
            .contact("tip", primary, by)
            .step("load", 1)
            .fix("root", "xy")
            .fix("held", "xy")
            .load("beam", &format!("body_force = [0.0, {:?}]", -1.0 / height))
            .run();
        let frame = run.frames.last().unwrap();
        let force = frame.contacts[0].secondary.force.y;
        let tip = frame.displacement[beam.nodes[0][40] - 1].y;
        println!(
            "{primary} {by}: R {force:.6}, tip {tip:.9}, {} iterations",
            run.increments[0].iterations
        );
        assert!(
            (force / 0.225 - 1.0).abs() < 0.01,
            "{primary} {by}: {force}"
        );
        assert!(!exact || (tip + 0.05).abs() < 1e-7, "{primary} {by}: {tip}");
    }
}
