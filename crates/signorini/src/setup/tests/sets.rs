//! Sets by geometry.

use super::*;
use signorini_mechanics::model::{PrimaryPart, SidePart};

#[test]
fn sets_by_geometry_hold_the_nodes_of_their_place_and_no_stray_ones() {
    for (set, expected) in [
        ("{ plane = 'z', at = 1 }", &[5, 6, 7, 8, 11, 12, 13, 14][..]),
        ("{ plane = 'z', at = 1, of = 'high' }", &[11, 12, 13, 14]),
        ("{ plane = [0, 0, -2], at = -2.0 }", &[15, 16, 17, 18, 22]),
        ("{ box = [[0, 0, 0], [1, 0.5, 0.9]] }", &[1, 2]),
        ("{ sphere = [[3, 0, 0], 0.5] }", &[21]),
        ("{ near = [9, 9, 1.1], of = 'low' }", &[7]),
        ("{ union = ['later', 'base'] }", &[1, 2, 3, 4, 22]),
    ] {
        let more = format!(
            "here = {set}\nlater = {{ near = [3, 0, 9] }}\n{}",
            STEP.replace("base", "here")
        );
        assert_eq!(fixed(&cubes(&more).steps[0]), expected, "{set}");
    }
    let (code, text) = refused(&format!("off = {{ plane = 'x', at = 7 }}\n{STEP}"));
    assert!(
        code == "S0203" && text.contains("\"off\" is empty"),
        "{text}"
    );
}

#[test]
fn a_set_by_geometry_is_a_surface_where_it_holds_whole_outer_faces() {
    let contact = "[[contact]]\nname = 'c'\nsecondary = 'under'\nprimary = 'over'\n";
    let sets = "over = { plane = 'z', at = 1, of = 'low' }\nunder = { plane = 'z', at = 1, of = 'high' }\n";
    let body = "[[body]]\ngroup = 'high'\nmaterial = 'steel'\n";
    let built = cubes(&format!("{sets}{body}{contact}{STEP}"));
    let part = &built.contacts[0];
    assert!(matches!(&part.primary, PrimaryPart::Faces(faces) if faces.len() == 1));
    assert!(matches!(&part.secondary, SidePart::Faces(faces) if faces.len() == 1));
}
