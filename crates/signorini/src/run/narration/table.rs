//! The table of increments: which columns there are, and how wide they are, by the width of the page.
//!
//! ```text
//!  from 120  step inc att time iter contact residual linear worst p_max F
//!  from  80  step inc att time iter contact residual linear       p_max F
//!  from  60  step inc     time iter         residual linear       p_max F
//!  below     step inc     time iter                                     F
//! ```

use super::page::Page;
use crate::run::news::{Effort, SLOW};
use crate::text::short;
use signorini_mechanics::solve::IncrementRecord;
use signorini_mechanics::system::Frame;

/// A column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Column {
    Step,
    Increment,
    Attempts,
    Time,
    Iterations,
    Contact,
    Residual,
    Linear,
    Worst,
    Pressure,
    Force,
}

use Column::{
    Attempts, Contact, Force, Increment, Iterations, Linear, Pressure, Residual, Step, Time, Worst,
};

/// Columns with their widths, for pages from a width on; the widest page first. A blank stands before each column.
const LAYOUTS: [(usize, &[(Column, usize)]); 4] = [
    (
        120,
        &[
            (Step, 12),
            (Increment, 4),
            (Attempts, 4),
            (Time, 9),
            (Iterations, 5),
            (Contact, 8),
            (Residual, 9),
            (Linear, 9),
            (Worst, 22),
            (Pressure, 9),
            (Force, 9),
        ],
    ),
    (
        80,
        &[
            (Step, 10),
            (Increment, 4),
            (Attempts, 3),
            (Time, 8),
            (Iterations, 4),
            (Contact, 7),
            (Residual, 8),
            (Linear, 8),
            (Pressure, 8),
            (Force, 8),
        ],
    ),
    (
        60,
        &[
            (Step, 8),
            (Increment, 4),
            (Time, 7),
            (Iterations, 4),
            (Residual, 7),
            (Linear, 7),
            (Pressure, 7),
            (Force, 7),
        ],
    ),
    (
        0,
        &[
            (Step, 6),
            (Increment, 4),
            (Time, 7),
            (Iterations, 4),
            (Force, 8),
        ],
    ),
];

impl Column {
    const fn head(self, width: usize) -> &'static str {
        match self {
            Residual if width < 8 => "resid",
            Step => "step",
            Increment => "inc",
            Attempts => "att",
            Time => "time",
            Iterations => "iter",
            Contact => "contact",
            Residual => "residual",
            Linear => "linear",
            Worst => "worst",
            Pressure => "p_max",
            Force => "F",
        }
    }

    const fn is_text(self) -> bool {
        matches!(self, Step | Worst)
    }
}

fn columns(page: Page) -> &'static [(Column, usize)] {
    let fitting = LAYOUTS.iter().find(|(from, _)| page.width >= *from);
    fitting.map_or(&[], |(_, columns)| columns)
}

/// Whether there is room for what was worst in an increment.
pub fn shows_worst(page: Page) -> bool {
    columns(page).iter().any(|(column, _)| *column == Worst)
}

/// A row, made column by column.
fn row(page: Page, cell: impl Fn(Column, usize) -> String) -> String {
    let mut out = String::new();
    for (column, width) in columns(page) {
        let text = cell(*column, *width);
        if column.is_text() {
            out += &format!(" {text:<width$}");
        } else {
            out += &format!(" {text:>width$}");
        }
    }
    out.trim_end().to_owned()
}

/// The head of the table.
pub fn head(page: Page) -> String {
    row(page, |column, width| column.head(width).to_owned())
}

/// Whether the equations of an increment were hard to solve.
pub fn is_slow(record: &IncrementRecord, effort: &Effort) -> bool {
    record.iterations >= SLOW && effort.solves > 0
}

/// The row of an increment; one that was slow says so, where there is room.
pub fn increment(
    page: Page,
    step: &str,
    record: &IncrementRecord,
    frame: &Frame,
    effort: &Effort,
) -> String {
    let contacts = frame.contacts.iter();
    let pressure = contacts.clone().map(|c| c.pressure_max).fold(0.0, f64::max);
    let force = contacts.map(|c| c.secondary.force.norm());
    let force = force.fold(0.0, f64::max);
    let text = row(page, |column, width| match column {
        Step => cut(step, width),
        Increment => record.increment.to_string(),
        Attempts => record.attempts.to_string(),
        Time => time(record.time),
        Iterations => record.iterations.to_string(),
        Contact => effort.closed.to_string(),
        Residual => format!("{:.1e}", record.residual),
        Linear => linear(effort, width),
        Worst => cut(effort.worst.as_deref().unwrap_or("—"), width),
        Pressure => short(pressure),
        Force => short(force),
    });
    let mark = match shows_worst(page) {
        true => "  ← slow",
        false => "",
    };
    match is_slow(record, effort) {
        true => text + mark,
        false => text,
    }
}

/// The beginning of a row that says something in words.
pub fn beginning(page: Page, step: &str, increment: u64, attempt: u64) -> String {
    let mut out = String::new();
    for (column, width) in columns(page) {
        match column {
            Step => out += &format!(" {:<width$}", cut(step, *width)),
            Increment => out += &format!(" {increment:>width$}"),
            Attempts => out += &format!(" {attempt:>width$}"),
            _ => break,
        }
    }
    out
}

/// How the linear equations were solved: directly, or in so many iterations; `+d` where these gave way to the direct solver.
fn linear(effort: &Effort, width: usize) -> String {
    let gave_way = if effort.gave_way { "+d" } else { "" };
    if effort.solves == 0 {
        "—".to_owned()
    } else if !effort.multigrid {
        "direct".to_owned()
    } else {
        let whole = format!("{} it{gave_way}", effort.linear_iterations);
        let short = || format!("{}{gave_way}", effort.linear_iterations);
        if whole.len() <= width {
            whole
        } else {
            cut(&short(), width)
        }
    }
}

/// A text no longer than a width.
fn cut(text: &str, width: usize) -> String {
    if text.chars().count() <= width {
        return text.to_owned();
    }
    let kept: String = text.chars().take(width.saturating_sub(1)).collect();
    kept + "…"
}

/// A time with three decimals, or more where they are needed to distinguish small ones.
fn time(time: f64) -> String {
    if time != 0.0 && !(0.01..1e4).contains(&time.abs()) {
        format!("{time:.1e}")
    } else {
        let decimals = if time.abs() < 100.0 { 3 } else { 1 };
        format!("{time:.decimals$}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(width: usize) -> [String; 2] {
        let page = Page { width };
        let record = IncrementRecord {
            increment: 1234,
            attempts: 12,
            iterations: 123,
            residual: 1.2e-10,
            time: 123_456.7,
            step: 0,
            step_time: (1.0, 1.0),
            dt: 1.0,
            work_stabilization: 0.0,
            work_external: 0.0,
        };
        let effort = Effort {
            worst: Some("1234 flips n12345678901234567".into()),
            closed: 123_456,
            solves: 123,
            multigrid: true,
            linear_iterations: 1234,
            gave_way: true,
        };
        let frame = Frame::default();
        [
            head(page),
            increment(page, "a long name of a step", &record, &frame, &effort),
        ]
    }

    #[test]
    fn rows_of_large_numbers_fit_the_page() {
        for width in [40, 59, 60, 79, 80, 119, 120, 300] {
            for row in rows(width) {
                let n = row.chars().count();
                assert!(n < width, "{width}: {n}\n{row}");
            }
        }
    }

    #[test]
    fn the_linear_solver_is_seen_from_sixty_columns_on() {
        assert!(!rows(59)[0].contains("linear"));
        for width in [60, 80, 120] {
            let [head, row] = rows(width);
            assert!(head.contains("linear"));
            assert!(row.contains("1234 it+d") || row.contains("1234+d"), "{row}");
        }
    }

    #[test]
    fn times_are_short_and_distinct() {
        let times = [0.0, 0.25, 2.0, 123.4, 1e-4, 1e6].map(time);
        assert_eq!(
            times,
            ["0.000", "0.250", "2.000", "123.4", "1.0e-4", "1.0e6"]
        );
    }
}
