//! Steps that come again.

use super::quoted;
use signorini_io::case::{self, Case};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_mechanics::solve::{Cycle, Jump};

/// The cycles of a case, by the places of their steps.
pub(super) fn cycles(case: &Case, found: &mut Diagnostics) -> Vec<Cycle> {
    let mut cycles: Vec<Cycle> = Vec::new();
    for one in &case.cycles {
        let Some(steps) = steps(case, one, found) else {
            continue;
        };
        let [first, last] = steps;
        if cycles
            .iter()
            .any(|other| first <= other.steps[1] && other.steps[0] <= last)
        {
            found.push(wrong(
                one,
                "a step belongs to two cycles",
                "give each step to one",
            ));
        }
        let wears = case.contacts.iter().any(|contact| contact.wear.is_some());
        if one.jump.is_some() && !wears {
            let remark = "delete `jump`, or give a contact  wear = { coefficient = .. }";
            found.push(wrong(
                one,
                "one cycle stands for many where nothing wears",
                remark,
            ));
        }
        if one.jump.is_some() && case.general.is_some() {
            let remark = "name the sides of contacts, or delete `jump`";
            found.push(wrong(
                one,
                "`jump` does not go with a contact of `all`",
                remark,
            ));
        }
        cycles.push(Cycle {
            steps,
            count: usize::try_from(one.count).unwrap_or(usize::MAX),
            jump: one.jump.map(|jump| Jump {
                tol: jump.tol,
                first: usize::try_from(jump.first).unwrap_or(usize::MAX),
                max_wear: jump.max_wear,
            }),
        });
    }
    cycles
}

/// The first and the last of the steps of a cycle, which follow one another.
fn steps(case: &Case, one: &case::Cycle, found: &mut Diagnostics) -> Option<[usize; 2]> {
    let mut places = Vec::new();
    for name in &one.steps {
        let place = case
            .steps
            .iter()
            .position(|step| step.name.value == name.value);
        let Some(place) = place else {
            let message = format!("there is no step {}", quoted(name));
            found
                .push(Diagnostic::error(&codes::UNDEFINED, message).at(&name.place, "not defined"));
            return None;
        };
        places.push(place);
    }
    let (first, last) = (*places.first()?, *places.last()?);
    if !places.iter().copied().eq(first..=last) {
        let remark = "name steps in the order in which the case has them";
        found.push(wrong(
            one,
            "the steps of a cycle do not follow one another",
            remark,
        ));
        return None;
    }
    Some([first, last])
}

fn wrong(one: &case::Cycle, message: &str, remark: &str) -> Diagnostic {
    Diagnostic::error(&codes::CONTRADICTION, message.to_owned())
        .at(&one.place, "this cycle")
        .help(remark)
}
