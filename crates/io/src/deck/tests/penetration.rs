//! Fluids between the surfaces of a contact pair.

use super::contact::{BY_FACES, pair};
use super::*;
use crate::case::SetContent;

const LAW: &str = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e4";

fn steps(card: &str, lines: &str) -> String {
    format!(
        "*STEP\n*STATIC\n*END STEP\n*STEP\n*STATIC\n*PRESSURE PENETRATION, SECONDARY=FOOT, MAIN=TABLE{card}\n{lines}\n\
         *END STEP\n"
    )
}

#[test]
fn a_fluid_comes_in_its_step_from_nodes_of_both_surfaces() {
    let more = format!(
        "{}{}",
        steps(", PENETRATION TIME=0.01", "11, 5, 20., 2."),
        "*STEP\n*STATIC\n*PRESSURE PENETRATION, SLAVE=FOOT, MASTER=TABLE, PENETRATION TIME=0.01\n11, 5, 30., 2.\n*END STEP\n"
    );
    let case = case(&pair(BY_FACES, LAW, &more));
    let fluid = case.contacts[0].fluid.as_ref().unwrap();
    assert_eq!((fluid.pressure, fluid.critical), (0.0, Some(2.0)));
    assert_eq!((fluid.ramp, fluid.recedes), (0.01, true));
    let mut sets = case.sets.iter();
    let set = sets.find(|set| set.name.value == fluid.from.value).unwrap();
    assert_eq!(set.content, SetContent::Nodes(vec![5, 11]));
    let pressures = case.steps.iter().map(|step| step.contacts.first()?.fluid);
    let pressures: Vec<_> = pressures.collect();
    assert_eq!(pressures, [None, Some(20.0), Some(30.0)]);
}

#[test]
fn what_a_card_leaves_out_is_what_it_is_by_itself() {
    let case = case(&pair(BY_FACES, LAW, &steps("", "11, , 20.")));
    let fluid = case.contacts[0].fluid.as_ref().unwrap();
    assert_eq!((fluid.critical, fluid.ramp), (Some(0.0), 0.001));
}

#[test]
fn what_is_not_known_of_it_is_refused_by_name() {
    for (card, lines, says) in [
        (", WETTED FRONT=1", "11, 5, 20.", "WETTED FRONT"),
        (", AMPLITUDE=A", "11, 5, 20.", "AMPLITUDE"),
        (", OP=NEW", "11, 5, 20.", "OP=NEW"),
        ("", "11, 5, 20.\n12, 6, 30.", "several pressures"),
        ("", "11, 5", "critical pressure"),
    ] {
        let found = refused(&pair(BY_FACES, LAW, &steps(card, lines)));
        assert!(found.contains(says), "{card} {lines}: {found}");
    }
    let steps = steps("", "11, 5, 20.").replace("MAIN=TABLE", "MAIN=LID");
    let found = refused(&pair(BY_FACES, LAW, &steps));
    assert!(found.contains("no contact pair"), "{found}");
}
