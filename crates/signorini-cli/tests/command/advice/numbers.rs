//! Numbers that are too large to compute with, and laws that have no answer, exit code 5.

use super::blocks::{BLOCKS, Blocks};
use super::trial::{Remedy, Trial};

const CUT_ONLY: &str = "[solver]\non_trouble = [\"cut\"]\n";
const LINEAR: &str = "geometry = \"linear\"\nincrements = { fixed = 1 }";
const FOOT_HELD: &str = "[[step.fix]]\non = \"high_bottom\"\nu = \"all\"\n";
const SMALLER: &str = "write a smaller number";

/// A block that is held at its foot and pulled, without contact.
fn pulled(by: &str, more: &'static str) -> String {
    let steps = format!("{FOOT_HELD}[[step.move]]\non = \"high_top\"\nuy = {by}\n");
    Blocks {
        contact: None,
        more,
        keys: LINEAR,
        steps: steps.leak(),
        solver: CUT_ONLY,
        ..BLOCKS
    }
    .text()
}

#[test]
fn a_motion_whose_strain_energy_overflows() {
    Trial {
        text: pulled("1e160", ""),
        code: 5,
        says: &[
            "S0501",
            "step \"press\"",
            "the force of element 101 of body \"high\" is not a finite number",
            "case.toml:",
        ],
        help: SMALLER,
        remedy: Remedy::Change("1e160", "0.1"),
        gone: None,
    }
    .holds();
}

#[test]
fn a_spring_whose_force_overflows() {
    let spring =
        "[[spring]]\nname = \"rod\"\non = \"high_top\"\ndirection = \"y\"\nstiffness = 1e306\n";
    Trial {
        text: pulled("1e5", spring),
        code: 5,
        says: &[
            "S0501",
            "step \"press\"",
            "the force at node 111 (x = 0.7, y = 1) of body \"high\" is not a finite number",
            "case.toml:",
        ],
        help: SMALLER,
        remedy: Remedy::Change("1e306", "10"),
        gone: None,
    }
    .holds();
}

/// Blocks that are pressed together by a tenth.
fn pressed(contact: &'static str, more: &'static str) -> String {
    Blocks {
        contact: Some(contact),
        more,
        keys: "increments = { fixed = 1 }",
        steps: "[[step.move]]\non = \"high_top\"\nux = 0\nuy = -0.1\n",
        solver: CUT_ONLY,
        ..BLOCKS
    }
    .text()
}

#[test]
fn a_spring_whose_stiffness_overflows() {
    let spring =
        "[[spring]]\nname = \"rod\"\non = \"low_top\"\ndirection = \"y\"\nstiffness = 1e308\n";
    let twice = spring.to_owned() + &spring.replace("rod", "other");
    Trial {
        text: pressed("", twice.leak()),
        code: 5,
        says: &[
            "S0501",
            "step \"press\"",
            "the stiffness at node 21 (x = 3, y = 0) of body \"low\" is not a finite number",
            "case.toml:",
        ],
        help: SMALLER,
        remedy: Remedy::Case(pressed("", "")),
        gone: None,
    }
    .holds();
}

#[test]
fn a_penalty_that_hides_the_bodies() {
    for method in ["node-to-segment", "gauss-point"] {
        let contact = format!("method = \"{method}\"\nenforcement = {{ penalty = 1e18 }}\n");
        Trial {
            text: pressed(contact.leak(), ""),
            code: 5,
            says: &[
                "S0501",
                "step \"press\"",
                "the stiffness at node ",
                "is so large that rounding errors hide the others",
                "case.toml:",
            ],
            help: "the penalty that suits the bodies:  enforcement",
            remedy: Remedy::Key,
            gone: None,
        }
        .holds();
    }
}

#[test]
fn a_penalty_at_which_contact_does_not_settle() {
    Trial {
        text: pressed(
            "method = \"node-to-segment\"\nenforcement = { penalty = 1e12 }\n",
            "",
        ),
        code: 5,
        says: &[
            "S0501",
            "step \"press\"",
            "contact \"touch\": 1 closed (node 101)",
        ],
        help: "the penalty that suits the bodies:  enforcement",
        remedy: Remedy::Key,
        gone: None,
    }
    .holds();
}

#[test]
fn a_sheet_that_is_stretched_beyond_its_law() {
    let steps = format!("{FOOT_HELD}[[step.move]]\non = \"high_top\"\nux = 0\nuy = 1.5\n");
    let text = Blocks {
        contact: None,
        material: "model = \"saint-venant-kirchhoff\"\nE = 1000.0\nnu = 0.3",
        keys: "increments = { fixed = 1 }",
        steps: steps.leak(),
        solver: CUT_ONLY,
        ..BLOCKS
    }
    .text();
    Trial {
        text: text.replacen("plane-strain", "plane-stress", 1),
        code: 5,
        says: &[
            "S0501",
            "step \"press\"",
            "element 101 of body \"high\"",
            "no state without stress across",
            "case.toml:",
        ],
        help: "a law that does not collapse",
        remedy: Remedy::Key,
        gone: None,
    }
    .holds();
}
