//! The warning about bodies that only contact holds.

use super::ContactInfo;
use super::gaps::place;
use crate::text::short;
use signorini_geometry::mesh::{Mesh, NodeId};
use signorini_io::case::{Case, FreeMotions};
use signorini_io::diagnostic::{Diagnostic, codes};
use signorini_mechanics::model::Unheld;
use std::collections::BTreeMap;

/// Bodies, and contacts, that are listed one by one.
pub(crate) const LISTED: usize = 5;

/// One message for all bodies that only contact holds; `None` where there are none. `stabilized` says whether a viscous force holds
/// them until contact does.
pub(super) fn by_contact(
    bodies: &[Unheld],
    contacts: &[ContactInfo],
    (case, mesh): (&Case, &Mesh),
    sets: &BTreeMap<String, Vec<NodeId>>,
    stabilized: bool,
) -> Option<Diagnostic> {
    let first = bodies.first()?;
    let named = |one: &Unheld| name(one, (case, mesh), sets);
    let what = match bodies.len() {
        1 => format!("{} is held only by contact", named(first)),
        n => format!("{n} bodies are held only by contact"),
    };
    let mut message = if stabilized {
        Diagnostic::warning(&codes::HELD_BY_CONTACT, what)
    } else {
        Diagnostic::error(&codes::HELD_BY_CONTACT, what)
    };
    for one in bodies {
        message = message.about_motion(one.motion.clone());
    }
    if bodies.len() == 1 {
        message = message.note(format!("without contact it is free to {}", first.motion));
    } else {
        for one in bodies.iter().take(LISTED) {
            let text = format!("without contact {} is free to {}", named(one), one.motion);
            message = message.note(text);
        }
        message = and_so_on(message, bodies.len());
    }
    let open: Vec<(&ContactInfo, f64)> = contacts
        .iter()
        .filter_map(|contact| Some((contact, contact.start.gap.filter(|gap| *gap > 0.0)?)))
        .collect();
    for (contact, gap) in open.iter().take(LISTED) {
        let at = contact.start.place.as_ref();
        let at = at.map_or_else(String::new, |at| place(at, mesh));
        let text = format!(
            "contact \"{}\" is open by {}{at}",
            contact.name,
            short(*gap)
        );
        message = message.note(text);
    }
    message = and_so_on(message, open.len());
    message = message.note(if stabilized {
        "until contact holds it, a vanishing viscous force does; its work is in summary.json"
    } else {
        "nothing else holds it: stabilize = false"
    });
    if stabilized {
        for (contact, gap) in open.iter().filter(|(one, _)| !one.is_found).take(LISTED) {
            message = message.help(format!(
                "where the gap is meant to be closed:  start = {{ close_gaps_below = {} }}  of contact \"{}\"",
                short(1.01 * gap),
                contact.name
            ));
        }
    } else {
        message = message
            .help("let a vanishing viscous force hold it:  stabilize = \"auto\"  in [solver]");
    }
    Some(message.help(hold_it(first_step(case))))
}

/// The remedy for whatever moves freely in a step.
pub(crate) fn hold_it(step: &str) -> String {
    format!(
        "hold it by [[step.fix]], or prescribe its motion by [[step.move]] instead of a load, in step \"{step}\""
    )
}

/// The remedies for what nothing holds in a step: to hold it, or to let the program do so.
pub(crate) fn hold(case: &Case, step: &str) -> Vec<String> {
    let mut found = vec![hold_it(step)];
    if case.solver.free_motions != FreeMotions::Hold {
        found.push(
            "where no load acts on the motion:  free_motions = \"hold\"  in [solver]".to_owned(),
        );
    }
    found
}

/// The name of the first step.
pub(crate) fn first_step(case: &Case) -> &str {
    let first = case.steps.first();
    first.map_or("", |step| step.name.value.as_str())
}

/// Says how many more there are than were listed.
pub(crate) fn and_so_on(message: Diagnostic, n: usize) -> Diagnostic {
    match n.saturating_sub(LISTED) {
        0 => message,
        more => message.note(format!("and {more} more")),
    }
}

/// A body by its name; a part of one by the group that it belongs to.
fn name(
    one: &Unheld,
    (case, mesh): (&Case, &Mesh),
    sets: &BTreeMap<String, Vec<NodeId>>,
) -> String {
    let node = one.node.and_then(|label| {
        let labels = mesh.node_labels.iter();
        let found = labels.enumerate().find(|(_, l)| **l == label);
        found.map(|(node, _)| node as NodeId)
    });
    let groups = case.bodies.iter().flat_map(|body| &body.groups);
    let mut holding = groups.filter(|group| {
        let nodes = sets.get(&group.value);
        node.is_some_and(|node| nodes.is_some_and(|nodes| nodes.contains(&node)))
    });
    match (holding.next(), one.node) {
        (Some(group), Some(node)) => {
            format!("body \"{}\" (the part with node {node})", group.value)
        }
        _ => one.to_string(),
    }
}
