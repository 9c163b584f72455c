//! Where shells of other thickness, sense and direction meet.

use crate::common::{model, run};
use crate::sheet::{Kind, close, grid};

/// A strip of two halves, the second one perhaps turned over, or thinner: the deflection of its tip.
fn halves(turned: bool, second: f64, offset: f64) -> f64 {
    let cell = |nodes: [usize; 4], group: &str, number: usize| {
        format!("{{ id = {number}, type = \"quad4\", group = \"{group}\", nodes = {nodes:?} }},\n")
    };
    let (mut nodes, mut elements) = (String::new(), String::new());
    for i in 0..=8 {
        let x = 0.25 * i as f64;
        nodes += &format!(
            "[{}, {x:?}, 0.0, 0.0], [{}, {x:?}, 1.0, 0.0],\n",
            2 * i + 1,
            2 * i + 2
        );
    }
    for i in 0..8 {
        let [a, d] = [2 * i + 1, 2 * i + 2];
        let [b, c] = [a + 2, d + 2];
        let (group, is_turned) = if i < 4 { ("a", false) } else { ("b", turned) };
        let order = if is_turned {
            [a, d, c, b]
        } else {
            [a, b, c, d]
        };
        elements += &cell(order, group, i + 1);
    }
    let body = |group: &str, thickness: f64, offset: f64| {
        format!(
            "[[body]]\ngroup = \"{group}\"\nmaterial = \"m\"\nshell = {{ thickness = {thickness:?}, offset = {offset:?} }}\n"
        )
    };
    let text = format!(
        "[mesh]\nnodes = [\n{nodes}]\nelements = [\n{elements}]\n[sets]\nroot = {{ nodes = [1, 2] }}\ntip = {{ nodes = [17, 18] }}\n\
         [material.m]\nmodel = \"linear-elastic\"\nE = 1000.0\nnu = 0.0\n{}{}\
         [[step]]\nname = \"s\"\ngeometry = \"linear\"\nincrements = 1\n\
         [[step.fix]]\non = \"root\"\nu = \"all\"\nrot = \"all\"\n[[step.load]]\non = \"tip\"\nforce = [0, 0, 0.02]\n",
        body("a", 0.2, offset),
        body(
            "b",
            second,
            offset * 0.2 / second * if turned { -1.0 } else { 1.0 }
        ),
    );
    let mut model = model("halves.toml", &text, &[]);
    let run = run(&mut model);
    assert!(run.error.is_none(), "{:?}", run.error);
    let tip = model.node(17).unwrap();
    run.frames.last().unwrap().displacement[tip as usize].z
}

#[test]
fn a_sheet_with_a_half_turned_over_bends_as_one_that_is_not() {
    let one = halves(false, 0.2, 0.0);
    close(halves(true, 0.2, 0.0), one, 1e-9);
    close(halves(true, 0.2, 0.5), halves(false, 0.2, 0.5), 1e-6);
    // F L³/3EI, and 6/5 F L/GA
    let inertia = 0.2f64.powi(3) / 12.0;
    close(
        one,
        0.02 * 8.0 / (3.0 * 1000.0 * inertia) + 1.2 * 0.02 * 2.0 / (500.0 * 0.2),
        1e-2,
    );
}

#[test]
fn a_half_of_another_thickness_bends_by_its_own() {
    let [thick, thin] = [0.2f64, 0.1].map(|t| 1000.0 * t.powi(3) / 12.0);
    // by Mohr: half the length 1, force 0.02 at 2
    let wanted = 0.02 * ((8.0 - 1.0) / (3.0 * thick) + 1.0 / (3.0 * thin));
    close(halves(false, 0.1, 0.0), wanted, 1e-2);
    close(halves(true, 0.1, 0.0), wanted, 1e-2);
}

/// An angle of two legs of 2, folded by this angle (degrees), with a force across its second leg.
fn angle(fold: f64, nonlinear: bool, force: f64) -> [f64; 2] {
    let [c, s] = [fold.to_radians().cos(), fold.to_radians().sin()];
    let mut sheet = grid(16, 1, Kind::Quad4, |a, b| {
        let along = 4.0 * a;
        match along < 2.0 {
            true => [along, b, 0.0],
            false => [2.0 + (along - 2.0) * c, b, (along - 2.0) * s],
        }
    });
    sheet.thickness = 0.2;
    sheet.material = [1000.0, 0.0, 1.0];
    sheet.nonlinear = nonlinear.then_some(4);
    sheet.fix("x0", "xyz", "xyz");
    sheet.load("x1", &format!("force = [{}, 0, {}]", force * s, -force * c));
    let solved = sheet.solve();
    let [x, _, z] = solved.at(sheet.label(16, 0));
    // along and across the second leg
    [x * c + z * s, x * s - z * c]
}

#[test]
fn a_folded_sheet_bends_as_its_beam() {
    let stiffness = 1000.0 * 0.2f64.powi(3) / 12.0;
    for fold in [25.0, 60.0, 90.0, 120.0] {
        let force = 1e-3;
        let [_, across] = angle(fold, false, force);
        let c = f64::to_radians(fold).cos();
        // the first leg has the moment F (2 + s cos fold) at a distance s from the fold, the second F s
        let first = force * (8.0 + 8.0 * c + 8.0 / 3.0 * c * c);
        let wanted = (first + force * 8.0 / 3.0) / stiffness;
        close(across, wanted, 1.5e-2);
    }
}

#[test]
fn a_fold_turns_far_without_changing_its_angle() {
    // reference: the same sheet with a rounded corner is the limit; CalculiX gives 0.6595, -0.3703 on 4 cells a leg and ν = 0.3
    let [along, across] = angle(90.0, true, 0.025 * 2.0);
    assert!(across > 0.6 && across < 0.72, "{across}");
    assert!(along < -0.3 && along > -0.42, "{along}");
}
