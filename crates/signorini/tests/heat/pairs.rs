//! Two bodies that conduct into one another: blocks that close as they warm, a flux that varies along the contact, nodes on a face.

use super::*;
use crate::common::reference;
use std::f64::consts::PI;

const METHODS: [&str; 3] = ["node-to-segment", "gauss-point", "mortar"];

/// A strain without stress whose nodes are 0.02 x² (1 − y) off: with it, what is meshed as a flat block is one with a crown.
fn crown([nx, ny]: [usize; 2]) -> String {
    let mut rows = String::new();
    let point = [-1.0, 1.0].map(|s: f64| 0.5 + 0.5 * s / 3.0_f64.sqrt());
    for (j, i) in (0..ny).flat_map(|j| (0..nx).map(move |i| (j, i))) {
        let [left, right] = [i, i + 1].map(|i| i as f64 / nx as f64);
        for (k, (y, x)) in point.iter().flat_map(|y| point.map(|x| (y, x))).enumerate() {
            let height = 0.02 * (left * left * (1.0 - x) + right * right * x);
            let slope = 0.02 * (left + right) * (1.0 - (j as f64 + y) / ny as f64);
            let element = i + nx * j + 1;
            rows += &format!(
                "[{element}, {}, 0.0, {:?}, 0.0, {:?}, 0.0, 0.0],\n",
                k + 1,
                -height,
                0.5 * slope
            );
        }
    }
    format!("[initial]\nstrain = [\n{rows}]\n")
}

/// A hot block with a crown over a cold one that does not expand; they conduct by their pressure.
fn crowned(method: &str, [ns, nm, ny]: [usize; 3]) -> (Boxes, String) {
    let mut boxes = Boxes::new(2);
    boxes.add("upper", [0.0; 3], [1.0; 3], [ns, ny, 1]);
    boxes.add("lower", [0.0, -1.0, 0.0], [1.0, 0.0, 1.0], [nm, ny, 1]);
    let law = |alpha: f64| {
        format!(
            "model = \"linear-elastic\"\nE = 1000.0\nnu = 0.3\nconductivity = 10.0\nexpansion = {{ alpha = {alpha:?} }}"
        )
    };
    let text = boxes.case(&format!(
        "[material.a]\n{}\n[material.b]\n{}\n[[body]]\ngroup = \"upper\"\nmaterial = \"a\"\nlocking = \"none\"\n\
         [[body]]\ngroup = \"lower\"\nmaterial = \"b\"\nlocking = \"none\"\n{}\
         [[contact]]\nname = \"c\"\nsecondary = \"upper_bottom\"\nprimary = \"lower_top\"\nmethod = \"{method}\"\n\
         enforcement = {{ penalty = 1e6, per = \"area\" }}\nreach = 0.5\nconductance = {{ over_pressure = [[0.0, 0.0], [1e6, 3e6]] }}\n\
         [[step]]\nname = \"heat\"\nkind = \"coupled\"\ngeometry = \"linear\"\nincrements = {{ fixed = 1 }}\n\
         fix = [{{ on = \"upper_left\", u = [\"x\"] }}, {{ on = \"lower_left\", u = [\"x\"] }}, {{ on = \"lower_bottom\", u = [\"y\"] }}]\n\
         move = [{{ on = \"upper_top\", uy = 0.08 }}]\n\
         temperature = [{{ on = \"upper_top\", value = 100.0 }}, {{ on = \"lower_bottom\", value = 0.0 }}]\n\
         [solver]\nnewton = {{ force_tol = 1e-8 }}\n",
        law(1e-3),
        law(0.0),
        crown([ns, ny]),
    ));
    (boxes, text)
}

/// `two_blocks_coupled.json`: quad4 with expansions by the mean temperature of elements, mortar. Force and heat to its tolerance.
#[test]
fn blocks_that_close_as_they_warm_press_and_conduct_as_in_an_independent_program() {
    let Some(all) = reference("thermal/two_blocks_coupled.json") else {
        return;
    };
    // the coarsest mesh alone where nothing is optimized
    let count = if cfg!(debug_assertions) { 1 } else { 3 };
    for run in all["runs"].as_array().unwrap().iter().take(count) {
        let value = |key: &str| run[key].as_f64().unwrap();
        let cells = ["ns", "nm", "ny"].map(|key| value(key) as usize);
        for method in METHODS {
            let (_, text) = crowned(method, cells);
            let (run, _) = solved(&text);
            let frame = run.frames.last().unwrap();
            let force = frame.contacts[0].force_normal.y;
            let heat = 0.5 * heat_in(frame)[1];
            let what = format!("{method} {cells:?}");
            assert!((force / value("F") - 1.0).abs() < 2e-3, "{what}: {force}");
            assert!((heat / value("Q") - 1.0).abs() < 5e-4, "{what}: {heat}");
            assert!(run.cutbacks.is_empty(), "{what}: {:?}", run.cutbacks);
            let found = run.increments[0].iterations;
            assert!(found <= 9, "{what}: {found} iterations");
        }
    }
}

/// A flux that varies as a cosine, with rectangles of height 1/4f on which 3f:2f facets do not match, and what it is at nodes
/// of the secondary side or, where the points are within facets, at these: places and values.
fn cosine(method: &str, f: usize) -> Vec<[f64; 2]> {
    let [ns, nm, ny] = [3 * f, 2 * f, 4 * f];
    let mut boxes = Boxes::new(2);
    boxes.add("upper", [0.0; 3], [1.0; 3], [ns, ny, 1]);
    boxes.add("lower", [0.0, -1.0, 0.0], [1.0, 0.0, 1.0], [nm, ny, 1]);
    let mut given = String::new();
    for node in boxes.nodes("upper_top").to_vec() {
        let value = (PI * boxes.place(node)[0]).cos();
        boxes.set(&format!("n{node}"), vec![node]);
        given += &format!("{{ on = \"n{node}\", value = {value:?} }}, ");
    }
    let text = boxes.case(&format!(
        "[material.a]\nconductivity = 1.0\n[material.b]\nconductivity = 2.0\n\
         [[body]]\ngroup = \"upper\"\nmaterial = \"a\"\n[[body]]\ngroup = \"lower\"\nmaterial = \"b\"\n\
         [[contact]]\nname = \"c\"\nsecondary = \"upper_bottom\"\nprimary = \"lower_top\"\nmethod = \"{method}\"\n\
         enforcement = {{ penalty = 1.0 }}\nconductance = 20.0\n\
         [[step]]\nname = \"heat\"\nkind = \"heat\"\nincrements = 1\n\
         temperature = [{given}{{ on = \"lower_bottom\", value = 0.0 }}]\n\
         [solver]\nnewton = {{ force_tol = 1e-12 }}\n"
    ));
    let (run, _) = solved(&text);
    let frame = run.frames.last().unwrap();
    let [upper, lower] = ["upper_bottom", "lower_top"].map(|side| at(frame, &boxes, side));
    let all = at(frame, &boxes, "upper_all");
    let along = |side: &[f64], x: f64| {
        let place = x * (side.len() - 1) as f64;
        let left = (place as usize).min(side.len() - 2);
        let part = place - left as f64;
        side[left] * (1.0 - part) + side[left + 1] * part
    };
    if method == "gauss-point" {
        let points = (0..ns).flat_map(|i| [-1.0, 1.0].map(|s| (i, s)));
        let places = points.map(|(i, s)| (i as f64 + 0.5 + 0.5 * s / 3.0_f64.sqrt()) / ns as f64);
        return places
            .map(|x| [x, 20.0 * (along(&upper, x) - along(&lower, x))])
            .collect();
    }
    // what flows out of the first row of rectangles, over the part of the side that a node stands for
    let [a, b] = [ns, ny].map(|n| (n as f64).recip());
    let mut flow = vec![0.0; ns + 1];
    for i in 0..ns {
        let [p, q, r, s] = [i, i + 1, i + ns + 2, i + ns + 1].map(|k| all[k]);
        let [x, y] = [b / a / 6.0, a / b / 6.0];
        flow[i] += x * (2.0 * (p - q) + s - r) + y * (2.0 * (p - s) + q - r);
        flow[i + 1] += x * (2.0 * (q - p) + r - s) + y * (2.0 * (q - r) + p - s);
    }
    let share = |i: usize| if i == 0 || i == ns { 0.5 * a } else { a };
    let of = |(i, flow): (usize, f64)| [i as f64 * a, -flow / share(i)];
    flow.into_iter().enumerate().map(of).collect()
}

/// `cosine_flux.json`: errors over the largest flux, of which two digits are given.
#[test]
fn a_flux_that_varies_along_the_contact_is_as_far_off_as_in_an_independent_program() {
    let Some(exact) = reference("thermal/cosine_flux.json") else {
        return;
    };
    let most = exact["q0"].as_f64().unwrap();
    for (method, expected) in [
        ("mortar", ["3.3e-1", "9.9e-2", "2.8e-2", "8.0e-3"]),
        ("gauss-point", ["2.8e-1", "9.2e-2", "2.9e-2", "1.0e-2"]),
        ("node-to-segment", ["3.3e-1", "1.3e-1", "6.6e-2", "3.6e-2"]),
    ] {
        let count = if cfg!(debug_assertions) { 3 } else { 4 };
        for (f, expected) in [1, 2, 4, 8].into_iter().zip(expected).take(count) {
            let all = cosine(method, f).into_iter();
            let off = all.map(|[x, q]| (q / most - (PI * x).cos()).abs());
            let off = off.fold(0.0, f64::max);
            assert_eq!(format!("{off:.1e}"), expected, "{method} {f}: {off}");
        }
    }
}

/// `contact7_ccx.json`: nodes of a small cube on a face, with the area of all faces around them, in the increments of CalculiX.
#[test]
fn nodes_on_a_face_conduct_as_in_calculix() {
    let Some(all) = reference("thermal/contact7_ccx.json") else {
        return;
    };
    let mut boxes = Boxes::new(3);
    boxes.add("lower", [0.0; 3], [1.0; 3], [1; 3]);
    boxes.add("upper", [-1.0, 1.0, -1.0], [1.0, 1.2, 1.0], [1; 3]);
    // turned by 45 degrees, with sides of 0.2
    boxes.bend("upper", |[x, y, z]| {
        let half = 0.1 / 2.0_f64.sqrt();
        [0.5 + half * (x - z), y, 0.5 + half * (x + z)]
    });
    let mut steps = String::new();
    let increments = common::numbers(&all["dt"]);
    for (k, dt) in increments.iter().enumerate() {
        steps += &format!(
            "[[step]]\nname = \"{k}\"\nkind = \"heat\"\nthermal = \"transient\"\nduration = {dt:?}\nincrements = {{ fixed = 1 }}\n"
        );
        if k == 0 {
            steps += "temperature = [{ on = \"lower_bottom\", value = 0.0 }, { on = \"upper_top\", value = 1000.0 }]\n";
        }
    }
    let text = boxes.case(&format!(
        "[initial]\ntemperature = 0.0\nat = [{{ on = \"upper_top\", temperature = 1000.0 }}]\n\
         [material.m]\nconductivity = 0.01\nspecific_heat = 1e3\ndensity = 7.8e-9\n\
         [[body]]\ngroup = [\"lower\", \"upper\"]\nmaterial = \"m\"\n\
         [[contact]]\nname = \"c\"\nsecondary = \"upper_bottom\"\nprimary = \"lower_top\"\nmethod = \"node-to-segment\"\n\
         area = \"adjacent\"\nenforcement = {{ penalty = 1e7, per = \"area\" }}\nconductance = 1.0\n{steps}\
         [solver]\nnewton = {{ force_tol = 1e-12 }}\n"
    ));
    let (run, _) = solved(&text);
    for (key, by_hand, frame) in [
        ("ccx_first", [51.453_03, 66.888_94], &run.frames[0]),
        ("ccx_last", [164.381_53, 178.080_20], &run.frames[9]),
    ] {
        let expected = common::numbers(&all[key]);
        for ((side, expected), by_hand) in ["lower_top", "upper_bottom"]
            .iter()
            .zip(expected)
            .zip(by_hand)
        {
            for t in at(frame, &boxes, side) {
                assert!((t - by_hand).abs() < 1e-5, "{key} {side}: {t} {by_hand}");
                assert!(
                    (t / expected - 1.0).abs() < 1e-5,
                    "{key} {side}: {t} {expected}"
                );
            }
        }
    }
}
