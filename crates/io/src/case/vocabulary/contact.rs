//! Contacts.

use super::*;

pub(super) static CONTACT: Table = Table {
    heading: "[[contact]]",
    doc: "pairs of surfaces that may touch",
    keys: &[
        key("name", Shape::Text, "its name, in results and messages").required(),
        key(
            "secondary",
            Shape::Text,
            "the side that carries the points: the finer or more curved one",
        )
        .required()
        .hints(&["slave", "source"]),
        key("primary", Shape::Text, "the side they may not pass through")
            .required()
            .hints(&["master", "target"]),
        key(
            "method",
            Shape::Choice(METHODS),
            "how the sides are discretized",
        )
        .or(Default::Text("auto")),
        key(
            "enforcement",
            Shape::Either(ENFORCEMENTS),
            "how penetration is prevented",
        )
        .or(Default::Text("auto")),
        key(
            "friction",
            Shape::Either(FRICTIONS),
            "coefficient of friction",
        )
        .or(Default::Number(0.0))
        .hints(&["mu"]),
        key(
            "sliding",
            Shape::Choice(&[word("finite"), Choice::later("small", "finite")]),
            "how far points slide",
        )
        .or(Default::Text("finite")),
        key(
            "passes",
            Shape::Integer(1, 2),
            "1, or 2: also with the sides swapped",
        )
        .or(Default::Integer(1)),
        key(
            "tied",
            Shape::Either(&[Shape::Flag, Shape::Later(&Shape::Table(&LATER), "")]),
            "whether the sides are glued",
        )
        .or(Default::Flag(false)),
        key(
            "reach",
            Shape::Either(&[AUTO, POSITIVE]),
            "how far the sides are searched for each other (length)",
        )
        .or(Default::Text("auto")),
        key(
            "active",
            Shape::Flag,
            "whether it acts from the first step on",
        )
        .or(Default::Flag(true)),
        key("rule", Shape::Table(&LATER), "integration points").later(""),
        key("area", Shape::Text, "reference or current")
            .later("leave it away: areas are those of the reference"),
        key(
            "start",
            Shape::Table(&LATER),
            "gaps and overlaps at the start",
        )
        .later("close gaps in the mesh"),
        key("normals", Shape::Text, "whose normals")
            .later("leave it away: normals are those of the primary side"),
        key("pairs", Shape::Text, "how nodes are paired").later(""),
    ],
    rules: &[],
};
const METHODS: &[Choice] = &[
    word("auto"),
    word("node-to-segment"),
    Choice::later("node-to-node", "node-to-segment"),
    Choice::later("gauss-point", "node-to-segment"),
    Choice::later("mortar", "node-to-segment"),
];
const ENFORCEMENTS: &[Shape] = &[AUTO, Shape::Table(&ENFORCEMENT)];
const FRICTIONS: &[Shape] = &[
    NOT_NEGATIVE,
    Shape::Later(&Shape::Table(&LATER), "friction = 0.0"),
];

pub(super) static ENFORCEMENT: Table = Table {
    heading: "enforcement",
    doc: "how penetration is prevented",
    keys: &[
        key(
            "penalty",
            Shape::Either(PENALTIES),
            "force or pressure per penetration",
        )
        .or(Default::Text("auto"))
        .hints(&["stiffness", "epsilon"]),
        key(
            "per",
            Shape::Choice(&[word("node"), word("area")]),
            "a force per node, or a pressure; absent: by what the secondary side is",
        ),
        key("gap_tol", ANY, "penetration allowed").later("solver.newton.gap_tol"),
        key("exponential", Shape::Table(&LATER), "soft contact").later("{ penalty = \"auto\" }"),
        key(
            "lagrange",
            Shape::Table(&LATER),
            "no penetration, by multipliers",
        )
        .later("{ penalty = \"auto\" }"),
        key("augmented", Shape::Text, "augmented Lagrangian").later("{ penalty = \"auto\" }"),
    ],
    rules: &[],
};
const PENALTIES: &[Shape] = &[AUTO, POSITIVE, Shape::Later(&TIME_TABLE, "one number")];
