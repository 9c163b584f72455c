//! The same algorithm over the ranks of MPI: PETSc has the rows of the operator and the hierarchy of the bodies.
//!
//! ```text
//!   every rank    iterations, the block of the interface, decisions      the same everywhere
//!   its rows      A x, hierarchy: PETSc's GAMG                           smoothed aggregation
//!                   smoothed by Chebyshev's polynomial of degree 2 over incomplete factors of each rank's rows
//! ```
//!
//! Vectors of the iterations are shared out, sums over ranks are in their order: the same number of ranks gives the same
//! bits. The hierarchy is that of the stiffness of the bodies with [`springs`] for multipliers and for what floats; motions
//! of rigid bodies, zero where they are held, lead to its levels. Every rank factorizes the whole block of the interface.
//!
//! Problems that no hierarchy serves (the plane, other fields, equations that dofs share) are solved on every rank by
//! [`Multigrid`], as are those with which iterations fail (nearly incompressible bodies), until the increment ends, and from the
//! second such increment on for the rest of the run.
//!
//! Needs the feature `mpi` and the library, of real numbers in double precision with indices of 32 bits.
//!
//! Sources: S. Balay and others, PETSc/TAO Users Manual, ANL-21/39; M. Adams, M. Brezina, J. Hu, R. Tuminaro, Parallel
//! multigrid smoothing: polynomial versus Gauss–Seidel, J. Comput. Phys. 188 (2003) 593–610.

mod fleet;
mod layout;
mod library;
mod rows;

use super::grid::Wanted;
use super::{MULTIGRID_FROM, Multigrid, all_finite, suits};
use crate::error::LinearError;
use crate::problem::{Kept, Problem, Values};
use crate::solver::{Iterative, LinearSolver, Note, SolveReport, StartStiffness, Why};
use fleet::Fleet;
use std::any::Any;

/// Increments in which iterations fail before they are tried no more.
const FAILURES: u8 = 2;

/// Multigrid over the ranks of MPI.
pub struct Petsc {
    kept: Option<Kept>,
    fleet: Option<Fleet>,
    /// Increments in which iterations have failed, as far as they count.
    failures: u8,
    /// What stands in for it, on every rank.
    alone: Multigrid,
    /// What has the present values.
    way: Option<Way>,
    notes: Vec<Note>,
}

/// What solves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    Fleet,
    Alone,
}

impl Default for Petsc {
    fn default() -> Self {
        Self::new()
    }
}

impl Petsc {
    /// A solver that has not seen a problem yet.
    #[must_use]
    pub fn new() -> Self {
        Self {
            kept: None,
            fleet: None,
            failures: 0,
            alone: Multigrid::from_sizes(MULTIGRID_FROM),
            way: None,
            notes: Vec::new(),
        }
    }

    fn go_alone(&mut self, values: &Values) -> Result<(), LinearError> {
        let kept = self.kept.as_ref();
        let kept = kept.ok_or(LinearError::Order { before: "analyze" })?;
        self.way = None;
        self.alone.analyze(&kept.problem())?;
        self.alone.factorize(values)?;
        self.way = Some(Way::Alone);
        Ok(())
    }

    fn solve_by(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        wanted: Wanted,
    ) -> Result<SolveReport, LinearError> {
        let before = match self.kept {
            Some(_) => "factorize",
            None => "analyze",
        };
        let (Some(kept), Some(way)) = (&self.kept, self.way) else {
            return Err(LinearError::Order { before });
        };
        kept.check_solution(values, rhs, x)?;
        let lost = match &mut self.fleet {
            Some(fleet) if way == Way::Fleet => match fleet.solve(kept, values, rhs, x, wanted)? {
                Ok(report) => return Ok(report),
                Err(why) => {
                    self.notes.push(Note::Alone { why });
                    fleet.has_failed = true;
                    match why {
                        Why::Slow { iterations } => iterations,
                        _ => 0,
                    }
                }
            },
            _ => 0,
        };
        if way == Way::Fleet {
            self.go_alone(values)?;
        }
        let report = self.alone.solve_by(values, rhs, x, wanted)?;
        Ok(report.after(lost))
    }
}

impl LinearSolver for Petsc {
    fn analyze(&mut self, problem: &Problem) -> Result<(), LinearError> {
        if self.kept.as_ref().is_some_and(|kept| kept.is(problem)) {
            return Ok(());
        }
        (self.way, self.kept) = (None, None);
        problem.check()?;
        let kept = Kept::new(problem);
        let suits = problem.fields.is_empty() && suits(problem, [0; 2]);
        let fleet = self.fleet.take().filter(|_| suits);
        self.fleet = match fleet {
            Some(mut fleet) if fleet.is_of(&kept) => {
                fleet.follow(&kept);
                Some(fleet)
            }
            _ if suits => Some(Fleet::new(&kept)?).filter(Fleet::has_rows),
            _ => None,
        };
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
        let is_tried = self.failures < FAILURES;
        let serves = match &mut self.fleet {
            Some(fleet) if is_tried && !fleet.has_failed => {
                fleet.update(kept, values, &mut self.notes)?
            }
            _ => false,
        };
        if !serves {
            return self.go_alone(values);
        }
        self.way = Some(Way::Fleet);
        Ok(())
    }

    fn forget(&mut self) {
        self.alone.forget();
        if let Some(fleet) = &mut self.fleet {
            fleet.forget();
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

impl Iterative for Petsc {
    fn iterates(&self) -> bool {
        match &self.fleet {
            Some(fleet) if self.failures < FAILURES && !fleet.has_failed => true,
            _ => self.alone.iterates(),
        }
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

    fn wants_start(&self, _: u64) -> bool {
        false
    }

    fn start_from(&mut self, _: u64, _: StartStiffness) {}

    fn experience(&self) -> u8 {
        2 * self.failures + self.alone.experience().min(1)
    }

    fn recall(&mut self, experience: u8) {
        self.failures = FAILURES.min(experience / 2);
        self.alone.recall(experience % 2);
    }

    fn bequeath(&mut self) -> Option<Box<dyn Any + Send>> {
        (self.kept, self.way) = (None, None);
        let mut fleet = self.fleet.take()?;
        fleet.forget();
        Some(Box::new(fleet))
    }

    fn inherit(&mut self, heritage: Box<dyn Any + Send>) {
        let Ok(fleet) = heritage.downcast::<Fleet>() else {
            return;
        };
        // nothing is known of the present problem: it serves if it suits that
        (self.kept, self.way) = (None, None);
        self.fleet = Some(*fleet);
    }

    fn notes(&mut self) -> Vec<Note> {
        let mut notes = std::mem::take(&mut self.notes);
        notes.extend(self.alone.notes());
        notes
    }
}
