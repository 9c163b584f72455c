//! Cards: keyword lines with their parameters, and the fields of data lines.

use super::lines::{Lines, Spot};
use super::parameters::spelled;
pub(super) use super::spelling::key;
use super::spelling::title;
use crate::readers::MeshError;
use crate::readers::error::excerpt;
use std::cell::Cell;

/// A parameter of a card.
#[derive(Clone, Debug)]
pub(super) struct Parameter {
    /// In capitals and without blanks.
    pub name: String,
    /// As written; empty where it has none.
    pub value: String,
    /// Whether anybody has asked for it.
    asked: Cell<bool>,
}

impl Parameter {
    /// The value of one of these, which is known to be asked for from now on.
    pub fn find<'p>(all: &'p [Self], name: &str) -> Option<&'p str> {
        let found = all.iter().find(|one| one.name == name)?;
        found.asked.set(true);
        Some(&found.value)
    }

    /// The names of those that nobody has asked for.
    pub fn unread(all: &[Self]) -> impl Iterator<Item = &str> {
        let unread = all.iter().filter(|one| !one.asked.get());
        unread.map(|one| one.name.as_str())
    }
}

/// A keyword with its parameters.
pub(super) struct Card {
    /// In capitals, without star and blanks.
    pub keyword: String,
    /// In capitals, without star, its words apart: for messages.
    pub title: String,
    /// In their order.
    pub parameters: Vec<Parameter>,
    /// Its line.
    pub spot: Spot,
    /// As it stands there.
    pub written: String,
}

impl Card {
    /// Reads a keyword line, and those after it where it ends with a comma.
    pub fn read(first: &[u8], lines: &mut Lines<'_>) -> Self {
        let spot = lines.spot;
        let mut text = first.to_vec();
        while text.ends_with(b",") {
            let Some(more) = lines.data() else { break };
            text.extend_from_slice(more);
        }
        Self::parse(&text, spot)
    }

    fn parse(line: &[u8], spot: Spot) -> Self {
        let mut fields = Fields::of(line.trim_ascii().strip_prefix(b"*").unwrap_or(line));
        let title = title(&text(fields.next().unwrap_or_default()));
        let parameter = |field| {
            let field = text(field);
            let (name, value) = field.split_once('=').unwrap_or((&field, ""));
            Parameter {
                name: key(name),
                value: value.trim().trim_matches('"').to_owned(),
                asked: Cell::new(false),
            }
        };
        let parameters = fields.filter(|f| !f.is_empty()).map(parameter).collect();
        Self {
            keyword: key(&title),
            title,
            parameters,
            spot,
            written: text(line),
        }
    }

    /// The value of a parameter as it was written; empty where it has none.
    pub fn get(&self, name: &str) -> Option<&str> {
        Parameter::find(&self.parameters, name)
    }

    /// The value of a parameter that must be there.
    pub fn need(&self, name: &'static str, lines: &Lines<'_>) -> Result<&str, MeshError> {
        let value = self.get(name).filter(|value| !value.is_empty());
        value.ok_or_else(|| MeshError::NoParameter {
            place: lines.place_of(self.spot),
            card: self.title.clone(),
            parameter: spelled(&self.keyword, name),
        })
    }
}

/// The file that a card names, and whether the file holds the card's data, not cards of its own.
pub(super) fn included(line: &[u8]) -> Option<(String, bool)> {
    let has_input = line.windows(5).any(|w| w.eq_ignore_ascii_case(b"INPUT"));
    if !has_input {
        return None;
    }
    let card = Card::parse(line, Spot::default());
    let path = card
        .get("INPUT")
        .filter(|path| !path.is_empty())?
        .to_owned();
    match card.keyword.as_str() {
        "INCLUDE" => Some((path, false)),
        "NODE" | "ELEMENT" | "NSET" | "ELSET" | "SURFACE" => Some((path, true)),
        _ => None,
    }
}

/// Bytes as text, UTF-8 or else Latin-1.
pub(super) fn text(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&b| char::from(b)).collect(),
    }
}

/// The fields of a line: between commas, without white space at their ends. What is in quotes is not cut.
pub(super) struct Fields<'a> {
    rest: Option<&'a [u8]>,
}

impl<'a> Fields<'a> {
    pub fn of(line: &'a [u8]) -> Self {
        Self { rest: Some(line) }
    }
}

impl<'a> Iterator for Fields<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let rest = self.rest?;
        let comma = match rest.iter().position(|&b| b == b',' || b == b'"') {
            Some(at) if rest.get(at) == Some(&b'"') => unquoted_comma(rest),
            found => found,
        };
        let Some(comma) = comma else {
            self.rest = None;
            return Some(rest.trim_ascii());
        };
        self.rest = rest.get(comma + 1..);
        rest.get(..comma).map(<[u8]>::trim_ascii)
    }
}

/// The first comma outside of quotes; where a quote has no end, the first of all.
fn unquoted_comma(line: &[u8]) -> Option<usize> {
    let mut quoted = false;
    let comma = line.iter().position(|&b| {
        quoted ^= b == b'"';
        b == b',' && !quoted
    });
    comma.or_else(|| line.iter().position(|&b| b == b',').filter(|_| quoted))
}

/// A whole number without sign; nothing for anything else, or beyond 64 bits.
#[inline]
pub(super) fn whole(field: &[u8]) -> Option<u64> {
    let digits = field.strip_prefix(b"+").unwrap_or(field);
    if digits.is_empty() {
        return None;
    }
    // nineteen digits fit whatever they are
    let (short, long) = digits.split_at(digits.len().min(19));
    let mut sum = 0_u64;
    for b in short {
        let digit = b.wrapping_sub(b'0');
        if digit > 9 {
            return None;
        }
        sum = 10 * sum + u64::from(digit);
    }
    long.iter().try_fold(sum, |sum, b| {
        let digit = b.wrapping_sub(b'0');
        let more = sum.checked_mul(10)?.checked_add(u64::from(digit));
        more.filter(|_| digit <= 9)
    })
}

/// A real number as Fortran writes it: `1.`, `.5`, `1.E-6`, `1.D5`, `1.5+3`.
pub(super) fn real(field: &[u8]) -> Option<f64> {
    let plain = std::str::from_utf8(field).ok()?;
    if let Some(value) = decimal(plain) {
        return Some(value);
    }
    let mut text = plain.replace(['d', 'D', 'q', 'Q'], "e");
    if !text.contains(['e', 'E']) {
        let sign = text.rfind(['+', '-']).filter(|&at| at > 0)?;
        text.insert(sign, 'e');
    }
    decimal(&text)
}

/// A number in decimal digits; words such as `nan` are none.
fn decimal(text: &str) -> Option<f64> {
    let is_number = |b: u8| b.is_ascii_digit() || b"+-.eE".contains(&b);
    let value: f64 = text.parse().ok()?;
    // all words that are read are not finite
    (value.is_finite() || text.bytes().all(is_number)).then_some(value)
}

/// Refuses a line with more values than a card takes: how many, what they are, and what to do.
pub(super) fn at_most(
    lines: &Lines<'_>,
    card: &Card,
    line: &[u8],
    (most, wanted, hint): (usize, &'static str, &'static str),
) -> Result<(), MeshError> {
    let found = Fields::of(line).filter(|field| !field.is_empty()).count();
    if found <= most {
        return Ok(());
    }
    Err(MeshError::TooManyValues {
        place: lines.place(),
        card: card.title.clone(),
        wanted,
        found,
        hint,
    })
}

/// The fault of a field that is no number.
pub(super) fn not_a_number(
    lines: &Lines<'_>,
    card: &Card,
    wanted: &'static str,
    found: &[u8],
) -> MeshError {
    MeshError::NotANumber {
        place: lines.place(),
        section: format!("*{}", card.title),
        wanted,
        found: excerpt(found),
        hint: "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_fortran_writes_them() {
        for (text, value) in [
            ("1.", 1.0),
            (".5", 0.5),
            ("+3", 3.0),
            ("1E5", 1e5),
            ("1.E-6", 1e-6),
            ("1.D5", 1e5),
            ("-1.25d-3", -1.25e-3),
            ("1.5+3", 1.5e3),
            ("-2-3", -2e-3),
            ("0.12345678901234567890123456789", 0.123_456_789_012_345_68),
            (
                "123456789012345678901234567890.",
                1.234_567_890_123_456_8e29,
            ),
        ] {
            assert_eq!(real(text.as_bytes()), Some(value), "{text}");
        }
        for text in [
            "",
            "nan",
            "inf",
            "-infinity",
            "1,5",
            "five",
            "1e",
            "--1",
            "+",
            "1 2",
            "é",
        ] {
            assert_eq!(real(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn whole_numbers_have_no_dot() {
        assert_eq!(whole(b"007"), Some(7));
        assert_eq!(whole(b"18446744073709551615"), Some(u64::MAX));
        for text in ["", "+", "1.", "-1", "18446744073709551616", "x"] {
            assert_eq!(whole(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn cards_are_read_whatever_their_blanks_and_letters() {
        let card = Card::parse(
            b" * node Print , NSET = \"my, Set\",frequency=2,GLOBAL",
            Spot::default(),
        );
        assert_eq!(card.keyword, "NODEPRINT");
        assert_eq!(card.title, "NODE PRINT");
        assert_eq!(card.get("NSET"), Some("my, Set"));
        assert_eq!(card.get("FREQUENCY"), Some("2"));
        assert_eq!(card.get("GLOBAL"), Some(""));
        assert_eq!(card.get("OP"), None);
    }

    #[test]
    fn a_quote_without_end_does_not_swallow_the_line() {
        let fields: Vec<&[u8]> = Fields::of(b"a, \"b, c ,").collect();
        assert_eq!(fields, [&b"a"[..], b"\"b", b"c", b""]);
    }
}
