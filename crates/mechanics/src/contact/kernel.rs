//! From rows to force and stiffness, (E1) and (E2) of the room.

use super::law::Eval;
use super::row::Row;

/// Adds the force of a pressure, and its stiffness where `stiffness` is not empty.
pub(super) fn add_pressure(
    row: &Row,
    measure: f64,
    pressure: &Eval,
    force: &mut [f64],
    stiffness: &mut [f64],
) {
    let n = row.weights.len();
    let scaled = measure * pressure.value;
    for (f, b) in force.iter_mut().zip(&row.weights) {
        *f -= scaled * b; // (E1)
    }
    if stiffness.is_empty() {
        return;
    }
    let slope = measure * pressure.dgap;
    for ((line, b), db) in stiffness
        .chunks_exact_mut(n)
        .zip(&row.weights)
        .zip(row.dweights.chunks_exact(n))
    {
        let along = slope * b;
        for ((k, g), db) in line.iter_mut().zip(&row.gradient).zip(db) {
            *k -= along * g + scaled * db; // (E2)
        }
    }
}
