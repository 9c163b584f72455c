//! Findings about a model in the words of decks.
//!
//! Findings about a model, and those of its solution, name keys of cases: `[[step.fix]]`, keys of `[solver]`. Users of a deck
//! read the cards that say the same instead, or the option of the command that sets the key.
//!
//! To add a word: one line in [`WORDS`].

use crate::case::Case;
use crate::diagnostic::{Diagnostic, Diagnostics};

/// The words of a case and those of a deck, replaced in this order.
const WORDS: [(&str, &str); 9] = [
    (
        "give at least one [[body]] a `material`",
        "give elements a material by *SOLID SECTION, ELSET=…, MATERIAL=…",
    ),
    (
        "write  reference = \"...\"  in a rigid [[body]] or in a [[constraint]]",
        "name the node in *RIGID BODY, REF NODE=… or *COUPLING, REF NODE=…",
    ),
    (
        "make the element part of a [[body]]",
        "give the element a *SOLID SECTION",
    ),
    (
        "make a [[body]] of this group alone",
        "give this element set a *SOLID SECTION of its own",
    ),
    ("[[step.move]]", "*BOUNDARY with a value"),
    ("[[step.fix]]", "*BOUNDARY"),
    ("[[body]]", "*SOLID SECTION"),
    ("[[step]]", "*STEP"),
    ("choose  [model] space = \"3d\"", "write C3D elements"),
];

/// Whether a case was read from a deck of Abaqus or CalculiX.
#[must_use]
pub fn is_of_deck(case: &Case) -> bool {
    let place = case.steps.first().and_then(|step| step.place.get());
    place.is_some_and(|(file, _)| {
        let name = file.name().as_bytes();
        let end = name.len().checked_sub(4).and_then(|at| name.get(at..));
        end.is_some_and(|end| end.eq_ignore_ascii_case(b".inp"))
    })
}

/// Findings about the case of a deck, in the words of decks.
#[must_use]
pub fn in_words(found: Diagnostics) -> Diagnostics {
    let mut all = Diagnostics::new();
    for one in found {
        all.push(one_in_words(one));
    }
    all
}

/// One finding, likewise.
#[must_use]
pub fn one_in_words(mut one: Diagnostic) -> Diagnostic {
    let mut is_left = false;
    for help in &mut one.help {
        *help = help_in_words(help);
        is_left |= help.contains("[[") || help.contains(" = ") && !help.contains("--set");
    }
    if is_left {
        let help = "where a key of cases is named: `signorini convert` writes the deck as a case";
        one.help.push(help.to_owned());
    }
    one
}

fn help_in_words(help: &str) -> String {
    if let Some(text) = increments(help).or_else(|| setting(help)) {
        return text;
    }
    WORDS.iter().fold(help.to_owned(), |text, (case, deck)| {
        text.replace(case, deck)
    })
}

/// A key of `[solver]` as an option: `why:  key = value  in [solver]`.
fn setting(help: &str) -> Option<String> {
    let rest = help.strip_suffix("  in [solver]")?;
    let (why, assignment) = rest.rsplit_once(":  ")?;
    let (key, value) = assignment.split_once(" = ")?;
    let inner = value.strip_prefix("{ ").and_then(|v| v.strip_suffix(" }"));
    let (key, value) = match inner.and_then(|inner| inner.split_once(" = ")) {
        Some((name, value)) if !value.contains(',') => (format!("{key}.{name}"), value),
        _ => (key.to_owned(), value),
    };
    Some(format!("{why}:  run it with  --set 'solver.{key}={value}'"))
}

/// Sizes of increments as in the line of a procedure.
fn increments(help: &str) -> Option<String> {
    let (why, rest) = help.split_once("increments = { ")?;
    let (sizes, _) = rest.split_once(" }")?;
    let size = |wanted: &str| {
        let mut all = sizes.split(", ").filter_map(|one| one.split_once(" = "));
        all.find(|(name, _)| *name == wanted).map(|(_, size)| size)
    };
    let why = why.trim_end_matches([' ', ':']);
    let mut text = match (size("initial"), size("min"), size("max")) {
        (Some(initial), Some(min), Some(max)) => {
            format!("{why}:  {initial}, the period, {min}, {max}  below the procedure")
        }
        _ => return None,
    };
    if let Some(most) = size("count_max") {
        text.push_str(&format!(", and  INC={most}  in *STEP"));
    }
    Some(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn help_is_in_the_words_of_decks() {
        for (case, deck) in [
            (
                "hold it by [[step.fix]], or prescribe its motion by [[step.move]] instead of a load, in step \"step-1\"",
                "hold it by *BOUNDARY, or prescribe its motion by *BOUNDARY with a value instead of a load, in step \"step-1\"",
            ),
            (
                "where no load acts on the motion:  free_motions = \"hold\"  in [solver]",
                "where no load acts on the motion:  run it with  --set 'solver.free_motions=\"hold\"'",
            ),
            (
                "more iterations:  newton = { max_iterations = 50 }  in [solver]",
                "more iterations:  run it with  --set 'solver.newton.max_iterations=50'",
            ),
            (
                "smaller increments:  increments = { initial = 0.1, min = 1e-5, max = 1, count_max = 100 }  of step \"step-1\"",
                "smaller increments:  0.1, the period, 1e-5, 1  below the procedure, and  INC=100  in *STEP",
            ),
            (
                "give at least one [[body]] a `material`",
                "give elements a material by *SOLID SECTION, ELSET=…, MATERIAL=…",
            ),
        ] {
            assert_eq!(help_in_words(case), deck);
        }
    }

    #[test]
    fn what_has_no_card_says_how_to_get_a_case() {
        let one = Diagnostic::error(&crate::diagnostic::codes::OUT_OF_RANGE, "it")
            .help("where the gap is meant to be closed:  start = { close_gaps_below = 1 }  of contact \"a\"");
        let help = one_in_words(one).help;
        assert_eq!(help.len(), 2);
        assert!(help[1].contains("signorini convert"), "{help:?}");
    }
}
