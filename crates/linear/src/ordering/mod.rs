//! The order of elimination: which equations go first decides how much the factor fills in.
//!
//! Equations are ordered in *groups*, for the graph of the groups is much smaller than that of the equations: all
//! equations of one node form a group, and every other unknown one of its own. A multiplier joins the group of a node
//! that it couples with and comes last in it. A saddle-point matrix then never meets the zero on a multiplier's
//! diagonal: by its turn the node before it has been eliminated and has left −b K⁻¹ bᵀ there.
//!
//! ```text
//!   equations   u1x u1y u1z   u2x u2y u2z   λ
//!                └─────┬───────────┘   └──┬──┘
//!   groups         node 1             node 2, λ     ──dissection──▶   order of groups   ──expand──▶   order
//! ```
//!
//! A few groups are ordered by minimum degree, many by nested dissection; the order is then made a postorder of its
//! elimination tree, so that columns of like pattern lie side by side.

mod graph;
pub(crate) mod metis;

use crate::error::LinearError;
use crate::lists::Lists;
use crate::matrix::Matrix;
use crate::problem::Problem;
use crate::sparsity::NONE;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;
use graph::Graph;

/// Below so many groups minimum degree is faster: a block of 600 nodes costs it 5 ms to order and factorize, dissection
/// 7 ms; at 1,200 nodes they meet, at 17,000 dissection needs a third of the time.
const DISSECT_FROM: usize = 600;

/// How the groups are ordered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ordering {
    /// Nested dissection for many groups, minimum degree for few.
    Auto,
    /// Minimum degree.
    #[cfg(test)]
    MinimumDegree,
    /// Nested dissection, minimum degree only where that fails.
    #[cfg(test)]
    NestedDissection,
}

/// Orders the equations of a problem and its matrix: `order[new] = old`. What is not symmetric is ordered as A + Aᵀ.
pub(crate) fn order(
    problem: &Problem,
    matrix: &Matrix,
    ordering: Ordering,
) -> Result<Vec<u32>, LinearError> {
    order_groups(problem, matrix, &groups(problem, matrix), ordering)
}

/// The same, in groups that are known.
pub(crate) fn order_groups(
    problem: &Problem,
    matrix: &Matrix,
    group: &[u32],
    ordering: Ordering,
) -> Result<Vec<u32>, LinearError> {
    let ngroup = group.iter().map(|&g| g as usize + 1).max().unwrap_or(0);
    let mut weight = vec![0u32; ngroup];
    for &g in group {
        weight[g as usize] += 1;
    }
    let graph = Graph::from_pairs(weight, &group_pairs(matrix, group));

    let dissect = match ordering {
        Ordering::Auto => ngroup >= DISSECT_FROM,
        #[cfg(test)]
        Ordering::MinimumDegree => false,
        #[cfg(test)]
        Ordering::NestedDissection => true,
    };
    let first = if dissect {
        metis::nested_dissection(&graph)
    } else {
        None
    };
    let first = match first {
        Some(order) => order,
        None => minimum_degree(&graph)?,
    };
    Ok(expand(group, &postorder(&graph, &first), problem.sign))
}

/// The node of each equation; none for those outside the bulk.
fn node_of(problem: &Problem) -> Vec<u32> {
    let mut node = vec![NONE; problem.nequation];
    let nbulk = problem.bulk.nrow() * problem.bulk.block;
    for (d, &e) in problem
        .equation
        .iter()
        .enumerate()
        .take(nbulk)
        .filter(|&(_, &e)| e != NONE)
    {
        node[e as usize] = (d / problem.bulk.block) as u32;
    }
    node
}

/// The group of each equation, numbered by first appearance. Values, where the matrix has them already, show which node a
/// multiplier acts on most; nothing else about the order depends on them.
pub(crate) fn groups(problem: &Problem, matrix: &Matrix) -> Vec<u32> {
    let (node, sign) = (node_of(problem), problem.sign);
    let nequation = node.len();
    let mut of_node = vec![
        NONE;
        node.iter()
            .filter(|&&n| n != NONE)
            .map(|&n| n as usize + 1)
            .max()
            .unwrap_or(0)
    ];
    let mut group = vec![NONE; nequation];
    let mut ngroup = 0;
    for equation in (0..nequation).filter(|&e| sign[e] >= 0) {
        let known = of_node.get_mut(node[equation] as usize);
        group[equation] = match &known {
            Some(g) if **g != NONE => **g,
            _ => ngroup,
        };
        ngroup = ngroup.max(group[equation] + 1);
        if let Some(g) = known {
            *g = group[equation];
        }
    }
    if group.iter().all(|&g| g != NONE) {
        return group;
    }

    // each multiplier joins the neighbouring group that it acts on most of those with fewer multipliers than unknowns;
    // without values, that with the fewest multipliers per unknown so far: the columns of the half matrix name each pair
    // once, so both its ends are visited
    let mut load = vec![0u32; ngroup as usize];
    let mut size = vec![0u32; ngroup as usize];
    for &g in group.iter().filter(|&&g| g != NONE) {
        size[g as usize] += 1;
    }
    let group_of = &group;
    let coupled = Lists::new(nequation, || {
        (0..nequation).flat_map(|column| {
            let entries = matrix.column(column).iter().zip(matrix.values(column));
            entries.flat_map(move |(&row, value)| {
                let ends = [(column, row as usize), (row as usize, column)];
                let of_multiplier = |&(m, other): &(usize, usize)| sign[m] < 0 && sign[other] >= 0;
                let ends = ends.into_iter().filter(of_multiplier);
                ends.map(move |(m, other)| (m, (group_of[other], value.abs())))
            })
        })
    });
    // the place of a group among those near the multiplier at hand
    let mut place = vec![NONE; ngroup as usize];
    let mut near: Vec<(u32, f64)> = Vec::new();
    for equation in (0..nequation).filter(|&e| sign[e] < 0) {
        near.clear();
        for &(g, value) in coupled.of(equation) {
            match near.get_mut(place[g as usize] as usize) {
                Some((_, sum)) => *sum += value,
                None => {
                    place[g as usize] = near.len() as u32;
                    near.push((g, value));
                }
            }
        }
        near.iter().for_each(|&(g, _)| place[g as usize] = NONE);
        let free = |g: u32| load[g as usize] * 8 / size[g as usize].max(1);
        let is_full = |g: u32| load[g as usize] >= size[g as usize];
        let better = |a: &&(u32, f64), b: &&(u32, f64)| {
            let by_value = b.1.total_cmp(&a.1);
            let by_load = free(a.0).cmp(&free(b.0)).then(a.0.cmp(&b.0));
            is_full(a.0).cmp(&is_full(b.0)).then(by_value).then(by_load)
        };
        match near.iter().min_by(better).map(|&(g, _)| g) {
            Some(g) => {
                load[g as usize] += 1;
                group[equation] = g;
            }
            None => {
                group[equation] = ngroup;
                ngroup += 1;
            }
        }
    }
    group
}

/// The pairs of different groups that some entry couples, most repetitions left out.
fn group_pairs(matrix: &Matrix, group: &[u32]) -> Vec<(u32, u32)> {
    let mut pairs = Vec::new();
    let mut last_seen = vec![NONE; group.iter().map(|&g| g as usize + 1).max().unwrap_or(0)];
    for (column, &a) in group.iter().enumerate() {
        for &row in matrix.column(column) {
            let b = group[row as usize];
            let (low, high) = (a.min(b), a.max(b));
            if a != b && last_seen[high as usize] != low {
                last_seen[high as usize] = low;
                pairs.push((low, high));
            }
        }
    }
    pairs
}

fn minimum_degree(graph: &Graph) -> Result<Vec<u32>, LinearError> {
    let nvertex = graph.nvertex();
    let too_large = || LinearError::TooLarge {
        nequation: nvertex,
        nentry: graph.neighbour.len(),
    };
    let start = graph
        .start
        .iter()
        .map(|&s| u32::try_from(s).ok())
        .collect::<Option<Vec<u32>>>()
        .ok_or_else(too_large)?;
    let symbolic =
        SymbolicSparseColMatRef::new_checked(nvertex, nvertex, &start, None, &graph.neighbour);
    let (mut order, mut place) = (vec![0u32; nvertex], vec![0u32; nvertex]);
    let scratch = amd::order_scratch::<u32>(nvertex, graph.neighbour.len());
    let mut memory = MemBuffer::try_new(scratch).map_err(|_| too_large())?;
    amd::order(
        &mut order,
        &mut place,
        symbolic,
        amd::Control::default(),
        MemStack::new(&mut memory),
    )
    .map_err(|_| too_large())?;
    Ok(order)
}

/// The same order of elimination, up to the exchange of independent steps, as a postorder of its elimination tree
/// (J. W. H. Liu, The role of elimination trees in sparse factorization, SIAM J. Matrix Anal. Appl. 11 (1990) 134–172).
fn postorder(graph: &Graph, order: &[u32]) -> Vec<u32> {
    let nvertex = graph.nvertex();
    let mut place = vec![0u32; nvertex];
    for (new, &old) in order.iter().enumerate() {
        place[old as usize] = new as u32;
    }
    // the tree, by paths that are compressed as they are walked
    let (mut parent, mut ancestor) = (vec![NONE; nvertex], vec![NONE; nvertex]);
    for new in 0..nvertex as u32 {
        for &other in graph.neighbours(order[new as usize] as usize) {
            let mut vertex = place[other as usize];
            while vertex < new {
                let up = std::mem::replace(&mut ancestor[vertex as usize], new);
                if up == NONE {
                    parent[vertex as usize] = new;
                    break;
                }
                vertex = up;
            }
        }
    }
    // children lists, the first child first
    let (mut child, mut sibling) = (vec![NONE; nvertex], vec![NONE; nvertex]);
    let mut roots = Vec::new();
    for vertex in (0..nvertex as u32).rev() {
        match parent[vertex as usize] {
            NONE => roots.push(vertex),
            up => sibling[vertex as usize] = std::mem::replace(&mut child[up as usize], vertex),
        }
    }
    let mut out = Vec::with_capacity(nvertex);
    let mut path = Vec::new();
    while let Some(root) = roots.pop() {
        path.push(root);
        while let Some(&vertex) = path.last() {
            match std::mem::replace(&mut child[vertex as usize], NONE) {
                NONE => {
                    out.push(order[vertex as usize]);
                    path.pop();
                }
                first => {
                    child[vertex as usize] = sibling[first as usize];
                    path.push(first);
                }
            }
        }
    }
    out
}

/// The order of the equations from that of their groups; multipliers come last within a group.
fn expand(group: &[u32], order: &[u32], sign: &[i8]) -> Vec<u32> {
    let mut place = vec![0u32; order.len()];
    for (new, &old) in order.iter().enumerate() {
        place[old as usize] = new as u32;
    }
    let mut equations: Vec<u32> = (0..group.len() as u32).collect();
    equations.sort_by_key(|&e| (place[group[e as usize] as usize], sign[e as usize] < 0, e));
    equations
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn graph_is_symmetric_without_loops_or_doubles() {
        let graph = Graph::from_pairs(
            vec![1; 4],
            &[(0, 1), (1, 0), (2, 2), (3, 1), (1, 3), (0, 3)],
        );
        assert_eq!(graph.start, [0, 2, 4, 4, 6]);
        assert_eq!(graph.neighbour, [1, 3, 0, 3, 0, 1]);
    }

    #[test]
    fn postorder_keeps_the_fill_and_puts_children_before_parents() {
        // a path eliminated from both ends and the middle, and a lonely vertex
        let graph = Graph::from_pairs(
            vec![1; 8],
            &[(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 6)],
        );
        let order = [0, 6, 7, 3, 1, 5, 2, 4];
        let post = postorder(&graph, &order);
        let mut sorted = post.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, [0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(fill(&graph, &order), fill(&graph, &post));
    }

    /// Edges that elimination in the given order adds, by playing it.
    fn fill(graph: &Graph, order: &[u32]) -> usize {
        let n = graph.nvertex();
        let mut linked = vec![vec![false; n]; n];
        for (vertex, linked) in linked.iter_mut().enumerate() {
            for &other in graph.neighbours(vertex) {
                linked[other as usize] = true;
            }
        }
        let mut added = 0;
        for (step, &vertex) in order.iter().enumerate() {
            let later = &order[step + 1..];
            for &a in later {
                for &b in later {
                    let joined =
                        linked[vertex as usize][a as usize] && linked[vertex as usize][b as usize];
                    if a < b && joined && !linked[a as usize][b as usize] {
                        linked[a as usize][b as usize] = true;
                        linked[b as usize][a as usize] = true;
                        added += 1;
                    }
                }
            }
        }
        added
    }
}
