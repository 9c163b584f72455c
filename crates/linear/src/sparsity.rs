//! Which entries of the operator may be nonzero.
//!
//! The operator has two parts over the same raw degrees of freedom, numbered before any of them is prescribed or
//! eliminated. The *bulk* (solids) comes in square blocks, one block row per node; the *interface* (contact rows,
//! couplings, springs, multipliers) comes in single entries and may reach past the bulk.
//!
//! ```text
//!             nodes × block    the rest
//!            ┌───────────────┬─────────┐
//!     nodes  │ bulk          │         │     BlockPattern   blocks of ndim × ndim, row-major
//!    × block │   + interface │ inter-  │     Pattern        single entries
//!            ├───────────────┤ face    │
//!   the rest │ interface               │
//!            └─────────────────────────┘
//! ```
//!
//! Both patterns keep compressed rows with sorted columns and both halves of a symmetric matrix, so that a row can be
//! multiplied, searched and filled on its own. A pattern is built from *cliques*: lists of nodes (or dofs) that all
//! couple with each other, one per element or contact row, flat, with offsets: clique `c` is
//! `members[offsets[c]..offsets[c + 1]]`. A clique of the interface may be *split*: its first members couple with the others
//! alone, as those of one field do with those of another. A row has a diagonal entry only where it occurs in a clique that is
//! not split.

use crate::lists::Lists;
use crate::partition::Partition;
use rayon::prelude::*;
use signorini_ranks::Ranks;
use std::sync::Arc;

/// "No such number": a degree of freedom without an equation, a node without a body.
pub const NONE: u32 = u32::MAX;

/// Rows handled by one task; results do not depend on it.
const ROWS_PER_TASK: usize = 1024;

/// The pattern of the bulk: compressed block rows, both halves, columns sorted; a block row is a mesh node. All who keep one
/// share it.
///
/// # Shapes
/// `row_start` has `nrow + 1` entries, `column` has `nblock`. The values that belong to it are
/// `nblock * block * block` numbers: block after block, each row-major.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BlockPattern {
    /// Rows and columns of one block, the number of dimensions.
    pub block: usize,
    /// Where each block row begins in `column`.
    pub row_start: Arc<[usize]>,
    /// The block column of each block.
    pub column: Arc<[u32]>,
    /// Which rank has which rows; none where all rows are here. Those of other ranks are empty.
    pub partition: Option<Arc<Partition>>,
}

impl BlockPattern {
    /// A pattern of `nrow` block rows without any block.
    pub fn empty(nrow: usize, block: usize) -> Self {
        Self {
            block,
            row_start: vec![0; nrow + 1].into(),
            column: Arc::default(),
            partition: None,
        }
    }

    /// The pattern in which all nodes of a clique couple; members that are not below `nrow` are left out.
    pub fn from_cliques(nrow: usize, block: usize, nodes: &[u32], offsets: &[usize]) -> Self {
        let (row_start, column) = rows_from_cliques(nrow, nodes, offsets, &[]);
        Self {
            block,
            row_start: row_start.into(),
            column: column.into(),
            partition: None,
        }
    }

    /// Of a pattern with all rows, those of this rank: they are divided among these ranks.
    ///
    /// # Example
    /// ```
    /// use signorini_linear::sparsity::BlockPattern;
    /// use signorini_ranks::on_threads;
    ///
    /// let bars = BlockPattern::from_cliques(5, 1, &[0, 1, 1, 2, 2, 3, 3, 4], &[0, 2, 4, 6, 8]);
    /// let (blocks, _) = on_threads(2, |ranks| bars.divided(ranks).nblock());
    /// assert_eq!(blocks.iter().sum::<usize>(), bars.nblock());
    /// ```
    pub fn divided(&self, ranks: &'static dyn Ranks) -> Self {
        let partition = Partition::new(self.nrow(), |row| self.columns(row), ranks);
        let mut row_start = Vec::with_capacity(self.nrow() + 1);
        row_start.push(0);
        let mut column = Vec::new();
        for node in 0..self.nrow() as u32 {
            if partition.is_own(node) {
                column.extend_from_slice(self.columns(node));
            }
            row_start.push(column.len());
        }
        Self {
            block: self.block,
            row_start: row_start.into(),
            column: column.into(),
            partition: Some(partition.into()),
        }
    }

    /// Whether a node has a row, here or on another rank.
    pub fn has_row(&self, node: u32) -> bool {
        match &self.partition {
            Some(partition) => partition.owner(node).is_some(),
            None => self.position(node, node).is_some(),
        }
    }

    /// The columns of a row that is here; none for others.
    pub fn columns(&self, row: u32) -> &[u32] {
        row_of(&self.row_start, &self.column, row)
    }

    /// Raw columns of the row of a raw dof, and where their values are; none for a row that is not here.
    pub(crate) fn row_of_dof(&self, dof: u32) -> impl Iterator<Item = (u32, usize)> + '_ {
        let block = self.block;
        let (node, i) = (dof as usize / block, dof as usize % block);
        let blocks = match self.row_start.get(node..node.saturating_add(2)) {
            Some(&[begin, end]) => begin..end,
            _ => 0..0,
        };
        blocks.flat_map(move |k| {
            let first = self.column[k] as usize * block;
            (0..block).map(move |j| ((first + j) as u32, (k * block + i) * block + j))
        })
    }

    /// The number of block rows.
    pub fn nrow(&self) -> usize {
        self.row_start.len().saturating_sub(1)
    }

    /// The number of blocks.
    pub fn nblock(&self) -> usize {
        self.column.len()
    }

    /// The number of values: `nblock * block * block`.
    pub fn nvalue(&self) -> usize {
        self.column.len() * self.block * self.block
    }

    /// The position in `column` of the block at (`row`, `column`), if it is in the pattern.
    ///
    /// # Example
    /// ```
    /// use signorini_linear::sparsity::BlockPattern;
    ///
    /// // two bars: nodes 0 and 1, nodes 1 and 2
    /// let pattern = BlockPattern::from_cliques(3, 2, &[0, 1, 1, 2], &[0, 2, 4]);
    /// assert_eq!((pattern.nblock(), pattern.nvalue()), (7, 28));
    /// assert!(pattern.position(0, 1).is_some());
    /// assert!(pattern.position(0, 2).is_none());
    /// ```
    pub fn position(&self, row: u32, column: u32) -> Option<usize> {
        position(&self.row_start, &self.column, row, column)
    }
}

/// The pattern of the interface: compressed rows over raw degrees of freedom, both halves, columns sorted. All who keep one
/// share it.
///
/// # Shapes
/// `row_start` has `nrow + 1` entries, `column` has one per value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    /// The number of rows, which is the number of raw degrees of freedom.
    pub nrow: usize,
    /// Where each row begins in `column`.
    pub row_start: Arc<[usize]>,
    /// The column of each entry.
    pub column: Arc<[u32]>,
}

impl Pattern {
    /// A pattern of `nrow` rows without any entry.
    pub fn empty(nrow: usize) -> Self {
        Self {
            nrow,
            row_start: vec![0; nrow + 1].into(),
            column: Arc::default(),
        }
    }

    /// The pattern in which all members of a clique couple; members that are not below `nrow` are left out.
    pub fn from_cliques(nrow: usize, dofs: &[u32], offsets: &[usize]) -> Self {
        Self::from_split_cliques(nrow, dofs, offsets, &[])
    }

    /// The same where the first `splits[c]` members of a clique couple with its other members alone, and these with them; all
    /// members couple where that is 0 or not given.
    ///
    /// # Example
    /// ```
    /// use signorini_linear::sparsity::Pattern;
    ///
    /// // 0 and 1 couple with 2
    /// let pattern = Pattern::from_split_cliques(3, &[0, 1, 2], &[0, 3], &[2]);
    /// assert_eq!(*pattern.column, [2, 2, 0, 1]);
    /// ```
    pub fn from_split_cliques(
        nrow: usize,
        dofs: &[u32],
        offsets: &[usize],
        splits: &[usize],
    ) -> Self {
        let (row_start, column) = rows_from_cliques(nrow, dofs, offsets, splits);
        Self {
            nrow,
            row_start: row_start.into(),
            column: column.into(),
        }
    }

    /// The position of the first entry of a row, and its columns; none for a row outside the pattern.
    pub fn row(&self, row: u32) -> (usize, &[u32]) {
        let first = self.row_start.get(row as usize).copied();
        (
            first.unwrap_or_default(),
            row_of(&self.row_start, &self.column, row),
        )
    }

    /// The number of entries, and of values.
    pub fn nentry(&self) -> usize {
        self.column.len()
    }

    /// The position of the entry at (`row`, `column`), if it is in the pattern.
    pub fn position(&self, row: u32, column: u32) -> Option<usize> {
        position(&self.row_start, &self.column, row, column)
    }
}

/// The columns of one row; none for a row outside the pattern.
fn row_of<'a>(row_start: &[usize], column: &'a [u32], row: u32) -> &'a [u32] {
    match row_start.get(row as usize..(row as usize).saturating_add(2)) {
        Some(&[begin, end]) => column.get(begin..end).unwrap_or_default(),
        _ => &[],
    }
}

fn position(row_start: &[usize], columns: &[u32], row: u32, column: u32) -> Option<usize> {
    let at = row_of(row_start, columns, row)
        .binary_search(&column)
        .ok()?;
    row_start.get(row as usize).map(|begin| begin + at)
}

/// What a member of a clique couples with: all of it, or of one that is split the part that it is not in.
fn coupled(clique: &[u32], split: usize, row: u32) -> [&[u32]; 2] {
    let (first, others) = clique.split_at(split.min(clique.len()));
    match split {
        0 => [clique, &[]],
        _ => [
            if others.contains(&row) { first } else { &[] },
            if first.contains(&row) { others } else { &[] },
        ],
    }
}

/// Compressed rows from cliques: each row is the sorted union of what the row couples with in the cliques that it occurs in.
fn rows_from_cliques(
    nrow: usize,
    members: &[u32],
    offsets: &[usize],
    splits: &[usize],
) -> (Vec<usize>, Vec<u32>) {
    let cliques = || {
        offsets
            .windows(2)
            .map(|ends| members.get(ends[0]..ends[1]).unwrap_or_default())
    };

    let cliques_of = Lists::new(nrow, || {
        let known = |&&row: &&u32| (row as usize) < nrow;
        (0u32..).zip(cliques()).flat_map(move |(clique, rows)| {
            let rows = rows.iter().filter(known);
            rows.map(move |&row| (row as usize, clique))
        })
    });

    // their union, a task for each run of rows; `seen` holds the last row that met a column
    let ntask = nrow.div_ceil(ROWS_PER_TASK);
    let parts: Vec<(Vec<usize>, Vec<u32>)> = (0..ntask)
        .into_par_iter()
        .map_init(
            || vec![NONE; nrow],
            |seen, task| {
                let rows = task * ROWS_PER_TASK..nrow.min((task + 1) * ROWS_PER_TASK);
                let mut length = Vec::with_capacity(rows.len());
                let mut column = Vec::new();
                for row in rows {
                    let begin = column.len();
                    for &clique in cliques_of.of(row) {
                        let ends = offsets[clique as usize]..offsets[clique as usize + 1];
                        let split = splits.get(clique as usize).copied().unwrap_or_default();
                        let others = coupled(&members[ends], split, row as u32);
                        for &other in others.into_iter().flatten() {
                            if (other as usize) < nrow && seen[other as usize] != row as u32 {
                                seen[other as usize] = row as u32;
                                column.push(other);
                            }
                        }
                    }
                    column[begin..].sort_unstable();
                    length.push(column.len() - begin);
                }
                (length, column)
            },
        )
        .collect();

    let mut row_start = Vec::with_capacity(nrow + 1);
    let mut column = Vec::with_capacity(parts.iter().map(|(_, column)| column.len()).sum());
    let mut end = 0;
    row_start.push(0);
    for (length, part) in parts {
        for n in length {
            end += n;
            row_start.push(end);
        }
        column.extend_from_slice(&part);
    }
    (row_start, column)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A small generator with a fixed seed, so that a failure can be repeated.
    fn random(state: &mut u64) -> u32 {
        *state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (*state >> 33) as u32
    }

    fn random_cliques(nrow: u32, nclique: usize, seed: u64) -> (Vec<u32>, Vec<usize>) {
        let mut state = seed;
        let (mut members, mut offsets) = (Vec::new(), vec![0]);
        for _ in 0..nclique {
            for _ in 0..random(&mut state) % 6 {
                members.push(random(&mut state) % nrow);
            }
            offsets.push(members.len());
        }
        (members, offsets)
    }

    /// All pairs, the plain way.
    fn dense(nrow: usize, members: &[u32], offsets: &[usize]) -> Vec<Vec<bool>> {
        let mut full = vec![vec![false; nrow]; nrow];
        for ends in offsets.windows(2) {
            for &row in &members[ends[0]..ends[1]] {
                for &column in &members[ends[0]..ends[1]] {
                    full[row as usize][column as usize] = true;
                }
            }
        }
        full
    }

    #[test]
    fn cliques_give_exactly_their_pairs_sorted() {
        // more rows than one task takes
        for (nrow, nclique, seed) in [(1, 3, 1), (40, 30, 2), (3000, 1500, 3)] {
            let (members, offsets) = random_cliques(nrow, nclique, seed);
            let nrow = nrow as usize;
            let pattern = BlockPattern::from_cliques(nrow, 3, &members, &offsets);
            let full = dense(nrow, &members, &offsets);
            assert_eq!(
                (pattern.nrow(), pattern.nvalue()),
                (nrow, 9 * pattern.nblock())
            );
            for (row, wanted) in full.iter().enumerate() {
                let columns = row_of(&pattern.row_start, &pattern.column, row as u32);
                assert!(columns.windows(2).all(|pair| pair[0] < pair[1]));
                let wanted: Vec<u32> = (0..nrow as u32)
                    .filter(|&column| wanted[column as usize])
                    .collect();
                assert_eq!(columns, wanted);
            }
        }
    }

    #[test]
    fn position_finds_every_entry_and_nothing_else() {
        let (members, offsets) = random_cliques(50, 40, 7);
        let pattern = Pattern::from_cliques(50, &members, &offsets);
        let full = dense(50, &members, &offsets);
        let mut found = 0;
        for row in 0..60 {
            for column in 0..60 {
                let at = pattern.position(row, column);
                let wanted = row < 50 && column < 50 && full[row as usize][column as usize];
                assert_eq!(at.is_some(), wanted);
                if let Some(at) = at {
                    assert_eq!((at, pattern.column[at]), (found, column));
                    found += 1;
                }
            }
        }
        assert_eq!(found, pattern.nentry());
    }

    #[test]
    fn split_cliques_give_exactly_the_pairs_across() {
        let nrow = 60;
        let (members, offsets) = random_cliques(nrow, 80, 5);
        let splits: Vec<usize> = (0..80).map(|clique| clique % 4).collect();
        let pattern = Pattern::from_split_cliques(nrow as usize, &members, &offsets, &splits);
        let mut wanted = vec![vec![false; nrow as usize]; nrow as usize];
        for (ends, &split) in offsets.windows(2).zip(&splits) {
            let clique = &members[ends[0]..ends[1]];
            for (i, &row) in clique.iter().enumerate() {
                for (j, &column) in clique.iter().enumerate() {
                    wanted[row as usize][column as usize] |=
                        split == 0 || (i < split) != (j < split);
                }
            }
        }
        for (row, wanted) in wanted.iter().enumerate() {
            let (_, columns) = pattern.row(row as u32);
            let wanted = (0..nrow).filter(|&column| wanted[column as usize]);
            assert!(wanted.eq(columns.iter().copied()));
        }
    }

    #[test]
    fn a_row_outside_all_cliques_is_empty() {
        let pattern = BlockPattern::from_cliques(4, 2, &[1, 3], &[0, 2]);
        assert_eq!(*pattern.row_start, [0, 0, 2, 2, 4]);
        assert_eq!(*pattern.column, [1, 3, 1, 3]);
        assert_eq!(
            BlockPattern::from_cliques(0, 2, &[], &[0]),
            BlockPattern::empty(0, 2)
        );
        assert_eq!(Pattern::from_cliques(3, &[], &[]), Pattern::empty(3));
    }
}
