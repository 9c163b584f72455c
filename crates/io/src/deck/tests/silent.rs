//! What would be another model without a word: cut lines, decimal commas, typing errors, elements without a section.

use super::*;

/// Each deck is refused with these words, and with the line that is at fault.
fn assert_refused(decks: &[(String, usize, &str)]) {
    for (text, line, expected) in decks {
        let found = translated(text, Compat::None).unwrap_err();
        assert_eq!(found.exit_code(), Some(3), "{}", found.plain());
        let shown = found.plain();
        assert!(shown.contains(expected), "{expected}: {shown}");
        if *line > 0 {
            let (short, long) = (format!("job.inp:{line}"), format!("job.inp, line {line}:"));
            let is_there = shown.contains(&short) || shown.contains(&long);
            assert!(is_there, "line {line} of {expected}: {shown}");
        }
    }
}

/// The line, from 1, in which a text stands first.
fn line_of(deck: &str, text: &str) -> usize {
    let at = deck.find(text).unwrap_or_else(|| panic!("{text}"));
    deck[..at].matches('\n').count() + 1
}

/// A change of the cube's deck, and the words for it in the line where the change begins.
fn changed(from: &str, to: &str, expected: &'static str) -> (String, usize, &'static str) {
    let deck = cube("C3D8", STEP);
    assert!(deck.contains(from), "{from}");
    let line = line_of(&deck, from) + from.len() - from.trim_start_matches('\n').len();
    (deck.replacen(from, to, 1), line, expected)
}

#[test]
fn misspelt_parameters_and_words_are_refused_with_what_was_meant() {
    assert_refused(&[
        changed("*STEP", "*STEP, NLGOEM", "did you mean NLGEOM?"),
        changed("*STEP", "*STEP, NLGEOM=YSE", "did you mean YES?"),
        changed("*CLOAD", "*CLOAD, OP=NWE", "did you mean NEW?"),
        changed("*CLOAD", "*CLOAD, AMPLITUD=A", "did you mean AMPLITUDE?"),
        changed(
            "*CLOAD",
            "*CLOAD, FOLLOWER",
            "FOLLOWER of *CLOAD is not supported",
        ),
        changed(
            "*NSET, NSET=TOP",
            "*NSET, NSET=TOP, GENERTE",
            "did you mean GENERATE?",
        ),
        changed("*NODE, NSET=ALL", "*NODE, NSTE=ALL", "did you mean NSET?"),
        changed("*STEP", "*STEP, INC=0", "a whole number from 1 on"),
        changed("*STEP", "*STEP, INC=-3", "a whole number from 1 on"),
        changed("*STEP", "*STEP, INC=many", "a whole number from 1 on"),
    ]);
}

#[test]
fn parameters_that_change_nothing_are_taken_and_noted() {
    let deck = cube(
        "C3D8",
        &STEP.replace("*STEP", "*STEP, UNSYMM=YES, NAME=press"),
    );
    let notes = translated(&deck, Compat::None).unwrap().found.plain();
    assert!(notes.contains("UNSYMM of *STEP is not read"), "{notes}");
}

#[test]
fn too_many_values_are_refused_and_decimal_commas_are_seen() {
    assert_refused(&[
        changed(
            "1000., 0.3",
            "1000, 0,3",
            "write 0.3; or, if two values are meant, 0., 3.",
        ),
        changed(
            "1000., 0.3",
            "1000., 0,3, 20.",
            "`0,3` is one number, write it with a decimal point: 0.3",
        ),
        changed("TOP, 3, 1.\n", "TOP, 3, 1,5\n", "with a decimal point: 1.5"),
        changed(
            "8,0,1,1\n",
            "8,0,1,1,5\n",
            "takes a number and three coordinates, found 5 values",
        ),
        changed(
            "CUBE, S2",
            "CUBE, S2, S3",
            "takes an element or element set, and one side, found 3",
        ),
    ]);
    // nought at a temperature, written so that it cannot be misread
    for row in ["1000., 0., 3.", "1000, 0, 3", "1000., 0.3, 20."] {
        case(&cube("C3D8", STEP).replace("1000., 0.3", row));
    }
}

#[test]
fn lines_that_are_cut_and_cards_without_lines_are_refused() {
    assert_refused(
        &[
            changed(
                "TOP, 3, 1.\n",
                "TOP, 3,\n",
                "*CLOAD takes 3 values on a line, found 2",
            ),
            changed("TOP, 3, 1.\n", "", "*CLOAD has no data line"),
            changed(
                "1000., 0.3",
                "1000.",
                "*ELASTIC takes 2 to 3 values on a line, found 1",
            ),
            changed("*END STEP\n", "", "where its *END STEP should follow"),
            changed(
                "*CLOAD\nTOP, 3, 1.\n*END STEP\n",
                "",
                "where its *END STEP should follow",
            ),
        ]
        .map(|(deck, line, words)| match words {
            // the line is that of what has no end
            "where its *END STEP should follow" => {
                let line = line_of(&deck, "*STEP");
                (deck, line, words)
            }
            "*CLOAD has no data line" => (deck, line - 1, words),
            _ => (deck, line, words),
        }),
    );
    let held = STEP.replace("*CLOAD\nTOP, 3, 1.", "*CLOAD, OP=NEW");
    case(&cube("C3D8", &held));
}

/// Cards whose lines have a fixed number of values, with a line that is right.
const LINES: &[(&str, &str)] = &[
    ("*BOUNDARY", "BASE, 1, 3, 0.5"),
    ("*EXPANSION", "1.5e-5, 20."),
    ("*DENSITY", "7.5, 20."),
    ("*PLASTIC", "200., 0., 20."),
    ("*INITIAL CONDITIONS, TYPE=TEMPERATURE", "ALL, 20.5"),
    (
        "*INITIAL CONDITIONS, TYPE=STRESS",
        "1, 1, 1., 2., 3., 4., 5., 6.5",
    ),
    ("*AMPLITUDE, NAME=A", "0., 0., 1., 1.5"),
    ("*TRANSFORM, NSET=TOP", "1., 0., 0., 0., 1., 0.5"),
    ("*ORIENTATION, NAME=O", "1., 0., 0., 0., 1., 0.5"),
    ("*EQUATION\n2", "5, 1, 1., 6, 1, -1.5"),
    ("*CLOAD", "TOP, 3, 1.5"),
    ("*DLOAD", "CUBE, P2, 1.5"),
    ("*DLOAD", "CUBE, GRAV, 9.81, 0., 0., -1.5"),
    ("*DLOAD", "CUBE, CENTRIF, 9., 0., 0., 0., 0., 0., 1.5"),
    ("*DSLOAD", "LID, P, 1.5"),
    ("*TEMPERATURE", "ALL, 20.5"),
    ("*STATIC", "0.5, 1., 1e-5, 0.5"),
];

/// Where a card belongs in the cube's deck.
fn with_card(card: &str, line: &str) -> String {
    let text = format!("{card}\n{line}\n");
    match card {
        "*CLOAD" | "*DLOAD" | "*DSLOAD" | "*TEMPERATURE" => {
            cube("C3D8", STEP).replace("*CLOAD\nTOP, 3, 1.\n", &text)
        }
        "*STATIC" => cube("C3D8", STEP).replace("*STATIC\n", &text),
        "*EXPANSION" | "*DENSITY" | "*PLASTIC" => {
            cube("C3D8", STEP).replace("*SOLID", &format!("{text}*SOLID"))
        }
        _ => cube("C3D8", &format!("{text}{STEP}")),
    }
}

/// Of every card: the line is taken; with one value more, or its last number with a decimal comma, it is not.
#[test]
fn every_line_of_every_card_is_refused_with_a_value_too_many() {
    for (card, line) in LINES {
        case(&with_card(card, line));
        let last = line.rsplit(", ").next().unwrap();
        let mut more = vec![format!("{line}, 7")];
        if let Some((whole, decimals)) = last.split_once('.').filter(|(_, d)| !d.is_empty()) {
            let before = line.strip_suffix(last).unwrap();
            more.push(format!("{before}{whole},{decimals}"));
        }
        for line in more {
            let deck = with_card(card, &line);
            let found = translated(&deck, Compat::None).expect_err(&line);
            assert_eq!(found.exit_code(), Some(3), "{}", found.plain());
            let at = format!("job.inp:{}", line_of(&deck, &line));
            assert!(
                found.plain().contains(&at),
                "{card} {line}: {}",
                found.plain()
            );
        }
    }
}

/// Of every card whose values are all needed: every beginning of its line is refused.
#[test]
fn every_line_that_is_cut_off_is_refused() {
    let optional = [
        "*BOUNDARY",
        "*EXPANSION",
        "*DENSITY",
        "*STATIC",
        "*ORIENTATION",
        "*TRANSFORM",
        "*PLASTIC",
    ];
    let whole =
        |card: &str| !optional.iter().any(|one| card.starts_with(one)) && !card.contains("STRESS");
    for (card, line) in LINES.iter().filter(|(card, _)| whole(card)) {
        let fields: Vec<&str> = line.split(", ").collect();
        let least = match fields[1] {
            "GRAV" => 4,
            "CENTRIF" => 7,
            _ => fields.len(),
        };
        for count in 1..least {
            let cut = fields[..count].join(", ");
            // a table may end after any pair
            if card.starts_with("*AMPLITUDE") && count % 2 == 0 {
                continue;
            }
            let deck = with_card(card, &cut);
            let found = translated(&deck, Compat::None).expect_err(&cut);
            assert_eq!(found.exit_code(), Some(3), "{}", found.plain());
        }
    }
}

#[test]
fn elements_without_a_section_are_refused_with_their_card() {
    let more = "*ELEMENT, TYPE=C3D8, ELSET=OTHER\n7,1,2,3,4,5,6,7,8\n8,1,2,3,4,5,6,7,8\n";
    let deck = cube("C3D8", &format!("{more}{STEP}"));
    let line = line_of(&deck, "*ELEMENT, TYPE=C3D8, ELSET=OTHER");
    let none = cube("C3D8", STEP).replace("*SOLID SECTION, ELSET=CUBE, MATERIAL=M\n", "");
    assert_refused(&[
        (
            deck,
            line,
            "2 elements of `OTHER` have no section, such as 7",
        ),
        (none.clone(), 10, "element 1 of `CUBE` has no section"),
        (none, 10, "write *SOLID SECTION, ELSET=CUBE, MATERIAL=…"),
    ]);
    // faces of solids, rigid bodies and springs need none
    for more in [
        "*ELEMENT, TYPE=S4, ELSET=SKIN\n7,5,6,7,8\n",
        "*ELEMENT, TYPE=SPRINGA, ELSET=SPRINGS\n7,1,7\n*SPRING, ELSET=SPRINGS\n\n5.\n",
        "*NODE\n20,0,0,3\n*ELEMENT, TYPE=C3D8, ELSET=STIFF\n7,1,2,3,4,5,6,7,8\n*RIGID BODY, ELSET=STIFF, REF NODE=20\n",
    ] {
        case(&cube("C3D8", &format!("{more}{STEP}")));
    }
    let part = "*PART, NAME=P\n*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT, TYPE=C3D4, ELSET=E\n1,1,2,3,4\n{}*END PART\n\
                *ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n*END INSTANCE\n*END ASSEMBLY\n\
                *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*STEP\n*STATIC\n*END STEP\n";
    case(&part.replace("{}", "*SOLID SECTION, ELSET=E, MATERIAL=M\n"));
    let found = refused(&part.replace("{}", ""));
    assert!(found.contains("element 1 of `E` has no section"), "{found}");
    assert!(found.contains("job.inp:7"), "{found}");
}

#[test]
fn sections_of_what_is_no_solid_are_refused() {
    let plane = "*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n*ELEMENT, TYPE=CPE4, ELSET=P\n1,1,2,3,4\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n\
                 *SOLID SECTION, ELSET=P, MATERIAL=M\n*STEP\n*STATIC\n*END STEP\n";
    case(plane);
    let skin = "*ELEMENT, TYPE=S4, ELSET=SKIN\n7,5,6,7,8\n*SOLID SECTION, ELSET=SKIN, MATERIAL=M\n";
    assert_refused(&[
        (
            plane.replace("CPE4", "S4"),
            0,
            "element 1, which is no solid: S4 (shell)",
        ),
        (
            cube("C3D8", &format!("{skin}{STEP}")),
            0,
            "element 7, which is no solid: S4 (shell)",
        ),
        (
            plane.replace("3,1,1\n", "3,1,1,0.3\n"),
            0,
            "z is 0 at node 1, and 0.3 at node 3",
        ),
    ]);
    let aloft = ["1,0,0", "2,1,0", "3,1,1", "4,0,1"]
        .iter()
        .fold(plane.to_owned(), |deck, node| {
            deck.replace(&format!("\n{node}\n"), &format!("\n{node},0.3\n"))
        });
    let notes = translated(&aloft, Compat::None).unwrap().found.plain();
    assert!(notes.contains("at z = 0.3, which is left out"), "{notes}");
}

#[test]
fn increments_that_contradict_each_other_are_refused() {
    let times = |row: &str, expected: &'static str| {
        changed("*STATIC\n", &format!("*STATIC\n{row}\n"), expected)
    };
    let all = [
        times("-0.1, 1.", "the initial increment of *STATIC is -0.1"),
        times(
            "2., 1.",
            "the initial increment of *STATIC, 2, is larger than its period, 1",
        ),
        times(
            "0.1, 1., 0.5, 0.1",
            "the smallest increment of *STATIC, 0.5, is larger",
        ),
        times(
            "0.1, 1., 0.5",
            "the smallest increment of *STATIC, 0.5, is larger",
        ),
        times("0.1, -2.", "the period of *STATIC is -2."),
        times("0.1, 1., -1.", "the smallest increment of *STATIC is -1."),
        times(
            "0.1, 1., 0.01, -1.",
            "the largest increment of *STATIC is -1.",
        ),
    ];
    assert_refused(&all.map(|(deck, line, words)| (deck, line + 1, words)));
    // zero stands for the default
    for row in [
        "",
        "0.1",
        "0.1, 0.",
        "0., 0., 0., 0.",
        "0.1, 1.",
        "0.1, 2., , 0.5",
        "1., 1., 1e-5, 1.",
    ] {
        case(&with_card("*STATIC", row));
    }
}

#[test]
fn names_that_are_given_twice_are_refused_with_both_lines() {
    for (first, second) in [
        (
            "*MATERIAL, NAME=M\n",
            "*MATERIAL, NAME=m\n*ELASTIC\n2000., 0.3\n",
        ),
        (
            "*SURFACE INTERACTION, NAME=I\n",
            "*SURFACE INTERACTION, NAME=I\n*FRICTION\n0.1\n",
        ),
        (
            "*ORIENTATION, NAME=O\n",
            "*ORIENTATION, NAME=o\n0., 1., 0., -1., 0., 0.\n",
        ),
    ] {
        let own = match first {
            "*MATERIAL, NAME=M\n" => String::new(),
            "*ORIENTATION, NAME=O\n" => format!("{first}1., 0., 0., 0., 1., 0.\n"),
            _ => first.to_owned(),
        };
        let deck = cube("C3D8", &format!("{own}{second}{STEP}"));
        let found = refused(&deck);
        assert!(found.contains("is defined twice"), "{found}");
        for line in [first, second.split('\n').next().unwrap()] {
            let at = deck.rfind(line).unwrap_or_default();
            let number = deck[..at].matches('\n').count() + 1;
            assert!(
                found.contains(&format!("job.inp:{number}"))
                    || found.contains(&format!("{number} |")),
                "{found}"
            );
        }
    }
}

#[test]
fn values_out_of_range_are_refused_with_their_line() {
    let contact = |law: &str| {
        format!(
            "*SURFACE INTERACTION, NAME=I\n{law}*CONTACT PAIR, INTERACTION=I\nLID, SOLE\n{STEP}"
        )
    };
    let friction = cube("C3D8", &contact("*FRICTION\n-0.1\n"));
    let line = line_of(&friction, "-0.1");
    assert_refused(
        &[
            (friction, line, "-0.1 in *FRICTION is negative"),
            (
                with_card("*DENSITY", "-1."),
                line_of(&with_card("*DENSITY", "-1."), "-1."),
                "the density of `M` is -1",
            ),
            (
                with_card("*PLASTIC", "-1., 0."),
                line_of(&with_card("*PLASTIC", "-1., 0."), "-1., 0."),
                "has to be positive",
            ),
            changed(
                "1000., 0.3",
                "1e-320, 0.3",
                "`1e-320` is no number to compute with",
            ),
            changed(
                "TOP, 3, 1.\n",
                "TOP, 3, 1e-320\n",
                "`1e-320` is no number to compute with",
            ),
            changed(
                "*ELASTIC\n1000., 0.3\n",
                "",
                "material `M` has no elastic constants",
            ),
        ]
        .map(|(deck, line, words)| match words {
            "material `M` has no elastic constants" => (deck, 0, words),
            _ => (deck, line, words),
        }),
    );
    // what the model judges knows where it was written
    let material = case(&cube("C3D8", STEP)).materials.remove(0);
    let constants = &material.constants[0].values.place;
    assert_eq!(constants.line().as_deref(), Some("line 22 of job.inp"));
}

#[test]
fn faults_of_many_cards_are_reported_once_with_their_lines() {
    let loads = "*CLOAD, FOLLOWER\nTOP, 3, 1.\n".repeat(12);
    let text = refused(&cube(
        "C3D8",
        &format!("*STEP\n*STATIC\n{loads}*END STEP\n"),
    ));
    assert_eq!(
        text.matches("FOLLOWER of *CLOAD is not supported").count(),
        1,
        "{text}"
    );
    assert!(text.contains("and 3 more"), "{text}");
    let cards = "*CREEP\n1.,2.,3.\n".repeat(2);
    let text = refused(&cube("C3D8", &format!("{cards}{STEP}")));
    assert_eq!(text.matches("*CREEP is not supported").count(), 1, "{text}");
    assert!(text.contains("also in lines"), "{text}");
}

#[test]
fn parameters_that_are_like_none_are_noted_and_change_nothing() {
    let plain = translated(&cube("C3D8", STEP), Compat::None).unwrap();
    for (from, to, note) in [
        (
            "*CLOAD",
            "*CLOAD, QWERTZ",
            "*CLOAD has no parameter QWERTZ: it is not read",
        ),
        (
            "*STATIC",
            "*STATIC, XY=3",
            "*STATIC has no parameter XY: it is not read",
        ),
    ] {
        let text = cube("C3D8", &STEP.replace(from, to));
        let read = translated(&text, Compat::None).unwrap();
        assert_eq!(read.case.steps, plain.case.steps);
        assert!(read.found.plain().contains(note), "{}", read.found.plain());
    }
    let print = "*CONTACT PRINT, SET=TOP\nCDIS\n*END STEP";
    let text = cube("C3D8", &STEP.replace("*END STEP", print));
    let notes = translated(&text, Compat::None).unwrap().found.plain();
    assert!(
        notes.contains("*CONTACT PRINT has no parameter SET"),
        "{notes}"
    );
}

#[test]
fn keywords_that_nobody_knows_are_refused_and_passed_over_as_calculix_does() {
    let text = cube("C3D8", &format!("*SOMETHING ELSE, A=1\n1., 2.\n{STEP}"));
    let found = refused(&text);
    assert!(
        found.contains("there is no keyword *SOMETHING ELSE"),
        "{found}"
    );
    let read = translated(&text, Compat::Ccx).unwrap_or_else(|found| panic!("{}", found.plain()));
    assert!(
        read.found
            .plain()
            .contains("*SOMETHING ELSE is not known: it is left out")
    );
    // a typing error is none that CalculiX means to pass over
    let typo = text.replace("*SOMETHING ELSE", "*BOUNDRY");
    assert!(translated(&typo, Compat::Ccx).is_err());
}

#[test]
fn decks_of_membranes_or_beams_alone_are_refused_by_one_message() {
    let deck = |kind: &str, nodes: &str, section: &str| {
        format!(
            "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n*ELEMENT, TYPE={kind}, ELSET=E\n1,{nodes}\n\
             *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n{section}*BOUNDARY\n1,1,6\n\
             *STEP\n*STATIC\n*CLOAD\n2,5,1.\n*DLOAD\nE,P,1.\n*END STEP\n"
        )
    };
    for (kind, nodes, section, words) in [
        (
            "M3D4",
            "1,2,3,4",
            "*MEMBRANE SECTION, ELSET=E, MATERIAL=M\n0.1\n",
            "(M3D4): membranes are not built yet",
        ),
        ("M3D3", "1,2,3", "", "(M3D3): membranes are not built yet"),
        (
            "B31",
            "1,2",
            "*BEAM SECTION, ELSET=E, MATERIAL=M, SECTION=RECT\n1.,1.\n",
            "(B31): beams are not built yet",
        ),
    ] {
        let found = translated(&deck(kind, nodes, section), Compat::None).unwrap_err();
        assert_eq!(found.len(), 1, "{}", found.plain());
        assert!(found.plain().contains(words), "{}", found.plain());
    }
    // next to solids the section alone is refused, and no load on its elements
    let mixed = "*NODE\n9,3,0,0\n10,4,0,0\n11,4,1,0\n12,3,1,0\n*ELEMENT, TYPE=M3D4, ELSET=SH\n9,9,10,11,12\n\
                 *MEMBRANE SECTION, ELSET=SH, MATERIAL=M\n0.1\n";
    let step = STEP.replace("TOP, 3, 1.", "9, 5, 1.\n*DLOAD\nSH, P, 1.");
    let found = translated(&cube("C3D8", &format!("{mixed}{step}")), Compat::None).unwrap_err();
    assert_eq!(found.len(), 1, "{}", found.plain());
}
