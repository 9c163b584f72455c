//! Surfaces that cannot be, exit code 4.

use super::blocks::{BLOCKS, Blocks};
use super::trial::{Remedy, Trial};
use crate::support::{BRICK, change, folder_with, run};

#[test]
fn a_polynomial_of_a_high_degree() {
    let text = Blocks {
        more: "[[surface]]\nname = \"floor\"\nshape = { polynomial = { coefficients = [1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0] } }",
        steps: "[[step.move]]\non = \"high_top\"\nux = 0\nuy = 0\n",
        ..BLOCKS
    }
    .text();
    Trial {
        text: change(&text, "primary = \"low_head\"", "primary = \"floor\""),
        code: 4,
        says: &[
            "S0309",
            "surface \"floor\"",
            "of degree 11; 10 is the most",
            "case.toml:",
        ],
        help: "write fewer `coefficients`",
        remedy: Remedy::Change("[1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0]", "[0]"),
        gone: None,
    }
    .holds();
}

/// A file of these triangles.
fn stl(triangles: &[[[f64; 3]; 3]]) -> String {
    let mut text = "solid floor\n".to_owned();
    for triangle in triangles {
        text += "facet normal 0 0 1\nouter loop\n";
        for [x, y, z] in triangle {
            text += &format!("vertex {x} {y} {z}\n");
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid floor\n"
}

/// The brick upside down on a floor of triangles.
fn on_triangles(triangles: &[[[f64; 3]; 3]]) -> crate::support::Ended {
    let text = change(
        BRICK,
        "top = { faces",
        "sole = { faces = [[1, \"-z\"]] }\ntop = { faces",
    );
    let text = change(
        &text,
        "base = { nodes = [1, 2, 3, 4] }",
        "base = { nodes = [5, 6, 7, 8] }",
    );
    let text = change(
        &text,
        "[[step]]",
        "[[surface]]\nname = \"floor\"\nshape = { stl = \"floor.stl\" }\n\
         [[contact]]\nname = \"rest\"\nsecondary = \"sole\"\nprimary = \"floor\"\n[[step]]",
    );
    let folder = folder_with(&text);
    std::fs::write(folder.path().join("floor.stl"), stl(triangles)).unwrap();
    run(folder.path(), &["run", "case.toml"])
}

#[test]
fn triangles_that_make_no_surface() {
    let [a, b, c, d] =
        [[-5.0, -5.0], [5.0, -5.0], [5.0, 5.0], [-5.0, 5.0]].map(|[x, y]| [x, y, 0.0]);
    let middle = [0.0, -5.0, 0.0];
    let whole = [[a, b, c], [a, c, d]];
    for (triangles, says, help, mended) in [
        (
            vec![[a, b, c], [a, d, c]],
            "triangles 1 and 2 run along their common edge in the same direction",
            "reverse the order of the corners of one of them",
            whole.to_vec(),
        ),
        (
            vec![[a, b, c], [a, c, d], [a, middle, b]],
            "triangle 3 has no area: its corners lie on a line",
            "take the triangle out of the file",
            whole.to_vec(),
        ),
    ] {
        let help = format!("= help: {help}");
        let before = on_triangles(&triangles);
        before.says(
            4,
            &["S0309", "surface \"floor\"", says, "case.toml:", &help],
        );
        on_triangles(&mended).says(0, &[]);
    }
}
