//! What makes no model, as messages.

use super::{constraints, loads};
use signorini_io::case::Case;
use signorini_io::diagnostic::{Code, Diagnostic, Place, codes};
use signorini_mechanics::model::{ConstraintError, LoadError, ModelError};
use signorini_mechanics::solid::SolidError;

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
    let of_load = |name: &str| {
        case.steps.iter().find_map(|step| {
            let mut loads = step.loads.iter().enumerate();
            let (_, load) = loads.find(|(at, load)| loads::name(step, *at, load) == name)?;
            Some(&load.place)
        })
    };
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
        ModelError::Solid(error) => {
            let (code, body, help) = of_solid_error(error);
            (code, of_body(body).map(|b| &b.place), help)
        }
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
        ModelError::TooDeep { contact, .. } => (
            &codes::DEEP_OVERLAP,
            of_contact(contact).map(|c| &c.place),
            "move the bodies apart, or let the contact act from a later step on",
        ),
        ModelError::TwoPass { contact } => (
            &codes::WRONG_KIND,
            of_contact(contact).map(|c| &c.place),
            "name surfaces with faces on both sides, or write  passes = 1",
        ),
        ModelError::Unsuited { contact, .. } | ModelError::PairCount { contact, .. } => (
            &codes::BAD_SIDES,
            of_contact(contact).map(|c| &c.place),
            "change the sides, or the way they are compared",
        ),
        ModelError::Table { contact, .. } => (
            &codes::BAD_SIDES,
            of_contact(contact).map(|c| &c.place),
            "write  penalty = [[gap, pressure], ...]  with rising gaps and falling pressures",
        ),
        ModelError::BothRigid { contact } => (
            &codes::BAD_SIDES,
            of_contact(contact).map(|c| &c.place),
            "give one of the bodies a `material`, or a `penalty` to the contact",
        ),
        ModelError::FreeBody(free) => (
            &codes::FREE_BODY,
            free.bodies
                .first()
                .and_then(|b| of_body(b))
                .map(|b| &b.place),
            "add a [[step.fix]] or [[step.move]] on it in the first step",
        ),
        ModelError::Clash { step, .. } => (
            &codes::CLASH,
            of_step(step).map(|s| &s.place),
            "take the node out of one of the two sets",
        ),
        ModelError::Load { load, source } => {
            let (code, help) = of_load_error(source);
            (code, of_load(load), help)
        }
        ModelError::Constraint(error) => (
            &codes::BAD_CONSTRAINT,
            of_constraint(case, error),
            "take out what is said twice, or what cannot be followed",
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

fn of_solid_error(error: &SolidError) -> (&'static Code, &str, &'static str) {
    match error {
        SolidError::NotSolid { body, .. } => (
            &codes::WRONG_KIND,
            body,
            "name a group of solid elements of the model's dimension",
        ),
        SolidError::NotBar { body, .. } => {
            (&codes::WRONG_KIND, body, "name a group of line elements")
        }
        SolidError::BarOfRevolution { body, .. } => (
            &codes::WRONG_KIND,
            body,
            "a line turned about the axis is a shell: mesh it with solids",
        ),
        SolidError::NoSize { body, .. } => (
            &codes::BAD_ELEMENTS,
            body,
            "look at the mesh: signorini check",
        ),
        SolidError::NoPoint { body, .. } => (
            &codes::NOT_IN_MESH,
            body,
            "points count from 1; reduced integration has fewer",
        ),
        SolidError::OtherHistory { body } => (
            &codes::NOT_BUILT,
            body,
            "change to a material of the same kind: elastic ones remember nothing",
        ),
        SolidError::Locking { body, .. } => {
            (&codes::NOT_A_CHOICE, body, "write  locking = \"auto\"")
        }
        SolidError::Radius { body, .. } => (
            &codes::BAD_MESH,
            body,
            "mesh the half with x >= 0; the axis is x = 0",
        ),
    }
}

fn of_load_error(error: &LoadError) -> (&'static Code, &'static str) {
    match error {
        LoadError::Twice { .. } => (&codes::NAME_TWICE, "rename one of the two loads"),
        LoadError::Nowhere | LoadError::NoArea => {
            (&codes::BAD_LOAD, "name a set of faces: signorini info MESH")
        }
        LoadError::Outside { .. } => (
            &codes::BAD_LOAD,
            "make the element part of a [[body]], or load another set",
        ),
        LoadError::NoFace { .. } | LoadError::NoVolume { .. } => (
            &codes::WRONG_KIND,
            "name something that this load can act on",
        ),
        LoadError::NoDensity { .. } => (&codes::MISSING, "write  density =  in its [material]"),
        LoadError::NoArm => (
            &codes::BAD_LOAD,
            "load nodes that lie around the axis of the moment, or a [reference] that they follow",
        ),
        LoadError::NoAxis | LoadError::OtherAxis => {
            (&codes::CONTRADICTION, "write  axis = \"y\"  through x = 0")
        }
    }
}

/// Where a constraint, a spring or a step was written that an error names.
fn of_constraint<'a>(case: &'a Case, error: &ConstraintError) -> Option<&'a Place> {
    let of_constraint = |wanted: &str| {
        let mut all = case.constraints.iter().enumerate();
        let found = all.find(|(number, one)| constraints::name(*number, one) == wanted);
        let spring = case.springs.iter().find(|one| one.name.value == wanted);
        found
            .map(|(_, one)| &one.place)
            .or(spring.map(|s| &s.place))
    };
    let of_step = |name: &str| {
        let step = case.steps.iter().find(|step| step.name.value == name);
        step.map(|step| &step.place)
    };
    match error {
        ConstraintError::Connector { name, .. } => of_constraint(name),
        ConstraintError::TwoLeaders { constraint, .. }
        | ConstraintError::Contradictory { constraint }
        | ConstraintError::OverConstrained { constraint, .. }
        | ConstraintError::Turning { constraint, .. } => of_constraint(constraint),
        ConstraintError::Idle { step, .. } | ConstraintError::OffAxis { step, .. } => of_step(step),
        ConstraintError::OnFollower { .. } => None,
    }
}
