//! The operator as it is assembled, in two parts, over raw degrees of freedom.

use crate::problem::Values;
use crate::sparsity::{BlockPattern, Pattern};
use rayon::prelude::*;

/// Rows handled by one task; results do not depend on it.
const ROWS_PER_TASK: usize = 1024;

/// Multiplies the two-part operator with a vector over raw degrees of freedom: `y = A x`.
///
/// Prescribed motion needs it before equations are numbered, and every solver measures its residual with it. Each row
/// is summed in the order of its columns, bulk first: the same bits for any number of threads.
///
/// # Shapes
/// `x` and `y` have one entry per raw degree of freedom; `values` belong to the patterns. Blocks are 1, 2 or 3 wide.
///
/// # Example
/// ```
/// use signorini_linear::sparsity::{BlockPattern, NONE, Pattern};
/// use signorini_linear::{Problem, Symmetry, Values, apply};
///
/// // four springs in a row, k = 2, held at node 0
/// let bulk = BlockPattern::from_cliques(5, 1, &[0, 1, 1, 2, 2, 3, 3, 4], &[0, 2, 4, 6, 8]);
/// let interface = Pattern::empty(5);
/// let mut stiffness = vec![0.0; bulk.nvalue()];
/// for spring in 0..4 {
///     for (row, column, k) in [(0, 0, 2.0), (0, 1, -2.0), (1, 0, -2.0), (1, 1, 2.0)] {
///         let at = bulk.position(spring + row, spring + column).ok_or("not in the pattern")?;
///         stiffness[at] += k;
///     }
/// }
/// let values = Values { bulk: &stiffness, interface: &[] };
/// let problem = Problem {
///     ndof: 5,
///     bulk: &bulk,
///     interface: &interface,
///     fields: &[],
///     equation: &[NONE, 0, 1, 2, 3],
///     nequation: 4,
///     symmetry: Symmetry::Definite,
///     sign: &[1; 4],
///     coordinates: &[[0.0; 3]; 5],
///     between: &[],
/// };
///
/// // unit elongation of each spring: its force at both ends, nothing between
/// let mut force = [0.0; 5];
/// apply(problem.bulk, problem.interface, &values, &[0.0, 1.0, 2.0, 3.0, 4.0], &mut force);
/// assert_eq!(force, [-2.0, 0.0, 0.0, 0.0, 2.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn apply(bulk: &BlockPattern, interface: &Pattern, values: &Values, x: &[f64], y: &mut [f64]) {
    multiply(bulk, interface, values, x, y, |a| a);
}

/// Multiplies the absolute values of the operator with those of a vector: the size of what [`apply`] adds up, and so
/// the yardstick of its round-off.
pub fn apply_absolute(
    bulk: &BlockPattern,
    interface: &Pattern,
    values: &Values,
    x: &[f64],
    y: &mut [f64],
) {
    multiply(bulk, interface, values, x, y, f64::abs);
}

fn multiply(
    bulk: &BlockPattern,
    interface: &Pattern,
    values: &Values,
    x: &[f64],
    y: &mut [f64],
    of: impl Fn(f64) -> f64 + Sync + Copy,
) {
    match bulk.block {
        2 => rows::<2>(bulk, interface, values, x, y, of),
        3 => rows::<3>(bulk, interface, values, x, y, of),
        _ => rows::<1>(bulk, interface, values, x, y, of),
    }
}

fn rows<const N: usize>(
    bulk: &BlockPattern,
    interface: &Pattern,
    values: &Values,
    x: &[f64],
    y: &mut [f64],
    of: impl Fn(f64) -> f64 + Sync + Copy,
) {
    let (x_blocks, _) = x.as_chunks::<N>();
    let (blocks, _) = values.bulk.as_chunks::<N>();
    y.par_chunks_mut(N * ROWS_PER_TASK)
        .enumerate()
        .for_each(|(task, y)| {
            let first = task * ROWS_PER_TASK;
            for (row, y) in (first..).zip(y.chunks_mut(N)) {
                // entries of a block have sums of their own, which do not wait for one another
                let mut parts = [[0.0; N]; N];
                if let Some(&[begin, end]) = bulk.row_start.get(row..row + 2) {
                    for (k, &column) in (begin..end).zip(&bulk.column[begin..end]) {
                        let (Some(x), Some(block)) = (
                            x_blocks.get(column as usize),
                            blocks.get(k * N..(k + 1) * N),
                        ) else {
                            continue;
                        };
                        for (parts, entries) in parts.iter_mut().zip(block) {
                            for ((part, a), x) in parts.iter_mut().zip(entries).zip(x) {
                                *part += of(*a) * of(*x);
                            }
                        }
                    }
                }
                for ((dof, y), parts) in (row * N..).zip(y).zip(parts) {
                    *y = parts.iter().sum();
                    if let Some(&[begin, end]) = interface.row_start.get(dof..dof + 2) {
                        let entries = interface.column[begin..end]
                            .iter()
                            .zip(values.interface.iter().skip(begin));
                        for (&column, a) in entries {
                            *y += of(*a) * of(x.get(column as usize).copied().unwrap_or(0.0));
                        }
                    }
                }
            }
        });
}
