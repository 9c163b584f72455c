//! Large rotations.

use crate::linear::hemisphere;
use crate::sheet::{Kind, Solved, close, grid};

/// Sze's cantilever under an end shear of 4.
fn cantilever(increments: usize) -> (Solved, usize) {
    let mut sheet = grid(16, 1, Kind::Quad4, |a, b| [10.0 * a, b, 0.0]);
    sheet.thickness = 0.1;
    sheet.material = [1.2e6, 0.0, 1.0];
    sheet.nonlinear = Some(increments);
    sheet.fix("x0", "xyz", "xyz");
    sheet.load("x1", "force = [0, 0, 4]");
    (sheet.solve(), sheet.label(16, 0))
}

#[test]
fn a_cantilever_bends_far_in_one_increment() {
    for (increments, most) in [(1, 8), (10, 55)] {
        let (solved, tip) = cantilever(increments);
        assert!(solved.run.cutbacks.is_empty(), "{:?}", solved.run.cutbacks);
        assert!(solved.iterations() <= most, "{}", solved.iterations());
        let [x, _, z] = solved.at(tip);
        // the other program, then Sze's table
        close(-x, 3.2933, 1e-3);
        close(z, 6.7049, 1e-3);
        close(-x, 3.286, 2e-2);
        close(z, 6.698, 2e-2);
    }
}

#[test]
fn a_hemisphere_is_pulled_inside_out() {
    let (mut sheet, [a, b]) = hemisphere(16, Kind::Quad4, 200.0);
    sheet.nonlinear = Some(1);
    let solved = sheet.solve();
    assert!(solved.run.cutbacks.is_empty(), "{:?}", solved.run.cutbacks);
    assert!(solved.iterations() <= 12, "{}", solved.iterations());
    close(solved.at(a)[0], 3.9684, 1e-2);
    close(-solved.at(b)[1], 7.8177, 1e-2);
}

#[test]
#[ignore = "a minute"]
fn a_hemisphere_on_a_fine_mesh_has_the_published_displacements() {
    let (mut sheet, [a, b]) = hemisphere(24, Kind::Quad4, 200.0);
    sheet.nonlinear = Some(1);
    let solved = sheet.solve();
    close(solved.at(a)[0], 4.067, 2e-2);
    close(-solved.at(b)[1], 8.178, 2e-2);
}
