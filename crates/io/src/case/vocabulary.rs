//! The words of a case: every key with its form, default, range and meaning, in one place.
//!
//! Reading, messages about unknown keys, the JSON schema and the resolved case all follow these tables. What the
//! format knows but this version cannot do stands here too, marked as `later`, so that
//! it is refused by name.
//!
//! To add a key: one line here, one field in `parts`, one line each in `build` and `resolved`.

/// A table of a case: what may stand in it.
#[derive(Debug)]
pub struct Table {
    /// How users write it, as in `[[contact]]`.
    pub heading: &'static str,
    /// What it is.
    pub doc: &'static str,
    /// Its keys, in the order in which they are listed and written.
    pub keys: &'static [Key],
    /// Which keys exclude or need each other.
    pub rules: &'static [Rule],
}

impl Table {
    /// The entry of a key.
    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }

    /// The names of all keys this version reads.
    pub fn names(&self) -> impl Iterator<Item = &'static str> + Clone + use<> {
        self.keys
            .iter()
            .filter(|key| key.later.is_none())
            .map(|key| key.name)
    }
}

/// A key of a table.
#[derive(Debug)]
pub struct Key {
    /// Its name.
    pub name: &'static str,
    /// The form of its value.
    pub shape: Shape,
    /// What holds where it is absent.
    pub default: Default,
    /// What it means, in one line.
    pub doc: &'static str,
    /// Other words people use for it; they are proposed, never read.
    pub hints: &'static [&'static str],
    /// Known, but not supported by this version: what to use instead, which may be empty.
    pub later: Option<&'static str>,
}

impl Key {
    const fn required(mut self) -> Self {
        self.default = Default::Required;
        self
    }

    const fn or(mut self, default: Default) -> Self {
        self.default = default;
        self
    }

    const fn hints(mut self, hints: &'static [&'static str]) -> Self {
        self.hints = hints;
        self
    }

    /// Known, but not supported by this version.
    const fn later(mut self, instead: &'static str) -> Self {
        self.later = Some(instead);
        self
    }
}

const fn key(name: &'static str, shape: Shape, doc: &'static str) -> Key {
    Key {
        name,
        shape,
        default: Default::Absent,
        doc,
        hints: &[],
        later: None,
    }
}

/// What holds where a key is absent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Default {
    /// It must be given.
    Required,
    /// Nothing.
    Absent,
    /// A text or word.
    Text(&'static str),
    /// Several texts or words.
    Texts(&'static [&'static str]),
    /// A number.
    Number(f64),
    /// A whole number.
    Integer(i64),
    /// A truth value.
    Flag(bool),
}

/// The form of a value.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// Any text.
    Text,
    /// One of these words.
    Choice(&'static [Choice]),
    /// A finite number in a range.
    Number(Bounds),
    /// A whole number from the first to the second.
    Integer(i64, i64),
    /// `true` or `false`.
    Flag,
    /// A list of values of one form: at least and at most so many.
    List(&'static Shape, usize, usize),
    /// A list of values of these forms.
    Row(&'static [Shape]),
    /// A value of one of these forms, which differ in their TOML type.
    Either(&'static [Shape]),
    /// A table.
    Table(&'static Table),
    /// A list of tables.
    Tables(&'static Table),
    /// A table of tables by names of the user's choice.
    Named(&'static Table),
    /// The rows `[id, x, y, z]` of nodes, which are too many for the ordinary way.
    Nodes,
    /// A form that this version does not support: what to use instead.
    Later(&'static Shape, &'static str),
}

/// A word that a key takes.
#[derive(Clone, Copy, Debug)]
pub struct Choice {
    /// The word.
    pub word: &'static str,
    /// Known, but not supported by this version: what to use instead, which may be empty.
    pub later: Option<&'static str>,
}

impl Choice {
    const fn later(word: &'static str, instead: &'static str) -> Self {
        Self {
            word,
            later: Some(instead),
        }
    }
}

const fn word(word: &'static str) -> Choice {
    Choice { word, later: None }
}

/// The range of a number: exclusive (`above`, `below`) or inclusive (`from`, `to`) ends.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// Greater than this.
    pub above: Option<f64>,
    /// At least this.
    pub from: Option<f64>,
    /// Less than this.
    pub below: Option<f64>,
    /// At most this.
    pub to: Option<f64>,
}

impl Bounds {
    /// Whether a number lies in the range.
    pub fn hold(&self, value: f64) -> bool {
        self.above.is_none_or(|end| value > end)
            && self.from.is_none_or(|end| value >= end)
            && self.below.is_none_or(|end| value < end)
            && self.to.is_none_or(|end| value <= end)
    }

    /// The range in words, as in `greater than 0`.
    pub fn words(&self) -> String {
        let ends = [
            ("greater than", self.above),
            ("at least", self.from),
            ("less than", self.below),
            ("at most", self.to),
        ];
        let words: Vec<String> = ends
            .into_iter()
            .filter_map(|(words, end)| end.map(|end| format!("{words} {end}")))
            .collect();
        words.join(" and ")
    }
}

/// Keys that exclude or need each other.
#[derive(Clone, Copy, Debug)]
pub enum Rule {
    /// Exactly one of these.
    ExactlyOne(&'static [&'static str]),
    /// At least one of these.
    AtLeastOne(&'static [&'static str]),
    /// At most one of these.
    AtMostOne(&'static [&'static str]),
    /// The first only together with the second.
    Needs(&'static str, &'static str),
}

const FREE: Bounds = Bounds {
    above: None,
    from: None,
    below: None,
    to: None,
};
const ANY: Shape = Shape::Number(FREE);
const POSITIVE: Shape = Shape::Number(Bounds {
    above: Some(0.0),
    ..FREE
});
const NOT_NEGATIVE: Shape = Shape::Number(Bounds {
    from: Some(0.0),
    ..FREE
});
const POISSON: Shape = Shape::Number(Bounds {
    above: Some(-1.0),
    below: Some(0.5),
    ..FREE
});
const ID: Shape = Shape::Integer(0, i64::MAX);
/// More increments, iterations or threads than any run has.
const COUNT: Shape = Shape::Integer(1, 1_000_000_000);
const MANY: usize = usize::MAX;
const NAMES: Shape = Shape::Either(&[Shape::Text, Shape::List(&Shape::Text, 1, MANY)]);
const VECTOR: Shape = Shape::List(&ANY, 3, 3);
const TIME_TABLE: Shape = Shape::List(&Shape::List(&ANY, 2, 2), 1, MANY);
const AUTO: Shape = Shape::Choice(&[word("auto")]);
const ON_DOC: &str = "the set, mesh group or rigid body it acts on";

/// The whole case.
pub static CASE: Table = Table {
    heading: "the case",
    doc: "A contact problem: geometry, materials, bodies, contacts, and what happens step by step.",
    keys: &[
        key("format", Shape::Integer(1, i64::MAX), "version of the case format").or(Default::Integer(1)),
        key("title", Shape::Text, "what the run is about, for reports").or(Default::Text("")),
        key("units", Shape::Text, "length-force-stress, as in mm-N-MPa: a label for reports and plausibility; nothing is converted")
            .or(Default::Text("")),
        key("allow", Shape::List(&Shape::Text, 0, MANY), "codes of warnings to silence").or(Default::Texts(&[])),
        key("mesh", Shape::Table(&MESH), MESH.doc).required(),
        key("model", Shape::Table(&MODEL), MODEL.doc),
        key("sets", Shape::Named(&SET), SET.doc).hints(&["set"]),
        key("reference", Shape::Named(&LATER), "named points that carry motions")
            .later("name a rigid body itself in `on`; it turns about its centroid"),
        key("amplitude", Shape::Named(&AMPLITUDE), AMPLITUDE.doc).hints(&["amplitudes"]),
        key("material", Shape::Named(&MATERIAL), MATERIAL.doc).hints(&["materials"]),
        key("body", Shape::Tables(&BODY), BODY.doc).required().hints(&["bodies", "part", "section"]),
        key("surface", Shape::Tables(&LATER), "analytical or triangulated rigid surfaces")
            .later("mesh the tool and make it a rigid body"),
        key("contact", Shape::Tables(&CONTACT), CONTACT.doc).hints(&["contacts", "pair", "interface"]),
        key("constraint", Shape::Tables(&LATER), "linear equations between displacements").later(""),
        key("initial", Shape::Table(&LATER), "fields at the start").later(""),
        key("step", Shape::Tables(&STEP), STEP.doc).required().hints(&["steps"]),
        key("solver", Shape::Table(&SOLVER), SOLVER.doc),
        key("output", Shape::Table(&OUTPUT), OUTPUT.doc).hints(&["results"]),
        key("checkpoint", Shape::Table(&CHECKPOINT), CHECKPOINT.doc).hints(&["restart"]),
        key("expect", Shape::Tables(&EXPECT), EXPECT.doc).hints(&["check", "test"]),
    ],
    rules: &[],
};

/// The content of tables that this version does not read.
static LATER: Table = Table {
    heading: "",
    doc: "",
    keys: &[],
    rules: &[],
};

static MESH: Table = Table {
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

static ELEMENT: Table = Table {
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

static MODEL: Table = Table {
    heading: "[model]",
    doc: "dimension of the model",
    keys: &[
        key("space", Shape::Choice(SPACES), "space or plane").or(Default::Text("3d")),
        key("thickness", POSITIVE, "thickness of a plane model").or(Default::Number(1.0)),
        key(
            "compat",
            Shape::Choice(&[word("none")]),
            "laws as another program has them",
        )
        .later("leave it away: laws are as the manual describes them"),
    ],
    rules: &[],
};
const SPACES: &[Choice] = &[
    word("3d"),
    word("plane-strain"),
    Choice::later("plane-stress", "plane-strain, or a thin body in 3d"),
    Choice::later("axisymmetric", "a wedge of the body in 3d"),
];

static SET: Table = Table {
    heading: "[sets]",
    doc: "named sets of nodes or faces",
    keys: &[
        key("nodes", Shape::List(&ID, 1, MANY), "numbers of nodes").hints(&["node"]),
        key("faces", Shape::List(&Shape::Row(&[ID, Shape::Text]), 1, MANY),
            "rows [element, side]: side \"S1\", \"S2\", … as in Abaqus, or \"+z\", \"-x\", … by its normal").hints(&["face"]),
        key("union", Shape::List(&Shape::Text, 1, MANY), "names of sets or groups"),
        key("plane", Shape::Text, "what lies in a plane").later(BY_GEOMETRY),
        key("at", ANY, "position of the plane").later(BY_GEOMETRY),
        key("tol", POSITIVE, "distance from the plane").later(BY_GEOMETRY),
        key("box", Shape::List(&VECTOR, 2, 2), "what lies in a box").later(BY_GEOMETRY),
        key("near", VECTOR, "what is nearest to a point").later(BY_GEOMETRY),
        key("sphere", Shape::Row(&[VECTOR, POSITIVE]), "what lies in a sphere").later(BY_GEOMETRY),
        key("of", Shape::Text, "the body searched").later(BY_GEOMETRY),
    ],
    rules: &[Rule::ExactlyOne(&["nodes", "faces", "union"])],
};
const BY_GEOMETRY: &str = "a group of the mesh, or `nodes` or `faces` by number";

static AMPLITUDE: Table = Table {
    heading: "[amplitude.NAME]",
    doc: "functions of time: linear between rows, constant outside",
    keys: &[
        key("table", TIME_TABLE, "rows [time, value]; times increase").required(),
        key(
            "time",
            Shape::Choice(&[word("step"), word("total")]),
            "time of the step, or of the whole run",
        )
        .or(Default::Text("step")),
    ],
    rules: &[],
};

static MATERIAL: Table = Table {
    heading: "[material.NAME]",
    doc: "materials",
    keys: &[
        key("model", Shape::Choice(MATERIALS), "the law")
            .required()
            .hints(&["law", "type"]),
        key("E", POSITIVE, "Young's modulus (stress)")
            .required()
            .hints(&["young", "youngs_modulus", "modulus"]),
        key("nu", POISSON, "Poisson's ratio")
            .required()
            .hints(&["poisson", "poissons_ratio"]),
        key("density", POSITIVE, "mass per volume").hints(&["rho"]),
        key("c10", ANY, "constant of mooney-rivlin").later("neo-hookean with E and nu"),
        key("c01", ANY, "constant of mooney-rivlin").later("neo-hookean with E and nu"),
        key("bulk", ANY, "bulk modulus").later("E and nu"),
        key("expansion", Shape::Table(&LATER), "thermal expansion").later(""),
        key("plasticity", Shape::Table(&LATER), "yielding and hardening").later(""),
    ],
    rules: &[],
};
const MATERIALS: &[Choice] = &[
    word("linear-elastic"),
    word("saint-venant-kirchhoff"),
    word("neo-hookean"),
    Choice::later("mooney-rivlin", "neo-hookean with E and nu"),
    Choice::later("orthotropic", ""),
];

static BODY: Table = Table {
    heading: "[[body]]",
    doc: "groups of elements that are solids or rigid tools",
    keys: &[
        key("group", NAMES, "the mesh group, or a list of them")
            .required()
            .hints(&["groups", "name"]),
        key(
            "material",
            Shape::Text,
            "its material; none for a rigid body",
        ),
        key("rigid", Shape::Flag, "whether it moves as a whole").or(Default::Flag(false)),
        key("reference", Shape::Text, "the point it turns about")
            .later("leave it away: a rigid body turns about its centroid"),
        key("integration", Shape::Text, "full or reduced")
            .later("leave it away: integration is full"),
        key("locking", Shape::Text, "remedy against locking")
            .later("leave it away, and keep Poisson's ratio away from one half"),
        key("orientation", Shape::Table(&LATER), "axes of the material").later(""),
    ],
    rules: &[],
};

static CONTACT: Table = Table {
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

static ENFORCEMENT: Table = Table {
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

static STEP: Table = Table {
    heading: "[[step]]",
    doc: "what happens, in order; a step keeps what earlier ones set",
    keys: &[
        key("name", Shape::Text, "its name, in results and messages").required(),
        key(
            "kind",
            Shape::Choice(&[word("static")]),
            "the kind of analysis",
        )
        .or(Default::Text("static")),
        key(
            "geometry",
            Shape::Choice(&[word("auto"), word("linear"), word("nonlinear")]),
            "small displacements or any; auto: as the step before, at first nonlinear",
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
            Shape::Tables(&LATER),
            "changes of a contact in this step",
        )
        .later("`active` and `friction` in [[contact]], for all steps"),
        key("temperature", Shape::Tables(&LATER), "temperature").later(""),
    ],
    rules: &[],
};
const INCREMENTS: &[Shape] = &[COUNT, Shape::Table(&INCREMENTS_TABLE)];

static INCREMENTS_TABLE: Table = Table {
    heading: "increments",
    doc: "how the step is cut into increments",
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

const DIRECTION: Shape = Shape::Choice(&[word("x"), word("y"), word("z")]);
const DIRECTIONS: Shape =
    Shape::Either(&[Shape::Choice(&[word("all")]), Shape::List(&DIRECTION, 1, 3)]);

static FIX: Table = Table {
    heading: "[[step.fix]]",
    doc: "supports, at the present position",
    keys: &[
        key("on", Shape::Text, ON_DOC)
            .required()
            .hints(&["set", "group", "name"]),
        key(
            "u",
            DIRECTIONS,
            "displacements held: \"all\" or a list of \"x\", \"y\", \"z\"",
        )
        .hints(&["displacement", "dofs"]),
        key("rot", DIRECTIONS, "rotations held, of a rigid body").hints(&["rotation", "r"]),
    ],
    rules: &[Rule::AtLeastOne(&["u", "rot"])],
};

static FREE_TABLE: Table = Table {
    heading: "[[step.free]]",
    doc: "supports and motions of earlier steps that end",
    keys: &[
        key("on", Shape::Text, ON_DOC)
            .required()
            .hints(&["set", "group", "name"]),
        key(
            "u",
            DIRECTIONS,
            "displacements set free: \"all\" or a list of \"x\", \"y\", \"z\"",
        )
        .hints(&["displacement", "dofs"]),
        key("rot", DIRECTIONS, "rotations set free, of a rigid body").hints(&["rotation", "r"]),
    ],
    rules: &[Rule::AtLeastOne(&["u", "rot"])],
};

static MOVE: Table = Table {
    heading: "[[step.move]]",
    doc: "prescribed motions: a number is reached linearly over the step",
    keys: &[
        key("on", Shape::Text, ON_DOC)
            .required()
            .hints(&["set", "group", "name"]),
        key("ux", MOTION, "displacement along x").hints(&["x"]),
        key("uy", MOTION, "displacement along y").hints(&["y"]),
        key("uz", MOTION, "displacement along z").hints(&["z"]),
        key("rx", MOTION, "rotation about x, in radian"),
        key("ry", MOTION, "rotation about y, in radian"),
        key("rz", MOTION, "rotation about z, in radian"),
    ],
    rules: &[Rule::AtLeastOne(&["ux", "uy", "uz", "rx", "ry", "rz"])],
};
const MOTION: Shape = Shape::Either(&[ANY, Shape::Table(&MOTION_TABLE)]);

static MOTION_TABLE: Table = Table {
    heading: "a motion",
    doc: "the course of a prescribed component",
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

static LOAD: Table = Table {
    heading: "[[step.load]]",
    doc: "loads, reached linearly over the step",
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
            "force",
            VECTOR,
            "the total force [x, y, z], spread over what it acts on",
        ),
        key("per_node", VECTOR, "the same force [x, y, z] at every node"),
        key("traction", VECTOR, "force per area").later("`force`, the total"),
        key("pressure", ANY, "pressure on a surface").later("`force`, the total"),
        key("moment", VECTOR, "moment on a rigid body").later("`move` with rx, ry, rz"),
        key("body_force", VECTOR, "force per volume").later(""),
        key("gravity", VECTOR, "acceleration").later(""),
        key("centrifugal", Shape::Table(&LATER), "rotation of the frame").later(""),
        key("follows", Shape::Flag, "whether it turns with the surface").later(""),
        key(
            "coupling",
            Shape::Text,
            "common displacement of the loaded set",
        )
        .later("`move` instead of `load`"),
    ],
    rules: &[Rule::ExactlyOne(&["force", "per_node"])],
};

static SOLVER: Table = Table {
    heading: "[solver]",
    doc: "how equations are solved",
    keys: &[
        key("newton", Shape::Table(&NEWTON), NEWTON.doc),
        key(
            "linear",
            Shape::Choice(&[
                word("auto"),
                word("direct"),
                Choice::later("iterative", "direct"),
            ]),
            "how linear equations are solved",
        )
        .or(Default::Text("auto")),
        key(
            "stabilize",
            Shape::Either(&[AUTO, Shape::Flag]),
            "whether a vanishing viscous force holds bodies that only open contact holds",
        )
        .or(Default::Text("auto")),
        key(
            "on_trouble",
            Shape::List(
                &Shape::Choice(&[word("cut"), Choice::later("stabilize", "cut")]),
                0,
                2,
            ),
            "what is tried, in order, when an increment does not converge",
        )
        .or(Default::Texts(&["cut"])),
        key(
            "threads",
            Shape::Either(&[AUTO, Shape::Integer(1, 4096)]),
            "the number of threads",
        )
        .or(Default::Text("auto")),
    ],
    rules: &[],
};

static NEWTON: Table = Table {
    heading: "newton",
    doc: "Newton's method",
    keys: &[
        key(
            "max_iterations",
            COUNT,
            "iterations of an increment at most",
        )
        .or(Default::Integer(20)),
        key(
            "force_tol",
            POSITIVE,
            "largest residual force, in parts of the mean force",
        )
        .or(Default::Number(1e-6))
        .hints(&["tol", "tolerance", "rtol"]),
        key(
            "gap_tol",
            POSITIVE,
            "largest penetration, in parts of the size of a facet, of laws with multipliers",
        )
        .or(Default::Number(1e-6)),
        key(
            "line_search",
            Shape::Either(&[AUTO, Shape::Flag]),
            "whether corrections are shortened",
        )
        .or(Default::Text("auto")),
    ],
    rules: &[],
};

static OUTPUT: Table = Table {
    heading: "[output]",
    doc: "what is written",
    keys: &[
        key(
            "format",
            Shape::List(&Shape::Choice(FORMATS), 1, 4),
            "formats of results",
        )
        .or(Default::Texts(&["vtu"])),
        key(
            "fields",
            Shape::List(&Shape::Text, 0, MANY),
            "fields to write",
        )
        .or(Default::Texts(&["displacement", "stress", "contact"]))
        .hints(&["field"]),
        key(
            "every",
            Shape::Either(&[COUNT, Shape::Table(&EVERY)]),
            "write after so many increments, or { time }",
        )
        .or(Default::Integer(1)),
        key(
            "names",
            Shape::Choice(&[word("signorini"), Choice::later("abaqus", "signorini")]),
            "how fields are named",
        )
        .or(Default::Text("signorini")),
        key("history", Shape::Tables(&HISTORY), HISTORY.doc),
    ],
    rules: &[],
};
const FORMATS: &[Choice] = &[
    word("vtu"),
    Choice::later("vtkhdf", "vtu"),
    Choice::later("frd", "vtu"),
    Choice::later("xdmf", "vtu"),
];

static EVERY: Table = Table {
    heading: "every",
    doc: "how often results are written",
    keys: &[key("time", POSITIVE, "after so much time").required()],
    rules: &[],
};

static HISTORY: Table = Table {
    heading: "[[output.history]]",
    doc: "columns of history.csv",
    keys: &[
        key("name", Shape::Text, "the first part of the column's name").required(),
        key(
            "quantity",
            NAMES,
            "the quantity, as in force_z or displacement.z, or a list of them",
        )
        .required()
        .hints(&["quantities"]),
        key("contact", Shape::Text, "of this contact"),
        key("reference", Shape::Text, "of this rigid body"),
        key("node", ID, "of the node of this number"),
        key(
            "set",
            Shape::Text,
            "of this set: the sum of forces, the mean of other quantities",
        ),
    ],
    rules: &[Rule::ExactlyOne(&["contact", "reference", "node", "set"])],
};

static CHECKPOINT: Table = Table {
    heading: "[checkpoint]",
    doc: "when a run can be resumed from",
    keys: &[
        key(
            "every",
            Shape::Table(&CHECKPOINT_EVERY),
            "how often; absent: { increments = 5, wall = \"10 min\" }",
        ),
        key("keep", Shape::Integer(1, 1000), "how many are kept").or(Default::Integer(2)),
    ],
    rules: &[],
};

static CHECKPOINT_EVERY: Table = Table {
    heading: "every",
    doc: "how often checkpoints are written",
    keys: &[
        key("increments", COUNT, "after so many increments"),
        key(
            "wall",
            Shape::Text,
            "after so much time on the clock, as in \"10 min\"",
        ),
    ],
    rules: &[Rule::AtLeastOne(&["increments", "wall"])],
};

static EXPECT: Table = Table {
    heading: "[[expect]]",
    doc: "values that are checked at the end",
    keys: &[
        key(
            "what",
            Shape::Text,
            "a column of history.csv, or \"displacement.z @ node 5\"",
        )
        .required()
        .hints(&["quantity", "name"]),
        key("at", COUNT, "the data row of history.csv; absent: the last").hints(&["row"]),
        key("time", ANY, "the total time"),
        key("value", ANY, "what it should be").required(),
        key("tol", Shape::Table(&TOLERANCE), TOLERANCE.doc)
            .required()
            .hints(&["tolerance"]),
    ],
    rules: &[Rule::AtMostOne(&["at", "time"])],
};

static TOLERANCE: Table = Table {
    heading: "tol",
    doc: "how far off it may be: { rel } in parts of the value, or { abs } in its unit",
    keys: &[
        key("rel", NOT_NEGATIVE, "in parts of the value"),
        key("abs", NOT_NEGATIVE, "in the unit of the value"),
    ],
    rules: &[Rule::ExactlyOne(&["rel", "abs"])],
};
