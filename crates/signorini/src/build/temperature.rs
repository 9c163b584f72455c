//! Temperatures: at the start, and at the end of steps.

use signorini_geometry::mesh::Mesh;
use signorini_io::case::{Case, Expansion, Material};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};

/// The temperature of every node at the start, and its one value; nothing where the case knows no temperatures.
///
/// Without `[initial]` bodies start without thermal strain, at the reference temperature of their materials.
pub(super) fn at_start(
    case: &Case,
    mesh: &Mesh,
    found: &mut Diagnostics,
) -> (Vec<f64>, Option<f64>) {
    let expanding: Vec<(&Material, &Expansion)> = used(case)
        .filter_map(|material| Some((material, material.expansion.as_ref()?)))
        .collect();
    let given = case.initial_temperature.as_ref();
    let mut changes = case.steps.iter().flat_map(|step| &step.temperatures);
    let first = changes.next();
    if expanding.is_empty() {
        let place = first.map(|one| &one.place).or(given.map(|one| &one.place));
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
        (None, [(first, one), others @ ..]) => {
            let reference = one.free.value;
            if let Some((second, other)) = others
                .iter()
                .find(|(_, other)| other.free.value != reference)
            {
                found.push(
                    Diagnostic::error(
                        &codes::MISSING,
                        format!(
                            "materials \"{}\" and \"{}\" are without thermal strain at {reference} and {}: \
                             where does the run start?",
                            first.name.value, second.name.value, other.free.value
                        ),
                    )
                    .at(&other.free.place, "another reference than the first")
                    .help("write  [initial] temperature ="),
                );
            }
            reference
        }
    };
    (vec![start; mesh.nnode()], Some(start))
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
