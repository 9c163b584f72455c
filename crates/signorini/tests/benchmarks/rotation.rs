//! Two blocks that have slipped on one another, turned as one rigid body.
//!
//! SOURCE      Objectivity: a rigid motion of all that is prescribed changes no stress and no relative motion.
//! GOAL        rows that rest on the limit of friction, where they stick as well as slip, neither stop an iteration nor let
//!             viscous forces lead it to another state
//! MESH        in the plane 7 × 4 and 5 × 4 quad4, in space 4 × 3 × 2 and 3 × 2 × 2 hex8; nowhere do nodes meet nodes
//! CONDITIONS  finite strain, neo-Hookean; pressed, sheared until some of the contact slips, then turned by the references of
//!             both ends about one axis, by several angles, in fixed increments of up to 19 degrees and in automatic ones;
//!             friction 0.1 to 0.6, all methods, penalty and multipliers; otherwise as by default
//! EXPECTED    the force turns with the blocks; friction does no work, nor do viscous forces
//! TOLERANCE   1e-8 of the force, the residual that is left; work to 1e-8 of the force times the slip
use crate::common::{Run, model, run};
use crate::scene::{RUBBER, Scene, Side, equal};
use signorini_geometry::tensor::Vec3;

/// How far the upper block is pressed, and sheared.
const PRESSED: f64 = 0.05;
const SHEARED: f64 = 0.06;

/// Discretization and enforcement.
const METHODS: [(&str, &str); 4] = [
    ("mortar", "{ lagrange = {} }"),
    ("node-to-segment", "{ lagrange = {} }"),
    ("node-to-segment", "{ penalty = \"auto\" }"),
    ("gauss-point", "{ penalty = \"auto\" }"),
];

/// Angles in degrees, and increments.
const TURNS: [(f64, &str); 3] = [
    (90.0, "{ fixed = 18 }"),
    (-130.0, "{ fixed = 7 }"),
    (40.0, "{ initial = 0.2 }"),
];

/// The blocks; how the upper one moves before all turns.
fn blocks(space: bool) -> (Scene, Vec<f64>) {
    let mut scene = Scene::default();
    if space {
        scene.bricks(
            "lower",
            [
                &equal(0.0, 2.0, 4),
                &equal(0.0, 1.5, 3),
                &equal(0.0, 0.8, 2),
            ],
        );
        let up = [equal(0.4, 1.5, 3), equal(0.3, 1.2, 2), equal(0.8, 1.4, 2)];
        scene.bricks("upper", [&up[0], &up[1], &up[2]]);
        let of = |first: usize, n: usize, side: &'static str| {
            (first..first + n).map(|c| (c, side)).collect::<Vec<_>>()
        };
        scene.faces("top", &of(13, 12, "S2"));
        scene.faces("foot", &of(25, 6, "S1"));
        scene.place("base", "plane = \"z\", at = 0.0");
        scene.place("head", "plane = \"z\", at = 1.4");
        return (scene, vec![SHEARED, 0.4 * SHEARED, -PRESSED]);
    }
    let same = |u: f64, v: f64| [u, v];
    let lower = scene.grid("lower", [&equal(0.0, 2.0, 7), &equal(0.0, 1.0, 4)], same);
    let upper = scene.grid("upper", [&equal(0.4, 1.5, 5), &equal(1.0, 1.8, 4)], same);
    scene.faces("top", &lower.faces(Side::Top));
    scene.faces("foot", &upper.faces(Side::Bottom));
    scene.place("base", "plane = \"y\", at = 0.0");
    scene.place("head", "plane = \"y\", at = 1.8");
    (scene, vec![SHEARED, -PRESSED])
}

/// Presses, shears and turns.
fn turned(
    space: bool,
    (method, enforcement): (&str, &str),
    friction: f64,
    (angle, increments): (f64, &str),
    axis: &str,
) -> Run {
    let (scene, motion) = blocks(space);
    // the reference of the upper block is where that of the lower one is when all turns
    let at: Vec<f64> = motion.iter().map(|u| -u).collect();
    let origin = vec![0.0; motion.len()];
    let space = if space { "3d" } else { "plane-strain" };
    let held = match motion.len() {
        2 => "rz = 0.0",
        _ => "rx = 0.0\nry = 0.0\nrz = 0.0",
    };
    let along = |names: &[&str], values: &[f64]| {
        let pairs = names.iter().zip(values);
        pairs
            .map(|(name, value)| format!("{name} = {value:?}\n"))
            .collect::<String>()
    };
    let (down, aside) = match motion.len() {
        2 => (
            along(&["ux", "uy"], &[0.0, motion[1]]),
            along(&["ux"], &motion),
        ),
        _ => (
            along(&["ux", "uy", "uz"], &[0.0, 0.0, motion[2]]),
            along(&["ux", "uy"], &motion),
        ),
    };
    let angle = angle.to_radians();
    let text = scene.case(&format!(
        r#"
[model]
space = "{space}"
[reference.rb]
at = {origin:?}
[reference.rh]
at = {at:?}
[[constraint]]
kind = "kinematic"
on = "base"
reference = "rb"
[[constraint]]
kind = "kinematic"
on = "head"
reference = "rh"
{RUBBER}
[[body]]
group = ["lower", "upper"]
material = "m"
[[contact]]
name = "c"
secondary = "foot"
primary = "top"
friction = {friction:?}
method = "{method}"
enforcement = {enforcement}
[[step]]
name = "press"
geometry = "nonlinear"
increments = {{ fixed = 5 }}
[[step.fix]]
on = "rb"
u = "all"
rot = "all"
[[step.move]]
on = "rh"
{down}{held}
[[step]]
name = "shear"
increments = {{ fixed = 5 }}
[[step.move]]
on = "rh"
{aside}
[[step]]
name = "turn"
increments = {increments}
[[step.move]]
on = "rb"
r{axis} = {angle:?}
[[step.move]]
on = "rh"
r{axis} = {angle:?}
[solver]
newton = {{ force_tol = 1e-9 }}
"#
    ));
    let mut model = model("rotation", &text, &[]);
    run(&mut model)
}

/// A vector turned about an axis of coordinates.
fn turn(v: Vec3, axis: usize, angle: f64) -> Vec3 {
    let n = Vec3::unit(axis);
    let along = n * n.dot(v);
    along + (v - along) * angle.cos() + n.cross(v) * angle.sin()
}

/// Asserts that nothing but the direction of the force changes while the blocks turn.
fn assert_objective(run: &Run, axis: usize, name: &str) {
    assert!(run.error.is_none(), "{name}: {:?}", run.error);
    let sheared = run.frames.iter().rfind(|f| f.step == "shear").unwrap();
    let before = &sheared.contacts[0];
    let (force, size) = (before.secondary.force, before.secondary.force.norm());
    let mut worst = [0.0f64; 2];
    for frame in run.frames.iter().filter(|f| f.step == "turn") {
        let now = &frame.contacts[0];
        let angle = frame.rigid[0].rotation[axis];
        let apart = (now.secondary.force - turn(force, axis, angle)).norm() / size;
        let work = (now.work_friction - before.work_friction).abs() / (size * SHEARED);
        worst = [worst[0].max(apart), worst[1].max(work)];
    }
    let last = run.frames.last().unwrap();
    let iterations: usize = run.increments.iter().map(|i| i.iterations).sum();
    println!(
        "{name}: force {:.1e}, work {:.1e}, {iterations} iterations, {} cut-backs",
        worst[0],
        worst[1],
        run.cutbacks.len()
    );
    assert_eq!(last.work_stabilization, 0.0, "{name}");
    assert!(worst[0] < 1e-8 && worst[1] < 1e-8, "{name}: {worst:?}");
    assert!(
        before.work_friction > 0.0 || before.area_slip == 0.0,
        "{name}"
    );
}

#[test]
fn blocks_turned_in_the_plane_keep_their_force() {
    for method in METHODS {
        for friction in [0.1, 0.3, 0.6] {
            for by in TURNS {
                let name = format!("{method:?}, mu = {friction}, {by:?}");
                assert_objective(&turned(false, method, friction, by, "z"), 2, &name);
            }
        }
    }
}

#[test]
fn blocks_turned_in_space_keep_their_force() {
    for (k, method) in METHODS.into_iter().enumerate() {
        for (j, friction) in [0.1, 0.4].into_iter().enumerate() {
            let axis = (k + j) % 3;
            let by = TURNS[(k + 2 * j) % TURNS.len()];
            let name = format!("{method:?}, mu = {friction}, {by:?} about {axis}");
            let run = turned(true, method, friction, by, ["x", "y", "z"][axis]);
            assert_objective(&run, axis, &name);
        }
    }
}
