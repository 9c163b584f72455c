//! Tests of reading cases: the manual's cases, messages, options, round trips, damaged texts, cost.

use std::fmt::Write as _;
use std::sync::LazyLock;

use super::mutate::{Generator, mutate};
use super::vocabulary::{Kinds, Shape, Table, Vocabulary};
use super::*;
use crate::diagnostic::Class;

const PAPER_BRICK: &str = include_str!("cases/paper_brick.toml");
const HERTZ: &str = include_str!("cases/hertz.toml");
const SLIDING: &str = include_str!("cases/sliding.toml");
/// A case that says everything this version understands.
const EVERYTHING: &str = include_str!("cases/everything.toml");
/// What is different in the plane.
const PLANE: &str = include_str!("cases/plane.toml");
const MESSAGES: &str = include_str!("cases/messages.txt");

fn vocabulary() -> &'static Vocabulary {
    static VOCABULARY: LazyLock<Vocabulary> = LazyLock::new(|| {
        Vocabulary::new(Kinds {
            materials: signorini_mechanics::material::descriptions(),
            loads: signorini_mechanics::load::descriptions(),
            surfaces: signorini_geometry::surface::descriptions(),
            laws: signorini_mechanics::contact::law::descriptions(),
            frictions: signorini_mechanics::contact::friction::descriptions(),
        })
    });
    &VOCABULARY
}

fn read(text: &str) -> Result<(Case, Diagnostics), Diagnostics> {
    read_case("case.toml", text.as_bytes(), &[], vocabulary())
}

fn read_with(text: &str, path: &str, value: &str) -> Result<(Case, Diagnostics), Diagnostics> {
    read_case(
        "case.toml",
        text.as_bytes(),
        &[(path.to_owned(), value.to_owned())],
        vocabulary(),
    )
}

/// The paper's case with one passage replaced.
fn brick(old: &str, new: &str) -> String {
    assert!(PAPER_BRICK.contains(old), "{old}");
    PAPER_BRICK.replacen(old, new, 1)
}

fn codes_of(text: &str) -> Vec<&'static str> {
    read(text).map_or_else(
        |all| all.iter().map(|one| one.code.id).collect(),
        |_| Vec::new(),
    )
}

#[test]
fn the_brick_of_the_paper_reads_completely() {
    let (case, warnings) = read(PAPER_BRICK).unwrap();
    assert!(warnings.is_empty(), "{warnings}");
    let MeshSource::Inline {
        nodes,
        elements,
        place,
    } = &case.mesh
    else {
        panic!("the mesh is in place");
    };
    assert_eq!(nodes.len(), 12);
    assert_eq!(nodes[8], (11, [0.5, 0.25, 1.0]));
    assert_eq!(elements[1].element_type.value, "tet4");
    assert_eq!(elements[1].nodes, [11, 12, 13, 14]);
    assert_eq!(place.line().unwrap(), "line 9 of case.toml");
    assert_eq!(case.names(), ["base", "brick", "tip_node", "tool", "top"]);
    assert_eq!(
        case.sets[2].content,
        SetContent::Faces(vec![(1, Side::Axis(Axis::Z, Sense::Plus))])
    );
    assert_eq!(case.materials[0].number("E"), Some(500.0));
    assert_eq!(
        case.materials[0].constants[0].values.place.text(),
        Some("500.0")
    );
    assert!(!case.bodies[0].rigid && case.bodies[1].rigid);
    let contact = &case.contacts[0];
    assert_eq!(*contact.method, Method::NodeToSegment);
    assert_eq!(contact.secondary.place.text(), Some("\"tip_node\""));
    assert_eq!(contact.enforcement, Enforcement::Penalty(Some(1e5.into())));
    assert_eq!((contact.per, &contact.friction), (Some(Per::Node), &None));
    assert_eq!((contact.reach, contact.active), (None, true));
    let step = &case.steps[0];
    assert_eq!(step.increments, Increments::Fixed(60));
    assert_eq!(step.geometry, Geometry::Nonlinear);
    assert_eq!(step.fixes[0].u, Directions::ALL);
    assert!(step.fixes[0].rot.is_empty());
    let ramp = |value| Some(Motion::Ramp(value));
    assert_eq!(step.moves[0].u, [ramp(0.0), ramp(0.0), ramp(-0.3)]);
    assert_eq!(step.moves[0].rot, [None, None, None]);
    assert_eq!(case.output.history[0].quantities.len(), 3);
    assert_eq!(case.output.history[1].source, HistorySource::Node(5.into()));
    assert_eq!(case.solver.newton.max_iterations, 20);
    assert_eq!(
        case.checkpoint,
        Checkpoint {
            increments: Some(5),
            wall: Some(600.0),
            keep: 2
        }
    );
}

#[test]
fn what_is_not_supported_yet_is_refused_by_name_and_nothing_else_is() {
    let refused = |text: &str| -> Vec<String> {
        let all = read(text).unwrap_err();
        assert_eq!(all.class(), Some(Class::Input));
        assert!(all.iter().all(|one| one.code.id == "S0111"), "{all}");
        all.iter().map(|one| one.message.clone()).collect()
    };
    assert!(read(HERTZ).is_ok() && read(SLIDING).is_ok());
    assert_eq!(
        refused(&SLIDING.replace("\"frd\"]", "\"xdmf\"]")),
        ["`format = \"xdmf\"` is not supported yet"]
    );
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

/// Faults of the text of a case, by name.
fn faults() -> Vec<(&'static str, Vec<u8>)> {
    let text = |name, text: String| (name, text.into_bytes());
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
        text(
            "an unknown key that belongs inside another",
            brick("friction    = 0.0", "penaltty = 1e5"),
        ),
        text(
            "the word of another program",
            brick(
                "secondary   = \"tip_node\"",
                "slave = \"tip_node\"\nsecondary = \"tip_node\"",
            ),
        ),
        text(
            "a key of another table",
            brick("friction    = 0.0", "E = 1.0"),
        ),
        text("an unknown key at the top", brick("[output]", "[outptu]")),
        text(
            "a text where a number belongs",
            brick("= 500.0", "= \"five\""),
        ),
        text(
            "one table where a list belongs",
            brick("[[contact]]", "[contact]"),
        ),
        text("NaN", brick("= 500.0", "= nan")),
        text("a number too large", brick("= 500.0", "= 1e400")),
        text("a number too small", brick("= 500.0", "= 1e-320")),
        text(
            "a decimal comma",
            brick("nu    = 0.0", "nu    = 0,3   # rubber"),
        ),
        text(
            "a decimal comma in quotes",
            brick("nu    = 0.0", "nu    = \"0,3\""),
        ),
        text(
            "a decimal comma in a row",
            brick("[  2,  1.0,", "[  2,  1,0,"),
        ),
        text("a unit behind a number", brick("= 500.0", "= 500MPa")),
        text(
            "a key twice",
            brick("nu    = 0.0", "nu    = 0.0\nE     = 2.0"),
        ),
        text("a table twice", brick("[output]", "[mesh]\n[output]")),
        text("no E", brick("E     = 500.0", "")),
        text("no material of a body", brick("material = \"soft\"", "")),
        text(
            "no name",
            brick("name       = \"press\"", "name       = \"\""),
        ),
        text("neither support", brick("  u  = \"all\"", "")),
        text(
            "an undefined material",
            brick("material = \"soft\"", "material = \"sotf\""),
        ),
        text(
            "an undefined amplitude",
            brick("uz = -0.3", "uz = { amplitude = \"saw\" }"),
        ),
        text(
            "an undefined contact",
            brick("contact = \"tip\"", "contact = \"tap\""),
        ),
        text(
            "a set and a body of one name",
            brick("tip_node = {", "brick = {"),
        ),
        text(
            "two contacts of one name",
            brick(
                "[[step]]",
                "[[contact]]\nname = \"tip\"\nsecondary = \"a\"\nprimary = \"b\"\n[[step]]",
            ),
        ),
        text("cut off in a list", PAPER_BRICK[..700].to_owned()),
        text(
            "cut off before the steps",
            PAPER_BRICK.split("[[step]]").next().unwrap().to_owned(),
        ),
        text("no increments", brick("{ fixed = 60 }", "0")),
        text(
            "negative increments",
            brick("{ fixed = 60 }", "{ fixed = -5 }"),
        ),
        text(
            "min above max",
            brick("{ fixed = 60 }", "{ initial = 0.1, min = 0.5, max = 0.2 }"),
        ),
        text(
            "a table that does not increase",
            brick("uz = -0.3", "uz = { table = [[0, 0], [1, 1], [1, 2]] }"),
        ),
        text("a negative modulus", brick("= 500.0", "= -500.0")),
        text(
            "an incompressible material",
            brick("nu    = 0.0", "nu    = 0.5"),
        ),
        text("no penalty", brick("1.0e5", "0")),
        text(
            "negative friction",
            brick("friction    = 0.0", "friction = -0.1"),
        ),
        text(
            "an unknown method",
            brick("\"node-to-segment\"", "\"node-to-segmnt\""),
        ),
        text(
            "a direction without a list",
            brick("u  = \"all\"", "u  = \"x\""),
        ),
        text(
            "two ways of one set",
            brick(
                "{ nodes = [11] }",
                "{ nodes = [11], faces = [[2, \"S1\"]] }",
            ),
        ),
        text("an unknown side", brick("\"+z\"", "\"top\"")),
        text(
            "a text without quotes",
            brick("material = \"soft\"", "material = soft"),
        ),
        text(
            "a quote not closed",
            brick("\"Node-to-segment", "\"Node-to-\nsegment"),
        ),
        text(
            "a bracket not closed",
            brick("[1, 2, 3, 4] }", "[1, 2, 3, 4 }"),
        ),
        text(
            "brackets without end",
            format!("a = {}", "[".repeat(100_000)),
        ),
        text("a newer format", brick("format = 1", "format = 2")),
        text(
            "several at once",
            brick("nu    = 0.0", "nuu   = 0.0").replace("tool\"\nrigid", "tool\"\nrigit"),
        ),
        text(
            "too much friction",
            brick("friction    = 0.0", "friction    = 30"),
        ),
        text(
            "two limits of friction",
            contact("friction = { mu = 0.3, tresca = 5.0 }"),
        ),
        text(
            "no limit of friction",
            contact("friction = { stiffness = 1e3 }"),
        ),
        text(
            "a cap without mu",
            contact("friction = { tresca = 5.0, cap = 2.0 }"),
        ),
        text(
            "half of a coefficient that falls",
            contact("friction = { static = 0.3, kinetic = 0.2 }"),
        ),
        text(
            "more friction in motion than at rest",
            contact("friction = { static = 0.2, kinetic = 0.3, transition = 0.1 }"),
        ),
        text(
            "no length over which friction falls",
            contact("friction = { static = 0.3, kinetic = 0.2, transition = 0 }"),
        ),
        text(
            "two ways to yield",
            contact("friction = { mu = 0.3, stiffness = 1e3, elastic_slip = 0.01 }"),
        ),
        text(
            "friction of what is joined",
            contact(
                "tied = true\nfriction = 0.3\nstart = { close_gaps_below = 0.1, clearance = 0.2 }",
            ),
        ),
        text(
            "a joint that cannot pull",
            law("{ exponential = { p0 = 1.0, c0 = 0.1 } }")
                .replace("friction    = 0.0", "tied = true"),
        ),
        text("three passes", contact("passes = 3")),
        text(
            "what belongs to nodes against nodes",
            contact("normals = [0, 0, 1]\npairs = \"order\"\nrule = { points = 3 }"),
        ),
        text(
            "what does not go with nodes against nodes",
            contact("passes = 2\nnormals = [0, 0, 0]")
                .replace("\"node-to-segment\"", "\"node-to-node\""),
        ),
        text(
            "what does not go with points inside of facets",
            contact("rule = { kind = \"lobatto\", points = 1 }")
                .replace("\"node-to-segment\"", "\"gauss-point\""),
        ),
        text(
            "small sliding of nodes against nodes",
            contact("sliding = \"small\"").replace("\"node-to-segment\"", "\"node-to-node\""),
        ),
        text(
            "multipliers at too many points",
            law("{ lagrange = {} }")
                .replace("friction    = 0.0", "passes = 2")
                .replace("\"node-to-segment\"", "\"gauss-point\""),
        ),
        text(
            "multipliers of a surface with itself",
            law("{ augmented = \"newton\" }")
                .replace("primary     = \"top\"", "primary = \"self\""),
        ),
        text("mortar", brick("\"node-to-segment\"", "\"mortar\"")),
        text(
            "a surface against itself by two names",
            brick("primary     = \"top\"", "primary     = \"tip_node\""),
        ),
        text(
            "what does not go with self-contact",
            contact("passes = 2\ntied = true")
                .replace("primary     = \"top\"", "primary = \"self\""),
        ),
        text(
            "nodes of a surface with itself",
            brick("primary     = \"top\"", "primary = \"self\"")
                .replace("\"node-to-segment\"", "\"node-to-node\""),
        ),
        text("two laws", law("{ penalty = 1e5, lagrange = {} }")),
        text(
            "two laws with multipliers",
            law("{ lagrange = {}, augmented = \"uzawa\" }"),
        ),
        text(
            "a law without its numbers",
            law("{ exponential = { p0 = 1.0 } }"),
        ),
        text(
            "gaps that do not increase",
            law("{ penalty = [[0, 5], [0, 0]] }"),
        ),
        text(
            "pressures that grow with the gap",
            law("{ penalty = [[-1, 5], [-0.5, 6], [0, 0]] }"),
        ),
        text(
            "pressures that do not end",
            law("{ penalty = [[-1, 5], [0, 1]] }"),
        ),
        text(
            "a table without pressure",
            law("{ penalty = [[-1, 0], [0, 0]] }"),
        ),
        text(
            "pressures that pull",
            law("{ penalty = [[-1, 5], [0, -1]] }"),
        ),
        text(
            "a table beside multipliers",
            law("{ augmented = \"newton\", penalty = [[-1, 5], [0, 0]] }"),
        ),
        text(
            "a tolerance of one contact",
            law("{ augmented = \"newton\", gap_tol = 1e-6 }"),
        ),
        text(
            "one pair in two contacts",
            brick(
                "[[step]]",
                "[[contact]]\nname = \"pit\"\nsecondary = \"top\"\nprimary = \"tip_node\"\n[[step]]",
            ),
        ),
        text(
            "a change of no contact",
            step("name = \"tap\"\nactive = false"),
        ),
        text("a change without content", step("name = \"tip\"")),
        text(
            "a contact changed twice",
            step(
                "name = \"tip\"\nfriction = 0.1\n[[step.contact]]\nname = \"tip\"\nactive = false",
            ),
        ),
        text(
            "friction that joined sides get later",
            step("name = \"tip\"\nfriction = 0.1").replace("friction    = 0.0", "tied = true"),
        ),
        text(
            "a sphere without radius",
            surface("sphere = { center = [0, 0, 0] }"),
        ),
        text(
            "a radius of zero",
            surface("sphere = { center = [0, 0, 0], radius = 0 }"),
        ),
        text(
            "a normal without direction",
            surface("plane = { point = [0, 0, 0], normal = [0, 0, 0] }"),
        ),
        text(
            "a cone that is flat",
            surface("cone = { apex = [0, 0, 0], axis = \"z\", half_angle = 90 }"),
        ),
        text(
            "a torus that meets itself",
            surface("torus = { center = [0, 0, 0], axis = \"z\", radius = 1.0, tube = 2.0 }"),
        ),
        text(
            "a circle in space",
            surface("circle = { center = [0, 0, 0], radius = 1 }"),
        ),
        text(
            "a sphere in the plane",
            surface("sphere = { center = [0, 0, 1], radius = 1 }")
                .replace("[mesh]", "[model]\nspace = \"plane-strain\"\n[mesh]"),
        ),
        text(
            "two shapes",
            surface("stl = \"a.stl\", plane = { point = [0, 0, 0], normal = \"z\" }"),
        ),
        text("no shape", surface("")),
        text("no path", surface("stl = \" \"")),
        text(
            "an unknown shape",
            surface("plain = { point = [0, 0, 0], normal = \"z\" }"),
        ),
        text(
            "a surface that moves with nothing",
            surface("stl = \"a.stl\"").replace(
                "name = \"floor\"",
                "name = \"floor\"\nreference = \"pilot\"",
            ),
        ),
        text(
            "a surface that nothing touches",
            surface("stl = \"a.stl\"").replace("primary     = \"floor\"", "primary     = \"top\""),
        ),
        text(
            "a surface on the wrong side",
            surface("stl = \"a.stl\"")
                .replace("primary     = \"floor\"", "primary     = \"top\"")
                .replace("secondary   = \"tip_node\"", "secondary   = \"floor\""),
        ),
        text(
            "a surface with points",
            surface("stl = \"a.stl\"").replace("friction    = 0.0", "passes = 2"),
        ),
        text(
            "a set and a surface of one name",
            surface("stl = \"a.stl\"").replace("\"floor\"", "\"top\""),
        ),
        text(
            "units far off",
            brick("m-MN-MPa", "mm-N-MPa").replace("= 500.0", "= 210e9"),
        ),
        text("units not coherent", brick("m-MN-MPa", "m-N-MPa")),
    ]
}

#[test]
fn sets_that_contain_themselves_are_found_however_long_the_way() {
    let sets = |text: &str| brick("[sets]", &format!("[sets]\n{text}"));
    assert_eq!(
        codes_of(&sets("a = { union = [\"base\", \"a\"] }")),
        ["S0112"]
    );
    let chain: String = (0..20_000)
        .map(|n| format!("a{n} = {{ union = [\"top\", \"a{}\"] }}\n", n + 1))
        .collect();
    assert!(read(&sets(&chain)).is_ok());
    assert_eq!(
        codes_of(&sets(&format!("{chain}a20000 = {{ union = [\"a7\"] }}"))),
        ["S0112"]
    );
    let all = read(&sets(
        "d = { union = [\"b\"] }\nb = { union = [\"base\", \"c\"] }\nc = { union = [\"b\"] }",
    ))
    .unwrap_err();
    assert!(all.plain().contains("the last the first: c, b"), "{all}");
}

/// The options of `--set` that name nothing, or give a wrong value.
const WRONG_OPTIONS: &[(&str, &str)] = &[
    ("material.sotf.E", "2000"),
    ("contact.tap.reach", "1.0"),
    ("solver.newton.max_iteratons", "30"),
    ("solver.newton.max_iterations", "many"),
    ("step.5.duration", "1.0"),
    ("step..duration", "1.0"),
    ("material.soft.E", "0,3"),
    ("contact.tip.enforcement.penalty", "-1"),
];

fn messages() -> String {
    let mut text = String::new();
    let mut tell = |name: &str, result: Result<(Case, Diagnostics), Diagnostics>| {
        let (head, all) = match result {
            Ok((_, warnings)) => ("read, with warnings", warnings),
            Err(all) => ("exit code 3", all),
        };
        assert_eq!(
            all.exit_code(),
            (head == "exit code 3").then_some(3),
            "{name}"
        );
        assert!(!all.is_empty(), "{name} says nothing");
        let _ = write!(text, "==== {name}: {head}\n\n{}", all.plain());
    };
    for (name, bytes) in faults() {
        tell(name, read_case("case.toml", &bytes, &[], vocabulary()));
    }
    for (path, value) in WRONG_OPTIONS {
        tell(
            &format!("--set {path}={value}"),
            read_with(PAPER_BRICK, path, value),
        );
    }
    text
}

/// Compares with `cases/messages.txt`; with `SIGNORINI_BLESS=1` in the environment that file is written again.
#[test]
fn messages_say_what_where_and_what_to_do() {
    let found = messages();
    if std::env::var_os("SIGNORINI_BLESS").is_some() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/case/cases/messages.txt");
        std::fs::write(path, &found).unwrap();
        return;
    }
    let sections = |text: &str| text.split("==== ").map(str::to_owned).collect::<Vec<_>>();
    for (found, expected) in sections(&found).iter().zip(&sections(MESSAGES)) {
        assert_eq!(found, expected);
    }
    assert_eq!(found, MESSAGES);
}

#[test]
fn every_code_about_text_is_provoked() {
    for code in codes::ALL
        .iter()
        .filter(|code| code.id.starts_with("S01") || code.id.starts_with("S04"))
    {
        let of_runs = [
            "S0411", "S0412", "S0413", "S0414", "S0415", "S0421", "S0422", "S0423", "S0424",
            "S0425", "S0431",
        ];
        let elsewhere =
            ["S0121", "S0404", "S0405"].contains(&code.id) || of_runs.contains(&code.id);
        assert!(
            elsewhere || MESSAGES.contains(&format!("[{}]", code.id)),
            "{}",
            code.id
        );
    }
}

#[test]
fn files_that_cannot_be_read_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let missing = read_case_file(&folder.path().join("no.toml"), &[], vocabulary()).unwrap_err();
    let text = missing.plain();
    assert!(
        text.contains("S0121") && text.contains("no.toml") && text.contains("current directory"),
        "{text}"
    );
    assert_eq!(missing.exit_code(), Some(3));
    let directory = read_case_file(folder.path(), &[], vocabulary()).unwrap_err();
    assert!(directory.plain().contains("is a directory"));
    let file = folder.path().join("größe 1.toml");
    std::fs::write(&file, PAPER_BRICK).unwrap();
    assert!(read_case_file(&file, &[], vocabulary()).is_ok());
}

#[test]
fn marks_and_line_ends_of_other_systems_read_the_same() {
    let (plain, _) = read(PAPER_BRICK).unwrap();
    for text in [
        format!("\u{FEFF}{PAPER_BRICK}"),
        PAPER_BRICK.replace('\n', "\r\n"),
        PAPER_BRICK.replace('\n', "\r"),
        format!("{}{PAPER_BRICK}", "\n".repeat(100_000)),
    ] {
        assert_eq!(read(&text).unwrap().0, plain);
    }
}

#[test]
fn names_may_be_in_any_script_and_of_any_length() {
    let long = "Körper 一 with spaces, \\\"quotes\\\" ".repeat(1000);
    let text = PAPER_BRICK.replace("\"brick\"", &format!("\"{long}\""));
    let (case, _) = read(&text).unwrap();
    assert!(case.bodies[0].groups[0].starts_with("Körper 一 with spaces, \"quotes\""));
    assert_eq!(read(&resolved(&case, vocabulary())).unwrap().0, case);
}

#[test]
fn a_megabyte_in_one_line_reads_and_errs_quickly() {
    let ids: Vec<String> = (0..150_000).map(|n| n.to_string()).collect();
    let text = brick("[1, 2, 3, 4] }", &format!("[{}] }}", ids.join(", ")));
    assert!(text.len() > 1_000_000);
    assert!(
        matches!(&read(&text).unwrap().0.sets[0].content, SetContent::Nodes(ids) if ids.len() == 150_000)
    );
    let wrong = read(&text.replace(", 149999]", ", -1]"))
        .unwrap_err()
        .plain();
    assert!(
        wrong.contains("`nodes` = -1 is out of range") && wrong.len() < 2000,
        "{wrong}"
    );
}

#[test]
fn warnings_are_silenced_by_allow() {
    let steel = brick("m-MN-MPa", "mm-N-MPa").replace("= 500.0", "= 210e9");
    assert_eq!(read(&steel).unwrap().1.len(), 1);
    let allowed = steel.replace("format = 1", "format = 1\nallow = [\"S0402\"]");
    assert!(read(&allowed).unwrap().1.is_empty());
    assert_eq!(
        codes_of(&steel.replace("format = 1", "allow = [\"S4020\"]")),
        ["S0110"]
    );
}

#[test]
fn a_fault_does_not_draw_others_after_it() {
    assert_eq!(codes_of(&brick("[[contact]]", "[contact]")), ["S0107"]);
    assert_eq!(
        codes_of(&brick("[1, 2, 3, 4] }", "[1, 2, 3, 4 }")),
        ["S0104"]
    );
    assert_eq!(
        codes_of(&brick("material = \"soft\"", "material = soft")),
        ["S0104"]
    );
    assert_eq!(codes_of(&brick("nu    = 0.0", "nu = 0,3")), ["S0115"]);
    assert_eq!(codes_of(&brick("tip_node = {", "brick = {")), ["S0113"]);
    assert_eq!(codes_of(&brick("nu    = 0.0", "nuu   = 0.0")), ["S0102"]);
    assert_eq!(
        codes_of(&brick("rigid    = true", "rigit    = true")),
        ["S0102"]
    );
}

#[test]
fn errors_of_all_stages_come_together_in_the_order_of_the_text() {
    let text = brick("nu    = 0.0", "nu = 0,3\nrho = 1.0")
        .replace("\"soft\"", "\"sotf\"")
        .replace("fixed = 60", "fixed = 0")
        .replace("node = 5", "node = 5.5");
    assert_eq!(
        codes_of(&text),
        ["S0115", "S0102", "S0114", "S0109", "S0107"]
    );
}

#[test]
fn options_change_the_case() {
    let changed = |path: &str, value: &str| {
        read_with(PAPER_BRICK, path, value)
            .unwrap_or_else(|all| panic!("{all}"))
            .0
    };
    assert_eq!(
        changed("material.soft.E", "2000").materials[0].number("E"),
        Some(2000.0)
    );
    assert_eq!(changed("title", "two words").title, "two words");
    assert_eq!(changed("title", "\"two words\"").title, "two words");
    assert_eq!(
        changed("contact.tip.reach", "0.5").contacts[0].reach,
        Some(0.5)
    );
    assert_eq!(
        changed("step.press.increments", "20").steps[0].increments,
        Increments::Count(20)
    );
    assert_eq!(
        changed("step.press.increments.fixed", "20").steps[0].increments,
        Increments::Fixed(20)
    );
    assert_eq!(changed("step.0.duration", "2").steps[0].duration, 2.0);
    assert_eq!(
        changed("step.press.move.tool.uz", "-0.5").steps[0].moves[0].u[2],
        Some(Motion::Ramp(-0.5))
    );
    assert_eq!(
        changed("solver.newton.force_tol", "1e-10")
            .solver
            .newton
            .force_tol,
        1e-10
    );
    assert_eq!(
        changed("output.every.time", "0.1").output.every,
        Every::Time(0.1)
    );
    assert_eq!(
        changed("sets.base.nodes.0", "7").sets[0].content,
        SetContent::Nodes(vec![7, 2, 3, 4])
    );
    let young = changed("material.\"soft\".E", " 7.5 ").materials[0].constants[0]
        .values
        .clone();
    assert_eq!(young.place.line().unwrap(), "line 1 of --set");
    assert_eq!(young.place.text(), Some("7.5"));
}

#[test]
fn later_options_win() {
    let set = [
        ("material.soft.E", "1"),
        (
            "material.soft",
            "{ model = \"neo-hookean\", E = 2, nu = 0.1 }",
        ),
        ("material.soft.E", "3"),
    ]
    .map(|(path, value)| (path.to_owned(), value.to_owned()));
    let (case, _) = read_case("case.toml", PAPER_BRICK.as_bytes(), &set, vocabulary()).unwrap();
    assert_eq!(case.materials[0].number("E"), Some(3.0));
    assert_eq!(case.materials[0].model.value, "neo-hookean");
}

#[test]
fn absent_keys_take_the_defaults_of_the_vocabulary() {
    let text = "mesh = { file = 'a.msh' }\nbody = [{ group = 'a', rigid = true }]\nstep = [{ name = 's' }]\n";
    let (case, _) = read(text).unwrap();
    assert_eq!(case.format, 1);
    assert_eq!(*case.model.space, Space::ThreeD);
    assert_eq!(case.model.thickness, 1.0);
    assert_eq!(case.steps[0].increments, Increments::Count(10));
    assert_eq!(case.steps[0].duration, 1.0);
    let all = [Remedy::Cut, Remedy::Stabilize, Remedy::Points];
    assert_eq!(case.solver.on_trouble, all);
    assert_eq!(case.output.every, Every::Increments(1));
    assert_eq!(case.output.fields.len(), 3);
    let (case, _) = read_with(text, "step.s.increments", "{ initial = 0.1 }").unwrap();
    assert_eq!(
        case.steps[0].increments,
        Increments::Adaptive {
            initial: 0.1,
            min: 1e-5,
            max: 1.0,
            count_max: 1000
        }
    );
}

#[test]
fn plane_nodes_may_leave_z_away_and_nodes_in_space_may_not() {
    let flat = "model = { space = 'plane-strain', thickness = 2.0 }\nbody = [{ group = 'a', rigid = true }]\nstep = [{ name = 's' }]\n\
        [mesh]\nnodes = [[1, 0, 0], [2, 1.5, 0, 0]]\nelements = [{ id = 1, type = 'line2', nodes = [1, 2] }]\n";
    let (case, _) = read(flat).unwrap();
    assert!(
        matches!(&case.mesh, MeshSource::Inline { nodes, .. } if nodes[1] == (2, [1.5, 0.0, 0.0]))
    );
    assert_eq!(case.model.thickness, 2.0);
    assert_eq!(read(&resolved(&case, vocabulary())).unwrap().0, case);
    assert_eq!(
        codes_of(
            &flat
                .replace(", thickness = 2.0", "")
                .replace("plane-strain", "3d")
        ),
        ["S0116"]
    );
    assert_eq!(
        codes_of(&flat.replace("plane-strain", "3d")),
        ["S0112", "S0116"]
    );
}

#[test]
fn a_resolved_case_reads_back_to_the_same_case() {
    for text in [PAPER_BRICK, EVERYTHING, PLANE] {
        let (case, _) = read(text).unwrap_or_else(|all| panic!("{all}"));
        let written = resolved(&case, vocabulary());
        let (again, _) = read(&written).unwrap_or_else(|all| panic!("{all}"));
        assert_eq!(again, case);
        assert_eq!(resolved(&again, vocabulary()), written);
    }
}

/// The page of the manual about contacts.
const PAGE: &str = include_str!("../../../../docs/contact.md");

#[test]
fn what_the_page_about_contacts_shows_reads_without_a_word() {
    let blocks = PAGE.split("```toml\n").skip(1);
    let shown: String = blocks.filter_map(|text| text.split("```").next()).collect();
    let around = "mesh = { file = 'a.msh' }\nreference = { pilot = { at = [0, 0, 0] } }\n\
        body = [{ group = 'a', rigid = true }]\n";
    let (contacts, change) = shown.split_once("[[step.contact]]").unwrap();
    let case = |contacts: &str| {
        let text = format!("{around}{contacts}\n[[step]]\nname = 's'\n[[step.contact]]{change}");
        let (case, warnings) = read(&text).unwrap_or_else(|all| panic!("{all}"));
        assert!(warnings.is_empty(), "{warnings}");
        case
    };
    assert_eq!(case(contacts).contacts.len(), 5);
    let cells = PAGE.lines().filter_map(|line| line.strip_prefix("| "));
    let laws = cells.flat_map(|line| line.split('`').skip(1).step_by(2));
    let laws: Vec<&str> = laws.filter(|law| law.starts_with('{')).collect();
    assert_eq!(laws.len(), 10);
    for law in laws {
        let of_friction = ["mu", "tresca", "static"]
            .iter()
            .any(|word| law.contains(word));
        let key = if of_friction {
            "friction"
        } else {
            "enforcement"
        };
        let other =
            format!("[[contact]]\nname = 'other'\nsecondary = 'x'\nprimary = 'y'\n{key} = {law}\n");
        assert_eq!(case(&format!("{contacts}{other}")).contacts.len(), 6);
    }
}

fn inner(shape: &'static Shape) -> Option<&'static Table> {
    match shape {
        Shape::Table(table) | Shape::Tables(table) | Shape::Named(table) => Some(table),
        Shape::Either(shapes) => shapes.iter().find_map(inner),
        _ => None,
    }
}

/// Calls `visit` with every table of the vocabulary and its path.
fn each_table(words: &'static Table, path: &str, visit: &mut impl FnMut(&'static Table, &str)) {
    visit(words, path);
    for key in words.keys.iter().filter(|key| key.later.is_none()) {
        if let Some(table) = inner(&key.shape) {
            each_table(table, &format!("{path}.{}", key.name), visit);
        }
    }
}

#[test]
fn a_resolved_case_can_say_every_key() {
    let written = [EVERYTHING, PAPER_BRICK, PLANE]
        .map(|text| {
            resolved(
                &read(text).unwrap_or_else(|all| panic!("{all}")).0,
                vocabulary(),
            )
        })
        .concat();
    each_table(vocabulary().case, "", &mut |table, path| {
        for name in table.names() {
            let said = [format!("\n{name} = "), format!(" {name} = ")]
                .iter()
                .any(|text| written.contains(text))
                || ["[", "."].iter().any(|lead| {
                    written.contains(&format!("{lead}{name}]"))
                        || written.contains(&format!("{lead}{name}."))
                });
            assert!(said || name == "format", "{path}.{name}");
        }
    });
}

#[test]
fn what_rooms_describe_has_its_words_and_keys_in_a_case() {
    let keys_of = |path: &[&str]| {
        let mut table = vocabulary().case;
        for part in path {
            table = inner(&table.key(part).unwrap().shape).unwrap();
        }
        table
    };
    let material = keys_of(&["material"]);
    let Shape::Choice(models) = material.key("model").unwrap().shape else {
        panic!("a model is a word");
    };
    for described in vocabulary().materials() {
        assert!(models.iter().any(|one| one.word == described.name));
        for key in described.keys {
            assert!(material.key(key.name).is_some(), "{}", key.name);
        }
    }
    for described in vocabulary().laws() {
        let law = keys_of(&["contact", "enforcement", described.name]);
        assert_eq!(law.keys.len(), described.keys.len());
    }
    for described in vocabulary().frictions() {
        for path in [
            &["contact", "friction"][..],
            &["step", "contact", "friction"],
        ] {
            let friction = keys_of(path);
            assert!(
                described
                    .keys
                    .iter()
                    .all(|key| friction.key(key.name).is_some())
            );
        }
    }
    assert!(vocabulary().materials().len() > 5 && vocabulary().laws().len() > 1);
}

#[test]
fn the_schema_has_every_key_with_its_meaning() {
    let text = serde_json::to_string(&schema(vocabulary())).unwrap();
    let schema: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(
        schema["$schema"],
        "https://json-schema.org/draft/2020-12/schema"
    );
    fn find(schema: &serde_json::Value) -> Option<&serde_json::Value> {
        if schema.get("properties").is_some() {
            return Some(schema);
        }
        let inner = schema
            .get("items")
            .or_else(|| schema.get("additionalProperties"));
        inner
            .and_then(find)
            .or_else(|| schema.get("anyOf")?.as_array()?.iter().find_map(find))
    }
    let mut nkey = 0;
    each_table(vocabulary().case, "", &mut |table, path| {
        let place = path
            .split('.')
            .filter(|part| !part.is_empty())
            .try_fold(&schema, |at, part| find(at)?.get("properties")?.get(part));
        let properties = &find(place.unwrap_or_else(|| panic!("{path}"))).unwrap()["properties"];
        for key in table.keys {
            let property = &properties[key.name];
            assert!(
                property["description"]
                    .as_str()
                    .is_some_and(|doc| doc.starts_with(key.doc)),
                "{path}.{}",
                key.name
            );
            assert_eq!(property.get("not").is_some(), key.later.is_some());
            nkey += 1;
        }
        assert_eq!(properties.as_object().unwrap().len(), table.keys.len());
    });
    assert!(nkey > 130, "{nkey}");
}

/// Reads damaged copies of all cases, one for each seed; returns how many still read and how many are refused.
fn read_damaged(seeds: std::ops::Range<u64>) -> (usize, usize) {
    let (mut nread, mut nrefused) = (0, 0);
    for seed in seeds {
        let mut generator = Generator::new(seed);
        let text = [PAPER_BRICK, HERTZ, SLIDING, EVERYTHING, PLANE][generator.below(5)];
        let bytes = mutate(text.as_bytes(), &mut generator);
        match read_case("case.toml", &bytes, &[], vocabulary()) {
            Ok((case, warnings)) => {
                let written = resolved(&case, vocabulary());
                let (again, _) =
                    read(&written).unwrap_or_else(|all| panic!("seed {seed}: {all}\n{written}"));
                assert_eq!(again, case, "seed {seed}");
                assert!(!warnings.has_errors());
                nread += 1;
            }
            Err(all) => {
                assert!(
                    all.exit_code() == Some(3) && !all.coloured().is_empty(),
                    "seed {seed}"
                );
                nrefused += 1;
            }
        }
    }
    (nread, nrefused)
}

#[test]
fn damaged_texts_never_panic_and_what_reads_round_trips() {
    let (nread, nrefused) = read_damaged(0..2_000);
    assert!(
        nread > 50 && nrefused > 1_000,
        "{nread} read, {nrefused} refused"
    );
}

#[test]
#[ignore = "takes a minute"]
fn a_hundred_thousand_damaged_texts_never_panic() {
    let (nread, nrefused) = read_damaged(2_000..102_000);
    assert!(
        nread > 2_500 && nrefused > 50_000,
        "{nread} read, {nrefused} refused"
    );
}

#[test]
fn damaged_options_never_panic() {
    for seed in 0..2000 {
        let mut generator = Generator::new(seed);
        let (path, value) = WRONG_OPTIONS[generator.below(WRONG_OPTIONS.len())];
        let damaged = |text: &str, generator: &mut Generator| {
            String::from_utf8_lossy(&mutate(text.as_bytes(), generator)).into_owned()
        };
        let set = [(
            damaged(path, &mut generator),
            damaged(value, &mut generator),
        )];
        if let Err(all) = read_case("case.toml", PAPER_BRICK.as_bytes(), &set, vocabulary()) {
            assert!(
                all.exit_code() == Some(3) && all.plain().contains("--set"),
                "{all}"
            );
        }
    }
}

/// Texts made to take long: many of something, or deep; `n` of it, or in proportion.
fn hostile(n: usize) -> Vec<(&'static str, String)> {
    let lines = |line: &dyn Fn(usize) -> String| (0..n).map(line).collect::<String>();
    vec![
        ("blank lines", "\n".repeat(300 * n)),
        ("unknown keys", lines(&|n| format!("key{n} = {n}\n"))),
        ("one key many times", lines(&|_| "title = 1\n".to_owned())),
        ("decimal commas", lines(&|n| format!("key{n} = 0,{n}\n"))),
        (
            "undefined materials",
            lines(&|n| {
                format!("[[body]]\ngroup = \"g{n}\"\nmaterial = \"m{n}\"\n[material.n{n}]\n")
            }),
        ),
        (
            "sets and bodies",
            lines(&|n| {
                format!("[[body]]\ngroup = \"g{n}\"\nmaterial = \"m\"\n[sets.s{n}]\nnodes = [1]\n")
            }),
        ),
        ("dots", format!("{}a = 1", "a.".repeat(15 * n))),
        ("headings", format!("[{}a]\n", "a.".repeat(15 * n))),
        ("braces", format!("a = {}", "{a=".repeat(10 * n))),
        ("a long key", format!("{} = 1", "a".repeat(30 * n))),
        (
            "a long text",
            format!("title = \"{}\"\nx = 1", "a".repeat(300 * n)),
        ),
    ]
}

/// Work is counted in allocations and their bytes: with the square of the size it would grow sixteenfold.
#[test]
fn texts_made_to_take_long_take_what_their_size_takes() {
    for ((name, few), (_, many)) in hostile(7_500).iter().zip(&hostile(30_000)) {
        let [few, many] = [few, many].map(|text| {
            let mut message = String::new();
            let taken = allocation_counter::measure(|| message = read(text).unwrap_err().plain());
            assert!(message.len() < 50_000, "{name}");
            taken
        });
        println!("{name}: {few:?}, {many:?}");
        let bytes = 6 * few.bytes_total + (1 << 16);
        assert!(many.bytes_total < bytes, "{name}: {few:?}, {many:?}");
        let count = 6 * few.count_total + (1 << 10);
        assert!(many.count_total < count, "{name}: {few:?}, {many:?}");
    }
}

#[test]
fn ten_times_as_many_nodes_take_ten_times_the_memory() {
    let [few, many] = [10_000, 100_000].map(|nnode| {
        let mut text = String::from("[mesh]\nnodes = [\n");
        for n in 0..nnode {
            let x = f64::from(n) * 0.001;
            let _ = writeln!(text, "  [{n}, {}, {x:.6}, -1.5e-3],", n % 100);
        }
        text.push_str(
            "]\nelements = [{ id = 1, type = \"tet4\", group = \"a\", nodes = [0, 1, 2, 3] }]\n",
        );
        text.push_str("[[body]]\ngroup = \"a\"\nrigid = true\n[[step]]\nname = \"s\"\n");
        let mut result = None;
        let taken = allocation_counter::measure(|| result = Some(read(&text)));
        let (case, _) = result.unwrap().unwrap();
        let nread = match &case.mesh {
            MeshSource::Inline { nodes, .. } => nodes.len(),
            _ => 0,
        };
        assert_eq!(nread, nnode as usize);
        taken.bytes_total as f64 / text.len() as f64
    });
    // lists double when they are full
    assert!(many < 2.0 * few, "{few}, {many} bytes per byte of the text");
}

#[test]
fn a_body_has_a_plane_of_its_own_where_it_goes_with_the_model() {
    let text = |model: &str, body: &str| {
        format!(
            "step = [{{ name = 's' }}]\nmodel = {{ {model} }}\nmaterial = {{ m = {{ model = 'linear-elastic', E = 1, nu = 0 }} }}\n\
             body = [{{ group = 'a', material = 'm', {body} }}]\n[mesh]\nnodes = [[1, 0, 0], [2, 1, 0], [3, 0, 1]]\n\
             elements = [{{ id = 1, type = 'tri3', group = 'a', nodes = [1, 2, 3] }}]\n"
        )
    };
    let ring = "space = 'axisymmetric'";
    let (case, _) = read(&text(ring, "space = 'plane-stress', thickness = 3")).unwrap();
    let body = &case.bodies[0];
    assert_eq!(body.space.as_ref().unwrap().value, Space::PlaneStress);
    assert_eq!(read(&resolved(&case, vocabulary())).unwrap().0, case);
    for (model, body, code) in [
        (ring, "space = 'plane-strain', thickness = 3", "S0112"),
        (ring, "space = 'plane-stress'", "S0106"),
        (ring, "thickness = 3", "S0112"),
        ("space = 'plane-strain'", "space = 'axisymmetric'", "S0112"),
        (
            "space = 'plane-stress'",
            "space = 'axisymmetric', thickness = 2",
            "S0112",
        ),
    ] {
        let found = codes_of(&text(model, body));
        assert_eq!(found, [code], "{model} {body}");
    }
}
