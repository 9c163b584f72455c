//! Another method for contacts that mortar does not get through.
//!
//! Where a sharp edge slides off the other side, what mortar compares vanishes while it still bears a force, and no increment is
//! small enough. Gauss points with a penalty pass. A case whose increments did not converge, and whose contacts are by mortar
//! because the program chose it, is therefore solved once more with Gauss points there, from the start: as if the case said so.
//! `on_trouble` without `"points"` does without.

use super::drive::run;
use super::{Finished, Listener, RunOptions};
use crate::load::load_again;
use crate::setup::{Model, build_with};
use signorini_io::case::Remedy;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};

/// Solves a model, and where mortar contact does not converge, the same case by Gauss points; everything that happens goes to
/// files and to the listener, as in [`run`].
pub fn solve(mut model: Model, options: &RunOptions, listener: &mut dyn Listener) -> Finished {
    let finished = run(&mut model, options, listener);
    let contacts = contacts_by_mortar(&model, &finished);
    if contacts.is_empty() {
        return finished;
    }
    let (name, allowed) = (model.name.clone(), model.case.allow.clone());
    let mut again = options.clone();
    for contact in &contacts {
        let path = format!("contact.{contact:?}.method");
        let method = "\"gauss-point\"".to_owned();
        again.source.overrides.push((path, method));
    }
    (again.fresh, again.resume) = (true, false);
    // two models at a time are not needed
    drop(model);
    let loaded = load_again(again.source.clone());
    let built = loaded.and_then(|loaded| build_with(loaded.case, loaded.mesh, &again.own));
    let built = options.ranks.agreed(built);
    let Ok(mut model) = built else {
        return finished;
    };
    model.name = name;
    let mut notes = Diagnostics::from(note(&contacts));
    let allowed: Vec<&str> = allowed.iter().map(String::as_str).collect();
    notes.silence(&allowed);
    notes.append(std::mem::take(&mut model.warnings));
    model.warnings = notes;
    run(&mut model, &again, listener)
}

/// The contacts that are solved by points instead: those by mortar, as the program chose, of a run that did not converge.
fn contacts_by_mortar(model: &Model, finished: &Finished) -> Vec<String> {
    let wanted = model.case.solver.on_trouble.contains(&Remedy::Points);
    if !wanted
        || !finished.in_trouble
        || finished.exit_code != codes::NOT_CONVERGED.class.exit_code()
    {
        return Vec::new();
    }
    let all = model.contacts.iter();
    // a contact that was found has no key of its own
    let named = all.filter(|contact| !contact.is_found);
    let by_mortar = named.filter(|contact| contact.automatic && contact.method == "mortar");
    by_mortar.map(|contact| contact.name.clone()).collect()
}

fn note(contacts: &[String]) -> Diagnostic {
    let names: Vec<String> = contacts.iter().map(|name| format!("\"{name}\"")).collect();
    let (which, names) = match names.len() {
        1 => ("contact", names.join("")),
        _ => ("contacts", names.join(", ")),
    };
    let message = Diagnostic::warning(
        &codes::BY_POINTS,
        format!(
            "{which} {names}: mortar did not converge, so the case is solved again by Gauss points"
        ),
    );
    let help = |name: &String| {
        format!("to start with it:  method = \"gauss-point\"  of contact \"{name}\"")
    };
    contacts.iter().map(help).fold(message, Diagnostic::help)
}
