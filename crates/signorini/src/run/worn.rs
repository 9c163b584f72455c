//! What a run says of contacts that are worn deep.

use crate::setup::Model;
use crate::text::short;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};

/// A warning for each contact that is worn beyond its limit: its name, how deep, over the size of its facets, and where.
pub(super) fn warnings(worn: &[(String, f64, u32)], model: &Model) -> Diagnostics {
    let mut found = Diagnostics::new();
    for (name, ratio, node) in worn {
        let part = model.case.contacts.iter().find(|c| c.name.value == *name);
        let Some(wear) = part.and_then(|part| part.wear) else {
            continue;
        };
        if *ratio <= wear.limit {
            continue;
        }
        let size = model.contacts.iter().find(|c| c.name == *name);
        let size = size.map_or(f64::NAN, |c| c.facet_size);
        let label = model.mesh.node_labels.get(*node as usize);
        let label = label.copied().unwrap_or_default();
        let text = format!(
            "contact \"{name}\" is worn {} deep at node {label}, where facets have a size of {}",
            short(ratio * size),
            short(size)
        );
        let one = Diagnostic::warning(&codes::WORN_DEEP, text)
            .note("nodes stay where they are: the bodies are as thick as before")
            .help(format!(
                "where that is meant:  wear = {{ .., limit = {} }}  of contact \"{name}\"",
                short(2.0 * ratio)
            ));
        found.push(one);
    }
    found
}
