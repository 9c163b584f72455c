//! Rows for terminals of 80 columns.

use super::{allowed, count, difference, labels, number};
use crate::solve::Judged;
use std::fmt::Write;

/// Whether signs beyond ASCII may be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Signs {
    /// ✓ and ✗.
    Unicode,
    /// `ok` and `no`.
    Ascii,
}

impl Signs {
    const fn of(self, passed: bool) -> &'static str {
        match (self, passed) {
            (Self::Unicode, true) => "✓",
            (Self::Unicode, false) => "✗",
            (Self::Ascii, true) => "ok",
            (Self::Ascii, false) => "no",
        }
    }

    /// A text in these signs.
    fn text(self, text: &str) -> String {
        match self {
            Self::Unicode => text.to_owned(),
            Self::Ascii => text
                .chars()
                .map(|c| if c.is_ascii() { c } else { '?' })
                .collect(),
        }
    }
}

/// The longest line of a failure.
const WIDTH: usize = 80;

/// The heads of the columns.
#[must_use]
pub fn head() -> String {
    format!(
        "  {:<34}{:>12}{:>12}{:>9} {:>7}\n",
        "quantity", "value", "reference", "off by", "allowed"
    )
}

/// A problem with its values.
#[must_use]
pub fn problem(judged: &Judged, signs: Signs) -> String {
    let sign = signs.of(judged.passed());
    let mut out = format!(
        "{sign} {:<32} {:<12} {:>6.1} s\n",
        judged.problem.name,
        labels(&judged.setup.checks),
        judged.solved.seconds
    );
    if let Some(why) = &judged.solved.failure {
        let line: String = signs.text(why).chars().take(WIDTH - 4).collect();
        out.push_str(&format!("    {line}\n"));
    }
    for row in judged.rows() {
        // writing to a string does not fail
        let _ = writeln!(
            out,
            "  {:<34}{:>12}{:>12}{:>9} {:>7} {}",
            row.check.quantity,
            number(row.value),
            number(row.check.reference),
            difference(row.check, row.value),
            allowed(row.check),
            signs.of(row.passed)
        );
    }
    out
}

/// The last line: how many passed.
#[must_use]
pub fn ending(judged: &[Judged], seconds: f64, signs: Signs) -> String {
    let [passed, failed] = count(judged);
    let values: usize = judged.iter().map(|one| one.setup.checks.len()).sum();
    let sign = signs.of(failed == 0 && passed > 0);
    format!("{sign} verify: {passed} passed, {failed} failed, {values} values in {seconds:.0} s\n")
}
