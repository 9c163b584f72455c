//! Increments that do not converge, exit code 5, and cases that are solved in another way.

use super::blocks::{BLOCKS, Blocks, GUIDED, TWO_BODIES};
use super::trial::{Remedy, Trial, ended};
use crate::support::change;

const CUT_ONLY: &str = "[solver]\non_trouble = [\"cut\"]\n";
const PRESSED: &str = "[[step.move]]\non = \"high_top\"\nux = 0\nuy = -0.1\n";

/// Asserts that a message does not propose what fails, too.
#[track_caller]
fn proposes_no_smaller_increments(text: &str) {
    let failed = ended(text);
    assert!(
        !failed
            .says(5, &["help:"])
            .err
            .contains("smaller increments"),
        "{}",
        failed.err
    );
}

/// Pressed by a tenth, and dragged along.
fn dragged(along: f64, down: f64, by: f64, contact: &'static str, solver: &'static str) -> Blocks {
    let steps = format!(
        "[[step.move]]\non = \"high_top\"\nux = 0\nuy = {down}\n\
         [[step]]\nname = \"drag\"\n[[step.move]]\non = \"high_top\"\nux = {by}\n"
    );
    Blocks {
        along,
        contact: Some(contact),
        steps: steps.leak(),
        solver,
        ..BLOCKS
    }
}

#[test]
fn a_step_with_too_few_increments() {
    let text = Blocks {
        keys: "increments = { initial = 0.1, max = 0.1, count_max = 3 }",
        steps: PRESSED,
        ..BLOCKS
    }
    .text();
    // every increment converged: another method would change nothing
    let failed = ended(&text);
    assert!(!failed.says(5, &["S0501"]).err.contains("S0502"));
    assert!(!failed.err.contains("failed.vtu"), "{}", failed.err);
    Trial {
        text,
        code: 5,
        says: &[
            "S0501",
            "step \"press\" is not done after 3 increments (time 0.3 of 1)",
            "case.toml:",
        ],
        help: "more increments:",
        remedy: Remedy::Key,
        gone: None,
    }
    .holds();
}

#[test]
fn an_increment_in_which_an_element_is_crushed() {
    let text = Blocks {
        contact: Some("friction = 0.3\n"),
        keys: "increments = { fixed = 1 }",
        steps: "[[step.move]]\non = \"high_top\"\nux = 0.3\nuy = -1.5\n",
        solver: CUT_ONLY,
        ..BLOCKS
    }
    .text();
    Trial {
        text,
        code: 5,
        says: &[
            "S0501",
            "step \"press\"",
            "tried the size 1.00; `increments = { fixed }` allows no smaller one",
            "element 101 of body \"high\" is turned inside out",
            "case.toml:",
        ],
        help: "smaller increments:",
        remedy: Remedy::Key,
        gone: None,
    }
    .holds();
}

#[test]
fn a_material_that_collapses() {
    let text = Blocks {
        material: "model = \"saint-venant-kirchhoff\"\nE = 1000.0\nnu = 0.3",
        keys: "increments = { fixed = 1 }",
        steps: "[[step.move]]\non = \"high_top\"\nux = 0\nuy = -0.8\n",
        solver: CUT_ONLY,
        ..BLOCKS
    }
    .text();
    proposes_no_smaller_increments(&text);
    Trial {
        text,
        code: 5,
        says: &[
            "S0501",
            "step \"press\"",
            "of body \"low\" is turned inside out",
        ],
        help: "a law that does not collapse:",
        remedy: Remedy::Key,
        gone: None,
    }
    .holds();
}

#[test]
fn iterations_that_do_not_suffice() {
    let text = Blocks {
        contact: None,
        keys: "increments = { fixed = 1 }",
        steps: "[[step.fix]]\non = \"high_bottom\"\nu = \"all\"\n[[step.load]]\non = \"high_top\"\nforce = [60, 0, 0]\n",
        solver: "[solver]\nnewton = { max_iterations = 2 }\n",
        ..BLOCKS
    }
    .text();
    Trial {
        text,
        code: 5,
        says: &[
            "S0501",
            "step \"press\"",
            "2 iterations did not suffice",
            "of body \"high\"",
        ],
        help: "more iterations:",
        remedy: Remedy::Key,
        gone: None,
    }
    .holds();
}

#[test]
fn contact_that_has_too_few_iterations_for_one_increment() {
    let text = Blocks {
        keys: "increments = { fixed = 1 }",
        steps: "[[step.move]]\non = \"high_top\"\nux = 0\nuy = -0.3\n",
        solver: "[solver]\non_trouble = [\"cut\"]\nnewton = { max_iterations = 3 }\n",
        ..BLOCKS
    }
    .text();
    for help in ["smaller increments:", "other ways of the program:"] {
        Trial {
            text: text.clone(),
            code: 5,
            says: &[
                "S0501",
                "step \"press\"",
                "contact \"touch\": 5 closed (nodes 101, 102, 103, 104)",
            ],
            help,
            remedy: Remedy::Key,
            gone: None,
        }
        .holds();
    }
}

#[test]
fn a_point_that_goes_through_the_other_side() {
    let rigid = change(
        TWO_BODIES,
        "group = \"high\"\nmaterial = \"m\"",
        "group = \"high\"\nrigid = true",
    );
    let text = Blocks {
        bodies: rigid.leak(),
        contact: Some("reach = 0.1\n"),
        keys: "increments = { fixed = 1 }",
        steps: "[[step.move]]\non = \"high\"\nux = 0\nuy = -0.3\nrz = 0\n",
        solver: CUT_ONLY,
        ..BLOCKS
    }
    .text();
    Trial {
        text,
        code: 5,
        says: &[
            "S0501",
            "step \"press\"",
            "contact \"touch\"",
            "node 10",
            "went through the surface",
        ],
        help: "smaller increments:",
        remedy: Remedy::Key,
        gone: None,
    }
    .holds();
}

#[test]
fn gauss_points_that_mortar_replaces() {
    let keys = "method = \"gauss-point\"\n";
    Trial {
        text: dragged(0.7, -0.3, 3.0, keys, CUT_ONLY).text(),
        code: 5,
        says: &["S0501", "step \"drag\"", "contact \"touch\"", "(node 10"],
        help: "another method:",
        remedy: Remedy::Key,
        gone: None,
    }
    .holds();
}

#[test]
fn mortar_at_an_edge_that_gauss_points_replace() {
    let keys = "method = \"mortar\"\n";
    let says: &[&str] = &[
        "S0501",
        "step \"press\"",
        "the equations of contact \"touch\" are singular, at node 10",
    ];
    Trial {
        text: dragged(2.4, -0.1, 1.0, keys, CUT_ONLY).text(),
        code: 5,
        says,
        help: "another method:",
        remedy: Remedy::Key,
        gone: None,
    }
    .holds();
    // before anything was solved it is no body that is free
    let in_one = Blocks {
        keys: "increments = { fixed = 1 }",
        ..dragged(2.4, -0.1, 1.0, keys, CUT_ONLY)
    };
    proposes_no_smaller_increments(&in_one.text());
    Trial {
        text: in_one.text(),
        code: 5,
        says,
        help: "another method:",
        remedy: Remedy::Key,
        gone: None,
    }
    .holds();
}

#[test]
fn a_case_that_is_solved_again_by_points() {
    Trial {
        text: dragged(2.4, -0.1, 1.0, "", "").text(),
        code: 0,
        says: &["S0502", "contact \"touch\"", "solved again by Gauss points"],
        help: "to start with it:",
        remedy: Remedy::Key,
        gone: Some("S0502"),
    }
    .holds();
}

#[test]
fn a_body_that_becomes_free() {
    let freed = "[[step]]\nname = \"let_go\"\n[[step.contact]]\nname = \"touch\"\nactive = false\n[[step.free]]\non = \"high_top\"\nu = \"all\"\n";
    let steps = PRESSED.to_owned() + freed;
    let text = Blocks {
        steps: steps.leak(),
        solver: CUT_ONLY,
        ..BLOCKS
    }
    .text();
    let says: &[&str] = &[
        "S0501",
        "step \"let_go\"",
        "body \"high\" has become free",
        "at node 1",
    ];
    Trial {
        text: text.clone(),
        code: 5,
        says,
        help: "where no load acts on the motion:",
        remedy: Remedy::Key,
        gone: None,
    }
    .holds();
    let held = freed.to_owned() + "[[step.move]]\non = \"high_top\"\nux = 0\nuy = 0\n";
    Trial {
        text,
        code: 5,
        says,
        help: "hold it by [[step.fix]], or prescribe its motion by [[step.move]] instead of a load, in step \"let_go\"",
        remedy: Remedy::Change(freed, &held),
        gone: None,
    }
    .holds();
}

#[test]
fn a_jump_that_viscous_forces_lead_through() {
    let freed = "[[step]]\nname = \"let_go\"\n[[step.contact]]\nname = \"touch\"\nactive = false\n[[step.free]]\non = \"high_top\"\nu = \"all\"\n";
    let steps = PRESSED.to_owned() + freed;
    let text = Blocks {
        steps: steps.leak(),
        ..BLOCKS
    }
    .text();
    let held = freed.to_owned() + "[[step.fix]]\non = \"high_top\"\nu = \"all\"\n";
    Trial {
        text,
        code: 0,
        says: &["warning[S0425]", "first at time 1.05"],
        help: "where something is free there: hold it by [[step.fix]]",
        remedy: Remedy::Change(freed, &held),
        gone: Some("S0425"),
    }
    .holds();
}

#[test]
fn a_body_that_a_load_pulls_off() {
    let pull = "[[step.load]]\non = \"high_top\"\nforce = [0, 1, 0]\n";
    let steps = format!(
        "{PRESSED}[[step]]\nname = \"pull\"\n[[step.free]]\non = \"high_top\"\nu = \"all\"\n{GUIDED}{pull}"
    );
    let text = Blocks {
        steps: steps.leak(),
        ..BLOCKS
    }
    .text();
    proposes_no_smaller_increments(&text);
    Trial {
        text,
        code: 5,
        says: &["S0501", "step \"pull\"", "body \"high\" has become free", "along y at node 1"],
        help: "hold it by [[step.fix]], or prescribe its motion by [[step.move]] instead of a load, in step \"pull\"",
        remedy: Remedy::Change(pull, "[[step.move]]\non = \"high_top\"\nuy = 0.2\n"),
        gone: None,
    }
    .holds();
}

const ARCH_LOADED: &str = "[[step.load]]\non = \"top\"\nforce = [0, -2, 0]\n";
const ARCH_MOVED: &str = "[[step.move]]\non = \"top\"\nuy = -1.0\n";

/// A shallow arch of sixteen elements that snaps through under a load.
fn arch() -> String {
    let (mut nodes, mut elements) = (String::new(), String::new());
    for i in 0..=16_u32 {
        let x = f64::from(i) / 4.0;
        let y = 0.2 * x * (4.0 - x);
        nodes += &format!(
            "[{}, {x}, {y}], [{}, {x}, {}],\n",
            2 * i + 1,
            2 * i + 2,
            y + 0.1
        );
        if i > 0 {
            let corners = [2 * i - 1, 2 * i + 1, 2 * i + 2, 2 * i];
            elements += &format!(
                "{{ id = {i}, type = \"quad4\", group = \"arch\", nodes = {corners:?} }},\n"
            );
        }
    }
    format!(
        "format = 1\n[mesh]\nnodes = [\n{nodes}]\nelements = [\n{elements}]\n[model]\nspace = \"plane-strain\"\n\
         [sets]\nends = {{ nodes = [1, 2, 33, 34] }}\ntop = {{ nodes = [18] }}\n\
         [material.m]\nmodel = \"neo-hookean\"\nE = 1000.0\nnu = 0.0\n\
         [[body]]\ngroup = \"arch\"\nmaterial = \"m\"\n\
         [[step]]\nname = \"press\"\nincrements = {{ initial = 0.1, min = 0.02, max = 0.1 }}\n\
         [[step.fix]]\non = \"ends\"\nu = \"all\"\n{ARCH_LOADED}"
    )
}

#[test]
fn a_shallow_arch_that_snaps() {
    Trial {
        text: arch(),
        code: 5,
        says: &["S0501", "step \"press\"", "at node 12 (x = 1.25, y = 0.7875) of body \"arch\""],
        help: "where the load is more than the structure bears: prescribe a motion by [[step.move]] instead of the load",
        remedy: Remedy::Change(ARCH_LOADED, ARCH_MOVED),
        gone: None,
    }
    .holds();
}
