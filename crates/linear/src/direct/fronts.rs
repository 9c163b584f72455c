//! LU factors of a matrix whose pattern is symmetric though its values are not: the multifrontal method.
//!
//! Elimination goes up a tree of supernodes. Each assembles a small dense matrix, its front: what the matrix has in its
//! rows and columns, and what is left over of its children.
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
//! Subtrees without much work are tasks of their own, and above them what is side by side is eliminated at the same time;
//! sums are formed in an order that does not depend on threads.
//!
//! Factors may be in single precision: within a preconditioner they serve as well, and take half the time and memory.
//! Couplings fade from front to front. Products of what fades leave the range of normal numbers, with others of which some
//! processors compute a hundred times as slowly: what is as small as the root of that range, where rows and columns have 1
//! as their largest entry, counts as nothing.
//!
//! Source: I. S. Duff and J. K. Reid, The multifrontal solution of unsymmetric sets of linear equations, SIAM J. Sci.
//! Stat. Comput. 5 (1984) 633–641; X. S. Li and J. W. Demmel, SuperLU_DIST, ACM Trans. Math. Softw. 29 (2003) 110–140,
//! section 2.1 (static pivoting).

use crate::direct::registers::clear_upper_halves;
use crate::error::LinearError;
use crate::lists::Lists;
use crate::matrix::Matrix;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::factor::{lu_in_place, lu_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_unit_lower_triangular_in_place,
};
use faer::perm::PermRef;
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::linalg::{SupernodalThreshold, SymbolicSupernodalParams};
use faer::traits::ComplexField;
use faer::{Accum, MatMut, Par, Side};
use pulp::Arch;
use rayon::prelude::*;
use std::ops::{AddAssign, Div, Mul, Neg, Range, Sub, SubAssign};

/// A pivot below it, in units of the largest entry of its row, gives reason to look for free motions.
const SUSPICIOUS: f64 = 1e-8;
/// A subtree with no more than this part of all work is one task of a factorization, where threads share the nodes above.
const PART: f64 = 1.0 / 32.0;
/// A subtree with no more than this part of all entries is one task of a solution: each node above waits for the one below.
const PART_OF_SOLUTION: f64 = 1.0 / 4.0;
/// Columns of what goes to the parent that are worked on together.
const COLUMNS: usize = 96;
/// Multiplications below which nothing is shared among threads.
const LITTLE: f64 = 2e6;
/// Supernodes whose entries are placed by one task.
const NODES: usize = 16;
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

/// Numbers that factors are made of.
trait Number:
    ComplexField
    + Copy
    + Default
    + AddAssign
    + SubAssign
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + PartialOrd
{
    /// What is smaller counts as nothing in a front.
    const SMALLEST: Self;
    /// A pivot below it, in units of the largest entry of its row, is round-off.
    const VANISHING: f64;
    /// It is replaced by this one: the root of the round-off, where errors by the change and by growth are alike.
    const REPLACEMENT: f64;

    fn narrow(value: f64) -> Self;

    fn wide(self) -> f64;

    /// The number, unless it counts as nothing.
    #[inline(always)]
    fn flushed(self) -> Self {
        if self < Self::SMALLEST && -self < Self::SMALLEST {
            Self::default()
        } else {
            self
        }
    }
}

impl Number for f64 {
    const SMALLEST: Self = 1e-150;
    const VANISHING: f64 = 1e-14;
    const REPLACEMENT: f64 = 1.5e-8;

    fn narrow(value: f64) -> Self {
        value
    }

    fn wide(self) -> f64 {
        self
    }
}

impl Number for f32 {
    const SMALLEST: Self = 1e-18;
    const VANISHING: f64 = 1e-6;
    const REPLACEMENT: f64 = 3.5e-4;

    fn narrow(value: f64) -> Self {
        value as Self
    }

    fn wide(self) -> f64 {
        f64::from(self)
    }
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
    /// Ranges of nodes that are subtrees with little work, in their order; what is not in one is above them all.
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

/// What some nodes work with in a solution.
struct Work<T> {
    /// Their unknowns, and what is left of the rows below them, node by node.
    front: Vec<T>,
    own: Vec<T>,
}

/// A supernode.
struct Node {
    /// Its columns.
    columns: Range<usize>,
    /// The rows below them, in the new order.
    rows: Vec<u32>,
    children: Vec<u32>,
    parent: Option<u32>,
    /// The place of each of its rows in the front of its parent.
    place: Vec<u32>,
    /// The branch it is in; past them all where it is in none.
    branch: usize,
    /// Where its front begins among those of its branch.
    front: usize,
    /// Its entries among those of the matrix.
    entries: Range<usize>,
}

/// What a supernode keeps: `L₁₁∖U₁₁` over `L₂₁`, column by column, then `U₁₂`, column by column.
struct Panel<T> {
    value: Vec<T>,
    /// Row `pivot[k]` of the block came to place k.
    pivot: Vec<u32>,
}

/// A pivot that is no number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct NoPivot;

impl Node {
    fn width(&self) -> usize {
        self.columns.len()
    }

    /// Rows of its front.
    fn size(&self) -> usize {
        self.columns.len() + self.rows.len()
    }

    /// Entries of its factors.
    fn nentry(&self) -> usize {
        self.width() * (self.width() + 2 * self.rows.len())
    }

    /// Multiplications of its elimination.
    fn effort(&self) -> f64 {
        let (w, r) = (self.width() as f64, self.rows.len() as f64);
        w * (w * w / 3.0 + w * r + r * r)
    }
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

/// The places of the entries of some nodes in their panels.
#[derive(Default)]
struct Placed {
    from: Vec<u32>,
    to: Vec<u32>,
    /// Where the entries of each node end.
    ends: Vec<usize>,
}

impl Placed {
    /// Adds one more node; `local` is of nothing before and after.
    fn add(
        &mut self,
        node: &Node,
        (matrix, by_row): (&Matrix, &Lists<[u32; 2]>),
        (order, place): (&[u32], &[u32]),
        local: &mut [Option<u32>],
    ) -> Option<()> {
        let (columns, w, m) = (node.columns.clone(), node.width(), node.size());
        let unknowns = || columns.clone().chain(node.rows.iter().map(|&r| r as usize));
        unknowns().zip(0..).for_each(|(k, at)| local[k] = Some(at));
        for (own, &e) in order[columns.clone()].iter().enumerate() {
            let e = e as usize;
            for (at, &f) in (matrix.start[e]..).zip(matrix.column(e)) {
                let other = place[f as usize] as usize;
                if other >= columns.start {
                    let j = local[other]? as usize;
                    let place = if j < w {
                        own + j * m
                    } else {
                        w * m + own + (j - w) * w
                    };
                    self.from.push(at);
                    self.to.push(u32::try_from(place).ok()?);
                }
            }
            for &[f, at] in by_row.of(e) {
                let other = place[f as usize] as usize;
                if other >= columns.end {
                    let place = local[other]? as usize + own * m;
                    self.from.push(at);
                    self.to.push(u32::try_from(place).ok()?);
                }
            }
        }
        unknowns().for_each(|k| local[k] = None);
        self.ends.push(self.from.len());
        Some(())
    }
}

/// What all nodes share in a solution.
struct Factors<'a, T> {
    order: &'a [u32],
    nodes: &'a [Node],
    panels: &'a [Panel<T>],
}

impl<T: Number> Factors<'_, T> {
    /// Solves with the lower factor of a node, and leaves to its parent what remains of the rows below. Children are in the
    /// same work, or in that of their branch.
    #[inline(always)]
    fn reduce(&self, s: usize, right: &[f64], work: &mut Work<T>, branches: &[Work<T>]) {
        let (node, panel) = (&self.nodes[s], &self.panels[s]);
        let (w, m) = (node.width(), node.size());
        let (before, rest) = work.front.split_at_mut(node.front);
        let front = &mut rest[..m];
        let unknowns = &self.order[node.columns.clone()];
        for (y, &old) in front.iter_mut().zip(unknowns) {
            *y = T::narrow(right[old as usize]);
        }
        front[w..].fill(T::default());
        for &child in &node.children {
            let child = &self.nodes[child as usize];
            let home = if child.branch == node.branch {
                &*before
            } else {
                &branches[child.branch].front
            };
            let left = &home[child.front + child.width()..];
            for (&place, left) in child.place.iter().zip(left) {
                front[place as usize] += *left;
            }
        }
        let (known, below) = front.split_at_mut(w);
        let own = &mut work.own;
        own.clear();
        own.extend(panel.pivot.iter().map(|&k| known[k as usize]));
        for k in 0..w {
            let column = &panel.value[k * m + k + 1..k * m + w];
            let known = own[k];
            for (x, l) in own[k + 1..].iter_mut().zip(column) {
                *x -= *l * known;
            }
        }
        known.copy_from_slice(own);
        subtract_product(below, &panel.value[w..], m, known);
    }

    /// Solves with the upper factor of a node, whose parent is in the same work, or in that of the nodes above.
    #[inline(always)]
    fn expand(&self, s: usize, work: &mut Work<T>, above: Option<&Work<T>>) {
        let (node, panel) = (&self.nodes[s], &self.panels[s]);
        let (w, m) = (node.width(), node.size());
        let (fronts, after) = work.front.split_at_mut(node.front + m);
        let (own, below) = fronts[node.front..].split_at_mut(w);
        if let Some(parent) = node.parent {
            let parent = &self.nodes[parent as usize];
            let known = match above {
                Some(above) if parent.branch != node.branch => &above.front[parent.front..],
                _ => &after[parent.front - node.front - m..],
            };
            for (y, &place) in below.iter_mut().zip(&node.place) {
                *y = known[place as usize];
            }
        }
        subtract_product(own, &panel.value[w * m..], w, below);
        for k in (0..w).rev() {
            let column = &panel.value[k * m..k * m + k + 1];
            let known = own[k] / column[k];
            own[k] = known;
            for (x, u) in own[..k].iter_mut().zip(column) {
                *x -= *u * known;
            }
        }
    }
}

/// `y −= A x` with A by columns, which begin `stride` apart.
#[inline(always)]
fn subtract_product<T: Number>(y: &mut [T], a: &[T], stride: usize, x: &[T]) {
    let n = y.len();
    if n == 0 {
        return;
    }
    let (fours, others) = x.as_chunks::<4>();
    for (k, x) in fours.iter().enumerate() {
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| &a[(4 * k + i) * stride..][..n]);
        for i in 0..n {
            // in the order of the columns
            y[i] = y[i] - a[i] * x[0] - b[i] * x[1] - c[i] * x[2] - d[i] * x[3];
        }
    }
    for (k, x) in (4 * fours.len()..).zip(others) {
        for (y, a) in y.iter_mut().zip(&a[k * stride..][..n]) {
            *y -= *a * *x;
        }
    }
}

impl Node {
    /// The place of a row or column in its front.
    fn place_of(&self, row: u32) -> Option<u32> {
        let own = (row as usize).checked_sub(self.columns.start)?;
        if own < self.width() {
            return Some(own as u32);
        }
        let below = self.rows.binary_search(&row).ok()?;
        Some((self.width() + below) as u32)
    }
}

/// Memory for pivots.
#[derive(Default)]
struct Memory<T> {
    buffer: Option<MemBuffer>,
    width: usize,
    inverse: Vec<u32>,
    column: Vec<T>,
}

/// What all nodes share.
#[derive(Clone, Copy)]
struct Tree<'a> {
    nodes: &'a [Node],
    tasks: &'a [Range<usize>],
    from: &'a [u32],
    to: &'a [u32],
    value: &'a [f64],
}

impl Tree<'_> {
    /// Whether a node is above all tasks.
    fn is_above(self, s: u32) -> bool {
        let before = self.tasks.partition_point(|task| task.end <= s as usize);
        let next = self.tasks.get(before);
        next.is_none_or(|task| task.start > s as usize)
    }

    /// Eliminates what is above the tasks in the subtrees with these roots, which side by side are the nodes from `begin`
    /// on: at the same time. Returns the smallest pivot.
    fn climb_all<T: Number>(
        self,
        mut begin: usize,
        roots: &[u32],
        mut panels: &mut [Panel<T>],
        mut left: &mut [Vec<T>],
    ) -> Result<f64, NoPivot> {
        let mut jobs = Vec::with_capacity(roots.len());
        for &root in roots {
            let end = root as usize + 1;
            let (own, others) = panels.split_at_mut(end - begin);
            let (own_left, others_left) = left.split_at_mut(end - begin);
            if self.is_above(root) {
                jobs.push((begin..end, own, own_left));
            }
            (panels, left, begin) = (others, others_left, end);
        }
        let jobs = jobs.into_par_iter();
        jobs.map(|(subtree, panels, left)| self.climb(subtree, panels, left))
            .try_reduce(|| f64::INFINITY, |a, b| Ok(a.min(b)))
    }

    /// The same of one subtree. A node with two children above the tasks has two subtrees with much work below it, so that
    /// there are never many of them above one another.
    fn climb<T: Number>(
        self,
        subtree: Range<usize>,
        panels: &mut [Panel<T>],
        left: &mut [Vec<T>],
    ) -> Result<f64, NoPivot> {
        let (mut begin, mut lowest) = (subtree.start, subtree.end - 1);
        let children = loop {
            let children = self.nodes[lowest].children.as_slice();
            let mut above = (0..children.len()).filter(|&k| self.is_above(children[k]));
            match (above.next(), above.next()) {
                (Some(only), None) => {
                    begin = only
                        .checked_sub(1)
                        .map_or(begin, |k| children[k] as usize + 1);
                    lowest = children[only] as usize;
                }
                _ => break children,
            }
        };
        let below = begin - subtree.start..lowest - subtree.start;
        let parts = (&mut panels[below.clone()], &mut left[below]);
        let mut smallest = self.climb_all(begin, children, parts.0, parts.1)?;
        let mut memory = Memory::default();
        for s in (lowest..subtree.end).filter(|&s| self.is_above(s as u32)) {
            let at = s - subtree.start;
            let (children, own) = left.split_at_mut(at);
            let children = (children, subtree.start);
            let pivot = self.eliminate(s, children, &mut panels[at], &mut own[0], &mut memory)?;
            smallest = smallest.min(pivot);
        }
        Ok(smallest)
    }

    /// Eliminates the columns of a node; `children` holds what the nodes from its number on leave, and `left` gets what
    /// this one does. Returns the smallest pivot.
    fn eliminate<T: Number>(
        self,
        s: usize,
        (children, first): (&mut [Vec<T>], usize),
        panel: &mut Panel<T>,
        left: &mut Vec<T>,
        memory: &mut Memory<T>,
    ) -> Result<f64, NoPivot> {
        let node = &self.nodes[s];
        let (w, r) = (node.width(), node.rows.len());
        let m = w + r;
        panel.value.fill(T::default());
        left.clear();
        left.resize(r * r, T::default());
        let entries = self.from[node.entries.clone()].iter();
        for (&from, &to) in entries.zip(&self.to[node.entries.clone()]) {
            panel.value[to as usize] += T::narrow(self.value[from as usize]).flushed();
        }
        let (lower, upper) = panel.value.split_at_mut(w * m);
        for &child in &node.children {
            let part = std::mem::take(&mut children[child as usize - first]);
            let place = &self.nodes[child as usize].place;
            let split = place.partition_point(|&p| (p as usize) < w);
            let (own, below) = place.split_at(split);
            for (&column, part) in place.iter().zip(part.chunks_exact(place.len().max(1))) {
                let column = column as usize;
                if column < w {
                    let to = &mut lower[column * m..(column + 1) * m];
                    for (&row, v) in place.iter().zip(part) {
                        to[row as usize] += v.flushed();
                    }
                } else {
                    let (above, part) = part.split_at(split);
                    let to = &mut upper[(column - w) * w..(column - w + 1) * w];
                    for (&row, v) in own.iter().zip(above) {
                        to[row as usize] += v.flushed();
                    }
                    let to = &mut left[(column - w) * r..(column - w + 1) * r];
                    for (&row, v) in below.iter().zip(part) {
                        to[row as usize - w] += v.flushed();
                    }
                }
            }
        }
        let smallest = pivots(lower, upper, (w, r), &mut panel.pivot, memory)?;
        if r > 0 {
            let is_little = node.effort() < LITTLE;
            let (block, below) =
                MatMut::from_column_major_slice_mut(lower, m, w).split_at_row_mut(w);
            let (block, mut below) = (block.as_ref(), below);
            solve_lower_triangular_in_place(
                block.transpose(),
                below.as_mut().transpose_mut(),
                Par::Seq,
            );
            flush(below.as_mut());
            let below = below.as_ref();
            let strip = |(upper, left): (&mut [T], &mut [T])| {
                let n = left.len() / r;
                let mut upper = MatMut::from_column_major_slice_mut(upper, w, n);
                solve_unit_lower_triangular_in_place(block, upper.as_mut(), Par::Seq);
                flush(upper.as_mut());
                let left = MatMut::from_column_major_slice_mut(left, r, n);
                matmul(
                    left,
                    Accum::Add,
                    below,
                    upper.as_ref(),
                    T::narrow(-1.0),
                    Par::Seq,
                );
                clear_upper_halves();
            };
            if is_little {
                upper
                    .chunks_mut(w * COLUMNS)
                    .zip(left.chunks_mut(r * COLUMNS))
                    .for_each(strip);
            } else {
                upper
                    .par_chunks_mut(w * COLUMNS)
                    .zip(left.par_chunks_mut(r * COLUMNS))
                    .for_each(strip);
            }
        }
        Ok(smallest)
    }
}

/// Drops what counts as nothing.
fn flush<T: Number>(block: MatMut<'_, T>) {
    for column in block.col_iter_mut() {
        if let Some(column) = column.try_as_col_major_mut() {
            for value in column.as_slice_mut() {
                *value = value.flushed();
            }
        }
    }
}

/// Factorizes the block of pivots, and exchanges the rows of `upper`. Returns the smallest pivot before it was replaced.
fn pivots<T: Number>(
    lower: &mut [T],
    upper: &mut [T],
    (w, r): (usize, usize),
    pivot: &mut [u32],
    memory: &mut Memory<T>,
) -> Result<f64, NoPivot> {
    let m = w + r;
    let mut block = MatMut::from_column_major_slice_mut(lower, m, w)
        .split_at_row_mut(w)
        .0;
    if memory.width < w {
        let scratch = lu_in_place_scratch::<u32, T>(w, w, Par::Seq, Default::default());
        memory.buffer = MemBuffer::try_new(scratch).ok();
        memory.width = w;
    }
    let buffer = memory.buffer.as_mut().ok_or(NoPivot)?;
    memory.inverse.resize(w, 0);
    lu_in_place(
        block.as_mut(),
        pivot,
        &mut memory.inverse,
        Par::Seq,
        MemStack::new(buffer),
        Default::default(),
    );
    clear_upper_halves();
    flush(block.as_mut());
    let mut smallest = f64::INFINITY;
    for k in 0..w {
        let value = block[(k, k)].wide();
        let size = value.abs();
        if !size.is_finite() {
            return Err(NoPivot);
        }
        smallest = smallest.min(size);
        if size < T::VANISHING {
            block[(k, k)] = T::narrow(T::REPLACEMENT.copysign(value));
        }
    }
    if pivot.iter().enumerate().any(|(k, &p)| k != p as usize) {
        for column in upper.chunks_exact_mut(w) {
            memory.column.clear();
            memory.column.extend_from_slice(column);
            for (to, &p) in column.iter_mut().zip(pivot.iter()) {
                *to = memory.column[p as usize];
            }
        }
    }
    Ok(smallest)
}

/// The columns of each row of a matrix, sorted, with the places of their entries.
fn by_row(matrix: &Matrix) -> Lists<[u32; 2]> {
    let n = matrix.nequation();
    Lists::new(n, || {
        (0..n).flat_map(|e| {
            let places = matrix.start[e]..;
            let entries = matrix.column(e).iter().zip(places);
            entries.map(move |(&row, at)| (row as usize, [e as u32, at]))
        })
    })
}

/// The lower half of the pattern of A + Aᵀ.
fn lower_half(matrix: &Matrix, by_row: &Lists<[u32; 2]>) -> (Vec<u32>, Vec<u32>) {
    let n = matrix.nequation();
    let mut row = Vec::with_capacity(matrix.row.len() / 2 + n);
    let mut begin = Vec::with_capacity(n + 1);
    begin.push(0);
    for e in 0..n {
        let is_above = |&f: &u32| (f as usize) < e;
        let (one, two) = (matrix.column(e), by_row.of(e));
        let mut one = &one[one.partition_point(is_above)..];
        let mut two = &two[two.partition_point(|[f, _]| is_above(f))..];
        if one.iter().eq(two.iter().map(|[f, _]| f)) {
            row.extend_from_slice(one);
            (one, two) = (&[], &[]);
        }
        while let Some(&least) = match (one.first(), two.first()) {
            (Some(a), Some([b, _])) => Some(a.min(b)),
            (a, b) => a.or(b.map(|[f, _]| f)),
        } {
            row.push(least);
            if one.first() == Some(&least) {
                one = &one[1..];
            }
            if two.first().is_some_and(|[f, _]| *f == least) {
                two = &two[1..];
            }
        }
        begin.push(row.len() as u32);
    }
    (begin, row)
}

/// The node of each column.
fn nodes_of_columns(nodes: &[Node], ncolumn: usize) -> Vec<u32> {
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
/// A node comes before its parent as it is, but where nodes were merged, what is below one need not lie side by side.
fn sort_by_subtrees(nodes: &mut Vec<Node>, order: &mut Vec<u32>) {
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
    // each node before what is below it, the last first
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
fn subtrees(
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
fn place_fronts(nodes: &mut [Node], branches: &[Range<usize>]) -> Vec<usize> {
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
