//! The figure of the paper, a rigid tip on one wedge and on one brick; and two blocks that another program slid.

use crate::forms::root;
use crate::mesh::{Grid, even};
use crate::problem::{Check, Kind, Problem, Setup};

const SOURCE: &str =
    "Faltus and Horak, A modular extension of a finite element contact implementation, figure 2";

/// The problems of this file.
pub(super) const PROBLEMS: [Problem; 3] = [
    Problem {
        name: "paper-wedge",
        title: "The paper's figure: a tip on one wedge",
        source: SOURCE,
        goal: "node to segment by a penalty at large displacement; the force at the centroid leaves the top plane",
        mesh: "one wedge6",
        conditions: "St. Venant and Kirchhoff, E = 500, ν = 0; the base is clamped, the tip moves by 0.3; penalty 1e5 per node",
        formula: "$F = \\tfrac12 EA(l - l^3)$ with $l = 0.7 + F/k$: uniaxial compression of the wedge, $A = \\tfrac12$",
        quick: true,
        pose: wedge,
    },
    Problem {
        name: "paper-brick",
        title: "The paper's figure: a tip on one brick",
        source: SOURCE,
        goal: "the same on a facet that warps: curvature enters force and tangent",
        mesh: "one hex8",
        conditions: "as the wedge; the tip is on a symmetry axis of the top",
        formula: "no closed form; an independent program, written for the purpose, lists force and penetration of all 60 increments",
        quick: true,
        pose: brick,
    },
    Problem {
        name: "two-blocks",
        title: "A block is pressed into another one and slid over its facets",
        source: "independent program, written for the purpose: Newton to round-off, twelve digits (crates/signorini/tests/data/two_block_2d.json)",
        goal: "sliding across the boundaries of facets at finite strain",
        mesh: "2 by 2 quad4 on 4 by 2",
        conditions: "plane strain, neo-Hookean, E = 1000 and 2000, ν = 0.3; pressed by 0.05, slid by 0.21; penalty 1e5 per node, no friction",
        formula: "no closed form; both ends of the path of the independent program",
        quick: true,
        pose: two_blocks,
    },
];

/// Half of the tetrahedron's base over its tip.
const TIP: [[f64; 3]; 3] = [[-0.3, -0.2, 0.8], [0.3, -0.2, 0.8], [0.0, 0.4, 0.8]];

const CASE: &str = r#"
units = "m-MN-MPa"

[material.soft]
model = "saint-venant-kirchhoff"
E = 500.0
nu = 0.0

[[body]]
group = "body"
material = "soft"

[[body]]
group = "tool"
rigid = true

[[contact]]
name = "tip"
secondary = "tip_node"
primary = "top"
method = "node-to-segment"
enforcement = { penalty = 1.0e5, per = "node" }

[[step]]
name = "press"
geometry = "nonlinear"
increments = { fixed = 60 }

  [[step.fix]]
  on = "base"
  u = "all"

  [[step.move]]
  on = "tool"
  uz = -0.3

[solver]
newton = { force_tol = 1e-10 }
"#;

fn with_tip(kind: &'static str, corners: &[[f64; 2]], tip: [f64; 2], top: &str) -> Grid {
    let mut grid = Grid::space();
    let mut nodes = Vec::new();
    for z in [0.0, 1.0] {
        nodes.extend(corners.iter().map(|[x, y]| grid.node([*x, *y, z])));
    }
    grid.cell(kind, "body", &nodes);
    let [x, y] = tip;
    let mut tool = vec![grid.node([x, y, 1.0])];
    grid.set("tip_node", format!("{{ nodes = {tool:?} }}"));
    tool.extend(TIP.map(|[dx, dy, dz]| grid.node([x + dx, y + dy, 1.0 + dz])));
    grid.cell("tet4", "tool", &tool);
    let base: Vec<usize> = (1..=corners.len()).collect();
    grid.set("base", format!("{{ nodes = {base:?} }}"));
    grid.set("top", format!("{{ faces = [[1, \"{top}\"]] }}"));
    grid
}

fn wedge() -> Setup {
    let third = 1.0 / 3.0;
    let force = root(
        |f| {
            let l = 0.7 + f / 1e5;
            f - 0.5 * 500.0 * 0.5 * (l - l * l * l)
        },
        0.0,
        1000.0,
    );
    Setup {
        mesh: with_tip(
            "wedge6",
            &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            [third, third],
            "+z",
        ),
        case: CASE.to_owned(),
        checks: vec![
            Check::exact(
                "force on the tip",
                "tip.force_z",
                force,
                1e-9,
                "three unknowns: rounding",
            ),
            Check::exact(
                "gap at the tip",
                "tip.gap_min",
                -force / 1e5,
                1e-9,
                "three unknowns: rounding",
            ),
        ],
    }
}

fn brick() -> Setup {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let why = "the same equations by another program, to the tolerance of Newton's method";
    let force = |words: &'static str, increment: u32, value: f64| {
        Check::exact(words, "tip.force_z", value, 1e-8, why)
            .of(Kind::CrossCode)
            .at(f64::from(increment) / 60.0)
    };
    Setup {
        mesh: with_tip("hex8", &corners, [0.5, 0.25], "+z"),
        case: CASE.to_owned(),
        checks: vec![
            force("force after 1 increment", 1, 1.664_433_258_03),
            force("force after 20 increments", 20, 32.263_017_988_9),
            force("force after 40 increments", 40, 56.602_543_405_9),
            force("force after 60 increments", 60, 68.956_391_015_2),
            Check::exact(
                "gap at the tip",
                "tip.gap_min",
                -0.000_725_088_618_977,
                1e-8,
                why,
            )
            .of(Kind::CrossCode),
        ],
    }
}

fn two_blocks() -> Setup {
    let mut grid = Grid::plane();
    grid.block("lower", "quad4", &[even(0.0, 2.0, 4), even(0.0, 1.0, 2)]);
    grid.block("upper", "quad4", &[even(0.55, 1.25, 2), even(1.0, 1.5, 2)]);
    grid.set("foot", "{ plane = \"y\", at = 1.0, of = \"upper\" }");
    let case = r#"
units = "mm-N-MPa"

[model]
space = "plane-strain"

[amplitude]
slide = { table = [[5.0, 0.0], [12.0, 0.21]], time = "total" }
press = { table = [[0.0, 0.0], [5.0, -0.05]], time = "total" }

[material.soft]
model = "neo-hookean"
E = 1000.0
nu = 0.3

[material.stiff]
model = "neo-hookean"
E = 2000.0
nu = 0.3

[[body]]
group = "lower"
material = "soft"

[[body]]
group = "upper"
material = "stiff"

[[contact]]
name = "foot"
secondary = "foot"
primary = "lower_top"
method = "node-to-segment"
enforcement = { penalty = 1.0e5, per = "node" }

[[step]]
name = "press and slide"
geometry = "nonlinear"
duration = 12.0
increments = { fixed = 12 }

  [[step.fix]]
  on = "lower_bottom"
  u = "all"

  [[step.move]]
  on = "upper_top"
  ux = { amplitude = "slide", value = 1.0 }
  uy = { amplitude = "press", value = 1.0 }

[solver]
newton = { force_tol = 1e-10 }
"#;
    let why = "the same equations by another program, to the tolerance of Newton's method";
    let force = |words: &'static str, what: &str, value: f64| {
        Check::exact(words, what, value, 1e-8, why).of(Kind::CrossCode)
    };
    Setup {
        mesh: grid,
        case: case.to_owned(),
        checks: vec![
            force("force along the facets", "foot.force_x", 0.144_150_365_488),
            force("force across the facets", "foot.force_y", 55.164_083_934),
        ],
    }
}
