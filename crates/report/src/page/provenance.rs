//! Section 8: where the results come from.

use super::cell::{count, number};
use crate::results::Results;
use crate::text::short;
use maud::{Markup, html};

/// The section.
pub fn section(results: &Results) -> Markup {
    let start = results.events_of("start").next();
    let threads = start.and_then(|event| event["threads"].as_u64());
    html! {
        section #provenance {
            h2 { "Provenance" }
            @if let Some(summary) = &results.summary {
                div.columns {
                    div {
                        table { tbody {
                            tr { th { "signorini" } td { (summary.version) } }
                            @if let Some(threads) = threads { tr { th { "threads" } td.number { (threads) } } }
                            tr { th { "unknowns" } (count(summary.unknowns, "unknowns")) }
                            tr { th { "largest memory" } td.number data-key="memory_peak_bytes" data-value=(summary.memory_peak_bytes) {
                                (short(summary.memory_peak_bytes as f64 / 1e6, 4)) " MB" } }
                        } }
                        p.hint { "Results do not depend on the number of threads." }
                    }
                    div {
                        table {
                            caption { "Wall time in seconds" }
                            tbody { @for (phase, seconds) in &summary.time {
                                tr { th { (phase) } (number(*seconds, &format!("time/{phase}"))) }
                            } }
                        }
                    }
                }
                table.wide {
                    caption { "Input files" }
                    thead { tr { th { "file" } th { "SHA-256" } } }
                    tbody { @for input in &summary.inputs {
                        tr { td { (input.path) } td { code.hash { (input.sha256) } } }
                    } }
                }
            } @else if let Some(start) = start {
                p { "signorini " (start["version"].as_str().unwrap_or_default()) ", "
                    (threads.unwrap_or(0)) " threads; the run has no summary." }
            } @else {
                p { "Neither a summary nor events say what wrote these results." }
            }
            @if let Some(text) = &results.resolved {
                details { summary { "The resolved case: all keys with what was run" } pre { (text) } }
            }
        }
    }
}
