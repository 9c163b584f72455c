//! What a terminal shows, seen through a pseudo terminal: transcripts at three widths are files in `golden/`, written again
//! with `SIGNORINI_BLESS=1`.

mod screen;

use crate::support::{BRICK, brick_in, change, folder_with, run};
use screen::{Screen, shown};
use std::path::Path;
use tempfile::TempDir;

const WIDTHS: [u16; 3] = [60, 80, 120];

/// A brick with expectations, one of which fails.
fn expecting() -> String {
    let expect = |what: &str, value: f64, tol: &str| {
        format!("\n[[expect]]\nwhat = \"{what}\"\nvalue = {value:?}\ntol = {{ {tol} }}\n")
    };
    format!(
        "{BRICK}{}{}",
        expect("time", 1.0, "abs = 0.0"),
        expect("displacement.z @ node 11", -0.03, "rel = 1e-3")
    )
}

/// A brick that is pressed too far in one increment, so that it is cut.
fn cut_back() -> String {
    let text = change(BRICK, "{ fixed = 4 }", "{ initial = 1.0, min = 1e-3 }");
    change(&text, "uz = -0.02", "uz = -0.3")
}

/// A brick that is pressed through its base.
fn failing() -> String {
    let text = change(BRICK, "{ fixed = 4 }", "{ initial = 0.5, min = 0.1 }");
    let text = change(&text, "uz = -0.02", "uz = -5.0");
    // by the shortest way: numbers on longer ones depend on the last bits
    text + "\n[solver]\non_trouble = [\"cut\"]\nstabilize = false\n"
}

/// Compares a transcript with its file.
#[track_caller]
fn compare(name: &str, screen: &Screen) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/command/terminal/golden")
        .join(format!("{name}_{}.txt", screen.width));
    let text = screen.text();
    if std::env::var_os("SIGNORINI_BLESS").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    let wanted = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        wanted == text,
        "{}:\n{text}\nwanted:\n{wanted}",
        path.display()
    );
}

/// Asserts what holds for every transcript.
#[track_caller]
fn is_tidy(screen: &Screen) {
    let text = screen.text();
    assert!(!screen.wrapped, "a line was wrapped\n{text}");
    let lines: Vec<&str> = text.lines().filter(|line| !line.is_empty()).collect();
    for pair in lines.windows(2) {
        assert_ne!(pair[0], pair[1], "repeated\n{text}");
    }
    assert!(!text.contains('━'), "the bar is still there\n{text}");
    for line in lines {
        assert!(line.chars().count() < usize::from(screen.width), "{line}");
    }
}

fn at_all_widths(name: &str, code: u32, case: &str, before: &dyn Fn(&TempDir), arguments: &[&str]) {
    for width in WIDTHS {
        let folder = folder_with(case);
        before(&folder);
        let screen = shown(folder.path(), arguments, width, &[]);
        assert_eq!(screen.code, code, "{}", screen.text());
        is_tidy(&screen);
        compare(name, &screen);
    }
}

#[test]
fn a_run_with_expectations_fits_three_widths() {
    let arguments = ["run", "case.toml", "-j", "1"];
    at_all_widths("expect", 1, &expecting(), &|_| (), &arguments);
}

#[test]
fn a_run_with_cutbacks_fits_three_widths() {
    let arguments = ["run", "case.toml", "-j", "1"];
    at_all_widths("cut_back", 0, &cut_back(), &|_| (), &arguments);
}

#[test]
fn a_run_that_fails_fits_three_widths() {
    let arguments = ["run", "case.toml", "-j", "1"];
    at_all_widths("failing", 5, &failing(), &|_| (), &arguments);
}

#[test]
fn a_resumed_run_fits_three_widths() {
    let late = |folder: &TempDir| {
        let first = ["run", "case.toml", "--max-wall", "0.000001s"];
        run(folder.path(), &first).says(8, &[]);
    };
    let arguments = ["resume", "case.out", "-j", "1"];
    at_all_widths("resume", 0, &brick_in(3), &late, &arguments);
}

#[test]
fn the_bar_is_drawn_while_a_run_goes_on_and_gone_afterwards() {
    let folder = folder_with(&brick_in(60));
    for width in [40, 60, 200] {
        let arguments = ["run", "case.toml", "--fresh"];
        let screen = shown(folder.path(), &arguments, width, &[]);
        is_tidy(&screen);
        let raw = String::from_utf8_lossy(&screen.raw);
        assert!(raw.contains('╸') && raw.contains("inc "), "{width}");
    }
}

#[test]
fn a_dumb_terminal_gets_plain_lines() {
    let folder = folder_with(&expecting());
    let arguments = ["run", "case.toml"];
    let screen = shown(folder.path(), &arguments, 80, &[("TERM", "dumb")]);
    is_tidy(&screen);
    assert!(!screen.raw.contains(&0x1b));
    assert!(screen.text().contains("expect time"));
}

#[test]
fn without_unicode_all_letters_are_those_of_ascii() {
    let folder = folder_with(&expecting());
    for (variable, value) in [("LC_ALL", "C"), ("LC_ALL", "POSIX")] {
        let arguments = ["run", "case.toml", "--fresh"];
        let screen = shown(folder.path(), &arguments, 80, &[(variable, value)]);
        is_tidy(&screen);
        assert!(screen.raw.is_ascii());
        assert!(screen.text().contains("+ read"), "{}", screen.text());
    }
}

#[test]
fn wanted_no_colour_there_is_none() {
    let folder = folder_with(&brick_in(2));
    let arguments = ["run", "case.toml", "--no-progress"];
    let screen = shown(folder.path(), &arguments, 80, &[("NO_COLOR", "1")]);
    assert!(!screen.raw.contains(&0x1b));
    let coloured = shown(
        folder.path(),
        &["run", "case.toml", "--no-progress"],
        80,
        &[],
    );
    assert!(coloured.raw.contains(&0x1b));
}
