//! Numbers in columns of fixed width.

use std::io::Write;

/// Exponents that two digits can hold.
const LARGEST: i32 = 99;

/// Beyond this distance from a tie the rounding of a scaled number is certain: its error is a few units in the last
/// place of a number below 10⁶.
const CERTAIN: f64 = 1e-8;

/// Appends a whole number, right-justified in `width` columns, of which there may be 32; one that needs more takes more.
pub(super) fn push_whole(out: &mut Vec<u8>, value: u64, width: usize) {
    let mut digits = [b' '; 32];
    let (mut rest, mut ndigit) = (value, 0);
    for place in digits.iter_mut().rev() {
        *place = b'0' + (rest % 10) as u8;
        rest /= 10;
        ndigit += 1;
        if rest == 0 {
            break;
        }
    }
    let start = digits.len() - width.clamp(ndigit, digits.len());
    out.extend_from_slice(digits.get(start..).unwrap_or_default());
}

/// Appends a number as `%12.5E` writes it: ` 1.23457E-03`, rounded correctly.
///
/// # Limits
/// Two digits of exponent: smaller numbers become zero, larger ones the largest that fits.
pub(super) fn push_real(out: &mut Vec<u8>, value: f64) {
    let size = value.abs();
    if !size.is_finite() {
        let name: &[u8] = if value.is_nan() {
            b"         NaN"
        } else if value > 0.0 {
            b"         Inf"
        } else {
            b"        -Inf"
        };
        out.extend_from_slice(name);
        return;
    }
    let (mantissa, exponent) = six_digits(size);
    let (mantissa, exponent) = match exponent {
        _ if exponent < -LARGEST => (0, 0),
        _ if exponent > LARGEST => (999_999, LARGEST),
        _ => (mantissa, exponent),
    };
    let sign = if value < 0.0 && mantissa > 0 {
        b'-'
    } else {
        b' '
    };
    let digit = |power: u32| b'0' + (mantissa / power % 10) as u8;
    let exponent_sign = if exponent < 0 { b'-' } else { b'+' };
    let size = exponent.unsigned_abs() as u8;
    out.extend_from_slice(&[
        sign,
        digit(100_000),
        b'.',
        digit(10_000),
        digit(1_000),
        digit(100),
        digit(10),
        digit(1),
        b'E',
        exponent_sign,
        b'0' + size / 10,
        b'0' + size % 10,
    ]);
}

/// The six leading digits of a finite number that is not negative, rounded, and the exponent of the first one.
fn six_digits(size: f64) -> (u32, i32) {
    if size == 0.0 {
        return (0, 0);
    }
    let exponent = size.log10().floor() as i32;
    let scaled = size * 10_f64.powi(5 - exponent);
    let nearest = scaled.round();
    let from_tie = ((scaled - nearest).abs() - 0.5).abs();
    if from_tie > CERTAIN && (1e5..1e6).contains(&nearest) {
        (nearest as u32, exponent)
    } else {
        exactly(size)
    }
}

/// The same by exact decimal expansion.
fn exactly(size: f64) -> (u32, i32) {
    let mut text = [0_u8; 24];
    let mut rest = text.as_mut_slice();
    // a number of six digits is never longer
    let _ = write!(rest, "{size:.5e}");
    let length = 24 - rest.len();
    let written = text.get(..length).unwrap_or_default();
    let at = written.iter().position(|&c| c == b'e').unwrap_or(length);
    let (digits, exponent) = written.split_at(at);
    let digits = digits.iter().filter(|c| c.is_ascii_digit());
    let mantissa = digits.fold(0, |n, c| 10 * n + u32::from(c - b'0'));
    let exponent = std::str::from_utf8(exponent.get(1..).unwrap_or_default());
    (
        mantissa,
        exponent.ok().and_then(|e| e.parse().ok()).unwrap_or(0),
    )
}

/// Appends a time in 12 columns with as many digits as they hold: ` 1.000000000`, or as [`push_real`] does.
pub(super) fn push_time(out: &mut Vec<u8>, time: f64) {
    let ndigit = (1..=9).find(|&n| time < 10_f64.powi(n));
    let text = ndigit.map(|n| format!(" {time:.*}", 10 - n as usize));
    match text {
        Some(text) if time >= 1e-3 && text.len() == 12 => out.extend_from_slice(text.as_bytes()),
        _ => push_real(out, time),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn real(value: f64) -> String {
        let mut out = Vec::new();
        push_real(&mut out, value);
        String::from_utf8(out).unwrap()
    }

    /// As the standard library writes it, with two digits of exponent.
    fn slowly(value: f64) -> String {
        let text = format!("{value:.5e}");
        let (mantissa, exponent) = text.split_once('e').unwrap();
        let exponent: i32 = exponent.parse().unwrap();
        format!("{:>12}", format!("{mantissa}E{exponent:+03}"))
    }

    #[test]
    fn numbers_are_rounded_as_the_standard_library_does() {
        let mut bits = 1_u64;
        let mut ntie = 0;
        for _ in 0..400_000 {
            bits = bits
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let value = f64::from_bits(bits);
            let (low, high) = (1e-98, 9.9e98);
            if value.is_finite() && (low..high).contains(&value.abs()) {
                assert_eq!(real(value), slowly(value));
            }
            // seven digits of which the last is 5: half of them are a tie or next to one
            let near = (bits >> 44) as f64 + 0.5;
            for power in [0, -3, -7, 12, 25] {
                let value = near * 10_f64.powi(power);
                assert_eq!(real(value), slowly(value), "{value:e}");
                ntie += 1;
            }
        }
        assert!(ntie > 1_000_000);
        for value in [
            0.0, 1.0, -1.0, 9.999994, 9.999995, 9.999996, 0.1, 1e5, 1e22, 1e-22,
        ] {
            assert_eq!(real(value), slowly(value));
        }
        assert_eq!(real(-0.0), " 0.00000E+00");
    }

    #[test]
    fn numbers_stay_in_their_columns() {
        for value in [1e-100, -3e-250, f64::MIN_POSITIVE, 5e-324] {
            assert_eq!(real(value), " 0.00000E+00");
        }
        assert_eq!(real(-1e100), "-9.99999E+99");
        assert_eq!(real(f64::MAX), " 9.99999E+99");
        assert_eq!(real(9.999_999e99), " 9.99999E+99");
        assert_eq!(real(9.999_999e-100), " 1.00000E-99");
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(real(value).len(), 12);
            assert!(!real(value).trim().parse::<f64>().unwrap().is_finite());
        }
    }

    #[test]
    fn whole_numbers_are_right_justified() {
        let whole = |value, width| {
            let mut out = Vec::new();
            push_whole(&mut out, value, width);
            String::from_utf8(out).unwrap()
        };
        assert_eq!(whole(0, 5), "    0");
        assert_eq!(whole(12_345, 5), "12345");
        assert_eq!(whole(123_456, 5), "123456");
        assert_eq!(whole(u64::MAX, 10), u64::MAX.to_string());
        assert_eq!(whole(7, 26), format!("{:>26}", 7));
    }

    #[test]
    fn times_have_all_digits_that_fit() {
        let time = |value| {
            let mut out = Vec::new();
            push_time(&mut out, value);
            String::from_utf8(out).unwrap()
        };
        assert_eq!(time(1.0), " 1.000000000");
        assert_eq!(time(0.05), " 0.050000000");
        assert_eq!(time(12.5), " 12.50000000");
        assert_eq!(time(123_456_789.0), " 123456789.0");
        assert_eq!(time(0.0), " 0.00000E+00");
        assert_eq!(time(1e-6), " 1.00000E-06");
        for value in [9.999_999_999_9, 999_999_999.99, 1e9, 1e300, -1.0, 0.001] {
            assert_eq!(time(value).len(), 12, "{}", time(value));
        }
    }
}
