//! Amplitudes and steps.

use super::contact::CONTACT_CHANGE;
use super::placeholders::LOADS;
use super::*;
use crate::case::parts::{ERROR_TOL, IMPACT_STEP, SCALING_LIMIT};

pub(super) static AMPLITUDE: Table = Table {
    heading: "[amplitude.NAME]",
    doc: "functions of time: linear between rows and constant outside, or of the program",
    keys: &[
        key("table", TIME_TABLE, "rows [time, value]; times increase"),
        own::AMPLITUDE,
        key(
            "time",
            Shape::Choice(&[word("step"), word("total")]),
            "time of the step, or of the whole run",
        )
        .or(Default::Text("step")),
    ],
    rules: &[Rule::ExactlyOne(&["table", OWN])],
};

pub(super) static STEP: Table = Table {
    heading: "[[step]]",
    doc: "what happens, in order; a step keeps what earlier ones set",
    keys: &[
        key("name", Shape::Text, "its name, in results and messages").required(),
        key(
            "kind",
            Shape::Choice(&[
                word("static"),
                word("dynamic"),
                word("frequency"),
                word("heat"),
                word("coupled"),
            ]),
            "the kind of analysis: equilibrium, a motion in time with inertia, natural frequencies about the state that \
             earlier steps lead to, which stays as it is, temperatures alone, or equilibrium and temperatures together",
        )
        .or(Default::Text("static")),
        key(
            "thermal",
            Shape::Choice(&[word("steady"), word("transient")]),
            "of heat and coupled steps: heat in equilibrium, or stored by bodies as time passes; loads and temperatures then act \
             at once unless they have a table or an amplitude",
        )
        .hints(&["steady", "transient"]),
        key("dynamics", Shape::Table(&DYNAMICS), DYNAMICS.doc),
        key("frequency", Shape::Table(&FREQUENCY), FREQUENCY.doc).hints(&["modal", "modes", "eigen"]),
        key(
            "geometry",
            Shape::Choice(&[word("auto"), word("linear"), word("nonlinear")]),
            "small displacements or any; auto: as the step before, at first nonlinear, and in frequency steps",
        )
        .or(Default::Text("auto"))
        .hints(&["nlgeom"]),
        key("duration", POSITIVE, "how long it takes")
            .or(Default::Number(1.0))
            .hints(&["time", "period"]),
        key(
            "increments",
            Shape::Either(INCREMENTS),
            "a number, { fixed } or { initial, min, max, count_max }",
        )
        .or(Default::Integer(10))
        .hints(&["increment"]),
        key("fix", Shape::Tables(&FIX), FIX.doc).hints(&["boundary", "support"]),
        key("move", Shape::Tables(&MOVE), MOVE.doc).hints(&["displacement"]),
        key("free", Shape::Tables(&FREE_TABLE), FREE_TABLE.doc),
        key("load", Shape::Tables(&LOAD), LOAD.doc).hints(&["force"]),
        key(
            "contact",
            Shape::Tables(&CONTACT_CHANGE),
            CONTACT_CHANGE.doc,
        ),
        key(
            "material",
            Shape::Tables(&MATERIAL_CHANGE),
            MATERIAL_CHANGE.doc,
        )
        .hints(&["section"]),
        key("activate", Shape::Tables(&ACTIVATE), ACTIVATE.doc).hints(&["add", "birth"]),
        key("deactivate", Shape::Tables(&DEACTIVATE), DEACTIVATE.doc).hints(&["remove", "death"]),
        key("temperature", Shape::Tables(&TEMPERATURE), TEMPERATURE.doc),
        key("print", Shape::Tables(&PRINT), PRINT.doc).hints(&["table", "dat"]),
    ],
    rules: &[],
};

static DYNAMICS: Table = Table {
    heading: "dynamics",
    doc: "how a dynamic step goes through time",
    keys: &[
        key(
            "method",
            Shape::Choice(&[
                word("generalized-alpha"),
                word("energy-momentum"),
                word("explicit"),
            ]),
            "implicit, of second order; energy-momentum: forces of bodies and contacts with a penalty do exactly the work of their \
             energy; explicit: central differences with masses at nodes, in short increments that follow from what is stable, as \
             many as an increment takes",
        )
        .or(Default::Text("generalized-alpha")),
        key(
            "rho_inf",
            Shape::Number(Bounds {
                from: Some(0.0),
                to: Some(1.0),
                ..FREE
            }),
            "the spectral radius of the highest frequencies: 1 keeps them, 0 takes them away in an increment; absent: 0.8",
        )
        .hints(&["rho", "spectral_radius"]),
        key(
            "alpha",
            Shape::Number(Bounds {
                from: Some(-1.0 / 3.0),
                to: Some(0.0),
                ..FREE
            }),
            "in its place, that of Hilber, Hughes and Taylor; 0: the trapezoidal rule of Newmark",
        ),
        key(
            "contact_mass",
            Shape::Choice(&[word("as-is"), word("redistributed")]),
            "redistributed: elements with nodes on a side of a contact give their mass to their other nodes; impacts then neither \
             flicker nor lose energy",
        )
        .or(Default::Text("as-is")),
        key(
            "contact_force",
            Shape::Choice(&[word("end"), word("weighted")]),
            "end: contact acts as a whole, as it is at the end of an increment; weighted: of penalties and curves, with its share of \
             all forces, and what it was before, as CalculiX does: hard contact flickers then",
        )
        .or(Default::Text("end")),
        key(
            "error_tol",
            NOT_NEGATIVE,
            "of increments that adapt: their local error of displacements, over the largest displacement so far; 0: it does not count",
        )
        .or(Default::Number(ERROR_TOL)),
        key(
            "impact_step",
            NOT_NEGATIVE,
            "of increments that adapt: the longest in which contact closes or opens, over the time that a wave takes through an element \
             of the secondary side; 0: any",
        )
        .or(Default::Number(IMPACT_STEP)),
        key(
            "safety",
            Shape::Number(Bounds {
                above: Some(0.0),
                to: Some(1.0),
                ..FREE
            }),
            "explicit: the length of short increments, over the longest that is stable; absent: 0.9",
        ),
        key("mass_scaling", Shape::Table(&MASS_SCALING), MASS_SCALING.doc),
    ],
    rules: &[Rule::AtMostOne(&["rho_inf", "alpha"])],
};

static MASS_SCALING: Table = Table {
    heading: "mass_scaling",
    doc: "explicit: mass added to elements that would need shorter increments than this",
    keys: &[
        key(
            "step",
            POSITIVE,
            "the shortest increment that is wanted (time)",
        )
        .required(),
        key(
            "limit",
            NOT_NEGATIVE,
            "the mass that may be added, over that of all bodies",
        )
        .or(Default::Number(SCALING_LIMIT)),
    ],
    rules: &[],
};

static FREQUENCY: Table = Table {
    heading: "frequency",
    doc: "which natural frequencies a frequency step finds",
    keys: &[
        key(
            "modes",
            Shape::Integer(1, 10_000),
            "how many, the lowest first; rigid motions of free bodies count",
        )
        .or(Default::Integer(10))
        .hints(&["count", "number"]),
        key(
            "lower",
            NOT_NEGATIVE,
            "the frequency above which they begin (cycles per time); absent: with the lowest",
        )
        .hints(&["from", "min", "shift"]),
        key(
            "upper",
            POSITIVE,
            "the frequency at which they end, where there are not as many; absent: nowhere",
        )
        .hints(&["to", "max"]),
    ],
    rules: &[],
};
const INCREMENTS: &[Shape] = &[COUNT, Shape::Table(&INCREMENTS_TABLE)];

pub(super) static INCREMENTS_TABLE: Table = Table {
    heading: "increments",
    doc: "how the step is cut into increments: a smaller one after a failure; after two easy ones a larger one, or all that is left of the step where that is not much more",
    keys: &[
        key("fixed", COUNT, "exactly so many equal ones"),
        key(
            "initial",
            POSITIVE,
            "the first one, in the time of the step",
        )
        .hints(&["start", "dt"]),
        key(
            "min",
            POSITIVE,
            "the smallest one; absent: 1e-5 of the step",
        )
        .hints(&["dt_min"]),
        key("max", POSITIVE, "the largest one; absent: the whole step").hints(&["dt_max"]),
        key("count_max", COUNT, "how many there may be").or(Default::Integer(1000)),
    ],
    rules: &[
        Rule::ExactlyOne(&["fixed", "initial"]),
        Rule::Needs("min", "initial"),
        Rule::Needs("max", "initial"),
        Rule::Needs("count_max", "initial"),
    ],
};

const DIRECTIONS: Shape = Shape::Either(&[Shape::Choice(&[word("all")]), Shape::List(&AXIS, 1, 3)]);

/// What a change of a step acts on.
const ON: Key = key("on", Shape::Text, ON_DOC)
    .required()
    .hints(&["set", "group", "name"]);

pub(super) static FIX: Table = Table {
    heading: "[[step.fix]]",
    doc: "supports, at the present position",
    keys: &[
        ON,
        key(
            "u",
            DIRECTIONS,
            "displacements held: \"all\" or a list of \"x\", \"y\", \"z\"",
        )
        .hints(&["displacement", "dofs"]),
        key(
            "rot",
            DIRECTIONS,
            "rotations held, of a reference, rigid body or shell nodes",
        )
        .hints(&["rotation", "r"]),
    ],
    rules: &[Rule::AtLeastOne(&["u", "rot"])],
};

pub(super) static FREE_TABLE: Table = Table {
    heading: "[[step.free]]",
    doc: "supports and motions of earlier steps that end",
    keys: &[
        ON,
        key(
            "u",
            DIRECTIONS,
            "displacements set free: \"all\" or a list of \"x\", \"y\", \"z\"",
        )
        .hints(&["displacement", "dofs"]),
        key(
            "rot",
            DIRECTIONS,
            "rotations set free, of a reference, rigid body or shell nodes",
        )
        .hints(&["rotation", "r"]),
        key(
            "temperature",
            Shape::Flag,
            "whether temperatures that earlier steps gave are set free",
        )
        .or(Default::Flag(false)),
    ],
    rules: &[Rule::AtLeastOne(&["u", "rot", "temperature"])],
};

pub(super) static MOVE: Table = Table {
    heading: "[[step.move]]",
    doc: "prescribed motions: a number is reached linearly over the step",
    keys: &[
        ON,
        key("ux", MOTION, "displacement along x").hints(&["x"]),
        key("uy", MOTION, "displacement along y").hints(&["y"]),
        key("uz", MOTION, "displacement along z").hints(&["z"]),
        key(
            "rx",
            MOTION,
            "rotation about x, in radian, of a reference or rigid body",
        ),
        key(
            "ry",
            MOTION,
            "rotation about y, in radian, of a reference or rigid body",
        ),
        key(
            "rz",
            MOTION,
            "rotation about z, in radian, of a reference or rigid body",
        ),
        key("from", Shape::Table(&FROM), FROM.doc).hints(&["global", "submodel"]),
    ],
    rules: &[Rule::AtLeastOne(&[
        "ux", "uy", "uz", "rx", "ry", "rz", "from",
    ])],
};

pub(super) static FROM: Table = Table {
    heading: "from",
    doc: "the results of another model, whose displacements nodes have at their places",
    keys: &[
        key(
            "file",
            Shape::Text,
            "its results: a .frd, .vtu or .pvd file, or a folder of results",
        )
        .required()
        .hints(&["input", "path"]),
        key(
            "step",
            COUNT,
            "the number of its step; the end of it counts",
        ),
        key(
            "data_set",
            COUNT,
            "the number of the displacement field, in place of a step",
        ),
        key(
            "elements",
            Shape::List(&COUNT, 1, MANY),
            "the numbers of its elements that count; absent: all",
        ),
        key(
            "u",
            DIRECTIONS,
            "displacements prescribed: \"all\" or a list of \"x\", \"y\", \"z\"",
        )
        .or(Default::Text("all")),
        key(
            "ramp",
            Shape::Flag,
            "whether they are reached linearly over the step; false: from its first increment on",
        )
        .or(Default::Flag(true)),
    ],
    rules: &[Rule::ExactlyOne(&["step", "data_set"])],
};
const MOTION: Shape = Shape::Either(&[ANY, Shape::Table(&MOTION_TABLE)]);

pub(super) static MOTION_TABLE: Table = Table {
    heading: "a motion",
    doc: "the course of a prescribed component or temperature",
    keys: &[
        key(
            "table",
            TIME_TABLE,
            "rows [time of the step, value]; times increase",
        ),
        key("amplitude", Shape::Text, "the name of an amplitude"),
        key("value", ANY, "what the amplitude is multiplied with").or(Default::Number(1.0)),
    ],
    rules: &[
        Rule::ExactlyOne(&["table", "amplitude"]),
        Rule::Needs("value", "amplitude"),
    ],
};

/// Without the kinds of loads, which another room describes.
pub(super) static LOAD: Table = Table {
    heading: "[[step.load]]",
    doc: "loads, reached linearly over the step unless `table` or `amplitude` says otherwise",
    keys: &[
        key(
            "name",
            Shape::Text,
            "its name: a later load of this name replaces it",
        ),
        key("on", Shape::Text, ON_DOC)
            .required()
            .hints(&["set", "group"]),
        key(
            "follows",
            Shape::Flag,
            "whether a pressure turns with the surface; absent: it does in nonlinear steps",
        )
        .hints(&["follower"]),
        key(
            "coupling",
            Shape::Choice(&[
                word("none"),
                word("rigid-x"),
                word("rigid-y"),
                word("rigid-z"),
            ]),
            "the direction in which what is loaded keeps one common displacement, in the whole run",
        )
        .or(Default::Text("none")),
        key(
            "table",
            TIME_TABLE,
            "rows [time of the step, factor]; times increase",
        ),
        key(
            "amplitude",
            Shape::Text,
            "the name of an amplitude, a factor over time",
        ),
    ],
    rules: &[
        Rule::ExactlyOne(&[LOADS]),
        Rule::AtMostOne(&["table", "amplitude"]),
    ],
};

static MATERIAL_CHANGE: Table = Table {
    heading: "[[step.material]]",
    doc: "bodies that are made of another material from this step on",
    keys: &[
        key("group", Shape::Text, "the group of the body")
            .required()
            .hints(&["body", "on"]),
        key("material", Shape::Text, "its new material").required(),
    ],
    rules: &[],
};

/// What elements are removed and added by.
const GROUP: Key = key("group", Shape::Text, "the group or set of elements")
    .required()
    .hints(&["on", "set", "body", "elements"]);

static ACTIVATE: Table = Table {
    heading: "[[step.activate]]",
    doc: "elements that take part again from this step on, with their loads and contact faces",
    keys: &[
        GROUP,
        key(
            "strain",
            Shape::Choice(&[word("free"), word("keep")]),
            "free: without stress where they are now, as new; keep: with the strain and the history that they have",
        )
        .or(Default::Text("free")),
    ],
    rules: &[],
};

static DEACTIVATE: Table = Table {
    heading: "[[step.deactivate]]",
    doc: "elements that take no part from this step on, nor do their loads and contact faces",
    keys: &[
        GROUP,
        key(
            "ramp",
            Shape::Flag,
            "whether what they exert falls to zero over the step; false: it is gone at once",
        )
        .or(Default::Flag(true)),
    ],
    rules: &[],
};

static TEMPERATURE: Table = Table {
    heading: "[[step.temperature]]",
    doc: "temperatures, reached linearly over the step, and at once in transient ones; others stay, or are unknown in heat and coupled steps",
    keys: &[
        key("on", Shape::Text, "the set or group; \"all\" is everything")
            .required()
            .hints(&["set", "group"]),
        key(
            "value",
            MOTION,
            "the temperature at the end of the step; its course, in heat and coupled steps",
        )
        .required(),
        key(
            "gradient",
            ANY,
            "of shells: change of temperature per length along their normal, with the course of `value`, which is that of the middle surface; absent: 0",
        ),
    ],
    rules: &[],
};

static PRINT: Table = Table {
    heading: "[[step.print]]",
    doc: "tables in NAME.dat, in CalculiX's format; absent: those of the step before, [] ends them",
    keys: &[
        key(
            "on",
            Shape::Text,
            "the set or group of nodes, elements or faces, or the contact; absent: every contact",
        )
        .hints(&["set", "group", "name"]),
        key(
            "nodes",
            Shape::List(&Shape::Choice(OF_NODES), 1, MANY),
            "quantities of nodes",
        )
        .hints(&["node"]),
        key(
            "elements",
            Shape::List(&Shape::Choice(OF_ELEMENTS), 1, MANY),
            "quantities of elements, at their integration points where they vary",
        )
        .hints(&["element"]),
        key(
            "contact",
            Shape::List(&Shape::Choice(OF_CONTACTS), 1, MANY),
            "quantities of contact, at the points of its secondary side or in all",
        ),
        key(
            "faces",
            Shape::List(&Shape::Choice(OF_FACES), 1, MANY),
            "quantities of faces, inside a body or around it: force and moment of the stresses at their nodes",
        )
        .hints(&["section", "face"]),
        key(
            "totals",
            Shape::Choice(&[word("no"), word("yes"), word("only")]),
            "whether sums over the set follow: of reactions, energies, volumes",
        )
        .or(Default::Text("no")),
        key(
            "local",
            Shape::Flag,
            "whether vectors at nodes are printed along their [[axes]], and tensors at points along the axes of the material",
        )
        .or(Default::Flag(false)),
        key(
            "every",
            COUNT,
            "after so many increments, and at the end of the step",
        )
        .or(Default::Integer(1))
        .hints(&["frequency"]),
    ],
    rules: &[
        Rule::ExactlyOne(&["nodes", "elements", "contact", "faces"]),
        Rule::Needs("nodes", "on"),
        Rule::Needs("elements", "on"),
        Rule::Needs("faces", "on"),
    ],
};

const OF_NODES: &[Choice] = &[
    word("displacement"),
    word("reaction"),
    word("temperature"),
    word("heat-reaction"),
];
const OF_ELEMENTS: &[Choice] = &[
    word("stress"),
    word("strain"),
    word("mechanical-strain"),
    word("plastic-strain"),
    word("energy-density"),
    word("energy"),
    word("volume"),
    word("spin-squared"),
    word("heat-flux"),
];
const OF_FACES: &[Choice] = &[word("force")];
const OF_CONTACTS: &[Choice] = &[
    word("gap"),
    word("traction"),
    word("energy"),
    word("count"),
    word("force"),
    word("normal-force"),
    word("shear-force"),
];
