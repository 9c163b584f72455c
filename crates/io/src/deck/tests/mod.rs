mod cohesion;
mod constraints;
mod contact;
mod frequency;
mod general;
mod heat;
mod mass;
mod materials;
mod motion;
mod penetration;
mod sections;
mod shells;
mod silent;
mod steps;

use super::*;
use crate::case::FreeMotions;
use crate::fs::RealFs;

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
fn faults_are_reported_with_their_lines() {
    for (text, expected) in [
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
        assert!(found.contains(expected), "{expected}: {found}");
        assert!(
            expected.contains("no step") || found.contains("job.inp:"),
            "{found}"
        );
    }
}

#[test]
fn all_faults_of_a_deck_are_reported_at_once() {
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
fn what_nothing_resists_is_held_as_in_calculix_or_refused() {
    let text = cube("C3D8", STEP);
    assert_eq!(case(&text).solver.free_motions, FreeMotions::Refuse);
    let ccx = case_as(&text, Compat::Ccx);
    assert_eq!(ccx.solver.free_motions, FreeMotions::Hold);
}
