//! Models that are ill-posed, exit code 4, and warnings that they may be.

use super::blocks::{BLOCKS, Blocks, GUIDED, HEAD_MOVED, TWO_BODIES, pressed};
use super::trial::{Remedy, Trial};
use crate::audit::WEDGE;
use crate::support::change;

/// A load on the head.
const LOAD: &str = "[[step.load]]\non = \"high_top\"\nforce = [0, -1, 0]\n";
const BASE_FIXED: &str = "[[step.fix]]\non = \"low_bottom\"\nu = \"all\"\n";

#[test]
fn a_body_that_nothing_holds() {
    let text = Blocks {
        contact: None,
        steps: LOAD,
        ..BLOCKS
    }
    .text();
    Trial {
        remedy: Remedy::Change(LOAD, HEAD_MOVED),
        text,
        code: 4,
        says: &["S0302", "body \"high\"", "slide in every direction and to turn", "case.toml:"],
        help: "hold it by [[step.fix]], or prescribe its motion by [[step.move]] instead of a load, in step \"press\"",
        gone: None,
    }
    .holds();
}

#[test]
fn a_motion_without_friction_and_without_load() {
    let text = Blocks {
        steps: LOAD,
        ..BLOCKS
    }
    .text();
    let says: &[&str] = &["S0302", "body \"high\"", "slide along x", "case.toml:"];
    Trial {
        text: text.clone(),
        code: 4,
        says,
        help: "where no load acts on the motion:  free_motions",
        remedy: Remedy::Key,
        gone: None,
    }
    .holds();
    let guided = LOAD.to_owned() + GUIDED;
    Trial {
        text,
        code: 4,
        says,
        help: "hold it by [[step.fix]]",
        remedy: Remedy::Change(LOAD, &guided),
        gone: None,
    }
    .holds();
}

#[test]
fn a_free_motion_that_a_load_drives() {
    let text = Blocks {
        contact: None,
        steps: LOAD,
        solver: "[solver]\nfree_motions = \"hold\"\n",
        ..BLOCKS
    }
    .text();
    Trial {
        text,
        code: 4,
        says: &["S0302", "body \"high\"", "along y at node 1", "y = 1)"],
        help: "hold it by [[step.fix]], or prescribe its motion by [[step.move]] instead of a load, in step \"press\"",
        remedy: Remedy::Change(LOAD, HEAD_MOVED),
        gone: None,
    }
    .holds();
}

#[test]
fn a_body_that_open_contact_holds() {
    let steps = LOAD.to_owned() + GUIDED;
    let open = Blocks {
        gap: 0.05,
        steps: steps.leak(),
        ..BLOCKS
    };
    let says: &[&str] = &[
        "warning[S0301]",
        "body \"high\" is held only by contact",
        "slide along y and to turn about (1.45, 1.05)",
        "contact \"touch\" is open by 0.0500 at node 101 (x = 0.700, y = 0.0500)",
    ];
    Trial {
        text: open.text(),
        code: 0,
        says,
        help: "where the gap is meant to be closed:  start",
        remedy: Remedy::Key,
        gone: Some("is open by"),
    }
    .holds();
    Trial {
        text: open.text(),
        code: 0,
        says,
        help: "hold it by [[step.fix]], or prescribe its motion by [[step.move]] instead of a load, in step \"press\"",
        remedy: Remedy::Change(LOAD, "[[step.move]]\non = \"high_top\"\nuy = -0.1\n"),
        gone: Some("S0301"),
    }
    .holds();
    Trial {
        text: open.text() + "[solver]\nstabilize = false\n",
        code: 4,
        says: &["error[S0301]", says[1], says[2], says[3]],
        help: "let a vanishing viscous force hold it:  stabilize",
        remedy: Remedy::Key,
        gone: None,
    }
    .holds();
}

#[test]
fn sides_that_share_all_nodes() {
    // one node in the place of two, and no other on the secondary side
    let glued = [
        ("[101, 102, 107, 106]", "[15, 102, 107, 106]"),
        ("[sets]\n", "[sets]\nglued = { nodes = [15] }\n"),
        ("secondary = \"high_foot\"", "secondary = \"glued\""),
    ];
    let glued = (glued.iter()).fold(pressed(), |text, (from, to)| change(&text, from, to));
    Trial {
        text: glued,
        code: 4,
        says: &[
            "S0303",
            "contact \"touch\"",
            "one of them node 15",
            "case.toml:",
        ],
        help: "mesh the two bodies apart, without common nodes",
        remedy: Remedy::Case(pressed()),
        gone: None,
    }
    .holds();
}

#[test]
fn sides_that_are_both_rigid() {
    let rigid =
        "[[body]]\ngroup = \"low\"\nrigid = true\n[[body]]\ngroup = \"high\"\nrigid = true\n";
    let springs =
        "[[spring]]\nname = \"rod\"\non = \"low_bottom\"\nstiffness = 10.0\ndirection = \"y\"\n";
    let text = Blocks {
        bodies: rigid,
        more: springs,
        contact: Some("enforcement = { lagrange = {} }\n"),
        steps: "[[step.fix]]\non = \"low\"\nu = \"all\"\nrot = \"all\"\n[[step.move]]\non = \"high\"\nux = 0\nuy = -0.05\nrz = 0\n",
        ..BLOCKS
    }
    .text();
    let text = change(&text, BASE_FIXED, "");
    Trial {
        text: text.clone(),
        code: 4,
        says: &[
            "S0303",
            "contact \"touch\"",
            "both sides are rigid",
            "case.toml:",
        ],
        help: "let one of the bodies deform, or:  enforcement",
        remedy: Remedy::Key,
        gone: None,
    }
    .holds();
}

#[test]
fn facets_opposite_where_there_are_none() {
    let text = Blocks {
        contact: Some("method = \"node-to-segment\"\narea = \"opposite\"\n"),
        more: "[[surface]]\nname = \"floor\"\nshape = { plane = { point = [0, 0, 0], normal = \"y\" } }",
        steps: HEAD_MOVED,
        ..BLOCKS
    }
    .text();
    Trial {
        text: change(&text, "primary = \"low_head\"", "primary = \"floor\""),
        code: 4,
        says: &[
            "S0303",
            "contact \"touch\"",
            "its primary side has none",
            "case.toml:",
        ],
        help: "write  area",
        remedy: Remedy::Key,
        gone: None,
    }
    .holds();
}

#[test]
fn bodies_of_different_thickness_on_a_mortar_side() {
    let text = Blocks {
        contact: Some("method = \"mortar\"\n"),
        more: "[[body]]\ngroup = \"more\"\nmaterial = \"m\"\nthickness = 2.0",
        steps: HEAD_MOVED,
        ..BLOCKS
    }
    .text();
    let high = |id: usize| format!("id = {id}, type = \"quad4\", group = \"high\"");
    let more = |id: usize| format!("id = {id}, type = \"quad4\", group = \"more\"");
    let text = [101, 105]
        .iter()
        .fold(text, |text, &id| change(&text, &high(id), &more(id)));
    Trial {
        text,
        code: 4,
        says: &[
            "S0303",
            "contact \"touch\"",
            "differ in thickness",
            "case.toml:",
        ],
        help: "write  method",
        remedy: Remedy::Key,
        gone: None,
    }
    .holds();
}

#[test]
fn nothing_that_deforms() {
    let rigid = "[[body]]\ngroup = \"low\"\nrigid = true\n[[body]]\ngroup = \"high\"\nrigid = true";
    let text = change(&pressed(), TWO_BODIES, rigid);
    Trial {
        text,
        code: 4,
        says: &["S0304", "no body has a material", "case.toml:"],
        help: "give at least one [[body]] a `material`",
        remedy: Remedy::Case(pressed()),
        gone: None,
    }
    .holds();
}

#[test]
fn motions_that_contradict_each_other() {
    let twice = "[[step.move]]\non = \"edge\"\nuy = 0.1\n";
    let steps = HEAD_MOVED.to_owned() + twice;
    let text = Blocks {
        steps: steps.leak(),
        ..BLOCKS
    }
    .text();
    let text = change(&text, "[sets]", "[sets]\nedge = { nodes = [110, 115] }");
    Trial {
        text,
        code: 4,
        says: &[
            "S0305",
            "step \"press\"",
            "y displacement of node 115 twice",
            "case.toml:",
        ],
        help: "take the node out of one of the two sets",
        remedy: Remedy::Change("edge = { nodes = [110, 115] }", "edge = { nodes = [110] }"),
        gone: None,
    }
    .holds();
}

#[test]
fn a_node_of_a_rigid_body_that_is_moved_by_itself() {
    let rigid = change(
        TWO_BODIES,
        "group = \"high\"\nmaterial = \"m\"",
        "group = \"high\"\nrigid = true",
    );
    let text = change(&pressed(), TWO_BODIES, &rigid);
    Trial {
        text,
        code: 4,
        says: &["S0305", "node 111", "rigid body \"high\"", "case.toml:"],
        help: "name the body:  on = \"high\"",
        remedy: Remedy::Change("on = \"high_top\"", "on = \"high\"\nrz = 0"),
        gone: None,
    }
    .holds();
}

#[test]
fn an_element_in_two_bodies() {
    let more = "[[body]]\ngroup = \"some\"\nmaterial = \"m\"\n";
    let text = Blocks {
        more,
        steps: HEAD_MOVED,
        ..BLOCKS
    }
    .text();
    let text = change(&text, "[sets]", "[sets]\nsome = { elements = [101, 102] }");
    Trial {
        text,
        code: 4,
        says: &[
            "S0306",
            "element 101",
            "body \"high\"",
            "body \"some\"",
            "case.toml:",
        ],
        help: "name groups that do not overlap",
        remedy: Remedy::Change(more, ""),
        gone: None,
    }
    .holds();
}

#[test]
fn sides_that_overlap_too_deeply() {
    let deep = Blocks {
        gap: -0.6,
        steps: "[[step.fix]]\non = \"high_top\"\nu = \"all\"\n",
        ..BLOCKS
    };
    let says: &[&str] = &[
        "S0312",
        "contact \"touch\"",
        "node 101 (x = 0.700, y = -0.600)",
        "case.toml:",
    ];
    Trial {
        text: deep.text(),
        code: 4,
        says,
        help: "move the bodies apart, or let the contact act from a later step on",
        remedy: Remedy::Case(Blocks { gap: 0.0, ..deep }.text()),
        gone: None,
    }
    .holds();
    Trial {
        text: deep.text(),
        code: 4,
        says,
        help: "move the bodies apart, or let the contact act from a later step on",
        remedy: Remedy::Change("name = \"touch\"", "name = \"touch\"\nactive = false"),
        gone: None,
    }
    .holds();
    Trial {
        text: deep.text(),
        code: 4,
        says,
        help: "where the overlap is meant so:  start",
        remedy: Remedy::Key,
        gone: None,
    }
    .holds();
}

#[test]
fn contact_between_nodes_that_are_all_prescribed() {
    let held = "[[step.fix]]\non = \"low_top\"\nu = \"all\"\n[[step.move]]\non = \"high_bottom\"\nux = 0\nuy = -0.05\n";
    let text = Blocks {
        contact: Some("method = \"mortar\"\n"),
        steps: HEAD_MOVED,
        ..BLOCKS
    }
    .text();
    Trial {
        text: text.clone() + held,
        code: 0,
        says: &["note[S0415]", "contact \"touch\"", "node 10"],
        help: "take the supports off the nodes of the contact",
        remedy: Remedy::Change(held, ""),
        gone: Some("S0415"),
    }
    .holds();
}

#[test]
fn a_contact_that_slides_far_in_the_geometry_of_the_start() {
    let text = Blocks {
        along: 0.1,
        keys: "geometry = \"linear\"",
        steps: "[[step.move]]\non = \"high_top\"\nux = 1.2\nuy = -0.05\n",
        ..BLOCKS
    }
    .text();
    Trial {
        text,
        code: 0,
        says: &["warning[S0431]", "contact \"touch\"", "node 10"],
        help: "write  sliding",
        remedy: Remedy::Key,
        gone: Some("S0431"),
    }
    .holds();
}

#[test]
fn a_tip_that_goes_into_a_facet() {
    let says: &[&str] = &[
        "warning[S0422]",
        "contact \"c\"",
        "inside each other at node",
    ];
    Trial {
        text: WEDGE.to_owned(),
        code: 0,
        says,
        help: "look from both sides:",
        remedy: Remedy::Key,
        gone: Some("S0422"),
    }
    .holds();
    Trial {
        text: WEDGE.to_owned(),
        code: 0,
        says,
        help: "exchange `secondary` and `primary` of contact \"c\"",
        remedy: Remedy::Change(
            "secondary = \"flat\"\nprimary = \"flanks\"",
            "secondary = \"flanks\"\nprimary = \"flat\"",
        ),
        gone: Some("S0422"),
    }
    .holds();
}

const PILOT: &str = "[reference.pilot]\nat = [1.45, 1]\n\
    [[constraint]]\nkind = \"kinematic\"\non = \"high_top\"\nreference = \"pilot\"\n";
const PILOT_MOVED: &str = "[[step.move]]\non = \"pilot\"\nux = 0\nuy = -0.05\nrz = 0\n";

#[test]
fn a_node_that_follows_two_references() {
    let other = "[reference.other]\nat = [1.45, 0]\n\
        [[constraint]]\nkind = \"kinematic\"\non = \"more\"\nreference = \"other\"\n";
    let more = PILOT.to_owned() + other;
    let text = Blocks {
        more: more.leak(),
        steps: PILOT_MOVED,
        ..BLOCKS
    }
    .text();
    let text = change(
        &text,
        "[sets]",
        "[sets]\nmore = { nodes = [109, 110, 111] }",
    );
    Trial {
        text,
        code: 4,
        says: &[
            "S0308",
            "(kinematic on \"high_top\")",
            "node 111 follows \"other\" already",
            "case.toml:",
        ],
        help: "take the node out of one of the two sets",
        remedy: Remedy::Change("[109, 110, 111]", "[109, 110]"),
        gone: None,
    }
    .holds();
}

#[test]
fn a_reference_that_is_held_and_moved() {
    for (held, says) in [
        ("u = \"all\"", "the y displacement of \"pilot\" twice"),
        ("rot = \"all\"", "the rotation about z of \"pilot\" twice"),
    ] {
        let fix = format!("[[step.fix]]\non = \"pilot\"\n{held}\n");
        let moved = change(PILOT_MOVED, "rz = 0", "rz = 0.01");
        let steps = moved + &fix;
        let text = Blocks {
            more: PILOT,
            steps: steps.leak(),
            ..BLOCKS
        }
        .text();
        Trial {
            text,
            code: 4,
            says: &["S0305", "step \"press\"", says, "case.toml:"],
            help: "leave the direction out of [[step.fix]]",
            remedy: Remedy::Change(fix.leak(), ""),
            gone: None,
        }
        .holds();
    }
}

#[test]
fn a_support_of_a_node_that_follows() {
    let steps = PILOT_MOVED.to_owned() + "[[step.fix]]\non = \"high_top\"\nu = [\"x\"]\n";
    let text = Blocks {
        more: PILOT,
        steps: steps.leak(),
        ..BLOCKS
    }
    .text();
    Trial {
        text,
        code: 4,
        says: &["S0308", "node 111 follows \"pilot\""],
        help: "name what it follows:  on = \"pilot\"",
        remedy: Remedy::Change(
            "[[step.fix]]\non = \"high_top\"",
            "[[step.fix]]\non = \"pilot\"",
        ),
        gone: None,
    }
    .holds();
}

#[test]
fn equations_that_contradict_each_other() {
    let equation =
        "[[constraint]]\nequation = [[\"high_bottom\", \"x\", 1.0], [\"high_top\", \"x\", -1.0]]\n";
    let again = equation.to_owned() + "rhs = 0.1\n";
    let more = equation.to_owned() + &again;
    let text = Blocks {
        more: more.leak(),
        steps: HEAD_MOVED,
        ..BLOCKS
    }
    .text();
    Trial {
        text,
        code: 4,
        says: &[
            "S0308",
            "constraint \"2 (equation)\" contradicts",
            "case.toml:",
        ],
        help: "take out one of the constraints that speak of the same displacements",
        remedy: Remedy::Change(&again, ""),
        gone: None,
    }
    .holds();
}

#[test]
fn an_equation_between_prescribed_displacements() {
    let equation = "[[constraint]]\nequation = [[\"high_top\", \"x\", 1.0], [\"high_top\", \"y\", -1.0]]\nrhs = 0.1\n";
    let text = Blocks {
        more: equation,
        steps: HEAD_MOVED,
        ..BLOCKS
    }
    .text();
    Trial {
        text,
        code: 4,
        says: &[
            "S0308",
            "constraint \"1 (equation)\" leaves nothing free",
            "node 111",
            "case.toml:",
        ],
        help: "take the constrained nodes out of the supports and motions",
        remedy: Remedy::Change("ux = 0\nuy = -0.05", "uy = -0.05"),
        gone: None,
    }
    .holds();
}

#[test]
fn a_reference_that_leaves_the_axis() {
    let text = Blocks {
        more: PILOT,
        steps: "[[step.move]]\non = \"pilot\"\nux = 0.1\nuy = -0.05\n",
        ..BLOCKS
    }
    .text();
    let text = change(&text, "plane-strain", "axisymmetric");
    let text = change(&text, "at = [1.45, 1]", "at = [0, 1]");
    Trial {
        text,
        code: 4,
        says: &[
            "S0308",
            "step \"press\"",
            "reference \"pilot\"",
            "across the axis",
            "case.toml:",
        ],
        help: "move and load it along y alone",
        remedy: Remedy::Change("ux = 0.1\n", ""),
        gone: None,
    }
    .holds();
}
