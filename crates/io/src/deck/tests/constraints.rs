//! Constraints between nodes.

use super::*;
use crate::case::{ConstraintKind, Geometry, Motion, SetContent};
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
