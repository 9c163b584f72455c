//! Bytes as they lie in a file: raw, or in base64.

use std::borrow::Cow;

/// Bytes still to be read.
pub(super) enum Stream<'a> {
    Raw(&'a [u8]),
    /// Sections of base64, each padded on its own, follow each other without a mark; white space does not count.
    Base64 {
        text: &'a [u8],
        held: [u8; 3],
        nheld: usize,
    },
}

impl<'a> Stream<'a> {
    pub fn base64(text: &'a [u8]) -> Self {
        Self::Base64 {
            text,
            held: [0; 3],
            nheld: 0,
        }
    }

    /// No more than this many bytes are left.
    pub fn bound(&self) -> u64 {
        match self {
            Self::Raw(bytes) => bytes.len() as u64,
            Self::Base64 { text, .. } => text.len() as u64 / 4 * 3 + 3,
        }
    }

    /// The next bytes; nothing where there are not so many.
    pub fn take(&mut self, nbyte: u64) -> Option<Cow<'a, [u8]>> {
        if nbyte > self.bound() {
            return None;
        }
        let nbyte = usize::try_from(nbyte).ok()?;
        match self {
            Self::Raw(bytes) => {
                let first;
                (first, *bytes) = bytes.split_at_checked(nbyte)?;
                Some(Cow::Borrowed(first))
            }
            Self::Base64 { text, held, nheld } => {
                let mut out = Vec::with_capacity(nbyte);
                while out.len() < nbyte {
                    if *nheld == 0 {
                        (*held, *nheld) = group(text)?;
                    }
                    let count = (*nheld).min(nbyte - out.len());
                    out.extend_from_slice(held.get(..count)?);
                    held.rotate_left(count % 3);
                    *nheld -= count;
                }
                Some(Cow::Owned(out))
            }
        }
    }
}

/// Four characters, which hold one to three bytes.
fn group(text: &mut &[u8]) -> Option<([u8; 3], usize)> {
    let (mut bits, mut npad) = (0_u32, 0);
    for _ in 0..4 {
        *text = text.trim_ascii_start();
        let (&c, rest) = text.split_first()?;
        *text = rest;
        if npad > 0 && c != b'=' {
            return None;
        }
        let value = match c {
            b'A'..=b'Z' => c - b'A',
            b'a'..=b'z' => c - b'a' + 26,
            b'0'..=b'9' => c - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            b'=' => {
                npad += 1;
                0
            }
            _ => return None,
        };
        bits = bits << 6 | u32::from(value);
    }
    let [_, a, b, c] = bits.to_be_bytes();
    (npad < 3).then_some(([a, b, c], 3 - npad))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_read_over_paddings_and_line_ends() {
        // the vectors of RFC 4648, section 10, one after the other
        let text = b"Zg==Zm8=Zm9v\nZm9vYg==  Zm9vYmE=Zm9vYmFy";
        let all = b"ffofoofoobfoobafoobar";
        for step in 1..=all.len() {
            let mut stream = Stream::base64(text);
            let mut out = Vec::new();
            while out.len() + step <= all.len() {
                out.extend_from_slice(&stream.take(step as u64).unwrap());
            }
            assert_eq!(out, all[..out.len()]);
        }
        let mut stream = Stream::base64(text);
        assert!(stream.take(22).is_none());
        for bad in ["Zg=", "Z===", "Zg=a", "Z!==", "é=="] {
            assert!(Stream::base64(bad.as_bytes()).take(1).is_none(), "{bad}");
        }
    }
}
