//! Section 6: how the solution converged.

use super::cell::node;
use crate::results::Results;
use crate::text::{grouped, short};
use maud::{Markup, html};
use serde_json::{Value, json};

/// More iterations than these are not plotted one by one.
const ITERATIONS_MOST: usize = 20_000;

/// The section.
pub fn section(results: &Results) -> Markup {
    let table = &results.convergence;
    let cutbacks: Vec<&Value> = results.events_of("cutback").collect();
    html! {
        section #convergence {
            h2 { "Convergence" }
            @if table.rows.is_empty() && results.history.rows.is_empty() {
                p { "No increment converged and no iteration was written." }
            } @else {
                div.plots { div #plot-size.plot {} div #plot-iterations.plot {} div #plot-residual.plot.wide {} div #plot-flips.plot.wide {} }
                @if table.rows.len() > ITERATIONS_MOST {
                    p.note { "Of " (grouped(table.rows.len())) " iterations the last " (grouped(ITERATIONS_MOST)) " are plotted." }
                }
            }
            @if !cutbacks.is_empty() {
                details open[cutbacks.len() < 12] {
                    summary { (cutbacks.len()) " cut-backs" }
                    table {
                        thead { tr { th { "step" } th.number { "increment" } th.number { "attempt" } th.number { "time" } th.number { "next size" } th { "reason" } } }
                        tbody { @for one in cutbacks.iter().take(500) { tr {
                            td { (one["step"].as_str().unwrap_or_default()) }
                            td.number { (one["inc"]) }
                            td.number { (one["att"]) }
                            td.number { (short(one["time"].as_f64().unwrap_or(f64::NAN), 6)) }
                            td.number { (short(one["size"].as_f64().unwrap_or(f64::NAN), 4)) }
                            td { (one["why"].as_str().unwrap_or_default()) }
                        } } }
                    }
                }
            }
            (worst(results))
        }
    }
}

/// The nodes of the largest residual, by how often they had it.
fn worst(results: &Results) -> Markup {
    let nodes = results.convergence.texts("worst_node");
    let mut counts: Vec<(i64, usize)> = Vec::new();
    for label in nodes.iter().filter_map(|text| text.parse::<i64>().ok()) {
        match counts.iter_mut().find(|(known, _)| *known == label) {
            Some((_, count)) => *count += 1,
            None => counts.push((label, 1)),
        }
        if counts.len() > 5_000 {
            break;
        }
    }
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    html! {
        @if !counts.is_empty() {
            p { "Nodes that had the largest residual most often: "
                @for (k, (label, count)) in counts.iter().take(12).enumerate() {
                    @if k > 0 { ", " }
                    (node(*label)) " (" (count) "×)"
                }
                "."
            }
        }
    }
}

/// What the plots of this section need.
pub fn data(results: &Results) -> Value {
    let table = &results.convergence;
    let first = table.rows.len().saturating_sub(ITERATIONS_MOST);
    let tail = |name: &str| -> Vec<f64> { table.numbers(name).into_iter().skip(first).collect() };
    let steps: Vec<&str> = table.texts("step").into_iter().skip(first).collect();
    let cutbacks: Vec<Value> = results
        .events_of("cutback")
        .map(|e| json!({"time": e["time"], "size": e["size"], "why": e["why"]}))
        .collect();
    json!({
        "step": steps,
        "increment": tail("increment"),
        "attempt": tail("attempt"),
        "iteration": tail("iteration"),
        "residual": tail("residual"),
        "flips": tail("flips"),
        "closed": tail("closed"),
        "worst": tail("worst_node"),
        "cutbacks": cutbacks,
    })
}
