//! The equations around the interface, solved directly.

use super::alone::{coupled, touched};
use super::values::Means;
use crate::direct::Direct;
use crate::direct::Factor;
use crate::error::LinearError;
use crate::problem::{Kept, Problem, Values};
use crate::solver::LinearSolver;
use crate::sparsity::{BlockPattern, NONE, Pattern};

/// What is asked of its solutions: they serve within a preconditioner.
const TOLERANCE: f64 = 1e-6;
/// What solutions in single precision may leave, in equilibrated equations: more, and the factor is made in double.
const ROUGHLY: f64 = 1e-3;
/// Layers of nodes around the interface are taken in as long as the block has no more than these parts of all equations:
/// they save iterations, and cost a larger factor. Measured, iterations of a whole run and seconds, without, with one and
/// with two layers: 106, 72, 63 and 6.7, 6.2, 6.0 in a circle with 0.7 to 1.7 % of 286,000 equations; 310, 195, 155 and
/// 11.0, 11.0, 11.7 between blocks with 8, 14 and 22 % of 50,000. A block of no more than so many equations costs little
/// in any case. The second layer is for what has no multipliers: where the hierarchy has springs for these, iterations of a
/// run are 55, 48 and 44 without, with one and with two, and the seconds least with one.
const LAYERS: [(f64, usize); 2] = [(0.12, 2500), (0.05, 1000)];

/// All nodes at which interface values have a place are taken where these are no more than so many times those they act on.
const NEARLY: f64 = 1.25;

/// The equations that interface values act on, with those of the nodes around.
pub(super) struct InterfaceBlock {
    direct: Direct,
    /// Whether solutions need no refinement, as one with the first factor of these equations has shown.
    is_exact: Option<bool>,
    /// The nodes in it, and the raw dofs beyond the nodes.
    nodes: Vec<u32>,
    extra: Vec<u32>,
    bulk: BlockPattern,
    interface: Pattern,
    /// Which block, or entry, of the whole each one is: 2³² blocks would take 300 GB.
    bulk_at: Vec<u32>,
    interface_at: Vec<u32>,
    bulk_values: Vec<f64>,
    interface_values: Vec<f64>,
    equation: Vec<u32>,
    /// The equation of the whole behind each.
    pub whole: Vec<u32>,
    sign: Vec<i8>,
    /// Where the values of the operator between these equations and others are: those of the bulk, then of the interface.
    outer_at: Vec<usize>,
    outer: Rows,
    right: Vec<f64>,
    left: Vec<f64>,
}

/// The rows of the whole operator at these equations, over all others.
#[derive(Default)]
struct Rows {
    start: Vec<usize>,
    column: Vec<u32>,
    value: Vec<f64>,
}

impl InterfaceBlock {
    pub fn new() -> Self {
        Self {
            direct: Direct::rough(),
            is_exact: None,
            nodes: Vec::new(),
            extra: Vec::new(),
            bulk: BlockPattern::empty(0, 3),
            interface: Pattern::empty(0),
            bulk_at: Vec::new(),
            interface_at: Vec::new(),
            bulk_values: Vec::new(),
            interface_values: Vec::new(),
            equation: Vec::new(),
            whole: Vec::new(),
            sign: Vec::new(),
            outer_at: Vec::new(),
            outer: Rows::default(),
            right: Vec::new(),
            left: Vec::new(),
        }
    }

    /// Forgets what earlier values taught.
    pub fn forget(&mut self) {
        self.direct.forget();
        self.is_exact = None;
    }

    /// The size of the factor if values act wherever they have a place.
    ///
    /// # Errors
    /// `TooLarge`.
    pub fn size(kept: &Kept) -> Result<Factor, LinearError> {
        let mut block = Self::new();
        let all = coupled(kept);
        block.nodes = (0..kept.bulk.nrow() as u32)
            .filter(|&node| all[node as usize])
            .collect();
        block.extra = beyond(kept);
        block.number(kept, &kept.bulk);
        Factor::of(&block.problem(kept))
    }

    /// The equations outside that it is coupled with, some of them several times.
    #[cfg(feature = "mpi")]
    pub fn coupled(&self) -> &[u32] {
        &self.outer.column
    }

    fn problem(&self, kept: &Kept) -> Problem<'_> {
        Problem {
            ndof: self.equation.len(),
            bulk: &self.bulk,
            interface: &self.interface,
            fields: &[],
            equation: &self.equation,
            nequation: self.whole.len(),
            symmetry: kept.symmetry,
            sign: &self.sign,
            coordinates: &[],
            between: &[],
        }
    }

    /// Takes the values of a tangent: chooses the equations, and factorizes.
    ///
    /// # Errors
    /// Those of the direct solver.
    pub fn update(&mut self, kept: &Kept, values: &Values) -> Result<(), LinearError> {
        let touched = touched(kept, values, Means::Here(kept, values));
        let near = |nodes: &[u32]| {
            let columns = nodes.iter().flat_map(|&node| kept.bulk.columns(node));
            Ok(columns.copied().collect())
        };
        let chosen = choose(kept, touched, near)?;
        self.update_at(kept, &kept.bulk, values, chosen)
    }

    /// The same for nodes and other dofs that have been chosen; `bulk`, whose values these are, has the rows of the nodes.
    ///
    /// # Errors
    /// Those of the direct solver.
    pub fn update_at(
        &mut self,
        kept: &Kept,
        bulk: &BlockPattern,
        values: &Values,
        (nodes, extra): (Vec<u32>, Vec<u32>),
    ) -> Result<(), LinearError> {
        if nodes != self.nodes || extra != self.extra || self.equation.is_empty() {
            self.nodes = nodes;
            self.extra = extra;
            self.number(kept, bulk);
            self.is_exact = None;
        }
        if self.whole.is_empty() {
            return Ok(());
        }
        self.gather(values);
        let mut direct = std::mem::replace(&mut self.direct, Direct::rough());
        let analyzed = direct.analyze(&self.problem(kept));
        self.direct = direct;
        analyzed?;
        let values = Values {
            bulk: &self.bulk_values,
            interface: &self.interface_values,
        };
        self.direct.factorize(&values)?;
        let is_rough = self.direct.is_rough();
        if self.is_exact.is_some() && !is_rough {
            return Ok(());
        }
        let signs = [1.0, -1.0, 1.0, 1.0, -1.0];
        let signs = signs.into_iter().cycle();
        self.right.iter_mut().zip(signs).for_each(|(b, s)| *b = s);
        if is_rough {
            if self.direct.leaves(&self.right) <= ROUGHLY {
                self.is_exact = Some(true);
                return Ok(());
            }
            self.direct.widen();
            self.direct.factorize(&values)?;
        }
        let (right, left) = (&self.right, &mut self.left);
        self.is_exact = match self.direct.solve(&values, right, left, TOLERANCE) {
            Ok(report) => Some(report.refinements == 0),
            Err(LinearError::Inaccurate { .. }) => Some(false),
            Err(other) => return Err(other),
        };
        Ok(())
    }

    /// Numbers the equations and finds where their values are.
    fn number(&mut self, kept: &Kept, bulk: &BlockPattern) {
        let nlocal = self.nodes.len();
        let nbulk = 3 * kept.bulk.nrow();
        let mut local_node = vec![NONE; kept.bulk.nrow()];
        for (k, &node) in self.nodes.iter().enumerate() {
            local_node[node as usize] = k as u32;
        }
        let mut raw: Vec<u32> = Vec::with_capacity(3 * nlocal + self.extra.len());
        raw.extend(
            self.nodes
                .iter()
                .flat_map(|&node| (0..3).map(move |i| 3 * node + i)),
        );
        raw.extend(&self.extra);
        let local = |dof: u32| -> Option<u32> {
            if (dof as usize) < nbulk {
                let node = local_node[dof as usize / 3];
                (node != NONE).then(|| 3 * node + dof % 3)
            } else {
                let at = self.extra.binary_search(&dof).ok()?;
                Some((3 * nlocal + at) as u32)
            }
        };
        let (mut row_start, mut columns) = (vec![0], Vec::new());
        self.bulk_at.clear();
        for &node in &self.nodes {
            let of_row = bulk.row_start[node as usize]..bulk.row_start[node as usize + 1];
            for at in of_row {
                let column = local_node[bulk.column[at] as usize];
                if column != NONE {
                    columns.push(column);
                    self.bulk_at.push(at as u32);
                }
            }
            row_start.push(columns.len());
        }
        self.bulk = BlockPattern {
            block: 3,
            row_start: row_start.into(),
            column: columns.into(),
            partition: None,
        };
        let (mut row_start, mut columns) = (vec![0], Vec::new());
        self.interface_at.clear();
        for &dof in &raw {
            let of_row = kept.interface.row_start.get(dof as usize..dof as usize + 2);
            for at in of_row.map_or(0..0, |ends| ends[0]..ends[1]) {
                if let Some(column) = local(kept.interface.column[at]) {
                    columns.push(column);
                    self.interface_at.push(at as u32);
                }
            }
            row_start.push(columns.len());
        }
        self.interface = Pattern {
            nrow: raw.len(),
            row_start: row_start.into(),
            column: columns.into(),
        };
        self.equation.clear();
        self.whole.clear();
        for &dof in &raw {
            let whole = kept.equation[dof as usize];
            if whole == NONE {
                self.equation.push(NONE);
            } else {
                self.equation.push(self.whole.len() as u32);
                self.whole.push(whole);
            }
        }
        self.connect(kept, bulk, &raw);
        let signs = self.whole.iter().map(|&e| kept.sign[e as usize]);
        self.sign = signs.collect();
        self.right = vec![0.0; self.whole.len()];
        self.left = vec![0.0; self.whole.len()];
    }

    /// Finds what connects these equations with others: bulk, and what rows of the interface depend on without acting on it.
    fn connect(&mut self, kept: &Kept, bulk: &BlockPattern, raw: &[u32]) {
        let mut is_inside = vec![false; kept.sign.len()];
        for &e in &self.whole {
            is_inside[e as usize] = true;
        }
        let nbulk = bulk.nvalue();
        let Rows { start, column, .. } = &mut self.outer;
        start.clear();
        column.clear();
        self.outer_at.clear();
        start.push(0);
        for &dof in raw
            .iter()
            .filter(|&&dof| kept.equation[dof as usize] != NONE)
        {
            let of_interface = kept.interface.row_start.get(dof as usize..dof as usize + 2);
            let of_interface = of_interface.map_or(0..0, |ends| ends[0]..ends[1]);
            let of_interface = of_interface.map(|at| (kept.interface.column[at], nbulk + at));
            for (other, at) in bulk.row_of_dof(dof).chain(of_interface) {
                let e = kept.equation[other as usize];
                if e != NONE && !is_inside[e as usize] {
                    column.push(e);
                    self.outer_at.push(at);
                }
            }
            start.push(column.len());
        }
    }

    fn gather(&mut self, values: &Values) {
        self.bulk_values.clear();
        let (blocks, _) = values.bulk.as_chunks::<9>();
        for &at in &self.bulk_at {
            let block = blocks.get(at as usize).unwrap_or(&[0.0; 9]);
            self.bulk_values.extend_from_slice(block);
        }
        let interface = self.interface_at.iter();
        self.interface_values.clear();
        self.interface_values
            .extend(interface.map(|&at| values.interface.get(at as usize).copied().unwrap_or(0.0)));
        let nbulk = values.bulk.len();
        let outer = self.outer_at.iter().map(|&at| {
            let value = if at < nbulk {
                values.bulk.get(at)
            } else {
                values.interface.get(at - nbulk)
            };
            value.copied().unwrap_or(0.0)
        });
        self.outer.value.clear();
        self.outer.value.extend(outer);
    }

    /// `A_II⁻¹` times what `right` gives for each of the equations, into `left`.
    fn apply(&mut self) -> Result<(), LinearError> {
        if self.is_exact == Some(true) {
            return self.direct.solve_unchecked(&self.right, &mut self.left);
        }
        let values = Values {
            bulk: &self.bulk_values,
            interface: &self.interface_values,
        };
        let outcome = self
            .direct
            .solve(&values, &self.right, &mut self.left, TOLERANCE);
        outcome.map(|_| ())
    }

    /// `y = A_II⁻¹ r_I`, and `r −= A y`, which leaves nothing at the equations of the block.
    ///
    /// # Errors
    /// Those of the direct solver.
    pub fn before(&mut self, r: &mut [f64]) -> Result<(), LinearError> {
        for (right, &e) in self.right.iter_mut().zip(&self.whole) {
            *right = r[e as usize];
        }
        self.apply()?;
        // outside of the block the operator is that of the bulk, which is symmetric
        let Rows {
            start,
            column,
            value,
        } = &self.outer;
        for (ends, y) in start.windows(2).zip(&self.left) {
            let at = ends[0]..ends[1];
            for (&e, a) in column[at.clone()].iter().zip(&value[at]) {
                r[e as usize] -= a * y;
            }
        }
        for &e in &self.whole {
            r[e as usize] = 0.0;
        }
        Ok(())
    }

    /// `x_I = A_II⁻¹ (r_I − A_IO x_O)` with the other equations O: what `x_I += A_II⁻¹ (r − A x)_I` makes of any `x_I`.
    ///
    /// # Errors
    /// Those of the direct solver.
    pub fn after(&mut self, r: &[f64], x: &mut [f64]) -> Result<(), LinearError> {
        for (right, &e) in self.right.iter_mut().zip(&self.whole) {
            *right = r[e as usize];
        }
        let Rows {
            start,
            column,
            value,
        } = &self.outer;
        for (ends, right) in start.windows(2).zip(&mut self.right) {
            let at = ends[0]..ends[1];
            let parts = column[at.clone()].iter().zip(&value[at]);
            *right -= parts.map(|(&e, a)| a * x[e as usize]).sum::<f64>();
        }
        self.apply()?;
        for (left, &e) in self.left.iter().zip(&self.whole) {
            x[e as usize] = *left;
        }
        Ok(())
    }
}

/// The raw dofs beyond the nodes that are solved for; of other fields of the nodes, those that constraints or carriers act
/// on.
fn beyond(kept: &Kept) -> Vec<u32> {
    let nbulk = 3 * kept.bulk.nrow() as u32;
    let is_nodal = |column: u32| column < nbulk || kept.is_of_field(column);
    let is_apart = |dof: u32| {
        let mut columns = kept.interface_row(dof).map(|(column, _)| column);
        kept.is_of_field(dof) && columns.all(is_nodal)
    };
    let all = nbulk..kept.equation.len() as u32;
    all.filter(|&dof| kept.is_free(dof as usize) && !is_apart(dof))
        .collect()
}

/// Nodes and other raw dofs that interface values act on, and layers of nodes around, where they are not too many. Where
/// values act on nearly all that they have a place at, these are taken: then what opens and closes costs no new order.
/// `near` gives the nodes in the rows of some, in any order.
///
/// # Errors
/// Those of `near`.
pub(super) fn choose(
    kept: &Kept,
    touched: Vec<bool>,
    mut near: impl FnMut(&[u32]) -> Result<Vec<u32>, LinearError>,
) -> Result<(Vec<u32>, Vec<u32>), LinearError> {
    let nnode = kept.bulk.nrow();
    let mut inside = touched;
    let all = coupled(kept);
    let [some, most] = [&inside, &all].map(|some| some.iter().filter(|is_in| **is_in).count());
    if some > 0 && most as f64 <= NEARLY * some as f64 {
        let both = inside.iter_mut().zip(all);
        both.for_each(|(is_in, may_be)| *is_in |= may_be);
    }
    let extra = beyond(kept);
    let mut nodes: Vec<u32> = (0..nnode as u32)
        .filter(|&node| inside[node as usize])
        .collect();
    let has_multipliers = extra.iter().any(|&dof| kept.is_multiplier(dof as usize));
    let most = if has_multipliers { 1 } else { LAYERS.len() };
    for (part, few) in LAYERS.into_iter().take(most) {
        let mut more = nodes.clone();
        for other in near(&nodes)? {
            if !std::mem::replace(&mut inside[other as usize], true) {
                more.push(other);
            }
        }
        let count = 3 * more.len() + extra.len();
        if count > few && count as f64 > part * kept.sign.len() as f64 {
            break;
        }
        more.sort_unstable();
        nodes = more;
    }
    Ok((nodes, extra))
}
