//! The mesh, the model, sets, references.

use super::*;

pub(super) static MESH: Table = Table {
    heading: "[mesh]",
    doc: "nodes and elements: a file, or written in place",
    keys: &[
        key(
            "file",
            Shape::Text,
            "path of a mesh file, relative to the case",
        )
        .hints(&["path", "name"]),
        key(
            "nodes",
            Shape::Nodes,
            "rows [id, x, y, z]; [id, x, y] in the plane",
        ),
        key("elements", Shape::Tables(&ELEMENT), "the elements"),
    ],
    rules: &[
        Rule::ExactlyOne(&["file", "nodes"]),
        Rule::Needs("nodes", "elements"),
        Rule::Needs("elements", "nodes"),
    ],
};

pub(super) static ELEMENT: Table = Table {
    heading: "an element",
    doc: "an element written in place",
    keys: &[
        key("id", ID, "its number").required(),
        key("type", Shape::Text, "its type, as in hex8 or tet4").required(),
        key("group", Shape::Text, "the group it belongs to"),
        key(
            "nodes",
            Shape::List(&ID, 1, MANY),
            "the numbers of its nodes",
        )
        .required(),
    ],
    rules: &[],
};

pub(super) static MODEL: Table = Table {
    heading: "[model]",
    doc: "dimension of the model",
    keys: &[
        key(
            "space",
            Shape::Choice(SPACES),
            "space, a plane, or a body of revolution (r = x, axis y)",
        )
        .or(Default::Text("3d")),
        key(
            "thickness",
            POSITIVE,
            "thickness of a model in plane strain or plane stress",
        )
        .or(Default::Number(1.0)),
        key(
            "compat",
            Shape::Choice(&[word("none")]),
            "laws as another program has them",
        )
        .later("leave it away: laws are as the manual describes them"),
    ],
    rules: &[],
};
const SPACES: &[Choice] = &[word("3d"), PLANES[0], PLANES[1], PLANES[2]];
/// What a plane stands for.
pub(super) const PLANES: &[Choice] = &[
    word("plane-strain"),
    word("plane-stress"),
    word("axisymmetric"),
];

pub(super) static SET: Table = Table {
    heading: "[sets]",
    doc: "named sets of nodes, elements or faces",
    keys: &[
        key("nodes", Shape::List(&ID, 1, MANY), "numbers of nodes").hints(&["node"]),
        key("elements", Shape::List(&ID, 1, MANY), "numbers of elements").hints(&["element", "cells"]),
        key("faces", Shape::List(&Shape::Row("[element, side]", &[ID, Shape::Text]), 1, MANY),
            "rows [element, side]: side \"S1\", \"S2\", … as in Abaqus, or \"+z\", \"-x\", … by its normal; of shells S1 is the negative side, S2 the positive one, S3, S4, … the edges").hints(&["face"]),
        key("union", Shape::List(&Shape::Text, 1, MANY), "names of sets or groups"),
        key("plane", LINE, "what lies in a plane: \"x\", \"y\", \"z\" or a vector normal to it"),
        key("at", ANY, "distance of the plane from the origin, along its normal"),
        key("tol", POSITIVE, "distance from the plane up to which nodes count; absent: 1e-6 of the size of the mesh"),
        key("box", Shape::List(&VECTOR, 2, 2), "what lies between two corners: [[x, y, z], [x, y, z]]"),
        key("near", VECTOR, "the node nearest to a point"),
        key("sphere", Shape::Row("[[x, y, z], radius]", &[VECTOR, POSITIVE]), "what lies in a sphere"),
        key("of", Shape::Text, "the body or group whose nodes are searched; absent: all"),
    ],
    rules: &[
        Rule::ExactlyOne(&["nodes", "elements", "faces", "union", "plane", "box", "near", "sphere"]),
        Rule::Needs("plane", "at"),
        Rule::Needs("at", "plane"),
        Rule::Needs("tol", "plane"),
    ],
};

pub(super) static REFERENCE: Table = Table {
    heading: "[reference]",
    doc: "named points with translations and rotations of their own; without `at` and `node` in the mean of the nodes \
          that move with it",
    keys: &[
        key("at", VECTOR, "where it is at the start").hints(&["point", "position"]),
        key("node", ID, "the node where it is at the start"),
        key(
            "rotations",
            ID,
            "a node that stands for its rotations where displacements of nodes are printed",
        ),
    ],
    rules: &[Rule::AtMostOne(&["at", "node"])],
};

pub(super) static AXES: Table = Table {
    heading: "[[axes]]",
    doc: "local axes of nodes, that  local = true  of [[step.print]] prints along; the last that names a node holds",
    keys: &[
        key("set", Shape::Text, "the set or group of nodes")
            .required()
            .hints(&["on"]),
        OF_AXES[0],
        OF_AXES[1],
        OF_AXES[2],
        OF_AXES[3],
    ],
    rules: AXES_RULES,
};

/// How local axes lie: by two vectors, or by two points of the axis of a cylindrical system.
pub(super) const OF_AXES: [Key; 4] = [
    key(
        "x",
        VECTOR,
        "a vector along the first axis, the same everywhere",
    ),
    key(
        "xy",
        VECTOR,
        "a vector in the plane of the first and the second",
    ),
    key(
        "from",
        VECTOR,
        "a point of the axis of a cylindrical system: radial, circumferential, along the axis",
    ),
    key("to", VECTOR, "another one"),
];
pub(super) const AXES_RULES: &[Rule] = &[
    Rule::ExactlyOne(&["x", "from"]),
    Rule::Needs("x", "xy"),
    Rule::Needs("xy", "x"),
    Rule::Needs("from", "to"),
    Rule::Needs("to", "from"),
];

pub(super) static CONSTANTS: Table = Table {
    heading: "[constants]",
    doc: "constants of nature, in the units of the case: radiation needs them",
    keys: &[
        key(
            "stefan_boltzmann",
            POSITIVE,
            "heat per time and area of a black surface over its absolute temperature to the fourth power",
        )
        .required()
        .hints(&["sigma"]),
        key("absolute_zero", ANY, "absolute zero, on the scale of temperatures").required(),
    ],
    rules: &[],
};

pub(super) static INITIAL: Table = Table {
    heading: "[initial]",
    doc: "fields at the start",
    keys: &[
        key(
            "temperature",
            ANY,
            "temperature of everything; absent: that at which materials have no thermal strain",
        ),
        key("at", Shape::Tables(&INITIAL_AT), INITIAL_AT.doc),
        key(
            "velocity",
            Shape::Tables(&INITIAL_VELOCITY),
            INITIAL_VELOCITY.doc,
        ),
        key(
            "stress",
            POINTS,
            "stress without strain at integration points, rows [element, point, xx, yy, zz, xy, xz, yz]",
        ),
        key(
            "strain",
            POINTS,
            "strain without stress at integration points, likewise; shears are those of the tensor",
        )
        .hints(&["plastic_strain"]),
    ],
    rules: &[Rule::AtLeastOne(&[
        "temperature",
        "at",
        "velocity",
        "stress",
        "strain",
    ])],
};

pub(super) static THICKNESS: Table = Table {
    heading: "[[thickness]]",
    doc: "thickness at nodes, of plane bodies and shells with thickness = \"field\"; of several that name a node the last holds",
    keys: &[
        key("on", Shape::Text, "the set or group")
            .required()
            .hints(&["set", "group"]),
        key("value", POSITIVE, "the thickness there (length)").required(),
    ],
    rules: &[],
};

static INITIAL_VELOCITY: Table = Table {
    heading: "[[initial.velocity]]",
    doc: "velocities at the start of the first step, if it is dynamic; of several that name a node the last holds",
    keys: &[
        key("on", Shape::Text, "the set, group, reference or rigid body")
            .required()
            .hints(&["set", "group"]),
        key(
            "v",
            VECTOR,
            "velocity; of the point `about`, where there is an `omega`",
        )
        .hints(&["velocity"]),
        key(
            "omega",
            Shape::Either(&[ANY, VECTOR]),
            "angular velocity (radian/time); a number in the plane",
        ),
        key("about", VECTOR, "a point of its axis; absent: the origin"),
    ],
    rules: &[
        Rule::AtLeastOne(&["v", "omega"]),
        Rule::Needs("about", "omega"),
    ],
};

static INITIAL_AT: Table = Table {
    heading: "[[initial.at]]",
    doc: "temperatures at the start that differ from that of everything; of several that name a node the last holds",
    keys: &[
        key("on", Shape::Text, "the set or group")
            .required()
            .hints(&["set", "group"]),
        key("temperature", ANY, "the temperature at the start").required(),
        key(
            "gradient",
            ANY,
            "of shells: change of temperature per length along their normal; `temperature` is that of the middle surface; absent: 0",
        ),
    ],
    rules: &[],
};
const POINTS: Shape = Shape::List(
    &Shape::Row(
        "[element, point, xx, yy, zz, xy, xz, yz]",
        &[ID, COUNT, ANY, ANY, ANY, ANY, ANY, ANY],
    ),
    1,
    MANY,
);
