//! Two blocks of neo-Hookean material, one upon the other, squeezed to half their height.
//!
//! SOURCE      Uniaxial compression of W = mu/2 (I1 − 3) − mu ln J + la/2 (ln J)²: nominal stress
//!             P = mu (l − 1/l) + la ln J/l with the lateral stretch that leaves the sides free; both blocks carry one P.
//! GOAL        both blocks stay homogeneous, and the lateral slip between them is free
//! MESH        two unit cubes of 2 × 2 × 2 hex8, or two unit squares of 3 × 3 quad4, matching at the interface
//! CONDITIONS  finite strain, (mu, la) = (1, 1.5) below and (10, 15) above, no friction; node to node and node to segment
//!             with multipliers; sides free, free
//!             along one axis, or confined. Free sides of the two blocks move apart, so that only node to node, whose
//!             pairs stay, keeps the blocks homogeneous; node to segment is asked where they are confined.
//! EXPECTED    nominal pressure and displacement of the interface, table at [`EXPECTED`] (the closed form, solved for d)
//! TOLERANCE   1e-8, the digits of the table
use crate::common::{Run, model, run};
use crate::scene::{Scene, Side, equal};

/// Sides, compression, nominal pressure, displacement of the interface.
const EXPECTED: [(&str, f64, f64, f64); 5] = [
    ("free", 0.2, 0.54728928, 0.17928975),
    ("free", 0.6, 2.52960016, 0.50972757),
    ("free", 1.0, 8.05951872, 0.75453804),
    ("plane", 0.6, 2.90077200, 0.50680191),
    ("confined", 0.6, 3.65559461, 0.50496718),
];

/// E and nu of mu and la.
fn elastic(mu: f64, la: f64) -> (f64, f64) {
    (
        mu * (3.0 * la + 2.0 * mu) / (la + mu),
        la / (2.0 * (la + mu)),
    )
}

/// Nominal pressure and lateral stretch at a stretch.
fn squeezed(stretch: f64, (mu, la): (f64, f64), sides: &str) -> f64 {
    let naxis = match sides {
        "free" => 2,
        "plane" => 1,
        _ => 0,
    };
    let volume = |t: f64| stretch * t.powi(naxis);
    let mut lateral = 1.0;
    if naxis > 0 {
        let stress = |t: f64| mu * (t - 1.0 / t) + la * volume(t).ln() / t;
        let (mut low, mut high) = (1.0, 10.0);
        for _ in 0..200 {
            let t = 0.5 * (low + high);
            if stress(t) < 0.0 { low = t } else { high = t }
        }
        lateral = 0.5 * (low + high);
    }
    -(mu * (stretch - 1.0 / stretch) + la * volume(lateral).ln() / stretch)
}

/// Nominal pressure, and displacement of the interface, of the stack.
fn stacked(d: f64, sides: &str) -> (f64, f64) {
    let pressure = |d: f64, constants: (f64, f64)| squeezed(1.0 - d, constants, sides);
    let (mut low, mut high) = (0.0f64, d.min(0.999));
    for _ in 0..200 {
        let lower = 0.5 * (low + high);
        let more = pressure(lower, (1.0, 1.5)) < pressure(d - lower, (10.0, 15.0));
        if more { low = lower } else { high = lower }
    }
    (pressure(low, (1.0, 1.5)), low)
}

fn compressed(sides: &str, d: f64, method: &str, increments: usize) -> (Run, usize) {
    let mut scene = Scene::default();
    let up = if sides == "plane" { "y" } else { "z" };
    let interface;
    if sides == "plane" {
        let ends = equal(0.0, 1.0, 3);
        let lower = scene.grid("lower", [&ends, &ends], |x, y| [x, y]);
        let upper = scene.grid("upper", [&ends, &ends], |x, y| [x, y + 1.0]);
        interface = lower.nodes[3][1] - 1;
        scene.faces("foot", &upper.faces(Side::Bottom));
        scene.faces("roof", &lower.faces(Side::Top));
    } else {
        let ends = equal(0.0, 1.0, 2);
        scene.bricks("lower", [&ends, &ends, &ends]);
        scene.bricks("upper", [&ends, &ends, &[1.0, 1.5, 2.0]]);
        interface = scene.label(&[0.5, 0.5, 1.0]) - 1;
        let of = |first: usize, side: &'static str| (first..first + 4).map(move |c| (c, side));
        scene.faces("foot", &of(9, "S1").collect::<Vec<_>>());
        scene.faces("roof", &of(5, "S2").collect::<Vec<_>>());
    }
    for (name, axis, at) in [
        ("base", up, 0.0),
        ("head", up, 2.0),
        ("x0", "x", 0.0),
        ("x1", "x", 1.0),
        ("y0", "y", 0.0),
        ("y1", "y", 1.0),
    ] {
        if sides != "plane" || !name.starts_with('y') {
            scene.place(name, &format!("plane = \"{axis}\", at = {at:?}"));
        }
    }
    let held: &[&str] = match sides {
        "free" => &["x0", "y0"],
        "plane" => &["x0"],
        _ => &["x0", "x1", "y0", "y1"],
    };
    let supports: String = held
        .iter()
        .map(|set| format!("[[step.fix]]\non = \"{set}\"\nu = [\"{}\"]\n", &set[..1]))
        .collect();
    let space = if sides == "plane" {
        "plane-strain"
    } else {
        "3d"
    };
    let ((e1, nu1), (e2, nu2)) = (elastic(1.0, 1.5), elastic(10.0, 15.0));
    let text = scene.case(&format!(
        r#"
[model]
space = "{space}"
[material.lower]
model = "neo-hookean"
E = {e1:?}
nu = {nu1:?}
[material.upper]
model = "neo-hookean"
E = {e2:?}
nu = {nu2:?}
[[body]]
group = "lower"
material = "lower"
locking = "none"
[[body]]
group = "upper"
material = "upper"
locking = "none"
[[contact]]
name = "interface"
secondary = "foot"
primary = "roof"
method = "{method}"
enforcement = {{ lagrange = {{}} }}
[[step]]
name = "squeeze"
geometry = "nonlinear"
increments = {{ fixed = {increments} }}
[[step.fix]]
on = "base"
u = ["{up}"]
{supports}
[[step.move]]
on = "head"
u{up} = -{d:?}
[solver]
newton = {{ force_tol = 1e-12 }}
"#
    ));
    let run = run(&mut model("stack", &text, &[]));
    assert!(run.error.is_none(), "{sides} {d} {method}: {:?}", run.error);
    (run, interface)
}

#[test]
fn a_stack_of_two_materials_is_squeezed_homogeneously() {
    for (sides, d, pressure, interface) in EXPECTED {
        let (p, u) = stacked(d, sides);
        assert!((p - pressure).abs() < 1e-8 && (u - interface).abs() < 1e-8);
        let methods = ["node-to-node", "node-to-segment"];
        // node to segment only where both sides stay equally wide
        let count = if sides == "confined" { 2 } else { 1 };
        for method in &methods[..count] {
            let (run, node) = compressed(sides, d, method, 10);
            let frame = run.frames.last().unwrap();
            let axis = if sides == "plane" { 1 } else { 2 };
            let force = frame.contacts[0].secondary.force[axis];
            let moved = -frame.displacement[node][axis];
            let iterations: usize = run.increments.iter().map(|i| i.iterations).sum();
            println!(
                "{sides:8} {d} {method:15} P {force:.10} ({:.1e}) u {moved:.10} ({:.1e}), {iterations} iterations",
                force - p,
                moved - u
            );
            assert!(
                (force / p - 1.0).abs() < 1e-8,
                "{sides} {d} {method}: {force}"
            );
            assert!(
                (moved / u - 1.0).abs() < 1e-8,
                "{sides} {d} {method}: {moved}"
            );
        }
    }
}
