//! What a case names by `own`, from the program.

use crate::own::Own;
use signorini_io::case::vocabulary::OWN;
use signorini_io::case::{Case, Enforcement, Factor, Friction, Shape};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Place, codes, listed};
use signorini_vocabulary::Chosen;
use std::collections::BTreeMap;

/// The name of what a case has chosen from the program; nothing where it is described by the vocabulary.
pub(super) fn name(chosen: &Chosen) -> Option<&str> {
    (chosen.name == OWN).then(|| chosen.values.text(OWN))?
}

/// Refuses every name that the program lacks, once.
pub(super) fn check(case: &Case, own: &Own, found: &mut Diagnostics) {
    for surface in &case.surfaces {
        if let Shape::Analytical(shape) = &surface.shape {
            known(
                &own.surfaces,
                ("surface", name(shape), &surface.place),
                found,
            );
        }
    }
    for contact in &case.contacts {
        if let Enforcement::Law(law) = &contact.enforcement {
            known(&own.laws, ("contact law", name(law), &contact.place), found);
        }
    }
    let at_first = case.contacts.iter();
    let at_first = at_first.filter_map(|one| Some((one.friction.as_ref()?, &one.place)));
    let changes = case.steps.iter().flat_map(|step| &step.contacts);
    let later = changes.filter_map(|one| Some((one.friction.as_ref()?.as_ref()?, &one.place)));
    for (Friction { limit, .. }, place) in at_first.chain(later) {
        known(&own.frictions, ("friction law", name(limit), place), found);
    }
    for material in &case.materials {
        let name = material.own.as_ref().map(|name| name.as_str());
        let place = material
            .own
            .as_ref()
            .map_or(&material.place, |own| &own.place);
        known(&own.materials, ("material", name, place), found);
    }
    for amplitude in &case.amplitudes {
        if let Factor::Own(name) = &amplitude.factor {
            let course = ("function of time", Some(name.as_str()), &name.place);
            known(&own.courses, course, found);
        }
    }
}

/// Refuses a name, of this kind and at this place, that is not among those of the program.
fn known<T>(
    all: &BTreeMap<String, T>,
    (kind, name, place): (&str, Option<&str>, &Place),
    found: &mut Diagnostics,
) {
    let Some(name) = name.filter(|name| !all.contains_key(*name)) else {
        return;
    };
    let message =
        format!("the case names own physics \"{name}\", which only the program that made it has");
    let message = Diagnostic::error(&codes::NOT_BROUGHT, message)
        .at(place, format!("a {kind} of the program"))
        .help("run it from there");
    let names = listed(all.keys().map(String::as_str));
    found.push(match all.is_empty() {
        true => message,
        false => message.note(format!("this program has: {names}")),
    });
}
