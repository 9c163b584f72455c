//! Section 7: balances, the audit, the shapes of the elements.

use super::cell::{count, derived, node, number};
use crate::results::{Frame, Results};
use crate::text::{grouped, short, unit};
use maud::{Markup, html};
use serde_json::{Value, json};
use signorini_geometry::mesh::quality::{Quality, quality};
use signorini_io::readers::vtu::from_grid;
use signorini_io::writers::json::{AuditEntry, HeatEntry, HeatSummary, Summary};

/// The part of the external work that viscous forces may take.
const VISCOUS_MOST: f64 = 0.05;

/// The checks of the audit in words.
const CHECKS: [(&str, &str); 4] = [
    ("apart", "force on nodes that press where nothing touches"),
    (
        "direction",
        "force beyond the normal and the limit of friction",
    ),
    (
        "stress",
        "force that the stress behind the surface does not carry",
    ),
    (
        "through",
        "points inside of the other side, relative to a facet",
    ),
];

/// The shapes of the elements of a frame.
pub fn shapes(start: Option<&Frame>) -> Option<Quality> {
    let (mesh, _) = from_grid("frame", &start?.volume).ok()?;
    quality(&mesh, mesh.cells(mesh.dim()))
}

/// The histogram for the plot of this section.
pub fn data(quality: Option<&Quality>) -> Value {
    quality.map_or(Value::Null, |quality| {
        json!(quality.scaled_jacobian.classes)
    })
}

/// The section.
pub fn section(results: &Results, quality: Option<&Quality>, end: Option<&Frame>) -> Markup {
    html! {
        section #health {
            h2 { "Health" }
            div.columns {
                @if let Some(summary) = &results.summary { (energy(results, summary)) }
                @if let Some(heat) = results.summary.as_ref().and_then(|s| s.heat.as_ref()) { (of_heat(results, heat)) }
                (reactions(results, end))
                (elements(quality))
            }
            @if let Some(summary) = &results.summary { (audit(summary)) }
            @else { p { "The run has no summary: there is no audit of its states." } }
        }
    }
}

fn energy(results: &Results, summary: &Summary) -> Markup {
    let work = unit("work", results.units());
    let viscous = summary.work_stabilization;
    let part = match summary.work_external == 0.0 {
        true => 0.0,
        false => viscous / summary.work_external.abs(),
    };
    let last = results.history.rows.len().saturating_sub(1);
    let friction: Vec<(usize, &String)> = (results.history.columns.iter().enumerate())
        .filter(|(_, column)| column.ends_with(".work_friction"))
        .collect();
    html! {
        div {
            h3 { "Energy" }
            table { tbody {
                tr { th { "work of supports and loads" } (number(summary.work_external, "work_external")) td { (work) } }
                @if !results.history.rows.is_empty() {
                    @for (column, name) in friction {
                        tr {
                            th { "spent by friction, " (name.trim_end_matches(".work_friction")) }
                            (number(results.history.number(last, column), &format!("history.csv:{last}:{name}")))
                            td { (work) }
                        }
                    }
                }
                tr { th { "spent by viscous forces that hold what only contact stops" } (number(viscous, "work_stabilization")) td { (work) } }
                tr { th { "the same as part of the work" } (derived(part))
                    @if part.abs() < VISCOUS_MOST { td.good { "✓ below 5 %" } } @else { td.bad { "✗ above 5 %: bodies moved freely before contact held them, or nothing holds them" } } }
            } }
        }
    }
}

/// Heat that came in over time, or per time where nothing was stored.
fn of_heat(results: &Results, heat: &HeatSummary) -> Markup {
    let is_total = heat.total != HeatEntry::default();
    let (of, key, words) = match is_total {
        true => (&heat.total, "total", "since the start"),
        false => (&heat.rate, "rate", "per time"),
    };
    let unit = if is_total {
        unit("work", results.units())
    } else {
        String::new()
    };
    let rows = [
        ("by loads", of.loads, "loads"),
        ("from held temperatures", of.supports, "supports"),
        ("from rigid surfaces", of.surfaces, "surfaces"),
        ("of friction", of.friction, "friction"),
        ("taken up by bodies", of.stored, "stored"),
    ];
    html! {
        div {
            h3 { "Heat " (words) }
            table { tbody {
                @for (words, value, name) in rows {
                    tr { th { (words) } (number(value, &format!("heat/{key}/{name}"))) td { (unit) } }
                }
            } }
        }
    }
}

/// The sum of all reactions and what contacts leave unbalanced.
fn reactions(results: &Results, end: Option<&Frame>) -> Markup {
    let array = end.and_then(|frame| frame.volume.point_field("reaction_force"));
    let Some(array) = array.filter(|array| array.ncomponent == 3) else {
        return html! {};
    };
    let mut sum = [0.0; 3];
    for entry in array.numbers.to_f64().chunks_exact(3) {
        sum.iter_mut()
            .zip(entry)
            .for_each(|(sum, value)| *sum += value);
    }
    let force = unit("force", results.units());
    let axes = ["x", "y", "z"].into_iter().zip(sum);
    let axes = axes.filter(|(axis, _)| *axis == "y" || !results.is_axisymmetric());
    html! {
        div {
            h3 { "Reactions" }
            table { tbody {
                @for (axis, value) in axes {
                    tr { th { "sum of all reactions, " (axis) } (derived(value)) td { (force) } }
                }
            } }
            p.hint { "Of the last frame. It is opposite to all loads, and zero where the model is only moved." }
        }
    }
}

fn elements(quality: Option<&Quality>) -> Markup {
    html! {
        @if let Some(quality) = quality {
            div {
                h3 { "Elements" }
                div #plot-quality.plot {}
                p {
                    (grouped(quality.cells.len())) " elements; scaled Jacobian (1 ideal, 0 flat): worst "
                    (short(quality.scaled_jacobian.min, 3)) ", mean " (short(quality.scaled_jacobian.mean, 3))
                    "; shortest over longest edge: worst " (short(quality.edge_ratio.min, 3)) "."
                    @if quality.nbad > 0 { span.bad { " " (quality.nbad) " elements are turned inside out." } }
                }
            }
        }
    }
}

fn audit(summary: &Summary) -> Markup {
    let audit = &summary.audit;
    html! {
        @if !audit.contacts.is_empty() || audit.heat.is_some() {
            table.wide {
                caption { "Audit of all accepted states: each check measures a part that should be small" }
                thead { tr { th { "contact" } th { "check" } th.number { "part" } th.number { "limit" } th.number { "at time" } th.number { "increments above" } th { "nodes" } th { "" } } }
                tbody {
                    @for (name, checks) in &audit.contacts {
                        @for (check, entry) in checks {
                            (checked(name, meaning(check), entry, &format!("audit/contacts/{}/{check}", name.replace('/', "~1"))))
                        }
                    }
                    @if let Some(entry) = &audit.heat {
                        (checked("", "heat that comes in and is not taken up", entry, "audit/heat"))
                    }
                }
            }
            @if !audit.passed { p.note { "The audit did not pass: do not trust these results before the reason is known." } }
        }
    }
}

/// A row of the audit, whose entry the summary has under this key.
fn checked(name: &str, words: &str, entry: &AuditEntry, key: &str) -> Markup {
    let key = |rest: &str| format!("{key}/{rest}");
    html! {
        tr {
            td { (name) }
            td { (words) }
            (number(entry.part, &key("part")))
            (number(entry.limit, &key("limit")))
            (number(entry.time, &key("time")))
            (count(entry.increments, &key("increments")))
            td { @for label in entry.nodes.iter().take(6) { (node(i64::try_from(*label).unwrap_or(-1))) " " } }
            @if entry.passed { td.good { "✓" } } @else { td.bad { "✗ above the limit" } }
        }
    }
}

fn meaning(check: &str) -> &str {
    let known = CHECKS.iter().find(|(name, _)| *name == check);
    known.map_or(check, |(_, words)| words)
}
