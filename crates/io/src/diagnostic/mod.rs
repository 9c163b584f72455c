//! What the program reports to users about their input: faults, their places, and remedies.
//!
//! ```text
//! error[S0102]: unknown key `penaltty`                      severity, code, message
//!    ┌─ hertz.toml:24:1
//!    │
//! 24 │ penaltty  = 1e5
//!    │ ^^^^^^^^ did you mean `penalty`?                       label: a place and a remark
//!    │
//!    = keys of [[contact]]: name, secondary, primary, …       note: a fact
//!    = help: write  enforcement = { penalty = 1e5 }           help: one thing to do
//! ```
//!
//! A phase collects all its findings in [`Diagnostics`] and hands them over at once. A place holds its text, so
//! collections of different phases can be joined freely. Every code is one entry of [`codes`], which is also what
//! `signorini explain` prints: a message cannot carry a code that is not explained.
//!
//! To add a code: one entry in `codes.rs`, and one test that provokes it.

pub mod codes;
mod render;
mod source;
mod suggest;

pub use codes::{Class, Code};
pub use source::{Place, SourceFile, Spanned};
pub use suggest::{closest, listed};

use std::ops::Range;
use std::sync::Arc;

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The run cannot start or go on.
    Error,
    /// The run goes on, but the user ought to look.
    Warning,
    /// Worth knowing.
    Note,
}

/// A remark about a place in a text.
#[derive(Clone, Debug)]
pub struct Label {
    /// The text.
    pub file: Arc<SourceFile>,
    /// The bytes of it that are marked.
    pub span: Range<usize>,
    /// The remark; may be empty.
    pub text: String,
}

/// One finding.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// Which kind it is.
    pub code: &'static Code,
    /// What is wrong, in the user's words: one sentence without a full stop.
    pub message: String,
    /// Where: the first label is the main one, the others explain it.
    pub labels: Vec<Label>,
    /// Facts with numbers.
    pub notes: Vec<String>,
    /// What to do, ready to be copied.
    pub help: Vec<String>,
    /// What it is about, for programs that read it; boxed, so that results that may be a finding stay small.
    pub about: Box<About>,
}

/// What a finding is about, where its message names it in words.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct About {
    /// Motions that nothing stops, as in `slide along x`.
    pub motions: Vec<String>,
    /// The first of the elements, as numbered in the input.
    pub elements: Vec<u64>,
}

impl Diagnostic {
    /// A finding of any severity.
    pub fn new(severity: Severity, code: &'static Code, message: impl Into<String>) -> Self {
        Self {
            severity,
            code,
            message: message.into(),
            labels: Vec::new(),
            notes: Vec::new(),
            help: Vec::new(),
            about: Box::default(),
        }
    }

    /// A finding that stops the run.
    pub fn error(code: &'static Code, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, code, message)
    }

    /// A finding that the user ought to look at.
    pub fn warning(code: &'static Code, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, code, message)
    }

    /// Marks a place; where there is none, a remark becomes a note.
    #[must_use]
    pub fn at(mut self, place: &Place, text: impl Into<String>) -> Self {
        let text = text.into();
        match place.get() {
            Some((file, span)) => self.labels.push(Label {
                file: Arc::clone(file),
                span,
                text,
            }),
            None if text.is_empty() => {}
            None => self.notes.push(text),
        }
        self
    }

    /// Adds a fact.
    #[must_use]
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(text.into());
        self
    }

    /// Adds a motion that it is about.
    #[must_use]
    pub fn about_motion(mut self, motion: impl Into<String>) -> Self {
        self.about.motions.push(motion.into());
        self
    }

    /// Adds elements that it is about, as numbered in the input.
    #[must_use]
    pub fn about_elements(mut self, elements: &[u64]) -> Self {
        self.about.elements.extend(elements);
        self
    }

    /// Adds one thing to do.
    #[must_use]
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.help.push(text.into());
        self
    }
}

/// The findings of a phase, in the order in which they were made.
///
/// # Example
/// ```
/// use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
///
/// let mut found = Diagnostics::new();
/// found.push(Diagnostic::warning(&codes::EMPTY, "nothing to do"));
/// assert!(!found.has_errors() && found.exit_code().is_none());
/// found.push(Diagnostic::error(&codes::EMPTY, "case.toml is empty").help("start from a template"));
/// // a fault of the input
/// assert_eq!(found.exit_code(), Some(3));
/// ```
#[derive(Clone, Default)]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
}

impl Diagnostics {
    /// No findings.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a finding.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.list.push(diagnostic);
    }

    /// Adds all findings of another phase.
    pub fn append(&mut self, mut other: Diagnostics) {
        self.list.append(&mut other.list);
    }

    /// Keeps only the findings for which `keep` holds.
    pub fn retain(&mut self, keep: impl FnMut(&Diagnostic) -> bool) {
        self.list.retain(keep);
    }

    /// Drops warnings and notes whose codes the user has silenced.
    pub fn silence(&mut self, codes: &[&str]) {
        self.retain(|one| one.severity == Severity::Error || !codes.contains(&one.code.id));
    }

    /// Orders the findings by the place of their first label; findings without one come first.
    pub fn sort_by_place(&mut self) {
        self.list
            .sort_by_key(|one| one.labels.first().map(|label| label.span.start));
    }

    /// The findings.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.list.iter()
    }

    /// The number of findings.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Whether there are no findings.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Whether there is an error among the findings.
    pub fn has_errors(&self) -> bool {
        self.errors().next().is_some()
    }

    /// What kind of end the errors call for: the class that comes first in the life of a run.
    pub fn class(&self) -> Option<Class> {
        self.errors().map(|one| one.code.class).min()
    }

    /// The exit code the errors call for; none without errors.
    pub fn exit_code(&self) -> Option<u8> {
        self.class().map(Class::exit_code)
    }

    fn errors(&self) -> impl Iterator<Item = &Diagnostic> {
        self.list
            .iter()
            .filter(|one| one.severity == Severity::Error)
    }
}

impl From<Diagnostic> for Diagnostics {
    fn from(one: Diagnostic) -> Self {
        Self { list: vec![one] }
    }
}

impl IntoIterator for Diagnostics {
    type Item = Diagnostic;
    type IntoIter = std::vec::IntoIter<Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.list.into_iter()
    }
}

impl<'a> IntoIterator for &'a Diagnostics {
    type Item = &'a Diagnostic;
    type IntoIter = std::slice::Iter<'a, Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl std::fmt::Display for Diagnostics {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.write_str(&self.plain())
    }
}

/// As `Display`, from a new line on: for `unwrap`, and for a `main` that returns them.
impl std::fmt::Debug for Diagnostics {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(out, "\n{self}")
    }
}

impl std::error::Error for Diagnostics {}

#[cfg(test)]
mod tests {
    use super::*;

    fn model_error() -> Diagnostic {
        Diagnostic::error(&codes::BAD_ELEMENTS, "3 elements have zero volume")
    }

    #[test]
    fn input_errors_outrank_model_errors() {
        let mut all = Diagnostics::from(model_error());
        assert_eq!(all.exit_code(), Some(4));
        all.push(Diagnostic::error(&codes::UNKNOWN_KEY, "unknown key"));
        assert_eq!(all.exit_code(), Some(3));
    }

    #[test]
    fn warnings_have_no_exit_code_and_can_be_silenced() {
        let mut all = Diagnostics::from(Diagnostic::warning(&codes::IMPLAUSIBLE, "far off"));
        assert_eq!(all.exit_code(), None);
        assert!(!all.has_errors());
        all.push(model_error());
        all.silence(&["S0402", "S0211"]);
        assert_eq!(all.len(), 1, "errors cannot be silenced");
    }

    #[test]
    fn a_program_that_returns_them_prints_what_the_command_prints() {
        let all = Diagnostics::from(model_error());
        assert_eq!(format!("{all:?}"), format!("\n{}", all.plain()));
    }

    #[test]
    fn a_label_without_a_place_becomes_a_note() {
        let one = model_error()
            .at(&Place::nowhere(), "element 7")
            .at(&Place::nowhere(), "");
        assert_eq!(one.notes, ["element 7"]);
        assert!(one.labels.is_empty());
    }
}
