//! Numbers and lines as Fortran programs write them.

/// A line that could not be understood.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {what}")]
pub struct LineError {
    /// The line, from 1.
    pub line: usize,
    /// What is wrong.
    pub what: &'static str,
}

/// The lines of a file without their ends, numbered from 1.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, &[u8])> {
    let bare = |line: &'_ [u8]| -> usize { line.len() - usize::from(line.ends_with(b"\r")) };
    let whole = bytes.split(|&c| c == b'\n');
    (1..).zip(whole.map(move |line| line.get(..bare(line)).unwrap_or_default()))
}

/// A whole number with blanks around it.
pub(super) fn whole(text: &[u8]) -> Option<u64> {
    std::str::from_utf8(text.trim_ascii()).ok()?.parse().ok()
}

/// A real number with blanks around it: also `1.0D+00`, and `1.00000-100` where three digits left no place for the `E`.
pub(super) fn real(text: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(text.trim_ascii()).ok()?;
    if let Ok(value) = text.parse() {
        return Some(value);
    }
    if !text.contains(|c: char| c.is_ascii_digit()) {
        return None;
    }
    if text.contains(['D', 'd']) {
        return text.replace(['D', 'd'], "E").parse().ok();
    }
    let sign = text.rfind(['+', '-']).filter(|&at| at > 0)?;
    let (mantissa, exponent) = text.split_at(sign);
    format!("{mantissa}E{exponent}").parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_fortran_are_read() {
        for (text, value) in [
            (" 1.50000E-03", 1.5e-3),
            ("-2.5", -2.5),
            ("1.0D+02", 100.0),
            ("-1.25000-101", -1.25e-101),
            ("1.25000+101", 1.25e101),
            ("  7 ", 7.0),
        ] {
            assert_eq!(real(text.as_bytes()), Some(value), "{text}");
        }
        assert!(real(b"NaN").is_some_and(f64::is_nan));
        for bad in [
            "", "x", "1.0x", "--1", "D", "1-", "-", "1 2", "+-", "1e5-3-2",
        ] {
            assert_eq!(real(bad.as_bytes()), None, "{bad}");
        }
        assert_eq!(real(b"\xff"), None);
        assert_eq!(whole(b"  12 "), Some(12));
        assert_eq!(whole(b"-1"), None);
    }

    #[test]
    fn lines_lose_their_ends() {
        let all: Vec<_> = lines(b"a\r\nb\n\nc").collect();
        assert_eq!(all, [(1, &b"a"[..]), (2, b"b"), (3, b""), (4, b"c")]);
    }
}
