//! Cases as text, and the parts they become.

use super::carriers::Carriers;
use super::names::Names;
use super::*;
use signorini_geometry::tensor::Vec3;
use signorini_io::case::{read_case, resolved};
use signorini_mechanics::contact::Measure;
use signorini_mechanics::contact::discretization::SlidingRange;
use signorini_mechanics::contact::friction::{Coulomb, Falling, FrictionLaw, Tresca};
use signorini_mechanics::contact::law::{Exponential, Table};
use signorini_mechanics::load::Course;
use signorini_mechanics::model::{
    self, AreaPart, BodyKind, Change, ConstraintKind, ContactChange, ContactPart, FrictionPart,
    Load, PrimaryPart, SidePart, StartPart, StepPart, StickPart, Target, TieOffset, TiePart,
    Unknown,
};
use signorini_mechanics::solid::{Integration, Locking};
use signorini_mechanics::solve::Motion;
use std::path::Path;

/// Two unit cubes, one on the other and apart by nothing but their nodes; a bar next to them.
const CUBES: &str = r#"
[mesh]
nodes = [
  [1, 0, 0, 0], [2, 1, 0, 0], [3, 1, 1, 0], [4, 0, 1, 0],
  [5, 0, 0, 1], [6, 1, 0, 1], [7, 1, 1, 1], [8, 0, 1, 1],
  [11, 0, 0, 1], [12, 1, 0, 1], [13, 1, 1, 1], [14, 0, 1, 1],
  [15, 0, 0, 2], [16, 1, 0, 2], [17, 1, 1, 2], [18, 0, 1, 2],
  [21, 3, 0, 0], [22, 3, 0, 2], [99, 9, 9, 1],
]
elements = [
  { id = 1, type = "hex8", group = "low", nodes = [1, 2, 3, 4, 5, 6, 7, 8] },
  { id = 2, type = "hex8", group = "high", nodes = [11, 12, 13, 14, 15, 16, 17, 18] },
  { id = 3, type = "line2", group = "bar", nodes = [21, 22] },
]
[material.steel]
model = "linear-elastic"
E = 210e3
nu = 0.3
[[body]]
group = "low"
material = "steel"
"#;

const BASE: &str = "[sets]\nbase = { plane = 'z', at = 0, of = 'low' }\n";
const STEP: &str = "[[step]]\nname = 'one'\n[[step.fix]]\non = 'base'\nu = 'all'\n";

/// The comparable content of parts, with the warnings.
struct Built {
    text: String,
    springs: Vec<signorini_mechanics::model::SpringPart>,
    constraints: Vec<signorini_mechanics::model::ConstraintPart>,
    carriers: Vec<signorini_mechanics::model::CarrierPart>,
    steps: Vec<StepPart>,
    bodies: Vec<signorini_mechanics::model::BodyPart>,
    temperature: Vec<f64>,
    contacts: Vec<signorini_mechanics::model::ContactPart>,
    warnings: Diagnostics,
    case: Case,
}

fn try_parts(text: &str) -> Result<Built, Diagnostics> {
    let (mut case, mut found) = read_case("case.toml", text.as_bytes(), &[], crate::vocabulary())?;
    let (mut mesh, _) = read_mesh_of(&case, Path::new("."))?;
    let cuts = Cuts::new(&case, &mut mesh, &mut found);
    let names = Names::new(&case, &mesh, &mut found);
    let carriers = Carriers::new(&case, &names, &mut found);
    let (parts, start) = match parts(&case, &mesh, &names, &carriers, &cuts, &mut found) {
        Some(parts) if !found.has_errors() => parts,
        _ => return Err(found),
    };
    let text = format!(
        "{:?} {:?} {:?} {:?} {:?} {:?} {:?}",
        parts.space,
        parts.carriers,
        parts.springs,
        parts.constraints,
        parts.contacts,
        parts.temperature,
        parts.steps
    );
    let built = (
        parts.springs,
        parts.constraints,
        parts.carriers,
        parts.steps,
        parts.bodies,
        parts.temperature,
        parts.contacts,
    );
    case.initial_temperature = start.map(Spanned::from);
    let (springs, constraints, carriers, steps, bodies, temperature, contacts) = built;
    Ok(Built {
        text,
        springs,
        constraints,
        carriers,
        steps,
        bodies,
        temperature,
        contacts,
        warnings: found,
        case,
    })
}

#[track_caller]
fn parts_of(text: &str) -> Built {
    try_parts(text).unwrap_or_else(|all| panic!("{all}"))
}

/// The parts of the cubes with more behind them.
#[track_caller]
fn cubes(more: &str) -> Built {
    parts_of(&format!("{CUBES}{BASE}{more}"))
}

/// What is said about the cubes with more behind them: the code of its first error, and all of it.
#[track_caller]
fn refused(more: &str) -> (&'static str, String) {
    let all = try_parts(&format!("{CUBES}{BASE}{more}")).err().unwrap();
    let first = all.iter().next().map_or("", |one| one.code.id);
    (first, all.plain())
}

fn labels(mesh_nodes: &[NodeId]) -> Vec<u64> {
    const LABELS: [u64; 19] = [
        1, 2, 3, 4, 5, 6, 7, 8, 11, 12, 13, 14, 15, 16, 17, 18, 21, 22, 99,
    ];
    mesh_nodes.iter().map(|&n| LABELS[n as usize]).collect()
}

fn fixed(step: &StepPart) -> Vec<u64> {
    match &step.changes[0] {
        Change::Prescribe(Target::Nodes(nodes), _) => labels(nodes),
        other => panic!("{other:?}"),
    }
}

#[test]
fn sets_by_geometry_hold_the_nodes_of_their_place_and_no_stray_ones() {
    for (set, expected) in [
        ("{ plane = 'z', at = 1 }", &[5, 6, 7, 8, 11, 12, 13, 14][..]),
        ("{ plane = 'z', at = 1, of = 'high' }", &[11, 12, 13, 14]),
        ("{ plane = [0, 0, -2], at = -2.0 }", &[15, 16, 17, 18, 22]),
        ("{ box = [[0, 0, 0], [1, 0.5, 0.9]] }", &[1, 2]),
        ("{ sphere = [[3, 0, 0], 0.5] }", &[21]),
        ("{ near = [9, 9, 1.1], of = 'low' }", &[7]),
        ("{ union = ['later', 'base'] }", &[1, 2, 3, 4, 22]),
    ] {
        let more = format!(
            "here = {set}\nlater = {{ near = [3, 0, 9] }}\n{}",
            STEP.replace("base", "here")
        );
        assert_eq!(fixed(&cubes(&more).steps[0]), expected, "{set}");
    }
    let (code, text) = refused(&format!("off = {{ plane = 'x', at = 7 }}\n{STEP}"));
    assert!(
        code == "S0203" && text.contains("\"off\" is empty"),
        "{text}"
    );
}

#[test]
fn a_set_by_geometry_is_a_surface_where_it_holds_whole_outer_faces() {
    let contact = "[[contact]]\nname = 'c'\nsecondary = 'under'\nprimary = 'over'\n";
    let sets = "over = { plane = 'z', at = 1, of = 'low' }\nunder = { plane = 'z', at = 1, of = 'high' }\n";
    let body = "[[body]]\ngroup = 'high'\nmaterial = 'steel'\n";
    let built = cubes(&format!("{sets}{body}{contact}{STEP}"));
    let part = &built.contacts[0];
    assert!(matches!(&part.primary, PrimaryPart::Faces(faces) if faces.len() == 1));
    assert!(matches!(&part.secondary, SidePart::Faces(faces) if faces.len() == 1));
}

#[test]
fn loads_become_what_they_say() {
    let load = |what: &str| {
        let sets = "top = { plane = 'z', at = 1, of = 'low' }\nedge = { nodes = [5, 6] }\n";
        let text = format!("{sets}{STEP}[[step.load]]\n{what}\n");
        let text = format!("{CUBES}{BASE}{text}").replace("nu = 0.3", "nu = 0.3\ndensity = 7.8e-9");
        let mut built = parts_of(&text);
        built.steps[0].loads.remove(0)
    };
    let face_of = |faces: &[signorini_geometry::mesh::Face]| faces.len();
    match load("on = 'top'\nforce = [0, 0, -5]").load {
        Load::Force { faces, total } => {
            assert_eq!((face_of(&faces), total.z), (1, -5.0));
        }
        other => panic!("{other:?}"),
    }
    match load("on = 'edge'\nforce = [0, 4, 0]").load {
        Load::Nodes(nodes) => {
            assert!(nodes.len() == 2 && nodes.iter().all(|(_, f)| f.y == 2.0));
        }
        other => panic!("{other:?}"),
    }
    match load("on = 'edge'\nper_node = [0, 4, 0]").load {
        Load::Nodes(nodes) => assert!(nodes.iter().all(|(_, f)| f.y == 4.0)),
        other => panic!("{other:?}"),
    }
    let follows = |load: Load| match load {
        Load::Pressure {
            follows, pressure, ..
        } => {
            assert_eq!(pressure, 0.5);
            follows
        }
        other => panic!("{other:?}"),
    };
    assert!(follows(load("on = 'top'\npressure = 0.5").load));
    assert!(!follows(
        load("on = 'top'\npressure = 0.5\nfollows = false").load
    ));
    assert!(matches!(
        load("on = 'top'\ntraction = [1, 0, 0]").load,
        Load::Traction { traction, .. } if traction == Vec3::unit(0)
    ));
    assert!(matches!(
        load("on = 'top'\nmoment = [0, 0, 2]").load,
        Load::Moment { nodes, .. } if labels(&nodes) == [5, 6, 7, 8]
    ));
    assert!(matches!(
        load("on = 'low'\nbody_force = [0, 0, 1]").load,
        Load::Body { cells, .. } if cells.len() == 1
    ));
    assert!(matches!(
        load("on = 'all'\ngravity = [0, 0, -9810]").load,
        Load::Gravity { cells, acceleration } if cells.len() == 1 && acceleration.z == -9810.0
    ));
    assert!(matches!(
        load("on = 'low'\ncentrifugal = { speed = 3, axis = [0, 0, 2] }").load,
        Load::Centrifugal { speed, axis, .. } if speed == 3.0 && axis == Vec3::unit(2)
    ));
}

#[test]
fn loads_go_over_time_as_their_course_says() {
    let amplitudes = "[amplitude.saw]\ntable = [[0, 0], [1, 2]]\n[amplitude.whole]\ntable = [[0, 1], [5, 3]]\ntime = 'total'\n";
    let load = "on = 'base'\nper_node = [0, 0, 1]";
    let text = format!(
        "{amplitudes}{STEP}[[step.load]]\n{load}\n[[step.load]]\n{load}\ntable = [[0, 0.5]]\n[[step.load]]\n{load}\namplitude = 'saw'\n\
         [[step.load]]\n{load}\namplitude = 'whole'\n[[step]]\nname = 'two'\n[[step]]\nname = 'three'\n"
    );
    let built = cubes(&text);
    let courses: Vec<&Course> = built.steps[0].loads.iter().map(|l| &l.course).collect();
    assert_eq!(
        courses,
        [
            &Course::Ramp,
            &Course::Table(vec![[0.0, 0.5]]),
            &Course::Table(vec![[0.0, 0.0], [1.0, 2.0]]),
            &Course::TotalTable(vec![[0.0, 1.0], [5.0, 3.0]]),
        ]
    );
    assert!(
        built.warnings.is_empty(),
        "a load in total time goes on: {}",
        built.warnings
    );
}

#[test]
fn steps_change_what_they_name_and_keep_the_rest() {
    let text = format!(
        "{STEP}[[step.load]]\nname = 'push'\non = 'base'\nforce = [1, 0, 0]\n[[step]]\nname = 'two'\ngeometry = 'linear'\n\
         [[step.free]]\non = 'base'\nu = ['x']\n[[step.load]]\nname = 'push'\non = 'base'\nforce = [0, 0, 0]\n\
         [[step.move]]\non = 'base'\nuz = {{ table = [[0, 0], [1, 2]] }}\n[[step]]\nname = 'three'\n"
    );
    let built = cubes(&text);
    let [one, two, three] = &built.steps[..] else {
        panic!("three steps");
    };
    assert_eq!(
        (one.nonlinear, two.nonlinear, three.nonlinear),
        (true, false, false)
    );
    assert_eq!(one.loads[0].name, two.loads[0].name);
    assert!(matches!(&two.changes[0], Change::Release(_, components) if components == &[0]));
    let table = Motion::Table(vec![[0.0, 0.0], [1.0, 2.0]]);
    assert!(matches!(&two.changes[1], Change::Prescribe(_, motions) if motions == &[(2, table)]));
    assert!(three.changes.is_empty() && three.loads.is_empty());
    let notes = built.warnings.plain();
    assert!(
        notes.contains("S0405") && notes.contains("\"three\" changes nothing"),
        "{notes}"
    );
}

#[test]
fn references_carry_rigid_bodies_and_nodes() {
    let text = "[reference.pilot]\nat = [0, 0, 5]\n[reference.corner]\nnode = 18\n\
        [[body]]\ngroup = 'high'\nrigid = true\nreference = 'pilot'\n[[body]]\ngroup = 'bar'\nrigid = true\n\
        [[constraint]]\nkind = 'kinematic'\non = 'base'\nreference = 'corner'\ndofs = ['x', 'z']\n\
        [[constraint]]\nkind = 'distributing'\non = 'top'\nreference = 'corner'\n\
        [[step]]\nname = 'one'\n[[step.fix]]\non = 'corner'\nrot = ['x']\n[[step.move]]\non = 'high'\nrz = 1.0\n\
        [[step.load]]\non = 'pilot'\nmoment = [1, 0, 0]\n";
    let built = cubes(&format!(
        "top = {{ plane = 'z', at = 1, of = 'low' }}\n{text}"
    ));
    let names: Vec<&str> = built.carriers.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["pilot", "corner", "bar"]);
    assert_eq!(built.carriers[1].at, Some(Vec3::new(0.0, 1.0, 2.0)));
    assert_eq!(built.carriers[2].at, None);
    let rigid = |n: usize| matches!(built.bodies[n].kind, BodyKind::Rigid(c) if c == [9, 0, 2][n]);
    assert!(rigid(1) && rigid(2));
    assert!(matches!(
        &built.constraints[0].kind,
        ConstraintKind::Kinematic { carrier: 1, axes: [true, false, true], nodes } if labels(nodes) == [1, 2, 3, 4]
    ));
    let ConstraintKind::Distributing { nodes, .. } = &built.constraints[1].kind else {
        panic!("distributing");
    };
    assert!(nodes.iter().all(|(_, share)| (share - 0.25).abs() < 1e-15));
    assert!(
        matches!(&built.steps[0].changes[0], Change::Prescribe(Target::Rigid(1), m) if m[0].0 == 3)
    );
    assert!(
        matches!(&built.steps[0].changes[1], Change::Prescribe(Target::Rigid(0), m) if m[0].0 == 5)
    );
    assert!(matches!(
        built.steps[0].loads[0].load,
        Load::Carrier { carrier: 0, moment, .. } if moment == Vec3::unit(0)
    ));
}

#[test]
fn equations_and_springs_pair_nodes_in_the_order_they_are_listed() {
    let sets = "a = { nodes = [8, 5] }\nb = { nodes = [11, 14] }\none = { nodes = [21] }\n";
    let text = format!(
        "{sets}[[constraint]]\nequation = [['a', 'x', 1.0], ['b', 'y', -2.0], ['one', 'z', 0.5]]\nrhs = 0.25\n\
         [[constraint]]\nkind = 'equal'\non = 'a'\ndofs = ['y']\n[[constraint]]\nkind = 'plane'\non = 'base'\n\
         [[spring]]\nname = 's'\nbetween = ['a', 'b']\nstiffness = 3\n[[spring]]\nname = 'g'\non = 'a'\nstiffness = 4\n\
         direction = [0, 3, 4]\n{STEP}"
    );
    let built = cubes(&text);
    let node = |label: u64, axis| {
        let at = (0..19).find(|&n| labels(&[n]) == [label]).unwrap();
        Unknown::Node(at, axis)
    };
    let equations: Vec<_> = built
        .constraints
        .iter()
        .take(2)
        .map(|c| c.kind.clone())
        .collect();
    let equation = |a, b| ConstraintKind::Equation {
        terms: vec![(node(a, 0), 1.0), (node(b, 1), -2.0), (node(21, 2), 0.5)],
        rhs: 0.25,
    };
    assert_eq!(equations, [equation(8, 11), equation(5, 14)]);
    assert!(matches!(
        &built.constraints[2].kind,
        ConstraintKind::Equal {
            axes: [false, true, false],
            ..
        }
    ));
    assert!(
        matches!(&built.constraints[3].kind, ConstraintKind::Plane { nodes } if nodes.len() == 4)
    );
    let ends = |n: usize| {
        let ends = built.springs[n].ends.iter();
        ends.map(|(a, b)| (labels(&[*a])[0], b.map(|b| labels(&[b])[0])))
            .collect::<Vec<_>>()
    };
    assert_eq!(ends(0), [(8, Some(11)), (5, Some(14))]);
    assert_eq!(ends(1), [(8, None), (5, None)]);
    assert_eq!(built.springs[1].direction, Some(Vec3::new(0.0, 0.6, 0.8)));
}

#[test]
fn couplings_become_constraints_of_the_whole_run() {
    let load = "[[step.load]]\non = 'top'\nforce = [0, 0, -1]\ncoupling = 'rigid-z'\n";
    let top = "top = { plane = 'z', at = 1, of = 'low' }\n";
    let built = cubes(&format!("{top}{STEP}{load}[[step]]\nname = 'two'\n{load}"));
    assert_eq!(built.constraints.len(), 1);
    assert!(matches!(
        &built.constraints[0].kind,
        ConstraintKind::Equal { nodes, axes: [false, false, true] } if labels(nodes) == [5, 6, 7, 8]
    ));
    let (code, text) = refused(&format!("{top}{STEP}[[step]]\nname = 'two'\n{load}"));
    assert!(
        code == "S0112" && text.contains("from the first step on"),
        "{text}"
    );
}

#[test]
fn bodies_are_solids_bars_or_rigid_with_what_they_are_made_of() {
    let bar = "[[body]]\ngroup = 'bar'\nmaterial = 'steel'\narea = 2.5\n";
    let text = format!("{CUBES}{bar}{BASE}{STEP}").replace(
        "group = \"low\"\nmaterial = \"steel\"",
        "group = \"low\"\nmaterial = \"steel\"\nintegration = 'reduced'\nlocking = 'b-bar'\norientation = { x = [0, 1, 0], y = [0, 0, 1] }",
    );
    let text = text.replace(
        "nu = 0.3",
        "nu = 0.3\ndensity = 2.0\nplasticity = { table = [[250, 0], [300, 0.1]] }",
    );
    let built = parts_of(&text);
    let BodyKind::Solid {
        integration,
        locking,
        density,
        ..
    } = &built.bodies[0].kind
    else {
        panic!("a solid");
    };
    assert_eq!(
        (*integration, *locking, *density),
        (Integration::Reduced, Locking::BBar, Some(2.0))
    );
    let BodyKind::Truss { area, material, .. } = &built.bodies[1].kind else {
        panic!("bars");
    };
    assert!(*area == 2.5 && material.nhistory() > 0);
    for (from, to, code, word) in [
        ("area = 2.5", "", "S0106", "has no `area`"),
        (
            "integration = 'reduced'",
            "area = 1",
            "S0112",
            "which have no `area`",
        ),
        ("[300, 0.1]", "[300, 0.0]", "S0117", "do not increase"),
    ] {
        assert!(text.contains(from), "{from}");
        let all = try_parts(&text.replace(from, to)).err().unwrap();
        assert_eq!(all.iter().next().unwrap().code.id, code, "{all}");
        assert!(all.plain().contains(word), "{all}");
    }
}

#[test]
fn bodies_start_without_thermal_strain_unless_the_case_says_otherwise() {
    let heated = format!("{STEP}[[step.temperature]]\non = 'base'\nvalue = 120\n");
    let text = format!("{CUBES}{BASE}{heated}");
    let expands = "nu = 0.3\nexpansion = { alpha = 1e-5, reference = 20 }";
    let built = parts_of(&text.replace("nu = 0.3", expands));
    assert!(built.temperature.len() == 19 && built.temperature.iter().all(|t| *t == 20.0));
    assert_eq!(built.case.initial_temperature, Some(20.0.into()));
    assert_eq!(built.steps[0].temperatures.len(), 4);
    let given = text.replace("[[body]]", "[initial]\ntemperature = 5\n[[body]]");
    let built = parts_of(&given.replace("nu = 0.3", expands));
    assert!(built.temperature.iter().all(|t| *t == 5.0));
    let built = parts_of(&text);
    let said = built.warnings.plain();
    assert!(
        said.contains("S0405") && said.contains("no material expands"),
        "{said}"
    );
    assert!(
        parts_of(&format!("{CUBES}{BASE}{STEP}"))
            .temperature
            .is_empty()
    );
}

#[test]
fn what_cannot_be_is_refused_with_its_reason() {
    let top = "top = { plane = 'z', at = 1, of = 'low' }\nedge = { nodes = [5, 6] }\n";
    let pilot = "[reference.pilot]\nat = [0, 0, 5]\n";
    let load = |what: &str| format!("{top}{pilot}{STEP}[[step.load]]\n{what}\n");
    for (more, code, word) in [
        (
            load("on = 'edge'\npressure = 1"),
            "S0203",
            "a pressure needs some",
        ),
        (
            load("on = 'top'\nforce = [1, 0, 0]\nfollows = true"),
            "S0112",
            "keeps its direction",
        ),
        (
            load("on = 'pilot'\nforce = [1, 0, 0]"),
            "S0112",
            "moves nothing",
        ),
        (
            load("on = 'low'\ngravity = [1, 0, 0]"),
            "S0106",
            "no `density`",
        ),
        (
            load("on = 'high'\nbody_force = [1, 0, 0]"),
            "S0203",
            "in no body that deforms",
        ),
        (
            load("on = 'nowhere'\nforce = [1, 0, 0]"),
            "S0201",
            "nowhere",
        ),
        (format!("{STEP}rot = 'all'\n"), "S0203", "have no rotations"),
        (
            format!("{STEP}[[step.move]]\non = 'base'\nrx = 1\n"),
            "S0203",
            "have no rotations",
        ),
        (
            format!(
                "a = {{ nodes = [1, 2, 3] }}\n[[constraint]]\nequation = [['a', 'x', 1], ['base', 'x', 1]]\n{STEP}"
            ),
            "S0203",
            "cannot be paired",
        ),
        (
            format!("[[constraint]]\nequation = [['base', 'rx', 1]]\n{STEP}"),
            "S0203",
            "have no rotations",
        ),
        (
            format!(
                "a = {{ nodes = [5] }}\nb = {{ nodes = [11] }}\n[[spring]]\nname = 's'\nbetween = ['a', 'b']\nstiffness = 1\n{STEP}"
            ),
            "S0106",
            "has no length",
        ),
        (
            format!("[reference.pilot]\nnode = 1000\n{STEP}"),
            "S0201",
            "no node 1000",
        ),
    ] {
        let (found, text) = refused(&more);
        assert!(
            found == code && text.contains(word),
            "{code} {word}: {text}"
        );
    }
}

/// The faces where the cubes touch, and bare nodes of theirs.
const SIDES: &str = "over = { plane = 'z', at = 1, of = 'low' }\nunder = { plane = 'z', at = 1, of = 'high' }\n\
    corner = { nodes = [13, 11] }\nedge = { nodes = [6, 5] }\nthree = { nodes = [5, 6, 7] }\n\
    [[body]]\ngroup = 'high'\nmaterial = 'steel'\n";
const CONTACT: &str = "[[contact]]\nname = 'c'\nsecondary = 'under'\nprimary = 'over'\n";

#[test]
fn contacts_become_what_they_say() {
    let contact = |keys: &str| {
        let built = cubes(&format!("{SIDES}{CONTACT}{keys}\n{STEP}"));
        built.contacts.into_iter().next().unwrap()
    };
    let plain = contact("");
    let default = ContactPart::new("c", plain.secondary.clone(), PrimaryPart::Itself);
    let same = |a: &ContactPart, b: &ContactPart| {
        let of = |part: &ContactPart| ContactPart {
            primary: PrimaryPart::Itself,
            ..part.clone()
        };
        assert_eq!(format!("{:?}", of(a)), format!("{:?}", of(b)));
    };
    same(&plain, &default);
    let changed = |keys: &str, change: &dyn Fn(&mut ContactPart)| {
        let mut wanted = default.clone();
        change(&mut wanted);
        same(&contact(keys), &wanted);
    };
    changed("method = 'node-to-segment'\npasses = 2", &|part| {
        part.method = model::Method::NodeToSegment;
        part.two_pass = true;
    });
    changed("method = 'gauss-point'", &|part| {
        part.method = model::Method::GaussPoint(model::PointRule {
            kind: model::PointKind::Gauss,
            points: None,
            cut: false,
        });
    });
    changed(
        "method = 'gauss-point'\nrule = { kind = 'lobatto', points = 4 }\narea = 'current'",
        &|part| {
            part.method = model::Method::GaussPoint(model::PointRule {
                kind: model::PointKind::Lobatto,
                points: Some(4),
                cut: false,
            });
            part.area = AreaPart::Present;
        },
    );
    changed("method = 'node-to-node'\nnormals = [0, 3, 0]", &|part| {
        part.method = model::Method::NodeToNode {
            normals: model::Normals::Given(Vec3::new(0.0, 3.0, 0.0)),
            pairs: model::PairOrder::Nearest,
        };
    });
    type Law = model::Enforcement;
    for (keys, law) in [
        ("penalty = 'auto'", Law::Penalty(None)),
        ("penalty = 5", Law::Penalty(Some(5.0))),
        (
            "penalty = [[-1, 5], [0, 0]]",
            Law::Law(Arc::new(Table::new(vec![[-1.0, 5.0], [0.0, 0.0]]).unwrap())),
        ),
        (
            "exponential = { p0 = 2, c0 = 0.5 }",
            Law::Law(Arc::new(Exponential {
                p0: 2.0,
                c0: 0.5,
                within: f64::INFINITY,
            })),
        ),
        ("lagrange = {}", Law::Lagrange),
        ("augmented = 'uzawa'", Law::Uzawa(None)),
        (
            "augmented = 'newton', penalty = 3",
            Law::AugmentedNewton(Some(3.0)),
        ),
    ] {
        changed(&format!("enforcement = {{ {keys} }}"), &|part| {
            part.enforcement = law.clone();
        });
    }
    changed("enforcement = { per = 'node' }", &|part| {
        part.enforcement = Law::Penalty(None);
        part.measure = Some(Measure::Node);
    });
    let coulomb = |mu, cap| -> Arc<dyn FrictionLaw> { Arc::new(Coulomb { mu, cap }) };
    let falling: Arc<dyn FrictionLaw> = Arc::new(Falling {
        stationary: 0.4,
        kinetic: 0.2,
        transition: 2.0,
    });
    for (friction, limit, stick) in [
        ("0.3", coulomb(0.3, f64::INFINITY), None),
        ("{ mu = 0.3, cap = 7 }", coulomb(0.3, 7.0), None),
        (
            "{ tresca = 4, stiffness = 9 }",
            Arc::new(Tresca(4.0)),
            Some(StickPart::Stiffness(9.0)),
        ),
        (
            "{ static = 0.4, kinetic = 0.2, transition = 2, elastic_slip = 0.1 }",
            falling,
            Some(StickPart::Slip(0.1)),
        ),
    ] {
        changed(&format!("friction = {friction}"), &|part| {
            let limit = Arc::clone(&limit);
            part.friction = Some(FrictionPart { limit, stick });
        });
    }
    changed("friction = { mu = 0, stiffness = 9 }", &|_| {});
    changed("sliding = 'small'\nreach = 0.5", &|part| {
        part.sliding = SlidingRange::Small;
        part.reach = Some(0.5);
    });
    for (tied, offset, within) in [
        ("true", TieOffset::Keep, None),
        ("{ within = 0.1 }", TieOffset::Keep, Some(0.1)),
        ("{ offset = 'close' }", TieOffset::Close, None),
    ] {
        changed(&format!("tied = {tied}"), &|part| {
            part.tie = Some(TiePart {
                offset,
                within,
                penalty_tangential: None,
            });
        });
    }
    let by_points = "method = 'gauss-point'\nenforcement = { penalty = 9 }";
    changed(
        &format!("{by_points}\ntied = {{ offset = 'pull', penalty_tangential = 2 }}"),
        &|part| {
            part.method = model::Method::GaussPoint(model::PointRule {
                kind: model::PointKind::Gauss,
                points: None,
                cut: false,
            });
            part.enforcement = model::Enforcement::Penalty(Some(9.0));
            part.tie = Some(TiePart {
                offset: TieOffset::Pull,
                within: None,
                penalty_tangential: Some(2.0),
            });
        },
    );
    changed(
        "start = { close_gaps_below = 0.1, clearance = 0, interference = 'strain-free' }",
        &|part| {
            part.start = StartPart {
                close_below: 0.1,
                close_nodes: Vec::new(),
                clearance: Some(0.0),
                interference: model::Interference::StrainFree,
                bends: true,
            };
        },
    );
    changed("start = { interference = 'now' }", &|part| {
        part.start.interference = model::Interference::AtOnce;
    });
}

#[test]
fn nodes_that_meet_in_order_keep_the_order_of_their_lists() {
    let contact = |keys: &str| {
        let contact = format!(
            "[[contact]]\nname = 'c'\nsecondary = 'corner'\nprimary = 'edge'\nmethod = 'node-to-node'\n{keys}\n"
        );
        let part = cubes(&format!("{SIDES}{contact}{STEP}")).contacts.remove(0);
        match (part.secondary, part.primary) {
            (SidePart::Nodes(secondary), PrimaryPart::Nodes(primary)) => {
                (labels(&secondary), labels(&primary))
            }
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(contact("pairs = 'order'"), (vec![13, 11], vec![6, 5]));
    assert_eq!(contact(""), (vec![11, 13], vec![5, 6]));
}

#[test]
fn nodes_in_order_have_the_normals_of_their_faces() {
    let sets = "turned = { nodes = [8, 7, 6, 5] }\nfour = { nodes = [14, 12, 13, 11] }\n";
    let of = |normals: &str| {
        let contact = format!(
            "[[contact]]\nname = 'c'\nsecondary = 'four'\nprimary = 'turned'\nmethod = 'node-to-node'\n\
             pairs = 'order'\nnormals = {normals}\n"
        );
        cubes(&format!("{sets}{SIDES}{contact}{STEP}"))
            .contacts
            .remove(0)
    };
    let part = of("'primary'");
    assert!(matches!(&part.primary, PrimaryPart::Faces(faces) if faces.len() == 1));
    // 14 meets 8, 12 meets 7, 13 meets 6, 11 meets 5
    assert!(matches!(&part.secondary, SidePart::Nodes(nodes) if labels(nodes) == [11, 13, 12, 14]));
    let part = of("'secondary'");
    assert!(matches!(&part.secondary, SidePart::Faces(faces) if faces.len() == 1));
    assert!(matches!(&part.primary, PrimaryPart::Nodes(nodes) if labels(nodes) == [5, 7, 6, 8]));
    let part = of("[0, 0, 1]");
    assert!(matches!(&part.secondary, SidePart::Nodes(nodes) if labels(nodes) == [14, 12, 13, 11]));
}

#[test]
fn a_surface_may_meet_itself() {
    let built = cubes(&format!(
        "{SIDES}{}{STEP}",
        CONTACT.replace("'over'", "'self'")
    ));
    assert!(matches!(built.contacts[0].primary, PrimaryPart::Itself));
}

#[test]
fn steps_change_contacts_that_act_at_some_time() {
    let other = |name: &str, secondary: &str| {
        format!(
            "[[contact]]\nname = '{name}'\nsecondary = '{secondary}'\nprimary = 'over'\nactive = false\n"
        )
    };
    let (never, late) = (other("never", "corner"), other("late", "high"));
    let change = |keys: &str| format!("[[step.contact]]\n{keys}\n");
    let steps = format!(
        "{STEP}{}[[step]]\nname = 'two'\n{}{}[[step]]\nname = 'three'\n{}{}",
        change("name = 'c'\nfriction = 0.3"),
        change("name = 'c'\nactive = false\nfriction = 0"),
        change("name = 'late'\nactive = true"),
        change("name = 'late'\nactive = true\nfriction = 0.0"),
        change("name = 'never'\nactive = false"),
    );
    let built = cubes(&format!("{SIDES}{never}{CONTACT}{late}{steps}"));
    let parts: Vec<_> = built
        .contacts
        .iter()
        .map(|c| (c.name.as_str(), c.active))
        .collect();
    assert_eq!(parts, [("c", true), ("late", false)]);
    let rough = FrictionPart::coulomb(0.3);
    let change = |contact, active, friction| ContactChange {
        contact,
        active,
        friction,
    };
    let shown = |changes: &[ContactChange]| format!("{changes:?}");
    assert_eq!(
        shown(&built.steps[0].contacts),
        shown(&[change(0, None, Some(Some(rough)))])
    );
    assert_eq!(
        shown(&built.steps[1].contacts),
        shown(&[
            change(0, Some(false), Some(None)),
            change(1, Some(true), None)
        ])
    );
    assert!(built.steps[2].contacts.is_empty());
    let notes = built.warnings.plain();
    for word in [
        "step \"three\" changes nothing of contact \"late\"",
        "all of it was so before",
        "step \"three\" changes nothing of contact \"never\"",
        "it acts in no step",
    ] {
        assert!(notes.contains(word), "{word}: {notes}");
    }
}

#[test]
fn what_sides_cannot_do_is_refused_with_its_reason() {
    let bare = CONTACT.replace("'under'", "'corner'");
    let surface =
        "[[surface]]\nname = 'floor'\nshape = { plane = { point = [0, 0, 0], normal = 'z' } }\n";
    let on_floor = CONTACT.replace("'over'", "'floor'");
    for (text, code, word) in [
        (
            format!("{bare}enforcement = {{ per = 'area' }}\n"),
            "S0203",
            "a penalty per area needs faces",
        ),
        (
            format!("{bare}passes = 2\n"),
            "S0203",
            "`passes` = 2 needs faces",
        ),
        (
            format!("{bare}area = 'current'\n"),
            "S0203",
            "area \"current\" needs faces",
        ),
        (
            format!("{bare}method = 'gauss-point'\n"),
            "S0203",
            "\"gauss-point\" needs faces",
        ),
        (
            bare.replace("'over'", "'self'"),
            "S0203",
            "with itself needs faces",
        ),
        (
            CONTACT.replace("'over'", "'edge'"),
            "S0203",
            "\"edge\" has no faces: the primary side needs some",
        ),
        (
            format!(
                "{}method = 'node-to-node'\npairs = 'order'\n",
                bare.replace("'over'", "'three'")
            ),
            "S0203",
            "\"corner\" has 2 nodes and \"three\" has 3: they cannot be paired",
        ),
        (
            format!("{surface}{}", CONTACT.replace("'over'", "'flor'")),
            "S0405",
            "did you mean \"floor\"?",
        ),
        (
            format!(
                "{surface}{on_floor}[[spring]]\nname = 's'\non = 'floor'\nstiffness = 1\ndirection = 'x'\n"
            ),
            "S0203",
            "surface \"floor\" has no nodes and no faces",
        ),
        (
            format!(
                "{}{on_floor}",
                surface.replace(
                    "plane = { point = [0, 0, 0], normal = 'z' }",
                    "stl = 'floor.stl'"
                )
            ),
            "S0309",
            "surface \"floor\": ",
        ),
    ] {
        let (found, said) = refused(&format!("{SIDES}{text}{STEP}"));
        assert!(
            found == code && said.contains(word),
            "{code} {word}: {said}"
        );
    }
}

#[test]
fn a_surface_has_a_name_that_no_group_of_the_mesh_has() {
    let surface = "[[surface]]\nname = 'floor'\nshape = { stl = 'floor.stl' }\n";
    let contact = CONTACT.replace("'over'", "'floor'");
    let text = format!("{CUBES}{BASE}{SIDES}{surface}{contact}{STEP}");
    let (case, _) = read_case("case.toml", text.as_bytes(), &[], crate::vocabulary()).unwrap();
    let (mut mesh, _) = read_mesh_of(&case, Path::new(".")).unwrap();
    mesh.sets.insert("floor".into(), Default::default());
    let all = build(case, mesh).err().unwrap().plain();
    assert!(
        all.contains("S0113") && all.contains("both a group of the mesh and a surface"),
        "{all}"
    );
}

#[test]
fn a_reference_that_a_surface_follows_moves_something() {
    let surface = "[reference.pilot]\nat = [0, 0, 5]\n[[surface]]\nname = 'floor'\n\
        shape = { sphere = { center = [0, 0, 5], radius = 1 } }\nreference = 'pilot'\n";
    let contact = CONTACT.replace("'over'", "'floor'");
    let moved = "[[step.move]]\non = 'pilot'\nuz = -1\n";
    cubes(&format!("{SIDES}{surface}{contact}{STEP}{moved}"));
    let alone = surface.replace("\nreference = 'pilot'", "");
    let (_, said) = refused(&format!("{SIDES}{alone}{contact}{STEP}{moved}"));
    assert!(said.contains("\"pilot\" moves nothing"), "{said}");
}

/// A ring, in the plane of its section.
const RING: &str = r#"
[model]
space = "axisymmetric"
[mesh]
nodes = [[1, 0, 0], [2, 2, 0], [3, 2, 1], [4, 0, 1]]
elements = [{ id = 1, type = "quad4", group = "ring", nodes = [1, 2, 3, 4] }]
[material.steel]
model = "linear-elastic"
E = 210e3
nu = 0.3
density = 1.0
[[body]]
group = "ring"
material = "steel"
[[step]]
name = "one"
[[step.fix]]
on = "ring"
u = "all"
"#;

#[test]
fn a_body_of_revolution_lies_on_one_side_of_its_axis() {
    assert!(parts_of(RING).text.starts_with("Axisymmetric"));
    let all = try_parts(&RING.replace("[1, 0, 0]", "[1, -0.5, 0]"))
        .err()
        .unwrap();
    assert!(all.plain().contains("node 1 lies at x = -0.5"), "{all}");
    let gravity = |g: &str| {
        try_parts(&format!(
            "{RING}[[step.load]]\non = 'ring'\ngravity = {g}\n"
        ))
    };
    assert!(gravity("[0, -9.81]").is_ok());
    let all = gravity("[1, 0]").err().unwrap();
    assert!(all.plain().contains("is not axisymmetric"), "{all}");
    let stress = parts_of(&RING.replace("\"axisymmetric\"", "\"plane-stress\"\nthickness = 0.5"));
    assert!(stress.text.starts_with("PlaneStress { thickness: 0.5 }"));
}

#[test]
fn what_a_contact_acts_in_says_how_far_it_slides() {
    let sliding = |keys: &str, steps: &[(&str, &str)]| {
        let mut text = format!(
            "{CUBES}{BASE}top = {{ plane = [0, 0, 3], at = 1, of = 'low' }}\n[[body]]\ngroup = 'high'\nmaterial = 'steel'\n\
             [[contact]]\nname = 'c'\nsecondary = 'high'\nprimary = 'top'\n{keys}\n"
        );
        for (number, (geometry, contact)) in steps.iter().enumerate() {
            text += &format!("[[step]]\nname = 's{number}'\ngeometry = '{geometry}'\n");
            if number == 0 {
                text += "[[step.fix]]\non = 'base'\nu = 'all'\n";
            }
            text += &format!("[[step.load]]\nname = 'l'\non = 'top'\npressure = {number}.5\n");
            if !contact.is_empty() {
                text += &format!("[[step.contact]]\nname = 'c'\nactive = {contact}\n");
            }
        }
        parts_of(&text).contacts[0].sliding
    };
    use SlidingRange::{Finite, Increment, Small};
    let (linear, nonlinear, auto) = (("linear", ""), ("nonlinear", ""), ("auto", ""));
    for (steps, right) in [
        (&[linear][..], Small),
        (&[nonlinear], Finite),
        (&[auto], Finite),
        (&[linear, auto, linear], Small),
        (&[linear, nonlinear], Finite),
        (&[nonlinear, linear], Finite),
        // it has gone before anything moves far
        (&[linear, ("nonlinear", "false")], Small),
        // bodies have moved before it comes
        (&[nonlinear, ("linear", "true")], Finite),
    ] {
        let inactive = steps.iter().any(|(_, contact)| *contact == "true");
        let keys = if inactive { "active = false" } else { "" };
        assert_eq!(sliding(keys, steps), right, "{steps:?}");
        for (word, given) in [("finite", Finite), ("small", Small)] {
            let keys = format!("{keys}\nsliding = '{word}'");
            assert_eq!(sliding(&keys, steps), given, "{steps:?}");
        }
    }
    let points = "method = 'node-to-segment'\nenforcement = { penalty = 9 }\nsliding = 'increment'";
    assert_eq!(sliding(points, &[linear]), Increment);
    // joined sides do not slide
    assert_eq!(sliding("tied = true", &[linear]), Finite);
}

#[test]
fn a_resolved_case_becomes_the_same_parts() {
    let text = "[reference.pilot]\nat = [0, 0, 5]\n[[body]]\ngroup = 'high'\nrigid = true\nreference = 'pilot'\n\
        [[spring]]\nname = 's'\nbetween = ['base', 'top']\nstiffness = 3\n\
        [[constraint]]\nkind = 'equal'\non = 'top'\ndofs = ['x']\n[[contact]]\nname = 'c'\nsecondary = 'high'\nprimary = 'top'\n\
        method = 'gauss-point'\nfriction = { mu = 0.3, cap = 2 }\nstart = { clearance = 0.1 }\n";
    let steps = "[[step.contact]]\nname = 'c'\nactive = false\n[[step.load]]\non = 'top'\npressure = 0.5\ntable = [[0, 0], [1, 2]]\n[[step.temperature]]\non = 'all'\nvalue = 50\n\
        [[step]]\nname = 'two'\n[[step.free]]\non = 'base'\nu = ['x']\n[[step.load]]\non = 'all'\ngravity = [0, 0, -1]\n";
    let text = format!(
        "{CUBES}{BASE}top = {{ plane = [0, 0, 3], at = 1, of = 'low' }}\n{text}{STEP}{steps}"
    );
    let text = text.replace(
        "nu = 0.3",
        "nu = 0.3\ndensity = 2.0\nexpansion = { alpha = 1e-5, reference = 20 }",
    );
    let first = parts_of(&text);
    let second = parts_of(&resolved(&first.case, crate::vocabulary()));
    assert_eq!(first.text, second.text);
    assert_eq!(
        resolved(&first.case, crate::vocabulary()),
        resolved(&second.case, crate::vocabulary())
    );
}

#[test]
fn the_remedy_against_locking_is_told_and_written_where_a_body_has_one() {
    let linear = STEP.replace("name = 'one'", "name = 'one'\ngeometry = 'linear'");
    let finite = "[[step]]\nname = 'two'\n[[step.move]]\non = 'base'\nuz = 0.1\n";
    for (nu, steps, told, locking) in [
        (
            "0.3",
            linear.clone(),
            "low: incompatible",
            Locking::Incompatible,
        ),
        ("0.49", linear.clone(), "low: b-bar", Locking::BBar),
        ("0.49", STEP.to_owned(), "low: f-bar", Locking::FBar),
        ("0.3", STEP.to_owned(), "", Locking::None),
        (
            "0.49",
            format!(
                "{linear}{}",
                finite.replace("'two'", "'two'\ngeometry = 'nonlinear'")
            ),
            "low: b-bar and f-bar",
            Locking::Auto,
        ),
    ] {
        let cubes = CUBES.replace("nu = 0.3", &format!("nu = {nu}"));
        let text = format!("{cubes}{BASE}{steps}");
        let (case, _) = read_case("case.toml", text.as_bytes(), &[], crate::vocabulary()).unwrap();
        let (mesh, _) = read_mesh_of(&case, Path::new(".")).unwrap();
        let model = build(case, mesh).unwrap_or_else(|all| panic!("{all}"));
        assert_eq!(model.remedies().concat(), told);
        assert_eq!(
            model.case.bodies[0].locking.value,
            bodies::locking_word(locking)
        );
    }
}

/// Two cubes that share a face, cut between them.
#[test]
fn a_cut_gives_its_side_nodes_of_its_own() {
    let mesh = "[mesh]\nnodes = [[1, 0, 0, 0], [2, 1, 0, 0], [3, 1, 1, 0], [4, 0, 1, 0],\n\
                [5, 0, 0, 1], [6, 1, 0, 1], [7, 1, 1, 1], [8, 0, 1, 1],\n\
                [15, 0, 0, 2], [16, 1, 0, 2], [17, 1, 1, 2], [18, 0, 1, 2]]\n\
                elements = [{ id = 1, type = 'hex8', group = 'low', nodes = [1, 2, 3, 4, 5, 6, 7, 8] },\n\
                { id = 2, type = 'hex8', group = 'high', nodes = [5, 6, 7, 8, 15, 16, 17, 18] }]\n\
                [material.steel]\nmodel = 'linear-elastic'\nE = 1\nnu = 0\n[[body]]\ngroup = ['low', 'high']\n\
                material = 'steel'\n[reference]\nbolt = { at = [0, 0, 0] }\n[sets]\n\
                base = { plane = 'z', at = 0 }\n";
    let text = |faces: &str, more: &str| {
        format!(
            "{mesh}cut = {{ faces = {faces} }}\n[[constraint]]\nkind = 'pretension'\non = 'cut'\n\
             reference = 'bolt'\n{more}{STEP}"
        )
    };
    let built = parts_of(&text("[[1, '+z']]", ""));
    let equations: Vec<_> = built
        .constraints
        .iter()
        .map(|c| match &c.kind {
            ConstraintKind::Equation { terms, .. } => terms.clone(),
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(equations.len(), 12);
    // the side below gets the copies: its normal points up
    let overlap = (Unknown::Carrier(0, 0), -1.0);
    assert_eq!(equations[2].last(), Some(&overlap));
    assert!(equations[0].len() == 2 && equations[1].len() == 2);
    assert!(matches!(
        equations[2][..2],
        [(Unknown::Node(12, 2), 1.0), (Unknown::Node(4..8, 2), -1.0)]
    ));
    let turned = parts_of(&text("[[2, '-z']]", "normal = [0, 3, -4]\n"));
    let along: Vec<f64> = turned.constraints[..3]
        .iter()
        .map(|c| match &c.kind {
            ConstraintKind::Equation { terms, .. } if terms.len() == 3 => terms[2].1,
            _ => 0.0,
        })
        .collect();
    assert_eq!(along, [0.0, -0.6, 0.8]);
    for (faces, more, wanted) in [
        ("[[1, '-z']]", "", "lies on the outside"),
        (
            "[[1, '+z']]",
            "[[constraint]]\nkind = 'pretension'\non = 'cut'\nreference = 'bolt'\n",
            "nodes of another pretension",
        ),
        (
            "[[1, '+z'], [2, '-z']]",
            "normal = 'z'\n",
            "does not cut the body",
        ),
    ] {
        let all = try_parts(&text(faces, more)).err().unwrap().plain();
        assert!(all.contains(wanted), "{all}");
    }
}

/// A quarter of a square about the z axis: the side y = 0 leads the side x = 0.
#[test]
fn nodes_of_a_sector_follow_those_of_its_other_side() {
    let sides = "lead = { plane = 'y', at = 0, of = 'low' }\nfollow = { plane = 'x', at = 0, of = 'low' }\n";
    let sector = |sectors: u32| {
        format!(
            "{sides}[[constraint]]\nkind = 'cyclic'\non = 'follow'\nwith = 'lead'\nsectors = {sectors}\n{STEP}"
        )
    };
    let built = cubes(&sector(4));
    assert_eq!(built.constraints.len(), 12);
    let rows: Vec<Vec<(Unknown, f64)>> = built
        .constraints
        .iter()
        .map(|c| match &c.kind {
            ConstraintKind::Equation { terms, .. } => terms.clone(),
            other => panic!("{other:?}"),
        })
        .collect();
    // u_x of (0, 1, z) is −u_y of (1, 0, z)
    let node = |unknown: Unknown| match unknown {
        Unknown::Node(node, axis) => (labels(&[node])[0], axis),
        other => panic!("{other:?}"),
    };
    let of = |label: u64, axis: usize| {
        let row = rows.iter().find(|row| node(row[0].0) == (label, axis));
        let row = row.unwrap();
        (node(row[1].0), row[1].1)
    };
    assert_eq!(of(4, 0), ((2, 1), 1.0));
    assert_eq!(of(4, 1), ((2, 0), -1.0));
    assert_eq!(of(8, 2), ((6, 2), -1.0));
    let (code, text) = refused(&sector(5));
    assert!(
        code == "S0308" && text.contains("turned by a sector of 5"),
        "{text}"
    );
}
