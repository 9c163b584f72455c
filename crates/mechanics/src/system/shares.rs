//! Which thread adds up which rows.
//!
//! ```text
//!   rows     ├───────── 0 ─────────┼───────── 1 ─────────┤
//!   chunks   a  b  c  d  e  f                               thread 0 evaluates a to f, and adds the rows above the line
//!                        e  f  g  h  i  j  k                thread 1 evaluates e to k, and adds the rows below it
//! ```
//!
//! Each thread evaluates the chunks that touch its rows, and adds each while it is in cache; those across a line are
//! evaluated by both. Nothing that one thread has written is read by another, and an entry is the same sum, chunk by
//! chunk, whoever adds it up.

use signorini_geometry::mesh::NodeId;

/// Chunks of a thread, at least.
const CHUNKS: usize = 8;
/// Evaluations of a chunk in the mean, at most: where numbers of nodes are scattered, there are more.
const EVALUATIONS: f64 = 1.25;

/// What one thread evaluates and adds.
pub(super) struct Share {
    /// The node after its last one.
    pub end: usize,
    /// The chunks that touch its nodes, in order.
    pub chunks: Vec<usize>,
}

/// Where to divide rows, so that each of so many parts has about as many of these nodes: the first node of each but the
/// first part.
pub(super) fn divide(npart: usize, nnode: usize, nodes: &mut [NodeId]) -> Vec<usize> {
    let first = |k: usize| {
        let at = k * nodes.len() / npart;
        match at < nodes.len() {
            true => *nodes.select_nth_unstable(at).1 as usize,
            false => nnode,
        }
    };
    (1..npart).map(first).collect()
}

/// Shares rows among threads. `elements` hands over the nodes of all elements of a chunk. None where there is too little,
/// or where too much would be evaluated more than once.
pub(super) fn share_out(
    nthread: usize,
    nnode: usize,
    all: &[usize],
    elements: impl Fn(usize, &mut dyn FnMut(&[NodeId])),
) -> Vec<Share> {
    let nchunk = all.len();
    if nthread < 2 || nchunk < CHUNKS * nthread {
        return Vec::new();
    }
    let mut firsts: Vec<NodeId> = Vec::new();
    for &chunk in all {
        elements(chunk, &mut |nodes| firsts.extend(nodes.first()));
    }
    let mut ends = divide(nthread, nnode, &mut firsts);
    ends.push(nnode);
    let share = |&end: &usize| Share {
        end,
        chunks: Vec::new(),
    };
    let mut shares: Vec<Share> = ends.iter().map(share).collect();
    let mut touched = vec![false; nthread];
    for &chunk in all {
        touched.fill(false);
        elements(chunk, &mut |nodes| {
            for &node in nodes {
                let share = ends.partition_point(|&end| end <= node as usize);
                touched[share.min(nthread - 1)] = true;
            }
        });
        let is_in = shares.iter_mut().zip(&touched).filter(|(_, is)| **is);
        is_in.for_each(|(share, _)| share.chunks.push(chunk));
    }
    let nevaluation: usize = shares.iter().map(|share| share.chunks.len()).sum();
    if nevaluation as f64 > EVALUATIONS * nchunk as f64 {
        shares.clear();
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Chunks of four bars between nodes of these numbers.
    fn of_chain(number: &[NodeId], nthread: usize) -> Vec<Share> {
        let nbar = number.len() - 1;
        let chunks: Vec<usize> = (0..nbar / 4).collect();
        share_out(nthread, number.len(), &chunks, |chunk, take| {
            let bars = number.windows(2).skip(4 * chunk).take(4);
            bars.for_each(take);
        })
    }

    #[test]
    fn every_chunk_is_with_all_whose_rows_it_touches() {
        let number: Vec<NodeId> = (0..=400).collect();
        for nthread in [2, 3, 5] {
            let shares = of_chain(&number, nthread);
            assert_eq!(shares.len(), nthread);
            assert_eq!(shares[nthread - 1].end, 401);
            let mut first = 0;
            for share in &shares {
                let touches = |chunk: &usize| 4 * chunk < share.end && first <= 4 * chunk + 4;
                let wanted: Vec<usize> = (0..100).filter(touches).collect();
                assert_eq!(share.chunks, wanted);
                first = share.end;
            }
            // about as much for each
            let sizes = shares.iter().map(|share| share.chunks.len());
            assert!(sizes.max().unwrap() <= 100 / nthread + 2);
        }
    }

    #[test]
    fn nothing_is_shared_where_it_does_not_pay() {
        let number: Vec<NodeId> = (0..=400).collect();
        assert!(of_chain(&number, 1).is_empty());
        assert!(of_chain(&number[..41], 2).is_empty());
        let scattered: Vec<NodeId> = (0..=400).map(|n| (n * 149) % 401).collect();
        assert!(of_chain(&scattered, 2).is_empty());
    }
}
