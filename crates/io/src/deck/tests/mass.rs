//! *MASS, *ROTARY INERTIA, and the weight of MASS elements.

use super::*;
use crate::case::SetContent;
use crate::deck::load::vector;

const MASSES: &str = "*ELEMENT, TYPE=MASS, ELSET=M\n20, 5\n21, 6\n22, 6\n*MASS, ELSET=M\n0.25\n";

/// A rigid cube that node 9 moves, and more cards.
fn rigid(cards: &str) -> String {
    let body = "*NODE\n9, 0., 0., 2.\n*RIGID BODY, NSET=ALL8, REF NODE=9\n*NSET, NSET=ALL8, GENERATE\n1, 8\n";
    cube("C3D8", &format!("{body}{cards}"))
}

fn nodes_of(case: &Case, name: &str) -> Vec<u64> {
    let set = case.sets.iter().find(|set| set.name.as_str() == name);
    match set.map(|set| &set.content) {
        Some(SetContent::Nodes(nodes)) => nodes.clone(),
        _ => panic!("{name}"),
    }
}

/// The nodes and the value of each mass.
fn masses(case: &Case) -> Vec<(Vec<u64>, f64)> {
    let all = case.masses.iter();
    all.map(|one| (nodes_of(case, &one.on), one.value))
        .collect()
}

/// A node has the mass as often as there are elements at it; the card may stand before its elements.
#[test]
fn every_element_has_the_mass_given() {
    let wanted = [(vec![5], 0.25), (vec![6], 0.5)];
    let (elements, card) = MASSES.split_at(MASSES.find("*MASS,").unwrap());
    for cards in [MASSES.to_owned(), format!("{card}{elements}")] {
        let read = translated(&cube("C3D8", &format!("{cards}{STEP}")), Compat::None).unwrap();
        assert_eq!(masses(&read.case), wanted);
        assert!(!read.found.plain().contains("left out"), "no note");
        assert!(!read.found.plain().contains("is empty"), "no note");
    }
}

#[test]
fn elements_at_the_node_of_a_reference_are_one_mass_of_it() {
    let cards = "*ELEMENT, TYPE=MASS, ELSET=M\n20, 9\n21, 9\n22, 1\n*ELEMENT, TYPE=ROTARYI, ELSET=R\n30, 9\n\
                 *ROTARY INERTIA, ELSET=R\n3., 4., 5., 0.1, 0.2, 0.3\n*MASS, ELSET=M\n0.25\n";
    let case = case(&rigid(&format!("{cards}{STEP}")));
    let [at_node, lump] = &case.masses[..] else {
        panic!("{:?}", case.masses);
    };
    assert_eq!(
        (nodes_of(&case, &at_node.on), at_node.value),
        (vec![1], 0.25)
    );
    assert_eq!(lump.on.as_str(), case.references[0].name.as_str());
    assert_eq!((lump.value, &lump.centroid), (0.5, &None));
    let inertia = lump.inertia.as_ref().map(|of| of.value);
    assert_eq!(inertia, Some([3.0, 4.0, 5.0, 0.1, 0.2, 0.3]));
}

/// Of couplings, too.
#[test]
fn the_node_of_a_coupling_has_a_mass() {
    for kind in ["KINEMATIC", "DISTRIBUTING"] {
        let cards = format!(
            "*NODE\n9, 0., 0., 2.\n*COUPLING, REF NODE=9, SURFACE=LID, CONSTRAINT NAME=C\n*{kind}\n\
             *ELEMENT, TYPE=MASS, ELSET=M\n20, 9\n*MASS, ELSET=M\n2.\n{STEP}"
        );
        let case = case(&cube("C3D8", &cards));
        assert_eq!(case.masses[0].on.as_str(), "reference-9");
    }
}

/// Only those of the set named, whatever else is at their nodes; of sets of sets, and of single elements.
#[test]
fn masses_weigh_what_the_elements_named_have() {
    let more = "*ELEMENT, TYPE=MASS, ELSET=N\n30, 6\n*MASS, ELSET=N\n1.\n*ELSET, ELSET=BOTH\nM, N, CUBE\n*DENSITY\n2.\n";
    for (target, wanted, gravity) in [
        ("M", vec![(vec![5], 2.5), (vec![6], 5.0)], 0),
        ("N", vec![(vec![6], 10.0)], 0),
        ("21", vec![(vec![6], 2.5)], 0),
        ("BOTH", vec![(vec![5], 2.5), (vec![6], 15.0)], 1),
    ] {
        let step = format!("*STEP\n*STATIC\n*DLOAD\n{target}, GRAV, 10., 0., 0., -1.\n*END STEP\n");
        let case = case(&cube("C3D8", &format!("{MASSES}{more}{step}")));
        let loads = &case.steps[0].loads;
        let (bodies, points): (Vec<_>, Vec<_>) =
            loads.iter().partition(|load| load.kind.name == "gravity");
        assert_eq!(bodies.len(), gravity, "{target}");
        let points: Vec<(Vec<u64>, _)> = points
            .iter()
            .map(|load| (nodes_of(&case, &load.on), load.kind.clone()))
            .collect();
        let wanted: Vec<(Vec<u64>, _)> = wanted
            .into_iter()
            .map(|(nodes, force)| (nodes, vector("per_node", [0.0, 0.0, -force])))
            .collect();
        assert_eq!(points, wanted, "{target}");
    }
}

#[test]
fn a_reference_weighs_what_the_elements_at_it_have() {
    let cards = "*ELEMENT, TYPE=MASS, ELSET=M\n20, 9\n21, 9\n*MASS, ELSET=M\n0.25\n\
                 *STEP\n*STATIC\n*DLOAD\nM, GRAV, 10., 1., 0., 0.\n*END STEP\n";
    let case = case(&rigid(cards));
    let load = &case.steps[0].loads[0];
    assert_eq!(load.on, case.references[0].name);
    assert_eq!(load.kind, vector("force", [5.0, 0.0, 0.0]));
}

/// *DLOAD, OP=NEW takes their weight back.
#[test]
fn weights_end_with_the_other_distributed_loads() {
    let step = |op: &str, g: &str| format!("*STEP\n*STATIC\n*DLOAD{op}\n{g}*END STEP\n");
    let steps = [
        step("", "M, GRAV, 10., 0., 0., -1.\n"),
        step(", OP=NEW", ""),
    ]
    .concat();
    let case = case(&cube("C3D8", &format!("{MASSES}{steps}")));
    let ended = &case.steps[1].loads;
    assert_eq!(ended.len(), 2);
    for load in ended {
        assert_eq!(load.kind, vector("per_node", [0.0; 3]));
    }
}

/// Elements of a rigid body have their mass, where their material has a density.
#[test]
fn rigid_elements_keep_their_mass() {
    let body = "*NODE\n9, 0., 0., 2.\n*RIGID BODY, ELSET=CUBE, REF NODE=9\n";
    for (density, wanted) in [("*DENSITY\n2.\n", Some("M")), ("", None)] {
        let text = cube("C3D8", &format!("{body}{STEP}"))
            .replace("1000., 0.3\n", &format!("1000., 0.3\n{density}"));
        let case = case(&text);
        let [body] = &case.bodies[..] else {
            panic!("{:?}", case.bodies);
        };
        let material = body.material.as_ref().map(|name| name.as_str());
        assert!(body.rigid && material == wanted, "{material:?}");
    }
}

#[test]
fn a_deck_of_masses_alone_is_a_model() {
    let text = "*NODE\n1, 0., 0., 0.\n*ELEMENT, TYPE=MASS, ELSET=M\n1, 1\n*MASS, ELSET=M\n2.\n\
                *STEP\n*DYNAMIC\n0.1, 1.\n*END STEP\n";
    assert_eq!(masses(&case(text)), [(vec![1], 2.0)]);
}

#[test]
fn what_is_no_mass_is_refused_with_its_line() {
    let mass = |card: &str| format!("*ELEMENT, TYPE=MASS, ELSET=M\n20, 5\n{card}");
    let rotary = |node: u64, more: &str| {
        format!(
            "*ELEMENT, TYPE=ROTARYI, ELSET=R\n30, {node}\n*ROTARY INERTIA, ELSET=R\n3., 4., 5.\n{more}"
        )
    };
    let gravity = |on: &str| format!("{MASSES}*STEP\n*STATIC\n*DLOAD\n{on}\n*END STEP\n");
    for (cards, expected) in [
        (mass(""), "element 20 of type MASS has no *MASS"),
        (mass("*MASS, ELSET=M\n-1.\n"), "the mass of *MASS is -1"),
        (mass("*MASS, ELSET=M\n"), "*MASS has no data line"),
        (mass("*MASS\n1.\n"), "*MASS has no ELSET"),
        (mass("*MASS, ELSET=M, ALPHA=2.\n1.\n"), "ALPHA"),
        (
            mass("*MASS, ELSET=CUBE\n1.\n"),
            "element set `CUBE` has no elements of type MASS",
        ),
        (
            mass("*ELSET, ELSET=M\nCUBE\n*MASS, ELSET=M\n1.\n"),
            "has elements that are not of type MASS",
        ),
        (
            mass("*MASS, ELSET=M\n1.\n*MASS, ELSET=M\n1.\n"),
            "element 20 has two *MASS",
        ),
        (
            "*ELEMENT, TYPE=MASS, ELSET=M\n20, 99\n*MASS, ELSET=M\n1.\n".into(),
            "there is no node 99 in the mesh",
        ),
        (
            "*ELEMENT, TYPE=ROTARYI, ELSET=R\n30, 5\n".into(),
            "element 30 of type ROTARYI has no *ROTARY INERTIA",
        ),
        (rotary(5, ""), "node 5 has no rotations"),
        (rotary(9, ""), "ROTARYI at node 9, which has no mass"),
        (
            gravity("M, CENTRIF, 4., 0., 0., 0., 0., 0., 1."),
            "CENTRIF does not act on MASS elements",
        ),
        (gravity("M, P1, 4."), "P1 does not act on MASS elements"),
        (
            format!("{MASSES}*STEP\n*STATIC\n*MODEL CHANGE, TYPE=ELEMENT, REMOVE\nM\n*END STEP\n"),
            "*MODEL CHANGE of MASS elements",
        ),
    ] {
        let said = refused(&rigid(&format!("{cards}{STEP}")));
        assert!(said.contains(expected), "{expected}: {said}");
        assert!(said.contains("job.inp:"), "{said}");
    }
}

/// A node that turns a body, or that moves a cut, is no point in space.
#[test]
fn nodes_that_are_no_points_have_no_mass() {
    let mass = "*ELEMENT, TYPE=MASS, ELSET=M\n20, 10\n*MASS, ELSET=M\n1.\n";
    for (cards, expected) in [
        (
            "*NODE\n9, 0., 0., 2.\n10, 0., 0., 2.\n*RIGID BODY, NSET=TOP, REF NODE=9, ROT NODE=10\n",
            "put the element at its REF NODE",
        ),
        (
            "*NODE\n10, 0., 0., 2.\n*PRE-TENSION SECTION, SURFACE=LID, NODE=10\n0., 0., 1.\n",
            "it moves a pre-tension section",
        ),
    ] {
        let said = refused(&cube("C3D8", &format!("{cards}{mass}{STEP}")));
        assert!(said.contains("stands for no point in space"), "{said}");
        assert!(said.contains(expected), "{said}");
    }
}

/// The weight of such a body is that of all it has: it would count twice.
#[test]
fn the_weight_of_rigid_elements_with_masses_is_refused() {
    let cards = "*NODE\n9, 0., 0., 2.\n*RIGID BODY, ELSET=CUBE, REF NODE=9\n\
                 *ELEMENT, TYPE=MASS, ELSET=M\n20, 9\n*MASS, ELSET=M\n1.\n\
                 *STEP\n*STATIC\n*DLOAD\nCUBE, GRAV, 10., 0., 0., -1.\n*END STEP\n";
    let text = cube("C3D8", cards).replace("1000., 0.3\n", "1000., 0.3\n*DENSITY\n2.\n");
    let said = refused(&text);
    assert!(said.contains("GRAV on rigid body `CUBE`"), "{said}");
    let without = text.replace(
        "*ELEMENT, TYPE=MASS, ELSET=M\n20, 9\n*MASS, ELSET=M\n1.\n",
        "",
    );
    assert_eq!(case(&without).steps[0].loads[0].kind.name, "gravity");
}

/// In CalculiX damping is that of all mass, in Abaqus that of its material.
#[test]
fn masses_are_not_damped_with_a_warning() {
    let step = "*DAMPING, ALPHA=2.\n*STEP\n*DYNAMIC\n0.1, 1.\n*END STEP\n";
    for (compat, warns) in [(Compat::None, false), (Compat::Ccx, true)] {
        let read = translated(&cube("C3D8", &format!("{MASSES}{step}")), compat).unwrap();
        let said = read.found.plain();
        assert_eq!(
            said.contains("does not damp MASS elements"),
            warns,
            "{said}"
        );
    }
}

/// In the plane, bodies turn about its normal alone.
#[test]
fn the_plane_has_one_moment_of_inertia() {
    let text = |kind: &str| {
        format!(
            "*NODE\n1, 1., 0.\n2, 2., 0.\n3, 2., 1.\n4, 1., 1.\n9, 1., 0.\n*ELEMENT, TYPE={kind}, ELSET=B\n1, 1, 2, 3, 4\n\
             *MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n*SOLID SECTION, ELSET=B, MATERIAL=M\n*RIGID BODY, ELSET=B, REF NODE=9\n\
             *ELEMENT, TYPE=MASS, ELSET=P\n2, 9\n*MASS, ELSET=P\n2.\n*ELEMENT, TYPE=ROTARYI, ELSET=R\n3, 9\n\
             *ROTARY INERTIA, ELSET=R\n7., 7., 5.\n*STEP\n*DYNAMIC\n0.1, 1.\n*END STEP\n"
        )
    };
    let case = case(&text("CPE4"));
    let inertia = case.masses[0].inertia.as_ref().map(|of| of.value);
    assert_eq!(inertia, Some([0.0, 0.0, 5.0, 0.0, 0.0, 0.0]));
    let said = refused(&text("CAX4"));
    assert!(said.contains("bodies of revolution do not turn"), "{said}");
}
