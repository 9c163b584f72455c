//! Whether increments of transient steps suit the elements that heat goes through: their Fourier number Fo = k Δt/(ρ c h²).

use super::bodies;
use super::names::Names;
use crate::text::short;
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_io::case::{Body, Case, Conductivity, Material};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Severity, codes};
use signorini_mechanics::solve::{Increments, Motion, Step};
use signorini_mechanics::system::{Heat, Layout};
use std::collections::BTreeSet;

/// Below this, temperatures of linear elements that store heat between their nodes overshoot where one jumps next to them: the heat
/// that a node stores for its neighbour, ρ c h/6, is then more than what it conducts there, k Δt/h.
const MONOTONE: f64 = 1.0 / 6.0;

/// Fourier numbers of the smallest element beyond these are more often those of mixed units than meant.
const USUAL: [f64; 2] = [1e-6, 1e6];

/// What is found of each body in the first transient step in which it is.
pub(super) fn findings(
    case: &Case,
    (names, mesh): (&Names<'_>, &Mesh),
    (layout, steps): (&Layout, &[Step]),
) -> Diagnostics {
    let mut found = Diagnostics::new();
    let transient = |step: &&Step| step.physics.heat == Heat::Transient;
    for body in case.bodies.iter().filter(|body| !body.rigid) {
        let Some(diffusivity) = diffusivity(case, body) else {
            continue;
        };
        let groups = body.groups.iter();
        let cells = groups.flat_map(|g| names.cells(g, &mut Diagnostics::new()).solids);
        let cells: Vec<CellId> = cells.collect();
        let of_step = |step: &Step| {
            let jumps = jumps(layout, step);
            finding(body, step, diffusivity, &Sizes::new(mesh, &cells, &jumps))
        };
        let first = steps.iter().filter(transient).find_map(of_step);
        if let Some(one) = first {
            found.push(one);
        }
    }
    found
}

fn finding(body: &Body, step: &Step, diffusivity: f64, sizes: &Sizes) -> Option<Diagnostic> {
    let name = bodies::name(body);
    let dt = match step.increments {
        Increments::Fixed(count) => step.duration / count as f64,
        Increments::Adaptive { initial, .. } => initial,
    };
    let number = |size: f64| diffusivity * dt / (size * size);
    let fourier = number(sizes.smallest);
    if !(USUAL[0]..=USUAL[1]).contains(&fourier) {
        let text = format!(
            "body \"{name}\": in an increment of {} of step \"{}\", heat goes {} elements far",
            short(dt),
            step.name,
            short(fourier.sqrt())
        );
        let one = Diagnostic::new(Severity::Note, &codes::ODD_FOURIER, text)
            .at(&body.place, "")
            .note(format!(
                "k/(ρ c) is {}, the smallest element {}: is all of it in the same units?",
                short(diffusivity),
                short(sizes.smallest)
            ));
        return Some(one);
    }
    let crossed = sizes.crossed.filter(|size| number(*size) < MONOTONE)?;
    if body.lumped_capacity {
        return None;
    }
    let least = MONOTONE * crossed * crossed / diffusivity;
    let text = format!(
        "body \"{name}\": temperatures may overshoot in step \"{}\": its increments of {} are short for elements of {}",
        step.name,
        short(dt),
        short(crossed)
    );
    let one = Diagnostic::warning(&codes::OVERSHOOT, text)
        .at(&body.place, "")
        .note(format!(
            "k Δt/(ρ c h²) is {}, less than 1/6",
            short(number(crossed))
        ))
        .help(format!(
            "store heat at nodes:  capacity = \"lumped\"  of body \"{name}\""
        ))
        .help(format!(
            "or increments of {} and longer, or smaller elements",
            short(least)
        ));
    Some(one)
}

/// The largest k/(ρ c) that a body has at any temperature; none of what stores no heat.
fn diffusivity(case: &Case, body: &Body) -> Option<f64> {
    let name = body.material.as_ref()?;
    let mut all = case.materials.iter();
    let material: &Material = all.find(|one| one.name.value == name.value)?;
    let heat = material.heat.as_ref()?;
    let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let conductivity = match &heat.conductivity {
        Conductivity::Isotropic(rows) => rows.iter().map(|row| row[1]).fold(0.0, f64::max),
        Conductivity::Along(values) => largest(values),
        Conductivity::Full(rows) => rows
            .iter()
            .map(|row| largest(&row[1..4]))
            .fold(0.0, f64::max),
    };
    let specific = heat.specific_heat.iter().map(|row| row[1]);
    let stored = material.density.as_ref()?.value * specific.reduce(f64::min)?;
    Some(conductivity / stored).filter(|of| of.is_finite() && *of > 0.0)
}

/// The nodes whose temperature jumps where a step begins.
fn jumps(layout: &Layout, step: &Step) -> BTreeSet<NodeId> {
    let given = step.prescriptions.iter();
    let given = given.filter(|one| matches!(one.motion, Motion::Table(_)));
    let names = given.filter_map(|one| {
        let name = layout.name(one.dof)?;
        (layout.temperature(name.entity) == one.dof).then_some(name.entity)
    });
    names.collect()
}

/// Lengths of edges of the elements of a body.
struct Sizes {
    /// The shortest of all.
    smallest: f64,
    /// Of linear elements at nodes whose temperature jumps, the shortest that leads away from these, the longest of all elements; of
    /// a body without such nodes, the shortest of its linear elements. None without linear elements.
    crossed: Option<f64>,
}

impl Sizes {
    fn new(mesh: &Mesh, cells: &[CellId], jumps: &BTreeSet<NodeId>) -> Self {
        let mut smallest = f64::INFINITY;
        let (mut linear, mut away) = (None, None);
        for &cell in cells {
            let Some(element) = mesh.element(cell) else {
                continue;
            };
            let nodes = mesh.cell(cell);
            let mut shortest = [f64::INFINITY; 2];
            for &[a, b] in element.edges() {
                let (Some(&a), Some(&b)) = (nodes.get(a), nodes.get(b)) else {
                    continue;
                };
                let [from, to] = [a, b].map(|node| mesh.points.get(node as usize).copied());
                let (Some(from), Some(to)) = (from, to) else {
                    continue;
                };
                let length = (to - from).norm();
                shortest[0] = shortest[0].min(length);
                if jumps.contains(&a) != jumps.contains(&b) {
                    shortest[1] = shortest[1].min(length);
                }
            }
            smallest = f64::min(smallest, shortest[0]);
            if element.order() > 1 {
                continue;
            }
            let [any, leading] = shortest;
            linear = Some(linear.map_or(any, |least: f64| least.min(any)));
            if leading.is_finite() {
                away = Some(away.map_or(leading, |most: f64| most.max(leading)));
            }
        }
        Self {
            smallest,
            crossed: away.or(linear),
        }
    }
}
