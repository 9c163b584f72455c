//! Damaged texts for tests: bytes, tokens and lines changed, lost, doubled or moved, from a seed.

/// A small generator of numbers (xorshift64*, Marsaglia 2003 with the multiplier of Vigna 2016).
#[derive(Clone, Debug)]
pub struct Generator(u64);

impl Generator {
    /// Starts from a seed; every seed gives another sequence.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    /// The next number.
    pub fn draw(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 16
    }

    /// A number below `end`; zero where `end` is.
    pub fn below(&mut self, end: usize) -> usize {
        if end == 0 {
            0
        } else {
            (self.draw() % end as u64) as usize
        }
    }

    fn pick<'a>(&mut self, words: &[&'a str]) -> &'a str {
        let at = self.below(words.len());
        words.get(at).copied().unwrap_or_default()
    }
}

const TOKENS: &[&str] = &[
    "=",
    "[",
    "]",
    "[[",
    "]]",
    "{",
    "}",
    ",",
    ".",
    "\"",
    "'",
    "\"\"\"",
    "#",
    "\n",
    "\r",
    "\r\n",
    "\t",
    "-",
    "+",
    "0",
    "-1",
    "1e400",
    "nan",
    "-inf",
    "1e-320",
    "0,3",
    "9223372036854775808",
    "0x7f",
    "1979-05-27",
    "true",
    "false",
    "\"\"",
    "[]",
    "{}",
    "[[]]",
    "\"all\"",
    "\"auto\"",
    "\u{0}",
    "\u{FEFF}",
    "é",
    "\u{202E}",
    "\\u0000",
    "name",
    "format",
    "a.b.c",
];

/// A damaged copy of `bytes`: one to four changes.
pub fn mutate(bytes: &[u8], generator: &mut Generator) -> Vec<u8> {
    let mut out = bytes.to_vec();
    for _ in 0..=generator.below(4) {
        match generator.below(3) {
            0 => change_byte(&mut out, generator),
            1 => change_token(&mut out, generator),
            _ => change_line(&mut out, generator),
        }
    }
    out
}

fn change_byte(bytes: &mut Vec<u8>, generator: &mut Generator) {
    let at = generator.below(bytes.len() + 1);
    match generator.below(4) {
        0 => bytes.truncate(at),
        1 if at < bytes.len() => {
            bytes.remove(at);
        }
        2 => bytes.insert(at, generator.draw() as u8),
        _ => {
            if let Some(byte) = bytes.get_mut(at) {
                *byte ^= 1 << generator.below(8);
            }
        }
    }
}

fn change_token(bytes: &mut Vec<u8>, generator: &mut Generator) {
    let is_word = |byte: &u8| byte.is_ascii_alphanumeric() || b"._-+\"".contains(byte);
    let at = generator.below(bytes.len() + 1);
    let after = |bytes: &[u8]| {
        bytes
            .iter()
            .skip(at)
            .position(|byte| !is_word(byte))
            .map_or(bytes.len(), |n| at + n)
    };
    let end = after(bytes);
    let start = bytes
        .iter()
        .take(at)
        .rposition(|byte| !is_word(byte))
        .map_or(0, |n| n + 1);
    let token = generator.pick(TOKENS).bytes();
    if generator.below(2) == 0 {
        bytes.splice(start..end, token);
    } else {
        bytes.splice(at..at, token);
    }
}

fn change_line(bytes: &mut Vec<u8>, generator: &mut Generator) {
    let mut lines: Vec<Vec<u8>> = bytes
        .split(|byte| *byte == b'\n')
        .map(<[u8]>::to_vec)
        .collect();
    let from = generator.below(lines.len());
    let to = generator.below(lines.len());
    match generator.below(3) {
        0 => {
            lines.remove(from);
        }
        1 => {
            let line = lines.get(from).cloned().unwrap_or_default();
            lines.insert(to, line);
        }
        _ => lines.swap(from, to),
    }
    *bytes = lines.join(&b'\n');
}
