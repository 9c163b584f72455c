//! Elements and sections become bodies and springs.

use super::*;
use crate::case::{Body, Integration, Locking, Space, SpringEnds, SpringLaw, Thickness};

#[test]
fn types_of_elements_say_how_they_are_integrated() {
    let body = |kind: &str| -> Body { case(&cube(kind, STEP)).bodies[0].clone() };
    let of = |kind: &str| (body(kind).integration, body(kind).locking.value);
    assert_eq!(of("C3D8"), (Integration::Full, Locking::None));
    assert_eq!(of("C3D8I"), (Integration::Full, Locking::Incompatible));
    assert_eq!(of("C3D8R"), (Integration::Full, Locking::Auto));
    assert_eq!(case(&cube("C3D8", STEP)).model.space.value, Space::ThreeD);
}

#[test]
fn sections_of_a_plane_model_have_a_thickness_each() {
    let deck = "*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n5,2,0\n6,2,1\n*ELEMENT, TYPE=CPS4, ELSET=A\n1,1,2,3,4\n\
                *ELEMENT, TYPE=CPS4, ELSET=B\n2,2,5,6,3\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n\
                *SOLID SECTION, ELSET=A, MATERIAL=M\n0.5\n*SOLID SECTION, ELSET=B, MATERIAL=M\n2.\n\
                *STEP\n*STATIC\n*END STEP\n";
    let case = case(deck);
    assert_eq!(case.model.thickness, 0.5);
    let own: Vec<_> = case
        .bodies
        .iter()
        .map(|b| b.thickness.as_ref().map(|t| t.value))
        .collect();
    assert_eq!(own, [None, Some(Thickness::Uniform(2.0))]);
}

/// A ring next to a sheet; without a thickness a sheet is one thick.
#[test]
fn bodies_have_the_plane_that_their_elements_name() {
    let deck = "*NODE\n1,1,0\n2,2,0\n3,2,1\n4,1,1\n5,3,0\n6,3,1\n7,4,0\n8,4,1\n*ELEMENT, TYPE=CAX4, ELSET=A\n1,1,2,3,4\n\
                *ELEMENT, TYPE=CPS4, ELSET=B\n2,2,5,6,3\n*ELEMENT, TYPE=CPS4, ELSET=C\n3,5,7,8,6\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n\
                *SOLID SECTION, ELSET=A, MATERIAL=M\n0.1\n*SOLID SECTION, ELSET=B, MATERIAL=M\n2.\n*SOLID SECTION, ELSET=C, MATERIAL=M\n\
                *STEP\n*STATIC\n*END STEP\n";
    let own = |deck: &str| -> Vec<_> {
        let case = case(deck);
        let of = |body: &Body| {
            let thickness = body.thickness.as_ref().map(|t| t.value);
            (body.space.as_ref().map(|s| s.value), thickness)
        };
        case.bodies.iter().map(of).collect()
    };
    let sheet = Some(Space::PlaneStress);
    let thick = |length: f64| Some(Thickness::Uniform(length));
    assert_eq!(
        own(deck),
        [(None, None), (sheet, thick(2.0)), (sheet, thick(1.0))]
    );
    let flat = deck.replace("CAX4", "CPE4");
    assert_eq!(
        own(&flat),
        [
            (Some(Space::PlaneStrain), None),
            (None, thick(2.0)),
            (None, None)
        ]
    );
    let text = refused(&deck.replace("CPS4, ELSET=B", "CPE4, ELSET=B"));
    assert!(text.contains("no part of a ring"), "{text}");
}

#[test]
fn the_last_section_of_an_element_holds() {
    let cards =
        "*MATERIAL, NAME=SOFT\n*ELASTIC\n1., 0.\n*SOLID SECTION, ELSET=EALL, MATERIAL=SOFT\n";
    let deck = cube("C3D8", &format!("*ELSET, ELSET=EALL\n1\n{cards}{STEP}"));
    let case = case(&deck);
    let materials: Vec<_> = case.bodies.iter().map(|b| b.material.as_ref()).collect();
    assert_eq!(materials.len(), 1);
    assert_eq!(materials[0].map(|m| m.value.as_str()), Some("SOFT"));
}

#[test]
fn springs_pull_along_their_line_or_an_axis_by_stiffness_or_table() {
    let nodes = "*NODE\n1,0,0,0\n2,1,0,0\n*ELEMENT, TYPE=SPRINGA, ELSET=A\n1,1,2\n\
                 *ELEMENT, TYPE=SPRING1, ELSET=B\n2,2\n*ELEMENT, TYPE=SPRING2, ELSET=C\n3,1,2\n";
    let cards = "*SPRING, ELSET=A, NONLINEAR\n\n0., 0.\n10., 1.\n100., 20.\n*SPRING, ELSET=B\n2\n7.\n\
                 *SPRING, ELSET=C\n3, 3\n8.\n";
    let step = "*STEP\n*STATIC\n*END STEP\n";
    let case = case(&format!("{nodes}{cards}{step}"));
    let [along, ground, between] = &case.springs[..] else {
        panic!("{:?}", case.springs)
    };
    let table = vec![[0.0, 0.0], [10.0, 1.0], [100.0, 20.0]];
    assert_eq!(
        (&along.law, along.direction),
        (&SpringLaw::Table(table), None)
    );
    assert!(matches!(&along.ends, SpringEnds::Between(..)));
    assert_eq!(ground.law, SpringLaw::Linear(7.0));
    assert!(matches!(&ground.ends, SpringEnds::Ground(on) if on.value == "node-2"));
    assert_eq!(ground.direction, Some([0.0, -1.0, 0.0]));
    assert_eq!(between.direction, Some([0.0, 0.0, -1.0]));
    assert_eq!(
        (case.bodies.len(), case.model.space.value),
        (0, Space::ThreeD)
    );
    for (cards, expected) in [
        (
            "*SPRING, ELSET=C\n3, 2\n8.\n",
            "degrees of freedom of this spring",
        ),
        (
            "*SPRING, ELSET=A, NONLINEAR\n\n1., 0.\n0., 1.\n",
            "no rising table",
        ),
        ("*SPRING, ELSET=A\n\n-3.\n", "has to be positive"),
        (
            "*SPRING, ELSET=A\n\n3., 1.\n4., 2.\n",
            "depends on temperature",
        ),
        ("*SPRING, ELSET=A\n", "has no data"),
        ("*SPRING, ELSET=D\n\n3.\n", "element set `D` has no springs"),
    ] {
        let message = refused(&format!("{nodes}{cards}{step}"));
        assert!(message.contains(expected), "{expected}: {message}");
    }
}

#[test]
fn trusses_are_bars_with_the_cross_section_of_their_section() {
    let bars = "*ELEMENT, TYPE=T3D2, ELSET=BARS\n20,1,7\n21,2,8\n";
    let section = "*SOLID SECTION, ELSET=BARS, MATERIAL=M\n0.25\n";
    let both = case(&cube("C3D8", &format!("{bars}{section}{STEP}")));
    let areas: Vec<Option<f64>> = both
        .bodies
        .iter()
        .map(|body| body.area.as_ref().map(|area| area.value))
        .collect();
    assert_eq!(areas, [None, Some(0.25)]);
    let alone = "*NODE\n1,0,0\n2,1,0\n*ELEMENT, TYPE=T2D2, ELSET=BARS\n1,1,2\n\
                 *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n";
    let step = "*STEP\n*STATIC\n*END STEP\n";
    let plane = case(&format!("{alone}{section}{step}"));
    assert_eq!(plane.model.space.value.ndim(), 2);
    assert_eq!(plane.bodies[0].area.as_ref().unwrap().value, 0.25);
    let none = refused(&format!("{alone}*SOLID SECTION, ELSET=BARS, MATERIAL=M\n"));
    assert!(none.contains("has no cross-section"), "{none}");
}

#[test]
fn a_membrane_of_no_elements_does_no_harm() {
    case(&cube(
        "C3D8",
        &format!("*MEMBRANE, ELSET=NONE, MATERIAL=M\n0.\n{STEP}"),
    ));
    let message = refused(&cube("C3D8", &format!("*MEMBRANE, ELSET=CUBE\n0.\n{STEP}")));
    assert!(message.contains("membranes are not built"), "{message}");
}
