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

mod fetched;
mod fleet;
mod layout;
mod library;
mod rows;

use super::grid::Wanted;
use super::{MULTIGRID_FROM, Multigrid, all_finite, suits};
use crate::error::LinearError;
use crate::problem::{Kept, Problem, Values};
use crate::solver::{Iterative, LinearSolver, Note, SolveReport, StartStiffness, Why};
use crate::sparsity::BlockPattern;
use fetched::Fetched;
use fleet::Fleet;
use signorini_ranks::{Ranks, world};
use std::any::Any;

/// Increments in which iterations fail before they are tried no more.
const FAILURES: u8 = 2;

/// Multigrid over the ranks of MPI.
pub struct Petsc {
    kept: Option<Kept>,
    fleet: Option<Fleet>,
    /// Increments in which iterations have failed, as far as they count.
    failures: u8,
    /// What stands in for it, on every rank, with all rows.
    alone: Multigrid,
    /// Those of other ranks, once they were needed.
    rows: Option<Fetched>,
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
            rows: None,
            way: None,
            notes: Vec::new(),
        }
    }

    fn go_alone(&mut self, values: &Values) -> Result<(), LinearError> {
        let kept = self.kept.as_ref();
        let kept = kept.ok_or(LinearError::Order { before: "analyze" })?;
        self.way = None;
        self.rows = match &kept.bulk.partition {
            Some(partition) if partition.ranks().size() > 1 => {
                let all = || (0..kept.bulk.nrow() as u32).collect::<Vec<u32>>();
                let mut rows = match self.rows.take() {
                    Some(rows) => rows,
                    None => Fetched::new(&kept.bulk, partition, &all())?,
                };
                rows.update(partition, values.bulk)?;
                Some(rows)
            }
            _ => None,
        };
        let here = BlockPattern {
            partition: None,
            ..kept.bulk.clone()
        };
        let bulk = self.rows.as_ref().map_or(&here, |rows| &rows.pattern);
        self.alone.analyze(&Problem {
            bulk,
            ..kept.problem()
        })?;
        self.alone.factorize(&whole(self.rows.as_ref(), values))?;
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
        let values = whole(self.rows.as_ref(), values);
        let report = self.alone.solve_by(&values, rhs, x, wanted)?;
        Ok(report.after(lost))
    }
}

/// The values of all rows, where those of other ranks were fetched.
fn whole<'a>(rows: Option<&'a Fetched>, values: &Values<'a>) -> Values<'a> {
    Values {
        bulk: rows.map_or(values.bulk, |rows| &rows.values),
        interface: values.interface,
    }
}

impl LinearSolver for Petsc {
    fn analyze(&mut self, problem: &Problem) -> Result<(), LinearError> {
        let on_all = |is: bool| match &problem.bulk.partition {
            Some(partition) => partition.is_on_all(is),
            None => Ok(is),
        };
        let is_kept = self.kept.as_ref().is_some_and(|kept| kept.is(problem));
        if on_all(is_kept)? {
            return Ok(());
        }
        (self.way, self.kept, self.rows) = (None, None, None);
        problem.check()?;
        let kept = Kept::new(problem);
        let suits = problem.fields.is_empty() && suits(problem, [0; 2]);
        let partition = kept.bulk.partition.as_ref().filter(|_| suits);
        let fleet = self.fleet.take().filter(|_| suits);
        let is_of = on_all(fleet.as_ref().is_some_and(|fleet| fleet.is_of(&kept)))?;
        let fleet = fleet.filter(|_| is_of);
        self.fleet = match (fleet, partition) {
            (Some(mut fleet), _) => {
                fleet.follow(&kept);
                Some(fleet)
            }
            (None, Some(partition)) => Some(Fleet::new(&kept, partition)?).filter(Fleet::has_rows),
            (None, None) => None,
        };
        self.kept = Some(kept);
        Ok(())
    }

    fn factorize(&mut self, values: &Values) -> Result<(), LinearError> {
        let kept = self.kept.as_ref();
        let kept = kept.ok_or(LinearError::Order { before: "analyze" })?;
        self.way = None;
        kept.check(values)?;
        let partition = kept.bulk.partition.as_ref();
        let is_finite = all_finite(values);
        if !partition.map_or(Ok(is_finite), |of| of.is_on_all(is_finite))? {
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

    fn ranks(&self) -> Option<&'static dyn Ranks> {
        Some(world())
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
