//! Beams, plates and a cube.

use super::mesh::{Block, Mesh};
use super::{agree, elastic, solve};
use std::f64::consts::PI;

/// A free cube of side 1 with E such that μ = 1.
pub fn cube(cells: usize, nu: f64, modes: usize) -> String {
    let mesh = Mesh::of(&[Block {
        group: "cube",
        element: "hex20",
        cells: [cells; 3],
        origin: [0.0; 3],
        size: [1.0; 3],
    }]);
    format!(
        "{}[model]\nspace = \"3d\"\n{}\
         [[step]]\nname = \"modes\"\nkind = \"frequency\"\nfrequency = {{ modes = {modes} }}\n",
        mesh.text(),
        elastic(2.0 * (1.0 + nu), nu, "\"cube\"", ""),
    )
}

/// ω a √(ρ/μ), from the seventh on.
const CUBE: [f64; 20] = [
    2.8573056482458665,
    2.8573056482458665,
    3.846449081233573,
    3.846449081233573,
    3.846449081233573,
    3.9113378278739614,
    3.9113378278739614,
    3.9113378278739614,
    4.442882938762499,
    4.442882938762499,
    4.442882942610657,
    4.573705045756133,
    4.573705045756133,
    4.573705045756133,
    4.7931942249186426,
    4.7931942249186426,
    4.7931942249186426,
    5.425848126095558,
    5.425848126095558,
    5.516217768978085,
];

/// All of the repeated ones, and six rigid motions.
#[test]
fn a_free_cube_has_all_its_modes() {
    for (cells, count, tolerance) in [(3, 20, 0.012), (6, 26, 0.002)] {
        let omegas = solve(&cube(cells, 0.3, count)).omegas();
        let rigid = omegas[..6]
            .iter()
            .fold(0.0, |most: f64, w| most.max(w.abs()));
        assert!(rigid < 1e-4 * omegas[6], "{rigid}");
        let wanted = &CUBE[..count - 6];
        agree(
            &format!("cube of {cells}³"),
            &omegas[6..],
            wanted,
            tolerance,
        );
    }
}

/// A cantilever of square section, which bends about both axes alike.
#[test]
fn a_cantilever_has_the_frequencies_of_a_beam() {
    let (e, length) = (1e6, 50.0);
    let mesh = Mesh::of(&[Block {
        group: "beam",
        element: "hex20",
        cells: [30, 1, 1],
        origin: [0.0; 3],
        size: [length, 1.0, 1.0],
    }]);
    let text = format!(
        "{}[model]\nspace = \"3d\"\n{}[sets]\n{}\
         [[step]]\nname = \"modes\"\nkind = \"frequency\"\nfrequency = {{ modes = 6 }}\nfix = [{{ on = \"base\", u = \"all\" }}]\n",
        mesh.text(),
        elastic(e, 0.3, "\"beam\"", ""),
        mesh.set("base", |x| x[0] == 0.0),
    );
    let betas = [1.8751040687116978_f64, 4.694091132974175, 7.854757438237325];
    let of = |beta: f64| beta.powi(2) * (e / 12.0 / length.powi(4)).sqrt();
    let wanted: Vec<f64> = betas
        .iter()
        .flat_map(|&beta| [of(beta), of(beta)])
        .collect();
    agree("cantilever", &solve(&text).omegas(), &wanted, 0.005);
}

/// Navier's plate: along its edges nothing moves but across them.
#[test]
fn a_plate_on_simple_supports_has_the_frequencies_of_navier() {
    let (e, nu, side, thickness) = (1e6, 0.3, 10.0, 0.1);
    let mesh = Mesh::of(&[Block {
        group: "plate",
        element: "hex20",
        cells: [12, 12, 1],
        origin: [0.0, 0.0, -0.5 * thickness],
        size: [side, side, thickness],
    }]);
    let text = format!(
        "{}[model]\nspace = \"3d\"\n{}[sets]\n{}{}\
         [[step]]\nname = \"modes\"\nkind = \"frequency\"\nfrequency = {{ modes = 6 }}\n\
         fix = [{{ on = \"ends\", u = [\"y\", \"z\"] }}, {{ on = \"sides\", u = [\"x\", \"z\"] }}]\n",
        mesh.text(),
        elastic(e, nu, "\"plate\"", "integration = \"reduced\""),
        mesh.set("ends", |x| x[0] == 0.0 || x[0] == side),
        mesh.set("sides", |x| x[1] == 0.0 || x[1] == side),
    );
    let stiffness = e * f64::powi(thickness, 3) / (12.0 * (1.0 - nu * nu));
    let of = |sum: f64| sum * (PI / side).powi(2) * (stiffness / thickness).sqrt();
    let wanted = [2.0, 5.0, 5.0, 8.0, 10.0, 10.0].map(of);
    agree("plate", &solve(&text).omegas(), &wanted, 0.005);
}

/// A beam on two supports under tension: ω² = (kπ/L)⁴ EI/ρA + (kπ/L)² N/ρA.
#[test]
fn tension_raises_the_frequencies_of_a_beam_as_of_a_string() {
    let (e, length) = (1e6, 100.0);
    let mesh = Mesh::of(&[Block {
        group: "beam",
        element: "quad8",
        cells: [60, 1, 0],
        origin: [0.0, -0.5, 0.0],
        size: [length, 1.0, 0.0],
    }]);
    let critical = PI * PI * e / 12.0 / (length * length);
    for times in [5.0, 0.0, -0.5] {
        let tension = times * critical;
        let pull = format!(
            "[[step]]\nname = \"pull\"\nincrements = 1\n\
             fix = [{{ on = \"left\", u = \"all\" }}, {{ on = \"right\", u = [\"y\"] }}]\n\
             load = [{{ on = \"ends\", traction = [0.0, 0.0], name = \"none\" }}, \
             {{ on = \"head\", traction = [{tension:?}, 0.0], name = \"a\" }}, \
             {{ on = \"tail\", traction = [{:?}, 0.0], name = \"b\" }}]\n",
            -tension
        )
        .replace(
            "{ on = \"ends\", traction = [0.0, 0.0], name = \"none\" }, ",
            "",
        );
        let text = format!(
            "{}[model]\nspace = \"plane-stress\"\n{}[sets]\n{}{}{}{}{pull}\
             [[step]]\nname = \"modes\"\nkind = \"frequency\"\nfrequency = {{ modes = 3 }}\n",
            mesh.text(),
            elastic(e, 0.0, "\"beam\"", ""),
            mesh.set("left", |x| x[0] == 0.0 && x[1] == 0.0),
            mesh.set("right", |x| x[0] == length && x[1] == 0.0),
            mesh.faces("head", "beam +x"),
            mesh.faces("tail", "beam -x"),
        );
        let of = |k: usize| {
            let wave = k as f64 * PI / length;
            (wave.powi(4) * e / 12.0 + wave.powi(2) * tension).sqrt()
        };
        let wanted = [1, 2, 3].map(of);
        agree(
            &format!("tension of {times} buckling loads"),
            &solve(&text).omegas(),
            &wanted,
            0.003,
        );
    }
}
