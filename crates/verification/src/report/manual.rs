//! The verification manual: an index and a page for each problem, in Markdown, with the cases that can be run as they are.

use super::{count, difference, number};
use crate::problem::{Expectations, Problem};
use crate::solve::Judged;
use signorini_io::fs::{Fs, FsError};
use std::fmt::Write;
use std::path::Path;

/// Makes the picture of a problem, a PNG; none where it has none.
pub type Draw<'a> = &'a dyn Fn(&Judged) -> Option<Vec<u8>>;

/// Writes `index.md`, and `NAME.md`, `NAME.toml` and, where `draw` makes one, `NAME.png` for each problem into a folder, which
/// is made where it is missing.
///
/// # Errors
/// A file that cannot be written.
pub fn manual(
    fs: &dyn Fs,
    folder: &Path,
    judged: &[Judged],
    draw: Draw<'_>,
) -> Result<(), FsError> {
    fs.create_dir_all(folder)?;
    for one in judged {
        let name = one.problem.name;
        let picture = draw(one);
        if let Some(png) = &picture {
            fs.write_atomic(&folder.join(format!("{name}.png")), png)?;
        }
        let page = page(one, picture.is_some());
        fs.write_atomic(&folder.join(format!("{name}.md")), page.as_bytes())?;
        let case = one.setup.text(one.problem.title, Expectations::Judged);
        fs.write_atomic(&folder.join(format!("{name}.toml")), case.as_bytes())?;
    }
    fs.write_atomic(&folder.join("index.md"), index(judged).as_bytes())?;
    Ok(())
}

fn index(judged: &[Judged]) -> String {
    let [passed, failed] = count(judged);
    let mut out = format!(
        "# Verification manual\n\nWritten by `signorini verify --manual`, version {}: {passed} problems passed, {failed} failed.\n\n\
         | problem | what | label | values | largest part of the tolerance | |\n|---|---|---|---|---|---|\n",
        signorini::VERSION
    );
    for one in judged {
        let used = one
            .rows()
            .into_iter()
            .map(|row| row.check.difference(row.value).abs() / row.check.tolerance.part());
        let used = used.fold(0.0, |most: f64, part| {
            if part.is_nan() {
                f64::NAN
            } else {
                most.max(part)
            }
        });
        let used = if used.is_finite() {
            format!("{used:.2}")
        } else {
            "-".to_owned()
        };
        // writing to a string does not fail
        let _ = writeln!(
            out,
            "| [{name}]({name}.md) | {} | {} | {} | {used} | {} |",
            one.problem.title,
            super::labels(&one.setup.checks),
            one.setup.checks.len(),
            sign(one.passed()),
            name = one.problem.name,
        );
    }
    out
}

const fn sign(passed: bool) -> &'static str {
    if passed { "✓" } else { "✗ **failed**" }
}

fn page(judged: &Judged, has_picture: bool) -> String {
    let problem = &judged.problem;
    let mut out = format!(
        "# {}\n\n| | |\n|---|---|\n| source | {} |\n| goal | {} |\n| mesh | {} ({}) |\n| conditions | {} |\n| case | [{name}.toml]({name}.toml) |\n\n\
         ## Reference\n\n{}\n\n## Values\n\n",
        problem.title,
        problem.source,
        problem.goal,
        problem.mesh,
        judged.setup.mesh.words(),
        problem.conditions,
        problem.formula,
        name = problem.name,
    );
    if let Some(why) = &judged.solved.failure {
        // writing to a string does not fail
        let _ = writeln!(out, "**The run failed**: {why}\n");
    }
    out.push_str("| quantity | value | reference | off by | allowed | label | |\n|---|---|---|---|---|---|---|\n");
    for row in judged.rows() {
        let check = row.check;
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} | {} | {} | {} |",
            check.quantity,
            number(row.value),
            number(check.reference),
            difference(check, row.value),
            check.tolerance.words(),
            check.kind.label(),
            sign(row.passed)
        );
    }
    out.push_str("\nWhy so much is allowed:\n\n");
    for check in &judged.setup.checks {
        let _ = writeln!(out, "* {}: {}", check.quantity, check.why);
    }
    if has_picture {
        let _ = writeln!(out, "\n![{}]({}.png)", problem.title, problem.name);
    }
    out
}

/// All problems as a Markdown table: name, title, source, labels, tolerances, whether it is quick.
#[must_use]
pub fn list(problems: &[Problem]) -> String {
    let mut out = String::from(
        "| problem | what | source | label | allowed | quick |\n|---|---|---|---|---|---|\n",
    );
    for problem in problems {
        let checks = problem.setup().checks;
        let mut parts: Vec<String> = checks.iter().map(super::allowed).collect();
        parts.sort();
        parts.dedup();
        // writing to a string does not fail
        let _ = writeln!(
            out,
            "| `{}` | {} | {} | {} | {} | {} |",
            problem.name,
            problem.title,
            problem.source,
            super::labels(&checks),
            parts.join(", "),
            if problem.quick { "yes" } else { "" }
        );
    }
    out
}
