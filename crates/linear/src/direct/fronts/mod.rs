//! LU factors of a matrix whose pattern is symmetric though its values are not: the multifrontal method.
//!
//! Elimination goes up a tree of supernodes. Each assembles a small dense matrix, its front: what the matrix has in its
//! rows and columns, and the Schur complements of its children.
//!
//! ```text
//!            w    r
//!        ┌─────┬─────┐
//!      w │ L∖U │  U  │     P F₁₁ = L₁₁ U₁₁,  U₁₂ = L₁₁⁻¹ P F₁₂,  L₂₁ = F₂₁ U₁₁⁻¹
//!        ├─────┼─────┤
//!      r │  L  │  C  │     C = F₂₂ − L₂₁ U₁₂  goes to the parent
//!        └─────┴─────┘
//! ```
//!
//! Pivots are chosen in the block w × w alone, so that order and storage are known beforehand; with the order of
//! [`super::ordering`], which puts a multiplier after a node that it couples with, these blocks are regular in most cases.
//! Where one is not, though the matrix is, pivots that vanish are replaced by ±√ε: the factor is that of a matrix nearby,
//! whose solutions refinement corrects (static pivoting). [`Fronts::lacks_pivots`] reports it.
//!
//! Subtrees without much work are tasks of their own, and above them nodes that are independent are eliminated at the same time;
//! sums are formed in an order that does not depend on threads.
//!
//! Factors may be in single precision: within a preconditioner they serve as well, and take half the time and memory.
//! Couplings fade from front to front. Products of what fades leave the range of normal numbers, with others of which some
//! processors compute a hundred times as slowly: an entry as small as the root of that range, where rows and columns have 1
//! as their largest entry, counts as nothing.
//!
//! Source: I. S. Duff and J. K. Reid, The multifrontal solution of unsymmetric sets of linear equations, SIAM J. Sci.
//! Stat. Comput. 5 (1984) 633–641; X. S. Li and J. W. Demmel, SuperLU_DIST, ACM Trans. Math. Softw. 29 (2003) 110–140,
//! section 2.1 (static pivoting).

mod elimination;
mod forest;
mod number;
mod pattern;
mod substitution;

use crate::error::LinearError;
use crate::lists::Lists;
use crate::matrix::Matrix;
use elimination::{Memory, NoPivot, Panel, Placed, Tree};
use faer::Side;
use faer::perm::PermRef;
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::linalg::{SupernodalThreshold, SymbolicSupernodalParams};
use forest::{LITTLE, Node, nodes_of_columns, place_fronts, sort_by_subtrees, subtrees};
use number::Number;
use pattern::{by_row, lower_half};
use pulp::Arch;
use rayon::prelude::*;
use std::ops::Range;
use substitution::{Factors, Work};

/// A subtree with no more than this part of all work is one task of a factorization, where threads share the nodes above.
const PART: f64 = 1.0 / 32.0;
/// Supernodes whose entries are placed by one task.
const NODES: usize = 16;
/// A pivot below it, in units of the largest entry of its row, gives reason to look for free motions.
const SUSPICIOUS: f64 = 1e-8;
/// A subtree with no more than this part of all entries is one task of a solution: each node above waits for the one below.
const PART_OF_SOLUTION: f64 = 1.0 / 4.0;
/// Entries of factors below which threads do not share a solution.
const FEW: usize = 500_000;
/// Supernodes are merged where they have at most so many columns, and at most this part of their entries is zero.
const RELAX: [(usize, f64); 3] = [(8, 0.9), (24, 0.4), (64, 0.15)];

/// How many digits factors have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Precision {
    Single,
    Double,
}

/// The factors, and the tree that they are made along.
pub(super) struct Fronts {
    plan: Plan,
    numbers: Numbers,
    /// The smallest pivot of the last factorization before any was replaced, in units of the largest entry of its row.
    smallest: f64,
}

/// The factors.
enum Numbers {
    Single(Store<f32>),
    Double(Store<f64>),
}

/// The tree, which is the same whatever the values.
struct Plan {
    /// The order that became of the one that was asked for, in which supernodes are whole: `order[new] = old`.
    order: Vec<u32>,
    nodes: Vec<Node>,
    /// Ranges of nodes that are subtrees with little work, in their order; nodes outside of them are above them all.
    tasks: Vec<Range<usize>>,
    /// The same for solutions.
    branches: Vec<Range<usize>>,
    /// The place of each entry of the matrix in its panel, node by node.
    from: Vec<u32>,
    to: Vec<u32>,
    /// How large the fronts of each branch are together, then of the nodes above them all.
    size: Vec<usize>,
}

/// What is kept of each node, and what solutions work with.
struct Store<T> {
    panels: Vec<Panel<T>>,
    /// Of each branch, then of the nodes above them all.
    work: Vec<Work<T>>,
}

impl Fronts {
    /// The tree for the order of elimination, `order[new] = old`, that is found meanwhile.
    ///
    /// # Errors
    /// `TooLarge`, and those of `find_order`.
    pub fn new(
        matrix: &Matrix,
        precision: Precision,
        find_order: impl FnOnce() -> Result<Vec<u32>, LinearError> + Send,
    ) -> Result<Self, LinearError> {
        let n = matrix.nequation();
        let too_large = || LinearError::TooLarge {
            nequation: n,
            nentry: matrix.row.len(),
        };
        let (order, (by_row, (start, row))) = rayon::join(find_order, || {
            let by_row = by_row(matrix);
            let half = lower_half(matrix, &by_row);
            (by_row, half)
        });
        let order = order?;
        let mut place = vec![0u32; n];
        for (new, &old) in order.iter().enumerate() {
            place[old as usize] = new as u32;
        }
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &start, None, &row);
        let ordering = SymmetricOrdering::Custom(PermRef::new_checked(&order, &place, n));
        let parameters = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            supernodal_params: SymbolicSupernodalParams {
                relax: Some(&RELAX),
            },
            ..CholeskySymbolicParams::default()
        };
        let symbolic = factorize_symbolic_cholesky(pattern, Side::Lower, ordering, parameters)
            .map_err(|_| too_large())?;
        let SymbolicCholeskyRaw::Supernodal(raw) = symbolic.raw() else {
            return Err(too_large());
        };
        let mut own_order = match symbolic.perm() {
            Some(perm) => perm.arrays().0.to_vec(),
            None => (0..n as u32).collect(),
        };
        let mut nodes: Vec<Node> = Vec::with_capacity(raw.n_supernodes());
        for s in 0..raw.n_supernodes() {
            let columns = raw.supernode_begin()[s] as usize..raw.supernode_end()[s] as usize;
            let mut rows = raw.supernode(s).pattern().to_vec();
            rows.sort_unstable();
            nodes.push(Node {
                columns,
                rows,
                children: Vec::new(),
                parent: None,
                place: Vec::new(),
                branch: 0,
                front: 0,
                entries: 0..0,
            });
        }
        sort_by_subtrees(&mut nodes, &mut own_order);
        let node_of = nodes_of_columns(&nodes, n);
        // children, and where they add to
        for s in 0..nodes.len() {
            let Some(&first) = nodes[s].rows.first() else {
                continue;
            };
            let parent = node_of[first as usize] as usize;
            let above = &nodes[parent];
            let places = nodes[s].rows.iter().map(|&row| above.place_of(row));
            let places: Option<Vec<u32>> = places.collect();
            nodes[s].place = places.ok_or_else(too_large)?;
            nodes[s].parent = Some(parent as u32);
            nodes[parent].children.push(s as u32);
        }
        let tasks = subtrees(&nodes, Node::effort, PART, LITTLE);
        let branches = subtrees(&nodes, |node| node.nentry() as f64, PART_OF_SOLUTION, 0.0);
        let size = place_fronts(&mut nodes, &branches);
        let mut plan = Plan {
            order: own_order,
            nodes,
            tasks,
            branches,
            from: Vec::new(),
            to: Vec::new(),
            size,
        };
        plan.place_entries(matrix, &by_row).ok_or_else(too_large)?;
        Ok(Self {
            numbers: Numbers::new(&plan, precision).ok_or_else(too_large)?,
            plan,
            smallest: 0.0,
        })
    }

    pub const fn precision(&self) -> Precision {
        match self.numbers {
            Numbers::Single(_) => Precision::Single,
            Numbers::Double(_) => Precision::Double,
        }
    }

    /// Goes on with numbers of this precision: false where there is no memory for them.
    pub fn change(&mut self, precision: Precision) -> bool {
        if self.precision() == precision {
            return true;
        }
        let numbers = Numbers::new(&self.plan, precision);
        let is_there = numbers.is_some();
        self.numbers = numbers.unwrap_or(Numbers::Double(Store::empty()));
        is_there
    }

    /// Whether some pivot was all but cancelled, so that the matrix may be singular. Factors in single precision have too
    /// few digits for that.
    pub fn is_suspicious(&self) -> bool {
        self.precision() == Precision::Double && self.smallest < SUSPICIOUS
    }

    /// Whether pivots were replaced: another order may do better.
    pub fn lacks_pivots(&self) -> bool {
        let vanishing = match self.precision() {
            Precision::Single => f32::VANISHING,
            Precision::Double => f64::VANISHING,
        };
        self.smallest < vanishing
    }

    /// Factorizes; false where numbers are not finite, or there is no memory.
    pub fn factorize(&mut self, matrix: &Matrix) -> bool {
        let smallest = match &mut self.numbers {
            Numbers::Single(store) => store.factorize(&self.plan, matrix),
            Numbers::Double(store) => store.factorize(&self.plan, matrix),
        };
        self.smallest = smallest.unwrap_or(0.0);
        smallest.is_ok()
    }

    /// Solves with the factors, in equilibrated unknowns.
    pub fn solve(&mut self, x: &mut [f64]) {
        match &mut self.numbers {
            Numbers::Single(store) => store.solve(&self.plan, x),
            Numbers::Double(store) => store.solve(&self.plan, x),
        }
    }
}

#[cfg(test)]
impl Fronts {
    /// How many entries are beyond the range of normal numbers.
    pub fn nsubnormal(&self) -> usize {
        fn count<T: Number>(store: &Store<T>, is_subnormal: fn(&T) -> bool) -> usize {
            let values = store.panels.iter().flat_map(|panel| &panel.value);
            values.filter(|value| is_subnormal(value)).count()
        }
        match &self.numbers {
            Numbers::Single(store) => count(store, |v| v.is_subnormal()),
            Numbers::Double(store) => count(store, |v| v.is_subnormal()),
        }
    }
}

impl Numbers {
    fn new(plan: &Plan, precision: Precision) -> Option<Self> {
        Some(match precision {
            Precision::Single => Self::Single(Store::new(plan)?),
            Precision::Double => Self::Double(Store::new(plan)?),
        })
    }
}

impl Plan {
    /// Finds the place of every entry; column e of the matrix holds row e of the operator.
    fn place_entries(&mut self, matrix: &Matrix, by_row: &Lists<[u32; 2]>) -> Option<()> {
        let mut place = vec![0u32; self.order.len()];
        for (new, &old) in self.order.iter().enumerate() {
            place[old as usize] = new as u32;
        }
        let (order, place) = (&self.order, &place);
        let chunks = self.nodes.par_chunks(NODES);
        let placed = chunks.map_init(
            // where unknowns are in the front of the node at hand
            || vec![None; order.len()],
            |local, nodes| {
                let mut placed = Placed::default();
                for node in nodes {
                    placed.add(node, (matrix, by_row), (order, place), local)?;
                }
                Some(placed)
            },
        );
        let placed: Option<Vec<Placed>> = placed.collect();
        self.from.reserve_exact(matrix.row.len());
        self.to.reserve_exact(matrix.row.len());
        for (nodes, placed) in self.nodes.chunks_mut(NODES).zip(placed?) {
            let first = self.from.len();
            let mut begin = first;
            for (node, end) in nodes.iter_mut().zip(&placed.ends) {
                node.entries = begin..first + end;
                begin = first + end;
            }
            self.from.extend_from_slice(&placed.from);
            self.to.extend_from_slice(&placed.to);
        }
        Some(())
    }
}

impl<T: Number> Store<T> {
    /// Nothing yet; `None` where there is no memory.
    fn new(plan: &Plan) -> Option<Self> {
        let panel = |node: &Node| {
            let mut value = Vec::new();
            value.try_reserve_exact(node.nentry()).ok()?;
            value.resize(node.nentry(), T::default());
            let pivot = vec![0; node.width()];
            Some(Panel { value, pivot })
        };
        let work = |&size: &usize| Work {
            front: vec![T::default(); size],
            own: Vec::new(),
        };
        Some(Self {
            panels: plan.nodes.iter().map(panel).collect::<Option<_>>()?,
            work: plan.size.iter().map(work).collect(),
        })
    }

    const fn empty() -> Self {
        Self {
            panels: Vec::new(),
            work: Vec::new(),
        }
    }

    /// Factorizes; the smallest pivot.
    fn factorize(&mut self, plan: &Plan, matrix: &Matrix) -> Result<f64, NoPivot> {
        let Plan {
            nodes,
            tasks,
            from,
            to,
            ..
        } = plan;
        let panels = &mut self.panels;
        if panels.len() != nodes.len() {
            return Err(NoPivot);
        }
        let tree = Tree {
            nodes,
            tasks,
            from,
            to,
            value: &matrix.value,
        };
        // what every node leaves to its parent
        let mut left: Vec<Vec<T>> = nodes.iter().map(|_| Vec::new()).collect();
        let mut jobs = Vec::with_capacity(tasks.len());
        let (mut rest, mut rest_left, mut begin) = (panels.as_mut_slice(), &mut left[..], 0);
        for task in tasks.iter() {
            let (_, after) = rest.split_at_mut(task.start - begin);
            let (_, after_left) = rest_left.split_at_mut(task.start - begin);
            let (own, after) = after.split_at_mut(task.len());
            let (own_left, after_left) = after_left.split_at_mut(task.len());
            jobs.push((task.clone(), own, own_left));
            (rest, rest_left, begin) = (after, after_left, task.end);
        }
        let done = jobs.into_par_iter().map(|(task, panels, left)| {
            let mut memory = Memory::default();
            let mut smallest = f64::INFINITY;
            for s in task.clone() {
                let (children, own) = left.split_at_mut(s - task.start);
                let pivot = tree.eliminate(
                    s,
                    (children, task.start),
                    &mut panels[s - task.start],
                    &mut own[0],
                    &mut memory,
                )?;
                smallest = smallest.min(pivot);
            }
            Ok(smallest)
        });
        let done: Result<Vec<f64>, NoPivot> = done.collect();
        let smallest = done?;
        let roots: Vec<u32> = (0..)
            .zip(nodes.iter())
            .filter(|(_, node)| node.parent.is_none())
            .map(|(s, _)| s)
            .collect();
        let above = tree.climb_all(0, &roots, panels, &mut left)?;
        Ok(smallest.into_iter().fold(above, f64::min))
    }

    fn solve(&mut self, plan: &Plan, x: &mut [f64]) {
        let factors = Factors {
            order: &plan.order,
            nodes: &plan.nodes,
            panels: &self.panels,
        };
        let Some((above, below)) = self.work.split_last_mut() else {
            return;
        };
        let branches = &plan.branches;
        let is_little = plan.nodes.iter().map(Node::nentry).sum::<usize>() < FEW;
        let each = |below: &mut [Work<T>], run: &(dyn Fn(&Range<usize>, &mut Work<T>) + Sync)| {
            if is_little {
                branches.iter().zip(below).for_each(|(b, w)| run(b, w));
            } else {
                branches.par_iter().zip(below).for_each(|(b, w)| run(b, w));
            }
        };
        let nodes_above =
            || (0..factors.nodes.len()).filter(|&s| factors.nodes[s].branch == branches.len());
        let arch = Arch::new();
        let right = &*x;
        each(below, &|branch, work| {
            arch.dispatch(|| {
                branch
                    .clone()
                    .for_each(|s| factors.reduce(s, right, work, &[]))
            });
        });
        arch.dispatch(|| nodes_above().for_each(|s| factors.reduce(s, right, above, below)));
        arch.dispatch(|| {
            nodes_above()
                .rev()
                .for_each(|s| factors.expand(s, above, None))
        });
        let above = &*above;
        each(below, &|branch, work| {
            let down = || {
                branch
                    .clone()
                    .rev()
                    .for_each(|s| factors.expand(s, work, Some(above)))
            };
            arch.dispatch(down);
        });
        for node in &plan.nodes {
            let work = below.get(node.branch).unwrap_or(above);
            let found = &work.front[node.front..];
            for (&old, found) in plan.order[node.columns.clone()].iter().zip(found) {
                x[old as usize] = found.wide();
            }
        }
    }
}
