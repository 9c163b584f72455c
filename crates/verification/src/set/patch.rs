//! Contact patch tests: a uniform pressure goes through two blocks.

use crate::mesh::{Grid, Lines, even};
use crate::problem::{Check, Problem, Setup};

const SOURCE: &str = "Taylor and Papadopoulos, On a patch test for contact problems in two dimensions (1991); El-Abbasi and Bathe, Comput. Struct. 79 (2001) 1473";
const GOAL: &str = "a uniform pressure goes through meshes that do not match without a trace";
const FORMULA: &str = "$\\sigma = -p$ everywhere; the head sinks by $p\\,h\\,(1/M_1 + 1/M_2)$, $M = E/(1-\\nu^2)$ in plane strain, $E$ in space";
const PLANE: &str =
    "plane strain, pressure 1 on the head; the base is held along the pressure, one side along x";
const SPACE: &str =
    "pressure 1 on the head; the base is held along the pressure, two sides along x and y";

const fn patch(
    name: &'static str,
    title: &'static str,
    mesh: &'static str,
    in_plane: bool,
    pose: fn() -> Setup,
) -> Problem {
    Problem {
        name,
        title,
        source: SOURCE,
        goal: GOAL,
        mesh,
        conditions: if in_plane { PLANE } else { SPACE },
        formula: FORMULA,
        quick: true,
        pose,
    }
}

/// The problems of this file.
pub(super) const PROBLEMS: [Problem; 12] = [
    patch(
        "patch-quad4-mortar",
        "Patch test, quad4, mortar",
        "7 cells on 5",
        true,
        || plane("quad4", [7, 5], MORTAR, 1e-10),
    ),
    patch(
        "patch-quad8-mortar",
        "Patch test, quad8, mortar",
        "4 cells on 3",
        true,
        || plane("quad8", [4, 3], MORTAR, 1e-10),
    ),
    patch(
        "patch-tri6-mortar",
        "Patch test, tri6, mortar",
        "4 cells of two triangles on 3",
        true,
        || plane("tri6", [4, 3], MORTAR, 1e-10),
    ),
    patch(
        "patch-hex8-mortar",
        "Patch test, hex8, mortar",
        "4 by 4 cells on 3 by 3",
        false,
        || space("hex8", MORTAR, 1e-9),
    ),
    patch(
        "patch-hex20-mortar",
        "Patch test, hex20, mortar",
        "4 by 4 cells on 3 by 3",
        false,
        || space("hex20", MORTAR, 1e-9),
    ),
    patch(
        "patch-tet4-mortar",
        "Patch test, tet4, mortar",
        "4 by 4 cells of six tetrahedra on 3 by 3",
        false,
        || space("tet4", MORTAR, 1e-9),
    ),
    patch(
        "patch-tet10-mortar",
        "Patch test, tet10, mortar",
        "4 by 4 cells of six tetrahedra on 3 by 3",
        false,
        || space("tet10", MORTAR, 1e-9),
    ),
    patch(
        "patch-quad4-gauss-point",
        "Patch test, quad4, Gauss points",
        "7 cells on 5",
        true,
        || plane("quad4", [7, 5], POINTS, 2e-3),
    ),
    patch(
        "patch-quad4-penalty",
        "Patch test, quad4, matching, penalty at nodes",
        "6 cells on 6 that match",
        true,
        || plane("quad4", [6, 6], NODES, 1e-9),
    ),
    patch(
        "patch-hex8-lagrange",
        "Patch test, hex8, matching, multipliers at nodes",
        "3 by 3 cells on 3 by 3 that match",
        false,
        matching,
    ),
    patch(
        "patch-tri3-mortar",
        "Patch test, tri3, mortar",
        "7 cells of two triangles on 5",
        true,
        || plane("tri3", [7, 5], MORTAR, 1e-10),
    ),
    patch(
        "patch-wedge6-mortar",
        "Patch test, wedge6, mortar",
        "4 by 4 cells of two wedges on 3 by 3",
        false,
        || space("wedge6", MORTAR, 1e-9),
    ),
];

const MORTAR: &str = "method = \"mortar\"";
const POINTS: &str = "method = \"gauss-point\"\nenforcement = { penalty = 1e6 }";
const NODES: &str = "method = \"node-to-segment\"\nenforcement = { penalty = 1e4 }";
const MULTIPLIERS: &str = "method = \"node-to-segment\"\nenforcement = { lagrange = {} }";

/// Moduli of the lower and the upper block, and Poisson's ratio of both.
const E: [f64; 2] = [100.0, 200.0];
const NU: f64 = 0.3;

fn case(axis: &str, method: &str, more: &str) -> String {
    let (base, head) = match axis {
        "y" => ("lower_bottom", "upper_top"),
        _ => ("lower_back", "upper_front"),
    };
    let (foot, top) = match axis {
        "y" => ("upper_bottom", "lower_top"),
        _ => ("upper_back", "lower_front"),
    };
    format!(
        r#"units = "mm-N-MPa"
{more}
[material.soft]
model = "linear-elastic"
E = {:?}
nu = {NU:?}

[material.stiff]
model = "linear-elastic"
E = {:?}
nu = {NU:?}

[[body]]
group = "lower"
material = "soft"

[[body]]
group = "upper"
material = "stiff"

[[contact]]
name = "joint"
secondary = "{foot}"
primary = "{top}"
{method}

[solver]
newton = {{ force_tol = 1e-12 }}

[[step]]
name = "press"
geometry = "linear"
increments = 1

  [[step.fix]]
  on = "{base}"
  u = ["{axis}"]

  [[step.fix]]
  on = "left"
  u = ["x"]

  [[step.load]]
  on = "{head}"
  pressure = 1.0
"#,
        E[0], E[1]
    )
}

const WHY: &str = "rounding: the method passes the test";
const WHY_POINTS: &str = "points inside facets integrate a kink in the middle of a facet";

fn plane(kind: &'static str, cells: [usize; 2], method: &str, part: f64) -> Setup {
    let mut grid = Grid::plane();
    grid.block(
        "lower",
        kind,
        &[even(0.0, 2.0, cells[1]), even(0.0, 1.0, 2)],
    );
    grid.block(
        "upper",
        kind,
        &[even(0.0, 2.0, cells[0]), even(1.0, 2.0, 2)],
    );
    grid.set("left", "{ plane = \"x\", at = 0.0 }");
    let why = if method == POINTS { WHY_POINTS } else { WHY };
    let modulus = E.map(|e| e / (1.0 - NU * NU));
    let gap = if method == NODES { 1e-4 } else { 0.0 };
    let sinks = -(1.0 / modulus[0] + 1.0 / modulus[1]) - gap;
    Setup {
        mesh: grid,
        case: case("y", method, "\n[model]\nspace = \"plane-strain\"\n"),
        checks: vec![
            Check::exact(
                "least stress at the foot",
                "stress.yy @ set upper_bottom max",
                -1.0,
                part,
                why,
            ),
            Check::exact(
                "largest stress at the foot",
                "stress.yy @ set upper_bottom min",
                -1.0,
                part,
                why,
            ),
            Check::exact("force", "joint.force_y", 2.0, 1e-9, "equilibrium"),
            Check::exact(
                "the head sinks by",
                "displacement.y @ set upper_top",
                sinks,
                part,
                why,
            ),
        ],
    }
}

fn blocks(kind: &'static str, upper: usize) -> Grid {
    let mut grid = Grid::space();
    let square = |n: usize| even(0.0, 2.0, n);
    for (name, n, z) in [("lower", 3, [0.0, 1.0]), ("upper", upper, [1.0, 2.0])] {
        grid.mapped(&Lines {
            name,
            kind,
            axes: &[square(n), square(n), even(z[0], z[1], 1)],
            map: &|p| p,
        });
    }
    grid.set("left", "{ plane = \"x\", at = 0.0 }");
    grid.set("side", "{ plane = \"y\", at = 0.0 }");
    grid
}

const SIDE: &str = "\n  [[step.fix]]\n  on = \"side\"\n  u = [\"y\"]\n";

fn checks_in_space(part: f64) -> Vec<Check> {
    let sinks = -(1.0 / E[0] + 1.0 / E[1]);
    vec![
        Check::exact(
            "least stress at the foot",
            "stress.zz @ set upper_back max",
            -1.0,
            part,
            WHY,
        ),
        Check::exact(
            "largest stress at the foot",
            "stress.zz @ set upper_back min",
            -1.0,
            part,
            WHY,
        ),
        Check::exact("largest pressure", "joint.pressure_max", 1.0, part, WHY),
        Check::exact("force", "joint.force_z", 4.0, 1e-9, "equilibrium"),
        Check::exact(
            "the head sinks by",
            "displacement.z @ set upper_front",
            sinks,
            part,
            WHY,
        ),
    ]
}

fn space(kind: &'static str, method: &str, part: f64) -> Setup {
    Setup {
        mesh: blocks(kind, 4),
        case: format!("{}{SIDE}", case("z", method, "")),
        checks: checks_in_space(part),
    }
}

fn matching() -> Setup {
    Setup {
        mesh: blocks("hex8", 3),
        case: format!("{}{SIDE}", case("z", MULTIPLIERS, "")),
        checks: checks_in_space(1e-9),
    }
}
