//! Overlaps and gaps at the start: how large, where, and what becomes of them.
//!
//! SOURCE      by construction: two blocks of height 1 whose faces overlap by a given amount, or are apart by it
//! GOAL        the reported gap is the distance of the faces, at a node of one of them, whatever the method; an overlap of more
//!             than half the height is refused, with places
//! MESH        blocks of quad4, tri3, hex8 and tet4, meshes that do not match, either side secondary, turned by 30 degrees
//! TOLERANCE   1e-9
use crate::scene::{Case, Scene};
use signorini::setup::{Model, build, read_mesh_of};
use signorini_geometry::tensor::Vec3;
use signorini_io::case::read_case;
use signorini_io::diagnostic::Diagnostics;
use signorini_mechanics::model::{Interference, Treatment};
use std::path::Path;

/// Two blocks, the upper one narrower, with this much of its height in the lower one.
fn blocks(element: &'static str, overlap: f64, turn: f64, swapped: bool, by: &str) -> Case {
    let mut scene = Scene::default();
    let solid = matches!(element, "hex8" | "tet4");
    let place = |x: [f64; 3]| {
        let (c, s) = (turn.cos(), turn.sin());
        let [x, y, z] = x;
        // the height is y in the plane and z in space
        if solid {
            [x, c * y - s * z, s * y + c * z]
        } else {
            [c * x - s * y, s * x + c * y, 0.0]
        }
    };
    let mut block = |group: &str, n: [usize; 3], [from, to]: [[f64; 3]; 2]| {
        let ends = [0, 1, 2].map(|a| (from[a], to[a]));
        let size = if solid { n } else { [n[0], n[2], 0] };
        scene.straight(group, element, size, |k| {
            let at = |a: usize, k: usize, n: usize| {
                ends[a].0 + (ends[a].1 - ends[a].0) * k as f64 / n as f64
            };
            let x = match solid {
                true => [at(0, k[0], n[0]), at(1, k[1], n[1]), at(2, k[2], n[2])],
                false => [at(0, k[0], n[0]), at(2, k[1], n[2]), 0.0],
            };
            Vec3::from(place(x))
        });
    };
    block("low", [4, 4, 3], [[0.0, 0.0, 0.0], [4.0, 4.0, 1.0]]);
    let bottom = 1.0 - overlap;
    block(
        "up",
        [3, 3, 3],
        [[1.0, 1.0, bottom], [3.0, 3.0, bottom + 1.0]],
    );
    let height = |x: &[f64]| match solid {
        true => turn.cos() * x[2] - turn.sin() * x[1],
        false => turn.cos() * x[1] - turn.sin() * x[0],
    };
    for (name, group, at) in [
        ("base", "low", 0.0),
        ("top", "low", 1.0),
        ("foot", "up", bottom),
        ("head", "up", bottom + 1.0),
    ] {
        let faces = scene.facets_where(group, |x| (height(x) - at).abs() < 1e-9);
        let faces: Vec<(usize, &str)> = faces.iter().map(|(c, s)| (*c, s.as_str())).collect();
        scene.faces(name, &faces);
    }
    let sides = if swapped {
        ["top", "foot"]
    } else {
        ["foot", "top"]
    };
    let space = if solid { "3d" } else { "plane-strain" };
    let axes = if solid { "xyz" } else { "xy" };
    scene
        .elastic(space, 100.0, 0.3)
        .body(&["low"], "")
        .body(&["up"], "")
        .contact(sides[0], sides[1], by)
        .step("s", 1)
        .fix("base", axes)
        .fix("head", axes)
}

fn built(case: &Case) -> Result<Model, Diagnostics> {
    let (case, _) = read_case(
        "blocks",
        case.text().as_bytes(),
        &[],
        signorini::vocabulary(),
    )?;
    let (mesh, _) = read_mesh_of(&case, Path::new("."))?;
    build(case, mesh)
}

const ELEMENTS: [&str; 4] = ["quad4", "tri3", "hex8", "tet4"];

const WAYS: [&str; 3] = [
    "",
    "method = \"node-to-segment\"",
    "method = \"gauss-point\"",
];

#[test]
fn overlaps_up_to_half_the_height_are_told_with_their_place_and_treatment() {
    for element in ELEMENTS {
        for (by, swapped, turn) in [
            (WAYS[0], false, 0.0),
            (WAYS[0], true, 0.5),
            (WAYS[1], false, 0.5),
            (WAYS[2], true, 0.0),
        ] {
            let model = built(&blocks(element, 0.3, turn, swapped, by)).unwrap();
            let start = &model.contacts[0].start;
            let gap = start.gap.unwrap();
            assert!((gap + 0.3).abs() < 1e-9, "{element} {by}: {gap}");
            let ramped = Treatment::Interference(Interference::Ramped);
            assert_eq!(start.treatment, ramped);
            let text = model.warnings.plain();
            assert!(
                text.contains("overlap at the start by up to 0.300 at node"),
                "{text}"
            );
            assert!(text.contains("resolved over step \"s\""), "{text}");
        }
    }
}

#[test]
fn overlaps_beyond_half_the_height_are_refused_with_places() {
    for element in ELEMENTS {
        for (by, swapped, turn) in [
            (WAYS[0], false, 0.0),
            (WAYS[0], true, 0.5),
            (WAYS[1], false, 0.5),
            (WAYS[2], true, 0.0),
        ] {
            let Err(found) = built(&blocks(element, 0.6, turn, swapped, by)) else {
                panic!("{element} {by} {swapped}: built");
            };
            assert_eq!(found.exit_code(), Some(4));
            let text = found.plain();
            assert!(text.contains("S0312"), "{text}");
            assert!(text.contains("overlap by 0.600 at the start"), "{text}");
            assert!(text.contains("the deepest is node"), "{text}");
            // intended
            let now = format!("{by}\nstart = {{ interference = \"strain-free\" }}");
            assert!(built(&blocks(element, 0.6, turn, swapped, &now)).is_ok());
        }
    }
}

#[test]
fn gaps_are_told_as_they_are() {
    for element in ELEMENTS {
        for by in WAYS {
            let model = built(&blocks(element, -0.25, 0.5, false, by)).unwrap();
            let start = &model.contacts[0].start;
            let gap = start.gap.unwrap();
            assert!((gap - 0.25).abs() < 1e-9, "{element} {by}: {gap}");
            assert_eq!((start.touching, start.overlapping), (0, 0));
            let flush = built(&blocks(element, 0.0, 0.0, false, by)).unwrap();
            let start = &flush.contacts[0].start;
            assert_eq!((start.gap, start.overlapping), (Some(0.0), 0));
            assert!(start.touching > 3, "{element} {by}");
        }
    }
}
