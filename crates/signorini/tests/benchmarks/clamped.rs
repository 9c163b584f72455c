//! Two equal beams that touch along their length, clamped at both ends.
//!
//! SOURCE      Written for the purpose.
//! GOAL        multipliers at clamped nodes carry nothing that goes from one support to the other, and have no say in how
//!             the beams bend
//! MESH        two beams of length 20 and height 1, one upon the other, of every element that bends: 13 cells along the
//!             upper one, 15 or 40 along the lower one, 2 over the height, and 1 across in space
//! CONDITIONS  plane stress, or space with a width of 1, small strain and finite, E = 1000, nu = 0; a pressure of 1e-4 on the
//!             upper beam, sides of the contact swapped
//! EXPECTED    both bend by the same, so that the lower beam bears half of the load
//! TOLERANCE   of the load 2 % on quadratic cells of about the same length, 6 % where the lower ones are three times as fine;
//!             9 % on linear ones of about the same length, whose facets stay straight while the beams bend; nothing is cut
use crate::common::run;
use crate::scene::Scene;
use signorini_geometry::tensor::Vec3;

const LENGTH: f64 = 20.0;
const PRESSURE: f64 = 1e-4;

/// The part of the load that the lower beam bears.
fn borne(element: &'static str, ncell: [usize; 2], swapped: bool, geometry: &str) -> f64 {
    let plane = element.starts_with("quad");
    let up = if plane { 1 } else { 2 };
    let mut scene = Scene::default();
    for (group, n, floor) in [("lower", ncell[0], -1.0), ("upper", ncell[1], 0.0)] {
        let size = if plane { [n, 2, 0] } else { [n, 1, 2] };
        let corner = |at: [usize; 3]| {
            let mut x = Vec3::from(at.map(|k| k as f64));
            x.x *= LENGTH / n as f64;
            x[up] = 0.5 * x[up] + floor;
            x
        };
        scene.straight(group, element, size, corner);
    }
    let on = |level: f64| move |x: &[f64]| (x[up] - level).abs() < 1e-9;
    let is_end = |x: &[f64]| x[0].abs() < 1e-9 || (x[0] - LENGTH).abs() < 1e-9;
    for (name, group, faces) in [
        ("roof", "lower", scene.facets_where("lower", on(0.0))),
        ("foot", "upper", scene.facets_where("upper", on(0.0))),
        ("top", "upper", scene.facets_where("upper", on(1.0))),
        ("lower_ends", "lower", scene.facets_where("lower", is_end)),
        ("upper_ends", "upper", scene.facets_where("upper", is_end)),
    ] {
        assert!(!faces.is_empty(), "{name} of {group}");
        let listed: Vec<String> = faces.iter().map(|(c, s)| format!("[{c}, {s:?}]")).collect();
        scene.place(name, &format!("faces = [{}]", listed.join(", ")));
    }
    let [secondary, primary] = match swapped {
        true => ["roof", "foot"],
        false => ["foot", "roof"],
    };
    let (space, axes) = if plane {
        ("plane-stress", "xy")
    } else {
        ("3d", "xyz")
    };
    let linear = !element.ends_with(['8', '0']) || element == "hex8";
    let locking = if linear && geometry == "linear" {
        "locking = \"incompatible\""
    } else {
        ""
    };
    let case = scene
        .elastic(space, 1000.0, 0.0)
        .body(&["lower", "upper"], locking)
        .contact(secondary, primary, "")
        .also(&format!(
            "[[step]]\nname = \"press\"\ngeometry = {geometry:?}\nincrements = 1"
        ))
        .fix("lower_ends", axes)
        .fix("upper_ends", axes)
        .load("top", &format!("pressure = {PRESSURE:?}"));
    let mut model = case.model(&[]);
    let run = run(&mut model);
    assert!(run.error.is_none(), "{:?}", run.error);
    assert!(run.cutbacks.is_empty());
    let reactions = &run.frames[run.frames.len() - 1].reaction_force;
    let ends = model.nodes_of("lower_ends").unwrap();
    let force: f64 = ends.iter().map(|&n| reactions[n as usize][up]).sum();
    force / (PRESSURE * LENGTH)
}

#[test]
fn a_beam_under_another_one_bears_half_of_the_load() {
    let (linear, quadratic) = (["quad4", "hex8"], ["quad8", "hex20"]);
    let similar = [[15, 13], [13, 15]];
    let cases = linear.map(|element| (element, &similar[..], 0.09));
    let more = quadratic.map(|element| (element, &similar[..], 0.02));
    let finer = quadratic.map(|element| (element, &[[40, 13]][..], 0.06));
    for (element, meshes, tolerance) in cases.into_iter().chain(more).chain(finer) {
        for &ncell in meshes {
            for swapped in [false, true] {
                let part = borne(element, ncell, swapped, "linear");
                assert!(
                    (part - 0.5).abs() < tolerance,
                    "{element} {ncell:?} {swapped}: {part}"
                );
            }
        }
    }
}

#[test]
fn so_it_does_at_finite_strain() {
    for element in ["quad8", "hex20"] {
        for swapped in [false, true] {
            let part = borne(element, [15, 13], swapped, "nonlinear");
            assert!((part - 0.5).abs() < 0.02, "{element} {swapped}: {part}");
        }
    }
}
