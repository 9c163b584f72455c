//! Joints that break.

use super::*;
use crate::case::{Cohesive, Enforcement, Mixity};

/// The cube on itself, with these cards in its interaction.
fn joined(cards: &str) -> String {
    let pair = "*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE\nLID, SOLE\n";
    cube(
        "C3D8",
        &format!("*SURFACE INTERACTION, NAME=I\n{cards}{pair}{STEP}"),
    )
}

const BEHAVIOR: &str = "*COHESIVE BEHAVIOR, ELIGIBILITY=ORIGINAL CONTACTS\n1e6, 8e5, 8e5\n";
const INITIATION: &str = "*DAMAGE INITIATION, CRITERION=QUADS\n57., 90., 90.\n";
const EVOLUTION: &str =
    "*DAMAGE EVOLUTION, TYPE=ENERGY, MIXED MODE BEHAVIOR=BK, POWER=2.284\n0.28, 0.78, 0.78\n";

#[test]
fn the_damage_cards_of_surfaces_are_a_joint_that_breaks() {
    let all = "*FRICTION\n0.2\n*DAMAGE STABILIZATION\n1e-4\n";
    let text = joined(&format!("{BEHAVIOR}{INITIATION}{EVOLUTION}{all}"));
    let contact = case(&text).contacts.remove(0);
    let expected = Cohesive {
        strength: [57.0, 90.0],
        toughness: [0.28, 0.78],
        mixity: Mixity::Bk(2.284),
        quadratic: true,
        exponential: false,
        stiffness: Some([1e6, 8e5]),
        viscosity: 1e-4,
    };
    assert_eq!(contact.cohesive, Some(expected));
    assert!(contact.tied.is_some() && contact.friction.is_some());
    assert_eq!(contact.enforcement, Enforcement::Auto);
    let cohesive = |cards: &str| case(&joined(cards)).contacts.remove(0).cohesive.unwrap();
    let power = EVOLUTION.replace("BK, POWER=2.284", "POWER LAW, POWER=1.");
    let plain = BEHAVIOR.replace("1e6, 8e5, 8e5\n", "");
    let found = cohesive(&format!("{plain}{INITIATION}{power}"));
    assert_eq!((found.mixity, found.stiffness), (Mixity::Power(1.0), None));
    let one = "*DAMAGE EVOLUTION, TYPE=ENERGY\n0.4\n";
    let found = cohesive(&format!("{BEHAVIOR}{INITIATION}{one}"));
    assert_eq!(found.toughness, [0.4; 2]);
}

#[test]
fn joints_that_would_be_others_are_refused_by_name() {
    let whole = format!("{BEHAVIOR}{INITIATION}{EVOLUTION}");
    for (from, to, expected) in [
        (INITIATION, "", "without *DAMAGE INITIATION"),
        (EVOLUTION, "", "and *DAMAGE EVOLUTION"),
        ("QUADS", "MAXS", "CRITERION=MAXS"),
        ("TYPE=ENERGY", "TYPE=DISPLACEMENT", "TYPE=DISPLACEMENT"),
        (
            "=BK, POWER",
            "=TABULAR, POWER",
            "MIXED MODE BEHAVIOR=TABULAR",
        ),
        (", POWER=2.284", "", "has no POWER"),
        (
            "TYPE=ENERGY",
            "TYPE=ENERGY, SOFTENING=EXPONENTIAL",
            "SOFTENING=EXPONENTIAL",
        ),
        (
            "TYPE=ENERGY",
            "TYPE=ENERGY, MODE MIX RATIO=TRACTION",
            "MODE MIX RATIO=TRACTION",
        ),
        ("8e5, 8e5", "8e5, 7e5", "two kinds of shear"),
        (
            "ELIGIBILITY=ORIGINAL CONTACTS",
            "TYPE=COUPLED",
            "TYPE=COUPLED",
        ),
        ("57., 90.", "0., 90.", "have to be positive"),
        (
            "*COHESIVE",
            "*MATERIAL, NAME=OTHER\n*COHESIVE",
            "stands in no *SURFACE INTERACTION",
        ),
    ] {
        assert!(whole.contains(from), "{from}");
        let found = refused(&joined(&whole.replacen(from, to, 1)));
        assert!(found.contains(expected), "{expected}: {found}");
    }
}
