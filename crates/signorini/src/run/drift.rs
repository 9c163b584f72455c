//! What a run says of contacts that keep the geometry of the start and slid far.

use crate::setup::Model;
use crate::text::short;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};

/// A warning for each contact that slid by more than a facet: its name, how far, over the size of its facets, and where.
pub(super) fn warnings(drifts: &[(String, f64, u32)], model: &Model) -> Diagnostics {
    let mut found = Diagnostics::new();
    for (name, ratio, node) in drifts.iter().filter(|(_, ratio, _)| *ratio > 1.0) {
        let size = model.contacts.iter().find(|c| c.name == *name);
        let size = size.map_or(f64::NAN, |c| c.facet_size);
        let label = model.mesh.node_labels.get(*node as usize);
        let label = label.copied().unwrap_or_default();
        let text = format!(
            "contact \"{name}\" keeps the geometry of the start, and node {label} has slid by {} along facets of size {}",
            short(ratio * size),
            short(size)
        );
        let one = Diagnostic::warning(&codes::FAR_FROM_START, text)
            .note("it still presses on the facets that were opposite at the start")
            .help(format!(
                "write  sliding = \"finite\"  of contact \"{name}\""
            ))
            .help("where displacements are large:  geometry = \"nonlinear\"  of the steps");
        found.push(one);
    }
    found
}
