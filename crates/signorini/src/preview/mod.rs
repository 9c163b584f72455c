//! What can be said about a model before anything is solved: sizes, shapes of elements, free motions, gaps, overlaps,
//! memory and time.

mod cost;
mod found;
mod picture;

pub use cost::Estimate;
pub use picture::picture;

use crate::run::{Start, begin};
use crate::setup::{ContactInfo, Model, gaps};
use crate::text::{count, plural, short};
use signorini_geometry::mesh::quality::{Quality, quality};
use signorini_geometry::mesh::{CellId, Mesh};
use signorini_geometry::tensor::Vec3;
use signorini_io::diagnostic::Diagnostics;
use signorini_mechanics::system::ContactFrame;
use std::collections::BTreeSet;

/// A look at a model.
#[derive(Clone, Debug)]
pub struct Preview {
    /// The undeformed state.
    pub start: Start,
    /// The shapes of the elements; none where there are none.
    pub quality: Option<Quality>,
    /// Memory and time; none where they are not known.
    pub estimate: Option<Estimate>,
    /// What there is to say, line by line.
    pub lines: Vec<String>,
}

/// Looks at a model.
///
/// # Errors
/// An undeformed state that cannot be evaluated: exit code 4.
pub fn preview(model: &mut Model) -> Result<Preview, Diagnostics> {
    let start = begin(model)?;
    let mesh = &model.mesh;
    let quality = quality(mesh, mesh.cells(mesh.dim()));
    let mut lines = Vec::new();
    lines.push(plural(mesh.nnode(), "node"));
    let solids = mesh.blocks.iter().filter(|b| b.element.dim() == mesh.dim());
    let cells: Vec<String> = solids
        .map(|b| format!("{} {}", count(b.ncell()), b.element.name()))
        .collect();
    lines.push(format!("elements: {}", cells.join(", ")));
    lines.push(plural(start.nunknown, "unknown"));
    lines.extend(quality.iter().flat_map(|quality| shapes(mesh, quality)));
    for body in &model.case.bodies {
        let groups: Vec<&str> = body.groups.iter().map(|g| g.value.as_str()).collect();
        let nodes = groups.iter().filter_map(|g| model.nodes_of(g)).flatten();
        let nodes: BTreeSet<u32> = nodes.collect();
        let kind = match &body.material {
            Some(material) if !body.rigid => format!("of {}", material.value),
            _ => "rigid".to_owned(),
        };
        lines.push(format!(
            "body {}: {kind}, {}",
            groups.join(" + "),
            plural(nodes.len(), "node")
        ));
    }
    let remedies = model.remedies();
    if !remedies.is_empty() {
        lines.push(format!("against locking: {}", remedies.join(", ")));
    }
    for info in model.contacts.iter().filter(|one| !one.is_found) {
        lines.push(format!(
            "contact {}: {}, {}, {}, {} against {} of size {}",
            info.name,
            info.method,
            info.enforcement,
            info.sliding,
            plural(info.npoint, "point"),
            plural(info.nfacet, "facet"),
            short(info.facet_size)
        ));
        let contact = start.frame.contacts.iter().find(|c| c.name == info.name);
        lines.extend(contact.map(|c| gaps(c, info, model)));
    }
    lines.extend(found::table(model, &start));
    let estimate = cost::estimate(model);
    lines.extend(estimate.iter().flat_map(|one| one.lines.iter().cloned()));
    Ok(Preview {
        start,
        quality,
        estimate,
        lines,
    })
}

/// The gaps of a contact in words.
fn gaps(contact: &ContactFrame, info: &ContactInfo, model: &Model) -> String {
    let near: Vec<(usize, f64)> = contact
        .gap
        .iter()
        .copied()
        .enumerate()
        .filter(|(_, gap)| gap.is_finite())
        .collect();
    let start = &info.start;
    let (Some(gap), false) = (start.gap, near.is_empty()) else {
        return "  nothing of the other side is within reach".to_owned();
    };
    let label = match &start.place {
        Some(place) => gaps::place(place, &model.mesh),
        None => {
            let least = near.iter().min_by(|a, b| a.1.total_cmp(&b.1));
            let node = least.and_then(|(at, _)| contact.nodes.get(*at));
            let label = node.and_then(|&n| model.mesh.node_labels.get(n as usize));
            label.map_or_else(String::new, |l| format!(" at node {l}"))
        }
    };
    let touching = start.touching;
    let gap = if gap < 0.0 {
        let what = gaps::treatment(start, &gaps::first_step(&model.case, &info.name));
        let what = what.map_or_else(String::new, |what| format!(", {what}"));
        format!("largest initial overlap {}{label}{what}", short(-gap))
    } else {
        format!("smallest gap {}{label}", short(gap))
    };
    let area: f64 = near.iter().filter_map(|(k, _)| contact.area.get(*k)).sum();
    let area = match contact.facets.is_empty() {
        true => String::new(),
        false => format!(" on an area of {}", short(area)),
    };
    format!(
        "  {} within reach{area}, {touching} touching, {gap}",
        plural(near.len(), "point")
    )
}

/// The shapes of the elements of a mesh, in three lines.
#[must_use]
pub fn shapes(mesh: &Mesh, quality: &Quality) -> Vec<String> {
    let Some(worst) = quality.worst.first() else {
        return Vec::new();
    };
    let tenths = quality.scaled_jacobian.classes.map(count);
    let edges = &quality.edge_ratio;
    vec![
        format!(
            "quality (1 ideal, 0 flat): worst {:.2}, {} at {}",
            worst.scaled_jacobian,
            mesh.element(worst.cell).map_or("", |e| e.name()),
            center(mesh, worst.cell)
        ),
        format!("  elements by tenths from 0 to 1: {}", tenths.join(" | ")),
        format!(
            "  shortest over longest edge: worst {:.2}, mean {:.2}",
            edges.min, edges.mean
        ),
    ]
}

/// `element 17 (x = 1.00, y = 0, z = 2.50)`.
fn center(mesh: &Mesh, cell: CellId) -> String {
    let nodes = mesh.cell(cell).iter();
    let points = nodes.filter_map(|&n| mesh.points.get(n as usize).copied());
    let (sum, n) = points.fold((Vec3::ZERO, 0.0), |(s, n), x| (s + x, n + 1.0));
    let at = sum / f64::max(n, 1.0);
    format!(
        "element {} (x = {}, y = {}, z = {})",
        mesh.cell_label(cell).unwrap_or(0),
        short(at.x),
        short(at.y),
        short(at.z)
    )
}
