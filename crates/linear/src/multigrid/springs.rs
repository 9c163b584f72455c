//! Springs in place of multipliers, for the levels of a hierarchy.
//!
//! What multipliers hold together, the stiffness of the bodies does not know of: where two blocks touch over a whole face,
//! a hierarchy of it moves each as if it were alone, and motions of one against the other, which are many times as stiff
//! as that, are found by iterations alone. On every level, springs stand for the rows of multipliers,
//!
//! ```text
//!   S = Cᵀ C      C: rows of multipliers over displacements, each in units of its spring
//!   A + S         in the residuals of a level, of which the smoother knows A
//!   C P           on the next one; the coarsest level is solved with all of S
//! ```
//!
//! No stiffer than the smoother stands: `D⁻¹ S`, with the diagonal D of A, has no eigenvalue above [`STIFFEST`]. What
//! slips has a small row; an open contact has none.

use super::blocks::Blocks;
use super::fine::Fine;
use super::packed::Packed;
use super::values::Means;
use crate::problem::{Kept, Values};
use crate::sparsity::NONE;

/// Rows that are a block.
const GROUP: usize = 3;
/// The largest sum of a row of `D^-½ S D^-½`, which no eigenvalue exceeds. Measured, iterations of two runs in which one
/// block slides on another, with 12,000 and 53,000 unknowns: 160 and 227 without springs; 107, 101, 117, 162 and 122, 123,
/// 164, 260 with 0.9, 1.3, 1.8, 2.5.
const STIFFEST: f64 = 0.9;

/// Rows of springs over the rows of a level.
pub(super) type Rows<const N: usize> = Blocks<GROUP, N>;

/// The springs of a level.
pub(super) struct Springs<const N: usize> {
    rows: Packed<GROUP, N>,
    back: Packed<N, GROUP>,
    stretch: Vec<[f32; GROUP]>,
}

impl<const N: usize> Springs<N> {
    /// Springs with these rows.
    pub fn new(rows: &Rows<N>) -> Self {
        Self {
            rows: Packed::new(rows),
            back: Packed::transposed(rows),
            stretch: vec![[0.0; GROUP]; rows.nrow()],
        }
    }

    /// `to −= S x`
    pub fn subtract(&mut self, x: &[[f32; N]], to: &mut [[f32; N]]) {
        self.stretch.fill([0.0; GROUP]);
        self.rows.multiply::<false>(x, &mut self.stretch);
        self.back.multiply::<true>(&self.stretch, to);
    }
}

/// The rows of all multipliers over the finest level, in units of springs about as stiff as the node that each acts on
/// most; `None` where there are none.
pub(super) fn rows(kept: &Kept, values: &Values, fine: &Fine) -> Option<Rows<3>> {
    rows_and_strengths(kept, values, Means::Here(kept, values), fine).0
}

/// The same with the sum of the diagonal of `cᵀ c` for the row of each multiplier that acts, by its raw dof.
pub(super) fn rows_and_strengths(
    kept: &Kept,
    values: &Values,
    means: Means<'_>,
    fine: &Fine,
) -> (Option<Rows<3>>, Vec<(usize, f64)>) {
    let nbulk = 3 * kept.bulk.nrow();
    let interface = |dof: usize| {
        let ends = kept.interface.row_start.get(dof..dof + 2);
        let range = ends.map_or(0..0, |ends| ends[0]..ends[1]);
        let columns = kept.interface.column.get(range.clone()).unwrap_or(&[]);
        let values = values.interface.get(range).unwrap_or(&[]);
        columns.iter().map(|&c| c as usize).zip(values)
    };
    // forces of multipliers are as large whether they hold or slip
    let mut acts = vec![(0.0f64, 0); kept.equation.len().saturating_sub(nbulk)];
    for dof in (0..nbulk).filter(|&dof| kept.is_free(dof)) {
        for (column, value) in interface(dof) {
            let Some(most) = column.checked_sub(nbulk).and_then(|k| acts.get_mut(k)) else {
                continue;
            };
            if value.abs() > most.0 {
                *most = (value.abs(), dof / 3);
            }
        }
    }
    let stiffness = |node: usize| Some(means.of(node)).filter(|mean| *mean > 0.0);
    let unit = |&(most, node): &(f64, usize)| {
        let stiffness = stiffness(node).filter(|_| most > 0.0)?;
        Some(stiffness.sqrt() / most)
    };
    let acting: Vec<(usize, f64)> = (nbulk..)
        .zip(&acts)
        .filter(|(dof, _)| kept.is_multiplier(*dof))
        .filter_map(|(dof, acts)| unit(acts).map(|unit| (dof, unit)))
        .collect();
    let mut all = Rows {
        ncolumn: fine.node.len(),
        start: vec![0],
        column: Vec::new(),
        value: Vec::new(),
    };
    let mut group: Vec<(u32, usize, usize, f64)> = Vec::new();
    let mut strengths = Vec::with_capacity(acting.len());
    for dofs in acting.chunks(GROUP) {
        group.clear();
        for (k, &(dof, unit)) in dofs.iter().enumerate() {
            let mut strength = 0.0;
            for (column, value) in interface(dof).filter(|(c, v)| *c < nbulk && **v != 0.0) {
                let row = fine.row(column / 3);
                if row != NONE && kept.is_free(column) {
                    group.push((row, k, column % 3, unit * value));
                    strength += (unit * value).powi(2);
                }
            }
            strengths.push((dof, strength));
        }
        group.sort_unstable_by_key(|&(row, ..)| row);
        for of_row in group.chunk_by(|a, b| a.0 == b.0) {
            let mut block = [[0.0; 3]; GROUP];
            for &(_, k, axis, value) in of_row {
                block[k][axis] += value;
            }
            all.column.push(of_row[0].0);
            all.value.push(block);
        }
        all.start.push(all.column.len());
    }
    (Some(all).filter(|all| !all.column.is_empty()), strengths)
}

/// How many springs of multipliers, given by raw dofs and stiffness, differ between two lists by more than this part.
pub(super) fn changes(old: &[(usize, f64)], new: &[(usize, f64)], part: f64) -> usize {
    let (mut old, mut new) = (old.iter().peekable(), new.iter().peekable());
    let mut changes = 0;
    while let Some(dof) = [old.peek(), new.peek()]
        .into_iter()
        .flatten()
        .map(|s| s.0)
        .min()
    {
        let [a, b] = [&mut old, &mut new]
            .map(|springs| springs.next_if(|s| s.0 == dof).map_or(0.0, |s| s.1));
        changes += usize::from((a - b).abs() > part * a.max(b));
    }
    changes
}

/// Makes springs no stiffer than `STIFFEST` allows compared with this diagonal.
pub(super) fn limit<const N: usize>(rows: &mut Rows<N>, diagonal: impl Fn(usize) -> [f32; N]) {
    let inverse_root = |d: f32| {
        if d > 0.0 {
            f64::from(d).sqrt().recip()
        } else {
            0.0
        }
    };
    // C D^-½, without signs
    let mut sizes = rows.clone();
    for (&column, block) in rows.column.iter().zip(&mut sizes.value) {
        let root = diagonal(column as usize).map(inverse_root);
        for line in block {
            line.iter_mut()
                .zip(root)
                .for_each(|(v, root)| *v = v.abs() * root);
        }
    }
    let mut sums = vec![[0.0; N]; rows.ncolumn];
    for row in 0..rows.nrow() {
        let mut whole = [0.0; GROUP];
        for (_, block) in sizes.row(row) {
            for (whole, line) in whole.iter_mut().zip(block) {
                *whole += line.iter().sum::<f64>();
            }
        }
        for (column, block) in sizes.row(row) {
            for (whole, line) in whole.iter().zip(block) {
                let entries = sums[column].iter_mut().zip(line);
                entries.for_each(|(sum, size)| *sum += size * whole);
            }
        }
    }
    for row in 0..rows.nrow() {
        let mut factor = [1.0f64; GROUP];
        for (column, block) in sizes.row(row) {
            for (factor, line) in factor.iter_mut().zip(block) {
                let met = sums[column]
                    .iter()
                    .zip(line)
                    .filter(|(_, size)| **size > 0.0);
                *factor = met.fold(*factor, |least, (sum, _)| least.min(STIFFEST / sum));
            }
        }
        let range = rows.range(row);
        for block in &mut rows.value[range] {
            for (line, factor) in block.iter_mut().zip(factor) {
                line.iter_mut().for_each(|value| *value *= factor.sqrt());
            }
        }
    }
}

/// `C P`
pub(super) fn projected<const N: usize, const M: usize>(
    rows: &Rows<N>,
    prolong: &Packed<N, M, i16>,
) -> Rows<M> {
    let mut is_met = vec![false; rows.ncolumn];
    for &column in &rows.column {
        is_met[column as usize] = true;
    }
    rows.times(&prolong.blocks(|row| is_met[row]), |_, _, _| {})
}

/// `Cᵀ C`
pub(super) fn stiffness<const N: usize>(rows: &Rows<N>) -> Blocks<N, N> {
    let one = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let nrow = rows.nrow();
    let unit = Blocks {
        ncolumn: nrow,
        start: (0..=nrow).collect(),
        column: (0..nrow as u32).collect(),
        value: vec![one; nrow],
    };
    unit.projected(rows)
}

#[cfg(test)]
mod tests {
    use super::super::aggregation::MODES;
    use super::*;

    /// Two blocks of rows over three places; the second place has no diagonal along the last axis.
    fn rows() -> Rows<3> {
        let block = |k: usize| {
            std::array::from_fn(|i| {
                std::array::from_fn(|j| ((7 * k + 3 * i + 2 * j) % 5) as f64 - 2.0)
            })
        };
        Blocks {
            ncolumn: 3,
            start: vec![0, 2, 4],
            column: vec![0, 1, 1, 2],
            value: (0..4).map(block).collect(),
        }
    }

    fn diagonal(place: usize) -> [f32; 3] {
        [[4.0, 4.0, 4.0], [9.0, 1.0, 0.0], [2.0, 2.0, 2.0]][place]
    }

    /// All rows, one line of numbers each.
    fn dense<const N: usize>(rows: &Blocks<GROUP, N>) -> Vec<Vec<f64>> {
        let mut lines = vec![vec![0.0; N * rows.ncolumn]; GROUP * rows.nrow()];
        for row in 0..rows.nrow() {
            for (column, block) in rows.row(row) {
                for (k, line) in block.iter().enumerate() {
                    lines[GROUP * row + k][N * column..N * (column + 1)].copy_from_slice(line);
                }
            }
        }
        lines
    }

    /// Entry i, j of Cᵀ C.
    fn stiff(lines: &[Vec<f64>], i: usize, j: usize) -> f64 {
        lines.iter().map(|line| line[i] * line[j]).sum()
    }

    #[test]
    fn springs_pull_as_their_rows_say() {
        let rows = rows();
        let lines = dense(&rows);
        let x = [[1.0f32, -2.0, 3.0], [0.5, 0.0, 4.0], [-1.0, 2.0, 0.25]];
        let mut to = [[1.0f32; 3]; 3];
        Springs::new(&rows).subtract(&x, &mut to);
        for (i, to) in to.as_flattened().iter().enumerate() {
            let x = x.as_flattened().iter().enumerate();
            let pull: f64 = x.map(|(j, x)| stiff(&lines, i, j) * f64::from(*x)).sum();
            assert!((f64::from(*to) - (1.0 - pull)).abs() < 1e-5);
        }
    }

    #[test]
    fn no_spring_is_stiffer_than_the_smoother_stands() {
        let sums = |rows: &Rows<3>| -> Vec<f64> {
            let lines = dense(rows);
            let root = |i: usize| f64::from(diagonal(i / 3)[i % 3]).sqrt();
            let of = |i: usize| {
                let entry = |j: usize| stiff(&lines, i, j).abs() / (root(i) * root(j));
                (0..9).filter(|&j| root(j) > 0.0).map(entry).sum()
            };
            (0..9).filter(|&i| root(i) > 0.0).map(of).collect()
        };
        let largest = |of: &[f64]| of.iter().fold(0.0f64, |a, b| a.max(*b));
        for scale in [1e-3, 1.0, 1e3] {
            let mut scaled = rows();
            let numbers = scaled.value.as_flattened_mut().as_flattened_mut();
            numbers.iter_mut().for_each(|v| *v *= scale);
            let before = sums(&scaled);
            limit(&mut scaled, diagonal);
            let after = sums(&scaled);
            assert!(largest(&after) <= STIFFEST * (1.0 + 1e-12), "{after:?}");
            if largest(&before) <= STIFFEST {
                assert_eq!(before, after);
            } else {
                assert!(largest(&after) > 0.2 * STIFFEST, "{after:?}");
            }
        }
    }

    #[test]
    fn the_springs_of_a_level_are_those_of_the_finer_one_seen_from_it() {
        let rows = rows();
        // the first and the last place move by whole numbers, which 16 bits hold
        let block = |k: usize| {
            std::array::from_fn(|i| {
                std::array::from_fn(|j| [[2.0, 1.0], [-2.0, 0.0]][k][(i + j) % 2])
            })
        };
        let prolong: Blocks<3, MODES> = Blocks {
            ncolumn: 2,
            start: vec![0, 1, 1, 2],
            column: vec![1, 0],
            value: vec![block(0), block(1)],
        };
        let found = dense(&projected(&rows, &Packed::new(&prolong)));
        let (fine, coarse) = (dense(&rows), dense(&prolong));
        for (found, fine) in found.iter().zip(&fine) {
            for (j, found) in found.iter().enumerate() {
                let wanted: f64 = fine.iter().zip(&coarse).map(|(c, p)| c * p[j]).sum();
                assert!((found - wanted).abs() < 1e-3, "{found} {wanted}");
            }
        }
        let coarse = projected(&rows, &Packed::new(&prolong));
        let (lines, whole) = (dense(&coarse), stiffness(&coarse));
        for row in 0..2 {
            for (column, block) in whole.row(row) {
                for (k, found) in block.as_flattened().iter().enumerate() {
                    let (i, j) = (MODES * row + k / MODES, MODES * column + k % MODES);
                    assert!((found - stiff(&lines, i, j)).abs() < 1e-9);
                }
            }
        }
    }
}
