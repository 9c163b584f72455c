//! One object for machines.

use super::count;
use crate::problem::{Kind, Tolerance};
use crate::solve::{Judged, exit_code};
use serde::Serialize;

#[derive(Serialize)]
struct Report<'a> {
    v: u32,
    command: &'static str,
    ok: bool,
    exit_code: u8,
    diagnostics: [(); 0],
    version: &'static str,
    passed: usize,
    failed: usize,
    seconds: f64,
    problems: Vec<Problem<'a>>,
}

#[derive(Serialize)]
struct Problem<'a> {
    name: &'a str,
    title: &'a str,
    source: &'a str,
    mesh: String,
    passed: bool,
    failure: Option<&'a str>,
    increments: u64,
    iterations: u64,
    seconds: f64,
    checks: Vec<Value<'a>>,
}

#[derive(Serialize)]
struct Value<'a> {
    quantity: &'a str,
    label: Kind,
    value: Option<f64>,
    reference: f64,
    difference: Option<f64>,
    tolerance: f64,
    relative_to: f64,
    why: &'a str,
    passed: bool,
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// The verdicts as one JSON object; numbers that are not finite are `null`.
#[must_use]
pub fn json(judged: &[Judged], seconds: f64) -> String {
    let [passed, failed] = count(judged);
    let report = Report {
        v: 1,
        command: "verify",
        ok: exit_code(judged) == 0,
        exit_code: exit_code(judged),
        diagnostics: [],
        version: signorini::VERSION,
        passed,
        failed,
        seconds,
        problems: judged.iter().map(of_problem).collect(),
    };
    // plain data with finite numbers or null: nothing can fail
    serde_json::to_string(&report).unwrap_or_default()
}

fn of_problem(judged: &Judged) -> Problem<'_> {
    let [increments, iterations] = judged.solved.effort;
    let value = |row: crate::solve::Row<'_>| {
        let check = row.check;
        Value {
            quantity: check.quantity,
            label: check.kind,
            value: finite(row.value),
            reference: check.reference,
            difference: finite(check.difference(row.value)),
            tolerance: check.tolerance.part(),
            relative_to: match check.tolerance {
                Tolerance::Relative(_) => check.reference.abs(),
                Tolerance::OfScale { scale, .. } => scale,
            },
            why: check.why,
            passed: row.passed,
        }
    };
    Problem {
        name: judged.problem.name,
        title: judged.problem.title,
        source: judged.problem.source,
        mesh: judged.setup.mesh.words(),
        passed: judged.passed(),
        failure: judged.solved.failure.as_deref(),
        increments,
        iterations,
        seconds: judged.solved.seconds,
        checks: judged.rows().into_iter().map(value).collect(),
    }
}
