//! Friction.

use crate::mesh::{Grid, Lines, Point, even};
use crate::problem::{Check, Problem, Setup};
use std::f64::consts::PI;

/// The problems of this file.
pub(super) const PROBLEMS: [Problem; 6] = [
    Problem {
        name: "friction-loop",
        title: "A cube is dragged forth and back",
        source: "Coulomb 1785; loading of CalculiX's example friction2",
        goal: "shear that is μ times the pressure, and turns round",
        mesh: "one hex8 on 3 by 3 hex8",
        conditions: "pressure 100 on the cube, then ±1 mm sideways; node to segment by penalties, μ = 0.2",
        formula: "$|t| = \\mu p$ against the motion",
        quick: true,
        pose: friction_loop,
    },
    Problem {
        name: "friction-cap",
        title: "Shear traction with a cap",
        source: "Tresca's law of friction: a limit that does not grow with the pressure",
        goal: "a friction law with two branches",
        mesh: "one hex8 on 3 by 3 hex8",
        conditions: "as the friction loop, with μ = 0.2 and a cap of 12",
        formula: "$|t| = \\min(\\mu p, t_{max})$",
        quick: true,
        pose: || dragged_cube("{ mu = 0.2, cap = 12.0, stiffness = 80.0 }", 12.0),
    },
    Problem {
        name: "incline",
        title: "Two blocks on an incline: one rests, one slides",
        source: "Coulomb 1785: angle of friction",
        goal: "the limit between stick and slip",
        mesh: "two blocks of 8 by 2 quad4",
        conditions: "plane strain, slope 20 degrees, μ = 0.5 and 0.2, weight 4; a soft spring along the slope holds each block",
        formula: "stick for $\\mu > \\tan\\alpha$: the spring is idle; else it carries $W(\\sin\\alpha - \\mu\\cos\\alpha)$, and contact $\\mu W\\cos\\alpha$ along and $W\\cos\\alpha$ across the slope",
        quick: true,
        pose: incline,
    },
    Problem {
        name: "capstan",
        title: "A belt around a drum",
        source: "L. Euler 1769; Eytelwein 1808: belt friction",
        goal: "tension that grows with the angle of wrap",
        mesh: "90 quad8 on a half circle, one through the thickness of 1/100 of the radius",
        conditions: "plane strain, small strain; the middle of one end is pulled by T₁, that of the other one is moved until all of it slips; μ = 0.3",
        formula: "$T_2 = T_1 e^{\\mu\\beta R/(R + t/2)}$: the tension acts in the middle of the thickness, friction on its inside",
        quick: true,
        pose: capstan,
    },
    Problem {
        name: "dragged-toe",
        title: "A toe is dragged over a hump",
        source: "statics of a point on a slope with friction",
        goal: "large sliding over an analytical curve",
        mesh: "three quad4 with a toe",
        conditions: "plane strain; a load of 1 and a soft spring press, the head moves 3.2 mm along y = 0.05 x⁴ − 0.2 x²; μ = 0.3",
        formula: "$F_x/F_y = -\\tan(\\arctan y'(x) + \\arctan\\mu)$, $F_y = P + k\\,(y(x) - y_0)$",
        quick: true,
        pose: dragged_toe,
    },
    Problem {
        name: "friction-tresca",
        title: "Shear traction that pressure does not change",
        source: "Tresca's law of friction",
        goal: "a limit without pressure",
        mesh: "one hex8 on 3 by 3 hex8",
        conditions: "as the friction loop, with a limit of 15",
        formula: "$|t| = t_{max}$ against the motion",
        quick: true,
        pose: || dragged_cube("{ tresca = 15.0, stiffness = 80.0 }", 15.0),
    },
];

const UNITS: &str = "units = \"mm-N-MPa\"\n";

fn law(name: &str, model: &str, e: f64, nu: f64) -> String {
    format!("[material.{name}]\nmodel = \"{model}\"\nE = {e:?}\nnu = {nu:?}\n")
}

fn friction_loop() -> Setup {
    dragged_cube("{ mu = 0.2, stiffness = 80.0 }", 20.0)
}

fn dragged_cube(friction: &str, shear: f64) -> Setup {
    let mut grid = Grid::space();
    let wide = || even(0.0, 3.0, 3);
    grid.block("block", "hex8", &[wide(), wide(), even(0.0, 1.0, 1)]);
    let cube = || even(1.0, 2.0, 1);
    grid.block("cube", "hex8", &[cube(), cube(), cube()]);
    let case = format!(
        r#"{UNITS}{}
[amplitude]
drag = {{ table = [[1.0, 0.0], [2.0, 1.0], [4.0, -1.0]], time = "total" }}

[[body]]
group = ["cube", "block"]
material = "steel"

[[contact]]
name = "foot"
secondary = "cube_back"
primary = "block_front"
method = "node-to-segment"
enforcement = {{ penalty = 1e7, per = "area" }}
friction = {friction}

[[step]]
name = "press"
geometry = "nonlinear"
increments = {{ fixed = 1 }}

  [[step.fix]]
  on = "block"
  u = "all"

  [[step.fix]]
  on = "cube_front"
  u = ["x", "y"]

  [[step.load]]
  on = "cube_front"
  pressure = 100.0
  follows = false
  coupling = "rigid-z"

[[step]]
name = "drag"
duration = 3.0
increments = {{ fixed = 15 }}

  [[step.move]]
  on = "cube_front"
  ux = {{ amplitude = "drag", value = 1.0 }}
"#,
        law("steel", "linear-elastic", 210e3, 0.3)
    );
    let why = "equilibrium, to the tolerance of Newton's method";
    Setup {
        mesh: grid,
        case,
        checks: vec![
            Check::exact(
                "force against the first way",
                "foot.force_x",
                -shear,
                1e-6,
                why,
            )
            .at(2.0),
            Check::exact(
                "force against the way back",
                "foot.force_x",
                shear,
                1e-6,
                why,
            ),
            Check::exact("pressing force", "foot.force_z", 100.0, 1e-6, why),
        ],
    }
}

/// The slope, in degrees.
const SLOPE: f64 = 20.0;

/// Two blocks on the slope.
fn inclined() -> Grid {
    let (sin, cos) = (SLOPE.to_radians().sin(), SLOPE.to_radians().cos());
    // down the slope is along (cos, -sin)
    let turn = |[x, y, z]: Point| [x * cos + y * sin, y * cos - x * sin, z];
    let mut grid = Grid::plane();
    for (name, from) in [("rests", 0.0), ("slides", 10.0)] {
        grid.mapped(&Lines {
            name,
            kind: "quad4",
            axes: &[even(from, from + 4.0, 8), even(0.0, 1.0, 2)],
            map: &turn,
        });
        let [x, y, _] = turn([from, 0.5, 0.0]);
        grid.set(
            &format!("{name}_end"),
            format!("{{ near = [{x:?}, {y:?}] }}"),
        );
    }
    grid
}

/// The contact of a block on the slope, and its spring.
fn on_slope(name: &str, mu: f64, stiffness: f64) -> String {
    let (sin, cos) = (SLOPE.to_radians().sin(), SLOPE.to_radians().cos());
    format!(
        r#"
[[contact]]
name = "{name}"
secondary = "{name}_bottom"
primary = "slope"
friction = {mu:?}

[[spring]]
name = "{name}"
on = "{name}_end"
direction = [{cos:?}, {:?}]
stiffness = {stiffness:?}
"#,
        -sin
    )
}

fn incline() -> Setup {
    let (sin, cos) = (SLOPE.to_radians().sin(), SLOPE.to_radians().cos());
    let grid = inclined();
    let (weight, stiffness, mu) = (4.0, 10.0, 0.2);
    let case = format!(
        r#"{UNITS}{}
[model]
space = "plane-strain"

[[body]]
group = ["rests", "slides"]
material = "steel"

[[surface]]
name = "slope"
shape = {{ plane = {{ point = [0.0, 0.0], normal = [{sin:?}, {cos:?}] }} }}
{}{}
[[step]]
name = "weigh"
geometry = "linear"
increments = {{ fixed = 4 }}

  [[step.load]]
  on = "rests"
  body_force = [0.0, -1.0]

  [[step.load]]
  on = "slides"
  body_force = [0.0, -1.0]
"#,
        law("steel", "linear-elastic", 1e5, 0.3),
        on_slope("rests", 0.5, stiffness),
        on_slope("slides", mu, stiffness)
    );
    let why = "equilibrium, and the limit of friction by multipliers";
    let along = |f: &[f64]| {
        let angle = SLOPE.to_radians();
        f[0] * angle.cos() - f[1] * angle.sin()
    };
    let across = |f: &[f64]| {
        let angle = SLOPE.to_radians();
        f[0] * angle.sin() + f[1] * angle.cos()
    };
    let slid = weight * (sin - mu * cos) / stiffness;
    Setup {
        mesh: grid,
        case,
        checks: vec![
            Check::exact(
                "friction on the resting block",
                "rests.force_x",
                -weight * sin,
                1e-3,
                "the spring is a ten-thousandth as stiff as the block",
            )
            .and("rests.force_y", along),
            Check::exact(
                "friction on the sliding block",
                "slides.force_x",
                -mu * weight * cos,
                1e-5,
                why,
            )
            .and("slides.force_y", along),
            Check::exact(
                "pressing force, sliding block",
                "slides.force_x",
                weight * cos,
                1e-5,
                why,
            )
            .and("slides.force_y", across),
            Check::exact(
                "the sliding block slides by",
                "displacement.x @ set slides_end",
                slid,
                1e-3,
                "the block itself gives way, being stiff",
            )
            .and("displacement.y @ set slides_end", along),
        ],
    }
}

fn capstan() -> Setup {
    let (radius, thick, mu, pull): (f64, f64, f64, f64) = (10.0, 0.1, 0.3, 0.01);
    let mut grid = Grid::plane();
    grid.mapped(&Lines {
        name: "belt",
        kind: "quad8",
        // from the left over the top to the right, the inside below
        axes: &[even(PI, 0.0, 90), even(radius, radius + thick, 1)],
        map: &|[angle, r, z]| [r * angle.cos(), r * angle.sin(), z],
    });
    let middle = radius + 0.5 * thick;
    grid.set("left", format!("{{ near = [{:?}, 0.0] }}", -middle));
    grid.set("right", format!("{{ near = [{middle:?}, 0.0] }}"));
    let growth = (mu * PI * radius / middle).exp();
    let case = format!(
        r#"{UNITS}{}
[model]
space = "plane-strain"

[[body]]
group = "belt"
material = "steel"

[[surface]]
name = "drum"
shape = {{ circle = {{ center = [0.0, 0.0], radius = {radius:?} }} }}

[[contact]]
name = "wrap"
secondary = "belt_bottom"
primary = "drum"
friction = {mu:?}

[[step]]
name = "pull"
geometry = "linear"
increments = {{ fixed = 8 }}

  [[step.load]]
  on = "right"
  force = [0.0, {:?}]

  [[step.move]]
  on = "left"
  uy = -0.02
"#,
        law("steel", "linear-elastic", 1000.0, 0.0),
        -pull
    );
    Setup {
        mesh: grid,
        case,
        checks: vec![Check::exact(
            "force on the moved end",
            "reaction_force.y @ set left",
            -pull * growth,
            2e-3,
            "bending of a belt of 1/100 of the radius, and cells of two degrees",
        )],
    }
}

/// The curve that the toe is dragged over, and its slope.
fn hump(x: f64) -> [f64; 2] {
    [0.05 * x.powi(4) - 0.2 * x * x, 0.2 * x.powi(3) - 0.4 * x]
}

fn dragged_toe() -> Setup {
    let (start, mu, stiffness) = (-1.6, 0.3_f64, 0.01);
    let low = hump(start)[0];
    let mut grid = Grid::plane();
    let shape = [
        [0.0, 0.0],
        [0.25, 0.4],
        [0.0, 0.5],
        [-0.25, 0.4],
        [0.25, 1.0],
        [0.0, 1.0],
        [-0.25, 1.0],
    ];
    for [x, y] in shape {
        grid.node([start + x, low + y, 0.0]);
    }
    for nodes in [[1, 2, 3, 4], [3, 2, 5, 6], [4, 3, 6, 7]] {
        grid.cell("quad4", "block", &nodes);
    }
    grid.set("toe", "{ nodes = [1] }");
    grid.set("middle", "{ nodes = [6] }");
    grid.set("head", "{ faces = [[2, \"S3\"], [3, \"S3\"]] }");
    let case = format!(
        r#"{UNITS}{}
[model]
space = "plane-strain"

[[body]]
group = "block"
material = "steel"

[[surface]]
name = "ground"
shape = {{ polynomial = {{ coefficients = [0.05, 0.0, -0.2, 0.0, 0.0], side = "above" }} }}

[[contact]]
name = "drag"
secondary = "toe"
primary = "ground"
method = "node-to-segment"
enforcement = {{ penalty = 1e5, per = "node" }}
friction = {mu:?}

[[spring]]
name = "guide"
on = "middle"
direction = "y"
stiffness = {stiffness:?}

[[step]]
name = "press"
geometry = "nonlinear"
increments = {{ fixed = 1 }}

  [[step.fix]]
  on = "head"
  u = ["x"]

  [[step.load]]
  on = "head"
  force = [0.0, -1.0]
  coupling = "rigid-y"

[[step]]
name = "drag"
duration = 3.2
increments = {{ fixed = 64 }}

  [[step.move]]
  on = "head"
  ux = 3.2
"#,
        law("steel", "linear-elastic", 210e3, 0.3)
    );
    let why = "the toe bends, and the penalty yields";
    let mut checks = Vec::new();
    for (x, words) in [
        (-0.8, "force along x, uphill"),
        (0.0, "force along x, on the hump"),
        (0.8, "force along x, downhill"),
        (1.6, "force along x, uphill again"),
    ] {
        let [height, slope] = hump(x);
        let press = 1.0 + stiffness * (height - low);
        let force = -press * (slope.atan() + mu.atan()).tan();
        // one millimetre per time, after the first step
        checks.push(Check::exact(words, "drag.force_x", force, 5e-4, why).at(1.0 + x - start));
    }
    Setup {
        mesh: grid,
        case,
        checks,
    }
}
