//! Constraints that cannot be made of their nodes, exit code 4.

use super::blocks::{BLOCKS, Blocks, HEAD_MOVED};
use super::trial::{Remedy, Trial};
use crate::support::change;

const PILOT: &str = "[reference.pilot]\nat = [1.45, 1]\n";

/// Blocks with a constraint on the set `some`.
fn constrained(nodes: &str, constraint: &str) -> String {
    let more = PILOT.to_owned() + constraint;
    let text = Blocks {
        along: 0.0,
        more: more.leak(),
        steps: HEAD_MOVED,
        ..BLOCKS
    }
    .text();
    change(
        &text,
        "[sets]",
        &format!("[sets]\nsome = {{ nodes = {nodes} }}"),
    )
}

#[test]
fn nodes_at_one_place() {
    let pilot = "reference = \"pilot\"\n";
    for (kind, keys, nodes, others) in [
        ("distance", "", "[15, 101]", "[16, 102]"),
        ("distributing", pilot, "[111]", "[111, 113]"),
        (
            "twist",
            "reference = \"pilot\"\naxis = \"z\"\n",
            "[111]",
            "[111, 113]",
        ),
    ] {
        let constraint = format!("[[constraint]]\nkind = \"{kind}\"\non = \"some\"\n{keys}");
        Trial {
            text: constrained(nodes, &constraint),
            code: 4,
            says: &[
                "S0308",
                &format!("constraint \"1 ({kind} on \"some\")\""),
                "its nodes lie in one point",
                "case.toml:",
            ],
            help: "name nodes at different places",
            remedy: Remedy::Case(constrained(others, &constraint)),
            gone: None,
        }
        .holds();
    }
}

#[test]
fn nodes_that_are_on_no_line() {
    for (kind, place) in [("line", "on one line"), ("plane", "in one plane")] {
        let constraint = format!("[[constraint]]\nkind = \"{kind}\"\non = \"some\"\n");
        Trial {
            text: constrained("[101, 102, 103, 107]", &constraint),
            code: 4,
            says: &[
                "S0308",
                &format!("constraint \"1 ({kind} on "),
                place,
                "node 107 is 5.000e-1 away from it",
                "case.toml:",
            ],
            help: "take the node out of the set",
            remedy: Remedy::Case(constrained("[101, 102, 103]", &constraint)),
            gone: None,
        }
        .holds();
    }
}

#[test]
fn a_rotation_that_follows_a_node_that_turns() {
    let equation =
        "[[constraint]]\nequation = [[\"other\", \"rz\", 1.0], [\"one\", \"x\", -1.0]]\n";
    let more = format!(
        "{PILOT}[reference.other]\nat = [0, 0]\n\
         [[constraint]]\nkind = \"kinematic\"\non = \"high_top\"\nreference = \"pilot\"\n\
         [[constraint]]\nkind = \"kinematic\"\non = \"low_bottom\"\nreference = \"other\"\n{equation}"
    );
    let text = Blocks {
        contact: None,
        more: more.leak(),
        steps: "[[step.fix]]\non = \"pilot\"\nu = \"all\"\n[[step.fix]]\non = \"other\"\nu = \"all\"\n\
                [[step.move]]\non = \"pilot\"\nrz = 0.01\n",
        ..BLOCKS
    }
    .text();
    let text = change(&text, "[sets]", "[sets]\none = { nodes = [111] }");
    let base = "[[step.fix]]\non = \"low_bottom\"\nu = \"all\"\n";
    Trial {
        text: change(&text, base, ""),
        code: 4,
        says: &[
            "S0308",
            "constraint \"3 (equation)\" would make a rotation of \"other\" depend on",
            "case.toml:",
        ],
        help: "couple the rotations",
        remedy: Remedy::Change("[\"one\", \"x\", -1.0]", "[\"pilot\", \"rz\", -1.0]"),
        gone: None,
    }
    .holds();
}
