//! A ball and a cylinder on elastic blocks.
//!
//! SOURCE      Johnson, *Contact Mechanics*, 1985, (3.38)–(3.40) for the cylinder (4.45)–(4.46), with
//!             `1/E* = 2 (1 − ν²)/E` for two bodies of one material.
//! GOAL        the largest pressure is that of Hertz at the force that is measured; forces are in balance.
//! MESH        examples/hertz_sphere_3d, examples/hertz_cylinder_2d (from Gmsh; 5 and 20 elements across the half width)
//! CONDITIONS  small strain and sliding, approach prescribed; `auto`, which is mortar
//! EXPECTED    p0 = (6 F E*²/(π³ R²))^⅓;  in the plane p0 = √(F E*/(π R))
//! TOLERANCE   3 %: bodies of finite size and facets of finite size; balance 1e-10 of the force
#![allow(clippy::unwrap_used)]

mod common;

use common::{Run, example, run};
use signorini::setup::Model;
use signorini_geometry::tensor::Vec3;
use std::f64::consts::PI;

const RADIUS: f64 = 10.0;
const TIGHT: [(&str, &str); 1] = [("solver.newton.force_tol", "1e-12")];

fn modulus() -> f64 {
    1000.0 / (1.0 - 0.3f64.powi(2)) / 2.0
}

/// The example, run to its end.
fn solved(name: &str) -> (Model, Run) {
    let mut model = example(name, &TIGHT);
    let run = run(&mut model);
    assert!(run.error.is_none(), "{:?}", run.error);
    (model, run)
}

/// What supports exert on a set of nodes.
fn reaction(model: &Model, run: &Run, set: &str) -> Vec3 {
    let frame = run.frames.last().unwrap();
    let nodes = model.nodes_of(set).unwrap();
    nodes
        .into_iter()
        .map(|n| frame.reaction_force[n as usize])
        .sum()
}

/// The forces on both sides of the contact and the supports along the axis of the load balance.
fn balanced(model: &Model, run: &Run, axis: usize, [top, bottom]: [&str; 2]) {
    let contact = &run.frames.last().unwrap().contacts[0];
    let (secondary, primary) = (contact.secondary, contact.primary);
    let size = secondary.force.norm();
    let sum = (secondary.force + primary.force).norm();
    assert!(sum < 1e-10 * size, "{sum:e}");
    let turning = (secondary.moment + primary.moment).norm();
    assert!(turning < 1e-10 * size * RADIUS, "{turning:e}");
    let pressed = reaction(model, run, top)[axis] + secondary.force[axis];
    assert!(pressed.abs() < 1e-10 * size, "{pressed:e}");
    let carried = reaction(model, run, bottom)[axis] + primary.force[axis];
    assert!(carried.abs() < 1e-10 * size, "{carried:e}");
}

#[test]
fn hertz_sphere_johnson_3_40() {
    let (model, run) = solved("hertz_sphere_3d");
    balanced(&model, &run, 2, ["sphere_top", "block_bottom"]);
    let contact = &run.frames.last().unwrap().contacts[0];
    // a quarter of the bodies
    let force = 4.0 * contact.secondary.force.z;
    let p0 = (6.0 * force * modulus().powi(2) / (PI.powi(3) * RADIUS.powi(2))).cbrt();
    let ratio = contact.pressure_max / p0;
    println!("force {force:.4}, p0 {p0:.4}, ratio {ratio:.4}");
    assert!((ratio - 1.0).abs() < 0.03);
}

#[test]
fn hertz_cylinder_johnson_4_46() {
    let (model, run) = solved("hertz_cylinder_2d");
    balanced(&model, &run, 1, ["cylinder_top", "block_bottom"]);
    let contact = &run.frames.last().unwrap().contacts[0];
    // half of the bodies
    let force = 2.0 * contact.secondary.force.y;
    let p0 = (force * modulus() / (PI * RADIUS)).sqrt();
    let ratio = contact.pressure_max / p0;
    println!("force {force:.4}, p0 {p0:.4}, ratio {ratio:.4}");
    assert!((ratio - 1.0).abs() < 0.03);
}
