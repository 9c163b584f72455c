//! The news in words: what a terminal shows and `run.log` keeps.
//!
//! ```text
//! hertz  577 nodes · 1 855 tet4 · 1 pair  ·  2 threads
//! ✓ read 0.02 s   ✓ built 0.01 s: 1 203 unknowns · 93 candidate nodes, smallest gap 0.000 mm
//!   against locking: block: b-bar
//!  step          inc  att      time  iter  contact  residual    linear worst                  p_max         F
//!  press           5    1     0.950     9       41    8.8e-7    direct 2 flips n214            37.9      23.8  ← slow
//! ✓ solved: 6 increments, 31 iterations, 0 cut-backs, 3.4 s   → hertz.out/results.pvd
//!   expect ball-block.pressure_max  38.12  (38.80 ± 3 %)  ✓
//! ```

mod page;
mod table;

pub use page::Page;

use super::limits::Stop;
use super::news::{Detail, Facts, News, Totals};
use crate::text::{count, plural, short};
use signorini_io::diagnostic::{Diagnostics, Severity};
use signorini_io::writers::json::{Event, ModeSummary};
use signorini_mechanics::solve::{IterationRecord, Vibrations};

/// How much a line matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// Printed even where only the ending is wanted.
    Important,
    /// Printed by default.
    Normal,
    /// Printed where all is wanted.
    Verbose,
}

/// A line for people.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// Its text.
    pub text: String,
    /// How much it matters.
    pub level: Level,
}

/// Puts news into words; remembers what has been said before.
#[derive(Clone, Debug, Default)]
pub struct Narrator {
    page: Page,
    headed: Option<Page>,
    step: String,
}

impl Narrator {
    /// From now on, the lines are for another page: the table begins again with its head where its columns change.
    pub fn turn_to(&mut self, page: Page) {
        self.page = page;
    }

    /// The lines for one piece of news; there may be none.
    pub fn lines(&mut self, news: &News<'_>) -> Vec<Line> {
        match (news.event, news.detail) {
            (_, Detail::Start(facts)) => start(facts),
            (_, Detail::Finding(one)) => {
                let level = match one.severity {
                    Severity::Error | Severity::Warning => Level::Important,
                    Severity::Note => Level::Normal,
                };
                let text = Diagnostics::from(one.clone()).plain();
                vec![line(text.trim_end().to_owned(), level)]
            }
            (Event::Iteration { step, .. }, Detail::Iteration(record)) => {
                self.step.clone_from(step);
                vec![line(iteration(record), Level::Verbose)]
            }
            (Event::Increment { step, .. }, Detail::Increment(record, frame, effort)) => {
                self.step.clone_from(step);
                let mut lines = self.head();
                let row = table::increment(self.page, step, record, frame, effort);
                lines.push(line(row, Level::Normal));
                if table::is_slow(record, effort)
                    && let Some(worst) = &effort.worst
                    && !table::shows_worst(self.page)
                {
                    let start = table::beginning(self.page, step, record.increment as u64, 1);
                    let start = " ".repeat(start.chars().count());
                    lines.push(line(format!("{start} slow: {worst}"), Level::Normal));
                }
                lines
            }
            (
                Event::Frequencies {
                    step, time, modes, ..
                },
                Detail::Vibrations(found),
            ) => {
                self.headed = None;
                let lines = frequencies(step, *time, modes, found).into_iter();
                lines.map(|text| line(text, Level::Normal)).collect()
            }
            (
                Event::Cutback(_)
                | Event::Retry(_)
                | Event::Followed { .. }
                | Event::Stabilized { .. }
                | Event::Explicit { .. }
                | Event::Held { .. },
                _,
            ) => {
                let mut lines = self.head();
                lines.extend(remedy(self.page, news.event).map(|text| line(text, Level::Normal)));
                lines
            }
            (Event::Solver { note, .. }, _) => {
                vec![line(format!("   {note}"), Level::Verbose)]
            }
            (Event::Checkpoint { file, .. }, _) => {
                vec![line(format!("   saved to {file}"), Level::Verbose)]
            }
            (
                Event::Expect {
                    what,
                    value,
                    got,
                    ok,
                },
                Detail::Expectation(tolerance),
            ) => {
                let sign = if *ok { "✓" } else { "✗" };
                let name = format!("  expect {what}");
                let found = format!("{}  ({} {tolerance})  {sign}", digits(*got), digits(*value));
                let whole = format!("{name}  {found}");
                let level = match ok {
                    true => Level::Normal,
                    false => Level::Important,
                };
                match whole.chars().count() < self.page.width {
                    true => vec![line(whole, level)],
                    false => vec![line(name, level), line(format!("    {found}"), level)],
                }
            }
            (
                Event::End {
                    status,
                    exit_code,
                    seconds,
                },
                Detail::End(totals),
            ) => {
                vec![line(
                    end(status, *exit_code, *seconds, totals),
                    Level::Important,
                )]
            }
            _ => Vec::new(),
        }
    }

    /// The head of the table, once for each page.
    fn head(&mut self) -> Vec<Line> {
        let head = table::head(self.page);
        let before = self.headed.replace(self.page);
        if before.is_some_and(|before| table::head(before) == head) {
            return Vec::new();
        }
        vec![line(head, Level::Normal)]
    }
}

fn line(text: String, level: Level) -> Line {
    Line { text, level }
}

fn start(facts: &Facts) -> Vec<Line> {
    let cells = facts.cells.iter();
    let cells: Vec<String> = cells
        .map(|(name, n)| format!("{} {name}", count(*n)))
        .collect();
    let mut head = format!("{}  {}", facts.name, plural(facts.nnode, "node"));
    for part in cells {
        head += &format!(" · {part}");
    }
    if facts.ncontact > 0 {
        head += &format!(" · {}", plural(facts.ncontact, "pair"));
    }
    head += "  ·  ";
    if facts.ranks > 1 {
        head += &format!("{} of ", plural(facts.ranks, "rank"));
    }
    head += &plural(facts.threads, "thread");
    let [read, built] = facts.seconds;
    let mut ready = format!(
        "✓ read {read:.2} s   ✓ built {built:.2} s: {}",
        plural(facts.nunknown, "unknown")
    );
    if facts.ncontact > 0 {
        ready += &format!(" · {}", plural(facts.npoint, "candidate node"));
        let length = &facts.length;
        ready += &match facts.gap_min {
            Some(gap) if gap < 0.0 => format!(", largest overlap {} {length}", short(-gap)),
            Some(gap) => format!(", smallest gap {} {length}", short(gap)),
            None => ", none within reach".to_owned(),
        };
    }
    let mut lines = vec![head, ready.trim_end().to_owned()];
    if !facts.remedies.is_empty() {
        lines.push(format!("  against locking: {}", facts.remedies.join(", ")));
    }
    let lines = lines.into_iter();
    lines.map(|text| line(text, Level::Normal)).collect()
}

fn iteration(record: &IterationRecord) -> String {
    format!(
        "   iteration {:>2}  residual {:.2e}  correction {:.2e}  step {:.3}  closed {}  flips {}",
        record.iteration,
        record.residual,
        record.correction,
        record.line_search,
        record.closed,
        record.flips
    )
}

/// The table of natural frequencies.
fn frequencies(step: &str, time: f64, modes: &[ModeSummary], found: &Vibrations) -> Vec<String> {
    let sizes = modes.iter().map(|mode| mode.frequency.abs());
    let rigid = Vibrations::RIGID * sizes.fold(0.0, f64::max);
    let [solves, factors] = found.effort;
    let mut lines = vec![
        format!(
            " {step}: {} about the state at {}, {} and {}",
            plural(modes.len(), "natural mode"),
            digits(time),
            plural(factors, "factor"),
            plural(solves, "solution"),
        ),
        format!(
            "  {:>4}  {:>13}  {:>13}  {:>8}  {:<}",
            "mode", "frequency", "omega", "residual", "effective mass x, y, z (% of all)"
        ),
    ];
    for mode in modes {
        // nothing but rounding
        let shown = |value: f64| match mode.frequency.abs() < rigid {
            true => "0".to_owned(),
            false => digits(value),
        };
        let part = |axis: usize| {
            let all = found.mass.get(axis).copied().unwrap_or_default();
            let own = mode.effective_mass.get(axis).copied().unwrap_or_default();
            let part = if all > 0.0 { 100.0 * own / all } else { 0.0 };
            format!("{part:>6.2}")
        };
        lines.push(format!(
            "  {:>4}  {:>13}  {:>13}  {:>8.1e}  {} {} {}{}",
            mode.mode,
            shown(mode.frequency),
            shown(mode.omega),
            mode.residual,
            part(0),
            part(1),
            part(2),
            if mode.converged {
                ""
            } else {
                "  ✗ not converged"
            },
        ));
    }
    lines
}

/// What was done where Newton's method failed or nothing resists a motion.
fn remedy(page: Page, event: &Event) -> Option<String> {
    let start = |step: &str, inc: &u64, att: &u64| table::beginning(page, step, *inc, *att);
    Some(match event {
        Event::Cutback(one) => format!(
            "{}  cut to {}: {}",
            start(&one.step, &one.inc, &one.att),
            short(one.size),
            one.why
        ),
        Event::Retry(one) => format!(
            "{}  {} again from another start: {}",
            start(&one.step, &one.inc, &one.att),
            short(one.size),
            one.why
        ),
        Event::Followed {
            step,
            inc,
            att,
            parts,
            ..
        } => format!("{}  gone through in {parts} parts", start(step, inc, att)),
        Event::Stabilized {
            step,
            inc,
            att,
            stages,
            work,
            work_external,
            ..
        } => {
            let start = start(step, inc, att);
            let part = match 100.0 * work / work_external.abs() {
                part if part.is_finite() => {
                    format!(", {part:.2} % of that of supports and loads")
                }
                _ => String::new(),
            };
            format!(
                "{start}  no equilibrium nearby: led to another by viscous forces, in {stages} stages; their work is \
                 {work:.3e}{part}"
            )
        }
        Event::Explicit {
            step,
            size,
            mass_added,
        } => {
            let added = match 100.0 * mass_added {
                0.0 => String::new(),
                part => format!(", with {part:.2} % more mass"),
            };
            format!(" {step:<12}  short increments of at most {size:.3e}{added}")
        }
        Event::Held { step, at } => {
            let motions = match at.len() {
                1 => "a motion".to_owned(),
                n => format!("{n} motions"),
            };
            let at = at.join(", ");
            format!(
                " {step:<12}  warning: nothing resists {motions}, and no load acts there: held at {at}"
            )
        }
        _ => return None,
    })
}

/// A value with seven digits, less the zeros at its end.
fn digits(value: f64) -> String {
    if value.is_nan() {
        return "was never reached".to_owned();
    }
    let size = value.abs();
    if value != 0.0 && !(1e-4..1e6).contains(&size) {
        return format!("{value:.6e}");
    }
    let exponent = if value == 0.0 {
        0
    } else {
        size.log10().floor() as i32
    };
    let text = format!("{value:.*}", (6 - exponent).max(0) as usize);
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

fn end(status: &str, exit_code: u8, seconds: f64, totals: &Totals) -> String {
    let sign = if exit_code == 0 { "✓" } else { "✗" };
    let effort = format!(
        "{}, {}, {}, {seconds:.1} s",
        plural(totals.increments as usize, "increment"),
        plural(totals.iterations as usize, "iteration"),
        plural(totals.cutbacks as usize, "cut-back"),
    );
    let folder = &totals.folder;
    let goes_on = Stop::STATUSES.contains(&status);
    match exit_code {
        0 | 1 if !goes_on => format!("{sign} {status}: {effort}   → {folder}/results.pvd"),
        _ if totals.increments > 0 => {
            format!(
                "{sign} {status}: {effort}   → {folder}/results.pvd, go on with: signorini resume {folder}"
            )
        }
        _ => format!("{sign} {status}: {effort}"),
    }
}

#[cfg(test)]
mod tests {
    use super::digits;

    #[test]
    fn values_are_printed_with_seven_digits() {
        let found = [
            38.8,
            25.0,
            -0.000725088618977,
            123_456.789,
            1.6644332579,
            0.0,
            2e9,
        ]
        .map(digits);
        let wanted = [
            "38.8",
            "25",
            "-0.0007250886",
            "123456.8",
            "1.664433",
            "0",
            "2.000000e9",
        ];
        assert_eq!(found, wanted);
        assert_eq!(digits(f64::NAN), "was never reached");
    }
}
