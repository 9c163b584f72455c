//! Misspelt cards and parameters of decks: no letter of their names changes a model without a word.
//!
//! SOURCE      Written for the purpose.
//! GOAL        a deck with a wrong letter in the name of a card or a parameter is refused, or something is said of it, or it
//!             is the same model
//! MESH        those of the decks
//! CONDITIONS  one letter of each name left out, doubled, swapped with the next, or another one
//! EXPECTED    an error, another finding, or the same case
//! TOLERANCE   none
#![allow(clippy::unwrap_used)]

use signorini_io::case::resolved;
use signorini_io::deck::{self, Compat};
use signorini_io::fs::RealFs;
use std::path::{Path, PathBuf};

/// What a deck says: its case and what was found; nothing where it is refused.
fn said(name: &Path, text: &str, compat: Compat) -> Option<(String, String)> {
    let read = deck::read(
        &RealFs,
        &name.display().to_string(),
        text.as_bytes(),
        compat,
    )
    .ok()?;
    Some((
        resolved(&read.case, signorini::vocabulary()),
        read.found.plain(),
    ))
}

/// The places of letters in the names of cards and parameters: what stands before an `=` or without one.
fn letters(line: &str) -> Vec<usize> {
    let mut places = Vec::new();
    let mut at = 1;
    for part in line[1..].split(',') {
        let name = part.split('=').next().unwrap_or(part);
        let found = name.char_indices().filter(|(_, c)| c.is_ascii_alphabetic());
        places.extend(found.map(|(k, _)| at + k));
        at += part.len() + 1;
    }
    places
}

/// A line with one letter wrong.
fn wrong(line: &str, place: usize, way: usize) -> String {
    let (before, rest) = line.split_at(place);
    let (letter, after) = rest.split_at(1);
    match way {
        0 => format!("{before}{after}"),
        1 => format!("{before}{letter}{letter}{after}"),
        2 if after.starts_with(|c: char| c.is_ascii_alphabetic() && !letter.contains(c)) => {
            format!("{before}{}{letter}{}", &after[..1], &after[1..])
        }
        _ => {
            let other = if letter.eq_ignore_ascii_case("Q") {
                "K"
            } else {
                "Q"
            };
            format!("{before}{other}{after}")
        }
    }
}

/// The decks next to the tests, and those of single cards where they are at hand.
fn decks() -> Vec<PathBuf> {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut folders = vec![
        own.join("tests/data"),
        own.join("../signorini-cli/tests/decks"),
    ];
    let cards = own.join("../../../shared/cases/cards");
    if cards.is_dir() {
        folders.push(cards);
    } else {
        println!("SKIPPED: no {}", cards.display());
    }
    let mut decks = Vec::new();
    for folder in folders {
        let files = std::fs::read_dir(folder).unwrap();
        let files = files.map(|file| file.unwrap().path());
        decks.extend(files.filter(|path| {
            let is_small = std::fs::metadata(path).is_ok_and(|of| of.len() < 20_000);
            is_small && path.extension().is_some_and(|end| end == "inp")
        }));
    }
    decks.sort();
    decks
}

/// How often something was said of a wrong letter, and where nothing was.
#[derive(Debug, Default)]
struct Tried {
    refused: usize,
    mentioned: usize,
    same: usize,
    silent: Vec<String>,
}

impl Tried {
    fn deck(&mut self, name: &Path, text: &str, compat: Compat) {
        let Some((case, found)) = said(name, text, compat) else {
            return;
        };
        for (number, line) in text.lines().enumerate() {
            if !line.starts_with('*') || line.starts_with("**") || !line.is_ascii() {
                continue;
            }
            for (k, place) in letters(line).into_iter().enumerate() {
                let changed = wrong(line, place, (k + number) % 4);
                let lines = text.lines().enumerate();
                let lines = lines.map(|(n, of)| if n == number { &changed } else { of });
                let mutant: Vec<&str> = lines.collect();
                match said(name, &mutant.join("\n"), compat) {
                    None => self.refused += 1,
                    Some((_, of)) if of != found => self.mentioned += 1,
                    Some((now, _)) if now == case => self.same += 1,
                    Some(_) => {
                        let what = format!("{}: {line} as {changed}", name.display());
                        self.silent.push(what);
                    }
                }
            }
        }
    }
}

#[test]
fn no_wrong_letter_in_a_name_changes_a_model_without_a_word() {
    let mut tried = Tried::default();
    for (number, deck) in decks().into_iter().enumerate() {
        let text = std::fs::read_to_string(&deck).unwrap();
        tried.deck(&deck, &text, [Compat::None, Compat::Ccx][number % 2]);
    }
    println!(
        "{} refused, {} mentioned, {} the same",
        tried.refused, tried.mentioned, tried.same
    );
    assert!(tried.refused > 400 && tried.mentioned > 10, "{tried:?}");
    assert!(tried.silent.is_empty(), "{}", tried.silent.join("\n"));
}
