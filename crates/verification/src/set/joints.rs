//! Contact at large deformation, joints, bars that close gaps.

use crate::forms::{neo_hookean, root};
use crate::mesh::{Grid, Lines, even};
use crate::problem::{Check, Problem, Setup};
use std::f64::consts::PI;

/// The problems of this file.
pub(super) const PROBLEMS: [Problem; 6] = [
    Problem {
        name: "ironing-balance",
        title: "A round die irons a slab",
        source: "statics; loading after Fischer and Wriggers, Comput. Methods Appl. Mech. Engng 195 (2006) 5020",
        goal: "balance of forces at large sliding by mortar with friction",
        mesh: "quad4: 24 by 4 cells of the slab, 8 by 3 of the die",
        conditions: "plane strain, neo-Hookean, the die ten times as stiff; it is pressed in by 0.4 and moved by 2; μ = 0.3",
        formula: "forces on base and head add up to nothing; the contact force is that on the head",
        quick: false,
        pose: ironing,
    },
    Problem {
        name: "neo-hookean-stack",
        title: "Two neo-Hookean blocks, pressed together to large strain",
        source: "closed form: homogeneous states of both blocks with equal nominal stress",
        goal: "mortar contact at large strain on meshes that do not match",
        mesh: "3 by 3 hex8 on 2 by 2, by mortar",
        conditions: "unit cubes between smooth walls that keep their sides, shear moduli 1 and 10; pressed together by 0.6",
        formula: "$P_1(d_1) = P_2(d - d_1)$ with $P = -\\tau/l$, $\\tau = \\mu(l^2 - 1) + \\lambda\\ln l$, $l = 1 - d$",
        quick: true,
        pose: stack,
    },
    Problem {
        name: "tied-shear",
        title: "Two blocks tied on meshes that do not match, sheared and pulled",
        source: "patch test for mesh tying",
        goal: "a joint is as if it were not there",
        mesh: "5 by 2 quad4 on 7 by 3",
        conditions: "plane strain; uniform tension 1 and shear 0.5 by tractions on all sides",
        formula: "$\\sigma_y = 1$, $\\tau = 0.5$, $\\sigma_x = 0$; the top rises by $h(1 - \\nu^2)/E$ and shifts by $h\\tau/G$",
        quick: true,
        pose: tied,
    },
    Problem {
        name: "self-contact-hairpin",
        title: "A folded strip is squeezed until its legs touch",
        source: "closed form of the homogeneous state of a leg in plane strain, neo-Hookean",
        goal: "a surface that meets itself, at large rotation",
        mesh: "quad8, two cells through the strip",
        conditions: "plane strain; both legs are moved by 0.42 towards each other, 0.02 more than their gap",
        formula: "$\\sigma_y = \\tau_y/J$ at the stretch 0.9 with $\\tau_x = 0$",
        quick: false,
        pose: hairpin,
    },
    Problem {
        name: "bars-with-gaps",
        title: "Bars that close gaps",
        source: "statics of bars: S. Timoshenko, Strength of Materials I, chapter I",
        goal: "node to node contact by multipliers, loaded and heated",
        mesh: "four bars (line2)",
        conditions: "a bar and a wall, two bars that face each other, and a bar that is heated between a support and a wall",
        formula: "$R = F - EAg/L$; $u = (F + k_2 g)/(k_1 + k_2)$, $R = k_2(u - g)$; $R = EA(\\alpha\\Delta T - g/L)$",
        quick: true,
        pose: bars,
    },
    Problem {
        name: "cantilever-on-stop",
        title: "A loaded cantilever that comes to rest on a stop",
        source: "beam theory: Timoshenko and Gere, Mechanics of Materials",
        goal: "contact of one node with an analytical plane",
        mesh: "40 by 2 quad8",
        conditions: "plane stress, length 40, height 1; a uniform load presses the end on a stop below it",
        formula: "$R = \\frac{3EI}{L^3}(w - g)$, $w = \\frac{qL^4}{8EI}$, with the shear of the cross-section in both",
        quick: true,
        pose: stop,
    },
];

const UNITS: &str = "units = \"mm-N-MPa\"\n";

fn law(name: &str, model: &str, e: f64, nu: f64) -> String {
    format!("[material.{name}]\nmodel = \"{model}\"\nE = {e:?}\nnu = {nu:?}\n")
}

fn ironing() -> Setup {
    let mut grid = Grid::plane();
    grid.block("slab", "quad4", &[even(0.0, 9.0, 27), even(-3.0, 0.0, 5)]);
    grid.mapped(&Lines {
        name: "die",
        kind: "quad4",
        axes: &[even(-1.0, 1.0, 8), even(0.0, 1.0, 3)],
        map: &|[t, up, z]| {
            let low = 2.0 - (4.0 - t * t).sqrt();
            [2.5 + t, low + (1.5 - low) * up, z]
        },
    });
    let case = format!(
        r#"{UNITS}{}{}
[model]
space = "plane-strain"

[[body]]
group = "slab"
material = "rubber"

[[body]]
group = "die"
material = "tool"

[[contact]]
name = "iron"
secondary = "die_bottom"
primary = "slab_top"
method = "mortar"
friction = 0.3

[[step]]
name = "press"
geometry = "nonlinear"
increments = {{ fixed = 4 }}

  [[step.fix]]
  on = "slab_bottom"
  u = "all"

  [[step.move]]
  on = "die_top"
  ux = 0.0
  uy = -0.4

[[step]]
name = "iron"
increments = {{ fixed = 10 }}

  [[step.move]]
  on = "die_top"
  ux = 2.0
"#,
        law("rubber", "neo-hookean", 1.0, 0.3),
        law("tool", "neo-hookean", 10.0, 0.3)
    );
    let sum = |f: &[f64]| f.iter().sum::<f64>();
    let why = "equilibrium, to the tolerance of Newton's method";
    Setup {
        mesh: grid,
        case,
        checks: vec![
            Check::zero(
                "forces along x of base and head",
                "reaction_force.x @ set slab_bottom",
                0.5,
                1e-5,
                why,
            )
            .and("reaction_force.x @ set die_top", sum),
            Check::zero(
                "forces along y of base and head",
                "reaction_force.y @ set slab_bottom",
                1.0,
                1e-5,
                why,
            )
            .and("reaction_force.y @ set die_top", sum),
            Check::zero(
                "forces of contact and head along x",
                "iron.force_x",
                0.5,
                1e-5,
                why,
            )
            .and("reaction_force.x @ set die_top", sum),
        ],
    }
}

fn stack() -> Setup {
    let press = 0.6;
    let materials = [[1.0, 1.5], [10.0, 15.0]];
    let force = |[mu, lambda]: [f64; 2], d: f64| {
        let stretch = 1.0 - d;
        -neo_hookean(mu, lambda, [stretch, 1.0, 1.0])[0] / stretch
    };
    let lower = root(
        |d| force(materials[0], d) - force(materials[1], press - d),
        0.01,
        press - 0.001,
    );
    let pressure = force(materials[0], lower);
    let mut grid = Grid::space();
    let unit = |n: usize| even(0.0, 1.0, n);
    grid.block("lower", "hex8", &[unit(2), unit(2), unit(2)]);
    grid.block("upper", "hex8", &[unit(3), unit(3), even(1.0, 2.0, 2)]);
    for (name, sides) in [("side_x", ["left", "right"]), ("side_y", ["bottom", "top"])] {
        let all = ["lower", "upper"]
            .map(|b| sides.map(|s| format!("\"{b}_{s}\"")))
            .concat();
        grid.set(name, format!("{{ union = [{}] }}", all.join(", ")));
    }
    let case = format!(
        r#"{UNITS}{}{}
[[body]]
group = "lower"
material = "soft"

[[body]]
group = "upper"
material = "stiff"

[[contact]]
name = "joint"
secondary = "upper_back"
primary = "lower_front"
method = "mortar"

[solver]
newton = {{ force_tol = 1e-10 }}

[[step]]
name = "press"
geometry = "nonlinear"
increments = {{ fixed = 6 }}

  [[step.fix]]
  on = "lower_back"
  u = ["z"]

  [[step.fix]]
  on = "side_x"
  u = ["x"]

  [[step.fix]]
  on = "side_y"
  u = ["y"]

  [[step.move]]
  on = "upper_front"
  uz = {:?}
"#,
        law("soft", "neo-hookean", 2.6, 0.3),
        law("stiff", "neo-hookean", 26.0, 0.3),
        -press
    );
    let why = "homogeneous: mortar lets it through, to the tolerance of Newton's method";
    Setup {
        mesh: grid,
        case,
        checks: vec![
            Check::exact(
                "force on the head",
                "reaction_force.z @ set upper_front",
                -pressure,
                1e-7,
                why,
            ),
            Check::exact(
                "the joint sinks by",
                "displacement.z @ set lower_front",
                -lower,
                1e-7,
                why,
            ),
        ],
    }
}

fn tied_mesh() -> Grid {
    let mut grid = Grid::plane();
    grid.block("lower", "quad4", &[even(0.0, 2.0, 7), even(0.0, 1.0, 3)]);
    grid.block("upper", "quad4", &[even(0.0, 2.0, 5), even(1.0, 2.0, 2)]);
    grid.set("lefts", "{ union = [\"lower_left\", \"upper_left\"] }");
    grid.set("rights", "{ union = [\"lower_right\", \"upper_right\"] }");
    grid.set("corner", "{ near = [0.0, 0.0] }");
    grid.set("top_left", "{ near = [0.0, 2.0] }");
    grid
}

fn tied() -> Setup {
    let (e, nu, shear) = (100.0, 0.3, 0.5);
    let grid = tied_mesh();
    let case = format!(
        r#"{UNITS}{}
[model]
space = "plane-strain"

[[body]]
group = ["lower", "upper"]
material = "metal"

[[contact]]
name = "joint"
secondary = "upper_bottom"
primary = "lower_top"
tied = true

[solver]
newton = {{ force_tol = 1e-12 }}

[[step]]
name = "pull"
geometry = "linear"
increments = 1

  [[step.fix]]
  on = "lower_bottom"
  u = ["y"]

  [[step.fix]]
  on = "corner"
  u = ["x"]

  [[step.load]]
  on = "upper_top"
  traction = [{shear:?}, 1.0]

  [[step.load]]
  on = "lower_bottom"
  traction = [{:?}, 0.0]

  [[step.load]]
  on = "rights"
  traction = [0.0, {shear:?}]

  [[step.load]]
  on = "lefts"
  traction = [0.0, {:?}]
"#,
        law("metal", "linear-elastic", e, nu),
        -shear,
        -shear
    );
    let why = "rounding: the joint passes the patch test";
    let rises = 2.0 * (1.0 - nu * nu) / e;
    let shifts = 2.0 * shear * 2.0 * (1.0 + nu) / e;
    Setup {
        mesh: grid,
        case,
        checks: vec![
            Check::exact(
                "least tension at the joint",
                "stress.yy @ set upper_bottom min",
                1.0,
                1e-9,
                why,
            ),
            Check::exact(
                "largest tension at the joint",
                "stress.yy @ set lower_top max",
                1.0,
                1e-9,
                why,
            ),
            Check::exact(
                "largest shear at the joint",
                "stress.xy @ set lower_top max",
                shear,
                1e-9,
                why,
            ),
            Check::exact(
                "the top rises by",
                "displacement.y @ set top_left",
                rises,
                1e-9,
                why,
            ),
            Check::exact(
                "the top shifts by",
                "displacement.x @ set top_left",
                shifts,
                1e-9,
                why,
            ),
        ],
    }
}

fn hairpin_mesh() -> Grid {
    let mut grid = Grid::plane();
    // along the strip: the upper leg inwards, the bend, the lower leg outwards
    let legs = [even(0.0, 3.0, 15), even(3.0, 4.0, 12), even(4.0, 7.0, 12)];
    let along_axis = [legs[0].as_slice(), &legs[1][1..], &legs[2][1..]].concat();
    grid.mapped(&Lines {
        name: "strip",
        kind: "quad8",
        axes: &[along_axis, even(-0.6, -0.4, 2)],
        map: &|[s, depth, z]| {
            let r = -depth;
            match s {
                s if s <= 3.0 => [3.0 - s, r, z],
                s if s >= 4.0 => [s - 4.0, -r, z],
                s => {
                    let angle = PI * (s - 3.0);
                    [-r * angle.sin(), r * angle.cos(), z]
                }
            }
        },
    });
    grid.set("above", "{ box = [[1.49, 0.59], [2.51, 0.61]] }");
    grid.set("below", "{ box = [[1.49, -0.61], [2.51, -0.59]] }");
    grid.set("middle", "{ near = [2.0, 0.4] }");
    grid.set("bend", "{ box = [[-0.7, -1e-6], [-0.3, 1e-6]] }");
    grid.set("held", "{ union = [\"above\", \"below\", \"bend\"] }");
    grid
}

fn hairpin() -> Setup {
    let (e, nu) = (10.0, 0.3);
    let (mu, lambda) = (
        e / (2.0 * (1.0 + nu)),
        e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
    );
    let squeezed = 0.9;
    let state = |along: f64| neo_hookean(mu, lambda, [along, squeezed, 1.0]);
    let along = root(|along| state(along)[0], 0.5, 2.0);
    let stress = state(along)[1] / (along * squeezed);
    let grid = hairpin_mesh();
    let case = format!(
        r#"{UNITS}{}
[model]
space = "plane-strain"

[[body]]
group = "strip"
material = "rubber"

[[contact]]
name = "fold"
secondary = "strip_top"
primary = "self"
reach = 0.15

[[step]]
name = "squeeze"
geometry = "nonlinear"
increments = {{ initial = 0.05, max = 0.05 }}

  [[step.fix]]
  on = "bend"
  u = "all"

  [[step.move]]
  on = "above"
  uy = -0.42

  [[step.move]]
  on = "below"
  uy = 0.42
"#,
        law("rubber", "neo-hookean", e, nu)
    );
    Setup {
        mesh: grid,
        case,
        checks: vec![
            Check::exact(
                "stress across a leg",
                "stress.yy @ set middle",
                stress,
                0.02,
                "the squeezed part of the legs is five times as long as thick",
            ),
            Check::exact(
                "the legs meet halfway",
                "displacement.y @ set middle",
                -0.4,
                3e-3,
                "penetration by the automatic penalty",
            ),
            Check::zero(
                "forces of both legs",
                "contact_force.y @ set strip_top",
                1.0,
                1e-10,
                "what one leg gets, the other gives",
            ),
            Check::zero(
                "forces at the supports",
                "reaction_force.y @ set held",
                1.0,
                1e-5,
                "equilibrium",
            ),
        ],
    }
}

fn bars_mesh() -> Grid {
    let mut grid = Grid::plane();
    let mut bar = |name: &str, y: f64, from: f64, to: f64| {
        let ends = [grid.node([from, y, 0.0]), grid.node([to, y, 0.0])];
        grid.cell("line2", name, &ends);
    };
    bar("bar", 0.0, 0.0, 2.0);
    bar("wall", 0.0, 2.1, 2.5);
    bar("left", 1.0, 0.0, 1.0);
    bar("right", 1.0, 1.05, 2.05);
    bar("hot", 2.0, 0.0, 2.0);
    bar("stop", 2.0, 2.001, 2.5);
    for (name, node) in [
        ("end", 2),
        ("face", 3),
        ("left_end", 6),
        ("right_end", 7),
        ("hot_end", 10),
        ("stop_face", 11),
    ] {
        grid.set(name, format!("{{ nodes = [{node}] }}"));
    }
    grid.set("roots", "{ nodes = [1, 5, 8, 9] }");
    grid.set("guided", "{ nodes = [2, 6, 7, 10] }");
    grid
}

fn bars() -> Setup {
    let grid = bars_mesh();
    let contact = |name: &str, secondary: &str, primary: &str| {
        format!(
            r#"
[[contact]]
name = "{name}"
secondary = "{secondary}"
primary = "{primary}"
method = "node-to-node"
normals = [-1.0, 0.0]
enforcement = {{ lagrange = {{}} }}
"#
        )
    };
    let body = |name: &str, area: f64| {
        format!("\n[[body]]\ngroup = \"{name}\"\nmaterial = \"soft\"\narea = {area:?}\n")
    };
    let case = format!(
        r#"{UNITS}{}expansion = {{ alpha = 1e-5 }}

[model]
space = "plane-stress"
{}{}{}{}
[[body]]
group = ["wall", "stop"]
rigid = true
{}{}{}
[initial]
temperature = 0.0

[[step]]
name = "load"
geometry = "linear"
increments = {{ fixed = 1 }}

  [[step.fix]]
  on = "roots"
  u = "all"

  [[step.fix]]
  on = "guided"
  u = ["y"]

  [[step.load]]
  on = "end"
  force = [3.0, 0.0]

  [[step.load]]
  on = "left_end"
  force = [2.0, 0.0]

  [[step.temperature]]
  on = "hot"
  value = 100.0
"#,
        law("soft", "linear-elastic", 10.0, 0.3),
        body("bar", 1.0),
        body("left", 1.0),
        body("right", 2.0),
        body("hot", 1000.0),
        contact("at_wall", "end", "face"),
        contact("joint", "left_end", "right_end"),
        contact("at_stop", "hot_end", "stop_face"),
    );
    let [k1, k2, gap] = [10.0, 20.0, 0.05];
    let moved = (2.0 + k2 * gap) / (k1 + k2);
    let heated = 10.0 * 1000.0 * (1e-5 * 100.0 - 0.001 / 2.0);
    let why = "a few unknowns: rounding";
    Setup {
        mesh: grid,
        case,
        checks: vec![
            Check::exact(
                "force of the wall",
                "at_wall.force_x",
                -(3.0 - 10.0 * 0.1 / 2.0),
                1e-9,
                why,
            ),
            Check::exact(
                "the left bar moves by",
                "displacement.x @ set left_end",
                moved,
                1e-9,
                why,
            ),
            Check::exact(
                "force between the bars",
                "joint.force_x",
                -k2 * (moved - gap),
                1e-9,
                why,
            ),
            Check::exact("force of the stop", "at_stop.force_x", -heated, 1e-9, why),
        ],
    }
}

fn stop() -> Setup {
    let (e, nu, length, gap, load): (f64, f64, f64, f64, f64) = (1e6, 0.3, 40.0, 0.2, 0.1);
    let (bending, shear) = (e / 12.0, 5.0 / 6.0 * e / (2.0 * (1.0 + nu)));
    let sinks = load * length.powi(4) / (8.0 * bending) + load * length * length / (2.0 * shear);
    let yields = length.powi(3) / (3.0 * bending) + length / shear;
    let mut grid = Grid::plane();
    grid.block("beam", "quad8", &[even(0.0, length, 40), even(0.0, 1.0, 2)]);
    grid.set("end", format!("{{ near = [{length:?}, 0.0] }}"));
    let case = format!(
        r#"{UNITS}{}
[model]
space = "plane-stress"

[[body]]
group = "beam"
material = "metal"

[[surface]]
name = "floor"
shape = {{ plane = {{ point = [0.0, {:?}], normal = "y" }} }}

[[contact]]
name = "stop"
secondary = "end"
primary = "floor"
method = "node-to-segment"
enforcement = {{ lagrange = {{}} }}

[[step]]
name = "load"
geometry = "linear"
increments = 1

  [[step.fix]]
  on = "beam_left"
  u = "all"

  [[step.load]]
  on = "beam_top"
  traction = [0.0, {:?}]
"#,
        law("metal", "linear-elastic", e, nu),
        -gap,
        -load
    );
    Setup {
        mesh: grid,
        case,
        checks: vec![
            Check::exact(
                "force of the stop",
                "stop.force_y",
                (sinks - gap) / yields,
                3e-3,
                "beam theory: the clamped end, and the dent at the stop",
            ),
            Check::exact(
                "the end sinks by",
                "displacement.y @ set end",
                -gap,
                1e-9,
                "multipliers: no penetration",
            ),
        ],
    }
}
