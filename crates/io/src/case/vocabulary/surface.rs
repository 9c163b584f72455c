//! Rigid surfaces that are given by a formula or by triangles.

use super::placeholders::SHAPES;
use super::*;

pub(super) static SURFACE: Table = Table {
    heading: "[[surface]]",
    doc: "rigid surfaces without a mesh, for the primary side of contacts",
    keys: &[
        key("name", Shape::Text, "its name, for `primary`").required(),
        key("shape", Shape::Table(&SHAPE), SHAPE.doc)
            .required()
            .hints(&["geometry", "type", "kind"]),
        key(
            "reference",
            Shape::Text,
            "the [reference] it moves with; absent: fixed in space",
        ),
    ],
    rules: &[],
};

/// Without the shapes that another room describes.
pub(super) static SHAPE: Table = Table {
    heading: "shape",
    doc: "what it is: one shape with its numbers",
    keys: &[key(
        "stl",
        Shape::Text,
        "path of a file of triangles, relative to the case; their normals point to the bodies",
    )
    .hints(&["file", "triangles", "mesh"])],
    rules: &[Rule::ExactlyOne(&[SHAPES, "stl"])],
};
