//! What interface values do to single unknowns: viscous forces on bodies that float, weak springs to the ground.
//!
//! Where that is little in comparison with the stiffness of the bodies, it is no part of the block at the interface, which
//! would hold all bodies as long as viscous forces do, but of the hierarchy.

use super::blocks::Blocks;
use super::fine::Fine;
use super::values::Means;
use crate::problem::{Kept, Values};

/// The largest stiffness to the ground that is little, over the mean one of the node. Viscous forces are 1e-3 of it, and 0.03
/// after an iteration has failed; a penalty is ten times as stiff.
const LITTLE: f64 = 0.1;

/// The columns and values of the interface at an unknown.
fn row<'a>(kept: &'a Kept, values: &'a Values<'_>, dof: usize) -> impl Iterator<Item = (u32, f64)> {
    let ends = kept.interface.row_start.get(dof..dof + 2);
    let range = ends.map_or(0..0, |ends| ends[0]..ends[1]);
    let columns = kept.interface.column.get(range.clone()).unwrap_or_default();
    let values = values.interface.get(range).unwrap_or_default();
    columns.iter().copied().zip(values.iter().copied())
}

/// Whether interface values act on each node, apart from small values at single unknowns.
pub(super) fn touched(kept: &Kept, values: &Values, means: Means<'_>) -> Vec<bool> {
    let counts = |dof: usize, (column, v): (u32, f64)| {
        let is_alone = column as usize == dof;
        v != 0.0
            && !kept.is_of_field(column)
            && !(is_alone && v.abs() <= LITTLE * means.of(dof / 3))
    };
    let is_touched = |node: usize| {
        let mut dofs = 3 * node..3 * node + 3;
        dofs.any(|dof| row(kept, values, dof).any(|entry| counts(dof, entry)))
    };
    (0..kept.bulk.nrow()).map(is_touched).collect()
}

/// Whether interface values have a place at each node, but for single unknowns.
pub(super) fn coupled(kept: &Kept) -> Vec<bool> {
    let is_coupled = |node: usize| {
        (3 * node..3 * node + 3).any(|dof| {
            let ends = kept.interface.row_start.get(dof..dof + 2);
            let columns = ends.and_then(|ends| kept.interface.column.get(ends[0]..ends[1]));
            let others = |&column: &u32| column as usize != dof && !kept.is_of_field(column);
            columns.is_some_and(|all| all.iter().any(others))
        })
    };
    (0..kept.bulk.nrow()).map(is_coupled).collect()
}

/// Adds small values at single unknowns to the stiffness of the bodies.
pub(super) fn add(kept: &Kept, values: &Values, fine: &Fine, matrix: &mut Blocks<3, 3>) {
    let means = Means::Here(kept, values);
    for (row, at) in places(fine, matrix) {
        for (axis, v) in at_node(kept, values, fine.node[row], means) {
            matrix.value[at][axis][axis] += v;
        }
    }
}

/// The mean of what [`add`] adds at bodies that float, over the stiffness there.
pub(super) fn strength(kept: &Kept, values: &Values, fine: &Fine) -> f64 {
    let means = Means::Here(kept, values);
    let (mut added, mut all) = (0.0, 0.0);
    for &row in &fine.floating {
        let node = fine.node[row as usize];
        let of_node = at_node(kept, values, node, means);
        added += of_node.map(|(_, v)| v).sum::<f64>();
        all += 3.0 * means.of(node as usize);
    }
    if all > 0.0 { added / all } else { 0.0 }
}

/// What is little and acts on single unknowns of a node: axes and values.
fn at_node<'a>(
    kept: &'a Kept,
    values: &'a Values<'_>,
    node: u32,
    means: Means<'_>,
) -> impl Iterator<Item = (usize, f64)> {
    let little = LITTLE * means.of(node as usize);
    (0..3).filter_map(move |axis| {
        let dof = 3 * node as usize + axis;
        let own = row(kept, values, dof).find(|(column, _)| *column as usize == dof);
        own.map(|(_, v)| (axis, v))
            .filter(|(_, v)| *v > 0.0 && *v <= little)
    })
}

/// Where the diagonal blocks of bodies that float are.
fn places(fine: &Fine, matrix: &Blocks<3, 3>) -> Vec<(usize, usize)> {
    let place = |&row: &u32| {
        let range = matrix.range(row as usize);
        let at = matrix.column[range.clone()].binary_search(&row).ok()?;
        Some((row as usize, range.start + at))
    };
    fine.floating.iter().filter_map(place).collect()
}
