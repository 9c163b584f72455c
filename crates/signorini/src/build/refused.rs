//! What makes no model, as messages.

use signorini_io::case::Case;
use signorini_io::diagnostic::{Diagnostic, codes};
use signorini_mechanics::model::ModelError;

/// The message for what makes no model.
pub(super) fn refused(case: &Case, error: &ModelError) -> Diagnostic {
    let of_contact = |name: &str| case.contacts.iter().find(|c| c.name.value == name);
    let of_body = |name: &str| {
        case.bodies.iter().find(|b| {
            b.groups
                .iter()
                .any(|g| name.split('+').any(|n| n == g.value))
        })
    };
    let of_step = |name: &str| case.steps.iter().find(|s| s.name.value == name);
    let (code, place, help) = match error {
        ModelError::NothingDeforms => (
            &codes::NOTHING_TO_SOLVE,
            case.bodies.first().map(|b| &b.place),
            "give at least one [[body]] a `material`",
        ),
        ModelError::TwoBodies { second, .. } | ModelError::RigidBodiesShare { second, .. } => (
            &codes::BOTH_BODIES,
            of_body(second).map(|b| &b.place),
            "name groups that do not overlap",
        ),
        ModelError::EmptyBody { body } => (
            &codes::WRONG_KIND,
            of_body(body).map(|b| &b.place),
            "name a group of solid elements",
        ),
        ModelError::Solid(signorini_mechanics::solid::SolidError::NotSolid { body, .. }) => (
            &codes::WRONG_KIND,
            of_body(body).map(|b| &b.place),
            "name a group of solid elements of the model's dimension",
        ),
        ModelError::Facets { contact, .. } | ModelError::EmptySide { contact } => (
            &codes::WRONG_KIND,
            of_contact(contact).map(|c| &c.place),
            "name surfaces with faces",
        ),
        ModelError::Surface { contact, .. } => (
            &codes::BAD_ELEMENTS,
            of_contact(contact).map(|c| &c.place),
            "look at the mesh: signorini check",
        ),
        ModelError::Glued { contact, .. } => (
            &codes::BAD_SIDES,
            of_contact(contact).map(|c| &c.place),
            "mesh the two bodies apart, without common nodes",
        ),
        ModelError::BothRigid { contact } => (
            &codes::BAD_SIDES,
            of_contact(contact).map(|c| &c.place),
            "give one of the bodies a `material`, or a `penalty` to the contact",
        ),
        ModelError::FreeBody { body } => (
            &codes::FREE_BODY,
            of_body(body).map(|b| &b.place),
            "add a [[step.fix]] or [[step.move]] on it in the first step",
        ),
        ModelError::Clash { step, .. } => (
            &codes::CLASH,
            of_step(step).map(|s| &s.place),
            "take the node out of one of the two sets",
        ),
        ModelError::OnRigidNode { body, .. } => (
            &codes::CLASH,
            of_body(body).map(|b| &b.place),
            "name the rigid body itself in `on`",
        ),
    };
    let message = Diagnostic::error(code, error.to_string()).help(help);
    match place {
        Some(place) => message.at(place, ""),
        None => message,
    }
}
