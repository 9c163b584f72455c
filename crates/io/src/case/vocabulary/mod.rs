//! The words of a case: every key with its form, default, range and meaning, in one place.
//!
//! Reading, messages about unknown keys, the JSON schema and the resolved case all follow these tables. What the
//! format knows but this version cannot do stands here too, marked as `later`, so that
//! it is refused by name.
//!
//! To add a key: one line here, one field in `parts`, one line each in `build` and `resolved`.

mod bodies;
mod contact;
mod geometry;
mod run;
mod steps;
mod surface;

pub use run::FIELDS;

use bodies::{BODY, CONSTRAINT, MATERIAL, SPRING};
use contact::CONTACT;
use geometry::{AXES, INITIAL, MESH, MODEL, REFERENCE, SET};
use run::{CHECKPOINT, EXPECT, OUTPUT, SOLVER};
use steps::{AMPLITUDE, STEP};
use surface::SURFACE;

/// A table of a case: what may stand in it.
#[derive(Debug)]
pub struct Table {
    /// How users write it, as in `[[contact]]`.
    pub heading: &'static str,
    /// What it is.
    pub doc: &'static str,
    /// Its keys, in the order in which they are listed and written.
    pub keys: &'static [Key],
    /// Which keys exclude or need each other.
    pub rules: &'static [Rule],
}

impl Table {
    /// The entry of a key.
    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }

    /// The names of all keys this version reads.
    pub fn names(&self) -> impl Iterator<Item = &'static str> + Clone + use<> {
        self.keys
            .iter()
            .filter(|key| key.later.is_none())
            .map(|key| key.name)
    }
}

/// A key of a table.
#[derive(Debug)]
pub struct Key {
    /// Its name.
    pub name: &'static str,
    /// The form of its value.
    pub shape: Shape,
    /// What holds where it is absent.
    pub default: Default,
    /// What it means, in one line.
    pub doc: &'static str,
    /// Other words people use for it; they are proposed, never read.
    pub hints: &'static [&'static str],
    /// Known, but not supported by this version: what to use instead, which may be empty.
    pub later: Option<&'static str>,
}

impl Key {
    const fn required(mut self) -> Self {
        self.default = Default::Required;
        self
    }

    const fn or(mut self, default: Default) -> Self {
        self.default = default;
        self
    }

    const fn hints(mut self, hints: &'static [&'static str]) -> Self {
        self.hints = hints;
        self
    }

    /// Known, but not supported by this version.
    const fn later(mut self, instead: &'static str) -> Self {
        self.later = Some(instead);
        self
    }
}

const fn key(name: &'static str, shape: Shape, doc: &'static str) -> Key {
    Key {
        name,
        shape,
        default: Default::Absent,
        doc,
        hints: &[],
        later: None,
    }
}

/// What holds where a key is absent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Default {
    /// It must be given.
    Required,
    /// Nothing.
    Absent,
    /// A text or word.
    Text(&'static str),
    /// Several texts or words.
    Texts(&'static [&'static str]),
    /// A number.
    Number(f64),
    /// A whole number.
    Integer(i64),
    /// A truth value.
    Flag(bool),
}

/// The form of a value.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// Any text.
    Text,
    /// One of these words.
    Choice(&'static [Choice]),
    /// A finite number in a range.
    Number(Bounds),
    /// A whole number from the first to the second.
    Integer(i64, i64),
    /// `true` or `false`.
    Flag,
    /// A list of values of one form: at least and at most so many.
    List(&'static Shape, usize, usize),
    /// A list of values of these forms, and how it is written, as in `[element, side]`.
    Row(&'static str, &'static [Shape]),
    /// A value of one of these forms, which differ in their TOML type.
    Either(&'static [Shape]),
    /// A table.
    Table(&'static Table),
    /// A list of tables.
    Tables(&'static Table),
    /// A table of tables by names of the user's choice.
    Named(&'static Table),
    /// The rows `[id, x, y, z]` of nodes, which are too many for the ordinary way.
    Nodes,
    /// A form that this version does not support: what to use instead.
    Later(&'static Shape, &'static str),
}

/// A word that a key takes.
#[derive(Clone, Copy, Debug)]
pub struct Choice {
    /// The word.
    pub word: &'static str,
    /// Known, but not supported by this version: what to use instead, which may be empty.
    pub later: Option<&'static str>,
}

impl Choice {
    const fn later(word: &'static str, instead: &'static str) -> Self {
        Self {
            word,
            later: Some(instead),
        }
    }
}

const fn word(word: &'static str) -> Choice {
    Choice { word, later: None }
}

/// The range of a number: exclusive (`above`, `below`) or inclusive (`from`, `to`) ends.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// Greater than this.
    pub above: Option<f64>,
    /// At least this.
    pub from: Option<f64>,
    /// Less than this.
    pub below: Option<f64>,
    /// At most this.
    pub to: Option<f64>,
}

impl Bounds {
    /// Whether a number lies in the range.
    pub fn hold(&self, value: f64) -> bool {
        self.above.is_none_or(|end| value > end)
            && self.from.is_none_or(|end| value >= end)
            && self.below.is_none_or(|end| value < end)
            && self.to.is_none_or(|end| value <= end)
    }

    /// The range in words, as in `greater than 0`.
    pub fn words(&self) -> String {
        let ends = [
            ("greater than", self.above),
            ("at least", self.from),
            ("less than", self.below),
            ("at most", self.to),
        ];
        let words: Vec<String> = ends
            .into_iter()
            .filter_map(|(words, end)| end.map(|end| format!("{words} {end}")))
            .collect();
        words.join(" and ")
    }
}

/// Keys that exclude or need each other.
#[derive(Clone, Copy, Debug)]
pub enum Rule {
    /// Exactly one of these.
    ExactlyOne(&'static [&'static str]),
    /// At least one of these.
    AtLeastOne(&'static [&'static str]),
    /// At most one of these.
    AtMostOne(&'static [&'static str]),
    /// The first only together with the second.
    Needs(&'static str, &'static str),
}

const FREE: Bounds = Bounds {
    above: None,
    from: None,
    below: None,
    to: None,
};
const ANY: Shape = Shape::Number(FREE);
const POSITIVE: Shape = Shape::Number(Bounds {
    above: Some(0.0),
    ..FREE
});
const NOT_NEGATIVE: Shape = Shape::Number(Bounds {
    from: Some(0.0),
    ..FREE
});
const POISSON: Shape = Shape::Number(Bounds {
    above: Some(-1.0),
    below: Some(0.5),
    ..FREE
});
const ID: Shape = Shape::Integer(0, i64::MAX);
/// More increments, iterations or threads than any run has.
const COUNT: Shape = Shape::Integer(1, 1_000_000_000);
const MANY: usize = usize::MAX;
const NAMES: Shape = Shape::Either(&[Shape::Text, Shape::List(&Shape::Text, 1, MANY)]);
/// Three numbers; two will do in the plane.
const VECTOR: Shape = Shape::List(&ANY, 2, 3);
const AXIS: Shape = Shape::Choice(&[word("x"), word("y"), word("z")]);
/// An axis of the frame, or a vector along any other.
const LINE: Shape = Shape::Either(&[AXIS, VECTOR]);
const TIME_TABLE: Shape = Shape::List(&Shape::List(&ANY, 2, 2), 1, MANY);
const AUTO: Shape = Shape::Choice(&[word("auto")]);
const ON_DOC: &str = "the set, mesh group, reference or rigid body it acts on";

/// The whole case.
pub static CASE: Table = Table {
    heading: "the case",
    doc: "A contact problem: geometry, materials, bodies, contacts, and what happens step by step.",
    keys: &[
        key("format", Shape::Integer(1, i64::MAX), "version of the case format").or(Default::Integer(1)),
        key("title", Shape::Text, "what the run is about, for reports").or(Default::Text("")),
        key("units", Shape::Text, "length-force-stress, as in mm-N-MPa: a label for reports and plausibility; nothing is converted")
            .or(Default::Text("")),
        key("allow", Shape::List(&Shape::Text, 0, MANY), "codes of warnings to silence").or(Default::Texts(&[])),
        key("mesh", Shape::Table(&MESH), MESH.doc).required(),
        key("model", Shape::Table(&MODEL), MODEL.doc),
        key("sets", Shape::Named(&SET), SET.doc).hints(&["set"]),
        key("reference", Shape::Named(&REFERENCE), REFERENCE.doc).hints(&["references", "point"]),
        key("axes", Shape::Tables(&AXES), AXES.doc).hints(&["transform", "orientation"]),
        key("amplitude", Shape::Named(&AMPLITUDE), AMPLITUDE.doc).hints(&["amplitudes"]),
        key("material", Shape::Named(&MATERIAL), MATERIAL.doc).hints(&["materials"]),
        key("body", Shape::Tables(&BODY), BODY.doc).hints(&["bodies", "part", "section"]),
        key("surface", Shape::Tables(&SURFACE), SURFACE.doc).hints(&["surfaces"]),
        key("contact", Shape::Tables(&CONTACT), CONTACT.doc).hints(&["contacts", "pair", "interface"]),
        key("spring", Shape::Tables(&SPRING), SPRING.doc).hints(&["springs"]),
        key("constraint", Shape::Tables(&CONSTRAINT), CONSTRAINT.doc)
            .hints(&["constraints", "coupling", "equation", "mpc", "tie"]),
        key("initial", Shape::Table(&INITIAL), INITIAL.doc),
        key("step", Shape::Tables(&STEP), STEP.doc).required().hints(&["steps"]),
        key("solver", Shape::Table(&SOLVER), SOLVER.doc),
        key("output", Shape::Table(&OUTPUT), OUTPUT.doc).hints(&["results"]),
        key("checkpoint", Shape::Table(&CHECKPOINT), CHECKPOINT.doc).hints(&["restart"]),
        key("expect", Shape::Tables(&EXPECT), EXPECT.doc).hints(&["check", "test"]),
    ],
    rules: &[Rule::AtLeastOne(&["body", "spring"])],
};
