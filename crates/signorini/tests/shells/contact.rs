//! Contact of shells at their real faces.

use crate::common::{model, run};
use crate::sheet::{Kind, close, grid, quarter};

/// A ring between two plates, a quarter of it on `n` cells: the force on it, `P R²/(E I)`, where the plates have approached by so much
/// of its radius.
fn ring(n: usize, approach: f64, inside_out: bool) -> f64 {
    let (thickness, width, modulus) = (0.02, 0.2, 1e6);
    let mut sheet = grid(n, 1, Kind::Quad4, |a, b| {
        let [z, x] = quarter(a);
        let b = if inside_out { 1.0 - b } else { b };
        [x, width * b, z]
    });
    sheet.thickness = thickness;
    sheet.material = [modulus, 0.0, 1.0];
    sheet.nonlinear = Some(10);
    sheet.fix("x0", "x", "yz");
    sheet.fix("x1", "z", "xy");
    sheet.fix("sheet", "y", "");
    sheet.fix("plate", "xy", "xyz");
    let top = 1.0 + 0.5 * thickness;
    sheet.rest += &format!(
        "[[step.move]]\non = \"plate\"\nuz = {:?}\n",
        -0.5 * approach
    );
    let side = if inside_out { "negative" } else { "positive" };
    let before = format!(
        "[reference.plate]\nat = [0, 0, {top}]\n[[surface]]\nname = \"top\"\nreference = \"plate\"\n\
         shape = {{ plane = {{ point = [0, 0, {top}], normal = [0, 0, -1] }} }}\n\
         [[contact]]\nname = \"c\"\nsecondary = \"sheet.{side}\"\nprimary = \"top\"\n"
    );
    let solved = sheet.solve_with(&before);
    let [_, _, force] = solved.run.contact_force(solved.run.increments.len());
    // half the width of the ring is here, and half of the force
    let inertia = thickness.powi(3) / 12.0;
    2.0 * force.abs() / width / (modulus * inertia)
}

#[test]
fn a_ring_between_plates_has_the_force_of_the_elastica() {
    for (approach, wanted) in [(0.166944, 1.0), (0.373529, 2.0), (0.80186, 4.0)] {
        close(ring(30, approach, false), wanted, 1.5e-2);
    }
    close(ring(20, 0.373529, true), ring(20, 0.373529, false), 1e-6);
}

/// The deflection of two strips, one on the other, that are tied by their faces and bent by a force on the upper one, over that of a
/// beam of both. The lower one has its nodes on its positive side and so many cells, the upper one on its negative side.
fn tied_strips(cells: [usize; 2], secondary: &str, primary: &str) -> f64 {
    let (mut nodes, mut elements) = (String::new(), String::new());
    let (mut held, mut end) = (Vec::new(), Vec::new());
    let (mut label, mut number) = (0, 0);
    for (name, n) in ["lower", "upper"].into_iter().zip(cells) {
        end.clear();
        for i in 0..=n {
            let x = 10.0 * i as f64 / n as f64;
            let [a, b] = [label + 1, label + 2];
            label += 2;
            nodes += &format!("[{a}, {x:?}, 0.0, 0.0], [{b}, {x:?}, 1.0, 0.0],\n");
            if i == 0 {
                held.extend([a, b]);
            } else {
                number += 1;
                let corners = [a - 2, a, b, b - 2];
                elements += &format!(
                    "{{ id = {number}, type = \"quad4\", group = \"{name}\", nodes = {corners:?} }},\n"
                );
            }
            if i == n {
                end.extend([a, b]);
            }
        }
    }
    let body = |name: &str, offset: f64| {
        format!(
            "[[body]]\ngroup = \"{name}\"\nmaterial = \"m\"\nshell = {{ thickness = 0.05, offset = {offset:?} }}\n"
        )
    };
    let text = format!(
        "[model]\nspace = \"3d\"\n[mesh]\nnodes = [\n{nodes}]\nelements = [\n{elements}]\n[sets]\nheld = {{ nodes = {held:?} }}\n\
         end = {{ nodes = {end:?} }}\n[material.m]\nmodel = \"linear-elastic\"\nE = 1.2e6\nnu = 0.0\n{}{}\
         [[contact]]\nname = \"joint\"\nsecondary = \"{secondary}\"\nprimary = \"{primary}\"\ntied = true\n\
         [[step]]\nname = \"s\"\ngeometry = \"linear\"\nincrements = 1\n[[step.fix]]\non = \"held\"\nu = \"all\"\nrot = \"all\"\n\
         [[step.load]]\non = \"end\"\nforce = [0, 0, 1.0]\n",
        body("lower", 0.5),
        body("upper", -0.5)
    );
    let mut model = model("strips.toml", &text, &[]);
    let run = run(&mut model);
    assert!(run.error.is_none(), "{:?}", run.error);
    let node = model.node(label).unwrap();
    let inertia = 0.1_f64.powi(3) / 12.0;
    run.frames.last().unwrap().displacement[node as usize].z / (1e3 / (3.0 * 1.2e6 * inertia))
}

#[test]
fn strips_that_are_tied_by_their_faces_bend_as_one() {
    let (upper, lower) = ("upper.negative", "lower.positive");
    close(tied_strips([8, 8], upper, lower), 1.0, 2e-2);
    close(tied_strips([8, 8], lower, upper), 1.0, 2e-2);
}
