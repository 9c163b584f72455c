//! A ball that is pulled off what it sticks to.
//!
//! SOURCE      `shared/reference/thermal`: axisymmetric boundary elements
//! GOAL        the largest pull over π w R between the limits of rigid bodies, 2, and of soft ones, 1.5
//! MESH        a half-space of quad4, 20 of them along what the ball mostly acts on, then ever coarser; a rigid ball
//! CONDITIONS  E* = R = 1, w = 2e-6: contact is small against the ball; motions are given
//! EXPECTED    against Tabor's μ = (R w²/(E*² z₀³))^(1/3)
//! TOLERANCE   1 %
use crate::common::{model, reference, run};
use std::f64::consts::PI;
use std::fmt::Write;

/// Work of adhesion.
const WORK: f64 = 2e-6;

/// Lines that are this far apart at first, and ever further.
fn graded(even: f64, size: f64) -> Vec<f64> {
    let (mut lines, mut last, mut step) = (vec![0.0], 0.0, size);
    while last < 1.0 {
        if last > even - 1e-9 {
            step *= 1.5;
        }
        last += step;
        lines.push(last);
    }
    lines
}

/// The largest pull over π w R of a ball that comes near from `from` to `to` in a few increments, between which it is interpolated;
/// `even` is the radius that it mostly acts on.
fn pull_off(shape: &str, range: f64, even: f64, window: [f64; 2]) -> f64 {
    let size = 0.05 * even;
    let (across, down) = (graded(even, size), graded(2.0 * size, size));
    let (nx, ny) = (across.len(), down.len());
    let [mut nodes, mut elements, mut faces, mut axis, mut base] = [const { String::new() }; 5];
    for (j, y) in down.iter().enumerate() {
        for (i, x) in across.iter().enumerate() {
            let node = i + nx * j + 1;
            write!(nodes, "[{node}, {x:?}, {:?}], ", -y).unwrap();
            if i == 0 {
                write!(axis, "{node}, ").unwrap();
            }
            if j == ny - 1 {
                write!(base, "{node}, ").unwrap();
            }
        }
    }
    for j in 0..ny - 1 {
        for (i, x) in across.iter().enumerate().take(nx - 1) {
            let (element, a) = (i + (nx - 1) * j + 1, i + nx * j + 1);
            let (b, c, d) = (a + nx, a + nx + 1, a + 1);
            write!(
                elements,
                "{{ id = {element}, type = \"quad4\", group = \"half\", nodes = [{b}, {c}, {d}, {a}] }}, "
            )
            .unwrap();
            // what is further away pulls, too
            if j == 0 && *x < 0.45 {
                write!(faces, "[{element}, \"S3\"], ").unwrap();
            }
        }
    }
    let start = 2.0 * range;
    let [first, last] = window.map(|d| d * range - start);
    let text = format!(
        "[mesh]\nnodes = [{nodes}]\nelements = [{elements}]\n[model]\nspace = \"axisymmetric\"\n\
         [material.m]\nmodel = \"linear-elastic\"\nE = 0.91\nnu = 0.3\n[[body]]\ngroup = \"half\"\nmaterial = \"m\"\n\
         [sets]\nface = {{ faces = [{faces}] }}\naxis = {{ nodes = [{axis}] }}\nbase = {{ nodes = [{base}] }}\n\
         [reference.tool]\nat = [0, 0]\n\
         [[surface]]\nname = \"ball\"\nreference = \"tool\"\nshape = {{ circle = {{ center = [0, {:?}], radius = 1.0 }} }}\n\
         [[contact]]\nname = \"c\"\nsecondary = \"face\"\nprimary = \"ball\"\nmethod = \"node-to-segment\"\nreach = 0.1\n\
         adhesion = {{ work = {WORK:?}, range = {range:?}, shape = \"{shape}\" }}\n\
         [[step]]\nname = \"near\"\ngeometry = \"linear\"\nincrements = {{ fixed = 4 }}\n\
         fix = [{{ on = \"axis\", u = [\"x\"] }}, {{ on = \"base\", u = \"all\" }}, {{ on = \"tool\", u = [\"x\"], rot = \"all\" }}]\n\
         move = [{{ on = \"tool\", uy = {first:?} }}]\n\
         [[step]]\nname = \"past\"\nincrements = {{ fixed = 6 }}\nmove = [{{ on = \"tool\", uy = {last:?} }}]\n\
         [solver]\nnewton = {{ force_tol = 1e-8, max_iterations = 60 }}\n",
        1.0 + start
    );
    let done = run(&mut model("ball", &text, &[]));
    assert!(done.error.is_none(), "{shape} {range}: {:?}", done.error);
    let force = |k: usize| done.contact_force(k)[1] / (PI * WORK);
    let most = (5..10).max_by(|&a, &b| force(a).total_cmp(&force(b)));
    // a parabola through the largest one and those around it
    let [before, most, after] = most.map(|k| [k - 1, k, k + 1].map(force)).unwrap();
    assert!(
        before < most && most > after,
        "{shape} {range}: outside {window:?}"
    );
    most + (after - before).powi(2) / (8.0 * (2.0 * most - before - after))
}

/// `lennard_jones.json`.
#[test]
#[cfg_attr(debug_assertions, ignore = "takes its time without optimization")]
fn a_ball_that_atoms_pull_comes_off_between_the_limits_of_rigid_and_soft_bodies() {
    let Some(all) = reference("thermal/lennard_jones.json") else {
        return;
    };
    for (tabor, window) in [
        ("0.05", [0.3, -0.3]),
        ("0.2", [0.4, -0.2]),
        ("0.5", [0.7, 0.1]),
    ] {
        let range = WORK.powf(2.0 / 3.0) / tabor.parse::<f64>().unwrap();
        let found = pull_off("lennard-jones", range, 4.0 * range.sqrt(), window);
        let expected = -all["pull_off"][tabor].as_f64().unwrap();
        assert!(
            (found / expected - 1.0).abs() < 1e-2,
            "{tabor}: {found} {expected}"
        );
    }
}
