//! Tubes, spheres, discs: Lamé, press fits, plastic walls, rotation.

use crate::forms::{Wall, fit_pressure, root};
use crate::mesh::{Grid, Lines, even};
use crate::problem::{Check, Problem, Setup};
use std::f64::consts::{FRAC_PI_2, PI};

/// The problems of this file.
pub(super) const PROBLEMS: [Problem; 9] = [
    Problem {
        name: "lame-tube",
        title: "Lamé: a tube under internal pressure",
        source: "G. Lamé 1852; Timoshenko and Goodier, Theory of Elasticity, section 28",
        goal: "displacement and hoop stress of a thick wall in plane strain",
        mesh: "a quarter, 6 quad8 through the wall",
        conditions: "plane strain, symmetry at x = 0 and y = 0, pressure 10 inside",
        formula: "$u = \\frac{1+\\nu}{E}\\left((1-2\\nu)A + B/r^2\\right) r$, $\\sigma_\\theta = A + B/r^2$, $A = \\frac{p a^2}{b^2 - a^2}$, $B = A b^2$",
        quick: true,
        pose: lame_tube,
    },
    Problem {
        name: "wooden-tube",
        title: "A tube of cylindrical orthotropy under internal pressure",
        source: "S. G. Lekhnitskii, Anisotropic Plates (1968), section 57",
        goal: "axes of the material at every integration point",
        mesh: "a quarter, 8 quad8 through the wall",
        conditions: "plane stress, symmetry at x = 0 and y = 0, pressure 10 inside; E 1000 around, 250 through the wall, ν 0.1",
        formula: "$u = A r^k + B r^{-k}$, $k^2 = E_\\theta/E_r$, $\\sigma_r = \\frac{E_r}{1 - \\nu_{r\\theta}\\nu_{\\theta r}}(u' + \\nu_{\\theta r} u/r)$",
        quick: true,
        pose: wooden_tube,
    },
    Problem {
        name: "lame-sphere",
        title: "Lamé: a sphere under internal pressure",
        source: "G. Lamé 1852; Timoshenko and Goodier, Theory of Elasticity, section 136",
        goal: "a thick shell as a body of revolution",
        mesh: "a quarter of the section, 6 quad8 through the wall",
        conditions: "axisymmetric, the equator is held along the axis, pressure 10 inside",
        formula: "$\\sigma_\\theta = A + B/(2r^3)$, $\\sigma_r = A - B/r^3$, $A = \\frac{p a^3}{b^3 - a^3}$, $B = A b^3$, $u = \\frac{r}{E}((1-\\nu)\\sigma_\\theta - \\nu\\sigma_r)$",
        quick: true,
        pose: lame_sphere,
    },
    Problem {
        name: "press-fit-tubes",
        title: "Press fit of two tubes, plane strain, mortar",
        source: "G. Lamé 1852; Timoshenko, Strength of Materials II, section 43",
        goal: "an overlap that is resolved, on curved facets that do not match",
        mesh: "a quarter, quad8, 7 facets of the inner tube on 6 of the outer one",
        conditions: "plane strain, symmetry at x = 0 and y = 0; radial overlap 0.001",
        formula: "$p = \\delta/(u_o(1) - u_i(1))$ with Lamé's displacements of both at the joint under unit pressure",
        quick: true,
        pose: || press_fit_tubes("method = \"mortar\"", [0.005, 0.02]),
    },
    Problem {
        name: "press-fit-tubes-gauss-point",
        title: "Press fit of two tubes, plane strain, Gauss points",
        source: "G. Lamé 1852; Timoshenko, Strength of Materials II, section 43",
        goal: "the same by points inside facets with a penalty",
        mesh: "as for mortar",
        conditions: "as for mortar",
        formula: "$p = \\delta/(u_o(1) - u_i(1))$ with Lamé's displacements of both at the joint under unit pressure",
        quick: true,
        pose: || {
            let method = "method = \"gauss-point\"\nenforcement = { penalty = 1e6 }\nstart = { interference = \"step\" }";
            press_fit_tubes(method, [0.01, 0.02])
        },
    },
    Problem {
        name: "press-fit-rings-axisymmetric",
        title: "Press fit of two rings, axisymmetric",
        source: "G. Lamé 1852; Timoshenko, Strength of Materials II, section 43",
        goal: "an overlap of bodies of revolution with free ends: plane stress",
        mesh: "8 and 6 quad8 through the walls, 4 on 3 along the joint",
        conditions: "axisymmetric, one end is held along the axis; radial overlap 0.001",
        formula: "$p = \\delta/(u_o(1) - u_i(1))$ with Lamé's displacements in plane stress",
        quick: true,
        pose: press_fit_rings,
    },
    Problem {
        name: "press-fit-spheres",
        title: "Press fit of two spherical shells",
        source: "G. Lamé 1852; Timoshenko and Goodier, Theory of Elasticity, section 136",
        goal: "an overlap on a surface of two curvatures, as bodies of revolution",
        mesh: "a quarter of the section, quad8, 20 facets of the inner shell on 16 of the outer one",
        conditions: "axisymmetric, the equator is held along the axis; radial overlap 0.001",
        formula: "$p = \\delta/(u_o(1) - u_i(1))$ with Lamé's displacements of spherical shells",
        quick: true,
        pose: press_fit_spheres,
    },
    Problem {
        name: "limit-load-tube",
        title: "Limit load: a tube of perfectly plastic material",
        source: "R. Hill, The Mathematical Theory of Plasticity (1950), chapter V",
        goal: "the pressure at which the whole wall yields, and stays",
        mesh: "10 quad8 through the wall, one along the axis",
        conditions: "axisymmetric with ends held along the axis: plane strain; the bore is widened by 2 %; yield stress 240",
        formula: "$p = \\frac{2}{\\sqrt 3}\\, Y \\ln(b/a)$",
        quick: true,
        pose: limit_load,
    },
    Problem {
        name: "plastic-sphere",
        title: "A thick sphere of which the inner part yields",
        source: "R. Hill, The Mathematical Theory of Plasticity (1950), section V.2",
        goal: "contained plastic flow under a load",
        mesh: "a quarter of the section, 12 quad8 through the wall",
        conditions: "axisymmetric, the equator is held along the axis; pressure 300 inside, yield stress 240",
        formula: "$p = 2Y\\ln(c/a) + \\tfrac23 Y(1 - c^3/b^3)$ gives $c$; $u(b) = \\tfrac23 \\frac{Y c^3}{E}\\left((1-2\\nu)/b^2 + (1+\\nu)/(2b^2)\\right)$",
        quick: true,
        pose: plastic_sphere,
    },
];

/// A quarter of a ring in polar rows.
fn ring(grid: &mut Grid, name: &str, radii: [f64; 2], cells: [usize; 2]) {
    grid.mapped(&Lines {
        name,
        kind: "quad8",
        axes: &[
            even(radii[0], radii[1], cells[0]),
            even(0.0, FRAC_PI_2, cells[1]),
        ],
        map: &|[r, angle, z]| {
            // nodes on the axis lie exactly on it: the cosine of a right angle is not quite zero
            let x = if angle == FRAC_PI_2 {
                0.0
            } else {
                r * angle.cos()
            };
            [x, r * angle.sin(), z]
        },
    });
}

fn quarter_sets(grid: &mut Grid, of: [f64; 2]) {
    grid.set("on_x", "{ plane = \"y\", at = 0.0 }");
    grid.set("on_y", "{ plane = \"x\", at = 0.0 }");
    let [a, b] = of;
    grid.set("bore_node", format!("{{ near = [{a:?}, 0.0] }}"));
    grid.set("rim_node", format!("{{ near = [{b:?}, 0.0] }}"));
}

const HELD: &str = r#"
  [[step.fix]]
  on = "on_x"
  u = ["y"]

  [[step.fix]]
  on = "on_y"
  u = ["x"]
"#;

fn material(e: f64, more: &str) -> String {
    format!(
        "units = \"mm-N-MPa\"\n[material.metal]\nmodel = \"linear-elastic\"\nE = {e:?}\nnu = 0.3\n{more}\n"
    )
}

fn wall(space: &str, e: f64, more: &str, pressure: f64, increments: usize) -> String {
    format!(
        r#"{}
[model]
space = "{space}"

[[body]]
group = "wall"
material = "metal"

[[step]]
name = "press"
geometry = "linear"
increments = {{ fixed = {increments} }}
{HELD}
  [[step.load]]
  on = "wall_left"
  pressure = {pressure:?}
"#,
        material(e, more)
    )
}

const WHY_WALL: &str = "discretization: 6 quadratic cells through the wall";
const WHY_STRESS: &str = "stress at nodes is extrapolated from the points of the cells";

fn lame_tube() -> Setup {
    let mut grid = Grid::plane();
    ring(&mut grid, "wall", [1.0, 2.0], [6, 8]);
    quarter_sets(&mut grid, [1.0, 2.0]);
    let tube = Wall {
        a: 1.0,
        b: 2.0,
        inside: 10.0,
        outside: 0.0,
        e: 1000.0,
        nu: 0.3,
    };
    let ([inner, hoop], [outer, _]) = (
        tube.tube_in_plane_strain(1.0),
        tube.tube_in_plane_strain(2.0),
    );
    Setup {
        mesh: grid,
        case: wall("plane-strain", 1000.0, "", 10.0, 1),
        checks: vec![
            Check::exact(
                "bore widens by",
                "displacement.x @ set bore_node",
                inner,
                1e-3,
                WHY_WALL,
            ),
            Check::exact(
                "rim widens by",
                "displacement.x @ set rim_node",
                outer,
                1e-3,
                WHY_WALL,
            ),
            Check::exact(
                "hoop stress at the bore",
                "stress.yy @ set bore_node",
                hoop,
                0.01,
                WHY_STRESS,
            ),
        ],
    }
}

/// Displacement and hoop stress of a cylindrically orthotropic tube under a pressure inside, at both radii.
fn orthotropic_tube([a, b]: [f64; 2], [er, et, nu]: [f64; 3], p: f64) -> [[f64; 2]; 2] {
    // ν_θr/E_θ = ν_rθ/E_r
    let (k, other) = ((et / er).sqrt(), nu * et / er);
    let stiffness = er / (1.0 - nu * other);
    // σ_r of r^s over r^(s − 1)
    let radial = |s: f64, r: f64| stiffness * (s + other) * r.powf(s - 1.0);
    let [[m11, m12], [m21, m22]] = [a, b].map(|r| [radial(k, r), radial(-k, r)]);
    let determinant = m11 * m22 - m12 * m21;
    let (grow, fall) = (-p * m22 / determinant, p * m21 / determinant);
    let hoop = |s: f64, r: f64| et / (1.0 - nu * other) * (1.0 + nu * s) * r.powf(s - 1.0);
    [a, b].map(|r| {
        let u = grow * r.powf(k) + fall * r.powf(-k);
        [u, grow * hoop(k, r) + fall * hoop(-k, r)]
    })
}

fn wooden_tube() -> Setup {
    let mut grid = Grid::plane();
    ring(&mut grid, "wall", [1.0, 2.0], [8, 10]);
    quarter_sets(&mut grid, [1.0, 2.0]);
    let [[inner, hoop], [outer, _]] = orthotropic_tube([1.0, 2.0], [250.0, 1000.0, 0.1], 10.0);
    let case = format!(
        r#"
[model]
space = "plane-stress"

[material.wood]
model = "orthotropic"
E1 = 250.0
E2 = 1000.0
E3 = 400.0
nu12 = 0.1
nu13 = 0.05
nu23 = 0.2
G12 = 90.0
G13 = 80.0
G23 = 70.0

[orientation.rings]
kind = "cylindrical"
axis = "z"

[[body]]
group = "wall"
material = "wood"
orientation = "rings"

[[step]]
name = "press"
geometry = "linear"
increments = {{ fixed = 1 }}
{HELD}
  [[step.load]]
  on = "wall_left"
  pressure = 10.0
"#
    );
    Setup {
        mesh: grid,
        case,
        checks: vec![
            Check::exact(
                "bore widens by",
                "displacement.x @ set bore_node",
                inner,
                1e-3,
                "discretization: 8 quadratic cells through the wall",
            ),
            Check::exact(
                "rim widens by",
                "displacement.x @ set rim_node",
                outer,
                1e-3,
                "discretization: 8 quadratic cells through the wall",
            ),
            Check::exact(
                "hoop stress at the bore",
                "stress.yy @ set bore_node",
                hoop,
                0.01,
                WHY_STRESS,
            ),
        ],
    }
}

fn lame_sphere() -> Setup {
    let mut grid = Grid::plane();
    ring(&mut grid, "wall", [1.0, 2.0], [6, 8]);
    quarter_sets(&mut grid, [1.0, 2.0]);
    let shell = Wall {
        a: 1.0,
        b: 2.0,
        inside: 10.0,
        outside: 0.0,
        e: 1000.0,
        nu: 0.3,
    };
    let ([inner, hoop], [outer, _]) = (shell.sphere(1.0), shell.sphere(2.0));
    Setup {
        mesh: grid,
        case: wall("axisymmetric", 1000.0, "", 10.0, 1),
        checks: vec![
            Check::exact(
                "bore widens by",
                "displacement.x @ set bore_node",
                inner,
                1e-3,
                WHY_WALL,
            ),
            Check::exact(
                "rim widens by",
                "displacement.x @ set rim_node",
                outer,
                1e-3,
                WHY_WALL,
            ),
            Check::exact(
                "hoop stress at the bore",
                "stress.zz @ set bore_node",
                hoop,
                0.02,
                WHY_STRESS,
            ),
        ],
    }
}

/// Radial overlap of the fits.
const OVERLAP: f64 = 1e-3;

/// The two walls of a fit under a pressure between them.
fn fit_walls(pressure: f64) -> [Wall; 2] {
    let wall = |a: f64, b: f64, inside: f64, outside: f64| Wall {
        a,
        b,
        inside,
        outside,
        e: 1000.0,
        nu: 0.3,
    };
    [wall(1.0, 1.5, pressure, 0.0), wall(0.5, 1.0, 0.0, pressure)]
}

fn fit(space: &str, method: &str, held: &str) -> String {
    format!(
        r#"{}
[model]
space = "{space}"

[[body]]
group = ["inner", "outer"]
material = "metal"

[[contact]]
name = "fit"
secondary = "inner_right"
primary = "outer_left"
{method}

[[step]]
name = "fit"
geometry = "linear"
increments = {{ fixed = 2 }}
{held}"#,
        material(1000.0, "")
    )
}

fn press_fit_tubes(method: &str, parts: [f64; 2]) -> Setup {
    let mut grid = Grid::plane();
    ring(&mut grid, "inner", [0.5, 1.0 + OVERLAP], [6, 7]);
    ring(&mut grid, "outer", [1.0, 1.5], [6, 6]);
    quarter_sets(&mut grid, [0.5, 1.5]);
    let [outer, inner] = fit_walls(1.0);
    let pressure = fit_pressure(
        OVERLAP,
        outer.tube_in_plane_strain(1.0)[0],
        inner.tube_in_plane_strain(1.0)[0],
    );
    let [outer, inner] = fit_walls(pressure);
    let why = "facets of quadratic cells leave the circle; the overlap is 0.001 of the radius";
    Setup {
        mesh: grid,
        case: fit("plane-strain", method, HELD),
        checks: vec![
            Check::exact(
                "force on the quarter",
                "fit.force_x",
                -pressure,
                parts[0],
                why,
            ),
            Check::exact(
                "rim widens by",
                "displacement.x @ set rim_node",
                outer.tube_in_plane_strain(1.5)[0],
                parts[0],
                why,
            ),
            Check::exact(
                "bore narrows by",
                "displacement.x @ set bore_node",
                inner.tube_in_plane_strain(0.5)[0],
                parts[0],
                why,
            ),
            Check::exact(
                "mean pressure",
                "contact_pressure @ set inner_right mean",
                pressure,
                parts[1],
                why,
            ),
        ],
    }
}

fn press_fit_rings() -> Setup {
    let mut grid = Grid::plane();
    grid.block(
        "inner",
        "quad8",
        &[even(0.5, 1.0 + OVERLAP, 8), even(0.0, 1.0, 4)],
    );
    grid.block("outer", "quad8", &[even(1.0, 1.5, 6), even(0.0, 1.0, 3)]);
    grid.set("on_x", "{ plane = \"y\", at = 0.0 }");
    let [outer, inner] = fit_walls(1.0);
    let pressure = fit_pressure(
        OVERLAP,
        outer.tube_in_plane_stress(1.0)[0],
        inner.tube_in_plane_stress(1.0)[0],
    );
    let [outer, inner] = fit_walls(pressure);
    let why = "discretization, and the overlap of 0.001 of the radius";
    let held = "\n  [[step.fix]]\n  on = \"on_x\"\n  u = [\"y\"]\n";
    Setup {
        mesh: grid,
        case: fit("axisymmetric", "method = \"mortar\"", held),
        checks: vec![
            Check::exact(
                "least pressure",
                "contact_pressure @ set inner_right min",
                pressure,
                0.005,
                why,
            ),
            Check::exact(
                "largest pressure",
                "contact_pressure @ set inner_right max",
                pressure,
                0.005,
                why,
            ),
            Check::exact(
                "rim widens by",
                "displacement.x @ set outer_right",
                outer.tube_in_plane_stress(1.5)[0],
                0.005,
                why,
            ),
            Check::exact(
                "bore narrows by",
                "displacement.x @ set inner_left",
                inner.tube_in_plane_stress(0.5)[0],
                0.005,
                why,
            ),
        ],
    }
}

fn press_fit_spheres() -> Setup {
    let mut grid = Grid::plane();
    ring(&mut grid, "inner", [0.5, 1.0 + OVERLAP], [6, 20]);
    ring(&mut grid, "outer", [1.0, 1.5], [6, 16]);
    quarter_sets(&mut grid, [0.5, 1.5]);
    let [outer, inner] = fit_walls(1.0);
    let pressure = fit_pressure(OVERLAP, outer.sphere(1.0)[0], inner.sphere(1.0)[0]);
    let [outer, inner] = fit_walls(pressure);
    let why = "facets of quadratic cells leave the sphere; the overlap is 0.001 of the radius";
    Setup {
        mesh: grid,
        case: fit("axisymmetric", "method = \"mortar\"", HELD),
        checks: vec![
            // the sum over the half of the sphere along its axis: p times the area of its great circle
            Check::exact(
                "force along the axis",
                "fit.force_y",
                -pressure * PI,
                0.005,
                why,
            ),
            Check::exact(
                "rim widens by",
                "displacement.x @ set rim_node",
                outer.sphere(1.5)[0],
                0.005,
                why,
            ),
            Check::exact(
                "bore narrows by",
                "displacement.x @ set bore_node",
                inner.sphere(0.5)[0],
                0.005,
                why,
            ),
        ],
    }
}

/// Yield stress (MPa).
const YIELD: f64 = 240.0;
const PERFECT: &str = "plasticity = { hardening = \"isotropic\", table = [[240.0, 0.0]] }";

fn limit_load() -> Setup {
    let (a, b) = (1.0, 2.0);
    let mut grid = Grid::plane();
    grid.block("wall", "quad8", &[even(a, b, 10), even(0.0, 0.1, 1)]);
    let pressure = 2.0 / 3.0_f64.sqrt() * YIELD * (b / a).ln();
    let case = format!(
        r#"{}
[model]
space = "axisymmetric"

[[body]]
group = "wall"
material = "metal"

[[step]]
name = "widen"
geometry = "linear"
increments = {{ fixed = 10 }}

  [[step.fix]]
  on = "wall"
  u = ["y"]

  [[step.move]]
  on = "wall_left"
  ux = 0.02
"#,
        material(210e3, PERFECT)
    );
    Setup {
        mesh: grid,
        case,
        checks: vec![
            Check::exact(
                "pressure in the bore",
                "reaction_force.x @ set wall_left",
                pressure * 2.0 * PI * a * 0.1,
                0.005,
                "discretization: 10 cells through the wall",
            ),
            Check::exact(
                "equivalent stress at the rim",
                "von_mises @ set wall_right",
                YIELD,
                0.01,
                WHY_STRESS,
            ),
        ],
    }
}

fn plastic_sphere() -> Setup {
    let (a, b, e, nu, pressure) = (100.0, 200.0, 210e3, 0.3, 300.0);
    let mut grid = Grid::plane();
    ring(&mut grid, "wall", [a, b], [12, 10]);
    quarter_sets(&mut grid, [a, b]);
    let load = |c: f64| {
        2.0 * YIELD * (c / a).ln() + 2.0 / 3.0 * YIELD * (1.0 - (c / b).powi(3)) - pressure
    };
    let c = root(load, a, b);
    let widens = 2.0 / 3.0 * YIELD * c.powi(3) / e
        * ((1.0 - 2.0 * nu) / (b * b) + (1.0 + nu) / (2.0 * b * b));
    Setup {
        mesh: grid,
        case: wall("axisymmetric", e, PERFECT, pressure, 10),
        checks: vec![Check::exact(
            "equator widens by",
            "displacement.x @ set rim_node",
            widens,
            0.005,
            "discretization: the plastic front lies inside of a cell",
        )],
    }
}
