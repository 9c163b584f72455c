//! A brick pressed on a block and slid to and fro.
//!
//! SOURCE      CalculiX's test `friction2`; the ratio of shear and pressure is Coulomb's law.
//! GOAL        shear follows the direction of sliding, and is the coefficient times the pressure to all digits
//! MESH        a unit brick of 1 hex8 on 3 × 3 × 1 unit hex8, which are held
//! CONDITIONS  node-to-segment penalty 1e7 per area, stiffness of sticking 80, mu 0.2, pressure 100 on the brick, then its
//!             head slid by 0.9 to each side, across edges
//! EXPECTED    tangential force ∓0.2 times the normal force; penetration pressure/penalty = 1e-5
//! TOLERANCE   ratio 1e-6; penetration 1e-6 (the brick does not turn)
use crate::common::Run;
use crate::scene::{Scene, equal};

fn slid(enforcement: &str, driven: &str) -> Run {
    let mut scene = Scene::default();
    let block = equal(0.0, 3.0, 3);
    scene.bricks("block", [&block, &block, &[0.0, 1.0]]);
    let brick = [1.03, 2.03];
    scene.bricks("brick", [&[1.05, 2.05], &brick, &[1.0, 2.0]]);
    scene.place(
        "held",
        "box = [[-0.1, -0.1, -0.1], [3.1, 3.1, 1.1]], of = \"block\"",
    );
    scene.place("top", "plane = \"z\", at = 1.0, of = \"block\"");
    scene.faces("foot", &[(10, "S1")]);
    scene.place("head", "plane = \"z\", at = 2.0, of = \"brick\"");
    scene.faces("lid", &[(10, "S2")]);
    scene.place(
        "all_of_brick",
        "box = [[-0.1, -0.1, 0.9], [3.1, 3.1, 2.1]], of = \"brick\"",
    );
    let contact = format!(
        "method = \"node-to-segment\"\nenforcement = {enforcement}\nfriction = {{ mu = 0.2, stiffness = 80.0 }}"
    );
    scene
        .elastic("3d", 210_000.0, 0.3)
        .body(&["block", "brick"], "")
        .contact("foot", "top", &contact)
        .step("press", 1)
        .fix("held", "xyz")
        .fix(driven, "xy")
        .load("lid", "pressure = 100.0")
        .step("forth", 10)
        .displace(driven, "ux = 0.9")
        .step("back", 10)
        .displace(driven, "ux = -0.9")
        .newton("force_tol = 1e-10")
        .run()
}

#[test]
fn shear_is_the_coefficient_times_the_pressure_and_turns_with_the_motion() {
    // with multipliers, a foot whose motion is prescribed cannot stick
    let ways = [
        ("{ penalty = 1e7, per = \"area\" }", "all_of_brick"),
        ("{ penalty = 1e7, per = \"area\" }", "head"),
        ("{ lagrange = {} }", "head"),
        ("{ augmented = \"newton\" }", "head"),
    ];
    for (enforcement, driven) in ways {
        let run = slid(enforcement, driven);
        for (step, sign) in [(1, -1.0), (2, 1.0)] {
            let mut frames = run.frames.iter().filter(|f| f.step_number == step);
            let contact = &frames.next_back().unwrap().contacts[0];
            let force = contact.secondary.force;
            let ratio = force.x / force.z;
            println!(
                "{enforcement} {driven} step {step}: force {:.6?}, ratio {ratio:.10}, gap {:.6e}",
                force.to_array(),
                contact.gap_min
            );
            assert!((ratio - 0.2 * sign).abs() < 1e-6 * 0.2, "{ratio}");
            assert!((force.z - 100.0).abs() < 1e-8 * 100.0);
            if driven == "all_of_brick" {
                assert!((contact.gap_min / -1e-5 - 1.0).abs() < 1e-6);
            }
        }
    }
}

#[test]
fn uzawa_settles_friction_too() {
    let run = slid("{ augmented = \"uzawa\" }", "head");
    let mut frames = run.frames.iter().filter(|f| f.step_number == 1);
    let force = frames.next_back().unwrap().contacts[0].secondary.force;
    let ratio = force.x / force.z;
    assert!((ratio + 0.2).abs() < 1e-6 * 0.2, "{ratio}");
}
