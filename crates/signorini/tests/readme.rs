//! The blocks of README.md and docs/guide.md: the program is an example of this crate, and the cases read. Their commands run
//! in `crates/signorini-cli/tests/pages.rs`.
#![allow(clippy::unwrap_used)]

use signorini::vocabulary;
use signorini_io::case::read_case;

const README: &str = include_str!("../../../README.md");

const GUIDE: &str = include_str!("../../../docs/guide.md");

/// The blocks of code in this language.
fn blocks<'a>(page: &'a str, language: &str) -> Vec<&'a str> {
    let begin = format!("```{language}\n");
    let after = page.split(begin.as_str()).skip(1);
    after
        .map(|text| text.split("```").next().unwrap())
        .collect()
}

#[test]
fn the_program_is_the_example_that_runs_as_a_test() {
    let example = include_str!("../examples/moduli.rs");
    let (_, program) = example.split_once("\n\n").unwrap();
    let program = program.split("\n#[cfg(test)]").next().unwrap();
    assert_eq!(blocks(README, "rust"), [program]);
}

#[test]
fn the_cases_read_without_a_remark() {
    for page in [README, GUIDE] {
        let cases = blocks(page, "toml");
        assert_eq!(cases.len(), 1);
        for case in cases {
            let (_, remarks) = read_case("case.toml", case.as_bytes(), &[], vocabulary()).unwrap();
            assert!(remarks.is_empty(), "{remarks}");
        }
    }
}
