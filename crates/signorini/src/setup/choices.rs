//! Automatic choices, written into the case.

use super::carriers::Carriers;
use super::{bodies, contact};
use signorini_io::case::{Case, Enforcement, HistorySource, Method, Per};
use signorini_mechanics::contact::Measure;
use signorini_mechanics::model::{self, ContactSummary, LockingSummary};

/// Writes into the case what was chosen where it leaves a choice.
pub(super) fn choose(
    case: &mut Case,
    carriers: &Carriers,
    contacts: &[ContactSummary],
    locking: &[LockingSummary],
) {
    for summary in contacts {
        let mut all = case.contacts.iter_mut();
        let Some(part) = all.find(|one| one.name.value == summary.name) else {
            continue;
        };
        if *part.method == Method::Auto {
            contact::choose(part, &summary.method);
        }
        contact::choose_sliding(part, summary);
        let chosen = Some(summary.penalty.into());
        match &mut part.enforcement {
            Enforcement::Augmented { penalty, .. } => *penalty = chosen,
            law @ (Enforcement::Auto | Enforcement::Penalty(_)) => {
                *law = match summary.enforcement {
                    model::Enforcement::Lagrange => Enforcement::Lagrange,
                    _ => Enforcement::Penalty(chosen),
                };
            }
            _ => {}
        }
        if part.enforcement != Enforcement::Lagrange {
            part.per = Some(match summary.measure {
                Measure::Area => Per::Area,
                Measure::Node => Per::Node,
            });
        }
        part.reach = Some(summary.reach);
    }
    let by_body = bodies::by_body(locking);
    for body in &mut case.bodies {
        let of_body = by_body.get(&*bodies::name(body));
        let mut chosen = of_body.into_iter().flatten().map(|one| one.locking);
        // elements and sizes of strains that differ leave the choice to the program
        if let Some(first) = chosen.next().filter(|first| chosen.all(|c| c == *first)) {
            body.locking.value = bodies::locking_word(first);
        }
    }
    // a rigid body of several groups, or with a reference, has many names and one set of columns
    for history in &mut case.output.history {
        if let HistorySource::Reference(name) = &mut history.source
            && let Some(own) = carriers.called(name)
        {
            name.value = own.to_owned();
        }
    }
}
