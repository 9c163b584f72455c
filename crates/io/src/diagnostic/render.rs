//! Findings as text for terminals and logs.
//!
//! Only the lines that labels mark are handed to the renderer, cut to a window around the label and cleaned of
//! control characters: a megabyte in one line, or bytes that would steer the terminal, cannot spoil a message.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::ops::Range;
use std::sync::Arc;

use codespan_reporting::diagnostic as codespan;
use codespan_reporting::files::{Error, Files};
use codespan_reporting::term::termcolor::{Buffer, WriteColor};
use codespan_reporting::term::{Config, emit_to_write_style};

use super::{Diagnostic, Diagnostics, Label, Severity, SourceFile};

/// As many findings are shown at once.
const SHOWN: usize = 20;
/// Characters of a line that are shown at most before and after the start of a label.
const WINDOW: usize = 100;

impl Diagnostics {
    /// The findings as text without colours.
    pub fn plain(&self) -> String {
        self.rendered(Buffer::no_color())
    }

    /// The findings as text with the colours of a terminal.
    pub fn coloured(&self) -> String {
        self.rendered(Buffer::ansi())
    }

    fn rendered(&self, mut out: Buffer) -> String {
        let shown = self.shown();
        for diagnostic in &shown {
            emit(&mut out, diagnostic);
        }
        let mut text = String::from_utf8_lossy(out.as_slice()).into_owned();
        text.push_str(&self.remainder(&shown));
        text
    }

    /// At most [`SHOWN`] findings, errors first; every kind is among them before any kind is shown twice.
    fn shown(&self) -> Vec<&Diagnostic> {
        let mut order: Vec<usize> = (0..self.list.len()).collect();
        let severity = |at: &usize| self.list.get(*at).map(|one| one.severity);
        order.sort_by_key(severity);
        if order.len() > SHOWN {
            let mut kinds = BTreeSet::new();
            let (first, others): (Vec<usize>, Vec<usize>) = order.iter().partition(|at| {
                self.list
                    .get(**at)
                    .is_some_and(|one| kinds.insert(one.code.id))
            });
            let mut chosen: Vec<usize> = first.into_iter().chain(others).take(SHOWN).collect();
            chosen.sort_unstable();
            chosen.sort_by_key(severity);
            order = chosen;
        }
        order.iter().filter_map(|at| self.list.get(*at)).collect()
    }

    /// One line for each kind of which not all findings are shown.
    fn remainder(&self, shown: &[&Diagnostic]) -> String {
        let mut hidden: BTreeMap<&str, (usize, &str)> = BTreeMap::new();
        for one in &self.list {
            hidden.entry(one.code.id).or_insert((0, one.code.title)).0 += 1;
        }
        for one in shown {
            if let Some((count, _)) = hidden.get_mut(one.code.id) {
                *count -= 1;
            }
        }
        let mut text = String::new();
        for (id, (count, title)) in hidden.iter().filter(|(_, (count, _))| *count > 0) {
            let _ = writeln!(text, "and {count} more of the same kind: {id}, {title}");
        }
        text
    }
}

/// Writes one finding; writing into memory cannot fail, and a label that fits no text is left out.
fn emit(out: &mut Buffer, diagnostic: &Diagnostic) {
    let (files, labels) = Excerpts::of(&diagnostic.labels);
    let severity = match diagnostic.severity {
        Severity::Error => codespan::Severity::Error,
        Severity::Warning => codespan::Severity::Warning,
        Severity::Note => codespan::Severity::Note,
    };
    let helps = diagnostic.help.iter().map(|text| format!("help: {text}"));
    let notes = diagnostic.notes.iter().cloned().chain(helps);
    let rendered = codespan::Diagnostic::new(severity)
        .with_code(diagnostic.code.id)
        .with_message(printable(&diagnostic.message))
        .with_labels(labels)
        .with_notes_iter(notes.map(|text| printable(&text)));
    if emit_to_write_style(out, &Config::default(), &files, &rendered).is_err() {
        let _ = out.reset();
        let _ = std::io::Write::write_all(out, b"\n");
    }
}

/// The text with a visible sign for every control character but the line feed.
fn printable(text: &str) -> String {
    text.chars()
        .map(|c| if c == '\n' { c } else { visible(c) })
        .collect()
}

fn visible(c: char) -> char {
    match c {
        '\t' => ' ',
        c if c.is_control() => char::REPLACEMENT_CHARACTER,
        // Marks that reorder or hide text.
        '\u{200B}'..='\u{200F}' | '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}' => {
            char::REPLACEMENT_CHARACTER
        }
        c => c,
    }
}

/// The marked lines of the marked files.
struct Excerpts(Vec<Excerpt>);

struct Excerpt {
    file: Arc<SourceFile>,
    /// What is shown of the lines, joined by line feeds.
    text: String,
    /// Line counted from zero → where it stands in `text`, and the column its window starts at.
    lines: BTreeMap<usize, (Range<usize>, usize)>,
    /// Offset in `text` of the start of each label → its column in the file, counted from one.
    columns: BTreeMap<usize, usize>,
}

impl Excerpts {
    fn of(labels: &[Label]) -> (Self, Vec<codespan::Label<usize>>) {
        let mut excerpts: Vec<Excerpt> = Vec::new();
        let mut marks = Vec::new();
        for label in labels {
            let known = excerpts
                .iter()
                .position(|one| Arc::ptr_eq(&one.file, &label.file));
            let id = known.unwrap_or_else(|| {
                excerpts.push(Excerpt {
                    file: Arc::clone(&label.file),
                    text: String::new(),
                    lines: BTreeMap::new(),
                    columns: BTreeMap::new(),
                });
                excerpts.len() - 1
            });
            let Some(excerpt) = excerpts.get_mut(id) else {
                continue;
            };
            let span = excerpt.show(label);
            let mark = if marks.is_empty() {
                codespan::Label::primary(id, span)
            } else {
                codespan::Label::secondary(id, span)
            };
            marks.push(mark.with_message(printable(&label.text)));
        }
        (Self(excerpts), marks)
    }
}

impl Excerpt {
    /// Adds the line of a label and returns where the label stands in the excerpt.
    ///
    /// Several labels on one line of ordinary length share it; on a longer one the first label decides which part is shown.
    fn show(&mut self, label: &Label) -> Range<usize> {
        let line = self.file.line_index(label.span.start);
        let whole = self.file.line_range(line);
        let content = self.file.text().get(whole.clone()).unwrap_or_default();
        let start = label.span.start.clamp(whole.start, whole.end) - whole.start;
        let end = label.span.end.clamp(whole.start + start, whole.end) - whole.start;

        let column = content
            .char_indices()
            .take_while(|(at, _)| *at < start)
            .count();
        let known = self.lines.get(&line).cloned();
        let first = known
            .as_ref()
            .map_or(column.saturating_sub(WINDOW), |(_, first)| *first);
        let window = content.char_indices().skip(first).take(2 * WINDOW);
        let Range {
            start: place,
            end: line_end,
        } = known.map_or_else(
            || {
                let place = self.text.len();
                if first > 0 {
                    self.text.push('…');
                }
                self.text.extend(window.clone().map(|(_, c)| visible(c)));
                if content.chars().nth(first + 2 * WINDOW).is_some() {
                    self.text.push('…');
                }
                let range = place..self.text.len();
                self.lines.insert(line, (range.clone(), first));
                self.text.push('\n');
                range
            },
            |(range, _)| range,
        );

        // The offset in the excerpt of the byte `at` of the line.
        let shown = |at: usize| -> usize {
            let mark = if first > 0 { '…'.len_utf8() } else { 0 };
            let before: usize = window
                .clone()
                .take_while(|(offset, _)| *offset < at)
                .map(|(_, c)| visible(c).len_utf8())
                .sum();
            (place + mark + before).min(line_end)
        };
        let span = self.on_boundary(shown(start))..self.on_boundary(shown(end));
        self.columns.insert(span.start, column + 1);
        span
    }

    /// The nearest start of a character at or before `at`.
    fn on_boundary(&self, at: usize) -> usize {
        (0..=at)
            .rev()
            .find(|n| self.text.is_char_boundary(*n))
            .unwrap_or(0)
    }
}

impl<'a> Files<'a> for Excerpts {
    type FileId = usize;
    type Name = &'a str;
    type Source = &'a str;

    fn name(&'a self, id: usize) -> Result<&'a str, Error> {
        Ok(self.0.get(id).ok_or(Error::FileMissing)?.file.name())
    }

    fn source(&'a self, id: usize) -> Result<&'a str, Error> {
        Ok(&self.0.get(id).ok_or(Error::FileMissing)?.text)
    }

    fn line_index(&'a self, id: usize, at: usize) -> Result<usize, Error> {
        let excerpt = self.0.get(id).ok_or(Error::FileMissing)?;
        let holds = |range: &Range<usize>| range.start <= at && at <= range.end;
        let line = excerpt.lines.iter().find(|(_, (range, _))| holds(range));
        line.map(|(line, _)| *line).ok_or(Error::IndexTooLarge {
            given: at,
            max: excerpt.text.len(),
        })
    }

    fn column_number(&'a self, id: usize, _line: usize, at: usize) -> Result<usize, Error> {
        let excerpt = self.0.get(id).ok_or(Error::FileMissing)?;
        Ok(excerpt.columns.get(&at).copied().unwrap_or(1))
    }

    fn line_range(&'a self, id: usize, line: usize) -> Result<Range<usize>, Error> {
        let excerpt = self.0.get(id).ok_or(Error::FileMissing)?;
        // A line between two marked ones, which the renderer asks for, is shown empty.
        Ok(excerpt
            .lines
            .get(&line)
            .map_or(0..0, |(range, _)| range.clone()))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Place, codes};
    use super::*;

    fn contact() -> (Arc<SourceFile>, Diagnostic) {
        let file = SourceFile::new(
            "hertz.toml",
            "[[contact]]\nname = \"tip\"\npenaltty  = 1e5\n",
        );
        let at = file.text().find("penaltty").unwrap();
        let diagnostic = Diagnostic::error(&codes::UNKNOWN_KEY, "unknown key `penaltty`")
            .at(&Place::new(&file, at..at + 8), "did you mean `penalty`?")
            .help("write  enforcement = { penalty = 1e5 }")
            .note("keys of [[contact]]: name, secondary");
        (file, diagnostic)
    }

    #[test]
    fn a_message_shows_place_facts_and_help() {
        let text = Diagnostics::from(contact().1).plain();
        let expected = "\
error[S0102]: unknown key `penaltty`
  ┌─ hertz.toml:3:1
  │
3 │ penaltty  = 1e5
  │ ^^^^^^^^ did you mean `penalty`?
  │
  = keys of [[contact]]: name, secondary
  = help: write  enforcement = { penalty = 1e5 }

";
        assert_eq!(text, expected);
    }

    #[test]
    fn colours_only_add_to_the_text() {
        let all = Diagnostics::from(contact().1);
        let coloured = all.coloured();
        assert!(coloured.contains("\u{1b}["));
        let mut stripped = String::new();
        let mut rest = coloured.as_str();
        while let Some(at) = rest.find('\u{1b}') {
            stripped.push_str(&rest[..at]);
            rest = &rest[at + rest[at..].find('m').unwrap() + 1..];
        }
        stripped.push_str(rest);
        assert_eq!(stripped, all.plain());
    }

    #[test]
    fn twenty_are_shown_and_every_kind_is_among_them() {
        let mut all = Diagnostics::new();
        for n in 0..150 {
            all.push(Diagnostic::error(
                &codes::UNKNOWN_KEY,
                format!("unknown key `k{n}`"),
            ));
        }
        all.push(Diagnostic::warning(&codes::IMPLAUSIBLE, "far off"));
        all.push(Diagnostic::error(&codes::MISSING, "`E` is missing"));
        let text = all.plain();
        assert_eq!(text.matches("error[").count(), 19);
        assert_eq!(text.matches("warning[").count(), 1);
        assert!(text.contains("`E` is missing") && text.contains("far off"));
        assert!(
            text.ends_with("and 132 more of the same kind: S0102, unknown key\n"),
            "{text}"
        );
    }

    #[test]
    fn a_megabyte_in_one_line_is_cut_around_the_label() {
        let text = format!("{}WRONG{}", "é".repeat(500_000), "x".repeat(500_000));
        let file = SourceFile::new("long.toml", text);
        let place = Place::new(&file, 1_000_000..1_000_005);
        let one = Diagnostic::error(&codes::SYNTAX, "odd").at(&place, "here");
        let shown = Diagnostics::from(one).plain();
        assert!(shown.len() < 2_000);
        assert!(shown.contains("long.toml:1:500001"), "{shown}");
        let lines: Vec<&str> = shown.lines().collect();
        let word = lines[3].chars().position(|c| c == 'W').unwrap();
        assert_eq!(
            lines[4].chars().position(|c| c == '^'),
            Some(word),
            "{shown}"
        );
    }

    #[test]
    fn control_characters_do_not_reach_the_terminal() {
        let file = SourceFile::new("evil.toml", "a\u{1b}[2Jb\tc = \u{7}1");
        let one =
            Diagnostic::error(&codes::SYNTAX, "odd \u{1b}[31m").at(&Place::new(&file, 12..13), "");
        let shown = Diagnostics::from(one).plain();
        assert!(
            shown.chars().all(|c| c == '\n' || !c.is_control()),
            "{shown:?}"
        );
    }

    #[test]
    fn labels_may_lie_anywhere() {
        let file = SourceFile::new("odd.toml", "é1\n\nß2\r\nend");
        for start in 0..20 {
            for end in 0..20 {
                let spans = [start..end, end..start, 0..usize::MAX];
                let one = spans
                    .into_iter()
                    .fold(Diagnostic::error(&codes::SYNTAX, "odd"), |one, span| {
                        one.at(&Place::new(&file, span), "here")
                    });
                let shown = Diagnostics::from(one).plain();
                assert!(
                    shown.contains("odd.toml") && shown.contains("here"),
                    "{shown}"
                );
            }
        }
    }
}
