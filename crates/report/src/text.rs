//! Numbers and units as readers see them.

/// A number in at most `digits` significant digits, without trailing zeros; powers of ten from 10⁶ and below 10⁻³.
#[must_use]
pub fn short(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return if value.is_nan() { "–" } else { "∞" }.to_owned();
    }
    let digits = digits.max(1);
    let scientific = format!("{value:.*e}", digits - 1);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let power: i32 = exponent.parse().unwrap_or(0);
    let text = if (-3..6).contains(&power) {
        let decimals = usize::try_from(digits as i32 - 1 - power).unwrap_or(0);
        return trimmed(&format!("{value:.decimals$}")).replace('-', "−");
    } else {
        format!("{}e{power}", trimmed(mantissa))
    };
    text.replace('-', "−")
}

/// A decimal without zeros at its end.
fn trimmed(text: &str) -> &str {
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => text,
    }
}

/// `1 frame`, `2 frames`, `12 000 frames`.
#[must_use]
pub fn plural(count: usize, noun: &str) -> String {
    let end = if count == 1 { "" } else { "s" };
    format!("{} {noun}{end}", grouped(count))
}

/// A whole number with a thin gap between groups of three digits.
#[must_use]
pub fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// The unit of a field or of a column, from the label of the case (`mm-N-MPa`); empty where it is not known or has none.
#[must_use]
pub fn unit(quantity: &str, label: &str) -> String {
    let mut units = label.split('-');
    let [Some(length), Some(force), Some(stress), None] =
        [units.next(), units.next(), units.next(), units.next()]
    else {
        return String::new();
    };
    let is = |words: &[&str]| words.iter().any(|word| quantity.contains(word));
    if is(&[
        "stress",
        "mises",
        "pressure",
        "traction",
        "multiplier",
        "shear",
    ]) {
        stress.to_owned()
    } else if is(&["force"]) {
        force.to_owned()
    } else if is(&["moment", "work"]) {
        format!("{force} {length}")
    } else if is(&["area"]) {
        format!("{length}²")
    } else if is(&["displacement", "gap", "slip", "center"]) {
        length.to_owned()
    } else {
        String::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_keep_their_sign_and_power() {
        let texts = [0.0, 42.42284, -0.001234, 1.5e-7, 123456.7, 2e9, 100.0];
        let texts = texts.map(|value| short(value, 4));
        assert_eq!(
            texts,
            ["0", "42.42", "−0.001234", "1.5e−7", "123457", "2e9", "100"]
        );
        assert_eq!(short(f64::NAN, 3), "–");
    }

    #[test]
    fn units_follow_the_label_of_the_case() {
        assert_eq!(unit("contact_pressure", "mm-N-MPa"), "MPa");
        assert_eq!(unit("ball.area_slip", "mm-N-MPa"), "mm²");
        assert_eq!(unit("contact_status", "mm-N-MPa"), "");
        assert_eq!(unit("force_x", ""), "");
    }

    #[test]
    fn large_counts_are_grouped() {
        assert_eq!(plural(1_234_567, "node"), "1\u{202f}234\u{202f}567 nodes");
        assert_eq!(plural(1, "node"), "1 node");
    }
}
