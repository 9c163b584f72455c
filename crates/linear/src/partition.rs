//! Which rank has which rows of the bulk.
//!
//! ```text
//!   nodes        ●──●──●──●──●──●──●          rank 0 has the rows of the first four, rank 1 those of the others;
//!   rows         ├ rank 0 ──┤├ rank 1┤        an element across the line is evaluated by both
//!   vectors      ├──── every rank ───┤
//! ```
//!
//! Rows of other ranks are empty in the pattern of a rank. Vectors have all entries on every rank: each computes those of
//! its nodes, and [`Partition::complete`] fetches the others.

use crate::error::LinearError;
use crate::ordering::metis;
use signorini_ranks::{Ranks, RanksError};

/// No rank, or no body.
const NONE: u32 = u32::MAX;

/// How the nodes of a mesh are divided among ranks: by METIS, the same on every rank.
#[derive(Clone, Debug)]
pub struct Partition {
    ranks: &'static dyn Ranks,
    /// The rank of each node, or `NONE` where it has no row.
    owner: Vec<u32>,
    /// The connected body of each node, or `NONE`.
    body: Vec<u32>,
    /// The nodes of all ranks, rank by rank, in order.
    nodes: Vec<u32>,
    /// How many each rank has.
    counts: Vec<usize>,
}

impl PartialEq for Partition {
    fn eq(&self, other: &Self) -> bool {
        self.owner == other.owner && self.ranks.rank() == other.ranks.rank()
    }
}

impl Eq for Partition {}

impl Partition {
    /// Divides so many rows with these columns, all of which are here.
    pub(crate) fn new<'a>(
        nrow: usize,
        columns: impl Fn(u32) -> &'a [u32],
        ranks: &'static dyn Ranks,
    ) -> Self {
        let body = body_of_each(nrow, &columns);
        let used: Vec<u32> = (0..nrow as u32)
            .filter(|&node| body[node as usize] != NONE)
            .collect();
        let mut place = vec![NONE; nrow];
        for (at, &node) in (0..).zip(&used) {
            place[node as usize] = at;
        }
        let size = ranks.size();
        let near = |at: u32| {
            let node = used[at as usize];
            let others = columns(node).iter().filter(move |&&c| c != node);
            others.map(|&c| place[c as usize])
        };
        let parts = match size {
            0 | 1 => vec![0; used.len()],
            _ => metis::share_out(used.len(), near, size),
        };
        let mut owner = vec![NONE; nrow];
        let mut counts = vec![0; size.max(1)];
        for (&node, &part) in used.iter().zip(&parts) {
            owner[node as usize] = part;
            counts[part as usize] += 1;
        }
        let mut nodes = used;
        nodes.sort_by_key(|&node| owner[node as usize]);
        Self {
            ranks,
            owner,
            body,
            nodes,
            counts,
        }
    }

    /// The ranks.
    pub fn ranks(&self) -> &'static dyn Ranks {
        self.ranks
    }

    /// The rank that has the row of a node; none where it has no row.
    pub fn owner(&self, node: u32) -> Option<usize> {
        let owner = self.owner.get(node as usize).filter(|&&rank| rank != NONE);
        owner.map(|&rank| rank as usize)
    }

    /// Whether this rank has the row of a node.
    pub fn is_own(&self, node: u32) -> bool {
        self.owner(node) == Some(self.ranks.rank())
    }

    /// The nodes whose rows this rank has, in order.
    pub fn own(&self) -> &[u32] {
        let rank = self.ranks.rank();
        let first: usize = self.counts.iter().take(rank).sum();
        let count = self.counts.get(rank).copied().unwrap_or(0);
        self.nodes.get(first..first + count).unwrap_or_default()
    }

    /// The nodes of each connected body, in their order.
    pub(crate) fn bodies(&self) -> Vec<Vec<u32>> {
        grouped(&self.body)
    }

    /// Fetches the entries at nodes of other ranks.
    ///
    /// # Shapes
    /// `lists`: `width` numbers for each node, one node after the other, and whatever comes after them.
    ///
    /// # Errors
    /// `Library` where messages fail.
    ///
    /// # Example
    /// ```
    /// use signorini_linear::sparsity::BlockPattern;
    /// use signorini_ranks::on_threads;
    ///
    /// // four bars in a row; each rank knows the forces at its nodes
    /// let bars = BlockPattern::from_cliques(5, 1, &[0, 1, 1, 2, 2, 3, 3, 4], &[0, 2, 4, 6, 8]);
    /// let (forces, _) = on_threads(2, |ranks| {
    ///     let mut forces = [0.0; 5];
    ///     if let Some(partition) = bars.divided(ranks).partition {
    ///         for &node in partition.own() {
    ///             forces[node as usize] = f64::from(node);
    ///         }
    ///         partition.complete(1, [&mut forces])?;
    ///     }
    ///     Ok::<_, signorini_linear::LinearError>(forces)
    /// });
    /// assert!(forces.into_iter().all(|forces| forces == Ok([0.0, 1.0, 2.0, 3.0, 4.0])));
    /// ```
    pub fn complete<const N: usize>(
        &self,
        width: usize,
        lists: [&mut [f64]; N],
    ) -> Result<(), LinearError> {
        if self.ranks.size() < 2 {
            return Ok(());
        }
        let of_node = |node: u32| node as usize * width..(node as usize + 1) * width;
        let mut own = Vec::with_capacity(N * width * self.own().len());
        for &node in self.own() {
            for list in &lists {
                own.extend_from_slice(list.get(of_node(node)).unwrap_or_default());
            }
        }
        let counts: Vec<usize> = self.counts.iter().map(|n| N * width * n).collect();
        let mut all = vec![0.0; N * width * self.nodes.len()];
        self.all_gather(&own, &counts, &mut all)?;
        let mut from = all.chunks_exact(width.max(1));
        let mut lists = lists;
        for &node in &self.nodes {
            for list in &mut lists {
                let (to, from) = (list.get_mut(of_node(node)), from.next());
                if let Some((to, from)) = to.zip(from) {
                    to.copy_from_slice(from);
                }
            }
        }
        Ok(())
    }

    /// The largest of a number of each rank.
    ///
    /// # Errors
    /// As [`Partition::complete`].
    pub fn largest(&self, own: f64) -> Result<f64, LinearError> {
        let size = self.ranks.size();
        let mut all = vec![0.0; size];
        self.all_gather(&[own], &vec![1; size], &mut all)?;
        // what is no number is the largest
        let larger = |a: f64, b: f64| if a.total_cmp(&b).is_gt() { a } else { b };
        Ok(all.into_iter().fold(own, larger))
    }

    /// The least of a number of each rank.
    ///
    /// # Errors
    /// As [`Partition::complete`].
    pub fn least(&self, own: u64) -> Result<u64, LinearError> {
        let mut number = [own];
        self.ranks.least(&mut number).map_err(|e| failed(&e))?;
        Ok(number[0])
    }

    /// Whether this is so on every rank.
    ///
    /// # Errors
    /// As [`Partition::complete`].
    pub fn is_on_all(&self, own: bool) -> Result<bool, LinearError> {
        Ok(self.least(u64::from(own))? == 1)
    }

    /// The numbers of all ranks, one rank after the other.
    ///
    /// # Shapes
    /// `counts`: how many each rank has.
    ///
    /// # Errors
    /// As [`Partition::complete`].
    pub fn all_gather(
        &self,
        own: &[f64],
        counts: &[usize],
        all: &mut [f64],
    ) -> Result<(), LinearError> {
        let gathered = self.ranks.all_gather(own, counts, all);
        gathered.map_err(|error| failed(&error))
    }
}

/// An error between ranks as one of a library.
pub(crate) const fn failed(error: &RanksError) -> LinearError {
    let code = match error {
        RanksError::Library { code, .. } => *code,
        RanksError::Shape { .. } => -1,
    };
    LinearError::Library {
        name: "MPI",
        code,
        detail: 0,
    }
}

/// The nodes of each connected body, in their order, from the columns of so many rows.
pub(crate) fn bodies<'a>(nrow: usize, columns: impl Fn(u32) -> &'a [u32]) -> Vec<Vec<u32>> {
    grouped(&body_of_each(nrow, columns))
}

/// The nodes of each body, in their order.
fn grouped(body: &[u32]) -> Vec<Vec<u32>> {
    let last = body.iter().filter(|&&body| body != NONE).max();
    let mut bodies = vec![Vec::new(); last.map_or(0, |&last| last as usize + 1)];
    for (node, &body) in (0..).zip(body) {
        if let Some(of_body) = bodies.get_mut(body as usize) {
            of_body.push(node);
        }
    }
    bodies
}

/// The connected body of each node, numbered by their first nodes, or `NONE`.
fn body_of_each<'a>(nrow: usize, columns: impl Fn(u32) -> &'a [u32]) -> Vec<u32> {
    let mut body = vec![NONE; nrow];
    let mut nodes = Vec::new();
    let mut count = 0;
    for first in 0..nrow as u32 {
        if body[first as usize] != NONE || columns(first).is_empty() {
            continue;
        }
        body[first as usize] = count;
        nodes.push(first);
        while let Some(node) = nodes.pop() {
            for &other in columns(node) {
                if body.get(other as usize) == Some(&NONE) {
                    body[other as usize] = count;
                    nodes.push(other);
                }
            }
        }
        count += 1;
    }
    body
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sparsity::BlockPattern;
    use signorini_ranks::Alone;
    use std::sync::Arc;

    /// One of so many ranks that never speak.
    #[derive(Debug)]
    struct Mute(usize, usize);

    impl Ranks for Mute {
        fn rank(&self) -> usize {
            self.0
        }

        fn size(&self) -> usize {
            self.1
        }

        fn all_gather(&self, _: &[f64], _: &[usize], _: &mut [f64]) -> Result<(), RanksError> {
            Err(RanksError::Library {
                call: "all_gather",
                code: 7,
            })
        }

        fn broadcast(&self, _: &mut [u8]) -> Result<(), RanksError> {
            Ok(())
        }

        fn least(&self, _: &mut [u64]) -> Result<(), RanksError> {
            Ok(())
        }

        fn abort(&self, _: u8) {}
    }

    /// Two chains of bars, with a node between them that has none.
    fn chains() -> BlockPattern {
        let bars = (0..30u32).filter(|&n| n != 14 && n != 15);
        let nodes: Vec<u32> = bars.flat_map(|n| [n, n + 1]).collect();
        let offsets: Vec<usize> = (0..=nodes.len() / 2).map(|bar| 2 * bar).collect();
        BlockPattern::from_cliques(31, 3, &nodes, &offsets)
    }

    fn partition_of(pattern: &BlockPattern) -> Arc<Partition> {
        pattern.partition.clone().unwrap()
    }

    #[test]
    fn every_row_is_that_of_one_rank() {
        let whole = chains();
        let of = |rank: &'static Mute| whole.divided(rank);
        let patterns = [of(&Mute(0, 3)), of(&Mute(1, 3)), of(&Mute(2, 3))];
        let all = patterns.each_ref().map(partition_of);
        for node in 0..31 {
            let owners = all.iter().filter(|p| p.is_own(node)).count();
            assert_eq!(owners, usize::from(node != 15));
            assert_eq!(all[0].owner(node), all[2].owner(node));
        }
        let own: Vec<usize> = all.iter().map(|p| p.own().len()).collect();
        assert_eq!(own.iter().sum::<usize>(), 30);
        assert!(own.iter().all(|n| (8..=12).contains(n)), "{own:?}");
        for (pattern, partition) in patterns.iter().zip(&all) {
            for node in 0..31 {
                let is_own = partition.is_own(node);
                let wanted = if is_own { whole.columns(node) } else { &[] };
                assert_eq!(pattern.columns(node), wanted);
                assert_eq!(pattern.has_row(node), node != 15);
            }
        }
    }

    #[test]
    fn bodies_are_what_hangs_together() {
        let bodies = partition_of(&chains().divided(&Alone)).bodies();
        assert_eq!(bodies.len(), 2);
        assert_eq!(bodies[0], (0..15).collect::<Vec<u32>>());
        assert_eq!(bodies[1], (16..31).collect::<Vec<u32>>());
    }

    #[test]
    fn what_messages_fail_with_is_an_error() {
        let partition = partition_of(&chains().divided(&Mute(0, 2)));
        let failure = partition.complete(3, [&mut [0.0; 93]]).unwrap_err();
        let library = LinearError::Library {
            name: "MPI",
            code: 7,
            detail: 0,
        };
        assert_eq!(failure, library);
        assert_eq!(partition.largest(1.0).unwrap_err(), library);
    }
}
