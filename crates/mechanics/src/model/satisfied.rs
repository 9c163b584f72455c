//! Whether what steps prescribe satisfies equations.

use super::reduction::{Column, Row};
use crate::solve::Motion;
use crate::system::{Dof, interpolate};
use std::collections::{BTreeMap, HashMap};

/// Relative error with which prescribed motions may satisfy an equation.
const SATISFIED: f64 = 1e-9;
/// Parts of a step between which motions by functions are compared: a table has its rows for that, a function nothing.
const SAMPLES: usize = 64;

/// Whether the prescribed motions of all steps satisfy an equation in which everything is prescribed.
pub(super) fn holds(
    row: &Row,
    motions: &[BTreeMap<Dof, &Motion>],
    durations: impl Iterator<Item = f64>,
) -> bool {
    let mut terms = Vec::new();
    for (column, c) in &row.terms {
        match column {
            Column::Dof(dof) => terms.push((*dof, *c)),
            Column::Turn(_) => return false,
        }
    }
    let mut start: HashMap<Dof, Option<f64>> = terms.iter().map(|t| (t.0, Some(0.0))).collect();
    let mut total = 0.0;
    for (motions, duration) in motions.iter().zip(durations) {
        let value = |dof: Dof, time: f64| -> Option<f64> {
            let from = start.get(&dof).copied().flatten();
            match motions.get(&dof)? {
                Motion::Hold => from,
                Motion::Ramp(to) => from.map(|from| from + (to - from) * time / duration),
                Motion::Table(table) => Some(interpolate(table, time)),
                Motion::TotalTable(table) => Some(interpolate(table, total + time)),
                Motion::Function(function) => Some(function.at(time)),
                Motion::TotalFunction(function) => Some(function.at(total + time)),
            }
        };
        let mut times = vec![0.0, duration];
        for (dof, _) in &terms {
            match motions.get(dof) {
                Some(Motion::Table(table)) => times.extend(table.iter().map(|r| r[0])),
                Some(Motion::TotalTable(table)) => times.extend(table.iter().map(|r| r[0] - total)),
                Some(Motion::Function(_) | Motion::TotalFunction(_)) => {
                    times.extend((1..SAMPLES).map(|k| duration * k as f64 / SAMPLES as f64));
                }
                _ => {}
            }
        }
        for time in times.into_iter().filter(|t| (0.0..=duration).contains(t)) {
            let (mut sum, mut size) = (0.0, 0.0);
            for &(dof, c) in &terms {
                let Some(value) = value(dof, time) else {
                    return false;
                };
                sum += c * value;
                size += (c * value).abs();
            }
            if sum.abs() > SATISFIED * size {
                return false;
            }
        }
        let ends: Vec<_> = terms.iter().map(|t| (t.0, value(t.0, duration))).collect();
        start.extend(ends);
        total += duration;
    }
    true
}
