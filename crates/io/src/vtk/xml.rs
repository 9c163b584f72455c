//! A small XML scanner and the escaping that goes with it, enough for VTK's files.
//!
//! Limits: no document types, no namespaces, UTF-8 only, elements nested at most [`MAX_DEPTH`] deep.

use std::borrow::Cow;

/// Deepest nesting that is read.
const MAX_DEPTH: usize = 32;

/// What is not well formed, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what} at byte {at}")]
pub struct XmlError {
    /// What is wrong.
    pub what: &'static str,
    /// Where, in bytes from the start.
    pub at: usize,
}

/// One piece of a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Piece<'a> {
    /// `<name key="value">`; an empty element `<name/>` is opened and closed.
    Open(Tag<'a>),
    /// `</name>`
    Close(&'a str),
    /// Text between tags that is not blank.
    Text(Cow<'a, str>),
}

/// A start tag.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Tag<'a> {
    pub name: &'a str,
    attributes: Vec<(&'a str, Cow<'a, str>)>,
}

impl Tag<'_> {
    /// The value of an attribute.
    pub fn get(&self, key: &str) -> Option<&str> {
        self.attributes
            .iter()
            .find(|(k, _)| *k == key)
            .map(|(_, value)| value.as_ref())
    }
}

/// Walks through a document and checks that tags match.
pub(crate) struct Scanner<'a> {
    text: &'a str,
    at: usize,
    open: Vec<&'a str>,
    /// The element just opened was `<name/>`.
    pending_close: bool,
    seen_root: bool,
}

impl<'a> Scanner<'a> {
    pub fn new(text: &'a str) -> Self {
        Self {
            text,
            at: 0,
            open: Vec::new(),
            pending_close: false,
            seen_root: false,
        }
    }

    /// The next piece; `None` at the end of a well-formed document.
    pub fn piece(&mut self) -> Result<Option<Piece<'a>>, XmlError> {
        if self.pending_close {
            self.pending_close = false;
            return Ok(self.open.pop().map(Piece::Close));
        }
        loop {
            let rest = self.rest();
            if rest.is_empty() {
                return match self.open.is_empty() && self.seen_root {
                    true => Ok(None),
                    false => self.fail("the document ends inside an element"),
                };
            }
            if let Some(after) = rest.strip_prefix("<?") {
                self.skip_past(after, "?>")?;
            } else if let Some(after) = rest.strip_prefix("<!--") {
                self.skip_past(after, "-->")?;
            } else if let Some(after) = rest.strip_prefix("</") {
                let end = after.find('>').ok_or(self.error("a tag without end"))?;
                let name = after.get(..end).unwrap_or_default().trim_end();
                if self.open.pop() != Some(name) {
                    return self.fail("a closing tag that closes nothing");
                }
                self.at += 2 + end + 1;
                return Ok(Some(Piece::Close(name)));
            } else if rest.starts_with('<') {
                return self.tag().map(|tag| Some(Piece::Open(tag)));
            } else {
                let end = rest.find('<').unwrap_or(rest.len());
                let text = rest.get(..end).unwrap_or_default();
                if text.trim().is_empty() {
                    self.at += end;
                    continue;
                }
                if self.open.is_empty() {
                    return self.fail("text outside of the root element");
                }
                let text = unescape(text).ok_or(self.error("an unknown entity"))?;
                self.at += end;
                return Ok(Some(Piece::Text(text)));
            }
        }
    }

    fn rest(&self) -> &'a str {
        self.text.get(self.at..).unwrap_or_default()
    }

    fn error(&self, what: &'static str) -> XmlError {
        XmlError { what, at: self.at }
    }

    fn fail<T>(&self, what: &'static str) -> Result<T, XmlError> {
        Err(self.error(what))
    }

    fn skip_past(&mut self, after: &str, end: &str) -> Result<(), XmlError> {
        let length = after.find(end).ok_or(self.error("a comment without end"))?;
        let prefix = self.rest().len() - after.len();
        self.at += prefix + length + end.len();
        Ok(())
    }

    /// Reads `<name key="value" ...>` or `<name .../>`.
    fn tag(&mut self) -> Result<Tag<'a>, XmlError> {
        if self.open.is_empty() && self.seen_root {
            return self.fail("a second root element");
        }
        if self.open.len() >= MAX_DEPTH {
            return self.fail("elements nested too deep");
        }
        self.at += 1;
        let name = self.name()?;
        let mut attributes: Vec<(&str, Cow<str>)> = Vec::new();
        loop {
            let blanks = self.rest().len() - self.rest().trim_start().len();
            self.at += blanks;
            let rest = self.rest();
            if rest.starts_with("/>") || rest.starts_with('>') {
                self.pending_close = rest.starts_with('/');
                self.at += if self.pending_close { 2 } else { 1 };
                self.open.push(name);
                self.seen_root = true;
                return Ok(Tag { name, attributes });
            }
            if blanks == 0 {
                return self.fail("a tag without end");
            }
            let key = self.name()?;
            let quote = match self.rest().strip_prefix('=').and_then(|r| r.chars().next()) {
                Some(quote @ ('"' | '\'')) => quote,
                _ => return self.fail("an attribute without quoted value"),
            };
            self.at += 2;
            let end = self
                .rest()
                .find(quote)
                .ok_or(self.error("an attribute without end"))?;
            let raw = self.rest().get(..end).unwrap_or_default();
            if raw.contains('<') {
                return self.fail("'<' inside an attribute");
            }
            let value = unescape(raw).ok_or(self.error("an unknown entity"))?;
            if attributes.iter().any(|(k, _)| *k == key) {
                return self.fail("an attribute given twice");
            }
            attributes.push((key, value));
            self.at += end + 1;
        }
    }

    fn name(&mut self) -> Result<&'a str, XmlError> {
        let rest = self.rest();
        let end = rest
            .find(|c: char| !(c.is_alphanumeric() || "_-.:".contains(c)))
            .unwrap_or(rest.len());
        match rest.get(..end) {
            Some(name) if name.starts_with(|c: char| c.is_alphabetic() || c == '_') => {
                self.at += end;
                Ok(name)
            }
            _ => self.fail("a name was expected"),
        }
    }
}

/// Text as it may stand in an attribute. Characters that XML cannot hold become U+FFFD.
pub(crate) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\t' => out.push_str("&#9;"),
            '\n' => out.push_str("&#10;"),
            '\r' => out.push_str("&#13;"),
            '\0'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// The text that [`escape`] was given; `None` for an entity that XML does not have.
fn unescape(text: &str) -> Option<Cow<'_, str>> {
    if !text.contains('&') {
        return Some(Cow::Borrowed(text));
    }
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('&') {
        let (entity, tail) = after.split_once(';')?;
        out.push_str(before);
        out.push(match entity {
            "amp" => '&',
            "lt" => '<',
            "gt" => '>',
            "quot" => '"',
            "apos" => '\'',
            _ => {
                let digits = entity.strip_prefix('#')?;
                let code = match digits.strip_prefix('x') {
                    Some(hex) => u32::from_str_radix(hex, 16),
                    None => digits.parse(),
                };
                char::from_u32(code.ok()?)?
            }
        });
        rest = tail;
    }
    out.push_str(rest);
    Some(Cow::Owned(out))
}

/// Reads a document to its end; the error names the fault.
#[cfg(test)]
pub(crate) fn assert_well_formed(text: &str) {
    let mut scanner = Scanner::new(text);
    loop {
        match scanner.piece() {
            Ok(Some(_)) => {}
            Ok(None) => return,
            Err(error) => panic!("{error}:\n{text}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pieces(text: &str) -> Result<usize, XmlError> {
        let mut scanner = Scanner::new(text);
        let mut n = 0;
        while scanner.piece()?.is_some() {
            n += 1;
        }
        Ok(n)
    }

    #[test]
    fn escaping_is_undone_by_unescaping() {
        for text in [
            "",
            "plain",
            "a<b>&\"c\"'d'",
            "tab\tline\nreturn\r",
            "größe µ 漢 🦀",
            "&amp;",
        ] {
            assert_eq!(unescape(&escape(text)).unwrap(), text);
        }
        assert_eq!(escape("a\u{1}b\0"), "a\u{fffd}b\u{fffd}");
    }

    #[test]
    fn a_document_is_walked_piece_by_piece() {
        let mut scanner = Scanner::new(
            "<?xml version=\"1.0\"?>\n<a k=\"1 &lt; 2\" l='x'>\n <!-- no --> <b/>t&amp;u</a>\n",
        );
        let Some(Piece::Open(tag)) = scanner.piece().unwrap() else {
            panic!()
        };
        assert_eq!(
            (tag.name, tag.get("k"), tag.get("l"), tag.get("m")),
            ("a", Some("1 < 2"), Some("x"), None)
        );
        assert!(matches!(scanner.piece().unwrap(), Some(Piece::Open(tag)) if tag.name == "b"));
        assert_eq!(scanner.piece().unwrap(), Some(Piece::Close("b")));
        assert_eq!(scanner.piece().unwrap(), Some(Piece::Text("t&u".into())));
        assert_eq!(scanner.piece().unwrap(), Some(Piece::Close("a")));
        assert_eq!(scanner.piece().unwrap(), None);
    }

    #[test]
    fn what_is_not_well_formed_is_refused() {
        let bad = [
            "",
            "<a>",
            "<a",
            "</a>",
            "<a></b>",
            "<a/><b/>",
            "x<a/>",
            "<a/>x",
            "<a k=1/>",
            "<a k=\"1/>",
            "<a k=\"<\"/>",
            "<a k=\"1\" k=\"2\"/>",
            "<a>&nope;</a>",
            "<a>&#xD800;</a>",
            "<a k=\"1\"l=\"2\"/>",
            "< a/>",
            "<1/>",
            "<a><!-- </a>",
        ];
        for text in bad {
            assert!(pieces(text).is_err(), "{text:?} was accepted");
        }
        assert!(
            pieces(&("<a>".repeat(40) + &"</a>".repeat(40))).is_err(),
            "depth is limited"
        );
    }
}
