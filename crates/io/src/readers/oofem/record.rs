//! A record: its words, and the fields that keywords name among them.

use super::fault::{Fault, RecordError, shown};
use crate::diagnostic::{Place, SourceFile};
use std::ops::Range;
use std::sync::Arc;

/// A record of a deck: a line, or several that a backslash joins.
///
/// A field is found by its keyword, wherever it stands. What nobody has asked for by the end is an error of the
/// translation: see [`Record::unread`].
#[derive(Clone, Debug)]
pub struct Record {
    file: Arc<SourceFile>,
    words: Vec<Range<usize>>,
    read: Vec<bool>,
}

impl Record {
    /// The record of these stretches of a text.
    pub(super) fn new(file: &Arc<SourceFile>, stretches: &[Range<usize>]) -> Self {
        let mut words = Vec::new();
        for stretch in stretches {
            split(file.text(), stretch.clone(), &mut words);
        }
        Self {
            file: Arc::clone(file),
            read: vec![false; words.len()],
            words,
        }
    }

    /// A word; empty where there is none.
    fn word(&self, at: usize) -> &str {
        let range = self.words.get(at).cloned().unwrap_or_default();
        self.file.text().get(range).unwrap_or_default()
    }

    /// The place of a word; of the first where there is none.
    fn place_of(&self, at: usize) -> Place {
        let range = self.words.get(at).or_else(|| self.words.first());
        range.map_or_else(Place::nowhere, |range| {
            Place::new(&self.file, range.clone())
        })
    }

    /// Where it stands.
    #[must_use]
    pub fn place(&self) -> Place {
        self.place_of(0)
    }

    /// Its first word, in lower case.
    #[must_use]
    pub fn kind(&self) -> String {
        self.word(0).to_lowercase()
    }

    /// Its number, the second word.
    ///
    /// # Errors
    /// There is none.
    pub fn number(&mut self) -> Result<u64, Fault> {
        self.mark(0, 2);
        self.whole_at(1, "the number")
    }

    /// How many words it has.
    #[must_use]
    pub fn len(&self) -> usize {
        self.words.len()
    }

    /// Whether it has no words.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.words.is_empty()
    }

    fn mark(&mut self, from: usize, count: usize) {
        for read in self.read.iter_mut().skip(from).take(count) {
            *read = true;
        }
    }

    /// The first word counts as read.
    pub fn take_kind(&mut self) {
        self.mark(0, 1);
    }

    fn find(&self, keyword: &str) -> Option<usize> {
        let is_it = |at: &usize| self.word(*at).eq_ignore_ascii_case(keyword);
        (0..self.words.len()).find(is_it)
    }

    /// Whether a keyword is there. It and nothing else counts as read.
    pub fn flag(&mut self, keyword: &str) -> bool {
        let found = self.find(keyword);
        if let Some(at) = found {
            self.mark(at, 1);
        }
        found.is_some()
    }

    /// The place of a keyword; of the record where it is not there.
    #[must_use]
    pub fn place_of_field(&self, keyword: &str) -> Place {
        self.place_of(self.find(keyword).unwrap_or(0))
    }

    fn fault(&self, at: usize, error: RecordError) -> Fault {
        Fault {
            place: self.place_of(at.min(self.words.len().saturating_sub(1))),
            error,
        }
    }

    /// A fault of the whole record.
    #[must_use]
    pub fn wrong(&self, error: RecordError) -> Fault {
        self.fault(0, error)
    }

    /// A fault of a field.
    #[must_use]
    pub fn wrong_field(&self, keyword: &str, error: RecordError) -> Fault {
        self.fault(self.find(keyword).unwrap_or(0), error)
    }

    fn not_a_number(&self, at: usize, keyword: &str, wanted: &'static str) -> Fault {
        if at >= self.words.len() {
            let error = RecordError::Short {
                keyword: keyword.to_owned(),
                wanted: 1,
                found: 0,
            };
            return self.fault(at, error);
        }
        let error = RecordError::NotANumber {
            keyword: keyword.to_owned(),
            found: shown(self.word(at)),
            wanted,
        };
        self.fault(at, error)
    }

    fn whole_at(&self, at: usize, keyword: &str) -> Result<u64, Fault> {
        let number = self.word(at).parse();
        number.map_err(|_| self.not_a_number(at, keyword, "a whole number"))
    }

    fn real_at(&self, at: usize, keyword: &str) -> Result<f64, Fault> {
        let number = self.word(at).parse::<f64>().ok().filter(|v| v.is_finite());
        number.ok_or_else(|| self.not_a_number(at, keyword, "a finite number"))
    }

    /// A whole number.
    ///
    /// # Errors
    /// Something else stands there.
    pub fn whole(&mut self, keyword: &str) -> Result<Option<u64>, Fault> {
        self.one(keyword, Self::whole_at)
    }

    /// A whole number that must be there.
    ///
    /// # Errors
    /// It is not.
    pub fn need_whole(&mut self, keyword: &'static str) -> Result<u64, Fault> {
        let found = self.whole(keyword)?;
        found.ok_or_else(|| self.wrong(RecordError::Missing { keyword }))
    }

    /// A real number.
    ///
    /// # Errors
    /// Something else stands there, or it is not finite.
    pub fn real(&mut self, keyword: &str) -> Result<Option<f64>, Fault> {
        self.one(keyword, Self::real_at)
    }

    /// A real number that must be there.
    ///
    /// # Errors
    /// It is not.
    pub fn need_real(&mut self, keyword: &'static str) -> Result<f64, Fault> {
        let found = self.real(keyword)?;
        found.ok_or_else(|| self.wrong(RecordError::Missing { keyword }))
    }

    fn one<T>(
        &mut self,
        keyword: &str,
        at: impl Fn(&Self, usize, &str) -> Result<T, Fault>,
    ) -> Result<Option<T>, Fault> {
        let Some(found) = self.find(keyword) else {
            return Ok(None);
        };
        self.mark(found, 2);
        at(self, found + 1, keyword).map(Some)
    }

    /// A list of whole numbers: its length, then its entries.
    ///
    /// # Errors
    /// It is shorter than its length, or something else stands there.
    pub fn wholes(&mut self, keyword: &str) -> Result<Option<Vec<u64>>, Fault> {
        self.list(keyword, Self::whole_at)
    }

    /// A list of whole numbers that must be there.
    ///
    /// # Errors
    /// It is not.
    pub fn need_wholes(&mut self, keyword: &'static str) -> Result<Vec<u64>, Fault> {
        let found = self.wholes(keyword)?;
        found.ok_or_else(|| self.wrong(RecordError::Missing { keyword }))
    }

    /// A list of real numbers.
    ///
    /// # Errors
    /// It is shorter than its length, or something else stands there.
    pub fn reals(&mut self, keyword: &str) -> Result<Option<Vec<f64>>, Fault> {
        self.list(keyword, Self::real_at)
    }

    /// A list of real numbers that must be there.
    ///
    /// # Errors
    /// It is not.
    pub fn need_reals(&mut self, keyword: &'static str) -> Result<Vec<f64>, Fault> {
        let found = self.reals(keyword)?;
        found.ok_or_else(|| self.wrong(RecordError::Missing { keyword }))
    }

    fn list<T>(
        &mut self,
        keyword: &str,
        at: impl Fn(&Self, usize, &str) -> Result<T, Fault>,
    ) -> Result<Option<Vec<T>>, Fault> {
        let Some(found) = self.find(keyword) else {
            return Ok(None);
        };
        let count = self.whole_at(found + 1, keyword)?;
        let first = found + 2;
        let there = self.words.len().saturating_sub(first);
        // the count is believed only as far as the record goes
        let Some(count) = usize::try_from(count).ok().filter(|n| *n <= there) else {
            let error = RecordError::Short {
                keyword: keyword.to_owned(),
                wanted: count,
                found: there,
            };
            return Err(self.fault(found, error));
        };
        self.mark(found, count + 2);
        let entries = (first..first + count).map(|entry| at(self, entry, keyword));
        entries.collect::<Result<Vec<_>, _>>().map(Some)
    }

    /// A list of ranges, `{1 4 (7 12)}`: single numbers, and the first and last of several.
    ///
    /// # Errors
    /// Something else stands there.
    pub fn ranges(&mut self, keyword: &str) -> Result<Option<Vec<[u64; 2]>>, Fault> {
        let Some(found) = self.find(keyword) else {
            return Ok(None);
        };
        self.mark(found, 2);
        let wrong = || self.not_a_number(found + 1, keyword, "a list such as {1 4 (7 12)}");
        let inside = self.word(found + 1).strip_prefix('{');
        let inside = inside.and_then(|rest| rest.strip_suffix('}'));
        let spaced = inside.ok_or_else(wrong)?.replace('(', " ( ");
        let spaced = spaced.replace(')', " ) ");
        let mut ranges = Vec::new();
        let mut open: Option<Vec<u64>> = None;
        for word in spaced.split_whitespace() {
            match (word, &mut open) {
                ("(", None) => open = Some(Vec::new()),
                (")", Some(ends)) => match ends[..] {
                    [first, last] if first <= last => {
                        ranges.push([first, last]);
                        open = None;
                    }
                    _ => return Err(wrong()),
                },
                (number, Some(ends)) => ends.push(number.parse().map_err(|_| wrong())?),
                (number, None) => {
                    let number = number.parse().map_err(|_| wrong())?;
                    ranges.push([number, number]);
                }
            }
        }
        if open.is_some() {
            return Err(wrong());
        }
        Ok(Some(ranges))
    }

    /// A word, or a text without its quotes or dollars.
    ///
    /// # Errors
    /// The record ends before it.
    pub fn text(&mut self, keyword: &str) -> Result<Option<(String, Place)>, Fault> {
        self.one(keyword, |record, at, keyword| {
            let word = record.word(at);
            if word.is_empty() {
                return Err(record.not_a_number(at, keyword, "a text"));
            }
            let quoted = |mark: char| word.strip_prefix(mark)?.strip_suffix(mark);
            let bare = quoted('"').or_else(|| quoted('$')).unwrap_or(word);
            Ok((bare.to_owned(), record.place_of(at)))
        })
    }

    /// Steps over a field that changes no result here: its keyword, and as many words behind it.
    pub fn ignore(&mut self, keyword: &str, words: usize) {
        if let Some(at) = self.find(keyword) {
            self.mark(at, words + 1);
        }
    }

    /// All of it counts as read.
    pub fn ignore_all(&mut self) {
        self.mark(0, usize::MAX);
    }

    /// Words that nobody has asked for, in stretches: each with its place.
    pub fn unread(&self) -> impl Iterator<Item = (String, Place)> + '_ {
        let is_first = |at: &usize| !self.read[*at] && (*at == 0 || self.read[*at - 1]);
        let stretches = (0..self.words.len()).filter(is_first);
        stretches.map(|at| (shown(self.word(at)), self.place_of(at)))
    }
}

/// Words of a stretch of a text: `"…"`, `{…}` and `$…$` are one word each.
fn split(text: &str, stretch: Range<usize>, words: &mut Vec<Range<usize>>) {
    let bytes = text.as_bytes();
    let byte = |at: usize| bytes.get(at).copied().unwrap_or(b' ');
    let mut at = stretch.start;
    while at < stretch.end {
        if byte(at).is_ascii_whitespace() {
            at += 1;
            continue;
        }
        let close = match byte(at) {
            b'"' => Some(b'"'),
            b'{' => Some(b'}'),
            b'$' => Some(b'$'),
            _ => None,
        };
        let start = at;
        at += 1;
        match close {
            Some(close) => {
                while at < stretch.end && byte(at) != close {
                    at += 1;
                }
                at = (at + 1).min(stretch.end);
            }
            None => {
                while at < stretch.end && !byte(at).is_ascii_whitespace() {
                    at += 1;
                }
            }
        }
        words.push(start..at);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(text: &str) -> Record {
        let file = SourceFile::new("job.in", text);
        let whole = 0..text.len();
        Record::new(&file, &[whole])
    }

    #[test]
    fn fields_are_found_wherever_they_stand() {
        let mut one = record("Node 7 coords 3 1.0 .5 -2.e1 bc 2 0 1 LOAD 1 4");
        assert_eq!((one.kind().as_str(), one.number().unwrap()), ("node", 7));
        assert_eq!(one.wholes("load").unwrap(), Some(vec![4]));
        assert_eq!(one.reals("coords").unwrap(), Some(vec![1.0, 0.5, -20.0]));
        assert_eq!(one.whole("lcs").unwrap(), None);
        let unread: Vec<String> = one.unread().map(|(word, _)| word).collect();
        assert_eq!(unread, ["bc"]);
        assert_eq!(one.wholes("bc").unwrap(), Some(vec![0, 1]));
        assert_eq!(one.unread().count(), 0);
    }

    #[test]
    fn texts_expressions_and_ranges_are_one_word_each() {
        let mut one = record("f 1 f(t) $ 2 * t $ name \"A b\" list {1 4 (7 12)}");
        assert_eq!(one.text("f(t)").unwrap().unwrap().0, " 2 * t ");
        assert_eq!(one.text("name").unwrap().unwrap().0, "A b");
        let ranges = one.ranges("list").unwrap();
        assert_eq!(ranges, Some(vec![[1, 1], [4, 4], [7, 12]]));
        for wrong in [
            "l {1",
            "l 3",
            "l {(1 2}",
            "l {(3 1)}",
            "l {(1 2 3)}",
            "l {a}",
        ] {
            assert!(record(wrong).ranges("l").is_err(), "{wrong}");
        }
    }

    #[test]
    fn counts_are_believed_only_as_far_as_the_record_goes() {
        let mut one = record("set 1 nodes 99999999999 1 2");
        let message = one.wholes("nodes").unwrap_err().error.to_string();
        assert_eq!(
            message,
            "the list of `nodes` is announced to have 99999999999 entries, but the record ends after 2"
        );
        let message = record("a k 1.5").whole("k").unwrap_err().error.to_string();
        assert_eq!(message, "`1.5` stands where a whole number of `k` should");
        assert!(record("a k 1e400").real("k").is_err());
        assert!(record("a k").real("k").is_err());
    }
}
