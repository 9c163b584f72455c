//! Rows of the bulk that every rank needs, fetched from those that have them.

use crate::error::LinearError;
use crate::partition::Partition;
use crate::sparsity::BlockPattern;

/// Rows of some nodes, wherever they come from.
pub(super) struct Fetched {
    /// The nodes, in order.
    nodes: Vec<u32>,
    /// Their rows.
    pub pattern: BlockPattern,
    /// Their values.
    pub values: Vec<f64>,
    /// The blocks that this rank gives, in its own pattern.
    given: Vec<usize>,
    /// How many blocks each rank gives.
    counts: Vec<usize>,
    /// The place of each block that arrives.
    place: Vec<usize>,
}

impl Fetched {
    /// Fetches the pattern of the rows of some nodes, given in order, of which `own` has those of this rank.
    ///
    /// # Errors
    /// `Library` where messages fail.
    pub fn new(
        own: &BlockPattern,
        partition: &Partition,
        nodes: &[u32],
    ) -> Result<Self, LinearError> {
        let mut order: Vec<u32> = nodes.to_vec();
        order.retain(|&node| partition.owner(node).is_some());
        order.sort_by_key(|&node| partition.owner(node));
        let mut counts = vec![0; partition.ranks().size()];
        for &node in &order {
            counts[partition.owner(node).unwrap_or_default()] += 1;
        }
        let of_rank = order.iter().filter(|node| partition.is_own(**node));
        let (mut lengths, mut columns, mut given) = (Vec::new(), Vec::new(), Vec::new());
        for &node in of_rank {
            let range = own.row_start[node as usize]..own.row_start[node as usize + 1];
            lengths.push(range.len() as f64);
            columns.extend(own.column[range.clone()].iter().map(|&c| f64::from(c)));
            given.extend(range);
        }
        let mut length = vec![0.0; order.len()];
        partition.all_gather(&lengths, &counts, &mut length)?;
        let mut first = 0;
        for count in &mut counts {
            let of_rank = length[first..first + *count].iter();
            first += *count;
            *count = of_rank.map(|n| *n as usize).sum();
        }
        let mut column = vec![0.0; counts.iter().sum()];
        partition.all_gather(&columns, &counts, &mut column)?;
        // from the order of ranks to that of nodes
        let mut row_start = vec![0; own.nrow() + 1];
        for (&node, n) in order.iter().zip(&length) {
            row_start[node as usize + 1] = *n as usize;
        }
        for row in 0..own.nrow() {
            row_start[row + 1] += row_start[row];
        }
        let rows = order.iter().zip(&length);
        let places = rows.flat_map(|(&node, n)| {
            let start = row_start[node as usize];
            start..start + *n as usize
        });
        let place: Vec<usize> = places.collect();
        let mut sorted = vec![0; column.len()];
        for (&to, c) in place.iter().zip(&column) {
            sorted[to] = *c as u32;
        }
        Ok(Self {
            nodes: nodes.to_vec(),
            pattern: BlockPattern {
                block: own.block,
                row_start: row_start.into(),
                column: sorted.into(),
                partition: None,
            },
            values: Vec::new(),
            given,
            counts,
            place,
        })
    }

    /// Whether it has the rows of these nodes.
    pub fn is_of(&self, nodes: &[u32]) -> bool {
        self.nodes == nodes
    }

    /// Fetches values of its rows.
    ///
    /// # Errors
    /// `Library` where messages fail.
    pub fn update(&mut self, partition: &Partition, values: &[f64]) -> Result<(), LinearError> {
        let width = self.pattern.block * self.pattern.block;
        let mut given = Vec::with_capacity(width * self.given.len());
        for &block in &self.given {
            let of_block = values.get(block * width..(block + 1) * width);
            given.extend_from_slice(of_block.unwrap_or_default());
        }
        let counts: Vec<usize> = self.counts.iter().map(|n| width * n).collect();
        let mut arrived = vec![0.0; width * self.place.len()];
        partition.all_gather(&given, &counts, &mut arrived)?;
        self.values.resize(arrived.len(), 0.0);
        for (&to, block) in self.place.iter().zip(arrived.chunks_exact(width.max(1))) {
            self.values[to * width..(to + 1) * width].copy_from_slice(block);
        }
        Ok(())
    }
}

/// Patterns of rows that are needed again and again.
#[derive(Default)]
pub(super) struct Neighbourhood {
    last: Vec<Fetched>,
    used: usize,
}

impl Neighbourhood {
    /// What follows begins at the first of the rows known before.
    pub fn restart(&mut self) {
        self.used = 0;
    }

    /// The rows of these nodes: those that were asked for in the same place before, or new ones.
    ///
    /// # Errors
    /// As [`Fetched::new`].
    pub fn rows(
        &mut self,
        own: &BlockPattern,
        partition: &Partition,
        nodes: &[u32],
    ) -> Result<&mut Fetched, LinearError> {
        let at = self.used;
        self.used += 1;
        if !self.last.get(at).is_some_and(|rows| rows.is_of(nodes)) {
            self.last.truncate(at);
            self.last.push(Fetched::new(own, partition, nodes)?);
        }
        Ok(&mut self.last[at])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_ranks::on_threads;

    /// A grid of squares, with a number for each entry of each block that says where it belongs.
    fn grid(n: u32) -> BlockPattern {
        let node = |x: u32, y: u32| y * (n + 1) + x;
        let squares = (0..n).flat_map(|y| (0..n).map(move |x| (x, y)));
        let nodes: Vec<u32> = squares
            .flat_map(|(x, y)| [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)])
            .map(|(x, y)| node(x, y))
            .collect();
        let offsets: Vec<usize> = (0..=nodes.len() / 4).map(|square| 4 * square).collect();
        BlockPattern::from_cliques(((n + 1) * (n + 1)) as usize, 3, &nodes, &offsets)
    }

    fn values(pattern: &BlockPattern) -> Vec<f64> {
        let rows = (0..pattern.nrow() as u32)
            .flat_map(|row| pattern.columns(row).iter().map(move |&c| (row, c)));
        rows.flat_map(|(row, c)| {
            (0..9).map(move |k| f64::from(row * 1000 + c) + f64::from(k) / 16.0)
        })
        .collect()
    }

    #[test]
    fn rows_that_were_fetched_are_those_of_the_whole() {
        let whole = grid(9);
        let lists = [vec![0, 17, 44, 45, 99], (0..100).collect(), Vec::new()];
        for (size, nodes) in (1..=3).flat_map(|size| lists.iter().map(move |list| (size, list))) {
            let (all, _) = on_threads(size, |ranks| {
                let own = whole.divided(ranks);
                let partition = own.partition.clone().unwrap();
                let mut rows = Fetched::new(&own, &partition, nodes)?;
                assert!(rows.is_of(nodes) && rows.values.is_empty());
                rows.update(&partition, &values(&own))?;
                Ok::<_, LinearError>(rows)
            });
            for rows in all {
                let rows = rows.unwrap();
                for node in 0..100 {
                    let wanted = match nodes.contains(&node) {
                        true => whole.columns(node),
                        false => &[],
                    };
                    assert_eq!(rows.pattern.columns(node), wanted);
                }
                assert_eq!(rows.values, values(&rows.pattern));
            }
        }
    }

    #[test]
    fn a_neighbourhood_keeps_patterns_that_are_asked_for_again() {
        let (counts, _) = on_threads(2, |ranks| {
            let own = grid(3).divided(ranks);
            let partition = own.partition.clone().unwrap();
            let mut near = Neighbourhood::default();
            let mut fetched = Vec::new();
            for lists in [
                [vec![1], vec![2, 3]],
                [vec![1], vec![2, 3]],
                [vec![4], vec![2, 3]],
            ] {
                near.restart();
                for nodes in &lists {
                    let rows = near.rows(&own, &partition, nodes).unwrap();
                    fetched.push(rows.values.is_empty());
                    rows.update(&partition, &values(&own)).unwrap();
                }
            }
            fetched
        });
        // what follows a list that has changed is fetched, too
        assert!(
            counts
                .iter()
                .all(|new| *new == [true, true, false, false, true, true])
        );
    }
}
