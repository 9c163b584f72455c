//! Whether facets resolve the zones in which joints break.

use super::info::ContactInfo;
use crate::text::short;
use signorini_io::case::Case;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};

/// A warning for each joint whose facets are too large for the zone in which it breaks.
pub(super) fn findings(case: &Case, contacts: &[ContactInfo]) -> Diagnostics {
    let mut found = Diagnostics::new();
    for info in contacts {
        let Some(of) = &info.cohesion else { continue };
        let (Some(zone), Some([opening, shear])) = (of.zone, of.reduced) else {
            continue;
        };
        let text = format!(
            "contact \"{}\": its joint breaks over a length of {}, {} facets of {}: {} are needed",
            info.name,
            short(zone),
            short(zone / of.facet),
            short(of.facet),
            short(of.resolved)
        );
        let one = Diagnostic::warning(&codes::UNRESOLVED_ZONE, text);
        let own = case.contacts.iter().find(|c| c.name.value == info.name);
        let one = match own {
            Some(contact) => one.at(&contact.place, ""),
            None => one,
        };
        found.push(
            one.note(
                "the load at which a crack grows depends on the toughness, hardly on the strength",
            )
            .help(format!(
                "facets of {}, or  cohesive = {{ strength = [{}, {}], .. }}  of contact \"{}\"",
                short(zone / of.resolved),
                short(opening),
                short(shear),
                info.name
            )),
        );
    }
    found
}
