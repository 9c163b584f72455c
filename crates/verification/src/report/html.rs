//! One self-contained page without scripts.

use super::{allowed, count, difference, number};
use crate::solve::Judged;
use std::fmt::Write;

const STYLE: &str = "body{font:15px/1.4 sans-serif;margin:2em auto;max-width:70em;padding:0 1em;color:#222}\
table{border-collapse:collapse;width:100%}\
th,td{text-align:left;padding:.25em .6em;border-bottom:1px solid #ddd;vertical-align:top}\
td.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}\
tr.p td{background:#f3f3f3;font-weight:bold;border-top:2px solid #999}\
tr.s td{color:#555}.ok{color:#17701a}.no{color:#b00020;font-weight:bold}\
@media print{body{margin:0;max-width:none}tr{break-inside:avoid}}";

/// A text without signs that HTML reads as its own.
fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    text.replace('>', "&gt;").replace('"', "&quot;")
}

fn mark(passed: bool) -> &'static str {
    match passed {
        true => "<span class=\"ok\">✓</span>",
        false => "<span class=\"no\">✗</span>",
    }
}

/// The verdicts as a page.
#[must_use]
pub fn html(judged: &[Judged], seconds: f64) -> String {
    let [passed, failed] = count(judged);
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Signorini: verification</title>\
         <meta name=\"viewport\" content=\"width=device-width\"><style>{STYLE}</style></head><body>\n\
         <h1>Verification of Signorini {}</h1>\n<p>{passed} problems passed, {failed} failed; {seconds:.0} s.</p>\n<table>\n\
         <tr><th>quantity</th><th>value</th><th>reference</th><th>off by</th><th>allowed</th><th>label</th><th>why so much</th><th></th></tr>\n",
        escaped(signorini::VERSION)
    );
    for one in judged {
        // writing to a string does not fail
        let _ = writeln!(
            out,
            "<tr class=\"p\" id=\"{name}\"><td colspan=\"7\">{name}: {}</td><td>{}</td></tr>\n\
             <tr class=\"s\"><td colspan=\"8\">{}. Mesh: {}</td></tr>",
            escaped(one.problem.title),
            mark(one.passed()),
            escaped(one.problem.source),
            escaped(&one.setup.mesh.words()),
            name = escaped(one.problem.name),
        );
        if let Some(why) = &one.solved.failure {
            let _ = writeln!(
                out,
                "<tr><td colspan=\"8\" class=\"no\">{}</td></tr>",
                escaped(why)
            );
        }
        for row in one.rows() {
            let check = row.check;
            let _ = writeln!(
                out,
                "<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>\
                 <td>{}</td><td>{}</td><td>{}</td></tr>",
                escaped(check.quantity),
                number(row.value),
                number(check.reference),
                difference(check, row.value),
                allowed(check),
                check.kind.label(),
                escaped(check.why),
                mark(row.passed)
            );
        }
    }
    out.push_str("</table></body></html>\n");
    out
}
