//! Multigrid on the stiffness of the bodies, and a small direct solution at the interface.
//!
//! ```text
//!   K     stiffness of the bodies     ──aggregate, smooth──▶ hierarchy        kept while it serves
//!   A = K + contact, couplings        ──rows at the interface──▶ block A_II   again with every tangent
//!
//!   M⁻¹ r:   y = A_II⁻¹ r_I    x = V (r − A y)    x_I = A_II⁻¹ (r_I − A_IO x_O)    O: all other equations
//! ```
//!
//! Corners of quadratic elements are a level of their own: there stand the linear elements on the same places, which are
//! aggregated.
//!
//! What holds single unknowns, and is little compared with the bodies, is in the hierarchy and not in the block
//! ([`alone`]): viscous forces on bodies that float would make the block the whole model.
//!
//! Contact never enters the hierarchy, so that no change of contact costs a new one, and no stiffness of contact makes
//! iterations more. The levels represent multipliers by fictitious springs ([`springs`]), updated with every tangent. The
//! smoother is an incomplete factor by blocks of nodes. The hierarchy outlives patterns: it is rebuilt only where the
//! stiffness of the bodies, or their constraints, change. All of it is in single precision, and what only smooths, or leads from level to level, in whole numbers of 16 bits with a unit for each row: iterations stay the same.
//!
//! Other fields of the nodes have a hierarchy for each component ([`nodal`]), also where no body deforms, and no part in the block
//! unless constraints act on them. Iterations are in units in which all fields are as large.
//!
//! Multipliers are in the block with all they act on. Where operator and block are positive definite, iterations are by
//! conjugate gradients; elsewhere by minimal residuals, from a start that leaves nothing at the equations of the block,
//! nor does what follows: gaps close exactly, and the residual measures forces away from the interface.
//!
//! Where the hierarchy does not serve (thin bodies, iterations that stay slow), a factor of the stiffness of the bodies
//! stands for it ([`factor`]) for the rest of the run. Where that does not serve either, or in the plane, the direct solver
//! takes over, and says of singular systems what it knows.
//!
//! Sources: Vaněk, Mandel, Brezina, *Computing* 56 (1996) 179–196 (smoothed aggregation); Kothari, Krause, *Comput.
//! Methods Appl. Mech. Engrg.* 2022 (multigrid and contact); the interface apart: Nataf and others, AMG with filtering.

mod aggregation;
mod alone;
mod block;
mod blocks;
mod factor;
mod fine;
mod grid;
mod hierarchy;
mod incomplete;
mod krylov;
mod level;
mod nodal;
mod packed;
#[cfg(feature = "mpi")]
mod petsc;
mod springs;
#[cfg(test)]
mod tests;
mod values;
mod vectors;

use crate::condensation::Condensed;
use crate::direct::Direct;
use crate::direct::Factor;
use crate::error::LinearError;
use crate::problem::{Kept, Problem, Symmetry, Values};
use crate::residual::Residual;
use crate::solver::{EXACT, Iterative, LinearSolver, Note, SolveReport, StartStiffness, Why};
use crate::sparsity::NONE;
use block::InterfaceBlock;
use grid::{Grid, Start, Wanted};
#[cfg(feature = "mpi")]
pub use petsc::Petsc;
use rayon::prelude::*;
use signorini_ranks::Ranks;
use std::any::Any;
use values::CHUNK;

/// Equations from which on multigrid is no slower than a direct solution in space: by Cholesky's factor where the matrix is
/// definite, by L D Lᵀ or LU where it is not. Of the latter, the ten families of `scripts/speed_decks.py` with seeds 3 and 4
/// take 1.30, 1.30 and 1.37 times the processor seconds with `solver.linear = "direct"`, in geometric mean, at 1,500, 2,200 and
/// 3,000 unknowns; slabs take 0.44 to 1.1 times, plates 0.7 to 1.6, and gears, plasticity and quadratic elements 1.5 to 2.5.
pub(crate) const MULTIGRID_FROM: [usize; 2] = [8_000, 1_500];

/// Multigrid over direct solution.
pub struct Multigrid {
    /// Equations below which the direct solver is used, where the matrix is symmetric and where it is not.
    least: [usize; 2],
    direct: Condensed<Direct>,
    kept: Option<Kept>,
    grid: Option<Grid>,
    /// Whether a factor of the bodies stands for their hierarchy.
    wants_factor: bool,
    /// What has the present values.
    way: Option<Way>,
    residual: Residual,
    notes: Vec<Note>,
}

/// What solves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    Grid,
    Direct,
}

impl Default for Multigrid {
    fn default() -> Self {
        Self::new()
    }
}

impl Multigrid {
    /// A solver that has not seen a problem yet.
    #[must_use]
    pub fn new() -> Self {
        Self::from_sizes([0; 2])
    }

    /// The same, which leaves problems with fewer equations to the direct solver: definite ones, and those that are not.
    #[must_use]
    pub fn from_sizes(least: [usize; 2]) -> Self {
        Self {
            least,
            direct: Condensed::new(Direct::reproducible),
            kept: None,
            grid: None,
            wants_factor: false,
            way: None,
            residual: Residual::new(0, 0),
            notes: Vec::new(),
        }
    }

    /// Whether the hierarchy is in use.
    #[cfg(test)]
    pub(crate) fn is_multigrid(&self) -> bool {
        self.way == Some(Way::Grid)
    }

    /// How many equations are solved directly, at the interface.
    #[cfg(test)]
    pub(crate) fn nblock(&self) -> usize {
        let grid = self.grid.as_ref();
        grid.map_or(0, |grid| grid.block.whole.len())
    }

    /// Whether the hierarchy is that of the initial stiffness.
    #[cfg(test)]
    pub(crate) fn is_of_start(&self) -> bool {
        self.grid.as_ref().is_some_and(|grid| grid.start.is_in_use)
    }

    fn go_direct(&mut self, values: &Values) -> Result<(), LinearError> {
        let kept = self.kept.as_ref();
        let kept = kept.ok_or(LinearError::Order { before: "analyze" })?;
        self.way = None;
        self.direct.analyze(&kept.problem())?;
        self.direct.factorize(values)?;
        self.way = Some(Way::Direct);
        Ok(())
    }
}

impl LinearSolver for Multigrid {
    fn analyze(&mut self, problem: &Problem) -> Result<(), LinearError> {
        if self.kept.as_ref().is_some_and(|kept| kept.is(problem)) {
            return Ok(());
        }
        (self.way, self.kept) = (None, None);
        problem.check()?;
        let kept = Kept::new(problem);
        let suits = suits(problem, self.least);
        self.wants_factor = self.experience() > 0;
        let grid = self.grid.take().filter(|_| suits);
        self.grid = match grid {
            Some(mut grid) if grid.fine.is_of(&kept) => {
                grid.follow(&kept);
                Some(grid)
            }
            _ if suits => Some(Grid::new(&kept)).filter(Grid::has_rows),
            _ => None,
        };
        if let Some(grid) = &mut self.grid {
            grid.has_factor = self.wants_factor;
        }
        self.residual = Residual::new(problem.ndof, problem.nequation);
        self.kept = Some(kept);
        Ok(())
    }

    fn factorize(&mut self, values: &Values) -> Result<(), LinearError> {
        let kept = self.kept.as_ref();
        let kept = kept.ok_or(LinearError::Order { before: "analyze" })?;
        self.way = None;
        kept.check(values)?;
        if !all_finite(values) {
            return Err(LinearError::NotFinite);
        }
        let serves = match &mut self.grid {
            Some(grid) if !grid.has_failed => grid.update(kept, values, &mut self.notes)?,
            _ => false,
        };
        if !serves {
            return self.go_direct(values);
        }
        self.way = Some(Way::Grid);
        Ok(())
    }

    fn forget(&mut self) {
        self.direct.forget();
        if let Some(grid) = &mut self.grid {
            grid.forget();
        }
    }

    fn solve(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        rtol: f64,
    ) -> Result<SolveReport, LinearError> {
        self.solve_by(values, rhs, x, Wanted::Residual(rtol))
    }

    fn iterative(&self) -> Option<&dyn Iterative> {
        Some(self)
    }

    fn iterative_mut(&mut self) -> Option<&mut dyn Iterative> {
        Some(self)
    }
}

impl Iterative for Multigrid {
    fn iterates(&self) -> bool {
        self.grid.as_ref().is_some_and(|grid| !grid.has_failed)
    }

    fn solve_to(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        part: f64,
        enough: f64,
    ) -> Result<SolveReport, LinearError> {
        self.solve_by(values, rhs, x, Wanted::Part { part, enough })
    }

    fn ranks(&self) -> Option<&'static dyn Ranks> {
        None
    }

    fn wants_start(&self, id: u64) -> bool {
        self.grid.as_ref().is_some_and(|grid| {
            let start = &grid.start;
            let is_at_hand = start.is_in_use || start.told.is_some();
            let is_known = start.which == Some(id) && is_at_hand;
            let suits = grid.fine.floating.is_empty() && !grid.has_failed && !grid.has_factor;
            suits && !grid.is_proven && !is_known
        })
    }

    fn start_from(&mut self, id: u64, bulk: StartStiffness) {
        let (Some(grid), Some(kept)) = (&mut self.grid, &self.kept) else {
            return;
        };
        let suits = match &bulk {
            StartStiffness::Always => false,
            StartStiffness::Next => true,
            StartStiffness::Values(values) => values.len() == kept.bulk.nvalue(),
        };
        if suits {
            (grid.start.which, grid.start.told) = (Some(id), Some(bulk));
        } else {
            grid.start = Start::default();
        }
    }

    fn experience(&self) -> u8 {
        let has_factor = self.grid.as_ref().is_some_and(|grid| grid.has_factor);
        u8::from(self.wants_factor || has_factor)
    }

    fn recall(&mut self, experience: u8) {
        self.wants_factor = experience > 0;
        if let Some(grid) = &mut self.grid {
            grid.has_factor = self.wants_factor;
        }
    }

    fn bequeath(&mut self) -> Option<Box<dyn Any + Send>> {
        (self.kept, self.way) = (None, None);
        let mut grid = self.grid.take()?;
        grid.forget();
        // a hierarchy is known by the fingerprint of its stiffness, or is that of the start
        if !grid.start.is_in_use {
            grid.start = Start::default();
        }
        grid.has_factor = false;
        Some(Box::new(grid))
    }

    fn inherit(&mut self, heritage: Box<dyn Any + Send>) {
        let Ok(grid) = heritage.downcast::<Grid>() else {
            return;
        };
        // nothing is known of the present problem: the grid serves if it suits that
        (self.kept, self.way) = (None, None);
        self.grid = Some(*grid);
    }

    fn notes(&mut self) -> Vec<Note> {
        std::mem::take(&mut self.notes)
    }
}

impl Multigrid {
    fn solve_by(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        wanted: Wanted,
    ) -> Result<SolveReport, LinearError> {
        let kept = self.kept.as_ref();
        let kept = kept.ok_or(LinearError::Order { before: "analyze" })?;
        kept.check_solution(values, rhs, x)?;
        let rtol = match wanted {
            Wanted::Residual(rtol) => rtol,
            Wanted::Part { .. } => EXACT,
        };
        match (&mut self.grid, self.way) {
            (_, None) => Err(LinearError::Order {
                before: "factorize",
            }),
            (Some(grid), Some(Way::Grid)) => {
                let residual = &mut self.residual;
                let mut lost = 0;
                let why = loop {
                    let why = match grid.solve(kept, values, rhs, x, wanted, residual)? {
                        Ok(report) => return Ok(report.after(lost)),
                        Err(why) => why,
                    };
                    let Why::Slow { iterations } = why else {
                        break why;
                    };
                    lost += iterations;
                    if !grid.improve(kept, values, why, &mut self.notes)? {
                        break why;
                    }
                };
                self.notes.push(Note::Direct { why });
                grid.has_failed = true;
                self.go_direct(values)?;
                let report = self.direct.solve(values, rhs, x, rtol)?;
                Ok(report.after(lost))
            }
            _ => self.direct.solve(values, rhs, x, rtol),
        }
    }
}

/// Whether multigrid is tried on a problem, where it is for no fewer equations: definite ones, and those that are not.
pub(crate) fn suits(problem: &Problem, least: [usize; 2]) -> bool {
    let [definite, others] = least;
    let least = match problem.symmetry {
        Symmetry::Definite => definite,
        Symmetry::Symmetric | Symmetry::Unsymmetric => others,
    };
    problem.bulk.block == 3
        && problem.nequation >= least
        && problem.coordinates.len() == problem.bulk.nrow()
        && !has_shared(problem)
}

/// Whether all values are numbers.
fn all_finite(values: &Values) -> bool {
    // without a branch for each value
    let is_finite = |some: &[f64]| some.iter().fold(true, |all, v| all & v.is_finite());
    let chunks = |all| <[f64]>::par_chunks(all, CHUNK);
    chunks(values.bulk)
        .chain(chunks(values.interface))
        .all(is_finite)
}

/// The size of the factor at the interface of a problem.
///
/// # Errors
/// `TooLarge`.
pub(crate) fn size_of_block(kept: &Kept) -> Result<Factor, LinearError> {
    InterfaceBlock::size(kept)
}

/// Whether dofs share an equation.
fn has_shared(problem: &Problem) -> bool {
    let used = problem.equation.iter().filter(|&&e| e != NONE);
    used.count() > problem.nequation
}
