//! Names of tests: a claim, not a number of a list.

use super::{Fault, Source};

/// Words that say nothing of what a test claims.
const EMPTY: [&str; 5] = ["case", "example", "issue", "no", "test"];

/// Tests whose name is a number.
pub(super) fn numbered(sources: &[Source]) -> Vec<Fault> {
    let mut found = Vec::new();
    for source in sources {
        for function in source.functions() {
            let is_test = function
                .attributes
                .iter()
                .any(|a| a.path().is_ident("test"));
            let name = function.signature.ident.to_string();
            if is_test && is_numbered(&name) {
                let what = format!("the test `{name}` has a number for a name");
                found.push(source.fault(function.signature, what));
            }
        }
    }
    found
}

/// Whether a name begins with a number, alone or behind one letter, or is an empty word and a number.
fn is_numbered(name: &str) -> bool {
    let mut words = name.split('_').filter(|word| !word.is_empty());
    let Some(first) = words.next() else {
        return true;
    };
    let is_number = |word: &str| !word.is_empty() && word.chars().all(|c| c.is_ascii_digit());
    let behind_letter = first.get(1..).is_some_and(is_number);
    let behind_word = EMPTY.iter().any(|word| {
        let rest = first.strip_prefix(word);
        rest.is_some_and(|rest| {
            is_number(rest) || rest.is_empty() && words.clone().next().is_some_and(is_number)
        })
    });
    is_number(first) || behind_letter || behind_word
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn a_claim_may_have_a_number_in_it() {
        for name in [
            "f01_hertz",
            "t3",
            "test_3",
            "test3",
            "issue_38_holds",
            "_12",
        ] {
            assert!(is_numbered(name), "{name}");
        }
        for name in [
            "hertz_in_2d",
            "hex8_passes_the_patch_test",
            "two_bodies",
            "no_body_moves",
            "test_of_the_patch",
        ] {
            assert!(!is_numbered(name), "{name}");
        }
    }

    #[test]
    fn only_tests_are_looked_at() {
        let text = "fn f01() {}\n#[cfg(test)] mod tests { #[test] fn f02() {} }\n";
        let source = Source::new(Path::new("a.rs"), text).unwrap();
        let found = numbered(&[source]);
        assert_eq!(found.len(), 1);
        assert!(found[0].what.contains("f02"));
    }
}
