//! A case as text with every default filled in: what was really run.
//!
//! The vocabulary gives the order of the keys and the remark behind each of them; reading the text gives the same case.

mod contact;
mod model;
mod run;
mod steps;
mod surface;
mod write;

use super::parts::*;
use super::vocabulary::Vocabulary;
use contact::{contact, general};
use model::{
    body, constraint, initial, local_axes, mass, material, mesh, model, orientation, reference,
    set_content, spring, thickness,
};
use run::{checkpoint, cycle, expectation, output, solver};
use steps::{amplitude, step};
use surface::surface;
use write::{Entries, Value, list, named, tables, write_table};

/// A case as a complete TOML text, which reads back to the same case.
pub fn resolved(case: &Case, vocabulary: &Vocabulary) -> String {
    let mut text = String::new();
    write_table(&mut text, vocabulary.case, "", &tree(case));
    text
}

/// Contacts as they are written: those that were found are found again.
fn contacts(case: &Case) -> Value {
    let named = case.contacts.iter().filter(|one| one.found.is_none());
    let named = named.map(contact);
    let all = named.chain(case.general.iter().map(general));
    Value::Tables(all.map(|entries| (None, entries)).collect())
}

fn tree(case: &Case) -> Entries {
    let mut entries = vec![
        ("format", u64::from(case.format).into()),
        ("title", (&case.title).into()),
        ("units", (&case.units.value).into()),
        ("allow", list(&case.allow)),
        ("mesh", Value::Table(mesh(&case.mesh))),
        ("model", Value::Table(model(&case.model))),
    ];
    entries.extend([
        (
            "sets",
            named(&case.sets, |set| (&set.name, set_content(&set.content))),
        ),
        (
            "reference",
            named(&case.references, |one| (&one.name, reference(one))),
        ),
        ("axes", tables(&case.axes, local_axes)),
        (
            "amplitude",
            named(&case.amplitudes, |one| (&one.name, amplitude(one))),
        ),
        (
            "material",
            named(&case.materials, |one| (&one.name, material(one))),
        ),
        (
            "orientation",
            named(&case.orientations, |one| (&one.name, orientation(one))),
        ),
        ("body", tables(&case.bodies, body)),
        ("thickness", tables(&case.thicknesses, thickness)),
        (
            "mass",
            tables(&case.masses, |one| mass(one, case.model.space.ndim() == 2)),
        ),
        ("spring", tables(&case.springs, spring)),
        ("surface", tables(&case.surfaces, surface)),
        ("contact", contacts(case)),
        ("constraint", tables(&case.constraints, constraint)),
    ]);
    entries.extend(case.constants.map(|constants| {
        let constants = vec![
            ("stefan_boltzmann", constants.stefan_boltzmann.into()),
            ("absolute_zero", constants.absolute_zero.into()),
        ];
        ("constants", Value::Table(constants))
    }));
    let initial = initial(case);
    if !initial.is_empty() {
        entries.push(("initial", Value::Table(initial)));
    }
    entries.extend([
        ("step", tables(&case.steps, step)),
        ("cycle", tables(&case.cycles, cycle)),
        ("solver", Value::Table(solver(&case.solver))),
        ("output", Value::Table(output(&case.output))),
        ("checkpoint", Value::Table(checkpoint(&case.checkpoint))),
        ("expect", tables(&case.expectations, expectation)),
    ]);
    entries
}
