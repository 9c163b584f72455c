//! A problem: what it is about, how it is posed, what is compared with what, and how closely.

use crate::mesh::Grid;
use serde::Serialize;
use std::fmt::Write;

/// A problem of the set.
#[derive(Clone, Copy, Debug)]
pub struct Problem {
    /// What users call it: words with hyphens, the name of its page and of its case.
    pub name: &'static str,
    /// One line.
    pub title: &'static str,
    /// Author, work, equation or page.
    pub source: &'static str,
    /// What it shows.
    pub goal: &'static str,
    /// The mesh in words, and why it is fine enough.
    pub mesh: &'static str,
    /// Supports, loads and contacts in words.
    pub conditions: &'static str,
    /// The reference as a formula: Markdown with `$…$`.
    pub formula: &'static str,
    /// Whether it is one of the quick ones.
    pub quick: bool,
    /// Poses it.
    pub pose: fn() -> Setup,
}

impl Problem {
    /// The case, and what is compared.
    #[must_use]
    pub fn setup(&self) -> Setup {
        (self.pose)()
    }
}

/// A problem as the program is given it, and what is expected of it.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The mesh.
    pub mesh: Grid,
    /// The case without its head, mesh, sets and expectations.
    pub case: String,
    /// What is compared.
    pub checks: Vec<Check>,
}

/// Where a reference comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum Kind {
    /// A closed form, evaluated here.
    Analytical,
    /// A number in print.
    Published,
    /// The result of an independent program.
    #[serde(rename = "CROSS-CODE")]
    CrossCode,
    /// A converged result of this program: it shows changes, not errors.
    Regression,
}

impl Kind {
    /// The label in tables.
    #[must_use]
    pub const fn label(self) -> &'static str {
        match self {
            Self::Analytical => "ANALYTICAL",
            Self::Published => "PUBLISHED",
            Self::CrossCode => "CROSS-CODE",
            Self::Regression => "REGRESSION",
        }
    }
}

/// How far a value may be off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// Relative to the reference.
    Relative(f64),
    /// In the unit of the quantity, where the reference is zero: a part of a scale of the problem, a force or a length.
    OfScale {
        /// The part.
        part: f64,
        /// The scale.
        scale: f64,
    },
}

impl Tolerance {
    /// In the unit of the quantity.
    #[must_use]
    pub fn absolute(self, reference: f64) -> f64 {
        match self {
            Self::Relative(part) => part * reference.abs(),
            Self::OfScale { part, scale } => part * scale.abs(),
        }
    }

    /// The part that may be off.
    #[must_use]
    pub const fn part(self) -> f64 {
        match self {
            Self::Relative(part) | Self::OfScale { part, .. } => part,
        }
    }

    /// In words: `1 %`, `1e-9`, `1e-6 of 12.5`.
    #[must_use]
    pub fn words(self) -> String {
        let of = |part: f64| match part {
            part if part >= 1e-4 => format!("{} %", (1e6 * part).round() / 1e4),
            part => format!("{part:e}"),
        };
        match self {
            Self::Relative(part) => of(part),
            Self::OfScale { part, scale } => {
                format!("{} of {}", of(part), signorini::text::short(scale))
            }
        }
    }
}

/// What a run is asked for: a column of the history or a field at a place, as `[[expect]]` names it, at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct Ask {
    /// What.
    pub what: String,
    /// The total time; absent: the end.
    pub time: Option<f64>,
}

/// One comparison.
#[derive(Clone, Debug)]
pub struct Check {
    /// The quantity in words.
    pub quantity: &'static str,
    /// What the run is asked for.
    pub asks: Vec<Ask>,
    /// How the value is made of the answers; absent: it is the first one.
    pub combine: Option<fn(&[f64]) -> f64>,
    /// What it should be.
    pub reference: f64,
    /// Where that comes from.
    pub kind: Kind,
    /// How far the value may be off.
    pub tolerance: Tolerance,
    /// Why so far.
    pub why: &'static str,
}

impl Check {
    /// A value that the run reports itself, compared with a closed form.
    pub(crate) fn exact(
        quantity: &'static str,
        what: &str,
        reference: f64,
        part: f64,
        why: &'static str,
    ) -> Self {
        Self {
            quantity,
            asks: vec![Ask {
                what: what.to_owned(),
                time: None,
            }],
            combine: None,
            reference,
            kind: Kind::Analytical,
            tolerance: Tolerance::Relative(part),
            why,
        }
    }

    /// A value that should vanish compared with a scale of the problem.
    pub(crate) fn zero(
        quantity: &'static str,
        what: &str,
        scale: f64,
        part: f64,
        why: &'static str,
    ) -> Self {
        Self {
            tolerance: Tolerance::OfScale { part, scale },
            ..Self::exact(quantity, what, 0.0, part, why)
        }
    }

    /// Where the reference comes from, if not from a closed form.
    pub(crate) fn of(self, kind: Kind) -> Self {
        Self { kind, ..self }
    }

    /// The same at a time.
    pub(crate) fn at(mut self, time: f64) -> Self {
        for ask in &mut self.asks {
            ask.time = Some(time);
        }
        self
    }

    /// A value made of several answers, this one and more.
    pub(crate) fn and(mut self, what: &str, combine: fn(&[f64]) -> f64) -> Self {
        self.asks.push(Ask {
            what: what.to_owned(),
            time: None,
        });
        self.combine = Some(combine);
        self
    }

    /// A value made of the one answer.
    pub(crate) fn by(self, combine: fn(&[f64]) -> f64) -> Self {
        Self {
            combine: Some(combine),
            ..self
        }
    }

    /// The value that answers make; not a number where one is missing.
    #[must_use]
    pub fn value(&self, answers: &[f64]) -> f64 {
        if answers.len() != self.asks.len() {
            return f64::NAN;
        }
        match self.combine {
            Some(combine) => combine(answers),
            None => answers.first().copied().unwrap_or(f64::NAN),
        }
    }

    /// Whether the tolerance says something: it is finite, above zero and less than the reference or the scale.
    #[must_use]
    pub fn is_strict(&self) -> bool {
        let part = self.tolerance.part();
        let known = match self.tolerance {
            Tolerance::Relative(_) => self.reference.abs(),
            Tolerance::OfScale { scale, .. } => scale.abs(),
        };
        part > 0.0 && part < 1.0 && known > 0.0 && known.is_finite() && self.reference.is_finite()
    }

    /// How far a value is off, relative to the reference or the scale.
    #[must_use]
    pub fn difference(&self, value: f64) -> f64 {
        let off = value - self.reference;
        match self.tolerance {
            Tolerance::Relative(_) => off / self.reference.abs(),
            Tolerance::OfScale { scale, .. } => off / scale.abs(),
        }
    }

    /// Whether a value will do; one that is not finite never does.
    #[must_use]
    pub fn accepts(&self, value: f64) -> bool {
        let allowed = self.tolerance.absolute(self.reference);
        value.is_finite() && (value - self.reference).abs() <= allowed
    }
}

/// How the expectations of a case are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expectations {
    /// With the references: for users who run the case.
    Judged,
    /// Wide open: values are read and judged afterwards.
    Read,
}

/// No tolerance at all.
const ANYTHING: f64 = 1e300;

impl Setup {
    /// The whole case in TOML, which can be run as it is.
    #[must_use]
    pub fn text(&self, title: &str, expectations: Expectations) -> String {
        let mut out = format!(
            "format = 1\ntitle = {title:?}\n\n{}\n{}\n",
            self.case.trim(),
            self.mesh.text()
        );
        for check in &self.checks {
            for ask in &check.asks {
                let (value, allowed) = match (expectations, check.combine) {
                    (Expectations::Judged, None) => {
                        (check.reference, check.tolerance.absolute(check.reference))
                    }
                    _ => (0.0, ANYTHING),
                };
                // writing to a string does not fail
                let _ = writeln!(out, "[[expect]]\nwhat = {:?}", ask.what);
                if let Some(time) = ask.time {
                    let _ = writeln!(out, "time = {time:?}");
                }
                let _ = writeln!(out, "value = {value:?}\ntol = {{ abs = {allowed:?} }}\n");
            }
        }
        out
    }
}

/// Puts numbers and words where a text has their names behind a `$`; longer names first.
pub(crate) fn fill(text: &str, names: &[(&str, &dyn std::fmt::Debug)]) -> String {
    let mut sorted: Vec<_> = names.iter().collect();
    sorted.sort_by_key(|(name, _)| std::cmp::Reverse(name.len()));
    sorted.iter().fold(text.to_owned(), |text, (name, value)| {
        text.replace(&format!("${name}"), &format!("{value:?}"))
    })
}
