//! The tools, by topic; each file has a router of its own.

mod cases;
mod files;
mod results;
mod runs;
mod schema;

use crate::Limits;
use crate::reply::Refusal;

/// Bytes that one change of a case may have.
const LONGEST_CHANGE: usize = 4096;

/// Changes of a case as arguments; each is one word, so that none can be an option.
fn changes(set: &[String], limits: &Limits) -> Result<Vec<String>, Refusal> {
    if set.len() > limits.changes {
        let why = format!("at most {} changes are made at once", limits.changes);
        return Err(Refusal::value("set", why));
    }
    let change = |text: &String| {
        let has_key = text
            .split_once('=')
            .is_some_and(|(key, _)| !key.trim().is_empty());
        if !has_key || text.len() > LONGEST_CHANGE || text.contains('\0') {
            let why = "write KEY=VALUE, as in material.steel.E=2000, in at most 4096 bytes";
            return Err(Refusal::value("set", why));
        }
        Ok(format!("--set={text}"))
    };
    set.iter().map(change).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_are_words_that_no_option_can_be() {
        let limits = Limits::default();
        let set = [
            "a.b=1".to_owned(),
            "--output=/etc=x".to_owned(),
            "-j=9".to_owned(),
        ];
        let words = changes(&set, &limits).unwrap();
        assert_eq!(
            words,
            ["--set=a.b=1", "--set=--output=/etc=x", "--set=-j=9"]
        );
        for bad in ["a", "=1", " =1", "a=\0", &format!("a={}", "x".repeat(5000))] {
            assert!(changes(&[bad.to_owned()], &limits).is_err(), "{bad}");
        }
        assert!(changes(&vec!["a=1".to_owned(); 65], &limits).is_err());
    }
}
