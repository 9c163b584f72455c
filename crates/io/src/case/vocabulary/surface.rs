//! Rigid surfaces that are given by a formula or by triangles.

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

static SHAPE: Table = Table {
    heading: "shape",
    doc: "what it is: one shape with its numbers",
    keys: &[
        key("plane", Shape::Table(&PLANE), PLANE.doc).hints(&["line", "plain"]),
        key("circle", Shape::Table(&BALL), "of a model in the plane"),
        key("sphere", Shape::Table(&BALL), BALL.doc).hints(&["ball"]),
        key("cylinder", Shape::Table(&CYLINDER), CYLINDER.doc),
        key("cone", Shape::Table(&CONE), CONE.doc),
        key("torus", Shape::Table(&TORUS), TORUS.doc).hints(&["ring"]),
        key("polynomial", Shape::Table(&POLYNOMIAL), POLYNOMIAL.doc).hints(&["parabola"]),
        key(
            "stl",
            Shape::Text,
            "path of a file of triangles, relative to the case; their normals point to the bodies",
        )
        .hints(&["file", "triangles", "mesh"]),
    ],
    rules: &[Rule::ExactlyOne(&[
        "plane",
        "circle",
        "sphere",
        "cylinder",
        "cone",
        "torus",
        "polynomial",
        "stl",
    ])],
};

static PLANE: Table = Table {
    heading: "plane",
    doc: "a plane without end; in the plane, a line",
    keys: &[
        key("point", VECTOR, "a point of it").required(),
        key(
            "normal",
            LINE,
            "\"x\", \"y\", \"z\" or a vector, towards the bodies",
        )
        .required(),
    ],
    rules: &[],
};

static BALL: Table = Table {
    heading: "a circle or sphere",
    doc: "a sphere; in the plane, write `circle`",
    keys: &[
        key("center", VECTOR, "its centre")
            .required()
            .hints(&["centre", "point"]),
        RADIUS,
        FACING,
    ],
    rules: &[],
};

static CYLINDER: Table = Table {
    heading: "cylinder",
    doc: "a cylinder without ends",
    keys: &[
        key("point", VECTOR, "a point of its axis")
            .required()
            .hints(&["center"]),
        TURNED,
        RADIUS,
        FACING,
    ],
    rules: &[],
};

static CONE: Table = Table {
    heading: "cone",
    doc: "a cone without end; bodies are outside",
    keys: &[
        key("apex", VECTOR, "its tip")
            .required()
            .hints(&["tip", "point"]),
        key(
            "axis",
            LINE,
            "\"x\", \"y\", \"z\" or a vector, from the tip into the cone",
        )
        .required(),
        key(
            "half_angle",
            Shape::Number(Bounds {
                above: Some(0.0),
                below: Some(90.0),
                ..FREE
            }),
            "between the axis and the surface (degrees)",
        )
        .required()
        .hints(&["angle"]),
    ],
    rules: &[],
};

static TORUS: Table = Table {
    heading: "torus",
    doc: "a ring with a round section",
    keys: &[
        key("center", VECTOR, "its centre")
            .required()
            .hints(&["centre", "point"]),
        TURNED,
        key(
            "radius",
            POSITIVE,
            "from the axis to the middle of the tube",
        )
        .required(),
        key("tube", POSITIVE, "radius of the tube")
            .required()
            .hints(&["minor_radius"]),
        FACING,
    ],
    rules: &[],
};

static POLYNOMIAL: Table = Table {
    heading: "polynomial",
    doc: "the curve y = c_n x^n + … + c_0, the same for all z",
    keys: &[
        key(
            "coefficients",
            Shape::List(&ANY, 1, MANY),
            "[c_n, …, c_0], the highest power first",
        )
        .required()
        .hints(&["coeffs"]),
        key(
            "side",
            Shape::Choice(&[word("above"), word("below")]),
            "where bodies are",
        )
        .or(Default::Text("above")),
    ],
    rules: &[],
};

const RADIUS: Key = key("radius", POSITIVE, "its radius")
    .required()
    .hints(&["r"]);
const TURNED: Key = key(
    "axis",
    LINE,
    "\"x\", \"y\", \"z\" or a vector along its axis",
)
.required();
const FACING: Key = key(
    "side",
    Shape::Choice(&[word("outside"), word("inside")]),
    "where bodies are",
)
.or(Default::Text("outside"));
