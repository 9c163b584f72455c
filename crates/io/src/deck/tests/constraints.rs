//! Constraints between nodes.

use super::*;
use crate::case::{AxesSystem, ConstraintKind, Geometry, Motion, Position, SetContent};
use crate::deck::load::vector;

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

#[test]
fn a_rigid_body_without_a_reference_node_moves_about_the_mean_of_its_nodes() {
    let of_nodes = "*NODE\n9, 5., 5., 5.\n*RIGID BODY, NSET=TOP, ROT NODE=9\n*STEP\n*STATIC\n\
                    *CLOAD\n9, 3, 10.\n*END STEP\n";
    let case = self::case(&cube("C3D8", of_nodes));
    let [reference] = case.references.as_slice() else {
        panic!("{:?}", case.references);
    };
    assert_eq!(reference.position, Position::Mean);
    assert_eq!(reference.rotations, Some(9));
    assert_eq!(case.steps[0].loads[0].on, reference.name);
    assert_eq!(
        case.steps[0].loads[0].kind,
        vector("moment", [0.0, 0.0, 10.0])
    );
    // elements of a rigid body are free in every way until something holds them
    let more = "*NODE\n9,0,0,2\n10,1,0,2\n11,1,1,2\n12,0,1,2\n*ELEMENT, TYPE=C3D8, ELSET=CAP\n2,5,6,7,8,9,10,11,12\n";
    let of_elements = format!("{more}*RIGID BODY, ELSET=CAP\n{STEP}");
    let case = self::case(&cube("C3D8", &of_elements));
    let body = case.bodies.iter().find(|body| body.rigid).unwrap();
    assert_eq!(body.reference, Some(case.references[0].name.clone()));
    let free = &case.steps[0].frees[0];
    assert_eq!(free.on, case.references[0].name);
    assert_eq!((free.u.xyz, free.rot.xyz), ([true; 3], [true; 3]));
}

#[test]
fn couplings_follow_along_the_axes_of_an_orientation() {
    let axes = "*ORIENTATION, NAME=O, SYSTEM=RECTANGULAR\n1., 1., 0., -1., 1., 0.\n";
    let cards = format!(
        "*NODE\n9, 0.5, 0.5, 1.\n{axes}*COUPLING, REF NODE=9, SURFACE=LID, CONSTRAINT NAME=C, ORIENTATION=O\n\
         *KINEMATIC\n2, 2\n{STEP}"
    );
    let case = self::case(&cube("C3D8", &cards));
    let ConstraintKind::Kinematic { axes, local, .. } = &case.constraints[0].kind else {
        panic!("{:?}", case.constraints);
    };
    assert_eq!(axes.xyz, [false, true, false]);
    assert_eq!(
        *local,
        Some(AxesSystem::Rectangular {
            x: [1.0, 1.0, 0.0],
            xy: [-1.0, 1.0, 0.0],
        })
    );
    let text = refused(&cube(
        "C3D8",
        &cards.replace("ORIENTATION=O\n", "ORIENTATION=P\n"),
    ));
    assert!(text.contains("there is no orientation `P`"), "{text}");
}

#[test]
fn equations_of_sets_with_local_axes_are_those_of_their_nodes() {
    let cards = format!(
        "*TRANSFORM, NSET=TOP, TYPE=C\n0., 0., 0., 0., 0., 1.\n*EQUATION\n2\nTOP, 1, 1., BASE, 1, -2.\n{STEP}"
    );
    let case = self::case(&cube("C3D8", &cards));
    let equations: Vec<_> = (case.constraints.iter())
        .filter_map(|one| match &one.kind {
            ConstraintKind::Equation { terms, .. } => Some(terms),
            _ => None,
        })
        .collect();
    assert_eq!(equations.len(), 4);
    // node 7 at (1, 1): its radius lies between x and y; the other side has the axes of the model
    let parts: Vec<f64> = equations[2].iter().map(|term| term.coefficient).collect();
    let diagonal = std::f64::consts::FRAC_1_SQRT_2;
    assert_eq!(parts.len(), 3);
    for (found, wanted) in parts.iter().zip([diagonal, diagonal, -2.0]) {
        assert!((found - wanted).abs() < 1e-12, "{parts:?}");
    }
    let uneven = cards.replace("BASE, 1", "PAIR, 1");
    let uneven = format!("*NSET, NSET=PAIR\n1, 2\n{uneven}");
    assert!(refused(&cube("C3D8", &uneven)).contains("numbers of nodes"));
}

#[test]
fn equations_take_rotations_of_what_moves_a_rigid_body() {
    let cards = format!(
        "*NODE\n9, 5., 5., 5.\n*RIGID BODY, NSET=TOP, REF NODE=9\n*EQUATION\n2\n9, 6, 1., 1, 1, -1.\n{STEP}"
    );
    let case = self::case(&cube("C3D8", &cards));
    let terms = case.constraints.iter().find_map(|one| match &one.kind {
        ConstraintKind::Equation { terms, .. } => Some(terms.clone()),
        _ => None,
    });
    assert_eq!(terms.unwrap()[0].component.value, 5);
    let text = refused(&cube("C3D8", &format!("*EQUATION\n1\n5, 6, 1.\n{STEP}")));
    assert!(text.contains("degree of freedom 6"), "{text}");
}
