//! What all stages of building share: the vocabulary, the space of the model, the findings; and vectors.

use super::super::fields::{Fields, numbers};
use super::super::parts::Space;
use super::super::vocabulary::Vocabulary;
use crate::diagnostic::{Code, Diagnostic, Diagnostics, Place, codes};
use toml::de::DeValue;

pub(super) struct Builder<'v> {
    pub(super) vocabulary: &'v Vocabulary,
    pub(super) space: Space,
    pub(super) found: Diagnostics,
}

impl Builder<'_> {
    pub(super) fn error(
        &mut self,
        code: &'static Code,
        message: impl Into<String>,
        place: &Place,
        remark: impl Into<String>,
    ) {
        self.found
            .push(Diagnostic::error(code, message).at(place, remark));
    }

    /// A vector, or a point. In the plane its third component may be left away; it has to be zero.
    pub(super) fn vector(&mut self, fields: Fields<'_>, key: &str) -> Option<[f64; 3]> {
        let value = fields.get(key)?;
        self.vector_at(value.get_ref(), fields.at(value.span()), key)
    }

    pub(super) fn vector_at(
        &mut self,
        value: &DeValue<'_>,
        place: Place,
        key: &str,
    ) -> Option<[f64; 3]> {
        let plane = self.space.ndim() == 2;
        if let Some([x, y]) = numbers::<2>(value) {
            if !plane {
                self.error(
                    &codes::WRONG_LENGTH,
                    format!("`{key}` needs 3 entries, found 2"),
                    &place,
                    "x, y and z",
                );
            }
            return Some([x, y, 0.0]);
        }
        numbers::<3>(value)
    }

    /// A vector in the plane of a plane model.
    pub(super) fn vector_within(&mut self, fields: Fields<'_>, key: &str) -> Option<[f64; 3]> {
        let vector = self.vector(fields, key)?;
        self.within(vector, key, &fields.place(key));
        Some(vector)
    }

    /// Refuses what leads out of a plane model.
    pub(super) fn within(&mut self, vector: [f64; 3], key: &str, place: &Place) {
        if self.space.ndim() == 2 && vector[2] != 0.0 {
            self.error(
                &codes::CONTRADICTION,
                format!("`{key}` leads out of the plane"),
                place,
                "a plane model has no z: write 0, or two entries",
            );
        }
    }

    /// Refuses what is not along z in a plane model.
    pub(super) fn across(&mut self, vector: [f64; 3], key: &str, place: &Place) {
        if self.space.ndim() == 2 && vector[..2] != [0.0; 2] {
            self.error(
                &codes::CONTRADICTION,
                format!("`{key}` leads out of the plane"),
                place,
                format!("a plane model turns about z: write [0, 0, {key}]"),
            );
        }
    }

    /// A direction: the name of an axis, or a vector that is not zero.
    pub(super) fn line(&mut self, fields: Fields<'_>, key: &str) -> Option<[f64; 3]> {
        if let Some(word) = fields.text_if(key) {
            return Some(match word.value.as_str() {
                "x" => [1.0, 0.0, 0.0],
                "y" => [0.0, 1.0, 0.0],
                _ => [0.0, 0.0, 1.0],
            });
        }
        let vector = self.vector(fields, key)?;
        self.has_direction(vector, key, &fields.place(key));
        Some(vector)
    }

    /// Refuses a vector of length zero.
    pub(super) fn has_direction(&mut self, vector: [f64; 3], key: &str, place: &Place) {
        if vector == [0.0; 3] {
            self.error(
                &codes::OUT_OF_RANGE,
                format!("`{key}` has no direction"),
                place,
                "a vector of length zero",
            );
        }
    }
}
