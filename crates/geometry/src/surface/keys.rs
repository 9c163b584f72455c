//! Keys that several shapes share.

use super::Side;
use signorini_vocabulary::{Default, Key, LINE, POSITIVE, Shape, VECTOR, Values, key, word};

/// The centre of a closed shape.
pub(super) const CENTER: Key = key("center", VECTOR, "its centre")
    .required()
    .hints(&["centre", "point"])
    .within_plane();

/// The axis around which a shape is round.
pub(super) const AXIS: Key = key(
    "axis",
    LINE,
    "\"x\", \"y\", \"z\" or a vector along its axis",
)
.required()
.within_plane();

/// The radius of a shape that has one.
pub(super) const RADIUS: Key = key("radius", POSITIVE, "its radius")
    .required()
    .hints(&["r"]);

/// On which side of a closed shape bodies are.
pub(super) const SIDE: Key = key(
    "side",
    Shape::Choice(&[word("outside"), word("inside")]),
    "where bodies are",
)
.or(Default::Text("outside"));

/// The value of [`SIDE`].
pub(super) fn side(values: &Values) -> Side {
    match values.text(SIDE.name) {
        Some("inside") => Side::Inside,
        _ => Side::Outside,
    }
}
