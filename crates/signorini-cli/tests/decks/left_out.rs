//! Parts of a deck that are not read are named, once, with all their places; contradictory repetitions are errors.

use signorini::{Diagnostics, Reading, load};

/// A cube that is pulled, with more cards in the model and in the step.
fn deck(model: &str, step: &str) -> String {
    format!(
        "*NODE, NSET=NALL\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n\
         *ELEMENT, TYPE=C3D8, ELSET=B\n1,1,2,3,4,5,6,7,8\n*NSET, NSET=FOOT\n1,2,3,4\n\
         *MATERIAL, NAME=M\n*ELASTIC\n210000,0.3\n*SOLID SECTION, ELSET=B, MATERIAL=M\n{model}\
         *BOUNDARY\nFOOT,1,3\n*STEP\n*STATIC\n{step}*END STEP\n"
    )
}

fn read(text: &str) -> (Diagnostics, bool) {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("deck.inp");
    std::fs::write(&path, text).unwrap();
    match load(&path, &Reading::default()) {
        Ok(loaded) => (loaded.warnings, true),
        Err(found) => (found, false),
    }
}

#[test]
fn a_plain_deck_has_no_such_notes() {
    let (found, is_read) = read(&deck("", "*CLOAD\n5, 3, 1.\n"));
    let notes = found.plain();
    let says_so = notes.contains("is not read") || notes.contains("is left out");
    assert!(is_read && !says_so, "{notes}");
}

#[test]
fn parameters_that_nobody_reads_are_named_once_with_all_lines() {
    let model = "*NSET, NSET=HEAD, FREQUENCY=1\n5,6,7,8\n*NSET, NSET=TIP, FREQUENCY=1\n5\n";
    let step = "*CLOAD\n5, 3, 1.\n*NODE PRINT, NSET=TIP, SUMMARY=NO\nU\n*NODE PRINT, NSET=HEAD, SUMMARY=NO\nU\n";
    let (found, is_read) = read(&deck(model, step));
    let notes = found.plain();
    assert!(is_read, "{notes}");
    assert_eq!(
        notes.matches("SUMMARY of *NODE PRINT is not read").count(),
        1,
        "{notes}"
    );
    assert!(notes.contains("also in lines 30"), "{notes}");
    assert_eq!(
        notes
            .matches("FREQUENCY of *NSET is not read, and once more below")
            .count(),
        1,
        "{notes}"
    );
}

#[test]
fn parameters_that_no_card_has_are_refused_all_at_once() {
    let step =
        "*CLOAD, FOLLOWER\n5, 3, 1.\n*CLOAD, AMPLITUD=A\n7, 3, 1.\n*DLOAD, OP=NWE\nB, P2, 1.\n";
    let (found, is_read) = read(&deck("", step));
    let shown = found.plain();
    assert!(!is_read && found.exit_code() == Some(3), "{shown}");
    for words in [
        "FOLLOWER of *CLOAD is not supported",
        "did you mean AMPLITUDE?",
        "did you mean NEW?",
    ] {
        assert!(shown.contains(words), "{words}: {shown}");
    }
}

#[test]
fn cards_that_have_no_effect_are_named_once_with_all_lines() {
    let step = "*NODE FILE\nU\n*EL FILE\nS\n*NODE FILE\nRF\n";
    let notes = read(&deck("", step)).0.plain();
    assert_eq!(
        notes.matches("*NODE FILE is left out").count(),
        1,
        "{notes}"
    );
    assert_eq!(notes.matches("*EL FILE is left out").count(), 1, "{notes}");
    assert!(notes.contains("also in lines 26"), "{notes}");
}

#[test]
fn an_amplitude_that_is_defined_twice_is_an_error_with_both_lines() {
    let first = "*AMPLITUDE, NAME=A\n0., 0., 1., 1.\n";
    let load = "*CLOAD, AMPLITUDE=A\n5, 3, 1.\n";
    let other = "*AMPLITUDE, NAME=a\n0., 0., 1., 3.\n";
    for (model, step) in [
        (format!("{first}{other}"), load.to_owned()),
        (first.to_owned(), format!("{other}{load}")),
        (
            first.to_owned(),
            format!("*AMPLITUDE, NAME=A, TIME=TOTAL TIME\n0., 0., 1., 1.\n{load}"),
        ),
    ] {
        let (found, is_read) = read(&deck(&model, &step));
        let notes = found.plain();
        assert!(!is_read && notes.contains("is defined twice"), "{notes}");
        assert!(
            notes.contains("18 │") && notes.contains("first here"),
            "{notes}"
        );
    }
    let (found, is_read) = read(&deck(&format!("{first}{first}"), load));
    assert!(is_read, "{}", found.plain());
    // in a step it is as good as before
    let (found, is_read) = read(&deck("", &format!("{first}{load}")));
    assert!(is_read, "{}", found.plain());
}
