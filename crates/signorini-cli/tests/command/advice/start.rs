//! Meshes that cannot be used, exit code 4, and notes on sides at the start.

use super::blocks::{BLOCKS, Blocks, HEAD_MOVED, pressed};
use super::trial::{Remedy, Trial};
use crate::support::change;
use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;

const AT_TOP: &str = "format = 1";

#[test]
fn elements_without_a_volume() {
    let (nodes, place) = ("[101, 102, 107, 106]", "[101, 0.700000000, 0.000000000]");
    for (from, to, says, help) in [
        (
            nodes,
            "[106, 107, 102, 101]",
            "negative volume: elements 101",
            "reverse the order of their nodes",
        ),
        (
            place,
            "[101, 1.3, 0.9]",
            "elements 101 are folded",
            "move their nodes, or mesh again",
        ),
        (
            place,
            "[101, 0.7, 0.5]",
            "zero volume: elements 101",
            "remove them, or move their nodes",
        ),
    ] {
        Trial {
            text: change(&pressed(), from, to),
            code: 4,
            says: &[
                "S0211",
                says,
                "element 101 belongs to body \"high\"",
                "case.toml:",
            ],
            help,
            remedy: Remedy::Case(pressed()),
            gone: None,
        }
        .holds();
    }
}

#[test]
fn a_temperature_at_which_nothing_is_left() {
    let text = Blocks {
        material: "model = \"neo-hookean\"\nE = 1000.0\nnu = 0.3\nexpansion = { alpha = 0.1, reference = 20 }",
        more: "[initial]\ntemperature = 0\n",
        steps: HEAD_MOVED,
        ..BLOCKS
    }
    .text();
    Trial {
        text,
        code: 4,
        says: &[
            "S0211",
            "element 1 of body \"low\"",
            "its temperature would shrink the material to -1.000e0 of its length",
        ],
        help: "correct the `expansion` of its material",
        remedy: Remedy::Change("alpha = 0.1", "alpha = 1e-5"),
        gone: None,
    }
    .holds();
}

#[test]
fn sides_that_overlap() {
    let text = Blocks {
        gap: -0.02,
        steps: HEAD_MOVED,
        ..BLOCKS
    }
    .text();
    let says: &[&str] = &[
        "note[S0411]",
        "contact \"touch\"",
        "by up to 0.0200 at node 101 (x = 0.700, y = -0.0200)",
        "case.toml:",
    ];
    Trial {
        text: text.clone(),
        code: 0,
        says,
        help: "where the sides are meant to touch:  start",
        remedy: Remedy::Key,
        gone: Some("S0411"),
    }
    .holds();
    Trial {
        text,
        code: 0,
        says,
        help: "where the overlap is an interference fit:  allow = [\"S0411\"]",
        remedy: Remedy::Change(AT_TOP, "format = 1\nallow = [\"S0411\"]"),
        gone: Some("S0411"),
    }
    .holds();
}

#[test]
fn a_side_with_friction_that_ends_at_an_edge() {
    let text = Blocks {
        contact: Some("friction = 0.3\n"),
        steps: HEAD_MOVED,
        ..BLOCKS
    }
    .text();
    let says: &[&str] = &[
        "warning[S0414]",
        "contact \"touch\": its secondary side ends at 2 edges of body \"high\"",
        "node 101: face S4 of element 101",
        "case.toml:",
    ];
    for (help, from, to) in [
        (
            "add the faces next to these edges to the secondary side",
            "high_foot = { faces = [",
            "high_foot = { faces = [[101, \"S4\"], [104, \"S2\"], ",
        ),
        (
            "where the edges do not roll:  allow = [\"S0414\"]",
            AT_TOP,
            "format = 1\nallow = [\"S0414\"]",
        ),
    ] {
        Trial {
            text: text.clone(),
            code: 0,
            says,
            help,
            remedy: Remedy::Change(from, to),
            gone: Some("S0414"),
        }
        .holds();
    }
}

/// A quarter of a ring: the first number of its nodes and elements, elements along the arc, and radii.
fn ring(name: &str, first: usize, n: usize, radii: [f64; 2]) -> [String; 3] {
    let mut text: [String; 3] = Default::default();
    let [nodes, elements, sets] = &mut text;
    for i in 0..=n {
        let angle = FRAC_PI_2 * i as f64 / n as f64;
        for (j, r) in radii.iter().enumerate() {
            let (x, y) = (r * angle.cos(), r * angle.sin());
            writeln!(nodes, "[{}, {x:.12}, {y:.12}],", first + 2 * i + j).unwrap();
        }
    }
    for i in 0..n {
        let corners = [0, 1, 3, 2].map(|k| first + 2 * i + k);
        let id = first + i;
        writeln!(
            elements,
            "{{ id = {id}, type = \"quad4\", group = \"{name}\", nodes = {corners:?} }},"
        )
        .unwrap();
    }
    let faces = |side: &str| {
        let of = |i: usize| format!("[{}, \"{side}\"]", first + i);
        (0..n).map(of).collect::<Vec<_>>().join(", ")
    };
    for (side, faces) in [("inner", faces("S4")), ("outer", faces("S2"))] {
        writeln!(sets, "{name}_{side} = {{ faces = [{faces}] }}").unwrap();
    }
    text
}

#[test]
fn a_shaft_in_a_hole_of_other_facets() {
    let [shaft, hole] = [
        ring("shaft", 1, 6, [0.5, 1.0]),
        ring("hole", 101, 8, [1.0, 1.5]),
    ];
    let [nodes, elements, sets] = [0, 1, 2].map(|k| shaft[k].clone() + &hole[k]);
    let text = format!(
        "format = 1\n[mesh]\nnodes = [\n{nodes}]\nelements = [\n{elements}]\n[model]\nspace = \"plane-strain\"\n\
         [sets]\n{sets}[material.m]\nmodel = \"linear-elastic\"\nE = 1000.0\nnu = 0.3\n\
         [[body]]\ngroup = [\"shaft\", \"hole\"]\nmaterial = \"m\"\n\
         [[contact]]\nname = \"fit\"\nsecondary = \"shaft_outer\"\nprimary = \"hole_inner\"\n\
         [[step]]\nname = \"rest\"\nincrements = {{ fixed = 1 }}\n\
         [[step.fix]]\non = \"hole_outer\"\nu = \"all\"\n[[step.fix]]\non = \"shaft_inner\"\nu = \"all\"\n"
    );
    Trial {
        text,
        code: 0,
        says: &[
            "note[S0412]",
            "contact \"fit\"",
            "come from straight facets",
            "case.toml:",
        ],
        help: "to take the gaps of the facets:  start",
        remedy: Remedy::Key,
        gone: Some("S0412"),
    }
    .holds();
}
