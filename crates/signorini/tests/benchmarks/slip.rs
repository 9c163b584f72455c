//! Friction with exact answers: partial slip of cylinders, a pad on an incline, a block on a slope.
//!
//! SOURCE      Johnson, *Contact Mechanics*, 1985, (7.28)–(7.30) (Cattaneo 1938, Mindlin 1949); statics
//! GOAL        slip begins where and when Coulomb's law says, and goes as far as springs let it
//! MESH        half discs graded to the contact; a pad of 8 × 4, a block of 2 × 2 quad4
//! CONDITIONS  small strain, forces prescribed, multipliers and penalties
//! EXPECTED    closed forms at the tests
//! TOLERANCE   stick radius to an element; displacements of blocks 1e-5, of the pad 2e-4: it is elastic, 300/E times 20
use crate::common::Run;
use crate::scene::{Grid, Scene, Side, equal, finished, graded};
use std::f64::consts::PI;

/// The half of a disc that touches y = 0 in the origin, above (`up` = 1) or below (−1) it.
fn half(scene: &mut Scene, group: &str, radius: f64, [fine, h]: [f64; 2], up: f64) -> Grid {
    let right = graded(fine / radius, h / radius, 1.25, 0.5 * PI);
    let left = right.iter().skip(1).rev().map(|t| -t);
    let angles: Vec<f64> = left.chain(right.iter().copied()).collect();
    let depths = graded(3.0 * h, h, 1.3, 0.8 * radius);
    scene.grid(group, [&angles, &depths], |t, d| {
        let r = radius - d;
        [up * r * t.sin(), up * (radius - r * t.cos())]
    })
}

#[test]
fn partial_slip_of_cylinders_cattaneo_mindlin() {
    cattaneo("method = \"node-to-segment\"");
    cattaneo("method = \"gauss-point\"");
}

#[test]
fn partial_slip_of_cylinders_by_multipliers() {
    cattaneo("method = \"node-to-segment\"\nenforcement = { lagrange = {} }");
}

#[test]
fn partial_slip_of_cylinders_by_mortar() {
    cattaneo("method = \"mortar\"");
}

/// P, Q and mu.
const PRESSED: f64 = 10.0;
const SHEARED: f64 = 0.93616;
const FRICTION: f64 = 0.3;

/// Two cylinders of radius 8, pressed without friction, as the theory has it, and sheared with it; with elements of these
/// sizes at the contact, above and below.
pub fn cylinders(hs: [f64; 2], by: &str, set: &[(&str, &str)]) -> Run {
    let mut scene = Scene::default();
    let upper = half(&mut scene, "upper", 8.0, [20.0 * hs[0], hs[0]], 1.0);
    let lower = half(&mut scene, "lower", 8.0, [20.0 * hs[1], hs[1]], -1.0);
    let ends = |g: &Grid| [g.faces(Side::Left), g.faces(Side::Right)].concat();
    scene.faces("arc", &upper.faces(Side::Bottom));
    scene.faces("base_arc", &lower.faces(Side::Bottom));
    scene.faces("head", &ends(&upper));
    scene.faces("base", &ends(&lower));
    scene.set("handle", &upper.along(Side::Left)[..1]);
    let case = scene
        .elastic("plane-strain", 200.0, 0.3)
        .body(&["upper", "lower"], "")
        .contact("arc", "base_arc", by)
        .also("[[constraint]]\nkind = \"equal\"\non = \"head\"\ndofs = [\"x\", \"y\"]")
        .step("touch", 2)
        .fix("base", "xy")
        .displace("handle", "ux = 0.0\nuy = -0.1")
        .step("press", 2)
        .free("handle", "y")
        .load("head", &format!("force = [0.0, -{PRESSED:?}]"))
        .step("shear", 4)
        .also(&format!(
            "[[step.contact]]\nname = \"contact\"\nfriction = {FRICTION}"
        ))
        .free("handle", "x")
        .load(
            "head",
            &format!("name = \"shear\"\nforce = [{SHEARED:?}, 0.0]"),
        );
    finished(&mut case.model(set))
}

/// The shear and the length that sticks are those of theory.
fn cattaneo(by: &str) {
    // R = 8, E = 200, nu = 0.3: c = a √(1 − Q/(mu P))
    let modulus = 100.0 / (1.0 - 0.09);
    let a = (4.0 * PRESSED * 4.0 / (PI * modulus)).sqrt();
    let p0 = 2.0 * PRESSED / (PI * a);
    let c = a * (1.0 - SHEARED / (FRICTION * PRESSED)).sqrt();
    assert!((a - 0.680778).abs() < 1e-6 && (c - 0.564655).abs() < 1e-6);
    let h = a / 14.0;
    let ellipse = |x: f64, a: f64| (1.0 - (x / a).powi(2)).max(0.0).sqrt();
    let traction = |x: f64| FRICTION * p0 * (ellipse(x, a) - c / a * ellipse(x, c));
    let run = cylinders([h, h], by, &[]);
    report(by, &run);
    let contact = &run.frames.last().unwrap().contacts[0];
    // the contact moves with the shear, by half an element
    let center = contact.center.x;
    let (mut error, mut size, mut mean, mut count) = (0.0, 0.0, 0.0, 0.0);
    for (i, x) in contact.points.iter().enumerate() {
        let x = x.x - center;
        let expected = -traction(x);
        mean += (contact.traction[i].x - expected).abs() / (FRICTION * p0);
        count += f64::from(u8::from(x.abs() < a));
        error += (contact.traction[i].x - expected).powi(2);
        size += expected * expected;
    }
    // half the length that sticks, of points or of nodes
    let stick = contact.area_stick / 2.0;
    let error = (error / size).sqrt();
    println!(
        "  stick radius {stick:.5} for {c:.5} ({:+.2} h), p0 {:+.2} %, shear {:.3} % off in L2, by {:.2} % of mu p0 on the average, force {:?}",
        (stick - c) / h,
        100.0 * (contact.pressure_max / p0 - 1.0),
        100.0 * error,
        100.0 * mean / count,
        contact.secondary.force.to_array()
    );
    assert!((stick - c).abs() < h, "{by}: {stick} for {c}");
}

fn report(name: &str, run: &Run) {
    let iterations: Vec<usize> = run.increments.iter().map(|i| i.iterations).collect();
    println!(
        "{name}: iterations {iterations:?}, {} cutbacks",
        run.cutbacks.len()
    );
}

/// A pad of 40 × 20, 2 above an incline of 30 degrees: pressed on with 12000, then pushed up along it.
fn pad(push: f64, by: &str) -> Run {
    let (cos, sin) = (3f64.sqrt() / 2.0, 0.5);
    let mut scene = Scene::default();
    // along the incline and away from it
    let turned = |s: f64, n: f64| [s * cos - n * sin, s * sin + n * cos];
    let grid = scene.grid(
        "pad",
        [&equal(-20.0, 20.0, 8), &equal(2.0, 22.0, 4)],
        turned,
    );
    scene.faces("sole", &grid.faces(Side::Bottom));
    scene.faces("head", &grid.faces(Side::Top));
    scene.faces("heel", &grid.faces(Side::Left));

    let corner = grid.along(Side::Right);
    scene.set("sprung", &[corner[0], corner[4]]);
    scene.set("upper_nodes", &grid.along(Side::Top));
    // softly held away from the incline too, so that no viscous force has to
    let [mx, my] = turned(0.0, -2.0 - 1e-6);
    scene
        .elastic("plane-strain", 1e8, 0.3)
        .body(&["pad"], "")
        .spring("return", "sprung", 2.0, [cos, sin])
        .spring("soft", "sprung", 1e-6, [-sin, cos])
        .plane("incline", [0.0, 0.0], [-sin, cos])
        .contact("sole", "incline", &format!("friction = 0.3\n{by}"))
        .step("approach", 1)
        .displace("upper_nodes", &format!("ux = {mx:?}\nuy = {my:?}"))
        .step("press", 1)
        .free("upper_nodes", "xy")
        .load("head", "pressure = 300.0")
        .step("push", 4)
        .load("heel", &format!("name = \"push\"\npressure = {push:?}"))
        .newton("force_tol = 1e-10, gap_tol = 1e-13")
        .run()
}

#[test]
fn a_pad_on_an_incline_slides_until_its_springs_hold_it_ssnv503() {
    // threshold mu Rn = 3600; above it the two springs of 2 carry the rest: 36/4 = 9
    for by in [
        "method = \"node-to-segment\"\nenforcement = { lagrange = {} }",
        "method = \"node-to-segment\"",
    ] {
        for (push, slid) in [(3564.0, 0.0), (3636.0, 9.0)] {
            let run = pad(push / 20.0, by);
            report(by, &run);
            let frame = run.frames.last().unwrap();
            let mean = |axis: usize| {
                frame.displacement.iter().map(|u| u[axis]).sum::<f64>()
                    / frame.displacement.len() as f64
            };
            let (cos, sin) = (3f64.sqrt() / 2.0, 0.5);
            let expected = [1.0 + slid * cos, -2.0 * cos + slid * sin];
            let got = [mean(0), mean(1)];
            println!(
                "  {push}: u {got:.8?} for {expected:.8?}, {:?}",
                frame.contacts[0].secondary.force.to_array()
            );
            for (got, expected) in got.iter().zip(expected) {
                assert!(
                    (got - expected).abs() < 2e-4,
                    "{by} {push}: {got} for {expected}"
                );
            }
        }
    }
}

#[test]
fn a_block_on_a_slope_slips_where_the_slope_exceeds_the_friction() {
    // weight W at the angle a: the spring k carries W (sin a − mu cos a) where tan a > mu
    let (mu, weight, stiffness) = (0.3f64, 10.0, 5.0);
    for by in [
        "method = \"node-to-segment\"\nenforcement = { lagrange = {} }",
        "method = \"gauss-point\"\nenforcement = { penalty = 1e7 }",
    ] {
        for tan in [0.99 * mu, 1.01 * mu, 2.0 * mu] {
            let angle = tan.atan();
            let mut scene = Scene::default();
            let ends = equal(0.0, 1.0, 2);
            let grid = scene.grid("block", [&ends, &ends], |x, y| [2.0 * x, y]);
            scene.faces("sole", &grid.faces(Side::Bottom));
            scene.set("tied", &[grid.nodes[0][0]]);
            scene.set("sole_nodes", &grid.along(Side::Bottom));
            let (fx, fy) = (0.5 * weight * angle.sin(), -0.5 * weight * angle.cos());
            let run = scene
                .elastic("plane-strain", 1e8, 0.3)
                .body(&["block"], "")
                .spring("leash", "tied", stiffness, [1.0, 0.0])
                .spring("soft", "sole_nodes", 1e-6, [0.0, 1.0])
                .plane("slope", [0.0, 0.0], [0.0, 1.0])
                .contact("sole", "slope", &format!("friction = {mu:?}\n{by}"))
                .step("weight", 2)
                .load("block", &format!("body_force = [{fx:?}, {fy:?}]"))
                .run();
            report(by, &run);
            let expected = (weight * (angle.sin() - mu * angle.cos()) / stiffness).max(0.0);
            let slid = run.frames.last().unwrap().displacement[0].x;
            println!("  tan {tan:.4}: slid {slid:.9} for {expected:.9}");
            assert!(
                (slid - expected).abs() < 1e-5,
                "{by} {tan}: {slid} for {expected}"
            );
        }
    }
}
