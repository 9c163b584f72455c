//! What people and machines read: tables for terminals, JSON, HTML and Markdown.
//!
//! | file | what |
//! |---|---|
//! | `terminal` | rows of at most 80 columns, problem by problem |
//! | `json` | one object |
//! | `html` | one self-contained page without scripts |
//! | `manual` | the verification manual: an index and a page for each problem |

mod html;
mod json;
mod manual;
mod terminal;

pub use html::html;
pub use json::json;
pub use manual::{Draw, list, manual};
pub use terminal::{Signs, ending, head, problem};

use crate::problem::{Check, Tolerance};
use crate::solve::Judged;

/// A number with seven digits, six next to a power of ten; `-` where there is none.
#[must_use]
pub fn number(value: f64) -> String {
    let size = value.abs();
    if !value.is_finite() {
        return "-".to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&size) {
        return format!("{value:.5e}");
    }
    // of the rounded number: 0.99999999 is 1.000000
    let exponent = format!("{size:.6e}");
    let exponent = exponent
        .split_once('e')
        .and_then(|(_, e)| e.parse::<i32>().ok());
    let decimals = (6 - exponent.unwrap_or(0)).clamp(0, 9);
    format!("{value:.*}", decimals as usize)
}

/// How far a value is off: relative to its reference, or to the scale where that is zero; `-` where there is no value.
#[must_use]
pub fn difference(check: &Check, value: f64) -> String {
    match check.difference(value) {
        off if off.is_finite() => format!("{off:.1e}"),
        _ => "-".to_owned(),
    }
}

/// The tolerance, short: `1 %`, `1e-9`.
fn allowed(check: &Check) -> String {
    Tolerance::Relative(check.tolerance.part()).words()
}

/// The labels of the references of a problem, each once.
fn labels(checks: &[Check]) -> String {
    let mut all: Vec<&str> = Vec::new();
    for check in checks {
        if !all.contains(&check.kind.label()) {
            all.push(check.kind.label());
        }
    }
    all.join(", ")
}

/// Numbers of problems that passed and failed.
fn count(judged: &[Judged]) -> [usize; 2] {
    let passed = judged.iter().filter(|one| one.passed()).count();
    [passed, judged.len() - passed]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_seven_digits() {
        let all = [
            0.999_999_999,
            -12.345_678_9,
            0.0,
            2.5e-7,
            f64::NAN,
            123_456.789,
        ]
        .map(number);
        assert_eq!(
            all,
            ["1.000000", "-12.34568", "0", "2.50000e-7", "-", "123456.8"]
        );
    }
}
