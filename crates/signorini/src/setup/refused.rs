//! What makes no model, as messages.

use super::held::{LISTED, and_so_on, first_step, hold};
use super::{constraints, loads};
use signorini_io::case::Case;
use signorini_io::diagnostic::{Code, Diagnostic, Place, codes};
use signorini_mechanics::connector::ConnectorError;
use signorini_mechanics::model::{ActivityError, ConstraintError, LoadError, ModelError, Unheld};
use signorini_mechanics::solid::SolidError;

/// The message for what makes no model.
pub(super) fn refused(case: &Case, error: &ModelError) -> Diagnostic {
    let (code, place, help) = kind(case, error);
    let mut message = Diagnostic::error(code, error.to_string());
    if let Some(place) = place {
        message = message.at(place, "");
    }
    if let ModelError::FreeBodies(free) | ModelError::FreeLater { free, .. } = error {
        let motions = free.iter().map(|one| one.motion.clone());
        message = motions.fold(message, Diagnostic::about_motion);
        if free.len() > 1 {
            let shown = free.iter().take(LISTED);
            let free_to = |one: &Unheld| format!("{one} is free to {}", one.motion);
            message = shown.map(free_to).fold(message, Diagnostic::note);
            message = and_so_on(message, free.len());
        }
    }
    let helps = helps(case, error, help).into_iter();
    helps.fold(message, Diagnostic::help)
}

/// The code, the place in the case, and what to change.
type Kind<'a> = (&'static Code, Option<&'a Place>, &'static str);

fn kind<'a>(case: &'a Case, error: &ModelError) -> Kind<'a> {
    let of_body = |name: &str| {
        let has = |group: &str| name.split('+').any(|part| part == group);
        let mut bodies = case.bodies.iter();
        let found = bodies.find(|body| body.groups.iter().any(|group| has(&group.value)));
        found.map(|body| &body.place)
    };
    match error {
        ModelError::NothingDeforms => (
            &codes::NOTHING_TO_SOLVE,
            case.bodies.first().map(|b| &b.place),
            "give at least one [[body]] a `material`",
        ),
        ModelError::TwoBodies { second, .. } | ModelError::RigidBodiesShare { second, .. } => (
            &codes::BOTH_BODIES,
            of_body(second),
            "name groups that do not overlap",
        ),
        ModelError::EmptyBody { body } => (
            &codes::WRONG_KIND,
            of_body(body),
            "name a group of solid elements",
        ),
        ModelError::NoDensity { body } => (
            &codes::MISSING,
            of_body(body),
            "write  density =  in its [material]",
        ),
        ModelError::Thin { body } => (
            &codes::CONTRADICTION,
            of_body(body),
            "smaller elements; or  contact_mass = \"as-is\"  in `dynamics`",
        ),
        ModelError::Solid(error) => {
            let (code, body, help) = of_solid_error(error);
            (code, of_body(body), help)
        }
        ModelError::FreeBodies(free) => {
            let first = free.first().and_then(|one| one.bodies.first());
            let place = first.and_then(|body| of_body(body));
            (&codes::FREE_BODY, place, "")
        }
        ModelError::FreeLater { step, .. } => {
            let found = case.steps.iter().find(|s| s.name.value == *step);
            (&codes::FREE_BODY, found.map(|s| &s.place), "")
        }
        ModelError::Activity(error) => of_activity(case, error),
        ModelError::Clash { step, .. } => {
            let found = case.steps.iter().find(|s| s.name.value == *step);
            let help = "take the node out of one of the two sets";
            (&codes::CLASH, found.map(|s| &s.place), help)
        }
        ModelError::CarrierClash { step, .. } => {
            let found = case.steps.iter().find(|s| s.name.value == *step);
            let help =
                "leave the direction out of [[step.fix]], or the motion out of [[step.move]]";
            (&codes::CLASH, found.map(|s| &s.place), help)
        }
        ModelError::Load { load, source } => {
            let (code, help) = of_load_error(source);
            (code, of_load(case, load), help)
        }
        ModelError::Constraint(error) => (
            &codes::BAD_CONSTRAINT,
            of_constraint(case, error),
            of_constraint_error(error),
        ),
        ModelError::OnRigidNode { body, .. } => (&codes::CLASH, of_body(body), ""),
        ModelError::Facets { .. }
        | ModelError::EmptySide { .. }
        | ModelError::Surface { .. }
        | ModelError::Glued { .. }
        | ModelError::TooDeep { .. }
        | ModelError::TwoPass { .. }
        | ModelError::Cohesion { .. }
        | ModelError::Unsuited { .. }
        | ModelError::NoDualBasis { .. }
        | ModelError::PairCount { .. }
        | ModelError::BothRigid { .. } => of_contact_error(case, error),
    }
}

/// Elements that cannot be removed or added.
fn of_activity<'a>(case: &'a Case, error: &ActivityError) -> Kind<'a> {
    let (step, help) = match error {
        ActivityError::Outside { step, .. } => {
            (step, "name elements of a [[body]] with a material")
        }
        ActivityError::Rigid { step, .. } => (
            step,
            "remove the contacts of the rigid body:  [[step.contact]] with  active = false",
        ),
        ActivityError::Already {
            step, adds: "adds", ..
        } => (
            step,
            "elements take part from the start: remove them first, in the first step, say",
        ),
        ActivityError::Already { step, .. } => {
            (step, "take the element out of one of the two groups")
        }
        ActivityError::Twice { step, .. } => {
            (step, "take the element out of one of the two groups")
        }
        ActivityError::NothingLeft { step } => (step, "leave some elements"),
        ActivityError::TotalOverParts { load } => {
            let help = "give each part a load of its own, or write  traction  or  pressure";
            return (&codes::BAD_LOAD, of_load(case, load), help);
        }
    };
    let found = case.steps.iter().find(|s| s.name.value == *step);
    let place = found.map(|s| {
        let removed = s.deactivations.first().map(|one| &one.place);
        removed
            .or(s.activations.first().map(|one| &one.place))
            .unwrap_or(&s.place)
    });
    (&codes::CONTRADICTION, place, help)
}

fn of_load<'a>(case: &'a Case, name: &str) -> Option<&'a Place> {
    case.steps.iter().find_map(|step| {
        let mut loads = step.loads.iter().enumerate();
        let (_, load) = loads.find(|(at, load)| loads::name(step, *at, load) == name)?;
        Some(&load.place)
    })
}

fn of_contact_error<'a>(case: &'a Case, error: &ModelError) -> Kind<'a> {
    let (code, contact, help): (&'static Code, &str, &str) = match error {
        ModelError::Facets { contact, .. } | ModelError::EmptySide { contact } => {
            (&codes::WRONG_KIND, contact, "name surfaces with faces")
        }
        ModelError::Surface { contact, .. } => (
            &codes::BAD_ELEMENTS,
            contact,
            "look at the mesh: signorini check",
        ),
        ModelError::Glued { contact, .. } => (
            &codes::BAD_SIDES,
            contact,
            "mesh the two bodies apart, without common nodes",
        ),
        ModelError::TooDeep { contact, .. } => (
            &codes::DEEP_OVERLAP,
            contact,
            "where the overlap is meant so:  start = { interference = \"now\" }",
        ),
        ModelError::TwoPass { contact } => (
            &codes::WRONG_KIND,
            contact,
            "name surfaces with faces on both sides, or write  passes = 1",
        ),
        ModelError::PairCount { contact, .. } => {
            (&codes::BAD_SIDES, contact, "write  pairs = \"nearest\"")
        }
        ModelError::BothRigid { contact } => (
            &codes::BAD_SIDES,
            contact,
            "let one of the bodies deform, or:  enforcement = { penalty = 1e5 }",
        ),
        ModelError::Cohesion { contact, .. } => (
            &codes::CONTRADICTION,
            contact,
            "correct  cohesive = { strength, toughness, stiffness }",
        ),
        ModelError::Unsuited { contact, .. } => (&codes::BAD_SIDES, contact, ""),
        ModelError::NoDualBasis { contact, .. } => (
            &codes::BAD_SIDES,
            contact,
            "write  method = \"gauss-point\"  or  method = \"node-to-segment\"",
        ),
        // all others are no matter of contact
        _ => (&codes::BAD_SIDES, "", ""),
    };
    let found = case.contacts.iter().find(|c| c.name.value == contact);
    (code, found.map(|c| &c.place), help)
}

/// What to change; keys of contacts with the contact that they belong to.
fn helps(case: &Case, error: &ModelError, help: &str) -> Vec<String> {
    let of_contact = |help: &str, contact: &str| format!("{help}  of contact \"{contact}\"");
    match error {
        ModelError::FreeBodies(_) => hold(case, first_step(case)),
        ModelError::FreeLater { step, .. } => hold(case, step),
        ModelError::Unsuited {
            contact, remedy, ..
        } => vec![of_contact(&format!("write  {remedy}"), contact)],
        ModelError::PairCount { contact, .. }
        | ModelError::NoDualBasis { contact, .. }
        | ModelError::BothRigid { contact } => {
            vec![of_contact(help, contact)]
        }
        ModelError::TooDeep { contact, .. } => vec![
            "move the bodies apart, or let the contact act from a later step on".to_owned(),
            of_contact(help, contact),
        ],
        ModelError::OnRigidNode { body, .. } => vec![format!("name the body:  on = \"{body}\"")],
        ModelError::Constraint(ConstraintError::OnFollower { carrier, .. }) => {
            vec![format!("name what it follows:  on = \"{carrier}\"")]
        }
        _ => vec![help.to_owned()],
    }
}

/// What to change about a constraint.
const fn of_constraint_error(error: &ConstraintError) -> &'static str {
    match error {
        ConstraintError::Spring { source, .. } | ConstraintError::Connector { source, .. } => {
            of_connector_error(source)
        }
        ConstraintError::Uneven { .. } => "take the node out of the set, or correct its place",
        ConstraintError::TwoLeaders { .. } => "take the node out of one of the two sets",
        ConstraintError::OnFollower { .. } => "name what the node follows",
        ConstraintError::Contradictory { .. } => {
            "take out one of the constraints that speak of the same displacements"
        }
        ConstraintError::OverConstrained { .. } => {
            "take the constrained nodes out of the supports and motions, or leave the constraint away"
        }
        ConstraintError::Turning { .. } => "couple the rotations, or free a translation",
        ConstraintError::Idle { .. } => {
            "write  reference = \"...\"  in a rigid [[body]] or in a [[constraint]]"
        }
        ConstraintError::Loose { .. } => "move nodes of a [[body]], or a [reference]",
        ConstraintError::OffAxis { .. } => "move and load it along y alone",
    }
}

/// What to change about the nodes or numbers of a spring or constraint.
const fn of_connector_error(error: &ConnectorError) -> &'static str {
    match error {
        ConnectorError::NoLength { .. } | ConnectorError::NoDirection { .. } => {
            "write  direction = \"x\", \"y\", \"z\" or a vector"
        }
        ConnectorError::Number { .. } => "correct the number",
        ConnectorError::Narrow { point: true, .. } => "name nodes at different places",
        ConnectorError::Narrow { point: false, .. } => "name nodes that do not lie on one line",
        ConnectorError::Uneven { .. } => "take the node out of the set, or correct its place",
    }
}

fn of_solid_error(error: &SolidError) -> (&'static Code, &str, &'static str) {
    match error {
        SolidError::NotSolid { body, .. } => (
            &codes::WRONG_KIND,
            body,
            "name a group of solid elements of the model's dimension",
        ),
        SolidError::NoDirector { body, .. } => (
            &codes::WRONG_KIND,
            body,
            "write  shell = { thickness = }  in its [[body]]",
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
        SolidError::NotConserving { body, .. } => (
            &codes::NOT_BUILT,
            body,
            "locking = \"none\", or elements that need no remedy; bars:  strain = \"small\"",
        ),
        SolidError::OnAxis { body, .. } => (
            &codes::OUT_OF_RANGE,
            body,
            "move the axis off the elements, or give those around it axes of their own",
        ),
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
        LoadError::Loose { .. } => (
            &codes::BAD_LOAD,
            "load nodes of a [[body]]; a set by place takes those of a body with  of = \"BODY\"",
        ),
        LoadError::Alone { .. } => (
            &codes::BAD_LOAD,
            "join the node to a body by a [[constraint]] or a [[spring]], or write  kind = \"dynamic\"  in all steps",
        ),
        LoadError::Misplaced | LoadError::NoFace { .. } | LoadError::NoVolume { .. } => (
            &codes::WRONG_KIND,
            "name something that this load can act on",
        ),
        LoadError::Massless => (&codes::MISSING, "write a [[mass]] on it"),
        LoadError::NoDensity { .. } => (&codes::MISSING, "write  density =  in its [material]"),
        LoadError::NoArm => (
            &codes::BAD_LOAD,
            "load nodes that lie around the axis of the moment, or a [reference] that they follow",
        ),
        LoadError::NoConstants => (
            &codes::MISSING,
            "write  [constants] stefan_boltzmann = 5.67e-8, absolute_zero = -273.15  in the units of the case",
        ),
        LoadError::NoTemperatures => (
            &codes::CONTRADICTION,
            "write  kind = \"heat\"  or  kind = \"coupled\"  in its step",
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
        ConstraintError::Spring { spring, .. } => of_constraint(spring),
        ConstraintError::Connector { constraint, .. }
        | ConstraintError::Uneven { constraint, .. }
        | ConstraintError::TwoLeaders { constraint, .. }
        | ConstraintError::Contradictory { constraint }
        | ConstraintError::OverConstrained { constraint, .. }
        | ConstraintError::Turning { constraint, .. } => of_constraint(constraint),
        ConstraintError::Idle { step, .. }
        | ConstraintError::Loose { step, .. }
        | ConstraintError::OffAxis { step, .. } => of_step(step),
        ConstraintError::OnFollower { .. } => None,
    }
}
