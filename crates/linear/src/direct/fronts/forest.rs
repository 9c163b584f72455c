//! The forest of fronts: which columns each eliminates, which rows it has, and where it is stored.

use std::ops::Range;

/// Multiplications below which nothing is shared among threads.
pub(super) const LITTLE: f64 = 2e6;

/// A supernode.
pub(super) struct Node {
    /// Its columns.
    pub(super) columns: Range<usize>,
    /// The rows below them, in the new order.
    pub(super) rows: Vec<u32>,
    pub(super) children: Vec<u32>,
    pub(super) parent: Option<u32>,
    /// The place of each of its rows in the front of its parent.
    pub(super) place: Vec<u32>,
    /// The branch it is in; past them all where it is in none.
    pub(super) branch: usize,
    /// Where its front begins among those of its branch.
    pub(super) front: usize,
    /// Its entries among those of the matrix.
    pub(super) entries: Range<usize>,
}

impl Node {
    pub(super) fn width(&self) -> usize {
        self.columns.len()
    }

    /// Rows of its front.
    pub(super) fn size(&self) -> usize {
        self.columns.len() + self.rows.len()
    }

    /// Entries of its factors.
    pub(super) fn nentry(&self) -> usize {
        self.width() * (self.width() + 2 * self.rows.len())
    }

    /// Multiplications of its elimination.
    pub(super) fn effort(&self) -> f64 {
        let (w, r) = (self.width() as f64, self.rows.len() as f64);
        w * (w * w / 3.0 + w * r + r * r)
    }
}

impl Node {
    /// The place of a row or column in its front.
    pub(super) fn place_of(&self, row: u32) -> Option<u32> {
        let own = (row as usize).checked_sub(self.columns.start)?;
        if own < self.width() {
            return Some(own as u32);
        }
        let below = self.rows.binary_search(&row).ok()?;
        Some((self.width() + below) as u32)
    }
}

/// The node of each column.
pub(super) fn nodes_of_columns(nodes: &[Node], ncolumn: usize) -> Vec<u32> {
    let mut node_of = vec![0u32; ncolumn];
    for (s, node) in nodes.iter().enumerate() {
        if let Some(columns) = node_of.get_mut(node.columns.clone()) {
            columns.fill(s as u32);
        }
    }
    node_of
}

/// Numbers nodes, and columns with them, so that each comes right after all that is below it.
///
/// A node comes before its parent as it is, but where nodes were merged, the nodes below one need not be contiguous.
pub(super) fn sort_by_subtrees(nodes: &mut Vec<Node>, order: &mut Vec<u32>) {
    let node_of = nodes_of_columns(nodes, order.len());
    let parent = |node: &Node| node.rows.first().map(|&row| node_of[row as usize] as usize);
    // roots, then children of each node, from the last one to the first
    let mut below: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
    let mut stack = Vec::new();
    for (s, node) in nodes.iter().enumerate().rev() {
        match parent(node) {
            Some(parent) => below[parent].push(s),
            None => stack.push(s),
        }
    }
    stack.reverse();
    // each node before those below it, the last first
    let mut from_above = Vec::with_capacity(nodes.len());
    while let Some(s) = stack.pop() {
        from_above.push(s);
        stack.extend(below[s].iter().rev());
    }
    let sorted = from_above.into_iter().rev();
    if sorted.clone().eq(0..nodes.len()) {
        return;
    }
    let mut place = vec![0u32; order.len()];
    let mut order_now = Vec::with_capacity(order.len());
    let mut all: Vec<Option<Node>> = nodes.drain(..).map(Some).collect();
    for s in sorted {
        let Some(mut node) = all[s].take() else {
            continue;
        };
        let first = order_now.len();
        for column in node.columns.clone() {
            place[column] = order_now.len() as u32;
            order_now.push(order[column]);
        }
        node.columns = first..order_now.len();
        nodes.push(node);
    }
    for node in nodes {
        node.rows
            .iter_mut()
            .for_each(|row| *row = place[*row as usize]);
        node.rows.sort_unstable();
    }
    *order = order_now;
}

/// The largest subtrees with no more than this part of all that nodes take, or no more than this, the larger of the two:
/// ranges of nodes, for children come right before their parents.
pub(super) fn subtrees(
    nodes: &[Node],
    take: impl Fn(&Node) -> f64,
    part: f64,
    little: f64,
) -> Vec<Range<usize>> {
    let mut taken: Vec<f64> = nodes.iter().map(take).collect();
    let mut first: Vec<usize> = (0..nodes.len()).collect();
    let mut is_child = vec![false; nodes.len()];
    for (s, node) in nodes.iter().enumerate() {
        for &child in &node.children {
            taken[s] += taken[child as usize];
            first[s] = first[s].min(first[child as usize]);
            is_child[child as usize] = true;
        }
    }
    let roots = taken.iter().zip(&is_child).filter(|(_, child)| !**child);
    let all: f64 = roots.map(|(taken, _)| taken).sum();
    let most = (part * all).max(little);
    let mut subtrees: Vec<Range<usize>> = Vec::new();
    let mut s = nodes.len();
    while s > 0 {
        let last = s - 1;
        if taken[last] <= most {
            subtrees.push(first[last]..s);
            s = first[last];
        } else {
            s = last;
        }
    }
    subtrees.reverse();
    subtrees
}

/// Tells every node which branch it is in, and where its front is in what that works with; how large that is.
pub(super) fn place_fronts(nodes: &mut [Node], branches: &[Range<usize>]) -> Vec<usize> {
    nodes
        .iter_mut()
        .for_each(|node| node.branch = branches.len());
    for (number, branch) in branches.iter().enumerate() {
        nodes[branch.clone()]
            .iter_mut()
            .for_each(|node| node.branch = number);
    }
    let mut size = vec![0; branches.len() + 1];
    for node in nodes {
        node.front = size[node.branch];
        size[node.branch] += node.size();
    }
    size
}

#[cfg(test)]
mod tests {
    use super::{Node, nodes_of_columns, sort_by_subtrees};

    fn node(columns: std::ops::Range<usize>, rows: Vec<u32>) -> Node {
        Node {
            columns,
            rows,
            children: Vec::new(),
            parent: None,
            place: Vec::new(),
            branch: 0,
            front: 0,
            entries: 0..0,
        }
    }

    #[test]
    fn whatever_forest_nodes_make_all_below_a_node_comes_right_before_it() {
        let mut random = 1u64;
        let mut below = |n: usize| {
            random = random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (random >> 33) as usize % n
        };
        for n in [1, 2, 5, 12, 40] {
            for _ in 0..50 {
                // parents come after their children, as they do in any order of elimination, but nothing else is in order
                let parents: Vec<Option<usize>> = (0..n)
                    .map(|s| (s + 1 < n && below(8) > 0).then(|| s + 1 + below(n - s - 1)))
                    .collect();
                let mut first = 0;
                let columns: Vec<_> = (0..n)
                    .map(|_| {
                        let begin = first;
                        first += 1 + below(3);
                        begin..first
                    })
                    .collect();
                let rows = |s: usize| {
                    let mut rows = Vec::new();
                    let mut at = parents[s];
                    while let Some(p) = at {
                        rows.extend(columns[p].clone().map(|c| c as u32));
                        at = parents[p];
                    }
                    rows
                };
                let mut nodes: Vec<Node> =
                    (0..n).map(|s| node(columns[s].clone(), rows(s))).collect();
                let mut order: Vec<u32> = (0..first as u32).map(|c| 1000 + c).collect();
                sort_by_subtrees(&mut nodes, &mut order);
                let node_of = nodes_of_columns(&nodes, first);
                let mut begins: Vec<usize> = (0..n).collect();
                let mut sizes = vec![1; n];
                for s in 0..n {
                    // the same nodes with the same ancestors, by the names of their columns
                    let names = |columns: &mut dyn Iterator<Item = usize>| -> Vec<u32> {
                        let mut names: Vec<u32> = columns.map(|c| order[c] - 1000).collect();
                        names.sort_unstable();
                        names
                    };
                    let own = names(&mut nodes[s].columns.clone());
                    let before = columns
                        .iter()
                        .position(|c| c.start == own[0] as usize)
                        .unwrap();
                    assert!(own.iter().map(|c| *c as usize).eq(columns[before].clone()));
                    let mut expected = rows(before);
                    expected.sort_unstable();
                    assert_eq!(
                        names(&mut nodes[s].rows.iter().map(|r| *r as usize)),
                        expected
                    );
                    assert!(nodes[s].rows.is_sorted());
                    if let Some(&row) = nodes[s].rows.first() {
                        let parent = node_of[row as usize] as usize;
                        assert!(parent > s);
                        begins[parent] = begins[parent].min(begins[s]);
                        sizes[parent] += sizes[s];
                    }
                    // as many nodes as there are from the first one on
                    assert_eq!(s + 1 - begins[s], sizes[s]);
                }
                assert_eq!(nodes.last().map(|n| n.columns.end), Some(first));
            }
        }
    }
}
