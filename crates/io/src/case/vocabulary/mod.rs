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
mod kinds;
mod own;
mod placeholders;
mod run;
mod steps;
mod surface;
mod whole;

pub use kinds::{Kinds, Vocabulary};
pub use own::OWN;
pub use run::FIELDS;

use signorini_vocabulary::ANY;
pub use signorini_vocabulary::{
    AXIS, Bounds, Choice, Default, FREE, Key, LINE, MANY, NOT_NEGATIVE, POISSON, POSITIVE, Rule,
    Shape, Table, VECTOR, key, word,
};

const ID: Shape = Shape::Integer(0, i64::MAX);
/// More increments, iterations or threads than any run has.
const COUNT: Shape = Shape::Integer(1, 1_000_000_000);
const NAMES: Shape = Shape::Either(&[Shape::Text, Shape::List(&Shape::Text, 1, MANY)]);
const TIME_TABLE: Shape = Shape::List(&Shape::List(&ANY, 2, 2), 1, MANY);
const AUTO: Shape = Shape::Choice(&[word("auto")]);
const ON_DOC: &str = "the set, mesh group, reference or rigid body it acts on";
