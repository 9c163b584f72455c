//! Findings about gaps and overlaps at the start.

use super::mesh::body_of;
use super::{ContactInfo, quoted};
use crate::text::{plural, short};
use signorini_geometry::mesh::Mesh;
use signorini_geometry::tensor::Vec3;
use signorini_io::case::Case;
use signorini_io::diagnostic::{Code, Diagnostic, Diagnostics, Severity, codes};
use signorini_mechanics::model::{Interference, ModelError, StartPlace, StartSummary, Treatment};

/// A position in words: `x = 1.30, y = 0`; in space with z.
pub fn position(at: Vec3, ndim: usize) -> String {
    let axes = ["x", "y", "z"].iter().zip(at.to_array()).take(ndim);
    let axes: Vec<String> = axes
        .map(|(axis, value)| format!("{axis} = {}", short(value)))
        .collect();
    axes.join(", ")
}

/// A place in words: ` at node 14 (x = 1.30, y = 0)`.
pub fn place(place: &StartPlace, mesh: &Mesh) -> String {
    let at = position(place.position, mesh.dim());
    let label = place.node.and_then(|n| mesh.node_labels.get(n as usize));
    match label {
        Some(label) => format!(" at node {label} ({at})"),
        None => format!(" at {at}"),
    }
}

/// The treatment of overlaps in words; `None` for joined sides.
pub fn treatment(start: &StartSummary, first_step: &str) -> Option<String> {
    Some(match start.treatment {
        Treatment::Interference(Interference::Ramped) => {
            format!("resolved over step \"{first_step}\"")
        }
        Treatment::Interference(Interference::Increment) => {
            format!("resolved in the first two increments of step \"{first_step}\"")
        }
        Treatment::Interference(Interference::Increments) => {
            format!("resolved over step \"{first_step}\", measured again in every increment")
        }
        Treatment::Interference(Interference::AtOnce) => {
            "resolved in the first increment".to_owned()
        }
        Treatment::Interference(Interference::StrainFree) => {
            "left as it is, without stress".to_owned()
        }
        Treatment::Given => "taken to be the gap that the case gives".to_owned(),
        Treatment::Joined => return None,
    })
}

/// The name of the first step in which a contact acts.
pub fn first_step(case: &Case, contact: &str) -> String {
    let contact = case.contacts.iter().find(|c| c.name.value == contact);
    let acting = contact.map(|contact| contact.acting(case.steps.iter()));
    let steps = acting.into_iter().flatten().zip(&case.steps);
    let mut acting = steps.filter(|(acts, _)| *acts);
    acting
        .next()
        .map_or_else(String::new, |(_, step)| step.name.value.clone())
}

/// Findings about all contacts.
pub(super) fn findings(case: &Case, mesh: &Mesh, contacts: &[ContactInfo]) -> Diagnostics {
    let mut found = Diagnostics::new();
    for info in contacts {
        let own = case.contacts.iter().find(|c| c.name.value == info.name);
        let note = |code: &'static Code, text: String| {
            let one = Diagnostic::new(Severity::Note, code, text);
            match own {
                Some(contact) => one.at(&contact.place, ""),
                None => one,
            }
        };
        let start = &info.start;
        let overlaps = start.overlapping > 0 && start.treatment != Treatment::Joined;
        if let (true, Some(gap)) = (overlaps, start.gap) {
            let at = start.place.as_ref().map(|p| place(p, mesh));
            let text = format!(
                "contact \"{}\": the sides overlap at the start by up to {}{}",
                info.name,
                short(-gap),
                at.unwrap_or_default()
            );
            let mut one = note(&codes::OVERLAP, text);
            let what = treatment(start, &first_step(case, &info.name));
            let what = what.map_or_else(String::new, |what| format!("; {what}"));
            let many = plural(start.overlapping, "node");
            one = one.note(format!("{many} of both sides overlap{what}"));
            found.push(
                one.help(format!(
                    "where the sides are meant to touch:  start = {{ close_gaps_below = {} }}  of contact \"{}\"",
                    short(-1.01 * gap),
                    info.name
                ))
                .help("where the overlap is an interference fit:  allow = [\"S0411\"]"),
            );
        }
        // what is beyond the edges of a side that was found is found, too, where it comes near
        if let Some(edges) = start.open_edges.as_ref().filter(|_| !info.is_found) {
            let label = |n: u32| {
                mesh.node_labels
                    .get(n as usize)
                    .copied()
                    .unwrap_or_default()
            };
            let (cell, side) = (edges.face.cell, edges.face.side + 1);
            let element = mesh.cell_label(cell).unwrap_or_default();
            let body = body_of(element, case, mesh);
            let text = format!(
                "contact \"{}\": its secondary side ends at {} of {}",
                info.name,
                plural(edges.count, "edge"),
                body.map_or_else(
                    || "the body".to_owned(),
                    |body| format!("body {}", quoted(body))
                )
            );
            let one = Diagnostic::new(Severity::Warning, &codes::OPEN_EDGE, text);
            let one = match own {
                Some(contact) => one.at(&contact.place, ""),
                None => one,
            };
            found.push(
                one.note(format!(
                    "such as at node {}: face S{side} of element {element} next to it is not in the contact, and passes \
                     through the other side where the edge rolls",
                    label(edges.node),
                ))
                .help("add the faces next to these edges to the secondary side")
                .help("where the edges do not roll:  allow = [\"S0414\"]"),
            );
        }
        if let Some(bent) = start.bent.as_ref().filter(|_| !info.is_found) {
            let text = format!(
                "contact \"{}\": gaps of up to {} come from straight facets and are taken as {}",
                info.name,
                short(bent.straight),
                short(bent.bent)
            );
            let mut one = note(&codes::FACETED, text);
            one = one.note(
                "gaps are measured between the curved surfaces that the facets were cut from",
            );
            let distance = bent.distance;
            if distance.abs() > 2.0 * bent.bent {
                let kind = if distance > 0.0 {
                    "clearance"
                } else {
                    "interference"
                };
                let size = short(distance.abs());
                one = one.note(format!("a uniform {kind} of {size} stays"));
            }
            found.push(one.help(format!(
                "to take the gaps of the facets:  start = {{ facets = \"straight\" }}  of contact \"{}\"",
                info.name
            )));
        }
    }
    found
}

/// What an error adds about where bodies overlap too deeply.
pub(super) fn where_too_deep(error: &ModelError, mesh: &Mesh) -> Vec<String> {
    let ModelError::TooDeep {
        overlap,
        thickness,
        place,
        count,
        nodes,
        ..
    } = error
    else {
        return Vec::new();
    };
    let names: Vec<String> = nodes.iter().map(u64::to_string).collect();
    let more = if *count > names.len() { ", …" } else { "" };
    vec![
        format!(
            "the deepest is node {} ({}): {} where the bodies are {} thick",
            names.first().map_or("?", String::as_str),
            position(*place, mesh.dim()),
            short(*overlap),
            short(*thickness)
        ),
        format!("{}: {}{more}", plural(*count, "node"), names.join(", ")),
    ]
}
