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

/// A node that belongs to nothing in the mesh, and a set that has it together with these.
fn with_a_loose_node(text: &str, others: &str) -> String {
    let text = change(text, "nodes = [\n", "nodes = [\n[900, 9.0, 9.0],\n");
    change(
        &text,
        "[sets]",
        &format!("[sets]\nsome = {{ nodes = [{others}900] }}"),
    )
}

#[test]
fn a_load_on_a_node_of_no_body() {
    for load in [
        "force = [0, -1]",
        "per_node = [0, -1]",
        "moment = [0, 0, 1]",
    ] {
        for others in ["", "108, 109, "] {
            let text = loaded(&format!("on = \"some\"\n{load}\n")).text();
            Trial {
                text: with_a_loose_node(&text, others),
                code: 4,
                says: &[
                    "S0307",
                    "load \"press#0\"",
                    "node 900 belongs to no body",
                    "case.toml:",
                ],
                help: "load nodes of a [[body]]",
                remedy: Remedy::Change("on = \"some\"", "on = \"high_head\""),
                gone: None,
            }
            .holds();
        }
    }
}

/// A reference node of an equation has no element, and carries a load all the same.
#[test]
fn a_load_on_a_node_of_an_equation_acts() {
    let text = loaded("on = \"some\"\nper_node = [-0.5, 0]\n").text();
    let text = with_a_loose_node(&text, "");
    let text = change(&text, "[sets]", "[sets]\ntip = { nodes = [110] }");
    let terms = "[[constraint]]\nequation = [[\"some\", \"x\", 1.0], [\"tip\", \"x\", -1.0]]\n";
    let text = change(&text, "[[step]]", &format!("{terms}[[step]]"));
    let ended = super::trial::ended(&text);
    ended.says(0, &[]);
}

#[test]
fn a_motion_of_nodes_of_no_body() {
    let text = Blocks {
        steps: "[[step.move]]\non = \"high_top\"\nux = 0\nuy = -0.05\n[[step.move]]\non = \"some\"\nux = 0.1\n",
        ..BLOCKS
    }
    .text();
    Trial {
        text: with_a_loose_node(&text, ""),
        code: 4,
        says: &[
            "step \"press\" moves nodes of no body",
            "node 900",
            "case.toml:",
        ],
        help: "move nodes of a [[body]]",
        remedy: Remedy::Change("{ nodes = [900] }", "{ nodes = [108] }"),
        gone: None,
    }
    .holds();
}

/// A forgotten body: its elements and its loads would vanish.
#[test]
fn elements_of_no_body() {
    let low = "[[body]]\ngroup = \"low\"\nmaterial = \"m\"\n";
    let text = Blocks {
        contact: None,
        ..loaded("")
    }
    .text();
    let base = "[[step.fix]]\non = \"low_bottom\"\nu = \"all\"\n";
    let text = change(&change(&text, low, ""), base, "");
    let text = change(&text, "[[step.load]]\n", "");
    let ended = super::trial::ended(&text);
    ended.says(
        0,
        &[
            "warning[S0204]",
            "12 elements are in no body",
            "element 1, of \"low\"",
            "name its group in a [[body]]",
        ],
    );
    let silent = super::trial::ended(&format!("allow = [\"S0204\"]\n{text}"));
    assert!(!silent.err.contains("S0204"), "{}", silent.err);
}
