//! Bodies without contact, but for a gap that closes: beams, large strain, plastic flow, heat, rotation.

use crate::forms::{Kirchhoff, elastica, neo_hookean, ogden, uniaxial};
use crate::mesh::{Grid, Lines, even};
use crate::problem::{Check, Kind, Problem, Setup};
use std::f64::consts::{FRAC_PI_2, PI};

/// The problems of this file.
pub(super) const PROBLEMS: [Problem; 14] = [
    Problem {
        name: "cook-membrane",
        title: "Cook's membrane",
        source: "R. D. Cook, J. Struct. Div. ASCE 100 (1974) 1851; converged value 23.96: Hughes, The Finite Element Method (1987), and many after",
        goal: "skew cells in bending and shear",
        mesh: "16 by 16 quad8",
        conditions: "plane stress, E = 1, ν = 1/3; the left side is clamped, a force of 1 acts along the right one",
        formula: "no closed form; the converged deflection in the middle of the right side",
        quick: true,
        pose: cook,
    },
    Problem {
        name: "cantilever-2d",
        title: "A cantilever with a force at its end, plane stress",
        source: "Timoshenko and Gere, Mechanics of Materials; shear coefficient 5/6",
        goal: "bending of linear quadrilaterals without locking",
        mesh: "40 by 4 quad4",
        conditions: "plane stress, length 20, height 1; one end is clamped, a force acts along the other one",
        formula: "$w = \\frac{PL^3}{3EI} + \\frac{PL}{\\kappa G A}$, $\\kappa = 5/6$",
        quick: true,
        pose: cantilever,
    },
    Problem {
        name: "cantilever-3d",
        title: "A cantilever with a force at its end, in space",
        source: "Timoshenko and Gere, Mechanics of Materials; shear coefficient 5/6",
        goal: "bending of quadratic hexahedra",
        mesh: "10 by 1 by 1 hex20",
        conditions: "length 20, section 1 by 1, ν = 0, so that the clamp does not keep the section from contracting; one end is clamped, a force acts along the other one",
        formula: "$w = \\frac{PL^3}{3EI} + \\frac{PL}{\\kappa G A}$, $\\kappa = 5/6$",
        quick: true,
        pose: cantilever_in_space,
    },
    Problem {
        name: "elastica",
        title: "The elastica: a slender cantilever, bent far",
        source: "Bisshopp and Drucker, Q. Appl. Math. 3 (1945) 272; tables: Mattiasson, Int. J. Numer. Meth. Engng 17 (1981) 145",
        goal: "large rotation at small strain",
        mesh: "40 by 1 quad8",
        conditions: "plane stress, ν = 0, length 100, height 1; one end is clamped, a force that keeps its direction acts on the other one; P L²/(E I) = 5",
        formula: "$EI\\,\\theta'' = -P\\cos\\theta$, $\\theta(0) = 0$, $\\theta'(L) = 0$, integrated by Runge and Kutta",
        quick: true,
        pose: bent_far,
    },
    Problem {
        name: "rolled-beam",
        title: "A beam that is bent to a half circle by its end",
        source: "Euler: constant curvature under a moment",
        goal: "a prescribed rotation that a kinematic coupling carries into a body, at large rotation",
        mesh: "40 by 1 quad8",
        conditions: "plane stress, ν = 0, length 100, height 1; one end is clamped, the other one is coupled to a reference that turns by π",
        formula: "$M = EI\\theta/L$; the end lies at $x = L\\sin\\theta/\\theta$, $y = L(1 - \\cos\\theta)/\\theta$",
        quick: true,
        pose: rolled,
    },
    Problem {
        name: "uniaxial-neo-hookean",
        title: "A neo-Hookean cube is stretched and compressed",
        source: "Bonet and Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, section 6.4.3",
        goal: "stress and contraction at large strain",
        mesh: "one hex8",
        conditions: "three planes of symmetry; the stretch goes to 2, then to 0.5",
        formula: "$\\tau_i = \\mu(\\lambda_i^2 - 1) + \\lambda\\ln J$; the lateral stretch solves $\\tau_2 = 0$",
        quick: true,
        pose: || {
            let text = "model = \"neo-hookean\"\nE = 2.6\nnu = 0.3";
            stretched(text, &|l| neo_hookean(1.0, 1.5, l))
        },
    },
    Problem {
        name: "uniaxial-mooney-rivlin",
        title: "A cube of Mooney and Rivlin's law is stretched and compressed",
        source: "Rivlin 1948; Holzapfel, Nonlinear Solid Mechanics, section 6.5",
        goal: "stress and contraction at large strain",
        mesh: "one hex8",
        conditions: "three planes of symmetry; the stretch goes to 2, then to 0.5",
        formula: "$W = c_{10}(\\bar I_1 - 3) + c_{01}(\\bar I_2 - 3) + \\tfrac K2 (J-1)^2$; the lateral stretch solves $\\tau_2 = 0$",
        quick: true,
        pose: || {
            let text = "model = \"mooney-rivlin\"\nc10 = 0.4\nc01 = 0.1\nbulk = 20.0";
            stretched(text, &|l| ogden(&[[0.8, 2.0], [0.2, -2.0]], 20.0, l))
        },
    },
    Problem {
        name: "uniaxial-ogden",
        title: "A cube of Ogden's law is stretched and compressed",
        source: "R. W. Ogden, Proc. R. Soc. Lond. A 328 (1972) 567",
        goal: "stress and contraction at large strain",
        mesh: "one hex8",
        conditions: "three planes of symmetry; the stretch goes to 2, then to 0.5",
        formula: "$W = \\sum_p \\frac{2\\mu_p}{\\alpha_p^2}(\\bar\\lambda_1^{\\alpha_p} + \\bar\\lambda_2^{\\alpha_p} + \\bar\\lambda_3^{\\alpha_p} - 3) + \\tfrac K2 (J-1)^2$; the lateral stretch solves $\\tau_2 = 0$",
        quick: true,
        pose: || {
            let text = "model = \"ogden\"\nmu = [0.6, -0.1]\nalpha = [1.3, -2.0]\nbulk = 20.0";
            stretched(text, &|l| ogden(&[[0.6, 1.3], [-0.1, -2.0]], 20.0, l))
        },
    },
    Problem {
        name: "plastic-bar-isotropic",
        title: "A bar yields, is unloaded and yields again: isotropic hardening",
        source: "R. Hill, The Mathematical Theory of Plasticity (1950), chapter II",
        goal: "uniaxial flow, elastic unloading and a grown yield surface",
        mesh: "one hex8",
        conditions: "uniaxial stress; the strain goes to 0.01, then back to 0.004",
        formula: "$\\sigma = (Y + H\\varepsilon)/(1 + H/E)$, then $-(Y + H\\bar\\varepsilon_p)$ after reversal, $H = E/100$",
        quick: true,
        pose: || plastic_bar("isotropic"),
    },
    Problem {
        name: "plastic-bar-kinematic",
        title: "A bar yields, is unloaded and yields again: kinematic hardening",
        source: "W. Prager, 1955; R. Hill, The Mathematical Theory of Plasticity (1950), chapter II",
        goal: "the Bauschinger effect",
        mesh: "one hex8",
        conditions: "uniaxial stress; the strain goes to 0.01, then back to 0.004",
        formula: "$\\sigma = (Y + H\\varepsilon)/(1 + H/E)$, then $\\sigma = (-Y + H\\varepsilon)/(1 + H/E)$ after reversal, $H = E/100$",
        quick: true,
        pose: || plastic_bar("kinematic"),
    },
    Problem {
        name: "thermal-bars",
        title: "A bar that may expand, and one that may not",
        source: "Timoshenko and Goodier, Theory of Elasticity, section 148",
        goal: "thermal strain, free and constrained",
        mesh: "two bars of 4 hex8",
        conditions: "uniaxial stress; both are heated by 80 K, one between rigid ends",
        formula: "$u = \\alpha\\,\\Delta T\\, L$; $\\sigma = -E\\alpha\\,\\Delta T$",
        quick: true,
        pose: thermal_bars,
    },
    Problem {
        name: "rotating-disc",
        title: "A disc with a hole, rotating",
        source: "Timoshenko and Goodier, Theory of Elasticity, section 32",
        goal: "centrifugal forces",
        mesh: "a quarter in plane stress, 8 by 8 quad8",
        conditions: "symmetry at x = 0 and y = 0; angular velocity 1000 rad/s",
        formula: "$\\sigma_\\theta(a) = \\frac{3+\\nu}{4}\\rho\\omega^2\\left(b^2 + \\frac{1-\\nu}{3+\\nu}a^2\\right)$, $u(a) = a\\,\\sigma_\\theta(a)/E$",
        quick: true,
        pose: rotating_disc,
    },
    Problem {
        name: "turned-block",
        title: "A block is turned by a right angle",
        source: "frame indifference",
        goal: "a rigid motion leaves no stress",
        mesh: "2 by 2 by 2 hex8",
        conditions: "one side is coupled to a reference that turns by π/2 about z in four increments; nothing else acts",
        formula: "$x = Q X$, $\\sigma = 0$",
        quick: true,
        pose: turned_block,
    },
    Problem {
        name: "lever",
        title: "Two bars coupled by an equation",
        source: "statics: virtual work of a lever",
        goal: "a linear equation between displacements, and its forces",
        mesh: "two bars (line2)",
        conditions: "$u_2 = 2u_1$; a force F acts on the first bar",
        formula: "$u_1 = F/(k_1 + 4k_2)$, $u_2 = 2u_1$, reaction of the second bar $-k_2 u_2$",
        quick: true,
        pose: lever,
    },
];

const UNITS: &str = "units = \"mm-N-MPa\"\n";

fn elastic(e: f64, nu: f64, more: &str) -> String {
    format!("{UNITS}[material.metal]\nmodel = \"linear-elastic\"\nE = {e:?}\nnu = {nu:?}\n{more}\n[[body]]\ngroup = \"body\"\nmaterial = \"metal\"\n")
}

fn cook() -> Setup {
    let mut grid = Grid::plane();
    grid.mapped(&Lines {
        name: "body",
        kind: "quad8",
        axes: &[even(0.0, 48.0, 16), even(0.0, 1.0, 16)],
        map: &|[x, t, z]| {
            let (low, high) = (44.0 * x / 48.0, 44.0 + 16.0 * x / 48.0);
            [x, low + (high - low) * t, z]
        },
    });
    grid.set("corner", "{ near = [48.0, 52.0] }");
    let case = format!(
        r#"{}
[model]
space = "plane-stress"

[[step]]
name = "shear"
geometry = "linear"
increments = 1

  [[step.fix]]
  on = "body_left"
  u = "all"

  [[step.load]]
  on = "body_right"
  force = [0.0, 1.0]
"#,
        elastic(1.0, 1.0 / 3.0, "")
    );
    Setup {
        mesh: grid,
        case,
        checks: vec![
            Check::exact("middle of the end rises by", "displacement.y @ set corner", 23.96, 2e-3, "published to four digits; two singular corners")
                .of(Kind::Published),
        ],
    }
}

/// A beam along x of height and thickness 1, clamped on its left: text of its step.
fn clamped(geometry: &str, increments: usize, more: &str) -> String {
    format!(
        r#"
[[step]]
name = "bend"
geometry = "{geometry}"
increments = {{ fixed = {increments} }}

  [[step.fix]]
  on = "body_left"
  u = "all"
{more}"#
    )
}

const PLANE_STRESS: &str = "\n[model]\nspace = \"plane-stress\"\n";

/// Deflection of a clamped beam of section 1 by 1 under a force at its end, with shear.
fn timoshenko(load: f64, length: f64, e: f64, nu: f64) -> f64 {
    load * length.powi(3) * 12.0 / (3.0 * e) + load * length * 2.0 * (1.0 + nu) * 6.0 / (5.0 * e)
}

const WHY_BEAM: &str = "beam theory: the clamped end warps and contracts freely there, here it does not";

fn cantilever() -> Setup {
    let mut grid = Grid::plane();
    grid.block("body", "quad4", &[even(0.0, 20.0, 40), even(0.0, 1.0, 4)]);
    let load = "\n  [[step.load]]\n  on = \"body_right\"\n  force = [0.0, -1.0]\n";
    Setup {
        mesh: grid,
        case: format!("{}{PLANE_STRESS}{}", elastic(1e6, 0.3, ""), clamped("linear", 1, load)),
        checks: vec![
            Check::exact("the end sinks by", "displacement.y @ set body_right", -timoshenko(1.0, 20.0, 1e6, 0.3), 5e-3, WHY_BEAM),
            Check::exact("force at the clamp", "reaction_force.y @ set body_left", 1.0, 1e-8, "equilibrium"),
        ],
    }
}

fn cantilever_in_space() -> Setup {
    let mut grid = Grid::space();
    grid.block("body", "hex20", &[even(0.0, 20.0, 10), even(0.0, 1.0, 1), even(0.0, 1.0, 1)]);
    let load = "\n  [[step.load]]\n  on = \"body_right\"\n  force = [0.0, -1.0, 0.0]\n";
    Setup {
        mesh: grid,
        case: format!("{}{}", elastic(1e6, 0.0, ""), clamped("linear", 1, load)),
        checks: vec![
            Check::exact("the end sinks by", "displacement.y @ set body_right", -timoshenko(1.0, 20.0, 1e6, 0.0), 2e-3, "beam theory, whose shear coefficient is an approximation"),
            Check::exact("force at the clamp", "reaction_force.y @ set body_left", 1.0, 1e-8, "equilibrium"),
        ],
    }
}

fn slender() -> Grid {
    let mut grid = Grid::plane();
    grid.block("body", "quad8", &[even(0.0, 100.0, 40), even(-0.5, 0.5, 1)]);
    grid.set("end", "{ near = [100.0, 0.0] }");
    grid.set("middle_low", "{ near = [50.0, -0.5] }");
    grid
}

fn bent_far() -> Setup {
    const LOAD: f64 = 5.0;
    let (e, length) = (1.2e6, 100.0);
    let force = LOAD * e / 12.0 / (length * length);
    let [deflection, shortening] = elastica(LOAD);
    let load = format!("\n  [[step.load]]\n  on = \"body_right\"\n  force = [0.0, {force:?}]\n");
    let why = "the strain of the chord of a beam of 1/100, and 40 cells";
    Setup {
        mesh: slender(),
        case: format!("{}{PLANE_STRESS}{}", elastic(e, 0.0, ""), clamped("nonlinear", 10, &load)),
        checks: vec![
            Check::exact("deflection", "displacement.y @ set end", deflection * length, 3e-3, why),
            Check::exact("shortening", "displacement.x @ set end", -shortening * length, 3e-3, why),
        ],
    }
}

fn rolled() -> Setup {
    let (e, length) = (1.2e6, 100.0);
    let turn = format!("\n  [[step.move]]\n  on = \"hand\"\n  rz = {PI:?}\n");
    let coupling = "\n[reference.hand]\nat = [100.0, 0.0]\n\n[[constraint]]\nkind = \"kinematic\"\non = \"body_right\"\nreference = \"hand\"\n";
    let why = "straight ends of 40 cells of a circle, and the strain of a beam of 1/100";
    Setup {
        mesh: slender(),
        case: format!("{}{PLANE_STRESS}{coupling}{}", elastic(e, 0.0, ""), clamped("nonlinear", 20, &turn)),
        checks: vec![
            Check::exact("the end moves along x by", "displacement.x @ set end", -length, 3e-3, why),
            Check::exact("the end moves along y by", "displacement.y @ set end", 2.0 * length / PI, 3e-3, why),
            Check::exact(
                "bending stress in the middle",
                "von_mises @ set middle_low",
                e * PI / length * 0.5,
                0.03,
                "Green's strain of a beam bent to 1.6 % at its sides; stress is that of the turned section",
            ),
        ],
    }
}

/// Stretches of the cubes.
const LONG: f64 = 2.0;
const SHORT: f64 = 0.5;

fn cube() -> Grid {
    let mut grid = Grid::space();
    let one = || even(0.0, 1.0, 1);
    grid.block("body", "hex8", &[one(), one(), one()]);
    grid
}

const CUBE_HELD: &str = r#"
  [[step.fix]]
  on = "body_left"
  u = ["x"]

  [[step.fix]]
  on = "body_bottom"
  u = ["y"]

  [[step.fix]]
  on = "body_back"
  u = ["z"]
"#;

fn stretched(material: &str, law: Kirchhoff<'_>) -> Setup {
    let case = format!(
        r#"{UNITS}[material.rubber]
{material}

[[body]]
group = "body"
material = "rubber"

[solver]
newton = {{ force_tol = 1e-11 }}

[[step]]
name = "stretch"
geometry = "nonlinear"
increments = {{ fixed = 5 }}
{CUBE_HELD}
  [[step.move]]
  on = "body_right"
  ux = {:?}

[[step]]
name = "compress"
increments = {{ fixed = 8 }}

  [[step.move]]
  on = "body_right"
  ux = {:?}
"#,
        LONG - 1.0,
        SHORT - 1.0
    );
    let why = "homogeneous: the closed form to the tolerance of Newton's method";
    let mut checks = Vec::new();
    for (stretch, time, words) in [
        (LONG, 1.0, ["force at twice the length", "lateral motion then"]),
        (SHORT, 2.0, ["force at half the length", "lateral motion then, compressed"]),
    ] {
        let [force, lateral] = uniaxial(law, stretch);
        checks.push(Check::exact(words[0], "reaction_force.x @ set body_right", force, 1e-8, why).at(time));
        checks.push(Check::exact(words[1], "displacement.y @ set body_top", lateral - 1.0, 1e-8, why).at(time));
    }
    Setup {
        mesh: cube(),
        case,
        checks,
    }
}

fn plastic_bar(hardening: &str) -> Setup {
    let (e, y) = (200e3, 200.0);
    let h = e / 100.0;
    let [far, back] = [0.01, 0.004];
    // two rows far apart: linear hardening
    let table = format!("plasticity = {{ hardening = \"{hardening}\", table = [[{y:?}, 0.0], [{:?}, 1.0]] }}", y + h);
    let case = format!(
        r#"{}
[solver]
newton = {{ force_tol = 1e-11 }}

[[step]]
name = "pull"
geometry = "linear"
increments = {{ fixed = 4 }}
{CUBE_HELD}
  [[step.move]]
  on = "body_right"
  ux = {far:?}

[[step]]
name = "back"
increments = {{ fixed = 4 }}

  [[step.move]]
  on = "body_right"
  ux = {back:?}
"#,
        elastic(e, 0.3, &table)
    );
    let flow = |sign: f64, strain: f64| (sign * y + h * strain) / (1.0 + h / e);
    let pulled = flow(1.0, far);
    let then = match hardening {
        "kinematic" => flow(-1.0, back),
        // |σ| = Y + H p with p = p₁ + (p₁ − ε_p), ε_p = ε − σ/E
        _ => {
            let grown = far - pulled / e;
            -(y + 2.0 * h * grown - h * back) / (1.0 + h / e)
        }
    };
    let why = "homogeneous and proportional: the return mapping is exact";
    Setup {
        mesh: cube(),
        case,
        checks: vec![
            Check::exact("stress when pulled", "stress.xx @ set body_right", pulled, 1e-8, why).at(1.0),
            Check::exact("stress when pushed back", "stress.xx @ set body_right", then, 1e-8, why).at(2.0),
            Check::exact("plastic strain when pulled", "plastic_strain @ set body_right", far - pulled / e, 1e-8, why).at(1.0),
        ],
    }
}

fn thermal_bars() -> Setup {
    let (e, alpha, rise, length) = (210e3, 1.2e-5, 80.0, 4.0);
    let mut grid = Grid::space();
    let one = || even(0.0, 1.0, 1);
    grid.block("free", "hex8", &[even(0.0, length, 4), one(), one()]);
    grid.block("held", "hex8", &[even(0.0, length, 4), even(2.0, 3.0, 1), one()]);
    grid.set("starts", "{ union = [\"free_left\", \"held_left\"] }");
    grid.set("sides", "{ union = [\"free_bottom\", \"held_bottom\"] }");
    grid.set("backs", "{ union = [\"free_back\", \"held_back\"] }");
    let case = format!(
        r#"{UNITS}[material.metal]
model = "linear-elastic"
E = {e:?}
nu = 0.3
expansion = {{ alpha = {alpha:?} }}

[[body]]
group = ["free", "held"]
material = "metal"

[initial]
temperature = 20.0

[[step]]
name = "heat"
geometry = "linear"
increments = 1

  [[step.fix]]
  on = "starts"
  u = ["x"]

  [[step.fix]]
  on = "held_right"
  u = ["x"]

  [[step.fix]]
  on = "sides"
  u = ["y"]

  [[step.fix]]
  on = "backs"
  u = ["z"]

  [[step.temperature]]
  on = "all"
  value = {:?}
"#,
        20.0 + rise
    );
    let why = "homogeneous: rounding";
    Setup {
        mesh: grid,
        case,
        checks: vec![
            // strain is counted from temperature 0
            Check::exact("the free bar grows by", "displacement.x @ set free_right", alpha * rise * length, 1e-8, why),
            Check::exact("stress in the held bar", "stress.xx @ set held_right", -e * alpha * rise, 1e-8, why),
            Check::zero("stress in the free bar", "stress.xx @ set free_right", e * alpha * rise, 1e-9, why),
        ],
    }
}

fn rotating_disc() -> Setup {
    let (a, b, e, nu, density, speed): (f64, f64, f64, f64, f64, f64) = (20.0, 100.0, 210e3, 0.3, 7.8e-9, 1000.0);
    let mut grid = Grid::plane();
    grid.mapped(&Lines {
        name: "body",
        kind: "quad8",
        axes: &[even(a.ln(), b.ln(), 8), even(0.0, FRAC_PI_2, 8)],
        map: &|[log, angle, z]| {
            let x = if angle == FRAC_PI_2 { 0.0 } else { log.exp() * angle.cos() };
            [x, log.exp() * angle.sin(), z]
        },
    });
    grid.set("on_x", "{ plane = \"y\", at = 0.0 }");
    grid.set("on_y", "{ plane = \"x\", at = 0.0 }");
    grid.set("bore_node", format!("{{ near = [{a:?}, 0.0] }}"));
    let hoop = (3.0 + nu) / 4.0 * density * speed * speed * (b * b + (1.0 - nu) / (3.0 + nu) * a * a);
    let case = format!(
        r#"{}{PLANE_STRESS}
[[step]]
name = "spin"
geometry = "linear"
increments = 1

  [[step.fix]]
  on = "on_x"
  u = ["y"]

  [[step.fix]]
  on = "on_y"
  u = ["x"]

  [[step.load]]
  on = "body"
  centrifugal = {{ speed = {speed:?}, axis = "z" }}
"#,
        elastic(e, nu, &format!("density = {density:?}"))
    );
    Setup {
        mesh: grid,
        case,
        checks: vec![
            Check::exact("the bore widens by", "displacement.x @ set bore_node", a * hoop / e, 1e-3, "discretization: 8 cells that grow outwards"),
            Check::exact("hoop stress at the bore", "stress.yy @ set bore_node", hoop, 0.01, "stress at nodes is extrapolated from the points of the cells"),
        ],
    }
}

fn turned_block() -> Setup {
    let mut grid = Grid::space();
    let two = |a: f64, b: f64| even(a, b, 2);
    grid.block("body", "hex8", &[two(1.0, 2.0), two(0.0, 1.0), two(0.0, 1.0)]);
    grid.set("far", "{ near = [2.0, 1.0, 1.0] }");
    let case = format!(
        r#"{}
[reference.hand]
at = [0.0, 0.0, 0.0]

[[constraint]]
kind = "kinematic"
on = "body_left"
reference = "hand"

[[step]]
name = "turn"
geometry = "nonlinear"
increments = {{ fixed = 4 }}

  [[step.fix]]
  on = "hand"
  u = "all"
  rot = ["x", "y"]

  [[step.move]]
  on = "hand"
  rz = {FRAC_PI_2:?}
"#,
        elastic(1000.0, 0.3, "")
    );
    let why = "Newton's tolerance of 1e-6 on forces, squared by its last iteration";
    Setup {
        mesh: grid,
        case,
        checks: vec![
            // (2, 1) becomes (-1, 2)
            Check::exact("a corner moves along x by", "displacement.x @ set far", -3.0, 1e-7, why),
            Check::exact("a corner moves along y by", "displacement.y @ set far", 1.0, 1e-7, why),
            Check::zero("largest equivalent stress", "von_mises @ set body_right max", 1000.0, 1e-7, why),
        ],
    }
}

fn lever() -> Setup {
    let [k1, k2] = [100.0, 50.0];
    let mut grid = Grid::plane();
    let nodes = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|[x, y]| grid.node([x, y, 0.0]));
    grid.cell("line2", "first", &nodes[..2]);
    grid.cell("line2", "second", &nodes[2..]);
    grid.set("roots", "{ nodes = [1, 3] }");
    grid.set("end_1", "{ nodes = [2] }");
    grid.set("end_2", "{ nodes = [4] }");
    grid.set("ends", "{ nodes = [2, 4] }");
    let force = 6.0;
    let case = format!(
        r#"{UNITS}[material.metal]
model = "linear-elastic"
E = 100.0
nu = 0.3

[model]
space = "plane-stress"

[[body]]
group = "first"
material = "metal"
area = {:?}

[[body]]
group = "second"
material = "metal"
area = {:?}

[[constraint]]
equation = [["end_2", "x", 1.0], ["end_1", "x", -2.0]]

[[step]]
name = "push"
geometry = "linear"
increments = 1

  [[step.fix]]
  on = "roots"
  u = "all"

  [[step.fix]]
  on = "ends"
  u = ["y"]

  [[step.load]]
  on = "end_1"
  force = [{force:?}, 0.0]
"#,
        k1 / 100.0,
        k2 / 100.0
    );
    let first = force / (k1 + 4.0 * k2);
    let why = "two unknowns: rounding";
    Setup {
        mesh: grid,
        case,
        checks: vec![
            Check::exact("first end moves by", "displacement.x @ set end_1", first, 1e-9, why),
            Check::exact("second end moves by", "displacement.x @ set end_2", 2.0 * first, 1e-9, why),
            Check::exact("reaction of the second bar", "reaction_force.x @ node 3", -2.0 * k2 * first, 1e-9, why),
        ],
    }
}
