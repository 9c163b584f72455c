//! Hertz in its forms, Cattaneo and Mindlin.
//!
//! Bodies are graded rectangles that reach 40 half-widths of the contact and more. What such an end changes bends the surface
//! at the contact by the square of their ratio only, so that loads, not motions, are prescribed and compared; stresses
//! below it, which change with the ratio itself, need more. A round side is Hertz's parabola.

use crate::forms::{cattaneo_work, contact_modulus, hertz_line, hertz_line_axis, hertz_point};
use crate::mesh::{Grid, Lines, Point, even, graded, mirrored};
use crate::problem::{Check, Problem, Setup, fill};
use std::f64::consts::PI;

/// The problems of this file.
pub(super) const PROBLEMS: [Problem; 12] = [
    Problem {
        name: "hertz-cylinder-mortar",
        title: "Hertz: cylinder on block, mortar",
        source: "K. L. Johnson, Contact Mechanics (1985), equations 4.43 to 4.46",
        goal: "pressure, width and stress below the surface of a line contact, by mortar on meshes that do not match",
        mesh: "8 and 6.5 cells on the half-width, graded outwards to 160 half-widths",
        conditions: "plane strain, symmetry at x = 0; the base is held along y, the load acts on the head, which stays level",
        formula: "$p_0 = 2P/(\\pi a)$, $a^2 = 4PR/(\\pi E^*)$, $\\tau(z) = \\tfrac12(\\sigma_x - \\sigma_z)$ on the axis",
        quick: true,
        pose: || hertz_cylinder("method = \"mortar\"", [8.0, 6.5], 0.01),
    },
    Problem {
        name: "hertz-cylinder-node-to-segment",
        title: "Hertz: cylinder on block, node to segment",
        source: "K. L. Johnson, Contact Mechanics (1985), equations 4.43 to 4.46",
        goal: "the same by nodes against segments with the automatic penalty",
        mesh: "as for mortar, but with 8 cells on the half-width of both bodies, which match",
        conditions: "as for mortar",
        formula: "$p_0 = 2P/(\\pi a)$, $a^2 = 4PR/(\\pi E^*)$, $\\tau(z) = \\tfrac12(\\sigma_x - \\sigma_z)$ on the axis",
        quick: true,
        pose: || hertz_cylinder("method = \"node-to-segment\"", [8.0; 2], 0.01),
    },
    Problem {
        name: "hertz-cylinder-gauss-point",
        title: "Hertz: cylinder on block, Gauss points",
        source: "K. L. Johnson, Contact Mechanics (1985), equations 4.43 to 4.46",
        goal: "the same by points inside facets with the automatic penalty",
        mesh: "as for mortar",
        conditions: "as for mortar",
        formula: "$p_0 = 2P/(\\pi a)$, $a^2 = 4PR/(\\pi E^*)$, $\\tau(z) = \\tfrac12(\\sigma_x - \\sigma_z)$ on the axis",
        quick: false,
        pose: || hertz_cylinder("method = \"gauss-point\"", [8.0, 6.5], 0.02),
    },
    Problem {
        name: "hertz-rigid-circle-2d",
        title: "Hertz: rigid circle on a block",
        source: "K. L. Johnson, Contact Mechanics (1985), equations 4.43 to 4.45",
        goal: "contact with an analytical surface of the plane that a load moves",
        mesh: "8 cells on the half-width, graded outwards to 40 half-widths",
        conditions: "plane strain, symmetry at x = 0; the base is held along y, the load acts on the reference of the circle",
        formula: "$p_0 = 2P/(\\pi a)$, $a^2 = 4PR/(\\pi E^*)$",
        quick: true,
        pose: rigid_circle,
    },
    Problem {
        name: "hertz-rigid-cylinder-3d",
        title: "Hertz: rigid cylinder on a slab",
        source: "K. L. Johnson, Contact Mechanics (1985), equations 4.43 to 4.45",
        goal: "contact with an analytical cylinder in space",
        mesh: "hex8, one layer; 8 cells on the half-width, graded outwards to 40 half-widths",
        conditions: "plane strain by supports along z, symmetry at x = 0; the load acts on the reference of the cylinder",
        formula: "$p_0 = 2P/(\\pi a)$, $a^2 = 4PR/(\\pi E^*)$",
        quick: false,
        pose: rigid_cylinder,
    },
    Problem {
        name: "hertz-sphere-axisymmetric",
        title: "Hertz: ball on block, axisymmetric",
        source: "K. L. Johnson, Contact Mechanics (1985), equations 4.22 to 4.24",
        goal: "pressure and radius of a point contact of bodies of revolution, by mortar",
        mesh: "12 and 9.5 cells on the radius of contact, graded outwards to 40 radii",
        conditions: "the axis is held along r, the base along the axis; the load acts on the head, which stays level",
        formula: "$p_0 = 3F/(2\\pi a^2)$, $a^3 = 3FR/(4E^*)$",
        quick: false,
        pose: sphere_axisymmetric,
    },
    Problem {
        name: "hertz-sphere-3d",
        title: "Hertz: ball on block, a quarter in space",
        source: "K. L. Johnson, Contact Mechanics (1985), equations 4.22 to 4.24",
        goal: "pressure of a point contact of two bodies in space, by mortar on meshes that do not match",
        mesh: "hex8, 5 and 4 cells on the radius of contact, graded outwards to 12 radii",
        conditions: "symmetry at x = 0 and y = 0, the base is held along z; the load acts on the head, which stays level",
        formula: "$p_0 = 3F/(2\\pi a^2)$, $a^3 = 3FR/(4E^*)$",
        quick: false,
        pose: sphere_in_space,
    },
    Problem {
        name: "hertz-rigid-sphere-3d",
        title: "Hertz: rigid ball on a block, a quarter in space",
        source: "K. L. Johnson, Contact Mechanics (1985), equations 4.22 to 4.24",
        goal: "contact with an analytical sphere in space",
        mesh: "hex8, 5 cells on the radius of contact, graded outwards to 12 radii",
        conditions: "symmetry at x = 0 and y = 0, the base is held along z; the load acts on the reference of the sphere",
        formula: "$p_0 = 3F/(2\\pi a^2)$, $a^3 = 3FR/(4E^*)$",
        quick: false,
        pose: || rigid_sphere("hex8", 5.0, 0.03),
    },
    Problem {
        name: "cattaneo-mindlin",
        title: "Cattaneo and Mindlin: cylinders pressed, then sheared",
        source: "K. L. Johnson, Contact Mechanics (1985), section 7.2; work of slip: integral of μ p times slip over both slip zones",
        goal: "stick and slip of a contact with friction, by mortar",
        mesh: "16 and 13 cells on the half-width, graded outwards to 20 half-widths",
        conditions: "plane strain; the base is held; the head is pressed by P and then pulled by Q = 0.6 μP, and stays level; μ = 0.3",
        formula: "$c = a\\sqrt{1 - Q/(\\mu P)}$, $W = 2\\int_c^a \\mu p\\, s\\, dx$ with $s(x) = \\frac{2\\mu p_0}{E^* a}\\int_c^x\\sqrt{\\xi^2 - c^2}\\,d\\xi$",
        quick: false,
        pose: cattaneo_mindlin,
    },
    Problem {
        name: "hertz-cylinder-quad8",
        title: "Hertz: cylinder on block, quadratic cells",
        source: "K. L. Johnson, Contact Mechanics (1985), equations 4.43 to 4.46",
        goal: "a line contact of quadratic facets by mortar",
        mesh: "quad8, 4 and 3.25 cells on the half-width, graded outwards to 40 half-widths",
        conditions: "as for linear cells",
        formula: "$p_0 = 2P/(\\pi a)$, $a^2 = 4PR/(\\pi E^*)$",
        quick: true,
        pose: hertz_quadratic,
    },
    Problem {
        name: "hertz-groove",
        title: "Hertz: a cylinder in a rigid groove",
        source: "K. L. Johnson, Contact Mechanics (1985), equations 4.43 to 4.45",
        goal: "an analytical circle from its inside",
        mesh: "8 cells on the half-width, graded outwards to 40 half-widths",
        conditions: "plane strain, symmetry at x = 0; radius 100 in a groove of radius 150; the load acts on the head, which stays level",
        formula: "$p_0 = 2P/(\\pi a)$, $a^2 = 4PR/(\\pi E^*)$, $1/R = 1/R_1 - 1/R_2$",
        quick: true,
        pose: groove,
    },
    Problem {
        name: "hertz-rigid-sphere-tet10",
        title: "Hertz: rigid ball on a block of tetrahedra",
        source: "K. L. Johnson, Contact Mechanics (1985), equations 4.22 to 4.24",
        goal: "quadratic triangles against an analytical sphere",
        mesh: "tet10, 3 cells on the radius of contact, graded outwards to 12 radii",
        conditions: "as for hexahedra",
        formula: "$p_0 = 3F/(2\\pi a^2)$, $a^3 = 3FR/(4E^*)$",
        quick: false,
        pose: || rigid_sphere("tet10", 3.0, 0.04),
    },
];

/// Modulus and Poisson's ratio of all bodies here (MPa).
const MATERIAL: [f64; 2] = [1000.0, 0.3];

const RIGID: [f64; 2] = [f64::INFINITY, 0.0];

/// Half-width or radius of the contact, and radius of the round body (mm).
const A: f64 = 2.0;

const R: f64 = 100.0;

const POLYMER: &str = r#"
units = "mm-N-MPa"
[material.polymer]
model = "linear-elastic"
E = 1000.0
nu = 0.3
"#;

const P0: &str = "largest pressure";

const WIDTH: &str = "half-width of contact";

const RADIUS: &str = "radius of contact";

const WHY_WIDTH: &str = "nodes are in contact or not: a cell, on 8 cells";

const WHY_FORCE: &str = "equilibrium, to the tolerance of Newton's method";

/// The round lower side of a block that reaches up to `top`.
fn bulged(x: f64, y: f64, top: f64) -> f64 {
    // a parabola, and its tangent far from the contact
    let near = x.abs().min(20.0 * A);
    let low = near * near / (2.0 * R) + (x.abs() - near) * near / R;
    low + (top - low) * y / top
}

/// Two rectangles, the upper one with a round lower side.
fn two_bodies(kind: &'static str, cells: [f64; 2], end: f64, ratio: f64, half: bool) -> Grid {
    let mut grid = Grid::plane();
    let axes = |n: f64| {
        let x = graded(A / n, (1.3 * n).ceil() as usize, ratio, end);
        let y = graded(A / n, (1.1 * n).ceil() as usize, ratio, end);
        (x, y)
    };
    let whole = |x: Vec<f64>| match half {
        true => x,
        false => [mirrored(&x), x.get(1..).unwrap_or(&[]).to_vec()].concat(),
    };
    let (x, y) = axes(cells[0]);
    grid.mapped(&Lines {
        name: "upper",
        kind,
        axes: &[whole(x), y],
        map: &|[x, y, z]| [x, bulged(x, y, end), z],
    });
    let (x, y) = axes(cells[1]);
    grid.block("lower", kind, &[whole(x), mirrored(&y)]);
    grid.set("symmetry", "{ plane = \"x\", at = 0.0 }");
    grid
}

const TWO_BODIES: &str = r#"
[model]
space = $space

[[body]]
group = ["upper", "lower"]
material = "polymer"

[[contact]]
name = "line"
secondary = "upper_bottom"
primary = "lower_top"
@METHOD

[[step]]
name = "press"
geometry = "linear"
increments = 2

  [[step.fix]]
  on = "lower_bottom"
  u = ["y"]

  [[step.fix]]
  on = "symmetry"
  u = ["x"]

  [[step.load]]
  on = "upper_top"
  force = [0.0, $load]
  coupling = "rigid-y"
"#;

fn hertz_cylinder(method: &str, cells: [f64; 2], part: f64) -> Setup {
    let modulus = contact_modulus([MATERIAL; 2]);
    let hertz = hertz_line(A, R, modulus);
    let mut grid = two_bodies("quad4", cells, 160.0 * A, 1.3, true);
    let (node, [_, y, _]) = grid.nearest([0.0, -0.786 * A, 0.0]);
    let [along, across] = hertz_line_axis(A, hertz.p0, -y);
    grid.set("below", format!("{{ nodes = [{node}] }}"));
    grid.set("middle", "{ near = [0.0, 0.0], of = \"upper\" }");
    let case = fill(
        TWO_BODIES,
        &[("space", &"plane-strain"), ("load", &(-0.5 * hertz.load))],
    );
    Setup {
        mesh: grid,
        case: format!("{POLYMER}{}", case.replace("@METHOD", method)),
        checks: vec![
            Check::exact(
                P0,
                "contact_pressure @ set middle",
                hertz.p0,
                part,
                "discretization on 8 cells",
            ),
            Check::exact(WIDTH, "line.area_slip", A, 0.125, WHY_WIDTH),
            Check::exact(
                "force on half of it",
                "line.force_y",
                0.5 * hertz.load,
                1e-6,
                WHY_FORCE,
            ),
            Check::exact(
                "largest shear below",
                "stress.xx @ set below",
                0.5 * (along - across),
                0.02,
                "stress at nodes is the mean of the cells around",
            )
            .and("stress.yy @ set below", |s| 0.5 * (s[0] - s[1])),
        ],
    }
}

fn hertz_quadratic() -> Setup {
    let hertz = hertz_line(A, R, contact_modulus([MATERIAL; 2]));
    let case = fill(
        TWO_BODIES,
        &[("space", &"plane-strain"), ("load", &(-0.5 * hertz.load))],
    );
    Setup {
        mesh: two_bodies("quad8", [4.0, 3.25], 40.0 * A, 1.4, true),
        case: format!(
            "{POLYMER}{}",
            case.replace("@METHOD", "method = \"mortar\"")
        ),
        checks: vec![
            Check::exact(
                P0,
                "line.pressure_max",
                hertz.p0,
                0.02,
                "discretization on 4 cells",
            ),
            Check::exact(
                "force on half of it",
                "line.force_y",
                0.5 * hertz.load,
                1e-6,
                WHY_FORCE,
            ),
        ],
    }
}

fn sphere_axisymmetric() -> Setup {
    let hertz = hertz_point(A, R, contact_modulus([MATERIAL; 2]));
    let case = fill(
        TWO_BODIES,
        &[("space", &"axisymmetric"), ("load", &(-hertz.load))],
    );
    Setup {
        mesh: two_bodies("quad4", [12.0, 9.5], 40.0 * A, 1.3, true),
        case: format!(
            "{POLYMER}{}",
            case.replace("@METHOD", "method = \"mortar\"")
        ),
        checks: vec![
            Check::exact(
                P0,
                "line.pressure_max",
                hertz.p0,
                0.015,
                "discretization on 12 cells",
            ),
            Check::exact(
                RADIUS,
                "line.area_slip",
                A,
                0.09,
                "nodes are in contact or not: a cell, on 12 cells",
            )
            .by(|area| (area[0] / PI).sqrt()),
            Check::exact("force", "line.force_y", hertz.load, 1e-6, WHY_FORCE),
        ],
    }
}

/// One block below an analytical surface that a load moves.
const UNDER_SURFACE: &str = r#"
[model]
space = $space

[[body]]
group = "block"
material = "polymer"

[reference.pilot]
at = [0.0, $UP]

[[surface]]
name = "tool"
shape = @SHAPE
reference = "pilot"

[[contact]]
name = "line"
secondary = "block_top"
primary = "tool"

[[step]]
name = "press"
geometry = "linear"
increments = 2

  [[step.fix]]
  on = "block_bottom"
  u = ["y"]

  [[step.fix]]
  on = "symmetry"
  u = ["x"]

  [[step.load]]
  on = "pilot"
  force = [0.0, $load, 0.0]
"#;

fn rigid_circle() -> Setup {
    let hertz = hertz_line(A, R, contact_modulus([MATERIAL, RIGID]));
    let mut grid = Grid::plane();
    let axes = [
        graded(A / 8.0, 11, 1.25, 80.0),
        graded(A / 8.0, 6, 1.25, 80.0),
    ];
    grid.block("block", "quad4", &[axes[0].clone(), mirrored(&axes[1])]);
    grid.set("symmetry", "{ plane = \"x\", at = 0.0 }");
    let names: [(&str, &dyn std::fmt::Debug); 3] = [
        ("space", &"plane-strain"),
        ("UP", &R),
        ("load", &(-0.5 * hertz.load)),
    ];
    let shape = format!("{{ circle = {{ center = [0.0, {R:?}], radius = {R:?} }} }}");
    Setup {
        mesh: grid,
        case: format!(
            "{POLYMER}{}",
            fill(UNDER_SURFACE, &names).replace("@SHAPE", &shape)
        ),
        checks: vec![
            Check::exact(
                P0,
                "line.pressure_max",
                hertz.p0,
                0.015,
                "discretization on 8 cells",
            ),
            Check::exact(WIDTH, "line.area_slip", A, 0.125, WHY_WIDTH),
            Check::exact(
                "force on half of it",
                "line.force_y",
                -0.5 * hertz.load,
                1e-6,
                WHY_FORCE,
            ),
        ],
    }
}

fn rigid_cylinder() -> Setup {
    let hertz = hertz_line(A, R, contact_modulus([MATERIAL, RIGID]));
    let mut grid = Grid::space();
    let axes = [
        graded(A / 8.0, 11, 1.3, 80.0),
        graded(A / 8.0, 6, 1.3, 80.0),
    ];
    let z = even(0.0, 1.0, 1);
    grid.block("block", "hex8", &[axes[0].clone(), mirrored(&axes[1]), z]);
    grid.set("symmetry", "{ plane = \"x\", at = 0.0 }");
    let shape =
        format!("{{ cylinder = {{ point = [0.0, {R:?}, 0.0], axis = \"z\", radius = {R:?} }} }}");
    let names: [(&str, &dyn std::fmt::Debug); 3] =
        [("space", &"3d"), ("UP", &R), ("load", &(-0.5 * hertz.load))];
    let case = fill(UNDER_SURFACE, &names)
        .replace("@SHAPE", &shape)
        .replace(
            &format!("at = [0.0, {R:?}]"),
            &format!("at = [0.0, {R:?}, 0.0]"),
        );
    let flat = "\n  [[step.fix]]\n  on = \"block\"\n  u = [\"z\"]\n";
    Setup {
        mesh: grid,
        case: format!("{POLYMER}{case}{flat}"),
        checks: vec![
            Check::exact(
                P0,
                "line.pressure_max",
                hertz.p0,
                0.015,
                "discretization on 8 cells",
            ),
            Check::exact(
                "force on half of it",
                "line.force_y",
                -0.5 * hertz.load,
                1e-6,
                WHY_FORCE,
            ),
        ],
    }
}

/// A quarter of a block, whose top or bottom is round where a map says so.
fn quarter(
    [name, kind]: [&'static str; 2],
    n: f64,
    up: f64,
    map: &dyn Fn(Point) -> Point,
    grid: &mut Grid,
) {
    let flat = graded(A / n, n as usize + 1, 1.55, 12.0 * A);
    let deep = graded(A / n, (0.6 * n) as usize + 1, 1.6, 12.0 * A);
    let z = if up > 0.0 { deep } else { mirrored(&deep) };
    grid.mapped(&Lines {
        name,
        kind,
        axes: &[flat.clone(), flat, z],
        map,
    });
}

const QUARTER: &str = r#"
[[step]]
name = "press"
geometry = "linear"
increments = 1

  [[step.fix]]
  on = "lower_back"
  u = ["z"]

  [[step.fix]]
  on = "symmetry_x"
  u = ["x"]

  [[step.fix]]
  on = "symmetry_y"
  u = ["y"]
"#;

fn symmetries(grid: &mut Grid) {
    grid.set("symmetry_x", "{ plane = \"x\", at = 0.0 }");
    grid.set("symmetry_y", "{ plane = \"y\", at = 0.0 }");
}

fn sphere_in_space() -> Setup {
    let hertz = hertz_point(A, R, contact_modulus([MATERIAL; 2]));
    let mut grid = Grid::space();
    let round = |[x, y, z]: Point| [x, y, bulged(x.hypot(y), z, 12.0 * A)];
    quarter(["upper", "hex8"], 5.0, 1.0, &round, &mut grid);
    quarter(["lower", "hex8"], 4.0, -1.0, &|p| p, &mut grid);
    symmetries(&mut grid);
    let load = -0.25 * hertz.load;
    let case = format!(
        r#"{POLYMER}
[[body]]
group = ["upper", "lower"]
material = "polymer"

[[contact]]
name = "ball"
secondary = "upper_back"
primary = "lower_front"
method = "mortar"
{QUARTER}
  [[step.load]]
  on = "upper_front"
  force = [0.0, 0.0, {load:?}]
  coupling = "rigid-z"
"#
    );
    Setup {
        mesh: grid,
        case,
        checks: vec![
            Check::exact(
                P0,
                "ball.pressure_max",
                hertz.p0,
                0.03,
                "discretization on 5 cells",
            ),
            Check::exact("force on a quarter", "ball.force_z", -load, 1e-6, WHY_FORCE),
        ],
    }
}

fn rigid_sphere(kind: &'static str, n: f64, part: f64) -> Setup {
    let hertz = hertz_point(A, R, contact_modulus([MATERIAL, RIGID]));
    let mut grid = Grid::space();
    quarter(["lower", kind], n, -1.0, &|p| p, &mut grid);
    symmetries(&mut grid);
    let load = -0.25 * hertz.load;
    let case = format!(
        r#"{POLYMER}
[[body]]
group = "lower"
material = "polymer"

[reference.pilot]
at = [0.0, 0.0, {R:?}]

[[surface]]
name = "tool"
shape = {{ sphere = {{ center = [0.0, 0.0, {R:?}], radius = {R:?} }} }}
reference = "pilot"

[[contact]]
name = "ball"
secondary = "lower_front"
primary = "tool"
{QUARTER}
  [[step.load]]
  on = "pilot"
  force = [0.0, 0.0, {load:?}]
"#
    );
    Setup {
        mesh: grid,
        case,
        checks: vec![
            Check::exact(
                P0,
                "ball.pressure_max",
                hertz.p0,
                part,
                "discretization of the radius of contact",
            ),
            Check::exact("force on a quarter", "ball.force_z", load, 1e-6, WHY_FORCE),
        ],
    }
}

fn cattaneo_mindlin() -> Setup {
    let (mu, modulus) = (0.3, contact_modulus([MATERIAL; 2]));
    let hertz = hertz_line(A, R, modulus);
    let pull = 0.6 * mu * hertz.load;
    let c = A * (1.0 - pull / (mu * hertz.load)).sqrt();
    let case = format!(
        r#"{POLYMER}
[model]
space = "plane-strain"

[[body]]
group = ["upper", "lower"]
material = "polymer"

[[contact]]
name = "line"
secondary = "upper_bottom"
primary = "lower_top"
method = "mortar"
friction = {mu:?}

[[step]]
name = "press"
geometry = "linear"
increments = {{ fixed = 8 }}

  [[step.fix]]
  on = "lower_bottom"
  u = "all"

  [[step.load]]
  on = "upper_top"
  force = [0.0, {:?}]
  coupling = "rigid-y"

  [[step.load]]
  name = "pull"
  on = "upper_top"
  force = [0.0, 0.0]
  coupling = "rigid-x"

[[step]]
name = "shear"
increments = {{ fixed = 4 }}

  [[step.load]]
  name = "pull"
  on = "upper_top"
  force = [{pull:?}, 0.0]
"#,
        -hertz.load
    );
    Setup {
        mesh: two_bodies("quad4", [16.0, 13.0], 20.0 * A, 1.5, false),
        case,
        checks: vec![
            Check::exact(
                P0,
                "line.pressure_max",
                hertz.p0,
                0.02,
                "discretization on 10 cells",
            ),
            Check::exact("shear force", "line.force_x", -pull, 1e-5, WHY_FORCE),
            Check::exact(
                "half-width of stick",
                "line.area_stick",
                c,
                0.12,
                "nodes stick or slip: a cell, on 8 cells",
            )
            .by(|area| 0.5 * area[0]),
            Check::exact(
                "work of friction",
                "line.work_friction",
                cattaneo_work(A, c, hertz.p0, mu, modulus),
                0.05,
                "slip zones of two cells",
            ),
        ],
    }
}

fn groove() -> Setup {
    let wide = 150.0;
    let hertz = hertz_line(
        A,
        1.0 / (1.0 / R - 1.0 / wide),
        contact_modulus([MATERIAL, RIGID]),
    );
    let mut grid = Grid::plane();
    let axes = [
        graded(A / 8.0, 11, 1.25, 80.0),
        graded(A / 8.0, 9, 1.25, 80.0),
    ];
    grid.mapped(&Lines {
        name: "block",
        kind: "quad4",
        axes: &axes,
        map: &|[x, y, z]| [x, bulged(x, y, 80.0), z],
    });
    grid.set("symmetry", "{ plane = \"x\", at = 0.0 }");
    let case = format!(
        r#"{POLYMER}
[model]
space = "plane-strain"

[[body]]
group = "block"
material = "polymer"

[[surface]]
name = "groove"
shape = {{ circle = {{ center = [0.0, {wide:?}], radius = {wide:?}, side = "inside" }} }}

[[contact]]
name = "line"
secondary = "block_bottom"
primary = "groove"

[[step]]
name = "press"
geometry = "linear"
increments = 2

  [[step.fix]]
  on = "symmetry"
  u = ["x"]

  [[step.load]]
  on = "block_top"
  force = [0.0, {:?}]
  coupling = "rigid-y"
"#,
        -0.5 * hertz.load
    );
    Setup {
        mesh: grid,
        case,
        checks: vec![
            Check::exact(
                P0,
                "line.pressure_max",
                hertz.p0,
                0.015,
                "discretization on 8 cells, and a parabola next to a circle",
            ),
            Check::exact(
                "force on half of it",
                "line.force_y",
                0.5 * hertz.load,
                1e-6,
                WHY_FORCE,
            ),
        ],
    }
}
