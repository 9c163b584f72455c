//! "Did you mean": the known word that is closest to an unknown one.

/// Longer words are never compared: they are no typing errors, and comparing takes the product of lengths.
const LONGEST: usize = 64;

/// The known word that `word` was probably meant to be.
///
/// A word qualifies when it differs by a third of its letters at most (one at least), an exchange of neighbours
/// counting as one difference; case, hyphens and underscores do not count.
///
/// # Example
/// ```
/// use signorini_io::diagnostic::closest;
///
/// let known = ["node-to-segment", "gauss-point", "mortar"];
/// assert_eq!(closest("Node_to_segmnt", known), Some("node-to-segment"));
/// assert_eq!(closest("penalty", known), None);
/// ```
pub fn closest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if word.is_empty() || word.len() > LONGEST {
        return None;
    }
    let wanted = folded(word);
    known
        .into_iter()
        .filter(|candidate| !candidate.is_empty() && candidate.len() <= LONGEST)
        .map(|candidate| (strsim::osa_distance(&wanted, &folded(candidate)), candidate))
        .filter(|(distance, candidate)| {
            let nchar = candidate.chars().count();
            *distance <= (nchar / 3).max(1) && *distance < nchar
        })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

fn folded(word: &str) -> String {
    word.to_lowercase().replace('_', "-")
}

/// The words of a list for a message: at most twenty, then how many more there are.
pub fn listed<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    const SHOWN: usize = 20;
    let words: Vec<&str> = words.into_iter().collect();
    match words.get(..SHOWN) {
        Some(first) if words.len() > SHOWN => {
            format!("{} and {} more", first.join(", "), words.len() - SHOWN)
        }
        _ if words.is_empty() => "none".to_owned(),
        _ => words.join(", "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn typing_errors_find_their_word() {
        let keys = ["name", "secondary", "primary", "friction", "E", "nu"];
        for (typed, meant) in [
            ("secundary", Some("secondary")),
            ("frcition", Some("friction")),
            ("Primary", Some("primary")),
            ("e", Some("E")),
            ("gravity", None),
            ("x", None),
            ("", None),
        ] {
            assert_eq!(closest(typed, keys), meant, "{typed}");
        }
        assert_eq!(closest(&"n".repeat(1_000_000), keys), None);
    }

    #[test]
    fn long_lists_are_cut() {
        let words: Vec<String> = (0..132).map(|n| n.to_string()).collect();
        let text = listed(words.iter().map(String::as_str));
        assert!(text.ends_with("18, 19 and 112 more"), "{text}");
        assert_eq!(listed([]), "none");
        assert_eq!(listed(["a", "b"]), "a, b");
    }
}
