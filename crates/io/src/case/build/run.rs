//! Solver, output, checkpoints, expectations.

use super::super::fields::Fields;
use super::super::parts::*;
use super::super::scalar::shortened;
use super::builder::Builder;
use crate::diagnostic::{Place, Spanned, codes};

impl Builder<'_> {
    pub(super) fn solver(&mut self, fields: Fields<'_>) -> Solver {
        let newton = fields.table("newton");
        let linear = fields.text("linear");
        if fields.flag_if("stabilize") == Some(true) {
            self.error(
                &codes::NOT_A_CHOICE,
                "`stabilize` takes \"auto\" or false",
                &fields.place("stabilize"),
                "write \"auto\"",
            );
        }
        Solver {
            newton: Newton {
                max_iterations: newton.count("max_iterations"),
                force_tol: newton.number("force_tol"),
                gap_tol: newton.number("gap_tol"),
                line_search: match newton.flag_if("line_search") {
                    Some(true) => LineSearch::On,
                    Some(false) => LineSearch::Off,
                    None => LineSearch::Auto,
                },
                stress: match newton.text("stress").value.as_str() {
                    "mixed" => GeometricStress::Mixed,
                    "current" => GeometricStress::Current,
                    _ => GeometricStress::Auto,
                },
            },
            linear: Spanned {
                value: match linear.value.as_str() {
                    "direct" => LinearChoice::Direct,
                    "multigrid" => LinearChoice::Multigrid,
                    "mumps" => LinearChoice::Mumps,
                    "petsc" => LinearChoice::Petsc,
                    _ => LinearChoice::Auto,
                },
                place: linear.place,
            },
            stabilize: if fields.has("stabilize") && fields.flag_if("stabilize") == Some(false) {
                Stabilize::Off
            } else {
                Stabilize::Auto
            },
            free_motions: match fields.text("free_motions").value.as_str() {
                "hold" => FreeMotions::Hold,
                _ => FreeMotions::Refuse,
            },
            on_trouble: fields
                .texts("on_trouble")
                .iter()
                .map(|word| match word.value.as_str() {
                    "cut" => Remedy::Cut,
                    "points" => Remedy::Points,
                    _ => Remedy::Stabilize,
                })
                .collect(),
            threads: fields.count_if("threads").map(|count| count.value),
        }
    }

    pub(super) fn checkpoint(&mut self, fields: Fields<'_>) -> Checkpoint {
        let keep = fields.count("keep");
        let every = fields.table("every");
        if !fields.has("every") {
            return Checkpoint {
                increments: Some(5),
                wall: Some(600.0),
                keep,
            };
        }
        let wall = every.text_if("wall").and_then(|text| {
            let seconds = seconds(&text);
            if seconds.is_none() {
                self.error(
                    &codes::NOT_A_CHOICE,
                    format!("`wall` knows no time \"{}\"", shortened(&text)),
                    &text.place,
                    "a number and a unit: \"30 s\", \"10 min\" or \"2 h\"",
                );
            }
            seconds
        });
        Checkpoint {
            increments: every.count_if("increments").map(|count| count.value),
            wall,
            keep,
        }
    }
}

pub(super) fn output(fields: Fields<'_>) -> Output {
    let every = match fields.table("every").number_if("time") {
        Some(time) => Every::Time(time.value),
        None => Every::Increments(fields.count("every")),
    };
    let history = fields
        .tables("history")
        .into_iter()
        .map(|(one, place)| History {
            name: one.text("name"),
            quantities: one.texts("quantity"),
            source: if one.has("contact") {
                HistorySource::Contact(one.text("contact"))
            } else if one.has("reference") {
                HistorySource::Reference(one.text("reference"))
            } else if one.has("set") {
                HistorySource::Set(one.text("set"))
            } else {
                HistorySource::Node(one.count_if("node").unwrap_or_default())
            },
            place,
        });
    Output {
        format: fields.texts("format"),
        fields: fields.texts("fields"),
        smooth_pressures: fields.text("contact_pressure").value == "smoothed",
        every,
        history: history.collect(),
    }
}

/// The part of all cycles for which the first stands.
const FIRST: u64 = 10_000;

pub(super) fn cycles(root: &Fields<'_>) -> Vec<Cycle> {
    let all = root.tables("cycle").into_iter();
    all.map(|(fields, place)| cycle(fields, place)).collect()
}

fn cycle(fields: Fields<'_>, place: Place) -> Cycle {
    let count = fields.count("count").max(1);
    let jump = fields.table("jump");
    let first = jump.count_if("first").map(|first| first.value);
    Cycle {
        steps: fields.texts("steps"),
        count,
        jump: fields.has("jump").then(|| Jump {
            tol: jump.number("tol"),
            first: first.unwrap_or(count / FIRST).max(1),
            max_wear: jump.number_if("max_wear").map(|depth| depth.value),
        }),
        place,
    }
}

pub(super) fn expectation(fields: Fields<'_>, place: Place) -> Expectation {
    let at = match (fields.count_if("at"), fields.number_if("time")) {
        (Some(row), _) => Moment::Row(row.value),
        (None, Some(time)) => Moment::Time(time.value),
        (None, None) => Moment::End,
    };
    let tol = fields.table("tol");
    let tolerance = match tol.number_if("abs") {
        Some(abs) => Tolerance::Absolute(abs.value),
        None => Tolerance::Relative(tol.number("rel")),
    };
    Expectation {
        what: fields.text("what"),
        at,
        value: fields.number("value"),
        tolerance,
        place,
    }
}

/// Seconds of a time such as `10 min`, `2h`, `1.5 hours`.
fn seconds(text: &str) -> Option<f64> {
    let text = text.trim();
    let end = text.find(|c: char| c.is_alphabetic()).unwrap_or(text.len());
    let number: f64 = text.get(..end)?.trim().parse().ok()?;
    let unit = match text.get(end..)?.trim() {
        "s" | "sec" | "second" | "seconds" => 1.0,
        "min" | "minute" | "minutes" => 60.0,
        "h" | "hour" | "hours" => 3600.0,
        "d" | "day" | "days" => 86400.0,
        _ => return None,
    };
    let seconds = number * unit;
    (seconds.is_normal() && seconds > 0.0).then_some(seconds)
}
