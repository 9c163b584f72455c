//! Numbers and durations as people read them.

/// A count with a narrow gap between thousands: `1 855`.
#[must_use]
pub fn count(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// `1 pair`, `2 pairs`.
#[must_use]
pub fn plural(number: usize, noun: &str) -> String {
    let ending = if number == 1 { "" } else { "s" };
    format!("{} {noun}{ending}", count(number))
}

/// A number with three digits or so: `33.9`, `1.20e-7`.
#[must_use]
pub fn short(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".into()
    } else if !value.is_finite() {
        "—".into()
    } else if !(1e-3..1e5).contains(&size) {
        format!("{value:.2e}")
    } else {
        let decimals = (2 - size.log10().floor() as i32).clamp(0, 5);
        format!("{value:.*}", decimals as usize)
    }
}

/// Seconds as `0:03`, `12:40` or `2:05:09`.
#[must_use]
pub fn clock(seconds: f64) -> String {
    let whole = seconds.max(0.0) as u64;
    let (hours, minutes, seconds) = (whole / 3600, whole / 60 % 60, whole % 60);
    if hours > 0 {
        format!("{hours}:{minutes:02}:{seconds:02}")
    } else {
        format!("{minutes}:{seconds:02}")
    }
}

/// The seconds in `90`, `90 s`, `10 min`, `2h` or `1d`; none where it is no such text.
///
/// # Example
/// ```
/// use signorini::text::{clock, seconds};
///
/// assert_eq!(seconds("2h"), Some(7200.0));
/// assert_eq!(clock(7509.0), "2:05:09");
/// assert_eq!(seconds("soon"), None);
/// ```
#[must_use]
pub fn seconds(text: &str) -> Option<f64> {
    let text = text.trim();
    let split = text.find(|c: char| c.is_ascii_alphabetic());
    let (number, unit) = text.split_at(split.unwrap_or(text.len()));
    let number: f64 = number.trim().parse().ok()?;
    let unit = match unit.trim() {
        "" | "s" | "sec" => 1.0,
        "m" | "min" => 60.0,
        "h" | "hour" | "hours" => 3600.0,
        "d" | "day" | "days" => 86400.0,
        _ => return None,
    };
    let total = number * unit;
    (total.is_finite() && total > 0.0).then_some(total)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_readable() {
        assert_eq!(
            [0, 12, 1855, 1_000_000].map(count),
            ["0", "12", "1 855", "1 000 000"]
        );
        assert_eq!(
            [33.91234, 0.0, 1.5e-9, 175_000.0, -0.5].map(short),
            ["33.9", "0", "1.50e-9", "1.75e5", "-0.500"]
        );
        assert_eq!(short(f64::NAN), "—");
        assert_eq!(plural(1, "pair"), "1 pair");
        assert_eq!(
            [3.9, 760.0, 7509.0].map(clock),
            ["0:03", "12:40", "2:05:09"]
        );
    }

    #[test]
    fn durations_are_read_with_and_without_units() {
        let read = ["90", "90 s", "10 min", "2h", "1.5 h"].map(seconds);
        assert_eq!(
            read.map(Option::unwrap),
            [90.0, 90.0, 600.0, 7200.0, 5400.0]
        );
        for wrong in ["", "h", "2 weeks", "-1 h", "0", "nan", "inf", "1e999"] {
            assert_eq!(seconds(wrong), None, "{wrong}");
        }
    }
}
