//! Numbers packed for a page: differences, bytes by significance, zlib, base64.
//!
//! | kind | content | before zlib |
//! |---|---|---|
//! | `text` | UTF-8 | as it is |
//! | `f32` | reals of 4 bytes | all first bytes, then all second bytes, … |
//! | `u16` | `low + q (high − low) / 65534`, 65535 for no value | differences modulo 2¹⁶, then as above |
//! | `u32` | whole numbers | differences modulo 2³², then as above |
//!
//! All numbers are little-endian. `page.js` unpacks them with the browser's own `DecompressionStream`.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::Write;

/// The number that stands for no value.
const NONE: u16 = u16::MAX;

/// Packed numbers, ready for a page.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Chunk {
    /// `text`, `f32`, `u16` or `u32`.
    pub kind: &'static str,
    /// Base64 of a zlib stream.
    pub text: String,
}

impl Chunk {
    fn new(kind: &'static str, bytes: &[u8]) -> Self {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
        // writing into memory cannot fail
        let written = encoder.write_all(bytes).and_then(|()| encoder.finish());
        Self {
            kind,
            text: STANDARD.encode(written.unwrap_or_default()),
        }
    }

    /// A text.
    #[must_use]
    pub fn text(text: &str) -> Self {
        Self::new("text", text.as_bytes())
    }

    /// Reals of four bytes.
    #[must_use]
    pub fn f32(values: &[f64]) -> Self {
        let words: Vec<[u8; 4]> = values.iter().map(|v| (*v as f32).to_le_bytes()).collect();
        Self::new("f32", &planes(&words))
    }

    /// Reals in 65535 steps from the least to the greatest.
    #[must_use]
    pub fn u16(values: &[f64], [low, high]: [f64; 2]) -> Self {
        let width = high - low;
        let step = |value: &f64| -> u16 {
            if !value.is_finite() {
                return NONE;
            }
            let part = if width > 0.0 {
                (value - low) / width
            } else {
                0.0
            };
            (part.clamp(0.0, 1.0) * f64::from(NONE - 1)).round() as u16
        };
        let mut last = 0_u16;
        let words: Vec<[u8; 2]> = (values.iter())
            .map(|value| {
                let now = step(value);
                let difference = now.wrapping_sub(last);
                last = now;
                difference.to_le_bytes()
            })
            .collect();
        Self::new("u16", &planes(&words))
    }

    /// Whole numbers.
    #[must_use]
    pub fn u32(values: impl Iterator<Item = u32>) -> Self {
        let mut last = 0_u32;
        let words: Vec<[u8; 4]> = values
            .map(|now| {
                let difference = now.wrapping_sub(last);
                last = now;
                difference.to_le_bytes()
            })
            .collect();
        Self::new("u32", &planes(&words))
    }
}

/// All first bytes, then all second bytes, …
fn planes<const N: usize>(words: &[[u8; N]]) -> Vec<u8> {
    let plane = |k: usize| words.iter().filter_map(move |word| word.get(k).copied());
    (0..N).flat_map(plane).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::ZlibDecoder;
    use std::io::Read;

    fn unpacked(chunk: &Chunk) -> Vec<u8> {
        let bytes = STANDARD.decode(&chunk.text).unwrap();
        let mut plain = Vec::new();
        ZlibDecoder::new(bytes.as_slice())
            .read_to_end(&mut plain)
            .unwrap();
        plain
    }

    #[test]
    fn steps_are_closer_to_the_value_than_half_a_step_and_no_value_stays_none() {
        let values = [-1.0, 0.3, f64::NAN, 2.0];
        let chunk = Chunk::u16(&values, [-1.0, 2.0]);
        let bytes = unpacked(&chunk);
        let n = values.len();
        let mut last = 0_u16;
        for (k, value) in values.iter().enumerate() {
            last = last.wrapping_add(u16::from_le_bytes([bytes[k], bytes[n + k]]));
            match value.is_nan() {
                true => assert_eq!(last, NONE),
                false => {
                    let back = -1.0 + f64::from(last) * 3.0 / 65534.0;
                    assert!((back - value).abs() <= 1.5 / 65534.0 + 1e-15);
                }
            }
        }
    }

    #[test]
    fn whole_numbers_in_order_take_next_to_nothing() {
        let chunk = Chunk::u32(0..100_000);
        assert!(chunk.text.len() < 2_000, "{}", chunk.text.len());
        assert_eq!(unpacked(&chunk).len(), 400_000);
    }

    #[test]
    fn a_field_of_one_value_has_no_steps() {
        assert_eq!(unpacked(&Chunk::u16(&[3.0, 3.0], [3.0, 3.0])), [0; 4]);
    }
}
