//! Round bodies on planes and on each other, and a cone on a block.
//!
//! SOURCE      Johnson, *Contact Mechanics*, 1985: (4.43)–(4.45) for cylinders, (4.22)–(4.24) for spheres; Sneddon 1965
//!             for the cone
//! GOAL        largest pressure at a given or measured force
//! MESH        a quarter of a disc with a hole in its middle, graded to the point of contact, elements of 1/20 of the half
//!             width there; for the cone a block of 70 contact radii
//! CONDITIONS  small strain; forces prescribed (4.6 and the cone: motions), no friction
//! EXPECTED    closed forms at the tests
//! TOLERANCE   2 % of the largest pressure, 3 % where only the measured force is known; the half width to an element
use crate::common::{Run, model, run};
use crate::scene::{Grid, Scene, Side, graded};
use std::f64::consts::PI;

/// The quarter of a disc that touches y = 0 in the origin, above or below it: sizes of elements at the contact.
fn quarter(scene: &mut Scene, group: &str, radius: f64, [fine, h]: [f64; 2], up: f64) -> Grid {
    let angles: Vec<f64> = graded(fine / radius, h / radius, 1.15, 0.5 * PI);
    let depths = graded(4.0 * h, h, 1.2, 0.8 * radius);
    if up > 0.0 {
        scene.grid(group, [&angles, &depths], |t, d| {
            let r = radius - d;
            [r * t.sin(), radius - r * t.cos()]
        })
    } else {
        let angles: Vec<f64> = angles.into_iter().rev().collect();
        scene.grid(group, [&angles, &depths], |t, d| {
            let r = radius - d;
            [r * t.sin(), r * t.cos() - radius]
        })
    }
}

struct Problem<'a> {
    space: &'a str,
    young: f64,
    contact: &'a str,
    loading: &'a str,
}

impl Problem<'_> {
    fn solve(&self, scene: &Scene, bodies: &str) -> Run {
        let text = scene.case(&format!(
            r#"
[model]
space = "{}"
[material.m]
model = "linear-elastic"
E = {:?}
nu = 0.3
[[body]]
group = {bodies}
material = "m"
[[contact]]
name = "contact"
{}
[[step]]
name = "press"
geometry = "linear"
{}
"#,
            self.space, self.young, self.contact, self.loading
        ));
        let run = run(&mut model("hertz", &text, &[]));
        assert!(run.error.is_none(), "{}: {:?}", self.contact, run.error);
        run
    }
}

/// Largest pressure, half width (to an element), force along y, and the p0 of the ellipse over `a` that fits the pressures
/// inside of 0.8 a.
fn outcome(name: &str, run: &Run, a: f64) -> (f64, f64, f64, f64) {
    let contact = &run.frames.last().unwrap().contacts[0];
    let closed = contact.points.iter().zip(&contact.pressure);
    let width = closed.filter(|(_, p)| **p > 0.0).map(|(x, _)| x.x);
    let width = width.fold(0.0, f64::max);
    let force = contact.secondary.force.y.abs();
    let inside = contact.points.iter().zip(&contact.pressure);
    let inside = inside.filter(|(x, _)| x.x.abs() < 0.8 * a);
    let (up, low) = inside.fold((0.0, 0.0), |(up, low), (x, p)| {
        let shape = (1.0 - (x.x / a).powi(2)).sqrt();
        (up + p * shape, low + shape * shape)
    });
    let fit = up / low;
    let iterations: usize = run.increments.iter().map(|i| i.iterations).sum();
    println!(
        "{name}: p0 {:.6}, of the ellipse {fit:.6}, half width {width:.5}, force {force:.8}, {iterations} iterations, {} cutbacks",
        contact.pressure_max,
        run.cutbacks.len()
    );
    (contact.pressure_max, width, force, fit)
}

const ENFORCEMENTS: [&str; 3] = [
    "method = \"node-to-segment\"\nenforcement = { lagrange = {} }",
    "method = \"node-to-segment\"",
    "method = \"gauss-point\"",
];

/// The quarter of a disc of radius 1 on a rigid plane, pressed by a force at the plane through its middle.
fn on_a_plane(space: &str, h: f64, force: f64, by: &str) -> Run {
    let mut scene = Scene::default();
    let disc = quarter(&mut scene, "disc", 1.0, [40.0 * h, h], 1.0);
    scene.faces("arc", &disc.faces(Side::Bottom));
    scene.faces("middle", &disc.faces(Side::Right));
    scene.set("axis", &disc.along(Side::Left));
    let problem = Problem {
        space,
        young: 1.0,
        contact: &format!("secondary = \"arc\"\nprimary = \"floor\"\n{by}"),
        loading: &format!(
            r#"
increments = 2
[[step.fix]]
on = "axis"
u = ["x"]
[[step.load]]
on = "middle"
force = [0.0, -{force:?}]
coupling = "rigid-y"
[[surface]]
name = "floor"
shape = {{ plane = {{ point = [0.0, 0.0], normal = "y" }} }}
"#
        ),
    };
    problem.solve(&scene, "\"disc\"")
}

#[test]
fn a_cylinder_on_a_plane_johnson_4_45() {
    // P = 0.01, R = 1, E* = 1/(1 − nu²): a = √(4PR/(πE*)), p0 = 2P/(πa); half of it is modelled
    let modulus = 1.0 / (1.0 - 0.09);
    let a = (4.0 * 0.01 / (PI * modulus)).sqrt();
    let p0 = 2.0 * 0.01 / (PI * a);
    assert!((a - 0.10764051).abs() < 1e-8 && (p0 - 0.05914314).abs() < 1e-8);
    for by in ENFORCEMENTS {
        let h = a / 20.0;
        let found = outcome(by, &on_a_plane("plane-strain", h, 0.005, by), a);
        println!(
            "  p0 {:+.3} %, of the ellipse {:+.3} %, a {:+.3} h",
            100.0 * (found.0 / p0 - 1.0),
            100.0 * (found.3 / p0 - 1.0),
            (found.1 - a) / h
        );
        assert!((found.3 / p0 - 1.0).abs() < 0.02, "{by}");
        assert!(
            by.contains("gauss") || (found.0 / p0 - 1.0).abs() < 0.02,
            "{by}"
        );
        assert!((found.1 - a).abs() < h, "{by}");
        assert!((found.2 / 0.005 - 1.0).abs() < 1e-4);
    }
}

#[test]
fn a_sphere_on_a_plane_johnson_4_24() {
    // F = 0.001, R = 1: a = (3FR/(4E*))^⅓, p0 = 3F/(2πa²)
    let modulus = 1.0 / (1.0 - 0.09);
    let a = (3.0 * 0.001f64 / (4.0 * modulus)).cbrt();
    let p0 = 3.0 * 0.001 / (2.0 * PI * a * a);
    assert!(
        (a - 0.0880442).abs() < 1e-7 && (p0 - 0.0615942).abs() < 1e-7,
        "{a} {p0}"
    );
    for by in ENFORCEMENTS {
        let h = a / 20.0;
        let found = outcome(by, &on_a_plane("axisymmetric", h, 0.001, by), a);
        println!(
            "  p0 {:+.3} %, of the ellipse {:+.3} %, a {:+.3} h",
            100.0 * (found.0 / p0 - 1.0),
            100.0 * (found.3 / p0 - 1.0),
            (found.1 - a) / h
        );
        assert!((found.3 / p0 - 1.0).abs() < 0.02, "{by}");
        assert!(
            by.contains("gauss") || (found.0 / p0 - 1.0).abs() < 0.02,
            "{by}"
        );
        assert!((found.1 - a).abs() < h, "{by}");
        assert!((found.2 / 0.001 - 1.0).abs() < 1e-4);
    }
}

/// Two equal discs of elements of different size, the lower one held, the upper one loaded or moved.
fn two_discs(space: &str, radius: f64, young: f64, h: f64, by: &str, loading: &str) -> Run {
    let mut scene = Scene::default();
    let upper = quarter(&mut scene, "upper", radius, [40.0 * h, h], 1.0);
    let lower = quarter(&mut scene, "lower", radius, [48.0 * h, 1.2 * h], -1.0);
    scene.faces("arc", &upper.faces(Side::Bottom));
    scene.faces("head", &upper.faces(Side::Right));
    scene.faces("base_arc", &lower.faces(Side::Bottom));
    scene.set("base", &lower.along(Side::Left));
    let axis = [upper.along(Side::Left), lower.along(Side::Right)].concat();
    scene.set("axis", &axis);
    let problem = Problem {
        space,
        young,
        contact: &format!("secondary = \"arc\"\nprimary = \"base_arc\"\n{by}"),
        loading: &format!(
            r#"
increments = 2
[[step.fix]]
on = "axis"
u = ["x"]
[[step.fix]]
on = "base"
u = ["y"]
{loading}"#
        ),
    };
    problem.solve(&scene, "[\"upper\", \"lower\"]")
}

#[test]
fn two_cylinders_johnson_4_45() {
    // R = 8, E = 200, P = 10: 1/R = 2/8, E* = E/(2(1 − nu²))
    let modulus = 100.0 / (1.0 - 0.09);
    let a = (4.0 * 10.0 * 4.0 / (PI * modulus)).sqrt();
    let p0 = 2.0 * 10.0 / (PI * a);
    assert!((a - 0.68077837).abs() < 1e-8 && (p0 - 9.35135129).abs() < 1e-8);
    for by in ENFORCEMENTS {
        let h = a / 20.0;
        let load = "[[step.load]]\non = \"head\"\nforce = [0.0, -5.0]\ncoupling = \"rigid-y\"";
        let found = outcome(by, &two_discs("plane-strain", 8.0, 200.0, h, by, load), a);
        println!(
            "  p0 {:+.3} %, of the ellipse {:+.3} %, a {:+.3} h",
            100.0 * (found.0 / p0 - 1.0),
            100.0 * (found.3 / p0 - 1.0),
            (found.1 - a) / h
        );
        assert!((found.3 / p0 - 1.0).abs() < 0.02, "{by}");
        assert!(
            by.contains("gauss") || (found.0 / p0 - 1.0).abs() < 0.02,
            "{by}"
        );
        assert!((found.1 - a).abs() < 1.5 * h, "{by}");
        assert!((found.2 / 5.0 - 1.0).abs() < 1e-4);
    }
}

#[test]
fn two_spheres_ssnv104() {
    // approach 2 of R = 50, E = 2e4: p0 = 1978.72 of two half-spaces; at the force measured p0 = (6FE*²/(π³R²))^⅓
    for by in ENFORCEMENTS {
        let modulus = 1e4 / (1.0 - 0.09);
        let a = 50f64.sqrt();
        let motion = "[[step.move]]\non = \"head\"\nuy = -2.0";
        let run = two_discs("axisymmetric", 50.0, 2e4, 7.07 / 20.0, by, motion);
        let found = outcome(by, &run, a);
        let p0 = (6.0 * found.2 * modulus * modulus / (PI.powi(3) * 625.0)).cbrt();
        println!(
            "  p0 {:+.3} % of that of the force, {:+.3} % of that of the approach",
            100.0 * (found.0 / p0 - 1.0),
            100.0 * (found.0 / 1978.72 - 1.0)
        );
        assert!((found.3 / p0 - 1.0).abs() < 0.03, "{by}");
        assert!(
            by.contains("gauss") || (found.0 / p0 - 1.0).abs() < 0.03,
            "{by}"
        );
    }
}

#[test]
fn a_cone_on_a_block_sneddon() {
    // F = 2/π E* d² tan alpha, a = 2/π d tan alpha, p = E*/(2 tan alpha) acosh(a/r)
    let modulus = 1.0 / (1.0 - 0.09);
    for half_angle in [85.0f64, 89.0] {
        let slope = (90.0 - half_angle).to_radians();
        let a = 0.14;
        let depth = a * 0.5 * PI * slope.tan();
        let force = 2.0 / PI * modulus * depth * depth / slope.tan();
        let h = a / 20.0;
        let mut scene = Scene::default();
        let across = graded(1.5 * a, h, 1.3, 10.0);
        let deep: Vec<f64> = graded(0.5 * a, h, 1.3, 10.0)
            .iter()
            .rev()
            .map(|y| -y)
            .collect();
        let block = scene.grid("block", [&across, &deep], |x, y| [x, y]);
        scene.faces("top", &block.faces(Side::Top));
        scene.set("axis", &block.along(Side::Left));
        scene.set("base", &block.along(Side::Bottom));
        let ways = if half_angle > 88.0 { 3 } else { 1 };
        for by in &ENFORCEMENTS[..ways] {
            let problem = Problem {
                space: "axisymmetric",
                young: 1.0,
                contact: &format!("secondary = \"top\"\nprimary = \"cone\"\n{by}"),
                loading: &format!(
                    r#"
increments = 2
[[step.fix]]
on = "axis"
u = ["x"]
[[step.fix]]
on = "base"
u = "all"
[[step.move]]
on = "pilot"
uy = -{depth:?}
[reference]
pilot = {{ at = [0.0, 0.0] }}
[[surface]]
name = "cone"
shape = {{ plane = {{ point = [0.0, 0.0], normal = [{:?}, {:?}] }} }}
reference = "pilot"
"#,
                    slope.sin(),
                    -slope.cos()
                ),
            };
            let run = problem.solve(&scene, "\"block\"");
            let found = outcome(by, &run, a);
            let contact = &run.frames.last().unwrap().contacts[0];
            let half = contact
                .nodes
                .iter()
                .zip(&contact.points)
                .zip(&contact.pressure);
            let (x, p) = half
                .map(|((n, x), p)| (scene.at(*n as usize + 1)[0], (x, *p)))
                .min_by(|(r, _), (s, _)| (r - 0.5 * a).abs().total_cmp(&(s - 0.5 * a).abs()))
                .map(|(r, (_, p))| (r, p))
                .unwrap();
            let expected = 0.5 * modulus * slope.tan() * (a / x).acosh();
            println!(
                "  at {half_angle}: force {:+.3} %, p at {x:.4} {:+.3} %, a {:+.3} h",
                100.0 * (found.2 / force - 1.0),
                100.0 * (p / expected - 1.0),
                (found.1 - a) / h
            );
            if half_angle > 88.0 {
                assert!((found.2 / force - 1.0).abs() < 0.02, "{by}");
                assert!((p / expected - 1.0).abs() < 0.03, "{by}");
                assert!((found.1 - a).abs() < h, "{by}");
            }
        }
    }
}
