//! What can be said about a model before anything is solved: sizes, gaps, overlaps, memory.

use crate::build::Model;
use crate::run::{Fields, Start, Volume, begin};
use crate::text::{count, plural, short};
use signorini_io::diagnostic::Diagnostics;
use signorini_io::writers::vtu::VtuError;
use signorini_mechanics::system::ContactFrame;
use std::collections::BTreeSet;

/// A look at a model.
#[derive(Clone, Debug)]
pub struct Preview {
    /// The undeformed state.
    pub start: Start,
    /// What there is to say, line by line.
    pub lines: Vec<String>,
}

/// Numbers of a stiffness matrix and its factor for each unknown, and bytes of each: rough values for solids of linear
/// elements in space; the factor grows with the size of the model.
const MATRIX_ENTRIES: f64 = 81.0;
const FACTOR_GROWTH: f64 = 7.0;
const BYTES: f64 = 12.0;

/// Looks at a model.
///
/// # Errors
/// An undeformed state that cannot be evaluated: exit code 4.
pub fn preview(model: &mut Model) -> Result<Preview, Diagnostics> {
    let start = begin(model)?;
    let mesh = &model.mesh;
    let mut lines = Vec::new();
    lines.push(plural(mesh.nnode(), "node"));
    let solids = mesh.blocks.iter().filter(|b| b.element.dim() == mesh.dim());
    let cells: Vec<String> = solids
        .map(|b| format!("{} {}", count(b.ncell()), b.element.name()))
        .collect();
    lines.push(format!("elements: {}", cells.join(", ")));
    lines.push(plural(start.nunknown, "unknown"));
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
    for info in &model.contacts {
        lines.push(format!(
            "contact {}: {}, penalty {} per {}, {} against {} of size {}",
            info.name,
            info.method,
            short(info.penalty),
            info.per,
            plural(info.npoint, "point"),
            plural(info.nfacet, "facet"),
            short(info.facet_size)
        ));
        let contact = start.frame.contacts.iter().find(|c| c.name == info.name);
        lines.extend(contact.map(|c| gaps(c, model)));
    }
    lines.push(format!("memory: about {}", bytes(memory(start.nunknown))));
    Ok(Preview { start, lines })
}

/// The gaps of a contact in words.
fn gaps(contact: &ContactFrame, model: &Model) -> String {
    let near: Vec<(usize, f64)> = contact
        .gap
        .iter()
        .copied()
        .enumerate()
        .filter(|(_, gap)| gap.is_finite())
        .collect();
    let Some(&(at, gap)) = near.iter().min_by(|a, b| a.1.total_cmp(&b.1)) else {
        return "  nothing of the other side is within reach".to_owned();
    };
    let node = contact.nodes.get(at);
    let label = node.and_then(|&n| model.mesh.node_labels.get(n as usize));
    let label = label.map_or_else(String::new, |l| format!(" at node {l}"));
    let touching = near.iter().filter(|(_, gap)| *gap <= 0.0).count();
    let gap = if gap < 0.0 {
        format!("largest initial overlap {}{label}", short(-gap))
    } else {
        format!("smallest gap {}{label}", short(gap))
    };
    format!(
        "  {} within reach, {touching} touching, {gap}",
        plural(near.len(), "point")
    )
}

/// The memory that a direct solution needs, in bytes.
fn memory(nunknown: usize) -> f64 {
    let n = nunknown as f64;
    // nested dissection in space: the factor has about n log n to n^(4/3) entries
    let factor = FACTOR_GROWTH * n * n.max(1.0).powf(1.0 / 3.0);
    BYTES * (MATRIX_ENTRIES * n + factor) + 2e7
}

fn bytes(bytes: f64) -> String {
    if bytes < 1e9 {
        format!("{:.0} MB", (bytes / 1e6).max(1.0))
    } else {
        format!("{:.1} GB", bytes / 1e9)
    }
}

/// `check.vtu`: the undeformed solids with what is known of contact.
///
/// # Errors
/// Arrays of another mesh.
pub fn picture(model: &Model, preview: &Preview) -> Result<Vec<u8>, VtuError> {
    let fields = Fields {
        contact: true,
        ..Fields::default()
    };
    Volume::new(&model.mesh, fields).encode(&preview.start.frame)
}
