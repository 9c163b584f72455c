//! Warnings of the audit, and what takes their reason away.

use super::blocks::{BLOCKS, Blocks, pressed};
use super::trial::{Remedy, Trial};
use crate::audit::WEDGE;
use crate::support::change;

/// The wedge with its flanks as the secondary side, by another method.
fn flanks_by(method: &str) -> String {
    let text = change(
        WEDGE,
        "secondary = \"flat\"\nprimary = \"flanks\"",
        "secondary = \"flanks\"\nprimary = \"flat\"",
    );
    change(
        &text,
        "method = \"node-to-segment\"\nsliding = \"finite\"",
        &format!("method = \"{method}\""),
    )
}

#[test]
fn pressure_along_facets_that_are_tilted_against_the_other_side() {
    for method in ["mortar", "gauss-point"] {
        Trial {
            text: flanks_by(method),
            code: 0,
            says: &[
                "warning[S0423]",
                "the force of contact \"c\" is in a direction that friction does not allow, worst at node",
            ],
            help: "compare single points:  method",
            remedy: Remedy::Key,
            gone: Some("S0423"),
        }
        .holds();
    }
}

#[test]
fn a_joint_whose_nodes_are_held() {
    let held = "[[step.fix]]\non = \"high_bottom\"\nu = [\"x\"]\n";
    let steps = format!("{held}[[step.move]]\non = \"high_top\"\nux = 0\nuy = 0\n");
    let text = Blocks {
        contact: Some("tied = true\n"),
        steps: steps.leak(),
        ..BLOCKS
    }
    .text();
    Trial {
        text: change(
            &text,
            "[[step.fix]]\non = \"low_bottom\"\nu = \"all\"",
            "[[step.move]]\non = \"low_bottom\"\nux = 0.05\nuy = 0",
        ),
        code: 0,
        says: &[
            "warning[S0424]",
            "the stress next to contact \"touch\" does not carry",
            "worst at nodes 10",
        ],
        help: "take the supports off nodes that are joined",
        remedy: Remedy::Change(held, ""),
        gone: Some("S0424"),
    }
    .holds();
}

#[test]
fn a_body_that_is_pushed_away() {
    let held = "[[step.fix]]\non = \"low_bottom\"\nu = \"all\"";
    let guided = "[[step.fix]]\non = \"low_bottom\"\nu = [\"x\"]";
    Trial {
        text: change(&pressed(), held, guided),
        code: 0,
        says: &[
            "warning[S0426]",
            "body \"low\" moved freely, and nothing stopped it",
            "it moved by 0.05, from time",
            "without contact body \"low\" is free to slide along y",
        ],
        help: "hold it by [[step.fix]]",
        remedy: Remedy::Change(guided, held),
        gone: Some("S0426"),
    }
    .holds();
}

/// Nodes against nodes at a corner, whose normal looks past the node that is next to it.
fn at_a_corner() -> String {
    let text = Blocks {
        along: 0.1,
        gap: 0.03,
        contact: Some("method = \"node-to-node\"\n"),
        keys: "increments = { fixed = 2 }",
        steps: "[[step.move]]\non = \"high_top\"\nux = 0\nuy = -0.05\n",
        ..BLOCKS
    }
    .text();
    change(
        &text,
        "low_head = { faces = [",
        "low_head = { faces = [[7, \"S4\"], ",
    )
}

#[test]
fn pairs_of_nodes_that_press_before_they_touch() {
    for says in [
        &[
            "warning[S0421]",
            "contact \"touch\" presses at node 101 where the surfaces are 0.03",
        ],
        &[
            "warning[S0423]",
            "the force of contact \"touch\" is in a direction that friction does not allow, worst at node 101",
        ],
    ] {
        Trial {
            text: at_a_corner(),
            code: 0,
            says,
            help: "compare single points:  method",
            remedy: Remedy::Key,
            gone: Some(&says[0][8..13]),
        }
        .holds();
    }
}
