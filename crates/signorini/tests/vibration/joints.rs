//! Bars that contact joins, or does not.

use super::mesh::{Block, Mesh};
use super::{agree, chain, elastic, solve};
use std::f64::consts::PI;

/// Two halves of the bar along x that face each other, with this many cells across; the left one is fixed.
struct Halves {
    across: [usize; 2],
    gap: f64,
    contact: String,
    /// What presses the right one to the left.
    pressure: f64,
    count: usize,
}

/// Cells along each half.
const ALONG: usize = 20;

impl Halves {
    fn text(&self) -> String {
        let half = |group, across, start: f64| Block {
            group,
            element: "quad4",
            cells: [ALONG, across, 0],
            origin: [start, 0.0, 0.0],
            size: [5.0, 1.0, 0.0],
        };
        let [left, right] = self.across;
        let mesh = Mesh::of(&[
            half("left", left, 0.0),
            half("right", right, 5.0 + self.gap),
        ]);
        let press = format!(
            "[[step]]\nname = \"press\"\ngeometry = \"linear\"\nincrements = 1\n\
             fix = [{{ on = \"all_nodes\", u = [\"y\"] }}, {{ on = \"base\", u = \"all\" }}]\n\
             load = [{{ on = \"head\", traction = [{:?}, 0.0] }}]\n",
            -self.pressure
        );
        let held = "fix = [{ on = \"all_nodes\", u = [\"y\"] }, { on = \"base\", u = \"all\" }]\n";
        let (press, held) = match self.pressure > 0.0 {
            true => (press.as_str(), ""),
            false => ("", held),
        };
        format!(
            "{}[model]\nspace = \"plane-strain\"\n{}[sets]\n{}{}{}{}{}\
             [[contact]]\nname = \"c\"\nsecondary = \"tail\"\nprimary = \"front\"\n{}\n{press}\
             [[step]]\nname = \"modes\"\nkind = \"frequency\"\ngeometry = \"linear\"\n{held}frequency = {{ modes = {} }}\n",
            mesh.text(),
            elastic(900.0, 0.0, "[\"left\", \"right\"]", ""),
            mesh.set("all_nodes", |_| true),
            mesh.set("base", |x| x[0] == 0.0),
            mesh.faces("front", "left +x"),
            mesh.faces("tail", "right -x"),
            mesh.faces("head", "right +x"),
            self.contact,
            self.count,
        )
    }
}

fn whole(count: usize) -> Vec<f64> {
    (1..=count).map(|k| chain(2 * ALONG, k, false)).collect()
}

/// By multipliers to rounding; by a penalty of 1e5 E/ℓ to its compliance, 1e-5 of an element.
#[test]
fn halves_that_are_pressed_together_vibrate_as_one_bar() {
    let penalty = format!(
        "enforcement = {{ penalty = {:?}, per = \"area\" }}",
        1e5 * 900.0 / 0.25
    );
    let lagrange = "enforcement = { lagrange = {} }".to_owned();
    for (method, law, tolerance) in [
        ("mortar", &lagrange, 1e-9),
        ("mortar", &penalty, 1e-5),
        ("node-to-segment", &lagrange, 1e-9),
        ("gauss-point", &penalty, 1e-5),
    ] {
        for across in [[1, 1], [3, 2], [2, 3]] {
            if method == "node-to-segment" && across != [1, 1] {
                continue;
            }
            for friction in ["", "friction = 0.4\n"] {
                let halves = Halves {
                    across,
                    gap: 0.0,
                    contact: format!("method = \"{method}\"\n{law}\n{friction}"),
                    pressure: 2.0,
                    count: 6,
                };
                let what = format!("{method} {law} {friction} {across:?}");
                agree(&what, &solve(&halves.text()).omegas(), &whole(6), tolerance);
            }
        }
    }
}

/// What is open joins nothing: a bar fixed at one end, and a free one.
#[test]
fn halves_that_are_apart_vibrate_as_two_bars() {
    for law in ["lagrange = {}", "penalty = 1e7, per = \"area\""] {
        let halves = Halves {
            across: [1, 1],
            gap: 0.125,
            contact: format!("method = \"mortar\"\nenforcement = {{ {law} }}"),
            pressure: 0.0,
            count: 5,
        };
        let c_h = 30.0 / 0.25;
        let of = |x: f64| c_h * (6.0 * (1.0 - x.cos()) / (2.0 + x.cos())).sqrt();
        let fixed = |k: usize| of((2 * k - 1) as f64 * PI / (2 * ALONG) as f64);
        let free = |k: usize| of(k as f64 * PI / ALONG as f64);
        let omegas = solve(&halves.text()).omegas();
        assert!(omegas[0].abs() < 1e-4, "{omegas:?}");
        let wanted = [fixed(1), free(1), fixed(2), free(2)];
        agree(&format!("apart, {law}"), &omegas[1..], &wanted, 1e-9);
    }
}

/// A block on another, pressed and pushed along: below the limit of friction it is joined, beyond it slides freely.
#[test]
fn what_sticks_is_joined_and_what_slides_is_free_along_the_other_side() {
    let block = |group, start: f64| Block {
        group,
        element: "quad4",
        cells: [2, 2, 0],
        origin: [0.0, start, 0.0],
        size: [1.0, 1.0, 0.0],
    };
    let mesh = Mesh::of(&[block("low", 0.0), block("high", 1.0)]);
    for law in ["lagrange = {}", "penalty = 1e8, per = \"area\""] {
        let lowest = |friction: &str, push: f64| {
            let text = format!(
                "{}[model]\nspace = \"plane-strain\"\n{}[sets]\n{}{}{}{}{}\
                 [[contact]]\nname = \"c\"\nsecondary = \"foot\"\nprimary = \"top\"\nmethod = \"mortar\"\n\
                 enforcement = {{ {law} }}\n{friction}\n\
                 [[step]]\nname = \"press\"\ngeometry = \"linear\"\nincrements = 1\n\
                 fix = [{{ on = \"base\", u = \"all\" }}]\nmove = [{{ on = \"lid\", ux = 0.0, uy = -0.01 }}]\n\
                 [[step]]\nname = \"push\"\nincrements = 4\ngeometry = \"linear\"\nmove = [{{ on = \"lid\", ux = {push:?}, uy = -0.01 }}]\n\
                 [[step]]\nname = \"modes\"\nkind = \"frequency\"\ngeometry = \"linear\"\nfrequency = {{ modes = 6 }}\n\
                 free = [{{ on = \"lid\", u = [\"x\"] }}]\n",
                mesh.text(),
                elastic(900.0, 0.0, "[\"low\", \"high\"]", ""),
                mesh.set("base", |x| x[1] == 0.0),
                mesh.set("lid", |x| x[1] == 2.0),
                mesh.faces("top", "low +y"),
                mesh.faces("foot", "high -y"),
                mesh.faces("lid_faces", "high +y"),
            );
            solve(&text).omegas()
        };
        let sticks = lowest("friction = 0.5", 1e-4);
        let slides = lowest("friction = 0.01", 0.05);
        let smooth = lowest("", 0.05);
        assert!(sticks[0] > 1.0, "{law} {sticks:?}");
        // the upper block goes along as a whole, without resistance
        assert!(
            smooth[0].abs() < 1e-3 && slides[0].abs() < 1e-3,
            "{law} {smooth:?} {slides:?}"
        );
        agree(
            &format!("sliding as if smooth, {law}"),
            &slides[1..],
            &smooth[1..],
            1e-6,
        );
    }
}
