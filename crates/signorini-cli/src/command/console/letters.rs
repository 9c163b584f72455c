//! Text for terminals whose letters are those of ASCII.

/// What stands for the other letters that the program writes.
const INSTEAD: [(char, &str); 24] = [
    ('✓', "+"),
    ('✗', "x"),
    ('→', "->"),
    ('←', "<-"),
    ('·', "|"),
    ('—', "-"),
    ('–', "-"),
    ('…', "~"),
    ('±', "+/-"),
    ('≥', ">="),
    ('≤', "<="),
    ('×', "x"),
    ('²', "^2"),
    ('³', "^3"),
    ('µ', "u"),
    ('é', "e"),
    ('━', "="),
    ('╸', ">"),
    ('│', "|"),
    ('┌', ","),
    ('─', "-"),
    ('╭', ","),
    ('╰', "'"),
    ('╯', "'"),
];

/// Whether the environment asks for a locale without Unicode; none is asked for where nothing is said.
pub fn is_ascii(variable: impl Fn(&str) -> Option<String>) -> bool {
    let names = ["LC_ALL", "LC_CTYPE", "LANG"];
    let set = names.iter().filter_map(|name| variable(name));
    let locale = set.map(|value| value.to_lowercase());
    let first = locale.into_iter().find(|value| !value.is_empty());
    first.is_some_and(|locale| !locale.contains("utf-8") && !locale.contains("utf8"))
}

/// The text in ASCII; a question mark stands for letters of the user's that it does not have.
pub fn ascii(text: &str) -> String {
    if text.is_ascii() {
        return text.to_owned();
    }
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        let known = INSTEAD.iter().find(|(known, _)| *known == letter);
        match known {
            _ if letter.is_ascii() => out.push(letter),
            Some((_, instead)) => out.push_str(instead),
            None => out.push('?'),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn in_locale(values: &[(&str, &str)]) -> bool {
        is_ascii(|name| {
            let found = values.iter().find(|(known, _)| *known == name);
            found.map(|(_, value)| (*value).to_owned())
        })
    }

    #[test]
    fn only_a_locale_that_says_so_is_without_unicode() {
        assert!(!in_locale(&[]));
        assert!(in_locale(&[("LANG", "C")]));
        assert!(in_locale(&[("LANG", "de_DE.UTF-8"), ("LC_ALL", "POSIX")]));
        assert!(!in_locale(&[("LANG", "C"), ("LC_CTYPE", "C.utf8")]));
        assert!(!in_locale(&[("LC_ALL", ""), ("LANG", "en_GB.UTF-8")]));
    }

    #[test]
    fn letters_of_the_program_have_others_in_ascii() {
        assert_eq!(
            ascii("✓ solved  → a.out · 2 ± 1 %"),
            "+ solved  -> a.out | 2 +/- 1 %"
        );
        assert_eq!(ascii("über"), "?ber");
        assert!(INSTEAD.iter().all(|(_, instead)| instead.is_ascii()));
    }
}
