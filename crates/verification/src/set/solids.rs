//! Large strain, plastic flow, heat, rotation.

use crate::forms::{Kirchhoff, neo_hookean, ogden, uniaxial};
use crate::mesh::{Grid, Lines, even};
use crate::problem::{Check, Problem, Setup};
use std::f64::consts::FRAC_PI_2;

/// The problems of this file.
pub(super) const PROBLEMS: [Problem; 14] = [
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
            stretched(text, [LONG, SHORT], &|l| neo_hookean(1.0, 1.5, l))
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
            stretched(text, [LONG, SHORT], &|l| {
                ogden(&[[0.8, 2.0], [0.2, -2.0]], 20.0, l)
            })
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
            stretched(text, [LONG, SHORT], &|l| {
                ogden(&[[0.6, 1.3], [-0.1, -2.0]], 20.0, l)
            })
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
        name: "uniaxial-st-venant-kirchhoff",
        title: "A cube of St. Venant and Kirchhoff's law is stretched and compressed",
        source: "Bonet and Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, section 6.4",
        goal: "stress and contraction at large strain",
        mesh: "one hex8",
        conditions: "three planes of symmetry; the stretch goes to 1.5, then to 0.8",
        formula: "$P = \\tfrac12 E(l^3 - l)$, lateral stretch $\\sqrt{1 - \\nu(l^2 - 1)}$",
        quick: true,
        pose: saint_venant,
    },
    Problem {
        name: "uniaxial-rotated-linear",
        title: "A cube that is linear in its stretch is stretched and compressed",
        source: "closed form: the second stress of Piola and Kirchhoff is Hooke's of U − I",
        goal: "a law without a potential",
        mesh: "one hex8",
        conditions: "three planes of symmetry; the stretch goes to 1.5, then to 0.8",
        formula: "$P = E\\,l(l - 1)$, lateral stretch $1 - \\nu(l - 1)$",
        quick: true,
        pose: || {
            let law = |l: [f64; 3]| {
                let trace = l[0] + l[1] + l[2] - 3.0;
                l.map(|l| l * l * (1.5 * trace + 2.0 * (l - 1.0)))
            };
            let text = "model = \"rotated-linear\"\nE = 2.6\nnu = 0.3";
            stretched(text, [1.5, 0.8], &law)
        },
    },
    Problem {
        name: "uniaxial-ciarlet",
        title: "A cube of Ciarlet's law is stretched and compressed",
        source: "P. G. Ciarlet, Mathematical Elasticity I (1988), section 4.10",
        goal: "stress and contraction at large strain",
        mesh: "one hex8",
        conditions: "three planes of symmetry; the stretch goes to 2, then to 0.5",
        formula: "$\\tau_i = \\tfrac\\lambda2 (J^2 - 1) + \\mu(\\lambda_i^2 - 1)$; the lateral stretch solves $\\tau_2 = 0$",
        quick: true,
        pose: || {
            let law = |l: [f64; 3]| {
                let j: f64 = l.iter().product();
                l.map(|l| 0.75 * (j * j - 1.0) + l * l - 1.0)
            };
            let text = "model = \"ciarlet\"\nE = 2.6\nnu = 0.3";
            stretched(text, [LONG, SHORT], &law)
        },
    },
    Problem {
        name: "uniaxial-ramberg-osgood",
        title: "A cube of Ramberg and Osgood's curve is stretched and compressed",
        source: "W. Ramberg and W. R. Osgood, NACA TN 902 (1943)",
        goal: "deformation theory of plasticity at large strain",
        mesh: "one hex8",
        conditions: "three planes of symmetry; the stretch goes to 1.2, then to 0.9",
        formula: "$E\\ln l = \\tau + \\alpha(|\\tau|/s_0)^{n-1}\\tau$, $E\\ln l_2 = -\\nu\\tau - \\tfrac\\alpha2(|\\tau|/s_0)^{n-1}\\tau$, $n = 5$",
        quick: true,
        pose: || {
            let text = "model = \"ramberg-osgood\"\nE = 1000.0\nnu = 0.3\nreference_stress = 10.0\nexponent = 5\noffset = 0.5";
            stretched(text, [1.2, 0.9], &ramberg_osgood)
        },
    },
    Problem {
        name: "uniaxial-hyperfoam",
        title: "A cube of Ogden's and Storåkers's foam is stretched and compressed",
        source: "B. Storåkers, J. Mech. Phys. Solids 34 (1986) 125",
        goal: "a compressible law in principal stretches",
        mesh: "one hex8",
        conditions: "three planes of symmetry; the stretch goes to 2, then to 0.5",
        formula: "$\\tau_i = \\sum_p \\frac{2\\mu_p}{\\alpha_p}(\\lambda_i^{\\alpha_p} - J^{-\\alpha_p\\beta_p})$, $\\beta_p = \\nu_p/(1 - 2\\nu_p)$; the lateral stretch solves $\\tau_2 = 0$",
        quick: true,
        pose: || {
            let text =
                "model = \"hyperfoam\"\nmu = [0.5, 0.2]\nalpha = [2.0, -2.0]\nnu = [0.2, 0.1]";
            stretched(text, [LONG, SHORT], &|l| {
                foam(&[[0.5, 2.0, 0.2], [0.2, -2.0, 0.1]], l)
            })
        },
    },
    Problem {
        name: "heavy-column",
        title: "A column under its own weight",
        source: "Timoshenko and Goodier, Theory of Elasticity, section 96",
        goal: "gravity",
        mesh: "10 hex8 along the column",
        conditions: "ν = 0; the base is held along the column, three planes of symmetry",
        formula: "$u = \\rho g L^2/(2E)$, base force $\\rho g A L$",
        quick: true,
        pose: column,
    },
    Problem {
        name: "bimetal",
        title: "A strip of two metals is heated",
        source: "S. Timoshenko, J. Opt. Soc. Am. 11 (1925) 233",
        goal: "thermal strain that differs on both sides of a joint",
        mesh: "two tied layers of 40 quad8",
        conditions: "plane stress, layers of thickness 1 and 1, length 50, moduli 1 : 2; symmetry at one end, heated by 100 K",
        formula: "$\\kappa = \\frac{6(\\alpha_1 - \\alpha_2)\\Delta T(1+m)^2}{h(3(1+m)^2 + (1+mn)(m^2 + 1/(mn)))}$, $w = \\kappa L^2/2$; $m$, $n$: ratios of thickness and modulus",
        quick: true,
        pose: bimetal,
    },
];

const UNITS: &str = "units = \"mm-N-MPa\"\n";

fn elastic(e: f64, nu: f64, more: &str) -> String {
    format!(
        "{UNITS}[material.metal]\nmodel = \"linear-elastic\"\nE = {e:?}\nnu = {nu:?}\n{more}\n[[body]]\ngroup = \"body\"\nmaterial = \"metal\"\n"
    )
}

const PLANE_STRESS: &str = "\n[model]\nspace = \"plane-stress\"\n";

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

fn stretched(material: &str, [long, short]: [f64; 2], law: Kirchhoff<'_>) -> Setup {
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
        long - 1.0,
        short - 1.0
    );
    let why = "homogeneous: the closed form to the tolerance of Newton's method";
    let mut checks = Vec::new();
    for (stretch, time, words) in [
        (
            long,
            1.0,
            ["force when stretched", "lateral motion when stretched"],
        ),
        (
            short,
            2.0,
            ["force when compressed", "lateral motion when compressed"],
        ),
    ] {
        let [force, lateral] = uniaxial(law, stretch);
        checks.push(
            Check::exact(
                words[0],
                "reaction_force.x @ set body_right",
                force,
                1e-8,
                why,
            )
            .at(time),
        );
        checks.push(
            Check::exact(
                words[1],
                "displacement.y @ set body_top",
                lateral - 1.0,
                1e-8,
                why,
            )
            .at(time),
        );
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
    let table = format!(
        "plasticity = {{ hardening = \"{hardening}\", table = [[{y:?}, 0.0], [{:?}, 1.0]] }}",
        y + h
    );
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
            Check::exact(
                "stress when pulled",
                "stress.xx @ set body_right",
                pulled,
                1e-8,
                why,
            )
            .at(1.0),
            Check::exact(
                "stress when pushed back",
                "stress.xx @ set body_right",
                then,
                1e-8,
                why,
            )
            .at(2.0),
            Check::exact(
                "plastic strain when pulled",
                "plastic_strain @ set body_right",
                far - pulled / e,
                1e-8,
                why,
            )
            .at(1.0),
        ],
    }
}

fn thermal_bars() -> Setup {
    let (e, alpha, rise, length) = (210e3, 1.2e-5, 80.0, 4.0);
    let mut grid = Grid::space();
    let one = || even(0.0, 1.0, 1);
    grid.block("free", "hex8", &[even(0.0, length, 4), one(), one()]);
    grid.block(
        "held",
        "hex8",
        &[even(0.0, length, 4), even(2.0, 3.0, 1), one()],
    );
    grid.set("starts", "{ union = [\"free_left\", \"held_left\"] }");
    grid.set("sides", "{ union = [\"free_bottom\", \"held_bottom\"] }");
    grid.set("backs", "{ union = [\"free_back\", \"held_back\"] }");
    let case = format!(
        r#"{UNITS}[material.metal]
model = "linear-elastic"
E = {e:?}
nu = 0.3
expansion = {{ alpha = {alpha:?}, reference = 20.0 }}

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
            Check::exact(
                "the free bar grows by",
                "displacement.x @ set free_right",
                alpha * rise * length,
                1e-8,
                why,
            ),
            Check::exact(
                "stress in the held bar",
                "stress.xx @ set held_right",
                -e * alpha * rise,
                1e-8,
                why,
            ),
            Check::zero(
                "stress in the free bar",
                "stress.xx @ set free_right",
                e * alpha * rise,
                1e-9,
                why,
            ),
        ],
    }
}

fn rotating_disc() -> Setup {
    let (a, b, e, nu, density, speed): (f64, f64, f64, f64, f64, f64) =
        (20.0, 100.0, 210e3, 0.3, 7.8e-9, 1000.0);
    let mut grid = Grid::plane();
    grid.mapped(&Lines {
        name: "body",
        kind: "quad8",
        axes: &[even(a.ln(), b.ln(), 8), even(0.0, FRAC_PI_2, 8)],
        map: &|[log, angle, z]| {
            let x = if angle == FRAC_PI_2 {
                0.0
            } else {
                log.exp() * angle.cos()
            };
            [x, log.exp() * angle.sin(), z]
        },
    });
    grid.set("on_x", "{ plane = \"y\", at = 0.0 }");
    grid.set("on_y", "{ plane = \"x\", at = 0.0 }");
    grid.set("bore_node", format!("{{ near = [{a:?}, 0.0] }}"));
    let hoop =
        (3.0 + nu) / 4.0 * density * speed * speed * (b * b + (1.0 - nu) / (3.0 + nu) * a * a);
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
            Check::exact(
                "the bore widens by",
                "displacement.x @ set bore_node",
                a * hoop / e,
                1e-3,
                "discretization: 8 cells that grow outwards",
            ),
            Check::exact(
                "hoop stress at the bore",
                "stress.yy @ set bore_node",
                hoop,
                0.01,
                "stress at nodes is extrapolated from the points of the cells",
            ),
        ],
    }
}

fn saint_venant() -> Setup {
    let (e, nu) = (2.6, 0.3);
    let (mu, lambda) = (
        e / (2.0 * (1.0 + nu)),
        e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
    );
    let law = |l: [f64; 3]| {
        let green = l.map(|l| 0.5 * (l * l - 1.0));
        let trace: f64 = green.iter().sum();
        [0, 1, 2].map(|i| l[i] * l[i] * (lambda * trace + 2.0 * mu * green[i]))
    };
    let text = "model = \"saint-venant-kirchhoff\"\nE = 2.6\nnu = 0.3";
    stretched(text, [1.5, 0.8], &law)
}

/// Kirchhoff's stress by the curve of Ramberg and Osgood, E = 1000, ν = 0.3, s₀ = 10, n = 5, α = 0.5, by bisection.
fn ramberg_osgood(l: [f64; 3]) -> [f64; 3] {
    let (e, nu, s0, alpha) = (1000.0, 0.3, 10.0, 0.5);
    let strain = l.map(f64::ln);
    let trace: f64 = strain.iter().sum();
    let deviator = strain.map(|e| e - trace / 3.0);
    let size = (2.0 / 3.0 * deviator.iter().map(|d| d * d).sum::<f64>()).sqrt();
    let curve = |q: f64| (2.0 * (1.0 + nu) / 3.0 * q + alpha * (q / s0).powi(4) * q) / e;
    let (mut low, mut high) = (0.0, e * size);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if curve(middle) < size {
            low = middle;
        } else {
            high = middle;
        }
    }
    let secant = if size > 0.0 {
        2.0 * low / (3.0 * size)
    } else {
        0.0
    };
    deviator.map(|d| secant * d + e / (3.0 * (1.0 - 2.0 * nu)) * trace)
}

/// `W = Σ 2μ/α² (l₁^α + l₂^α + l₃^α − 3 + (J^(−αβ) − 1)/β)`, terms as `[μ, α, ν]`.
fn foam(terms: &[[f64; 3]], l: [f64; 3]) -> [f64; 3] {
    let j: f64 = l.iter().product();
    let mut stress = [0.0; 3];
    for [mu, alpha, nu] in terms {
        let volume = j.powf(-alpha * nu / (1.0 - 2.0 * nu));
        for (s, l) in stress.iter_mut().zip(l) {
            *s += 2.0 * mu / alpha * (l.powf(*alpha) - volume);
        }
    }
    stress
}

fn column() -> Setup {
    let (e, density, gravity, length): (f64, f64, f64, f64) = (1000.0, 1e-8, 9810.0, 10.0);
    let mut grid = Grid::space();
    let one = || even(0.0, 1.0, 1);
    grid.block("body", "hex8", &[one(), one(), even(0.0, length, 10)]);
    let case = format!(
        r#"{}
[[step]]
name = "stand"
geometry = "linear"
increments = 1
{CUBE_HELD}
  [[step.load]]
  on = "body"
  gravity = [0.0, 0.0, {:?}]
"#,
        elastic(e, 0.0, &format!("density = {density:?}")),
        -gravity
    );
    let weight = density * gravity;
    let why = "nodal values of linear elements are exact in one dimension";
    Setup {
        mesh: grid,
        case,
        checks: vec![
            Check::exact(
                "the head sinks by",
                "displacement.z @ set body_front",
                -weight * length * length / (2.0 * e),
                1e-8,
                why,
            ),
            Check::exact(
                "force at the base",
                "reaction_force.z @ set body_back",
                weight * length,
                1e-8,
                "equilibrium",
            ),
        ],
    }
}

fn bimetal() -> Setup {
    let (length, alpha, rise) = (50.0, [2e-5, 1e-5], 100.0);
    let mut grid = Grid::plane();
    grid.block("low", "quad8", &[even(0.0, length, 40), even(0.0, 1.0, 1)]);
    grid.block("high", "quad8", &[even(0.0, length, 40), even(1.0, 2.0, 1)]);
    grid.set("root", "{ plane = \"x\", at = 0.0 }");
    grid.set("foot", "{ near = [0.0, 0.0] }");
    grid.set("end", format!("{{ near = [{length:?}, 0.0] }}"));
    let material = |name: &str, e: f64, alpha: f64| {
        format!(
            r#"
[material.{name}]
model = "linear-elastic"
E = {e:?}
nu = 0.3
expansion = {{ alpha = {alpha:?} }}

[[body]]
group = "{name}"
material = "{name}"
"#
        )
    };
    let case = format!(
        r#"{UNITS}{}{}{PLANE_STRESS}
[initial]
temperature = 0.0

[[contact]]
name = "joint"
secondary = "high_bottom"
primary = "low_top"
tied = true

[[step]]
name = "heat"
geometry = "linear"
increments = 1

  [[step.fix]]
  on = "root"
  u = ["x"]

  [[step.fix]]
  on = "foot"
  u = ["y"]

  [[step.temperature]]
  on = "all"
  value = {rise:?}
"#,
        material("low", 1000.0, alpha[0]),
        material("high", 2000.0, alpha[1])
    );
    let (m, n, thick) = (1.0_f64, 0.5, 2.0);
    let ends = 3.0 * (1.0 + m).powi(2) + (1.0 + m * n) * (m * m + 1.0 / (m * n));
    let bends = 6.0 * (alpha[0] - alpha[1]) * rise * (1.0 + m).powi(2) / (thick * ends);
    Setup {
        mesh: grid,
        case,
        checks: vec![Check::exact(
            "the end rises by",
            "displacement.y @ set end",
            0.5 * bends * length * length,
            5e-3,
            "beam theory: at the free end the layers are not yet bent, and the thickness grows",
        )],
    }
}
