//! *FREQUENCY.

use super::*;
use crate::case::{Frequency, Geometry};

fn deck(steps: &str) -> String {
    cube("C3D8", &format!("*DENSITY\n2.\n{steps}"))
        .replace("*SOLID SECTION, ELSET=CUBE, MATERIAL=M\n", "")
        .replace(
            "*DENSITY\n2.\n",
            "*DENSITY\n2.\n*SOLID SECTION, ELSET=CUBE, MATERIAL=M\n",
        )
}

const PRELOAD: &str = "*STEP, NLGEOM\n*STATIC\n*CLOAD\nTOP, 3, 1.\n*END STEP\n";

#[test]
fn frequencies_have_their_number_and_range() {
    for (line, modes, lower, upper) in [
        ("10", 10, None, None),
        ("4, 100.", 4, Some(100.0), None),
        ("4, , 1.E4", 4, None, Some(1e4)),
        ("7, 0., 5.", 7, None, Some(5.0)),
    ] {
        let case = case(&deck(&format!(
            "*STEP, PERTURBATION\n*FREQUENCY, SOLVER=SPOOLES\n{line}\n*BOUNDARY\nBASE, 1, 3\n*END STEP\n"
        )));
        let wanted = Frequency {
            modes,
            lower,
            upper,
        };
        assert_eq!(case.steps[0].frequency, Some(wanted));
        assert!(!case.steps[0].fixes.is_empty());
    }
}

/// With PERTURBATION the stresses of earlier steps count, without it they do not, and the deck says what else differs.
#[test]
fn preload_counts_with_perturbation() {
    for (head, geometry, said) in [
        ("*STEP, PERTURBATION", Geometry::Nonlinear, false),
        ("*STEP", Geometry::Linear, true),
    ] {
        let text = deck(&format!("{PRELOAD}{head}\n*FREQUENCY\n3\n*END STEP\n"));
        let read = translated(&text, Compat::None).unwrap();
        assert_eq!(read.case.steps[1].geometry, geometry);
        let notes = read.found.plain();
        assert_eq!(notes.contains("without PERTURBATION"), said, "{notes}");
    }
}

#[test]
fn what_changes_the_state_is_refused() {
    let of = |step: &str, cards: &str| deck(&format!("{PRELOAD}{step}\n{cards}*END STEP\n"));
    for (step, cards, expected) in [
        (
            "*STEP\n*FREQUENCY\n3",
            "*CLOAD\nTOP, 3, 2.\n",
            "in a step of *FREQUENCY",
        ),
        (
            "*STEP\n*FREQUENCY\n3",
            "*BOUNDARY\nTOP, 1, 1, 0.5\n",
            "moves something",
        ),
        ("*STEP\n*FREQUENCY\n, 5.", "", "does not say how many"),
        (
            "*STEP\n*FREQUENCY\n3, 5., 2.",
            "",
            "is not above the lowest",
        ),
        ("*STEP\n*FREQUENCY\n3, -5.", "", "is -5"),
        ("*STEP\n*FREQUENCY\n0", "", "asks for no frequency"),
        ("*STEP\n*FREQUENCY, CYCMPC=INACTIVE\n3", "", "CYCMPC"),
        ("*STEP, PERTURBATION\n*STATIC", "", "with *FREQUENCY alone"),
    ] {
        let said = refused(&of(step, cards));
        assert!(said.contains(expected), "{said}");
    }
}

#[test]
fn tables_of_modes_are_left_out_with_a_note() {
    let text = deck("*STEP\n*FREQUENCY\n3\n*NODE PRINT, NSET=TOP\nU\n*END STEP\n");
    let read = translated(&text, Compat::None).unwrap();
    assert!(read.case.steps[0].prints.is_none());
    assert!(read.found.plain().contains("are not printed"));
}
