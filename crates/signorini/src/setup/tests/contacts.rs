//! Contacts of a case and the parts they become.

use super::*;
use signorini_geometry::tensor::Vec3;
use signorini_io::case::read_case;
use signorini_mechanics::contact::Measure;
use signorini_mechanics::contact::discretization::SlidingRange;
use signorini_mechanics::contact::friction::{Coulomb, Falling, FrictionLaw, Tresca};
use signorini_mechanics::contact::law::{Exponential, Table};
use signorini_mechanics::model::{
    self, AreaPart, ContactChange, ContactPart, FrictionPart, PrimaryPart, SidePart, StartPart,
    StickPart, TieOffset, TiePart,
};
use std::path::Path;

/// The faces where the cubes touch, and bare nodes of theirs.
const SIDES: &str = "over = { plane = 'z', at = 1, of = 'low' }\nunder = { plane = 'z', at = 1, of = 'high' }\n\
    corner = { nodes = [13, 11] }\nedge = { nodes = [6, 5] }\nthree = { nodes = [5, 6, 7] }\n\
    [[body]]\ngroup = 'high'\nmaterial = 'steel'\n";

const CONTACT: &str = "[[contact]]\nname = 'c'\nsecondary = 'under'\nprimary = 'over'\n";

/// The first contact of the cubes, with these keys.
fn contact(keys: &str) -> ContactPart {
    let built = cubes(&format!("{SIDES}{CONTACT}{keys}\n{STEP}"));
    built.contacts.into_iter().next().unwrap()
}

fn assert_alike(a: &ContactPart, b: &ContactPart) {
    let of = |part: &ContactPart| ContactPart {
        primary: PrimaryPart::Itself,
        ..part.clone()
    };
    assert_eq!(format!("{:?}", of(a)), format!("{:?}", of(b)));
}

/// Asserts that a contact with these keys is one without any after this change.
fn assert_changes(keys: &str, change: &dyn Fn(&mut ContactPart)) {
    let mut wanted = ContactPart::new("c", contact("").secondary, PrimaryPart::Itself);
    change(&mut wanted);
    assert_alike(&contact(keys), &wanted);
}

#[test]
fn a_contact_without_keys_has_the_defaults() {
    assert_changes("", &|_| {});
}

#[test]
fn methods_of_contact_become_those_of_parts() {
    assert_changes("method = 'node-to-segment'\npasses = 2", &|part| {
        part.method = model::Method::NodeToSegment;
        part.two_pass = true;
    });
    assert_changes("method = 'gauss-point'", &|part| {
        part.method = model::Method::GaussPoint(model::PointRule {
            kind: model::PointKind::Gauss,
            points: None,
            cut: false,
        });
    });
    assert_changes(
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
    assert_changes("method = 'node-to-node'\nnormals = [0, 3, 0]", &|part| {
        part.method = model::Method::NodeToNode {
            normals: model::Normals::Given(Vec3::new(0.0, 3.0, 0.0)),
            pairs: model::PairOrder::Nearest,
        };
    });
}

#[test]
fn laws_of_contact_become_those_of_parts() {
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
        assert_changes(&format!("enforcement = {{ {keys} }}"), &|part| {
            part.enforcement = law.clone();
        });
    }
    assert_changes("enforcement = { per = 'node' }", &|part| {
        part.enforcement = Law::Penalty(None);
        part.measure = Some(Measure::Node);
    });
}

#[test]
fn friction_becomes_a_law_and_a_way_to_stick() {
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
        assert_changes(&format!("friction = {friction}"), &|part| {
            let limit = Arc::clone(&limit);
            part.friction = Some(FrictionPart { limit, stick });
        });
    }
    assert_changes("friction = { mu = 0, stiffness = 9 }", &|_| {});
}

#[test]
fn sliding_and_reach_are_those_of_the_case() {
    assert_changes("sliding = 'small'\nreach = 0.5", &|part| {
        part.sliding = SlidingRange::Small;
        part.reach = Some(0.5);
    });
}

#[test]
fn a_tie_keeps_closes_or_pulls_its_offset() {
    for (tied, offset, within) in [
        ("true", TieOffset::Keep, None),
        ("{ within = 0.1 }", TieOffset::Keep, Some(0.1)),
        ("{ offset = 'close' }", TieOffset::Close, None),
    ] {
        assert_changes(&format!("tied = {tied}"), &|part| {
            part.tie = Some(TiePart {
                offset,
                within,
                penalty_tangential: None,
                cohesion: None,
            });
        });
    }
    let by_points = "method = 'gauss-point'\nenforcement = { penalty = 9 }";
    assert_changes(
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
                cohesion: None,
            });
        },
    );
}

#[test]
fn starts_of_contacts_become_those_of_parts() {
    assert_changes(
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
    assert_changes("start = { interference = 'now' }", &|part| {
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
        slip: None,
        contact,
        active,
        friction,
        fluid: None,
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
