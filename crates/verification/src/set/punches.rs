//! Rigid punches, and a pin in its hole: loads are prescribed, as in `hertz.rs`.

use crate::forms::{contact_modulus, persson};
use crate::mesh::{Grid, Lines, Point, even, graded, mirrored};
use crate::problem::{Check, Problem, Setup};
use std::f64::consts::PI;

/// The problems of this file.
pub(super) const PROBLEMS: [Problem; 5] = [
    Problem {
        name: "flat-punch-2d",
        title: "A rigid flat punch on a block, plane",
        source: "K. L. Johnson, Contact Mechanics (1985), equation 2.64",
        goal: "the pressure below a rigid body with a sharp edge",
        mesh: "32 cells on the half-width, graded outwards to 40 half-widths",
        conditions: "plane strain, symmetry at x = 0; the base is held along y, the load acts on the punch",
        formula: "$p(x) = P/(\\pi\\sqrt{a^2 - x^2})$",
        quick: true,
        pose: || flat_punch(false),
    },
    Problem {
        name: "flat-punch-axisymmetric",
        title: "A rigid flat punch on a block, axisymmetric",
        source: "Boussinesq 1885; K. L. Johnson, Contact Mechanics (1985), equation 3.34",
        goal: "the pressure below a rigid round punch",
        mesh: "32 cells on the radius, graded outwards to 40 radii",
        conditions: "the axis is held along r, the base along the axis; the load acts on the punch",
        formula: "$p(r) = F/(2\\pi a\\sqrt{a^2 - r^2})$",
        quick: true,
        pose: || flat_punch(true),
    },
    Problem {
        name: "persson-pin",
        title: "Persson: a pin in a hole of nearly its size",
        source: "A. Persson, On the Stress Distribution of Cylindrical Elastic Bodies in Contact (Chalmers 1964); closed form: Ciavarella and Decuzzi, Int. J. Solids Struct. 38 (2001) 4507",
        goal: "conforming contact, where Hertz does not hold: the half-angle of contact is 60 degrees",
        mesh: "quad8 in polar rows, 1.25 degrees at the contact; the plate reaches 20 radii",
        conditions: "plane strain, symmetry at x = 0; the outside of the plate is held, the load acts on a small core of the pin",
        formula: "$\\frac{E_1^*\\Delta R}{Q} = \\frac{2}{\\pi}\\frac{1 - b^2}{b^2} - \\frac{I_b}{\\pi^2 b^2(1 + b^2)}$, $I_b = \\int_{-b}^b \\ln\\frac{\\sqrt{b^2+1}+\\sqrt{b^2-t^2}}{\\sqrt{b^2+1}-\\sqrt{b^2-t^2}}\\frac{dt}{1+t^2}$, $b = \\tan(\\varepsilon/2)$; $p_0 R/Q = \\frac{2b}{\\pi\\sqrt{b^2+1}} + \\frac{1}{2\\pi b^2(1+b^2)}\\ln\\frac{\\sqrt{b^2+1}+b}{\\sqrt{b^2+1}-b}$",
        quick: false,
        pose: persson_pin,
    },
    Problem {
        name: "wedge-punch-2d",
        title: "A rigid blunt wedge on a block",
        source: "K. L. Johnson, Contact Mechanics (1985), section 5.2",
        goal: "a pressure that is infinite at a tip",
        mesh: "32 cells on the half-width, graded outwards to 40 half-widths",
        conditions: "plane strain, symmetry at x = 0; the base is held along y, the load acts on the wedge; slope 2 degrees",
        formula: "$a = P/(E^*\\tan\\beta)$, $p(x) = \\frac{E^*\\tan\\beta}{\\pi}\\operatorname{arcosh}(a/x)$",
        quick: true,
        pose: || blunt_punch(false),
    },
    Problem {
        name: "cone-punch-axisymmetric",
        title: "A rigid blunt cone on a block",
        source: "A. E. H. Love 1939; I. N. Sneddon 1948; K. L. Johnson, Contact Mechanics (1985), section 5.2",
        goal: "a pressure that is infinite at a tip",
        mesh: "32 cells on the radius, graded outwards to 40 radii",
        conditions: "the axis is held along r, the base along the axis; the load acts on the cone; slope 2 degrees",
        formula: "$F = \\tfrac{\\pi}{2} a^2 E^*\\tan\\beta$, $p(r) = \\tfrac12 E^*\\tan\\beta\\operatorname{arcosh}(a/r)$",
        quick: true,
        pose: || blunt_punch(true),
    },
];

/// Modulus and Poisson's ratio of all bodies here (MPa).
const MATERIAL: [f64; 2] = [1000.0, 0.3];

/// Half-width or radius of the contact (mm).
const A: f64 = 2.0;

const POLYMER: &str = r#"
units = "mm-N-MPa"
[material.polymer]
model = "linear-elastic"
E = 1000.0
nu = 0.3
"#;

const P0: &str = "largest pressure";

const WHY_FORCE: &str = "equilibrium, to the tolerance of Newton's method";

fn flat_punch(is_round: bool) -> Setup {
    let mut grid = Grid::plane();
    let y = graded(A / 32.0, 8, 1.25, 40.0 * A);
    let x = graded(A / 32.0, 32, 1.2, 40.0 * A);
    grid.block("block", "quad4", &[x, mirrored(&y)]);
    grid.block("punch", "quad4", &[even(0.0, A, 1), even(0.0, A, 1)]);
    grid.set("symmetry", "{ plane = \"x\", at = 0.0, of = \"block\" }");
    grid.set("middle", "{ near = [0.0, 0.0], of = \"block\" }");
    let place = A / 2.0;
    grid.set(
        "halfway",
        format!("{{ near = [{place:?}, 0.0], of = \"block\" }}"),
    );
    let load: f64 = 10.0;
    let pressure = |x: f64| {
        let width = (A * A - x * x).sqrt();
        match is_round {
            true => load / (2.0 * PI * A * width),
            // the load is that of half of the punch
            false => 2.0 * load / (PI * width),
        }
    };
    let space = if is_round {
        "axisymmetric"
    } else {
        "plane-strain"
    };
    let case = format!(
        r#"{POLYMER}
[model]
space = "{space}"

[[body]]
group = "block"
material = "polymer"

[[body]]
group = "punch"
rigid = true

[[contact]]
name = "face"
secondary = "block_top"
primary = "punch_bottom"
method = "mortar"

[[step]]
name = "press"
geometry = "linear"
increments = 1

  [[step.fix]]
  on = "block_bottom"
  u = ["y"]

  [[step.fix]]
  on = "symmetry"
  u = ["x"]

  [[step.load]]
  on = "punch"
  force = [0.0, {:?}]
"#,
        -load
    );
    let why = "discretization on 32 cells, with a pressure that is infinite at the edge";
    Setup {
        mesh: grid,
        case,
        checks: vec![
            Check::exact(
                "pressure in the middle",
                "contact_pressure @ set middle",
                pressure(0.0),
                0.02,
                why,
            ),
            Check::exact(
                "pressure halfway",
                "contact_pressure @ set halfway",
                pressure(place),
                0.02,
                why,
            ),
            Check::exact("force", "face.force_y", -load, 1e-6, WHY_FORCE),
        ],
    }
}

fn persson_pin() -> Setup {
    let (radius, b) = (10.0, (PI / 6.0).tan());
    let load = 1.0;
    let [young, nu] = MATERIAL;
    let [clearance, p0] = persson(b);
    let gap = clearance * load * (1.0 - nu * nu) / young;
    let fine = graded(0.25 * radius * 5.0_f64.to_radians(), 3, 1.3, 0.9 * radius);
    let angles = [even(0.0, 75.0, 60), even(75.0, 180.0, 14).split_off(1)].concat();
    let other = [even(0.0, 78.0, 52), even(78.0, 180.0, 12).split_off(1)].concat();
    let polar = |[r, turn, z]: Point, up: f64| {
        // from the lowest point of the pin upwards
        let angle = (turn - 90.0).to_radians();
        [r * angle.cos(), r * angle.sin() + up, z]
    };
    let mut grid = Grid::plane();
    let inwards = fine.iter().rev().map(|x| radius - x).collect();
    // the pin starts where it touches the hole
    grid.mapped(&Lines {
        name: "pin",
        kind: "quad8",
        axes: &[inwards, angles],
        map: &|p| polar(p, -gap),
    });
    let outwards = graded(0.25 * radius * 5.0_f64.to_radians(), 3, 1.3, 19.0 * radius);
    grid.mapped(&Lines {
        name: "plate",
        kind: "quad8",
        axes: &[outwards.iter().map(|x| radius + gap + x).collect(), other],
        map: &|p| polar(p, 0.0),
    });
    grid.set("symmetry", "{ plane = \"x\", at = 0.0, tol = 1e-6 }");
    let case = format!(
        r#"{POLYMER}
[model]
space = "plane-strain"

[[body]]
group = ["pin", "plate"]
material = "polymer"

[[contact]]
name = "bore"
secondary = "pin_right"
primary = "plate_left"
method = "mortar"

[[step]]
name = "press"
geometry = "linear"
increments = 2

  [[step.fix]]
  on = "plate_right"
  u = "all"

  [[step.fix]]
  on = "symmetry"
  u = ["x"]

  [[step.load]]
  on = "pin_left"
  force = [0.0, {:?}]
  coupling = "rigid-y"
"#,
        -0.5 * load
    );
    Setup {
        mesh: grid,
        case,
        checks: vec![
            Check::exact(
                P0,
                "bore.pressure_max",
                p0 * load / radius,
                0.02,
                "the plate ends at 20 radii, and the load acts on a core instead of a point",
            ),
            Check::exact(
                "half-angle (degree)",
                "bore.area_slip",
                60.0,
                0.04,
                "nodes are in contact or not: a cell of 1.25 degrees on either side",
            )
            .by(|area| (area[0] / 10.0).to_degrees()),
        ],
    }
}

/// Of blunt punches, in degrees.
const BLUNT: f64 = 2.0;

fn blunt_punch(is_round: bool) -> Setup {
    let mut setup = flat_punch(is_round);
    let tan = BLUNT.to_radians().tan();
    let modulus = contact_modulus([MATERIAL, [f64::INFINITY, 0.0]]);
    let (load, pressure) = match is_round {
        true => (0.5 * PI * A * A * modulus * tan, 0.5 * modulus * tan),
        // on half of it
        false => (0.5 * A * modulus * tan, modulus * tan / PI),
    };
    let mut grid = Grid::plane();
    let y = graded(A / 32.0, 8, 1.25, 40.0 * A);
    let x = graded(A / 32.0, 40, 1.2, 40.0 * A);
    grid.block("block", "quad4", &[x, mirrored(&y)]);
    grid.mapped(&Lines {
        name: "punch",
        kind: "quad4",
        axes: &[even(0.0, 2.0 * A, 1), even(0.0, A, 1)],
        map: &|[x, up, z]| [x, x * tan + up, z],
    });
    grid.set("symmetry", "{ plane = \"x\", at = 0.0, of = \"block\" }");
    let place = A / 2.0;
    grid.set(
        "halfway",
        format!("{{ near = [{place:?}, 0.0], of = \"block\" }}"),
    );
    setup.mesh = grid;
    setup.case = setup
        .case
        .replace("[0.0, -10.0]", &format!("[0.0, {:?}]", -load));
    let width = Check::exact(
        "extent of contact",
        "face.area_slip",
        A,
        0.04,
        "nodes are in contact or not: a cell, on 32 cells",
    );
    setup.checks = vec![
        Check::exact(
            "pressure halfway",
            "contact_pressure @ set halfway",
            pressure * 2.0_f64.acosh(),
            0.02,
            "discretization on 32 cells, with a pressure that is infinite at the tip",
        ),
        match is_round {
            true => width.by(|area| (area[0] / PI).sqrt()),
            false => width,
        },
    ];
    setup
}
