use super::load::vector;
use super::*;
use crate::case::{
    Area, AxesSystem, Body, ConstraintKind, Enforcement, FreeMotions, Geometry, Integration,
    Interference, Locking, Method, Motion, Offset, Per, SetContent, Sliding, Space, SpringEnds,
    SpringLaw, Unstrained,
};
use crate::fs::RealFs;
use signorini_geometry::tensor::Vec3;
use signorini_vocabulary::{Chosen, Value};
use std::f64::consts::FRAC_1_SQRT_2;

/// A cube with an element of this type, and more cards.
fn cube(kind: &str, cards: &str) -> String {
    format!(
        "*NODE, NSET=ALL\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n\
         *ELEMENT, TYPE={kind}, ELSET=CUBE\n1,1,2,3,4,5,6,7,8\n*NSET, NSET=TOP\n5,6,7,8\n\
         *NSET, NSET=BASE\n1,2,3,4\n*SURFACE, NAME=LID\nCUBE, S2\n*SURFACE, NAME=SOLE\nCUBE, S1\n\
         *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=CUBE, MATERIAL=M\n{cards}"
    )
}

const STEP: &str = "*STEP\n*STATIC\n*CLOAD\nTOP, 3, 1.\n*END STEP\n";

fn translated(text: &str, compat: Compat) -> Result<Read, Diagnostics> {
    read(&RealFs, "job.inp", text.as_bytes(), compat)
}

fn case(text: &str) -> Case {
    case_as(text, Compat::None)
}

fn case_as(text: &str, compat: Compat) -> Case {
    let read = translated(text, compat);
    read.unwrap_or_else(|found| panic!("{}", found.plain()))
        .case
}

fn refused(text: &str) -> String {
    translated(text, Compat::None).unwrap_err().plain()
}

#[test]
fn keywords_are_known_once_and_without_blanks() {
    let mut names: Vec<&str> = KEYWORDS.iter().map(|one| one.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), KEYWORDS.len());
    assert_eq!(
        Keyword::of("NODEPRINT").map(|one| one.name),
        Some("NODE PRINT")
    );
    assert_eq!(Keyword::of("NODE").map(|one| one.name), Some("NODE"));
    assert_eq!(Keyword::of("NOSUCHCARD"), None);
}

#[test]
fn types_of_elements_say_how_they_are_integrated() {
    let body = |kind: &str| -> Body { case(&cube(kind, STEP)).bodies[0].clone() };
    let of = |kind: &str| (body(kind).integration, body(kind).locking.value);
    assert_eq!(of("C3D8"), (Integration::Full, Locking::None));
    assert_eq!(of("C3D8I"), (Integration::Full, Locking::Incompatible));
    assert_eq!(of("C3D8R"), (Integration::Full, Locking::Auto));
    assert_eq!(case(&cube("C3D8", STEP)).model.space.value, Space::ThreeD);
}

#[test]
fn supports_in_the_first_step_hold_and_motions_ramp() {
    let cards = format!(
        "*BOUNDARY\nBASE, 1, 3\n{}",
        STEP.replace(
            "*CLOAD\nTOP, 3, 1.",
            "*BOUNDARY\n5,3,3,0.1\n6,3,3,0.1\n7,1,2"
        )
    );
    let case = case(&cube("C3D8", &cards));
    let step = &case.steps[0];
    assert_eq!(step.fixes.len(), 2);
    assert_eq!(step.fixes[0].on.value, "BASE");
    assert_eq!(step.fixes[0].u.xyz, [true; 3]);
    // lines of single nodes that say the same are one set
    assert_eq!(step.moves.len(), 1);
    assert_eq!(step.moves[0].u, [None, None, Some(Motion::Ramp(0.1))]);
    let set = case
        .sets
        .iter()
        .find(|set| set.name == step.moves[0].on)
        .unwrap();
    assert_eq!(set.content, SetContent::Nodes(vec![5, 6]));
}

#[test]
fn what_is_released_is_free_and_what_is_held_again_goes_back() {
    let steps = "*BOUNDARY\nBASE, 1, 3\n*STEP\n*STATIC\n*BOUNDARY\nTOP, 3, 3, 0.1\n*END STEP\n\
                 *STEP\n*STATIC\n*BOUNDARY, OP=NEW\nBASE, 1, 3\n*CLOAD\n5, 3, 1.\n*END STEP\n\
                 *STEP\n*STATIC\n*BOUNDARY\nTOP, 3, 3\n*END STEP\n";
    let case = case(&cube("C3D8", steps));
    let free: Vec<&str> = case.steps[1]
        .frees
        .iter()
        .map(|f| f.on.value.as_str())
        .collect();
    assert_eq!(free, ["BASE", "TOP"]);
    // BASE was set free and is taken back to zero
    assert_eq!(case.steps[1].moves.len(), 1);
    assert_eq!(case.steps[2].moves[0].u[2], Some(Motion::Ramp(0.0)));
}

#[test]
fn the_last_boundary_of_a_node_counts_of_the_model_or_the_step() {
    let held = "*BOUNDARY\nBASE, 1, 3\nTOP, 2, 3\n*STEP\n*STATIC\n*BOUNDARY\n";
    let moves_of = |lines: &str| {
        let case = case(&cube("C3D8", &format!("{held}{lines}\n*END STEP\n")));
        let nodes = |name: &str| {
            let set = case.sets.iter().find(|set| set.name.value == name);
            match set.map(|set| &set.content) {
                Some(SetContent::Nodes(nodes)) => nodes.clone(),
                _ => Vec::new(),
            }
        };
        let step = &case.steps[0];
        let fixes: Vec<_> = step
            .fixes
            .iter()
            .map(|f| (f.on.value.clone(), f.u))
            .collect();
        let moves = step.moves.iter();
        let moves: Vec<_> = moves
            .map(|m| (nodes(&m.on.value), m.u[2].clone()))
            .collect();
        (fixes, moves)
    };
    // all of what the model holds along an axis is moved by the step
    let (fixes, moves) = moves_of("TOP, 3, 3, -0.001");
    assert_eq!(fixes.len(), 2, "{fixes:?}");
    assert_eq!(moves.len(), 1);
    assert_eq!(moves[0].1, Some(Motion::Ramp(-0.001)));
    // one node of it: the others stay held
    let (_, moves) = moves_of("5, 3, 3, -0.001\n5, 3, 3, -0.002");
    assert_eq!(moves, [(vec![5], Some(Motion::Ramp(-0.002)))]);
    // the same again is no change
    let (fixes, moves) = moves_of("TOP, 3, 3");
    assert_eq!((fixes.len(), moves.len()), (3, 0), "{fixes:?}");
}

#[test]
fn loads_of_a_step_add_up_and_later_ones_replace_them() {
    let steps = "*STEP\n*STATIC\n*CLOAD\nTOP, 3, 1.\n5, 3, 10.\n*DLOAD\nCUBE, P2, 1.\nCUBE, P2, 2.\n*END STEP\n\
                 *STEP\n*STATIC\n*CLOAD\n5, 3, 2.\n*END STEP\n*STEP\n*STATIC\n*DLOAD, OP=NEW\n*END STEP\n";
    let case = case(&cube("C3D8", steps));
    let kinds = |step: usize| -> Vec<Chosen> {
        case.steps[step]
            .loads
            .iter()
            .map(|load| load.kind.clone())
            .collect()
    };
    let pressure = |p: f64| Chosen::bare("pressure", Value::Number(p));
    let up = |f: f64| vector("per_node", [0.0, 0.0, f]);
    assert_eq!(kinds(0), [up(11.0), up(1.0), pressure(3.0)]);
    assert_eq!(kinds(1), [up(2.0)]);
    assert_eq!(case.steps[1].loads[0].name, case.steps[0].loads[0].name);
    assert_eq!(kinds(2), [pressure(0.0)]);
}

#[test]
fn local_axes_turn_loads_and_make_equations() {
    let cards = "*TRANSFORM, NSET=TOP, TYPE=R\n0.,1.,0., -1.,0.,0.\n*STEP\n*STATIC\n\
                 *BOUNDARY\n5, 1, 1\n*CLOAD\n6, 1, 2.\n*END STEP\n";
    let case = case(&cube("C3D8", cards));
    assert_eq!(
        case.steps[0].loads[0].kind,
        vector("per_node", [0.0, 2.0, 0.0])
    );
    let ConstraintKind::Equation { terms, rhs } = &case.constraints[0].kind else {
        panic!("{:?}", case.constraints);
    };
    assert_eq!((terms.len(), *rhs), (1, 0.0));
    assert_eq!((terms[0].component.value, terms[0].coefficient), (1, 1.0));
}

#[test]
fn laws_of_contact_are_ours_or_those_of_the_deck() {
    let cards = format!(
        "*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e6, 1.\n*FRICTION\n0.2, 500.\n\
         *CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE, ADJUST=0.01\nLID, SOLE\n{STEP}"
    );
    let text = cube("C3D8", &cards);
    let ours = case(&text).contacts.remove(0);
    assert_eq!(
        (ours.method.value, ours.enforcement),
        (Method::Auto, Enforcement::Auto)
    );
    assert_eq!(ours.start.close_gaps_below, 0.01);
    assert_eq!(ours.start.interference, Interference::Step);
    assert_eq!(ours.friction.unwrap().stick, None);
    let theirs = translated(&text, Compat::Ccx)
        .unwrap()
        .case
        .contacts
        .remove(0);
    assert_eq!(theirs.method.value, Method::GaussPoint);
    assert_eq!(theirs.start.interference, Interference::Increments);
    assert_eq!(theirs.enforcement, Enforcement::Penalty(Some(1e6.into())));
    assert_eq!(
        theirs.friction.unwrap().stick,
        Some(crate::case::Stick::Stiffness(500.0))
    );
}

#[test]
fn stiffnesses_of_an_orthotropic_law_become_its_moduli() {
    // isotropic, E = 1000 and nu = 0.25: lambda = mu = 400
    let ortho = "*ELASTIC, TYPE=ORTHO\n1200.,400.,1200.,400.,400.,1200.,400.,400.\n400.\n";
    let text = cube("C3D8", STEP).replace("*ELASTIC\n1000., 0.3\n", ortho);
    let material = &case(&text).materials[0];
    for (name, value) in [
        ("E1", 1000.0),
        ("E3", 1000.0),
        ("nu13", 0.25),
        ("G23", 400.0),
    ] {
        let found = material.number(name).unwrap();
        assert!((found / value - 1.0).abs() < 1e-12, "{name}: {found}");
    }
}

#[test]
fn faults_are_told_with_their_lines() {
    for (text, said) in [
        (cube("C3D8", ""), "the deck has no step"),
        (
            cube("C3D8", &STEP.replace("TOP, 3", "TPO, 3")),
            "did you mean TOP?",
        ),
        (
            cube("C3D8", &STEP.replace("TOP, 3", "99, 3")),
            "there is no node 99",
        ),
        (
            cube("C3D8", &STEP.replace("3, 1.", "3, one")),
            "`one` stands where a number should",
        ),
        (
            cube("C3D8", &STEP.replace("*STATIC", "*STATTIC")),
            "did you mean *STATIC?",
        ),
        (
            cube("C3D8", &format!("*CREEP\n1.,2.,3.\n{STEP}")),
            "*CREEP is not supported",
        ),
        (
            cube("C3D8", &format!("*TIE, NAME=T\nLID, SOL\n{STEP}")),
            "there is no surface `SOL`",
        ),
        (
            cube("C3D8", STEP).replace("MATERIAL=M\n", "MATERIAL=N\n"),
            "there is no material `N`",
        ),
        (
            cube("C3D8", &STEP.replace("*STATIC\n", "")),
            "this step has no procedure",
        ),
    ] {
        let found = refused(&text);
        assert!(found.contains(said), "{said}: {found}");
        assert!(
            said.contains("no step") || found.contains("job.inp:"),
            "{found}"
        );
    }
}

#[test]
fn all_faults_of_a_deck_are_told_at_once() {
    let cards = STEP.replace("TOP, 3, 1.", "TPO, 3, 1.\n99, 1, 1.\nTOP, 9, 1.");
    let found = translated(&cube("C3D8", &cards), Compat::None).unwrap_err();
    assert_eq!(found.len(), 3, "{}", found.plain());
}

#[test]
fn what_is_left_out_is_named_once() {
    let text = cube(
        "C3D8",
        &STEP.replace(
            "*END STEP",
            "*NODE FILE\nU\n*EL FILE\nS\n*NODE FILE\nRF\n*END STEP",
        ),
    );
    let found = translated(&text, Compat::None).unwrap().found.plain();
    assert_eq!(
        found.matches("*NODE FILE is left out").count(),
        1,
        "{found}"
    );
    assert_eq!(found.matches("*EL FILE is left out").count(), 1, "{found}");
}

#[test]
fn a_motion_along_a_local_axis_is_that_of_a_reference() {
    let cards = "*TRANSFORM, NSET=TOP, TYPE=R\n0.,1.,0., -1.,0.,0.\n*STEP\n*STATIC\n*BOUNDARY\n5, 1, 1, 0.1\n*END STEP\n\
                 *STEP\n*STATIC\n*BOUNDARY\n5, 1, 1, 0.2\n*END STEP\n";
    let case = case(&cube("C3D8", cards));
    let ConstraintKind::Equation { terms, .. } = &case.constraints[0].kind else {
        panic!("{:?}", case.constraints);
    };
    // u_y − r_x = 0
    let of_terms: Vec<(usize, f64)> = (terms.iter())
        .map(|t| (t.component.value, t.coefficient))
        .collect();
    assert_eq!(of_terms, [(1, 1.0), (0, -1.0)]);
    for (step, value) in case.steps.iter().zip([0.1, 0.2]) {
        assert_eq!(step.moves[0].on, terms[1].on);
        assert_eq!(step.moves[0].u[0], Some(Motion::Ramp(value)));
    }
    assert_eq!(case.constraints.len(), 1);
}

#[test]
fn a_pretension_is_a_cut_with_a_reference_for_its_overlap() {
    let cards = "*NODE\n9, 5., 5., 5.\n*PRE-TENSION SECTION, SURFACE=LID, NODE=9\n0., 0., 2.\n\
                 *STEP\n*STATIC\n*CLOAD\n9, 1, 30.\n*END STEP\n*STEP\n*STATIC\n*BOUNDARY\n9, 1, 1, 0.1\n*END STEP\n";
    let case = case(&cube("C3D8", cards));
    let ConstraintKind::Pretension {
        on,
        reference,
        normal,
    } = &case.constraints[0].kind
    else {
        panic!("{:?}", case.constraints);
    };
    assert_eq!((on.as_str(), *normal), ("LID", Some([0.0, 0.0, 2.0])));
    assert_eq!(case.references[0].name, *reference);
    let load = &case.steps[0].loads[0];
    assert_eq!(load.on, *reference);
    assert_eq!(load.kind, vector("force", [30.0, 0.0, 0.0]));
    assert_eq!(case.steps[1].moves[0].u[0], Some(Motion::Ramp(0.1)));
    let text = refused(&cube(
        "C3D8",
        &format!("*PRE-TENSION SECTION, ELEMENT=1, NODE=1\n{STEP}"),
    ));
    assert!(text.contains("beams are not built"), "{text}");
}

#[test]
fn multi_point_constraints_become_those_of_a_case() {
    let cards = "*NODE\n9, 0., 0., 1.\n10, 2.5, 0., 0.\n*MPC\nPLANE, TOP\nSTRAIGHT, 1, 2,\n3\nBEAM, 1, 7\n\
                 MEANROT, 5,5,5, 6,6,6,\n7,7,7, 8,8,8, 9\nDIST, 1,1,1, 7,7,7, 10\n";
    let case = case(&cube("C3D8", &format!("{cards}{STEP}")));
    let kinds: Vec<&ConstraintKind> = case.constraints.iter().map(|c| &c.kind).collect();
    let nodes = |name: &str| {
        let set = case.sets.iter().find(|set| set.name.as_str() == name);
        match set.map(|set| &set.content) {
            Some(SetContent::Nodes(nodes)) => nodes.clone(),
            _ => Vec::new(),
        }
    };
    let [
        ConstraintKind::Plane { on: plane },
        ConstraintKind::Line { on: line },
        ConstraintKind::Distance {
            on: rod,
            most: None,
        },
        ConstraintKind::Twist {
            on: face,
            axis: [0.0, 0.0, 1.0],
            ..
        },
        ConstraintKind::Distance {
            on: rope,
            most: Some(2.5),
        },
    ] = kinds.as_slice()
    else {
        panic!("{kinds:?}");
    };
    assert_eq!(nodes(plane), [5, 6, 7, 8]);
    assert_eq!(nodes(line), [1, 2, 3]);
    assert_eq!((nodes(rod), nodes(rope)), (vec![1, 7], vec![1, 7]));
    assert_eq!(nodes(face), [5, 6, 7, 8]);
    // they bend with large displacements
    assert_eq!(case.steps[0].geometry, Geometry::Nonlinear);
    let text = refused(&cube("C3D8", &format!("*MPC\nCYCLIC, 1, 2\n{STEP}")));
    assert!(text.contains("no multi-point constraint CYCLIC"), "{text}");
}

#[test]
fn sectors_and_distributing_couplings_become_constraints() {
    let cards = "*SURFACE, NAME=A, TYPE=NODE\nTOP\n*SURFACE, NAME=B, TYPE=NODE\nBASE\n\
                 *TIE, NAME=C, CYCLIC SYMMETRY\nA, B\n*CYCLIC SYMMETRY MODEL, N=12, TIE=C\n1.,0.,0., 1.,0.,2.\n\
                 *NODE\n9, 0., 0., 1.\n*ELEMENT, TYPE=DCOUP3D, ELSET=D\n7, 9\n\
                 *DISTRIBUTING COUPLING, ELSET=D\n5, 1.\n6, 3.\n";
    let case = case(&cube("C3D8", &format!("{cards}{STEP}")));
    assert!(case.contacts.is_empty());
    let kinds: Vec<&ConstraintKind> = case.constraints.iter().map(|c| &c.kind).collect();
    let means = kinds.iter().filter_map(|kind| match kind {
        ConstraintKind::Equation { terms, .. } => Some(terms),
        _ => None,
    });
    let coefficients: Vec<Vec<f64>> = means
        .map(|terms| terms.iter().map(|t| t.coefficient).collect())
        .collect();
    assert_eq!(coefficients, vec![vec![-1.0, 0.25, 0.75]; 3]);
    assert!(kinds.iter().any(|kind| matches!(
        kind,
        ConstraintKind::Cyclic {
            sectors: 12,
            point: [1.0, 0.0, 0.0],
            axis: [0.0, 0.0, 2.0],
            ..
        }
    )));
}

/// The first material of a deck whose material has these cards in place of its elastic constants.
fn material(cards: &str) -> crate::case::Material {
    let deck = cube("C3D8", STEP).replace("*ELASTIC\n1000., 0.3\n", cards);
    case(&deck).materials[0].clone()
}

fn constant(material: &crate::case::Material, name: &str) -> Vec<f64> {
    let found = material.constants.iter().find(|one| one.name == name);
    found.unwrap().values.value.clone()
}

#[test]
fn constants_depend_on_temperature_where_their_rows_differ() {
    let hot = material(
        "*ELASTIC\n150., .31, 500.\n200., .3, 0.\n*EXPANSION, ZERO=20.\n1e-5, 0.\n2e-5, 500.\n",
    );
    assert_eq!(hot.model.value, "linear-elastic-by-temperature");
    assert_eq!(constant(&hot, "T"), [0.0, 500.0]);
    assert_eq!(constant(&hot, "E"), [200.0, 150.0]);
    assert_eq!(constant(&hot, "nu"), [0.3, 0.31]);
    let expansion = hot.expansion.unwrap();
    assert_eq!(expansion.alpha, [[0.0, 1e-5], [500.0, 2e-5]]);
    assert_eq!(expansion.reference, 20.0);
    assert_eq!(expansion.free.value, Unstrained::At(20.0));
    let same =
        material("*ELASTIC\n200., .3, 0.\n200., .3, 500.\n*EXPANSION\n1e-5, 0.\n1e-5, 500.\n");
    assert_eq!(same.model.value, "linear-elastic");
    assert_eq!(same.expansion.unwrap().alpha, [[0.0, 1e-5]]);
    let start = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 100.\n*STEP";
    let deck = cube("C3D8", STEP).replace("1000., 0.3\n", "1000., 0.3\n*EXPANSION\n1e-5\n");
    let expansion = case(&deck.replace("*STEP", start)).materials[0]
        .expansion
        .clone();
    assert_eq!(expansion.unwrap().free.value, Unstrained::At(100.0));
    let text = refused(&cube("C3D8", STEP).replace(
        "1000., 0.3\n",
        "1000., 0.3, 0.\n900., 0.3, 100.\n*PLASTIC\n10., 0.\n",
    ));
    assert!(text.contains("*PLASTIC does not go with"), "{text}");
}

#[test]
fn anisotropic_constants_are_taken_in_their_order() {
    let numbers: Vec<f64> = (1..=21).map(f64::from).collect();
    let text: Vec<String> = numbers.iter().map(f64::to_string).collect();
    let rows: Vec<String> = text.chunks(8).map(|row| row.join(", ")).collect();
    let law = material(&format!("*ELASTIC, TYPE=ANISO\n{}\n", rows.join("\n")));
    assert_eq!(law.model.value, "anisotropic");
    assert_eq!(constant(&law, "D"), numbers);
}

#[test]
fn hyperelastic_laws_have_the_bulk_modulus_of_d() {
    let law = material("*HYPERELASTIC, NEO HOOKE\n3., 0.1\n");
    assert_eq!(law.model.value, "mooney-rivlin");
    assert_eq!(
        [constant(&law, "c10"), constant(&law, "bulk")],
        [[3.0], [20.0]]
    );
    let law = material("*HYPERELASTIC, MOONEY-RIVLIN\n3., 1., 0.1\n");
    assert_eq!(
        [constant(&law, "c10"), constant(&law, "c01")],
        [[3.0], [1.0]]
    );
    let law = material("*HYPERELASTIC, OGDEN, N=2\n3., 2., 1., -2., 0.1, 0.\n");
    assert_eq!(law.model.value, "ogden");
    assert_eq!(constant(&law, "mu"), [3.0, 1.0]);
    assert_eq!(constant(&law, "alpha"), [2.0, -2.0]);
    assert_eq!(constant(&law, "bulk"), [20.0]);
    // without D: a Poisson's ratio of 0.475
    let law = material("*HYPERELASTIC, OGDEN, N=1\n3., 2., 0.\n");
    assert!((constant(&law, "bulk")[0] - 3.0 * 2.0 * 1.475 / 0.15).abs() < 1e-12);
    let law = material("*HYPERFOAM, N=2\n3., 2., 1., -2., 0.1, 0.2\n");
    assert_eq!(law.model.value, "hyperfoam");
    assert_eq!(
        [constant(&law, "mu"), constant(&law, "nu")],
        [[3.0, 1.0], [0.1, 0.2]]
    );
}

#[test]
fn points_of_elements_have_stress_and_strain_at_the_start() {
    let cards = format!(
        "*INITIAL CONDITIONS, TYPE=STRESS\n1, 2, 1., 2., 3., 4., 5., 6.\n\
         *INITIAL CONDITIONS, TYPE=PLASTIC STRAIN\nCUBE, 1, .1\n{STEP}"
    );
    let case = case(&cube("C3D8", &cards));
    let [at] = &case.initial_stress[..] else {
        panic!("{:?}", case.initial_stress);
    };
    assert_eq!((at.element, at.point), (1, 2));
    assert_eq!(at.value, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!(case.initial_strain[0].value, [0.1, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let text = refused(&cube("C3D8R", &cards));
    assert!(
        text.contains("values at the points of this element"),
        "{text}"
    );
    let text = refused(&cube("C3D8", &cards.replace("STRESS\n", "STRESS, USER\n")));
    assert!(
        text.contains("TYPE=STRESS, USER is not supported"),
        "{text}"
    );
}

#[test]
fn a_time_delay_is_an_amplitude_of_its_own() {
    let cards = "*AMPLITUDE, NAME=A\n0., 0., 1., 1.\n*STEP\n*STATIC\n*CLOAD, AMPLITUDE=A, TIME DELAY=0.5\nTOP, 3, 1.\n\
                 *CLOAD, AMPLITUDE=A\nTOP, 1, 1.\n*END STEP\n";
    let case = case(&cube("C3D8", cards));
    let tables: Vec<_> = case
        .amplitudes
        .iter()
        .map(|one| one.table.clone())
        .collect();
    assert_eq!(tables, [[[0.0, 0.0], [1.0, 1.0]], [[0.5, 0.0], [1.5, 1.0]]]);
}

#[test]
fn sections_of_a_plane_model_have_a_thickness_each() {
    let deck = "*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n5,2,0\n6,2,1\n*ELEMENT, TYPE=CPS4, ELSET=A\n1,1,2,3,4\n\
                *ELEMENT, TYPE=CPS4, ELSET=B\n2,2,5,6,3\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n\
                *SOLID SECTION, ELSET=A, MATERIAL=M\n0.5\n*SOLID SECTION, ELSET=B, MATERIAL=M\n2.\n\
                *STEP\n*STATIC\n*END STEP\n";
    let case = case(deck);
    assert_eq!(case.model.thickness, 0.5);
    let own: Vec<_> = case
        .bodies
        .iter()
        .map(|b| b.thickness.as_ref().map(|t| t.value))
        .collect();
    assert_eq!(own, [None, Some(2.0)]);
}

/// A ring next to a sheet; without a thickness a sheet is one thick.
#[test]
fn bodies_have_the_plane_that_their_elements_name() {
    let deck = "*NODE\n1,1,0\n2,2,0\n3,2,1\n4,1,1\n5,3,0\n6,3,1\n7,4,0\n8,4,1\n*ELEMENT, TYPE=CAX4, ELSET=A\n1,1,2,3,4\n\
                *ELEMENT, TYPE=CPS4, ELSET=B\n2,2,5,6,3\n*ELEMENT, TYPE=CPS4, ELSET=C\n3,5,7,8,6\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n\
                *SOLID SECTION, ELSET=A, MATERIAL=M\n0.1\n*SOLID SECTION, ELSET=B, MATERIAL=M\n2.\n*SOLID SECTION, ELSET=C, MATERIAL=M\n\
                *STEP\n*STATIC\n*END STEP\n";
    let own = |deck: &str| -> Vec<_> {
        let case = case(deck);
        let of = |body: &Body| {
            let thickness = body.thickness.as_ref().map(|t| t.value);
            (body.space.as_ref().map(|s| s.value), thickness)
        };
        case.bodies.iter().map(of).collect()
    };
    let sheet = Some(Space::PlaneStress);
    assert_eq!(
        own(deck),
        [(None, None), (sheet, Some(2.0)), (sheet, Some(1.0))]
    );
    let flat = deck.replace("CAX4", "CPE4");
    assert_eq!(
        own(&flat),
        [
            (Some(Space::PlaneStrain), None),
            (None, Some(2.0)),
            (None, None)
        ]
    );
    let text = refused(&deck.replace("CPS4, ELSET=B", "CPE4, ELSET=B"));
    assert!(text.contains("no part of a ring"), "{text}");
}

#[test]
fn temperatures_at_the_start_that_differ_are_those_of_sets_in_their_order() {
    let start = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 100.\nTOP, 20.\n*STEP";
    let deck = cube("C3D8", STEP).replace("1000., 0.3\n", "1000., 0.3\n*EXPANSION\n1e-5\n");
    let case = case(&deck.replace("*STEP", start));
    let sets = case.initial_temperatures.iter();
    let sets: Vec<_> = sets.map(|one| (one.on.as_str(), one.temperature)).collect();
    assert_eq!(sets, [("ALL", 100.0), ("TOP", 20.0)]);
    let expansion = case.materials[0].expansion.as_ref().unwrap();
    assert_eq!(expansion.free.value, Unstrained::AtStart);
}

/// Two cubes, a pair between them, and this law.
fn pair(kind: &str, law: &str, steps: &str) -> String {
    let cards = format!(
        "*NODE\n11,0,0,1\n12,1,0,1\n13,1,1,1\n14,0,1,1\n15,0,0,2\n16,1,0,2\n17,1,1,2\n18,0,1,2\n\
         *ELEMENT, TYPE=C3D8, ELSET=UPPER\n2,11,12,13,14,15,16,17,18\n*NSET, NSET=FEET\n11,12,13,14\n\
         *SOLID SECTION, ELSET=UPPER, MATERIAL=M\n{kind}\n*SURFACE, NAME=TABLE\n1, S2\n\
         *SURFACE INTERACTION, NAME=I\n{law}\n{steps}"
    );
    cube("C3D8", &cards)
}

const BY_NODES: &str = "*SURFACE, NAME=FOOT, TYPE=NODE\nFEET\n\
                        *CONTACT PAIR, INTERACTION=I, TYPE=NODE TO SURFACE, ADJUST=FEET\nFOOT, TABLE";
const BY_FACES: &str = "*SURFACE, NAME=FOOT\n2, S1\n\
                        *CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE\nFOOT, TABLE";

#[test]
fn nodes_have_the_rounded_law_of_calculix_and_adjust_by_a_set() {
    let law = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e4, 3.";
    let deck = pair(BY_NODES, law, STEP);
    let (exact, best) = (case_as(&deck, Compat::Ccx), case(&deck));
    let [ours, theirs] = [&best.contacts[0], &exact.contacts[0]];
    assert_eq!(ours.enforcement, Enforcement::Auto);
    assert_eq!((theirs.area, theirs.per), (Area::Adjacent, Some(Per::Area)));
    let values = [("stiffness", 1e4), ("tension", 3.0), ("within", 1e-3)];
    let rounded = Enforcement::Law(Chosen::new("arctangent", values));
    assert_eq!(theirs.enforcement, rounded);
    for contact in [ours, theirs] {
        let of = contact.start.close_gaps_of.as_ref();
        assert_eq!(of.map(|of| of.value.as_str()), Some("FEET"));
    }
}

#[test]
fn contact_follows_the_motion_as_in_calculix_with_nlgeom_or_without() {
    let law = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e4";
    let mortar = BY_FACES.replace("SURFACE TO SURFACE", "MORTAR");
    for step in [STEP, &STEP.replace("*STEP", "*STEP, NLGEOM")] {
        for (kind, theirs) in [
            (BY_NODES, Sliding::Finite),
            (BY_FACES, Sliding::Increment),
            (&mortar, Sliding::Finite),
        ] {
            let deck = pair(kind, law, step);
            let sliding = |case: Case| case.contacts[0].sliding;
            assert_eq!(sliding(case_as(&deck, Compat::Ccx)), theirs, "{kind}");
            assert_eq!(sliding(case(&deck)), Sliding::Auto, "{kind}");
        }
    }
}

#[test]
fn another_contact_takes_over_where_the_behavior_changes() {
    let law = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n1e4\n*FRICTION\n0.1, 50.";
    let steps = "*STEP\n*STATIC\n*END STEP\n*STEP\n*STATIC\n*CHANGE SURFACE BEHAVIOR, INTERACTION=I\n\
                 *SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n2e4\n*END STEP\n\
                 *STEP\n*STATIC\n*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nFOOT, TABLE\n*END STEP\n";
    let case = case_as(&pair(BY_FACES, law, steps), Compat::Ccx);
    let [tied, free] = case.contacts.as_slice() else {
        panic!("{:?}", case.contacts);
    };
    let joint = tied.tied.unwrap();
    assert_eq!(
        (joint.offset, joint.penalty_tangential),
        (Offset::Pull, Some(50.0))
    );
    assert!(tied.active && tied.friction.is_none());
    assert!(free.tied.is_none() && !free.active && free.friction.is_some());
    let changes = |step: usize| -> Vec<(&str, Option<bool>)> {
        let changes = case.steps[step].contacts.iter();
        changes
            .map(|one| (one.name.value.as_str(), one.active))
            .collect()
    };
    let (tied, free) = (tied.name.as_str(), free.name.as_str());
    assert_eq!(changes(1), [(tied, Some(false)), (free, Some(true))]);
    assert_eq!(changes(2), [(free, Some(false))]);
}

#[test]
fn what_moved_freely_is_not_tied_later() {
    let law = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e4";
    let steps = "*STEP\n*STATIC\n*END STEP\n*STEP\n*STATIC\n*CHANGE SURFACE BEHAVIOR, INTERACTION=I\n\
                 *SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n2e4\n*END STEP\n";
    let found = translated(&pair(BY_FACES, law, steps), Compat::Ccx).unwrap_err();
    assert!(
        found.plain().contains("to TIED in a later step"),
        "{found:?}"
    );
}

#[test]
fn the_last_section_of_an_element_holds() {
    let cards =
        "*MATERIAL, NAME=SOFT\n*ELASTIC\n1., 0.\n*SOLID SECTION, ELSET=EALL, MATERIAL=SOFT\n";
    let deck = cube("C3D8", &format!("*ELSET, ELSET=EALL\n1\n{cards}{STEP}"));
    let case = case(&deck);
    let materials: Vec<_> = case.bodies.iter().map(|b| b.material.as_ref()).collect();
    assert_eq!(materials.len(), 1);
    assert_eq!(materials[0].map(|m| m.value.as_str()), Some("SOFT"));
}

#[test]
fn cylindrical_axes_have_a_radius_on_their_axis_too() {
    let system = AxesSystem::Cylindrical {
        from: [1.0, 0.0, 0.0],
        to: [1.0, 0.0, 4.0],
    };
    let off = system.at([1.0, 2.0, 3.0].into()).unwrap();
    assert_eq!(
        off.map(Vec3::to_array),
        [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    );
    let on = system.at([1.0, 0.0, 9.0].into()).unwrap();
    assert_eq!(
        on.map(Vec3::to_array),
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    );
    // along which ccx 2.20 moves a node on these axes that is moved along its first local axis
    let printed = [
        ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
        ([0.0, -1.0, 0.0], [0.0, 0.0, 1.0]),
        ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        ([0.0, 0.0, -1.0], [1.0, 0.0, 0.0]),
        ([1.0, 1.0, 1.0], [-FRAC_1_SQRT_2, FRAC_1_SQRT_2, 0.0]),
        ([1.0, 2.0, 3.0], [-0.89443, 0.44721, 0.0]),
        ([1.0, 1.0, 0.0], [-FRAC_1_SQRT_2, FRAC_1_SQRT_2, 0.0]),
        ([1.0, 3.0, 2.0], [-0.94868, 0.31623, 0.0]),
    ];
    for (to, radial) in printed {
        let from = [0.0; 3];
        let system = AxesSystem::Cylindrical { from, to };
        let [first, ..] = system.at(Vec3::ZERO).unwrap();
        let off = (first - Vec3::from(radial)).norm();
        assert!(off < 1e-5, "{to:?}: {first:?}");
    }
}

#[test]
fn a_name_may_be_that_of_a_surface_of_faces_and_of_one_of_nodes() {
    let nodes = "*SURFACE, NAME=LOWER, TYPE=NODE\nBASE\n";
    let faces = "*SURFACE, NAME=LOWER\n1, S1\n";
    for (first, second) in [(nodes, faces), (faces, nodes)] {
        for (kind, compat, by_nodes) in [
            ("NODE TO SURFACE", Compat::Ccx, true),
            ("SURFACE TO SURFACE", Compat::Ccx, false),
            ("NODE TO SURFACE", Compat::None, false),
        ] {
            let pair = format!("*CONTACT PAIR, INTERACTION=I, TYPE={kind}\nLOWER, LID\n");
            let text = cube(
                "C3D8",
                &format!("{first}{second}*SURFACE INTERACTION, NAME=I\n{pair}{STEP}"),
            );
            let read = translated(&text, compat).unwrap();
            let side = &read.case.contacts[0].secondary.value;
            let set = &read.mesh.sets[side];
            assert_eq!(set.is_bare(), by_nodes, "{kind} {compat:?}: {side}");
            assert_eq!(set.faces.len(), usize::from(!by_nodes));
        }
    }
}

#[test]
fn springs_pull_along_their_line_or_an_axis_by_stiffness_or_table() {
    let nodes = "*NODE\n1,0,0,0\n2,1,0,0\n*ELEMENT, TYPE=SPRINGA, ELSET=A\n1,1,2\n\
                 *ELEMENT, TYPE=SPRING1, ELSET=B\n2,2\n*ELEMENT, TYPE=SPRING2, ELSET=C\n3,1,2\n";
    let cards = "*SPRING, ELSET=A, NONLINEAR\n\n0., 0.\n10., 1.\n100., 20.\n*SPRING, ELSET=B\n2\n7.\n\
                 *SPRING, ELSET=C\n3, 3\n8.\n";
    let step = "*STEP\n*STATIC\n*END STEP\n";
    let case = case(&format!("{nodes}{cards}{step}"));
    let [along, ground, between] = &case.springs[..] else {
        panic!("{:?}", case.springs)
    };
    let table = vec![[0.0, 0.0], [10.0, 1.0], [100.0, 20.0]];
    assert_eq!(
        (&along.law, along.direction),
        (&SpringLaw::Table(table), None)
    );
    assert!(matches!(&along.ends, SpringEnds::Between(..)));
    assert_eq!(ground.law, SpringLaw::Linear(7.0));
    assert!(matches!(&ground.ends, SpringEnds::Ground(on) if on.value == "node-2"));
    assert_eq!(ground.direction, Some([0.0, -1.0, 0.0]));
    assert_eq!(between.direction, Some([0.0, 0.0, -1.0]));
    assert_eq!(
        (case.bodies.len(), case.model.space.value),
        (0, Space::ThreeD)
    );
    for (cards, expected) in [
        (
            "*SPRING, ELSET=C\n3, 2\n8.\n",
            "degrees of freedom of this spring",
        ),
        (
            "*SPRING, ELSET=A, NONLINEAR\n\n1., 0.\n0., 1.\n",
            "no rising table",
        ),
        ("*SPRING, ELSET=A\n\n-3.\n", "has to be positive"),
        (
            "*SPRING, ELSET=A\n\n3., 1.\n4., 2.\n",
            "depends on temperature",
        ),
        ("*SPRING, ELSET=A\n", "has no data"),
        ("*SPRING, ELSET=D\n\n3.\n", "element set `D` has no springs"),
    ] {
        let told = refused(&format!("{nodes}{cards}{step}"));
        assert!(told.contains(expected), "{expected}: {told}");
    }
}

#[test]
fn trusses_are_bars_with_the_cross_section_of_their_section() {
    let bars = "*ELEMENT, TYPE=T3D2, ELSET=BARS\n20,1,7\n21,2,8\n";
    let section = "*SOLID SECTION, ELSET=BARS, MATERIAL=M\n0.25\n";
    let both = case(&cube("C3D8", &format!("{bars}{section}{STEP}")));
    let areas: Vec<Option<f64>> = both
        .bodies
        .iter()
        .map(|body| body.area.as_ref().map(|area| area.value))
        .collect();
    assert_eq!(areas, [None, Some(0.25)]);
    let alone = "*NODE\n1,0,0\n2,1,0\n*ELEMENT, TYPE=T2D2, ELSET=BARS\n1,1,2\n\
                 *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n";
    let step = "*STEP\n*STATIC\n*END STEP\n";
    let plane = case(&format!("{alone}{section}{step}"));
    assert_eq!(plane.model.space.value.ndim(), 2);
    assert_eq!(plane.bodies[0].area.as_ref().unwrap().value, 0.25);
    let none = refused(&format!("{alone}*SOLID SECTION, ELSET=BARS, MATERIAL=M\n"));
    assert!(none.contains("has no cross-section"), "{none}");
}

#[test]
fn a_membrane_of_no_elements_does_no_harm() {
    case(&cube(
        "C3D8",
        &format!("*MEMBRANE, ELSET=NONE, MATERIAL=M\n0.\n{STEP}"),
    ));
    let told = refused(&cube("C3D8", &format!("*MEMBRANE, ELSET=CUBE\n0.\n{STEP}")));
    assert!(told.contains("membranes are not built"), "{told}");
}

#[test]
fn what_nothing_resists_is_held_as_in_calculix_or_refused() {
    let text = cube("C3D8", STEP);
    assert_eq!(case(&text).solver.free_motions, FreeMotions::Refuse);
    let ccx = case_as(&text, Compat::Ccx);
    assert_eq!(ccx.solver.free_motions, FreeMotions::Hold);
}

#[test]
fn whole_sections_may_change_their_material() {
    let cards = "*MATERIAL, NAME=N\n*ELASTIC\n500., 0.3\n*STEP\n*STATIC\n*END STEP\n*STEP\n*STATIC\n\
                 *CHANGE SOLID SECTION, ELSET=CUBE, MATERIAL=N\n*END STEP\n";
    let changed = case(&cube("C3D8", cards));
    assert!(changed.steps[0].materials.is_empty());
    let [change] = &changed.steps[1].materials[..] else {
        panic!("{:?}", changed.steps[1])
    };
    assert_eq!(
        (change.group.as_str(), change.material.as_str()),
        ("CUBE", "N")
    );
    let told = refused(&cube(
        "C3D8",
        &cards.replace("MATERIAL=N\n*END", "MATERIAL=O\n*END"),
    ));
    assert!(told.contains("there is no material `O`"), "{told}");
    let two = "*ELEMENT, TYPE=C3D8, ELSET=CUBE\n2,1,2,3,4,5,6,7,8\n*ELSET, ELSET=ONE\n1\n";
    let part = cards.replace("ELSET=CUBE, MATERIAL=N", "ELSET=ONE, MATERIAL=N");
    let told = refused(&cube("C3D8", &format!("{two}{part}")));
    assert!(told.contains("a part of a section"), "{told}");
}
