//! Contact pairs, their laws and their surfaces.

use super::*;
use crate::case::{Area, Enforcement, Interference, Method, Offset, Per, Sliding};
use signorini_vocabulary::Chosen;

#[test]
fn laws_of_contact_are_automatic_or_those_of_the_deck() {
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

/// Two cubes, a pair between them, and this law.
pub(super) fn pair(kind: &str, law: &str, steps: &str) -> String {
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

pub(super) const BY_FACES: &str = "*SURFACE, NAME=FOOT\n2, S1\n\
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
