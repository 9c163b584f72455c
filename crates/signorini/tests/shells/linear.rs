//! Linear steps: the table of a linear benchmark for shells.

use crate::sheet::{Kind, Sheet, close, grid, quarter};

/// The deflection of a clamped square plate under a uniform load, a quarter of it on `n × n` cells, over that of Kirchhoff's theory,
/// `0.00126532 q L⁴/D`.
fn plate(n: usize, kind: Kind, thickness: f64) -> f64 {
    let mut sheet = grid(n, n, kind, |a, b| [0.5 * a, 0.5 * b, 0.0]);
    sheet.thickness = thickness;
    sheet.material = [1e4, 0.3, 1.0];
    sheet.fix("x0", "xyz", "xyz");
    sheet.fix("y0", "xyz", "xyz");
    sheet.fix("x1", "x", "yz");
    sheet.fix("y1", "y", "xz");
    let q = thickness.powi(3);
    sheet.load("sheet.positive", &format!("pressure = {q:e}"));
    let stiffness = 1e4 * thickness.powi(3) / (12.0 * (1.0 - 0.09));
    let w = sheet.solve().at(sheet.label(n, n))[2];
    -w / (0.00126532 * q / stiffness)
}

#[test]
fn a_clamped_plate_does_not_lock_and_loses_no_digits_from_thick_to_very_thin() {
    // of the prototype of this element, 8 × 8 and 16 × 16
    close(plate(8, Kind::Quad4, 0.1), 1.1546, 1e-3);
    for (thickness, wanted) in [(1e-2, 0.9981), (1e-3, 0.9964), (3e-4, 0.9966)] {
        close(plate(8, Kind::Quad4, thickness), wanted, 1e-3);
    }
    for thickness in [1e-3, 1e-4, 1e-5] {
        close(plate(16, Kind::Quad4, thickness), 0.9991, 2e-4);
    }
    for thickness in [1e-2, 1e-3] {
        close(plate(8, Kind::Tri3, thickness), 1.0, 5e-3);
    }
}

fn scordelis_lo(n: usize, kind: Kind) -> f64 {
    let [radius, length, angle] = [25.0, 50.0, 40f64.to_radians()];
    let mut sheet = grid(n, n, kind, |a, b| {
        [
            radius * (angle * a).sin(),
            0.5 * length * b,
            radius * (angle * a).cos(),
        ]
    });
    sheet.thickness = 0.25;
    sheet.material = [4.32e8, 0.0, 360.0];
    sheet.fix("y0", "xz", "");
    sheet.fix("y1", "y", "xz");
    sheet.fix("x0", "x", "yz");
    sheet.load("sheet", "gravity = [0, 0, -1]");
    -sheet.solve().at(sheet.label(n, n))[2] / 0.3024
}

/// Under a force at the middle, in an octant.
fn cylinder(n: usize, kind: Kind) -> f64 {
    let mut sheet = grid(n, n, kind, |a, b| {
        let [z, x] = quarter(a);
        [300.0 * x, 300.0 * b, 300.0 * z]
    });
    sheet.thickness = 3.0;
    sheet.material = [3e6, 0.3, 1.0];
    sheet.fix("y0", "xz", "");
    sheet.fix("y1", "y", "xz");
    sheet.fix("x0", "x", "yz");
    sheet.fix("x1", "z", "xy");
    let loaded = sheet.label(0, n);
    sheet.set("loaded", &[loaded]);
    sheet.load("loaded", "force = [0, 0, -0.25]");
    -sheet.solve().at(loaded)[2] / 1.8248e-5
}

/// A quarter with a hole of 18 degrees, which forces pull apart and press together.
pub fn hemisphere(n: usize, kind: Kind, force: f64) -> (Sheet, [usize; 2]) {
    let mut sheet = grid(n, n, kind, |a, b| {
        let latitude = b * 72f64.to_radians();
        let [x, y] = quarter(a).map(|part| 10.0 * part * latitude.cos());
        [x, y, 10.0 * latitude.sin()]
    });
    sheet.thickness = 0.04;
    sheet.material = [6.825e7, 0.3, 1.0];
    sheet.fix("x0", "y", "xz");
    sheet.fix("x1", "x", "yz");
    let [a, b, top] = [sheet.label(0, 0), sheet.label(n, 0), sheet.label(0, n)];
    for (name, node) in [("a", a), ("b", b), ("top", top)] {
        sheet.set(name, &[node]);
    }
    sheet.fix("top", "z", "");
    sheet.load("a", &format!("force = [{force}, 0, 0]"));
    sheet.load("b", &format!("force = [0, {}, 0]", -force));
    (sheet, [a, b])
}

/// Twisted by a right angle, under a force at its tip: the displacements along the width and across over those of the literature.
fn twisted(cells: [usize; 2], thickness: f64, force: f64, wanted: [f64; 2]) -> [f64; 2] {
    let mut found = [0.0; 2];
    for (found, (axis, wanted)) in found.iter_mut().zip([(2, wanted[0]), (1, wanted[1])]) {
        let [nx, ny] = cells;
        let mut sheet = grid(nx, ny, Kind::Quad4, |a, b| {
            let [c, s] = quarter(a);
            [12.0 * a, (b - 0.5) * 1.1 * c, (b - 0.5) * 1.1 * s]
        });
        sheet.thickness = thickness;
        sheet.material = [29e6, 0.22, 1.0];
        sheet.fix("x0", "xyz", "xyz");
        let mut along = [0.0; 3];
        along[axis] = force;
        sheet.load("x1", &format!("force = {along:?}"));
        *found = sheet.solve().at(sheet.label(nx, ny / 2))[axis] / wanted;
    }
    found
}

#[test]
fn curved_shells_of_quadrilaterals_give_what_another_program_with_this_element_gives() {
    for (n, roof, tube, [dome, angle]) in [
        (4, 1.0513, 0.3946, [1.0299, 45.0]),
        (8, 1.0062, 0.7551, [0.997, 20.0]),
        (16, 0.9975, 0.9305, [0.9925, 20.0]),
    ] {
        close(scordelis_lo(n, Kind::Quad4), roof, 1e-2);
        close(cylinder(n, Kind::Quad4), tube, 1e-2);
        // facets of a coarse dome meet at more than 20 degrees
        let (mut sheet, [a, b]) = hemisphere(n, Kind::Quad4, 1.0);
        sheet.shell = format!(", normals = {angle}");
        let solved = sheet.solve();
        close(solved.at(a)[0] / 0.094, dome, 1e-2);
        close(-solved.at(b)[1], solved.at(a)[0], 1e-3);
    }
}

#[test]
fn a_twisted_beam_bends_both_ways_thick_and_thin() {
    let thick = twisted([12, 2], 0.32, 1.0, [0.005424, 0.001754]);
    close(thick[0], 0.9967, 1e-2);
    close(thick[1], 0.985, 1e-2);
    for (cells, wanted) in [([12, 2], [0.9848, 0.979]), ([24, 4], [0.9946, 0.9945])] {
        let thin = twisted(cells, 0.0032, 1e-6, [0.005256, 0.001294]);
        close(thin[0], wanted[0], 1e-2);
        close(thin[1], wanted[1], 1e-2);
    }
}

#[test]
fn curved_shells_of_triangles_come_as_close() {
    close(scordelis_lo(8, Kind::Tri3), 1.0, 2e-2);
    close(scordelis_lo(16, Kind::Tri3), 1.0, 1e-2);
    close(cylinder(16, Kind::Tri3), 0.9716, 1e-2);
    let (sheet, [a, _]) = hemisphere(16, Kind::Tri3, 1.0);
    close(sheet.solve().at(a)[0] / 0.094, 0.9883, 1e-2);
}
