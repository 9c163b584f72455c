//! Where the forces of a row and their derivatives go.

use super::super::row::Row;
use signorini_geometry::tensor::Vec3;

/// Where results of a group go: its columns first, then the multipliers of its row.
pub(in crate::contact) struct Target<'a> {
    pub force: &'a mut [f64],
    /// Row-major; empty where it is not wanted.
    pub stiffness: &'a mut [f64],
}

/// Adds the traction of a bond, which changes with its stretch by `stretched`, and the equations of its multiplier.
pub(super) fn join(
    row: &Row,
    measure: f64,
    traction: Vec3,
    stretched: impl Fn(Vec3) -> Vec3,
    target: &mut Target<'_>,
) {
    let (n, width) = (row.weights.len(), target.force.len());
    let sliding = &row.sliding;
    for (f, b) in target.force.iter_mut().zip(&sliding.operator) {
        *f += measure * b.dot(traction);
    }
    for c in 0..width - n {
        target.force[n + c] += measure * sliding.slip[c];
    }
    if target.stiffness.is_empty() {
        return;
    }
    for (i, line) in target.stiffness.chunks_exact_mut(width).enumerate() {
        if i >= n {
            for (k, de) in line.iter_mut().zip(&sliding.dslip) {
                *k += measure * de[i - n];
            }
            continue;
        }
        let b = sliding.operator[i];
        for (k, de) in line.iter_mut().zip(&sliding.dslip) {
            *k += measure * b.dot(stretched(*de));
        }
        for c in 0..width - n {
            line[n + c] += measure * b[c];
        }
        for turn in sliding.turns() {
            let across = measure * turn.across[i].dot(traction);
            for (k, along) in line.iter_mut().zip(&turn.along) {
                *k += across * along;
            }
        }
    }
}

/// Adds (E4) of a pressure and a tangential traction with these slopes: lines of columns, in as many lanes as there are.
#[inline(always)]
pub(super) fn add_stiffness(
    row: &Row,
    measure: f64,
    (pressure, tangential): (f64, Vec3),
    [dx, dy, dz, dp]: &[Vec<f64>; 4],
    stiffness: &mut [f64],
) {
    let (n, width) = (row.weights.len(), dp.len());
    let (sliding, pressed) = (&row.sliding, measure * pressure);
    let lines = stiffness.chunks_exact_mut(width).take(n);
    for (i, line) in lines.enumerate() {
        let [x, y, z] = (sliding.operator[i] * measure).to_array();
        let b = measure * row.weights[i];
        let slopes = dx.iter().zip(dy).zip(dz).zip(dp);
        for (k, (((dx, dy), dz), dp)) in line.iter_mut().zip(slopes) {
            *k += (x * dx + y * dy) + (z * dz - b * dp);
        }
        for (k, db) in line.iter_mut().zip(&row.dweights[i * n..(i + 1) * n]) {
            *k -= pressed * db;
        }
        if let Some((c, dscale)) = sliding.scaled(i) {
            let along = measure * tangential[c];
            for (k, d) in line.iter_mut().zip(dscale) {
                *k += along * d;
            }
        }
        for turn in sliding.turns() {
            let across = measure * turn.across[i].dot(tangential);
            for (k, along) in line.iter_mut().zip(&turn.along) {
                *k += across * along;
            }
        }
    }
}
