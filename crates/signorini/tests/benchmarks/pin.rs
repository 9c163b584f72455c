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
use crate::common::{Run, run};
use crate::scene::{Case, Scene};
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

/// A pin in its hole, pulled along x.
#[derive(Clone, Copy, Debug)]
pub struct Pin {
    /// Facets around the hole.
    pub around: usize,
    /// Diameter of the hole less that of the pin.
    pub clearance: f64,
    pub mu: f64,
    pub on_nodes: bool,
    pub increments: usize,
}

impl Pin {
    pub fn case(self) -> Case {
        let mut scene = Scene::default();
        let radii = [HOLE, 13.0, 17.0, 25.0];
        let (lug, outer) = ring(&mut scene, "lug", &radii, self.around, 0.0);
        let radii = [3.0, 5.0, 7.5, HOLE - 0.5 * self.clearance];
        let (pin, inner) = ring(&mut scene, "pin", &radii, self.around - 4, 0.25);
        let faces = |cells: &[usize], side: &'static str| -> Vec<(usize, &'static str)> {
            cells.iter().map(|c| (*c, side)).collect()
        };
        let outside = lug[3].iter().copied();
        let held: Vec<usize> = outside.filter(|n| scene.at(*n)[0] < -12.0).collect();
        scene.set("clamp", &held);
        scene.set("bore", &pin[0]);
        scene.faces("hole", &faces(&outer[0], "S4"));
        scene.faces("surface", &faces(&inner[2], "S2"));
        scene.faces("inside", &faces(&inner[0], "S4"));
        let friction = if self.mu > 0.0 {
            format!("friction = {:?}", self.mu)
        } else {
            String::new()
        };
        let n = (self.around - 4) as f64;
        let length = 2.0 * n * 3.0 * (0.5 * TAU / n).sin();
        let case = scene
            .elastic("plane-strain", 210e3, 0.3)
            .body(&["lug", "pin"], "")
            .contact("hole", "surface", &friction)
            .step("pull", self.increments)
            .fix("clamp", "xy");
        match self.on_nodes {
            true => case.load("bore", &format!("per_node = [{:?}, 0.0]", LOAD / n)),
            false => case.load("inside", &format!("traction = [{:?}, 0.0]", LOAD / length)),
        }
    }

    /// The first increment whose contact does not bear the load, and its force.
    pub fn wrong(self, run: &Run) -> Option<String> {
        let off = |increment: &usize| {
            let [x, y, _] = run.contact_force(*increment);
            let load = LOAD * run.frames[increment - 1].time;
            (x - load).abs() > 1e-4 * LOAD || y.abs() > 1e-4 * LOAD
        };
        let increment = (1..=run.frames.len()).find(off)?;
        let force = run.contact_force(increment);
        Some(format!("increment {increment}: {force:?}"))
    }
}

#[test]
fn a_pin_that_only_contact_holds_finds_it_from_across_the_gap() {
    let mut at_once = 0;
    for around in [32, 48] {
        for clearance in [0.02, 0.2] {
            for mu in [0.0, 0.1, 0.3] {
                for on_nodes in [true, false] {
                    let pin = Pin {
                        around,
                        clearance,
                        mu,
                        on_nodes,
                        increments: 10,
                    };
                    at_once += usize::from(is_found_at_once(pin));
                }
            }
        }
    }
    assert!(at_once >= 20, "{at_once} of 24");
}

/// Whether a pin is found without a cut, in at most 120 iterations.
fn is_found_at_once(pin: Pin) -> bool {
    let run = run(&mut pin.case().model(&[]));
    assert!(run.error.is_none(), "{pin:?}: {:?}", run.error);
    assert!(run.cutbacks.len() <= 1, "{pin:?}: {:?}", run.cutbacks);
    assert_eq!(pin.wrong(&run), None, "{pin:?}");
    let iterations: usize = run.increments.iter().map(|i| i.iterations).sum();
    if std::env::var_os("SHOW_PINS").is_some() {
        let each: Vec<usize> = run.increments.iter().map(|i| i.iterations).collect();
        println!(
            "{pin:?}: {iterations} iterations {each:?}, {} cuts",
            run.cutbacks.len()
        );
    }
    run.cutbacks.is_empty() && iterations <= 120
}
