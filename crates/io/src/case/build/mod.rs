//! From a checked document to a [`Case`], and the checks that need more than one table.

mod bodies;
mod builder;
mod chosen;
mod contact;
mod general;
mod geometry;
mod names;
mod run;
mod shell;
mod steps;
mod surface;

use super::fields::Fields;
use super::origin::Origins;
use super::parts::*;
use super::scalar::shortened;
use super::vocabulary::Vocabulary;
use crate::diagnostic::{Code, Diagnostics, SourceFile, closest, codes};
pub(super) use bodies::COMPONENTS;
use builder::Builder;
use geometry::{at_points, temperatures_at, thicknesses_at};
use run::{cycles, expectation, output};
use toml::de::DeTable;

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
    builder.without_shells(&case);
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

impl Builder<'_> {
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
            orientations: root
                .named("orientation")
                .into_iter()
                .map(|(name, fields, place)| self.named_orientation(name, fields, place))
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
                .filter(|(fields, _)| !fields.has("all"))
                .map(|(fields, place)| self.contact(fields, place))
                .collect(),
            general: self.general(root.tables("contact")),
            constraints: root
                .tables("constraint")
                .into_iter()
                .map(|(fields, place)| self.constraint(fields, place))
                .collect(),
            thicknesses: thicknesses_at(&root),
            constants: constants(root),
            initial_temperature: root.table("initial").number_if("temperature"),
            initial_temperatures: temperatures_at(root.table("initial")),
            initial_velocities: self.velocities_at(root.table("initial")),
            masses: self.masses_at(&root),
            initial_stress: at_points(root.table("initial"), "stress"),
            initial_strain: at_points(root.table("initial"), "strain"),
            steps: root
                .tables("step")
                .into_iter()
                .map(|(fields, place)| self.step(fields, place))
                .collect(),
            cycles: cycles(&root),
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
}

/// Constants of nature.
fn constants(root: Fields<'_>) -> Option<Constants> {
    let of = root.table("constants");
    root.has("constants").then(|| Constants {
        stefan_boltzmann: of.number("stefan_boltzmann"),
        absolute_zero: of.number("absolute_zero"),
    })
}
