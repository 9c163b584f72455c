//! Two runs next to each other.

use super::cell::derived;
use crate::results::Results;
use crate::text::short;
use maud::{Markup, html};

/// Columns that say where a row is, not what came out.
const PLACES: [&str; 4] = ["time", "step", "increment", "iterations"];

/// The section: the histories of both at the end, and their largest difference over all times.
pub fn section(results: &Results, other: &Results) -> Markup {
    let rows = rows(results, other);
    html! {
        section #comparison {
            h2 { "Comparison" }
            p { "A is " strong { (results.name()) } ", B is " strong { (other.name()) }
                ". Plots show B with broken lines. Between its increments B is interpolated linearly." }
            @if rows.is_empty() {
                p { "The histories have no column in common." }
            } @else {
                table.wide {
                    thead { tr { th { "column of history.csv" } th.number { "A at the end" } th.number { "B at the end" }
                        th.number { "B − A" } th.number { "relative" } th.number { "largest |B − A|" } th.number { "at time" } } }
                    tbody { @for row in &rows { tr {
                        td { (row.name) } (derived(row.a)) (derived(row.b)) (derived(row.b - row.a))
                        td.number { (relative(row.a, row.b)) }
                        (derived(row.most)) (derived(row.time))
                    } } }
                }
            }
        }
    }
}

fn relative(a: f64, b: f64) -> String {
    let scale = a.abs().max(b.abs());
    match scale > 0.0 {
        true => format!("{} %", short(100.0 * (b - a) / scale, 3)),
        false => "0 %".to_owned(),
    }
}

/// A column of both histories.
struct Row {
    name: String,
    a: f64,
    b: f64,
    most: f64,
    time: f64,
}

fn rows(results: &Results, other: &Results) -> Vec<Row> {
    let (times, others) = (
        results.history.numbers("time"),
        other.history.numbers("time"),
    );
    let mut rows = Vec::new();
    for name in results
        .history
        .columns
        .iter()
        .filter(|name| !PLACES.contains(&name.as_str()))
    {
        let (a, b) = (results.history.numbers(name), other.history.numbers(name));
        let (Some(last), Some(last_other)) = (a.last(), b.last()) else {
            continue;
        };
        let differences = times.iter().zip(&a).filter_map(|(&time, value)| {
            let difference = (at(&others, &b, time)? - value).abs();
            difference.is_finite().then_some((time, difference))
        });
        let most = differences.max_by(|x, y| x.1.total_cmp(&y.1));
        let (time, most) = most.unwrap_or((f64::NAN, f64::NAN));
        rows.push(Row {
            name: name.clone(),
            a: *last,
            b: *last_other,
            most,
            time,
        });
    }
    rows
}

/// The value at a time, linear between the rows; nothing outside of them.
fn at(times: &[f64], values: &[f64], time: f64) -> Option<f64> {
    let above = times.partition_point(|t| *t < time);
    let (t1, v1) = (times.get(above)?, values.get(above)?);
    if *t1 == time {
        return Some(*v1);
    }
    let (t0, v0) = (times.get(above.checked_sub(1)?)?, values.get(above - 1)?);
    Some(v0 + (time - t0) / (t1 - t0) * (v1 - v0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_between_rows_are_linear_and_there_are_none_outside() {
        let (times, values) = ([1.0, 2.0, 4.0], [10.0, 20.0, 0.0]);
        assert_eq!(at(&times, &values, 3.0), Some(10.0));
        assert_eq!(at(&times, &values, 2.0), Some(20.0));
        assert_eq!(
            (at(&times, &values, 0.5), at(&times, &values, 5.0)),
            (None, None)
        );
    }
}
