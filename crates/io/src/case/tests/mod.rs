//! Tests of reading cases: the manual's cases, messages, options, round trips, damaged texts, cost.

mod agreement;
mod damage;
mod faults;
mod messages;
mod options;
mod shells;

use super::vocabulary::{Kinds, Vocabulary};
use super::*;
use crate::diagnostic::Class;
use std::sync::LazyLock;

const PAPER_BRICK: &str = include_str!("../cases/paper_brick.toml");
const HERTZ: &str = include_str!("../cases/hertz.toml");
const SLIDING: &str = include_str!("../cases/sliding.toml");
/// A case that says everything this version understands.
const EVERYTHING: &str = include_str!("../cases/everything.toml");
/// What is different in the plane.
const PLANE: &str = include_str!("../cases/plane.toml");

pub(super) fn vocabulary() -> &'static Vocabulary {
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
