//! A factor of the stiffness of the bodies, for those that no hierarchy serves.
//!
//! Plates and slabs of a few elements bend: aggregates that span their thickness do not see that, and an incomplete factor
//! does not smooth it. Yet their stiffness alone has a small factor, and with the springs of multipliers ([`springs`]) it
//! takes a few iterations,
//!
//! ```text
//!   L Lᵀ = K + Cᵀ C + viscous forces      C: rows of multipliers, each in units of its spring
//! ```
//!
//! where all of it in one unsymmetric factor would take several times the memory. It serves as long as about the same
//! multipliers act, and iterations cost less than a new one: a spring that holds together what has opened costs about an
//! iteration, and many of them all.

use super::blocks::Blocks;
use super::fine::{Fine, stiffen};
use super::springs::Rows;
use super::values::{Means, fill, fingerprint};
use super::{alone, springs};
use crate::direct::Direct;
use crate::error::LinearError;
use crate::problem::{Kept, Problem, Symmetry, Values};
use crate::solver::LinearSolver;
use crate::sparsity::{BlockPattern, Pattern};

/// Springs to the ground at nodes of bodies that float, over their stiffness, so that there is a factor where nothing but
/// friction and the curvature of contact hold them.
const GROUND: f64 = 1e-5;
/// Multiplications of a factorization that take as long as one number of the factor in a solution, which is bound by memory:
/// measured, 0.4 s and 0.02 s for 8 million numbers of 6e9 multiplications.
const WORK_PER_NUMBER: f64 = 40.0;
/// Iterations that are never too many.
const FEW: usize = 10;
/// The part of the iterations that a factor costs that may be spent because of multipliers that act no more, one for each.
const TOLERATED: f64 = 0.5;
/// The change of a spring's stiffness from which on it is another one.
const CHANGED: f64 = 0.1;

/// The factor.
pub(super) struct BodyFactor {
    direct: Direct,
    /// What it was made of.
    source: Option<u64>,
    /// The multipliers that act, and the stiffness of their springs.
    springs: Vec<(usize, f64)>,
    is_stale: bool,
    right: Vec<f64>,
    left: Vec<f64>,
}

impl BodyFactor {
    pub fn new() -> Self {
        Self {
            direct: Direct::reproducible(),
            source: None,
            springs: Vec::new(),
            is_stale: false,
            right: Vec::new(),
            left: Vec::new(),
        }
    }

    /// Whether there is one.
    pub const fn is_there(&self) -> bool {
        self.source.is_some()
    }

    /// The numbers that it stores.
    pub fn numbers(&self) -> usize {
        self.direct.size().0
    }

    /// Asks for a new one with the next values, where these differ.
    pub const fn expire(&mut self) {
        self.is_stale = true;
    }

    /// Takes note of iterations that a solution with it took: where they cost more than a factor, the next values get one.
    pub fn judge(&mut self, iterations: usize) {
        self.is_stale |= iterations > FEW && iterations as f64 > self.price();
    }

    /// The iterations that a factor costs.
    fn price(&self) -> f64 {
        let (numbers, work) = self.direct.size();
        work / (WORK_PER_NUMBER * numbers.max(1) as f64)
    }

    /// Makes one of these values, unless that at hand serves. Answers whether it did.
    ///
    /// # Errors
    /// Those of the direct solver.
    pub fn update(
        &mut self,
        kept: &Kept,
        values: &Values,
        fine: &Fine,
    ) -> Result<bool, LinearError> {
        let (rows, springs) =
            springs::rows_and_strengths(kept, values, Means::Here(kept, values), fine);
        if self.is_there() && !self.is_stale && self.is_held_like(&springs) {
            return Ok(false);
        }
        self.is_stale = false;
        self.springs = springs;
        let matrix = stiffness(kept, values, fine, rows.as_ref());
        let numbers = matrix.value.as_flattened().as_flattened();
        let source = fingerprint(numbers);
        if self.source == Some(source) {
            return Ok(false);
        }
        self.source = None;
        let nrow = matrix.nrow();
        let bulk = BlockPattern {
            block: 3,
            row_start: matrix.start.as_slice().into(),
            column: matrix.column.as_slice().into(),
            partition: None,
        };
        let equation: Vec<u32> = (0..3 * nrow as u32).collect();
        let place = |&node: &u32| kept.coordinates.get(node as usize).copied();
        let coordinates: Vec<[f64; 3]> = fine.node.iter().filter_map(place).collect();
        self.direct.analyze(&Problem {
            ndof: 3 * nrow,
            bulk: &bulk,
            interface: &Pattern::empty(3 * nrow),
            fields: &[],
            equation: &equation,
            nequation: 3 * nrow,
            symmetry: Symmetry::Definite,
            sign: &vec![1; 3 * nrow],
            coordinates: &coordinates,
            between: &[],
        })?;
        self.direct.factorize(&Values {
            bulk: numbers,
            interface: &[],
        })?;
        self.source = Some(source);
        self.right.resize(3 * nrow, 0.0);
        self.left.resize(3 * nrow, 0.0);
        Ok(true)
    }

    /// Whether almost all multipliers have about the springs that the factor was made with.
    fn is_held_like(&self, springs: &[(usize, f64)]) -> bool {
        let changes = springs::changes(&self.springs, springs, CHANGED);
        changes as f64 <= TOLERATED * self.price()
    }

    /// The motion of the bodies under `r`, at unknowns of the finest level: `of_row` are the equations of each row, `unknown`
    /// is that of each equation.
    ///
    /// # Errors
    /// `Order` where there is no factor.
    pub fn apply(
        &mut self,
        r: &[f64],
        of_row: &[[u32; 3]],
        unknown: &[u32],
        z: &mut [f64],
    ) -> Result<(), LinearError> {
        let force = |&e: &u32| r.get(e as usize).copied().unwrap_or(0.0);
        fill(&mut self.right, of_row.as_flattened(), force);
        self.direct.solve_unchecked(&self.right, &mut self.left)?;
        let left = &self.left;
        fill(z, unknown, |&k| {
            left.get(k as usize).copied().unwrap_or(0.0)
        });
        Ok(())
    }
}

/// The stiffness of the bodies with what holds them, over the rows of the finest level.
fn stiffness(kept: &Kept, values: &Values, fine: &Fine, rows: Option<&Rows<3>>) -> Blocks<3, 3> {
    let mut matrix = fine.matrix(kept, values);
    alone::add(kept, values, fine, &mut matrix);
    stiffen(&mut matrix, &fine.floating, GROUND);
    match rows {
        Some(rows) => matrix.plus(&springs::stiffness(rows)),
        None => matrix,
    }
}
