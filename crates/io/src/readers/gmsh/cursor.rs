//! Numbers and section marks, from text and from binary data alike.

use crate::readers::MeshError;
use crate::readers::error::{Place, excerpt};

/// How binary numbers are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Binary {
    /// Whether the most significant byte comes first.
    pub big_endian: bool,
    /// Whether sizes take eight bytes (else four).
    pub wide: bool,
}

/// A place in a file and how to read on from it.
pub(super) struct Cursor<'a> {
    file: &'a str,
    bytes: &'a [u8],
    at: usize,
    start: usize, // of the value read last
    section: &'a str,
    /// `None` in text files.
    pub binary: Option<Binary>,
}

type Result<T> = std::result::Result<T, MeshError>;

const SIZE_RANGE: &str = "0 to 2^63 - 1";

impl<'a> Cursor<'a> {
    pub fn new(file: &'a str, bytes: &'a [u8]) -> Self {
        Self {
            file,
            bytes,
            at: 0,
            start: 0,
            section: "",
            binary: None,
        }
    }

    /// The file as a whole.
    pub fn file(&self) -> Place {
        Place::File(self.file.into())
    }

    /// Where the value read last begins.
    pub fn place(&self) -> Place {
        if self.binary.is_some() {
            return Place::Byte {
                file: self.file.into(),
                offset: self.start,
            };
        }
        let before = self.bytes.get(..self.start).unwrap_or(self.bytes);
        let unix = before.iter().filter(|&&b| b == b'\n').count();
        let line = 1 + if unix == 0 {
            before.iter().filter(|&&b| b == b'\r').count()
        } else {
            unix
        };
        Place::Line {
            file: self.file.into(),
            line,
        }
    }

    /// The number of bytes not read yet.
    pub fn remaining(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// The number of bytes of the file.
    pub fn nbyte(&self) -> usize {
        self.bytes.len()
    }

    /// Steps over these bytes where they come next.
    pub fn accept(&mut self, expected: &[u8]) -> bool {
        let found = self.rest().starts_with(expected);
        if found {
            self.at += expected.len();
        }
        found
    }

    /// What is not read yet.
    pub fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.at..).unwrap_or(&[])
    }

    pub fn skip_space(&mut self) {
        let space = self.rest().iter().take_while(|b| b.is_ascii_whitespace());
        self.at += space.count();
    }

    /// The rest of the line, without its end, which is stepped over.
    pub fn line(&mut self) -> &'a [u8] {
        let rest = self.rest();
        let end = rest.iter().position(|&b| b == b'\n' || b == b'\r');
        let end = end.unwrap_or(rest.len());
        let (line, after) = rest.split_at(end);
        let newline = if after.starts_with(b"\r\n") { 2 } else { 1 };
        self.at += end + newline.min(after.len());
        line
    }

    /// The next word, empty at the end of the file.
    fn word(&mut self) -> &'a [u8] {
        self.skip_space();
        self.start = self.at;
        let rest = self.rest();
        let end = rest.iter().position(u8::is_ascii_whitespace);
        let word = rest.get(..end.unwrap_or(rest.len())).unwrap_or(rest);
        self.at += word.len();
        word
    }

    /// The next word, which must be there.
    pub fn text(&mut self, wanted: &'static str) -> Result<&'a [u8]> {
        let word = self.word();
        if word.is_empty() {
            return Err(self.truncated(wanted));
        }
        Ok(word)
    }

    fn truncated(&self, wanted: &'static str) -> MeshError {
        MeshError::Truncated {
            place: self.place(),
            section: format!("${}", self.section),
            wanted,
        }
    }

    fn not_a_number(&self, wanted: &'static str, found: &[u8]) -> MeshError {
        let hint = if found.starts_with(b"$") {
            ": the section ends before its count is met"
        } else if found.contains(&b',') {
            ": use a decimal point, and spaces between numbers"
        } else {
            ""
        };
        MeshError::NotANumber {
            place: self.place(),
            section: format!("${}", self.section),
            wanted,
            found: excerpt(found),
            hint,
        }
    }

    pub fn out_of_range(
        &self,
        wanted: &'static str,
        found: impl ToString,
        range: &'static str,
    ) -> MeshError {
        MeshError::OutOfRange {
            place: self.place(),
            wanted,
            found: found.to_string(),
            range,
        }
    }

    fn raw<const N: usize>(&mut self, wanted: &'static str) -> Result<[u8; N]> {
        self.start = self.at;
        match self.rest().first_chunk::<N>() {
            Some(bytes) => {
                self.at += N;
                Ok(*bytes)
            }
            None => Err(self.truncated(wanted)),
        }
    }

    /// A whole number written as text, in binary files too.
    pub fn text_int(&mut self, wanted: &'static str) -> Result<i64> {
        let word = self.text(wanted)?;
        let (negative, digits) = match word {
            [b'-', digits @ ..] => (true, digits),
            [b'+', digits @ ..] => (false, digits),
            digits => (false, digits),
        };
        if digits.is_empty() || !digits.iter().all(u8::is_ascii_digit) {
            return Err(self.not_a_number(wanted, word));
        }
        let value = digits.iter().try_fold(0_i64, |sum, d| {
            sum.checked_mul(10)?.checked_add(i64::from(d - b'0'))
        });
        match value {
            Some(value) => Ok(if negative { -value } else { value }),
            None => Err(self.out_of_range(wanted, excerpt(word), "up to 2^63 - 1")),
        }
    }

    /// A whole number (four bytes).
    pub fn int(&mut self, wanted: &'static str) -> Result<i64> {
        let Some(binary) = self.binary else {
            return self.text_int(wanted);
        };
        let raw = self.raw::<4>(wanted)?;
        Ok(i64::from(if binary.big_endian {
            i32::from_be_bytes(raw)
        } else {
            i32::from_le_bytes(raw)
        }))
    }

    /// A whole number that is not negative (in binary, of the width that the header states).
    pub fn size(&mut self, wanted: &'static str) -> Result<u64> {
        let value = match self.binary {
            None => {
                let value = self.text_int(wanted)?;
                u64::try_from(value).map_err(|_| self.out_of_range(wanted, value, SIZE_RANGE))?
            }
            Some(Binary {
                big_endian,
                wide: true,
            }) => {
                let raw = self.raw::<8>(wanted)?;
                if big_endian {
                    u64::from_be_bytes(raw)
                } else {
                    u64::from_le_bytes(raw)
                }
            }
            Some(Binary {
                big_endian,
                wide: false,
            }) => {
                let raw = self.raw::<4>(wanted)?;
                u64::from(if big_endian {
                    u32::from_be_bytes(raw)
                } else {
                    u32::from_le_bytes(raw)
                })
            }
        };
        if value > i64::MAX as u64 {
            return Err(self.out_of_range(wanted, value, SIZE_RANGE));
        }
        Ok(value)
    }

    /// A whole number that is not negative (four bytes).
    pub fn small_size(&mut self, wanted: &'static str) -> Result<u64> {
        let value = self.int(wanted)?;
        u64::try_from(value).map_err(|_| self.out_of_range(wanted, value, SIZE_RANGE))
    }

    /// A real number, perhaps not finite, and how it was written.
    fn real(&mut self, wanted: &'static str) -> Result<f64> {
        let Some(binary) = self.binary else {
            let word = self.text(wanted)?;
            let number = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
            return number.ok_or_else(|| self.not_a_number(wanted, word));
        };
        let raw = self.raw::<8>(wanted)?;
        Ok(if binary.big_endian {
            f64::from_be_bytes(raw)
        } else {
            f64::from_le_bytes(raw)
        })
    }

    /// Reads over `n` real numbers.
    pub fn skip_reals(&mut self, n: u64, wanted: &'static str) -> Result<()> {
        (0..n).try_for_each(|_| self.real(wanted).map(drop))
    }

    /// The coordinates of a node.
    pub fn point(&mut self, node: u64) -> Result<[f64; 3]> {
        let mut x = [0.0; 3];
        for (x, axis) in x.iter_mut().zip(['x', 'y', 'z']) {
            *x = self.real("a coordinate")?;
            if !x.is_finite() {
                let written = self.bytes.get(self.start..self.at).unwrap_or(&[]);
                return Err(MeshError::NotFinite {
                    place: self.place(),
                    node,
                    axis,
                    found: match self.binary {
                        None => excerpt(written),
                        Some(_) => x.to_string(),
                    },
                });
            }
        }
        Ok(x)
    }

    /// Checks that `announced` items of at least `least` bytes each (in text: characters) can still follow.
    pub fn check_count(&self, wanted: &'static str, announced: u64, least: usize) -> Result<usize> {
        let possible = self.remaining().div_ceil(least.max(1));
        match usize::try_from(announced) {
            Ok(count) if count <= possible => Ok(count),
            _ => Err(MeshError::TooMany {
                place: self.place(),
                wanted,
                announced,
                remaining: self.remaining(),
            }),
        }
    }

    /// The fault of a section whose blocks do not hold what it announces.
    pub fn count(&self, what: &'static str, announced: u64, found: u64) -> MeshError {
        MeshError::Count {
            place: self.place(),
            section: self.section.into(),
            what,
            announced,
            found,
        }
    }

    /// The name of the next section, or `None` at the end of the file.
    pub fn open_section(&mut self) -> Result<Option<&'a str>> {
        let word = self.word();
        if word.is_empty() {
            return Ok(None);
        }
        let name = word.strip_prefix(b"$").filter(|name| {
            !name.is_empty()
                && name.len() <= 64
                && !name.starts_with(b"End")
                && name.iter().all(u8::is_ascii_alphanumeric)
        });
        let Some(name) = name.and_then(|name| std::str::from_utf8(name).ok()) else {
            return Err(MeshError::NotASection {
                place: self.place(),
                found: excerpt(word),
            });
        };
        self.line();
        self.section = name;
        Ok(Some(name))
    }

    /// Steps over the mark that ends the section.
    pub fn close_section(&mut self) -> Result<()> {
        let word = self.text("its end mark")?;
        let mark = word.strip_prefix(b"$End");
        if mark != Some(self.section.as_bytes()) {
            return Err(MeshError::SectionEnd {
                place: self.place(),
                section: self.section.into(),
                found: excerpt(word),
            });
        }
        Ok(())
    }

    /// Steps over all of the section and the mark that ends it.
    pub fn skip_section(&mut self) -> Result<()> {
        loop {
            let rest = self.rest();
            let Some(next) = rest.iter().position(|&b| b == b'$') else {
                self.at = self.bytes.len();
                self.start = self.at;
                return Err(self.truncated("its end mark"));
            };
            self.at += next + 1;
            let mark = self.rest().strip_prefix(b"End");
            let after = mark.and_then(|m| m.strip_prefix(self.section.as_bytes()));
            if after.is_some_and(|a| a.first().is_none_or(u8::is_ascii_whitespace)) {
                self.at += "End".len() + self.section.len();
                return Ok(());
            }
        }
    }
}
