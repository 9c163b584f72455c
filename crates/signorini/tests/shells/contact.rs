//! Contact of shells at their real faces.

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
