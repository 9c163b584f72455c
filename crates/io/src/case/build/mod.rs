//! From a checked document to a [`Case`], and the checks that need more than one table.

mod bodies;
mod chosen;
mod contact;
mod geometry;
mod names;
mod run;
mod steps;
mod surface;

use toml::de::{DeTable, DeValue};

use super::fields::{Fields, numbers};
use super::origin::Origins;
use super::parts::*;
use super::scalar::shortened;
use super::vocabulary::Vocabulary;
use crate::diagnostic::{Code, Diagnostic, Diagnostics, Place, SourceFile, closest, codes};
pub(super) use bodies::COMPONENTS;
use geometry::{at_points, temperatures_at};
use run::{expectation, output};

/// The version of the case format that this program reads and writes.
pub(super) const FORMAT: u64 = 1;

/// Builds the case of a checked document.
///
/// The case is of use only where neither the check nor this function found errors.
pub(super) fn build(
    document: &DeTable<'_>,
    vocabulary: &Vocabulary,
    origins: &Origins,
) -> (Case, Diagnostics) {
    let mut builder = Builder {
        vocabulary,
        space: Space::default(),
        found: Diagnostics::new(),
    };
    let root = Fields::new(document, vocabulary.case, origins);
    let case = builder.case(root);
    builder.names(&case);
    builder.cycles(&case);
    builder.references(&case, root);
    builder.surfaces(&case);
    builder.pairs(&case);
    builder.contact_changes(&case);
    (case, builder.found)
}

/// The case of an empty document.
pub(super) fn empty() -> Case {
    let origins = Origins::new(SourceFile::new("", ""));
    build(&DeTable::new(), &Vocabulary::plain(), &origins).0
}

struct Builder<'v> {
    vocabulary: &'v Vocabulary,
    space: Space,
    found: Diagnostics,
}

impl Builder<'_> {
    fn error(
        &mut self,
        code: &'static Code,
        message: impl Into<String>,
        place: &Place,
        remark: impl Into<String>,
    ) {
        self.found
            .push(Diagnostic::error(code, message).at(place, remark));
    }

    fn case(&mut self, root: Fields<'_>) -> Case {
        let format = root.count("format");
        if format > FORMAT {
            self.error(
                &codes::NEWER_FORMAT,
                format!("the case is written for format {format}"),
                &root.place("format"),
                format!("this program reads format {FORMAT}"),
            );
        }
        let model = self.model(root.table("model"));
        self.space = *model.space;
        Case {
            format: u32::try_from(format).unwrap_or(u32::MAX),
            title: root.text("title").value,
            units: root.text("units"),
            allow: self.allow(root),
            mesh: self.mesh(root.table("mesh")),
            model,
            sets: root
                .named("sets")
                .into_iter()
                .map(|(name, fields, place)| self.set(name, fields, place))
                .collect(),
            references: root
                .named("reference")
                .into_iter()
                .map(|(name, fields, place)| self.reference_point(name, fields, place))
                .collect(),
            axes: root
                .tables("axes")
                .into_iter()
                .map(|(fields, place)| self.local_axes(fields, place))
                .collect(),
            amplitudes: root
                .named("amplitude")
                .into_iter()
                .map(|(name, fields, _)| self.amplitude(name, fields))
                .collect(),
            materials: root
                .named("material")
                .into_iter()
                .map(|(name, fields, place)| self.material(name, fields, place))
                .collect(),
            bodies: root
                .tables("body")
                .into_iter()
                .map(|(fields, place)| self.body(fields, place))
                .collect(),
            springs: root
                .tables("spring")
                .into_iter()
                .map(|(fields, place)| self.spring(fields, place))
                .collect(),
            surfaces: root
                .tables("surface")
                .into_iter()
                .map(|(fields, place)| self.surface(fields, place))
                .collect(),
            contacts: root
                .tables("contact")
                .into_iter()
                .map(|(fields, place)| self.contact(fields, place))
                .collect(),
            constraints: root
                .tables("constraint")
                .into_iter()
                .map(|(fields, place)| self.constraint(fields, place))
                .collect(),
            initial_temperature: root.table("initial").number_if("temperature"),
            initial_temperatures: temperatures_at(root.table("initial")),
            initial_stress: at_points(root.table("initial"), "stress"),
            initial_strain: at_points(root.table("initial"), "strain"),
            steps: root
                .tables("step")
                .into_iter()
                .map(|(fields, place)| self.step(fields, place))
                .collect(),
            solver: self.solver(root.table("solver")),
            output: output(root.table("output")),
            checkpoint: self.checkpoint(root.table("checkpoint")),
            expectations: root
                .tables("expect")
                .into_iter()
                .map(|(fields, place)| expectation(fields, place))
                .collect(),
        }
    }

    fn allow(&mut self, root: Fields<'_>) -> Vec<String> {
        let allowed = root.texts("allow");
        for one in &allowed {
            if Code::find(one).is_none() {
                let known = codes::ALL.iter().map(|code| code.id);
                let remark = closest(one, known)
                    .map_or(String::new(), |meant| format!("did you mean \"{meant}\"?"));
                self.error(
                    &codes::NOT_A_CHOICE,
                    format!("there is no warning \"{}\"", shortened(one)),
                    &one.place,
                    remark,
                );
            }
        }
        allowed.into_iter().map(|one| one.value).collect()
    }

    /// A vector, or a point. In the plane its third component may be left away; it has to be zero.
    fn vector(&mut self, fields: Fields<'_>, key: &str) -> Option<[f64; 3]> {
        let value = fields.get(key)?;
        self.vector_at(value.get_ref(), fields.at(value.span()), key)
    }

    fn vector_at(&mut self, value: &DeValue<'_>, place: Place, key: &str) -> Option<[f64; 3]> {
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
    fn vector_within(&mut self, fields: Fields<'_>, key: &str) -> Option<[f64; 3]> {
        let vector = self.vector(fields, key)?;
        self.within(vector, key, &fields.place(key));
        Some(vector)
    }

    /// Refuses what leads out of a plane model.
    fn within(&mut self, vector: [f64; 3], key: &str, place: &Place) {
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
    fn across(&mut self, vector: [f64; 3], key: &str, place: &Place) {
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
    fn line(&mut self, fields: Fields<'_>, key: &str) -> Option<[f64; 3]> {
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
    fn has_direction(&mut self, vector: [f64; 3], key: &str, place: &Place) {
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
