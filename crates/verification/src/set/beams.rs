//! Beams, rigid motions and linear equations.

use crate::forms::{elastica, root};
use crate::mesh::{Grid, Lines, even};
use crate::problem::{Check, Kind, Problem, Setup};
use std::f64::consts::{FRAC_PI_2, PI};

/// The problems of this file.
pub(super) const PROBLEMS: [Problem; 10] = [
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
    Problem {
        name: "cook-incompressible",
        title: "Cook's membrane, nearly incompressible",
        source: "own value, quad9 extrapolated over meshes: crates/mechanics/tests/cook.rs",
        goal: "bending without volumetric locking",
        mesh: "16 by 16 quad8",
        conditions: "plane strain, E = 250, ν = 0.4999; the left side is clamped, a force of 100 acts along the right one",
        formula: "no closed form; the converged deflection at the upper corner of the right side",
        quick: true,
        pose: cook_incompressible,
    },
    Problem {
        name: "torsion-bar",
        title: "Torsion of a square bar",
        source: "Saint-Venant 1855; Timoshenko and Goodier, Theory of Elasticity, section 109",
        goal: "shear and warping of a section that may warp",
        mesh: "6 by 6 by 6 hex20",
        conditions: "one end is held across the axis, the section of the other one turns by 0.01; both may warp",
        formula: "$\\tau = G\\theta' a\\left(1 - \\frac{8}{\\pi^2}\\sum_{n\\,odd} \\frac{1}{n^2\\cosh(n\\pi/2)}\\right)$ in the middle of a side",
        quick: true,
        pose: torsion,
    },
    Problem {
        name: "plastic-cantilever",
        title: "A cantilever of perfectly plastic material",
        source: "Prager and Hodge, Theory of Perfectly Plastic Solids (1951); W. Johnson and Mellor, Engineering Plasticity",
        goal: "a plastic zone that grows through the height",
        mesh: "80 by 6 quad8, finer towards the clamp",
        conditions: "plane stress, length 20, height 1; one end is clamped, the other one is moved by 1.6 of what first yields",
        formula: "$\\frac{\\delta}{\\delta_y} = \\left(\\frac{F_y}{F}\\right)^2\\left(5 - \\left(3 + \\frac{F}{F_y}\\right)\\sqrt{3 - 2\\frac{F}{F_y}}\\right)$, $F_y = Yh^2/(6L)$",
        quick: true,
        pose: plastic_cantilever,
    },
];

const UNITS: &str = "units = \"mm-N-MPa\"\n";

fn elastic(e: f64, nu: f64, more: &str) -> String {
    format!(
        "{UNITS}[material.metal]\nmodel = \"linear-elastic\"\nE = {e:?}\nnu = {nu:?}\n{more}\n[[body]]\ngroup = \"body\"\nmaterial = \"metal\"\n"
    )
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
            Check::exact(
                "middle of the end rises by",
                "displacement.y @ set corner",
                23.96,
                2e-3,
                "published to four digits; two singular corners",
            )
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

const WHY_BEAM: &str =
    "beam theory: the clamped end warps and contracts freely there, here it does not";

fn cantilever() -> Setup {
    let mut grid = Grid::plane();
    grid.block("body", "quad4", &[even(0.0, 20.0, 40), even(0.0, 1.0, 4)]);
    let load = "\n  [[step.load]]\n  on = \"body_right\"\n  force = [0.0, -1.0]\n";
    Setup {
        mesh: grid,
        case: format!(
            "{}{PLANE_STRESS}{}",
            elastic(1e6, 0.3, ""),
            clamped("linear", 1, load)
        ),
        checks: vec![
            Check::exact(
                "the end sinks by",
                "displacement.y @ set body_right",
                -timoshenko(1.0, 20.0, 1e6, 0.3),
                5e-3,
                WHY_BEAM,
            ),
            Check::exact(
                "force at the clamp",
                "reaction_force.y @ set body_left",
                1.0,
                1e-8,
                "equilibrium",
            ),
        ],
    }
}

fn cantilever_in_space() -> Setup {
    let mut grid = Grid::space();
    grid.block(
        "body",
        "hex20",
        &[even(0.0, 20.0, 10), even(0.0, 1.0, 1), even(0.0, 1.0, 1)],
    );
    let load = "\n  [[step.load]]\n  on = \"body_right\"\n  force = [0.0, -1.0, 0.0]\n";
    Setup {
        mesh: grid,
        case: format!("{}{}", elastic(1e6, 0.0, ""), clamped("linear", 1, load)),
        checks: vec![
            Check::exact(
                "the end sinks by",
                "displacement.y @ set body_right",
                -timoshenko(1.0, 20.0, 1e6, 0.0),
                2e-3,
                "beam theory, whose shear coefficient is an approximation",
            ),
            Check::exact(
                "force at the clamp",
                "reaction_force.y @ set body_left",
                1.0,
                1e-8,
                "equilibrium",
            ),
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
        case: format!(
            "{}{PLANE_STRESS}{}",
            elastic(e, 0.0, ""),
            clamped("nonlinear", 10, &load)
        ),
        checks: vec![
            Check::exact(
                "deflection",
                "displacement.y @ set end",
                deflection * length,
                3e-3,
                why,
            ),
            Check::exact(
                "shortening",
                "displacement.x @ set end",
                -shortening * length,
                3e-3,
                why,
            ),
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
        case: format!(
            "{}{PLANE_STRESS}{coupling}{}",
            elastic(e, 0.0, ""),
            clamped("nonlinear", 20, &turn)
        ),
        checks: vec![
            Check::exact(
                "the end moves along x by",
                "displacement.x @ set end",
                -length,
                3e-3,
                why,
            ),
            Check::exact(
                "the end moves along y by",
                "displacement.y @ set end",
                2.0 * length / PI,
                3e-3,
                why,
            ),
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

fn turned_block() -> Setup {
    let mut grid = Grid::space();
    let two = |a: f64, b: f64| even(a, b, 2);
    grid.block(
        "body",
        "hex8",
        &[two(1.0, 2.0), two(0.0, 1.0), two(0.0, 1.0)],
    );
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
            Check::exact(
                "a corner moves along x by",
                "displacement.x @ set far",
                -3.0,
                1e-7,
                why,
            ),
            Check::exact(
                "a corner moves along y by",
                "displacement.y @ set far",
                1.0,
                1e-7,
                why,
            ),
            Check::zero(
                "largest equivalent stress",
                "von_mises @ set body_right max",
                1000.0,
                1e-7,
                why,
            ),
        ],
    }
}

fn lever() -> Setup {
    let [k1, k2] = [100.0, 50.0];
    let mut grid = Grid::plane();
    let nodes =
        [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|[x, y]| grid.node([x, y, 0.0]));
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
            Check::exact(
                "first end moves by",
                "displacement.x @ set end_1",
                first,
                1e-9,
                why,
            ),
            Check::exact(
                "second end moves by",
                "displacement.x @ set end_2",
                2.0 * first,
                1e-9,
                why,
            ),
            Check::exact(
                "reaction of the second bar",
                "reaction_force.x @ node 3",
                -2.0 * k2 * first,
                1e-9,
                why,
            ),
        ],
    }
}

fn cook_incompressible() -> Setup {
    let mut setup = cook();
    let of = |e: f64, nu: f64| elastic(e, nu, "");
    setup.case = setup
        .case
        .replace(&of(1.0, 1.0 / 3.0), &of(250.0, 0.4999))
        .replace("plane-stress", "plane-strain")
        .replace("force = [0.0, 1.0]", "force = [0.0, 100.0]");
    setup.mesh.set("tip", "{ near = [48.0, 60.0] }");
    setup.checks = vec![
        Check::exact(
            "upper corner rises by",
            "displacement.y @ set tip",
            7.773,
            0.01,
            "16 cells; two singular corners",
        )
        .of(Kind::Regression),
    ];
    setup
}

fn torsion() -> Setup {
    let (e, nu, length, turn) = (1000.0, 0.3, 8.0, 0.01);
    let mut grid = Grid::space();
    let side = || even(-0.5, 0.5, 6);
    grid.block("body", "hex20", &[even(0.0, length, 6), side(), side()]);
    grid.set("middle", "{ near = [4.0, -0.5, 0.0] }");
    grid.set("root", "{ near = [0.0, 0.0, 0.0] }");
    let case = format!(
        r#"{}
[reference.hand]
at = [{length:?}, 0.0, 0.0]

[[constraint]]
kind = "kinematic"
on = "body_right"
reference = "hand"
dofs = ["y", "z"]

[[step]]
name = "twist"
geometry = "linear"
increments = 1

  [[step.fix]]
  on = "body_left"
  u = ["y", "z"]

  [[step.fix]]
  on = "root"
  u = ["x"]

  [[step.fix]]
  on = "hand"
  u = "all"
  rot = ["y", "z"]

  [[step.move]]
  on = "hand"
  rx = {turn:?}
"#,
        elastic(e, nu, "")
    );
    let sum: f64 = (0..8)
        .map(|k| f64::from(2 * k + 1))
        .map(|n| 1.0 / (n * n * (0.5 * n * PI).cosh()))
        .sum();
    let shear = -e / (2.0 * (1.0 + nu)) * turn / length * (1.0 - 8.0 / (PI * PI) * sum);
    Setup {
        mesh: grid,
        case,
        checks: vec![Check::exact(
            "shear in the middle of a side",
            "stress.xz @ set middle",
            shear,
            0.01,
            "stress at nodes is extrapolated from the points of 6 cells on a side",
        )],
    }
}

fn plastic_cantilever() -> Setup {
    let (e, y, length): (f64, f64, f64) = (200e3, 200.0, 20.0);
    // of first yield
    let force = y / (6.0 * length);
    let moved = 1.6 * force * length.powi(3) * 4.0 / e;
    let ratio = |f: f64| (5.0 - (3.0 + f) * (3.0 - 2.0 * f).sqrt()) / (f * f);
    let carries = force * root(|f| ratio(f) - 1.6, 1.0, 1.4999);
    let mut grid = Grid::plane();
    let x = [even(0.0, 8.0, 48), even(8.0, length, 24).split_off(1)].concat();
    grid.block("body", "quad8", &[x, even(-0.5, 0.5, 6)]);
    let table = format!("plasticity = {{ hardening = \"isotropic\", table = [[{y:?}, 0.0]] }}");
    let end = format!(
        "\n  [[step.move]]\n  on = \"body_right\"\n  uy = {:?}\n",
        -moved
    );
    Setup {
        mesh: grid,
        case: format!(
            "{}{PLANE_STRESS}{}",
            elastic(e, 0.0, &table),
            clamped("linear", 8, &end)
        ),
        checks: vec![Check::exact(
            "force at the end",
            "reaction_force.y @ set body_right",
            -carries,
            0.01,
            "beam theory without shear, and the clamp that keeps its section plane",
        )],
    }
}
