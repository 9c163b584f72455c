//! Section 1: how the run ended, its expectations and its messages.

use super::cell::{exact, number};
use crate::results::Results;
use crate::text::{plural, short};
use maud::{Markup, html};
use signorini_io::writers::json::Summary;

/// How good an ending is: a class of the style sheet, and words.
fn verdict(results: &Results) -> (&'static str, String) {
    let Some(summary) = &results.summary else {
        let rows = results.history.rows.len();
        let last = results.history.numbers("time").last().copied();
        let reached = last.map_or_else(String::new, |time| {
            format!(", up to time {}", short(time, 6))
        });
        return (
            "unfinished",
            format!(
                "No ending: the run goes on or was killed; {} on disk{reached}",
                plural(rows, "converged increment")
            ),
        );
    };
    let missed = summary.expectations.iter().filter(|one| !one.ok).count();
    let of = |sum: fn(&signorini_io::writers::json::StepSummary) -> u64| {
        summary.steps.iter().map(sum).sum::<u64>() as usize
    };
    let counts = format!(
        "{}, {}, {}",
        plural(of(|s| s.increments), "increment"),
        plural(of(|s| s.iterations), "iteration"),
        plural(of(|s| s.cutbacks), "cut-back")
    );
    let status = &summary.status;
    match summary.exit_code {
        0 if missed == 0 => {
            let met = match summary.expectations.len() {
                0 => "no expectations were given".to_owned(),
                1 => "the expectation is met".to_owned(),
                n => format!("all {n} expectations are met"),
            };
            ("solved", format!("{} · {counts} · {met}", capital(status)))
        }
        0 | 1 => {
            let of = plural(summary.expectations.len(), "expectation");
            let why = match missed {
                0 => "see the messages below".to_owned(),
                n => format!("{n} of {of} not met"),
            };
            ("missed", format!("{} · {counts} · {why}", capital(status)))
        }
        8 | 130 | 143 => (
            "unfinished",
            format!("{} · {counts} · can be resumed", capital(status)),
        ),
        _ => ("failed", format!("{} · {counts}", capital(status))),
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

/// The section.
pub fn section(results: &Results, notes: &[String]) -> Markup {
    let (class, words) = verdict(results);
    html! {
        section #verdict {
            div.banner.(class) role="status" {
                strong { (words) }
                @if let Some(summary) = &results.summary {
                    span.code { "exit code " span data-key="exit_code" data-value=(summary.exit_code) { (summary.exit_code) } }
                }
            }
            @if let Some(summary) = &results.summary {
                (expectations(summary))
                (messages(summary))
            }
            @for note in notes { p.note { (note) } }
        }
    }
}

fn expectations(summary: &Summary) -> Markup {
    html! {
        @if !summary.expectations.is_empty() {
            table {
                caption { "Expectations of the case" }
                thead { tr { th { "quantity" } th.number { "expected" } th.number { "found" } th.number { "difference" } th { "" } } }
                tbody {
                    @for (k, one) in summary.expectations.iter().enumerate() {
                        tr {
                            td { (one.what) }
                            (number(one.value, &format!("expectations/{k}/value")))
                            (number(one.got, &format!("expectations/{k}/got")))
                            td.number { (difference(one.got, one.value)) }
                            @if one.ok { td.good { "✓ met" } } @else { td.bad { "✗ missed" } }
                        }
                    }
                }
            }
        }
    }
}

/// The difference relative to the expected value, in percent.
fn difference(got: f64, value: f64) -> String {
    match value == 0.0 {
        true => short(got, 3),
        false => format!("{} %", short(100.0 * (got - value) / value.abs(), 3)),
    }
}

fn messages(summary: &Summary) -> Markup {
    html! {
        @if !summary.diagnostics.is_empty() {
            table.messages {
                caption { "Messages" }
                tbody {
                    @for one in &summary.diagnostics {
                        tr {
                            td { code { (one.code) } }
                            td { (one.message) }
                        }
                    }
                }
            }
            p.hint { "Each code is explained by " code { "signorini explain CODE" } "." }
        }
        @if summary.audit != Default::default() && !summary.audit.passed {
            p.note {
                "The audit of the results found something wrong: see " a href="#health" { "Health" } ". External work "
                (exact(summary.audit.work_external)) "."
            }
        }
    }
}
