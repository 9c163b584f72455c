//! Shells: bodies of elements of the plane in space, and what acts on nothing else.

use super::super::fields::Fields;
use super::super::parts::*;
use super::bodies::thickness;
use super::builder::Builder;
use crate::diagnostic::{Spanned, codes};

/// Keys of bodies that mean nothing for shells, each with the value that it may have nevertheless, if any.
const NOT_OF_SHELLS: [(&str, &str); 6] = [
    ("area", ""),
    ("integration", "full"),
    ("locking", "auto"),
    ("temperatures", "full"),
    ("at_nodes", "linear"),
    ("strain", "auto"),
];

impl Builder<'_> {
    /// What makes shells of the elements of a body: in space, and without keys of solids and bars.
    pub(super) fn shell(&mut self, fields: &Fields<'_>, name: &str) -> Option<Shell> {
        if !fields.has("shell") {
            return None;
        }
        let (of, place) = (fields.table("shell"), fields.place("shell"));
        if self.space != Space::ThreeD {
            let space = self.space.word();
            self.error(
                &codes::CONTRADICTION,
                format!("body \"{name}\" is a shell in a model that is {space}"),
                &place,
                "delete it, or choose  [model] space = \"3d\"",
            );
        }
        for (key, only) in NOT_OF_SHELLS {
            let is_only = !only.is_empty() && fields.text(key).value == only;
            if fields.has(key) && !is_only {
                self.error(
                    &codes::CONTRADICTION,
                    format!("`{key}` means nothing for a shell"),
                    &fields.place(key),
                    "delete it, or `shell`",
                );
            }
        }
        let uniform = || Spanned::new(Thickness::Uniform(1.0), place.clone());
        let normals = of.number_if("normals");
        Some(Shell {
            thickness: thickness(&of).unwrap_or_else(uniform),
            offset: of.number("offset"),
            normals: normals.unwrap_or_else(|| of.number("normals").into()),
            points: usize::try_from(of.count("points")).unwrap_or(Shell::POINTS),
            place,
        })
    }

    /// Refuses what acts on shells only in a case without any.
    pub(super) fn without_shells(&mut self, case: &Case) {
        if case.bodies.iter().any(|body| body.shell.is_some()) {
            return;
        }
        let steps = || case.steps.iter();
        let initial = case.initial_temperatures.iter();
        let initial = initial.filter(|one| one.gradient.is_some());
        let initial = initial.map(|one| ("gradient", &one.place));
        let temperatures = steps().flat_map(|step| &step.temperatures);
        let gradients = temperatures.filter_map(|one| one.gradient.as_ref());
        let gradients = gradients.map(|gradient| ("gradient", &gradient.place));
        let loads = steps().flat_map(|step| &step.loads);
        let lines = loads.filter(|load| load.kind.name == "line");
        let lines = lines.map(|load| ("line", &load.what));
        for (key, place) in initial.chain(gradients).chain(lines) {
            self.error(
                &codes::CONTRADICTION,
                format!("`{key}` acts on shells, and no body is one"),
                place,
                "delete it, or write  shell = { thickness = }  in a [[body]]",
            );
        }
    }
}
