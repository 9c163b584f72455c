//! Rust source as words and signs with their lines; comments, strings, characters, lifetimes and numbers are left out.

/// A word, `::`, or a single sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Token<'a> {
    /// Its text; a raw identifier is without `r#`.
    pub text: &'a str,
    /// The line on which it stands, from 1.
    pub line: usize,
}

impl Token<'_> {
    /// Whether it is an identifier or a keyword.
    pub fn is_word(&self) -> bool {
        self.text.starts_with(starts_word)
    }
}

/// Splits a source text.
pub(super) fn tokens(source: &str) -> Vec<Token<'_>> {
    let mut scanner = Scanner {
        rest: source,
        line: 1,
    };
    let mut out = Vec::new();
    while let Some(first) = scanner.rest.chars().next() {
        let line = scanner.line;
        if let Some(text) = scanner.next(first) {
            out.push(Token { text, line });
        }
    }
    out
}

fn starts_word(c: char) -> bool {
    c == '_' || c.is_alphabetic()
}

fn goes_on(c: char) -> bool {
    c == '_' || c.is_alphanumeric()
}

struct Scanner<'a> {
    rest: &'a str,
    line: usize,
}

impl<'a> Scanner<'a> {
    /// Takes one piece that starts with `first`; returns it where it counts.
    fn next(&mut self, first: char) -> Option<&'a str> {
        if self.rest.starts_with("//") {
            let end = self.rest.find('\n').unwrap_or(self.rest.len());
            self.take(end);
            None
        } else if self.rest.starts_with("/*") {
            self.block_comment();
            None
        } else if first == '"' {
            self.string();
            None
        } else if first == '\'' {
            self.character_or_lifetime();
            None
        } else if starts_word(first) {
            self.word()
        } else if first.is_ascii_digit() {
            self.run();
            None
        } else if self.rest.starts_with("::") {
            Some(self.take(2))
        } else {
            let text = self.take(first.len_utf8());
            (!first.is_whitespace()).then_some(text)
        }
    }

    /// Moves `n` bytes on, `n` at most up to the end and between characters.
    fn take(&mut self, n: usize) -> &'a str {
        let (taken, rest) = self.rest.split_at(n.min(self.rest.len()));
        self.line += taken.matches('\n').count();
        self.rest = rest;
        taken
    }

    fn run(&mut self) -> &'a str {
        let end = self.rest.find(|c| !goes_on(c)).unwrap_or(self.rest.len());
        self.take(end)
    }

    /// An identifier or keyword, unless it turns out to be the prefix of a literal.
    fn word(&mut self) -> Option<&'a str> {
        let text = self.run();
        let hashes = self.rest.len() - self.rest.trim_start_matches('#').len();
        let quoted = self.rest[hashes..].starts_with('"');
        match text {
            "r" | "br" | "cr" if quoted => {
                self.take(hashes + 1);
                let end = format!("\"{}", "#".repeat(hashes));
                let n = self
                    .rest
                    .find(&end)
                    .map_or(self.rest.len(), |at| at + end.len());
                self.take(n);
                None
            }
            "b" | "c" if quoted && hashes == 0 => {
                self.string();
                None
            }
            "b" if self.rest.starts_with('\'') => {
                self.character_or_lifetime();
                None
            }
            "r" if hashes == 1 => {
                self.take(1);
                Some(self.run())
            }
            _ => Some(text),
        }
    }

    fn string(&mut self) {
        self.take(1);
        let mut escaped = false;
        let end = self.rest.find(|c| {
            let closes = c == '"' && !escaped;
            escaped = c == '\\' && !escaped;
            closes
        });
        self.take(end.map_or(self.rest.len(), |at| at + 1));
    }

    fn block_comment(&mut self) {
        let mut depth = 0usize;
        loop {
            if self.rest.starts_with("/*") {
                depth += 1;
                self.take(2);
            } else if self.rest.starts_with("*/") {
                depth -= 1;
                self.take(2);
            } else {
                let Some(c) = self.rest.chars().next() else {
                    return;
                };
                self.take(c.len_utf8());
            }
            if depth == 0 {
                return;
            }
        }
    }

    fn character_or_lifetime(&mut self) {
        self.take(1);
        let mut ahead = self.rest.chars();
        let (first, second) = (ahead.next(), ahead.next());
        if first == Some('\\') {
            let escape = 1 + second.map_or(0, char::len_utf8);
            self.take(escape);
            let end = self.rest.find('\'').map_or(self.rest.len(), |at| at + 1);
            self.take(end);
        } else if second == Some('\'') {
            self.take(first.map_or(0, char::len_utf8) + 1);
        } else {
            self.run();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(source: &str) -> Vec<&str> {
        tokens(source).iter().map(|t| t.text).collect()
    }

    #[test]
    fn words_and_signs_stay_with_their_lines() {
        let found = tokens("use a::b;\n\nfn c() {}");
        let at = |i: usize| (found[i].text, found[i].line);
        assert_eq!(at(0), ("use", 1));
        assert_eq!(at(2), ("::", 1));
        assert_eq!(at(5), ("fn", 3));
        assert_eq!(found.len(), 11);
    }

    #[test]
    fn comments_are_left_out_and_nest() {
        assert_eq!(texts("a // use b\n/* c /* d */ e */ f"), ["a", "f"]);
        assert_eq!(texts("/// [`crate::x`]\nfn"), ["fn"]);
    }

    #[test]
    fn literals_are_left_out() {
        assert_eq!(
            texts(r#"a("crate::x \" crate::y", b"z", 1.5e3)"#).concat(),
            "a(,,.)"
        );
        assert_eq!(texts("r#\"crate::x \" y\"# z"), ["z"]);
        assert_eq!(texts(r"'a' '\'' '\u{1F600}' b'\n' 'b"), [""; 0]);
        assert_eq!(texts("&'static str"), ["&", "str"]);
        assert_eq!(texts("r#type::x"), ["type", "::", "x"]);
    }

    #[test]
    fn lines_count_on_through_literals() {
        assert_eq!(tokens("\"a\nb\"\n/*\n*/ c")[0].line, 4);
    }

    #[test]
    fn what_is_cut_off_ends() {
        for source in ["\"abc", "/* abc", "'", "'\\", "r#\"abc", "b'", "r#"] {
            let _ = tokens(source);
        }
    }
}
