//! The second line of *ORIENTATION: a bar of orthotropic material along x, whose axes turn about one of themselves.

use crate::common::run;
use signorini::{Reading, build, load};
use signorini_geometry::tensor::{Mat3, Vec3};

const E: [f64; 3] = [100_000.0, 20_000.0, 10_000.0];
/// ν12, ν13, ν23.
const NU: [f64; 3] = [0.3, 0.2, 0.25];
/// G12, G13, G23.
const G: [f64; 3] = [5_000.0, 4_000.0, 3_000.0];
const X: Vec3 = Vec3::new(1.0, 2.0, 0.5);
const XY: Vec3 = Vec3::new(-1.0, 1.0, 0.3);
const FORCE: f64 = 25.0;

/// A cube that four forces pull at each end, free to shear.
fn deck(second: &str) -> String {
    let corners = [
        [0, 0, 0],
        [1, 0, 0],
        [1, 1, 0],
        [0, 1, 0],
        [0, 0, 1],
        [1, 0, 1],
        [1, 1, 1],
        [0, 1, 1],
    ];
    let nodes = corners
        .iter()
        .zip(1..)
        .map(|([x, y, z], n)| format!("{n}, {x}, {y}, {z}\n"));
    let forces = corners.iter().zip(1..).map(|([x, ..], n)| {
        let force = if *x == 1 { FORCE } else { -FORCE };
        format!("{n}, 1, {force}\n")
    });
    let constants = [&E[..], &NU[..], &G[..2]]
        .concat()
        .iter()
        .map(|c| format!("{c}"))
        .collect::<Vec<_>>();
    format!(
        "*NODE\n{}*ELEMENT, TYPE=C3D8, ELSET=B\n1, 1, 2, 3, 4, 5, 6, 7, 8\n\
         *MATERIAL, NAME=M\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n{}\n{}\n\
         *ORIENTATION, NAME=O\n{}, {}, {}, {}, {}, {}\n{second}\
         *SOLID SECTION, ELSET=B, MATERIAL=M, ORIENTATION=O\n\
         *BOUNDARY\n1, 1, 3\n2, 2, 3\n4, 3, 3\n*STEP\n*STATIC\n*CLOAD\n{}*END STEP\n",
        nodes.collect::<String>(),
        constants.join(", "),
        G[2],
        X.x,
        X.y,
        X.z,
        XY.x,
        XY.y,
        XY.z,
        forces.collect::<String>(),
    )
}

/// The strain along x of a unit of stress along it, with the cosines of the local axes.
fn compliance(axes: [Vec3; 3]) -> f64 {
    let [a, b, c] = axes.map(|axis| axis.x * axis.x);
    a * a / E[0]
        + b * b / E[1]
        + c * c / E[2]
        + a * b * (1.0 / G[0] - 2.0 * NU[0] / E[0])
        + a * c * (1.0 / G[1] - 2.0 * NU[1] / E[0])
        + b * c * (1.0 / G[2] - 2.0 * NU[2] / E[1])
}

fn stretch(second: &str) -> f64 {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("bar.inp");
    std::fs::write(&path, deck(second)).unwrap();
    let loaded =
        load(&path, &Reading::default()).unwrap_or_else(|found| panic!("{}", found.plain()));
    let mut model =
        build(loaded.case, loaded.mesh).unwrap_or_else(|found| panic!("{}", found.plain()));
    run(&mut model).frames.last().unwrap().displacement[1].x
}

#[test]
fn axes_of_a_material_turn_about_any_of_themselves_by_any_angle() {
    let first = X.normalized().unwrap();
    let third = first.cross(XY).normalized().unwrap();
    let axes = [first, third.cross(first), third];
    let check = |second: &str, axes: [Vec3; 3]| {
        let (found, exact) = (stretch(second), 4.0 * FORCE * compliance(axes));
        assert!(
            (found / exact - 1.0).abs() < 1e-10,
            "{second}: {found} for {exact}"
        );
    };
    check("", axes);
    for (number, about) in (1..).zip(axes) {
        for angle in [-200.0f64, -90.0, 0.0, 30.0, 45.0, 90.0, 137.5, 180.0, 370.0] {
            let turn = Mat3::rotation(about * angle.to_radians());
            check(
                &format!("{number}, {angle}\n"),
                axes.map(|axis| turn * axis),
            );
        }
    }
    // the first axis where none is named
    let turn = Mat3::rotation(axes[0] * 30f64.to_radians());
    check(", 30.\n", axes.map(|axis| turn * axis));
}

#[test]
fn there_is_no_fourth_axis_to_turn_about() {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("bar.inp");
    std::fs::write(&path, deck("4, 30.\n")).unwrap();
    let found = load(&path, &Reading::default()).unwrap_err().plain();
    assert!(
        found.contains("*ORIENTATION turns about local axis 4"),
        "{found}"
    );
}
