//! Faults of the text of a case, by what is wrong with it.

use super::{PAPER_BRICK, brick};

/// The name of a fault, and a text that has it.
type Fault = (&'static str, String);

/// Every fault, in the order of `cases/messages.txt`.
pub(super) fn faults() -> Vec<(&'static str, Vec<u8>)> {
    let texts = [
        keys(),
        numbers(),
        repeated_and_missing(),
        names(),
        values(),
        syntax(),
        formats(),
        friction(),
        methods(),
        laws(),
        pairs(),
        surfaces(),
        units(),
        orientations(),
    ];
    let texts = texts.into_iter().flatten();
    let bytes = texts.map(|(name, text)| (name, text.into_bytes()));
    encodings().into_iter().chain(bytes).collect()
}

/// The paper's case with other keys instead of `friction` of its contact.
fn contact(keys: &str) -> String {
    brick("friction    = 0.0", keys)
}

/// The paper's case with another law.
fn law(enforcement: &str) -> String {
    brick("{ penalty = 1.0e5, per = \"node\" }", enforcement)
}

/// The paper's case with a change of its contact.
fn step(change: &str) -> String {
    brick("[output]", &format!("[[step.contact]]\n{change}\n[output]"))
}

/// The paper's case with a surface as the primary side.
fn surface(shape: &str) -> String {
    let surface = format!("[[surface]]\nname = \"floor\"\nshape = {{ {shape} }}\n[[contact]]");
    brick("[[contact]]", &surface).replace("primary     = \"top\"", "primary     = \"floor\"")
}

/// Bytes that are no text.
fn encodings() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("an empty file", b"  \n# nothing\n".to_vec()),
        ("NUL bytes", b"format = 1\n\0\0\0".to_vec()),
        (
            "UTF-16",
            [0xFF, 0xFE]
                .into_iter()
                .chain("title = \"a\"".bytes().flat_map(|b| [b, 0]))
                .collect(),
        ),
        (
            "UTF-16 without a mark",
            "title = \"a\"".bytes().flat_map(|b| [0, b]).collect(),
        ),
        ("Latin-1", b"format = 1\ntitle = \"caf\xE9\"".to_vec()),
    ]
}

/// Keys that no table has, or that another one has.
fn keys() -> Vec<Fault> {
    vec![
        (
            "an unknown key that belongs inside another",
            brick("friction    = 0.0", "penaltty = 1e5"),
        ),
        (
            "the word of another program",
            brick(
                "secondary   = \"tip_node\"",
                "slave = \"tip_node\"\nsecondary = \"tip_node\"",
            ),
        ),
        (
            "a key of another table",
            brick("friction    = 0.0", "E = 1.0"),
        ),
        ("an unknown key at the top", brick("[output]", "[outptu]")),
    ]
}

/// Values of the wrong type, and texts that are no number.
fn numbers() -> Vec<Fault> {
    vec![
        (
            "a text where a number belongs",
            brick("= 500.0", "= \"five\""),
        ),
        (
            "one table where a list belongs",
            brick("[[contact]]", "[contact]"),
        ),
        ("NaN", brick("= 500.0", "= nan")),
        ("a number too large", brick("= 500.0", "= 1e400")),
        ("a number too small", brick("= 500.0", "= 1e-320")),
        (
            "a decimal comma",
            brick("nu    = 0.0", "nu    = 0,3   # rubber"),
        ),
        (
            "a decimal comma in quotes",
            brick("nu    = 0.0", "nu    = \"0,3\""),
        ),
        (
            "a decimal comma in a row",
            brick("[  2,  1.0,", "[  2,  1,0,"),
        ),
        ("a unit behind a number", brick("= 500.0", "= 500MPa")),
    ]
}

/// Keys that come twice, and keys that are missing.
fn repeated_and_missing() -> Vec<Fault> {
    vec![
        (
            "a key twice",
            brick("nu    = 0.0", "nu    = 0.0\nE     = 2.0"),
        ),
        ("a table twice", brick("[output]", "[mesh]\n[output]")),
        ("no E", brick("E     = 500.0", "")),
        ("no material of a body", brick("material = \"soft\"", "")),
        (
            "no name",
            brick("name       = \"press\"", "name       = \"\""),
        ),
        ("neither support", brick("  u  = \"all\"", "")),
    ]
}

/// Names that nothing has, or two things.
fn names() -> Vec<Fault> {
    vec![
        (
            "an undefined material",
            brick("material = \"soft\"", "material = \"sotf\""),
        ),
        (
            "an undefined amplitude",
            brick("uz = -0.3", "uz = { amplitude = \"saw\" }"),
        ),
        (
            "an undefined contact",
            brick("contact = \"tip\"", "contact = \"tap\""),
        ),
        (
            "a set and a body of one name",
            brick("tip_node = {", "brick = {"),
        ),
        (
            "two contacts of one name",
            brick(
                "[[step]]",
                "[[contact]]\nname = \"tip\"\nsecondary = \"a\"\nprimary = \"b\"\n[[step]]",
            ),
        ),
    ]
}

/// Numbers out of range and words that are no choice.
fn values() -> Vec<Fault> {
    vec![
        ("no increments", brick("{ fixed = 60 }", "0")),
        (
            "negative increments",
            brick("{ fixed = 60 }", "{ fixed = -5 }"),
        ),
        (
            "min above max",
            brick("{ fixed = 60 }", "{ initial = 0.1, min = 0.5, max = 0.2 }"),
        ),
        (
            "a table that does not increase",
            brick("uz = -0.3", "uz = { table = [[0, 0], [1, 1], [1, 2]] }"),
        ),
        ("a negative modulus", brick("= 500.0", "= -500.0")),
        (
            "an incompressible material",
            brick("nu    = 0.0", "nu    = 0.5"),
        ),
        ("no penalty", brick("1.0e5", "0")),
        (
            "negative friction",
            brick("friction    = 0.0", "friction = -0.1"),
        ),
        (
            "an unknown method",
            brick("\"node-to-segment\"", "\"node-to-segmnt\""),
        ),
        (
            "a direction without a list",
            brick("u  = \"all\"", "u  = \"x\""),
        ),
        (
            "two ways of one set",
            brick(
                "{ nodes = [11] }",
                "{ nodes = [11], faces = [[2, \"S1\"]] }",
            ),
        ),
        ("an unknown side", brick("\"+z\"", "\"top\"")),
    ]
}

/// Texts that are no TOML, and cases that break off.
fn syntax() -> Vec<Fault> {
    vec![
        (
            "a text without quotes",
            brick("material = \"soft\"", "material = soft"),
        ),
        (
            "a value missing",
            brick("material = \"soft\"", "material = "),
        ),
        (
            "a quote not closed",
            brick("\"Node-to-segment", "\"Node-to-\nsegment"),
        ),
        (
            "a bracket not closed",
            brick("[1, 2, 3, 4] }", "[1, 2, 3, 4 }"),
        ),
        (
            "brackets without end",
            format!("a = {}", "[".repeat(100_000)),
        ),
        ("cut off in a list", PAPER_BRICK[..700].to_owned()),
        (
            "cut off before the steps",
            PAPER_BRICK.split("[[step]]").next().unwrap().to_owned(),
        ),
    ]
}

/// Another version of the format, and several faults in one text.
fn formats() -> Vec<Fault> {
    vec![
        ("a newer format", brick("format = 1", "format = 2")),
        (
            "several at once",
            brick("nu    = 0.0", "nuu   = 0.0").replace("tool\"\nrigid", "tool\"\nrigit"),
        ),
    ]
}

/// Friction that contradicts itself or its contact.
fn friction() -> Vec<Fault> {
    vec![
        (
            "too much friction",
            brick("friction    = 0.0", "friction    = 30"),
        ),
        (
            "two limits of friction",
            contact("friction = { mu = 0.3, tresca = 5.0 }"),
        ),
        (
            "no limit of friction",
            contact("friction = { stiffness = 1e3 }"),
        ),
        (
            "a cap without mu",
            contact("friction = { tresca = 5.0, cap = 2.0 }"),
        ),
        (
            "half of a coefficient that falls",
            contact("friction = { static = 0.3, kinetic = 0.2 }"),
        ),
        (
            "more friction in motion than at rest",
            contact("friction = { static = 0.2, kinetic = 0.3, transition = 0.1 }"),
        ),
        (
            "no length over which friction falls",
            contact("friction = { static = 0.3, kinetic = 0.2, transition = 0 }"),
        ),
        (
            "two ways to yield",
            contact("friction = { mu = 0.3, stiffness = 1e3, elastic_slip = 0.01 }"),
        ),
        (
            "friction of what is joined",
            contact(
                "tied = true\nfriction = 0.3\nstart = { close_gaps_below = 0.1, clearance = 0.2 }",
            ),
        ),
        (
            "a joint that cannot pull",
            law("{ exponential = { p0 = 1.0, c0 = 0.1 } }")
                .replace("friction    = 0.0", "tied = true"),
        ),
        (
            "what breaks and is not joined",
            contact("cohesive = { strength = [1, 2], toughness = [0.1, 0.2] }"),
        ),
        (
            "a joint that breaks, by forces and twice",
            contact(
                "tied = { penalty_tangential = 10 }\npasses = 2\n\
                 cohesive = { strength = [1, 2], toughness = [0.1, 0.1], softening = \"exponential\", stiffness = 3 }",
            ),
        ),
        (
            "two ways to pull",
            contact("adhesion = { work = 0.1, range = 0.01 }"),
        ),
        (
            "numbers of a joint that breaks",
            contact(
                "tied = true\n\
                 cohesive = { strength = [1, 0], toughness = [0.1], mixity = { bk = 2, power = 1 } }",
            ),
        ),
    ]
}

/// Methods that do not go with the rest of their contact.
fn methods() -> Vec<Fault> {
    vec![
        ("three passes", contact("passes = 3")),
        (
            "what belongs to nodes against nodes",
            contact("normals = [0, 0, 1]\npairs = \"order\"\nrule = { points = 3 }"),
        ),
        (
            "what does not go with nodes against nodes",
            contact("passes = 2\nnormals = [0, 0, 0]")
                .replace("\"node-to-segment\"", "\"node-to-node\""),
        ),
        (
            "what does not go with points inside of facets",
            contact("rule = { kind = \"lobatto\", points = 1 }")
                .replace("\"node-to-segment\"", "\"gauss-point\""),
        ),
        (
            "small sliding of nodes against nodes",
            contact("sliding = \"small\"").replace("\"node-to-segment\"", "\"node-to-node\""),
        ),
        (
            "multipliers at too many points",
            law("{ lagrange = {} }")
                .replace("friction    = 0.0", "passes = 2")
                .replace("\"node-to-segment\"", "\"gauss-point\""),
        ),
        (
            "multipliers of a surface with itself",
            law("{ augmented = \"newton\" }")
                .replace("primary     = \"top\"", "primary = \"self\""),
        ),
        ("mortar", brick("\"node-to-segment\"", "\"mortar\"")),
        (
            "a surface against itself by two names",
            brick("primary     = \"top\"", "primary     = \"tip_node\""),
        ),
        (
            "what does not go with self-contact",
            contact("passes = 2\ntied = true")
                .replace("primary     = \"top\"", "primary = \"self\""),
        ),
        (
            "nodes of a surface with itself",
            brick("primary     = \"top\"", "primary = \"self\"")
                .replace("\"node-to-segment\"", "\"node-to-node\""),
        ),
    ]
}

/// Laws of contact that are incomplete or contradict themselves.
fn laws() -> Vec<Fault> {
    vec![
        ("two laws", law("{ penalty = 1e5, lagrange = {} }")),
        ("a word for a law that is a table", law("\"lagrange\"")),
        (
            "two laws with multipliers",
            law("{ lagrange = {}, augmented = \"uzawa\" }"),
        ),
        (
            "a law without its numbers",
            law("{ exponential = { p0 = 1.0 } }"),
        ),
        (
            "gaps that do not increase",
            law("{ penalty = [[0, 5], [0, 0]] }"),
        ),
        (
            "pressures that grow with the gap",
            law("{ penalty = [[-1, 5], [-0.5, 6], [0, 0]] }"),
        ),
        (
            "pressures that do not end",
            law("{ penalty = [[-1, 5], [0, 1]] }"),
        ),
        (
            "a table without pressure",
            law("{ penalty = [[-1, 0], [0, 0]] }"),
        ),
        (
            "pressures that pull",
            law("{ penalty = [[-1, 5], [0, -1]] }"),
        ),
        (
            "a table next to multipliers",
            law("{ augmented = \"newton\", penalty = [[-1, 5], [0, 0]] }"),
        ),
        (
            "a tolerance of one contact",
            law("{ augmented = \"newton\", gap_tol = 1e-6 }"),
        ),
    ]
}

/// Pairs of surfaces, and their changes in a step.
fn pairs() -> Vec<Fault> {
    vec![
        (
            "one pair in two contacts",
            brick(
                "[[step]]",
                "[[contact]]\nname = \"pit\"\nsecondary = \"top\"\nprimary = \"tip_node\"\n[[step]]",
            ),
        ),
        (
            "a change of no contact",
            step("name = \"tap\"\nactive = false"),
        ),
        ("a change without content", step("name = \"tip\"")),
        (
            "a contact changed twice",
            step(
                "name = \"tip\"\nfriction = 0.1\n[[step.contact]]\nname = \"tip\"\nactive = false",
            ),
        ),
        (
            "friction that joined sides get later",
            step("name = \"tip\"\nfriction = 0.1").replace("friction    = 0.0", "tied = true"),
        ),
    ]
}

/// Analytical surfaces and surfaces from files.
fn surfaces() -> Vec<Fault> {
    vec![
        (
            "a sphere without radius",
            surface("sphere = { center = [0, 0, 0] }"),
        ),
        (
            "a radius of zero",
            surface("sphere = { center = [0, 0, 0], radius = 0 }"),
        ),
        (
            "a normal without direction",
            surface("plane = { point = [0, 0, 0], normal = [0, 0, 0] }"),
        ),
        (
            "a cone that is flat",
            surface("cone = { apex = [0, 0, 0], axis = \"z\", half_angle = 90 }"),
        ),
        (
            "a torus that meets itself",
            surface("torus = { center = [0, 0, 0], axis = \"z\", radius = 1.0, tube = 2.0 }"),
        ),
        (
            "a circle in space",
            surface("circle = { center = [0, 0, 0], radius = 1 }"),
        ),
        (
            "a sphere in the plane",
            surface("sphere = { center = [0, 0, 1], radius = 1 }")
                .replace("[mesh]", "[model]\nspace = \"plane-strain\"\n[mesh]"),
        ),
        (
            "two shapes",
            surface("stl = \"a.stl\", plane = { point = [0, 0, 0], normal = \"z\" }"),
        ),
        ("no shape", surface("")),
        ("no path", surface("stl = \" \"")),
        (
            "an unknown shape",
            surface("plain = { point = [0, 0, 0], normal = \"z\" }"),
        ),
        (
            "a surface that moves with nothing",
            surface("stl = \"a.stl\"").replace(
                "name = \"floor\"",
                "name = \"floor\"\nreference = \"pilot\"",
            ),
        ),
        (
            "a surface that nothing touches",
            surface("stl = \"a.stl\"").replace("primary     = \"floor\"", "primary     = \"top\""),
        ),
        (
            "a surface on the wrong side",
            surface("stl = \"a.stl\"")
                .replace("primary     = \"floor\"", "primary     = \"top\"")
                .replace("secondary   = \"tip_node\"", "secondary   = \"floor\""),
        ),
        (
            "a surface with points",
            surface("stl = \"a.stl\"").replace("friction    = 0.0", "passes = 2"),
        ),
        (
            "a set and a surface of one name",
            surface("stl = \"a.stl\"").replace("\"floor\"", "\"top\""),
        ),
    ]
}

/// Axes of materials.
fn orientations() -> Vec<Fault> {
    let with = |axes: &str| {
        let named = "material = \"soft\"\norientation = \"rings\"";
        let text = brick("material = \"soft\"", named);
        text.replace("[[contact]]", &format!("[orientation.{axes}\n[[contact]]"))
    };
    vec![
        (
            "an orientation that is not there",
            with("ring]\nx = [1, 0, 0]\ny = [0, 1, 0]"),
        ),
        (
            "an orientation without its axis",
            with("rings]\nkind = \"cylindrical\""),
        ),
        (
            "an orientation with keys of another kind",
            with(
                "rings]\nkind = \"cylindrical\"\naxis = \"z\"\nrows = [[1, [1, 0, 0], [0, 1, 0]]]",
            ),
        ),
        (
            "parallel axes of an element",
            with("rings]\nkind = \"elements\"\nrows = [[1, [1, 0, 0], [2, 0, 0]]]"),
        ),
        (
            "an axis without direction",
            with("rings]\nkind = \"cylindrical\"\naxis = [0, 0, 0]"),
        ),
        (
            "a turn about a fourth axis",
            with("rings]\nx = [1, 0, 0]\ny = [0, 1, 0]\nturn = [4, 30]"),
        ),
    ]
}

/// Numbers and units that do not go together.
fn units() -> Vec<Fault> {
    vec![
        (
            "units far off",
            brick("m-MN-MPa", "mm-N-MPa").replace("= 500.0", "= 210e9"),
        ),
        ("units not coherent", brick("m-MN-MPa", "m-N-MPa")),
    ]
}
