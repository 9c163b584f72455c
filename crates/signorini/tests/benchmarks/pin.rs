//! A pin in a hole with clearance, held by nothing but contact.
//!
//! SOURCE      Written for the purpose.
//! GOAL        the first increment finds its contact from across the gap, whatever the friction; viscous forces that hold the pin
//!             until then bear nothing in the end
//! MESH        rings of quad4: the hole 20 wide, the pin turned by a quarter of its facets; 32 and 48 around
//! CONDITIONS  plane strain, small strain, E = 210,000, nu = 0.3; clearance 0.02 and 0.2; friction 0, 0.1 and 0.3; 1000 per
//!             thickness on the nodes of the pin's bore, or as a traction on it, in ten increments
//! EXPECTED    the contact bears the load
//! TOLERANCE   1e-4 of the whole load in every increment; 20 of the 24 in at most 120 iterations without a cut, the others with one
use crate::common::run;
use crate::scene::Scene;
use std::f64::consts::TAU;

const HOLE: f64 = 10.0;
const LOAD: f64 = 1000.0;

/// A ring of so many cells around: labels of its nodes circle by circle, and of its cells.
fn ring(
    scene: &mut Scene,
    group: &str,
    radii: &[f64],
    around: usize,
    turn: f64,
) -> (Vec<Vec<usize>>, Vec<Vec<usize>>) {
    let mut circle = |r: f64| -> Vec<usize> {
        let angle = |k: usize| TAU * (k as f64 + turn) / around as f64;
        let places = (0..around).map(angle).map(|t| [r * t.cos(), r * t.sin()]);
        places.map(|x| scene.node(&x)).collect()
    };
    let circles: Vec<Vec<usize>> = radii.iter().map(|r| circle(*r)).collect();
    let mut cells = Vec::new();
    for pair in circles.windows(2) {
        let of = |k: usize| {
            let next = (k + 1) % around;
            vec![pair[0][k], pair[1][k], pair[1][next], pair[0][next]]
        };
        let row = (0..around).map(|k| scene.cell("quad4", group, of(k)));
        cells.push(row.collect());
    }
    (circles, cells)
}

#[test]
fn a_pin_that_only_contact_holds_finds_it_from_across_the_gap() {
    let mut at_once = 0;
    for around in [32, 48] {
        for clearance in [0.02, 0.2] {
            for mu in [0.0, 0.1, 0.3] {
                for on_nodes in [true, false] {
                    at_once += usize::from(bears(around, clearance, mu, on_nodes));
                }
            }
        }
    }
    assert!(at_once >= 20, "{at_once} of 24");
}

/// Whether a pin is found without a cut, in at most 120 iterations.
fn bears(around: usize, clearance: f64, mu: f64, on_nodes: bool) -> bool {
    let mut scene = Scene::default();
    let radii = [HOLE, 13.0, 17.0, 25.0];
    let (lug, outer) = ring(&mut scene, "lug", &radii, around, 0.0);
    let radii = [3.0, 5.0, 7.5, HOLE - 0.5 * clearance];
    let (pin, inner) = ring(&mut scene, "pin", &radii, around - 4, 0.25);
    let faces = |cells: &[usize], side: &'static str| -> Vec<(usize, &'static str)> {
        cells.iter().map(|c| (*c, side)).collect()
    };
    let held: Vec<usize> = lug[3]
        .iter()
        .copied()
        .filter(|n| scene.at(*n)[0] < -12.0)
        .collect();
    scene.set("clamp", &held);
    scene.set("bore", &pin[0]);
    scene.faces("hole", &faces(&outer[0], "S4"));
    scene.faces("surface", &faces(&inner[2], "S2"));
    scene.faces("inside", &faces(&inner[0], "S4"));
    let friction = if mu > 0.0 {
        format!("friction = {mu:?}")
    } else {
        String::new()
    };
    let n = (around - 4) as f64;
    let length = 2.0 * n * 3.0 * (0.5 * TAU / n).sin();
    let case = scene
        .elastic("plane-strain", 210e3, 0.3)
        .body(&["lug", "pin"], "")
        .contact("hole", "surface", &friction)
        .step("pull", 10)
        .fix("clamp", "xy");
    let case = match on_nodes {
        true => case.load("bore", &format!("per_node = [{:?}, 0.0]", LOAD / n)),
        false => case.load("inside", &format!("traction = [{:?}, 0.0]", LOAD / length)),
    };
    let what = format!("{around} around, clearance {clearance}, mu {mu}, on nodes: {on_nodes}");
    let run = run(&mut case.model(&[]));
    assert!(run.error.is_none(), "{what}: {:?}", run.error);
    assert!(run.cutbacks.len() <= 1, "{what}: {:?}", run.cutbacks);
    for increment in 1..=run.frames.len() {
        let [x, y, _] = run.contact_force(increment);
        let load = LOAD * run.frames[increment - 1].time;
        assert!(
            (x - load).abs() < 1e-4 * LOAD,
            "{what}, increment {increment}: {x}"
        );
        assert!(y.abs() < 1e-4 * LOAD, "{what}, increment {increment}: {y}");
    }
    let iterations: usize = run.increments.iter().map(|i| i.iterations).sum();
    run.cutbacks.is_empty() && iterations <= 120
}
