//! Loads that cannot act, exit code 4.

use super::blocks::{BLOCKS, Blocks, HEAD_MOVED};
use super::trial::{Remedy, Trial};
use crate::support::change;

fn loaded(load: &str) -> Blocks {
    let steps = format!("{HEAD_MOVED}[[step.load]]\n{load}");
    Blocks {
        along: 0.0,
        steps: steps.leak(),
        ..BLOCKS
    }
}

#[test]
fn a_moment_on_one_node() {
    let text = loaded("on = \"one\"\nmoment = [0, 0, 1]\n").text();
    Trial {
        text: change(&text, "[sets]", "[sets]\none = { nodes = [109] }"),
        code: 4,
        says: &[
            "S0307",
            "load \"press#0\"",
            "its nodes lie in a point",
            "case.toml:",
        ],
        help: "load nodes that lie around the axis of the moment",
        remedy: Remedy::Change("one = { nodes = [109] }", "one = { nodes = [108, 109] }"),
        gone: None,
    }
    .holds();
}

#[test]
fn a_pressure_on_an_element_of_no_body() {
    let low = "[[body]]\ngroup = \"low\"\nmaterial = \"m\"\n";
    let text = Blocks {
        contact: None,
        ..loaded("on = \"low_foot\"\npressure = 1.0\n")
    }
    .text();
    let base = "[[step.fix]]\non = \"low_bottom\"\nu = \"all\"\n";
    let text = change(&change(&text, low, ""), base, "");
    let help = "make the element part of a [[body]], or load another set";
    let whole = change(
        &text,
        "group = \"high\"\nmaterial",
        "group = [\"high\", \"low\"]\nmaterial",
    );
    let held = "[[step]]\nname = \"press\"\n";
    for remedy in [
        Remedy::Change("on = \"low_foot\"", "on = \"high_foot\""),
        Remedy::Case(change(&whole, held, &format!("{held}{base}"))),
    ] {
        Trial {
            text: text.clone(),
            code: 4,
            says: &[
                "S0307",
                "load \"press#0\"",
                "element 1 belongs to no body",
                "case.toml:",
            ],
            help,
            remedy,
            gone: None,
        }
        .holds();
    }
}

#[test]
fn a_force_on_the_axis_of_revolution() {
    let text = loaded("on = \"axis\"\nforce = [0, 1]\n").text();
    let text = change(&text, "plane-strain", "axisymmetric");
    Trial {
        text: change(
            &text,
            "[sets]",
            "[sets]\naxis = { faces = [[101, \"S4\"]] }",
        ),
        code: 4,
        says: &[
            "S0307",
            "load \"press#0\"",
            "its faces have no area",
            "case.toml:",
        ],
        help: "name a set of faces",
        remedy: Remedy::Change("[101, \"S4\"]", "[101, \"S1\"]"),
        gone: None,
    }
    .holds();
}
