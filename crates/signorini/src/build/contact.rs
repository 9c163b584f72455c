//! Contacts.

use super::names::Names;
use signorini_io::case::{self, Enforcement, Per};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_mechanics::contact::Measure;
use signorini_mechanics::model::{self, ContactPart, PrimaryPart, SidePart};

pub(super) fn contact(
    part: &case::Contact,
    names: &Names<'_>,
    found: &mut Diagnostics,
) -> Option<ContactPart> {
    let primary = names.faces(&part.primary, "the primary side", found);
    let secondary = names.side(&part.secondary, found);
    if part.primary.value == part.secondary.value {
        found.push(
            Diagnostic::error(
                &codes::BAD_SIDES,
                format!(
                    "both sides of contact \"{}\" are \"{}\"",
                    part.name.value, part.primary.value
                ),
            )
            .at(&part.secondary.place, "the same as `primary`")
            .help("name two different surfaces"),
        );
        return None;
    }
    let (penalty, measure) = match &part.enforcement {
        Enforcement::Auto => (None, None),
        Enforcement::Penalty { penalty, per } => (
            penalty.as_ref().map(|p| p.value),
            per.map(|p| match p {
                Per::Node => Measure::Node,
                Per::Area => Measure::Area,
            }),
        ),
    };
    let secondary = secondary?;
    if measure == Some(Measure::Area) && matches!(secondary, SidePart::Nodes(_)) {
        found.push(
            Diagnostic::error(
                &codes::WRONG_KIND,
                format!(
                    "contact \"{}\": \"{}\" is bare nodes, a penalty per area needs faces",
                    part.name.value, part.secondary.value
                ),
            )
            .at(&part.secondary.place, "no whole face of a solid")
            .help("write  per = \"node\"  in `enforcement`, or name a surface"),
        );
        return None;
    }
    let primary = PrimaryPart::Faces(primary?);
    Some(ContactPart {
        enforcement: penalty.map_or(model::Enforcement::Auto, |p| {
            model::Enforcement::Penalty(Some(p))
        }),
        measure,
        reach: part.reach,
        ..ContactPart::new(part.name.value.clone(), secondary, primary)
    })
}
