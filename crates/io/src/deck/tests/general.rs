//! Contact of everything with everything.

use super::*;
use crate::case::{Enforcement, Interference};

/// Two cubes with an interaction.
fn cubes(cards: &str) -> String {
    cube(
        "C3D8",
        &format!(
            "*NODE\n11,0,0,1\n12,1,0,1\n13,1,1,1\n14,0,1,1\n15,0,0,2\n16,1,0,2\n17,1,1,2\n18,0,1,2\n\
             *ELEMENT, TYPE=C3D8, ELSET=UPPER\n2,11,12,13,14,15,16,17,18\n\
             *SOLID SECTION, ELSET=UPPER, MATERIAL=M\n*SURFACE, NAME=TABLE\n1, S2\n*SURFACE, NAME=FOOT\n2, S1\n\
             *SURFACE INTERACTION, NAME=I\n*FRICTION\n0.2\n*SURFACE INTERACTION, NAME=J\n\
             *SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=EXPONENTIAL\n0.01, 2.\n{cards}{STEP}"
        ),
    )
}

const ALL: &str = "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n";

#[test]
fn everything_may_touch_by_the_interaction_of_all() {
    let general = case(&cubes(&format!(
        "{ALL}*CONTACT PROPERTY ASSIGNMENT\n, , I\n"
    )))
    .general;
    let general = general.unwrap();
    assert!(general.of.is_empty() && general.exclude.is_empty() && general.pairs.is_empty());
    assert!(general.with_itself && general.common.friction.is_some());
    assert_eq!(general.common.enforcement, Enforcement::Auto);
    assert_eq!(general.common.start.interference, Interference::StrainFree);
}

#[test]
fn pairs_have_interactions_and_roles_of_their_own() {
    let cards = "*CONTACT PROPERTY ASSIGNMENT\n, , I\nFOOT, TABLE, J\n\
                 *CONTACT FORMULATION, TYPE=MASTER SLAVE ROLES\nFOOT, TABLE, MASTER\n";
    let general = case(&cubes(&format!("{ALL}{cards}"))).general.unwrap();
    let [law, role] = &general.pairs[..] else {
        panic!("{:?}", general.pairs);
    };
    assert_eq!(
        law.between.each_ref().map(|name| name.value.as_str()),
        ["FOOT", "TABLE"]
    );
    assert_eq!(law.friction, Some(None));
    assert!(matches!(law.enforcement, Some((Enforcement::Law(_), _))));
    assert_eq!(role.secondary.as_ref().unwrap().value, "TABLE");
}

/// What is said of the start, of all and of a pair; the last line about a pair wins, whatever the line before it was about.
#[test]
fn pairs_start_as_their_data_say() {
    let data = "*CONTACT INITIALIZATION DATA, NAME=FIT, INTERFERENCE FIT=0.1\n\
                *CONTACT INITIALIZATION DATA, NAME=MEASURED, INTERFERENCE FIT\n\
                *CONTACT INITIALIZATION DATA, NAME=PLAY, INITIAL CLEARANCE=0.2, SEARCH ABOVE=0.3\n\
                *CONTACT INITIALIZATION DATA, NAME=NOTHING\n";
    let general = |rows: &str| {
        let cards = format!("{ALL}{data}*CONTACT INITIALIZATION ASSIGNMENT\n{rows}");
        case(&cubes(&cards)).general.unwrap()
    };
    let all = general(", , PLAY\nFOOT, TABLE, FIT\n, , MEASURED\n");
    let start = &all.common.start;
    assert_eq!((start.clearance, start.close_gaps_below), (Some(0.2), 0.3));
    assert_eq!(start.interference, Interference::StrainFree);
    let starts = all.pairs.iter().map(|pair| pair.start.clone().unwrap());
    let starts: Vec<_> = starts
        .map(|one| (one.clearance, one.interference))
        .collect();
    let step = Interference::Step;
    assert_eq!(starts, [(Some(-0.1), step), (None, step)]);
    let default = general(", , NOTHING\n").common.start;
    assert_eq!(default.interference, Interference::StrainFree);
    assert_eq!((default.clearance, default.close_gaps_below), (None, 0.0));
}

#[test]
fn inclusions_and_exclusions_are_pairs_of_surfaces() {
    let only = case(&cubes("*CONTACT\n*CONTACT INCLUSIONS\nFOOT, TABLE\n"))
        .general
        .unwrap();
    let names = |pair: &(crate::case::Name, Option<crate::case::Name>)| {
        [pair.0.value.clone(), pair.1.as_ref().unwrap().value.clone()]
    };
    assert_eq!(only.of.len(), 2);
    let apart: Vec<[String; 2]> = only.exclude.iter().map(names).collect();
    assert_eq!(apart, [["FOOT", "FOOT"], ["TABLE", "TABLE"]]);
    let all = case(&cubes(&format!(
        "{ALL}*CONTACT EXCLUSIONS\nFOOT, TABLE\nFOOT\n"
    )))
    .general
    .unwrap();
    let apart: Vec<[String; 2]> = all.exclude.iter().map(names).collect();
    assert_eq!(apart, [["FOOT", "TABLE"], ["FOOT", "FOOT"]]);
    let blank = case(&cubes("*CONTACT\n*CONTACT INCLUSIONS\n,\n"))
        .general
        .unwrap();
    assert!(blank.of.is_empty());
}

#[test]
fn what_is_not_read_is_refused_by_name() {
    for (cards, says) in [
        (
            "*CONTACT INCLUSIONS, ALL EXTERIOR\n",
            "stands without *CONTACT",
        ),
        ("*CONTACT\n", "nothing would touch"),
        (
            "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n*CONTACT PROPERTY ASSIGNMENT\n, , K\n",
            "no surface interaction `K`",
        ),
        (
            "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n*SURFACE PROPERTY ASSIGNMENT, PROPERTY=THICKNESS\n, , 0.1\n",
            "SURFACE PROPERTY ASSIGNMENT",
        ),
        (
            "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n*CONTACT INITIALIZATION ASSIGNMENT\n, , A\n",
            "no *CONTACT INITIALIZATION DATA `A`",
        ),
        (
            "*CONTACT INITIALIZATION DATA, NAME=A\n",
            "*CONTACT INITIALIZATION DATA stands without *CONTACT",
        ),
        (
            "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n\
             *CONTACT INITIALIZATION DATA, NAME=A, INTERFERENCE FIT, INITIAL CLEARANCE=0.1\n",
            "exclude each other",
        ),
        (
            "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n*CONTACT INITIALIZATION DATA, NAME=A, INTERFERENCE FIT=-0.1\n",
            "INTERFERENCE FIT is negative",
        ),
        ("*CONTACT\n*CONTACT INCLUSIONS\nFOOT, ROOF\n", "ROOF"),
    ] {
        let said = translated(&cubes(cards), Compat::None)
            .map(drop)
            .unwrap_err()
            .plain();
        assert!(said.contains(says), "{cards}: {said}");
    }
}
