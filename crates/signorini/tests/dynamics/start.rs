//! How a motion starts of what touches.

use super::bar::{Bar, LENGTH, WAVE};
use super::common::{model, run};
use super::impact::{apart, sliding};
use super::{energy, solved};
use signorini_geometry::tensor::Vec3;
use signorini_mechanics::system::Frame;

fn last(text: &str, place: &str) -> Frame {
    let done = run(&mut model("start", text, &[]));
    assert!(done.error.is_none(), "{place}: {:?}", done.error);
    done.frames.into_iter().last().unwrap()
}

/// Blocks that touch and are pulled apart fall freely from the start: `g t²/2`, to rounding.
#[test]
fn blocks_that_are_pulled_apart_fall_freely() {
    for ndim in [2, 3] {
        for method in ["mortar", "node-to-segment"] {
            for (matrix, friction) in [("consistent", ""), ("lumped", "friction = 0.3")] {
                let contact = format!(
                    "method = \"{method}\"\nenforcement = {{ lagrange = {{}} }}\n{friction}"
                );
                let z = if ndim == 3 { ", 0.0" } else { "" };
                let text = apart(ndim, true, &contact, 0.0).replace(
                    "material = \"soft\"",
                    &format!("material = \"soft\"\nmass_matrix = \"{matrix}\""),
                ) + &format!(
                    "duration = 0.1\nincrements = {{ fixed = 5 }}\n\
                     load = [{{ on = \"upper\", gravity = [0, 2.0{z}] }}, {{ on = \"lower\", gravity = [0, -1.0{z}] }}]\n"
                );
                let place = format!("{ndim} {contact} {matrix}");
                let frame = last(&text, &place);
                let lower = if ndim == 3 { 5 * 4 * 3 } else { 5 * 4 };
                for (node, u) in frame.displacement.iter().enumerate() {
                    let g = if node < lower { -1.0 } else { 2.0 };
                    let away = *u - Vec3::new(0.0, 0.5 * g * 0.01, 0.0);
                    assert!(away.norm() < 1e-12, "{place}: node {node}: {u:?}");
                }
            }
        }
    }
}

/// Nodes that are pressed on a floor by their own weight stick, or slip at an acceleration of `g_t − μ g_n`, from the start; those that slide
/// already are braked along their velocity.
#[test]
fn what_is_pressed_on_a_floor_sticks_or_slips_from_the_start() {
    let contact = "method = \"node-to-segment\"\nenforcement = { lagrange = {} }";
    for (v, along, a) in [
        (0.0, 3.0, 0.0),
        (0.0, 8.0, 3.0),
        (0.0, -8.0, -3.0),
        (1.0, 0.0, -5.0),
        (-1.0, 3.0, 8.0),
        (-1.0, 8.0, 13.0),
    ] {
        let text = sliding(contact, "")
            .replace("v = [1.0, 0.0]", &format!("v = [{v:?}, 0.0]"))
            .replace("[0, -10.0]", &format!("[{along:?}, -10.0]"))
            .replace("duration = 0.3", "duration = 2e-5")
            .replace("fixed = 300", "fixed = 2")
            .replace(
                "material = \"m\"",
                "material = \"m\"\nmass_matrix = \"lumped\"",
            );
        let frame = last(&text, &format!("{v} {along}"));
        for node in 0..4 {
            let u = frame.displacement[node];
            let own = (u.x - v * 2e-5) / (0.5 * 4e-10);
            assert!(
                (own - a).abs() < 0.01,
                "{v} {along}: node {node}: {own} for {a}"
            );
            assert!(u.y.abs() < 1e-15, "{v} {along}: node {node}: {u:?}");
        }
    }
}

/// The same in space on facets that do not match; those of mortar rub from the second increment on.
#[test]
fn what_is_pressed_on_facets_slips_from_the_start() {
    let contact = "method = \"node-to-segment\"\nenforcement = { lagrange = {} }\nfriction = 0.3";
    for [x, z] in [[2.0, 1.0], [8.0, -3.0]] {
        let text = apart(3, true, contact, 0.0).replace(
            "material = \"soft\"",
            "material = \"soft\"\nmass_matrix = \"lumped\"",
        ) + &format!(
            "duration = 2e-4\nincrements = {{ fixed = 2 }}\n\
                 fix = [{{ on = \"lower\", u = \"all\" }}]\n\
                 load = [{{ on = \"upper\", gravity = [{x:?}, -10.0, {z:?}] }}]\n"
        );
        let place = format!("{x} {z}");
        let frame = last(&text, &place);
        let along = Vec3::new(x, 0.0, z);
        let slips = (along.norm() - 3.0).max(0.0) / along.norm();
        // the layer at the bottom of 4 × 5 × 4 nodes
        for k in 0..4 {
            for i in 0..4 {
                let node = 5 * 4 * 3 + i + 4 * 5 * k;
                let own = frame.displacement[node] * (2.0 / 4e-8);
                let away = (own - along * slips).norm();
                assert!(away < 0.02, "{place}: node {node}: {own:?}");
            }
        }
    }
}

/// A bar that touches a wall and moves towards it has the force of its wave from the start, gives no energy, and increments that adapt
/// are no shorter for the sake of the impact than a wave takes through half an element.
#[test]
fn what_touches_and_meets_is_stopped_at_the_start() {
    let bar = Bar {
        elements: 20,
        ..Bar::default()
    };
    let (force, long) = (WAVE * bar.velocity, 2.0 * LENGTH / WAVE);
    let fixed = [0.2, 0.375, 1.0].map(|courant| {
        let h = courant * bar.size() / WAVE;
        format!("{{ fixed = {} }}", (1.0 / h).round())
    });
    for mass in ["as-is", "redistributed"] {
        for increments in fixed.iter().chain([&"20".to_owned(), &"200".to_owned()]) {
            let text = bar.text();
            let step = text.find("duration").unwrap();
            let (before, _) = text.split_at(step);
            let text = format!(
                "{before}duration = 1.0\nincrements = {increments}\n\
                 dynamics = {{ rho_inf = 0.8, contact_mass = \"{mass}\" }}\nfix = [{{ on = \"bar\", u = [\"y\"] }}]\n"
            );
            let got = solved(&text);
            let place = format!("{mass} {increments}");
            let largest = energy(&got).into_iter().fold(0.0, f64::max);
            assert!(largest < 500.0 * 1.001, "{place}: {largest}");
            assert!(got["time"].len() < 500, "{place}: {}", got["time"].len());
            let rows = got["time"].iter().zip(&got["c.force_x"]);
            let middle = rows.filter(|(t, _)| (0.1 * long..0.9 * long).contains(*t));
            let squares: Vec<f64> = middle.map(|(_, f)| (f / force - 1.0).powi(2)).collect();
            let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
            assert!(rms < 0.15, "{place}: {rms}");
        }
    }
}
