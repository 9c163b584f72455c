//! Temperatures: at the start, and at the end of steps.

use super::heat;
use super::names::Names;
use signorini_geometry::mesh::Mesh;
use signorini_io::case::{Case, Expansion, Material};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use std::collections::HashMap;

/// The temperature of every node at the start, and that of all nodes that nothing else is said of; nothing where the case knows no temperatures.
///
/// Without `[initial]` bodies start without thermal strain, at the reference temperature of their materials.
pub(super) fn at_start<'a>(
    case: &'a Case,
    names: &Names<'_>,
    mesh: &Mesh,
    found: &mut Diagnostics,
) -> (Vec<f64>, Option<f64>) {
    let expanding: Vec<(&Material, &Expansion)> = used(case)
        .filter_map(|material| Some((material, material.expansion.as_ref()?)))
        .collect();
    let given = case.initial_temperature.as_ref();
    let somewhere = case.initial_temperatures.first();
    let mut changes = case.steps.iter().flat_map(|step| &step.temperatures);
    let first = changes.next();
    let is_solved = heat::first(case).is_some();
    if expanding.is_empty() && !is_solved {
        let place = first.map(|one| &one.place).or(given.map(|one| &one.place));
        let place = place.or(somewhere.map(|one| &one.place));
        if let Some(place) = place {
            found.push(
                Diagnostic::warning(&codes::NO_EFFECT, "temperatures that change nothing")
                    .at(place, "no material expands")
                    .help("give a material  expansion = { alpha = , reference = }"),
            );
        }
        if place.is_none() {
            return (Vec::new(), None);
        }
    }
    let start = match (given, expanding.as_slice()) {
        (Some(given), _) => given.value,
        (None, []) => 0.0,
        (None, all) => {
            let given = |(material, one): &(&'a Material, &'a Expansion)| {
                Some((*material, one.free.value.given()?, &one.free.place))
            };
            let mut known = all.iter().filter_map(given);
            let Some((first, reference, _)) = known.next() else {
                let message =
                    "a material is without thermal strain at the start: how warm is that?";
                let place = all.first().map(|(_, one)| &one.free.place);
                let message = Diagnostic::error(&codes::MISSING, message);
                let message = message.help("write  [initial] temperature =");
                found.push(match place {
                    Some(place) => message.at(place, "what each place is at at the start"),
                    None => message,
                });
                return (Vec::new(), None);
            };
            if let Some((second, other, place)) = known.find(|(_, other, _)| *other != reference) {
                found.push(
                    Diagnostic::error(
                        &codes::MISSING,
                        format!(
                            "materials \"{}\" and \"{}\" are without thermal strain at {reference} and {}: \
                             where does the run start?",
                            first.name.value, second.name.value, other
                        ),
                    )
                    .at(place, "another reference than the first")
                    .help("write  [initial] temperature ="),
                );
            }
            reference
        }
    };
    let mut field = vec![start; mesh.nnode()];
    let mut gradients = HashMap::new();
    for one in &case.initial_temperatures {
        for node in names.nodes(&one.on, found).unwrap_or_default() {
            if let Some(at) = field.get_mut(node as usize) {
                *at = one.temperature;
            }
            if let Some(gradient) = one.gradient {
                gradients.insert(node, gradient);
            }
        }
    }
    names.shells().spread(&mut field, &gradients);
    (field, Some(start))
}

/// The materials that bodies are made of.
fn used(case: &Case) -> impl Iterator<Item = &Material> {
    case.materials.iter().filter(|material| {
        let names = case.bodies.iter().filter_map(|body| body.material.as_ref());
        let changes = case.steps.iter().flat_map(|step| &step.materials);
        let mut names = names.chain(changes.map(|change| &change.material));
        names.any(|name| name.value == material.name.value)
    })
}
