//! Two bodies that conduct into one another: blocks that close as they warm.

use super::*;
use crate::common::reference;

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
